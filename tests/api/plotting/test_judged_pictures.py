"""Pictures of judged logs tell who is not in them and where the map is unknown."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from matplotlib.colors import to_rgba

from hrsafety import datasets, plotting
from hrsafety import navigation as nav
from hrsafety.plotting import walls

TIME = np.arange(81) / 10


def judged(lanes: dict[str, float], **given: Any) -> nav.metrics.Judgement:
    """Return a judged log of a robot on the x axis, and people who walk toward it at some distance."""
    ways = np.stack([np.stack([8.0 - TIME, 0.0 * TIME + lane], axis=1) for lane in lanes.values()], axis=1)
    people = datasets.Recording(
        time_s=np.repeat(TIME, len(lanes)), person=list(lanes) * len(TIME), position=ways.reshape(-1, 2)
    )
    straight = np.stack([0.5 * TIME, 0.0 * TIME], axis=1)
    log = SimpleNamespace(time=TIME, position=straight, heading=0.0 * TIME, people=people)
    return nav.metrics.judge(log, robot_radius=0.3, **given)


def entries(figure: Any) -> list[str]:
    found = [text.get_text() for legend in figure.legends for text in legend.get_texts()]
    plt.close(figure)
    return found


@pytest.mark.parametrize(
    ("lanes", "label"),
    [
        ({"a": 0.9, "b": 1.5}, "people"),
        ({"a": 0.9, "b": 30.0, "c": -40.0}, "people (2 of 3 are not shown)"),
        ({f"p{k}": 0.9 + 0.01 * k for k in range(43)}, "people (3 of 43 are not shown)"),
    ],
    ids=["all", "far", "many"],
)
def test_people_who_are_not_in_the_picture_are_counted(lanes: dict[str, float], label: str) -> None:
    assert label in entries(plotting.runs.judged_way(judged(lanes)))


def test_people_who_are_in_no_panel_are_counted() -> None:
    assert "people" in entries(plotting.runs.worst_moments(judged({"a": 0.9, "b": 1.5})))
    assert "people (1 of 2 are not shown)" in entries(plotting.runs.worst_moments(judged({"a": 0.9, "b": 30.0})))


@pytest.mark.parametrize("unknown", [True, False])
def test_unknown_cells_are_drawn_as_unknown(unknown: bool) -> None:
    free = np.zeros((40, 60), dtype=np.bool_)
    unseen = free.copy()
    unseen[:, 40:] = unknown
    cells = nav.maps.parts.Cells(
        np.packbits(free).tobytes(), free.shape, 0.2, (-2.0, -4.0), 0.0, True, np.packbits(unseen).tobytes()
    )
    figure = plotting.runs.judged_way(judged({"a": 0.9}, map=nav.StaticMap(grids=[cells])))
    (axes,) = figure.axes
    pictures = [np.asarray(image.get_array()) for image in axes.images]
    drawn = [each for each in pictures if np.allclose(each[10, 50], to_rgba(walls.UNKNOWN))]
    assert len(drawn) == unknown
    assert all(each[10, 10, 3] == 0.0 for each in pictures)
    assert ("unknown" in entries(figure)) == unknown
