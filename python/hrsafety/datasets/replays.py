"""Replays of recorded people."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._replay.record import Replay, UnjudgedTime

__all__ = ["replay_of_people"]

RADIUS = 0.25
MOST_PLACES = 4_000_000
"""Places that are kept in memory: frames times people."""
LONGEST_GAP = 2.0
GAP_PERIODS = 10.0


def replay_of_people(people: Any) -> Replay:
    """Return what a player shows of recorded people.

    Instants are those of the rows, or evenly spaced if there are too many; a person is on the straight line between
    two rows, and absent over a gap.
    """
    tracks = list(people.tracks())
    time = np.unique(people.time_s)
    most = max(MOST_PLACES // len(tracks), 2)
    if len(time) > most:
        time = np.linspace(time[0], time[-1], most)
    places = np.full((len(time), len(tracks), 2), np.nan)
    for column, (_, instants, position) in enumerate(tracks):
        first, last = np.searchsorted(time, [instants[0], instants[-1] + 1e-9])
        asked = time[first:last]
        known = _known(asked, instants)
        for axis in range(2):
            found = np.interp(asked, instants, position[:, axis])
            places[first:last, column, axis] = np.where(known, found, np.nan)
    return Replay(
        title="Recorded people",
        time=time,
        people=places,
        radius=np.full(len(tracks), RADIUS),
        names=[str(person) for person, _, _ in tracks],
        kinds=["person"] * len(tracks),
        not_judged=_silent(people),
        facts=[
            ("people", str(len(tracks))),
            ("rows", str(len(people))),
            ("radius shown", f"{RADIUS:g} m, which is not recorded"),
        ],
        warnings=people.warnings,
    )


def _known(asked: Array, instants: Array) -> npt.NDArray[np.bool_]:
    """Return at which instants a person is recorded: at a row, or between two that are no gap apart."""
    if len(instants) < 2:
        return np.isin(asked, instants)
    steps = np.diff(instants)
    after = np.clip(np.searchsorted(instants, asked), 1, len(instants) - 1)
    near = steps[after - 1] <= max(LONGEST_GAP, GAP_PERIODS * float(np.median(steps)))
    found: npt.NDArray[np.bool_] = near | np.isin(asked, instants)
    return found


def _silent(people: Any) -> list[UnjudgedTime]:
    """Return when no person is recorded for long: no row is no empty floor."""
    time = np.unique(people.time_s)
    steps = np.diff(time)
    if not len(steps):
        return []
    long = np.flatnonzero(steps > max(LONGEST_GAP, GAP_PERIODS * float(np.median(steps))))
    return [UnjudgedTime(float(time[row]), float(time[row + 1]), "nobody is recorded") for row in long.tolist()]
