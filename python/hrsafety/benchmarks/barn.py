"""BARN and DynaBARN: fields of cylinders that stand, and worlds of cylinders that move along keyframes."""

from __future__ import annotations

import functools
import json
import math
from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import Array, number, readable
from hrsafety.benchmarks.protocol import Case, rows_of
from hrsafety.benchmarks.results import Row
from hrsafety.errors import InvalidParameterError, Shown

__all__ = [
    "ACCEPTED",
    "DYNAMIC_LAWS",
    "LAWS",
    "MOST_WORLDS",
    "barn_score",
    "dynamic_files",
    "dynamic_scene",
    "own_times",
    "run_dynamic",
    "run_worlds",
    "world_files",
    "world_scene",
    "worlds_in",
]

LAWS = ("field(attractive_gain=13)+guide+shield", "field+guide+shield", "orca(horizon=1,margin=0.005)+guide+shield")
"""Entries of BARN without others."""
ACCEPTED: Mapping[tuple[str, float | None], str] = {
    (LAWS[0], None): "99 / 0, score 0.495",
    (LAWS[1], None): "99 / 0",
    (LAWS[2], None): "99 / 0",
}
DYNAMIC_LAWS = ("field(attractive_gain=13)+yielding",)
"""Entries of DynaBARN without others."""
MOST_WORLDS = 10_000
RADIUS, SPEED = 0.22, 2.0
"""Of the robot, in m and m/s."""
START, GOAL = (-2.0, 3.0), (-2.0, 13.0)
BOX = ((-6.0, -0.5), (1.5, 15.0))
"""Of the nodes of guides in BARN, in m."""
MOVER = 0.5
"""Radius of what moves in DynaBARN, in m."""
WORLDS, PHASE, FRESH = 60, 1.7, 0.4
"""Worlds of DynaBARN, and between two phases and two seeds, in s."""
WRAP, OFF = 1e-6, 1e-5
"""In which a mover is taken from the end of its keyframes to their start, and how long after it, in s."""
LIMIT = 100.0
"""Longest episode in s."""
OPTIMUM = 10.0
"""Time of an episode of DynaBARN at full speed in s."""


def barn_score(row: Row, optimum: float) -> Row:
    """Return the row with its score: success OT / clip(AT, 2 OT, 8 OT)."""
    arrived = row.outcome == "arrived"
    score = optimum / min(max(row.arrival_time, 2.0 * optimum), 8.0 * optimum) if arrived else 0.0
    return replace(row, score=score)


# ---- cylinders that stand -------------------------------------------------------------------


def world_files(folder: Path | None) -> list[Path]:
    """Return the files of worlds in a folder, or the one that is named."""
    return _files(folder, "barn_*.json")


def _files(folder: Path | None, pattern: str) -> list[Path]:
    files = [] if folder is None else sorted(folder.glob(pattern)) if folder.is_dir() else [folder]
    if not files:
        raise InvalidParameterError("data", f"be a folder with files {pattern}, or one of them", str(folder))
    return files


Stamped = tuple[Path, int, int]
"""A file, when it was changed and its size: what is read of it is kept for as long as these stand."""


def _stamped(files: list[Path]) -> tuple[Stamped, ...]:
    found = [(file, readable("data", file).stat()) for file in files]
    return tuple((file, state.st_mtime_ns, state.st_size) for file, state in found)


@functools.lru_cache(maxsize=4)
def _worlds(files: tuple[Stamped, ...], key: str = "optimal_time_2022_s") -> dict[int, tuple[Mapping[str, Any], float]]:
    """Return the file of each world, by its number, and its optimal time, which has a name."""
    found: dict[int, tuple[Mapping[str, Any], float]] = {}
    for file, *_ in files:
        loaded = _json(file)
        for each in loaded.get("worlds", ()) if isinstance(loaded, Mapping) else ():
            if not isinstance(each, Mapping) or not isinstance(each.get("id"), int) or each["id"] in found:
                raise InvalidParameterError("data", "name every world once by a number, id", Shown(f"{file.name}"))
            optimum = number(f"{key} of world {each['id']}", each.get(key))
            if not 0.0 < optimum < math.inf:
                name = f"{key} of world {each['id']}"
                raise InvalidParameterError(name, "be positive and finite", optimum)
            found[each["id"]] = loaded, optimum
    if not found:
        names = ", ".join(file.name for file, *_ in files)
        raise InvalidParameterError("data", "hold BARN worlds in JSON", Shown(names))
    return dict(sorted(found.items()))


def _json(file: Path) -> Any:
    try:
        return json.loads(readable("data", file).read_text(encoding="utf-8"))
    except (ValueError, RecursionError) as error:
        raise InvalidParameterError("data", "hold JSON", Shown(f"{file.name} ({error})")) from None


def own_times(folder: Path | None) -> dict[int, tuple[Mapping[str, Any], float]]:
    """Return the worlds of files by their numbers, with the optimal times of their own starts in s."""
    return _worlds(_stamped(world_files(folder)), "optimal_time_s")


def worlds_in(folder: Path | None) -> int:
    """Return how many worlds the files hold."""
    return len(_worlds(_stamped(world_files(folder))))


def world_scene(case: Case, index: int) -> tuple[nav.Scenario, nav.Law]:
    """Return an episode of BARN: the worlds of the files in the order of their numbers."""
    worlds = _worlds(_stamped(world_files(case.data)))
    world = list(worlds)[index]
    place = nav.Scenario(
        robot=nav.HolonomicRobot(radius=RADIUS, max_speed=SPEED, max_acceleration=3.0),
        start=START,
        goal=GOAL,
        control_period=0.1,
        time_limit=LIMIT,
        rest_time=LIMIT,
        arrival_tolerance=1.0,
    )
    known = nav.maps.StaticMap.from_barn(worlds[world][0], world)
    return place, case.entry.built(person_speed=case.person_speed, map=known, guide=nav.maps.Guide(box=BOX))


def run_worlds(case: Case) -> Iterator[Row]:
    """Yield the rows of some worlds."""
    worlds = _worlds(_stamped(world_files(case.data)))
    optima = [optimum for _, optimum in worlds.values()]
    for index in case.cases:
        place, law = world_scene(case, index)
        table = nav.simulate_many([place], law, stop_on_contact=True, threads=1)
        (row,) = rows_of(table, [index])
        yield barn_score(row, optima[index])


# ---- cylinders that move --------------------------------------------------------------------


def dynamic_files(folder: Path | None) -> list[Path]:
    """Return the file of trajectories in a folder, or the one that is named."""
    return _files(folder, "dynabarn*.json")


@functools.lru_cache(maxsize=4)
def _dynamic(files: tuple[Stamped, ...]) -> list[list[tuple[float, Array]]]:
    """Return period and keyframes of the movers of every world, in the order of their numbers."""
    file = files[0][0]
    loaded = _json(file)
    rule = "hold trajectories by name (duration, keyframes) and worlds by number (names)"
    if not isinstance(loaded, Mapping) or not {"trajectories", "worlds"} <= loaded.keys():
        raise InvalidParameterError("data", rule, Shown(file.name))
    try:
        movers = {name: _mover(name, given) for name, given in loaded["trajectories"].items()}
        worlds = {int(world): [movers[name] for name in names] for world, names in loaded["worlds"].items()}
    except (KeyError, TypeError, AttributeError, ValueError) as error:
        if isinstance(error, InvalidParameterError):
            raise
        raise InvalidParameterError("data", rule, Shown(f"{file.name} ({error!r})")) from None
    return [worlds[world] for world in sorted(worlds)]


def _mover(name: str, given: Mapping[str, Any]) -> tuple[float, Array]:
    keys = np.array(given["keyframes"], dtype=float)
    if keys.ndim != 2 or keys.shape[1] != 3 or not np.isfinite(keys).all() or not (np.diff(keys[:, 0]) > 0.0).all():
        raise InvalidParameterError(
            "data", f"have keyframes (t, x, y) in order in {name}", Shown(f"shape {keys.shape}")
        )
    return max(number(f"duration of {name}", given["duration"]), float(keys[-1, 0])), keys


def _unrolled(period: float, keys: Array, phase: float) -> tuple[Array, Array]:
    """Return instants and places of a mover from a phase on, for as long as an episode may take."""
    rounds = np.arange(-1, math.ceil((phase + LIMIT) / period) + 1)
    # At the end of a round it stands where its keyframes end, and is at their start at once: a little later
    # than where samples may fall.
    begin, end = OFF + WRAP, period + OFF
    inner = keys[(keys[:, 0] > begin) & (keys[:, 0] < end)]
    turn = np.vstack([[begin, *_at(keys, begin)], inner, [end, *_at(keys, end)]])
    time = (rounds[:, None] * period + turn[:, 0] - phase).ravel()
    place = np.tile(turn[:, 1:], (len(rounds), 1))
    first = max(0, int(np.searchsorted(time, 0.0, side="right")) - 1)
    return time[first:], place[first:]


def _at(keys: Array, time: float) -> tuple[float, float]:
    return float(np.interp(time, keys[:, 0], keys[:, 1])), float(np.interp(time, keys[:, 0], keys[:, 2]))


def dynamic_scene(acceleration: float) -> Callable[[Case, int], tuple[nav.Scenario, nav.Law]]:
    """Return what makes episodes of DynaBARN for a robot with a largest acceleration in m/s^2."""

    def scene(case: Case, index: int) -> tuple[nav.Scenario, nav.Law]:
        worlds = _dynamic(_stamped(dynamic_files(case.data)))
        phase, world = divmod(index, WORLDS)
        if world >= len(worlds):
            raise InvalidParameterError("data", f"hold {WORLDS} worlds", Shown(f"{len(worlds)} of them"))
        begin = PHASE * phase + FRESH * case.seed
        movers = tuple(_obstacle(*_unrolled(period, keys, begin)) for period, keys in worlds[world])
        place = nav.Scenario(
            robot=nav.HolonomicRobot(radius=RADIUS, max_speed=SPEED, max_acceleration=acceleration),
            start=(11.0, 0.0),
            goal=(-9.0, 0.0),
            obstacles=tuple(movers),
            control_period=0.1,
            time_limit=LIMIT,
            rest_time=LIMIT,
            arrival_tolerance=1.0,
        )
        yielding = nav.laws.Yielding(
            clearance=0.3, horizon=3.5, time_weight=5.0, distance_weight=3.0, comfort=0.3, goal_weight=1.0, reach=4.0
        )
        return place, case.entry.built(person_speed=case.person_speed, yielding=yielding, takeover=False)

    return scene


def _obstacle(time: Array, place: Array) -> nav.MovingDisc:
    steps = np.diff(time)
    speeds = np.hypot(*np.diff(place, axis=0).T) / steps
    # What is faster is taken from an end to a start, and moves at no speed.
    moving = speeds[(steps > 2.0 * WRAP) & (speeds <= 5.0)]
    return nav.MovingDisc.from_path(
        time,
        place,
        radius=MOVER,
        max_speed=float(moving.max(initial=0.0)),
        active_clearance=1.0,
        critical_clearance=0.05,
    )


def run_dynamic(acceleration: float) -> Callable[[Case], Iterator[Row]]:
    """Return what runs episodes of DynaBARN for a robot with a largest acceleration in m/s^2."""
    scene = dynamic_scene(acceleration)

    def run(case: Case) -> Iterator[Row]:
        pairs = [scene(case, index) for index in case.cases]
        places = [place for place, _ in pairs]
        table = nav.simulate_many(places, pairs[0][1], stop_on_contact=True, step=0.025, threads=case.threads)
        for row in rows_of(table, case.cases):
            yield barn_score(row, OPTIMUM)

    return run
