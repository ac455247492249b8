"""Doubts about what is drawn stand below every picture, whatever the picture is of."""

from __future__ import annotations

import ast
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from matplotlib.figure import Figure

from hrsafety import contact, plotting, standards
from hrsafety import navigation as nav
from hrsafety.plausibility import ResultWarning
from hrsafety.plotting import notes, style

PLOTTING = Path(plotting.__file__).parent

DOUBT = ResultWarning("edge", "x", "a doubt that nobody may overlook")


class Carrier:
    warnings = (DOUBT,)


def note(figure: Figure) -> str:
    return " ".join(text.get_text() for text in figure.texts).replace("\n", " ")


@notes.picture
def inner(given: Any, *, more: Any = None) -> Figure:  # noqa: ARG001  # their doubts are shown
    return style.new_figure(2.0)


@notes.picture
def outer(given: Any) -> Figure:
    return inner(given)


@pytest.mark.parametrize("given", [Carrier(), [Carrier()], {"a": (Carrier(), Carrier())}])
def test_doubts_of_arguments_are_written_once(given: Any) -> None:
    for figure in (inner(given), inner(None, more=given), outer(given)):
        assert note(figure).count("a doubt that nobody may overlook") == 1
    assert note(inner([1.0, "words", np.ones(3)])) == ""


def test_speeds_over_the_distance_show_their_doubts() -> None:
    curve = standards.speed_over_distance(
        np.linspace(0.0, 2.0, 5), contact_speed=0.2, max_speed=1.0, reaction_time=0.1, deceleration=2.0
    )
    assert curve.warnings
    assert curve.warnings[0].message.split(":")[0][:30] in note(plotting.contacts.speed_over_distance(curve))
    assert note(plotting.contacts.speed_over_distance(replace(curve, warnings=()))) == ""


def test_loads_show_the_doubts_of_collisions() -> None:
    hit = contact.Contact(robot=8e5, body=0.6, region=75e3).simulate(0.3)
    assert hit.warnings
    assert "robot_mass" in note(plotting.contacts.contact_forces({"bare": hit}))


def test_every_public_picture_is_drawn_by_the_one_preamble() -> None:
    missing = []
    for path in PLOTTING.rglob("*.py"):
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            drawn = isinstance(node, ast.FunctionDef) and node.returns is not None
            if drawn and ast.unparse(node.returns) == "Figure" and node.name in getattr(plotting, "__all__", ()):
                decorators = [ast.unparse(each) for each in node.decorator_list]
                if decorators != ["notes.picture"]:
                    missing.append(f"{path.name}: {node.name}")
    assert missing == []


def test_a_robot_run_shows_the_doubts_of_its_scenario() -> None:
    walker = nav.Human(start=(-8.0, 0.6), velocity=(9.0, 0.0), max_speed=9.0, critical_radius=0.8, active_radius=2.1)
    scenario = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[walker])
    run = nav.simulate(scenario, nav.VirtualForceField())
    assert run.warnings
    for draw in (plotting.paths, plotting.distances, plotting.energy):
        assert "critical_radius of obstacles[0] (Human) is 0.8 m" in note(draw([run]))


def test_a_note_begins_with_what_may_be_unsafe_and_names_the_others() -> None:
    careful = [ResultWarning("closed_in", "goal", f"careful {index}", safe_side=True) for index in range(2)]
    found = [*careful, ResultWarning("unknown_wall", "law", "unsafe"), ResultWarning("implausible", "goal", "unit")]
    lines = notes.warning_lines([SimpleNamespace(warnings=found)], 20.0)
    assert lines == ["warning: unsafe", "warning: unit", "and 2 more (closed_in): see .warnings of the result"]
    assert notes.warning_lines([SimpleNamespace(warnings=careful)], 20.0) == [
        "warning: careful 0",
        "warning: careful 1",
    ]


@pytest.mark.parametrize("width", [2.0, 4.0, 8.0])
@pytest.mark.parametrize("text", ["WWW MMM " * 30, "W" * 200, "/robot/odometry " * 20, "a $ sign, " * 40])
def test_lines_of_a_note_are_as_wide_as_the_picture(text: str, width: float) -> None:
    figure = Figure(figsize=(width, 2.0))
    notes.add_warnings(figure, SimpleNamespace(warnings=[ResultWarning("x", "y", text)]))
    box = figure.texts[-1].get_window_extent()
    assert box.x0 >= 0.0
    assert box.x1 <= figure.bbox.width
    assert "".join(figure.texts[-1].get_text().replace("\\$", "$").split()) == "".join(f"warning: {text}".split())
