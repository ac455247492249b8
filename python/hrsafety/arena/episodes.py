"""Episodes of the arena: an entry in standard scenes, how people are measured, and how each ends."""

from __future__ import annotations

import contextlib
import functools
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Any

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._arguments import Array
from hrsafety._records import dataclass
from hrsafety.arena.cards import CARDS, task_error
from hrsafety.benchmarks.entries import Entry
from hrsafety.benchmarks.reacting import SCENE_ERROR
from hrsafety.navigation.crowd.contacts import Contacts, contacts_of
from hrsafety.navigation.crowd.simulation import simulated
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.crowd.world_run import WorldRun
from hrsafety.navigation.laws.python_law import PythonLaw
from hrsafety.sweep import Column
from hrsafety.sweep.studies import Found, Study

__all__ = ["COLUMNS", "ENDS", "METRICS", "PERSON_SPEED", "SENSINGS", "TASK_ERROR", "ArenaStudy"]

ENDS = ("success", "by_robot", "by_person", "wall", "late", "lost")
"""How an episode ends: a contact that the robot moved toward counts first, then one with a wall, then others."""
SENSINGS: Mapping[str, tuple[float, float]] = MappingProxyType(
    {"exact": (0.0, 0.0), "noise": (0.025, 0.0), "noise_delay": (0.025, 0.1)}
)
"""Half width of the error of each coordinate of measured people in m, and their age in s."""
PERSON_SPEED = 1.8
"""Speed of people that shields assume, in m/s: that of the fastest in the scenes."""
TASK_ERROR = 0.75
"""Mean distance in m from the moving goal up to which a task is done."""
METRICS = tuple(dict.fromkeys(metric for metrics in CARDS.values() for metric in metrics))
"""Metrics of the cards."""
OF_PEOPLE = frozenset({"person_delay", "person_detour"})
"""Those that compare people with the same people in the scene without its robot."""
COLUMNS = (
    Column(name="end", kind="word", words=ENDS),
    Column(name="arrival_time", unit="s"),
    Column(name="task_error", unit="m"),
    *(Column(name=name) for name in METRICS),
)
"""Columns of an episode; metrics of other cards are NaN."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ArenaStudy(Study):
    """An entry in standard scenes, a row for each scene and seed.

    Parameters
    ----------
    entry : Entry
        What drives the robot.
    reacting : bool
        Whether people notice the robot.
    sensing : str
        One of `SENSINGS`.
    """

    entry: Entry
    reacting: bool
    sensing: str

    def units(self, names: Sequence[str]) -> dict[str, str]:  # noqa: ARG002  # numbers have none
        """Return no units: scenes and seeds are numbers."""
        return {}

    def columns(self) -> tuple[Column, ...]:
        """Return what is found for each episode."""
        return COLUMNS

    def compute(self, rows: dict[str, Array], threads: int | None = None) -> Found:
        """Return the episodes of some rows; scenes with the same walls share the plan of the guide.

        An episode in which a law of the user raises an error, or asks for a number that is not finite, is lost.
        """
        runs = _finished(self.worlds(rows["scene"], rows["seed"]), threads)
        count = len(rows["scene"])
        found: dict[str, Any] = {column.name: np.full(count, np.nan) for column in COLUMNS[1:]}
        ends = ["lost"] * count
        told = [
            nav.crowd.episodes_of(run, self._without(int(rows["scene"][index]), int(rows["seed"][index])))[0]
            for index, run in runs.items()
        ]
        table = nav.metrics.evaluate_many(told, threads=threads) if told else None
        for row, (index, run) in enumerate(runs.items()):
            assert table is not None  # there is a run
            found["arrival_time"][index] = arrival = float(table.arrival_time[row])
            if run.scenario.robots[0].task is not None:
                found["task_error"][index] = task_error(run)
            touched = contacts_of(told[row], arrival), int(table.wall_contacts[row])
            ends[index] = _end(run, touched, found["task_error"][index])
            for metric in CARDS[scenarios.SOCIAL[int(rows["scene"][index])]]:
                found[metric][index] = getattr(table, metric)[row]
        return found | {"end": np.array(ends)}

    def worlds(self, scene: Iterable[float], seed: Iterable[float]) -> list[World]:
        """Return scenes with the entry in them, by their numbers and seeds."""
        laws: dict[object, nav.Law] = {}
        noise, latency = SENSINGS[self.sensing]
        measured = nav.Measurement(scale=noise, latency=latency, of="obstacles") if noise or latency else None
        found = []
        for number, each in zip(scene, seed, strict=True):
            world = _scene(int(number), int(each), self.reacting)
            walls = tuple(each for each in world.wall_shapes if isinstance(each, tuple))
            if walls not in laws:
                laws[walls] = self._built(walls, noise, latency)
            robot = replace(world.robots[0], law=laws[walls], measurement=measured)
            found.append(replace(world, robots=[robot]))
        return found

    def _without(self, scene: int, seed: int) -> WorldRun | None:
        """Return a scene without its robot, if its card asks what the robot costs people."""
        asked = not OF_PEOPLE.isdisjoint(CARDS[scenarios.SOCIAL[scene]])
        return _without_robot(scene, seed, self.reacting) if asked else None

    def why_lost(self, scene: int, seed: int) -> str:
        """Return what happens in an episode that is lost, which is run again."""
        try:
            simulated(self.worlds([scene], [seed]))
        except Exception as error:  # whatever a law of the user raises
            return f"the law raised {type(error).__name__}: {error}"
        return "the world diverged"

    def _built(self, walls: tuple[Any, ...], noise: float, latency: float) -> nav.Law:
        """Return the law of the entry among walls, with a guide around them."""
        map = _map(walls) if walls else None
        law = self.entry.law
        if isinstance(law, nav.SafeNavigation):
            return law if law.map is not None else law.replaced(map=map, guide=law.guide or nav.maps.Guide())
        guided = replace(self.entry, parts=tuple(dict.fromkeys(("guide", *self.entry.parts))))
        error = float(np.hypot(noise, noise))
        return guided.built(
            person_speed=PERSON_SPEED, latency=latency, position_error=error, margin=SCENE_ERROR, map=map
        )


@functools.lru_cache(maxsize=64)
def _scene(number: int, seed: int, reacting: bool) -> World:
    """Return a scene, which all entries share."""
    return scenarios.social(scenarios.SOCIAL[number], seed, reacting=reacting)


@functools.lru_cache(maxsize=64)
def _without_robot(number: int, seed: int, reacting: bool) -> WorldRun:
    """Return a scene without its robot, which all entries share."""
    (found,) = simulated([replace(_scene(number, seed, reacting), robots=[])])
    return found


@functools.lru_cache(maxsize=24)
def _map(walls: tuple[Any, ...]) -> nav.StaticMap:
    """Return the map of walls, whose plans all entries share."""
    return nav.StaticMap.from_polylines(walls)


def _finished(worlds: Sequence[World], threads: int | None) -> dict[int, WorldRun]:
    """Return the runs by their rows; without those in which a law of the user fails."""
    try:
        return dict(enumerate(simulated(worlds, threads=threads)))
    except Exception:  # whatever a law of the user raises
        if not any(_in_python(world.robots[0].law) for world in worlds):
            raise
    found = {}
    for row, world in enumerate(worlds):
        with contextlib.suppress(Exception):  # that episode is lost
            (found[row],) = simulated([world], threads=threads)
    return found


def _in_python(law: object) -> bool:
    """Return whether a law is a function or an object of the user."""
    while isinstance(law, nav.SafeNavigation):
        law = law.law
    return isinstance(law, PythonLaw)


def _end(run: WorldRun, touched: tuple[Contacts, int], error: float) -> str:
    """Return how an episode ended."""
    people, walls = touched
    ends = {
        "lost": run.diverged is not None,
        "by_robot": people.toward > 0,
        "wall": walls > 0,
        "by_person": people.moving + people.standing > 0,
        "late": np.isnan(run.robot_arrival_time[0]) or error > TASK_ERROR,
    }
    return next((end for end, is_so in ends.items() if is_so), "success")
