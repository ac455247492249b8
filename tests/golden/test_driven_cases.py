"""Clamped contacts with a drive against checked cases: peaks, speeds, times, statuses; and distances for a scanner."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from hrsafety import contact, standards


@pytest.fixture(scope="module")
def cases(shared: Path) -> dict[str, Any]:
    data: dict[str, Any] = json.loads((shared / "spec" / "program_cases.json").read_text(encoding="utf-8"))
    return data


def covering(about: dict[str, Any] | None) -> contact.Covering | None:
    if about is None:
        return None
    own = {name: about[name] for name in ("thickness", "shape", "area", "bottom") if name in about}
    law = {name: value for name, value in about.items() if name not in own}
    return contact.Covering(material=law, **own)


def asked(case: dict[str, Any]) -> tuple[contact.Contact, contact.Drive]:
    """Return the contact and the drive of a case."""
    given = case["input"]
    hit = contact.Contact(
        robot=given.get("robot_mass", 1.0), region=given["stiffness"], covering=covering(given.get("covering"))
    )
    keys = ("detection_force", "reaction_time", "push_limit")
    more = {name: given[name] for name in keys if name in given}
    if case["model"] != "push_limit":
        more["deceleration"] = math.inf if given["deceleration"] is None else given["deceleration"]
    elif given["weight"]:
        more |= {"gravity": "acts", "weight": given["weight"]}
    if "drive_stiffness" in given:
        more["stiffness"] = given["drive_stiffness"]
    return hit, contact.Drive(model=case["model"], **more)


def test_drives(cases: dict[str, Any]) -> None:
    assert len(cases["drive"]) == 17
    for number, case in enumerate(cases["drive"]):
        hit, drive = asked(case)
        given, close = case["input"], {"rel": case["input"].get("tolerance", 1e-9)}
        if "peak" in case:
            found = contact.driven_loads(hit, given["speed"], drive)
            assert found.force == pytest.approx(case["peak"], **close), number
            names = {"time_of_peak": "time_of_peak", "detection_time": "detection_time", "commanded": "commanded"}
            for key, name in (names | {"static_force": "static_force"}).items():
                if key in case:
                    assert getattr(found, name) == pytest.approx(case[key], rel=1e-9, abs=1e-15), (number, key)
        if "allowed_speed_at_that_peak" in case:
            back = contact.driven_speed(hit, drive, {"force": case["peak"]})
            assert back.speed == pytest.approx(case["allowed_speed_at_that_peak"], **close), number
        if "allowed_speed" in case:
            limit = {"force": given["force_limit"]}
            back = contact.driven_speed(hit, drive, limit)
            assert back.speed == pytest.approx(case["allowed_speed"], **close), number
            assert back.status == case.get("status", "ok"), number
            if "bare_allowed_speed" in case:
                bare = contact.Contact(robot=1.0, region=given["stiffness"])
                assert contact.driven_speed(bare, drive, limit).speed == pytest.approx(case["bare_allowed_speed"])
            if "kinetic_only_speed" in case:
                assert back.kinetic_speed == pytest.approx(case["kinetic_only_speed"], **close)


def test_distances_for_a_scanner(cases: dict[str, Any]) -> None:
    for case in cases["page1_separation"]:
        rules = {name: value for name, value in case.items() if name not in ("speed", "stop", "slow_down")}
        found = standards.field_distances(case["speed"], **rules)
        assert (found.stop, found.slow_down) == pytest.approx((case["stop"], case["slow_down"]), rel=1e-9)
        for whole, terms in ((found.stop, found.stop_terms), (found.slow_down, found.slow_down_terms)):
            assert sum(terms.values()) == pytest.approx(whole, rel=1e-12)
        assert found.said == ""
        without = standards.field_distances(
            case["speed"], contact_speed=None, reaction_time=0.1, deceleration=2.0, intrusion=0.0, uncertainty=0.0
        )
        assert (without.slow_down, without.said) == (None, "no intrusion, no uncertainty given")
