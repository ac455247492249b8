"""Decisions of the parts around a law in every control period of a run, and the plans behind them."""

from __future__ import annotations

import math
from collections import Counter
from typing import Annotated

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, instance, number
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._replay.played import Played
from hrsafety._replay.record import Replay
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.free_space import stands
from hrsafety.navigation.laws.safe_navigation import SafeNavigation, SafetyTrace
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.laws.situation import Situation
from hrsafety.navigation.maps.guide import LocalGoal, Plan
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving_rectangle import Box, Mobile
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.run import Run
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.navigation.warnings.scenarios import own_speed

__all__ = ["SafetyDecision", "SafetyRecord", "record_safety"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SafetyDecision:
    """A decision of the parts around a law, and the plan that it was verified with.

    Parameters
    ----------
    time : float
        When, in s.
    position, velocity : ndarray, shape (2,)
        The robot as it was measured, in m and m/s.
    wanted, command : ndarray, shape (2,)
        Velocity that the law wanted, or the takeover in its place, and the one that is commanded, in m/s.
    status : str
        ``"kept"``, ``"changed"`` or ``"braking"``.
    taken_over : bool
        Whether the law was taken over from.
    margin : float
        Least distance in m between the half disc ahead of the robot and everywhere that people can be, over
        the plan behind the command; infinite without people, NaN without a shield. Negative while braking
        where nothing was verified anew: the rest of an older plan is executed.
    plan_time : ndarray, shape (k,)
        Instants of the plan in s, from 0 to the rest of the robot.
    plan_position : ndarray, shape (k, 2)
        Where the robot is at them, in m.
    obstacle_position : ndarray, shape (n, 2)
        Measured positions of the obstacles in m, NaN for who is absent.
    obstacle_reach : ndarray, shape (n,)
        How far each of them can have come from there when the robot rests, in m; 0 for what stands.
    path : ndarray, shape (p, 2)
        Path of the guide through the map alone from here, in m; empty without a guide. Around people who
        stand the guide makes another plan in the run, which is not recorded.
    local_goal : (float, float) or None
        Local goal on that path, in m: where the guide sends the law while no person stands.
    """

    time: Annotated[float, "s"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    wanted: Annotated[Array, "m/s"]
    command: Annotated[Array, "m/s"]
    status: str
    taken_over: bool
    margin: float
    plan_time: Annotated[Array, "s"]
    plan_position: Annotated[Array, "m"]
    obstacle_position: Annotated[Array, "m"]
    obstacle_reach: Annotated[Array, "m"]
    path: Annotated[Array, "m"]
    local_goal: Annotated[Pair | None, "m"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SafetyRecord(Played):
    """The decisions of a run, one a control period.

    Parameters
    ----------
    trajectory : Trajectory
        The run.
    decisions : tuple of SafetyDecision
        In the order of time.
    """

    trajectory: Trajectory
    decisions: tuple[SafetyDecision, ...]

    def _replay(self) -> Replay:
        from hrsafety.navigation.replays import replay_of_record

        return replay_of_record(self)

    @property
    def law(self) -> SafeNavigation:
        """The law with its parts."""
        return instance("law", self.trajectory.law, SafeNavigation)

    @property
    def shares(self) -> dict[str, float]:
        """Share of the decisions by status."""
        found = Counter(each.status for each in self.decisions)
        return {status: found[status] / len(self.decisions) for status in ("kept", "changed", "braking")}

    def at(self, time: float) -> SafetyDecision:
        """Return the decision in force at a time.

        Parameters
        ----------
        time : float
            In s, from 0 to the end of the run.

        Returns
        -------
        SafetyDecision
            The last one that is not later.

        Raises
        ------
        InvalidParameterError
            If the time lies outside of the run.
        """
        end = float(self.trajectory.time[-1])
        if not 0.0 <= number("time", time) <= end:
            raise InvalidParameterError("time", f"be from 0 to the end of the run at {end:g} s", time)
        instants = [each.time for each in self.decisions]
        return self.decisions[int(np.searchsorted(instants, time + 1e-9, side="right")) - 1]

    def __repr__(self) -> str:
        """Return how many decisions there are, and how they came out."""
        shares = ", ".join(f"{100.0 * share:.1f} % {status}" for status, share in self.shares.items())
        return f"SafetyRecord({len(self.decisions)} decisions: {shares})"


def record_safety(scenario: Scenario, law: SafeNavigation) -> SafetyRecord:
    """Run a law with parts around it, and keep what they decided in every control period.

    The run is that of `simulate`, bit for bit.

    Parameters
    ----------
    scenario : Scenario
        Where; the robot is a `HolonomicRobot`.
    law : SafeNavigation
        The law with its parts.

    Returns
    -------
    SafetyRecord
        The run and its decisions.

    Raises
    ------
    InvalidParameterError
        If the law has no parts around it, the robot has two wheels, or the law cannot work in the scenario.

    See Also
    --------
    hrsafety.plotting.runs.safety_decision : picture of one decision
    hrsafety.plotting.runs.animate_safety : all of them as an animation

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(person_speed=1.0))
    >>> record = nav.metrics.record_safety(scenarios.configuration("c2"), law)
    >>> record.trajectory.outcome, record.decisions[0].status
    ('arrived', 'kept')
    """
    parts, scene = instance("law", law, SafeNavigation), instance("scenario", scenario, Scenario)
    robot = instance("scenario.robot", scene.robot, HolonomicRobot)
    run = Run(scene, parts)
    plan = None
    if parts.guide is not None and parts.map is not None:
        plan = parts.guide.plan(parts.map, radius=robot.radius, start=scene.start, goal=scene.goal)
    decisions = []
    while not run.finished:
        seen = run.observe()
        run.step()
        trace = run.trace
        if trace is not None:
            decisions.append(_decision(seen, trace, parts.shield, plan, scene))
    return SafetyRecord(trajectory=run.trajectory, decisions=tuple(decisions))


def _decision(
    seen: Situation, trace: SafetyTrace, shield: Shield | None, plan: Plan | None, scene: Scenario
) -> SafetyDecision:
    instants, places, margin = np.zeros(1), seen.position[None, :], math.nan
    reach = np.zeros(len(scene.obstacles))
    if shield is not None:
        margin, instants, places = _examined(seen, trace.command, shield, scene)
        ages = shield.latency + instants[-1]
        bounds = (_bounds(each, shield) for each in scene.obstacles)
        reach = np.array([error + speed * ages if speed > 0.0 else 0.0 for speed, error in bounds])
    local: LocalGoal | None = None if plan is None else plan.local_goal(seen.position)
    return SafetyDecision(
        time=seen.time,
        position=seen.position,
        velocity=seen.velocity,
        wanted=np.array(trace.wanted),
        command=np.array(trace.command),
        status=trace.status,
        taken_over=trace.taken_over,
        margin=margin,
        plan_time=instants,
        plan_position=places,
        obstacle_position=seen.obstacle_position,
        obstacle_reach=reach,
        path=np.empty((0, 2)) if plan is None else plan.path(seen.position),
        local_goal=None if local is None else local.point,
    )


def _examined(seen: Situation, command: Pair, shield: Shield, scene: Scenario) -> tuple[float, Array, Array]:
    """Return the margin of a command, and instants and places of the plan behind it."""
    robot = seen.robot
    native: _hrsafety.Shield = shield._native
    others = []
    for index, obstacle in enumerate(scene.obstacles):
        # Rectangles that stand are walls, which are kept off by their clearance.
        if not seen.obstacle_present[index] or (stands(obstacle) and isinstance(obstacle, Box)):
            continue
        sizes = (obstacle.length, obstacle.width, obstacle.heading) if isinstance(obstacle, Box) else None
        outline = sizes or (float(seen.obstacle_radius[index]), math.nan, math.nan)
        velocity = (math.nan, math.nan) if stands(obstacle) else _pair(seen.obstacle_velocity[index])
        others.append((_pair(seen.obstacle_position[index]), outline, velocity, _bounds(obstacle, shield)))
    margin, (instants, places) = native.examine(
        (robot.radius, robot.max_speed, min(robot.max_acceleration, robot.max_deceleration), seen.control_period),
        (_pair(seen.position), _pair(seen.velocity)),
        command,
        others,
    )
    return margin, np.array(instants), np.array(places)


def _bounds(obstacle: Obstacle, shield: Shield) -> Pair:
    """Return speed in m/s and error in m that a shield assumes of an obstacle."""
    if stands(obstacle):
        return 0.0, 0.0
    if shield.person_speed is not None:
        return shield.person_speed, shield.position_error
    accelerates = isinstance(obstacle, Mobile) and (
        any(getattr(obstacle, "acceleration", ())) or any(any(each[2]) for each in obstacle.segments or ())
    )
    return math.inf if accelerates else own_speed(obstacle, 0.0), shield.position_error


def _pair(row: Array) -> Pair:
    x, y = row.tolist()
    return x, y
