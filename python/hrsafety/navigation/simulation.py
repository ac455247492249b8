"""One run: the trajectory and its score."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, flag, number
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.forces import check_law
from hrsafety.navigation.laws import Law
from hrsafety.navigation.robots import DifferentialDriveRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table, each, plane

__all__ = [
    "Performance",
    "Trajectory",
    "evaluate",
    "simulate",
]

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
        from hrsafety.navigation import scenario_warnings  # found only when asked for

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


def simulate(
    scenario: Scenario,
    law: Law,
    *,
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
    stop_on_contact: bool = False,
) -> Trajectory:
    """Run one robot from start to goal.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles.
    law : Law
        What drives the robot.
    integrator : {"semi_implicit_euler", "rk4"}
        Velocity first and position with the new velocity, or Runge-Kutta of order 4 with the
        speed limit in every stage.
    step : float
        Motion step in s.
    hold : bool
        Whether the force is computed once a control period and held, as a sampled controller
        does; otherwise at every step (``"rk4"``: at every stage). With ``hold`` the step must
        divide the control period. A measurement needs ``hold``.
    stop_on_contact : bool
        Whether the run ends at the first contact.

    Returns
    -------
    Trajectory
        The run; a `BuiltTrajectory` for a `DifferentialDriveRobot`, which moves by
        semi-implicit Euler with a held force, as `simulate_built` does.

    Raises
    ------
    InvalidParameterError
        If the step is not positive and finite or does not divide the control period, or a
        word is unknown.
    SimulationError
        If the state became non-finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> run.outcome, round(run.arrival_time, 2), round(float(run.min_distance[0]), 3)
    ('arrived', 6.63, 0.536)
    """
    check_law(scenario, law, Law)
    if isinstance(scenario.robot, DifferentialDriveRobot):
        _check_held(integrator, hold)
        from hrsafety.navigation import built  # which needs this module

        return built.simulate_built(scenario, law, step=step, stop_on_contact=stop_on_contact)
    fields = _hrsafety.simulate(
        scenario._native,
        law._native,
        integrator,
        number("step", step),
        flag("hold", hold),
        flag("stop_on_contact", stop_on_contact),
    )
    return Trajectory(scenario=scenario, law=law, **fields)


def check_weights(weights: Sequence[float]) -> tuple[float, float, float]:
    """Return three weights that are not negative and sum to 1."""
    if isinstance(weights, (str, bytes)) or not hasattr(weights, "__len__") or len(weights) != 3:
        raise InvalidParameterError("weights", "be three numbers (time, distance, energy)", weights)
    time, distance, energy = (number(f"weights[{i}]", weights[i]) for i in range(3))
    if not min(time, distance, energy) >= 0.0 or not abs(time + distance + energy - 1.0) <= 1e-9:
        raise InvalidParameterError("weights", "not be negative and sum to 1", weights)
    return (time, distance, energy)


def evaluate(
    scenario: Scenario,
    law: Law,
    weights: Sequence[float] = (1 / 3, 1 / 3, 1 / 3),
    *,
    integrator: Integrator = "semi_implicit_euler",
    step: float = 0.01,
    hold: bool = True,
) -> Performance:
    """Run one robot and score it, Zeng (2011), section 5.6.

    ``H = k (w_T T*/T + w_D mean_i min(d_s,i / d_s,i*, 1) + w_E L*/L)`` with k = 0 after a
    contact or without arrival, ``d_s = d - rho_r - rho_obs`` and
    ``d_s* = r_2 - rho_r - rho_obs``. T* and L* come from the same law without obstacles.

    Parameters
    ----------
    scenario : Scenario
        Robot, start, goal, obstacles.
    law : Law
        What drives the robot.
    weights : sequence of float
        Weights of time, distance and energy; not negative, sum 1.
    integrator, step, hold
        As for `simulate`.

    Returns
    -------
    Performance
        total, arrival_time, avoidance, energy_saving and both trajectories.

    Raises
    ------
    InvalidParameterError
        As `simulate`, or if the weights are negative or do not sum to 1.
    SimulationError
        If the state became non-finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> round(nav.evaluate(scenarios.configuration("c1"), nav.VirtualForceField()).total, 2)
    0.65
    """
    check_law(scenario, law, Law)
    if isinstance(scenario.robot, DifferentialDriveRobot):
        _check_held(integrator, hold)
        from hrsafety.navigation import built  # which needs this module

        return built.evaluate_built(scenario, law, weights, step=step)
    scores, run, nominal = _hrsafety.evaluate(
        scenario._native, law._native, check_weights(weights), integrator, number("step", step), flag("hold", hold)
    )
    return Performance(
        **scores,
        trajectory=Trajectory(scenario=scenario, law=law, **run),
        nominal=Trajectory(scenario=without_obstacles(scenario), law=law, **nominal),
    )


def without_obstacles(scenario: Scenario) -> Scenario:
    """Return the same way without obstacles."""
    return replace(scenario, obstacles=())


def _check_held(integrator: Integrator, hold: bool) -> None:
    """Refuse what a two-wheel robot cannot do."""
    if flag("hold", hold) is False:
        raise InvalidParameterError("hold", "be True for a DifferentialDriveRobot", hold)
    if integrator != "semi_implicit_euler":
        raise InvalidParameterError("integrator", 'be "semi_implicit_euler" for a DifferentialDriveRobot', integrator)
