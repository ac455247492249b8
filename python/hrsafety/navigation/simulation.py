"""One run: forces at a state, the Lyapunov function, the trajectory and its score."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import flag, number, numbers, pair, points
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.laws import Law, VirtualForceField
from hrsafety.navigation.robots import DifferentialDriveRobot
from hrsafety.navigation.scenario import Scenario, _require

__all__ = [
    "ForceField",
    "ForceTerms",
    "Lyapunov",
    "Performance",
    "Trajectory",
    "evaluate",
    "force_field",
    "force_terms",
    "lyapunov",
    "simulate",
]

Array = npt.NDArray[np.float64]
Integrator = Literal["semi_implicit_euler", "rk4"]
Outcome = Literal["arrived", "collided", "timed_out", "stopped"]


class ForceTerms(NamedTuple):
    """Virtual forces at one state, before the acceleration limit.

    Attributes
    ----------
    attractive : ndarray, shape (2,)
        F_a in N.
    repulsive, detour : ndarray, shape (n, 2)
        F_Lambda and F_psi of each obstacle in N; zero outside its active region.
    stabilizing : ndarray, shape (2,)
        F_L in N, in the mode of the law.
    total : ndarray, shape (2,)
        Commanded force in N: the sum, or the braking force inside a critical region, where
        every term is zero.
    region : ndarray of str, shape (n,)
        ``"free"``, ``"active"``, ``"critical"`` or ``"absent"`` for each obstacle.
    side : ndarray of int, shape (n,)
        Side of the detour: +1 counter-clockwise, -1 clockwise, 0 when not active.
    omega : float
        Omega of (5.5.8), corrected, in N^2/s.
    """

    attractive: Array
    repulsive: Array
    detour: Array
    stabilizing: Array
    total: Array
    region: npt.NDArray[np.str_]
    side: npt.NDArray[np.int64]
    omega: float


class ForceField(NamedTuple):
    """Virtual forces at many positions, summed over the obstacles.

    Attributes
    ----------
    position : ndarray, shape (n, 2)
        Where, in m.
    attractive, repulsive, detour, stabilizing, total : ndarray, shape (n, 2)
        Forces in N; NaN inside a critical region except ``total``, which brakes there.
    potential : ndarray, shape (n,)
        Lyapunov function V in N^2; NaN inside a critical region.
    """

    position: Array
    attractive: Array
    repulsive: Array
    detour: Array
    stabilizing: Array
    total: Array
    potential: Array


class Lyapunov(NamedTuple):
    """Lyapunov function of the force field at one state.

    Attributes
    ----------
    value : float
        V in N^2.
    derivative : float
        dV/dt in N^2/s with the law's own stabilizing force; limits of the robot are ignored.
    omega : float
        Omega in N^2/s.
    """

    value: float
    derivative: float
    omega: float


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trajectory:
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


def _check(scenario: Scenario, law: Law, kind: type[Law] = VirtualForceField) -> None:
    _require("scenario", scenario, Scenario)
    _require("law", law, kind)


def command(
    law: Law,
    scenario: Scenario,
    *,
    position: Sequence[float] | Array,
    velocity: Sequence[float] | Array,
    time: float = 0.0,
) -> Array:
    """Return the force that any law asks for at one state, as at its first control step.

    Parameters
    ----------
    law : Law
        The law.
    scenario : Scenario
        Robot, goal and obstacles.
    position, velocity : array_like, shape (2,)
        State of the robot, in m and m/s.
    time : float
        When, in s; moving obstacles are where they are then.

    Returns
    -------
    ndarray, shape (2,)
        Force in N before the limits of the robot. A planner asks for ``m (v* - V)/T_s``, with
        its velocity v* and the control period T_s.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, the time is negative, or the law cannot work in the scenario.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> nav.command(
    ...     nav.Masoud(), scenarios.configuration("c1"), position=(3.5, 0.6), velocity=(0.0, 0.0)
    ... ).round(3).tolist()
    [-17.5, 0.0]
    """
    _check(scenario, law, Law)
    state = pair("position", position), pair("velocity", velocity)
    return np.array(_hrsafety.law_command(law._native, scenario._native, *state, number("time", time)))


def force_terms(
    law: VirtualForceField,
    scenario: Scenario,
    *,
    position: Sequence[float] | Array,
    velocity: Sequence[float] | Array,
    time: float = 0.0,
) -> ForceTerms:
    """Return every virtual force at one state.

    Parameters
    ----------
    law : VirtualForceField
        The law.
    scenario : Scenario
        Goal and obstacles.
    position, velocity : array_like, shape (2,)
        State of the robot, in m and m/s.
    time : float
        When, in s; moving obstacles are where they are then.

    Returns
    -------
    ForceTerms
        Attractive, repulsive, detour, stabilizing and total force, region and side.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or the time is negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> terms = nav.force_terms(
    ...     nav.VirtualForceField(), scenarios.configuration("c1"),
    ...     position=(2.95, 0.71), velocity=(-0.5, 0.1),
    ... )
    >>> terms.repulsive.round(3).tolist()
    [[28.788, 6.621]]
    """
    _check(scenario, law)
    fields = _hrsafety.force_terms(
        law._native, scenario._native, pair("position", position), pair("velocity", velocity), number("time", time)
    )
    return ForceTerms(**fields)


def force_field(
    law: VirtualForceField,
    scenario: Scenario,
    *,
    position: npt.ArrayLike,
    velocity: Sequence[float] | npt.ArrayLike = (0.0, 0.0),
    time: float = 0.0,
) -> ForceField:
    """Return the virtual forces at many positions, for maps and arrows.

    Parameters
    ----------
    law : VirtualForceField
        The law.
    scenario : Scenario
        Goal and obstacles.
    position : array_like, shape (n, 2)
        Positions of the robot in m.
    velocity : array_like, shape (2,) or (n, 2)
        Velocity of the robot there, in m/s.
    time : float
        When, in s.

    Returns
    -------
    ForceField
        Forces summed over the obstacles, and the Lyapunov function.

    Raises
    ------
    InvalidParameterError
        If a value is not finite or the time is negative.
    ShapeError
        If the arrays do not fit together.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> field = nav.force_field(
    ...     nav.VirtualForceField(), scenarios.configuration("c1"), position=[[3.5, 0.6], [3.0, 0.6]]
    ... )
    >>> field.total.shape
    (2, 2)
    """
    _check(scenario, law)
    places = points("position", position)
    speeds = numbers("velocity", velocity, "be an array of numbers")
    if speeds.shape not in {(2,), places.shape}:
        raise ShapeError("velocity", f"(2,) or {places.shape}", speeds.shape)
    speeds = np.ascontiguousarray(np.broadcast_to(speeds, places.shape))
    fields = _hrsafety.force_field(law._native, scenario._native, places, speeds, number("time", time))
    return ForceField(position=places, **fields)


def lyapunov(
    law: VirtualForceField,
    scenario: Scenario,
    *,
    position: Sequence[float] | Array,
    velocity: Sequence[float] | Array,
    time: float = 0.0,
) -> Lyapunov:
    """Return the Lyapunov function (5.5.2) of the field and its derivative.

    ``V = K_1^2 |E|^2/2 + m K_1 |V|^2/2 + sum over active obstacles of K_3^2 L^2/2
    + m K_3 (r_2-d)^2/(d-r_3)^2 ddot^2/2 + K_5^2 psi^2/2 + m K_5 (r_2-d)^2 d Phidot^2/2`` and
    ``dV/dt = -b |v_L|^2 - v_L.F_L + Omega`` with the corrected Omega. The identity holds for
    discs as long as no side switches; on the face of a rectangle it does not.

    Parameters
    ----------
    law : VirtualForceField
        The law; its stabilizing force enters the derivative.
    scenario : Scenario
        Goal and obstacles.
    position, velocity : array_like, shape (2,)
        State of the robot, in m and m/s.
    time : float
        When, in s.

    Returns
    -------
    Lyapunov
        value, derivative, omega.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, or the position lies inside a critical region, where the
        function is not defined.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> state = nav.lyapunov(
    ...     nav.VirtualForceField(stabilizing="full"), scenarios.configuration("c1"),
    ...     position=(2.95, 0.71), velocity=(-0.5, 0.1),
    ... )
    >>> state.derivative <= 0
    True
    """
    _check(scenario, law)
    return Lyapunov(
        *_hrsafety.lyapunov(
            law._native, scenario._native, pair("position", position), pair("velocity", velocity), number("time", time)
        )
    )


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
    _check(scenario, law, Law)
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
    _check(scenario, law, Law)
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
