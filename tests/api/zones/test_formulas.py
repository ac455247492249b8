"""Closed forms of zones: the numbers of manuals and of the literature, and what must hold for any robot."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import zones
from hrsafety.errors import InvalidParameterError

BODY = [(0.4, 0.3), (0.4, -0.3), (-0.4, -0.3), (-0.4, 0.3)]

SPEEDS = st.floats(0.0, 3.0)
DECELERATIONS = st.floats(0.2, 5.0)
TIMES = st.floats(0.0, 1.0)


@pytest.fixture(scope="module")
def cases(shared: Path) -> dict[int, dict[str, Any]]:
    expected = json.loads((shared / "data" / "formats" / "expected.json").read_text(encoding="utf-8"))
    return {each["case"]: each for each in expected["zones"]}


def field(given: dict[str, float]) -> float:
    return zones.protective_field(
        given["v"],
        deceleration=given["d"],
        control_time=given["tc"],
        scanner_time=given["ts"],
        tolerance=given["TZ"],
        reflector=given["ZR"],
        clearance=given["ZF"],
        brake_wear=given["zb"],
        person_speed=given.get("u", 0.0),
    )


def test_a_protective_field_is_that_of_manuals_and_longer_for_who_walks(cases: dict[int, Any]) -> None:
    for case in (1, 2):
        assert field(cases[case]["given"]) == pytest.approx(cases[case]["result"], abs=1e-6)


def test_a_stop_takes_the_way_and_the_time_of_brakes_that_build_up(cases: dict[int, Any]) -> None:
    given = cases[3]["given"]
    stop = zones.stopping_travel(given["v"], deceleration=given["d"], reaction_time=given["T"], build_up=given["tb"])
    assert stop == pytest.approx(cases[3]["result"], abs=1e-6)


def test_a_zone_reaches_behind_a_robot_that_is_slower_than_people(cases: dict[int, Any]) -> None:
    for (v, d, reaction, u), result in zip(cases[4]["given"], cases[4]["result"], strict=True):
        found = zones.rear_extension(v, deceleration=d, reaction_time=reaction, person_speed=u)
        assert found == pytest.approx(result, abs=1e-6)


def test_a_leg_enters_so_deep_before_enough_beams_meet_it(cases: dict[int, Any]) -> None:
    given = cases[5]["given"]
    found = zones.leg_depth(given["rho"], distance=given["r"], beam_step=given["dphi"], points=given["n"])
    assert found == pytest.approx(cases[5]["result"], abs=1e-6)
    blind = zones.blind_range(0.06, beam_step=math.radians(0.5), points=4)
    assert blind == pytest.approx(3.4377, abs=1e-4)
    assert math.isinf(zones.leg_depth(0.06, distance=blind * 1.001, beam_step=math.radians(0.5), points=4))


def test_approach_touches_a_person_who_walks(cases: dict[int, Any]) -> None:
    given = cases[6]["given"]
    settings_ = {"person_speed": given["u"], "reaction_time": given["T"], "time_before_collision": given["tau"]}
    found = zones.approach_contact_speed(given["v"], **settings_)
    assert found == pytest.approx(cases[6]["result"], abs=1e-6)
    assert zones.approach_contact_speed(given["v"], **{**settings_, "person_speed": 0.0}) == 0.0
    with pytest.raises(InvalidParameterError, match="reaction_time must be below"):
        zones.approach_contact_speed(0.5, **{**settings_, "reaction_time": 1.0})


def test_a_stop_in_a_turn_reaches_as_far_as_the_union_over_time(cases: dict[int, Any]) -> None:
    given = cases[7]["given"]
    length, width = given["half_length"], given["half_width"]
    found = zones.turning_extents(
        given["v"],
        given["turn_rate"],
        footprint=[(length, width), (length, -width), (-length, -width), (-length, width)],
        deceleration=given["d"],
        reaction_time=given["T"],
        person_speed=given["u"],
    )
    assert found == pytest.approx(cases[7]["result"], abs=1e-6)


def test_a_margin_allows_a_speed(cases: dict[int, Any]) -> None:
    for (margin, d, reaction, u, e), result in zip(cases[8]["given"], cases[8]["result"], strict=True):
        found = zones.allowed_speed(margin, deceleration=d, reaction_time=reaction, person_speed=u, error=e)
        assert found == pytest.approx(result, abs=1e-6)


@given(speed=SPEEDS, deceleration=DECELERATIONS, reaction=TIMES, rise=TIMES)
def test_a_stop_is_what_integration_gives(speed: float, deceleration: float, reaction: float, rise: float) -> None:
    stop = zones.stopping_travel(speed, deceleration=deceleration, reaction_time=reaction, build_up=rise)
    steps = 20000
    time = np.linspace(0.0, stop.time, steps + 1)
    braking = np.maximum(time - reaction, 0.0)
    built = np.minimum(braking, rise)
    lost = deceleration * ((built**2 / (2.0 * rise) if rise > 0.0 else 0.0) + braking - built)
    left = speed - lost
    assert left[-1] == pytest.approx(0.0, abs=1e-9)
    travel = float(np.sum(0.5 * (left[1:] + left[:-1])) * stop.time / steps)
    assert stop.travel == pytest.approx(travel, abs=1e-5)


@given(
    margin=st.floats(0.0, 5.0),
    deceleration=DECELERATIONS,
    reaction=TIMES,
    person=st.floats(0.0, 2.0),
    error=st.floats(0.0, 0.2),
)
def test_the_allowed_speed_uses_up_the_margin(
    margin: float, deceleration: float, reaction: float, person: float, error: float
) -> None:
    rules = {"deceleration": deceleration, "reaction_time": reaction}
    speed = zones.allowed_speed(margin, **rules, person_speed=person, error=error)
    stop = zones.stopping_travel(speed, **rules)
    needed = stop.travel + person * stop.time + error
    if speed > 0.0:
        assert needed == pytest.approx(margin, abs=1e-9)
    else:
        assert needed >= margin - 1e-12


@settings(max_examples=30)
@given(
    speed=st.floats(0.05, 2.0),
    turn=st.floats(-2.0, 2.0),
    deceleration=DECELERATIONS,
    reaction=TIMES,
    person=st.floats(0.0, 2.0),
)
def test_a_turn_reaches_no_farther_than_path_and_walk_together(
    speed: float, turn: float, deceleration: float, reaction: float, person: float
) -> None:
    rules = {"deceleration": deceleration, "reaction_time": reaction}
    found = zones.turning_extents(speed, turn, footprint=BODY, **rules, person_speed=person)
    stop = zones.stopping_travel(speed, **rules)
    assert max(found) <= 0.5 + stop.travel + person * stop.time + 1e-9
    # Somebody walks for the whole stop: no side is nearer than the body and less than what a standing robot leaves.
    assert found.left >= 0.3
    assert found.front >= 0.4
    mirrored = zones.turning_extents(speed, -turn, footprint=BODY, **rules, person_speed=person)
    assert (mirrored.left, mirrored.right) == pytest.approx((found.right, found.left), abs=1e-9)


@pytest.mark.parametrize(
    ("call", "argument"),
    [
        (lambda: zones.stopping_travel(-1.0, deceleration=1.0, reaction_time=0.1), "speed"),
        (lambda: zones.stopping_travel(1.0, deceleration=0.0, reaction_time=0.1), "deceleration"),
        (lambda: zones.leg_depth(0.06, distance=1.0, beam_step=0.01, points=0), "points"),
        (lambda: zones.allowed_speed(math.nan, deceleration=1.0, reaction_time=0.1, person_speed=1.6), "margin"),
        (
            lambda: zones.turning_extents(0.0, 1.0, footprint=BODY, deceleration=1.0, reaction_time=0.1),
            "speed",
        ),
        (
            lambda: zones.turning_extents(1.0, 1.0, footprint=BODY[:2], deceleration=1.0, reaction_time=0.1),
            "footprint",
        ),
    ],
)
def test_a_number_out_of_range_is_named(call: Any, argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        call()
    assert caught.value.argument == argument
