"""Pictures of the skirt draw what they are given, and refuse what they cannot draw."""

from __future__ import annotations

import math

import numpy as np
import pytest
from matplotlib.collections import FillBetweenPolyCollection
from matplotlib.patches import Circle, Wedge

from hrsafety import plotting, reactive
from hrsafety.errors import InvalidParameterError


@pytest.fixture(scope="module")
def tested() -> reactive.SkirtTest:
    return reactive.skirt_test(layouts=3)


def test_ring_shows_every_sensor_its_beam_and_both_safe_distances() -> None:
    skirt = reactive.UltrasonicSkirt(triggering="printed")
    (axes,) = plotting.reactive.skirt_ring(skirt, directions=reactive.skirt.MOTION_DIRECTIONS).axes
    beams = [patch for patch in axes.patches if isinstance(patch, Wedge)]
    assert [beam.r for beam in beams] == skirt.trigger_distances.tolist()
    assert [beam.theta2 - beam.theta1 for beam in beams] == [pytest.approx(40.0)] * 9
    assert np.array([beam.center for beam in beams]) == pytest.approx(skirt.positions)
    radii = sorted(patch.radius for patch in axes.patches if isinstance(patch, Circle))
    assert radii == [pytest.approx(value) for value in (0.33, skirt.meeting_distance, 0.666)]
    words = {text.get_text() for text in axes.texts}
    assert {str(number) for number in range(1, 10)} | set(reactive.skirt.MOTION_DIRECTIONS) <= words


def test_ring_without_a_meeting_distance_draws_the_one_in_use() -> None:
    figure = plotting.reactive.skirt_ring(reactive.UltrasonicSkirt(sensors=4, layout="even"), title="four")
    names = [text.get_text() for text in figure.legends[0].get_texts()]
    assert [name for name in names if name.startswith("safe distance")] == ["safe distance in use, 0.666 m"]
    assert len(names) == 3, "the sensors and the beams have a name, too"


def test_runs_show_path_discs_and_the_ending() -> None:
    scene = reactive.SkirtScene(unseen_share=1.0)
    runs = {"seen": reactive.skirt_run(), "blind": reactive.skirt_run(scene=scene)}
    seen, blind = plotting.reactive.skirt_runs(runs, title="two runs").axes
    for axes, run in ((seen, runs["seen"]), (blind, runs["blind"])):
        path = axes.lines[0].get_xydata()
        assert np.array_equal(path[1:], run.position)
        centers = [patch.center for patch in axes.patches if isinstance(patch, Circle)][: len(run.disc_center)]
        assert np.array_equal(centers, run.disc_center)
    assert "least clearance" in seen.get_title()
    assert "contact at" in blind.get_title()


def test_more_runs_than_columns_leave_empty_panels_without_axes() -> None:
    runs = {f"run {k}": reactive.skirt_run(repeat=k) for k in range(4)}
    figure = plotting.reactive.skirt_runs(runs)
    assert [axes.axison for axes in figure.axes] == [True] * 4


def test_curve_is_the_share_of_the_tests_over_the_limit(tested: reactive.SkirtTest) -> None:
    (axes,) = plotting.reactive.skirt_clearances({"ideal": tested}, most=0.3, printed=0.775).axes
    limits, shares = axes.lines[0].get_data()
    expected = [float(np.mean(~tested.collided & (tested.min_clearance >= limit))) for limit in limits]
    assert np.asarray(shares) == pytest.approx(expected, abs=1e-15)
    assert axes.lines[1].get_ydata()[0] == 0.775
    assert any(isinstance(band, FillBetweenPolyCollection) for band in axes.collections)


def test_sensor_counts_show_every_share_the_limit_and_what_is_enough() -> None:
    enough = reactive.smallest_skirt(0.3, counts=[5, 12], layouts=3)
    none = reactive.smallest_skirt(0.3, counts=[5, 12], layouts=3, speed=0.8)
    figure = plotting.reactive.skirt_sensor_counts([enough, none], title="counts")
    words = [text.get_text() for text in figure.legends[0].get_texts()]
    assert any("12 are enough" in word for word in words)
    assert any("none is enough" in word for word in words)
    assert any("limit 0.3" in word for word in words)
    assert figure.axes[0].get_xticks().tolist() == [5, 12]


def test_what_cannot_be_drawn_is_refused(tested: reactive.SkirtTest) -> None:
    for call in (
        lambda: plotting.reactive.skirt_runs({}),
        lambda: plotting.reactive.skirt_clearances({}),
        lambda: plotting.reactive.skirt_clearances({"a": tested}, most=0.0),
        lambda: plotting.reactive.skirt_clearances({"a": tested}, most=math.inf),
        lambda: plotting.reactive.skirt_sensor_counts([]),
    ):
        with pytest.raises(InvalidParameterError):
            call()
