"""Places with corners behind which people hide: a corner of a corridor, a corridor with doors, and rooms."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import field
from itertools import groupby, pairwise

import numpy as np

from hrsafety import navigation as nav
from hrsafety._arguments import Array
from hrsafety._records import dataclass
from hrsafety.benchmarks.entries import Entry, settings_of
from hrsafety.benchmarks.protocol import Case, Suite
from hrsafety.benchmarks.results import Row
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.pursuits import hidden_encounters

__all__ = ["HIDDEN", "HiddenEntry", "encounters", "hidden_entry"]

PERSON, WALKING = 0.3, 1.6
"""Radius in m and speed in m/s of the person."""
ROBOT = nav.HolonomicRobot(radius=0.2, max_speed=1.2, max_acceleration=2.0)
EACH = 5
"""Encounters in a place, evenly spread over the run with nobody there."""
LIMIT = 60.0
"""Of a run, in s."""
SETTINGS = ("creep", "reckon", "cell", "sampling")

Point = tuple[float, float]
Place = tuple[nav.StaticMap, Point, Point]


def _box(lower: Point, upper: Point) -> list[Point]:
    (a, b), (c, d) = lower, upper
    return [(a, b), (c, b), (c, d), (a, d), (a, b)]


def _corner(rng: np.random.Generator) -> Place:
    """Return a corridor with a corner."""
    (one, other), side = rng.uniform(1.4, 2.4, 2), 8.6
    inner = side - other
    outline = [(0, 0), (side, 0), (side, side), (inner, side), (inner, one), (0, one), (0, 0)]
    goal = (side - other / 2, side - 0.8)
    return nav.StaticMap.from_polylines([outline], radius=0.05), (0.8, one / 2), goal


def _doors(rng: np.random.Generator) -> Place:
    """Return a corridor with a closet behind each of 8 doors."""
    width = rng.uniform(1.5, 2.4)
    lines: list[list[Point]] = [_box((0, -2.5), (14, width + 2.5))]
    for side in (0.0, width):
        away = -2.5 if side == 0.0 else width + 2.5
        at = 0.0
        for index in range(4):
            left = 2.0 + 3.0 * index + rng.uniform(0.0, 1.0)
            lines.append([(at, side), (left, side)])
            at = left + rng.uniform(0.9, 1.2)
            if index:
                middle = 0.5 + 3.0 * index + 0.5
                lines.append([(middle, side), (middle, away)])
        lines.append([(at, side), (14, side)])
    return nav.StaticMap.from_polylines(lines, radius=0.05), (0.8, width / 2), (13.2, width / 2)


def _rooms(rng: np.random.Generator) -> Place:
    """Return 3 times 2 rooms with doors in all walls between them."""
    across = [0.0, *(np.array([3.0, 6.0]) + rng.uniform(-0.4, 0.4, 2)).tolist(), 9.0]
    up = [0.0, 3.0 + rng.uniform(-0.4, 0.4), 6.0]
    lines: list[list[Point]] = [_box((0, 0), (9, 6))]
    for x in across[1:-1]:
        for low, high in pairwise(up):
            door = rng.uniform(0.9, 1.3)
            first = rng.uniform(low + 0.3, high - 0.3 - door)
            lines += [[(x, low), (x, first)], [(x, first + door), (x, high)]]
    for left, right in pairwise(across):
        door = rng.uniform(0.9, 1.3)
        first = rng.uniform(left + 0.3, right - 0.3 - door)
        lines += [[(left, up[1]), (first, up[1])], [(first + door, up[1]), (right, up[1])]]
    return nav.StaticMap.from_polylines(lines, radius=0.05), (0.9, 0.9), (8.1, 5.1)


PLACES: dict[str, Callable[[np.random.Generator], Place]] = {"corner": _corner, "doors": _doors, "rooms": _rooms}


@dataclass(frozen=True, kw_only=True, slots=True)
class HiddenEntry(Entry):
    """A robot with a guide and a shield in places of a kind, in which people hide.

    Parameters
    ----------
    name : str
        The word.
    law : Law
        The law within guide and shield.
    parts : tuple of str
        Guide and shield.
    unseen : Unseen
        What the shield assumes of people who are not seen.
    """

    unseen: nav.Unseen = field(default_factory=nav.Unseen)

    @property
    def place(self) -> str:
        """Kind of place."""
        return self.name.strip().lower().partition("(")[0]


def hidden_entry(word: str) -> HiddenEntry:
    """Return the robot and the kind of place that a word names.

    Parameters
    ----------
    word : str
        ``corner``, ``doors`` or ``rooms``, with settings in brackets where they are others than usual: ``creep``, the
        speed up to which plans reckon with seen people only, in m/s; ``reckon=0`` for a shield that reckons with those
        only; ``cell`` in m, 0.025 unless given, and ``sampling`` in s of `Unseen`.

    Returns
    -------
    HiddenEntry
        What is to be run.

    Raises
    ------
    InvalidParameterError
        If the word or a setting is unknown.

    Examples
    --------
    >>> from hrsafety.benchmarks.hidden import hidden_entry
    >>> hidden_entry("doors(creep=0.1)").unseen.creep_speed
    0.1
    """
    values = settings_of(word, tuple(PLACES), SETTINGS)
    if values.get("reckon", 1.0) not in (0.0, 1.0) or {"reckon", "creep"} <= set(values):
        raise InvalidParameterError("laws", "give reckon 0 or 1, and creep without it", word)
    return HiddenEntry(
        name=word,
        law=nav.VirtualForceField(),
        parts=("guide", "shield"),
        unseen=nav.Unseen(
            person_radius=PERSON,
            # Plans are never faster than the robot.
            creep_speed=values.get("creep", 0.0) if values.get("reckon", 1.0) else ROBOT.max_speed,
            cell=values.get("cell", 0.025),
            sampling=values.get("sampling", 0.0125),
        ),
    )


def encounters(
    entry: HiddenEntry, number: int, *, seed: int = 0, person_speed: float = WALKING, most: int = EACH
) -> tuple[dict[str, Array], float]:
    """Return the encounters in a place, and when the robot arrives with nobody there.

    Parameters
    ----------
    entry : HiddenEntry
        Robot and kind of place.
    number : int
        Number of the place.
    seed : int
        Of the draw of places and starts.
    person_speed : float
        What the shield assumes, in m/s.
    most : int
        Most encounters.

    Returns
    -------
    columns : dict
        Those of `hrsafety.navigation.pursuits.hidden_encounters`.
    arrival_time : float
        In s; NaN if it does not.
    """
    place, start, goal = PLACES[entry.place](np.random.Generator(np.random.PCG64([seed, number])))
    law = nav.SafeNavigation(
        entry.law,
        map=place,
        guide=nav.maps.Guide(),
        shield=nav.Shield(person_speed=person_speed, unseen=entry.unseen),
    )
    scene = nav.Scenario(robot=ROBOT, start=start, goal=goal, control_period=0.05, time_limit=LIMIT, rest_time=LIMIT)
    draws = seed * 1_000_003 + number
    return hidden_encounters(scene, law, radius=PERSON, speed=WALKING, most=most, seed=draws)


def _hidden(case: Case) -> Iterator[Row]:
    entry = case.entry
    if not isinstance(entry, HiddenEntry):
        raise InvalidParameterError("laws", "be corner, doors or rooms", entry.name)
    for number, group in groupby(case.cases, lambda index: index // EACH):
        found, alone = encounters(entry, number, seed=case.seed, person_speed=case.person_speed)
        for index in group:
            at = index % EACH
            toward, away, standing = (int(found[f"contacts_{each}"][at]) for each in ("toward", "away", "standing"))
            touched = toward + away + standing
            yield Row(
                case=index,
                outcome="collided" if touched else "timed_out" if math.isnan(alone) else "arrived",
                arrival_time=alone,
                end_time=float(found["end_time"][at]),
                contacts=touched,
                toward=toward,
                away=away,
                at_fault=int(found["margin"][at] < 0.0),
                walls=int(found["wall_contacts"][at]),
                apart=0,
                clearance=float(found["min_clearance"][at]),
            )


SUITE_LAWS = tuple(f"{place}{setting}" for place in PLACES for setting in ("(reckon=0)", "", "(creep=0.1)"))

HIDDEN = (
    Suite(
        name="hidden_people",
        fastest=WALKING,
        summary=(
            f"a robot of {ROBOT.max_speed:g} m/s and {ROBOT.max_acceleration:g} m/s^2 in places where people hide: at "
            f"{EACH} instants of a run somebody comes out of the worst of 48 places; arrival times are those with "
            "nobody there"
        ),
        laws=SUITE_LAWS,
        cases=10 * EACH,
        seed=0,
        most=1_000_000,
        sensed=False,
        accepted={(word, WALKING): "- / - / 0" for word in SUITE_LAWS if "reckon" not in word},
        entry=hidden_entry,
        run=_hidden,
    ),
)
"""Suites of people who hide."""
