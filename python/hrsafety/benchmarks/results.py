"""Results of a benchmark: one row an episode, shares with intervals, a table as text and CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

from hrsafety._statistics import Share, wilson
from hrsafety.errors import InvalidParameterError

__all__ = ["Result", "Row", "read_rows", "row_text"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """One episode.

    Parameters
    ----------
    case : int
        Its number.
    outcome : str
        How it ended.
    arrival_time, end_time : float
        In s; NaN without arrival.
    contacts, at_fault : int
        People touched, and how many of them at fault.
    clearance : float
        Least distance of the surfaces in m; of the adversary suite while the robot moved toward somebody.
    """

    case: int
    outcome: str
    arrival_time: float
    end_time: float
    contacts: int
    at_fault: int
    clearance: float


NAMES = tuple(each.name for each in fields(Row))
_WHOLE = ("case", "contacts", "at_fault")


def row_text(rows: Iterable[Row], *, head: bool) -> str:
    """Return rows as CSV."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    if head:
        writer.writerow(NAMES)
    writer.writerows([getattr(row, name) for name in NAMES] for row in rows)
    return text.getvalue()


def read_rows(path: Path) -> list[Row]:
    """Return the rows of a file that was written before; a line that was cut off is left out."""
    if not path.exists():
        return []
    text = path.read_text(encoding="utf-8")
    lines = list(csv.reader(text[: text.rfind("\n") + 1].splitlines()))
    if not lines:
        return []
    if tuple(lines[0]) != NAMES:
        raise InvalidParameterError("out", f"hold rows of this benchmark ({', '.join(NAMES)})", str(path))
    rows = []
    for line in lines[1:]:
        if len(line) != len(NAMES):
            continue
        value = dict(zip(NAMES, line, strict=True))
        rows.append(
            Row(
                case=int(value["case"]),
                outcome=value["outcome"],
                arrival_time=float(value["arrival_time"]),
                end_time=float(value["end_time"]),
                contacts=int(value["contacts"]),
                at_fault=int(value["at_fault"]),
                clearance=float(value["clearance"]),
            )
        )
    return rows


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """Episodes of a suite by entry.

    Parameters
    ----------
    suite : str
        The suite.
    rows : mapping of str to sequence of Row
        Episodes of every entry.
    """

    suite: str
    rows: Mapping[str, Sequence[Row]]

    def success(self, name: str) -> Share:
        """Return the share of episodes that arrived without a contact, with its 95 % Wilson interval."""
        rows = self.rows[name]
        return wilson(sum(row.outcome == "arrived" for row in rows), len(rows))

    def contact(self, name: str) -> Share:
        """Return the share with a contact."""
        rows = self.rows[name]
        return wilson(sum(row.contacts > 0 for row in rows), len(rows))

    def at_fault(self, name: str) -> Share:
        """Return the share with a contact at fault."""
        rows = self.rows[name]
        return wilson(sum(row.at_fault > 0 for row in rows), len(rows))

    def mean_arrival(self, name: str) -> float:
        """Return the mean arrival time in s; NaN without arrivals."""
        times = [row.arrival_time for row in self.rows[name] if not math.isnan(row.arrival_time)]
        return math.fsum(times) / len(times) if times else math.nan

    def failures(self, name: str, most: int = 3) -> list[int]:
        """Return the first episodes that did not succeed."""
        return [row.case for row in self.rows[name] if row.outcome != "arrived"][:most]

    def cells(self) -> list[tuple[str, ...]]:
        """Return the table, a row an entry, with shares in percent."""
        return [
            (
                name,
                str(len(self.rows[name])),
                *(_percent(share(name)) for share in (self.success, self.contact, self.at_fault)),
                "" if math.isnan(self.mean_arrival(name)) else f"{self.mean_arrival(name):.2f}",
            )
            for name in self.rows
        ]


HEAD = ("law", "episodes", "success %", "contact %", "at fault %", "arrival s")
"""Titles of the table."""


def _percent(share: Share) -> str:
    return f"{100 * share.value:.1f} ({100 * share.low:.1f} to {100 * share.high:.1f})"
