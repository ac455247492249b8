"""Doubts about a log that contradicts itself or its map: people in walls or under two ids, and odd twists."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from hrsafety._arguments import Array
from hrsafety.datasets import Recording
from hrsafety.navigation.judging.synchronized import Flags, Synchronized
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plausibility import ResultWarning

__all__ = ["continued_tracks", "other_twists", "people_off_map"]

IN_WALLS = 0.05
"""Share of the rows of a person that may lie in walls: doors that were closed, and false sights."""
LEAST_ROWS = 3
"""So many rows in walls are no single false sights."""
DEPTH = 0.1
"""Depth in a wall in m that a position and a map may be wrong by, besides the noise and a cell."""
OUTSIDE = 0.2
"""Share of all rows that may lie outside of the image of a map."""
UNKNOWN = 0.5
"""Share of all rows that may lie where the map is unknown."""
MOVING, TURNING = 0.1, 0.15
"""Speed in m/s and turn rate in rad/s above which robots move and turn, and by which both may differ at any."""
LAG = 0.3
"""Time in s by which a stored velocity may be early or late."""
APART = 0.25
"""Share of the larger one by which poses and stored velocities may differ: slip and wheels of another size."""
DISAGREEING = 0.5
"""Share of the moving rows that must differ."""
LEAST_TIME = 1.0
"""Of moving rows in s."""


# ---- people and map ------------------------------------------------------------------------------


def people_off_map(people: Any, both: Synchronized, walls: StaticMap | None) -> Iterator[ResultWarning]:
    """Yield where the centers of people lie in walls or outside of the map: both do not fit together.

    Parameters
    ----------
    people : Recording or None
        Of the log.
    both : Synchronized
        Robot and people at equal instants.
    walls : StaticMap or None
        The map.
    """
    if people is None or walls is None:
        return
    remedy = "people and map do not fit together: x and y exchanged, or another frame, origin or unit"
    tracks = [(who, time, np.asarray(rows, dtype=np.float64)) for who, time, rows in people.tracks()]
    places = np.concatenate([rows for _, _, rows in tracks]) if tracks else np.zeros((0, 2))
    if not len(places):
        return
    cell = max((grid.resolution for grid in walls.grids), default=0.0)
    depth = _depths(walls, places)
    inside = depth > DEPTH + cell + 3.0 * both.person_noise.position
    counts = [len(rows) for _, _, rows in tracks]
    per_person = np.array([part.sum() for part in np.split(inside, np.cumsum(counts)[:-1])])
    odd = (per_person >= LEAST_ROWS) & (per_person > IN_WALLS * np.array(counts))
    if odd.any() or (inside.sum() >= LEAST_ROWS and inside.mean() > IN_WALLS):
        worst = int(np.argmax(per_person))
        message = (
            f"person {tracks[worst][0]} is within walls of the map in {per_person[worst]} of {counts[worst]} rows, up "
            f"to {float(depth.max()):.2g} m deep, and so are {int((per_person > 0).sum()) - 1} more of {len(tracks)} "
            f"people at times: {remedy}, or unknown cells that count as occupied?"
        )
        yield ResultWarning("recording_in_wall", "people", message)
    unseen = np.asarray(walls.unseen(places), dtype=np.bool_)
    in_image = np.zeros(len(places), dtype=np.bool_)
    for grid in walls.grids:
        in_image |= grid.unseen_at(places)
    outside = unseen & ~in_image
    for share, most, where in (
        (float(outside.mean()), OUTSIDE, "outside of the map"),
        (float(unseen.mean()), UNKNOWN, "where the map is unknown"),
    ):
        if share > most:
            message = f"{100.0 * share:.0f} % of the positions of people lie {where}: {remedy}?"
            yield ResultWarning("people_off_map", "people", message)
            return


def continued_tracks(people: Any, lost: set[int | str | None]) -> Iterator[ResultWarning]:
    """Yield which ways of people begin where another one leads that ends: probably those of one person.

    Parameters
    ----------
    people : Recording or None
        Of the log.
    lost : set
        Who is not seen while maybe near the robot: without any of them nothing that is near is left out.
    """
    if not isinstance(people, Recording):
        return
    ends, ids = people._track_ends(), people.people().tolist()
    pairs = [(one, int(other)) for one, other in enumerate(ends.follower) if other >= 0]
    if not pairs:
        return
    near = [each for each in pairs if lost & {ids[each[0]], ids[each[1]]}]
    shown = [
        f"{ids[other]} begins at {ends.begin[other]:.2f} s, {np.hypot(*(ends.first[other] - ends.last[one])):.2f} m "
        f"from where {ids[one]} ended at {ends.end[one]:.2f} s"
        for one, other in [*near, *(each for each in pairs if each not in near)][:3]
    ]
    more = f", and {len(pairs) - 3} more" if len(pairs) > 3 else ""
    message = (
        f"probably one person under two ids: {'; '.join(shown)}{more}; nobody is there in between, and each id is "
        "judged by itself: give both one id"
    )
    yield ResultWarning("continued_track", "people", message, safe_side=not near)


def _depths(walls: StaticMap, places: Array) -> Array:
    """Return how deep points lie in walls in m; 0 outside of them."""
    found = np.zeros(len(places))
    inside = np.flatnonzero(np.asarray(walls.clearance(places)) <= 0.0)
    if len(inside):
        found[inside] = np.hypot(*(np.asarray(walls.nearest(places[inside])) - places[inside]).T)
    return found


# ---- poses and twists ----------------------------------------------------------------------------


def other_twists(log: Any, both: Synchronized) -> Iterator[ResultWarning]:
    """Yield where the velocities that a log stores are not those of its poses most of the time that the robot moves.

    Parameters
    ----------
    log : Logged
        Its ``twist`` is compared, if it has one.
    both : Synchronized
        Robot and people at equal instants.
    """
    twist = np.asarray(getattr(log, "twist", ()), dtype=np.float64)
    time = np.asarray(log.time, dtype=np.float64)
    if twist.shape != (len(time), 3):
        return
    last = np.clip(np.searchsorted(time, both.time + 1e-9, "right") - 1, 0, len(time) - 1)
    stored = twist[last]
    pairs = (
        ("speed", "m/s", np.hypot(*both.velocity.T), np.hypot(stored[:, 0], stored[:, 1]), MOVING, both.noise.velocity),
        ("turn rate", "rad/s", both.turn_rate, stored[:, 2], TURNING, both.heading_noise.velocity),
    )
    for name, unit, driven, told, least, noise in pairs:
        slack = least + 3.0 * noise
        known = both.whole & np.isfinite(driven) & np.isfinite(told)
        moves = known & (np.fmax(np.abs(driven), np.abs(told)) > 2.0 * slack)
        if moves.sum() * both.step < LEAST_TIME:
            continue
        differs = moves & _differ(driven, told, known, slack, both.step)
        if differs.sum() > DISAGREEING * moves.sum():
            medians = [float(np.median(np.abs(each[moves]))) for each in (driven, told)]
            opposed = " the other way round" if float(np.median(driven[moves] * told[moves])) < 0.0 else ""
            hint = "degrees given for radians, a heading in degrees" if name == "turn rate" else "another unit"
            message = (
                f"the {name} of the log is {medians[1]:.3g} {unit}{opposed} where its poses have {medians[0]:.3g} "
                f"{unit} (medians of the {moves.sum() * both.step:.3g} s in motion): {hint}, time stamps of another "
                "clock, velocities that were never filled in, or another robot?"
            )
            yield ResultWarning("twist_disagrees", "log.twist", message)


def _differ(driven: Array, told: Array, known: Flags, slack: float, step: float) -> Flags:
    """Return where a velocity by poses is none of those that were told within the lag."""
    wide = max(1, round(LAG / step))
    padded = np.pad(np.where(known, told, np.nan), wide, constant_values=np.nan)
    around = np.lib.stride_tricks.sliding_window_view(padded, 2 * wide + 1)
    low, high = np.fmin.reduce(around, axis=1), np.fmax.reduce(around, axis=1)
    away = np.fmax(low - driven, driven - high)
    larger = np.fmax(np.abs(driven), np.fmin(np.abs(low), np.abs(high)))
    with np.errstate(invalid="ignore"):
        found: Flags = away > np.fmax(slack, APART * larger)
    return found
