"""Long calls tell how far they are: which can take long, and what they tell."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from api.fuzzing import RECORDING, WEIGHED
from hrsafety import InvalidParameterError, arms, contact, impact, reactive, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.arms import workspace as arm_workspace

Tell = Callable[[Callable[[int, int], object]], Any]

# Calls that can take more than some seconds.
LONG: tuple[Callable[..., Any], ...] = (
    *(nav.simulate_many, nav.simulate_batch, nav.compare, nav.optimize_gains, nav.gain_sensitivity),
    *(nav.gains.pareto_front, nav.metrics.falsify, nav.metrics.evaluate_many),
    *(nav.tracking.track_batch, nav.sensing.calibration_study, nav.robots.open_loop_tests),
    *(impact.metrics_batch, impact.identify_foam, contact.study),
    *(contact.Contact.simulate_many, contact.Contact.allowed_speeds, contact.Contact.probability),
    *(reactive.experiment, reactive.skirt_test, reactive.smallest_skirt, reactive.locate_batch),
    *(reactive.sound.jittered_fixes, arms.workspace, scenarios.crossings, sweep.run),
)

CALLS: dict[str, Tell] = {
    "calibration_study": lambda told: nav.sensing.calibration_study(seeds=3, progress=told),
    "open_loop_tests": lambda told: nav.robots.open_loop_tests(
        nav.robots.HOLONOMIC_WHEELS[0], [0.3], repeats=3, duration=0.1, progress=told
    ),
    "crossings": lambda told: scenarios.crossings(RECORDING_OF_A_WALK, runs=3, progress=told),
}
RECORDING_OF_A_WALK = type(RECORDING)(time_s=[0.0, 20.0], person=[7, 7], position=[[-10, 1], [10, 1]])


@pytest.mark.parametrize("function", LONG, ids=lambda function: function.__name__)
def test_long_call_has_progress(function: Callable[..., Any]) -> None:
    parameters = inspect.signature(function).parameters
    assert "progress" in parameters
    assert parameters["progress"].default is None
    assert re.search(r"^    [\w, ]*\bprogress\b", function.__doc__ or "", re.MULTILINE)


@pytest.mark.parametrize("name", CALLS)
def test_progress_counts_from_nothing_to_all(name: str) -> None:
    seen: list[tuple[int, int]] = []
    CALLS[name](lambda done, total: seen.append((done, total)))
    assert seen == [(0, 3), (1, 3), (2, 3), (3, 3)]
    with pytest.raises(InvalidParameterError, match="progress must be callable or None"):
        CALLS[name]("often")  # type: ignore[arg-type]  # on purpose


def test_resamplings_and_draws_are_counted_to_all() -> None:
    time, depth = np.arange(0.0, 0.3, 0.001), np.linspace(0.0, 0.01, 11)
    drop = impact.identification.drop_trajectory(
        time, height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=0.112, friction=2.0
    )
    scattered = np.round(drop, 4)
    hit = contact.Contact(robot=4.0, region=75e3)
    calls: dict[str, tuple[Callable[..., Any], int]] = {
        "bootstrap": (lambda **told: impact.identify_foam(24250.0 * depth, depth, time, scattered, 1.54, **told), 20),
        "draws": (
            lambda **told: hit.probability(0.2, {"force": 140.0}, body_mass={"lognormal": [1.0, 0.2]}, **told),
            5000,
        ),
    }
    for name, (call, total) in calls.items():
        seen: list[int] = []
        heard = call(**{name: total}, progress=lambda done, of, seen=seen: seen.append(done if of > 0 else -1))
        assert seen[-1] == total
        assert seen == sorted(seen)
        assert repr(heard) == repr(call(**{name: total}))
        with pytest.raises(InvalidParameterError, match="progress must be callable or None"):
            call(**{name: total}, progress="often")
    # Nothing is counted where nothing is resampled.
    impact.identify_foam(24250.0 * depth, depth, time, scattered, 1.54, progress=lambda *_: pytest.fail("told"))


def test_workspace_in_blocks_is_that_in_one(monkeypatch: pytest.MonkeyPatch) -> None:
    options: dict[str, Any] = {"link": "tool", "samples": 50, "seed": 3, "threads": 1}
    whole = arms.workspace(WEIGHED, **options)
    along = arms.workspace(WEIGHED, direction=(1.0, 0.0, 0.0), **options)
    monkeypatch.setattr(inspect.getmodule(arm_workspace), "_BLOCK", 16)
    seen: list[tuple[int, int]] = []
    parts = arms.workspace(WEIGHED, progress=lambda done, total: seen.append((done, total)), **options)
    assert seen == [(0, 50), (16, 50), (32, 50), (48, 50), (50, 50)]
    for name in ("joints", "position", "mass", "direction"):
        np.testing.assert_array_equal(getattr(parts, name), getattr(whole, name))
    again = arms.workspace(WEIGHED, direction=(1.0, 0.0, 0.0), **options)
    np.testing.assert_array_equal(again.mass, along.mass)
    np.testing.assert_array_equal(again.direction, along.direction)
