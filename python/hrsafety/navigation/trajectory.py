"""The record of a run, and its score."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, number
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation import scenario_warnings
from hrsafety.navigation.laws import Law
from hrsafety.navigation.scenario import Scenario
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table, each, plane

__all__ = ["Integrator", "Outcome", "Performance", "Trajectory", "check_weights", "without_obstacles"]

Integrator = Literal["semi_implicit_euler", "rk4"]
Outcome = Literal["arrived", "collided", "timed_out", "stopped"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trajectory(Table):
    """One run of a robot: n instants, m obstacles, w wheels.

    The rows are the motion steps and, last, the instant of arrival (linear inside its step).

    Attributes
    ----------
    scenario : Scenario
        What was simulated.
    law : Law
        The law that drove the robot.
    time : ndarray, shape (n,)
        Instants in s.
    position, velocity : ndarray, shape (n, 2)
        True motion of the robot, in m and m/s.
    force : ndarray, shape (n, 2)
        Force as commanded, in N; from this row to the next.
    heading : ndarray, shape (n,)
        Heading in rad.
    wheel_current : ndarray, shape (n, w)
        Motor currents in A over the step that ends at the row; zero in the first row.
    obstacle_position : ndarray, shape (n, m, 2)
        True obstacle positions in m (centroid for rectangles); NaN while absent.
    distance : ndarray, shape (n, m)
        Distance d from obstacle centre (rectangle: contour) to robot centre in m; NaN while
        absent.
    outcome : {"arrived", "collided", "timed_out", "stopped"}
        How it ended. A contact makes it ``"collided"`` whatever came after.
    arrival_time : float
        First entry into the tolerance circle, in s; NaN without arrival.
    energy : float
        Electrical loss of the motors, in J.
    min_distance, min_clearance : ndarray, shape (m,)
        Least distance d, and least distance between the surfaces, in m; infinite for an
        obstacle that was never present.
    contact_time, contact_speed : ndarray, shape (m,)
        First contact with each obstacle in s and the robot's speed then in m/s; NaN without.
    path_length : float
        Length of the path in m.
    stabilizing : ndarray, shape (n, 2)
        Stabilizing force within ``force``, in N.
    lyapunov : ndarray, shape (n,)
        Lyapunov function V at the force samples, held between them, in N^2; NaN inside a
        critical region.
    """

    scenario: Scenario
    law: Law
    time: Array
    position: Array
    velocity: Array
    force: Array
    heading: Array
    wheel_current: Array
    obstacle_position: Array
    distance: Array
    outcome: Outcome
    arrival_time: float
    energy: float
    min_distance: Array
    min_clearance: Array
    contact_time: Array
    contact_speed: Array
    path_length: float
    stabilizing: Array
    lyapunov: Array

    @property
    def contacts_moving(self) -> int:
        """Number of obstacles that the robot touched while it moved faster than 0.05 m/s."""
        return int(np.sum(self.contact_speed > _hrsafety.CONTACT_SPEED))

    @property
    def contacts_standing(self) -> int:
        """Number of obstacles that touched the standing robot."""
        return int(np.sum(self.contact_speed <= _hrsafety.CONTACT_SPEED))

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each instant.

        Returns
        -------
        dict of str to ndarray
            Units are in the names; obstacles and wheels are numbered.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
        >>> list(run.columns())[:5]
        ['t_s', 'x_m', 'y_m', 'vx_m_per_s', 'vy_m_per_s']
        """
        found = {"t_s": self.time, **plane("{}", self.position, "m"), **plane("v{}", self.velocity, "m/s")}
        found |= {**plane("force_{}", self.force, "N"), "heading_rad": self.heading}
        found |= each("current_{}", self.wheel_current, "A")
        for index in range(self.distance.shape[1]):
            found |= plane(f"obstacle_{index}_{{}}", self.obstacle_position[:, index], "m")
            found[f"distance_{index}_m"] = self.distance[:, index]
        return found | plane("stabilizing_{}", self.stabilizing, "N") | {"lyapunov_N2": self.lyapunov}

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the run may not mean what it seems to: the warnings of its scenario that matter for its law."""
        return scenario_warnings.of_run(self.scenario, self.law)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Performance:
    """Score of a run, each part from 0 to 1 in ordinary cases, Zeng (2011), section 5.6.

    Attributes
    ----------
    total : float
        H = w_T H_T + w_D H_D + w_E H_E; 0 after a contact or without arrival.
    arrival_time : float
        H_T = T*/T.
    avoidance : float
        H_D: mean over the obstacles of min(d_s / d_s*, 1).
    energy_saving : float
        H_E = L*/L.
    trajectory, nominal : Trajectory
        The run, and the run of the same law without obstacles that gives T* and L*.
    """

    total: float
    arrival_time: float
    avoidance: float
    energy_saving: float
    trajectory: Trajectory
    nominal: Trajectory

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the score may not mean what it seems to: the warnings of the run."""
        return self.trajectory.warnings


def check_weights(weights: Sequence[float]) -> tuple[float, float, float]:
    """Return three weights that are not negative and sum to 1."""
    if isinstance(weights, (str, bytes)) or not hasattr(weights, "__len__") or len(weights) != 3:
        raise InvalidParameterError("weights", "be three numbers (time, distance, energy)", weights)
    time, distance, energy = (number(f"weights[{i}]", weights[i]) for i in range(3))
    if not min(time, distance, energy) >= 0.0 or not abs(time + distance + energy - 1.0) <= 1e-9:
        raise InvalidParameterError("weights", "not be negative and sum to 1", weights)
    return (time, distance, energy)


def without_obstacles(scenario: Scenario) -> Scenario:
    """Return the same way without obstacles."""
    return replace(scenario, obstacles=())
