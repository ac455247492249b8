"""Numbers in another unit that make a contact seem better than it is are told of beside the result."""

from __future__ import annotations

import numpy as np

from api import contact_calls
from hrsafety import arms, contact, standards

APART = {"contact_speed": 0.2, "max_speed": 1.0, "reaction_time": 0.1, "intrusion": 0.2, "uncertainty": 0.1}


def test_strain_in_percent_is_told_of() -> None:
    shares = contact.StressTable(strain=[0.0, 0.1, 0.6], stress=[0.0, 14e3, 30e3])
    percent = contact.StressTable(strain=[0.0, 10.0, 60.0], stress=[0.0, 14e3, 30e3])
    for material, subjects in ((shares, []), (percent, ["strain"])):
        pad = contact.Covering(material=material, thickness=0.02, area=4e-3, bottom=(0.5, 1e7))
        found = contact_calls.allowed_speed(
            robot_mass=6.0, body_mass=0.6, region=75e3, limits={"force": 140.0, "pressure": 2e6}, covering=pad
        )
        assert [each.subject for each in found.warnings] == subjects


def test_distances_in_millimeters_are_told_of() -> None:
    curve = standards.speed_over_distance([500.0, 1500.0], deceleration=3.0, **APART)
    assert [each.subject for each in curve.warnings] == ["distance"]
    assert "mm or cm given for m" in str(curve)
    braked = standards.speed_over_distance([0.5, 1.5], deceleration=3000.0, **APART)
    assert [each.subject for each in braked.warnings] == ["deceleration"]
    assert standards.speed_over_distance([0.5, 1.5], deceleration=3.0, **APART).warnings == ()


def test_a_point_in_millimeters_is_told_of() -> None:
    arm, pose = arms.Arm.example(), {"elbow": 1.4}
    far, near = (0.0, 0.0, 100.0), (0.0, 0.0, 0.1)
    time, still = np.linspace(0.0, 1.0, 5), np.zeros((5, 6))
    for point, told in ((far, True), (near, False)):
        results = (
            arm.point_masses(pose, link="tool", point=point, direction=(0, 1, 0)),
            arms.workspace(arm, link="tool", point=point, samples=4),
            arms.along(arm, time, still, link="tool", point=point),
        )
        assert [any(each.subject == "point" for each in found.warnings) for found in results] == [told] * 3
