"""Studies: the same numbers as the calls they stand for, and what they refuse."""

from __future__ import annotations

import functools
import importlib
import pickle
import re
import sys
import threading
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import InvalidParameterError, ShapeError, SimulationError, impact, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.sweep import room
from reference import sweep_functions

LAW = nav.VirtualForceField()
C2 = scenarios.configuration("c2")
IMPACT = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
SPEED = sweep.Axis(name="closing_speed", values=[0.4, 1.25])
X, Y = (sweep.Axis(name=name, unit="m", low=-1.0, high=1.0, points=5) for name in "xy")
NORMS = [
    sweep.Column(name="norm", unit="m"),
    sweep.Column(name="quadrant", kind="integer"),
    sweep.Column(name="far", kind="flag"),
    sweep.Column(name="side", kind="word", words=("left", "right")),
]
FUNCTION = sweep.FunctionStudy(function=sweep_functions.norms, results=NORMS)


def without_units(table: nav.RunTable) -> dict[str, Any]:
    """Return the columns by the names that a sweep gives them; its units stand beside the names."""
    unit = re.compile(r"_(s|m|J|N_per_m2?|m_per_s)$")
    found = {unit.sub("", name): values for name, values in table.columns().items()}
    scenes = [table.scenarios[index] for index in table.scenario_index.tolist()]
    for place in range(max(len(scene.obstacles) for scene in scenes)):
        for name in ("critical_radius", "active_radius"):
            own = (
                getattr(each, name, None)
                for scene in scenes
                for each in (*scene.obstacles, *[None] * 9)[place : place + 1]
            )
            found[f"{name}_{place}"] = np.array([np.nan if radius is None else radius for radius in own])
    return found


def equal(found: sweep.SweepResult, expected: dict[str, Any]) -> None:
    for column in found.found:
        np.testing.assert_array_equal(found[column.name], expected[column.name], err_msg=column.name)


# ---- impact ---------------------------------------------------------------------------------


def test_impact_rows_are_those_of_a_batch() -> None:
    stiffness, damping = np.linspace(5e3, 6e4, 7), np.linspace(0.0, 150.0, 5)
    study = sweep.ImpactStudy(
        manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25}
    )
    axes = [sweep.Axis(name="foam_stiffness", values=stiffness), sweep.Axis(name="foam_damping", values=damping)]
    expected = impact.metrics_batch(
        manipulator=impact.MANIPULATOR_1,
        head=impact.Head.minimum(),
        closing_speed=1.25,
        foam_stiffness=stiffness[:, None],
        foam_damping=damping,
    )
    result = sweep.run(sweep.Grid(axes), study, chunk_rows=4)
    assert {column.name for column in result.found} == set(expected.columns())
    equal(result, expected.columns())
    assert result.shape() == (7, 5)
    assert [axis.label for axis in result.axes] == ["foam stiffness (N/m)", "foam damping (N s/m)"]


def test_impact_of_a_constrained_head_and_of_peaks_only() -> None:
    for options in ({"head": impact.ConstrainedHead()}, {"head": impact.Head.maximum(), "fields": "peaks"}):
        study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_2, **options)
        expected = impact.metrics_batch(
            manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_2, closing_speed=[0.4, 1.25], **options
        )
        equal(sweep.run(sweep.Grid([SPEED]), study), expected.columns())


def test_words_of_impacts_are_all_declared() -> None:
    damping = sweep.Axis(name="foam_damping", values=[-1.0, 0.0, 50.0])
    speed = sweep.Axis(name="closing_speed", values=[-1.0, 0.5, 9.0])
    stiffness = sweep.Axis(name="foam_stiffness", values=[0.0, 1e3])
    study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum())
    result = sweep.run(sweep.Grid([damping, speed, stiffness]), study)
    assert {"invalid_foam_damping", "no_impact", "released"} <= set(result["status"].tolist())


# ---- navigation -----------------------------------------------------------------------------


def test_gains_are_those_of_a_batch() -> None:
    names = ("c1", "c2", "c3")
    scenes = {name: scenarios.configuration(name) for name in names}
    axes = [
        sweep.Axis(name="detour_gain", low=10.0, high=250.0, points=4),
        sweep.Axis(name="repulsive_gain", low=10.0, high=30.0, points=3),
    ]
    study = sweep.NavigationStudy(scenarios=scenes, law=LAW)
    detour, repulsive = (grid.ravel() for grid in np.meshgrid(axes[0].levels(), axes[1].levels(), indexing="ij"))
    table = nav.simulate_batch(list(scenes.values()), LAW, {"detour_gain": detour, "repulsive_gain": repulsive})
    result = sweep.run(sweep.Grid(axes), study, chunk_rows=5)
    equal(result, without_units(table))
    assert result["scenario"].tolist() == list(names) * 12
    np.testing.assert_array_equal(result["detour_gain"], table.gains[:, 2])
    assert result.shape() == (4, 3, 3)


def test_other_numbers_change_the_scene_as_replace_does() -> None:
    rows = sweep.LatinHypercube(
        [
            sweep.Axis(name="robot_max_speed", low=0.4, high=0.9),
            sweep.Axis(name="obstacle_speed", low=0.3, high=1.2),
            sweep.Axis(name="measurement_scale", low=0.0, high=0.02),
            sweep.Axis(name="seed", low=0, high=100, scale="integer"),
            sweep.Axis(name="gain_ratio", low=0.2, high=0.8),
            sweep.Axis(name="stabilizing_force_cap", low=1.0, high=20.0),
        ],
        6,
    )
    result = sweep.run(rows, sweep.NavigationStudy(scenarios=C2), chunk_rows=4)
    for index, row in enumerate(rows.rows()):
        speed, walking, scale, seed, ratio, cap = row.tolist()
        person = replace(C2.obstacles[0], velocity=(walking, 0.0))
        scene = replace(
            C2,
            robot=replace(C2.robot, max_speed=speed),
            obstacles=(person,),
            measurement=nav.Measurement(scale=scale),
            seed=int(seed),
        )
        law = replace(LAW, gain_ratio=ratio, stabilizing_force_cap=cap)
        expected = without_units(nav.simulate_batch([scene], law))
        for column in result.found:
            np.testing.assert_array_equal(result[column.name][index], expected[column.name][0])


def test_rows_that_share_a_scene_are_put_back_in_order() -> None:
    # The scene varies fastest, so that rows with equal scenes are scattered.
    grid = sweep.Grid(
        [
            sweep.Axis(name="detour_gain", values=[10.0, 30.0, 20.0]),
            sweep.Axis(name="robot_max_speed", values=[0.7, 0.5]),
        ]
    )
    result = sweep.run(grid, sweep.NavigationStudy(scenarios={"c2": C2, "c1": scenarios.configuration("c1")}))
    row = 0
    for gain in (10.0, 30.0, 20.0):
        for speed in (0.7, 0.5):
            for name in ("c2", "c1"):
                scene = scenarios.configuration(name)
                scene = replace(scene, robot=replace(scene.robot, max_speed=speed))
                table = nav.simulate_batch([scene], LAW, {"detour_gain": gain})
                assert result["min_clearance"][row] == table.min_clearance[0]
                assert result["scenario"][row] == name
                row += 1


def test_scenes_that_occur_again_run_once_and_fill_all_their_rows() -> None:
    speeds = sweep.Axis(name="robot_max_speed", values=[0.7, 0.5, 0.6])
    result = sweep.run(sweep.Sobol([speeds], 32, seed=4), sweep.NavigationStudy(scenarios=C2))
    for speed in (0.5, 0.6, 0.7):
        expected = nav.simulate_batch([replace(C2, robot=replace(C2.robot, max_speed=speed))], LAW)
        found = result["energy"][result["robot_max_speed"] == speed]
        assert len(found) > 5
        np.testing.assert_array_equal(found, expected.energy[0])


def test_many_scenes_alone_run_together_and_in_order() -> None:
    seeds = sweep.Axis(name="seed", low=0, high=2499, scale="integer")
    noisy = replace(C2, measurement=nav.Measurement(scale=0.02))
    result = sweep.run(sweep.Grid([seeds]), sweep.NavigationStudy(scenarios=noisy, outputs=["energy"]))
    some = [0, 1, 1023, 1024, 2499]
    table = nav.simulate_batch([replace(noisy, seed=seed) for seed in some], LAW)
    np.testing.assert_array_equal(result["energy"][some], table.energy)


def test_scene_of_a_function_gets_its_axes() -> None:
    grid = sweep.Grid(
        [
            sweep.Axis(name="place", values=[2.0, 3.0]),
            sweep.Axis(name="walking_speed", values=[0.5, 1.0]),
            sweep.Axis(name="detour_gain", values=[10.0, 20.0]),
        ]
    )
    units = {"place": "m", "walking_speed": "m/s"}
    study = sweep.NavigationStudy(scenario=sweep_functions.crossing, axis_units=units)
    result = sweep.run(grid, study)
    scene = sweep_functions.crossing({"place": 3.0, "walking_speed": 0.5})
    table = nav.simulate_batch([scene], LAW, {"detour_gain": [10.0, 20.0]})
    np.testing.assert_array_equal(result["min_clearance"][4:6], table.min_clearance)
    assert result.units["walking_speed"] == "m/s"


# ---- functions ------------------------------------------------------------------------------


def test_function_gives_numbers_integers_flags_and_words() -> None:
    result = sweep.run(sweep.Grid([X, Y]), FUNCTION, chunk_rows=7)
    x, y = result["x"], result["y"]
    equal(result, sweep_functions.norms(x, y))
    assert [result[name].dtype.kind for name in ("norm", "quadrant", "far", "side")] == ["f", "i", "b", "U"]


def test_functions_that_differ_are_told_apart(tmp_path: Path) -> None:
    results = ["norm", "quadrant", sweep.Column(name="far", kind="flag"), NORMS[3]]
    first = functools.partial(sweep_functions.norms, offset=1.0)
    sweep.run(sweep.Grid([X, Y]), sweep.FunctionStudy(function=first, results=results), out=tmp_path)
    for other in (functools.partial(sweep_functions.norms, offset=2.0), sweep_functions.norms):
        with pytest.raises(sweep.SweepError, match=r"study\.function"):
            sweep.run(sweep.Grid([X, Y]), sweep.FunctionStudy(function=other, results=results), out=tmp_path)


@pytest.mark.parametrize("study", [IMPACT, FUNCTION, sweep.NavigationStudy(scenarios={"c2": C2}, law=LAW)])
def test_studies_are_pickled_by_value(study: sweep.Study) -> None:
    again = pickle.loads(pickle.dumps(study))
    assert again == study
    assert again.settings() == study.settings()


def made(**given: Any) -> Any:
    return lambda **_: given


@pytest.mark.parametrize(
    ("function", "error", "words"),
    [
        (lambda **_: 3, InvalidParameterError, "must be a mapping of names"),
        (made(b=np.zeros(5)), InvalidParameterError, "must have the names a"),
        (made(a=np.zeros(5), b=np.zeros(5)), InvalidParameterError, "must have the names a"),
        (made(a=np.zeros(4)), ShapeError, r"a must have shape \(5,\)"),
        (made(a=np.zeros((5, 1))), ShapeError, r"a must have shape \(5,\)"),
        (made(a=["x"] * 5), InvalidParameterError, "a must hold values of the kind 'number'"),
        (made(a=[None] * 5), InvalidParameterError, "a must hold values of the kind 'number'"),
        (made(a=np.zeros(5, dtype=complex)), InvalidParameterError, "a must hold values"),
    ],
)
def test_bad_result_of_a_function_is_refused(function: Any, error: type[Exception], words: str) -> None:
    with pytest.raises(error, match=words):
        sweep.run(sweep.Grid([X]), sweep.FunctionStudy(function=function, results=["a"]))


def test_word_that_was_not_declared_is_refused() -> None:
    study = sweep.FunctionStudy(
        function=made(a=["up"] * 5), results=[sweep.Column(name="a", kind="word", words=("down",))]
    )
    with pytest.raises(InvalidParameterError, match="a must hold words among down, got 'up'"):
        sweep.run(sweep.Grid([X]), study)


# ---- what is refused ------------------------------------------------------------------------

BAD: list[tuple[type, dict[str, Any], str]] = [
    (sweep.ImpactStudy, {"manipulator": 3}, "manipulator must be a Manipulator"),
    (sweep.ImpactStudy, {"foam": impact.Head.minimum()}, "foam must be a Foam"),
    (sweep.ImpactStudy, {"head": impact.FOAM_1}, "head must be a Head or ConstrainedHead"),
    (sweep.ImpactStudy, {"fixed": 3}, "fixed must be a mapping"),
    (sweep.ImpactStudy, {"fixed": {"speed": 1.0}}, "fixed must be one of"),
    (sweep.ImpactStudy, {"fixed": {"closing_speed": "x"}}, "closing_speed must be a number"),
    (sweep.ImpactStudy, {"fields": "few"}, "fields must be one of"),
    (sweep.ImpactStudy, {"horizon": -1.0}, "horizon must be finite and positive"),
    (sweep.ImpactStudy, {"outputs": ["speed"]}, "outputs must be one of"),
    (sweep.ImpactStudy, {"outputs": []}, "outputs must be at least one"),
    (sweep.ImpactStudy, {"outputs": "hic15"}, "outputs must be a sequence"),
    (sweep.ImpactStudy, {"fields": "peaks", "outputs": ["hic15"]}, "outputs must be one of"),
    (sweep.NavigationStudy, {}, "scenarios must be given"),
    (sweep.NavigationStudy, {"scenarios": 3}, "scenarios must be a sequence or a mapping"),
    (sweep.NavigationStudy, {"scenarios": [3]}, r"scenarios\[0\] must be a Scenario"),
    (sweep.NavigationStudy, {"scenarios": C2, "scenario": sweep_functions.crossing}, "scenarios must be given, or"),
    (sweep.NavigationStudy, {"scenario": 3}, "scenario must be callable"),
    (sweep.NavigationStudy, {"scenarios": C2, "law": 3}, "law must be a Law, a function that takes a Situation"),
    (sweep.NavigationStudy, {"scenarios": [C2], "names": ["a", "b"]}, "names must be 1"),
    (sweep.NavigationStudy, {"scenarios": [C2, C2], "names": ["a", "a"]}, "names must be different"),
    (sweep.NavigationStudy, {"scenarios": {"a": C2}, "names": ["a"]}, "names must be None"),
    (sweep.NavigationStudy, {"scenarios": C2, "integrator": "euler"}, "integrator must be one of"),
    (sweep.NavigationStudy, {"scenarios": C2, "step": 0.0}, "step must be finite and positive"),
    (sweep.NavigationStudy, {"scenarios": C2, "hold": 1}, "hold must be True or False"),
    (sweep.NavigationStudy, {"scenarios": C2, "stop_on_contact": "no"}, "stop_on_contact must be True"),
    (sweep.NavigationStudy, {"scenarios": C2, "weights": 1.0}, "weights must"),
    (sweep.NavigationStudy, {"scenarios": C2, "weights": (1.0, 2.0)}, "weights must"),
    (sweep.NavigationStudy, {"scenarios": C2, "axis_units": 3}, "axis_units must be a mapping"),
    (sweep.NavigationStudy, {"scenarios": C2, "outputs": ["min_distance_7"]}, "outputs must be one of"),
    (sweep.FunctionStudy, {"function": 3, "results": ["a"]}, "function must be callable"),
    (sweep.FunctionStudy, {"function": len, "results": []}, "results must be at least one"),
    (sweep.FunctionStudy, {"function": len, "results": [3]}, r"results\[0\] must be a Column"),
    (sweep.FunctionStudy, {"function": len, "results": ["a", "a"]}, "results must be at least one column, no name"),
    (sweep.FunctionStudy, {"function": len, "results": ["a"], "parameters": 3}, "parameters must be a mapping"),
    (sweep.FunctionStudy, {"function": len, "results": ["a"], "axis_units": []}, "axis_units must be a mapping"),
    (sweep.Column, {"name": "a", "kind": "complex"}, "kind must be one of"),
    (sweep.Column, {"name": "a", "kind": "word"}, "words must be given"),
    (sweep.Column, {"name": "a", "words": ("b",)}, "words must be given"),
    (sweep.Column, {"name": "a", "kind": "word", "words": ("b", "b")}, "words must be different"),
    (sweep.Column, {"name": "a", "unit": None}, "unit must be a text"),
]


@pytest.mark.parametrize(("kind", "fields", "words"), BAD)
def test_bad_study_is_refused(kind: type, fields: dict[str, Any], words: str) -> None:
    with pytest.raises((InvalidParameterError, ShapeError), match=words):
        kind(**fields)


@pytest.mark.parametrize(
    ("axes", "study", "words"),
    [
        ([X], IMPACT, "name of an axis must be one of"),
        ([SPEED], sweep.ImpactStudy(foam=impact.FOAM_1, head=impact.Head.minimum()), "manipulator_mass must be given"),
        ([SPEED], replace(IMPACT, fixed={"closing_speed": 1.0}), "fixed must not name an axis"),
        ([sweep.Axis(name="foam_damping", values=[1.0])], IMPACT, "closing_speed must be an axis"),
        (
            [sweep.Axis(name="closing_speed", unit="km/h", values=[1.0])],
            IMPACT,
            "must be 'm/s' in this study, got 'km/h'",
        ),
        (
            [sweep.Axis(name="head_mass", values=[1.0]), SPEED],
            replace(IMPACT, head=impact.ConstrainedHead()),
            "None for",
        ),
        ([X], sweep.NavigationStudy(scenarios=C2), "name of an axis must be one of"),
        (
            [X],
            sweep.FunctionStudy(function=len, results=["a"], parameters={"x": 1}),
            "parameters must not name an axis",
        ),
        ([X], sweep.FunctionStudy(function=len, results=["x"]), "columns must have different names"),
    ],
)
def test_axes_that_do_not_fit_the_study_are_refused(axes: list[sweep.Axis], study: sweep.Study, words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        sweep.run(sweep.Grid(axes), study)


@pytest.mark.parametrize(
    ("axis", "words"),
    [
        (sweep.Axis(name="detour_gain", values=[-1.0]), "must be"),
        (sweep.Axis(name="seed", values=[0.5]), "seed must be an integer"),
        (sweep.Axis(name="control_period", values=[0.0]), "control_period must be"),
        (sweep.Axis(name="robot_max_speed", values=[-1.0]), "max_speed must be"),
    ],
)
def test_values_that_cannot_be_run_are_refused(axis: sweep.Axis, words: str) -> None:
    with pytest.raises((InvalidParameterError, SimulationError), match=words) as caught:
        sweep.run(sweep.Grid([axis]), sweep.NavigationStudy(scenarios=C2))
    assert caught.value.__notes__ == ["in rows 0 to 0 of the sweep"]


OPTIONS: list[tuple[dict[str, Any], str]] = [
    ({"design": 3}, "design must be a Grid"),
    ({"study": len}, "study must be an ImpactStudy"),
    ({"out": 3}, "out must be the path"),
    ({"out": b"x"}, "out must be the path"),
    ({"out": ""}, "out must be the path"),
    ({"chunk_rows": 0}, "chunk_rows must be an integer"),
    ({"chunk_rows": 1.5}, "chunk_rows must be an integer"),
    ({"executor": 3}, "executor must be an Executor"),
    ({"client": 3}, r"client must be a distributed\.Client"),
    ({"in_flight": 0}, "in_flight must be an integer"),
    ({"retries": -1}, "retries must be an integer"),
    ({"threads": 0}, "threads must be an integer"),
    ({"threads": 10**6}, "threads must be an integer from 1 to 1024"),
    ({"resume": 1}, "resume must be True or False"),
    ({"progress": 3}, "progress must be callable"),
]


@pytest.mark.parametrize(("options", "words"), OPTIONS)
def test_bad_argument_of_run_is_refused(options: dict[str, Any], words: str) -> None:
    if "client" in options:
        pytest.importorskip("distributed", reason="needs the extra distributed")
    with pytest.raises(InvalidParameterError, match=words):
        sweep.run(**{"design": sweep.Grid([SPEED]), "study": IMPACT, **options})


def test_file_in_the_place_of_the_folder_is_refused(tmp_path: Path) -> None:
    (tmp_path / "out").write_text("", encoding="utf-8")
    with pytest.raises(InvalidParameterError, match="out must be a folder or not exist"):
        sweep.run(sweep.Grid([SPEED]), IMPACT, out=tmp_path / "out")


def test_any_law_is_swept_over_its_own_gains() -> None:
    study = sweep.NavigationStudy(scenarios={"c1": scenarios.configuration("c1")}, law=nav.Masoud())
    axes = [sweep.Axis(name="detour_gain", values=[20.0, 36.0]), sweep.Axis(name="attractive_gain", values=[4.0, 5.0])]
    result = sweep.run(sweep.Grid(axes), study)
    assert {axis.name: axis.unit for axis in result.axes} == {"detour_gain": "N/m", "attractive_gain": "N/m"}
    for row, arrival in enumerate(result["arrival_time"].tolist()):
        law = nav.Masoud(
            detour_gain=float(result["detour_gain"][row]), attractive_gain=float(result["attractive_gain"][row])
        )
        assert arrival == nav.simulate(scenarios.configuration("c1"), law).arrival_time
    with pytest.raises(InvalidParameterError, match="gain_ratio"):
        sweep.run(sweep.Grid([sweep.Axis(name="gain_ratio", values=[0.1])]), study)


STRAIGHT = """
import numpy as np

class Straight:
    def velocity(self, seen):
        away = seen.goal - seen.position
        return {speed} * away / np.hypot(*away)
"""


@pytest.fixture
def straight(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[[float], Any]:
    """Return a function that writes a module with a law of a speed, and returns the law."""
    monkeypatch.syspath_prepend(str(tmp_path))

    def made(speed: float) -> Any:
        monkeypatch.delitem(sys.modules, "law_of_tests", raising=False)
        (tmp_path / "law_of_tests.py").write_text(STRAIGHT.format(speed=speed), encoding="utf-8")
        importlib.invalidate_caches()
        return importlib.import_module("law_of_tests").Straight()

    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    return made


def test_a_law_in_python_is_swept_and_told_apart_by_its_source(
    straight: Callable[[float], Any], tmp_path: Path
) -> None:
    scene, folder = scenarios.configuration("c1"), tmp_path / "runs"
    periods = sweep.Grid([sweep.Axis(name="control_period", values=[0.05, 0.1])])

    def run(law: Any) -> sweep.SweepResult:
        return sweep.run(periods, sweep.NavigationStudy(scenarios={"c1": scene}, law=law), out=folder)

    law = straight(0.4)
    assert run(law)["arrival_time"][1] == nav.simulate(replace(scene, control_period=0.1), law).arrival_time
    assert run(straight(0.4)).complete
    with pytest.raises(sweep.SweepError, match=r"study\.law\.function\.source"):
        run(straight(0.25))


def test_a_law_that_cannot_be_pickled_is_refused(straight: Callable[[float], Any]) -> None:
    law = straight(0.4)
    law.lock = threading.Lock()
    study = sweep.NavigationStudy(scenarios={"c1": scenarios.configuration("c1")}, law=law)
    with pytest.raises(InvalidParameterError, match=r"study must hold what can be pickled.*Straight"):
        study.settings()


def test_a_function_changes_no_rows_and_masks_no_results() -> None:
    design = sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=5)])

    def doubling(x: np.ndarray) -> dict[str, np.ndarray]:
        x *= 2.0
        return {"y": x}

    found = sweep.run(design, sweep.FunctionStudy(function=doubling, results=["y"]))
    assert found["x"].tolist() == [0.0, 0.25, 0.5, 0.75, 1.0]
    assert found["y"].tolist() == [0.0, 0.5, 1.0, 1.5, 2.0]

    def hiding(x: np.ndarray) -> dict[str, np.ndarray]:
        return {"y": np.ma.masked_greater(x, 0.5)}

    with pytest.raises(InvalidParameterError, match="y must have no masked values, got 2 masked of 5"):
        sweep.run(design, sweep.FunctionStudy(function=hiding, results=["y"]))


# ---- functions that raise ------------------------------------------------------------------------------


@settings(max_examples=25, deadline=None)
@given(st.integers(1, 40), st.data())
def test_error_of_a_function_names_the_first_row_that_raises_it(size: int, data: st.DataObject) -> None:
    bad = data.draw(st.sets(st.integers(0, size - 1), min_size=1))

    def picky(x: Any, scale: float) -> dict[str, Any]:
        if bad & set(x.astype(int).tolist()):
            raise KeyError("latency")
        return {"y": scale * x}

    study = sweep.FunctionStudy(function=picky, results=["y"], parameters={"scale": 2.0})
    with pytest.raises(sweep.SweepError, match=f"KeyError: 'latency' in the row x = {min(bad)};") as caught:
        sweep.run(sweep.Grid([sweep.Axis(name="x", values=np.arange(size))]), study)
    assert isinstance(caught.value.__cause__, KeyError)


def test_rows_that_fail_together_only_are_not_named() -> None:
    def crowded(x: Any) -> dict[str, Any]:
        if len(x) > 3:
            raise MemoryError("too many")
        return {"y": x}

    study = sweep.FunctionStudy(function=crowded, results=["y"])
    with pytest.raises(sweep.SweepError, match=r"MemoryError: too many; it is called with the axes x"):
        sweep.run(sweep.Grid([sweep.Axis(name="x", values=np.arange(9))]), study)


def test_error_of_a_misspelt_axis_names_the_axes() -> None:
    axis = sweep.Axis(name="latencyy", values=[0.1, 0.2])
    row: Any = lambda values: replace(C2, control_period=values["latency"])  # noqa: E731  # a function of a row
    with pytest.raises(
        sweep.SweepError, match=r"KeyError: 'latency' in the row latencyy = 0\.1; .*axes latencyy"
    ) as caught:
        sweep.run(sweep.Grid([axis]), sweep.NavigationStudy(scenario=row))
    assert isinstance(caught.value.__cause__, KeyError)
    with pytest.raises(
        sweep.SweepError, match=r"unexpected keyword argument 'latencyy'.*called with the axes latencyy"
    ):
        sweep.run(sweep.Grid([axis]), sweep.FunctionStudy(function=lambda latency: {"y": latency}, results=["y"]))
    wrong: Any = lambda _values: replace(C2, control_period=-1.0)  # noqa: E731  # a function of a row
    with pytest.raises(InvalidParameterError, match="control_period must be"):
        sweep.run(sweep.Grid([axis]), sweep.NavigationStudy(scenario=wrong))


# ---- room ----------------------------------------------------------------------------------------------

MANY = [sweep.Axis(name=name, low=0.0, high=1.0, points=10**6) for name in "xz"]


def test_rows_that_do_not_fit_are_refused_before_anything_is_taken_or_made(tmp_path: Path) -> None:
    study = sweep.FunctionStudy(function=lambda x, z: {"y": x + z}, results=["y"])
    with pytest.raises(
        InvalidParameterError, match=r"results of about 24 TB: this machine has \S+ GB of memory.*give out="
    ):
        sweep.run(sweep.Grid(MANY), study)
    with pytest.raises(InvalidParameterError, match=r"room for about 24 TB of results, got \S+ \SB free at .*chunks="):
        sweep.run(sweep.Grid(MANY), study, out=tmp_path / "out")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("store", ["npz", "parquet"])
def test_only_chunks_that_are_missing_need_room(store: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    study = sweep.FunctionStudy(function=lambda x: {"y": 0.0 * x}, results=["y"])
    grid = sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=100_000)])
    half = sweep.run(grid, study, out=tmp_path / "out", chunk_rows=20_000, chunks="0:4", store=store)
    assert not half.complete
    monkeypatch.setattr(room, "free_space", lambda _path: 400_000)
    if store == "npz":
        with pytest.raises(InvalidParameterError, match=r"room for about 1\.6 MB of results, got 400 kB free"):
            sweep.run(grid, study, out=tmp_path / "new", chunk_rows=20_000, store=store)
    assert sweep.run(grid, study, out=tmp_path / "out").complete
