"""Headers of tables: what divides the cells, what each column means, and in which unit."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import NamedTuple

from hrsafety._words import meant
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.io.reader import Document

__all__ = [
    "DELIMITERS",
    "LENGTHS",
    "TIMES",
    "Header",
    "Meaning",
    "cells_of",
    "delimiter_of",
    "first_row",
    "header_of",
    "is_number",
]

DELIMITERS = {"\t": "tab", ";": ";", ",": ",", " ": "blank"}
"""Delimiters of cells, in the order in which they are tried, and their names."""
LENGTHS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "km": 1000.0}
TIMES = {"s": 1.0, "ms": 1e-3, "us": 1e-6, "µs": 1e-6, "ns": 1e-9}
_WORDS = {
    "sec": "s",
    "secs": "s",
    "second": "s",
    "seconds": "s",
    "sekunden": "s",
    "msec": "ms",
    "milliseconds": "ms",
    "meter": "m",
    "meters": "m",
    "metre": "m",
    "metres": "m",
    "px": "px",
    "pix": "px",
    "pixel": "px",
    "pixels": "px",
    "deg": "deg",
    "rad": "rad",
    "fps": "fps",
}
_UNIT = re.compile(
    r"^(?P<name>.*?)\s*(?:\[\s*(?P<a>[^\]]*)\s*\]|\(\s*(?:in\s+)?(?P<b>[^)]*)\s*\)|/\s*(?P<c>[^/\s]+)|\s+in\s+(?P<d>\S+)|_(?P<e>[^_\s\[\](/]+))$"
)
_SPEED = re.compile(r"^(?P<name>.*?)[\s_\[(]+(?P<unit>m|cm|mm|px)(?:/|_per_)s[\])]?$")
Roles = Mapping[str, Sequence[str]]


class Meaning(NamedTuple):
    """Meaning of the name of a column.

    Attributes
    ----------
    role : str
        Meaning, a key of the roles; empty if it has none.
    unit : str
        Unit in the name; empty without one.
    """

    role: str
    unit: str


class Header(NamedTuple):
    """Columns of a table.

    Attributes
    ----------
    names : list of str
        As they stand in the file.
    place : dict of str to int
        Column of each role that was found.
    unit : dict of str to str
        Unit of each role; empty without one.
    delimiter : str
        What divides the cells.
    skip : int
        Lines before the first row.
    """

    names: list[str]
    place: dict[str, int]
    unit: dict[str, str]
    delimiter: str
    skip: int


def is_number(text: str) -> bool:
    """Return whether a cell is a number, with either sign of decimals."""
    try:
        float(text.replace(",", ".") if text.count(",") == 1 else text)
    except ValueError:
        return False
    return "_" not in text


def first_row(document: Document) -> tuple[int, str]:
    """Return number, from 0, and text of the first line that is neither blank nor a comment; -1 if there is none."""
    for number, line in enumerate(document.first_lines):
        if line.strip() and not line.lstrip().startswith("#"):
            return number, line
    return -1, ""


def delimiter_of(line: str) -> str:
    """Return what divides the cells of a line."""
    unquoted = re.sub(r'"[^"]*"', "", line)
    return next((each for each in DELIMITERS if each != " " and each in unquoted), " ")


def cells_of(line: str, delimiter: str) -> list[str]:
    """Return the cells of a line, without blanks and quotes around them."""
    parts = re.findall(r'"[^"]*"|[^\s"]+', line) if delimiter == " " else _split(line, delimiter)
    return [part.strip().strip('"').strip() for part in parts]


def _split(line: str, delimiter: str) -> list[str]:
    return re.split(rf'{re.escape(delimiter)}(?=(?:[^"]*"[^"]*")*[^"]*$)', line)


def meaning_of(name: str, roles: Roles) -> Meaning:
    """Return role and unit of a name: ``"Zeit [s]"``, ``"x/cm"``, ``"t_ms"``."""
    plain = name.strip().lower()
    speed = _SPEED.match(plain)
    found = None if speed else _UNIT.match(plain)
    unit = ""
    if speed:
        plain, unit = speed["name"], f"{speed['unit']}/s"
    if found:
        told = next(part for part in found.groups()[1:] if part is not None).strip()
        told = _WORDS.get(told, told)
        bracketed = found["a"] is not None or found["b"] is not None
        if bracketed or told in LENGTHS or told in TIMES or told in _WORDS.values():
            plain, unit = found["name"], told
    key = re.sub(r"[\s_\-.#:]+", "", plain)
    role = next((role for role, names in roles.items() if key in names), "")
    return Meaning(role, unit)


def header_of(document: Document, roles: Roles, columns: object = None) -> Header | None:
    """Return the columns of a table with a header, or none if its first row holds numbers.

    Parameters
    ----------
    document : Document
        The file.
    roles : mapping of str to sequence of str
        Synonyms of each role, in small letters without blanks and underscores.
    columns : str, sequence of str, mapping or None
        Names instead of those of the file, of all columns or of some by the name in the file.

    Raises
    ------
    InvalidParameterError
        If names do not fit the columns of the file.
    FileError
        If two columns have one role (``ambiguous_columns``).
    """
    number, line = first_row(document)
    delimiter = delimiter_of(line)
    names = cells_of(line, delimiter)
    bare = bool(names) and sum(map(is_number, names)) > len(names) / 2
    given = _renamed(names, columns, bare)
    if bare and columns is None:
        given = _commented(document, number, delimiter, len(names))
        if not {"x", "y"} <= {meaning_of(name, roles).role for name in given}:
            return None
        names = given
    index: dict[str, int] = {}
    unit: dict[str, str] = {}
    for place, name in enumerate(given):
        role, found = meaning_of(name, roles)
        if not role:
            continue
        if role in index:
            both = Shown(f"{names[index[role]]!r} and {names[place]!r}" if not bare else f"{columns}")
            remedy = f'say which with columns={{"{names[place]}": "-"}}, which leaves one out'
            raise document.error("ambiguous_columns", f"have one column for {role}", both, remedy, line=number + 1)
        index[role], unit[role] = place, found
    return Header(names, index, unit, delimiter, number if bare else number + 1)


def _commented(document: Document, number: int, delimiter: str, count: int) -> list[str]:
    """Return the names in the last comment above the first row, if there are as many as it has cells."""
    above = [line.strip() for line in document.first_lines[:number] if line.strip()]
    names = cells_of(above[-1].lstrip("# \t"), delimiter) if above else []
    return names if len(names) == count else []


def _renamed(names: list[str], columns: object, bare: bool) -> list[str]:
    """Return the names of columns as the caller has them."""
    if columns is None:
        return names
    if isinstance(columns, Mapping):
        if bare:
            raise InvalidParameterError("columns", "name all columns of a file without a header", columns)
        for each in columns:
            if each not in names:
                rule = f"rename columns of the file, {', '.join(names[:12])}"
                raise InvalidParameterError("columns", rule, each, meant(str(each), names))
        return [str(columns.get(name, name)) for name in names]
    words = columns.replace(",", " ").split() if isinstance(columns, str) else columns
    if not isinstance(words, Sequence) or not all(isinstance(each, str) for each in words):
        raise InvalidParameterError("columns", 'be names of columns, as "id frame x y"', columns)
    if len(words) != len(names):
        raise InvalidParameterError("columns", f"name the {len(names)} columns of the file", columns)
    return list(words)
