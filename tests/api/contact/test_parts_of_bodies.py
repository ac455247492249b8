"""Contacts that are larger than the part of the body, and other coverings that are not as they are computed."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from api import contact_calls
from hrsafety import contact, standards
from hrsafety.contact.bodies import part_of
from hrsafety.plausibility import unsafe_doubts

ISO = standards.limits()
FOAM = contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9)
LINEAR = contact.Linear(modulus=2e5)


def codes(result: Any) -> set[str]:
    return {each.code for each in unsafe_doubts(result.warnings)}


def pad(area: float, **more: Any) -> contact.Covering:
    return contact.Covering(material=more.pop("material", FOAM), thickness=0.02, area=area, **more)


@pytest.mark.parametrize(
    ("region", "area", "most"),
    [
        ("hand_finger", None, 4.0),
        ("hand_finger", "palm, dominant", 60.0),
        ("hand_finger", "forefinger pad", 4.0),
        ("hand_finger", "back of the hand", 60.0),
        ("face", None, 60.0),
        ("lower_arm_wrist", None, 60.0),
        ("neck", None, 40.0),
        ("lower_leg", None, 40.0),
        ("lower_leg", "calf muscle", 100.0),
        ("chest", None, 100.0),
        ("thigh_knee", None, 100.0),
    ],
)
def test_parts_have_their_areas(region: str, area: str | None, most: float) -> None:
    part = part_of(ISO.contact(region, "quasi_static", area=area))
    assert part is not None
    assert part.area == pytest.approx(1e-4 * most)


def test_a_pad_larger_than_a_finger_is_told_with_the_speed_of_what_it_touches() -> None:
    hand = ISO.contact("hand_finger", "quasi_static")
    case: dict[str, Any] = {"robot_mass": 16.5, "limits": hand}
    wide = contact_calls.allowed_speed(**case, covering=pad(4e-3))
    assert round(wide.speed or 0.0, 3) == 0.367
    narrow = contact_calls.allowed_speed(**case, covering=pad(4e-4))
    assert "covering_larger_than_part" in codes(wide)
    assert codes(narrow) == {"drive_not_given"}
    (told,) = [each.message for each in wide.warnings if each.code == "covering_larger_than_part"]
    assert f"with that area {narrow.speed:.3g} m/s is allowed" in told
    palm = ISO.contact("hand_finger", "quasi_static", area="palm")
    assert codes(contact_calls.allowed_speed(robot_mass=16.5, limits=palm, covering=pad(4e-3))) == {"drive_not_given"}


@settings(max_examples=30, deadline=None)
@given(
    st.sampled_from(ISO.regions),
    st.floats(1e-5, 0.02),
    st.sampled_from(["flat", "bare", "sphere", "thickness", "probability", "rows"]),
)
def test_every_result_tells_of_contacts_larger_than_the_part(region: str, area: float, kind: str) -> None:
    limit = ISO.contact(region, "quasi_static")
    part = part_of(limit)
    assert part is not None
    case: dict[str, Any] = {"robot_mass": 8.0, "limits": limit}
    if kind == "bare":
        found: Any = contact_calls.allowed_speed(**case, area=area)
    elif kind == "sphere":
        ball = contact.Covering(material=LINEAR, thickness=0.02, shape="sphere", radius=20.0 * area)
        found = contact_calls.allowed_speed(**case, covering=ball)
        # F = p A: the area that bears, of a linear law half the footprint.
        column = ball.column(found.covering_compression)
        area = column.force / column.peak_pressure
    elif kind == "thickness":
        found = contact_calls.thickness(**case, covering=pad(area), speed=0.1)
        if found.status == "none_up_to_1_m":
            return
    elif kind == "probability":
        found = contact_calls.probability(**case, covering=pad(area), speed=0.1, draws=100)
    elif kind == "rows":
        found = contact_calls.allowed_speeds(robot_mass=[8.0, 9.0], limits=limit, covering=pad(area))
    else:
        found = contact_calls.allowed_speed(**case, covering=pad(area))
    if abs(area / part.area - 1.0) > 1e-6:
        assert ("covering_larger_than_part" in codes(found)) == (area > part.area)


def test_a_linear_covering_is_not_believed_to_four_fifths_of_its_thickness() -> None:
    soft = contact.Linear(modulus=3e4)
    case: dict[str, Any] = {"robot_mass": 8.0, "limits": ISO.contact("chest", "transient")}
    deep = contact_calls.allowed_speed(**case, covering=pad(4e-3, material=soft))
    assert deep.covering_compression == pytest.approx(0.8 * 0.02)
    assert codes(deep) == {"linear_beyond_half"}
    # Who states how far it was tested, or stays within half of it, is believed.
    assert codes(contact_calls.allowed_speed(**case, covering=pad(4e-3, material=soft, bottom=(0.7, 1e7)))) == set()
    assert codes(contact_calls.allowed_speed(**case, covering=pad(4e-3, material=soft), max_strain=0.5)) == set()
    assert codes(contact_calls.allowed_speed(**case, covering=pad(4e-3))) == set()
    hit = contact_calls.simulate(
        robot_mass=8.0, closing_speed=0.9, covering=pad(4e-3, material=soft), limits=case["limits"]
    )
    assert "linear_beyond_half" in codes(hit)


@pytest.mark.parametrize(
    ("slip", "unsafe"),
    [
        ({"robot_mass": 0.008}, True),
        ({"robot_mass": 8e5}, False),
        ({"area": 0.4}, True),
        ({"limits": {"force": 140e3, "pressure": 190e4}}, True),
        ({"limits": {"force": 0.14, "pressure": 190e4}}, False),
        ({"limits": {"force": 140.0, "pressure": 190e9}}, True),
        ({"limits": {"force": 140.0, "pressure": 190.0}}, False),
        ({"region": 75.0}, True),
        ({"region": 75e6}, False),
        ({"body_mass": 0.0006}, True),
        ({"body_mass": 600.0}, False),
    ],
)
def test_numbers_in_another_unit_know_the_side_of_their_error(slip: dict[str, Any], unsafe: bool) -> None:
    right: dict[str, Any] = {"robot_mass": 8.0, "region": 75e3, "body_mass": 0.6, "area": 1e-4}
    right |= {"limits": {"force": 140.0, "pressure": 190e4}}
    assert codes(contact_calls.allowed_speed(**right)) == set()
    found = contact_calls.allowed_speed(**right | slip)
    assert [each.code for each in found.warnings] == ["implausible"]
    assert (codes(found) == {"implausible"}) is unsafe
    if not unsafe:
        assert (found.speed or 0.0) < (contact_calls.allowed_speed(**right).speed or 0.0)


def test_a_covering_of_twenty_meters_is_a_doubt() -> None:
    thick = contact.Covering(material=FOAM, thickness=20.0, area=4e-3)
    found = contact_calls.allowed_speed(robot_mass=8.0, limits=ISO.contact("chest", "transient"), covering=thick)
    assert "implausible" in codes(found)


# ---- margins ------------------------------------------------------------------------------------


def still(gap: float) -> SimpleNamespace:
    """Return a run in which neither robot nor person moves, at a distance."""
    time = np.linspace(0.0, 0.3, 4)
    return SimpleNamespace(
        time=time,
        position=np.zeros((4, 2)),
        velocity=np.zeros((4, 2)),
        heading=np.zeros(4),
        obstacle_position=np.broadcast_to([gap, 0.0], (4, 1, 2)).copy(),
    )


def margins(gap: float, *regions: standards.ContactLimit, mass: float = 20.0) -> contact.ContactMargins:
    return contact.contact_margins(
        still(gap),
        base=contact.HolonomicBase(mass=mass, inertia=0.8),
        covering=None,
        area=1e-4,
        regions=list(regions),
        robot_radius=0.2,
        person_radius=0.3,
    )


def test_a_face_that_is_touched_at_closing_speed_0_is_not_permitted() -> None:
    face, leg = ISO.contact("face", "transient"), ISO.contact("lower_leg", "transient")
    assert set(margins(0.4, leg, face).verdict.ravel()) == {"not_permitted"}
    assert set(margins(1.5, leg, face).verdict.ravel()) == {"within_limits"}
    assert set(margins(0.4, leg).verdict.ravel()) == {"within_limits"}


def test_a_base_in_another_unit_has_no_margin_that_counts() -> None:
    leg = ISO.contact("lower_leg", "transient")
    found = margins(0.4, leg, mass=0.02)
    assert set(found.verdict.ravel()) == {"not_checked"}
    assert codes(found) == {"implausible"}
