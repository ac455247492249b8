"""YAML files that robots are configured with: read without a library, changed with everything else kept."""

from __future__ import annotations

import codecs
import itertools
import json
import math
import re
from collections.abc import Iterable, Iterator, Mapping
from os import PathLike
from pathlib import Path as File
from typing import Any

import numpy as np

from hrsafety._arguments import instance, meant
from hrsafety._atomic import write_file
from hrsafety._text import decoded, read_bytes
from hrsafety._yaml.nodes import Key, Node, Path, YamlText, key_path, resolved
from hrsafety._yaml.syntax import parsed
from hrsafety.errors import FileError, InvalidParameterError, Shown
from hrsafety.plausibility import ResultWarning

__all__ = ["YamlDocument", "YamlSection", "read_yaml"]

LARGEST = 1e300
"""Numbers are smaller: squares of larger ones are not finite."""
_MARKS = ((codecs.BOM_UTF8, "utf-8"), (codecs.BOM_UTF16_LE, "utf-16-le"), (codecs.BOM_UTF16_BE, "utf-16-be"))


class YamlSection:
    """Value in a YAML file that knows its keys, its file and its line.

    Maps are looked into with ``section["key"]``, lists with ``section[0]``; what is not there, or is of another
    kind, is an error that names the keys, the file and the line.

    Parameters
    ----------
    node : Node
        The value with its place.

    Examples
    --------
    >>> from hrsafety._yaml.documents import YamlDocument
    >>> robot = YamlDocument("robot: {radius: 0.22, name: base}  # by hand").root["robot"]
    >>> robot["radius"].number(), robot["name"].text(), robot.get("mass") is None
    (0.22, 'base', True)
    """

    __slots__ = ("_node",)

    def __init__(self, node: Node) -> None:
        self._node = node

    @property
    def path(self) -> Path:
        """Keys and indices that lead to it."""
        return self._node.path

    @property
    def line(self) -> int:
        """Number of its line, from 1."""
        return self._node.source.line(self._node.start)

    @property
    def place(self) -> str:
        """File, line and keys, as errors name them."""
        where = f"{self._node.source.name}, line {self.line}"
        return f"{where}, {key_path(self.path)}" if self.path else where

    @property
    def is_map(self) -> bool:
        """Whether the value is a map of keys and values."""
        return isinstance(self._node.value, dict)

    @property
    def is_list(self) -> bool:
        """Whether the value is a list."""
        return isinstance(self._node.value, list)

    @property
    def plain(self) -> Any:
        """Its value in dicts, lists, numbers, truth values, text and None."""
        value = self._node.value
        if isinstance(value, dict):
            return {key: YamlSection(each).plain for key, each in value.items()}
        if isinstance(value, list):
            return [YamlSection(each).plain for each in value]
        return value

    def error(self, requirement: str, remedy: str | None = None, *, code: str = "unreadable") -> FileError:
        """Return the error of a value that breaks a rule.

        Parameters
        ----------
        requirement : str
            The rule, as ``"be positive"``.
        remedy : str or None
            What would mend it.
        code : str
            Kind of error, for programs.

        Returns
        -------
        FileError
            Names file, line, keys and value.
        """
        node = self._node
        if isinstance(node.value, (dict, list)):
            kind = "a map" if isinstance(node.value, dict) else "a list"
            value: object = self.plain if node.size < 20 else Shown(f"{kind} of {len(node.value)} values")
        else:
            value = node.value if isinstance(node.value, str) else Shown(node.text[:200])
        value = Shown("nothing") if node.value is None and not node.text else value
        return FileError(self.place, requirement, value, remedy, code=code)

    # ---- maps and lists --------------------------------------------------------------------------

    def get(self, key: Key) -> YamlSection | None:
        """Return what stands under a key or index, ``None`` if nothing does; what is no map has no keys."""
        value = self._node.value
        if isinstance(value, dict) and key in value:
            return YamlSection(value[str(key)])
        if isinstance(value, list) and isinstance(key, int) and 0 <= key < len(value):
            return YamlSection(value[key])
        return None

    def __contains__(self, key: Key) -> bool:
        """Return whether something stands under a key."""
        return self.get(key) is not None

    def __getitem__(self, key: Key) -> YamlSection:
        """Return what stands under a key or index, which has to be there."""
        found = self.get(key)
        if found is None:
            held = self._node.value
            if isinstance(held, dict):
                shown = Shown(", ".join(list(held)[:20]) or "nothing")
                remedy = meant(str(key), list(held))
                raise FileError(self.place, f"hold {key}", shown, remedy, code="missing_key")
            raise self.error(f"be a {'map' if isinstance(key, str) else 'list'} that holds {key}", code="missing_key")
        return found

    def keys(self) -> tuple[str, ...]:
        """Return the keys of a map in their order; of nothing, none."""
        value = self._node.value
        if value is None:
            return ()
        if not isinstance(value, dict):
            raise self.error("be a map of keys and values")
        return tuple(value)

    def __iter__(self) -> Iterator[str]:
        """Return the keys of a map one after the other."""
        return iter(self.keys())

    def values(self) -> list[YamlSection]:
        """Return the values of a list, which it has to be."""
        if not isinstance(self._node.value, list):
            raise self.error("be a list")
        return [YamlSection(each) for each in self._node.value]

    # ---- scalars ---------------------------------------------------------------------------------

    def unquoted(self) -> YamlSection:
        """Return a scalar as if it stood there without its quotes, which some readers of YAML do not look at."""
        node = self._node
        if not node.quoted or isinstance(node.value, (dict, list)):
            return self
        other = Node(node.source, node.path, node.start)
        other.text, other.value = node.text, resolved(node.text)
        return YamlSection(other)

    def number(self) -> float:
        """Return a finite number."""
        value = self._node.value
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.error("be a number")
        if not abs(value) < LARGEST:
            raise self.error("be finite")
        return float(value)

    def numbers(self, count: int | None = None) -> list[float]:
        """Return a list of finite numbers, of so many if told."""
        found = [each.number() for each in self.values()]
        if count is not None and len(found) != count:
            raise self.error(f"be {count} numbers")
        return found

    def whole(self) -> int:
        """Return a whole number."""
        value = self._node.value
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.error("be a whole number")
        return value

    def flag(self) -> bool:
        """Return a truth value; ROS reads yes, on and y as true, too."""
        if not isinstance(self._node.value, bool):
            raise self.error("be true or false")
        return self._node.value

    def text(self) -> str:
        """Return text: what stands in quotes, or any other scalar as it is written."""
        node = self._node
        if node.value is None or isinstance(node.value, (dict, list)):
            raise self.error("be text")
        return node.text

    def texts(self) -> list[str]:
        """Return a list of texts."""
        return [each.text() for each in self.values()]


class YamlDocument:
    r"""First document of a YAML file, of which values can be changed with all else kept byte for byte.

    Block and flow maps and lists, plain, quoted and block scalars, comments, anchors and aliases are read; truth
    values and numbers are those that ROS reads, keys are text. Tags, merges and keys that are no words are refused.

    Parameters
    ----------
    text : str
        The file's text.
    name : str
        Its name, for errors.
    warnings : sequence of ResultWarning
        What was assumed of its encoding.

    Attributes
    ----------
    root : YamlSection
        What the document holds.
    warnings : tuple of ResultWarning
        As given.

    Raises
    ------
    FileError
        If a line breaks a rule of YAML, a key stands twice, or it is nested deeper than 64 or longer than 200,000
        values; the error names file and line.

    Examples
    --------
    >>> from hrsafety._yaml.documents import YamlDocument
    >>> document = YamlDocument("stop:  # polygon\n  points: [0.4, 0.3]\n  enabled: on\n")
    >>> document.root["stop"]["points"].numbers(), document.root["stop"].plain["enabled"]
    ([0.4, 0.3], True)
    >>> print(document.changed({("stop", "points"): [0.5, 0.3], ("stop", "radius"): 1.0}).text)
    stop:  # polygon
      points: [0.5, 0.3]
      enabled: on
      radius: 1.0
    <BLANKLINE>
    """

    __slots__ = ("_encoding", "_mark", "_source", "root", "warnings")

    def __init__(self, text: str, name: str = "the text", warnings: Iterable[ResultWarning] = ()) -> None:
        self._source = YamlText(name, text)
        self._encoding, self._mark = "utf-8", b""
        self.warnings = tuple(warnings)
        self.root = YamlSection(parsed(self._source))

    @property
    def text(self) -> str:
        """The file's text."""
        return self._source.text

    @property
    def content(self) -> bytes:
        """The file's bytes, in the encoding in which it was read."""
        return self._mark + self.text.encode(self._encoding)

    def at(self, path: Iterable[Key]) -> YamlSection:
        """Return what stands under keys below each other, which have to be there."""
        found = self.root
        for key in path:
            found = found[key]
        return found

    def changed(self, values: Mapping[tuple[Key, ...], Any]) -> YamlDocument:
        """Return the document with some values changed, or added to maps that exist.

        Parameters
        ----------
        values : mapping of tuple to object
            New values (numbers, truth values, text, None, lists and maps of them) by keys and indices below each other.
            A list of as many values as the old one is changed value by value, so that its lines and comments stay.

        Returns
        -------
        YamlDocument
            All else is as it was: comments, order, quotes, line breaks, further documents.

        Raises
        ------
        InvalidParameterError
            If the keys lead nowhere, a value stands under an anchor or alias, or cannot be written.

        Examples
        --------
        >>> from hrsafety._yaml.documents import YamlDocument
        >>> print(YamlDocument("limit: 0.5  # m/s").changed({("limit",): 0.3}).text)
        limit: 0.3  # m/s
        """
        edits: list[tuple[int, int, str]] = []
        for path, value in values.items():
            if not isinstance(path, tuple) or not path:
                raise InvalidParameterError("values", "have keys below each other as their names", path)
            above = self.root
            for key in path[:-1]:
                above = _own(above)[key]
            old = above.get(path[-1])
            _own(above)
            edits += [_addition(above, path[-1], value)] if old is None else _replacements(old, value)
        text = self.text
        edits.sort()
        for before, after in itertools.pairwise(edits):
            if after[0] < before[1]:
                raise InvalidParameterError("values", "be apart from each other", Shown("a value within another"))
        for start, stop, new in reversed(edits):
            text = text[:start] + new + text[stop:]
        try:
            text.encode(self._encoding)
        except UnicodeEncodeError as error:
            shown = Shown(repr(text[error.start]))
            raise InvalidParameterError("values", f"be text that {self._encoding} can hold", shown) from None
        found = YamlDocument(text, self._source.name, self.warnings)
        found._encoding, found._mark = self._encoding, self._mark
        return found

    def write(self, path: str | PathLike[str]) -> None:
        """Write the document in one step.

        Parameters
        ----------
        path : path
            Where.

        Raises
        ------
        OSError
            If it cannot be written; an older file stays as it was.
        """
        write_file(File(path), self.content)


def read_yaml(path: str | PathLike[str]) -> YamlDocument:
    r"""Return the first document of a YAML file.

    Parameters
    ----------
    path : path
        Of a file of at most 4 MiB in UTF-8, UTF-16 with a byte order mark, or Latin-1.

    Returns
    -------
    YamlDocument
        Its values with their places.

    Raises
    ------
    InvalidParameterError
        If there is no such file.
    FileError
        If it breaks a rule; the error names file, line and rule.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety._yaml.documents import read_yaml
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "map.yaml")
    ...     _ = path.write_text("resolution: 0.05\norigin: [0, 0, 0.0]\n")
    ...     read_yaml(path).root.plain
    {'resolution': 0.05, 'origin': [0, 0, 0.0]}
    """
    data = read_bytes(path)
    text, warnings = decoded(data, File(path).name)
    found = YamlDocument(text, File(path).name, warnings)
    encoding = "latin-1" if warnings else "utf-8"
    for mark, each in _MARKS:
        if data.startswith(mark):
            found._mark, encoding = mark, each
    found._encoding = encoding
    return found


# ---- changes ---------------------------------------------------------------------------------------


def _replacements(old: YamlSection, value: Any) -> list[tuple[int, int, str]]:
    """Return edits of the text that give a value its new content."""
    node = _own(old)._node
    value = _simple(old.place, value)
    if isinstance(value, list) and isinstance(node.value, list) and len(value) == len(node.value) > 0:
        return [edit for each, new in zip(old.values(), value, strict=True) for edit in _replacements(each, new)]
    quote = node.source.text[node.start] if node.quoted else ""
    new = _written(value, quote)
    if node.start == node.stop:  # nothing stood there
        return [(node.start, node.stop, f" {new}")]
    source = node.source.text
    block = isinstance(node.value, (dict, list)) and not node.flow
    if block or quote in ("|", ">"):
        line = source[node.source.line_start(node.start) : node.start]
        new = f" {new}" if not line.strip() else new
    return [(node.start, node.stop, new)]


def _own(section: YamlSection) -> YamlSection:
    """Return a value that stands where it was looked for."""
    if section._node.alias:
        raise section.error("stand here, not under the name of an anchor", "change it there")
    return section


def _addition(above: YamlSection, key: Key, value: Any) -> tuple[int, int, str]:
    """Return the edit that adds a key to a map."""
    node = above._node
    if not isinstance(node.value, dict) or not isinstance(key, str):
        raise above.error(f"be a map to which {key!r} can be added")
    new = f"{_written(key, '')}: {_written(_simple(f'{key} of {above.place}', value), '')}"
    source = node.source.text
    if node.flow:
        inside = source[node.start + 1 : node.stop - 1]
        comma = "" if not inside.strip() or inside.rstrip().endswith(",") else ", "
        return node.stop - 1, node.stop - 1, f"{comma}{new}"
    column = node.start - node.source.line_start(node.start)
    end = re.compile(r"[^\r\n]*").match(source, node.stop)
    stop = node.stop if end is None else end.end()
    found = re.search(r"\r\n|\r|\n", source)
    line_break = found[0] if found else "\n"
    return stop, stop, f"{line_break}{' ' * column}{new}"


def _simple(name: str, value: Any) -> Any:
    """Return a value in Python's own lists, maps and numbers."""
    if isinstance(value, Mapping):
        return {instance(f"key of {name}", key, str): _simple(name, each) for key, each in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, (list, tuple)):
        return [_simple(name, each) for each in value]
    if value is not None and not isinstance(value, (bool, int, float, str)):
        raise InvalidParameterError(name, "be numbers, truth values, text, lists or maps", value)
    return value


def _written(value: Any, quote: str) -> str:
    """Return a value in flow style; text has the quotes that stood there, or those it needs."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{_written(key, '')}: {_written(each, '')}" for key, each in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(_written(each, "") for each in value) + "]"
    if value is None or isinstance(value, bool):
        return "null" if value is None else str(value).lower()
    if isinstance(value, float):
        if not math.isfinite(value):
            return ".nan" if math.isnan(value) else f"{'-' if value < 0 else ''}.inf"
        return re.sub(r"^([-+]?\d+)e", r"\1.0e", repr(value))
    if isinstance(value, int):
        return str(value)
    if quote == "'" and re.fullmatch(r"[^\x00-\x1f\x7f]*", value):
        return str("'" + value.replace("'", "''") + "'")
    plain = not quote and re.fullmatch(r"[A-Za-z_/.][\w/.\-]*", value, re.ASCII) and resolved(value) == value
    text = str(value)
    return text if plain else json.dumps(text, ensure_ascii=False).replace("\x7f", "\\x7f")
