"""Formulas that runs evaluate, called one by one, against their sources as corrected."""

from __future__ import annotations

import math

import numpy as np
import pytest

from hrsafety import impact, reactive, scenarios
from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, ShapeError

EXACT = 1e-12


# ---- sensors to forces ------------------------------------------------------------------------


def test_collision_point_lies_along_the_axis_of_its_sensor() -> None:
    points = reactive.follower.collision_point([(0.0, 0.15), (0.0, -0.15)], [math.pi / 6, -math.pi / 6], 2.0)
    side = 0.15 + 2.0 * math.sin(math.pi / 6)
    np.testing.assert_allclose(points, [(math.sqrt(3.0), side), (math.sqrt(3.0), -side)], atol=EXACT)


def test_printed_foot_has_the_sign_of_its_second_component_wrong() -> None:
    one, other = np.array([1.0, 0.4]), np.array([1.6, 1.1])
    slope = (other[1] - one[1]) / (other[0] - one[0])
    scale = slope + 1.0 / slope
    right = [(slope * one[0] - one[1]) / scale, (one[1] / slope - one[0]) / scale]
    np.testing.assert_allclose(reactive.follower.collision_vector(one, other, clamp=False), right, atol=EXACT)
    printed = reactive.follower.printed_foot(one, other)
    np.testing.assert_allclose(printed, [right[0], (one[0] + one[1] / slope) / scale], atol=EXACT)
    assert abs(np.dot(right, other - one)) < EXACT
    assert abs(np.dot(printed, other - one)) > 0.1
    assert np.isnan(reactive.follower.printed_foot((1.0, -1.0), (1.0, 1.0))).any()


def test_rotation_is_counterclockwise_and_the_printed_one_its_transpose() -> None:
    vector, heading = np.array([0.3, -0.7]), 0.9
    matrix = np.array([[math.cos(heading), -math.sin(heading)], [math.sin(heading), math.cos(heading)]])
    np.testing.assert_allclose(reactive.follower.rotate_to_world(vector, heading), matrix @ vector, atol=EXACT)
    printed = reactive.follower.rotate_to_world(vector, heading, rotation="printed")
    np.testing.assert_allclose(printed, matrix.T @ vector, atol=EXACT)


def test_attraction_is_the_one_of_a_run() -> None:
    run = reactive.follow(reactive.FollowerLayouts(kind="one_dynamic").scene(1), seed=1)
    force = reactive.follower.attraction_force(run.target[1:] - run.position[1:], run.virtual_velocity[:-1])
    np.testing.assert_array_equal(force, run.attraction[1:])


def test_formulas_refuse_what_does_not_fit() -> None:
    for call in (
        lambda: reactive.follower.collision_point((1.0, 2.0, 3.0), 0.0, 1.0),
        lambda: reactive.follower.rotate_to_world([(1.0, 0.0)] * 2, [0.0] * 3),
        lambda: reactive.follower.attraction_force((1.0, 0.0), [(1.0, 0.0)]),
        lambda: reactive.follower.printed_foot((1.0, 0.0), (1.0, 0.0, 2.0)),
    ):
        with pytest.raises(ShapeError):
            call()
    with pytest.raises(InvalidParameterError, match="rotation"):
        reactive.follower.rotate_to_world((1.0, 0.0), 0.0, rotation="left")  # type: ignore[arg-type]  # the failure
    with pytest.raises(InvalidParameterError, match="damping"):
        reactive.follower.attraction_force((1.0, 0.0), (0.0, 0.0), damping=-1.0)


# ---- sound ------------------------------------------------------------------------------------


def test_elevations_are_the_angles_of_the_geometry() -> None:
    row = reactive.MicrophoneArray()
    ranges, bearings = np.array([0.5, 1.0, 3.0])[:, None], np.radians([-60.0, 0.0, 25.0, 80.0])
    angles = reactive.sound.microphone_elevations(row, range=ranges, bearing=bearings)
    x, y = ranges * np.cos(bearings), ranges * np.sin(bearings)
    for place, index in ((-row.spacing, 0), (0.0, 1), (row.spacing, 2)):
        np.testing.assert_allclose(angles[..., index], np.arctan2(x, y - place), atol=1e-9)
    for bad in ({"range": 0.0, "bearing": 0.0}, {"range": 1.0, "bearing": 2.0}):
        with pytest.raises(InvalidParameterError):
            reactive.sound.microphone_elevations(row, **bad)


# ---- skirt ------------------------------------------------------------------------------------


def test_sensors_stand_outside_the_chassis() -> None:
    skirt = reactive.UltrasonicSkirt(sensor_inset=-0.03, safe_distance=None)
    np.testing.assert_allclose(np.linalg.norm(skirt.positions, axis=1), 0.36, atol=EXACT)
    # The printed 0.666 m needs r = 0.3604 m.
    assert skirt.meeting_distance == pytest.approx(0.6652, abs=5e-5)
    np.testing.assert_allclose(skirt.trigger_distances, skirt.meeting_distance - 0.36, atol=EXACT)
    assert reactive.skirt_test(skirt, layouts=5).shares(0.1).completely_avoids.count > 0
    for inset in (0.33, -0.34, math.nan):
        with pytest.raises(InvalidParameterError, match="sensor_inset"):
            reactive.UltrasonicSkirt(sensor_inset=inset)


def test_radius_of_1_is_the_inverse_of_the_printed_gap() -> None:
    gap = reactive.skirt.skirt_spacing().printed_gap
    assert math.degrees(gap) == pytest.approx(40.6, abs=0.05)
    assert reactive.skirt.skirt_closing_radius(gap=gap) == pytest.approx(0.33, abs=EXACT)
    # a N L = 0.3888 m closes the published ring.
    closed = reactive.skirt.skirt_closing_radius(gap=math.radians(37.5), sensor_length=0.0635)
    assert closed == pytest.approx(0.33, abs=5e-5)
    with pytest.raises(InvalidParameterError, match="gap"):
        reactive.skirt.skirt_closing_radius(gap=0.0)


def test_printed_normal_distances_are_those_of_7_to_9() -> None:
    readings = np.linspace(0.1, 0.9, 9)
    theta, theta_1 = math.radians(37.5), math.radians(22.5)
    safe, face = 0.666, 0.33
    printed = reactive.UltrasonicSkirt(triggering="printed")
    distances, limits = printed.normal_distances(readings)
    near = face + readings[:4] - safe
    expected = [
        *(near * np.sin([theta + theta_1, theta_1, theta_1, theta + theta_1])),
        (face + readings[4]) * math.sin(theta + 2 * theta_1),
        (face + readings[5]) * math.sin(theta),
        (face + readings[7]) * math.sin(theta),
        (face + readings[7]) * math.sin(2 * theta),
    ]
    np.testing.assert_allclose(distances, expected, atol=EXACT)
    angles = [theta + theta_1, theta_1, theta_1, theta + theta_1, 2 * theta, theta, theta, 2 * theta]
    np.testing.assert_allclose(limits, safe * np.sin(angles), atol=EXACT)


@pytest.mark.parametrize("triggering", ["consistent", "printed"])
def test_triggering_distances_are_where_d_meets_its_limit(triggering: str) -> None:
    skirt = reactive.UltrasonicSkirt(triggering=triggering)  # type: ignore[arg-type]  # word of the list
    for sensor, index in ((0, 0), (1, 1), (2, 2), (3, 3), (4, 4), (5, 5), (7, 6)):
        readings = np.full(9, 3.0)
        readings[sensor] = skirt.trigger_distances[sensor]
        distances, limits = skirt.normal_distances(readings)
        assert distances[index] == pytest.approx(limits[index], abs=EXACT)
    with pytest.raises(InvalidParameterError, match="sensors"):
        reactive.UltrasonicSkirt(sensors=12).normal_distances(np.ones(12))


# ---- impact -----------------------------------------------------------------------------------


def test_dashpots_in_series_agree_with_the_arm_for_equal_ratios_only() -> None:
    place = {"second_link": 0.432, "lever_arm": 0.4}
    masses = impact.joints.uniform_links(mass=(17.4, 4.8), length=(0.432, 0.433))
    stiffness = np.array([8000.0, 1500.0])
    for damping, equal in ((0.005 * stiffness, True), (np.array([40.0, 30.0]), False)):
        arm = impact.Manipulator.from_two_joints(mass_matrix=masses, damping=damping, stiffness=stiffness, **place)
        series = impact.joints.dashpots_in_series(damping, **place)
        outer, inner = damping[0], damping[1]
        reach = 0.832
        assert series == pytest.approx(outer * inner / (reach**2 * inner + 0.4**2 * outer), rel=EXACT)
        assert (abs(series / arm.damping - 1.0) < 1e-9) is equal
    with pytest.raises(InvalidParameterError, match="damping"):
        impact.joints.dashpots_in_series((0.0, 1.0), **place)


# ---- other laws -------------------------------------------------------------------------------

STATE = {"position": (2.95, 0.71), "velocity": (-0.5, 0.1)}


@pytest.mark.parametrize("law", [nav.Masoud(), nav.GeCui(), nav.Khatib(), nav.BorensteinKoren()], ids=repr)
def test_components_add_up_to_the_command(law: nav.Law) -> None:
    scene = scenarios.configuration("c4")
    terms = nav.force_terms(law, scene, **STATE)
    total = terms.attractive + (terms.repulsive + terms.detour).sum(axis=0)
    np.testing.assert_allclose(total, terms.total, atol=1e-9)
    np.testing.assert_array_equal(terms.total, nav.laws.command(law, scene, **STATE))
    assert not terms.stabilizing.any()
    assert math.isnan(terms.omega)


def test_masoud_has_a_spring_and_a_circulation() -> None:
    terms = nav.force_terms(nav.Masoud(), scenarios.configuration("c1"), **STATE)
    disc = np.array(scenarios.configuration("c1").obstacles[0].center)
    away = np.array(STATE["position"]) - disc
    np.testing.assert_allclose(terms.repulsive[0], 24.0 * away, atol=1e-9)
    np.testing.assert_allclose(terms.detour[0], 36.0 * np.array([-away[1], away[0]]), atol=1e-9)
    assert terms.region.tolist() == ["active"]
    assert terms.side.tolist() == [1]


def test_ge_and_cui_by_2_2_12_to_2_2_15() -> None:
    scene = scenarios.configuration("c1")
    law = nav.GeCui()
    terms = nav.force_terms(law, scene, **STATE)
    away = np.array(STATE["position"]) - np.array(scene.obstacles[0].center)
    speed = np.array(STATE["velocity"])
    d = np.linalg.norm(away)
    u = away / d
    t = np.array([-u[1], u[0]])
    rate, turning, limit = speed @ u, speed @ t / d, scene.robot.max_acceleration
    strength = law.repulsive_gain / (d - rate**2 / (2.0 * limit)) ** 2
    np.testing.assert_allclose(terms.repulsive[0], strength * (1.0 - rate / limit) * u, atol=1e-9)
    np.testing.assert_allclose(terms.detour[0], -strength * rate * turning * d * t, atol=1e-9)


def test_planners_have_no_components() -> None:
    with pytest.raises(InvalidParameterError, match="law"):
        nav.force_terms(nav.VelocityObstacle(), scenarios.configuration("c1"), **STATE)
