"""YAML files: what is read, what is refused, and what stays when a value is changed."""

from __future__ import annotations

import contextlib
import math
import re
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import yaml
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hrsafety._yaml.documents import YamlDocument, read_yaml
from hrsafety._yaml.nodes import resolved
from hrsafety.errors import FileError, InvalidParameterError


def plain(text: str) -> Any:
    return YamlDocument(text, "base.yaml").root.plain


# ---- what is read --------------------------------------------------------------------------------

STYLES = {
    "a: 1\nb: 0.5\nc: word\nd: two words  # note\n": {"a": 1, "b": 0.5, "c": "word", "d": "two words"},
    "a:\n- 1\n- 2\nb:\n  - c: 1\n    d: 2\n  - - 3\n    - 4\n": {"a": [1, 2], "b": [{"c": 1, "d": 2}, [3, 4]]},
    "{a: [1, -2.5, 'x'], \"b\":{c: d}, e: , }  # flow": {"a": [1, -2.5, "x"], "b": {"c": "d"}, "e": None},
    "points: [0.1,\n    # corner\n  0.2, \n0.3]\n": {"points": [0.1, 0.2, 0.3]},
    "a: \"[[0.1, 0.2], \\\n     [0.3, 0.4]]\"\nb: 'it''s'\n": {"a": "[[0.1, 0.2], [0.3, 0.4]]", "b": "it's"},
    "a: one\n  two\n\n  three # c\nb: http://x/#y z:1\n": {"a": "one two\nthree", "b": "http://x/#y z:1"},
    "a: |\n  x\n   y\n\nb: >-\n  c\n  d\n": {"a": "x\n y\n", "b": "c d"},
    "%YAML 1.2\n# note\n---\na: 1\n---\nb: [\n": {"a": 1},
    "a: 1\n...\nnonsense: [": {"a": 1},
    "a: &one {b: 1}\nc: *one\n": {"a": {"b": 1}, "c": {"b": 1}},
    "\ufeffa: 1\r\nb:\r\n  - 2\r\n": {"a": 1, "b": [2]},
    "y: 1.0\nn: 2.0\non: 3\n'null': 4\n": {"y": 1.0, "n": 2.0, "on": 3, "null": 4},
    "": None,
    "# nothing\n": None,
}


@pytest.mark.parametrize("text", STYLES)
def test_styles_of_configuration_files(text: str) -> None:
    assert plain(text) == STYLES[text]


def test_scalars_are_those_of_ros() -> None:
    words = (
        "y Y yes YES on On true TRUE n No off OFF false 12 -3 +4 0x1F 010 1. .5 5e-2 1e3 -.inf ~ null abc 1_000 1:30 08"
    )
    assert [resolved(each) for each in words.split()] == [
        *(8 * [True]),
        *(5 * [False]),
        *(12, -3, 4, 31, 8, 1.0, 0.5, 0.05, 1000.0, -math.inf, None, None, "abc", "1_000", "1:30", 8.0),
    ]
    assert math.isnan(resolved(".NaN"))
    assert plain("a: '1'\nb: \"yes\"\n") == {"a": "1", "b": "yes"}


# ---- what is refused -----------------------------------------------------------------------------

REFUSED = {
    "a: 1\na: 2\n": (2, "once"),
    "a:\n  b: {c: 1, c: 2}\n": (2, "once"),
    "a: 1\n b: 2\n": (2, "indented"),
    "a:\n\tb: 1\n": (2, "tabs"),
    "a: [1, 2\nb: 3\n": (2, "commas"),
    "a: [1, 2\n": (1, "close every bracket"),
    "a: 'x\n": (1, "close its quotes"),
    "a: b: c\n": (1, "one 'key: value'"),
    "a: !!float 1\n": (1, "no tags"),
    "a: *b\n": (1, "anchor"),
    "a: &b {c: 1}\nd:\n  <<: *b\n": (3, "merges"),
    "? a\n: b\n": (1, "plain keys"),
    "a: 'b' c\n": (1, "end after its value"),
    'a: "\\q"\n': (1, "escape"),
    "a: 1\n- 2\n": (2, "key: value"),
    "a: 1\nword\n": (2, "key: value"),
    "a: @b\n": (1, "quotes"),
    "[" * 100: (1, "deep"),
    "a: \x07\n": (1, "control"),
}


@pytest.mark.parametrize("text", REFUSED)
def test_what_is_no_yaml_names_line_and_rule(text: str) -> None:
    line, rule = REFUSED[text]
    with pytest.raises(FileError, match=re.escape(f"base.yaml, line {line}")) as caught:
        YamlDocument(text, "base.yaml")
    assert rule in str(caught.value)


def test_aliases_do_not_multiply_beyond_the_bound() -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 12)]
    began = time.monotonic()
    with pytest.raises(FileError, match="200000"):
        plain("\n".join(lines))
    assert time.monotonic() - began < 2.0


@pytest.mark.parametrize(
    "text",
    [
        "\r\n" * 50_000 + "--",
        " " * 500_000 + "x: 'a",
        "a: '" + " " * 300_000 + "'",
        'a: "' + "\\ " * 200_000,
        "a" * 10**6,
    ],
)
def test_odd_texts_take_no_time(text: str) -> None:
    began = time.monotonic()
    with contextlib.suppress(InvalidParameterError):
        plain(text)
    assert time.monotonic() - began < 3.0


def test_values_of_another_kind_name_their_place(tmp_path: Path) -> None:
    path = tmp_path / "nav2.yaml"
    path.write_text("a:\n  b: [1, x]\n  c: .nan\n  d: 'on'\n", encoding="utf-8")
    root = read_yaml(path).root
    for call, place in (
        (lambda: root["a"]["b"].numbers(), r"nav2\.yaml, line 2, a\.b\[1\] must be a number, got 'x'"),
        (lambda: root["a"]["c"].number(), r"nav2\.yaml, line 3, a\.c must be finite, got \.nan"),
        (lambda: root["a"]["d"].flag(), r"nav2\.yaml, line 4, a\.d must be true or false, got 'on'"),
        (lambda: root["a"]["e"], r"nav2\.yaml, line 2, a must hold e, got b, c, d"),
        (lambda: root["a"]["b"][7], r"nav2\.yaml, line 2, a\.b must"),
        (lambda: root["a"]["b"].numbers(3), "3 numbers"),
        (lambda: root["a"].numbers(), "be a list"),
        (lambda: root["a"]["b"].text(), "be text"),
        (lambda: root["a"]["b"].whole(), "whole number"),
    ):
        with pytest.raises(FileError, match=place if "3 num" not in place else "number"):
            call()


def test_encodings(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    for content in (
        "\ufeffa: ä\n".encode("utf-8"),
        b"\xff\xfe" + "a: ä\n".encode("utf-16-le"),
        b"\xfe\xff" + "a: ä\n".encode("utf-16-be"),
        "a: ä\n".encode("latin-1"),
    ):
        path.write_bytes(content)
        document = read_yaml(path)
        assert document.root.plain == {"a": "ä"}
        assert document.content == content
        assert [each.code for each in document.warnings] == (["assumed"] if content[:1] == b"a" else [])
        document.changed({("a",): "ö"}).write(path)
        assert read_yaml(path).root.plain == {"a": "ö"}
        assert path.read_bytes()[:3] == content[:3]
    with pytest.raises(InvalidParameterError, match="latin-1"):
        document.changed({("a",): "人"})


# ---- another reader ------------------------------------------------------------------------------


class _Oracle(yaml.SafeLoader):
    """Structure by PyYAML; words as ROS reads them, keys as text, no key twice."""

    yaml_implicit_resolvers: dict[str, Any] = {}  # noqa: RUF012  # of the class that it extends


def _scalar(_loader: yaml.SafeLoader, node: yaml.ScalarNode) -> Any:
    return resolved(node.value) if node.style is None else node.value


def _map(loader: yaml.SafeLoader, node: yaml.MappingNode) -> dict[str, Any]:
    found: dict[str, Any] = {}
    for key, value in node.value:
        if not isinstance(key, yaml.ScalarNode) or key.value in found or key.value == "<<":
            raise yaml.YAMLError("a key")
        found[key.value] = loader.construct_object(value, deep=True)
    return found


_Oracle.add_constructor("tag:yaml.org,2002:str", _scalar)
_Oracle.add_constructor("tag:yaml.org,2002:map", _map)

PIECES = [
    "a",
    "b: ",
    "- ",
    "\n",
    "\n  ",
    "\n    ",
    "[",
    "]",
    "{",
    "}",
    ", ",
    ": ",
    " # c",
    "'",
    '"',
    "&a ",
    "*a",
    "|\n",
]
PIECES += ["x y", "1", "-", ">-\n", "\\n", "''", "0x1f", "1.5e3", "\n- ", "\n  - ", "\r\n", "\n\n", "a: 1\n", "[1, 2]"]


@settings(max_examples=400, deadline=None)
@given(st.lists(st.sampled_from(PIECES), max_size=16).map("".join))
def test_what_is_read_is_what_pyyaml_reads(text: str) -> None:
    try:
        found = plain(text)
    except FileError:
        return
    try:
        other = yaml.load(text, Loader=_Oracle)
    except yaml.YAMLError:
        return  # where PyYAML wants more
    assert found == other


# ---- changes -------------------------------------------------------------------------------------

ODD = """# robot
base:   # kept
    radius:    0.22    # m, measured
    'shape' : "[[0.1, 0.2], [0.3, 0.4]]"   # corners
    points:
    - 0.1  # first
    - 0.2
    limits: { x: 0.5,  y: 0.0 }   # flow
    nothing:
    note: |
        lines
        of text
last: [1, 2,
       3]  # end
"""


def test_changes_keep_everything_else() -> None:
    document = YamlDocument(ODD)
    changed = document.changed(
        {
            ("base", "radius"): 0.3,
            ("base", "shape"): "[[1.0, 1.0]]",
            ("base", "points"): [0.5, 0.6],
            ("base", "limits", "y"): np.float64(1e-7),
            ("base", "limits", "z"): True,
            ("base", "nothing"): 7,
            ("base", "added"): {"a": [1, 2.5], "b: c": "yes"},
            ("last",): [4],
        }
    )
    assert changed.text == (
        ODD.replace("0.22", "0.3")
        .replace("[[0.1, 0.2], [0.3, 0.4]]", "[[1.0, 1.0]]")
        .replace("- 0.1", "- 0.5")
        .replace("- 0.2", "- 0.6")
        .replace("y: 0.0 }", "y: 1.0e-07 , z: true}")
        .replace("nothing:", "nothing: 7")
        .replace("of text\n", 'of text\n    added: {a: [1, 2.5], "b: c": "yes"}\n')
        .replace("[1, 2,\n       3]", "[4]")
    )
    assert changed.root.plain["base"]["added"] == {"a": [1, 2.5], "b: c": "yes"}
    assert document.text == ODD


def test_a_change_of_a_monitor_keeps_all_its_other_lines(shared: Path, tmp_path: Path) -> None:
    source = shared / "data" / "formats" / "cfg_collision_monitor.yaml"
    document = read_yaml(source)
    assert document.content == source.read_bytes()
    top = ("collision_monitor", "ros__parameters")
    new = "[[0.6, 0.3], [0.6, -0.3], [-0.3, -0.3], [-0.3, 0.3]]"
    changed = document.changed({(*top, "Stop", "points"): new, (*top, "source_timeout"): 0.15})
    changed.write(tmp_path / "cm.yaml")
    before, after = source.read_text(encoding="utf-8").splitlines(), (tmp_path / "cm.yaml").read_text(encoding="utf-8")
    lines = after.splitlines()
    assert len(lines) == len(before)
    assert [new for old, new in zip(before, lines, strict=True) if old != new] == [
        "    source_timeout: 0.15   # a comment that a round trip keeps",
        f'      points: "{new}"',
    ]


def test_a_list_of_another_length_is_written_in_brackets() -> None:
    for indent in ("", "  "):
        text = f"a:\n{indent}- 1\n{indent}- 2\nb: 3\n"
        changed = YamlDocument(text).changed({("a",): [1, 2, 3]})
        assert changed.root.plain == {"a": [1, 2, 3], "b": 3}
        assert changed.text.endswith("\nb: 3\n")


def test_changes_that_have_no_place_are_refused() -> None:
    document = YamlDocument("a: &one {b: 1}\nc: *one\nd: [1]\n", "base.yaml")
    for values in (
        {("c",): 1},
        {("c", "b"): 1},
        {("d", 3): 1},
        {("x", "y"): 1},
        {(): 1},
        {("a",): {"b": 2}, ("a", "b"): 3},
        {("a",): object()},
        {("a",): {1: 2}},
    ):
        with pytest.raises(InvalidParameterError):
            document.changed(values)


SCALARS = st.one_of(
    st.booleans(),
    st.none(),
    st.integers(),
    st.floats(allow_nan=False),
    st.text(st.characters(codec="utf-8"), max_size=8),
)
TREES = st.recursive(
    SCALARS,
    lambda inner: (
        st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=5, alphabet="abn: '#-y1~"), inner, max_size=4)
    ),
    max_leaves=12,
)


def places(value: Any, path: tuple[str | int, ...] = ()) -> list[tuple[str | int, ...]]:
    below = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    return [path, *(place for key, each in below for place in places(each, (*path, key)))]


@settings(max_examples=150, deadline=None)
@given(tree=TREES, new=TREES, flow=st.sampled_from([True, False, None]), data=st.data())
def test_what_is_written_is_read_again(tree: Any, new: Any, flow: bool | None, data: st.DataObject) -> None:
    whole = {"first": 1, "tree": tree, "last": "x"}
    text = yaml.safe_dump(whole, default_flow_style=flow, sort_keys=False, allow_unicode=True, width=1000)
    try:
        document = YamlDocument(text)
    except FileError as error:
        assume("merges" not in str(error) and "keys" not in str(error))
        raise
    path = data.draw(st.sampled_from(places(document.root.plain["tree"], ("tree",))))
    changed = document.changed({path: new})
    assert changed.at(path).plain == new
    first, last = re.escape(text[: text.index("first")]), text[text.rindex("last") :]
    assert re.match(first, changed.text)
    assert changed.text.endswith(last)
    assert changed.changed({path: document.at(path).plain}).root.plain == document.root.plain
