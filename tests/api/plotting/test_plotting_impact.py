"""Pictures of impacts draw what they are given, and refuse what they cannot draw."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import matplotlib
import numpy as np
import pytest

from hrsafety import impact, plotting
from hrsafety.errors import InvalidParameterError, ShapeError

SETTING: dict[str, Any] = {"closing_speed": 1.25, "step": 1e-4}
DAMPING = np.linspace(0.0, 345.0, 24)


@pytest.fixture(scope="module")
def run() -> impact.ImpactResponse:
    return impact.simulate(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), **SETTING)


@pytest.fixture(scope="module")
def constrained() -> impact.ImpactResponse:
    return impact.simulate(impact.MANIPULATOR_1, impact.FOAM_1, impact.ConstrainedHead(), **SETTING)


@pytest.fixture(scope="module")
def design() -> impact.FoamDesign:
    return impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.25)


def boundary(stiffness: list[float], status: list[str], holds: bool = False) -> Any:
    flags = np.full(len(stiffness), holds)
    return SimpleNamespace(stiffness=np.array(stiffness), status=np.array(status), holds_below=flags, holds_above=flags)


def test_histories_show_the_response_in_the_unit_of_the_axis(run: impact.ImpactResponse) -> None:
    figure = plotting.impact_histories(run, quantities=["head_acceleration", "compression"], peaks=[0])
    acceleration, compression = figure.axes
    line = acceleration.lines[0]
    assert np.array_equal(line.get_xdata(), 1000.0 * run.time)
    assert line.get_ydata() == pytest.approx(run.head_acceleration / 9.80665)
    assert np.max(compression.lines[0].get_ydata()) == pytest.approx(1000.0 * run.compression.max())


def test_asterisk_stands_on_the_peak_within_the_impact_period(run: impact.ImpactResponse) -> None:
    figure = plotting.impact_histories(run, quantities=["contact_force"], peaks=[0])
    star = next(line for line in figure.axes[0].lines if line.get_marker() == "*")
    assert star.get_ydata()[0] == pytest.approx(run.metrics.peak_contact_force, rel=1e-4)
    assert star.get_xdata()[0] < 1000.0 * run.metrics.impact_duration


def test_constrained_head_has_no_acceleration_to_draw(
    run: impact.ImpactResponse, constrained: impact.ImpactResponse
) -> None:
    figure = plotting.impact_histories([run, constrained], labels=["free", "held"])
    force, acceleration = figure.axes
    assert [line.get_label() for line in force.lines if not str(line.get_label()).startswith("_")] == ["free", "held"]
    assert [line.get_label() for line in acceleration.lines if not str(line.get_label()).startswith("_")] == ["free"]
    with pytest.raises(InvalidParameterError, match="response must have a head that moves"):
        plotting.measured_impact(
            constrained, peak_head_acceleration_g=[1.0], impact_duration=[0.03], max_compression=[0.01]
        )


def test_measured_peaks_stand_at_their_values(run: impact.ImpactResponse) -> None:
    figure = plotting.measured_impact(
        run, peak_head_acceleration_g=[6.0, 6.2], impact_duration=[0.040, 0.045], max_compression=[0.011, 0.012]
    )
    left, right = figure.axes
    circles = [line for axes in (left, right) for line in axes.lines if line.get_marker() == "o"]
    assert [list(line.get_ydata()) for line in circles] == [[6.0, 6.2], [11.0, 12.0]]
    ends = next(line for line in left.lines if line.get_marker() == "|")
    assert list(ends.get_xdata()) == [40.0, 45.0]


def test_study_draws_one_line_for_each_case_and_the_limit() -> None:
    figure = plotting.impact_study(
        [1.0, 10.0, 100.0],
        {"a": [1.0, 2.0, 3.0], "b": [2.0, np.nan, 5.0]},
        parameter="stiffness (kN/m)",
        limit=4.0,
        marks={"best": (10.0, 2.0)},
        log_parameter=True,
    )
    (axes,) = figure.axes
    assert axes.get_xscale() == "log"
    assert [line.get_label() for line in axes.lines][:3] == ["a", "b", "limit 4"]
    assert axes.get_xlabel() == "stiffness (kN/m)"


def test_boundaries_mark_foams_by_their_verdict(design: impact.FoamDesign) -> None:
    foams = {"Foam 1": impact.FOAM_1, "Foam 2": impact.FOAM_2, "new": impact.FOAM_3}
    accepted = {"Foam 1": True, "Foam 2": False}
    figure = plotting.foam_boundaries(
        DAMPING, design.upper(DAMPING), design.lower(DAMPING), foams=foams, accepted=accepted
    )
    (axes,) = figure.axes
    markers = {line.get_ydata()[0]: line.get_marker() for line in axes.lines if len(line.get_xdata()) == 1}
    assert markers == {24.3: "o", 13.8: "X", 60.6: "o"}
    assert [text.get_text() for text in axes.texts] == ["Foam 1: fits", "Foam 2: does not fit", "new"]


def test_each_meaning_of_a_boundary_has_its_own_line() -> None:
    lower = boundary([1e4, 9e3, 8e3, 7e3], ["local_maximum", "end_of_impact_period", "jump", "jump"])
    upper = boundary([4e4] * 4, ["local_maximum"] * 4)
    (axes,) = plotting.foam_boundaries([0.0, 50.0, 100.0, 150.0], upper, lower).axes
    labels = [str(line.get_label()) for line in axes.lines]
    assert labels == [
        "upper: head acceleration",
        "lower: compression",
        "lower: compression, at the end of the impact period",
        "lower: compression, a jump of the impact period",
    ]
    assert len({line.get_linestyle() for line in axes.lines[1:]}) >= 2


def test_curve_has_a_gap_where_there_is_no_boundary() -> None:
    upper = boundary([4e4, np.nan, np.nan], ["local_maximum", "none", "none"])
    (axes,) = plotting.foam_boundaries([0.0, 50.0, 100.0], upper, boundary([1e4] * 3, ["local_maximum"] * 3)).axes
    drawn = axes.lines[0].get_ydata()
    assert np.isfinite(drawn[0])
    assert np.isnan(drawn[1:]).all()


@pytest.mark.parametrize("side", ["upper", "lower"])
def test_one_boundary_alone_can_be_drawn(side: str, design: impact.FoamDesign) -> None:
    upper = design.upper(DAMPING) if side == "upper" else None
    lower = design.lower(DAMPING) if side == "lower" else None
    (axes,) = plotting.foam_boundaries(DAMPING, upper, lower).axes
    assert all(str(line.get_label()).startswith(side) for line in axes.lines if line.get_label()[0] != "_")


def test_map_has_a_line_at_the_limit_and_the_foams() -> None:
    damping, stiffness = np.linspace(0.0, 200.0, 12), np.linspace(5e3, 80e3, 15)
    grid = impact.metrics_batch(
        manipulator=impact.MANIPULATOR_2,
        head=impact.Head.minimum(),
        foam_stiffness=stiffness[:, None],
        foam_damping=damping[None, :],
        linear_range=0.02,
        closing_speed=1.25,
    )
    figure = plotting.foam_map(
        damping,
        stiffness,
        grid.peak_head_acceleration_g,
        quantity="peak head acceleration (g)",
        limit=10.0,
        foams={"Foam 1": impact.FOAM_1},
    )
    axes, bar = figure.axes
    assert bar.get_ylabel() == "peak head acceleration (g)"
    assert [text.get_text() for text in axes.texts] == ["Foam 1"]


def test_bad_input_is_named(run: impact.ImpactResponse) -> None:
    for call, words in (
        (lambda: plotting.impact_histories([]), "responses must hold at least one"),
        (lambda: plotting.impact_histories([1.0]), r"responses\[0\] must be an ImpactResponse, got float"),
        (lambda: plotting.impact_histories(run, labels=["a", "b"]), "labels must be 1 strings"),
        (lambda: plotting.impact_histories(run, quantities=["force"]), "quantities must be among contact_force"),
        (lambda: plotting.impact_histories(run, quantities="contact_force"), "quantities must be a sequence"),
        (lambda: plotting.impact_histories(run, peaks=[1]), "peaks must hold indices from 0 to 0"),
        (lambda: plotting.impact_study([1.0], {}, parameter="x"), "curves must hold at least one curve"),
        (lambda: plotting.foam_boundaries([1.0, 0.0], None, None), "damping must rise"),
    ):
        with pytest.raises(InvalidParameterError, match=words):
            call()
    for call, words in (
        (lambda: plotting.impact_study([1.0, 2.0], {"a": [1.0]}, parameter="x"), r"curves\['a'\] must have shape"),
        (lambda: plotting.foam_boundaries(DAMPING, boundary([1.0], ["none"]), None), "upper.stiffness must have shape"),
        (lambda: plotting.foam_map([0.0, 1.0], [1.0, 2.0], [[1.0]], quantity="x"), "value must have shape"),
    ):
        with pytest.raises(ShapeError, match=words):
            call()


def test_pictures_leave_the_settings_of_matplotlib_alone(run: impact.ImpactResponse) -> None:
    before = dict(matplotlib.rcParams)
    plotting.impact_histories(run)
    assert dict(matplotlib.rcParams) == before
