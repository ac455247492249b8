"""Suites of episodes, and the cases that they hold."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from hrsafety import navigation as nav
from hrsafety._records import dataclass
from hrsafety.benchmarks.entries import Entry, entry
from hrsafety.benchmarks.results import Row
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.plausibility import ResultWarning

__all__ = ["Case", "Suite", "rows_of"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """Episode that an entry is run in.

    Parameters
    ----------
    cases : sequence of int
        Numbers of the episodes.
    entry : Entry
        What is run.
    person_speed : float
        What the shield assumes of people, in m/s.
    data : Path or None
        Folder with the data of the suite.
    seed : int
        Seed of the draw.
    threads : int or None
        Number of threads.
    noise : float
        Half width of the uniform error of each coordinate of measured people, in m.
    latency : float
        Age of their measurements, in s.
    """

    cases: Sequence[int]
    entry: Entry
    person_speed: float
    data: Path | None
    seed: int
    threads: int | None
    noise: float = 0.0
    latency: float = 0.0

    @property
    def measurement(self) -> nav.Measurement | None:
        """Errors and age of what the robot sees of people; ``None`` where they are known exactly."""
        if self.noise == self.latency == 0.0:
            return None
        return nav.Measurement(scale=self.noise, latency=self.latency, of="obstacles")

    def built(self, **protocol: Any) -> nav.Law:
        """Return the law of the entry, with a shield that assumes the people and the sensing of the case.

        Parameters
        ----------
        **protocol
            Further arguments of `Entry.built`.

        Returns
        -------
        Law
            The law.
        """
        error = math.hypot(self.noise, self.noise)
        return self.entry.built(person_speed=self.person_speed, latency=self.latency, position_error=error, **protocol)


@dataclass(frozen=True, kw_only=True, slots=True)
class Suite:
    """A protocol.

    Parameters
    ----------
    name : str
        Its name.
    summary : str
        What it is, in a sentence.
    laws : tuple of str
        Entries that are run without others.
    cases : int
        Episodes without another number.
    seed : int
        Seed of the draw without another one.
    most : int
        Most episodes.
    files : callable or None
        Files that it reads, from what the user names; ``None`` without any.
    available : callable or None
        How many episodes these hold; ``None``: ``most``, and ``cases`` are the episodes of the protocol.
    accepted : mapping
        What is asked of an entry, by its name and the speed of people that its shield assumes.
    step : float
        Motion step in s.
    execution_error : float
        How far its robots are off the motion that a shield plans, in m, where that is more than the margin.
    sensed : bool
        Whether errors and age of measurements of people may be asked for.
    fastest : float or None
        Largest speed of people in m/s; ``None``: the data decide.
    doubts : callable or None
        Doubts about the data of so many episodes, from what the user names; ``None`` without any.
    scene : callable
        Scenario of an episode, to show it again.
    entry : callable
        What a word among the laws names.
    run : callable
        Rows of some episodes.
    """

    name: str
    summary: str
    laws: tuple[str, ...]
    cases: int
    seed: int
    most: int
    files: Callable[[Path | None], list[Path]] | None = None
    available: Callable[[Path | None], int] | None = None
    accepted: Mapping[tuple[str, float | None], str] = field(default_factory=dict)
    step: float = 0.01
    execution_error: float = 0.0
    sensed: bool = True
    fastest: float | None
    doubts: Callable[[Path | None, int], Iterable[ResultWarning]] | None = None
    scene: Callable[[Case, int], tuple[nav.Scenario, nav.Law]] | None = None
    entry: Callable[[str], Entry] = entry
    run: Callable[[Case], Iterator[Row]]


def rows_of(table: RunTable, cases: Sequence[int]) -> Iterator[Row]:
    """Yield the rows of many runs, an episode each."""
    for index, case in enumerate(cases):
        yield Row(
            case=case,
            outcome=str(table.outcome[index]),
            arrival_time=float(table.arrival_time[index]),
            end_time=float(table.end_time[index]),
            contacts=int(table.contacts_moving[index] + table.contacts_standing[index]),
            toward=int(table.contacts_toward[index]),
            away=int(table.contacts_away[index]),
            at_fault=int(table.contacts_at_fault[index]),
            walls=int(table.wall_contacts[index]),
            apart=int(table.contacts_apart[index]),
            clearance=float(table.min_clearance[index]),
        )
