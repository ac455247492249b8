"""Ten thousand damaged files of arms and limits: an error of the package, or what another reading confirms."""

from __future__ import annotations

import json
import math
import re
import sys
from pathlib import Path

import numpy as np
import pytest

from api.arms.arm_models import EXAMPLE, INERTIAL, LINKS, TWO, joint, robot
from api.spoiled_files import spoiled
from hrsafety import arms, standards
from hrsafety.errors import HrsafetyError, MissingExtraError

MIMIC = robot(*LINKS, joint("one", "base", "a"), joint("two", "a", "b", '<axis xyz="0 1 0"/><mimic joint="one"/>'))
PLACE = {"direction": (0.6, -0.48, 0.64), "check_limits": False}

CSV = (
    standards.template("csv")
    + "chest,sternum,transient,100,60,25,40,own tests,likely\nface,,transient,not_permitted,,75,4.4,rule,certain\n"
)
TOML = (
    'id = "plant"\nedition = "2025"\n[[limits]]\nregion = "chest"\ncontact = "transient"\nforce_N = 100.0\n'
    'source = "own tests"\ncertainty = "likely"\n[[limits]]\nregion = "chest"\narea = "sternum"\n'
    'contact = "transient"\npressure_N_per_cm2 = 60\nsource = "own tests"\n'
)


def masses(arm: arms.Arm) -> np.ndarray:
    """Masses of the last link in two poses, some of them unbounded."""
    poses = np.array([[0.0], [0.7]]) * np.ones(len(arm.joint_names))
    return arm.effective_mass(poses, link=arm.link_names[-1], point=(0.1, 0.02, 0.03), **PLACE).mass


def read(content: bytes, path: Path) -> arms.Arm | None:
    """Return the arm in a damaged file, or nothing if it is refused."""
    path.write_bytes(content)
    try:
        return arms.Arm.from_urdf(path)
    except HrsafetyError as error:
        str(error)
        return None


@pytest.mark.parametrize(("text", "count"), [(EXAMPLE, 1500), (TWO, 1000), (MIMIC, 1000)])
def test_damaged_arms_are_refused_or_weigh_something(text: str, count: int, tmp_path: Path) -> None:
    path = tmp_path / "spoiled.urdf"
    refused = 0
    for content in spoiled(text, count, seed=18):
        arm = read(content, path)
        if arm is None:
            refused += 1
            continue
        try:
            found = masses(arm)
        except HrsafetyError as error:
            str(error)
            refused += 1
            continue
        assert not np.isnan(found).any(), content
        assert (found > 0.0).all(), content
        assert arm.iso_mass >= 0.0
        assert math.isfinite(arm.iso_mass)
    assert refused > count // 4


def numbers_of(text: str) -> list[re.Match[str]]:
    return list(re.finditer(r'(?<=[" ])-?\d+\.?\d*(e-?\d+)?(?=[" ])', text))


@pytest.mark.parametrize("word", ["nan", "inf", "-inf", "1e999", "1_0", "", "0x10", "1,5", "one"])
def test_no_number_of_a_urdf_is_read_from_what_is_none(word: str) -> None:
    inside = [place for place in numbers_of(EXAMPLE) if EXAMPLE[: place.start()].count("<robot")]
    for place in inside[::7]:
        before = EXAMPLE[: place.start()]
        if re.search(r'(effort|velocity)="$', before):
            continue
        with pytest.raises(HrsafetyError):
            arms.Arm.from_urdf(before + word + EXAMPLE[place.end() :])


def test_elements_that_carry_the_inertia_cannot_be_lost_unseen() -> None:
    for name in ("inertial", "mass", "inertia", "origin", "axis", "parent", "child"):
        for spelling in (name[:-1], name + "s", name.capitalize(), name[0] + name):
            if len(name) < 4 and spelling != name + "s":
                continue
            text = TWO.replace(f"<{name}", f"<{spelling}", 1).replace(f"</{name}>", f"</{spelling}>", 1)
            with pytest.raises(HrsafetyError):
                arms.Arm.from_urdf(text)


def test_deep_and_wide_documents_come_back_in_time() -> None:
    deep = f'<robot name="d">{"<a>" * 50_000}{"</a>" * 50_000}</robot>'
    wide = robot(*(f'<link name="l{index}">{INERTIAL}</link>' for index in range(10_001)))
    chain = robot(
        *(f'<link name="l{index}">{INERTIAL}</link>' for index in range(120)),
        *(joint(f"j{index}", f"l{index - 1}" if index else "base", f"l{index}") for index in range(120)),
    )
    for text in (deep, wide, chain):
        with pytest.raises(HrsafetyError):
            arms.Arm.from_urdf(text)


@pytest.mark.parametrize(("text", "suffix"), [(CSV, ".csv"), (TOML, ".toml")])
def test_damaged_limits_are_refused_or_are_limits(text: str, suffix: str, tmp_path: Path) -> None:
    path = tmp_path / f"own{suffix}"
    read = 0
    for content in spoiled(text, 2000, seed=19):
        path.write_bytes(content)
        try:
            found = standards.limits(path)
        except HrsafetyError as error:
            str(error)
            continue
        read += 1
        for row in found.rows:
            assert all(each.sources and each.sources[0] for each in (row.force, row.pressure) if each)
            limit = found.contact(row.region, row.contact)
            for number in (limit.force, limit.pressure):
                assert number is None or 0.0 < number < math.inf
            assert limit.status in {"limited", "not_permitted", "not_checked"}
            assert json.dumps(str(limit))
    assert read > 100


MACROS = """<robot name="m" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="load" value="3"/>
<link name="base"/><link name="upper"><inertial><mass value="${load + 1}"/><origin xyz="0.2 0 0"/>
<inertia ixx="0.01" iyy="0.05" izz="0.05" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><axis xyz="0 0 1"/>
<limit lower="-1" upper="1" effort="10" velocity="1"/></joint></robot>
"""


def test_macros_are_expanded(tmp_path: Path) -> None:
    pytest.importorskip("xacrodoc")
    path = tmp_path / "arm.urdf.xacro"
    path.write_text(MACROS, encoding="utf-8")
    assert arms.Arm.from_urdf(path).moving_mass == 4.0
    path.write_text(MACROS.replace("${load", "${lod"), encoding="utf-8")
    with pytest.raises(arms.InvalidParameterError, match=r"arm.urdf.xacro must hold macros that can be expanded"):
        arms.Arm.from_urdf(path)


def test_macros_name_the_extra_that_expands_them(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xacrodoc", None)
    path = tmp_path / "arm.xacro"
    path.write_text(MACROS, encoding="utf-8")
    with pytest.raises(MissingExtraError, match=r"pip install hrsafety\[arms\]"):
        arms.Arm.from_urdf(path)
