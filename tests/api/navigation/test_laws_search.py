"""Searches, fronts and sensitivities of laws with gains of other names and numbers."""

from __future__ import annotations

import itertools
import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from api.spoiled import names
from hrsafety import InvalidParameterError, ShapeError, scenarios
from hrsafety import navigation as nav
from hrsafety.navigation.gains.problem import noise_seeds

SCENES = [scenarios.configuration(name) for name in ("c1", "c2", "c3")]
MASOUD = nav.Masoud()
RECIPROCAL = nav.OptimalReciprocalCollisionAvoidance()
TREE = nav.RapidlyExploringRandomTree(draws=200)
SMALL: dict[str, Any] = {"grid": (4, 5, 4), "refinements": 2, "survivors": 20, "local_starts": 3}
TINY: dict[str, Any] = {"grid": (3, 3, 2, 1), "refinements": 1, "survivors": 5, "local_starts": 1}


def mean_score(law: nav.Law, gains: Any = None) -> np.ndarray:
    table = nav.simulate_batch(SCENES, law, gains, stop_on_contact=True)
    return np.asarray(table.performance_total.reshape(-1, len(SCENES)).mean(axis=1))


@pytest.fixture(scope="module")
def search() -> nav.GainSearch:
    return nav.optimize_gains(SCENES, MASOUD, **SMALL)


@pytest.fixture(scope="module")
def planner() -> nav.GainSearch:
    return nav.optimize_gains(SCENES, RECIPROCAL, **TINY)


# ---- three gains ----------------------------------------------------------------------------


def test_search_beats_the_gains_it_did_not_start_from(search: nav.GainSearch) -> None:
    assert isinstance(search.best, nav.Masoud)
    assert search.feasible
    assert search.best_value > mean_score(MASOUD)[0] + 0.01
    assert search.best_value == pytest.approx(mean_score(search.best)[0], abs=1e-15)
    assert search.best_performance == pytest.approx([nav.evaluate(s, search.best).total for s in SCENES], abs=1e-15)


def test_first_grid_spans_the_bounds_of_the_law(search: nav.GainSearch) -> None:
    first = search.grids[0]
    assert len(first.axes) == 3
    for axis, name, count in zip(first.axes, MASOUD.GAIN_NAMES, SMALL["grid"], strict=True):
        np.testing.assert_allclose(axis, np.linspace(*MASOUD.GAIN_BOUNDS[name], count), rtol=1e-14)
    assert [entry.evaluations for entry in search.grids] == [80, 80, 80]
    assert search.evaluations == 240 + sum(entry.evaluations for entry in search.local)


def test_every_grid_is_what_the_batch_says(search: nav.GainSearch) -> None:
    for entry in search.grids:
        points = np.array(list(itertools.product(*entry.axes)))
        assert entry.best_value == pytest.approx(mean_score(MASOUD, points).max(), abs=1e-12)
    np.testing.assert_allclose(mean_score(MASOUD, search.top), search.top_values, atol=1e-12)
    assert search.top.shape[1] == 3


def test_two_gains_are_searched_with_the_third_held() -> None:
    bounds = {"attractive_gain": (2.0, 10.0), "repulsive_gain": (10.0, 60.0), "detour_gain": (36.0, 36.0)}
    found = nav.optimize_gains(SCENES, MASOUD, bounds=bounds, **(SMALL | {"grid": (9, 11, 1)}))
    assert found.best.gains[2] == 36.0
    assert (found.grids[0].axes[2] == 36.0).all()
    assert found.best_value > mean_score(MASOUD)[0]


def test_no_number_of_threads_changes_the_search(search: nav.GainSearch) -> None:
    for threads in (1, 2):
        again = nav.optimize_gains(SCENES, MASOUD, threads=threads, **SMALL)
        assert again.best == search.best
        assert again.top.tobytes() == search.top.tobytes()
        assert again.convergence.tobytes() == search.convergence.tobytes()


@pytest.mark.parametrize("method", ["differential_evolution", "cma_es"])
def test_global_searches_know_three_gains(search: nav.GainSearch, method: Any) -> None:
    found = nav.optimize_gains(SCENES, MASOUD, method=method, evaluations=600, seed=1)
    assert len(found.best.gains) == 3
    assert found.best_value > mean_score(MASOUD)[0]
    assert found.best_value > search.best_value - 0.03
    again = nav.optimize_gains(SCENES, MASOUD, method=method, evaluations=600, seed=1)
    assert again.best == found.best


def test_default_grid_of_a_law_has_a_count_for_each_gain() -> None:
    found = nav.optimize_gains(SCENES[:1], MASOUD, refinements=0, local_starts=0)
    assert len(found.settings.grid) == 3
    assert found.evaluations == np.prod(found.settings.grid)


def test_search_of_a_law_goes_on_from_its_checkpoint(search: nav.GainSearch, tmp_path: Any) -> None:
    file = tmp_path / "search.state"
    first = nav.optimize_gains(SCENES, MASOUD, checkpoint=file, **SMALL)
    again = nav.optimize_gains(SCENES, MASOUD, checkpoint=file, **SMALL)
    assert first.best == again.best == search.best
    with pytest.raises(InvalidParameterError) as caught:
        nav.optimize_gains(SCENES, nav.GeCui(), checkpoint=file, **SMALL)
    assert names(caught.value) == "checkpoint"


def test_result_of_a_search_can_be_pickled(search: nav.GainSearch) -> None:
    again = pickle.loads(pickle.dumps(search))
    assert again.best == search.best
    assert again.settings.law == search.settings.law


WEAK = nav.BorensteinKoren(attractive_gain=4.0, repulsive_gain=0.7)


@pytest.mark.parametrize("law", [nav.GeCui(), nav.Khatib(form="printed", repulsive_gain=0.5), WEAK])
def test_other_force_laws_are_searched_too(law: nav.Law) -> None:
    found = nav.optimize_gains(
        SCENES[::2], law, grid=(4,) * len(law.gains), refinements=1, survivors=10, local_starts=1
    )
    assert type(found.nearest) is type(law)
    assert found.nearest.replaced(**dict(zip(law.GAIN_NAMES, law.gains, strict=True))) == law
    own = nav.simulate_batch(SCENES[::2], law, stop_on_contact=True).performance_total.mean()
    assert found.best_value >= own


# ---- planners -------------------------------------------------------------------------------


def test_numbers_of_a_planner_are_searched(planner: nav.GainSearch) -> None:
    assert isinstance(planner.best, nav.OptimalReciprocalCollisionAvoidance)
    assert planner.feasible
    assert planner.best_value > mean_score(RECIPROCAL)[0]
    assert planner.best_value == pytest.approx(mean_score(planner.best)[0], abs=1e-15)
    first = planner.grids[0]
    points = np.array(list(itertools.product(*first.axes)))
    assert first.best_value == pytest.approx(mean_score(RECIPROCAL, points).max(), abs=1e-12)
    for name, value in zip(RECIPROCAL.GAIN_NAMES, planner.best.gains, strict=True):
        low, high = RECIPROCAL.GAIN_BOUNDS[name]
        assert low <= value <= high


def test_choices_of_a_planner_are_kept() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance(reciprocal=True)
    found = nav.optimize_gains(SCENES[:1], law, **(TINY | {"local_starts": 0}))
    assert isinstance(found.best, nav.OptimalReciprocalCollisionAvoidance)
    assert found.best.reciprocal
    timed = nav.VelocityObstacle(selection="time_and_risk")
    searched = nav.optimize_gains(SCENES[:1], timed, **(TINY | {"local_starts": 0}))
    assert isinstance(searched.best, nav.VelocityObstacle)
    assert searched.best.selection == "time_and_risk"


def test_tree_is_searched_with_seeds() -> None:
    grid = dict.fromkeys(TREE.GAIN_NAMES, 1) | {"margin": 3}
    held = {name: (value, value) for name, value in zip(TREE.GAIN_NAMES, TREE.gains, strict=True) if name != "margin"}
    options: dict[str, Any] = {"bounds": held, "grid": grid, "refinements": 0, "local_starts": 0, "seeds": 3, "seed": 2}
    found = nav.optimize_gains(SCENES[:1], TREE, **options)
    assert isinstance(found.best, nav.RapidlyExploringRandomTree)
    assert found.best.draws == 200
    assert found.evaluations == 3
    assert found.episodes == 9
    assert found.confidence is not None
    assert nav.optimize_gains(SCENES[:1], TREE, threads=1, **options).best == found.best
    episodes = [replace(SCENES[0], seed=seed) for seed in noise_seeds(found.settings, 3)]
    scores = nav.simulate_batch(episodes, found.best, stop_on_contact=True).performance_total
    assert len(set(scores.tolist())) > 1
    assert found.best_value == pytest.approx(scores.mean(), abs=1e-14)
    with pytest.raises(InvalidParameterError) as caught:
        nav.optimize_gains(SCENES[:1], MASOUD, seeds=3)
    assert names(caught.value) == "seeds"


def test_front_of_a_planner_trades_time_for_clearance() -> None:
    front = nav.gains.pareto_front(
        SCENES[:1],
        RECIPROCAL,
        objectives=("arrival_time", "min_clearance"),
        grid=(3, 4, 1, 1),
        bounds={"turn": (0.01, 0.01)},
    )
    assert len(front) > 1
    assert front.gains.shape[1] == 4
    order = np.argsort(front.values[:, 0])
    # Whoever is later is farther away.
    assert (np.diff(front.values[order, 1]) > 0.0).all()


# ---- what is refused ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("options", "argument"),
    [
        ({"bounds": {"gain_ratio": (0.0, 1.0)}}, "bounds"),
        ({"bounds": [(0.0, 1.0)] * 4}, "bounds"),
        ({"grid": (3, 3, 3, 3)}, "grid"),
        ({"grid": {"gain_ratio": 3}}, "grid"),
        ({"law": "masoud"}, "law"),
        ({"law": nav.Masoud}, "law"),
    ],
)
def test_settings_of_another_law_are_refused(options: dict[str, Any], argument: str) -> None:
    with pytest.raises((InvalidParameterError, ShapeError)) as caught:
        nav.optimize_gains(**{"scenarios": SCENES[:1], "law": MASOUD, "refinements": 0, **options})
    assert names(caught.value).split("[")[0] == argument


# ---- sensitivity ----------------------------------------------------------------------------


@pytest.mark.parametrize("law", [MASOUD, nav.GeCui(), RECIPROCAL], ids=["masoud", "ge_cui", "reciprocal"])
def test_sensitivity_changes_each_gain_of_the_law(law: nav.Law) -> None:
    changes = (-10.0, 0.0, 5.0)
    found = nav.gain_sensitivity(SCENES, law, changes)
    width = len(law.gains)
    assert found.gain_names == law.GAIN_NAMES
    assert found.gains.shape == (width, 3, width)
    assert found.performance.shape == (width, 3, 3)
    for row, column in itertools.product(range(width), range(3)):
        gains = np.array(law.gains)
        gains[row] *= 1.0 + changes[column] / 100.0
        assert found.gains[row, column] == pytest.approx(gains)
        single = law.replaced(**dict(zip(law.GAIN_NAMES, gains.tolist(), strict=True)))
        scores = [nav.evaluate(scene, single).total for scene in SCENES]
        assert found.performance[row, column].tolist() == scores
    assert (found.performance[:, 1] == found.reference_performance).all()
    assert [name for name in found.columns() if name in law.GAIN_NAMES] == list(law.GAIN_NAMES)


def test_relative_sensitivity_is_that_of_the_definition() -> None:
    found = nav.gain_sensitivity(SCENES, MASOUD, (-10.0, 5.0))
    reference = found.reference_performance.mean()
    for column, change in enumerate((-0.1, 0.05)):
        expected = (found.mean_performance[:, column] / reference - 1.0) / change
        kept = (found.outcome[:, column] == "arrived").all(axis=1)
        assert kept.any()
        assert found.relative_sensitivity[kept, column] == pytest.approx(expected[kept], rel=1e-12)


def test_slopes_of_a_law_are_those_of_its_scores() -> None:
    found = nav.gains.gain_gradient(SCENES[:1], MASOUD)
    assert found.gain_names == MASOUD.GAIN_NAMES
    assert found.gradient.shape == (3,)
    for index, (name, step) in enumerate(zip(found.gain_names, found.steps, strict=True)):
        ahead, behind = (
            nav.evaluate(SCENES[0], replace(MASOUD, **{name: getattr(MASOUD, name) + side * step})).total
            for side in (1.0, -1.0)
        )
        assert found.gradient[index] == pytest.approx((ahead - behind) / (2.0 * step), abs=1e-9)
