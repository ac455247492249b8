"""Results of a benchmark: one row an episode, shares with intervals, a table as text and CSV."""

from __future__ import annotations

import csv
import io
import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field, fields
from pathlib import Path
from typing import Annotated

from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._statistics import Share, wilson
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.outcomes import OUTCOMES
from hrsafety.plausibility import ResultWarning

__all__ = ["Result", "Row", "read_rows", "row_text"]


@displayed
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
    contacts, toward, away, at_fault : int
        People and walls touched; how many of them while the robot moved toward them, how many from behind or from the
        side while it moved, and how many at fault. The rest of the contacts came while it stood.
    walls : int
        How many of these contacts are with walls or maps, each of which is at fault.
    apart : int
        People who touched the robot when they appeared in a recording or world, counted apart from the others.
    between : int
        How many of the people touched the robot on straight lines between two instants only.
    lost : int
        1 where a person who was recorded may have been touched while not seen, or where the robot arrived
        after the end of the recording; see `Recording.lost_near`.
    clearance : float
        Least distance of the surfaces in m; of the adversary suite while the robot moved toward a person.
    score : float
        Of BARN and DynaBARN: ``success OT / clip(AT, 2 OT, 8 OT)``, at best 0.5; NaN elsewhere.
    """

    case: int
    outcome: str
    arrival_time: Annotated[float, "s"]
    end_time: Annotated[float, "s"]
    contacts: int
    toward: int = 0
    away: int = 0
    at_fault: int
    walls: int = 0
    apart: int
    clearance: Annotated[float, "m"]
    score: float = math.nan
    between: int = 0
    lost: int = 0


NAMES = tuple(each.name for each in fields(Row))
_COUNTS = ("case", "contacts", "toward", "away", "at_fault", "walls", "apart", "between", "lost")


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
    try:
        text = path.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise InvalidParameterError("out", f"hold text in UTF-8 ({path})", Shown(f"byte {error.start}")) from None
    lines = list(csv.reader(text[: text.rfind("\n") + 1].splitlines()))
    if not lines:
        return []
    if tuple(lines[0]) != NAMES:
        raise InvalidParameterError("out", f"hold rows of this benchmark ({', '.join(NAMES)})", str(path))
    # Of two rows of an episode the first counts.
    rows: dict[int, Row] = {}
    for number, line in enumerate(lines[1:], start=2):
        row = _row(line, f"{path}, line {number}")
        rows.setdefault(row.case, row)
    return list(rows.values())


def _row(line: Sequence[str], where: str) -> Row:
    """Return a row of a file, or say where it is damaged."""
    try:
        value = dict(zip(NAMES, line, strict=True))
        row = Row(
            outcome=value["outcome"],
            arrival_time=float(value["arrival_time"]),
            end_time=float(value["end_time"]),
            clearance=float(value["clearance"]),
            score=float(value["score"]),
            **{name: int(value[name]) for name in _COUNTS},
        )
    except ValueError:
        row = None
    if row is None or min(getattr(row, name) for name in _COUNTS) < 0 or row.outcome not in OUTCOMES:
        rule = f"hold rows of this benchmark ({', '.join(NAMES)})"
        remedy = "remove the line, and its episode is run again"
        raise InvalidParameterError("out", rule, Shown(f"{','.join(line)[:80]!r} in {where}"), remedy)
    return row


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """Episodes of a suite by entry.

    Parameters
    ----------
    suite : str
        The suite.
    rows : mapping of str to sequence of Row
        Episodes of every entry.
    accepted : mapping of str to str
        What is asked of an entry: success, contact and fault in percent.
    warnings : tuple of ResultWarning
        Where shields assume slower people than the suite has.
    conditions : str
        Scenes, sensing and assumptions for which the shares hold.
    """

    suite: str
    rows: Mapping[str, Sequence[Row]]
    warnings: tuple[ResultWarning, ...] = ()
    accepted: Mapping[str, str] = field(default_factory=dict)
    conditions: str = ""

    def success(self, name: str) -> Share:
        """Return the share of episodes that arrived without a contact, with its 95 % Wilson interval."""
        rows = self.rows[name]
        return wilson(sum(row.outcome == "arrived" for row in rows), len(rows))

    def contact(self, name: str) -> Share:
        """Return the share with a contact."""
        return self._share(name, "contacts")

    def toward(self, name: str) -> Share:
        """Return the share with a contact toward which the robot moved."""
        return self._share(name, "toward")

    def away(self, name: str) -> Share:
        """Return the share with a contact from behind or from the side while the robot moved."""
        return self._share(name, "away")

    def walls(self, name: str) -> Share:
        """Return the share with a contact with a wall."""
        return self._share(name, "walls")

    def at_fault(self, name: str) -> Share:
        """Return the share with a contact at fault."""
        return self._share(name, "at_fault")

    def _share(self, name: str, count: str) -> Share:
        """Return the share of the episodes in which a count is not zero."""
        rows = self.rows[name]
        return wilson(sum(getattr(row, count) > 0 for row in rows), len(rows))

    def mean_arrival(self, name: str) -> float:
        """Return the mean arrival time in s; NaN without arrivals."""
        times = [row.arrival_time for row in self.rows[name] if not math.isnan(row.arrival_time)]
        return math.fsum(times) / len(times) if times else math.nan

    def mean_score(self, name: str) -> float:
        """Return the mean score of BARN; NaN for suites without one."""
        scores = [row.score for row in self.rows[name]]
        return math.fsum(scores) / len(scores) if scores else math.nan

    def _means(self, name: str) -> tuple[tuple[float, str], ...]:
        return (self.mean_arrival(name), ".2f"), (self.mean_score(name), ".4f")

    def failures(self, name: str, most: int = 3) -> list[int]:
        """Return the first episodes that did not succeed."""
        return [row.case for row in self.rows[name] if row.outcome != "arrived"][:most]

    def cells(self) -> list[tuple[str, ...]]:
        """Return the table, a row an entry, with shares in percent."""
        shares = (self.success, self.contact, self.walls, self.toward, self.away, self.at_fault)
        return [
            (
                name,
                str(len(self.rows[name])),
                *(_percent(share(name)) for share in shares),
                *("" if math.isnan(mean) else f"{mean:{form}}" for mean, form in self._means(name)),
                self.accepted.get(name, ""),
            )
            for name in self.rows
        ]


HEAD = (
    "law",
    "episodes",
    "success %",
    "contact %",
    "with walls %",
    "toward %",
    "away %",
    "at fault %",
    "arrival s",
    "score",
    "asked for",
)
"""Titles of the table."""


def _percent(share: Share) -> str:
    return f"{100 * share.value:.1f} ({100 * share.low:.1f} to {100 * share.high:.1f})"
