"""Pictures of contacts: what is drawn is what was given."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from api import contact_calls
from hrsafety import contact, plotting, standards
from hrsafety.errors import InvalidParameterError, ShapeError

PAD = contact.Covering(material=contact.Linear(modulus=2e5), thickness=0.02, area=4e-3)
pictures = plotting.contacts


def test_forces_over_time_are_those_of_the_collisions() -> None:
    hits = {
        name: contact_calls.simulate(robot_mass=8.0, closing_speed=0.3, region=75e3, covering=covering)
        for name, covering in (("bare $1", None), ("pad", PAD))
    }
    axes = pictures.contact_forces(hits, limits={"clamped": 140.0, "far": 1e6}).axes[0]
    for line, hit in zip(axes.lines, hits.values(), strict=False):
        assert np.array_equal(line.get_xdata(), 1e3 * hit.time)
        assert np.array_equal(line.get_ydata(), hit.force)
    drawn = [text.get_text() for text in axes.texts]
    assert drawn == ["limit clamped: 140 N"]
    assert [text.get_text() for text in axes.get_legend().get_texts()] == [r"bare \$1", "pad"]
    with pytest.raises(InvalidParameterError, match="at least one collision"):
        pictures.contact_forces({})


def test_warnings_of_collisions_stand_below() -> None:
    early = contact_calls.simulate(robot_mass=100.0, closing_speed=0.5, region=1e3)
    figure = pictures.contact_forces({"heavy": early})
    assert any("longer horizon" in text.get_text().replace("\n", " ") for text in figure.texts)


def test_forces_over_speed() -> None:
    speeds = np.array([0.1, 0.2, 0.3])
    axes = pictures.forces_over_speed(speeds, {"bare": 100.0 * speeds}, planned=0.25).axes[0]
    assert axes.lines[0].get_ydata().tolist() == (100.0 * speeds).tolist()
    assert axes.lines[1].get_xdata()[0] == 0.25
    with pytest.raises(ShapeError):
        pictures.forces_over_speed(speeds, {"bare": [1.0]})


def test_the_map_marks_the_wanted_speed_and_the_own_covering() -> None:
    table = np.array([[0.2, 0.3], [0.4, np.nan]])
    figure = pictures.speed_map([0.01, 0.02], [1e5, 2e5], table, wanted=0.35, own=(0.01, 1e5))
    axes, bar = figure.axes
    assert axes.collections[0].get_array().compressed().tolist() == [0.2, 0.3, 0.4]
    assert bar.lines[-1].get_ydata()[0] == 0.35
    assert axes.lines[0].get_xydata().tolist() == [[1e5, 10.0]]
    with pytest.raises(ShapeError):
        pictures.speed_map([0.01], [1e5, 2e5], table)


@pytest.mark.parametrize(("contact_speed", "words"), [(0.25, "contact allowed"), (None, "contact not permitted")])
def test_modes_of_the_speed_over_the_distance(contact_speed: float | None, words: str) -> None:
    curve = standards.speed_over_distance(
        np.linspace(0.0, 5.0, 51), contact_speed=contact_speed, max_speed=1.5, reaction_time=0.1, deceleration=3.0
    )
    axes = pictures.speed_over_distance(curve).axes[0]
    labels = [text.get_text() for text in axes.get_legend().get_texts()]
    assert labels[0].startswith(words)
    assert labels[1:] == ["stop before contact", "largest speed of the robot"]
    drawn = np.nanmax([line.get_ydata() for line in axes.lines], axis=0)
    assert drawn.tolist() == curve.speed.tolist()


def test_bars_are_ranked_with_the_largest_on_top() -> None:
    axes = pictures.contact_sensitivity({"force_limit": 1.0, "robot_mass": -0.5}).axes[0]
    assert [bar.get_width() for bar in axes.patches] == [-0.5, 1.0]
    assert [label.get_text() for label in axes.get_yticklabels()] == ["robot mass", "force limit"]
    with pytest.raises(InvalidParameterError, match="at least one sensitivity"):
        pictures.contact_sensitivity({})
