"""Sources of masses against checked cases: nearest inertias, densities, type plates, motor inertias."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.arms.arm_models import joint, link, robot
from hrsafety import arms
from hrsafety.arms import doubts

TOLERANCE = 1e-9


@pytest.fixture(scope="module")
def cases(shared: Path) -> dict[str, Any]:
    data: dict[str, Any] = json.loads((shared / "spec" / "program_cases.json").read_text(encoding="utf-8"))
    return data


def test_nearest_inertias(cases: dict[str, Any]) -> None:
    assert len(cases["inertia"]) == 4
    for row in cases["inertia"]:
        found = arms.nearest_inertia(row["inertia"])
        assert found.violation == pytest.approx(row["violation"], rel=TOLERANCE)
        largest = np.abs(row["projected"]).max()
        assert np.allclose(found.inertia, row["projected"], rtol=0, atol=TOLERANCE * largest)
        again = arms.nearest_inertia(found.inertia)
        assert np.allclose(again.inertia, found.inertia, rtol=0, atol=1e-15)
        grown = np.linalg.eigvalsh(found.inertia - np.array(row["inertia"]))
        assert grown.min() >= -1e-15


def test_densities(cases: dict[str, Any]) -> None:
    forms = {"cylinder": "radius='{}' length='{}'", "box": "size='{} {} {}'"}
    for row in cases["density"]:
        kind, *numbers = row["shape"]
        shape = f"<collision><geometry><{kind} {forms[kind].format(*numbers)}/></geometry></collision>"
        # The inertia of a sphere inside the shape: its radius of gyration is plausible.
        moment = 0.05 * max(numbers) ** 2 * row["mass"]
        inertia = f"<inertia ixx='{moment}' iyy='{moment}' izz='{moment}' ixy='0' ixz='0' iyz='0'/>"
        inertial = f"<inertial><mass value='{row['mass']}'/>{inertia}</inertial>"
        arm = arms.Arm.from_urdf(robot(link("a", inertial + shape), joint("one", "base", "a")), armature=1e-3)
        told = [each for each in arm.warnings if each.code == "density"]
        assert bool(told) is not row["plausible"]
        if told:
            assert f"{row['density']:.4g} kg/m^3" in told[0].message
            assert not told[0].safe_side


def test_type_plates(cases: dict[str, Any]) -> None:
    for row in cases["type_plate"]:
        found = list(doubts.doubts_of_plate(row["total"], row["moving"], row["plate"]))
        assert [each.code for each in found] == row["codes"]
        assert [each.safe_side for each in found] == [each == "mass_above_type_plate" for each in row["codes"]]


def test_motor_inertias(cases: dict[str, Any]) -> None:
    for row in cases["armature"]:
        facts = {"joint_names": ["one"], "joint_kinds": ["turning"], "largest_own": [row["largest_own"]]}
        found = doubts.doubts_of_motors([("one", row["given"])], facts, ["one"])
        assert [each.code for each in found] == row["codes"]
