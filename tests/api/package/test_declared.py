"""Names, units, bounds and defaults stand in one place: what is derived from it agrees with it."""

from __future__ import annotations

import ast
import dataclasses
import re
from pathlib import Path
from typing import Any, get_args

import pytest

from api.glossary import identifiers, units_of
from api.namespaces import public
from hrsafety import _hrsafety, impact, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.cli import verdict
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.criteria.declared import CRITERIA, CriterionValues
from hrsafety.navigation.laws.declared import Gain, Law, gain
from hrsafety.navigation.laws.known import LAWS
from hrsafety.navigation.outcomes import OUTCOMES, Outcome
from hrsafety.plotting.comparisons.studies import OUTCOME_COLORS
from hrsafety.scenarios.laws import SHORT_NAMES, law_named

GLOSSARY = (Path(__file__).resolve().parents[3] / "docs" / "theory" / "symbols.md").read_text(encoding="utf-8")
NAMES = tuple(CRITERIA)


# ---- criteria of an impact ----------------------------------------------------------------------------


def test_rows_batches_and_gradients_hold_the_declared_criteria() -> None:
    assert impact.ImpactMetrics._fields == (*NAMES, "status", "beyond_linear_range")
    assert tuple(each.name for each in dataclasses.fields(CriterionValues)) == NAMES
    assert tuple(each.name for each in dataclasses.fields(impact.ImpactMetricsBatch))[: len(NAMES)] == NAMES
    parts = (impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum())
    assert impact.gradients(*parts, closing_speed=1.0).metric_names == NAMES


@pytest.mark.parametrize("fields", ["all", "peaks"])
def test_columns_of_a_study_are_the_criteria_with_their_units(fields: Any) -> None:
    study = sweep.ImpactStudy(
        manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum(), fields=fields
    )
    units = {each.name: each.unit for each in study.columns() if each.name in CRITERIA}
    wanted = {name: each.unit for name, each in CRITERIA.items() if fields == "all" or each.is_peak}
    assert units == wanted


@pytest.mark.parametrize("name", NAMES)
def test_documentation_of_results_follows_from_the_list(name: str) -> None:
    label = CRITERIA[name].label
    for owner in (impact.ImpactMetrics, impact.ImpactMetricsBatch):
        assert re.search(rf"{name} : .*\n +{re.escape(label[0].upper() + label[1:])}", str(owner.__doc__))


@pytest.mark.parametrize("name", [name for name in NAMES if CRITERIA[name].unit])
def test_units_of_criteria_are_those_of_the_glossary(name: str) -> None:
    assert any(CRITERIA[name].unit in cell.split(", ") for cell in units_of(name)), units_of(name)


# ---- laws and gains -----------------------------------------------------------------------------------


def test_every_law_of_the_package_is_declared_once() -> None:
    laws = {each for each in public(nav).values() if isinstance(each, type) and issubclass(each, Law)}
    # The kind itself, what a user wrote, what stands around another law, and what needs a robot with lidars.
    laws -= {Law, nav.laws.PythonLaw, nav.laws.SafeNavigation, nav.ArcRollouts}
    assert set(LAWS.values()) == laws
    assert all(LAWS[law.NAME] is law for law in laws)
    assert set(SHORT_NAMES.values()) <= set(LAWS)
    assert not set(SHORT_NAMES) & set(LAWS)


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_core_reads_and_gives_back_the_declared_gains(law: type[Law]) -> None:
    made = law()
    assert made._native.gains == list(made.gains)
    assert len(made._native.gain_names) == len(law.GAIN_NAMES)
    for name in (law.NAME, *law.OTHER_NAMES, law.NAME.replace("_", "-").upper()):
        assert law_named("law", name) is law


@pytest.mark.parametrize("law", LAWS.values(), ids=LAWS)
def test_gains_stand_in_the_glossary(law: type[Law]) -> None:
    for name in law.GAIN_NAMES:
        low, high = law.GAIN_BOUNDS[name]
        assert low <= high
        assert name in identifiers(), name


def test_a_gain_is_a_field_that_knows_its_unit() -> None:
    found = gain(2.0, unit="N/m", bounds=(0.0, 5.0), symbol="K_1")
    assert found.default == 2.0
    assert found.metadata["gain"] == Gain(unit="N/m", bounds=(0.0, 5.0), symbol="K_1")


def test_core_refuses_a_law_it_does_not_know_and_arguments_that_are_left_over() -> None:
    with pytest.raises(ValueError, match="law must be one of masoud"):
        _hrsafety.Law.named("mosaud")
    gains = {"attractive_gain": 1.0, "repulsive_gain": 1.0, "detour_gain": 1.0}
    with pytest.raises(TypeError, match="unknown arguments"):
        _hrsafety.Law.named("masoud", **gains, gain_ratio=1.0)


# ---- native parameters --------------------------------------------------------------------------------

READ_BACK = [
    impact.MANIPULATOR_1,
    impact.FOAM_1,
    impact.Head.minimum(),
    impact.Joint(
        inertia=1.0, mechanical_stiffness=9e3, mechanical_damping=5.0, control_stiffness=2e3, control_damping=30.0
    ),
    nav.VirtualTorque(torque_gain=2.0, damping_ratio=0.9, backward=True),
]


@pytest.mark.parametrize("parameters", READ_BACK, ids=lambda each: type(each).__name__)
def test_native_parameters_are_read_back(parameters: Any) -> None:
    read = [each.name for each in dataclasses.fields(parameters) if hasattr(parameters._native, each.name)]
    assert len(read) >= 3
    for name in read:
        assert getattr(parameters._native, name) == getattr(parameters, name), name


def test_keywords_of_native_classes_are_complete_and_known() -> None:
    with pytest.raises(TypeError, match="missing argument 'stiffness'"):
        _hrsafety.Head(mass=5.0, damping=1.0)
    with pytest.raises(TypeError, match=r"unknown arguments .*'length'"):
        _hrsafety.Head(mass=5.0, damping=1.0, stiffness=1.0, length=1.0)
    with pytest.raises(TypeError, match="argument 'mass'"):
        _hrsafety.Head(mass="5", damping=1.0, stiffness=1.0)


# ---- outcomes of a run --------------------------------------------------------------------------------


def test_words_of_outcomes_are_those_of_the_core() -> None:
    assert get_args(Outcome) == tuple(OUTCOMES)
    assert all(OUTCOMES.values())


def test_columns_pictures_and_exit_words_follow_the_outcomes() -> None:
    study = sweep.NavigationStudy(scenarios=scenarios.configuration("c1"), law=nav.VirtualForceField())
    assert next(each for each in study.columns() if each.name == "outcome").words == tuple(OUTCOMES)
    assert {word for word in OUTCOMES if word not in {"arrived", "collided"}} <= set(verdict.FAILURES)
    assert {word.replace("_", " ") for word in OUTCOMES if word != "collided"} <= set(OUTCOME_COLORS)


@pytest.mark.parametrize("word", OUTCOMES)
def test_the_glossary_has_every_outcome(word: str) -> None:
    assert word.replace("_", " ") in next(line for line in GLOSSARY.splitlines() if "`outcome`" in line)


def test_no_module_lists_the_outcomes_again() -> None:
    lists = (ast.Tuple, ast.List, ast.Set, ast.Dict)
    found = set()
    for path in Path(nav.__file__).parents[1].rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, lists):
                words = {each.value for each in ast.walk(node) if isinstance(each, ast.Constant)}
                found |= {path.name} if set(OUTCOMES) <= words else set()
    assert found == {"outcomes.py"}


# ---- sensors on a robot -------------------------------------------------------------------------------


def test_a_sensor_is_made_by_its_name_alone() -> None:
    with pytest.raises(InvalidParameterError, match="sensor must be one of ultrasonic"):
        _hrsafety.Sensor.named("nose")
    with pytest.raises(InvalidParameterError, match="beam_width"):
        nav.sensing.Ultrasonic(beam_width=4.0)
    with pytest.raises(InvalidParameterError, match=r"sensors\[0\]"):
        nav.robots.AsBuilt(sensors=[nav.sensing.Vision()])  # type: ignore[list-item]  # what is tested
    assert nav.robots.AsBuilt(sensors=[nav.sensing.Ultrasonic()]).sensors[0].NAME == "ultrasonic"
