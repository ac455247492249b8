"""Documented causes of the differences between printed and measured values, from ``data/reasons.toml``."""

from __future__ import annotations

from fnmatch import fnmatchcase
from typing import NamedTuple

from hrsafety.reproduce import data

__all__ = ["CAUSES", "EXCHANGED_COLUMNS", "NOTES", "Cause", "cause_of", "note_of", "why_not_judged"]


class Cause(NamedTuple):
    """A text for the cells whose table, row and column match three shell-style patterns."""

    tables: str
    rows: str
    columns: str
    text: str


_DATA = data.table("reasons")
_TEXTS = _DATA["texts"]


def _listed(kind: str) -> tuple[Cause, ...]:
    found = []
    for entry in _DATA[kind]:
        tables, rows, columns = entry["where"]
        found.append(Cause(tables, rows, columns, entry.get("text") or _TEXTS[entry["shared"]]))
    return tuple(found)


CAUSES, NOTES = _listed("cause"), _listed("note")
"""Why cells differ, and what a reader must know about cells that agree; the first that fits is given."""
EXCHANGED_COLUMNS: str = _TEXTS["exchanged_columns"]


def _first(causes: tuple[Cause, ...], *place: str) -> str:
    for cause in causes:
        if all(fnmatchcase(name, pattern) for name, pattern in zip(place, cause[:3], strict=True)):
            return cause.text
    return ""


def cause_of(table: str, row: str, column: str) -> str:
    """Return why a cell differs; empty if no cause is known."""
    return _first(CAUSES, table, row, column)


def note_of(table: str, row: str, column: str) -> str:
    """Return what a reader must know about a cell even where it agrees; empty for most cells."""
    return _first(NOTES, table, row, column)


def why_not_judged(method: str, column: str) -> str:
    """Return why a value is shown beside the printed one without a verdict; empty if it is judged."""
    return str(_TEXTS["chatter"]) if method == "ge_cui" and not column.startswith("d_") else ""
