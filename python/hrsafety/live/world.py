"""A world that runs at the pace of the wall clock, while it is changed from outside.

People walk in the loop of the core, the robot moves in that of `Run`, and `Controller` decides: told the same, it
commands the same as a run. Nothing here advances anybody.
"""

from __future__ import annotations

import json
import math
import threading
import time as clocks
from collections import deque
from collections.abc import Hashable, Mapping
from dataclasses import replace
from typing import Any

import numpy as np

from hrsafety._arguments import Array, Pair, finite_pair
from hrsafety._replay.record import Event, PlayedRobot, Replay
from hrsafety.errors import HrsafetyError, InvalidParameterError
from hrsafety.live.routes import Walker
from hrsafety.live.settings import RANGES, LiveSettings, laws
from hrsafety.navigation.controller import Controller, Sighting
from hrsafety.navigation.crowd.agents import Person
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.maps.outlines import standing
from hrsafety.navigation.place import Place
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot
from hrsafety.navigation.run import Run
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.simulation import simulate
from hrsafety.ros.floor import Crowd, largest_step, walk

__all__ = ["PERIOD", "LiveWorld"]

PERIOD = 0.05
"""Control period of the robot, and time between two states that are told, in s."""
LONGEST = 3600.0
"""A world ends after so many seconds of its own time."""
FAR = 9_000.0
"""Where the run of the robot has its goal, in m: the controller knows the one that counts."""
FARTHEST = 1000.0
"""How far people can be dragged, in m."""
MORE_PEOPLE = 20
"""Room of the controller for those who come from sources."""
BEHIND = 0.25
"""A world that is farther behind the wall clock, in s, continues from there."""
KEPT = 12_000
"""States that are kept for the player."""


class LiveWorld:
    """A running world.

    Parameters
    ----------
    world : World or Scenario
        With one robot.
    pace : float
        Seconds of the world in one of the wall; infinite to run as fast as it can.

    Raises
    ------
    InvalidParameterError
        If the world has not one robot, repeats itself, or its law cannot work in it.
    """

    def __init__(self, world: Place, *, pace: float = 1.0) -> None:
        world = World.of(world)
        if len(world.robots) != 1:
            raise InvalidParameterError("world.robots", "be one robot", len(world.robots))
        self._world, self._pace = world, pace
        (self._robot,) = world.robots
        self.walls = standing(world.walls)
        self.settings = LiveSettings.of(self._robot, self.walls)
        self.told = threading.Condition()
        self.state = ""
        self.count = 0
        self.finished = False
        self._changes: deque[Mapping[str, Any]] = deque(maxlen=10_000)
        self._refused = ""
        self.paused = False
        self._random = np.random.default_rng(world.seed)
        # Speeds and awareness are drawn once: a person who is dragged stays the same person.
        drawn = simulate(replace(world, robots=[], sources=[], time_limit=world.step))
        told = _told_ways(world)
        self._walkers: dict[int, Walker] = {}
        for index, person in enumerate(world.people):
            own = replace(
                person,
                desired_speed=float(drawn.desired_speed[index]),
                awareness=float(drawn.awareness[index]),
                distracted_share=0.0,
                **told.get(index, {}),
            )
            self._walkers[index] = Walker(own)
        self._part = largest_step(world, PERIOD, at_most=PERIOD)
        self._parts = round(PERIOD / self._part)
        self._begin()

    def _begin(self) -> None:
        """Put everybody to the start."""
        robot = self._robot
        self._instant, self._base = 0, 0
        self._goal: Pair = robot.goal
        self._names: dict[int, int] = {index: index for index in self._walkers}
        self._next = len(self._walkers)
        self._seen: dict[int, tuple[Array, Array, float]] = {}
        self._past: deque[tuple[float, dict[int, tuple[Array, Array]]]] = deque()
        self._known: set[Any] = set()
        self._touching: set[int] = set()
        self._contacts = 0
        self._events: list[Event] = []
        self._history: deque[tuple[float, Array, float, float, dict[int, Array]]] = deque(maxlen=KEPT)
        self._radii: dict[int, float] = {}
        self._restarting = False
        alone = Scenario(
            robot=robot.body,
            start=robot.start,
            goal=(robot.start[0] + FAR, robot.start[1]),
            heading=robot.heading,
            control_period=PERIOD,
            time_limit=LONGEST + 1.0,
            rest_time=LONGEST + 1.0,
        )
        self._run = Run(alone, step=self._part if self._part <= 0.01 else 0.01)
        self._before = self._run.observe()
        self._after = self._before
        self._status: str | None = None
        self._doubts: tuple[str, ...] = ()
        self._controller = self._steered(self._goal, self.settings)

    def _steered(self, goal: Pair, settings: LiveSettings) -> Controller | None:
        """Return a controller of which it was tried that it works, so that what cannot is refused now.

        At the goal nothing is to be controlled, and there is none.
        """
        here = self._after
        law = settings.made(self._robot, self.walls, here.robot.max_speed)
        if math.dist(here.position, goal) <= self._robot.arrival_tolerance:
            return None
        count = len(self._walkers) + (MORE_PEOPLE if self._world.sources else 0)
        rules: dict[str, Any] = {
            "people": max(2 * count, 12),
            "person_radius": max([each.radius for each in [*self._world.people, *self._world.sources]], default=0.25),  # type: ignore[attr-defined]  # both have one
            "person_speed": settings.person_speed,
            "control_period": PERIOD,
            "arrival_tolerance": self._robot.arrival_tolerance,
            "seed": self._world.seed,
        }
        made = Controller(law, self._robot.body, goal, **rules)
        two = isinstance(self._robot.body, DifferentialDriveRobot)
        made.update(0.0, here.position, here.velocity, heading=here.heading if two else None)
        # That was a question only: the one that drives has been told nothing yet.
        return Controller(law, self._robot.body, goal, start=tuple(here.position.tolist()), **rules)

    # ---- changes --------------------------------------------------------------------------------

    def change(self, wish: Mapping[str, Any]) -> None:
        """Take a wish, which is granted or refused at the next instant.

        Parameters
        ----------
        wish : mapping
            ``{"kind": "person", "number": int, "place": [x, y] or None}`` (``None`` lets go), ``{"kind": "goal",
            "place": [x, y]}``, ``{"kind": "setting", "name": str, "value": ...}``, ``{"kind": "pause", "on": bool}`` or
            ``{"kind": "restart"}``.
        """
        with self.told:
            self._changes.append(wish)
            self.told.notify_all()

    def _grant(self) -> bool:
        """Grant what is wished; whether people continue otherwise than their world has them."""
        again = False
        while self._changes:
            wish = self._changes.popleft()
            try:
                again |= self._granted(wish)
                self._refused = ""
            except HrsafetyError as error:
                self._refused = str(error)
            except (KeyError, TypeError, ValueError) as error:
                self._refused = f"not understood: {error}"
        return again

    def _granted(self, wish: Mapping[str, Any]) -> bool:
        kind = wish["kind"]
        if kind == "person":
            return self._drag(wish["number"], wish["place"])
        if kind == "goal":
            goal = finite_pair("goal", wish["place"])
            if self.walls.bounds is not None and float(self.walls.clearance(goal)) < self._robot.body.radius:
                raise InvalidParameterError("goal", "be no nearer to a wall than the robot is wide", goal)
            self._controller, self._goal = self._steered(goal, self.settings), goal
            return False
        if kind == "setting":
            settings = self.settings.changed(wish["name"], wish["value"])
            self._controller = self._steered(self._goal, settings)
            other = settings.people_speed != self.settings.people_speed
            self.settings = settings
            return other
        if kind == "pause":
            self.paused = wish["on"] is True
            return False
        if kind == "restart":
            self._restarting = True
            return True
        raise InvalidParameterError("kind", "be person, goal, setting, pause or restart", kind)

    def _drag(self, number: Any, place: Any) -> bool:
        """Put a person to a place, or let go of a person."""
        walker = self._walkers.get(number) if type(number) is int else None
        if walker is None:
            raise InvalidParameterError("number", "be that of a person of the world who is no guest", number)
        held = None if place is None else finite_pair("place", place)
        if held is not None and math.dist(held, self._robot.start) > FARTHEST:
            raise InvalidParameterError("place", f"be at most {FARTHEST:g} m from the start of the robot", held)
        walker.held, walker.moved = held, True
        return True

    # ---- running --------------------------------------------------------------------------------

    def run(self) -> None:
        """Run until `stop` is called, or the time is over."""
        try:
            while not self.finished:
                try:
                    world = self._onward()
                except HrsafetyError as error:  # a world that cannot be: everybody is let go of
                    if not any(walker.held for walker in self._walkers.values()):
                        raise
                    self._refused = str(error)
                    for walker in self._walkers.values():
                        walker.held = None
                    world = self._onward()
                self._due = clocks.monotonic()
                self._first = True
                diverged = walk(world, self._part, self._meet)
                if diverged is not None or self._instant * self._part >= LONGEST:
                    break
                if self._restarting:
                    self._begin()
                    for walker in self._walkers.values():
                        walker.next, walker.held, walker.moved = 0, None, False
        finally:
            self.stop()

    def stop(self) -> None:
        """End the world at the next instant."""
        with self.told:
            self.finished = True
            self.told.notify_all()

    def _onward(self) -> World:
        """Return the world as it continues from now."""
        time, people, names = self._instant * self._part, [], []
        for number, walker in self._walkers.items():
            there = self._seen.get(number)
            if self._instant == 0:
                person: Person | None = replace(walker.person, desired_speed=self._paced(walker.person.desired_speed))
                if walker.held is not None:
                    person = walker.left(time, None, np.zeros(2), 1.0)
            else:
                place, velocity = (None, np.zeros(2)) if there is None else there[:2]
                person = walker.left(time, place, velocity, self.settings.people_speed)
            if person is not None:
                people.append(person)
                names.append(number)
        for number, (place, velocity, radius) in self._seen.items():
            if number not in self._walkers and self._instant > 0:
                source = min(self._world.sources, key=lambda each: abs(each.radius - radius))
                guest = Walker(_guest(source, place, radius)).left(time, place, velocity, self.settings.people_speed)
                if guest is not None:
                    people.append(guest)
                    names.append(number)
        self._names = dict(enumerate(names))
        self._base = self._instant
        robot = replace(self._robot, start=self._free_start(people))
        limit = LONGEST - time + 1.0
        seed = (self._world.seed + self._instant) % 2**64
        return replace(self._world, people=people, robots=[robot], time_limit=limit, seed=seed)

    def _free_start(self, people: list[Person]) -> Pair:
        """Return where the robot is; of one that is touched the nearest free place, for it may not start in a contact.

        It is where it is a step later, whatever it touches there.
        """
        here, radius = self._before.position, self._robot.body.radius + 1e-3
        there = [each for each in people if each.enters <= 0.0]
        centers = np.array([_at_start(each) for each in there], dtype=np.float64).reshape(-1, 2)
        sizes = np.array([each.radius for each in there])
        angles = np.arange(24) * (2.0 * math.pi / 24.0)
        ring = np.stack([np.cos(angles), np.sin(angles)], axis=1)
        for far in (0.0, *np.geomspace(0.01, 50.0, 40)):
            places = here + far * ring
            gaps = np.linalg.norm(places[:, None] - centers, axis=2) - sizes - radius
            free = (gaps > 0.0).all(axis=1)
            if self.walls.bounds is not None:
                free &= np.asarray(self.walls.clearance(places)) > radius
            if free.any():
                x, y = places[int(free.argmax())].tolist()
                return x, y
        raise InvalidParameterError("place", "leave the robot a free place within 50 m", tuple(here.tolist()))

    def _paced(self, speed: float | None) -> float | None:
        return None if speed is None else max(speed * self.settings.people_speed, 0.01)

    def _meet(self, _: float, crowd: Crowd) -> Pair | None:
        """Note who is there at an instant, tell it, and return where the robot is at the next one."""
        self._note(crowd)
        first, self._first = self._first, False
        if not first and self._grant():
            return None
        self._decide_if_due()
        self._tell()
        while self.paused and not self.finished:
            with self.told:
                if not self._changes:
                    self.told.wait(0.5)
            if self._grant():
                return None
            self._tell()
            self._due = clocks.monotonic()
        if self.finished or self._instant * self._part >= LONGEST:
            return None
        self._keep_pace()
        self._instant += 1
        share = (self._instant - 1) % self._parts + 1
        start, end = self._before.position, self._after.position
        place = start + (share / self._parts) * (end - start)
        return float(place[0]), float(place[1])

    def _keep_pace(self) -> None:
        if math.isinf(self._pace):
            return
        self._due += self._part / self._pace
        left = self._due - clocks.monotonic()
        if left < -BEHIND:
            self._due = clocks.monotonic()
        elif left > 0.0:
            clocks.sleep(left)

    def _note(self, crowd: Crowd) -> None:
        """Take who is there, by numbers that stay with a person through all changes."""
        found = {}
        for number, place, velocity, radius in zip(
            crowd.number.tolist(), crowd.position, crowd.velocity, crowd.radius.tolist(), strict=True
        ):
            own = self._names.get(number)
            if own is None:
                own = self._names[number] = self._next
                self._next += 1
            found[own] = (place, velocity, radius)
            self._radii[own] = radius
            if own in self._walkers:
                self._walkers[own].pass_by(place)
        self._seen = found

    def _decide_if_due(self) -> None:
        """At the start of a control period, let the controller decide and the robot move to its end."""
        if self._instant % self._parts:
            return
        time = self._instant * self._part
        self._before = self._run.observe()
        self._contact(time)
        people, gone = self._measured(time)
        here = self._before
        two = isinstance(self._robot.body, DifferentialDriveRobot)
        if self._controller is None:
            self._status, self._doubts = "arrived", ()
            self._after = self._run.step(velocity=(0.0, 0.0))
            return
        try:
            command = self._controller.update(
                time, here.position, here.velocity, heading=here.heading if two else None, people=people, gone=gone
            )
            self._known = (self._known | set(people)) - set(gone)
        except HrsafetyError as error:
            self._refused = str(error)
            self._status, self._doubts = "braking", ()
            self._after = self._run.step(velocity=(0.0, 0.0))
            return
        # Parts without a shield have a status, too, which promises nothing.
        self._status = "arrived" if command.arrived else command.status if self.settings.shield else None
        self._doubts = command.refuted
        self._after = self._run.step(velocity=(0.0, 0.0)) if command.arrived else self._run.step(command.force)

    def _measured(self, time: float) -> tuple[dict[Hashable, Sighting], list[int]]:
        """Return the measured people of the robot now, and those who have left its sight."""
        settings, here = self.settings, self._before.position
        self._past.append((time, {number: (place, velocity) for number, (place, velocity, _) in self._seen.items()}))
        while len(self._past) > 1 and self._past[1][0] <= time - settings.delay + 1e-9:
            self._past.popleft()
        then, seen = self._past[0]
        people: dict[Hashable, Sighting] = {}
        for number, (place, velocity) in seen.items():
            if float(np.hypot(*(place - here))) <= settings.range:
                x, y = (place + self._random.normal(0.0, settings.noise, 2) if settings.noise else place).tolist()
                people[number] = Sighting(x, y, float(velocity[0]), float(velocity[1]), then)
        return people, [number for number in self._known if number not in people]

    def _contact(self, time: float) -> None:
        """Notice who touches the robot."""
        here = self._before.position
        touching = {number for number, (place, _, size) in self._seen.items() if self._away(place) < size}
        if self._wall_gap() < 0.0:
            touching.add(-1)
        for number in touching - self._touching:
            self._contacts += 1
            who = "a wall" if number < 0 else f"person {number}"
            self._events.append(Event(time, "contact", f"contact with {who}", (float(here[0]), float(here[1]))))
        self._touching = touching

    # ---- telling --------------------------------------------------------------------------------

    def _gap(self) -> float:
        gaps = [self._away(place) - size for place, _, size in self._seen.values()]
        return min([*gaps, self._wall_gap()])

    def _away(self, place: Array) -> float:
        """Return how far a place is from the surface of the robot, in m."""
        body, offset = self._robot.body, place - self._before.position
        if body.footprint is None:
            return float(np.hypot(*offset)) - body.radius
        cosine, sine = math.cos(self._before.heading), math.sin(self._before.heading)
        own = [cosine * offset[0] + sine * offset[1], cosine * offset[1] - sine * offset[0]]
        return float(body.footprint.distance([own])[0])

    def _wall_gap(self) -> float:
        """Return how far walls are from the surface of the robot, in m; below 0 in a contact."""
        body, here = self._robot.body, self._before
        if self.walls.bounds is None:
            return math.inf
        if body.footprint is None:
            return float(self.walls.clearance(here.position)) - body.radius
        gap = float(body.footprint.clearance(self.walls, here.position[None], np.array([here.heading]))[0])
        return gap if gap > 0.0 else -1e-9  # an outline that overlaps a wall is at a distance of 0

    def _tell(self) -> None:
        if self._instant % self._parts and not self.paused:
            return
        here, gap = self._before, self._gap()
        self._history.append(
            (self._instant * self._part, here.position, here.heading, gap, {k: v[0] for k, v in self._seen.items()})
        )
        state = {
            "time": round(self._instant * self._part, 3),
            "robot": [*_rounded(here.position), round(float(here.heading), 4)],
            "speed": round(float(np.hypot(*here.velocity)), 4),
            "clearance": None if math.isinf(gap) else round(gap, 4),
            "goal": _rounded(np.array(self._goal)),
            "people": [[number, *_rounded(place), radius] for number, (place, _, radius) in self._seen.items()],
            "held": [number for number, walker in self._walkers.items() if walker.held is not None],
            "status": self._status,
            "doubts": list(self._doubts),
            "contacts": self._contacts,
            "touching": sorted(self._touching),
            "paused": self.paused,
            "refused": self._refused,
            "settings": self.settings.shown(self._robot),
        }
        with self.told:
            self.state = json.dumps(state, separators=(",", ":"))
            self.count += 1
            self.told.notify_all()

    def scene(self) -> dict[str, Any]:
        """Return what does not change: the robot, walls, what can be set."""
        body = self._robot.body
        return {
            "radius": body.radius,
            "footprint": [] if body.footprint is None else [list(corner) for corner in body.footprint.corners],
            "tolerance": self._robot.arrival_tolerance,
            "differential": isinstance(body, DifferentialDriveRobot),
            "walls": self.walls.segments.tolist(),
            "discs": np.asarray(self.walls.discs).tolist(),
            "polygons": [np.asarray(each).tolist() for each in self.walls.polygons],
            "laws": laws(),
            "ranges": {name: list(pair) for name, pair in RANGES.items()},
            "most": body.max_speed,
            "view": self._view(),
        }

    def _view(self) -> list[float]:
        points = [self._robot.start, self._robot.goal, *(each.person.start for each in self._walkers.values())]
        points += [corner for source in self._world.sources for corner in (source.low, source.high)]
        points += list(self.walls.bounds or ())
        (left, low), (right, high) = np.min(points, axis=0), np.max(points, axis=0)
        return [float(left) - 1.0, float(low) - 1.0, float(right) + 1.0, float(high) + 1.0]

    def replay(self) -> Replay:
        """Return what happened so far, for a player.

        Raises
        ------
        InvalidParameterError
            If nothing has happened yet.
        """
        kept = {each[0]: each for each in list(self._history)}  # of a paused world the last state counts
        rows = [kept[time] for time in sorted(kept)]
        numbers = sorted({number for row in rows for number in row[4]})
        column = {number: index for index, number in enumerate(numbers)}
        people = np.full((len(rows), len(numbers), 2), np.nan)
        for index, row in enumerate(rows):
            for number, place in row[4].items():
                people[index, column[number]] = place
        position = np.array([row[1] for row in rows]).reshape(-1, 2)
        body = self._robot.body
        turned = isinstance(body, DifferentialDriveRobot) or body.footprint is not None
        robot = PlayedRobot(
            name="robot",
            position=position,
            radius=body.radius,
            heading=np.array([row[2] for row in rows]) if turned else None,
            footprint=() if body.footprint is None else body.footprint.corners,
            clearance=np.array([row[3] for row in rows]),
            goal=self._goal,
            tolerance=self._robot.arrival_tolerance,
        )
        return Replay(
            title="A world that was played with",
            time=np.array([row[0] for row in rows]),
            robots=[robot],
            people=people,
            radius=np.array([self._radii[number] for number in numbers]),
            names=[f"person {number}" for number in numbers],
            maps=[self.walls],
            events=list(self._events),
            facts=[("people and goal", "were dragged, and the robot set otherwise, while it ran")],
        )


def _at_start(person: Person) -> Pair:
    """Return where a person is at the start of a world, far away while absent."""
    if person.recording is None:
        return person.start
    times, places = person.recording
    if not times[0] <= 0.0 <= times[-1]:
        return FAR, FAR
    x, y = np.asarray(places, dtype=np.float64).T
    return float(np.interp(0.0, times, x)), float(np.interp(0.0, times, y))


def _told_ways(world: World) -> dict[int, dict[str, Any]]:
    """Return the ways of those who move as they are told, as recordings, which can begin at any instant."""
    chosen = [index for index, person in enumerate(world.people) if person.mover is not None]
    if not chosen:
        return {}
    alone = replace(world, people=[world.people[index] for index in chosen], robots=[], sources=[], time_limit=LONGEST)
    run, found = simulate(alone), {}
    for column, index in enumerate(chosen):
        there = np.flatnonzero(np.isfinite(run.obstacle_position[:, column, 0]))
        times, places = run.time[there].tolist(), run.obstacle_position[there, column].tolist()
        if there[-1] == len(run.time) - 1 and times[-1] < LONGEST:  # who stands in the end keeps standing
            times, places = [*times, LONGEST], [*places, places[-1]]
        found[index] = {"recording": (times, places), "mover": None}
    return found


def _guest(source: Any, place: Array, radius: float) -> Any:
    """Return a person who came from a source as a person of the world."""
    given = {name: getattr(source, name) for name in ("route", "model", "at_end", "arrival_radius", "awareness")}
    return Person(start=(float(place[0]), float(place[1])), radius=radius, desired_speed=source.desired_speed, **given)


def _rounded(place: Array) -> list[float]:
    return [round(float(place[0]), 3), round(float(place[1]), 3)]
