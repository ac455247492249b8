"""The record of a run, and its score."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, Any, Literal, Protocol

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._replay.played import Played
from hrsafety._replay.record import Replay
from hrsafety.navigation.endings import ending_of
from hrsafety.navigation.knowledge import Sensing, sensing_of
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.outcomes import Outcome
from hrsafety.navigation.robots.as_built import AsBuilt
from hrsafety.navigation.robots.tracking_laws import Tracking
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.warnings import runs as run_warnings
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table, each, plane, with_units

__all__ = ["CONTACT_SPEED", "DECIDED_OVERLAP", "Divergence", "Integrator", "Trajectory", "without_obstacles"]

Integrator = Literal["semi_implicit_euler", "rk4"]
CONTACT_SPEED = _hrsafety.CONTACT_SPEED
"""Speed in m/s above which a robot counts as moving in a contact."""
DECIDED_OVERLAP = _hrsafety.DECIDED_OVERLAP
"""Overlap of two bodies in m from which on neither is at fault any more: what walks on through a robot is ahead of it
at last, whoever came."""
OPTIONAL_COLUMNS = ("force", "stabilizing", "lyapunov", "wheel_current", "obstacle_position", "distance")
"""Columns that a run may leave out, see ``record`` of `simulate`."""


@displayed
@dataclass(frozen=True, slots=True)
class Divergence:
    """Whose state was no longer finite, which ended the world.

    Parameters
    ----------
    time : float
        When, in s.
    kind : {"person", "robot"}
        Who.
    index : int
        Which of them.
    """

    time: Annotated[float, "s"]
    kind: Literal["person", "robot"]
    index: int


class Followed(Protocol):
    """Reference that a run may follow: one of `tracking`, which knows this module."""

    def at(self, time: npt.ArrayLike) -> Any:
        """Return positions and velocities at some instants."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Trajectory(Played, Table):
    """One run of a robot: n instants, m obstacles, w wheels.

    The rows are the motion steps, or every so many of them, and, last, the instant of arrival (linear inside
    its step). What a run does not know or did not keep is ``None``, and its table does not have the column:
    wheels and sensors of ideal point masses; scenario, law, forces, currents, energy and outcome of a run
    after a reference (`tracking.track`), which ends after its duration.

    Of a `World` the obstacles are the people, those from sources last, the rows are its steps, and the run continues
    after the arrival of the robot; distances and contacts of a robot are those up to its arrival. In a world of several
    robots, or without any, what is of one robot stands in ``robots``, and asking the run for it raises an
    `AttributeError`.

    Attributes
    ----------
    scenario : Scenario or World
        What was simulated.
    robots : tuple of Trajectory
        The run as each robot of a world has it; of a scenario, or a world with one robot, this one.
    robot_position, robot_velocity : ndarray, shape (n, k, 2)
        Of all k robots, in m and m/s.
    robot_heading : ndarray, shape (n, k)
        Of all robots, in rad.
    robot_arrival_time : ndarray, shape (k,)
        When each arrived, in s; NaN for those that did not.
    outcomes : tuple of str
        How it ended for each robot.
    law : Law
        The law that drove the robot; ``None`` for a robot of a world without one.
    time : ndarray, shape (n,)
        Instants in s.
    position, velocity : ndarray, shape (n, 2)
        True motion of the robot, in m and m/s.
    force : ndarray, shape (n, 2)
        Force as commanded, in N; from this row to the next.
    heading : ndarray, shape (n,)
        Heading in rad; of a two-wheel robot whole turns count.
    wheel_current : ndarray, shape (n, w)
        Mean motor currents in A over the step that ends at the row; zero in the first row.
    obstacle_position : ndarray, shape (n, m, 2)
        True obstacle positions in m (centroid for rectangles); NaN while absent.
    distance : ndarray, shape (n, m)
        Distance d from obstacle centre (rectangle: contour) to robot centre in m; NaN while
        absent.
    obstacle_velocity : ndarray of shape (n, m, 2), or None
        Velocities of the people of a world in m/s; NaN while absent.
    obstacle_radius, desired_speed, awareness : ndarray of shape (m,), or None
        Of the people of a world, in m, in m/s, and from 0 to 1, as drawn.
    person_arrival_time : ndarray of shape (m,), or None
        When each person of a world reached the end of the route, in s; NaN for those who did not.
    person_arrival_position : ndarray of shape (m, 2), or None
        Where that was, in m. Who leaves at the end is absent from that instant on.
    wall_rescues : int
        How often a person of a world was set back who would have passed a wall or come nearer to it than a tenth of
        the radius: no person does, whatever a model decides.
    max_person_speed : float
        Largest speed of the people of a world who decide, in m/s, also between instants and before walls take of it.
    diverged : Divergence or None
        Whose state was no longer finite, if that ended the world.
    outcome : {"arrived", "collided", "timed_out", "stopped", "diverged", "running"}
        How it ended. A contact makes it ``"collided"`` whatever came after; those between robots of a world do not.
        ``"diverged"``: the state of a world was no longer finite before the robot arrived. ``"running"``: the run so
        far of a `Run` that is under way.
    arrival_time : float
        First entry into the tolerance circle, in s; NaN without arrival.
    energy : float
        Electrical loss of the motors, in J; with wheels that have controllers, of their currents. In a world up to the
        arrival, of currents at its steps.
    min_distance, min_clearance : ndarray, shape (m,)
        Least distance d, and least distance between the surfaces, in m; infinite for an
        obstacle that was never present.
    contact_time, contact_speed : ndarray, shape (m,)
        First contact with each obstacle in s and the robot's speed then in m/s; NaN without. Those with walls are
        ``map_contact_time`` and ``map_contact_speed``. A contact at the end of
        a motion step has its time; one within a step only, where robot and obstacle move straight at constant speed
        and their surfaces meet, the instant at which they do, and the speed at the end of the step. An obstacle that a
        recording puts elsewhere at once (faster than 100 m/s) is not on the way there.
    contact_toward : ndarray of bool, shape (m,)
        Whether the robot moved toward the obstacle at the first touch: faster than 0.05 m/s, and V.(o - P) > 0 with its
        velocity V, its center P and the center o of a disc or the nearest point of a rectangle, at the end of
        the motion step; where the step ends 0.1 m deep in the other body or behind it, at the instant of the touch.
    contact_at_fault : ndarray of bool, shape (m,)
        Whether it did so at any instant of a contact from the first touch until the bodies first overlapped by
        0.1 m: later a body that walks on through the robot is ahead of it, whoever came.
    contact_apart : ndarray of bool, shape (m,)
        Whether the obstacle appeared in the scene where the robot was, and touched it within 0.2 s. That is no contact
        of the run: its time is NaN, unless they touched later again.
    map_contact_time, map_contact_speed : float
        First contact with a map that the law or a sensor knows, in s, and the robot's speed then in m/s; NaN
        without. Straight ways of motion steps count as above. The robot is always at fault; one that moves comes
        toward the map, which stands.
    map_clearance : float
        Least distance of the surfaces from the maps in m; infinite without any.
    path_length : float
        Length of the path in m.
    stabilizing : ndarray, shape (n, 2)
        Stabilizing force within ``force``, in N.
    lyapunov : ndarray, shape (n,)
        Lyapunov function V at the force samples, held between them, in N^2; NaN inside a
        critical region.
    wheel_speed : ndarray of shape (n, w), or None
        Wheel speeds in rad/s.
    energy_used : ndarray of shape (n,), or None
        Electrical loss up to each row, in J.
    reference_position : ndarray of shape (n, 2), or None
        Position of the point mass that the law drives, in m.
    seen_position : ndarray of shape (n, 2), or None
        Position of the robot as the law knows it since the last sample, in m.
    built : AsBuilt or None
        How the robot is built.
    motion_step : float
        Motion step of the run in s.
    commanded_periods : int
        Control periods in which a command from outside took the place of the law; 0 but for a `Run`.
    speed, turn_rate : ndarray of shape (n,), or None
        Forward speed in m/s and turn rate in rad/s over the step that ends at the row; of a run after a
        reference, as all that follows.
    commanded_speed, commanded_turn_rate : ndarray of shape (n,), or None
        What was asked for from the row on, in m/s and rad/s.
    reference_velocity : ndarray of shape (n, 2), or None
        Velocity of the reference in m/s; its position is ``reference_position``.
    goal_phase : ndarray of bool, shape (n,), or None
        Whether the command came from the goal phase of `tracking.ExponentialTracking`.
    reference : LineReference, CircleReference, PathReference or None
        What was followed.
    tracking : FullSpeedTracking, NonlinearTracking, ExponentialTracking or None
        The law that followed it.

    See Also
    --------
    hrsafety.plotting.paths : draws runs.
    hrsafety.plotting.distances : draws distances to goal and obstacles over time.
    RunTable : many runs.
    """

    # `X | Any`: None in a run after a reference only, which callers that made an episode need not ask. A `World` is
    # known by those who have one only: runs of scenarios load nothing of it.
    scenario: Any = None
    law: Law | Any = None
    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    force: Annotated[Array | Any, "N"] = None
    heading: Annotated[Array, "rad"]
    wheel_current: Array | Any = None
    obstacle_position: Annotated[Array | Any, "m"] = None
    obstacle_velocity: Annotated[Array | Any, "m/s"] = None
    obstacle_radius: Array | Any = None
    desired_speed: Array | Any = None
    awareness: Array | Any = None
    person_arrival_time: Annotated[Array | Any, "s"] = None
    person_arrival_position: Annotated[Array | Any, "m"] = None
    wall_rescues: int = 0
    max_person_speed: Annotated[float, "m/s"] = 0.0
    diverged: Divergence | None = None
    distance: Annotated[Array | Any, "m"] = None
    outcome: Outcome | Literal["running"] | Any = None
    arrival_time: Annotated[float | Any, "s"] = None
    energy: Annotated[float | Any, "J"] = None
    min_distance: Annotated[Array, "m"]
    min_clearance: Annotated[Array, "m"]
    contact_time: Annotated[Array, "s"]
    contact_speed: Array
    contact_toward: npt.NDArray[np.bool_]
    contact_at_fault: npt.NDArray[np.bool_]
    contact_apart: npt.NDArray[np.bool_]
    path_length: Annotated[float, "m"]
    map_contact_time: Annotated[float, "s"] = math.nan
    map_contact_speed: float = math.nan
    map_clearance: Annotated[float, "m"] = math.inf
    motion_step: Annotated[float, "s"] = 0.01
    commanded_periods: int = 0
    stabilizing: Annotated[Array | Any, "N"] = None
    lyapunov: Array | Any = None
    wheel_speed: Annotated[Array | None, "rad/s"] = None
    energy_used: Annotated[Array | None, "J"] = None
    reference_position: Annotated[Array | Any, "m"] = None
    seen_position: Annotated[Array | None, "m"] = None
    built: AsBuilt | None = None
    speed: Annotated[Array | Any, "m/s"] = None
    turn_rate: Array | Any = None
    commanded_speed: Annotated[Array | Any, "m/s"] = None
    commanded_turn_rate: Annotated[Array | Any, "rad/s"] = None
    reference_velocity: Annotated[Array | Any, "m/s"] = None
    goal_phase: npt.NDArray[np.bool_] | Any = None
    reference: Followed | None = None
    tracking: Tracking | None = None

    def _replay(self) -> Replay:
        from hrsafety.navigation.replays import replay_of_run

        return replay_of_run(self)

    @property
    def robot(self) -> int:
        """Index of the robot whose run it is."""
        return 0

    @property
    def robots(self) -> tuple[Trajectory, ...]:
        """The run as each robot has it."""
        return (self,)

    @property
    def robot_position(self) -> Array:
        """Positions of all robots in m."""
        return self.position[:, None]

    @property
    def robot_velocity(self) -> Array:
        """Velocities of all robots in m/s."""
        return self.velocity[:, None]

    @property
    def robot_heading(self) -> Array:
        """Headings of all robots in rad."""
        return self.heading[:, None]

    @property
    def robot_arrival_time(self) -> Array:
        """When each robot arrived, in s."""
        return np.array([self.arrival_time])

    @property
    def outcomes(self) -> tuple[str, ...]:
        """How the run ended for each robot."""
        return tuple(each.outcome for each in self.robots)

    @property
    def ending(self) -> str:
        """How the run ended for its robot in one sentence: contact or arrival, and why it did not get on if known."""
        return ending_of(self)

    def _shown(self) -> tuple[list[str], list[list[str]], str]:
        header, cells, title = Table._shown(self)  # a class with slots is made twice, and super() takes the first
        said = self.ending if isinstance(self.scenario, Scenario) else ""
        return header, cells, f"{title}\n{said}" if said else title

    @property
    def contacts_moving(self) -> int:
        """Number of obstacles that the robot touched while it moved faster than 0.05 m/s; maps count as one."""
        return int(np.sum(self._contact_speeds() > CONTACT_SPEED))

    @property
    def contacts_toward(self) -> int:
        """Number of these toward which it moved at the first touch; maps count as one."""
        return int(np.sum(self.contact_toward)) + int(self.map_contact_speed > CONTACT_SPEED)

    @property
    def contacts_away(self) -> int:
        """Number of those that it did not move toward: they came from behind or from the side."""
        return self.contacts_moving - self.contacts_toward

    @property
    def contacts_standing(self) -> int:
        """Number of obstacles that touched the standing robot; maps count as one."""
        return int(np.sum(self._contact_speeds() <= CONTACT_SPEED))

    @property
    def contacts_at_fault(self) -> int:
        """Number of obstacles touched by the robot's fault; maps count as one."""
        return int(np.sum(self.contact_at_fault)) + self.wall_contacts

    @property
    def contacts_apart(self) -> int:
        """Number of obstacles that appeared in the scene where the robot was: in none of the other numbers."""
        return int(np.sum(self.contact_apart))

    @property
    def wall_contacts(self) -> int:
        """Number of contacts with maps, 1 or 0, which the other numbers hold, too."""
        return int(not math.isnan(self.map_contact_time))

    def _contact_speeds(self) -> Array:
        return np.append(self.contact_speed, self.map_contact_speed)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each instant.

        Returns
        -------
        dict of str to ndarray
            Units are in the names; obstacles and wheels are numbered. What only robots as built and runs
            after a reference know stands last.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
        >>> list(run.columns())[:5]
        ['t_s', 'x_m', 'y_m', 'vx_m_per_s', 'vy_m_per_s']
        >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField(), built=nav.robots.AsBuilt())
        >>> list(run.columns())[-4:]
        ['reference_x_m', 'reference_y_m', 'seen_x_m', 'seen_y_m']
        """
        found = {"t_s": self.time, **plane("{}", self.position, "m"), **plane("v{}", self.velocity, "m/s")}
        found |= {} if self.force is None else plane("force_{}", self.force, "N")
        found["heading_rad"] = self.heading
        found |= {} if self.wheel_current is None else each("current_{}", self.wheel_current, "A")
        for index in range(len(self.min_distance)):
            if self.obstacle_position is not None:
                found |= plane(f"obstacle_{index}_{{}}", self.obstacle_position[:, index], "m")
            if self.distance is not None:
                found[f"distance_{index}_m"] = self.distance[:, index]
        found |= {} if self.stabilizing is None else plane("stabilizing_{}", self.stabilizing, "N")
        found |= {} if self.lyapunov is None else {"lyapunov_N2": self.lyapunov}
        if self.wheel_speed is not None:
            found |= each("wheel_{}_speed", self.wheel_speed, "rad/s")
        if self.energy_used is not None:
            found["energy_used_J"] = self.energy_used
        for name in ("reference", "seen"):
            places = getattr(self, f"{name}_position")
            found |= {} if places is None else plane(f"{name}_{{}}", places, "m")
        return found | (self._tracked() if self.tracking is not None else {})

    def _tracked(self) -> Columns:
        """Return the columns that only a run after a reference has."""
        found = plane("reference_v{}", self.reference_velocity, "m/s")
        units = {"speed": "m/s", "turn_rate": "rad/s", "commanded_speed": "m/s", "commanded_turn_rate": "rad/s"}
        return found | with_units(self, {**units, "goal_phase": "", "error": "m"})

    @property
    def error(self) -> Array | Any:
        """Distance between robot and reference at each instant in m, shape (n,); ``None`` without a reference."""
        if self.reference_position is None:
            return None
        offset = self.reference_position - self.position
        return np.hypot(offset[:, 0], offset[:, 1])

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the run may not mean what it seems to.

        The warnings of its scenario that matter for its law, of sensors that see less than they must, and of
        commands that a shield has not verified.
        """
        if self.scenario is None:
            return ()
        found = run_warnings.of_run(self.scenario, self.law, self.built, self.motion_step)
        way = run_warnings.of_way(self.law, self.position, self.scenario.walls)
        return (*run_warnings.of_commands(self.law, self.commanded_periods), *found, *way)

    @property
    def sensing(self) -> Sensing:
        """Which sensors told the law of the robot and of the obstacles."""
        if self.scenario is None:
            return Sensing(robot="exact", obstacles=("exact",))
        return sensing_of(self.scenario, AsBuilt() if self.built is None else self.built)


def without_obstacles(scenario: Scenario) -> Scenario:
    """Return the same way without obstacles."""
    return replace(scenario, obstacles=())
