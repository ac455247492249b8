"""Tables of changed gains and slopes over the gains: numbers, bad input, pickles."""

from __future__ import annotations

import dataclasses
import pickle
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize._numdiff import approx_derivative

from api.spoiled import INF, NAN, POSITIVE, WORD, names, refused, spoiled_calls
from hrsafety import navigation as nav
from hrsafety import scenarios

SCENES = [scenarios.configuration(name) for name in ("c1", "c2", "c3")]
SOURCE = nav.VirtualForceField(
    attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="off"
)
CHANGES = (-50.0, -10.0, 0.0, 10.0, 100.0)


@pytest.fixture(scope="module")
def table() -> nav.gains.GainSensitivity:
    return nav.gain_sensitivity(SCENES, SOURCE, CHANGES)


def law_of(gains: Any) -> nav.VirtualForceField:
    return replace(SOURCE, **dict(zip(SOURCE.GAIN_NAMES, map(float, gains), strict=True)))


# ---- sensitivity ----------------------------------------------------------------------------


def test_every_cell_is_the_single_run_of_its_gains(table: nav.gains.GainSensitivity) -> None:
    for gain in range(4):
        for change in (0, 3):
            for index, scene in enumerate(SCENES):
                found = nav.evaluate(scene, law_of(table.gains[gain, change]))
                assert table.performance[gain, change, index] == found.total
                assert table.energy[gain, change, index] == found.trajectory.energy
                own = table.min_distance[gain, change, index, : len(scene.obstacles)]
                np.testing.assert_array_equal(own, found.trajectory.min_distance)
                np.testing.assert_equal(table.arrival_time[gain, change, index], found.trajectory.arrival_time)


def test_one_gain_changes_at_a_time(table: nav.gains.GainSensitivity) -> None:
    for gain in range(4):
        expected = np.tile(SOURCE.gains, (len(CHANGES), 1))
        expected[:, gain] *= 1 + np.array(CHANGES) / 100
        np.testing.assert_allclose(table.gains[gain], expected, rtol=1e-15)


def test_relative_sensitivity_is_the_printed_equation(table: nav.gains.GainSensitivity) -> None:
    best = table.reference_performance.mean()
    for gain, own in enumerate(SOURCE.gains):
        for change in (1, 3, 4):
            delta = (best - table.mean_performance[gain, change]) / (own - table.gains[gain, change, gain])
            assert table.relative_sensitivity[gain, change] == pytest.approx(delta * own / best, rel=1e-9)
    assert np.isnan(table.relative_sensitivity[:, 2]).all()


def test_no_sensitivity_where_a_run_fails() -> None:
    found = nav.gain_sensitivity(SCENES, SOURCE, (-100.0, 10.0))
    failed = (found.outcome[:, 0] != "arrived").any(axis=1)
    assert failed[0]  # without attraction nothing arrives
    np.testing.assert_array_equal(np.isnan(found.relative_sensitivity[:, 0]), failed)
    assert np.isnan(found.arrival_time[0, 0]).all()
    assert np.isfinite(found.relative_sensitivity[:, 1]).all()


def test_a_gain_of_zero_has_no_relative_change() -> None:
    found = nav.gain_sensitivity(SCENES[:1], replace(SOURCE, repulsive_gain=0.0), (10.0,))
    assert np.isnan(found.relative_sensitivity[1, 0])
    assert np.isnan(found.largest_sensitivity()[1])


def test_summary_of_the_sensitivities(table: nav.gains.GainSensitivity) -> None:
    finite = np.abs(np.delete(table.relative_sensitivity, 2, axis=1))
    np.testing.assert_array_equal(table.largest_sensitivity(), finite.max(axis=1))
    np.testing.assert_allclose(table.average_sensitivity(), finite.mean(axis=1), rtol=1e-15)


def test_columns_hold_every_cell_once(table: nav.gains.GainSensitivity) -> None:
    columns = table.columns()
    assert {len(column) for column in columns.values()} == {4 * len(CHANGES)}
    assert "min_distance_2_1" in columns
    assert "min_distance_0_1" not in columns  # one obstacle only
    row = 2 * len(CHANGES) + 3
    assert columns["gain"][row] == "detour_gain"
    assert columns["change_percent"][row] == 10.0
    assert columns["energy_1"][row] == table.energy[2, 3, 1]
    assert columns["mean_performance"][row] == table.mean_performance[2, 3]


def test_threads_do_not_change_a_bit_and_progress_ends_at_the_total(table: nav.gains.GainSensitivity) -> None:
    seen: list[tuple[int, int]] = []
    again = nav.gain_sensitivity(SCENES, SOURCE, CHANGES, threads=1, progress=lambda *now: seen.append(now))
    assert again.performance.tobytes() == table.performance.tobytes()
    runs = (4 * len(CHANGES) + 1) * len(SCENES)
    assert seen[-1] == (runs, runs)


def test_results_can_be_pickled(table: nav.gains.GainSensitivity) -> None:
    for found in (table, nav.gains.gain_gradient(SCENES[:1], SOURCE)):
        copy = pickle.loads(pickle.dumps(found))
        for field in dataclasses.fields(found):  # type: ignore[arg-type]  # a dataclass
            np.testing.assert_array_equal(getattr(copy, field.name), getattr(found, field.name))


# ---- gradient -------------------------------------------------------------------------------


def mean_of(metric: str, gains: np.ndarray) -> float:
    batch = nav.simulate_batch(SCENES, SOURCE, gains[None, :])
    return float(batch.columns()[metric].mean())  # type: ignore[attr-defined]  # a column of numbers


@pytest.mark.parametrize(
    ("metric", "column"),
    [("performance", "performance_total"), ("arrival_time", "arrival_time_s"), ("min_clearance", "min_clearance_m")],
)
def test_slopes_are_those_of_scipy(metric: Any, column: str) -> None:
    own = nav.gains.gain_gradient(SCENES, SOURCE, metric=metric, relative_step=1e-3)
    gains = np.array(SOURCE.gains)
    peer = approx_derivative(
        lambda point: mean_of(column, point), gains, method="3-point", abs_step=own.steps, bounds=(0.0, np.inf)
    )
    # The same quotient of the same runs: roundings of the mean, divided by the step.
    np.testing.assert_allclose(own.gradient, peer, rtol=1e-9, atol=1e-12)
    np.testing.assert_allclose(own.relative, peer * gains / mean_of(column, gains), rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(own.scenario_gradient.mean(axis=1), own.gradient, rtol=1e-9, atol=1e-15)


def test_slope_at_zero_looks_upwards_as_scipy_does() -> None:
    law = replace(SOURCE, repulsive_gain=0.0)
    own = nav.gains.gain_gradient(SCENES[:1], law, metric="energy", steps=(0.01, 0.5, 1.0, 0.001))
    slope = approx_derivative(
        lambda point: nav.simulate_batch(SCENES[:1], law, point[None, :]).energy[0],
        np.array(law.gains),
        method="3-point",
        abs_step=own.steps / np.array([1.0, 2.0, 1.0, 1.0]),  # SciPy goes two steps upwards
        bounds=(0.0, np.inf),
    )
    np.testing.assert_allclose(own.gradient, slope, rtol=1e-9, atol=1e-12)
    assert np.isnan(own.backward).tolist() == [False, True, False, False]


def test_error_covers_the_slopes_of_smaller_steps() -> None:
    wide = nav.gains.gain_gradient(SCENES, SOURCE, relative_step=0.02)
    half = nav.gains.gain_gradient(SCENES, SOURCE, relative_step=0.01)
    assert (np.abs(half.gradient - wide.gradient) <= wide.error * (1 + 1e-9)).all()
    np.testing.assert_allclose(wide.gradient, (wide.forward + wide.backward) / 2, rtol=1e-9, atol=1e-15)


def test_no_slope_where_a_run_fails() -> None:
    found = nav.gains.gain_gradient(SCENES, replace(SOURCE, attractive_gain=0.0))
    assert np.isnan(found.gradient).all()
    assert np.isnan(found.value)


# ---- bad input ------------------------------------------------------------------------------

SHARED: dict[str, tuple[Any, ...]] = {
    "scenarios": ([], SCENES[0], None, "c1", [None], [SCENES[0], SOURCE]),
    "law": (SCENES[0], "off", 3.0),
    "weights": ((0.5, 0.5), (0.5, 0.5, 0.5), (NAN, 0.5, 0.5), "abc"),
    "integrator": WORD,
    "step": (*POSITIVE, 0.007),
    "hold": (None, 1, "yes"),
    "threads": (0, -1, 1.5, "2", NAN, 1025),
}
BAD: dict[str, tuple[Any, dict[str, tuple[Any, ...]]]] = {
    "gain_sensitivity": (
        nav.gain_sensitivity,
        SHARED
        | {
            "changes": ((), 5.0, [[1.0]], "ab", None, (NAN,), (INF,), (-100.1,), ("a",)),
            "progress": (5, "print"),
        },
    ),
    "gain_gradient": (
        nav.gains.gain_gradient,
        SHARED
        | {
            "metric": (*WORD, "total"),
            "relative_step": POSITIVE,
            "steps": ((1.0,), 1.0, "abcd", (1.0, 1.0, 1.0, 0.0), (1.0, -1.0, 1.0, 1.0), (NAN, 1.0, 1.0, 1.0)),
        },
    ),
}


@pytest.mark.parametrize(("name", "argument", "values"), spoiled_calls(BAD))
def test_bad_argument_is_refused_by_name(name: str, argument: str, values: Sequence[Any]) -> None:
    for value in values:
        with refused(value) as caught:
            BAD[name][0](**({"scenarios": SCENES[:1], "law": SOURCE} | {argument: value}))
        assert argument in re.split(r"[\[\].]+", names(caught.value)), repr(value)
