"""Repeated runs: bands, shares, seeds, threads, interruption."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, plotting, scenarios
from hrsafety import navigation as nav

LAW = nav.VirtualForceField(stabilizing="off")
NOISY = dataclasses.replace(scenarios.configuration("c2"), measurement=nav.Measurement(of="both"))


@pytest.fixture(scope="module")
def runs() -> nav.RunTable:
    return nav.simulate_many(NOISY, LAW, seeds=40, paths=True)


def test_rows_are_the_single_runs(runs: nav.RunTable) -> None:
    for row in (0, 17, 39):
        alone = nav.simulate(dataclasses.replace(NOISY, seed=row), LAW)
        assert runs.outcome[row] == alone.outcome
        assert runs.end_time[row] == alone.time[-1]
        assert runs.energy[row] == alone.energy
        assert runs.min_distance[row].tobytes() == alone.min_distance.tobytes()
        inside = np.isfinite(runs.time[row])
        nearest = np.searchsorted(alone.time, runs.time[row][inside])
        assert np.array_equal(runs.position[row][inside], alone.position[nearest])
        assert np.array_equal(runs.distance[row][inside], alone.distance[nearest])


def test_rows_are_those_of_the_batch_of_point_masses(runs: nav.RunTable) -> None:
    table = nav.simulate_batch([dataclasses.replace(NOISY, seed=seed) for seed in range(40)], LAW)
    assert runs.outcome.tolist() == table.outcome.tolist()
    assert runs.arrival_time.tobytes() == table.arrival_time.tobytes()


def test_threads_change_no_bit() -> None:
    built = nav.robots.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS)
    tables = [nav.simulate_many(NOISY, LAW, seeds=9, built=built, threads=threads, paths=True) for threads in (1, 2, 7)]
    for field in dataclasses.fields(nav.RunTable):
        values = [getattr(table, field.name) for table in tables]
        if isinstance(values[0], np.ndarray):
            assert len({value.tobytes() for value in values}) == 1, field.name


def test_shares_are_those_of_the_outcomes(runs: nav.RunTable) -> None:
    assert runs.success.count == (runs.outcome == "arrived").sum()
    assert runs.contact.count == np.isfinite(runs.contact_time).any(axis=1).sum()
    assert runs.success.low <= runs.success.value <= runs.success.high


def test_bands_hold_their_share(runs: nav.RunTable) -> None:
    whole = runs.goal_band(1.0)
    inner = runs.goal_band(0.5)
    assert (whole.low <= inner.low).all()
    assert (inner.high <= whole.high).all()
    assert (np.diff(whole.runs) <= 0).all()
    assert whole.runs[0] == len(runs)
    assert whole.low[0] == whole.high[0] == math.dist(NOISY.start, NOISY.goal)
    at = 20
    assert whole.low[at] == runs.goal_distance[:, at].min()
    assert runs.distance_band(0, 1.0).high[at] == runs.distance[:, at, 0].max()


def test_band_of_exact_runs_has_no_width() -> None:
    exact = nav.simulate_many(scenarios.configuration("c1"), LAW, seeds=3, paths=True)
    band = exact.path_band()
    there = band.runs > 0
    assert np.array_equal(band.low[there], band.high[there])
    # The path leaves the straight way by what the run does, measured at the stations.
    farthest = np.abs(exact.position[0, :, 1] - 0.6).max()
    assert np.nanmax(np.abs(band.middle)) == pytest.approx(farthest, abs=0.02)


def test_path_band_is_the_same_in_a_turned_scene() -> None:
    plain = nav.simulate_many(scenarios.configuration("c1"), LAW, seeds=1, paths=True).path_band()
    scene = nav.Scenario(
        start=(-0.6, 3.9), goal=(-0.6, 0.0), obstacles=[dataclasses.replace(_disc(), center=(-0.595, 2.45))]
    )
    turned = nav.simulate_many(scene, LAW, seeds=1, paths=True).path_band()
    there = (plain.runs > 0) & (turned.runs > 0)
    assert np.abs(plain.middle - turned.middle)[there].max() < 1e-9


def _disc() -> nav.Disc:
    (disc,) = scenarios.configuration("c1").obstacles
    assert isinstance(disc, nav.Disc)
    return disc


@pytest.mark.parametrize("seeds", [0, -1, True, 1.5, "3", [], [-1], [2**64], [0.5]])
def test_bad_seeds_are_refused(seeds: Any) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.simulate_many(NOISY, LAW, seeds=seeds, paths=True)
    assert caught.value.argument.startswith("seeds")


@pytest.mark.parametrize("share", [0.0, 1.1, math.nan, -0.5, "1"])
def test_bad_shares_are_refused(runs: nav.RunTable, share: Any) -> None:
    for band in (runs.goal_band, runs.path_band, lambda value: runs.distance_band(0, value)):
        with pytest.raises(InvalidParameterError) as caught:
            band(share)
        assert caught.value.argument == "share"


def test_an_obstacle_that_is_not_there_is_refused(runs: nav.RunTable) -> None:
    with pytest.raises(InvalidParameterError):
        runs.distance_band(1)


def test_progress_counts_to_the_end() -> None:
    heard: list[tuple[int, int]] = []
    nav.simulate_many(NOISY, LAW, seeds=30, paths=True, progress=lambda done, total: heard.append((done, total)))
    assert heard[-1] == (30, 30)
    assert sorted(heard) == heard


def test_an_exception_in_progress_ends_the_work() -> None:
    def stop(*_: int) -> None:
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        nav.simulate_many(NOISY, LAW, seeds=40_000, paths=True, progress=stop)


def test_pictures_have_an_axes_for_each_distance(runs: nav.RunTable) -> None:
    exact = nav.simulate(scenarios.configuration("c2"), LAW)
    assert len(plotting.repeated_distances(runs, exact=exact).axes) == 2
    legend = plotting.repeated_paths(runs, exact=exact).legends[0]
    words = [text.get_text() for text in legend.get_texts()]
    assert {"40 of 40 paths", "90 % of the runs"} <= set(words)
    with pytest.raises(InvalidParameterError):
        plotting.repeated_paths(exact)  # type: ignore[arg-type]  # the refusal is the test
