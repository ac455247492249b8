"""A limit object tells spring, mass and class of its region; what contradicts it is refused everywhere alike."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from api import contact_calls
from hrsafety import contact, standards
from hrsafety.errors import InvalidParameterError

ISO = standards.limits()
PAD = contact.Covering(material=contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9), thickness=0.02, area=4e-4)
CALLS: dict[str, Callable[..., Any]] = {
    "allowed_speed": lambda **body: contact_calls.allowed_speed(robot_mass=8.0, area=1e-4, **body).speed,
    "allowed_speeds": lambda **body: contact_calls.allowed_speeds(robot_mass=[8.0], area=1e-4, **body).speed[0],
    "thickness": lambda **body: contact_calls.thickness(robot_mass=8.0, speed=0.6, covering=PAD, **body).thickness,
    "sensitivity": lambda **body: tuple(contact_calls.sensitivity(robot_mass=8.0, area=1e-4, **body).values()),
    "probability": lambda **body: (
        contact_calls.probability(
            speed=0.2, robot_mass={"lognormal": [8.0, 0.1]}, area=1e-4, draws=2000, **body
        ).quantiles
    ),
    "simulate": lambda **body: contact_calls.simulate(robot_mass=8.0, closing_speed=0.2, **body).peak_force,
    "batch": lambda **body: contact_calls.batch(robot_mass=8.0, closing_speed=[0.2], **body).peak_force[0],
}
LOADS = ("simulate", "batch")
"""Of a collision the limit object is the body: there is no other mass that could contradict it."""
permitted = st.sampled_from([each for each in ISO.regions if each not in ("skull_forehead", "face")])


def test_the_chest_is_not_taken_for_clamped() -> None:
    chest = ISO.contact("chest", "transient")
    free = contact_calls.allowed_speed(robot_mass=16.35, limits=chest, area=1e-4)
    assert round(free.speed or 0.0, 3) == 0.446  # 0.521 with an infinite mass, 0.188 if it were clamped
    assert contact_calls.allowed_speed(robot_mass=16.35, region=25e3, limits=chest, area=1e-4) == free


@settings(max_examples=12, deadline=None)
@given(permitted, st.sampled_from(standards.CONTACTS), st.sampled_from(sorted(CALLS)))
def test_what_is_left_out_is_that_of_the_object(region: str, kind: str, name: str) -> None:
    limit = ISO.contact(region, kind)
    told = {"region": limit.spring_constant, "body_mass": limit.body_mass, "limits": limit}
    if name == "probability" and kind == "quasi_static":
        del told["body_mass"]
    whole = CALLS[name](**told)
    for left in ({"region"}, {"body_mass"}, {"region", "body_mass"}):
        assert CALLS[name](**{key: each for key, each in told.items() if key not in left}) == whole


@settings(max_examples=25, deadline=None)
@given(permitted, permitted, st.sampled_from(standards.CONTACTS), st.sampled_from(sorted(CALLS)))
def test_what_is_of_another_region_or_class_is_refused(region: str, other: str, kind: str, name: str) -> None:
    limit = ISO.contact(region, kind)
    wrong = ISO.contact(other, "transient")
    if wrong.spring_constant != limit.spring_constant:
        with pytest.raises(InvalidParameterError, match=f"spring constant of limits .{region}"):
            CALLS[name](region=wrong.spring_constant, limits=limit)
    if wrong.body_mass != limit.body_mass and name not in LOADS:
        with pytest.raises(InvalidParameterError, match=f"be that of limits .{region}"):
            CALLS[name](body_mass=wrong.body_mass, limits=limit)
    if kind == "transient" and name not in LOADS:
        with pytest.raises(InvalidParameterError, match="be that of limits"):
            CALLS[name](body_mass=math.inf, limits=limit)
    with pytest.raises(InvalidParameterError, match="spring constant of limits"):
        CALLS[name](region={"k": limit.spring_constant, "n": 1.5}, limits=limit)
    with pytest.raises(InvalidParameterError, match="spring constant of limits"):
        CALLS[name](region={}, limits=limit)  # rigid


@pytest.mark.parametrize("name", ["stiffness", "force_limit", "pressure_limit"])
def test_arrays_and_spreads_of_another_region_are_refused(name: str) -> None:
    hand, arm = ISO.contact("hand_finger", "transient"), ISO.contact("lower_arm_wrist", "transient")
    of_hand, of_arm = (
        {"stiffness": each.spring_constant, "force_limit": each.force, "pressure_limit": each.pressure}[name]
        for each in (hand, arm)
    )
    assert of_hand is not None
    case: dict[str, Any] = {"robot_mass": 8.0, "limits": hand, "area": 1e-4}
    own = contact_calls.allowed_speeds(**case, **{name: [of_hand, of_hand]})
    assert own.speed.tolist() == [contact_calls.allowed_speed(**case).speed] * 2
    around = contact_calls.probability(**case, speed=0.3, draws=500, **{name: {"lognormal": [0.95 * of_hand, 0.1]}})
    assert around.draws == 500
    if of_arm == of_hand:
        return
    with pytest.raises(InvalidParameterError, match="hand_finger, free to give way"):
        contact_calls.allowed_speeds(**case, **{name: [of_hand, of_arm]})
    for spread in ({"lognormal": [2.0 * of_hand, 0.1]}, {"uniform": [1.1 * of_hand, 2.0 * of_hand]}):
        with pytest.raises(InvalidParameterError, match="within its own spread"):
            contact_calls.probability(**case, speed=0.3, **{name: spread})


def test_what_neither_knows_is_asked_for(tmp_path: Any) -> None:
    path = tmp_path / "own.csv"
    path.write_text("region,contact,force_N,source\nchest,transient,100,own tests\n")
    chest = standards.limits(path).contact("chest", "transient")
    with pytest.raises(InvalidParameterError, match="region must be given: limits has no spring constant"):
        contact_calls.allowed_speed(robot_mass=8.0, limits=chest, body_mass=40.0)
    with pytest.raises(InvalidParameterError, match="body_mass must be given: limits has no mass"):
        contact_calls.allowed_speed(robot_mass=8.0, limits=chest, region=25e3)
    assert contact_calls.allowed_speed(robot_mass=8.0, limits=chest, region=25e3, body_mass=40.0).speed is not None
