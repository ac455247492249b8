"""Names of rows and columns of the published tables as a reader knows them, and where pictures stand."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from fnmatch import fnmatchcase
from html import escape

from hrsafety.pages import Picture
from hrsafety.reproduce import data

__all__ = ["GAIN_LABELS", "TABLE_TITLES", "beside", "beside_none", "column_label", "row_label"]

_NAMES = data.table("names")
GAIN_LABELS: Mapping[str, str] = _NAMES["gains"]
"""Gain sets; the star marks the optimized ones, as in the source."""
TABLE_TITLES: Mapping[str, str] = _NAMES["tables"]
"""Subject of each published table, in HTML."""


def row_label(row: str) -> str:
    """Return the name of a row: a key of the published tables, or a change in percent."""
    return str((_NAMES["gains"] | _NAMES["rows"]).get(row, row))


def column_label(column: str, unit: str = "") -> str:
    """Return the name of a column in HTML, with its unit if it has one."""
    match = re.fullmatch(r"((?:T|L|d|outcome).*?)_([123])", column)
    stem, where = (match[1], f", c{match[2]}") if match else (column, "")
    plain = escape(stem, quote=False)
    name = _NAMES["columns"].get(stem) or re.sub(r"_(\d|max|[a-z]{1,2}(?:,max)?)\b", r"<sub>\1</sub>", plain)
    name = re.sub(r"\beps(?=<)", "&epsilon;", name) + where
    return f"{name} ({unit})" if unit not in {"", "1"} else name


def beside(table: str, pictures: Iterable[Picture]) -> list[Picture]:
    """Return the pictures that stand beside a table; each belongs to the first table that names it."""
    return [each for each in pictures if _place(each) == table]


def beside_none(tables: Sequence[str], pictures: Iterable[Picture]) -> list[Picture]:
    """Return the pictures that stand beside none of some tables."""
    return [each for each in pictures if _place(each) not in tables]


def _place(picture: Picture) -> str | None:
    for table, patterns in _NAMES["pictures"].items():
        if any(fnmatchcase(picture.name, pattern) for pattern in patterns):
            return str(table)
    return None
