"""Arguments of wheels, kinematics and open-loop tests."""

from __future__ import annotations

import dataclasses
import pickle

import numpy as np
import pytest

from hrsafety import navigation as nav

WHEEL = nav.robots.HOLONOMIC_WHEELS[0]
NUMBERS = (
    "inertia",
    "proportional_gain",
    "derivative_gain",
    "gear_ratio",
    "amplifier_gain",
    "winding_resistance",
    "back_emf",
    "current_limit",
    "supply_voltage",
    "period",
    "encoder_counts",
)


def test_presets_are_the_printed_wheels_with_the_defaults() -> None:
    assert (
        nav.robots.WheelDrive(
            inertia=1 / 137,
            viscous_friction=0.26 / 137,
            static_friction=25.7 / 137,
            model=(0.0073, 0.0019, 0.188),
            proportional_gain=37.0,
            derivative_gain=1.1,
        )
        == WHEEL
    )
    assert [wheel.proportional_gain for wheel in nav.robots.DIFFERENTIAL_WHEELS] == [34.0, 35.0]
    assert len(nav.robots.HOLONOMIC_WHEELS) == 3
    assert pytest.approx(2 * np.pi / 20_000) == WHEEL.resolution
    assert dataclasses.replace(WHEEL, encoder_counts=None).resolution == 0.0


def test_wheels_pickle_print_and_compare() -> None:
    assert pickle.loads(pickle.dumps(WHEEL)) == WHEEL
    assert "proportional_gain=37.0" in repr(WHEEL)
    assert dataclasses.replace(WHEEL, period=2e-3) != WHEEL
    for each in (nav.robots.OmniKinematics(), nav.robots.DifferentialKinematics(), nav.robots.Slip(creep=0.1)):
        assert pickle.loads(pickle.dumps(each)) == each


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [np.nan, np.inf, -1.0, "1"])
def test_numbers_out_of_range_are_named(name: str, value: object) -> None:
    with pytest.raises(nav.InvalidParameterError, match=name):
        dataclasses.replace(WHEEL, **{name: value})


def test_other_fields_are_checked() -> None:
    for change, word in (
        ({"feedback": "guess"}, "feedback"),
        ({"feedback": None}, "feedback"),
        ({"observer_poles": (-10.0, 1.0)}, "observer_poles"),
        ({"model": (0.0073, 0.0019)}, "model"),
        ({"model": (0.0, 0.0019, 0.2)}, "model"),
        ({"static_friction": -0.1}, "static_friction"),
    ):
        with pytest.raises(nav.InvalidParameterError, match=word):
            dataclasses.replace(WHEEL, **change)
    assert dataclasses.replace(WHEEL, model=None).model == (
        WHEEL.inertia,
        WHEEL.viscous_friction,
        WHEEL.static_friction,
    )


def test_kinematics_invert_for_rows_and_headings() -> None:
    draws = np.random.default_rng(4)
    velocity, heading = draws.uniform(-2.0, 2.0, (500, 3)), draws.uniform(-4.0, 4.0, 500)
    omni = nav.robots.OmniKinematics()
    speeds = omni.wheel_speeds(velocity, heading=heading)
    back = omni.body_velocity(speeds, heading=heading)
    assert np.abs(back - velocity).max() <= 1e-14 * 2.0
    # The printed matrices (D.1.4), written out.
    for row, angle, speed in zip(velocity[:20], heading, speeds, strict=False):
        turned = np.array([[np.cos(angle), np.sin(angle), 0], [-np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        rows = [[-np.sin(z), np.cos(z), omni.center_distance] for z in np.radians([120, 240, 0])]
        np.testing.assert_allclose(omni.wheel_radius * speed, np.array(rows) @ turned @ row, atol=1e-15)
    two = nav.robots.DifferentialKinematics()
    motion = velocity[:, :2]
    wheels = two.wheel_speeds(motion)
    assert np.abs(two.body_velocity(wheels) - motion).max() <= 1e-14 * 2.0
    world = two.world_velocity(wheels, heading=heading)
    sideways = world[:, 0] * np.sin(heading) - world[:, 1] * np.cos(heading)
    assert np.abs(sideways).max() < 1e-15
    np.testing.assert_array_equal(world[0], two.world_velocity(wheels[0], heading=heading[0]))


def test_kinematics_refuse_other_shapes() -> None:
    for call in (
        lambda: nav.robots.OmniKinematics().wheel_speeds([1.0, 2.0]),
        lambda: nav.robots.OmniKinematics().wheel_speeds(np.zeros((2, 3)), heading=[0.0]),
        lambda: nav.robots.DifferentialKinematics().body_velocity(np.zeros((2, 3))),
        lambda: nav.robots.DifferentialKinematics().world_velocity(np.zeros((2, 2)), heading=[0.0, 0.0, 0.0]),
    ):
        with pytest.raises(nav.ShapeError):
            call()
    with pytest.raises(nav.InvalidParameterError):
        nav.robots.OmniKinematics(wheel_radius=0.0)
    with pytest.raises(nav.InvalidParameterError):
        nav.robots.DifferentialKinematics(span=-1.0)


def test_slip_is_checked_and_needs_grip() -> None:
    for change in ({"creep": 1.0}, {"creep": np.nan}, {"grip": 0.0}, {"grip": -1.0}):
        with pytest.raises(nav.InvalidParameterError):
            nav.robots.Slip(**change)
    rim = np.full(100, 0.7)
    assert nav.robots.Slip().ground_speed(rim)[0] == 0.7
    ground = nav.robots.Slip(grip=5.0).ground_speed(rim, period=0.01)
    np.testing.assert_allclose(np.diff(ground[:14]), 0.05, atol=1e-12)
    assert ground[-1] == 0.7
    with pytest.raises(nav.InvalidParameterError, match="rim_speed"):
        nav.robots.Slip().ground_speed([np.nan])


def test_references_and_runs() -> None:
    reference = nav.robots.WheelReference.sine(duration=2.0)
    run = nav.robots.follow_wheel(WHEEL, reference)
    assert run.time[-1] == pytest.approx(1.999)
    np.testing.assert_array_equal(run.angle_error, run.wanted_angle - run.angle)
    assert run.rms_speed_error < 0.05
    again = nav.robots.follow_wheel(WHEEL, reference)
    assert run.energy == again.energy
    np.testing.assert_array_equal(run.angle, again.angle)
    made = nav.robots.WheelReference.from_speed(reference.speed)
    np.testing.assert_allclose(made.angle, reference.angle, atol=1e-6)
    loss = WHEEL.winding_resistance * WHEEL.period * (run.current**2).sum()
    assert run.energy == pytest.approx(loss)
    assert np.abs(run.read_angle - run.angle).max() <= 0.5001 * WHEEL.resolution
    with pytest.raises(ValueError, match="read-only"):
        reference.angle[0] = 1.0


def test_bad_references_are_refused() -> None:
    for call in (
        lambda: nav.robots.WheelReference(angle=[], speed=[], acceleration=[]),
        lambda: nav.robots.WheelReference(angle=[np.nan], speed=[0.0], acceleration=[0.0]),
        lambda: nav.robots.WheelReference(angle=[0.0, 1.0], speed=[0.0], acceleration=[0.0]),
        lambda: nav.robots.WheelReference.sine(frequency=0.0),
        lambda: nav.robots.WheelReference.from_speed([0.0], period=0.0),
        lambda: nav.robots.follow_wheel(WHEEL, nav.robots.WheelReference.sine(), start_angle=np.inf),
        lambda: nav.robots.follow_wheel(WHEEL, "sine"),  # type: ignore[arg-type]  # the refusal is the test
        lambda: nav.robots.follow_wheel("wheel", nav.robots.WheelReference.sine()),  # type: ignore[arg-type]  # the refusal is the test
    ):
        with pytest.raises((nav.InvalidParameterError, nav.ShapeError)):
            call()


def test_a_command_without_bounds_is_an_error() -> None:
    beyond = nav.robots.WheelReference(angle=[1e308], speed=[-1.75e308], acceleration=[0.0])
    with pytest.raises(nav.SimulationError):
        nav.robots.follow_wheel(WHEEL, beyond)


def test_a_start_off_the_reference_is_caught_up() -> None:
    run = nav.robots.follow_wheel(WHEEL, nav.robots.WheelReference.sine(), start_angle=0.2, start_speed=-1.0)
    assert run.angle[0] == 0.2
    assert run.speed[0] == -1.0
    assert np.abs(run.angle_error[5000:]).max() < 0.005


def test_bad_open_loop_tests_are_refused() -> None:
    tests = nav.robots.open_loop_tests(WHEEL)
    assert len(tests) == 12
    for call in (
        lambda: nav.robots.identify_wheel(tests[:2]),
        lambda: nav.robots.identify_wheel(tests[:3], least_angle=1e6),
        lambda: nav.robots.identify_wheel(nav.robots.open_loop_tests(WHEEL, [0.3], repeats=4)),
        lambda: nav.robots.identify_wheel([1, 2, 3]),  # type: ignore[list-item]  # the refusal is the test
        lambda: nav.robots.open_loop_tests(WHEEL, [0.0]),
        lambda: nav.robots.open_loop_tests(WHEEL, [np.nan]),
        lambda: nav.robots.open_loop_tests(WHEEL, repeats=0),
        lambda: nav.robots.open_loop_tests(WHEEL, duration=0.001),
        lambda: nav.robots.OpenLoopTest(command=0.3, time=[0.0, 1.0], angle=[0.0]),
    ):
        with pytest.raises((nav.InvalidParameterError, nav.ShapeError)):
            call()
    assert nav.robots.identify_wheel(tests).covariance.shape == (2, 2)


def test_many_tests_of_both_directions_are_fitted_together() -> None:
    both = nav.robots.open_loop_tests(WHEEL, [0.3, -0.3, 0.5, -0.5])
    assert nav.robots.identify_wheel(both).command_gain == pytest.approx(137.0, rel=0.01)
