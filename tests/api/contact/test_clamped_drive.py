"""A clamped contact is that of a robot without drive, and every result of one says so unless the drive is given."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from api import contact_calls
from hrsafety import InvalidParameterError, contact, standards

LIMITS = {"force": 140.0, "pressure": 1e6}
CASE: dict[str, Any] = {"robot_mass": 8.0, "region": 25e3, "limits": LIMITS}
DRIVE: dict[str, Any] = {"robot_stiffness": 1e4, "stop": (0.1, 3.0), "horizon": 8.0}
PAD = {"material": {"law": "linear", "E": 1e5}, "thickness": 0.02, "area": 4e-3}


def told(result: Any) -> bool:
    """Return whether a result says that the drive is not known."""
    found = [each for each in result.warnings if each.code == "drive_not_given"]
    assert all(not each.safe_side for each in found)
    return bool(found)


def test_an_allowed_speed_says_that_it_holds_without_drive() -> None:
    alone, driven = contact_calls.allowed_speed(**CASE), contact_calls.allowed_speed(**CASE, **DRIVE)
    assert (told(alone), told(driven)) == (True, False)
    assert alone.speed > driven.speed > 0.0
    # Half of a drive is none: a support that never moves, or a stop of nothing.
    assert told(contact_calls.allowed_speed(**CASE, robot_stiffness=1e4))
    assert told(contact_calls.allowed_speed(**CASE, stop=(0.1, 3.0), horizon=1.0))


@given(st.floats(0.5, 200.0), st.floats(0.5, 80.0) | st.just(math.inf) | st.none())
def test_only_what_is_clamped_is_pressed_on(robot_mass: float, body_mass: float | None) -> None:
    clamped = body_mass is None or math.isinf(body_mass)
    case = {**CASE, "robot_mass": robot_mass}
    assert told(contact_calls.allowed_speed(**case, body_mass=body_mass, area=1e-3)) == clamped


def test_every_kind_of_speed_says_it() -> None:
    rows = contact_calls.allowed_speeds(**{**CASE, "body_mass": [40.0, np.inf, np.inf]})
    (doubt,) = [each for each in rows.warnings if each.code == "drive_not_given"]
    assert doubt.message.startswith("2 of 3 rows")
    drive = {"robot_stiffness": [0.0, 1e4, 1e4], "stop_time": 0.1, "stop_deceleration": 3.0, "horizon": 8.0}
    assert not told(contact_calls.allowed_speeds(**{**CASE, "body_mass": [40.0, np.inf, np.inf]}, **drive))
    assert told(contact_calls.thickness(speed=0.2, **CASE, covering=PAD))
    assert not told(contact_calls.thickness(speed=0.2, **CASE, covering=PAD, body_mass=40.0))
    chance = {"speed": 0.2, "draws": 100, "stiffness": {"normal": [25e3, 1e3]}}
    assert told(contact_calls.probability(robot_mass=8.0, limits=LIMITS, area=1e-3, **chance))
    assert not told(contact_calls.probability(robot_mass=8.0, body_mass=40.0, limits=LIMITS, area=1e-3, **chance))


def test_a_base_may_tell_its_drive() -> None:
    leg = [standards.limits().contact("lower_leg", kind) for kind in ("transient", "quasi_static")]
    base = contact.HolonomicBase(mass=20.0, inertia=1.0)
    place = (base, None, (0.2, 0.0), (1.0, 0.0), leg)
    alone = contact.contact_speed_limit(*place, area=1e-3)
    driven = contact.contact_speed_limit(*place, area=1e-3, drive=contact.Support(stiffness=1e4, stop=(0.1, 3.0)))
    assert [told(each) for each in alone] == [False, True]
    assert [told(each) for each in driven] == [False, False]
    assert driven[0].speed == alone[0].speed
    assert driven[1].speed < alone[1].speed
    for half, name in ((contact.Support(stiffness=1e4), "stop"), (contact.Support(stop=(0.1, 3.0)), "stiffness")):
        with pytest.raises(InvalidParameterError, match=rf"^drive\.{name} must be given"):
            contact.contact_speed_limit(*place, area=1e-3, drive=half)
