"""Collisions, allowed speeds, thicknesses, chances and bases against checked numbers."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import pytest

from api import contact_calls
from hrsafety import contact
from hrsafety.errors import InvalidParameterError

CASES: dict[str, Any] = json.loads((Path(__file__).parent / "contact_cases.json").read_text(encoding="utf-8"))
PRINTED = 2e-12
"""The numbers are given to 13 digits."""


def near(found: float | None, expected: float | None, tolerance: float) -> bool:
    if expected is None:
        return found is None
    return found is not None and abs(found - expected) <= tolerance * abs(expected)


@pytest.mark.parametrize("case", CASES["impacts"], ids=lambda case: case["name"])
def test_impacts(case: dict[str, Any]) -> None:
    found = contact_calls.simulate(**case["input"], tolerance=1e-10)
    output = dict(case["output"])
    assert found.status == output.pop("status")
    assert found.bottomed == output.pop("bottomed")
    assert abs((found.end_force or 0.0) - output.pop("end_force")) <= 1e-7 * (found.peak_force or 0.0)
    for name, expected in output.items():
        tolerance = 1e-6 if name.endswith("time") or name.startswith("hic") else 1e-7
        assert near(getattr(found, name), expected, tolerance), (name, getattr(found, name), expected)


@pytest.mark.parametrize("case", CASES["allowed_speed"])
def test_allowed_speeds_from_stored_energy(case: dict[str, Any]) -> None:
    found = contact_calls.allowed_speed(**case["input"])
    assert near(found.speed, case["speed"], PRINTED)
    assert near(found.bare_speed_force, case["bare_speed_force"], PRINTED)
    assert found.governs == case["governs"]
    assert found.status == "closed_form"
    for name, expected in case["speeds"].items():
        assert near(found.speeds[name], expected, PRINTED), name


@pytest.mark.parametrize("case", CASES["allowed_speed_numeric"])
def test_allowed_speeds_by_simulation(case: dict[str, Any]) -> None:
    found = contact_calls.allowed_speed(**case["input"])
    assert near(found.speed, case["speed"], 1e-7)
    assert found.status == "monotone"


@pytest.mark.parametrize("case", CASES["thickness"])
def test_thicknesses(case: dict[str, Any]) -> None:
    found = contact_calls.thickness(**case["input"])
    assert near(found.thickness, case["thickness"], PRINTED)
    assert found.status == case["status"]


@pytest.mark.parametrize("case", CASES["winkler"])
def test_columns(case: dict[str, Any]) -> None:
    found = contact.Covering(**case["input"]["covering"]).column(case["input"]["compression"])
    assert near(found.force, case["force"], PRINTED)
    assert near(found.energy, case["energy"], PRINTED)
    assert near(found.peak_pressure, case["peak_pressure"], PRINTED)
    assert near(None if found.half_widths is None else found.half_widths[0], case["half_width"], PRINTED)


REGIONS = {
    "skull_forehead": (130, 110, 150, 4.4),
    "face": (65, 110, 75, 4.4),
    "neck": (150, 140, 50, 1.2),
    "back_shoulders": (210, 160, 35, 40),
    "chest": (140, 120, 25, 40),
    "abdomen": (110, 140, 10, 40),
    "pelvis": (180, 210, 25, 40),
    "upper_arm_elbow": (150, 190, 30, 3),
    "lower_arm_wrist": (160, 180, 40, 2),
    "hand_finger": (140, 190, 75, 0.6),
    "thigh_knee": (220, 220, 50, 75),
    "lower_leg": (130, 210, 60, 75),
}


class Limit:
    """A limit as a set of limits gives it."""

    def __init__(self, region: str, contact_class: str) -> None:
        force, pressure, spring, mass = REGIONS[region]
        factor = 2.0 if contact_class == "transient" else 1.0
        self.region, self.contact = region, contact_class
        self.permitted = not (contact_class == "transient" and region in ("skull_forehead", "face"))
        self.force, self.pressure = factor * force, factor * pressure * 1e4
        self.spring_constant = 1e3 * spring
        self.body_mass = mass if contact_class == "transient" else math.inf


@pytest.mark.parametrize("case", CASES["iso_table"], ids=lambda case: f"{case['region']}-{case['kind']}")
def test_bare_speeds_of_all_regions(case: dict[str, Any]) -> None:
    limit = Limit(case["region"], case["kind"])
    arguments = {"robot_mass": case["robot_mass"], "area": case["area"], "limits": limit}
    if case["speed"] is None:
        with pytest.raises(InvalidParameterError, match="not_permitted"):
            contact_calls.allowed_speed(region=limit.spring_constant, body_mass=limit.body_mass, **arguments)
        return
    found = contact_calls.allowed_speed(region=limit.spring_constant, body_mass=limit.body_mass, **arguments)
    assert near(found.speed, case["speed"], PRINTED)
    assert near(found.speeds["force"], case["speed_force"], PRINTED)
    assert near(found.speeds["pressure"], case["speed_pressure"], PRINTED)
    assert found.governs == case["governs"]


@pytest.mark.parametrize(
    ("region", "kind", "shape", "speed", "governs"),
    [
        ("hand_finger", "quasi_static", {"shape": "flat", "area": 40e-4}, 0.36831, "force"),
        ("lower_leg", "quasi_static", {"shape": "flat", "area": 40e-4}, 0.36420, "force"),
        ("chest", "transient", {"shape": "flat", "area": 40e-4}, 0.63277, "strain"),
        ("hand_finger", "quasi_static", {"shape": "sphere", "radius": 0.08}, 0.35263, "force"),
        ("chest", "transient", {"shape": "sphere", "radius": 0.08}, 0.49671, "pressure"),
    ],
)
def test_covered_speeds(region: str, kind: str, shape: dict[str, Any], speed: float, governs: str) -> None:
    limit = Limit(region, kind)
    foam = contact.GibsonAshby(modulus=3e5, plateau=15e3, lock=0.9)
    found = contact_calls.allowed_speed(
        robot_mass=16.35,
        body_mass=limit.body_mass,
        region=limit.spring_constant,
        limits=limit,
        covering=contact.Covering(material=foam, thickness=0.02, **shape),
    )
    assert near(found.speed, speed, 2e-5)
    assert found.governs == governs


@pytest.mark.parametrize("case", CASES["probability"])
def test_chances(case: dict[str, Any]) -> None:
    found = contact_calls.probability(**case["input"], draws=200_000, seed=3)
    assert found.interval[0] - 1e-9 <= case["probability"] <= found.interval[1] + 1e-9


@pytest.mark.parametrize("case", CASES["mobile_base"])
def test_mobile_bases(case: dict[str, Any]) -> None:
    given = case["input"]
    kind = contact.HolonomicBase if given["kind"] == "holonomic" else contact.DifferentialBase
    base = kind(mass=given["mass"], inertia=given["inertia"])
    point, direction = tuple(given["point"]), tuple(given["direction"])
    mass = base.effective_mass(point, direction)
    if case["effective_mass"] is None:
        assert mass == math.inf
        return
    assert near(mass, case["effective_mass"], PRINTED)
    for region in ("lower_leg", "thigh_knee"):
        limits = [Limit(region, "transient"), Limit(region, "quasi_static")]
        free, clamped = contact.contact_speed_limit(base, None, point, direction, limits)
        assert near(free.speed, case[region]["transient"], PRINTED)
        assert near(clamped.speed, case[region]["clamped"], PRINTED)


@pytest.mark.parametrize(
    ("mass", "bare", "covered"), [(4.4, (0.5207, 0.2530), (0.9705, 0.4716)), (3.7, (0.5653, 0.2759), (1.0536, 0.5143))]
)
def test_robots_of_the_source(mass: float, bare: tuple[float, float], covered: tuple[float, float]) -> None:
    foam = {"material": {"law": "linear", "E": 24250.0 * 0.0254 / 0.01}, "thickness": 0.0254, "area": 0.01}
    base = contact.HolonomicBase(mass=mass, inertia=0.1)
    limits = [Limit("lower_leg", "transient"), Limit("lower_leg", "quasi_static")]
    for covering, expected in ((None, bare), (foam, covered)):
        found = contact.contact_speed_limit(base, covering, (0.2, 0.0), (1.0, 0.0), limits)
        forces = [each.allowed.speeds["force"] for each in found if each.allowed is not None]
        assert forces == pytest.approx(expected, abs=6e-5)
