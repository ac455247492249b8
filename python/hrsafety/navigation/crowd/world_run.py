"""The run of a world, of which ends and contacts of the robots are found when they are asked for."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import MISSING, fields
from typing import Any, NoReturn

import numpy as np

from hrsafety._arguments import assign
from hrsafety.navigation.crowd.contacts import touches_of
from hrsafety.navigation.crowd.doubts import of_people
from hrsafety.navigation.crowd.episodes import episodes_in, outcome_of
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.knowledge import Sensing, told_by
from hrsafety.navigation.metrics.between import distances_of, first_wall_contact, paths_of, until_arrival, wrapped
from hrsafety.navigation.metrics.scores import table_of
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.trajectory import Divergence, Trajectory
from hrsafety.navigation.warnings.runs import of_commands, of_way
from hrsafety.navigation.warnings.shields import maps_of
from hrsafety.navigation.warnings.walls import passed_walls
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, plane

__all__ = ["WorldRun"]

_OF_ONE_ROBOT = (
    *("law", "position", "velocity", "heading", "arrival_time", "energy"),
    *("outcome", "distance", "min_distance", "min_clearance", "path_length"),
    *("contact_time", "contact_speed", "contact_toward", "contact_at_fault", "contact_apart"),
    *("map_contact_time", "map_contact_speed", "map_clearance"),
)


class WorldRun(Trajectory):
    """A `Trajectory` of a world.

    Parameters
    ----------
    scenario : World
        The world.
    recorded : dict of str to object
        What the core has recorded, by name.
    robot : int or None
        Which robot the run is that of; ``None``: of the only one, if there is one.
    """

    __slots__ = ("_recorded", "_robot")

    def __init__(self, scenario: World, recorded: dict[str, Any], robot: int | None = None) -> None:
        if robot is None and len(scenario.robots) == 1:
            robot = 0
        assign(self, "_recorded", recorded)
        assign(self, "scenario", scenario)
        diverged = recorded["diverged"]
        values = {each.name: None if each.default is MISSING else each.default for each in fields(Trajectory)}
        values |= {name: value for name, value in recorded.items() if name in values}
        values |= {"scenario": scenario, "motion_step": scenario.step}
        values |= {"diverged": None if diverged is None else Divergence(*diverged)}
        values["_robot"] = robot
        for name in _OF_ONE_ROBOT:
            del values[name]  # their slots are filled when they are asked for, see `__getattr__`
        if robot is not None:
            values["law"] = scenario.robots[robot].law
            values |= {name: recorded[f"robot_{name}"][:, robot] for name in ("position", "velocity", "heading")}
            values["arrival_time"] = float(recorded["robot_arrival_time"][robot])
            values["energy"] = float(self.robot_energy[robot])
            values["commanded_periods"] = self._commanded[robot]
        for name, value in values.items():
            assign(self, name, value)

    def __getattr__(self, name: str) -> Any:
        """Find how the run ended for its robot, or say whose values are meant."""
        if self._robot is None and isinstance(getattr(Trajectory, name, None), property):
            self._refuse(name)  # asked for what one robot has
        if name not in _OF_ONE_ROBOT:
            raise AttributeError(f"'Trajectory' object has no attribute {name!r}", name=name, obj=self)
        if self._robot is None:
            self._refuse(name)
        found = self._met(self._robot)
        for each, value in found.items():
            assign(self, each, value)
        return found[name]

    def _refuse(self, name: str) -> NoReturn:
        count = len(self.scenario.robots)
        advice = f"take run.robots[i].{name}" if count else "it has no robot"
        raise AttributeError(f"the run of a world with {count} robots has no {name!r}: {advice}", name=name, obj=self)

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by what the core has recorded."""
        return WorldRun, (self.scenario, self._recorded, self._robot)

    @property
    def robot(self) -> int:
        """Index of the robot whose run it is."""
        if self._robot is None:
            self._refuse("robot")
        return int(self._robot)

    @property
    def sensing(self) -> Sensing:
        """Which sensors told the law of the robot and of the others."""
        own = self.scenario.robots[self.robot]
        return told_by(own.measurement, own.as_built() or AsBuilt())

    @property
    def robots(self) -> tuple[Trajectory, ...]:
        """The run as each robot has it."""
        if self._robot is not None and len(self.scenario.robots) == 1:
            return (self,)
        return tuple(WorldRun(self.scenario, self._recorded, index) for index in range(len(self.scenario.robots)))

    robot_position = property(lambda self: self._recorded["robot_position"])
    robot_velocity = property(lambda self: self._recorded["robot_velocity"])
    robot_heading = property(lambda self: self._recorded["robot_heading"])
    robot_energy = property(lambda self: self._recorded.get("robot_energy", np.full(len(self.scenario.robots), np.nan)))
    robot_arrival_time = property(lambda self: self._recorded["robot_arrival_time"])

    @property
    def _commanded(self) -> tuple[int, ...]:
        """Control periods in which each robot was commanded from outside."""
        commanded: tuple[int, ...] = self._recorded.get("commanded", (0,) * len(self.scenario.robots))
        return commanded

    def _met(self, robot: int) -> dict[str, Any]:
        """Return how the run ended for a robot, and which people and walls it touched."""
        places = self.robot_position, self.obstacle_position, self.obstacle_radius
        episode = episodes_in(self.scenario, *places, robot_heading=self.robot_heading)[robot]
        scored = table_of([episode], threads=1)[0]
        touches = touches_of(episode, scored.arrival_time)
        own, people = until_arrival(episode, scored.arrival_time)
        if people.size and len(own) > 1:
            start, _, nearest = paths_of(episode, own, people)
            apart = distances_of(episode, start)
            least = np.fmin.reduce(np.concatenate([apart, nearest]), axis=0)
        else:
            least = np.full(len(self.obstacle_radius), np.inf)
        least = np.where(np.isnan(least), np.inf, least)
        walls = first_wall_contact(episode, scored.arrival_time) if scored.wall_contacts else (math.nan, math.nan)
        away = wrapped(self.obstacle_position - self.robot_position[:, robot, None], self.scenario.period)
        arrived = not math.isnan(self.arrival_time)
        running = not arrived and self._recorded.get("running", False)
        touched = touches.counted or scored.wall_contacts > 0
        return {
            "outcome": "running"
            if running
            else outcome_of(touched=touched, arrived=arrived, diverged=self.diverged is not None),
            "distance": distances_of(episode, away),
            "min_distance": least,
            "min_clearance": least - episode.robot_radius - self.obstacle_radius,
            **{f"contact_{each}": values for each, values in touches._asdict().items()},
            "map_contact_time": walls[0],
            "map_contact_speed": walls[1],
            "map_clearance": scored.wall_clearance,
            "path_length": scored.path_length,
        }

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each instant.

        Returns
        -------
        dict of str to ndarray
            Units are in the names; people, as obstacles, and the robots of a world with several are numbered.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> world = nav.World(people=[nav.Person(start=(0, 0), route=[(2, 0)])])
        >>> list(nav.simulate(world).columns())[:3]
        ['t_s', 'obstacle_0_x_m', 'obstacle_0_y_m']
        """
        if self._robot is not None:
            found = super().columns()
        else:
            found = {"t_s": self.time}
            for index in range(len(self.scenario.robots)):
                found |= plane(f"robot_{index}_{{}}", self.robot_position[:, index], "m")
                found |= plane(f"robot_{index}_v{{}}", self.robot_velocity[:, index], "m/s")
            for index in range(self.obstacle_position.shape[1]):
                found |= plane(f"obstacle_{index}_{{}}", self.obstacle_position[:, index], "m")
        for index in range(self.obstacle_position.shape[1]):
            found |= plane(f"obstacle_{index}_v{{}}", self.obstacle_velocity[:, index], "m/s")
        return found

    def _passed(self, robot: int) -> Iterator[ResultWarning]:
        """Yield a warning if a robot touches walls that only its law knows."""
        own, places = self.scenario.robots[robot], self.robot_position[:, robot]
        maps = [map for map in maps_of(own.law) if map is not self.scenario.walls]
        known = np.isfinite(places).all(axis=1)
        if maps and known.any():
            gaps = [gap for gap, _ in self.scenario._native.nearest_walls(places[known].tolist())]
            yield from passed_walls(maps, own.body, places[known], self.robot_heading[known, robot], np.array(gaps))

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Warnings of the world; divergence, ways over unknown ground, people set back at walls, or too fast.

        Of a `Run` also commands that a shield has not verified.
        """
        # Of a world that diverged its end says more than a speed.
        speed = self.max_person_speed if self.diverged is None else 0.0
        asked = range(len(self.scenario.robots)) if self._robot is None else (self._robot,)
        told = [each for i in asked for each in of_commands(self.scenario.robots[i].law, self._commanded[i])]
        for i in asked:
            told += of_way(self.scenario.robots[i].law, self.robot_position[:, i], self.scenario.walls)
            told += self._passed(i)
        found = (*told, *of_people(self.wall_rescues, speed, self.desired_speed), *self.scenario.warnings)
        if self.diverged is None:
            return found
        who, when = f"{self.diverged.kind} {self.diverged.index}", self.diverged.time
        message = (
            f"the world diverged at {when:g} s, {who} first: nothing is known from then on; a smaller step may help"
        )
        return (ResultWarning("unfinished", "diverged", message), *found)


WorldRun.__name__ = "Trajectory"  # as it is printed
