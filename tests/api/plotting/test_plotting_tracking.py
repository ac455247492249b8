"""Pictures of tracking draw the runs they are given, and refuse what they cannot draw."""

from __future__ import annotations

import math
from typing import Any

import matplotlib.colors
import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.errors import InvalidParameterError

STILL = nav.tracking.LineReference(start=(0.0, 0.0))
CIRCLE = nav.tracking.CircleReference(center=(0.0, 0.0), radius=1.0, speed=0.5)


@pytest.fixture(scope="module")
def run() -> nav.Trajectory:
    return nav.tracking.track(CIRCLE, position=(0.2, -0.4), heading=3.0, duration=9.0)


@pytest.fixture(scope="module")
def parked() -> list[nav.Trajectory]:
    law = nav.tracking.ExponentialTracking()
    places = [(math.cos(angle), math.sin(angle)) for angle in (0.3, 2.0, 4.1)]
    return [nav.tracking.track(STILL, law, position=place, duration=15.0, goal=(0.0, 0.0)) for place in places]


def test_paths_are_drawn_with_their_references(run: nav.Trajectory) -> None:
    axes = plotting.robots.tracking_paths(run).axes[0]
    drawn = [np.column_stack([line.get_xdata(), line.get_ydata()]) for line in axes.lines]
    assert any(np.array_equal(line, run.position) for line in drawn)
    assert any(np.array_equal(line, run.reference_position) for line in drawn)
    assert axes.get_aspect() == 1.0


def test_arrow_points_along_the_heading_at_the_start(run: nav.Trajectory) -> None:
    (arrow,) = plotting.robots.tracking_paths(run).axes[0].texts
    tip: Any = arrow
    direction = np.array(tip.xy) - np.array(tip.xyann)
    assert math.atan2(direction[1], direction[0]) == pytest.approx(3.0)


def test_a_reference_that_stands_is_a_cross(parked: list[nav.Trajectory]) -> None:
    figure = plotting.robots.tracking_paths(parked, labels=["one", "two", "three"])
    assert [line.get_marker() for line in figure.axes[0].lines].count("x") == 3
    names = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    assert names == ["one", "two", "three", "reference", "start"]


def test_groups_share_a_color(run: nav.Trajectory, parked: list[nav.tracking.TrackingRun]) -> None:
    axes = plotting.robots.tracking_errors([parked, [run]], labels=["parked", "followed"]).axes[0]
    colors = [matplotlib.colors.to_hex(line.get_color()) for line in axes.lines]
    assert len(set(colors[:3])) == 1
    assert colors[3] != colors[0]


def test_errors_are_logarithmic_with_a_rate(parked: list[nav.Trajectory]) -> None:
    axes = plotting.robots.tracking_errors(parked, rate=0.5).axes[0]
    assert axes.get_yscale() == "log"
    assert axes.lines[0].get_ydata() == pytest.approx(parked[0].error)
    time, bound = (np.asarray(values) for values in (axes.lines[-1].get_xdata(), axes.lines[-1].get_ydata()))
    assert math.log(bound[0] / bound[-1]) == pytest.approx(0.5 * (time[-1] - time[0]))


def test_error_of_rounding_leaves_a_gap() -> None:
    on_it = nav.tracking.track(STILL, position=(0.0, 0.0), duration=3.0)
    axes = plotting.robots.tracking_errors(on_it).axes[0]
    assert np.isnan(axes.lines[0].get_ydata()).all()


@pytest.mark.parametrize("draw", [plotting.robots.tracking_paths, plotting.robots.tracking_errors])
@pytest.mark.parametrize("runs", [[], [[]], "run", 3, [1], [["run"]]])
def test_what_cannot_be_drawn_is_refused(draw: Any, runs: Any) -> None:
    with pytest.raises(InvalidParameterError, match="runs"):
        draw(runs)


def test_labels_and_rate_are_checked(run: nav.Trajectory) -> None:
    with pytest.raises(InvalidParameterError, match="labels"):
        plotting.robots.tracking_paths(run, labels=["a", "b"])
    with pytest.raises(InvalidParameterError, match="rate"):
        plotting.robots.tracking_errors(run, rate=0.0)
