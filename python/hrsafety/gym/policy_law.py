"""A policy that was trained in an environment, as a law: it is shown what the environment showed it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, numbers, positive, word
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.gym.environments import _BOUND, _MOST_SEEN, _OWN, _PERSON, _RANGE
from hrsafety.navigation.laws.situation import Situation
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.navigation.sensing.robot_sensor import RobotSensor
from hrsafety.plausibility import ResultWarning

__all__ = ["PolicyLaw"]

Observation = npt.NDArray[np.float32]


@dataclass(frozen=True, kw_only=True)
class PolicyLaw:
    """A policy as a law, so that it stands beside laws, under a shield, and on robots as built.

    Parameters
    ----------
    policy : callable
        ``policy(observation)`` returns an action in [-1, 1] x [-1, 1]; observations are flat, as of `CrowdEnv`.
    time_limit : float
        That of the worlds, in s: observations hold the share that has passed.
    people : int
        How many of the nearest people it was shown.
    lidar : int
        How many rays.
    frame : {"world", "goal"}
        Axes of all vectors that it was shown; actions are along those of the world.
    action : {"velocity", "unicycle"}
        What its actions are. One of the action "unicycle" drives robots with two wheels.
    max_turn_rate : float or None
        Of the action "unicycle", that of the environment, in rad/s.
    walls : StaticMap or None
        What the rays see beside people; those of the world.
    name : str
        In results.

    Raises
    ------
    InvalidParameterError
        If a value is out of range, and in a run if there is a wall or rectangle that no ray shows to the policy, or a
        policy of the action "unicycle" drives a robot without two wheels.

    Notes
    -----
    A law is told of people within the sight of its robot, an environment shows the nearest ones at any distance. What
    differs from the environment otherwise is doubted in results: sensors of the robot that tell of points in place of
    people (``"policy_sees_nobody"``), another time limit and another largest speed (``"other_environment"``); walls
    that no ray shows are ``"unknown_wall"``.

    Examples
    --------
    >>> from hrsafety import gym, navigation as nav, scenarios
    >>> def to_goal(observation):
    ...     return observation[:2]
    >>> law = gym.PolicyLaw(policy=to_goal, time_limit=25.0)
    >>> nav.simulate(scenarios.circle_crossing(0, law=law)).outcome
    'arrived'
    """

    policy: Callable[[Observation], npt.ArrayLike]
    time_limit: float
    people: int = 5
    lidar: int = 0
    frame: str = "world"
    action: str = "velocity"
    max_turn_rate: float | None = None
    walls: StaticMap | None = None
    name: str = "policy"
    _lidar: Lidar | None = field(init=False, repr=False, compare=False, default=None)

    def __post_init__(self) -> None:
        """Check the values."""
        if not callable(self.policy):
            raise InvalidParameterError("policy", "be callable", self.policy)
        object.__setattr__(self, "time_limit", positive("time_limit", self.time_limit))
        object.__setattr__(self, "people", count("people", self.people, least=0, most=_MOST_SEEN))
        object.__setattr__(self, "lidar", count("lidar", self.lidar, least=0, most=_MOST_SEEN))
        word("frame", self.frame, ("world", "goal"))
        word("action", self.action, ("velocity", "unicycle"))
        if (self.max_turn_rate is not None) != (self.action == "unicycle"):
            raise InvalidParameterError(
                "max_turn_rate", 'be given with action="unicycle", and only then', self.max_turn_rate
            )
        if self.max_turn_rate is not None:
            object.__setattr__(self, "max_turn_rate", positive("max_turn_rate", self.max_turn_rate))
        if self.walls is not None and not isinstance(self.walls, StaticMap):
            raise InvalidParameterError("walls", "be a StaticMap or None", self.walls)
        if self.lidar:
            object.__setattr__(self, "_lidar", Lidar(map=self.walls, beams=self.lidar, range_max=_RANGE))

    without_regions = True
    """Whether the regions of obstacles are nothing to it."""

    @property
    def asked(self) -> str:
        """Which of its methods is asked in a run: what its actions are."""
        return "velocity" if self.action == "velocity" else "twist"

    @property
    def known_map(self) -> StaticMap | None:
        """The walls that rays show."""
        return self.walls if self.lidar else None

    def doubts_of(
        self, robot: HolonomicRobot | DifferentialDriveRobot, sensors: Sequence[RobotSensor], time_limit: float
    ) -> Iterator[ResultWarning]:
        """Yield what a run shows the policy otherwise than its environment did.

        Parameters
        ----------
        robot : HolonomicRobot or DifferentialDriveRobot
            What it drives.
        sensors : sequence of RobotSensor
            Of the robot.
        time_limit : float
            Of the run, in s.

        Yields
        ------
        ResultWarning
            With the codes ``"policy_sees_nobody"`` and ``"other_environment"``.
        """
        telling = [index for index, sensor in enumerate(sensors) if sensor.TELLS]
        if telling and (self.people or self.lidar):
            message = (
                f"sensors[{telling[0]}] of the robot tells the law of points in place of people: the policy is shown "
                "nobody, neither in its list of people nor by rays; give the robot no sensors that tell of obstacles"
            )
            yield ResultWarning("policy_sees_nobody", "law.policy", message)
        if self.time_limit != time_limit:
            message = (
                f"time_limit of the policy is {self.time_limit:g} s, that of the run {time_limit:g} s: the share of "
                "the time that the policy is shown is not that of its environment"
            )
            yield ResultWarning("other_environment", "law.time_limit", message)
        share = getattr(robot, "reference_speed_share", 1.0)
        if share != 1.0:
            message = (
                f"the policy drives the point mass that the wheels follow, at up to reference_speed_share = {share:g} "
                "of their speed, and is shown that speed; in an environment it is the whole"
            )
            yield ResultWarning("other_environment", "robot.reference_speed_share", message)
        fastest = getattr(robot, "max_turn_rate", None)
        if self.max_turn_rate is not None and fastest is not None and self.max_turn_rate > fastest:
            message = (
                f"max_turn_rate of the policy is {self.max_turn_rate:g} rad/s, the robot turns by {fastest:g} rad/s at "
                "most: its turns are not those of its environment"
            )
            yield ResultWarning("other_environment", "law.max_turn_rate", message)

    def velocity(self, situation: Situation) -> Array:
        """Return the velocity that the policy wants, in m/s.

        Parameters
        ----------
        situation : Situation
            Of the robot.

        Returns
        -------
        ndarray, shape (2,)
            At most the greatest speed of the robot.
        """
        share = self._action(situation)
        share = share / max(1.0, float(np.hypot(*share)))
        return situation.robot.max_speed * share

    def twist(self, situation: Situation) -> Array:
        """Return the speed ahead in m/s and the turn rate in rad/s that a policy of the action "unicycle" wants.

        Parameters
        ----------
        situation : Situation
            Of the robot.

        Returns
        -------
        ndarray, shape (2,)
            At most the greatest speed of the robot, and ``max_turn_rate``.
        """
        return self._action(situation) * (situation.robot.max_speed, self.max_turn_rate or 0.0)

    def _action(self, situation: Situation) -> Array:
        """Return the action of the policy in a situation, as an environment takes it."""
        action = numbers("action of the policy", self.policy(self.observation(situation)))
        if action.shape != (2,):
            raise ShapeError("action of the policy", "(2,)", action.shape)
        if not np.isfinite(action).all():
            raise InvalidParameterError("action of the policy", "be finite", action)
        return np.clip(action, -1.0, 1.0)

    def observation(self, situation: Situation) -> Observation:
        """Return what an environment would show in a situation.

        Parameters
        ----------
        situation : Situation
            Of the robot.

        Returns
        -------
        ndarray of float32, shape (6 + 5 * people + lidar,)
            As of `CrowdEnv`.
        """
        seen, axes = situation, self._axes(situation)
        radius = np.asarray(seen.obstacle_radius)
        here = np.asarray(seen.obstacle_present, dtype=bool)
        if (here & np.isnan(radius)).any() and (self.walls is None or not self.lidar):
            remedy = "train with lidar=, and give lidar= and walls= here"
            raise InvalidParameterError(
                "obstacles of the scene", "be discs for a policy without rays", "a wall", remedy
            )
        # Points of walls have no radius; an environment shows walls by rays alone.
        discs = np.flatnonzero(here & (radius > 0.0))
        way = seen.obstacle_position[discs] - seen.position
        distance = np.hypot(*way.T)
        nearest = np.argsort(distance, kind="stable")[: self.people]
        moving = seen.obstacle_velocity[discs][nearest] - seen.velocity
        gap = distance[nearest] - radius[discs][nearest] - seen.robot.radius
        shown = np.zeros(_OWN + _PERSON * self.people + self.lidar)
        shown[:2], shown[2:4] = axes @ (seen.goal - seen.position), axes @ seen.velocity
        shown[4], shown[5] = seen.robot.max_speed, min(seen.time / self.time_limit, 1.0)
        rows = np.column_stack([way[nearest] @ axes.T, moving @ axes.T, gap])
        shown[_OWN : _OWN + rows.size] = rows.ravel()
        shown = np.clip(shown, -_BOUND, _BOUND)
        if self._lidar is not None:
            bodies = np.column_stack([seen.obstacle_position[discs], radius[discs]])
            heading = float(np.arctan2(axes[0, 1], axes[0, 0]) - self._lidar.bearings[0])
            shown[-self.lidar :] = self._lidar.scan(seen.position, heading, people=bodies)
        return shown.astype(np.float32)

    def _axes(self, situation: Situation) -> Array:
        """Return the axes of all vectors as rows."""
        to_goal = situation.goal - situation.position
        distance = float(np.hypot(*to_goal))
        if self.frame == "world" or distance == 0.0:
            return np.eye(2)
        x, y = to_goal / distance
        return np.array([[x, y], [-y, x]])
