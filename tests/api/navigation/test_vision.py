"""Vision: frames, delay, losses, estimates; what is refused."""

from __future__ import annotations

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, ShapeError
from hrsafety import navigation as nav

NAN, INF = float("nan"), float("inf")
EXACT = nav.sensing.PositionNoise(scale=0.0)
WORST = nav.sensing.PositionNoise(scale=0.025, distribution="uniform")
PERIOD = 1.0 / 16.7
TIME = np.arange(801) * 0.01


def walk(time: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return positions and velocities of the person of section 5.7: on, to rest, off sideways."""
    velocity = np.column_stack([np.clip(2.0 - time, 0.0, 1.0), np.clip(time - 2.0, 0.0, 1.0)])
    steps = 0.5 * (velocity[1:] + velocity[:-1]) * np.diff(time)[:, np.newaxis]
    return np.array([0.6, 0.0]) + np.vstack([[0.0, 0.0], np.cumsum(steps, axis=0)]), velocity


@pytest.mark.parametrize(
    ("kind", "right", "name", "value"),
    [
        *[(nav.sensing.PositionNoise, {}, "scale", value) for value in (-1.0, NAN, INF, "much")],
        (nav.sensing.PositionNoise, {}, "distribution", "cauchy"),
        *[(nav.sensing.ColorPatch, {"height": 0.3}, "height", value) for value in (NAN, INF, None)],
        *[(nav.sensing.ColorPatch, {"height": 0.3}, "centroid_deviation_px", value) for value in (-0.1, NAN)],
        *[(nav.sensing.ColorPatch, {"height": 0.3}, name, "here") for name in ("camera", "believed")],
        *[
            (nav.sensing.AlphaBeta, {"position_gain": 0.5, "velocity_gain": 0.2}, "position_gain", v)
            for v in (0.0, 1.1, NAN)
        ],
        *[
            (nav.sensing.AlphaBeta, {"position_gain": 0.5, "velocity_gain": 0.2}, "velocity_gain", v)
            for v in (0.0, 3.0, NAN)
        ],
        *[
            (nav.sensing.Kalman, {}, name, 0.0)
            for name in ("acceleration_deviation", "position_deviation", "speed_deviation")
        ],
        *[(nav.sensing.Kalman, {}, "position_deviation", value) for value in (1e-200, 1e200, NAN)],
        *[(nav.sensing.Vision, {}, "period", value) for value in (0.0, -1.0, NAN, INF)],
        *[(nav.sensing.Vision, {}, "delay", value) for value in (-1.0, NAN, INF)],
        *[(nav.sensing.Vision, {}, "drop_probability", value) for value in (-0.1, 1.0, NAN)],
        (nav.sensing.Vision, {}, "error", 0.025),
        (nav.sensing.Vision, {}, "estimator", "kalman"),
        (nav.sensing.Vision, {}, "compensated", 1),
    ],
)
def test_wrong_values_are_named(kind: Any, right: dict[str, Any], name: str, value: Any) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        kind(**(right | {name: value}))
    assert caught.value.argument == name


@pytest.mark.parametrize(
    "value",
    [
        nav.sensing.Vision(
            delay=0.05, error=nav.sensing.ColorPatch(height=1.4, believed=nav.sensing.Camera(focal_length=4.8e-3))
        ),
        nav.sensing.Vision(estimator=nav.sensing.Kalman(), compensated=True),
        nav.sensing.AlphaBeta(position_gain=0.5, velocity_gain=0.2),
        nav.sensing.Differences(),
    ],
)
def test_parameters_survive_pickling(value: Any) -> None:
    assert pickle.loads(pickle.dumps(value)) == value


def test_frames_come_at_the_stated_rate_and_are_known_after_the_delay() -> None:
    path, _ = walk(TIME)
    seen = nav.sensing.observe(nav.sensing.Vision(delay=0.1, error=EXACT), TIME, path)
    assert seen.exposed == pytest.approx(np.arange(len(seen.exposed)) * PERIOD)
    assert len(seen.exposed) == 134  # 0 to 8 s
    known = np.isfinite(seen.measured_at)
    assert TIME[known][0] == pytest.approx(0.1)
    age = TIME[known] - seen.measured_at[known]
    assert age.min() > 0.1 - 1e-9
    assert age.max() < 0.1 + PERIOD + 1e-9
    for axis in range(2):
        truth = np.interp(seen.measured_at[known], TIME, path[:, axis])
        assert seen.position[known, axis] == pytest.approx(truth, abs=1e-12)


def test_same_seed_gives_the_same_bits_and_streams_differ() -> None:
    path, _ = walk(TIME)
    vision = nav.sensing.Vision(error=WORST, drop_probability=0.2, estimator=nav.sensing.Kalman())
    first, again = (nav.sensing.observe(vision, TIME, path, seed=4, stream=1) for _ in range(2))
    for one, other in zip(first, again, strict=True):
        assert np.array_equal(one, other, equal_nan=True)
    for different in (
        nav.sensing.observe(vision, TIME, path, seed=5, stream=1),
        nav.sensing.observe(vision, TIME, path, seed=4),
    ):
        assert not np.array_equal(different.measured, first.measured, equal_nan=True)


def test_gaussian_error_has_the_stated_mean() -> None:
    time = np.arange(20001) * PERIOD
    seen = nav.sensing.observe(nav.sensing.Vision(), time, np.zeros((len(time), 2)))
    error = np.hypot(*seen.measured.T)
    # Mean of a Rayleigh distribution; 20,000 draws know it to 0.4 %.
    assert error.mean() == pytest.approx(0.0032 * np.sqrt(np.pi / 2.0), rel=0.02)
    assert error.mean() == pytest.approx(0.004, rel=0.02)


def test_tracking_the_measured_frames_gives_what_the_sensor_knows() -> None:
    path, _ = walk(TIME)
    for estimator in (
        nav.sensing.Differences(),
        nav.sensing.AlphaBeta(position_gain=0.6, velocity_gain=0.3),
        nav.sensing.Kalman(),
    ):
        vision = nav.sensing.Vision(error=WORST, drop_probability=0.3, estimator=estimator)
        seen = nav.sensing.observe(vision, TIME, path, seed=8)
        track = nav.sensing.track_positions(seen.exposed, seen.measured, estimator)
        assert len(track.measured_at) == np.isfinite(seen.measured).all(axis=1).sum()
        last = np.searchsorted(track.measured_at, TIME + 1e-9) - 1
        known = last >= 0
        assert np.array_equal(seen.velocity[known], track.velocity[last[known]])
        assert np.array_equal(seen.position[known], track.position[last[known]])


def test_compensation_takes_the_delay_out_of_a_steady_walk() -> None:
    path = np.column_stack([0.6 + TIME, 0.2 * TIME])
    late = nav.sensing.Vision(delay=0.12, error=EXACT)
    moved = nav.sensing.observe(replace(late, compensated=True), TIME, path)
    behind = nav.sensing.observe(late, TIME, path)
    known = TIME > 0.3
    assert moved.position[known] == pytest.approx(path[known], abs=1e-9)
    gap = np.hypot(*(behind.position - path)[known].T)
    assert gap.min() > 0.12
    assert gap.max() < 1.1 * (0.12 + PERIOD)


def test_filters_halve_the_error_of_the_velocity_or_better() -> None:
    path, velocity = walk(TIME)
    started = TIME > 0.5

    def rms(estimator: Any) -> float:
        vision = nav.sensing.Vision(error=WORST, estimator=estimator)
        misses = [nav.sensing.observe(vision, TIME, path, seed=seed).velocity - velocity for seed in range(20)]
        return float(np.sqrt(np.mean([(miss[started] ** 2).sum(axis=1) for miss in misses])))

    deviation = 0.025 / np.sqrt(3.0)
    plain = rms(nav.sensing.Differences())
    kalman = rms(nav.sensing.Kalman(position_deviation=deviation))
    steady = rms(nav.sensing.AlphaBeta.from_deviations(acceleration=1.0, position=deviation, period=PERIOD))
    # Differences of independent errors: sqrt(2) s / T in each component, plus the lag of a frame.
    assert plain == pytest.approx(2.0 * deviation / PERIOD, rel=0.05)
    assert kalman < 0.5 * plain
    assert steady == pytest.approx(kalman, rel=0.05)


def test_patch_errors_are_those_of_the_camera() -> None:
    camera = nav.sensing.Camera()
    patch = nav.sensing.ColorPatch(height=0.3, centroid_deviation_px=0.5)
    time = np.arange(4001) * PERIOD
    place = np.array([2.0, 0.6])
    seen = nav.sensing.observe(nav.sensing.Vision(error=patch), time, np.tile(place, (len(time), 1)))
    # First-order propagation of half a pixel through the inverse of the projection.
    step = 1e-4
    around = [[2.0 + step, 0.6, 0.3], [2.0 - step, 0.6, 0.3], [2.0, 0.6 + step, 0.3], [2.0, 0.6 - step, 0.3]]
    pixels = camera.project(around)
    slopes = np.linalg.inv(np.column_stack([pixels[0] - pixels[1], pixels[2] - pixels[3]]) / (2.0 * step))
    assert np.cov(seen.measured.T) == pytest.approx(0.25 * slopes @ slopes.T, rel=0.1, abs=2e-7)
    biased = replace(patch, believed=replace(camera, focal_length=4.8e-3), centroid_deviation_px=0.0)
    wrong = nav.sensing.observe(nav.sensing.Vision(error=biased), time[:3], np.tile(place, (3, 1))).measured
    assert np.hypot(*(wrong - place).T).min() > 1e-3


def test_patches_outside_the_picture_are_lost() -> None:
    patch = nav.sensing.Vision(error=nav.sensing.ColorPatch(height=1.4, centroid_deviation_px=0.0))
    time = np.arange(0.0, 3.0, 0.01)
    path = np.column_stack([np.linspace(2.0, 6.0, len(time)), np.full(len(time), 0.6)])
    seen = nav.sensing.observe(patch, time, path)
    pixels = nav.sensing.Camera().project(np.column_stack([path, np.full(len(time), 1.4)]))
    inside = nav.sensing.Camera().contains(pixels)
    leaves = time[~inside][0]
    lost = np.isnan(seen.measured).any(axis=1)
    assert not lost[seen.exposed < leaves - 0.02].any()
    assert lost[seen.exposed > leaves].all()


@pytest.mark.parametrize(
    ("time", "position", "error"),
    [
        ([0.0, 0.1], [[0.0, 0.0]], ShapeError),
        ([[0.0]], [[0.0, 0.0]], ShapeError),
        ([0.0, 0.1], [0.0, 1.0], ShapeError),
        ([0.1, 0.1], [[0.0, 0.0], [1.0, 0.0]], InvalidParameterError),
        ([0.0, NAN], [[0.0, 0.0], [1.0, 0.0]], InvalidParameterError),
        ([0.0, 0.1], [[0.0, 0.0], [INF, 0.0]], InvalidParameterError),
        ([0.0, 0.1], [[0.0, 0.0], [NAN, 0.0]], InvalidParameterError),
    ],
)
def test_wrong_paths_are_refused(time: Any, position: Any, error: type[Exception]) -> None:
    with pytest.raises(error):
        nav.sensing.track_positions(time, position, nav.sensing.Differences())
    with pytest.raises(error):
        nav.sensing.observe(nav.sensing.Vision(), time, position)


def test_lost_frames_are_left_out_of_a_track_but_a_path_has_none() -> None:
    gap = [[0.0, 0.0], [NAN, NAN], [0.2, 0.0]]
    track = nav.sensing.track_positions([0.0, 0.1, 0.2], gap, nav.sensing.Differences())
    assert track.measured_at.tolist() == [0.0, 0.2]
    assert track.velocity[-1] == pytest.approx([1.0, 0.0])
    with pytest.raises(InvalidParameterError, match="position"):
        nav.sensing.observe(nav.sensing.Vision(), [0.0, 0.1, 0.2], gap)


@pytest.mark.parametrize(("name", "value"), [("seed", -1), ("seed", 2**64), ("stream", 2**63), ("seed", 0.5)])
def test_wrong_seeds_are_refused(name: str, value: Any) -> None:
    arguments: dict[str, Any] = {name: value}
    with pytest.raises(InvalidParameterError, match=name):
        nav.sensing.observe(nav.sensing.Vision(), [0.0], [[0.0, 0.0]], **arguments)


def test_negative_times_of_a_path_are_refused() -> None:
    with pytest.raises(InvalidParameterError, match="time"):
        nav.sensing.observe(nav.sensing.Vision(), [-0.1, 0.0], [[0.0, 0.0], [0.0, 0.0]])


def test_nothing_is_known_of_an_empty_path() -> None:
    seen = nav.sensing.observe(nav.sensing.Vision(), [], np.empty((0, 2)))
    assert seen.exposed.shape == (0,)
    assert seen.position.shape == (0, 2)
    assert nav.sensing.track_positions([], np.empty((0, 2)), nav.sensing.Kalman()).velocity.shape == (0, 2)


def test_regions_too_small_for_the_delay_of_a_camera_are_told() -> None:
    person = nav.Human(start=(4.0, 1.0), velocity=(-1.0, 0.0))
    scene = nav.Scenario(start=(0.0, 0.0), goal=(5.0, 0.0), obstacles=[person], time_limit=1.0)

    def told(place: nav.Scenario, law: Any = None, **options: Any) -> list[str]:
        built = nav.robots.AsBuilt(**{name: nav.sensing.Vision(**given) for name, given in options.items()})
        run = nav.simulate(place, law or nav.VirtualForceField(), built=built)
        return [each.message for each in run.warnings if each.code == "region_below_safe"]

    assert told(scene, obstacle_vision={}) == []
    (message,) = told(scene, obstacle_vision={"delay": 0.5}, robot_vision={"delay": 0.1})
    # 0.7965 m for exact positions, 1 m/s and 0.7 m/s times the delays.
    assert "below the 1.366 m" in message
    assert told(scene, obstacle_vision={"delay": 0.5, "compensated": True}) == []
    assert told(scene, nav.OptimalReciprocalCollisionAvoidance(), obstacle_vision={"delay": 0.5}) == []
    sized = replace(person, critical_radius=1.2965, active_radius=3.0)
    assert told(replace(scene, obstacles=(sized,)), obstacle_vision={"delay": 0.5}) == []


def unseen(vision: nav.sensing.Vision, *obstacles: nav.Human | nav.Disc) -> list[str]:
    """Return of whom a run tells that the robot knows too late that they are there at the start."""
    scenario = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=obstacles, time_limit=5.0)
    built = nav.robots.AsBuilt(obstacle_vision=vision)
    warnings = nav.simulate(scenario, nav.VelocityObstacle(), built=built).warnings
    return [each.subject for each in warnings if each.code == "unseen_at_start"]


def test_a_camera_that_tells_too_late_of_somebody_near_the_start_is_a_warning() -> None:
    near, far = (nav.Human(start=(away, 0.0), velocity=(-0.5, 0.0)) for away in (1.2, 3.0))
    late = nav.sensing.Vision(delay=0.5)
    assert unseen(late, far, near) == ["obstacles[1]"]
    assert unseen(nav.sensing.Vision(), near) == []
    # Ten frames in a row are lost with a probability below 1e-3, nine are not: 0.54 s.
    assert unseen(nav.sensing.Vision(drop_probability=0.5), near) == ["obstacles[0]"]
    assert unseen(nav.sensing.Vision(drop_probability=1e-4), near) == []


def test_who_stands_or_is_absent_is_not_unseen_at_the_start() -> None:
    late = nav.sensing.Vision(delay=0.5)
    later = nav.Human.from_path([1.0, 2.0], [[1.0, 0.0], [1.0, 1.0]])
    assert unseen(late, nav.Disc(center=(1.5, 0.0), radius=0.3), later) == []


def test_where_a_recording_has_somebody_at_the_start_counts_not_where_it_begins() -> None:
    late = nav.sensing.Vision(delay=0.5)
    coming = nav.Human.from_path([-4.0, 0.0, 2.0], [[5.0, 0.0], [1.2, 0.0], [1.0, 1.0]])
    leaving = nav.Human.from_path([-4.0, 0.0, 2.0], [[1.2, 0.0], [5.0, 0.0], [5.0, 1.0]])
    assert unseen(late, coming, leaving) == ["obstacles[0]"]
