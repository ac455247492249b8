"""Optuna, cma and pymoo over the rows of a study: they find the best points of functions whose best is known."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, ShapeError, scenarios, sweep
from hrsafety import navigation as nav

AXES = [sweep.Axis(name="x", low=-2.0, high=2.0), sweep.Axis(name="y", low=1e-2, high=1e2, scale="log")]


def bowl(x: np.ndarray, y: np.ndarray) -> dict[str, np.ndarray]:
    return {"cost": (x - 0.5) ** 2 + np.log10(y) ** 2, "gain": -np.abs(x), "here": x > -1.0}


STUDY = sweep.FunctionStudy(function=bowl, results=["cost", "gain", sweep.Column(name="here", kind="flag")])


def problem(**changed: Any) -> sweep.SearchProblem:
    return sweep.SearchProblem(**{"axes": AXES, "study": STUDY, "objectives": {"cost": "min"}, **changed})


def test_cma_finds_the_minimum() -> None:
    cma = pytest.importorskip("cma")
    search = cma.CMAEvolutionStrategy([0.2, 0.2], 0.3, {"bounds": [0, 1], "seed": 1, "verbose": -9})
    for _ in range(40):
        told = problem().step(search)
        assert told.values.shape == (search.popsize, 1)
    best = problem().evaluate([search.result.xbest])
    assert best.values[0, 0] < 1e-6
    np.testing.assert_allclose(best.points[0], [0.5, 1.0], atol=2e-3)


def test_optuna_maximizes_and_rows_that_do_not_count_fail() -> None:
    optuna = pytest.importorskip("optuna")
    optuna.logging.set_verbosity(optuna.logging.WARNING)
    search = optuna.create_study(direction="maximize", sampler=optuna.samplers.RandomSampler(seed=2))
    told = problem(objectives={"gain": "max"}, require={"here": True}).step(search, size=64)
    failed = search.get_trials(states=[optuna.trial.TrialState.FAIL])
    assert len(failed) == np.count_nonzero(told.points[:, 0] <= -1.0) > 0
    assert np.isnan(told.values[told.points[:, 0] <= -1.0]).all()
    assert search.best_value == np.nanmax(told.values)
    assert search.best_trial.user_attrs["x"] == told.points[np.nanargmax(told.values), 0]
    with pytest.raises(InvalidParameterError, match="have the directions"):
        problem().step(search)


@pytest.mark.filterwarnings("default")  # of pymoo
def test_pymoo_finds_the_front() -> None:
    algorithms = pytest.importorskip("pymoo.algorithms.moo.nsga2")
    task = problem(objectives={"cost": "min", "gain": "max"}, require={"here": True})
    search = algorithms.NSGA2(pop_size=24)
    search.setup(task.pymoo_problem(), termination=("n_gen", 30), seed=1, verbose=False)
    while search.has_next():
        task.step(search)
    front = task.evaluate(search.result().X)
    # The front is y = 1 and x from 0 to 0.5.
    assert np.abs(np.log10(front.points[:, 1])).max() < 0.1
    assert front.points[:, 0].min() > -0.05
    assert front.points[:, 0].max() < 0.55


def test_the_worst_case_counts_and_all_cases_are_required() -> None:
    cases = {name: scenarios.configuration(name) for name in ("c1", "c2")}
    axes = [sweep.Axis(name="detour_gain", low=0.0, high=250.0)]
    task = sweep.SearchProblem(
        axes=axes,
        study=sweep.NavigationStudy(scenarios=cases),
        objectives={"arrival_time": "min"},
        require={"outcome": "arrived"},
    )
    told = task.evaluate([[0.0], [0.5]])
    assert task.axes[0].unit == "N/m^2"
    law = nav.VirtualForceField(detour_gain=125.0)
    assert told.values[1, 0] == max(nav.simulate(each, law).arrival_time for each in cases.values())
    outcomes = [nav.simulate(each, nav.VirtualForceField(detour_gain=0.0)).outcome for each in cases.values()]
    assert np.isnan(told.values[0, 0]) == any(each != "arrived" for each in outcomes)


def test_ends_of_axes_are_reached_and_what_is_outside_is_refused() -> None:
    listed = [sweep.Axis(name="x", values=[3.0, 1.0]), AXES[1]]
    assert problem(axes=listed).evaluate([[0.0, 0.0], [1.0, 1.0]]).points.tolist() == [
        [3.0, pytest.approx(1e-2)],
        [1.0, pytest.approx(1e2)],
    ]
    with pytest.raises(InvalidParameterError, match="be from 0 to 1"):
        problem().evaluate([[0.5, 1.1]])
    with pytest.raises(InvalidParameterError, match="be from 0 to 1"):
        problem().evaluate([[0.5, np.nan]])
    with pytest.raises(ShapeError):
        problem().evaluate([0.5, 0.5])


@pytest.mark.parametrize(
    ("changed", "rule"),
    [
        ({"objectives": {}}, "name at least one column"),
        ({"objectives": {"price": "min"}}, "objectives must be"),
        ({"objectives": {"cost": "least"}}, "must be"),
        ({"objectives": {"here": "max"}}, "columns of numbers"),
        ({"require": {"cost": True}}, "words or flags"),
        ({"require": {"here": 1}}, "True or False"),
    ],
)
def test_what_no_search_can_want_is_refused(changed: dict[str, Any], rule: str) -> None:
    with pytest.raises(InvalidParameterError, match=rule):
        problem(**changed)


def test_other_optimizers_are_refused() -> None:
    with pytest.raises(InvalidParameterError, match=r"optuna\.Study"):
        problem().step(object())
