"""What all pictures of paths share: panels of equal scale, labels at the edges, one drawer of paths."""

from __future__ import annotations

import ast
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety.plotting import floor

LIMITS = ((-1.0, 3.0), (0.0, 2.0))
# Pictures of the floor; a figure of their own kind would leave the shared panels.
PICTURES = {
    "scenes",
    "law_runs",
    "sequences",
    "tracking",
    "repeated",
    "layouts",
    "follower",
    "skirt",
    "instants",
    "paths",
}


def test_panels_have_equal_scales_and_labels_where_nothing_lies_below() -> None:
    figure, panels = floor.panels(LIMITS, titles=["a", "b", "c"], columns=2, entries=2)
    assert len(figure.axes) == len(panels) == 3
    assert [axes.get_title() for axes in panels] == ["a", "b", "c"]
    for axes in panels:
        assert axes.get_aspect() == 1.0
        assert (axes.get_xlim(), axes.get_ylim()) == LIMITS
    assert [axes.get_xlabel() for axes in panels] == ["", "x (m)", "x (m)"]
    assert [axes.get_ylabel() for axes in panels] == ["y (m)", "", "y (m)"]


def test_only_titles_of_two_lines_are_small() -> None:
    _, (usual, small) = floor.panels(LIMITS, titles=["a", "a\nb"], columns=2, entries=0)
    plain = usual.figure.add_subplot().set_title("a").get_fontsize()
    assert usual.title.get_fontsize() == plain > small.title.get_fontsize()


def test_figure_grows_with_rows_and_legend() -> None:
    def height(number: int, entries: int) -> float:
        figure, _ = floor.panels(LIMITS, titles=["t"] * number, columns=2, entries=entries)
        return float(figure.get_figheight())

    assert height(4, 4) > height(2, 4)
    assert height(2, 5) > height(2, 4) == height(2, 3)


def test_path_has_its_contacts_directions_and_an_end_where_it_did_not_arrive() -> None:
    scene = scenarios.configuration("c2")
    run = nav.simulate(scene, nav.GeCui())
    _, (axes,) = floor.panels(LIMITS, entries=1)
    floor.events(axes, run, {"color": "black"})
    path, *marks = axes.lines
    assert np.array_equal(np.column_stack(path.get_data()), run.position)
    crosses = [mark for mark in marks if mark.get_marker() == "X"]
    assert len(crosses) == np.isfinite(run.contact_time).sum() == 1
    squares = [mark for mark in marks if mark.get_marker() == "s"]
    assert len(squares) == (not np.isfinite(run.arrival_time))


def test_disc_has_a_faint_face_and_an_edge() -> None:
    _, (axes,) = floor.panels(LIMITS, entries=1)
    floor.disc(axes, (1.0, 0.5), 0.25, "red", strength=0.5, face=0.4)
    face, edge = axes.patches
    assert (face.get_alpha(), edge.get_alpha()) == (pytest.approx(0.2), 0.5)
    assert face.get_fill()
    assert not edge.get_fill()


@pytest.mark.parametrize("name", sorted(PICTURES))
def test_every_picture_of_the_floor_stands_on_the_shared_panels(name: str) -> None:
    (path,) = Path(plotting.__file__).parent.rglob(f"{name}.py")
    calls = {
        ast.unparse(node.func)
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, ast.Call)
    }
    assert {"floor.panels", "floor.finish"} <= calls
    assert "style.scene_height" not in calls
