"""Ultrasonic skirt: parameters, results of tests, determinism, bad arguments, Ctrl-C."""

from __future__ import annotations

import dataclasses
import math
import pickle
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from api.interrupting import check_work_is_interrupted, needs_signals
from hrsafety import InvalidParameterError, ShapeError, reactive

SMALL: dict[str, Any] = {"layouts": 2, "seed": 11}
READINGS = [3.0] * 9


@pytest.fixture(scope="module")
def small() -> reactive.SkirtTest:
    return reactive.skirt_test(**SMALL)


# ---- parameters -------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "value",
    [
        reactive.UltrasonicSkirt(sensors=12, policy="best_direction", safe_distance=None),
        reactive.SkirtScene(disc_radius=[0.1, 0.2], unseen_share=0.5),
        reactive.SkirtMotion(speed=0.7),
        reactive.skirt.TriOmniKinematics(wheel_radius=0.05),
    ],
    ids=lambda value: type(value).__name__,
)
def test_parameters_are_equal_by_value_frozen_and_picklable(value: Any) -> None:
    again = pickle.loads(pickle.dumps(value))
    assert again == value
    assert hash(again) == hash(value)
    assert repr(again) == repr(value)
    with pytest.raises(dataclasses.FrozenInstanceError):
        setattr(value, dataclasses.fields(value)[0].name, 3)


def test_an_even_ring_has_equal_gaps_and_looks_north_first() -> None:
    skirt = reactive.UltrasonicSkirt(sensors=7, layout="even")
    assert skirt.bearings[0] == math.pi / 2
    assert np.allclose(skirt.gaps, 2 * math.pi / 7, rtol=0, atol=1e-14)


def test_sensors_lie_on_the_chassis_less_the_inset() -> None:
    skirt = reactive.UltrasonicSkirt(sensor_inset=0.03)
    assert np.allclose(np.linalg.norm(skirt.positions, axis=1), 0.30, rtol=0, atol=1e-15)
    assert np.allclose(skirt.trigger_distances, 0.666 - 0.30, rtol=0, atol=1e-15)


def test_without_a_safe_distance_the_geometry_gives_it() -> None:
    skirt = reactive.UltrasonicSkirt(safe_distance=None)
    assert np.allclose(skirt.trigger_distances, skirt.meeting_distance - 0.33, rtol=0, atol=1e-15)


def test_a_sensor_is_triggered_from_its_distance_on() -> None:
    skirt = reactive.UltrasonicSkirt()
    edge = float(skirt.trigger_distances[4])
    assert skirt.action([*READINGS[:4], edge, *READINGS[5:]]) == "W"
    assert skirt.action([*READINGS[:4], np.nextafter(edge, 1.0), *READINGS[5:]]) == "keep"


BAD_SKIRTS: list[tuple[dict[str, Any], str]] = [
    ({"chassis_radius": 0.0}, "chassis_radius"),
    ({"chassis_radius": math.nan}, "chassis_radius"),
    ({"chassis_radius": "wide"}, "chassis_radius"),
    ({"sensor_inset": -0.4}, "sensor_inset"),
    ({"sensor_inset": 0.4}, "sensor_inset"),
    ({"sensors": 8}, "sensors"),
    ({"sensors": 3}, "sensors"),
    ({"sensors": 66}, "sensors"),
    ({"sensors": 9.0}, "sensors"),
    ({"sensors": 10**30}, "sensors"),
    ({"layout": "spiral"}, "layout"),
    ({"wheel_gap": 0.0}, "wheel_gap"),
    ({"wheel_gap": 1.1}, "wheel_gap"),
    ({"safe_distance": 0.33}, "safe_distance"),
    ({"safe_distance": math.inf}, "safe_distance"),
    ({"safe_distance": None, "sensors": 4, "layout": "even"}, "safe_distance"),
    ({"triggering": "loud"}, "triggering"),
    ({"triggering": "printed", "sensors": 12}, "sensors"),
    ({"policy": 1}, "policy"),
    ({"beam_width": 4.0}, "beam_width"),
    ({"rays": 0}, "rays"),
    ({"least_range": -0.1}, "least_range"),
    ({"most_range": 0.01}, "most_range"),
    ({"range_noise": -1.0}, "range_noise"),
    ({"firing_period": 0.0}, "firing_period"),
]


@pytest.mark.parametrize(("changes", "argument"), BAD_SKIRTS, ids=str)
def test_a_skirt_that_cannot_be_is_refused_by_name(changes: dict[str, Any], argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        reactive.UltrasonicSkirt(**changes)
    assert caught.value.argument == argument


BAD_CALLS: list[tuple[Callable[[], object], str]] = [
    (lambda: reactive.SkirtScene(obstacles=0), "obstacles"),
    (lambda: reactive.SkirtScene(disc_radius=(0.2, 0.1)), "disc_radius"),
    (lambda: reactive.SkirtScene(disc_radius=("a", "b")), "disc_radius"),
    (lambda: reactive.SkirtScene(course_distance=(0.1, 2.0)), "course_distance"),
    (lambda: reactive.SkirtScene(unseen_share=1.1), "unseen_share"),
    (lambda: reactive.SkirtScene(half_size=math.inf), "half_size"),
    (lambda: reactive.SkirtScene(spacing=-1), "spacing"),
    (lambda: reactive.SkirtMotion(speed=0.0), "speed"),
    (lambda: reactive.SkirtMotion(duration=math.nan), "duration"),
    (lambda: reactive.skirt.TriOmniKinematics(wheel_width=1.0), "wheel_width"),
    (lambda: reactive.skirt.TriOmniKinematics(wheel_radius=-1.0), "wheel_radius"),
    (lambda: reactive.skirt.TriOmniKinematics().wheel_speeds(["a", "b"]), "velocity"),
    (lambda: reactive.skirt_test(0.33), "skirt"),  # type: ignore[arg-type]  # the point of the test
    (lambda: reactive.skirt_test(layouts=0), "layouts"),
    (lambda: reactive.skirt_test(layouts=10**6), "layouts"),
    (lambda: reactive.skirt_test(layouts=10**25), "layouts"),
    (lambda: reactive.skirt_test(repeats=1.5), "repeats"),  # type: ignore[arg-type]  # as above
    (lambda: reactive.skirt_test(seed=-1), "seed"),
    (lambda: reactive.skirt_test(seed=2**64), "seed"),
    (lambda: reactive.skirt_test(threads=0), "threads"),
    (lambda: reactive.skirt_test(threads=10**6), "threads"),
    (lambda: reactive.skirt_test(progress=3), "progress"),  # type: ignore[arg-type]  # as above
    (lambda: reactive.skirt_test(motion=reactive.SkirtMotion(duration=1e9)), "duration"),
    (lambda: reactive.skirt_test(scene=reactive.SkirtScene(obstacles=400)), "obstacles"),
    (lambda: reactive.skirt_test(scene=reactive.SkirtScene(course_distance=(0.5, 1.0))), "course_distance"),
    (lambda: reactive.skirt_run(direction="up"), "direction"),
    (lambda: reactive.skirt_run(repeat=5), "repeat"),
    (lambda: reactive.skirt_run(layout=-1), "layout"),
    (lambda: reactive.skirt_run(layout=10**25), "layout"),
    (lambda: reactive.smallest_skirt(0.0), "contact_share"),
    (lambda: reactive.smallest_skirt(1.0), "contact_share"),
    (lambda: reactive.smallest_skirt(0.1, counts=[]), "counts"),
    (lambda: reactive.smallest_skirt(0.1, counts=[2.5]), "counts[0]"),
    (lambda: reactive.smallest_skirt(0.1, counts=[7], layout="wheels"), "sensors"),
    (lambda: reactive.smallest_skirt(0.1, speed=-0.3), "speed"),
    (lambda: reactive.smallest_skirt(0.1, chassis_radius=0.0), "chassis_radius"),
    (lambda: reactive.smallest_skirt(0.1, trigger_distance=0.0), "trigger_distance"),
    (lambda: reactive.skirt.least_skirt_sensors(wheel_sensor_radius=0.3, sensor_radius=0.0), "sensor_radius"),
    (lambda: reactive.skirt.skirt_spacing(3), "sensors"),
    (lambda: reactive.skirt.skirt_spacing(10**25), "sensors"),
    (lambda: reactive.UltrasonicSkirt(rays=10**25), "rays"),
    (lambda: reactive.SkirtScene(obstacles=10**25), "obstacles"),
    (lambda: reactive.skirt.skirt_spacing(6), "sensors"),
    (lambda: reactive.skirt.skirt_spacing(wheel_gap=1.2), "wheel_gap"),
    (lambda: reactive.skirt.skirt_spacing(sensor_length=0.0), "sensor_length"),
    (lambda: reactive.skirt.skirt_safe_distance(sensor_radius=0.3, gap=-0.1), "gap"),
    (lambda: reactive.skirt.skirt_safe_distance(sensor_radius=math.nan, gap=0.1), "sensor_radius"),
]


@pytest.mark.parametrize(("call", "argument"), BAD_CALLS)
def test_a_bad_argument_is_refused_by_name(call: Callable[[], object], argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        call()
    assert caught.value.argument == argument


@pytest.mark.parametrize(
    "call",
    [
        lambda: reactive.UltrasonicSkirt().action([1.0] * 8),
        lambda: reactive.UltrasonicSkirt().pattern([[1.0] * 9]),
        lambda: reactive.skirt.TriOmniKinematics().wheel_speeds([1.0, 2.0, 3.0]),
        lambda: reactive.skirt.TriOmniKinematics().wheel_speeds([[1.0, 2.0]] * 3, [1.0, 2.0]),
        lambda: reactive.skirt.TriOmniKinematics().body_velocity(3.0),
        lambda: reactive.SkirtScene(disc_radius=(0.1, 0.2, 0.3)),
    ],
)
def test_a_wrong_shape_is_refused(call: Callable[[], object]) -> None:
    with pytest.raises(ShapeError):
        call()


# ---- tests ------------------------------------------------------------------------------------------


def test_rows_run_over_repeats_then_directions_then_layouts(small: reactive.SkirtTest) -> None:
    assert len(small) == 80
    assert small.layout.tolist() == [0] * 40 + [1] * 40
    assert small.repeat[:10].tolist() == [0, 1, 2, 3, 4] * 2
    assert small.direction[40:80:5].tolist() == list(reactive.skirt.MOTION_DIRECTIONS)
    assert {len(column) for column in small.columns().values()} == {80}


def test_contact_and_clearance_say_the_same() -> None:
    long = reactive.skirt_test(layouts=10, scene=reactive.SkirtScene(unseen_share=0.3))
    assert np.array_equal(long.collided, np.isfinite(long.contact_time))
    assert long.collided.any()
    assert not long.collided.all()
    assert not long.nearest_seen[long.collided].all()


def test_shares_are_of_all_tests_and_fall_with_the_limit(small: reactive.SkirtTest) -> None:
    curve = [small.shares(limit) for limit in (0.0, 0.1, 0.2, 0.3, 5.0)]
    for shares in curve:
        assert sum(share.count for share in shares) == len(small)
        assert all(share.low <= share.value <= share.high for share in shares)
    clear = [shares.completely_avoids.count for shares in curve]
    assert clear == sorted(clear, reverse=True)
    assert clear[0] == np.sum(~small.collided)
    assert clear[-1] == 0
    with pytest.raises(InvalidParameterError):
        small.shares(-0.1)


def test_any_number_of_threads_gives_the_same_bits(small: reactive.SkirtTest) -> None:
    for threads in (1, 2, 5):
        other = reactive.skirt_test(**SMALL, threads=threads)
        assert np.array_equal(other.min_clearance, small.min_clearance)
        assert np.array_equal(other.contact_time, small.contact_time, equal_nan=True)


def test_more_layouts_continue_the_same_tests(small: reactive.SkirtTest) -> None:
    more = reactive.skirt_test(layouts=3, seed=11)
    assert np.array_equal(more.min_clearance[:80], small.min_clearance)
    assert not np.array_equal(reactive.skirt_test(layouts=2, seed=12).min_clearance, small.min_clearance)


def test_a_run_repeats_its_test_bit_by_bit(small: reactive.SkirtTest) -> None:
    for row in (0, 17, 63):
        place = {"direction": str(small.direction[row]), "layout": int(small.layout[row])}
        run = reactive.skirt_run(**place, repeat=int(small.repeat[row]), seed=11)
        assert run.min_clearance == small.min_clearance[row]


def test_discs_do_not_depend_on_the_skirt() -> None:
    other = reactive.UltrasonicSkirt(sensors=12, beam_width=0.2, range_noise=0.0)
    one, two = reactive.skirt_run(), reactive.skirt_run(other)
    assert np.array_equal(one.disc_center, two.disc_center)
    assert np.array_equal(one.disc_radius, two.disc_radius)


def test_progress_counts_the_tests_and_an_exception_in_it_comes_out() -> None:
    heard: list[tuple[int, int]] = []
    reactive.skirt_test(layouts=1, progress=lambda done, total: heard.append((done, total)))
    assert heard[-1] == (40, 40)
    heard.clear()
    reactive.smallest_skirt(0.5, counts=[6, 8], layouts=1, progress=lambda done, total: heard.append((done, total)))
    assert heard[-1] == (80, 80)
    assert [done for done, _ in heard] == sorted(done for done, _ in heard)

    def refuse(_done: int, _total: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        reactive.skirt_test(layouts=3, progress=refuse)


# ---- the smallest skirt -----------------------------------------------------------------------------


def test_more_sensors_touch_less_and_the_smallest_enough_is_found() -> None:
    study = reactive.smallest_skirt(0.2, counts=[4, 6, 8, 10], layouts=20)
    values = [share.value for share in study.contacts]
    assert values == sorted(values, reverse=True)
    assert study.sensors == min(n for n, share in zip(study.counts, study.contacts, strict=True) if share.high < 0.2)
    assert [skirt.sensors for skirt in study.skirts] == [4, 6, 8, 10]
    none = reactive.smallest_skirt(0.2, counts=[4, 6], layouts=5, speed=0.8)
    assert none.sensors is None


def test_a_wider_robot_needs_more_sensors() -> None:
    few, many = (
        reactive.smallest_skirt(0.1, chassis_radius=radius, counts=(6, 8, 10, 12, 14), layouts=10).sensors
        for radius in (0.25, 0.6)
    )
    assert few is not None
    assert many is not None
    assert few < many


def test_the_study_uses_the_given_skirt_scene_and_motion() -> None:
    skirt = reactive.UltrasonicSkirt(beam_width=math.radians(10.0), sensor_inset=0.02)
    study = reactive.smallest_skirt(0.5, counts=[9], layouts=1, layout="wheels", skirt=skirt, trigger_distance=0.4)
    assert study.skirts[0].beam_width == skirt.beam_width
    assert np.allclose(study.skirts[0].trigger_distances, 0.4, rtol=0, atol=1e-15)


# ---- Ctrl-C -----------------------------------------------------------------------------------------


@needs_signals
def test_ctrl_c_ends_a_batch(capsys: pytest.CaptureFixture[str]) -> None:
    work = "reactive.skirt_test(layouts=250_000, threads=2)"
    check_work_is_interrupted("from hrsafety import reactive", work, capsys)
