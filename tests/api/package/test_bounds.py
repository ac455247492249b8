"""Counts and durations beyond their bounds are refused, in no time and before memory is taken."""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import HrsafetyError, InvalidParameterError, datasets, impact, plotting, reactive, scenarios, sweep
from hrsafety import navigation as nav

HUGE = (2**31, 2**53, 2**63, 2**64, 10**400, 10**5000)
SCENE = nav.Scenario(
    start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[nav.Human(start=(0.0, 5.0), velocity=(0.01, 0.0))], time_limit=0.6
)
FIELD = nav.VirtualForceField()
ARRAY = reactive.MicrophoneArray()
HEAR: dict[str, Any] = {"range": 1.0, "bearing": 0.0}
FLIGHT = np.arange(0.0, 0.4, 1e-3)
DROP = impact.identification.drop_trajectory(
    FLIGHT, height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=0.112, friction=2.0
)
DEPTH = np.linspace(0.0, 0.008, 17)
AXIS = sweep.Axis(name="x", low=0.0, high=1.0)
TINY: dict[str, Any] = {"grid": (2, 1, 1, 1), "refinements": 0, "local_starts": 0, "threads": 1}
IMPACTS: dict[str, Any] = {
    "manipulator": impact.MANIPULATOR_1,
    "foam": impact.FOAM_1,
    "head": impact.Head.minimum(),
    "closing_speed": [1.0],
}


def identity(x: np.ndarray) -> dict[str, np.ndarray]:
    return {"y": x}


def swept(**options: Any) -> sweep.SweepResult:
    study = sweep.FunctionStudy(function=identity, results=["y"])
    return sweep.run(sweep.LatinHypercube([AXIS], 8), study, **options)


def searched(**options: Any) -> nav.GainSearch:
    return nav.optimize_gains([SCENE], **(TINY | options))


RUN = nav.simulate(SCENE, FIELD)
FOLLOWED = reactive.follow(reactive.FollowerLayouts(kind="static").scene(0))
SWEPT = swept()
WALK = datasets.Recording(time_s=[0.0, 20.0], person=[7, 7], position=[[-10.0, 1.0], [10.0, 1.0]])
MOVIE = Path(tempfile.gettempdir()) / "never_written.gif"


COUNTS: dict[str, tuple[Callable[[int], Any], tuple[int, ...]]] = {
    "rays": (lambda count: reactive.Sonar(rays=count), (10**9, *HUGE)),
    "skirt rays": (lambda count: reactive.UltrasonicSkirt(rays=count), HUGE),
    "skirt sensors": (lambda count: reactive.UltrasonicSkirt(sensors=count), HUGE),
    "skirt layouts": (lambda count: reactive.skirt_test(layouts=count), HUGE),
    "skirt obstacles": (lambda count: reactive.SkirtScene(obstacles=count), HUGE),
    "people": (lambda count: scenarios.random_crowd(count, seed=0), HUGE),
    "obstacles": (lambda count: scenarios.random_traffic(count, seed=0), HUGE),
    "refinements": (lambda count: searched(refinements=count), HUGE),
    "survivors": (lambda count: searched(survivors=count), HUGE),
    "local_starts": (lambda count: searched(local_starts=count), HUGE),
    "grid": (lambda count: searched(grid=(count, 1, 1, 1)), HUGE),
    "evaluations": (lambda count: searched(method="cma_es", evaluations=count), HUGE),
    "front refinements": (lambda count: nav.gains.pareto_front([SCENE], grid=(2, 1, 1, 1), refinements=count), HUGE),
    "seeds": (lambda count: nav.simulate_many(SCENE, FIELD, seeds=count), HUGE),
    "seeds of worlds": (lambda count: nav.simulate_many(scenarios.circle_crossing(0), FIELD, seeds=count), HUGE),
    "range of seeds": (lambda count: nav.simulate_many(SCENE, FIELD, seeds=range(count)), (2**31, 2**53)),
    "scenes of a batch": (lambda count: scenarios.random_traffic_batch(count), HUGE),
    "people of a batch": (lambda count: scenarios.random_crowd_batch(4, people=count), HUGE),
    "obstacles of a batch": (lambda count: scenarios.random_traffic_batch(4, obstacles=count), HUGE),
    "rows of a part": (lambda count: nav.gains.stream_batch([SCENE], FIELD, rows=count), HUGE),
    "steps between rows": (lambda count: nav.simulate(SCENE, FIELD, every=count), HUGE),
    "calibrations": (lambda count: nav.sensing.calibration_study(seeds=count), HUGE),
    "timed runs": (lambda count: nav.metrics.step_cost(FIELD, SCENE, repeats=count), HUGE),
    "wheel tests": (lambda count: nav.robots.open_loop_tests(nav.robots.HOLONOMIC_WHEELS[0], repeats=count), HUGE),
    "pixels": (lambda count: nav.sensing.Camera(image_size_px=(count, count)), HUGE),
    "draws": (lambda count: nav.RapidlyExploringRandomTree(draws=count), HUGE),
    "threads": (lambda count: nav.simulate_batch([SCENE], FIELD, threads=count), HUGE),
    "lanes": (lambda count: nav.simulate_batch([SCENE], FIELD, lanes=count), HUGE),
    "impact threads": (lambda count: impact.metrics_batch(**IMPACTS, threads=count), HUGE),
    "impact lanes": (lambda count: impact.metrics_batch(**IMPACTS, lanes=count), HUGE),
    "bootstrap": (lambda count: impact.identify_foam(24e3 * DEPTH, DEPTH, FLIGHT, DROP, 1.54, bootstrap=count), HUGE),
    "layouts": (lambda count: reactive.experiment("static", layouts=count), HUGE),
    "samples": (lambda count: reactive.record_burst(reactive.Burst(), ARRAY, **HEAR, samples=count), HUGE),
    "runs": (lambda count: reactive.sound.jittered_fixes(ARRAY, **HEAR, runs=count), HUGE),
    "points": (lambda count: sweep.Axis(name="x", low=0.0, high=1.0, points=count), HUGE[2:]),
    "Latin rows": (lambda count: sweep.LatinHypercube([AXIS], count), HUGE[2:]),
    "Sobol rows": (lambda count: sweep.Sobol([AXIS], count), HUGE),
    "rows at once": (lambda count: sweep.LatinHypercube([AXIS], 2**53).rows(0, count), (2**31, 2**53)),
    "in_flight": (lambda count: swept(in_flight=count), HUGE),
    "retries": (lambda count: swept(retries=count), HUGE),
    "runs across a recording": (lambda count: scenarios.crossings(WALK, runs=count, selection="even"), HUGE),
    "instants": (lambda count: plotting.time_sequence(RUN, instants=count), (25, *HUGE)),
    "points of an overview": (lambda count: plotting.sweep_scatter(SWEPT, "y", most=count), HUGE),
    "lines of an overview": (lambda count: plotting.sweep_parallel(SWEPT, "y", most=count), HUGE),
    "sweep threads": (lambda count: swept(threads=count), HUGE),
}

DURATIONS: dict[str, tuple[Callable[[float], Any], tuple[float, ...]]] = {
    "camera period": (
        lambda period: nav.sensing.observe(nav.sensing.Vision(period=period), [0.0, 1.0], np.zeros((2, 2))),
        (1e-308, 1e-12, 1e-8),
    ),
    "camera period in a run": (
        lambda period: nav.simulate(
            SCENE, FIELD, built=nav.robots.AsBuilt(obstacle_vision=nav.sensing.Vision(period=period), robot_vision=None)
        ),
        (1e-308, 1e-12, 1e-8),
    ),
    "frames": (lambda rate: plotting.animate(RUN, MOVIE, frames_per_second=rate), (1e308, 1e9, 2e4)),
    "pace": (lambda pace: plotting.animate(RUN, MOVIE, speed=pace), (1e-308, 5e-324, 1e-6)),
    "frames of a follower": (
        lambda pace: plotting.reactive.animate_follower(FOLLOWED, MOVIE, speed=pace),
        (5e-324, 1e-6),
    ),
    "step": (lambda step: nav.simulate(SCENE, FIELD, step=step), (1e-308, 1e-12)),
    "time limit": (lambda limit: nav.simulate(replace(SCENE, time_limit=limit), FIELD), (1e308, 1e12)),
    "tracking": (
        lambda duration: nav.tracking.track(
            nav.tracking.CircleReference(center=(0.0, 0.0), radius=2.0, speed=0.5), duration=duration
        ),
        (1e308, 1e12),
    ),
    "wheel reference": (lambda duration: nav.robots.WheelReference.sine(duration=duration), (1e308, 1e12)),
    "wheel period": (lambda period: nav.robots.WheelReference.sine(period=period), (1e-308, 1e-12)),
    "wheel test": (
        lambda duration: nav.robots.open_loop_tests(nav.robots.HOLONOMIC_WHEELS[0], duration=duration),
        (1e308, 1e12),
    ),
    "burst": (lambda duration: reactive.Burst(duration=duration), (1e308, 1e9)),
    "sample rate": (
        lambda rate: reactive.record_burst(
            reactive.Burst(), ARRAY, **HEAR, converter=reactive.Converter(sample_rate=rate)
        ),
        (1e308, 1e14),
    ),
    "firing period": (
        lambda period: reactive.skirt_test(reactive.UltrasonicSkirt(firing_period=period), layouts=1),
        (1e-308, 1e-12),
    ),
    "swings of a drop": (
        lambda stiffness: impact.identification.drop_trajectory(
            FLIGHT, height=0.05, mass=1.54, stiffness=stiffness, damping_ratio=0.1
        ),
        (1e20, 1e200),
    ),
    "swings of a fit": (
        lambda mass: impact.identify_foam(24e3 * DEPTH, DEPTH, FLIGHT, DROP, mass),
        (1e-12, 1e-300, 1e7, 1e308),
    ),
    "record": (
        lambda duration: impact.simulate(
            impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.0, duration=duration
        ),
        (1e308, 1e12),
    ),
}

CASES = [
    *(
        pytest.param(call, value, id=f"{name}-{index}")
        for name, (call, values) in COUNTS.items()
        for index, value in enumerate(values)
    ),
    *(
        pytest.param(call, value, id=f"{name}-{value}")
        for name, (call, values) in DURATIONS.items()
        for value in values
    ),
]


@pytest.mark.parametrize(("call", "value"), CASES)
def test_what_is_beyond_its_bound_is_refused_at_once(call: Callable[[Any], Any], value: float) -> None:
    begin = time.process_time()
    with pytest.raises(InvalidParameterError) as caught:
        call(value)
    # Not a measure of speed: what is not refused takes minutes, or more memory than there is.
    assert time.process_time() - begin < 30.0
    assert len(str(caught.value)) < 400


@pytest.mark.parametrize("seed", [-1, 2**64, 10**400, True, 1.5])
@pytest.mark.parametrize(
    "call",
    [
        lambda seed: replace(SCENE, seed=seed),
        lambda seed: nav.simulate_many(SCENE, FIELD, seeds=[seed]),
        lambda seed: nav.sensing.observe(nav.sensing.Vision(), [0.0, 1.0], np.zeros((2, 2)), seed=seed),
        lambda seed: nav.robots.open_loop_tests(nav.robots.HOLONOMIC_WHEELS[0], seed=seed),
        lambda seed: reactive.Sonar().readings([], seed=seed),
        lambda seed: reactive.skirt_test(layouts=1, seed=seed),
        lambda seed: reactive.FollowerLayouts(kind="static").scene(seed),
        lambda seed: reactive.follow(reactive.FollowerLayouts(kind="static").scene(0), seed=seed),
        lambda seed: reactive.experiment("static", layouts=1, first_seed=seed),
        lambda seed: reactive.Burst(seed=seed),
        lambda seed: reactive.record_burst(reactive.Burst(), ARRAY, **HEAR, seed=seed),
        lambda seed: reactive.sound.jittered_fixes(ARRAY, **HEAR, seed=seed),
        lambda seed: sweep.LatinHypercube([AXIS], 8, seed=seed),
        lambda seed: scenarios.random_crowd(1, seed=seed),
    ],
)
def test_seeds_that_are_none_are_refused(call: Callable[[Any], Any], seed: object) -> None:
    with pytest.raises(InvalidParameterError, match="seed"):
        call(seed)


@pytest.mark.parametrize("temperature", [np.nan, np.inf, -400.0, -273.15])
def test_there_is_no_sound_below_absolute_zero(temperature: float) -> None:
    with pytest.raises(InvalidParameterError, match="temperature must be finite and above"):
        reactive.sonar.speed_of_sound(temperature)


def test_deviations_whose_square_overflows_are_refused() -> None:
    for deviation in (1e200, 1e308):
        with pytest.raises(InvalidParameterError, match="arrival_deviation"):
            reactive.locate(ARRAY, delay_12=1e-4, delay_13=2e-4, arrival_deviation=deviation)


def unaligned(values: Any) -> np.ndarray:
    array = np.asarray(values, dtype=np.float64)
    raw = np.frombuffer(b"x" + array.tobytes(), dtype=np.uint8)[1:]
    shifted = raw.view(np.float64).reshape(array.shape)
    assert not shifted.flags.aligned
    return shifted


def test_arrays_that_are_not_aligned_are_copied() -> None:
    gains = [(3.0, 20.0, 17.0, 0.25), (2.0, 10.0, 5.0, 0.2)]
    table = [nav.simulate_batch([SCENE], FIELD, make(gains)).energy for make in (np.array, unaligned)]
    np.testing.assert_array_equal(*table)
    places = [[3.0, 0.7], [2.0, 1.5]]
    fields = [nav.laws.force_field(FIELD, SCENE, position=make(places)).total for make in (np.array, unaligned)]
    np.testing.assert_array_equal(*fields)
    pulse = np.sin(np.linspace(0.0, np.pi, 41))
    time_ = np.linspace(0.0, 0.02, 41)
    assert impact.hic(unaligned(time_), unaligned(pulse)) == impact.hic(time_, pulse)
    fixes = [reactive.locate_batch(ARRAY, delay_12=make([1e-4]), delay_13=make([2e-4])) for make in (list, unaligned)]
    np.testing.assert_array_equal(fixes[0].range, fixes[1].range)


def test_errors_of_other_libraries_do_not_come_out() -> None:
    walk = datasets.Recording(time_s=[0.0, 0.4], person=[7, 7], position=[[0.0, 0.0], [0.5, 0.0]])
    with pytest.raises(HrsafetyError, match="start_time"):
        walk.humans([1.0, 2.0], duration=1.0)  # type: ignore[arg-type]  # the failure is the test
    with pytest.raises(HrsafetyError, match="channel_class"):
        impact.criteria.channel_filter(FLIGHT, DROP, np.ones(3))  # type: ignore[arg-type]  # the failure is the test
