"""Pictures of gain searches draw what they are given, and refuse what they cannot draw."""

from __future__ import annotations

import dataclasses
import math
from typing import Any

import matplotlib
import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety.errors import InvalidParameterError, ShapeError

NAMES = nav.VirtualForceField.GAIN_NAMES
PLACES = tuple(scenarios.configuration(name) for name in ("c1", "c3"))
LAW = nav.VirtualForceField(
    attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="off"
)
BOUNDS = np.array([[0.0, 50.0], [0.0, 200.0], [0.0, 500.0], [0.0, 3.0]])
LABELS = ["$K_1$ (N/m)", "$K_3$ (N/m)", "$K_5$ (N/m²)", "$b$ (s)"]


def settings(**changes: Any) -> nav.gains.SearchSettings:
    values: dict[str, Any] = {
        "scenarios": PLACES,
        "law": LAW,
        "bounds": BOUNDS,
        "grid": (3, 3, 3, 3),
        "refinements": 1,
        "survivors": 5,
        "local_starts": 2,
        "method": "grid",
        "objectives": ("performance",),
        "weights": (1 / 3, 1 / 3, 1 / 3),
        "constraints": (),
        "require_arrival": True,
        "cap_ratios": True,
        "seeds": 0,
        "seed": 0,
        "robustness": "mean",
        "evaluations": None,
        "integrator": "semi_implicit_euler",
        "step": 0.01,
        "hold": True,
    }
    return nav.gains.SearchSettings(**(values | changes))


def grid(low: Any, high: Any, *, best: float, worst: float, name: str = "grid 1") -> nav.gains.SearchStage:
    low, high = np.asarray(low, dtype=float), np.asarray(high, dtype=float)
    return nav.gains.SearchStage(
        name=name,
        status="complete",
        axes=tuple(np.linspace(a, b, 3) for a, b in zip(low, high, strict=True)),
        increments=(high - low) / 2.0,
        evaluations=81,
        failures=7,
        best_value=best,
        best_gains=(low + high) / 2.0,
        survivor_low=low + 0.25 * (high - low),
        survivor_high=low + 0.75 * (high - low),
        violation=0.0,
        worst_survivor=worst,
    )


def local(value: float) -> nav.gains.SearchStage:
    gains = np.array([10.0, 80.0, 490.0, 0.5])
    return nav.gains.SearchStage(
        name="local",
        start=gains,
        start_value=0.66,
        best_gains=gains,
        best_value=value,
        violation=0.0,
        evaluations=40,
        status="converged",
    )


def search(**changes: Any) -> nav.GainSearch:
    low, high = BOUNDS.T
    history = (
        grid(low, high, best=0.66, worst=0.61),
        grid(0.25 * high, 0.75 * high, best=0.665, worst=0.65, name="grid 2"),
    )
    values: dict[str, Any] = {
        "nearest": LAW,
        "best_value": 0.67,
        "best_performance": np.array([0.7, 0.64]),
        "violation": 0.0,
        "feasible": True,
        "evaluations": 242,
        "episodes": 484,
        "failures": 14,
        "history": (*history, local(0.67), local(0.668)),
        "convergence": np.array([[81.0, 0.66], [162.0, 0.665], [242.0, 0.67]]),
        "top": np.array([LAW.gains]),
        "top_values": np.array([0.665]),
        "confidence": None,
        "interrupted": False,
        "settings": settings(),
    }
    return nav.GainSearch(**(values | changes))


def flat(**changes: Any) -> nav.gains.Flatness:
    gains = np.stack([np.linspace(low, high, 5) for low, high in BOUNDS])
    shape = np.array([0.3, 0.66, 0.672, 0.67, 0.66])
    values: dict[str, Any] = {
        "gain_names": NAMES,
        "best_gains": gains[:, 2],
        "best_value": 0.672,
        "gains": gains,
        "values": np.tile(shape, (4, 1)),
        "violation": np.zeros((4, 5)),
        "tolerance": 0.01,
        "low": gains[:, 2],
        "high": gains[:, 3],
        "near_best_share": 0.75,
    }
    return nav.gains.Flatness(**(values | changes))


def front(values: Any, objectives: tuple[str, ...], maximized: tuple[bool, ...]) -> nav.gains.ParetoFront:
    table = np.asarray(values, dtype=float).reshape(-1, len(objectives))
    return nav.gains.ParetoFront(
        objectives=objectives,
        maximized=maximized,
        gains=np.tile(np.array(LAW.gains), (len(table), 1)),
        values=table,
        reference=np.zeros(len(objectives)),
        hypervolume=0.5,
        evaluations=81,
        episodes=162,
        failures=3,
        interrupted=False,
        settings=settings(),
    )


THREE = front(
    [[6.0, 0.16, 4.2], [6.1, 0.25, 4.3], [6.2, 0.10, 4.1], [7.4, 0.29, 8.5]],
    ("arrival_time", "min_clearance", "energy"),
    (False, True, False),
)
TWO = front([[6.0, 4.2], [6.2, 4.1], [6.5, 3.9]], ("arrival_time", "energy"), (False, False))


def labelled(axes: Any) -> dict[str, Any]:
    handles, texts = axes.get_legend_handles_labels()
    return dict(zip(texts, handles, strict=True))


def legend_texts(figure: Any) -> list[str]:
    return [text.get_text() for legend in figure.legends for text in legend.get_texts()]


@pytest.fixture(scope="module")
def sensitivity() -> nav.gains.GainSensitivity:
    return nav.gain_sensitivity(PLACES, LAW, (-100, -50, -10, 0, 10, 100))


# ---- sensitivity ------------------------------------------------------------------------------------


def test_sensitivity_shows_the_mean_performance_and_the_magnitude_in_percent(
    sensitivity: nav.gains.GainSensitivity,
) -> None:
    upper, lower = plotting.gain_sensitivity(sensitivity).axes
    for index in range(4):
        assert np.array_equal(upper.lines[index].get_xdata(), sensitivity.changes_percent)
        assert np.array_equal(upper.lines[index].get_ydata(), sensitivity.mean_performance[index])
        shown, expected = lower.lines[index].get_ydata(), 100.0 * np.abs(sensitivity.relative_sensitivity[index])
        assert np.array_equal(shown, expected, equal_nan=True)
    assert lower.get_xlabel() == "change of one gain (%); axis linear up to ±2 %, logarithmic beyond"
    assert lower.get_ylabel() == "relative sensitivity of mean H (%),\naxis logarithmic beyond 1 %"


def test_sensitivity_names_average_and_largest_of_each_gain(sensitivity: nav.gains.GainSensitivity) -> None:
    texts = legend_texts(plotting.gain_sensitivity(sensitivity))
    largest = 100.0 * sensitivity.largest_sensitivity()
    assert len(texts) == 4
    for index, symbol in enumerate(("$K_1$", "$K_3$", "$K_5$", "$b$")):
        assert texts[index].startswith(f"{symbol}: ")
        assert texts[index].endswith(f"{largest[index]:.2f} % at most")


def test_changes_that_ruin_the_performance_are_told_at_the_foot(sensitivity: nav.gains.GainSensitivity) -> None:
    upper = plotting.gain_sensitivity(sensitivity).axes[0]
    deep = sensitivity.mean_performance[sensitivity.mean_performance < 0.9 * sensitivity.mean_performance.max()]
    assert len(deep) >= 2
    assert sorted(text.get_text() for text in upper.texts) == sorted(f"{value:.2f}" for value in deep)
    assert upper.get_ylim()[0] > 0.5


def test_changes_are_drawn_in_rising_order_whatever_their_order() -> None:
    table = nav.gain_sensitivity(PLACES, LAW, (10, -10, 0))
    line = plotting.gain_sensitivity(table).axes[0].lines[0]
    assert list(line.get_xdata()) == [-10.0, 0.0, 10.0]
    assert line.get_ydata()[0] == table.mean_performance[0, 1]


# ---- flatness ---------------------------------------------------------------------------------------


def test_flatness_has_a_panel_for_each_gain_with_its_unit() -> None:
    figure = plotting.flatness(flat())
    assert [axes.get_xlabel() for axes in figure.axes] == LABELS
    assert [axes.get_ylabel() for axes in figure.axes] == ["mean H", "", "mean H", ""]


def test_flatness_draws_line_optimum_band_and_range() -> None:
    found = flat()
    for index, axes in enumerate(plotting.flatness(found).axes):
        shown = labelled(axes)
        line = shown["other gains as in the best set"]
        assert np.array_equal(line.get_xdata(), found.gains[index])
        assert np.array_equal(line.get_ydata(), found.values[index])
        star = shown["best set, 0.6720"]
        assert (star.get_xdata()[0], star.get_ydata()[0]) == (found.best_gains[index], found.best_value)
        band = shown["within 1 % of the best: 75 % of the best grid points"].get_extents()
        assert axes.transData.inverted().transform(band.min)[1] == pytest.approx(0.99 * 0.672)
        verticals = {float(entry.get_xdata()[0]) for entry in axes.lines if str(entry.get_linestyle()) == "--"}
        assert verticals == {found.low[index], found.high[index]}


def test_flatness_shows_other_gain_sets_where_they_lie() -> None:
    marks = {"published": (LAW.gains, 0.664), "plain": ((3.0, 20.0, 17.0, 0.25), 0.4)}
    for index, axes in enumerate(plotting.flatness(flat(), marks=marks).axes):
        shown = labelled(axes)
        inside = shown["published, 0.6640"]
        assert (inside.get_xdata()[0], inside.get_ydata()[0]) == (LAW.gains[index], 0.664)
        below = shown["plain, 0.4000, below the axis"]
        assert below.get_ydata()[0] == axes.get_ylim()[0] > 0.6


def test_flatness_leaves_failures_out_and_survives_where_nothing_else_is_known() -> None:
    values = np.full((4, 5), -np.inf)
    values[:, 2] = 0.672
    axes = plotting.flatness(flat(values=values, near_best_share=math.nan)).axes[0]
    shown = labelled(axes)
    assert np.isnan(shown["other gains as in the best set"].get_ydata()).sum() == 4
    assert "within 1 % of the best" in shown


def test_mark_with_another_number_of_gains_is_refused() -> None:
    with pytest.raises(ShapeError, match=r"marks\['x'\] must have shape \(4,\)"):
        plotting.flatness(flat(), marks={"x": ((1.0, 2.0), 0.6)})


# ---- history ----------------------------------------------------------------------------------------


def test_history_shows_best_and_worst_survivor_of_each_grid_and_the_local_searches() -> None:
    found = search()
    upper = plotting.search_history(found).axes[0]
    shown = labelled(upper)
    assert list(shown["best of the grid"].get_ydata()) == [0.66, 0.665]
    assert list(shown["worst survivor"].get_ydata()) == [0.61, 0.65]
    assert sorted(shown["local searches"].get_ydata()) == [0.668, 0.67]
    assert [text.get_text() for text in upper.get_xticklabels()] == ["grid 1\n81", "grid 2\n81", "local\n80"]


def test_history_shows_the_ranges_of_grid_and_survivors() -> None:
    found = search()
    figure = plotting.search_history(found)
    assert [axes.get_xlabel() for axes in figure.axes[1:]] == LABELS
    for index, axes in enumerate(figure.axes[1:]):
        bars = [(bar.get_x(), bar.get_x() + bar.get_width()) for bar in axes.patches]
        expected = []
        for entry in found.grids:
            expected += [
                (entry.axes[index][0], entry.axes[index][-1]),
                (entry.survivor_low[index], entry.survivor_high[index]),
            ]
        assert bars == [pytest.approx(pair) for pair in expected]
        stars = [line.get_xdata()[0] for line in axes.lines if line.get_marker() == "*"]
        assert stars == [*(entry.best_gains[index] for entry in found.grids), found.best.gains[index]]
    assert {"range of the grid", "range of the survivors"} <= set(legend_texts(figure))


def test_history_without_grids_is_the_convergence() -> None:
    (axes,) = plotting.search_history(search(history=())).axes
    assert axes.get_xlabel() == "gain sets evaluated"
    assert list(axes.lines[0].get_xdata()) == [81.0, 162.0, 242.0]
    assert list(axes.lines[0].get_ydata()) == [0.66, 0.665, 0.67]


def test_history_of_a_search_without_any_valid_gain_set_is_drawn() -> None:
    low, high = BOUNDS.T
    empty = grid(low, high, best=-np.inf, worst=-np.inf)
    figure = plotting.search_history(search(history=(empty,), best_value=-np.inf))
    assert not [line for axes in figure.axes[1:] for line in axes.lines if line.get_marker() == "*"]


# ---- front ------------------------------------------------------------------------------------------


def test_front_of_three_objectives_has_every_pair_with_units_and_colors_for_the_third() -> None:
    figure = plotting.pareto_front(THREE)
    panels = [axes for axes in figure.axes if axes.collections and axes.get_xlabel() and axes.get_ylabel()]
    assert [(axes.get_xlabel(), axes.get_ylabel()) for axes in panels] == [
        ("arrival time (s)", "least clearance (m)"),
        ("arrival time (s)", "energy (J)"),
        ("least clearance (m)", "energy (J)"),
    ]
    for axes, (x, y), third in zip(panels, ((0, 1), (0, 2), (1, 2)), (2, 1, 0), strict=True):
        assert np.array_equal(axes.collections[0].get_offsets(), THREE.values[:, [x, y]])
        assert np.array_equal(axes.collections[0].get_array(), THREE.values[:, third])


def test_step_line_joins_the_points_that_are_best_in_the_pair() -> None:
    axes = plotting.pareto_front(THREE).axes[0]
    line = labelled(axes)["best in the pair"]
    # The third point is slower than the first and closer to the obstacles.
    assert list(line.get_xdata()) == [6.0, 6.1, 7.4]
    assert list(line.get_ydata()) == [0.16, 0.25, 0.29]


def test_best_of_each_objective_is_marked_in_its_good_direction() -> None:
    shown = labelled(plotting.pareto_front(THREE).axes[0])
    assert shown["best arrival time"].get_xdata()[0] == 6.0
    assert shown["best least clearance"].get_ydata()[0] == 0.29
    assert shown["best energy"].get_xdata()[0] == 6.2


def test_knee_is_marked_only_where_one_is_named() -> None:
    assert "knee" not in legend_texts(plotting.pareto_front(TWO))
    figure = plotting.pareto_front(TWO, knee=1)
    assert "knee" in legend_texts(figure)
    assert labelled(figure.axes[0])["knee"].get_xdata()[0] == 6.2


def test_marks_of_a_front_lie_at_their_objectives() -> None:
    shown = labelled(plotting.pareto_front(TWO, marks={"published": (6.3, 4.4)}).axes[0])
    assert (shown["published"].get_xdata()[0], shown["published"].get_ydata()[0]) == (6.3, 4.4)


def test_four_objectives_have_six_panels() -> None:
    four = front(np.eye(4), ("arrival_time", "energy", "path_length", "min_clearance"), (False, False, False, True))
    assert len(plotting.pareto_front(four).axes) == 6


# ---- errors and side effects ------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("call", "named"),
    [
        (lambda: plotting.flatness(search()), "flatness must be a Flatness"),
        (lambda: plotting.gain_sensitivity(flat()), "sensitivity must be a GainSensitivity"),
        (lambda: plotting.search_history(flat()), "search must be a GainSearch"),
        (lambda: plotting.pareto_front(search()), "front must be a ParetoFront"),
        (lambda: plotting.pareto_front(TWO, knee=3), "knee must be None or an index from 0 to 2"),
        (lambda: plotting.pareto_front(front([], ("arrival_time", "energy"), (False, False))), "at least one gain set"),
        (lambda: plotting.pareto_front(front([[1.0]], ("energy",), (False,))), "at least two objectives"),
    ],
)
def test_what_cannot_be_drawn_is_refused(call: Any, named: str) -> None:
    with pytest.raises(InvalidParameterError, match=named):
        call()


def test_marks_of_a_front_have_one_value_for_each_objective() -> None:
    with pytest.raises(ShapeError, match="marks"):
        plotting.pareto_front(TWO, marks={"published": (6.3, 4.4, 1.0)})


def test_pictures_leave_no_trace_in_pyplot_and_render(tmp_path: Any, sensitivity: nav.gains.GainSensitivity) -> None:
    before = dict(matplotlib.rcParams)
    figures = [
        plotting.flatness(flat()),
        plotting.gain_sensitivity(sensitivity),
        plotting.search_history(search()),
        plotting.pareto_front(THREE),
    ]
    for index, figure in enumerate(figures):
        figure.savefig(tmp_path / f"{index}.png")
        assert (tmp_path / f"{index}.png").stat().st_size > 10_000
    assert dict(matplotlib.rcParams) == before


def test_result_objects_of_the_tests_have_every_field_of_the_package() -> None:
    # A field that is added must be thought of here, because pictures may need it.
    for made in (search(), flat(), THREE):
        for entry in dataclasses.fields(made):
            assert getattr(made, entry.name) is not None or entry.name == "confidence"
