"""Places that the robot knows from its scans alone: BARN worlds and dead ends, a rectangle on two wheels."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np

from hrsafety import navigation as nav
from hrsafety._records import dataclass
from hrsafety.benchmarks import barn
from hrsafety.benchmarks.entries import Entry, settings_of
from hrsafety.benchmarks.protocol import Case, Suite
from hrsafety.benchmarks.results import Row
from hrsafety.errors import InvalidParameterError

__all__ = ["UNKNOWN", "RolloutEntry", "driving_time", "rollout_entry", "trial"]

LENGTH, WIDTH = 0.508, 0.430
"""Of the rectangle, in m."""
SPEED, TURN_RATE = 2.0, 4.0
"""Largest ones, in m/s and rad/s."""
PERIOD = 0.05
"""Control period in s."""
START, GOAL, HEADING = (-2.25, 3.0), (-2.25, 13.0), 0.5 * math.pi
"""Of BARN, in m and rad."""
STEP = PERIOD / 20
"""Motion step in s."""
LEFT = 0.1
"""An episode is timed from where the robot leaves this distance from its start, in m."""
BEAMS, FIELD_OF_VIEW, RANGE = 720, 1.5 * math.pi, 10.0
"""Of the lidar, in rad and m."""
LENGTH_DRIFT, HEADING_DRIFT = 0.01, math.radians(0.5)
"""Of an odometry with a drift of 1: share of lengths, and rad for each m."""
DEAD_ENDS = 30
SETTINGS = ("acceleration", "turn_acceleration", "noise", "dropout", "drift", "late", "margin", "range", "verify")


@dataclass(frozen=True, kw_only=True, slots=True)
class RolloutEntry(Entry):
    """A robot of a certain acceleration, with certain sensors, that finds its way by arc rollouts.

    Parameters
    ----------
    name : str
        The word.
    law : ArcRollouts
        How it finds its way.
    parts : tuple of str
        Empty: rollouts have guide and verified plans of their own.
    acceleration, turn_acceleration : float
        Largest ones in m/s^2 and rad/s^2.
    noise : float
        Standard deviation of ranges in m.
    dropout : float
        Share of beams that read nothing.
    drift : float
        Multiple of an odometry that is 1 % wrong in lengths and 0.5 degrees in each m.
    late : int
        Control periods by which scans come late.
    range : float
        Largest range in m.
    """

    law: nav.ArcRollouts
    acceleration: float
    turn_acceleration: float
    noise: float
    dropout: float
    drift: float
    late: int
    range: float


def rollout_entry(word: str) -> RolloutEntry:
    """Return the robot that a word names.

    Parameters
    ----------
    word : str
        ``rollouts``, with settings in brackets where they are others than usual:
        ``rollouts(acceleration=3,noise=0.03,drift=1)``.

    Returns
    -------
    RolloutEntry
        What is to be run.

    Raises
    ------
    InvalidParameterError
        If the word or a setting is unknown.

    Examples
    --------
    >>> from hrsafety.benchmarks.unknown import rollout_entry
    >>> rollout_entry("rollouts(acceleration=3)").turn_acceleration
    6.0
    """
    values = settings_of(word, ("rollouts",), SETTINGS)
    acceleration = values.get("acceleration", 10.0)
    late = values.get("late", 0.0)
    if late != int(late):
        raise InvalidParameterError("laws", "give late a whole number of control periods", word)
    return RolloutEntry(
        name=word,
        law=nav.ArcRollouts(margin=values.get("margin", 0.03), verify=bool(values.get("verify", 1.0))),
        parts=(),
        acceleration=acceleration,
        turn_acceleration=values.get("turn_acceleration", max(4.0, 2.0 * acceleration)),
        noise=values.get("noise", 0.01),
        dropout=values.get("dropout", 0.0),
        drift=values.get("drift", 0.0),
        late=int(late),
        range=values.get("range", RANGE),
    )


def trial(entry: RolloutEntry, place: nav.StaticMap, seed: int, **ends: Any) -> nav.Trajectory:
    """Run an episode until the goal, the first contact or the time limit.

    Parameters
    ----------
    entry : RolloutEntry
        The robot.
    place : StaticMap
        What is there.
    seed : int
        Of noise and drift.
    **ends
        Start, heading, goal, arrival tolerance and time limit where they are not those of BARN.

    Returns
    -------
    Trajectory
        Commands act at once, every 2.5 ms is recorded.
    """
    scene, built = episode(entry, place, seed, **ends)
    return nav.simulate(scene, entry.law, built=built, step=STEP, stop_on_contact=True)


def episode(
    entry: RolloutEntry, place: nav.StaticMap, seed: int, **ends: Any
) -> tuple[nav.Scenario, nav.robots.AsBuilt]:
    """Return scenario and sensors of a `trial`."""
    robot = nav.DifferentialDriveRobot(
        max_speed=SPEED,
        max_acceleration=entry.acceleration,
        max_turn_rate=TURN_RATE,
        max_turn_acceleration=entry.turn_acceleration,
        footprint=nav.robots.Footprint.rectangle(LENGTH, WIDTH),
    )
    given: dict[str, Any] = {"start": START, "heading": HEADING, "goal": GOAL, "arrival_tolerance": 1.0, **ends}
    limit = given.pop("time_limit", barn.LIMIT)
    scene = nav.Scenario(
        robot=robot, walls=place, control_period=PERIOD, time_limit=limit, rest_time=limit, seed=seed, **given
    )
    lidar = nav.Lidar(
        map=place,
        beams=BEAMS,
        field_of_view=FIELD_OF_VIEW,
        range_max=entry.range,
        range_noise=entry.noise,
        dropout=entry.dropout,
        latency=entry.late * PERIOD,
    )
    odometry = nav.sensing.Odometry(length_error=LENGTH_DRIFT * entry.drift, heading_error=HEADING_DRIFT * entry.drift)
    return scene, nav.robots.AsBuilt(sensors=[lidar, odometry])


def driving_time(run: nav.Trajectory) -> float:
    """Return the time in s from leaving the circle around the start to the end of a run."""
    left = np.hypot(*(run.position - run.scenario.start).T) > LEFT
    return float(run.time[-1] - (run.time[int(np.argmax(left))] if left.any() else 0.0))


def _row(case: int, run: nav.Trajectory) -> Row:
    arrived, touched = run.outcome == "arrived", int(run.outcome == "collided")
    return Row(
        case=case,
        outcome=run.outcome,
        arrival_time=driving_time(run) if arrived else math.nan,
        end_time=float(run.time[-1]),
        contacts=touched,
        # Everything stands: who touches it is at fault.
        toward=touched,
        at_fault=touched,
        walls=touched,
        apart=0,
        clearance=run.map_clearance,
    )


def _entry(case: Case) -> RolloutEntry:
    if not isinstance(case.entry, RolloutEntry):
        raise InvalidParameterError("laws", "be rollouts", case.entry.name)
    return case.entry


def _worlds(case: Case) -> Iterator[Row]:
    worlds = barn.own_times(case.data)
    names = list(worlds)
    for index in case.cases:
        loaded, optimum = worlds[names[index]]
        place = nav.maps.StaticMap.from_barn(loaded, names[index])
        seed = case.seed * barn.MOST_WORLDS + names[index]
        yield barn.barn_score(_row(index, trial(_entry(case), place, seed)), optimum)


def dead_end(index: int, seed: int) -> nav.StaticMap:
    """Return a place of one or two dead ends between start and goal, open toward the start.

    Parameters
    ----------
    index : int
        Number of the place.
    seed : int
        Of the draw.

    Returns
    -------
    StaticMap
        Walls of the dead ends and of the hall around them.
    """
    draw = np.random.Generator(np.random.PCG64([seed, index]))
    walls = [nav.maps.PolylineWall(((-2.0, -5.0), (12.0, -5.0), (12.0, 5.0), (-2.0, 5.0), (-2.0, -5.0)), 0.02)]
    for number in range(1 + index % 2):
        depth, half = draw.uniform(1.0, 2.2), 0.5 * draw.uniform(1.2, 2.4)
        end, middle = 3.5 + 3.0 * number + draw.uniform(0.0, 0.5), draw.uniform(-0.4, 0.4)
        low, high = middle - half, middle + half
        walls.append(nav.maps.PolylineWall(((end - depth, low), (end, low), (end, high), (end - depth, high)), 0.05))
    return nav.StaticMap(walls=walls)


def _dead_ends(case: Case) -> Iterator[Row]:
    ends: dict[str, Any] = {"start": (0.0, 0.0), "heading": 0.0, "goal": (10.0, 0.0)}
    for index in case.cases:
        found = trial(_entry(case), dead_end(index, case.seed), case.seed * DEAD_ENDS + index, **ends)
        yield _row(index, found)


def _settings(*accelerations: float) -> tuple[str, ...]:
    sensing = ("noise=0.01", "noise=0.03,drift=1")
    return tuple(f"rollouts(acceleration={most:g},{each})" for most in accelerations for each in sensing)


def _suite(name: str, summary: str, laws: tuple[str, ...], run: Callable[[Case], Iterator[Row]], **more: Any) -> Suite:
    guarded = f"{summary}; known from scans alone, which show nothing thinner than beams are apart and no glass"
    return Suite(
        name=name, summary=guarded, fastest=0.0, sensed=False, seed=0, run=run, entry=rollout_entry, **more, laws=laws
    )


UNKNOWN = (
    _suite(
        "unknown_barn",
        "fields of cylinders, a rectangle on two wheels",
        _settings(10, 3, 1),
        _worlds,
        cases=150,
        most=barn.MOST_WORLDS,
        files=barn.world_files,
        available=barn.worlds_in,
        accepted={
            (word, None): f"100 / 0, score {0.48 if 'acceleration=1,' in word else 0.5:.3f}"
            for word in _settings(10, 3, 1)
        },
    ),
    _suite(
        "dead_ends",
        "one or two dead ends on the way",
        _settings(10),
        _dead_ends,
        cases=DEAD_ENDS,
        most=100_000,
        accepted={(word, None): "100 / 0" for word in _settings(10)},
    ),
)
"""Suites of places that are not known."""
