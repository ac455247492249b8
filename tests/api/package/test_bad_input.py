"""Bad values are refused where an object is built, with an error that names the argument."""

from __future__ import annotations

import dataclasses
import math
import sys
from collections.abc import Callable, Sequence
from decimal import Decimal
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

from api.spoiled import (
    INF,
    NAN,
    NOT_NEGATIVE,
    NUMBER,
    OPTIONAL_NOT_NEGATIVE,
    OPTIONAL_POINT,
    OPTIONAL_POSITIVE,
    POINT,
    POSITIVE,
    WHEELS,
    WORD,
    names,
    refused,
    spoiled,
)
from hrsafety import InvalidParameterError, ShapeError, contact, impact, reactive, scenarios
from hrsafety import navigation as nav

# Constructors with arguments that are right; each test then spoils one of them.
RIGHT: dict[str, tuple[Callable[..., Any], dict[str, Any]]] = {
    "HolonomicRobot": (nav.HolonomicRobot, {}),
    "DifferentialDriveRobot": (nav.DifferentialDriveRobot, {}),
    "VirtualForceField": (nav.VirtualForceField, {}),
    "Measurement": (nav.Measurement, {}),
    "Disc": (nav.Disc, {"center": (2.0, 0.6), "radius": 0.1}),
    "Rectangle": (nav.Rectangle, {"center": (2.0, 0.0), "length": 1.4, "width": 0.6}),
    "MovingDisc": (nav.MovingDisc, {"center": (3.0, 4.0), "radius": 0.2, "velocity": (0.0, -0.5)}),
    "MovingRectangle": (
        nav.MovingRectangle,
        {"center": (3.0, 4.0), "length": 1.4, "width": 0.6, "velocity": (0.0, -0.5)},
    ),
    "Human": (nav.Human, {"start": (0.6, 0.6), "velocity": (1.0, 0.0)}),
    "Scenario": (nav.Scenario, {"start": (3.9, 0.6), "goal": (0.0, 0.6)}),
}

# Two numbers are right for two wheels, three are not.
TWO_WHEELS = (*(wrong for wrong in WHEELS if wrong != (1.0, 2.0)), (0.1, 0.1, 0.1))

RULES: dict[str, dict[str, tuple[Any, ...]]] = {
    "HolonomicRobot": {
        **dict.fromkeys(("mass", "radius", "max_speed", "max_acceleration", "wheel_radius"), POSITIVE),
        "max_deceleration": OPTIONAL_POSITIVE,
        "winding_resistance": NOT_NEGATIVE,
        **dict.fromkeys(("wheel_inertia", "wheel_viscous_friction", "wheel_static_friction"), WHEELS),
    },
    "DifferentialDriveRobot": {
        **dict.fromkeys(("mass", "radius", "max_speed", "max_acceleration", "max_angular_acceleration"), POSITIVE),
        **dict.fromkeys(("max_deceleration", "max_turn_rate", "max_turn_acceleration"), OPTIONAL_POSITIVE),
        **dict.fromkeys(("wheel_radius", "wheel_span"), POSITIVE),
        "reference_speed_share": (*POSITIVE, 1.01),
        "winding_resistance": NOT_NEGATIVE,
        **dict.fromkeys(("wheel_inertia", "wheel_viscous_friction", "wheel_static_friction"), TWO_WHEELS),
    },
    "VirtualForceField": {
        **dict.fromkeys(("attractive_gain", "repulsive_gain", "detour_gain", "gain_ratio"), NOT_NEGATIVE),
        "stabilizing": WORD,
        "pass_behind": (1, 0, None, "yes", NAN, ()),
        "side_hysteresis": (*OPTIONAL_NOT_NEGATIVE, math.pi, 4.0),
    },
    "Measurement": {"scale": NOT_NEGATIVE, "distribution": WORD, "of": WORD, "latency": (*NOT_NEGATIVE, 61.0)},
    "Disc": {
        "center": POINT,
        "radius": POSITIVE,
        "active_radius": OPTIONAL_POSITIVE,
        "critical_radius": OPTIONAL_NOT_NEGATIVE,
        "active_clearance": OPTIONAL_POSITIVE,
        "critical_clearance": OPTIONAL_NOT_NEGATIVE,
        "max_speed": OPTIONAL_NOT_NEGATIVE,
    },
    "Rectangle": {
        "center": POINT,
        "length": POSITIVE,
        "width": POSITIVE,
        "heading": NUMBER,
        "active_radius": OPTIONAL_POSITIVE,
        "critical_radius": OPTIONAL_NOT_NEGATIVE,
        "active_clearance": OPTIONAL_POSITIVE,
        "critical_clearance": OPTIONAL_NOT_NEGATIVE,
        "max_speed": (*OPTIONAL_NOT_NEGATIVE, 0.5),
    },
    "MovingDisc": {
        "center": POINT,
        "radius": POSITIVE,
        "velocity": POINT,
        "acceleration": POINT,
        "stop": (*OPTIONAL_POINT, (3.0, 5.0), (4.0, 3.0)),
        "active_radius": OPTIONAL_POSITIVE,
        "critical_radius": OPTIONAL_NOT_NEGATIVE,
        "active_clearance": OPTIONAL_POSITIVE,
        "critical_clearance": OPTIONAL_NOT_NEGATIVE,
        "max_speed": OPTIONAL_NOT_NEGATIVE,
    },
    "MovingRectangle": {
        "center": POINT,
        "length": POSITIVE,
        "width": POSITIVE,
        "heading": NUMBER,
        "velocity": POINT,
        "acceleration": POINT,
        "stop": (*OPTIONAL_POINT, (3.0, 5.0), (4.0, 3.0)),
        "active_radius": OPTIONAL_POSITIVE,
        "critical_radius": OPTIONAL_NOT_NEGATIVE,
        "active_clearance": OPTIONAL_POSITIVE,
        "critical_clearance": OPTIONAL_NOT_NEGATIVE,
        "max_speed": OPTIONAL_NOT_NEGATIVE,
    },
    "Human": {
        "start": POINT,
        "velocity": POINT,
        "stop": (*OPTIONAL_POINT, (0.0, 0.6), (2.0, 1.0)),
        "radius": POSITIVE,
        "active_radius": OPTIONAL_POSITIVE,
        "critical_radius": OPTIONAL_NOT_NEGATIVE,
        "active_clearance": OPTIONAL_POSITIVE,
        "critical_clearance": OPTIONAL_NOT_NEGATIVE,
        "max_speed": OPTIONAL_NOT_NEGATIVE,
    },
    "Scenario": {
        "start": POINT,
        "goal": (*POINT, (3.9, 0.6), (3.9, 0.65)),
        "obstacles": (
            None,
            1.0,
            "abc",
            [None],
            [(1.0, 2.0)],
            [nav.HolonomicRobot()],
            nav.Disc(center=(2, 2), radius=0.1),
        ),
        "robot": (None, "robot", 4.4, nav.Disc(center=(2, 2), radius=0.1), nav.HolonomicRobot),
        "control_period": POSITIVE,
        "time_limit": POSITIVE,
        "arrival_tolerance": POSITIVE,
        "heading": NUMBER,
        "rest_time": POSITIVE,
        "measurement": (0.025, "uniform", True),
        "seed": (-1, 2**64, 1.5, "1", None, True, NAN),
        "doubts": (None, "doubt", 7, ["doubt"], np.array([1.0])),
    },
}


@pytest.mark.parametrize(("kind", "argument", "values"), spoiled(RULES))
def test_bad_values_are_refused_by_name(kind: str, argument: str, values: Sequence[Any]) -> None:
    build, right = RIGHT[kind]
    for value in values:
        with refused(value) as caught:
            build(**{**right, argument: value})
        assert names(caught.value).split("[")[0] == argument, repr(value)


@pytest.mark.parametrize("kind", RIGHT)
def test_rules_cover_every_argument(kind: str) -> None:
    build, _ = RIGHT[kind]
    fields = {field.name for field in dataclasses.fields(build) if not field.name.startswith("_")}
    # Caps depend on the mode, motions on their class methods, walls are a map, footprints have several forms; they have
    # tests of their own.
    elsewhere = {"stabilizing_force_cap", "stabilizing_momentum_cap", "segments", "path", "walls", "footprint"}
    assert fields - elsewhere == set(RULES[kind])


@pytest.mark.parametrize("cap", ["stabilizing_force_cap", "stabilizing_momentum_cap"])
@pytest.mark.parametrize("value", OPTIONAL_NOT_NEGATIVE)
def test_bad_cap_is_refused_by_name(cap: str, value: Any) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.VirtualForceField(stabilizing="capped", **{cap: value})
    assert names(caught.value) == cap


@pytest.mark.parametrize("mode", ["off", "full"])
@pytest.mark.parametrize("cap", ["stabilizing_force_cap", "stabilizing_momentum_cap"])
def test_cap_belongs_to_the_capped_mode(mode: Any, cap: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.VirtualForceField(stabilizing=mode, **{cap: 1.0})
    assert names(caught.value) == "stabilizing"


@pytest.mark.parametrize("kind", ["Disc", "Rectangle", "MovingDisc", "MovingRectangle", "Human"])
@pytest.mark.parametrize(("active", "critical"), [(0.4, 0.4), (0.4, 0.8), (0.4, math.nextafter(0.4, 1.0))])
def test_active_region_must_be_larger_than_critical_region(kind: str, active: float, critical: float) -> None:
    build, right = RIGHT[kind]
    with pytest.raises(InvalidParameterError) as caught:
        build(**right, active_radius=active, critical_radius=critical)
    assert names(caught.value) in {"active_radius", "critical_radius"}


OBSTACLES = [
    nav.Disc(center=(3.9, 0.6), radius=0.1),
    nav.Disc(center=(3.65, 0.6), radius=0.1),
    nav.Rectangle(center=(3.9, 0.6), length=1.4, width=0.6),
    nav.Rectangle(center=(3.9, 0.15), length=1.4, width=0.6, heading=0.0),
    nav.Human(start=(3.5, 0.6), velocity=(1.0, 0.0)),
    nav.Human(start=(3.9, 0.6), velocity=(0.0, 0.0)),
    nav.MovingDisc(center=(4.1, 0.6), radius=0.2, velocity=(1.0, 0.0)),
    nav.MovingRectangle(center=(4.1, 0.6), length=0.4, width=0.1, velocity=(1.0, 0.0)),
]


@pytest.mark.parametrize("obstacle", OBSTACLES, ids=repr)
def test_robot_may_not_start_in_contact(obstacle: nav.Obstacle) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        nav.Scenario(start=(3.9, 0.6), goal=(-9.0, 0.6), obstacles=[obstacle])
    assert names(caught.value) == "start"


@pytest.mark.parametrize(
    "obstacle",
    [
        nav.Disc(center=(0.3, 0.6), radius=0.1),
        nav.Disc(center=(0.5, 0.6), radius=0.1, active_radius=0.8, critical_radius=0.4),
        nav.Rectangle(center=(0.0, 0.0), length=1.4, width=0.6),
        nav.Rectangle(center=(0.0, 0.6), length=1.4, width=0.6),
        nav.Human(start=(0.0, 0.6), velocity=(0.0, 0.0)),
    ],
    ids=repr,
)
def test_force_laws_refuse_a_goal_in_the_active_region_of_a_stationary_obstacle(obstacle: nav.Obstacle) -> None:
    scene = nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[obstacle])
    with pytest.raises(InvalidParameterError) as caught:
        nav.simulate(scene, nav.VirtualForceField())
    assert names(caught.value) == "goal"


RECORDINGS = [
    ([], np.empty((0, 2)), "time"),
    ([0.0, 0.4, 0.4], [[0, 0], [1, 0], [2, 0]], "time"),
    ([0.4, 0.0], [[0, 0], [1, 0]], "time"),
    ([0.0, NAN], [[0, 0], [1, 0]], "time"),
    ([0.0, INF], [[0, 0], [1, 0]], "time"),
    ([[0.0, 0.4]], [[0, 0], [1, 0]], "time"),
    ("ab", [[0, 0], [1, 0]], "time"),
    (None, [[0, 0], [1, 0]], "time"),
    ([0.0, 0.4], [[0, 0], [1, NAN]], "position"),
    ([0.0, 0.4], [[0, INF], [1, 0]], "position"),
    ([0.0, 0.4], [[0, 0]], "position"),
    ([0.0, 0.4], [0, 0], "position"),
    ([0.0, 0.4], [[0, 0, 0], [1, 0, 0]], "position"),
    ([0.0, 0.4], [["a", "b"], [1, 0]], "position"),
    ([0.0, 0.4], [[0, 0], [1]], "position"),
    ([0.0, 0.4], None, "position"),
]


@pytest.mark.parametrize(("time", "position", "argument"), RECORDINGS)
@pytest.mark.parametrize("build", [nav.Human.from_path, lambda *path: nav.MovingDisc.from_path(*path, radius=0.2)])
def test_bad_recording_is_refused_by_name(build: Callable[..., Any], time: Any, position: Any, argument: str) -> None:
    with pytest.raises((InvalidParameterError, ShapeError)) as caught:
        build(time, position)
    assert names(caught.value).split("[")[0] == argument


MOTIONS = [
    [],
    5,
    "abc",
    [1.0],
    [(1.0, (1.0, 0.0))],
    [(0.0, (1.0, 0.0), (0.0, 0.0))],
    [(-1.0, (1.0, 0.0), (0.0, 0.0))],
    [(NAN, (1.0, 0.0), (0.0, 0.0))],
    [(1.0, (1.0, NAN), (0.0, 0.0))],
    [(1.0, (1.0, 0.0), (INF, 0.0))],
    [(1.0, (1.0, 0.0, 0.0), (0.0, 0.0))],
    [(1.0, 1.0, (0.0, 0.0))],
    [("1", (1.0, 0.0), (0.0, 0.0))],
]


@pytest.mark.parametrize("segments", MOTIONS)
@pytest.mark.parametrize(
    "build", [nav.Human.from_segments, lambda *motion: nav.MovingDisc.from_segments(*motion, radius=0.2)]
)
def test_bad_motion_is_refused_by_name(build: Callable[..., Any], segments: Any) -> None:
    with pytest.raises((InvalidParameterError, ShapeError)) as caught:
        build((0.6, 0.0), segments)
    assert names(caught.value).startswith("segments")


def test_numbers_of_numpy_are_shown_as_numbers() -> None:
    cases = ((np.float64(1.5), "1.5"), ([np.float32(0.5), np.int8(3)], "[0.5, 3]"), ("np.int8(3)", "'np.int8(3)'"))
    for value, shown in cases:
        assert str(InvalidParameterError("radius", "be a number", value)) == f"radius must be a number, got {shown}"


@pytest.mark.parametrize("unit", ["ns", "s"])
@pytest.mark.parametrize("kind", [np.timedelta64, np.datetime64])
def test_an_instant_of_numpy_is_no_number(kind: type, unit: str) -> None:
    """NumPy turns those in ns into plain numbers: a second became a billion seconds."""
    moment = kind(10**9, unit)
    for name in ("time_limit", "seed"):
        with pytest.raises(InvalidParameterError, match=name):
            nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), **{name: moment})
    with pytest.raises(InvalidParameterError, match="rays"):
        reactive.Sonar(rays=moment)


_NO_NUMBERS = (np.timedelta64(5, "ns"), np.datetime64(5, "ns"), np.str_("5"), np.True_, np.complex128(5 + 2j))


@pytest.mark.parametrize("value", _NO_NUMBERS, ids=lambda value: type(value).__name__)
def test_an_array_without_an_axis_is_a_number_only_if_it_holds_one(value: Any) -> None:
    """Arrays of durations, words, truth values and complex numbers passed; complex scalars lost what is imaginary."""
    for given in (value, np.array(value), np.array(value, dtype=object)):
        with pytest.raises(InvalidParameterError, match="modulus must be a number"):
            contact.Linear(modulus=given)
        with pytest.raises(InvalidParameterError, match="stiffness must be a number"):
            impact.Foam(stiffness=given, damping=10.0)
        with pytest.raises(InvalidParameterError, match="speed must be a number"):
            contact.Contact(robot=3.0, region=75e3).simulate(given)
    for fine in (np.array(5), np.float32(5.0), np.array(5, dtype=np.uint8)):
        assert contact.Linear(modulus=fine) == contact.Linear(modulus=5.0)  # type: ignore[arg-type]  # what is tried


class _Unprintable:
    def __repr__(self) -> str:
        raise RuntimeError("nothing to show")


def test_what_cannot_be_printed_still_gets_its_rule() -> None:
    with pytest.raises(InvalidParameterError, match="mass must be a number, got an object of class _Unprintable"):
        nav.HolonomicRobot(mass=_Unprintable())
    nested: list[object] = []
    for _ in range(100_000):
        nested = [nested]
    with pytest.raises(InvalidParameterError, match="mass must be a number, got an object of class list"):
        nav.HolonomicRobot(mass=nested)


def test_numbers_of_other_kinds_are_taken_as_numbers() -> None:
    """Some were checked, and then computed with as they were given."""
    half = Decimal("0.5")
    assert len(nav.robots.WheelReference.sine(duration=5, period=half).angle) == 10
    pad = contact.Covering(material=contact.Linear(modulus=1e5), thickness=0.02, area=4e-3)
    hit = contact.Contact(robot=16.0, body=0.6, region=75e3, covering=pad)
    exact = hit.thickness(0.5, {"force": 280.0})
    assert hit.thickness(half, {"force": 280.0}) == exact  # type: ignore[arg-type]  # what is tried


def test_arrays_of_too_many_axes_are_refused_by_name() -> None:
    speed, hit = np.ones((1,) * 40), contact.Contact(robot=16.0, body=0.6, region=75e3)
    with pytest.raises(InvalidParameterError, match="speed must have at most 16 axes, got 40 axes"):
        hit.simulate_many(speed)


def test_names_without_a_hash_are_refused_by_name() -> None:
    controller = nav.Controller(nav.VirtualForceField(), nav.HolonomicRobot(), (5.0, 0.0))
    for name in (np.zeros(1, [("a", "f8")])[0], ([],)):
        with pytest.raises(InvalidParameterError, match="gone must hold names"):
            controller.update(0.0, (0.0, 0.0), (0.0, 0.0), gone=[name])


def test_drops_that_hold_rows_of_unequal_length_are_refused_by_name() -> None:
    uneven = [[[0.0], [0.0, 1.0]]]
    with pytest.raises(InvalidParameterError, match="drop_time must be a signal"):
        impact.identify_foam([0.0, 1.0], [0.0, 1.0], uneven, uneven, 1.5)


@pytest.mark.skipif(sys.platform == "win32", reason="links need rights there")
def test_a_link_that_leads_nowhere_is_called_so(tmp_path: Path) -> None:
    """The name of the link itself was what may have been meant."""
    for name, target in (("circle.toml", "circle.toml"), ("old.toml", "gone.toml")):
        (tmp_path / name).symlink_to(target)
        with pytest.raises(InvalidParameterError, match="a link that leads to no file"):
            scenarios.load(tmp_path / name)


def test_masked_arrays_that_another_thread_is_importing_disturb_no_call(monkeypatch: pytest.MonkeyPatch) -> None:
    # So it stands in `sys.modules` while its first lines are executed.
    monkeypatch.setitem(sys.modules, "numpy.ma", ModuleType("numpy.ma"))
    assert nav.Disc(center=(1.0, 2.0), radius=0.3).radius == 0.3
    assert nav.Lidar(mounting=(0.1, 0.0, 0.0)).mounting == (0.1, 0.0, 0.0)
