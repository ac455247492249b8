"""A contact as one object: what it refuses, whose doubts it carries, and that every result is of the same contact."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import arms, contact, standards
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import unsafe_doubts

PAD = contact.Covering(material=contact.Linear(modulus=2e5), thickness=0.02, area=4e-3)
HAND = standards.limits().contact("hand_finger", "transient")
CHEST = standards.limits().contact("chest", "transient")
DRIVE = contact.Support(stiffness=20e3, damping=200.0, stop=(0.01, 10.0))


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"robot": -1.0}, "robot must be finite and positive"),
        ({"robot": math.nan}, "robot must be"),
        ({"robot": HAND}, "robot must be a number"),
        ({"robot": None}, "robot must be a number"),
        ({"body": 0.0}, "body must be finite and positive"),
        ({"drive": 20e3}, "drive must be a Support"),
        ({"support": DRIVE}, "support.stop must be None: a body does not brake"),
        ({"covering": PAD, "area": 1e-4}, "area must be None with a covering"),
        ({"max_strain": 0.3}, "max_strain must be None without a covering"),
        ({"region": {"k": -1.0}}, "region.k must be"),
    ],
)
def test_a_wrong_contact_is_refused(more: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        contact.Contact(**({"robot": 8.0} | more))


@pytest.mark.parametrize(
    ("more", "words"),
    [
        ({"damping": -1.0}, "damping must be"),
        ({"stiffness": math.inf}, "stiffness must be"),
        ({"stop": 1.0}, "stop must be a time and a deceleration"),
        ({"stop": (-1.0, 1.0)}, "stop.time must be"),
        ({"stop": (0.0, 0.0)}, "stop.deceleration must be"),
    ],
)
def test_a_wrong_support_is_refused(more: dict[str, Any], words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        contact.Support(**more)


def test_a_body_that_is_a_limit_object_brings_its_limits() -> None:
    of_object, of_numbers = (
        contact.Contact(robot=8.0, body=HAND, area=1e-4),
        contact.Contact(robot=8.0, body=HAND.body_mass, region=HAND.spring_constant, area=1e-4),
    )
    limits = {"force": HAND.force, "pressure": HAND.pressure}
    assert of_object.allowed_speed() == of_object.allowed_speed(HAND) == of_object.allowed_speed(limits)
    assert of_object.allowed_speed().speed == of_numbers.allowed_speed(limits).speed
    assert of_object.simulate(0.3).peak_force == of_numbers.simulate(0.3).peak_force
    assert of_object.sensitivity() == of_numbers.sensitivity(limits)
    with pytest.raises(InvalidParameterError, match=r"limits must be of the region and class of body \(hand_finger"):
        of_object.allowed_speed(CHEST)
    with pytest.raises(InvalidParameterError, match="region must have the spring constant of limits"):
        contact.Contact(robot=8.0, body=HAND, region={}).simulate(0.3)  # rigid
    face = standards.limits().contact("face", "transient")
    touched = contact.Contact(robot=8.0, body=face, covering=PAD)
    assert touched.simulate(0.1).peak_force is not None
    for call in (touched.allowed_speed, touched.allowed_speeds, touched.sensitivity):
        for own in (None, {"force": 65.0}, face):
            with pytest.raises(InvalidParameterError, match="not_permitted"):
                call(own)
    for speed in (touched.thickness, touched.probability):
        with pytest.raises(InvalidParameterError, match="not_permitted"):
            speed(0.1, {"force": 65.0})


def test_limits_that_nobody_gives_are_not_checked() -> None:
    found = contact.Contact(robot=8.0, region=25e3).allowed_speed()
    assert found.status == "not_checked"
    assert found.not_checked == ("force", "pressure")
    assert [each.code for each in unsafe_doubts(found.warnings)] == ["not_checked", "not_checked", "drive_not_given"]


@pytest.mark.parametrize("support", [{"drive": DRIVE}, {"support": contact.Support(stiffness=1e3)}])
def test_a_support_is_never_ignored(support: dict[str, contact.Support]) -> None:
    held = contact.Contact(robot=8.0, body=40.0, region=25e3, covering=PAD, **support)
    for call in (held.thickness, held.probability):
        with pytest.raises(InvalidParameterError, match="must be None for a"):
            call(0.3, {"force": 140.0})
    with pytest.raises(InvalidParameterError, match="must be None for a sensitivity"):
        held.sensitivity({"force": 140.0})
    free = contact.Contact(robot=8.0, body=40.0, region=25e3, covering=PAD)
    assert held.simulate(0.3).peak_force != free.simulate(0.3).peak_force
    assert held.simulate_many([0.3]).peak_force[0] == held.simulate(0.3).peak_force
    limits = {"force": 140.0}
    assert held.allowed_speeds(limits, robot_mass=[8.0]).speed[0] == held.allowed_speed(limits).speed


def test_doubts_about_the_robot_are_doubts_about_every_result() -> None:
    arm = arms.Arm.example(payload=arms.Payload("tool", 2.0))
    robot = contact.ContactRobot.of_arm(arm, link="tool", poses=[[0.0, 0.4, 1.4, 0.0, 0.0, 0.0]])
    assert [each.code for each in unsafe_doubts(robot.warnings)] == ["no_motor_inertia"]
    hit = contact.Contact(robot=robot, body=40.0, region=25e3, covering=PAD)
    limits = {"force": 140.0, "pressure": 190e4}
    results = (
        hit.allowed_speed(limits),
        hit.allowed_speeds(limits, robot_mass=[8.0]),
        hit.simulate(0.2),
        hit.simulate_many([0.2]),
        hit.thickness(0.2, limits),
        hit.probability(0.2, limits, robot_mass={"lognormal": [robot.mass, 0.1]}, draws=100),
    )
    assert all(robot.warnings[0] in result.warnings for result in results)
    alone = contact.Contact(robot=robot.mass, body=40.0, region=25e3, covering=PAD)
    assert alone.allowed_speed(limits).warnings == ()
    assert alone.allowed_speed(limits).speed == hit.allowed_speed(limits).speed


def test_a_contact_is_a_value() -> None:
    hit = contact.Contact(robot=8.0, body=HAND, covering=PAD, drive=DRIVE)
    assert pickle.loads(pickle.dumps(hit)) == hit
    assert (
        contact.Contact(robot=8, covering={"material": PAD.material, "thickness": 0.02, "area": 4e-3}).covering == PAD
    )


@settings(max_examples=30, deadline=None)
@given(
    robot=st.floats(0.5, 200.0),
    body=st.one_of(st.none(), st.floats(0.5, 100.0)),
    stiffness=st.floats(5e3, 2e5),
    force=st.floats(20.0, 500.0),
    covered=st.booleans(),
)
def test_allowed_speed_loads_and_thickness_are_of_one_contact(
    robot: float, body: float | None, stiffness: float, force: float, covered: bool
) -> None:
    hit = contact.Contact(robot=robot, body=body, region=stiffness, covering=PAD if covered else None)
    limits = {"force": force}
    found = hit.allowed_speed(limits)
    if found.speed is None or found.governs != "force" or found.speed < 1e-3:
        return
    peak = hit.simulate(found.speed, horizon=10.0, tolerance=1e-10).peak_force
    assert peak == pytest.approx(force, rel=1e-5)
    assert np.isclose(hit.allowed_speeds(limits, robot_mass=[robot]).speed[0], found.speed, rtol=1e-12)
    assert hit.sensitivity(limits)["force_limit"] > 0.0
    if covered:
        thicker = hit.thickness(0.99 * found.speed, limits).thickness
        assert thicker is not None
        assert thicker <= PAD.thickness * (1.0 + 1e-6)


def test_columns_of_many_contacts_carry_their_units() -> None:
    hit = contact.Contact(robot=8.0, body=40.0, region=25e3, covering=PAD)
    speeds = hit.allowed_speeds({"force": 140.0}, robot_mass=[8.0, 9.0]).columns()
    assert {"speed_m_per_s", "speed_force_m_per_s", "covering_compression_m", "governs"} <= set(speeds)
    loads = hit.simulate_many([0.1, 0.2]).columns()
    assert {"peak_force_N", "peak_pressure_Pa", "peak_body_acceleration_g", "hic15", "rebound_speed_m_per_s"} <= set(
        loads
    )
    assert {"t_s", "force_N", "body_acceleration_m_per_s2"} <= set(hit.simulate(0.1).columns())
    assert "peak_pressure" in repr(hit.simulate(0.1))
    assert " Pa" in repr(hit.simulate(0.1))
