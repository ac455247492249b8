"""Separation distances: arguments, measured stops, the speed over the distance."""

from __future__ import annotations

import math
import pickle
import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import contact, standards
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plausibility import HrsafetyWarning, ImplausibleWarning

RULES = {"reaction_time": 0.1, "deceleration": 3.0, "intrusion": 0.2, "uncertainty": 0.1}
STOPS = standards.StoppingData(
    speed=[0.0, 0.5, 1.0, 2.0],
    load=[0.0, 10.0],
    time=[[0.0, 0.0], [0.2, 0.3], [0.3, 0.5], [0.7, 0.9]],
    distance=[[0.0, 0.0], [0.05, 0.07], [0.16, 0.2], [0.6, 0.8]],
)
MEASURED = {"reaction_time": 0.1, "intrusion": 0.2, "uncertainty": 0.1, "stopping": STOPS, "load": 5.0}


def test_arguments_broadcast_and_numbers_stay_numbers() -> None:
    assert type(standards.separation_distance(1.0, **RULES)) is float
    speeds = np.linspace(0.0, 2.0, 5)
    table = standards.separation_distance(speeds, **(RULES | {"human_speed": np.array([[0.0], [1.6]])}))
    assert table.shape == (2, 5)
    assert table[1, 2] == standards.separation_distance(1.0, **RULES)
    # The path of a person who stands still is left out, nothing else.
    assert table[0, 2] == pytest.approx(0.1 + 1.0 / 6.0 + 0.3, rel=1e-15)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"robot_speed": -0.1}, r"robot_speed must be finite and not negative, got -0.1"),
        ({"robot_speed": [1.0, math.nan]}, r"robot_speed\[1\] must be finite"),
        ({"target_speed": 1.1}, r"robot_speed must be at least target_speed \(1.1\), got 1.0"),
        ({"deceleration": 0.0}, r"deceleration must be finite and positive, got 0.0"),
        ({"deceleration": None}, r"deceleration must be given, or stopping in its place, got none"),
        ({"stopping": STOPS}, r"deceleration must be given, or stopping in its place, got both"),
        ({"reaction_time": [0.1, 0.2], "robot_speed": [1.0, 1.0, 1.0]}, r"robot_speed must broadcast with the other"),
        ({"uncertainty": "wide"}, r"uncertainty must be a number or an array of numbers, got 'wide'"),
        ({"human_speed": math.inf}, r"human_speed must be finite and not negative"),
    ],
)
def test_bad_arguments_are_named(arguments: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        standards.separation_distance(**({"robot_speed": 1.0} | RULES | arguments))


def test_too_close_is_the_target_speed() -> None:
    assert standards.separation_speed(0.45, **RULES) == 0.0
    assert standards.separation_speed(0.0, target_speed=0.3, **RULES) == 0.3
    assert standards.separation_speed(0.46, **RULES) == 0.0  # C + Z + v_h T_r
    assert standards.separation_speed(0.47, **RULES) > 0.0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"intrusion": 850.0}, "intrusion is 850 m, outside the plausible 0.008 to 5 m .*mm or cm given for m"),
        ({"intrusion": 0.00085}, "intrusion is 0.00085 m, .*turned into m twice"),
        ({"uncertainty": [0.1, 0.0, 0.0005]}, r"uncertainty is 0.0005 m \(element 2, 1 of 3 outside\)"),
        ({"deceleration": 30.0}, "deceleration is 30 m/s"),
        ({"uncertainty": [0.1, 100.0]}, r"uncertainty is 100 m \(element 1, 1 of 2 outside\)"),
        ({"reaction_time": 100.0}, "reaction_time is 100 s, .*ms given for s"),
        ({"deceleration": 3000.0}, "deceleration is 3000 m/s"),
        ({"human_speed": 1600.0}, "human_speed is 1600 m/s"),
    ],
)
def test_numbers_that_are_hardly_meant_are_told(arguments: dict[str, object], words: str) -> None:
    for call, value in ((standards.separation_distance, 1.0), (standards.separation_speed, 3.0)):
        with pytest.warns(ImplausibleWarning, match=words) as caught:
            answer = call(value, **(RULES | arguments))
        assert len(caught) == 1
        assert caught[0].filename == __file__
        assert np.isfinite(answer).all()
    with pytest.warns(ImplausibleWarning, match="robot_speed is 250 m/s"):
        standards.separation_distance(250.0, **RULES)
    with pytest.warns(ImplausibleWarning, match="distance is 1500 m"):
        standards.separation_speed(1500.0, **RULES)
    if all(isinstance(each, float) for each in arguments.values()):
        curve = standards.speed_over_distance([1.0], contact_speed=None, max_speed=1.5, **(RULES | arguments))
        assert [each.subject for each in curve.warnings] == list(arguments)


# ---- measured stops -------------------------------------------------------------------------


def test_measured_stops_are_linear_in_between() -> None:
    expected = 1.6 * (0.1 + 0.4) + 1.0 * 0.1 + 0.18 + 0.3
    assert standards.separation_distance(1.0, **MEASURED) == pytest.approx(expected, rel=1e-15)
    half = standards.separation_distance(1.5, **MEASURED)
    assert half == pytest.approx(1.6 * (0.1 + 0.6) + 1.5 * 0.1 + 0.44 + 0.3, rel=1e-15)


def test_nothing_is_extrapolated() -> None:
    with pytest.raises(
        InvalidParameterError, match=r"robot_speed must be within the measured stops, 0.0 to 2.0 \(outside_table"
    ):
        standards.separation_distance(2.1, **MEASURED)
    with pytest.raises(
        InvalidParameterError, match=r"load must be within the measured stops, 0.0 to 10.0 \(outside_table"
    ):
        standards.separation_distance(1.0, **(MEASURED | {"load": 11.0}))
    with pytest.raises(InvalidParameterError, match=r"load must be given"):
        standards.separation_distance(1.0, **(MEASURED | {"load": None}))
    assert standards.separation_speed(50.0, **MEASURED) == 2.0


def test_inverse_of_measured_stops() -> None:
    speeds = np.linspace(0.0, 2.0, 41)
    distances = standards.separation_distance(speeds, **MEASURED)
    assert np.all(np.diff(distances) > 0.0)
    assert standards.separation_speed(distances, **MEASURED) == pytest.approx(speeds, rel=1e-12, abs=1e-12)


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"distance": [0.0, 0.2, 0.1]}, r"distance\[2, 0, 0\] must not fall as the speed grows \(from 0.2\), got 0.1"),
        ({"time": [0.0, -0.1, 0.1]}, r"time\[1, 0, 0\] must be finite and not negative"),
        ({"speed": [0.0, 0.0, 1.0]}, r"speed\[1\] must exceed the value before it"),
        ({"time": [0.0, 0.1]}, r"time must have shape \(3, 1, 1\)"),
        ({"load": [0.0, 1.0]}, r"time must have shape \(3, 2, 1\)"),
    ],
)
def test_bad_stops_are_named(fields: dict[str, object], message: str) -> None:
    right = {"speed": [0.0, 0.5, 1.0], "time": [0.0, 0.1, 0.2], "distance": [0.0, 0.1, 0.2]}
    with pytest.raises((InvalidParameterError, ShapeError), match=message):
        standards.StoppingData(**(right | fields))


def _doubted(**stops: object) -> list[str]:
    table = standards.StoppingData(**stops)
    given = {"reaction_time": 0.1, "intrusion": 0.2, "uncertainty": 0.1, "stopping": table}
    given |= {} if np.ndim(stops.get("load", 0.0)) == 0 else {"load": np.min(stops["load"])}
    curve = standards.speed_over_distance([1.0], contact_speed=None, max_speed=1.0, **given)
    assert curve.warnings == table.doubts
    for call, value in ((standards.separation_distance, float(np.max(table.speed))), (standards.separation_speed, 1.0)):
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            call(value, **given)
        assert [str(each.message) for each in caught] == [each.message for each in table.doubts]
        assert all(each.category is ImplausibleWarning for each in caught)
    assert all(each.code == "stops_inconsistent" and not each.safe_side for each in table.doubts)
    return [each.message for each in table.doubts]


@pytest.mark.parametrize(
    ("factors", "names"),
    [
        ({"time": 1e3, "distance": 1e3}, ["stopping.time"]),
        ({"speed": 1e3, "distance": 1e3}, ["stopping.speed"]),
        ({"speed": 1e3, "time": 1e-3}, ["stopping.speed"]),
        ({"time": 1e3}, ["stopping.time"]),
        ({"distance": 1e4}, ["stopping.distance"]),
    ],
)
def test_stops_in_other_units_are_implausible(factors: dict[str, float], names: list[str]) -> None:
    stops = {"speed": [0.0, 0.5, 1.0], "time": [0.0, 0.2, 0.3], "distance": [0.0, 0.05, 0.16]}
    right = standards.StoppingData(**stops)
    assert right.doubts == ()
    wrong = {name: np.multiply(values, factors.get(name, 1.0)) for name, values in stops.items()}
    found = standards.StoppingData(**wrong).doubts
    assert [each.subject for each in found if each.code == "implausible"] == names
    drive = contact.Drive(stopping=standards.StoppingData(**wrong), reaction_time=0.1)
    assert {f"drive.{name}" for name in names} <= {each.subject for each in drive.doubts}


def test_stops_that_no_robot_makes_are_told() -> None:
    (told,) = _doubted(speed=[0.0, 0.5, 1.0, 1.5], time=[0.0, 0.02, 0.03, 0.04], distance=[0.0, 0.05, 0.16, 0.35])
    for word in ("speed 1.5 m/s", "time 0.04 s", "distance 0.35 m", "3 of 4", "no more than speed times time"):
        assert word in told
    (told,) = _doubted(speed=[0.0, 1.0, 2.0], time=[0.0, 0.3, 0.7], distance=[0.0, 0.00016, 0.0006])
    assert "speed 2 m/s" in told
    assert "in another unit" in told
    for time in ([0.0, 0.0, 0.0], [0.0, 0.01, 0.03]):
        (told,) = _doubted(speed=[0.0, 0.5, 1.0], time=time, distance=[0.0, 0.5 * time[1] * 0.5, 0.5 * time[2]])
        assert "speed 1 m/s" in told
        assert "25 m/s^2 at most takes longer" in told
    # A load that is not asked for counts, too; and both kinds at once.
    loads = {"speed": [0.0, 1.0, 2.0], "load": [0.0, 10.0], "time": [[0.0, 0.0], [0.3, 0.03], [0.7, 0.05]]}
    assert len(_doubted(**loads, distance=[[0.0, 0.0], [0.16, 0.16], [0.6, 0.6]])) == 1
    assert len(_doubted(**loads, distance=[[0.0, 0.0], [0.001, 0.16], [0.002, 0.6]])) == 2


@settings(max_examples=60)
@given(
    most=st.floats(0.1, 8.0),
    braking=st.floats(0.5, 20.0),
    reaction=st.floats(0.0, 0.3),
    shape=st.floats(0.5, 3.0),
)
def test_stops_of_robots_are_plausible_as_they_are_rounded(
    most: float, braking: float, reaction: float, shape: float
) -> None:
    speed = np.linspace(0.0, most, 5)
    # The speed falls as a power of the time that is left, from hard first to hard last, after a reaction at full speed.
    time = reaction * (speed > 0.0) + speed / braking
    distance = speed * reaction + speed**2 / braking / (1.0 + shape)
    assert _doubted(speed=speed, time=np.round(time, 2), distance=np.round(distance, 2)) == []


def test_stops_are_pickled_by_value() -> None:
    again = pickle.loads(pickle.dumps(STOPS))
    assert standards.separation_distance(1.3, **(MEASURED | {"stopping": again})) == standards.separation_distance(
        1.3, **MEASURED
    )


# ---- speed over the distance ----------------------------------------------------------------


@pytest.mark.parametrize("braking", [RULES, MEASURED])
def test_the_curve_is_continuous_and_names_its_mode(braking: dict[str, object]) -> None:
    distance = np.linspace(0.0, 6.0, 6001)
    curve = standards.speed_over_distance(distance, contact_speed=0.3, max_speed=1.2, **braking)
    assert curve.speed[0] == 0.3
    assert curve.speed[-1] == 1.2
    assert np.all(np.diff(curve.speed) >= 0.0)
    assert np.diff(curve.speed).max() < 0.01
    assert set(curve.mode[curve.speed > 0.3]) == {"separation"}
    assert set(curve.mode[curve.speed == 0.3]) == {"contact"}
    assert curve.capped[-1]
    assert not curve.outside_table.any()


def test_without_permitted_contact_the_robot_stops() -> None:
    curve = standards.speed_over_distance([0.0, 0.3, 2.0], contact_speed=None, max_speed=2.0, **RULES)
    assert curve.status == "not_permitted"
    assert curve.speed[:2].tolist() == [0.0, 0.0]
    assert curve.speed[2] == standards.separation_speed(2.0, **RULES)


def test_the_end_of_the_table_is_a_flag() -> None:
    curve = standards.speed_over_distance([1.0, 9.0], contact_speed=0.3, max_speed=5.0, **MEASURED)
    assert curve.outside_table.tolist() == [False, True]
    assert curve.speed[1] == 2.0


def test_slowing_down_to_a_speed_above_that_of_contact_is_refused() -> None:
    with pytest.raises(InvalidParameterError, match=r"target_speed must be at most contact_speed \(0.3\)"):
        standards.speed_over_distance([1.0], contact_speed=0.3, max_speed=1.0, target_speed=0.4, **RULES)


# ---- guards ---------------------------------------------------------------------------------


def test_guards() -> None:
    found = standards.minimum_distance(0.32, capability=0.014)
    assert found == (0.512, 0.64, 1.6, 0.0)
    assert standards.minimum_distance(0.3).distance == pytest.approx(1.6 * 0.3 + 0.85)
    assert standards.minimum_distance(0.3, height=0.5).intrusion == 1.0
    with pytest.raises(InvalidParameterError, match=r"height must be at least 0.3 for a capability of 0.07"):
        standards.minimum_distance(0.3, height=0.2, capability=0.07)
    with pytest.raises(InvalidParameterError, match=r"capability must be at most 0.04"):
        standards.minimum_distance(0.3, capability=0.05)
    with pytest.raises(InvalidParameterError, match=r"stopping_time must be finite and positive"):
        standards.minimum_distance(0.0)


@settings(max_examples=100, deadline=None)
@given(
    stop=st.floats(1e-4, 2.0),
    capability=st.none() | st.floats(1e-3, 0.04),
    height=st.none() | st.floats(0.0, 1.0),
)
def test_no_guard_is_nearer_than_a_tenth_of_a_meter(
    stop: float, capability: float | None, height: float | None
) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HrsafetyWarning)
        found = standards.minimum_distance(stop, capability=capability, height=height)
        assert found.distance >= 0.1
        assert found.distance <= standards.minimum_distance(stop + 0.1, capability=capability, height=height).distance
    assert standards.minimum_distance(0.01, capability=0.014).distance == 0.1
    for high in (300.0, 1.5):
        with pytest.raises(InvalidParameterError, match=r"height must be at most 1.*give it in meters"):
            standards.minimum_distance(0.3, height=high)


def test_people_who_are_taken_to_stand_are_told() -> None:
    """Nobody has to stand still, and km/s are no m/s."""
    for speed in (0.0, 0.0016, [0.0, 0.0]):
        rules = RULES | {"human_speed": speed}
        with pytest.warns(HrsafetyWarning, match=r"people are taken to stand still.*1\.6 m/s"):
            standards.separation_distance(1.0, **rules)
        with pytest.warns(HrsafetyWarning, match="people are taken to stand still"):
            standards.separation_speed(3.0, **rules)
    curve = standards.speed_over_distance([0.5, 2.0], contact_speed=0.2, max_speed=1.0, **RULES | {"human_speed": 0.0})
    assert [(each.code, each.subject) for each in curve.warnings] == [("taken_as_zero", "human_speed")]
    # Measured speeds of somebody who stands now and then are no such thing.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        standards.separation_distance(1.0, **RULES | {"human_speed": [0.0, 1.2]})


def test_contact_at_a_high_speed_is_told_by_every_function() -> None:
    rules = RULES | {"target_speed": 3.0}
    for call, value in ((standards.separation_distance, 5.0), (standards.separation_speed, 8.0)):
        with pytest.warns(ImplausibleWarning, match="target_speed is 3 m/s, outside the plausible 0 to 2 m/s"):
            call(value, **rules)


# ---- the field of a scanner ---------------------------------------------------------------------

FIELD = {"contact_speed": 0.25, "reaction_time": 0.12, "deceleration": 2.5, "uncertainty": 0.1}


@pytest.mark.parametrize(("height", "reached"), [(0.0, 1.2), (0.3, 1.08), (0.875, 0.85), (1.0, 0.85)])
def test_the_height_of_a_field_gives_its_intrusion(height: float, reached: float) -> None:
    found = standards.field_distances(1.0, height=height, **FIELD)
    given = standards.field_distances(1.0, intrusion=reached, **FIELD)
    assert found.stop_terms["intrusion"] == pytest.approx(reached)
    assert (found.stop, found.slow_down) == pytest.approx((given.stop, given.slow_down))
    assert found.warnings == given.warnings == ()


@pytest.mark.parametrize("intrusion", [0.0, 0.2, 0.8499])
def test_an_intrusion_that_no_field_has_is_doubted(intrusion: float) -> None:
    (doubt,) = standards.field_distances(1.0, intrusion=intrusion, **FIELD).warnings
    assert (doubt.code, doubt.safe_side) == ("intrusion_too_short", False)


@pytest.mark.parametrize(("speed", "codes"), [(0.0, ["taken_as_zero"]), (0.25, ["slow_person"]), (1.6, []), (2.0, [])])
def test_people_who_are_slower_than_the_standard_has_them_are_told(speed: float, codes: list[str]) -> None:
    found = standards.field_distances(1.0, height=0.3, human_speed=speed, **FIELD)
    assert [each.code for each in found.warnings] == codes


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"height": 0.3, "intrusion": 1.08}, "intrusion must not be given beside the height"),
        ({"capability": 0.05}, "capability must stand beside the height"),
        ({"height": 1.2}, "height must be"),
        ({"height": 0.1, "capability": 0.07}, "height must be at least 0.3 for a capability of 0.07"),
    ],
)
def test_fields_that_cannot_be_are_refused(arguments: dict[str, float], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        standards.field_distances(1.0, **FIELD, **arguments)
