"""Progress, Ctrl-C, exceptions and checkpoints of the search for gains."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.interrupting import LIMIT, answer_to_ctrl_c, needs_signals
from api.navigation.test_gain_search import assert_same
from hrsafety import InvalidParameterError, scenarios
from hrsafety import navigation as nav

SCENES = [scenarios.configuration(name) for name in ("c1", "c2", "c3")]
# Work for some tenths of a second, so that there are reports before its end.
LONG: dict[str, Any] = {"grid": (10, 14, 14, 11), "refinements": 2, "local_starts": 6, "survivors": 200, "threads": 1}


class Stopper:
    """Progress that raises an exception once a stage has come so far."""

    def __init__(self, stage: str, error: BaseException) -> None:
        self.stage, self.error, self.seen = stage, error, []

    def __call__(self, stage: str, done: int, total: int, best: float) -> None:
        self.seen.append((stage, done, total, best))
        if stage == self.stage:
            raise self.error


def stopped(stage: str, checkpoint: Path | None, **options: Any) -> nav.GainSearch:
    return nav.optimize_gains(
        SCENES, checkpoint=checkpoint, progress=Stopper(stage, KeyboardInterrupt()), **(LONG | options)
    )


@pytest.fixture(scope="module")
def whole() -> nav.GainSearch:
    return nav.optimize_gains(SCENES, **LONG)


def test_progress_is_reported_in_order_and_to_the_end() -> None:
    seen: list[tuple[str, int, int, float]] = []
    found = nav.optimize_gains(SCENES, progress=lambda *now: seen.append(now), **LONG)
    stages = list(dict.fromkeys(stage for stage, *_ in seen))
    assert stages == [stage for stage in ("grid 1", "grid 2", "grid 3", "local") if stage in stages]
    assert len(seen) > 2
    for stage, done, total, _ in seen:
        assert 0 <= done <= total
        assert total == (6 if stage == "local" else 10 * 14 * 14 * 11)
    assert seen[-1][:3] == ("local", 6, 6)
    best = [value for *_, value in seen]
    assert best == sorted(best)
    assert best[-1] == found.best_value


@pytest.mark.parametrize("stage", ["grid 1", "grid 2", "grid 3"])
def test_interrupted_search_returns_the_best_so_far(stage: str, whole: nav.GainSearch) -> None:
    found = stopped(stage, None)
    assert found.interrupted
    assert 0 < found.evaluations < whole.evaluations
    assert found.best_value <= whole.best_value
    own = nav.simulate_batch(SCENES, found.best, stop_on_contact=True).performance_total.mean()
    assert found.best_value == pytest.approx(own, abs=1e-12)
    assert found.confidence is None


@pytest.mark.parametrize("stage", ["grid 1", "grid 2", "grid 3"])
def test_resumed_search_is_the_uninterrupted_one_bit_for_bit(stage: str, whole: nav.GainSearch, tmp_path: Path) -> None:
    file = tmp_path / "search.npz"
    first = stopped(stage, file)
    assert first.interrupted
    assert file.exists()
    resumed = nav.optimize_gains(SCENES, checkpoint=file, **LONG)
    assert_same(resumed, whole)


def test_search_stopped_again_and_again_ends_the_same(whole: nav.GainSearch, tmp_path: Path) -> None:
    file = tmp_path / "search.npz"
    for stage in ("grid 1", "grid 1", "grid 2", "grid 3"):
        assert stopped(stage, file).interrupted
    # The threads may differ too.
    assert_same(nav.optimize_gains(SCENES, checkpoint=file, **(LONG | {"threads": 2})), whole)


def test_finished_checkpoint_is_not_computed_again(tmp_path: Path) -> None:
    calls: list[int] = []

    def objective(table: nav.RunTable) -> np.ndarray:
        calls.append(len(table))
        return table.performance_total.reshape(-1, 3).mean(axis=1)

    options: dict[str, Any] = {"grid": (3, 3, 3, 3), "refinements": 1, "local_starts": 1, "survivors": 9}
    file = tmp_path / "search.npz"
    first = nav.optimize_gains(SCENES, objective=objective, checkpoint=file, **options)
    assert calls
    calls.clear()
    again = nav.optimize_gains(SCENES, objective=objective, checkpoint=file, **options)
    assert not calls
    assert_same(again.local, first.local)
    assert again.best_value == first.best_value


def test_local_searches_resume_bit_for_bit(tmp_path: Path) -> None:
    def slowly(table: nav.RunTable) -> np.ndarray:
        time.sleep(0.005)  # so that there are reports between the few calls
        return table.performance_total.reshape(-1, 3).mean(axis=1)

    options: dict[str, Any] = {"grid": (4, 4, 4, 4), "refinements": 0, "survivors": 9, "local_starts": 3}
    whole = nav.optimize_gains(SCENES, objective=slowly, **options)
    file = tmp_path / "search.npz"
    stopper = Stopper("local", KeyboardInterrupt())
    first = nav.optimize_gains(SCENES, objective=slowly, checkpoint=file, progress=stopper, **options)
    assert first.interrupted
    assert "interrupted" in {entry.status for entry in first.local}
    resumed = nav.optimize_gains(SCENES, objective=slowly, checkpoint=file, **options)
    assert_same((resumed.best, resumed.local, resumed.top), (whole.best, whole.local, whole.top))
    assert (resumed.evaluations, resumed.failures) == (whole.evaluations, whole.failures)


@pytest.mark.parametrize("method", ["differential_evolution", "cma_es"])
def test_global_search_resumes_bit_for_bit(method: Any, tmp_path: Path) -> None:
    options: dict[str, Any] = {"method": method, "evaluations": 20_000, "threads": 1}
    whole = nav.optimize_gains(SCENES, **options)
    file = tmp_path / "search.npz"
    first = nav.optimize_gains(SCENES, checkpoint=file, progress=Stopper("global", KeyboardInterrupt()), **options)
    assert first.interrupted
    assert first.evaluations < whole.evaluations
    assert_same(nav.optimize_gains(SCENES, checkpoint=file, **options), whole)


def test_front_resumes_bit_for_bit(tmp_path: Path) -> None:
    options: dict[str, Any] = {"grid": LONG["grid"], "threads": 1}
    whole = nav.gains.pareto_front(SCENES, **options)
    file = tmp_path / "front.npz"
    first = nav.gains.pareto_front(SCENES, checkpoint=file, progress=Stopper("front 1", KeyboardInterrupt()), **options)
    assert first.interrupted
    assert_same(nav.gains.pareto_front(SCENES, checkpoint=file, **options), whole)


def test_other_exceptions_of_progress_are_raised_and_leave_a_checkpoint(whole: nav.GainSearch, tmp_path: Path) -> None:
    file = tmp_path / "search.npz"
    with pytest.raises(ZeroDivisionError):
        nav.optimize_gains(SCENES, checkpoint=file, progress=Stopper("grid 2", ZeroDivisionError()), **LONG)
    assert_same(nav.optimize_gains(SCENES, checkpoint=file, **LONG), whole)


# ---- what callables do wrong ----------------------------------------------------------------

TINY: dict[str, Any] = {"grid": (2, 2, 2, 2), "refinements": 0, "local_starts": 0}


def test_exception_of_a_callable_is_raised_as_it_is() -> None:
    class OwnError(Exception):
        pass

    def objective(_table: nav.RunTable) -> np.ndarray:
        raise OwnError("as it is")

    with pytest.raises(OwnError, match="as it is"):
        nav.optimize_gains(SCENES, objective=objective, **TINY)
    with pytest.raises(OwnError):
        nav.optimize_gains(SCENES, constraints=[objective], **TINY)


@pytest.mark.parametrize("result", [None, 1.0, [1.0], [[1.0] * 16], ["a"] * 16, [1j] * 16, "abc"])
def test_what_a_callable_returns_is_checked(result: Any) -> None:
    for name, options in (
        ("objective", {"objective": lambda _table: result}),
        (
            "constraints[1]",
            {"constraints": [nav.gains.GainConstraint(metric="energy", at_most=9), lambda _table: result]},
        ),
    ):
        with pytest.raises(InvalidParameterError) as caught:
            nav.optimize_gains(SCENES, **(TINY | options))  # type: ignore[arg-type]  # options of several kinds
        assert caught.value.argument == name


def test_values_that_are_not_numbers_are_worst_of_all() -> None:
    def objective(table: nav.RunTable) -> np.ndarray:
        values = table.gains[::3, 0].copy()
        values[values > 40] = np.nan
        return values

    found = nav.optimize_gains(SCENES, objective=objective, **(TINY | {"grid": (6, 2, 2, 2)}))
    assert found.best.attractive_gain == 40.0


# ---- checkpoints of something else ----------------------------------------------------------


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("checkpoint") / "search.npz"
    nav.optimize_gains(SCENES, checkpoint=path, **TINY)
    return path


@pytest.mark.parametrize(
    ("named", "options"),
    [
        ("grid[0]", {"grid": (3, 2, 2, 2)}),
        ("refinements", {"refinements": 1}),
        ("survivors", {"survivors": 7}),
        ("local_starts", {"local_starts": 1}),
        ("bounds", {"bounds": {"gain_ratio": (0.1, 2.0)}}),
        ("law.stabilizing", {"law": nav.VirtualForceField(stabilizing="full")}),
        ("law.pass_behind", {"law": nav.VirtualForceField(stabilizing="off", pass_behind=False)}),
        ("objectives[0]", {"objective": "energy"}),
        ("weights[0]", {"weights": (0.5, 0.25, 0.25)}),
        ("constraints (length)", {"constraints": [nav.gains.GainConstraint(metric="energy", at_most=5.0)]}),
        ("step", {"step": 0.02}),
        ("hold", {"hold": False}),
        ("integrator", {"integrator": "rk4"}),
        ("seed", {"seed": 1}),
        ("scenarios[0].time_limit", {"time_limit": 9.0}),
        ("scenarios (length)", {"scenarios": SCENES[:2]}),
        ("scenarios[0].obstacles[0]", {"scenarios": [SCENES[1], *SCENES[1:]]}),
        ("method", {"method": "cma_es"}),
    ],
)
def test_checkpoint_of_other_settings_is_refused_and_what_differs_is_named(
    file: Path, named: str, options: dict[str, Any]
) -> None:
    before = file.read_bytes()
    with pytest.raises(InvalidParameterError) as caught:
        nav.optimize_gains(**({"scenarios": SCENES} | TINY | {"checkpoint": file} | options))
    assert caught.value.argument == "checkpoint"
    assert f": {named} is " in caught.value.requirement
    assert file.read_bytes() == before


def test_recorded_path_is_part_of_the_settings(tmp_path: Path) -> None:
    def scene(last: float) -> nav.Scenario:
        time = np.linspace(0.0, 8.0, 100)
        path = np.column_stack([np.linspace(0.0, last, 100), np.full(100, 2.6)])
        return nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[nav.Human.from_path(time, path)])

    path = tmp_path / "search.npz"
    nav.optimize_gains([scene(3.0)], checkpoint=path, **TINY)
    with pytest.raises(InvalidParameterError, match="obstacles"):
        nav.optimize_gains([scene(3.1)], checkpoint=path, **TINY)


@pytest.mark.parametrize("content", [b"", b"not an archive", b"PK\x03\x04 but broken"])
def test_file_that_is_no_checkpoint_is_refused_and_kept(content: bytes, tmp_path: Path) -> None:
    path = tmp_path / "search.npz"
    path.write_bytes(content)
    with pytest.raises(InvalidParameterError) as caught:
        nav.optimize_gains(SCENES, checkpoint=path, **TINY)
    assert caught.value.argument == "checkpoint"
    assert path.read_bytes() == content


def test_archive_of_something_else_is_refused(tmp_path: Path, file: Path) -> None:
    path = tmp_path / "other.npz"
    np.savez(path, values=np.arange(3))
    with pytest.raises(InvalidParameterError, match="checkpoint must be a checkpoint"):
        nav.optimize_gains(SCENES, checkpoint=path, **TINY)
    with np.load(file) as archive:
        about, state = archive["about"], archive["state"]
    for spoiled in (state[:-9], np.roll(state, 3), state[:0]):
        np.savez(path, about=about, state=spoiled)
        with pytest.raises(InvalidParameterError):
            nav.optimize_gains(SCENES, checkpoint=path, **TINY)


def test_no_folder_no_search(tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError, match="checkpoint must be in a folder"):
        nav.optimize_gains(SCENES, checkpoint=tmp_path / "missing" / "search.npz", **TINY)


# ---- a signal -------------------------------------------------------------------------------

PROGRAM = """
import sys, time
from hrsafety import navigation as nav, scenarios
scenes = [scenarios.configuration(name) for name in ("c1", "c2", "c3", "c4")]
options = dict(grid={grid}, refinements=0, threads=1, {options})
print("started", flush=True)
found = nav.{function}(scenes, checkpoint=sys.argv[1], **options)
print(found.interrupted, time.monotonic(), flush=True)
"""


@needs_signals
@pytest.mark.parametrize(
    ("function", "options"),
    [
        ("optimize_gains", ""),
        ("optimize_gains", "objective=lambda table: table.energy.reshape(-1, 4).sum(axis=1)"),
        ("optimize_gains", 'method="differential_evolution"'),
        ("pareto_front", ""),
    ],
    ids=["grid", "callable", "global", "front"],
)
def test_ctrl_c_ends_the_search_with_a_result_and_a_checkpoint(function: str, options: str, tmp_path: Path) -> None:
    file = tmp_path / "search.npz"
    # A front keeps a record of its points before the first one is run.
    grid = "(30, 30, 30, 8)" if function == "pareto_front" else "(40, 40, 40, 16)"
    program = PROGRAM.format(function=function, options=options, grid=grid)
    assert answer_to_ctrl_c(program, str(file), word="True") < LIMIT
    assert file.exists()


@needs_signals
def test_front_of_millions_of_points_stops_soon() -> None:
    """No set of all points of the grid is filled before the first one is run, nor freed after a stop."""
    program = PROGRAM.format(function="pareto_front", options="", grid="(40, 40, 40, 30)").replace(
        "sys.argv[1]", "None"
    )
    # The best of some tries: other work on the machine delays single ones.
    assert min(answer_to_ctrl_c(program, word="True") for _ in range(4)) < 0.4


def test_equal_points_of_a_front_are_run_once() -> None:
    above = np.nextafter(20.0, 21.0)
    found = nav.gains.pareto_front(
        SCENES, grid=(5, 2, 2, 2), refinements=0, bounds={"attractive_gain": (20.0, above)}, threads=1
    )
    assert found.evaluations == 2 * 2 * 2 * 2
