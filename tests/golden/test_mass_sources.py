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
ZEROS = " ".join(f"{name}='0'" for name in ("ixx", "ixy", "ixz", "iyy", "iyz", "izz"))


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


def test_bases_on_rails(cases: dict[str, Any]) -> None:
    assert len(cases["base_on_rail"]) == 2
    for row in cases["base_on_rail"]:
        base = f"<inertial><mass value='{row['base_mass']}'/><inertia {ZEROS}/></inertial>"
        place = f"<origin xyz='{row['length']} 0 0'/>"
        tip = f"<inertial>{place}<mass value='{row['tip_mass']}'/><inertia {ZEROS}/></inertial>"
        ends = "<parent link='{}'/><child link='{}'/><axis xyz='{}'/>"
        turn = f"<joint name='turn' type='continuous'>{ends.format('base', 'bar', '0 0 1')}</joint>"
        rail = f"<joint name='rail' type='prismatic'>{ends.format('floor', 'base', '1 0 0')}</joint>"
        text = f"<robot name='r'><link name='floor'/>{link('base', base)}{link('bar', tip)}{rail}{turn}</robot>"
        place = {"link": "bar", "point": (row["length"], 0.0, 0.0)}
        along = (np.cos(row["phi"]), np.sin(row["phi"]), 0.0)
        pose = {"turn": row["q"]}
        free = arms.Arm.from_urdf(text)
        held = arms.Arm.from_urdf(text, locked="rail")
        found = [
            float(each.effective_mass(pose, direction=along, check_limits=False, **place)) for each in (free, held)
        ]
        assert found[0] == pytest.approx(row["mass_free_base"], rel=TOLERANCE)
        expected = np.inf if row["mass_fixed_base"] is None else row["mass_fixed_base"]
        assert found[1] == pytest.approx(expected, rel=TOLERANCE)
        assert free.iso_mass == pytest.approx(row["iso_moving"], rel=TOLERANCE)
        assert found[0] <= found[1]


def test_links_without_inertials(cases: dict[str, Any]) -> None:
    for row in cases["link_rod"]:
        place = " ".join(map(str, row["next_joint"]))
        text = (
            "<robot name='r'><link name='root'/><link name='rod'/><link name='next'/>"
            "<joint name='one' type='continuous'><parent link='root'/><child link='rod'/><axis xyz='1 0 0'/></joint>"
            f"<joint name='two' type='fixed'><parent link='rod'/><child link='next'/><origin xyz='{place}'/></joint>"
            "</robot>"
        )
        arm = arms.Arm.from_urdf(text, link_masses={"rod": row["mass"]}, armature=0.1)
        about = row["inertia"][0][0] + row["mass"] * row["center"][2] ** 2
        assert arm.mass_matrix()[0, 0] - 0.1 == pytest.approx(about, rel=TOLERANCE)
        across = arms.Arm.from_urdf(
            text.replace("xyz='1 0 0'", "xyz='0 0 1'"), link_masses={"rod": row["mass"]}, armature=0.1
        )
        assert across.mass_matrix()[0, 0] - 0.1 == pytest.approx(row["inertia"][2][2], rel=TOLERANCE)
        assert "estimated_inertia" in [each.code for each in arm.warnings]
