"""Identified parameters are the true ones, and their intervals say how far off they may be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hrsafety import impact
from hrsafety.errors import InvalidParameterError

# Foam 1 of the source on its rig.
STIFFNESS, RATIO, FRICTION, MASS, GRAVITY = 24_250.0, 0.112, 2.0, 1.54, 9.80665
TRUTH = (STIFFNESS, RATIO, FRICTION)
RESOLUTION = 1e-4
REPEATS = 500
TIGHT = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14}


def rounded(values: np.ndarray) -> np.ndarray:
    """What a transducer with 0.1 mm resolution shows."""
    return np.round(values / RESOLUTION) * RESOLUTION


def bench(seed: int, contact: str = "unilateral") -> tuple[np.ndarray, ...]:
    """Return a static test with 1 N noise and one drop from 30 to 60 mm at 1 kHz."""
    generator = np.random.default_rng(seed)
    depth = np.linspace(0.4e-3, 5e-3, 12) + generator.uniform(0.0, RESOLUTION, 12)
    force = STIFFNESS * depth + generator.normal(0.0, 1.0, 12)
    time = np.arange(500) * 1e-3
    drop = impact.identification.drop_trajectory(
        time,
        height=generator.uniform(0.03, 0.06),
        mass=MASS,
        stiffness=STIFFNESS,
        damping_ratio=RATIO,
        friction=FRICTION,
        contact=contact,
    )
    return force, rounded(depth), time, rounded(drop)


@pytest.mark.parametrize("contact", ["unilateral", "attached"])
def test_drops_follow_the_equation_of_motion(contact: str) -> None:
    damping = 2.0 * RATIO * math.sqrt(MASS * STIFFNESS)

    def slope(_: float, state: np.ndarray, direction: float, touching: bool) -> list[float]:
        push = -STIFFNESS * state[0] - damping * state[1] if touching else 0.0
        return [state[1], (push - MASS * GRAVITY - direction * FRICTION) / MASS]

    # Fall, way in, way out until the foam lets go: three stretches with one sign of the speed each.
    def surface(_: float, state: np.ndarray, *__: float) -> float:
        return float(state[0])

    def turn(_: float, state: np.ndarray, *__: float) -> float:
        return float(state[1])

    def release(_: float, state: np.ndarray, *__: float) -> float:
        return float(STIFFNESS * state[0] + (damping * state[1] if contact == "unilateral" else 0.0))

    state, now, height = [0.04, 0.0], 0.0, []
    instants: list[float] = []
    for event, direction, touching in ((surface, -1.0, False), (turn, -1.0, True), (release, 1.0, True)):
        event.terminal = True
        run = solve_ivp(
            slope, (now, now + 0.2), state, dense_output=True, events=event, args=(direction, touching), **TIGHT
        )
        inside = np.linspace(now, run.t[-1], 9)[1:]
        height.extend(run.sol(inside)[0])
        instants.extend(inside)
        now, state = float(run.t[-1]), run.y[:, -1]
        state = [state[0], 0.0] if event is turn else state
    found = impact.identification.drop_trajectory(
        [0.0, *instants],
        height=0.04,
        mass=MASS,
        stiffness=STIFFNESS,
        damping_ratio=RATIO,
        friction=FRICTION,
        contact=contact,
    )
    np.testing.assert_allclose(found[1:], height, atol=1e-11)


def test_nominal_intervals_cover_the_truth_in_90_to_99_percent_of_500_repeats() -> None:
    covered = np.zeros(3)
    values = []
    for seed in range(REPEATS):
        fit = impact.identify_foam(*bench(seed), MASS)
        covered += (fit.interval[:, 0] <= TRUTH) & (fit.interval[:, 1] >= TRUTH)
        values.append([fit.stiffness, fit.damping_ratio, fit.friction])
    share = covered / REPEATS
    assert ((share >= 0.90) & (share <= 0.99)).all(), share
    # No bias: the mean is off by less than four of its own standard errors.
    error = np.std(values, axis=0) / math.sqrt(REPEATS)
    np.testing.assert_array_less(np.abs(np.mean(values, axis=0) - TRUTH), 4.0 * error)


@pytest.mark.parametrize("offset", [False, True])
def test_static_fit_is_the_least_squares_line_and_its_intervals_cover_the_truth(offset: bool) -> None:
    covered, zero = 0, 3.0 if offset else 0.0
    for seed in range(REPEATS):
        generator = np.random.default_rng(seed)
        depth = np.linspace(0.4e-3, 5e-3, 12)
        force = STIFFNESS * depth + zero + generator.normal(0.0, 1.0, 12)
        fit = impact.identification.fit_static(force, depth, offset=offset)
        plain = np.column_stack([depth, np.ones(12)] if offset else [depth])
        solution = np.linalg.lstsq(plain, force, rcond=None)[0]
        assert fit.stiffness == pytest.approx(solution[0], rel=1e-9)
        assert fit.force_offset == pytest.approx(solution[1] if offset else 0.0, rel=1e-8)
        assert fit.degrees_of_freedom == 12 - plain.shape[1]
        covered += fit.interval[0, 0] <= STIFFNESS <= fit.interval[0, 1]
    assert 0.90 * REPEATS <= covered <= 0.99 * REPEATS


def test_several_drops_narrow_the_intervals() -> None:
    benches = [bench(seed) for seed in range(3)]
    one = impact.identify_foam(*benches[0], MASS)
    three = impact.identify_foam(
        benches[0][0], benches[0][1], [each[2] for each in benches], [each[3] for each in benches], MASS
    )
    assert len(three.drop_heights) == 3
    width = np.diff(np.asarray(three.interval), axis=1) / np.diff(np.asarray(one.interval), axis=1)
    assert (width < 0.8).all()


def test_bootstrap_intervals_agree_with_the_covariance_and_repeat_with_their_seed() -> None:
    measured = bench(5)
    fits = [impact.identify_foam(*measured, MASS, bootstrap=400, seed=seed) for seed in (7, 7, 8)]
    intervals = [np.asarray(fit.bootstrap_interval) for fit in fits]
    np.testing.assert_array_equal(intervals[0], intervals[1])
    assert (intervals[0] != intervals[2]).any()
    width = np.diff(intervals[0], axis=1) / np.diff(np.asarray(fits[0].interval), axis=1)
    assert ((width > 0.6) & (width < 1.6)).all(), width
    assert impact.identify_foam(*measured, MASS).bootstrap_interval is None


def test_differentiated_samples_bias_the_damping_and_the_trajectory_does_not() -> None:
    """Differences of rounded readings put noise into the regressor; the fit of the trajectory has none."""
    differentiated, fitted = [], []
    for seed in range(20):
        force, depth, time, drop = bench(seed)
        velocity = np.gradient(drop, time)
        acceleration = np.gradient(velocity, time)
        touching = drop < -2.0 * RESOLUTION
        rest = MASS * acceleration + STIFFNESS * drop + MASS * GRAVITY + FRICTION * np.sign(velocity)
        damping = -np.sum((rest * velocity)[touching]) / np.sum((velocity**2)[touching])
        differentiated.append(damping / (2.0 * math.sqrt(MASS * STIFFNESS)))
        fitted.append(impact.identify_foam(force, depth, time, drop, MASS).damping_ratio)
    assert abs(np.mean(fitted) - RATIO) < 1e-3
    assert abs(np.mean(differentiated) - RATIO) > 4e-3


def test_table_a_1_gives_the_numbers_of_its_regression() -> None:
    fit = impact.identification.identify_direct_drive(
        [0.3, 0.4, 0.6, 0.8, 1.0],
        [0.497, 0.808, 1.504, 2.555, 3.723],
        [0.121, 0.161, 0.098, 0.110, 0.109, 0.113, 0.138, 0.138, 0.184, 0.183],
        0.059,
    )
    assert round(fit.command_gain, 3) == 4.597
    assert round(fit.friction_offset, 3) == -1.033
    assert round(fit.decay, 4) == 0.1355
    assert round(fit.torque_constant, 5) == 0.27121
    assert round(fit.viscous_friction, 7) == 0.0079945
    assert fit.interval[0][0] < fit.command_gain < fit.interval[0][1]


def test_gains_for_a_wanted_stiffness_with_both_torque_constants() -> None:
    wanted = {"stiffness": 20e3, "damping": 250.0, "lever_arm": 0.078}
    printed = impact.identification.pd_gains(**wanted, torque_constant=0.2807, viscous_friction=0.0079)
    assert (round(printed.proportional, 3), round(printed.derivative, 5)) == (433.488, 5.39045)
    right = impact.identification.pd_gains(**wanted, torque_constant=0.27121, viscous_friction=0.0079945)
    assert (round(right.proportional, 1), round(right.derivative, 3)) == (448.7, 5.579)


def test_open_loop_intervals_cover_the_truth() -> None:
    time = np.arange(300) * 5e-3
    angle = 1.504 * (0.111 * time - 1.0 + np.exp(-0.111 * time)) / 0.111**2
    covered = np.zeros(2)
    for seed in range(300):
        fit = impact.identification.fit_open_loop(time, angle + np.random.default_rng(seed).normal(0.0, 2e-3, 300))
        interval = np.asarray(fit.interval)
        covered += (interval[:, 0] <= (1.504, 0.111)) & (interval[:, 1] >= (1.504, 0.111))
    assert ((covered / 300 >= 0.90) & (covered / 300 <= 0.99)).all()


def drive(**changes: float) -> impact.joints.DirectDrive:
    """Return the joint whose linear form is Manipulator 1."""
    gains = impact.identification.pd_gains(
        stiffness=20e3, damping=250.0, lever_arm=0.078, torque_constant=0.27121, viscous_friction=0.0079945
    )
    values = {"proportional": gains.proportional, "derivative": gains.derivative, "inertia": 9.6 * 0.078**2}
    return impact.joints.DirectDrive(**(values | changes))


FOAM = impact.Foam(stiffness=24.25e3, damping=71.9)
HEAD = impact.Head.apparatus()


def test_a_joint_without_limit_is_the_linear_manipulator() -> None:
    linear = drive(voltage_limit=math.inf)
    run = impact.joints.simulate_direct_drive(linear, FOAM, HEAD, closing_speed=1.25, duration=0.06, step=1e-3)
    exact = impact.simulate(linear.linear(), FOAM, HEAD, closing_speed=1.25, duration=0.06, step=1e-3)
    for name in ("manipulator_position", "manipulator_velocity", "head_position", "head_velocity", "contact_force"):
        reference = getattr(exact, name)
        np.testing.assert_allclose(getattr(run, name), reference, atol=1e-10 * np.abs(reference).max(), err_msg=name)
    metrics = impact.metrics(linear.linear(), FOAM, HEAD, closing_speed=1.25)
    assert run.peak_head_acceleration == pytest.approx(metrics.peak_head_acceleration, rel=1e-6)
    assert run.impact_duration == pytest.approx(metrics.impact_duration, rel=1e-9)
    assert math.isnan(run.saturated_from)


def test_the_limited_joint_saturates_and_is_softer_than_the_linear_one() -> None:
    run = impact.joints.simulate_direct_drive(drive(), FOAM, HEAD, closing_speed=1.25)
    linear = impact.metrics(drive().linear(), FOAM, HEAD, closing_speed=1.25)
    assert np.abs(run.command).max() == 5.0
    # What the controller asks for at the end of the impact: 256.5 N against the 17.4 N of 5 V.
    assert run.requested_command.max() > 50.0
    assert 0.0 < run.saturated_from < 0.005
    assert 0.9 * linear.peak_head_acceleration < run.peak_head_acceleration < linear.peak_head_acceleration


def test_bad_measurements_are_named() -> None:
    force, depth, time, drop = bench(1)
    with pytest.raises(InvalidParameterError, match="above the foam"):
        impact.identify_foam(force, depth, time, drop - 0.1, MASS)
    with pytest.raises(InvalidParameterError, match="above the foam"):
        impact.identify_foam(force, depth, time, drop + 0.1, MASS)
    with pytest.raises(InvalidParameterError, match="moving_mass"):
        impact.identify_foam(force, depth, time, drop, 0.0)
    with pytest.raises(InvalidParameterError, match="different values"):
        impact.identify_foam(force, np.zeros(12), time, drop, MASS)
    with pytest.raises(InvalidParameterError, match="confidence"):
        impact.identify_foam(force, depth, time, drop, MASS, confidence=1.0)
