"""Decisions of the parts around a law in every control period of a run, and the plans behind them."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np

from hrsafety._arguments import Array, Pair, instance, number
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._replay.played import Played
from hrsafety._replay.record import Replay
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.filters import FILTER_INFEASIBLE
from hrsafety.navigation.laws.safe_navigation import SafeNavigation, SafetyTrace
from hrsafety.navigation.laws.situation import Situation
from hrsafety.navigation.maps.guide import LocalGoal, Plan
from hrsafety.navigation.robots.bodies import HolonomicRobot
from hrsafety.navigation.run import Run
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plausibility import ResultWarning

if TYPE_CHECKING:
    from hrsafety.navigation.crowd.world import World

__all__ = ["SafetyDecision", "SafetyRecord", "record_safety"]

Expected = tuple[float, list[list[float]], list[tuple[int, list[list[float]]]], int]
"""Length of a stage in s, places of the robot, numbers of obstacles with their places, and the number of stages."""


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
        ``"kept"``, ``"changed"`` or ``"braking"``; ``"infeasible"`` where nothing obeyed the rule of a filter.
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
        Measured positions of the obstacles in m, NaN for who is absent; in a world those of its people, NaN for who
        is not seen, too, and for everybody where sensors tell of obstacles.
    obstacle_reach : ndarray, shape (n,)
        How far each of them can have come from there when the robot rests, in m; 0 for what stands, and for who has no
        position.
    path : ndarray, shape (p, 2)
        Path of the guide through the map alone from here, in m; empty without a guide. Around people who
        stand the guide makes another plan in the run, which is not recorded.
    foreseen_time : ndarray, shape (s,)
        Instants that foresight expects something of, in s from the decision on; empty without foresight.
    foreseen_way : ndarray, shape (w, 2)
        Where it expects the robot at the first w of them, in m, up to the goal.
    foreseen_people : ndarray, shape (n, s, 2)
        Where it expects the obstacles at them, in m, NaN for who is none that it predicts.
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
    foreseen_time: Annotated[Array, "s"]
    foreseen_way: Annotated[Array, "m"]
    foreseen_people: Annotated[Array, "m"]
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
        last = () if self.law.filter is None else ("infeasible",)
        return {status: found[status] / len(self.decisions) for status in ("kept", "changed", "braking", *last)}

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Warnings of the run, and ``"filter_infeasible"`` where the rule of a filter was not obeyed."""
        times = [each.time for each in self.decisions if each.status == "infeasible"]
        if not times:
            return self.trajectory.warnings
        message = (
            f"in {len(times)} of {len(self.decisions)} control periods, first at {times[0]:g} s, nothing obeyed the "
            "rule of the filter: it promises nothing there"
        )
        return (ResultWarning(FILTER_INFEASIBLE, "decisions", message), *self.trajectory.warnings)

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


def record_safety(
    scenario: Scenario | World, law: SafeNavigation | None = None, *, robot: int | None = None
) -> SafetyRecord:
    """Run a law with parts around it, and keep what they decided in every control period.

    The run is that of `simulate`, bit for bit.

    Parameters
    ----------
    scenario : Scenario or World
        Where; the robot is a `HolonomicRobot` without a footprint.
    law : SafeNavigation or None
        The law with its parts, in a world that of every robot; ``None``: robots of a world have their own.
    robot : int or None
        Index of the robot of a world that decides; ``None``: the only one.

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

    Among people who react:

    >>> person = nav.Person(start=(6, 0.1), route=[(0, 0.1)], desired_speed=0.9)
    >>> world = nav.World(people=[person], robots=[nav.Robot(start=(0, 0), goal=(6, 0))])
    >>> nav.metrics.record_safety(world, law).trajectory.outcome
    'arrived'
    """
    if law is not None or isinstance(scenario, Scenario):
        instance("law", law, SafeNavigation)
    run = Run(scenario, law)
    index = run._index(robot)
    place: Any = run.scenario
    if isinstance(place, Scenario):
        parts, own, body = instance("law", law, SafeNavigation), place, place.robot
    else:
        own = place.robots[index]
        parts, body = instance(f"scenario.robots[{index}].law", own.law, SafeNavigation), own.body
    name = "scenario.robot" if own is place else f"scenario.robots[{index}].body"
    if instance(name, body, HolonomicRobot).footprint is not None:
        # The plan and the margin of a record are those of a disc.
        raise InvalidParameterError(f"{name}.footprint", "be None", body.footprint, "give the disc around it")
    if parts.shield is not None and parts.shield.unseen is not None:
        # Margins are those from people who are seen.
        rule = "reckon with seen people only"
        raise InvalidParameterError("law.shield.unseen", rule, parts.shield.unseen, "record it without unseen=")
    plan = None
    if parts.guide is not None and parts.map is not None:
        plan = parts.guide.plan(parts.map, radius=body.radius, start=own.start, goal=own.goal)
    native, made = run._native, []
    while not run.finished:
        seen, decides = run.observe(index), native.deciding()[index]
        whom = native.people(index)
        run.step()
        trace = run._trace(index)
        if decides and trace is not None:
            made.append((seen, trace, native.examined(index), whom))
    ended = run.trajectory.robots[index]
    others = ended.obstacle_position.shape[1]
    return SafetyRecord(trajectory=ended, decisions=tuple(_decision(*each, plan, others) for each in made))


def _decision(
    seen: Situation,
    trace: SafetyTrace,
    verified: tuple[float, list[float], list[list[float]], list[float], Expected | None] | None,
    whom: Sequence[int | None],
    plan: Plan | None,
    others: int,
) -> SafetyDecision:
    """Return a decision; `whom`: column of the run for each obstacle that was seen."""
    margin, instants, places, reaches = math.nan, np.zeros(1), seen.position[None, :], np.zeros(len(whom))
    if verified is not None:
        margin, (instants, places, reaches) = verified[0], map(np.array, verified[1:4])
    position, reach = np.full((others, 2), np.nan), np.zeros(others)
    for index, column in enumerate(whom):
        if column is not None:
            position[column], reach[column] = seen.obstacle_position[index], reaches[index]
    foreseen_time, way, people = _foreseen(None if verified is None else verified[4], whom, others)
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
        obstacle_position=position,
        obstacle_reach=reach,
        path=np.empty((0, 2)) if plan is None else plan.path(seen.position),
        foreseen_time=foreseen_time,
        foreseen_way=way,
        foreseen_people=people,
        local_goal=None if local is None else local.point,
    )


def _foreseen(expected: Expected | None, whom: Sequence[int | None], others: int) -> tuple[Array, Array, Array]:
    """Return instants, way of the robot and ways of the obstacles that foresight expects."""
    if expected is None:
        return np.empty(0), np.empty((0, 2)), np.empty((others, 0, 2))
    step, way, ways, stages = expected
    people = np.full((others, stages + 1, 2), np.nan)
    for index, places in ways:
        column = whom[index] if index < len(whom) else None
        if column is not None:
            people[column] = places
    return step * np.arange(stages + 1.0), np.array(way).reshape(-1, 2), people
