"""A run that is advanced from outside, one control period at a time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any, NoReturn

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, checked_seed, count, finite_pair, flag, instance, number
from hrsafety.errors import InvalidParameterError, Shown, SimulationError
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import AnyLaw, PythonLaw, as_law
from hrsafety.navigation.laws.safe_navigation import SafetyTrace
from hrsafety.navigation.laws.situation import Situation, fixed, point_mass_of, situation_of
from hrsafety.navigation.outcomes import Outcome
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.scan_controller import KnownCells
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.simulation import refuse_in_worlds
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.navigation.warnings.units import of_scenarios
from hrsafety.plausibility import telling

if TYPE_CHECKING:
    from hrsafety._replay.record import Replay
    from hrsafety.navigation.crowd.world import World

__all__ = ["Run"]


class Run:
    """A run that is advanced from outside, one control period at a time.

    Every `step` decides, moves everybody until the next sample and measures there. Stepped to the end by its laws, a
    run has the same bits as `simulate`; the force is always held for a control period and the motion that of
    ``"semi_implicit_euler"``.

    Parameters
    ----------
    scenario : Scenario or World
        Robot, start, goal, obstacles, measurement; or people that react, robots and walls.
    law : Law, callable, object or None
        What drives every robot in steps without a command. ``None``: the robot of a scenario needs one in every step;
        a robot of a world has its own law, or stands.
    built : AsBuilt or None
        How the robot is built; ``None``: as `simulate` has it. Robots of worlds have their own.
    seed : int or None
        Seed of all that is drawn, in place of the scenario's own.
    step : float
        Motion step in s, which divides the control period; worlds have their own.
    stop_on_contact : bool
        Whether the run ends at the first contact; worlds continue.

    Raises
    ------
    InvalidParameterError
        If an argument is not valid.

    Notes
    -----
    Runs are independent of each other and may be stepped in turn, or each in a thread of its own.
    A run that is under way cannot be copied or pickled.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.Run(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> while not run.finished:
    ...     seen = run.step()
    >>> run.outcome, round(run.time, 2)
    ('arrived', 6.63)

    Without a law every step takes a force, or a velocity to have at the next sample:

    >>> run = nav.Run(scenarios.configuration("c1"))
    >>> while not run.finished and run.time < 1.0:
    ...     seen = run.step(velocity=(-0.5, 0.2))
    >>> seen.velocity.round(2).tolist()
    [-0.5, 0.2]

    In a world of two robots one is driven, the other has a law:

    >>> law = nav.OptimalReciprocalCollisionAvoidance()
    >>> robots = [nav.Robot(start=(0, 0), goal=(6, 0)), nav.Robot(start=(6, 0.1), goal=(0, 0.1), law=law)]
    >>> run = nav.Run(nav.World(robots=robots))
    >>> while not run.finished and run.time < 2.0:
    ...     mine, other = run.step(velocity={0: (0.4, 0.0)})
    >>> round(float(mine.position[0]), 2), len(mine.obstacle_position)
    (0.8, 1)
    """

    __slots__ = ("_built", "_commanded", "_ended", "_how", "_law", "_native", "_robots", "_scenario", "_step")

    @telling(lambda _, *given, **named: of_scenarios(*given, **named))
    def __init__(
        self,
        scenario: Scenario | World,
        law: AnyLaw | None = None,
        built: AsBuilt | None = None,
        *,
        seed: int | None = None,
        step: float = 0.01,
        stop_on_contact: bool = False,
    ) -> None:
        self._law = None if law is None else as_law(law)
        self._ended: Trajectory | None = None
        self._native: _hrsafety.Run | _hrsafety.WorldRun
        self._scenario: Any
        if not isinstance(scenario, Scenario):
            refuse_in_worlds({"built": built, "step": step, "stop_on_contact": stop_on_contact})
            self._scenario = _driven(scenario, self._law, seed)
            self._native = _hrsafety.WorldRun(self._scenario._native)
            goals = [each.goal for each in self._scenario.robots]
        else:
            self._scenario = scenario if seed is None else replace(scenario, seed=checked_seed("seed", seed))
            self._built = built is not None or not isinstance(scenario.robot, HolonomicRobot)
            self._how = AsBuilt() if built is None else instance("built", built, AsBuilt)
            self._step = number("step", step)
            self._native = _hrsafety.Run(
                self._scenario._native,
                None if self._law is None else self._law._native,
                self._how._native,
                step=self._step,
                stop_on_contact=flag("stop_on_contact", stop_on_contact),
            )
            goals = [scenario.goal]
        points = (self._native.point_mass(index) for index in range(len(goals)))
        self._robots = [(point_mass_of(each), fixed(goal)) for each, goal in zip(points, goals, strict=True)]
        self._commanded = [0] * len(goals)

    @property
    def scenario(self) -> Scenario | Any:
        """The scenario, with the seed of the run; the world, with its laws, too."""
        return self._scenario

    @property
    def time(self) -> float:
        """Present time in s; after the end, when the run ended."""
        return self._native.time

    @property
    def finished(self) -> bool:
        """Whether the run has ended; a world continues while people are on their ways."""
        return self._native.finished

    @property
    def outcomes(self) -> tuple[Outcome | None, ...]:
        """How the run ended for each robot; ``None`` while it is under way."""
        if isinstance(self._native, _hrsafety.Run):
            return (self._native.outcome,)  # type: ignore[return-value]  # one of the words
        if not self.finished:
            return (None,) * len(self._robots)
        return self.trajectory.outcomes  # type: ignore[return-value]  # ended

    @property
    def outcome(self) -> Outcome | None:
        """How the run ended for its only robot; ``None`` while it is under way."""
        if len(self._robots) != 1:
            raise AttributeError(f"a run with {len(self._robots)} robots has no 'outcome': take `outcomes`")
        return self.outcomes[0]

    @property
    def trajectory(self) -> Trajectory:
        """The run so far, with outcome ``"running"`` while it is under way.

        In a run without a law, its law is one by the name of ``"commands"``.
        """
        if self._ended is None:
            found = self._so_far()
            if not self.finished:
                return found
            self._ended = found
        return self._ended

    def _so_far(self) -> Trajectory:
        if isinstance(self._native, _hrsafety.Run):
            return Trajectory(
                scenario=self._scenario,
                law=_COMMANDS if self._law is None else self._law,
                built=self._how if self._built else None,
                motion_step=self._step,
                commanded_periods=self._commanded[0],
                **self._native.recorded(motors=self._built),
            )
        from hrsafety.navigation.crowd import simulation

        recorded = {**self._native.recorded(), "running": not self.finished, "commanded": tuple(self._commanded)}
        return simulation.run_of(self._scenario, recorded)

    @property
    def trace(self) -> SafetyTrace | None:
        """Decisions of the parts around the law of the only robot in the last period; ``None`` without parts."""
        return self._trace(self._index(None))

    def _trace(self, robot: int) -> SafetyTrace | None:
        found = self._native.trace(robot)
        if found is None:
            return None
        (wanted_x, wanted_y), (x, y), taken_over, status = found
        return SafetyTrace((wanted_x, wanted_y), (x, y), taken_over, status)

    def _index(self, robot: int | None) -> int:
        """Return the index of a robot, of the only one for ``None``."""
        robots = len(self._robots)
        if robot is None and robots != 1:
            raise InvalidParameterError("robot", "be the index of a robot", robot, f"the world has {robots} robots")
        return 0 if robot is None else count("robot", robot, least=0, most=robots - 1)

    def observe(self, robot: int | None = None) -> Situation:
        """Return what the controller of a robot sees now, measured once a control period.

        Parameters
        ----------
        robot : int or None
            Index of the robot; ``None``: the only one.

        Returns
        -------
        Situation
            The same until the next `step`; after the end, what is measured at the end of the last
            motion step.

        Raises
        ------
        InvalidParameterError
            If there is no such robot.
        """
        index = self._index(robot)
        return situation_of(self._native.situation(index), *self._robots[index])

    def unseen_places(self, robot: int | None = None) -> Array | None:
        """Return where people can be whom a robot does not see, as its shield has it since the last control period.

        Parameters
        ----------
        robot : int or None
            Index of the robot; ``None``: the only one.

        Returns
        -------
        ndarray, shape (n, 2), or None
            Centers of the cells in m; ``None`` for a law whose shield reckons with seen people only.

        Raises
        ------
        InvalidParameterError
            If there is no such robot.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> walls = nav.StaticMap.from_polylines([[(0, 0), (4, 0), (4, 3), (0, 3), (0, 0)]], radius=0.05)
        >>> shield = nav.Shield(unseen=nav.laws.Unseen())
        >>> law = nav.SafeNavigation(nav.VirtualForceField(), map=walls, guide=nav.maps.Guide(), shield=shield)
        >>> run = nav.Run(nav.Scenario(start=(0.8, 1.5), goal=(3.2, 1.5)), law)
        >>> seen = run.step()
        >>> inside = (run.unseen_places() > 0.1).all(axis=1) & (run.unseen_places() < (3.9, 2.9)).all(axis=1)
        >>> int(inside.sum())  # the room is seen to be empty
        0
        """
        found = self._native.unseen_places(self._index(robot))
        return None if found is None else np.array(found).reshape(-1, 2)

    def known_cells(self, robot: int | None = None) -> KnownCells | None:
        """Return what a law that makes its own map of scans knows since the last control period.

        Parameters
        ----------
        robot : int or None
            Index of the robot; ``None``: the only one.

        Returns
        -------
        KnownCells or None
            Cells, and the way that the law plans; ``None`` for other laws.

        Raises
        ------
        InvalidParameterError
            If there is no such robot.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> walls = nav.StaticMap.from_polylines([[(1.5, -1.0), (1.5, 1.0)]])
        >>> place = nav.Scenario(robot=nav.DifferentialDriveRobot(), start=(0, 0), goal=(3, 0), walls=walls)
        >>> run = nav.Run(place, nav.ArcRollouts(), nav.robots.AsBuilt(sensors=[nav.Lidar(map=walls)]))
        >>> seen = run.step()
        >>> cells = run.known_cells()
        >>> bool((cells.kinds == 2).any()), len(cells.way) > 1  # the wall was seen, and a way around it is planned
        (True, True)
        """
        index = self._index(robot)
        seen = situation_of(self._native.situation(index), *self._robots[index])
        found = self._native.explored(index, (float(seen.position[0]), float(seen.position[1])))
        if found is None:
            return None
        (x, y), kinds, cell, way = found
        return KnownCells(kinds, (x, y), cell, np.array(way, dtype=float).reshape(-1, 2))

    def _replay(self) -> Replay:
        from hrsafety.navigation.replays import replay_of_steps

        return replay_of_steps(self)

    def step(
        self,
        command: npt.ArrayLike | Mapping[int, npt.ArrayLike] | None = None,
        *,
        velocity: npt.ArrayLike | Mapping[int, npt.ArrayLike] | None = None,
    ) -> Situation | Any:
        """Advance to the next control period, or to the end of the run.

        Parameters
        ----------
        command : array_like of shape (2,), mapping of int to them, or None
            Force in N until the next sample, before the limits of the robot; in a world of several robots by the index
            of the robot.
        velocity : array_like of shape (2,), mapping of int to them, or None
            Velocity in m/s to have at the next sample, in place of a force: ``m (v* - V)/T_s``, as
            planners ask for it. Without either, the law decides.

        Returns
        -------
        Situation
            What the controller sees then; a tuple of them unless there is one robot. A world advances until the control
            period of a robot begins; without robots by its step.

        Raises
        ------
        InvalidParameterError
            If force and velocity are given, or neither in a scenario without a law, one is not finite, or a robot is
            told something that does not decide now.
        ShapeError
            If one has another shape than (2,).
        SimulationError
            If the run has ended, the state of a scenario became non-finite, or another thread is stepping it.
        """
        if self.finished:
            how = ", ".join(map(str, self.outcomes)) or "a world without robots"
            raise SimulationError(f"the run has ended ({how} at t = {self.time:.6g} s); make another Run")
        forces, velocities = self._told("command", command), self._told("velocity", velocity)
        if forces.keys() & velocities.keys():
            raise InvalidParameterError("velocity", "be None where a force is given", velocity)
        told = forces.keys() | velocities.keys()
        if self._law is None and isinstance(self._native, _hrsafety.Run) and not told:
            raise InvalidParameterError("command", "be a force in a run without a law", None, "or give velocity=(x, y)")
        self._native.step([(index, forces.get(index), velocities.get(index)) for index in sorted(told)])
        for index in told:
            self._commanded[index] += 1
        seen = tuple(self.observe(index) for index in range(len(self._robots)))
        return seen[0] if len(seen) == 1 else seen

    def _told(self, name: str, given: object) -> dict[int, Pair]:
        """Return what robots are told, by their indices."""
        if given is None:
            return {}
        robots = len(self._robots)
        if not isinstance(given, Mapping):
            if robots != 1:
                remedy = f"the world has {robots} robots"
                raise InvalidParameterError(name, "be a mapping of the index of a robot to a pair", given, remedy)
            return {0: finite_pair(name, given)}
        deciding = self._native.deciding()
        for key in given:
            index = count(f"a key of {name}", key, least=0, most=robots - 1)
            if not deciding[index]:
                rule = "be for robots that decide now"
                remedy = "it has arrived and stands, or its control period has not ended"
                raise InvalidParameterError(f"{name}[{index}]", rule, Shown(f"robot {index}"), remedy)
        return {int(key): finite_pair(f"{name}[{key}]", value) for key, value in given.items()}

    def __repr__(self) -> str:
        """Return law, time and outcome."""
        one = len(self._robots) == 1
        ended = f"outcome={self.outcome!r}" if one else f"outcomes={self.outcomes!r}"
        return f"Run(law={self._law!r}, time={self.time:.6g}, {ended})"

    def __reduce__(self) -> NoReturn:
        """Refuse: a law may remember anything, and its copy would not be independent."""
        raise SimulationError(
            "a Run cannot be copied or pickled; make another with the same arguments and step it again"
        )


def _driven(world: World, law: Law | None, seed: int | None) -> World:
    """Return a world with the law and the seed of its run."""
    # Here: runs of scenarios load nothing of it.
    from hrsafety.navigation.crowd import simulation
    from hrsafety.navigation.crowd.world import World

    instance("scenario", world, Scenario, World)
    place = world if law is None else simulation.driven(world, law)
    return place if seed is None else replace(place, seed=checked_seed("seed", seed))


def _commands(_: Situation) -> NoReturn:
    raise SimulationError("the run had no law: its commands came from outside")


_COMMANDS = PythonLaw(function=_commands, name="commands")
