"""Doubts about scenes and parts reach searches, sweeps, their files, pages and pictures."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import impact, plotting, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.cli import main

LAW = nav.VirtualForceField()
C1 = scenarios.configuration("c1")
# Noise that its critical regions are not sized for.
NOISY = replace(scenarios.configuration("c2"), measurement=nav.Measurement(of="obstacles"))
PLACES = [C1, NOISY]
SMALL: dict[str, Any] = {"grid": (2, 2, 2, 2), "refinements": 0, "survivors": 2, "local_starts": 0}
GAINS = sweep.Grid([sweep.Axis(name="detour_gain", values=[10.0, 17.0])])


def search(**changes: Any) -> nav.GainSearch:
    return nav.optimize_gains(PLACES, require_arrival=False, **SMALL | changes)


def results() -> dict[str, Any]:
    found = search()
    return {
        "search": found,
        "flatness": found.flatness(3),
        "front": nav.gains.pareto_front(PLACES, grid=(3, 3, 3, 3), refinements=0),
        "sensitivity": nav.gain_sensitivity(PLACES, LAW, [-10, 10]),
        "gradient": nav.gains.gain_gradient(PLACES),
        "sweep": sweep.run(GAINS, sweep.NavigationStudy(scenarios=PLACES)),
    }


def drawn(found: dict[str, Any]) -> dict[str, Any]:
    compared = nav.compare(PLACES, LAW)
    x, y = np.meshgrid(np.linspace(-0.2, 4.0, 12), np.linspace(-0.4, 1.6, 6))
    field = nav.laws.force_field(LAW, NOISY, position=np.column_stack([x.ravel(), y.ravel()]))
    repeated = nav.simulate_many(NOISY, LAW, seeds=3, paths=True)
    return {
        "search_history": plotting.search_history(found["search"]),
        "flatness": plotting.flatness(found["flatness"]),
        "pareto_front": plotting.pareto_front(found["front"]),
        "gain_sensitivity": plotting.gain_sensitivity(found["sensitivity"]),
        "sweep_lines": plotting.sweep_lines(found["sweep"], "energy"),
        "sweep_scatter": plotting.sweep_scatter(found["sweep"], "energy"),
        "sweep_parallel": plotting.sweep_parallel(found["sweep"], "energy"),
        "standings": plotting.comparison_standings(compared),
        "clearances": plotting.clearances({"both": compared.runs}),
        "outcomes": plotting.outcomes({"both": compared.runs}),
        "repeated_paths": plotting.repeated_paths(repeated),
        "repeated_distances": plotting.repeated_distances(repeated),
        "layout": plotting.layout(NOISY),
        "force_field": plotting.force_field(field, NOISY),
        "potential_valley": plotting.potential_valley(field, NOISY),
    }


def assert_nothing_covered(figure: Any, name: str) -> None:
    """Neither the note nor a legend of the figure lies on an axes with its labels, nor on each other."""
    figure.draw_without_rendering()
    boxes = [axes.get_tightbbox() for axes in figure.axes]
    legends = [legend.get_window_extent() for legend in figure.legends]
    note = figure.texts[-1].get_window_extent()
    for legend in legends:
        assert not note.overlaps(legend), name
        assert not any(legend.overlaps(box) for box in boxes), name
    assert not any(note.overlaps(box) for box in boxes), name


OF_SEARCH = ("search", "flatness")


def test_what_is_made_of_many_runs_carries_the_warnings_of_its_scenes() -> None:
    assert [each.code for each in nav.simulate(NOISY, LAW).warnings] == ["region_below_safe"]
    found = results()
    for name, result in found.items():
        warning, *of_search = result.warnings
        assert warning.code == "region_below_safe", name
        assert {each.code for each in of_search} <= ({"optimum_on_bound", "few_runs"} if name in OF_SEARCH else set())
        place = "scenarios['1']" if name == "sweep" else "scenarios[1]"
        assert warning.message.startswith(f"{place}: critical_radius of obstacles[0]"), name
    for name, figure in drawn(found).items():
        words = " ".join(text.get_text() for text in figure.texts)
        assert "critical_radius of obstacles[0]" in " ".join(words.split()), name
        assert_nothing_covered(figure, name)


def test_laws_without_critical_regions_do_not_depend_on_their_size() -> None:
    found = search(law=nav.Khatib(), grid=(2, 2, 2)).warnings
    assert {each.code for each in found} == {"optimum_on_bound", "few_runs"}
    assert (
        sweep.run(
            sweep.Grid([sweep.Axis(name="attractive_gain", values=[3.0])]),
            sweep.NavigationStudy(scenarios=PLACES, law=nav.Khatib()),
        ).warnings
        == ()
    )


def test_a_sweep_is_judged_at_the_ends_of_its_axes_and_its_folder_keeps_that(tmp_path: Path) -> None:
    speeds = sweep.Grid(
        [
            sweep.Axis(name="detour_gain", values=[10.0, 17.0]),
            sweep.Axis(name="robot_max_speed", values=[0.5, 0.7, 20.0]),
        ]
    )
    study = sweep.NavigationStudy(scenarios={"c1": C1})
    made = sweep.run(speeds, study, out=tmp_path / "speeds")
    assert {each.code for each in made.warnings} == {"region_below_safe", "implausible"}
    assert any("robot.max_speed is 20 m/s" in each.message for each in made.warnings)
    assert sweep.open(tmp_path / "speeds").warnings == made.warnings
    with np.load(made.to_npz(tmp_path / "speeds.npz")) as file:
        kept = json.loads(str(file["_hrsafety"]))
    assert "robot.max_speed is 20 m/s" in json.dumps(kept["provenance"]["warnings"])
    assert "robot.max_speed is 20 m/s" in repr(made)


@pytest.mark.parametrize("design", [sweep.LatinHypercube, sweep.Sobol])
def test_impacts_of_a_sweep_are_judged_by_their_numbers(design: Any) -> None:
    study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    speeds = [sweep.Axis(name="closing_speed", low=100.0, high=1250.0)]
    warning, pressed = sweep.run(design(speeds, 32, 1), study).warnings
    assert (warning.code, warning.subject) == ("implausible", "closing_speed")
    assert (pressed.code, "32 of the 32 rows" in pressed.message) == ("bottomed", True)
    heavy = replace(study, head=None, fixed={"head_mass": 4500.0, "head_damping": 10.0, "head_stiffness": 3300.0})
    found = sweep.run(design([sweep.Axis(name="closing_speed", low=0.1, high=1.0)], 32, 1), heavy).warnings
    assert "head_mass" in [each.subject for each in found]


def test_boundaries_of_foam_carry_what_is_doubtful_about_their_impact() -> None:
    grams = impact.Manipulator(mass=9600.0, damping=250.0, stiffness=20e3)
    upper = impact.foam_stiffness_upper(grams, damping=[50.0], closing_speed=1.25)
    lower = impact.foam_stiffness_lower(grams, damping=[50.0], closing_speed=1250.0)
    assert [each.subject for each in upper.warnings] == ["manipulator.mass"]
    assert [each.subject for each in lower.warnings] == ["manipulator.mass", "closing_speed"]
    fine = impact.foam_stiffness_upper(impact.MANIPULATOR_1, damping=[50.0], closing_speed=1.25)
    assert fine.warnings == ()
    limits = impact.FoamLimits(peak_head_acceleration_g=10.0)
    design = impact.design_foam(grams, limits, closing_speed=1.25)
    assert design.upper([50.0]).warnings == design.warnings != ()


def test_a_row_that_is_no_scene_is_named_by_its_chunk_not_by_the_look_ahead() -> None:
    radii = sweep.Grid([sweep.Axis(name="robot_radius", values=[0.2, 50.0])])
    with pytest.raises(Exception, match="must") as caught:
        sweep.run(radii, sweep.NavigationStudy(scenarios=C1))
    assert any("in rows 0 to 1" in note for note in caught.value.__notes__)


@pytest.mark.parametrize("command", ["optimize", "sweep"])
def test_commands_show_them_once_and_leave_with_code_4(
    command: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    person = '[[obstacles]]\ntype = "human"\nstart = [0.6, 0.6]\nvelocity = [1.0, 0.0]\n'
    person += "active_radius = 2.0\ncritical_radius = 0.65\n"
    (tmp_path / "met.toml").write_text(f"start = [3.9, 0.6]\ngoal = [0.0, 0.6]\n{person}")
    small = "[search]\ngrid = [2, 2, 2, 2]\nrefinements = 0\nsurvivors = 1\nlocal_starts = 0\n"
    axis = '[[axes]]\nname = "detour_gain"\nvalues = [10.0, 20.0]\n'
    study = tmp_path / "study.toml"
    study.write_text('scenarios = ["met.toml"]\n' + (small if command == "optimize" else axis))
    assert main([command, str(study), "--out", str(tmp_path / "out"), "--strict"]) == 4
    shown = capsys.readouterr().err
    assert shown.count("hrsafety: warning: ") == (1 if command == "sweep" else 2)
    assert ("on its largest value" in shown) == (command == "optimize")
    assert shown.count("critical_radius of obstacles[0] (Human) is 0.65 m") == 1
    assert "critical_radius of obstacles[0] (Human) is 0.65 m" in (tmp_path / "out" / "summary.html").read_text()
    if command == "optimize":
        kept, _ = json.loads((tmp_path / "out" / "results.json").read_text())["warnings"]
        assert kept in shown
