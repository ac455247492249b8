"""Ten thousand spoiled URDFs, cells, limits and materials: read or refused, never a number that is none."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from api.arms.arm_models import EXAMPLE
from api.spoiled_files import spoiled
from hrsafety import arms, contact, standards
from hrsafety.contact import load_cell
from hrsafety.errors import HrsafetyError

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
MATERIALS = """
[[materials]]
name = "grey"
source = "press, sheet 4"
law = "gibson_ashby"
E = 3e5
plateau = 15e3
e_D = 0.9
[[materials]]
name = "measured"
source = "press, sheet 5"
note = "at 20 degrees"
law = "table"
strain = [0.0, 0.1, 0.6]
stress = [0.0, 8e3, 20e3]
"""
ROWS = (
    "region,area,contact,force_N,pressure_N_per_cm2,spring_constant_N_per_mm,effective_mass_kg,source,certainty\n"
    "chest,,transient,280,,25,40,own tests,certain\n"
    "chest,sternum,transient,,240,,,own tests,likely\n"
    "face,,transient,not_permitted,,75,4.4,own tests,certain\n"
)
SET = """
id = "own"
title = "Own limits"
edition = "2026"
[[limits]]
region = "chest"
contact = "transient"
force_N = 280.0
spring_constant_N_per_mm = 25.0
effective_mass_kg = 40.0
source = "own tests"
certainty = "certain"
"""


def masses(path: str) -> None:
    """Read an arm and ask for its masses: positive, or said to be unbounded."""
    arm = arms.Arm.from_urdf(Path(path))
    if not arm.moved_links:
        return
    found = arm.point_masses(link=arm.moved_links[-1], direction=np.eye(3), check_limits=False)
    assert (found.effective_mass > 0.0).all()
    assert arm.iso_mass >= 0.0
    assert math.isfinite(arm.iso_mass)


def limits(path: str) -> None:
    """Read limits: every number is positive, or not there."""
    for row in standards.load_limits(path).rows:
        for quantity in (row.force, row.pressure, row.spring_constant, row.effective_mass):
            assert quantity is None or 0.0 < quantity.value < math.inf


def materials(path: str) -> None:
    """Read materials: every law that makes a covering has stresses that are numbers."""
    for each in contact.load_materials(path).values():
        pad = contact.Covering(material=each.law, thickness=0.02, area=4e-3, bottom=(0.5, 1e7))
        assert 0.0 <= pad.column(0.005).force < math.inf


def cell(path: str) -> None:
    """Read a cell: planned speeds and masses are positive."""
    found = load_cell(path)
    assert found.robot.mass > 0.0
    assert all(0.0 < each.speed <= 20.0 for each in found.contacts)


READERS: dict[str, tuple[str, int, Callable[[str], None]]] = {
    "robot.urdf": (EXAMPLE, 4000, masses),
    "own.csv": (ROWS, 2000, limits),
    "own.toml": (SET, 1000, limits),
    "foams.toml": (MATERIALS, 1500, materials),
    "contact_base.toml": ((EXAMPLES / "contact_base.toml").read_text(encoding="utf-8"), 1000, cell),
    "contact_arm.toml": ((EXAMPLES / "contact_arm.toml").read_text(encoding="utf-8"), 500, cell),
}


def test_there_are_ten_thousand() -> None:
    assert sum(count for _, count, _ in READERS.values()) == 10_000


@pytest.mark.parametrize("name", READERS)
def test_a_spoiled_file_is_read_or_refused_in_one_sentence(name: str, tmp_path: Path) -> None:
    text, count, read = READERS[name]
    path = tmp_path / name
    (tmp_path / "cell_arm.urdf").write_text(EXAMPLE, encoding="utf-8")
    messages = []
    for content in spoiled(text, count, seed=len(name)):
        path.write_bytes(content)
        try:
            read(str(path))
        except HrsafetyError as error:
            messages.append(str(error))
    assert len(messages) > count / 10
    assert all(10 < len(message) < 2000 for message in messages)
