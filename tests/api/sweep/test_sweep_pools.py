"""Sweeps in thread pools, process pools and on a Dask cluster: the same bits, whatever dies."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor, ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, arena, sweep
from reference import sweep_functions

SPEEDS = sweep.Sobol([sweep.Axis(name="closing_speed", unit="m/s", low=0.2, high=2.0)], 2048, seed=3)
PEAKS = sweep.FunctionStudy(function=sweep_functions.peaks, results=[sweep.Column(name="force", unit="N")])


def force(result: sweep.SweepResult) -> bytes:
    assert result.complete
    return result["force"].tobytes()


@pytest.fixture(scope="module")
def expected() -> bytes:
    return force(sweep.run(SPEEDS, PEAKS))


@pytest.fixture(scope="module")
def pool() -> Iterator[Executor]:
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as executor:
        yield executor


def spawned(workers: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(workers, mp_context=multiprocessing.get_context("spawn"))


class Counting(ThreadPoolExecutor):
    """Counts the tasks that are neither done nor handed out."""

    def __init__(self) -> None:
        super().__init__(2)
        self.most = 0
        self._open: set[Future[Any]] = set()

    def submit(self, *args: Any, **kwargs: Any) -> Future[Any]:
        future = super().submit(*args, **kwargs)
        self._open = {each for each in self._open if not each.done()} | {future}
        self.most = max(self.most, len(self._open))
        return future


# ---- pools ----------------------------------------------------------------------------------


def test_process_pool_gives_the_same_bits(pool: Executor, tmp_path: Path, expected: bytes) -> None:
    assert force(sweep.run(SPEEDS, PEAKS, out=tmp_path, executor=pool, chunk_rows=100)) == expected


def test_process_pool_computes_in_other_processes(pool: Executor, tmp_path: Path) -> None:
    study = sweep.FunctionStudy(function=sweep_functions.counted, results=["y"], parameters={"folder": str(tmp_path)})
    grid = sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=40)])
    result = sweep.run(grid, study, executor=pool, chunk_rows=4)
    np.testing.assert_array_equal(result["y"], np.sin(np.linspace(0.0, 1.0, 40)))
    calls = [path.name.split("_") for path in tmp_path.iterdir()]
    assert len(calls) == 10
    assert str(multiprocessing.current_process().pid) not in {process for process, _ in calls}


def test_navigation_in_a_process_pool_gives_the_same_bits(pool: Executor) -> None:
    study = sweep.NavigationStudy(scenario=sweep_functions.two_crossings, names=["near", "far"])
    design = sweep.LatinHypercube(
        [
            sweep.Axis(name="place", unit="m", low=1.0, high=4.0),
            sweep.Axis(name="walking_speed", unit="m/s", low=0.4, high=1.5),
        ],
        30,
    )
    here, there = sweep.run(design, study), sweep.run(design, study, executor=pool, chunk_rows=7)
    for name, values in here.to_numpy().items():
        np.testing.assert_array_equal(values, there[name])
    assert len(here) == 60


def test_threads_give_the_same_bits_and_only_some_chunks_are_in_flight(expected: bytes) -> None:
    with Counting() as executor:
        assert force(sweep.run(SPEEDS, PEAKS, executor=executor, chunk_rows=64, in_flight=3)) == expected
        assert 1 <= executor.most <= 3


def test_pool_that_broke_leaves_the_finished_chunks(tmp_path: Path, expected: bytes) -> None:
    marker = tmp_path / "marker"
    study = sweep.FunctionStudy(
        function=sweep_functions.peaks_with_a_victim,
        results=[sweep.Column(name="force", unit="N")],
        parameters={"victim": 0.0, "marker": str(marker)},
    )
    out = tmp_path / "out"
    with spawned(1) as executor, pytest.raises(sweep.SweepError, match=r"the pool broke .* the same call resumes"):
        sweep.run(SPEEDS, study, out=out, executor=executor, chunk_rows=512)
    assert marker.exists()
    assert force(sweep.run(SPEEDS, study, out=out, chunk_rows=512)) == expected


def test_sweep_that_began_in_a_pool_goes_on_elsewhere_with_the_same_chunks(tmp_path: Path, expected: bytes) -> None:
    with ThreadPoolExecutor(2) as executor:
        first = sweep.run(SPEEDS, PEAKS, out=tmp_path, executor=executor)
    assert first.chunk_count > 4
    (tmp_path / "chunks" / "chunk-00000001.npz").unlink()
    assert not first.complete
    assert force(sweep.run(SPEEDS, PEAKS, out=tmp_path)) == expected


def test_error_of_a_function_comes_through_with_its_rows(pool: Executor, tmp_path: Path) -> None:
    study = sweep.FunctionStudy(function=sweep_functions.fails_beyond, results=["y"], parameters={"limit": 0.5})
    grid = sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=11)])
    for executor in (None, pool):
        with pytest.raises(sweep.SweepError, match=r"ArithmeticError: x beyond 0\.5 in the row x = 0\.6") as caught:
            sweep.run(grid, study, out=tmp_path, executor=executor, chunk_rows=2, in_flight=1)
        assert "the axes x and the parameters limit" in str(caught.value)
        # What comes from another process has its traceback as text.
        assert isinstance(caught.value.__cause__, ArithmeticError) or "x beyond 0.5" in str(caught.value.__cause__)
        assert "in rows 6 to 7 of the sweep" in caught.value.__notes__
        assert sweep.open(tmp_path).finished == (0, 1, 2)


# ---- cluster --------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def client() -> Iterator[Any]:
    distributed = pytest.importorskip("distributed", reason="needs the extra distributed")
    with (
        distributed.LocalCluster(
            n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None, silence_logs=50
        ) as cluster,
        distributed.Client(cluster, set_as_default=False) as made,
    ):
        yield made


def test_cluster_gives_the_same_bits(client: Any, tmp_path: Path, expected: bytes) -> None:
    seen: list[tuple[int, int]] = []
    result = sweep.run(
        SPEEDS, PEAKS, out=tmp_path, client=client, chunk_rows=100, progress=lambda *done: seen.append(done)
    )
    assert force(result) == expected
    assert seen[0] == (0, 2048)
    assert seen[-1] == (2048, 2048)
    assert len(seen) == 22


def test_standard_scenes_on_a_cluster_have_the_same_bits(client: Any, tmp_path: Path) -> None:
    few: dict[str, Any] = {
        "scenes": ["frontal_approach", "pedestrian_overtaking"],
        "seeds": 2,
        "people": ["not_reacting"],
    }
    laws = ["straight", "straight+barrier"]
    here = arena.run(laws, **few)
    there = arena.run(laws, **few, client=client, out=tmp_path)
    for cell, found in here.episodes.items():
        for name, own in found.items():
            np.testing.assert_array_equal(there.episodes[cell][name], own)
    assert len(list(tmp_path.rglob("*.npz"))) == 4


def test_worker_that_is_killed_costs_nothing_but_time(client: Any, tmp_path: Path, expected: bytes) -> None:
    marker = tmp_path / "marker"
    before = set(client.run(os.getpid).values())
    study = sweep.FunctionStudy(
        function=sweep_functions.peaks_with_a_victim,
        results=[sweep.Column(name="force", unit="N")],
        parameters={"victim": 1.9, "marker": str(marker)},
    )
    assert force(sweep.run(SPEEDS, study, out=tmp_path / "out", client=client, chunk_rows=64)) == expected
    assert marker.exists()
    client.wait_for_workers(2)
    assert len(before - set(client.run(os.getpid).values())) == 1


def test_error_on_a_cluster_is_tried_again_and_comes_through(client: Any, tmp_path: Path) -> None:
    study = sweep.FunctionStudy(function=sweep_functions.fails_beyond, results=["y"], parameters={"limit": 0.5})
    grid = sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=11)])
    with pytest.raises(sweep.SweepError, match=r"x beyond 0\.5 in the row x = 0\.6"):
        sweep.run(grid, study, out=tmp_path, client=client, chunk_rows=2, in_flight=1, retries=1)
    assert sweep.open(tmp_path).finished == (0, 1, 2)


def test_client_that_is_none_is_refused(client: Any) -> None:
    with pytest.raises(InvalidParameterError, match=r"client must be a distributed\.Client"):
        sweep.run(SPEEDS, PEAKS, client="tcp://localhost:8786")  # type: ignore[arg-type]  # that is the test
    with ThreadPoolExecutor(1) as executor, pytest.raises(ValueError, match="when there is an executor"):
        sweep.run(SPEEDS, PEAKS, client=client, executor=executor)
