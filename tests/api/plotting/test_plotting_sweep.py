"""Pictures of sweeps: what they show, and what they refuse."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, impact, plotting, scenarios, sweep
from hrsafety.plotting.sweeps.overviews import _thinned

IMPACT = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25})
STIFFNESS = sweep.Axis(name="foam_stiffness", low=5e3, high=6e4, points=6, scale="log")
DAMPING = sweep.Axis(name="foam_damping", low=0.0, high=150.0, points=5)
MAP = sweep.run(sweep.Grid([STIFFNESS, DAMPING]), IMPACT)
LINE = sweep.run(sweep.Grid([STIFFNESS, sweep.Axis(name="foam_damping", values=[50.0])]), IMPACT)
SCENES = sweep.NavigationStudy(scenarios={name: scenarios.configuration(name) for name in ("c1", "c2", "c3", "c4")})
GAINS = [sweep.Axis(name="detour_gain", low=10.0, high=200.0), sweep.Axis(name="gain_ratio", low=0.2, high=0.9)]
RUNS = sweep.run(sweep.LatinHypercube(GAINS, 12), SCENES)


def test_line_holds_the_numbers_of_the_column() -> None:
    axes = plotting.sweep_lines(LINE, "hic15").axes[0]
    np.testing.assert_array_equal(axes.lines[0].get_xdata(), STIFFNESS.levels())
    np.testing.assert_array_equal(axes.lines[0].get_ydata(), LINE["hic15"])
    assert axes.get_xscale() == "log"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("foam stiffness (N/m)", "hic15")


def test_lines_are_sorted_and_named_by_case() -> None:
    result = sweep.run(sweep.LatinHypercube(GAINS[:1], 9), SCENES)
    figure = plotting.sweep_lines(result, "energy")
    axes = figure.axes[0]
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["c1", "c2", "c3", "c4"]
    x = np.asarray(axes.lines[1].get_xdata())
    assert (np.diff(x) > 0).all()
    by_gain = {gain: value for gain, value in zip(result["detour_gain"][1::4], result["energy"][1::4], strict=True)}
    np.testing.assert_array_equal(axes.lines[1].get_ydata(), [by_gain[gain] for gain in x])


def test_map_holds_the_numbers_of_the_column() -> None:
    figure = plotting.sweep_map(MAP, "max_compression")
    mesh = figure.axes[0].collections[0]
    np.testing.assert_array_equal(mesh.get_array(), MAP["max_compression"].reshape(6, 5).T)
    assert figure.axes[-1].get_ylabel() == "max compression (m)"


def test_map_has_a_panel_for_each_case_and_the_mean_of_many() -> None:
    grid = [sweep.Axis(name=axis.name, low=axis.low, high=axis.high, points=3) for axis in GAINS]
    figure = plotting.sweep_map(sweep.run(sweep.Grid(grid), SCENES), "performance_total")
    assert [axes.get_title() for axes in figure.axes[:-1]] == ["c1", "c2", "c3", "c4"]
    many = sweep.NavigationStudy(scenarios=[scenarios.configuration("c1")] * 7)
    result = sweep.run(sweep.Grid(grid), many)
    figure = plotting.sweep_map(result, "performance_total")
    assert [axes.get_title() for axes in figure.axes[:-1]] == ["mean of 7 cases"]
    one = result["performance_total"].reshape(3, 3, 7)[:, :, 0]
    np.testing.assert_allclose(figure.axes[0].collections[0].get_array(), one.T, rtol=1e-12)


def test_points_show_every_row_in_every_panel() -> None:
    figure = plotting.sweep_scatter(RUNS, "min_clearance")
    for axes, axis in zip(figure.axes, RUNS.axes, strict=True):
        assert axes.get_xlabel() == axis.label
        for index, points in enumerate(axes.collections):
            expected = np.column_stack([RUNS[axis.name][index::4], RUNS["min_clearance"][index::4]])
            np.testing.assert_array_equal(points.get_offsets(), expected)
        assert len(axes.collections) == 4


def test_parallel_axes_show_a_line_for_each_row() -> None:
    figure = plotting.sweep_parallel(RUNS, "energy")
    lines = figure.axes[0].collections[0]
    values = RUNS["energy"].reshape(12, 4).mean(axis=1)
    np.testing.assert_array_equal(lines.get_array(), np.sort(values))
    assert len(lines.get_segments()) == 12
    heights = np.array(lines.get_segments())[:, :, 1]
    assert heights.min() >= 0.0
    assert heights.max() <= 1.0


def test_long_results_are_thinned_over_all_levels() -> None:
    axes = [sweep.Axis(name="foam_stiffness", low=5e3, high=6e4, points=100), DAMPING]
    result = sweep.run(sweep.Grid(axes), IMPACT, chunk_rows=70)
    points = _thinned(result, ["foam_damping", "hic15"], 100)
    assert 50 < len(points["hic15"]) < 160
    assert len(np.unique(points["foam_damping"])) == 5
    for draw in (plotting.sweep_scatter, plotting.sweep_parallel):
        words = [axes.get_ylabel() for axes in draw(result, "hic15", most=100).axes]
        assert any(f" drawn of {len(result):,}" in each for each in words)
        words = [axes.get_ylabel() for axes in draw(result, "hic15", most=100_000).axes]
        assert not any("drawn of" in each for each in words)
    again = _thinned(result, ["foam_damping", "hic15"], 100)
    np.testing.assert_array_equal(points["hic15"], again["hic15"])


def test_values_that_are_not_drawn_are_counted() -> None:
    study = sweep.FunctionStudy(
        function=lambda a, b: {"y": np.where(a % 3 == 0, np.nan, a + b), "z": a},
        results=[sweep.Column(name="y"), sweep.Column(name="z")],
    )
    sizes = (("a", 6), ("b", 6), ("b", 1))
    first, second, one = (sweep.Axis(name=name, unit="m", values=[*range(size)]) for name, size in sizes)
    line, plane = (sweep.run(sweep.Grid([first, each]), study) for each in (one, second))
    pictures = [(plotting.sweep_lines, line, "2 of 6")]
    pictures += [(draw, plane, "12 of 36") for draw in (plotting.sweep_map, plotting.sweep_scatter)]
    for draw, result, words in (*pictures, (plotting.sweep_parallel, plane, "12 of 36")):
        said = [axes.get_ylabel() for axes in draw(result, "y").axes]
        assert any(each.endswith(f"\n{words} without value") for each in said)
        assert not any("without value" in axes.get_ylabel() for axes in draw(result, "z").axes)


@pytest.mark.parametrize(
    ("draw", "result", "column", "words"),
    [
        (plotting.sweep_lines, LINE, "status", "column must be one of"),
        (plotting.sweep_lines, LINE, "foam_stiffness", "column must be one of"),
        (plotting.sweep_lines, MAP, "hic15", "result must vary one axis"),
        (plotting.sweep_lines, 3, "hic15", "result must be a SweepResult"),
        (plotting.sweep_map, LINE, "hic15", "result must vary 2 axes.*draw sweep_scatter or sweep_parallel"),
        (plotting.sweep_map, RUNS, "energy", "result must be a complete grid"),
        (plotting.sweep_scatter, RUNS, "outcome", "column must be one of"),
        (plotting.sweep_parallel, RUNS, 3, "column must be one of"),
    ],
)
def test_what_cannot_be_drawn_is_refused(draw: Any, result: Any, column: Any, words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        draw(result, column)


def test_number_of_points_must_be_one() -> None:
    with pytest.raises(InvalidParameterError, match="most must be an integer"):
        plotting.sweep_scatter(RUNS, "energy", most=0)


def test_many_values_of_one_case_are_a_density() -> None:
    design = sweep.LatinHypercube([sweep.Axis(name="foam_stiffness", low=5e3, high=60e3)], 3000)
    study = sweep.ImpactStudy(
        manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25, "foam_damping": 80}
    )
    panel, bar = plotting.sweep_scatter(sweep.run(design, study), "hic15").axes
    (cells,) = panel.collections
    assert cells.get_array().sum() == 3000
    assert bar.get_ylabel() == "rows"


@pytest.mark.parametrize("value", [0.0, -0.0, 0.3, 1234.5])
def test_a_constant_quantity_has_one_number_on_its_scale(value: float) -> None:
    study = sweep.FunctionStudy(function=lambda x, z: {"y": 0.0 * x * z + value}, results=["y"])
    one = sweep.run(
        sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=5), sweep.Axis(name="z", values=[1.0])]), study
    )
    for points in (5, 60):
        axes = [sweep.Axis(name=name, low=0.0, high=1.0, points=points) for name in "xz"]
        two = sweep.run(sweep.Grid(axes), study)
        scales = [
            plotting.sweep_lines(one, "y").axes[0],
            plotting.sweep_map(two, "y").axes[-1],
            plotting.sweep_scatter(two, "y").axes[0],
            plotting.sweep_parallel(two, "y").axes[-1],
        ]
        for scale in scales:
            assert [each.get_text() for each in scale.get_yticklabels()] == [f"{abs(value):g}"]


def test_a_quantity_that_hardly_varies_keeps_its_scale() -> None:
    study = sweep.FunctionStudy(function=lambda x: {"y": 1.0 + 1e-6 * x}, results=["y"])
    result = sweep.run(sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=5)]), study)
    assert len(plotting.sweep_lines(result, "y").axes[0].get_yticks()) > 2
