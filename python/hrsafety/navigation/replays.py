"""Replays of runs, and of recorded decisions.

The classes of results import these functions, which know them by their fields only.
"""

from __future__ import annotations

import math
import zlib
from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety._arguments import Array
from hrsafety._replay.record import PERSON_POSSIBLE, Decisions, Event, PlayedCells, PlayedLidar, PlayedRobot, Replay
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.obstacles.moving import Human
from hrsafety.navigation.obstacles.moving_rectangle import Box, Mobile
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.navigation.outcomes import OUTCOMES
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.robots.footprint import Footprint
from hrsafety.navigation.sensing.lidar import Lidar

__all__ = ["replay_of_record", "replay_of_run", "replay_of_steps", "scanner_of", "walls_of"]

Run = Any
"""A `Trajectory`."""
Steps = Any
"""A `Run`."""
Record = Any
"""A `SafetyRecord`."""
Bodies = Sequence[tuple[int, str, str, float, Any]]
"""Column, kind, name, radius in m and, of one with sides, the obstacle, of everybody who can move."""

STANDING = 0.05

MOST_EXPECTED = 250
"""Most places of people that a player shows at once."""


def replay_of_run(run: Run, decisions: Decisions | None = None) -> Replay:
    """Return what a player shows of a run.

    Parameters
    ----------
    run : Trajectory
        The run.
    decisions : Decisions or None
        What the parts around the law of its robot decided.
    """
    scene = run.scenario
    of_world = hasattr(scene, "people")
    bodies = _people(run) if of_world else _moving(run)
    maps = [*walls_of(scene), *maps_around(run)] if of_world else [*maps_around(run), *_standing(run)]
    decider = run.robot if decisions is not None else None
    robots = [
        _robot(own, index, maps, bodies, of_world=of_world, decisions=decisions if index == decider else None)
        for index, own in enumerate(run.robots)
    ]
    columns = [column for column, *_ in bodies]
    events = [] if scene is None else [event for own in run.robots for event in _events(own, bodies, maps)]
    if run.diverged is not None:
        events.append(Event(run.diverged.time, "note", f"{run.diverged.kind} {run.diverged.index} diverged"))
    period = getattr(scene, "period", (0.0, 0.0))
    return Replay(
        title=_title(run, of_world=of_world),
        time=run.time,
        robots=robots,
        people=_in_cell(run.obstacle_position[:, columns], period) if bodies else None,
        radius=np.array([radius for *_, radius, _ in bodies]),
        names=[name for _, _, name, *_ in bodies],
        kinds=[kind for _, kind, *_ in bodies],
        boxes={k: (box.length, box.width, box.heading) for k, (*_, box) in enumerate(bodies) if box is not None},
        maps=maps,
        events=sorted(events, key=lambda event: event.time),
        facts=list(_facts(run, of_world=of_world)),
        warnings=run.warnings,
    )


def replay_of_record(record: Record) -> Replay:
    """Return what a player shows of a run with the decisions of its parts."""
    run, made = record.trajectory, record.decisions
    shielded, guided = record.law.shield is not None, record.law.guide is not None
    foresees = record.law.foresight is not None
    columns = [column for column, *_ in (_people(run) if hasattr(run.scenario, "people") else _moving(run))]
    decisions = Decisions(
        time=np.array([each.time for each in made]),
        verdict=[_verdict(each.status, taken_over=each.taken_over, shielded=shielded) for each in made],
        margin=np.array([each.margin for each in made]),
        plan=[each.plan_position for each in made] if shielded else (),
        path=[each.path for each in made] if guided else (),
        reach=np.array([each.obstacle_reach for each in made])[:, columns] if shielded and made else None,
        way=[each.foreseen_way for each in made] if foresees else (),
        expected=[_expected(each.foreseen_people) for each in made] if foresees else (),
    )
    return replay_of_run(run, decisions)


def replay_of_steps(run: Steps) -> Replay:
    """Step a run to its end, and return what a player shows of it with the cells that its robots keep.

    Parameters
    ----------
    run : Run
        A run under way.

    Raises
    ------
    InvalidParameterError
        If the run has ended.
    """
    if run.finished:
        remedy = "`run.trajectory` can be played without what the law knew"
        raise InvalidParameterError("run", "be under way: it is stepped to its end here", run, remedy)
    kept = [_Kept(run, index) for index in range(len(run.outcomes))]
    while not run.finished:
        run.step()
        for each in kept:
            each.add()
    shown = replay_of_run(run.trajectory)
    return replace(shown, robots=[replace(own, cells=kept[k].played()) for k, own in enumerate(shown.robots)])


class _Kept:
    """Cells that a robot of a run keeps, from now on."""

    def __init__(self, run: Steps, robot: int) -> None:
        self.run, self.robot, self.side = run, robot, math.nan
        self.rows: list[tuple[float, Any, tuple[int, int], bytes]] = []
        self.ways: list[Array] = []
        self.belief = False
        self.add()

    def add(self) -> None:
        """Keep those of now, without unknown ones around them."""
        map_now, places = self.run.known_cells(self.robot), self.run.unseen_places(self.robot)
        if map_now is not None:
            self.side, kinds, low = map_now.cell, map_now.kinds, np.array(map_now.low)
            self.ways.append(map_now.way)
        elif places is not None:
            if not self.rows:
                self.belief, self.side = True, self.run.trajectory.robots[self.robot].law.shield.unseen.cell
            low = places.min(axis=0, initial=np.inf) - 0.5 * self.side
            columns, rows = np.round((places - low) / self.side - 0.5).astype(int).T
            kinds = np.zeros((rows.max(initial=-1) + 1, columns.max(initial=-1) + 1), dtype=np.uint8)
            kinds[rows, columns] = PERSON_POSSIBLE
        else:
            return
        rows, columns = (np.flatnonzero(kinds.any(axis=axis)) for axis in (1, 0))
        if len(rows):
            kinds = kinds[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]
            low = low + self.side * np.array([columns[0], rows[0]])
        else:
            kinds = kinds[:0, :0]
        self.rows.append((self.run.time, low, kinds.shape, zlib.compress(kinds.tobytes(), 1)))

    def played(self) -> PlayedCells | None:
        """Return what a player shows of them; ``None`` of a law that keeps none."""
        if not self.rows:
            return None
        times, lows, sizes, packed = zip(*self.rows, strict=True)

        def kinds(row: int) -> Any:
            return np.frombuffer(zlib.decompress(packed[row]), dtype=np.uint8).reshape(sizes[row])

        return PlayedCells(
            np.array(times), self.side, np.array(lows), np.array(sizes), kinds, belief=self.belief, way=self.ways
        )


def _expected(people: Array) -> Array:
    """Return places where people are expected, at so many instants that a page can show all."""
    known = people[np.isfinite(people).all(axis=(1, 2))]
    every = max(1, -(-known.shape[0] * known.shape[1] // MOST_EXPECTED))
    return known[:, ::every].reshape(-1, 2)[:MOST_EXPECTED]


def _verdict(status: str, *, taken_over: bool, shielded: bool) -> str:
    """Return the word for a decision: without a shield nothing was verified, whatever was decided."""
    if taken_over and (status == "kept" or not shielded):
        return "taken over"
    return status if shielded else "not recorded"


def maps_around(run: Run) -> list[StaticMap]:
    """Return the different maps that the laws and the sensors of a run know."""
    found: list[StaticMap] = []
    for own in run.robots:
        sensors = () if own.built is None else own.built.sensors
        known = [getattr(own.law, "map", None), *(getattr(each, "map", None) for each in sensors)]
        found += [each for each in known if isinstance(each, StaticMap) and each not in found]
    return found


def _title(run: Run, *, of_world: bool) -> str:
    if run.scenario is None:
        return "Run of a robot"
    if of_world and len(run.robots) != 1:
        return "World of people and robots" if run.robots else "World of people"
    outcome = run.robots[0].outcome
    return f"Run: {OUTCOMES.get(outcome, outcome)}"


# ---- who is there ---------------------------------------------------------------------------


def _moving(run: Run) -> Bodies:
    """Return the obstacles of a scenario that can move."""
    if run.scenario is None or run.obstacle_position is None:
        return []
    chosen = [(index, each) for index, each in enumerate(run.scenario.obstacles) if isinstance(each, Mobile)]
    kinds = ["person" if isinstance(each, Human) else "cart" if isinstance(each, Box) else "body" for _, each in chosen]
    total, seen = Counter(kinds), Counter[str]()
    found: list[tuple[int, str, str, float, Any]] = []
    for (index, each), kind in zip(chosen, kinds, strict=True):
        seen[kind] += 1
        name = f"{kind} {seen[kind]}" if total[kind] > 1 else kind
        if isinstance(each, Box):
            found.append((index, kind, name, 0.5 * math.hypot(each.length, each.width), each))
        else:
            found.append((index, kind, name, each.radius, None))
    return found


def _people(run: Run) -> Bodies:
    """Return the people of a world."""
    given = run.scenario.people
    recorded = [getattr(each, "recording", None) is not None for each in given]
    return [
        (
            index,
            "recorded person" if recorded[index : index + 1] == [True] else "person",
            f"person {index}",
            radius,
            None,
        )
        for index, radius in enumerate(run.obstacle_radius.tolist())
    ]


def _standing(run: Run) -> list[StaticMap]:
    """Return what stands in a scenario."""
    if run.scenario is None:
        return []
    solid: list[Any] = [each for each in run.scenario.obstacles if isinstance(each, Disc | Rectangle)]
    walls = [] if run.scenario.walls is None else [run.scenario.walls]
    return [StaticMap.from_obstacles(solid), *walls] if solid else walls


def walls_of(world: Any) -> list[StaticMap]:
    """Return what stands in a world, as maps."""
    if isinstance(world.walls, StaticMap):
        return [world.walls]
    solid = [each for each in world.walls if isinstance(each, Disc | Rectangle)]
    lines = [each for each in world.walls if not isinstance(each, Disc | Rectangle)]
    found = [StaticMap.from_polylines(lines)] if lines else []
    return [*found, StaticMap.from_obstacles(solid)] if solid else found


def _in_cell(places: Array, period: tuple[float, float]) -> Array:
    """Return places in the cell of a world that repeats itself."""
    found: Array = places
    for axis, size in enumerate(period):
        if size > 0.0:
            found = found.copy()
            found[..., axis] = np.mod(found[..., axis], size)
    return found


# ---- robots ---------------------------------------------------------------------------------


def _robot(
    run: Run, index: int, maps: Sequence[StaticMap], bodies: Bodies, *, of_world: bool, decisions: Decisions | None
) -> PlayedRobot:
    scene = run.scenario
    own = scene.robots[index] if of_world else scene
    body = None if scene is None else own.body if of_world else own.robot
    radius = 0.2 if body is None else body.radius
    outline = getattr(body, "footprint", None)
    return PlayedRobot(
        name=f"robot {index}" if of_world and len(scene.robots) > 1 else "robot",
        position=run.position,
        radius=radius,
        heading=None if body is None or (isinstance(body, HolonomicRobot) and outline is None) else run.heading,
        footprint=() if outline is None else outline.corners,
        speed=np.hypot(*run.velocity.T),
        clearance=None if scene is None else _clearance(run, maps, bodies, radius, outline),
        goal=None if scene is None else own.goal,
        tolerance=0.0 if scene is None else own.arrival_tolerance,
        decisions=decisions,
        scan=scanner_of(run, bodies),
    )


def scanner_of(run: Run, bodies: Bodies | None = None) -> PlayedLidar | None:
    """Return the lidar of a robot, whose ranges are told without its noise; ``None`` without one.

    Parameters
    ----------
    run : Trajectory
        Of one robot.
    bodies : sequence or None
        Who can move; those of a scenario when ``None``.
    """
    lidar = next((each for each in (() if run.built is None else run.built.sensors) if isinstance(each, Lidar)), None)
    # Players draw beams from the center of the robot.
    if lidar is None or run.obstacle_position is None or any(lidar.mounting[:2]):
        return None
    bodies = _moving(run) if bodies is None else bodies
    exact = replace(lidar, range_noise=0.0, dropout=0.0)
    first, last = (lidar.mounting[2] + lidar.bearings[[0, -1]]).tolist()

    def ranges(row: int) -> Array:
        discs = [(*run.obstacle_position[row, column], size) for column, _, _, size, box in bodies if box is None]
        there = [each for each in discs if math.isfinite(each[0])] if lidar.sees_obstacles else []
        return np.asarray(exact.scan(run.position[row], float(run.heading[row]), people=there))

    return PlayedLidar(first, last, lidar.range_max, ranges)


def _clearance(
    run: Run, maps: Iterable[StaticMap], bodies: Bodies, radius: float, outline: Footprint | None
) -> Array | None:
    """Return how far the robot is from what is nearest, in m, NaN where unknown; ``None`` without distances."""
    if run.distance is None:
        return None
    found = np.full(len(run.time), np.inf)
    here = np.isfinite(run.position).all(axis=1)
    found[~here] = np.nan
    for each in maps:
        if each.bounds is not None:
            if outline is None:
                away = np.asarray(each.clearance(run.position[here])) - radius
            else:
                away = outline.clearance(each, run.position[here], run.heading[here])
            found[here] = np.minimum(found[here], away)
    for column, _, _, size, box in bodies:
        away = run.distance[:, column] - radius - (0.0 if box is not None else size)
        found = np.minimum(found, np.where(np.isnan(away), np.inf, away))
    return found


def _events(run: Run, bodies: Bodies, maps: Sequence[StaticMap]) -> Iterator[Event]:
    """Yield contacts of a robot and its arrival."""
    known = {column: (name, size, box) for column, _, name, size, box in bodies}
    several = len(getattr(run.scenario, "robots", ())) > 1
    who = f"robot {run.robot}: " if several else ""
    for index, when in enumerate(run.contact_time.tolist()):
        if math.isnan(when):
            continue
        name, size, box = known.get(index, (f"obstacle {index}", math.nan, None))
        speed, fault = float(run.contact_speed[index]), bool(run.contact_at_fault[index])
        did = "robot standing" if speed <= STANDING else "toward it" if run.contact_toward[index] else "away from it"
        words = f"{who}contact with {name}, {speed:.2f} m/s, {did}{', at fault' if fault else ''}"
        row = _row(run, when)
        place = run.position[row]
        if box is None and math.isfinite(size):
            # Between the centers, as far from each as its radius says.
            other = run.obstacle_position[row, index]
            share = _radius(run) / max(_radius(run) + size, 1e-9)
            place = place + share * (other - place) if np.isfinite(other).all() else place
        elif maps and index not in known:
            place = _nearest(maps, place)
        yield Event(when, "fault" if fault else "contact", words, (float(place[0]), float(place[1])))
    if not math.isnan(run.map_contact_time):
        place = _nearest(maps, run.position[_row(run, run.map_contact_time)])
        words = f"{who}contact with a wall, {run.map_contact_speed:.2f} m/s, at fault"
        yield Event(run.map_contact_time, "fault", words, (float(place[0]), float(place[1])))
    if run.arrival_time is not None and math.isfinite(run.arrival_time):
        yield Event(run.arrival_time, "arrival", f"{who}arrived at the goal")
    elif run.outcome in ("timed_out", "stopped"):
        yield Event(float(run.time[-1]), "note", f"{who}{OUTCOMES[run.outcome]}")


def _row(run: Run, when: float) -> int:
    return min(int(np.searchsorted(run.time, when - 1e-9)), len(run.time) - 1)


def _radius(run: Run) -> float:
    scene = run.scenario
    body = scene.robots[run.robot].body if hasattr(scene, "people") else scene.robot
    return float(body.radius)


def _nearest(maps: Sequence[StaticMap], place: Array) -> Array:
    """Return the point of maps that is nearest to a place; the place itself without any."""
    points = [np.asarray(each.nearest(place)) for each in maps if each.bounds is not None]
    return min(points, key=lambda point: float(np.hypot(*(point - place))), default=place)


def _facts(run: Run, *, of_world: bool) -> Iterator[tuple[str, str]]:
    scene = run.scenario
    if of_world:
        yield "people", str(run.obstacle_position.shape[1])
        yield "time step", f"{scene.step:g} s"
    if scene is not None:
        yield "seed", str(scene.seed)
    for own in run.robots:
        who = f" of robot {own.robot}" if len(run.robots) > 1 else ""
        yield f"path length{who}", f"{own.path_length:.2f} m"
        if own.law is not None:
            yield f"law{who}", type(own.law).__name__
        if own.contacts_apart:
            yield f"contacts{who} with somebody who appeared on it, counted apart", str(own.contacts_apart)
    if scene is not None and not of_world:
        told = run.sensing
        yield "sensing", f"robot {told.robot}, obstacles {', '.join(told.obstacles)}"
