"""Values of a YAML file with their places, and what ROS reads a plain word as."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Iterator
from typing import Any

from hrsafety.errors import FileError, Shown

__all__ = ["BREAK", "Key", "Node", "Path", "YamlText", "key_path", "resolved"]

BREAK = r"(?>\r\n|\r|\n)"
"""Pattern of the end of a line."""
LONGEST_SHOWN = 60
Key = str | int
Path = tuple[Key, ...]

_TRUE = {"y", "Y", "yes", "Yes", "YES", "true", "True", "TRUE", "on", "On", "ON"}
_FALSE = {"n", "N", "no", "No", "NO", "false", "False", "FALSE", "off", "Off", "OFF"}
_NULL = {"", "~", "null", "Null", "NULL"}
_INTEGER = re.compile(r"[-+]?(?:0[xX][0-9a-fA-F]+|0[0-7]*|[1-9][0-9]*)")
_FLOAT = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
_NOT_FINITE = re.compile(r"([-+]?)\.?(?:(inf)(?:inity)?|nan)", re.IGNORECASE)


def resolved(text: str) -> Any:
    """Return the value of a plain scalar as ROS reads it: truth value, integer (0x and 0 lead), float, None, text."""
    if text in _NULL:
        return None
    if text in _TRUE or text in _FALSE:
        return text in _TRUE
    if len(text) <= 400:
        if _INTEGER.fullmatch(text):
            digits = text.lstrip("+-")
            base = 16 if digits[:2] in ("0x", "0X") else 8 if digits[0] == "0" else 10
            return int(digits, base) * (-1 if text[0] == "-" else 1)
        if _FLOAT.fullmatch(text):
            return float(text)
        if match := _NOT_FINITE.fullmatch(text):
            return float(f"{match[1]}inf" if match[2] else "nan")
    return text


class YamlText:
    """Text of a YAML file, and how its places are named in errors.

    Attributes
    ----------
    name : str
        Of the file.
    text : str
        As decoded, line breaks as they are.
    """

    def __init__(self, name: str, text: str) -> None:
        self.name = name
        self.text = text
        self._lines = [0, *(match.end() for match in re.finditer(BREAK, text))]

    def line(self, at: int) -> int:
        """Return the number of the line of a place, from 1."""
        return bisect_right(self._lines, at)

    def line_start(self, at: int) -> int:
        """Return where the line of a place begins."""
        start = self._lines[self.line(at) - 1]
        return start + (start == 0 and self.text.startswith("\ufeff"))

    def error(self, at: int, requirement: str, remedy: str | None = None) -> FileError:
        """Return an error of grammar at a place."""
        rest = re.match(r"[^\r\n]*", self.text[at : at + LONGEST_SHOWN])
        shown = Shown(repr(rest[0]) if rest and rest[0].strip() else "the end of the line")
        return FileError(f"{self.name}, line {self.line(at)}", requirement, shown, remedy, code="yaml")


def key_path(path: Path) -> str:
    """Return keys and indices as errors name them: ``agents[2].goals``."""
    return "".join(f"[{each}]" if isinstance(each, int) else f".{each}" for each in path).lstrip(".")


class Node:
    """Value in a YAML file, with its place.

    Attributes
    ----------
    source : YamlText
        Text in which it stands.
    path : tuple of str or int
        Keys and indices that lead to it.
    value : dict of str to Node, list of Node, bool, int, float, str or None
        What stands there; keys are always text.
    text : str
        Scalar without quotes, before numbers and truth values are told from text.
    quoted : bool
        Whether the scalar stands in quotes, which makes it text.
    start, stop : int
        Its characters in the text.
    alias : bool
        Whether it was reached by the name of an anchor, and stands elsewhere.
    """

    __slots__ = ("alias", "path", "quoted", "size", "source", "start", "stop", "text", "value")

    def __init__(self, source: YamlText, path: Path, start: int) -> None:
        self.source, self.path, self.start, self.stop = source, path, start, start
        self.value: dict[str, Node] | list[Node] | bool | float | str | None = None
        self.text, self.quoted, self.alias, self.size = "", False, False, 1

    @property
    def flow(self) -> bool:
        """Whether the node is a map or list in brackets."""
        return self.source.text[self.start : self.start + 1] in ("{", "[") and not isinstance(self.value, str)

    def children(self) -> Iterator[Node]:
        """Yield the values of a map or list."""
        if isinstance(self.value, dict):
            yield from self.value.values()
        elif isinstance(self.value, list):
            yield from self.value
