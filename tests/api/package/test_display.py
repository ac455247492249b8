"""Every public class of results shows itself: short text, a table for notebooks, units, warnings, nothing unescaped."""

from __future__ import annotations

import dataclasses
from html.parser import HTMLParser
from typing import Annotated, Any, NamedTuple

import numpy as np
import pytest

from api.documented_units import documented_units
from api.fuzzing import CALLS
from fuzz.constructors import NO_CONSTRUCTORS, public_classes
from hrsafety import _display, impact, plausibility, program, ros, sweep
from hrsafety import navigation as nav
from hrsafety._display import fields_with_units, shown_html
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Table

MOST_LINES, MOST_LETTERS = 40, 4000

# Classes that describe attributes and are no results.
NO_RESULTS = {
    impact.ConstrainedHead: "a parameter object without parameters",
    nav.laws.Law: "the base of laws",
    nav.LidarScan: "what a controller is told",
    nav.laws.SafetyFilter: "the base of filters",
    nav.laws.Situation: "what a law in Python is given",
    nav.sensing.RobotSensor: "the base of sensors",
    sweep.Design: "the base of designs",
    Table: "the base of tables",
    program.ArmMotion: "a path that programs are made of",
    nav.maps.PolylineWall: "a kind of wall, for type checkers",
    plausibility.Range: "a row of the table of ranges",
    ResultWarning: "a line of the results that carry it",
    ros.Bridge: "a node",
    **dict.fromkeys((ros.Publisher, ros.Quality, ros.Leg, ros.BusRecord), "parts of a node"),
}


def is_result(kind: type) -> bool:
    """Return whether a class is of results: it describes attributes, or the package makes it."""
    if kind in NO_RESULTS or issubclass(kind, Exception):
        return False
    text = kind.__doc__ or ""
    attributes = "Attributes\n    ---" in text and "Parameters\n    ---" not in text
    return attributes or issubclass(kind, Table) or kind in NO_CONSTRUCTORS


RESULTS = [kind for kind in public_classes() if is_result(kind)]
DISPLAYED = [kind for kind in RESULTS if getattr(kind, "_repr_html_", None) is shown_html]
EVIL = '<script>alert("x")</script>&'


class Tags(HTMLParser):
    """Tags of a page, and whether each one is closed."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: set[str] = set()

    def handle_starttag(self, tag: str, attrs: Any) -> None:
        assert attrs == [] or tag == "td" or (tag == "iframe" and dict(attrs)["sandbox"] == "allow-scripts")
        self.open.append(tag)
        self.seen.add(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


def tags(text: str) -> set[str]:
    parser = Tags()
    parser.feed(text)
    parser.close()
    assert parser.open == []
    return parser.seen


def made_of(kind: Any, value: Any) -> Any:
    """Return a result whose fields all hold a value, without a check."""
    if issubclass(kind, tuple):
        return kind._make([() if name == "warnings" else value for name in kind._fields])
    result = object.__new__(kind)
    for field in dataclasses.fields(kind):
        object.__setattr__(result, field.name, () if field.name in {"warnings", "scenarios"} else value)
    return result


def test_results_are_found() -> None:
    assert {nav.Trajectory, nav.ForceTerms, impact.FoamFit, sweep.SweepResult, impact.HeadInjury} <= set(RESULTS)
    assert len(RESULTS) > 90
    assert len(DISPLAYED) > 60


@pytest.mark.parametrize("kind", RESULTS, ids=lambda kind: kind.__name__)
def test_every_public_result_class_shows_itself(kind: Any) -> None:
    assert callable(getattr(kind, "_repr_html_", None)), f"{kind.__qualname__} has no _repr_html_"
    assert kind.__repr__ is not object.__repr__


@pytest.mark.parametrize("kind", DISPLAYED, ids=lambda kind: kind.__name__)
def test_tables_are_short_whole_and_escaped(kind: Any) -> None:
    if not fields_with_units(kind):
        pytest.fail(f"no fields of {kind.__qualname__} are found")
    long = np.where(np.arange(1000) % 7 == 0, np.nan, np.linspace(0.0, 1.0, 1000)).reshape(500, 2)
    for value in (EVIL, long, float("nan"), [EVIL] * 100, {EVIL: EVIL}, None, (1.0, 2.0), np.array([EVIL] * 50)):
        try:
            result = made_of(kind, value)
        except TypeError:  # a class of the binding
            return
        text = shown_html(result)
        assert tags(text) <= {"p", "table", "tbody", "tr", "td"}
        assert "<script" not in text
        assert len(text) < 300 + 250 * len(fields_with_units(kind))


@pytest.mark.parametrize("name", CALLS)
def test_what_calls_return_is_shown_short(name: str) -> None:
    function, arguments = CALLS[name]
    result = function(**arguments)
    text = repr(result) if not isinstance(result, (np.ndarray, str, tuple)) or hasattr(result, "_fields") else ""
    assert len(text.splitlines()) <= MOST_LINES
    assert len(text) <= MOST_LETTERS
    if type(result) in RESULTS:
        tags(result._repr_html_())


@pytest.mark.parametrize(
    ("kind", "units"),
    [
        (impact.HeadInjury, {"value": "s", "start": "s", "end": "s"}),
        (nav.ForceTerms, {"attractive": "N", "total": "N"}),
        (impact.FoamFit, {"stiffness": "N/m", "friction": "N", "damping_ratio": ""}),
        (impact.ImpactMetrics, {"peak_head_acceleration": "m/s^2", "peak_contact_force": "N", "peak_power_foam": "W"}),
        (nav.metrics.Standing, {"arrival_time": "s", "energy": "J", "path_length": "m", "performance_total": ""}),
        (nav.metrics.Falsification, {"min_clearance": "m", "end_time": ""}),
        (impact.identification.DirectDriveFit, {"torque_constant": "N m/A", "command_gain": ""}),
        (impact.identification.PdGains, {"derivative": "V s/rad"}),
        (impact.ImpactGradients, {"values": ""}),
    ],
    ids=lambda each: getattr(each, "__name__", ""),
)
def test_units_are_those_of_the_fields(kind: type, units: dict[str, str]) -> None:
    found = fields_with_units(kind)
    assert {name: found[name] for name in units} == units


@pytest.mark.parametrize("kind", DISPLAYED, ids=lambda kind: kind.__name__)
def test_declared_units_are_those_that_the_documentation_names(kind: type) -> None:
    named = documented_units(kind)
    declared = fields_with_units(kind)
    assert declared == {name: named.get(name, "") for name in declared}


def test_a_unit_is_read_from_annotations_of_any_form() -> None:
    class Written(NamedTuple):
        speed: Annotated[float, "m/s"]
        count: int

    class Evaluated:
        __annotations__ = {"speed": Annotated[float, "m/s"], "count": int}  # as without `from __future__`
        _fields = ("speed", "count")

    for kind in (Written, Evaluated):
        assert fields_with_units(kind) == {"speed": "m/s", "count": ""}


def test_warnings_are_shown_and_many_are_counted() -> None:
    doubts = tuple(ResultWarning("implausible", "speed", f"speed {index} is {EVIL}") for index in range(9))

    class Doubted(impact.HeadInjury):
        warnings = doubts

    result = Doubted(1.0, 0.0, 0.1)
    text = shown_html(result)
    assert text.count("warning: speed") == 4
    assert "and 5 more: see .warnings" in text
    assert "<script" not in text


def test_implausible_impact_says_so_wherever_it_is_shown() -> None:
    found = impact.metrics(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=400.0)
    assert found.warnings
    for text in (repr(found), found._repr_html_()):
        assert "closing_speed" in text


def test_sweep_shows_columns_with_units_and_reads_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    result = sweep.run(sweep.Grid([sweep.Axis(name="closing_speed", values=[0.4, 1.25])]), study)
    monkeypatch.setattr(type(result._store), "read", None)
    text = result._repr_html_()
    assert tags(text) >= {"table", "th", "td"}
    assert "<td>closing_speed</td><td>axis</td><td>m/s</td>" in text
    assert "<td>peak_contact_force</td><td>number</td><td>N</td>" in text
    assert "SweepResult: grid, 2 rows" in text


def test_infinite_values_are_counted_beside_the_range_of_the_others() -> None:
    values = np.array([[0.5, np.inf], [2.0, -np.inf], [1.0, np.nan]])
    assert _display._array(values) == "3 x 2: 0.5 to 2, 2 infinite, 1 without value"
