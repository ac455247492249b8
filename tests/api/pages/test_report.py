"""One report: the same facts, tables and verdict on the terminal, in JSON and on the page."""

from __future__ import annotations

import json
import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

pytest.importorskip("jinja2")

from api.browsers import tab
from hrsafety import pages
from hrsafety._words import some
from hrsafety.cli import main, terminal
from hrsafety.pages.report import Report, ReportCell, ReportTable, Section, json_text
from hrsafety.plausibility import ResultWarning

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
DOUBT = ResultWarning("edge", "covering.radius", "an edge <b>")
TABLE = ReportTable(
    headers=(("region", "speed"), ("", "m/s")),
    rows=[("chest", ReportCell("0.1 !", "bad", "-3 %")), ("hand", 0.25), ("face", "-")],
    most=2,
    summary="All 3 regions",
    more="and 1 more",
    printed=True,
)


def report(**more: Any) -> Report:
    values: dict[str, Any] = {
        "title": "A <cell>",
        "facts": [("cell", "cell.toml"), ("limits", "ISO")],
        "said": "within limits",
        "sections": [Section("contacts", [TABLE, "One paragraph.", "two\nlines"])],
        "values": {"speed": np.array([0.1, math.inf]), "count": np.int64(3)},
    }
    return Report(**(values | more))


def test_terminal_shows_facts_and_printed_tables() -> None:
    assert terminal.told(report()).splitlines() == [
        "cell           cell.toml",
        "limits         ISO",
        "",
        "region  speed",
        "          m/s",
        "------  -----",
        "chest   0.1 !",
        "hand     0.25",
        "and 1 more",
    ]
    assert terminal.told(report(facts=[], sections=[Section("", ["words"])])) == ""


def test_page_shows_everything_escaped_with_looks_and_folded_rows() -> None:
    html = re.sub(r"\s+", " ", report(warnings=[DOUBT]).page())
    assert "<title>A &lt;cell&gt;</title>" in html
    assert "<h2>Contacts</h2>" in html
    assert '<td class="bad">0.1 ! <small>(-3 %)</small></td>' in html
    assert '<th scope="col">speed (m/s)</th>' in html
    assert html.count('<th scope="row">face</th>') == 1  # in the folded table only
    assert "<summary>All 3 regions</summary>" in html
    assert "<p>One paragraph.</p>" in html
    assert "<pre>two" in html
    assert "an edge &lt;b&gt;" in html


@pytest.mark.parametrize(
    ("good", "warnings", "look"),
    [
        (True, [], 'class="banner"'),
        (True, [DOUBT], 'class="banner unsure"'),
        (True, [ResultWarning("edge", "x", "careful", safe_side=True)], 'class="banner"'),
        (False, [DOUBT], 'class="banner no"'),
    ],
)
def test_doubts_that_may_be_unsafe_make_a_good_verdict_unsure(
    good: bool, warnings: list[ResultWarning], look: str
) -> None:
    html = report(good=good, warnings=warnings).page()
    assert f"<div {look}><strong>Within limits.</strong>" in re.sub(r"\s+<strong>", "<strong>", html)


def test_json_has_every_value_and_warning_and_no_number_that_is_none() -> None:
    found = json.loads(report(warnings=[DOUBT, DOUBT]).json())
    assert found == {"title": "A <cell>", "speed": [0.1, None], "count": 3, "warnings": [DOUBT.message]}


def test_json_without_values_by_name_is_what_the_terminal_shows() -> None:
    found = json.loads(report(values={}, source="cell.toml", warnings=[DOUBT]).json())
    assert found["facts"] == {"cell": "cell.toml", "limits": "ISO"}
    assert (found["verdict"], found["source"], found["warnings"]) == ("within limits", "cell.toml", [DOUBT.message])
    (table,) = found["tables"]
    assert table["columns"] == ["region", "speed (m/s)"]
    assert table["rows"] == [["chest", "0.1 !"], ["hand", 0.25], ["face", "-"]]


COMMANDS = {
    "simulate": ["simulate", str(EXAMPLES / "my_first_crossing.toml")],
    "foam": ["foam", str(EXAMPLES / "foam_design.toml"), "--out", "out"],
    "arm": ["arm", str(EXAMPLES / "cell_arm.urdf"), "--out", "out"],
    "contact": ["contact", "cell.toml", "--out", "out"],
}


@pytest.mark.parametrize("name", COMMANDS)
def test_every_command_gives_its_report_as_json(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib")
    monkeypatch.chdir(tmp_path)
    assert main(["init", "contact", "cell.toml"]) == 0
    file = tmp_path / "kept" / "report.json"
    main([*COMMANDS[name], "--json", str(file)])
    captured = capsys.readouterr()
    assert f"wrote {file}" in captured.out
    found = json.loads(file.read_text(encoding="utf-8"))
    assert found["title"]
    assert len(found["warnings"]) == len({line for line in captured.err.splitlines() if "warning: " in line})
    if name != "contact":
        assert all(f"{fact:<15}{words}" in captured.out for fact, words in found["facts"].items())
    assert main([*COMMANDS[name], "--json", str(tmp_path)]) == 2
    assert "--json must name a file" in capsys.readouterr().err


def test_no_command_renders_by_itself() -> None:
    folder = Path(pages.__file__).parents[1] / "cli"
    texts = {path.name: path.read_text(encoding="utf-8") for path in folder.rglob("*.py")}
    assert not [name for name, text in texts.items() if "import written" in text]
    assert {path.name for path in (folder.parent / "pages" / "templates").glob("*.html")} == {
        *("base.html", "parts.html", "report.html", "cell.html", "program.html")
    }


VALUES = st.recursive(
    st.none() | st.booleans() | st.integers(-(2**60), 2**60) | st.floats() | st.text(max_size=5),
    lambda inner: st.lists(inner, max_size=3) | st.dictionaries(st.text(max_size=5), inner, max_size=3),
    max_leaves=12,
)


@given(st.dictionaries(st.text(max_size=5), VALUES, max_size=4))
def test_json_reads_back_as_it_was_but_for_what_is_not_finite(values: dict[str, Any]) -> None:
    def plain(value: Any) -> Any:
        if isinstance(value, dict):
            return {name: plain(each) for name, each in value.items()}
        if isinstance(value, list):
            return [plain(each) for each in value]
        return None if isinstance(value, float) and not math.isfinite(value) else value

    assert json.loads(json_text(values)) == plain(values)


def test_no_zero_has_a_sign_and_one_is_no_plural() -> None:
    rows = [("-0.00", ReportCell("-0.000", "bad"), "-0.001", "1-0", "2e-0", "(-0.0, -0)")]
    table = ReportTable(headers=(("a", "b", "c", "d", "e", "f"),), rows=rows, printed=True)
    made = report(facts=[("gap", "-0.000 m")], sections=[Section("", [table, "from -0.0 to -0.5 m"])])
    told = terminal.told(made).splitlines()
    assert told[0].split() == ["gap", "0.000", "m"]
    assert told[-1].split() == ["0.00", "0.000", "-0.001", "1-0", "2e-0", "(0.0,", "0)"]
    page = made.page()
    assert "from 0.0 to -0.5 m" in page
    assert ">0.000</td>" in page
    assert "-0.000" not in page
    assert [some(count, "zone") for count in (0, 1, 2)] == ["0 zones", "1 zone", "2 zones"]
    assert some(1, "person", "people") == "1 person"
    assert some(1200, "row", form=",") == "1,200 rows"


@pytest.mark.parametrize(
    ("value", "spec", "words"),
    [
        (-1e-4, ".3f", "0.000"),
        (-1e-4, "+.3f", "0.000"),
        (-0.0, ".4g", "0"),
        (-0.01, ".2f", "-0.01"),
        (-1e-9, ".2g", "-1e-09"),
    ],
)
def test_numbers_of_pages_that_are_zero_have_no_sign(value: float, spec: str, words: str) -> None:
    assert pages.shown(value, spec) == words
    assert "<strong>0.0 m left.</strong>" in report(said="-0.0 m left").page()


def test_the_verdict_stands_above_the_warnings() -> None:
    page = report(warnings=[DOUBT]).page()
    assert page.index("Within limits") < page.index("an edge")


def test_rows_of_wide_tables_are_cards_on_a_narrow_screen(tmp_path: Path) -> None:
    names = tuple(f"a long title {index}" for index in range(11))
    table = ReportTable(headers=(names,), rows=[tuple(f"{index}.000" for index in range(11))])
    place = tmp_path / "page.html"
    place.write_text(report(sections=[Section("", [table])]).page(), encoding="utf-8")
    size = "(() => { const t = document.querySelector('table.cards'); return [t.scrollWidth, innerWidth]; })()"
    with tab(420, 900) as opened:
        opened.open(place.as_uri(), state=None)
        width, whole = opened.value(size)
    assert whole == 420
    assert width <= whole
