"""Local stability of the tracking laws, and their motion, against NumPy and SciPy.

The loops are linearized twice: from the equations, by hand, into the matrix of one control
period, and from the package, by central differences of one simulated period.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from hrsafety import navigation as nav

Array = np.ndarray[Any, np.dtype[np.float64]]

PERIODS = (0.06, 0.01)
SPEEDS = (0.1, 0.3, 0.5, 0.63, 0.7)
SMALL = 1e-5  # m and rad: differences of one period, whose second-order part is 1e-10 of the state
DIFFERENCES = 1e-6  # error of an eigenvalue from such differences
K_P, K_H = 2.0, 6.0
XI, K = 0.95, 10.0

WIDE = nav.DifferentialDriveRobot(max_speed=50.0, max_acceleration=1e6, max_angular_acceleration=1e9, wheel_span=0.01)
"""A robot that no limit touches; it turns at up to 10 000 rad/s."""


def one_period(law: nav.tracking.Tracking, speed: float, turn: float, period: float) -> Callable[[Array], Array]:
    """Return the map of (lag along, lag across, heading error) in the axes of the reference over one period."""
    if turn:
        reference: nav.tracking.Reference = nav.tracking.CircleReference(
            center=(0.0, speed / turn), radius=speed / abs(turn), speed=math.copysign(speed, turn),
            start_angle=-math.copysign(math.pi / 2, turn),
        )  # fmt: skip
    else:
        reference = nav.tracking.LineReference(start=(0.0, 0.0), velocity=(speed, 0.0))

    def advance(state: Array) -> Array:
        run = nav.tracking.track(
            reference, law, position=-state[:2], heading=-state[2], speed=speed, turn_rate=turn,
            robot=WIDE, control_period=period, step=period, duration=period,
        )  # fmt: skip
        offset = run.reference_position[-1] - run.position[-1]
        angle = turn * period
        cos, sin = math.cos(angle), math.sin(angle)
        return np.array([cos * offset[0] + sin * offset[1], cos * offset[1] - sin * offset[0], angle - run.heading[-1]])

    return advance


def jacobian(function: Callable[[Array], Array]) -> Array:
    """Central differences at zero, which the function must leave where it is."""
    assert function(np.zeros(3)) == pytest.approx(np.zeros(3), abs=1e-14)
    columns = [(function(SMALL * unit) - function(-SMALL * unit)) / (2.0 * SMALL) for unit in np.eye(3)]
    return np.stack(columns, axis=1)


def radius(matrix: Array) -> float:
    return float(np.abs(np.linalg.eigvals(matrix)).max())


def held(feedback: Array, speed: float, period: float) -> Array:
    """Matrix of one period on a straight reference with speed and turn rate held.

    ``feedback`` gives speed and turn rate from (lag along, lag across, heading error). Over a period the heading
    turns by omega T, and the robot moves across by v T (phi + omega T/2), to first order.
    """
    motion = np.eye(3)
    motion[1, 2] = speed * period
    effect = np.array([[-period, 0.0], [0.0, -speed * period**2 / 2.0], [0.0, -period]])
    return np.asarray(motion + effect @ feedback)


def full_speed_feedback(speed: float) -> Array:
    # alpha = K_p e_y/v + phi_e, to first order.
    return np.array([[K_P, 0.0, 0.0], [0.0, K_H * K_P / speed, K_H]])


def nonlinear_feedback(speed: float) -> Array:
    damped = 2.0 * XI * math.sqrt(K) * speed
    return np.array([[damped, 0.0, 0.0], [0.0, K * speed, damped]])


CASES = [
    (nav.tracking.FullSpeedTracking(), full_speed_feedback),
    (nav.tracking.NonlinearTracking(), nonlinear_feedback),
]


@pytest.mark.parametrize("period", PERIODS)
@pytest.mark.parametrize(("law", "feedback"), CASES, ids=["full_speed", "nonlinear"])
@pytest.mark.parametrize("speed", SPEEDS)
def test_linearized_period_is_that_of_the_equations(
    law: nav.tracking.Tracking, feedback: Callable[[float], Array], speed: float, period: float
) -> None:
    matrix = held(feedback(speed), speed, period)
    assert jacobian(one_period(law, speed, 0.0, period)) == pytest.approx(matrix, abs=DIFFERENCES)
    assert radius(matrix) < 1.0


@pytest.mark.parametrize("period", PERIODS)
def test_full_speed_poles_do_not_depend_on_the_speed(period: float) -> None:
    across = np.array([[1.0 - period**2 * K_H * K_P / 2.0, period * (1.0 - period * K_H / 2.0)],
                       [-period * K_H * K_P, 1.0 - period * K_H]])  # fmt: skip
    for speed in SPEEDS:
        found = radius(held(full_speed_feedback(speed), speed, period))
        assert found == pytest.approx(max(1.0 - period * K_P, radius(across)), abs=1e-12)


def test_nonlinear_radii_are_those_of_the_specification() -> None:
    # 0.98 at 0.1 m/s to 0.87 at 0.7 m/s and T_s = 0.06 s; tends to 1 as the reference slows down.
    radii = [radius(jacobian(one_period(nav.tracking.NonlinearTracking(), speed, 0.0, 0.06))) for speed in (0.1, 0.7)]
    assert [round(value, 2) for value in radii] == [0.98, 0.87]
    slow = radius(jacobian(one_period(nav.tracking.NonlinearTracking(), 1e-3, 0.0, 0.06)))
    assert 1.0 - 1e-3 < slow < 1.0


def test_a_fast_turning_reference_destabilizes_the_nonlinear_law_only() -> None:
    # At omega_d = 20 rad/s the gain 2 xi omega_n is 38 1/s: more than 2/T_s.
    assert radius(jacobian(one_period(nav.tracking.NonlinearTracking(), 0.3, 20.0, 0.06))) > 1.0
    assert radius(jacobian(one_period(nav.tracking.NonlinearTracking(), 0.3, 20.0, 0.01))) < 1.0
    for turn in (0.5, 2.0, 5.0):
        for period in PERIODS:
            for speed in SPEEDS:
                for law in (nav.tracking.FullSpeedTracking(), nav.tracking.NonlinearTracking()):
                    assert radius(jacobian(one_period(law, speed, turn, period))) < 1.0


def test_full_speed_law_loses_stability_where_the_argument_says() -> None:
    # Across: stable if and only if T K_p < 2 and T K_h < 2; along: T K_p < 2.
    for position_gain, heading_gain, stable in [
        (32.0, 6.0, True),
        (34.0, 6.0, False),
        (2.0, 32.0, True),
        (2.0, 34.0, False),
    ]:
        law = nav.tracking.FullSpeedTracking(position_gain=position_gain, heading_gain=heading_gain)
        assert (radius(jacobian(one_period(law, 0.5, 0.0, 0.06))) < 1.0) is stable


# ---- continuous loops -------------------------------------------------------------------------


def wrap(angle: float) -> float:
    return math.remainder(angle, math.tau)


def full_speed_law(state: Array, place: Array, velocity: Array, turn: float) -> tuple[float, float]:
    wanted = velocity + K_P * (place - state[:2])
    alpha = wrap(math.atan2(wanted[1], wanted[0]) - state[2])
    return math.hypot(*wanted) * max(math.cos(alpha), 0.0), turn * math.cos(alpha) + K_H * alpha


def nonlinear_law(state: Array, place: Array, velocity: Array, turn: float) -> tuple[float, float]:
    offset = complex(*(place - state[:2])) * np.exp(-1j * state[2])
    error = wrap(math.atan2(velocity[1], velocity[0]) - state[2])
    speed = math.hypot(*velocity)
    damped = 2.0 * XI * math.sqrt(turn**2 + K * speed**2)
    return speed * math.cos(error) + damped * offset.real, turn + K * speed * offset.imag + damped * error


def goal_law(heading: float) -> Callable[[Array, Array, Array, float], tuple[float, float]]:
    def law(state: Array, place: Array, _velocity: Array, _turn: float) -> tuple[float, float]:
        offset = place - state[:2]
        distance, bearing = math.hypot(*offset), math.atan2(offset[1], offset[0])
        alpha, theta = wrap(bearing - state[2]), wrap(bearing - heading)
        speed = 1.5 * distance * max(math.cos(alpha), 0.0)
        rate = speed / distance
        return speed, 4.0 * alpha + rate * math.sin(alpha) * (1.0 + 1.5 * theta / alpha)

    return law


CONTINUOUS = {
    "full_speed": (nav.tracking.FullSpeedTracking(), full_speed_law),
    "nonlinear": (nav.tracking.NonlinearTracking(), nonlinear_law),
    "goal": (nav.tracking.ExponentialTracking(goal_heading=0.4, capture_radius=math.inf), goal_law(0.4)),
}


@pytest.mark.parametrize("name", CONTINUOUS)
@pytest.mark.parametrize("heading", [-2.4, -0.5, 0.6, 2.0])
def test_short_periods_tend_to_the_differential_equation(name: str, heading: float) -> None:
    law, equations = CONTINUOUS[name]
    speed, radius_, end = (0.0, 1.0, 1.5) if name == "goal" else (0.4, 0.8, 1.5)
    turn = speed / radius_
    circle = nav.tracking.CircleReference(center=(0.0, 0.0), radius=radius_, speed=speed)

    def rates(time: float, state: Array) -> list[float]:
        cos, sin = math.cos(turn * time), math.sin(turn * time)
        place, velocity = radius_ * np.array([cos, sin]), speed * np.array([-sin, cos])
        forward, turning = equations(state, place, velocity, turn)
        return [forward * math.cos(state[2]), forward * math.sin(state[2]), turning]

    start = [0.5, 0.3, heading]
    solution = solve_ivp(rates, (0.0, end), start, method="DOP853", rtol=1e-10, atol=1e-12, max_step=0.01).y[:, -1]

    def final(period: float) -> Array:
        run = nav.tracking.track(
            circle, law, position=start[:2], heading=heading, robot=WIDE,
            control_period=period, step=period, duration=end, goal=(radius_, 0.0),
        )  # fmt: skip
        return np.array([*run.position[-1], run.heading[-1]])

    coarse, fine = final(1e-3), final(5e-4)
    assert fine == pytest.approx(solution, abs=3e-3)
    # Held commands err in proportion to the period, so twice the fine one less the coarse one errs far less.
    assert 2.0 * fine - coarse == pytest.approx(solution, abs=2e-5)


@pytest.mark.parametrize("bearing", [-1.1, 0.3, 1.0])
def test_goal_phase_has_its_closed_form(bearing: float) -> None:
    # Without a wanted heading alpha = alpha_0 exp(-4 t) and d ln(rho)/dt = -1.5 cos(alpha)^2.
    law = nav.tracking.ExponentialTracking(capture_radius=math.inf)
    run = nav.tracking.track(
        nav.tracking.LineReference(start=(0.3, 0.0)), law, heading=-bearing, robot=WIDE,
        control_period=1e-4, step=1e-4, duration=2.0, goal=(0.3, 0.0),
    )  # fmt: skip
    shrunk, _ = quad(lambda t: 1.5 * math.cos(bearing * math.exp(-4.0 * t)) ** 2, 0.0, 2.0, epsabs=1e-12)
    assert run.error[-1] == pytest.approx(0.3 * math.exp(-shrunk), rel=5e-4)


def test_contraction_of_the_heading_holds_for_every_angle() -> None:
    # With U fixed, alpha+ = alpha - T clip(K_h alpha): |alpha+| < |alpha| up to pi as long as T K_h < 2, and the
    # sign stays as long as T K_h <= 1. U is fixed for a reference so far away that its direction does not change.
    far = nav.tracking.LineReference(start=(1e9, 0.0))
    for period in PERIODS:
        for heading in np.linspace(-math.pi, math.pi, 41)[1:-1]:
            if heading == 0.0:
                continue
            run = nav.tracking.track(
                far,
                heading=heading,
                robot=nav.DifferentialDriveRobot(max_angular_acceleration=1e9),
                control_period=period,
                step=period,
                duration=round(3.0 / period) * period,
            )
            ratio = run.heading[1:] / run.heading[:-1]
            assert (ratio >= 0.0).all()
            assert (ratio < 1.0).all()
            assert abs(run.heading[-1]) < 1e-3


# ---- sizes of the regions ----------------------------------------------------------------------

TABLE = [
    (nav.Human(start=(0.0, 0.0), velocity=(1.0, 0.0)), None, 0.7965, 2.0959, 2.4560),
    (nav.Disc(center=(0.0, 0.0), radius=0.1), None, 0.3665, 0.4330, 0.5813),
    (nav.Rectangle(center=(0.0, 0.0), length=1.4, width=0.6), 0.6, 0.2665, 0.6330, 0.7813),
    (nav.MovingDisc(center=(0.0, 0.0), radius=0.2, velocity=(0.0, -0.5)), None, 0.5315, 1.0251, 1.2794),
]
PRINTED_DIGITS = 5.1e-5  # m: the table has four decimals


@pytest.mark.parametrize(("obstacle", "side", "critical", "active", "active_turning"), TABLE)
def test_regions_grow_by_the_turning_time(
    obstacle: nav.Obstacle, side: float | None, critical: float, active: float, active_turning: float
) -> None:
    for robot, size in ((nav.HolonomicRobot(), active), (nav.DifferentialDriveRobot(), active_turning)):
        found = nav.region_radii(robot, obstacle, faced_side=side)
        assert found.critical_radius == pytest.approx(critical, abs=PRINTED_DIGITS)
        assert found.active_radius == pytest.approx(size, abs=PRINTED_DIGITS)


@pytest.mark.parametrize("limit", [10.0, 35.0, 70.0, 500.0])
@pytest.mark.parametrize("max_speed", [0.3, 0.7, 1.5])
@pytest.mark.parametrize("max_acceleration", [2.0, 10.0])
def test_turning_time_is_that_of_a_quarter_turn(limit: float, max_speed: float, max_acceleration: float) -> None:
    # (7.4.2): pi/2 = alpha t^2/2; the active radius grows by the closing speed times that, for all limits.
    body: dict[str, float] = {"max_speed": max_speed, "max_acceleration": max_acceleration}
    turning = nav.DifferentialDriveRobot(max_angular_acceleration=limit, **body)
    straight = nav.HolonomicRobot(**body)
    for obstacle, closing in ((TABLE[0][0], max_speed + 1.0), (TABLE[1][0], max_speed), (TABLE[2][0], max_speed)):
        larger, smaller = (nav.region_radii(robot, obstacle) for robot in (turning, straight))
        assert larger.critical_radius == smaller.critical_radius
        growth = larger.active_radius - smaller.active_radius
        assert growth == pytest.approx(closing * math.sqrt(math.pi / limit), rel=1e-12)
