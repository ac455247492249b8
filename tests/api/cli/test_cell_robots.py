"""The robot of a cell file: what is doubted of its masses, and on which side."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.arms.arm_models import EXAMPLE
from hrsafety import arms
from hrsafety.cli import main
from hrsafety.contact.cell.robot import ContactRobot, robot_of
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import unsafe_doubts

MOTORS = {"turn": 1.2, "shoulder": 1.2, "elbow": 1.0, "wrist_1": 0.3, "wrist_2": 0.3, "wrist_3": 0.3}
POSES = [{"shoulder": 0.4, "elbow": 1.4}]
GRIPPER = {"link": "tool", "mass": 2.0}
ARM = {"urdf": "arm.urdf", "payload": GRIPPER}
TOOL = ARM | {"link": "tool", "direction": [1.0, 0.0, 0.0], "poses": POSES}


@pytest.fixture
def read(tmp_path: Path) -> Any:
    """Return a function that reads the robot of a table beside the example arm, or another one."""

    def robot(table: dict[str, Any], text: str = EXAMPLE) -> ContactRobot:
        (tmp_path / "arm.urdf").write_text(text, encoding="utf-8")
        return robot_of(table, tmp_path)

    return robot


def codes(robot: ContactRobot) -> list[str]:
    return [each.code for each in unsafe_doubts(robot.warnings)]


def test_an_ordinary_arm_with_motors_is_not_doubted(read: Any) -> None:
    robot = read(TOOL | {"armature": MOTORS, "type_plate_mass": 31.0})
    assert robot.warnings == ()
    assert (robot.total_mass, robot.moving_mass, robot.quantile_mass) == (29.0, 29.0, None)
    assert robot.payload_mass == 2.0
    assert read(TOOL | {"armature": 0.4}).directional_mass > read(TOOL).directional_mass


@pytest.mark.parametrize(("rule", "unsafe"), [("larger", True), ("iso", False), ("directional", True)])
def test_missing_motors_are_unsafe_where_they_may_change_the_mass(read: Any, rule: str, unsafe: bool) -> None:
    robot = read(TOOL | {"robot_mass": rule})
    assert robot.directional_mass > robot.iso_mass / 3
    assert codes(robot) == ["no_motor_inertia"] * unsafe
    rotor = read(TOOL | {"robot_mass": rule, "armature": 5e-5})
    assert codes(rotor) == ["armature_suspicious"] * unsafe
    assert read(TOOL | {"mass_rule": rule}) == robot
    with pytest.raises(InvalidParameterError, match="be left out beside mass_rule"):
        read(TOOL | {"mass_rule": rule, "robot_mass": rule})


FLANGE = '<link name="tool"/>'
HAND = """
<link name="hand"><inertial><mass value="0.8"/><inertia ixx="1e-3" iyy="1e-3" izz="1e-3" ixy="0" ixz="0" iyz="0"/>
</inertial></link><joint name="hand_mount" type="fixed"><parent link="tool"/><child link="hand"/></joint>
<link name="tcp"/><joint name="tcp_mount" type="fixed"><parent link="hand"/><child link="tcp"/>
<origin xyz="0 0 0.15"/></joint>"""
MARK = """
<link name="mark"/><joint name="mark_mount" type="fixed"><parent link="forearm"/><child link="mark"/>
<origin xyz="0 0 0.2"/></joint>"""


@pytest.mark.parametrize(
    ("link", "more", "doubted"),
    [
        ("tool", "", True),
        ("tcp", HAND.replace('<mass value="0.8"/>', '<mass value="0"/>'), True),
        # Links that weigh something, frames beside them, and frames before the end of the arm.
        ("wrist_block_3", "", False),
        ("hand", HAND, False),
        ("tcp", HAND, False),
        ("tool", HAND, False),
        ("mark", MARK, False),
    ],
)
@pytest.mark.parametrize("rule", ["larger", "iso", "directional"])
def test_an_arm_that_carries_no_tool_is_doubted(read: Any, link: str, more: str, doubted: bool, rule: str) -> None:
    text = EXAMPLE.replace(FLANGE, FLANGE + more)
    given = {name: each for name, each in TOOL.items() if name not in ("payload", "direction")}
    given |= {"link": link, "armature": MOTORS, "mass_rule": rule}
    assert ("tool_without_mass" in codes(read(given, text))) == doubted
    assert "tool_without_mass" not in codes(read(given | {"payload": GRIPPER}, text))


def test_an_arm_without_inertials_is_doubted_or_refused(read: Any) -> None:
    bare = re.sub(r"<inertial>.*?</inertial>", "", EXAMPLE, flags=re.DOTALL)
    given = {name: each for name, each in TOOL.items() if name != "payload"} | {"armature": MOTORS}
    assert "link_without_mass" in codes(read(given, bare))
    with pytest.raises(InvalidParameterError, match="urdf must have links with masses for the rule 'iso'"):
        read(given | {"mass_rule": "iso"}, bare)


@pytest.mark.parametrize(
    ("more", "code"),
    [
        ({"type_plate_mass": 40.0}, "mass_below_type_plate"),
        ({"payload": {"link": "tool", "mass": 1200.0}}, "implausible"),
        ({"payload": {"link": "tool", "mass": 2.0, "center": [0.0, 0.0, 60.0]}}, "implausible"),
        ({"payload": {"link": "tool", "mass": 0.002}}, "implausible"),
        ({"point": [0.0, 0.0, 60.0]}, "implausible"),
    ],
)
def test_masses_that_are_no_data_reach_the_robot(read: Any, more: dict[str, Any], code: str) -> None:
    assert codes(read(TOOL | {"armature": MOTORS} | more)) == [code]


def test_poses_in_degrees_are_refused_or_told(read: Any) -> None:
    degrees = {"poses": [{"shoulder": 23.0, "elbow": 80.0}], "armature": MOTORS}
    with pytest.raises(InvalidParameterError, match=r"degrees are .* rad"):
        read(TOOL | degrees)
    endless = EXAMPLE.replace('type="revolute"', 'type="continuous"')
    limits = re.sub(r'upper="[^"]*"', 'upper="180"', re.sub(r'lower="[^"]*"', 'lower="-180"', EXAMPLE))
    for text in (endless, limits):
        assert codes(read(TOOL | degrees, text)) == ["implausible"]
        # What is drawn is drawn between limits, and the same pose after a turn.
        assert codes(read(ARM | {"armature": MOTORS, "samples": 1000}, text)) == []


def test_without_poses_the_worst_draw_is_named_as_singular_with_a_quantile_beside(read: Any) -> None:
    robot = read(ARM | {"armature": MOTORS})
    drawn = arms.workspace(arms.Arm.example(armature=MOTORS, payload=GRIPPER), link="tool", samples=2000, seed=0)
    assert robot.near_singular
    assert robot.directional_mass == drawn.mass.max()
    assert np.quantile(drawn.mass, 0.99, method="higher") == robot.quantile_mass < 0.1 * robot.directional_mass
    (told,) = robot.warnings
    assert (told.code, told.safe_side) == ("near_singular", True)
    assert re.search(r"2000 drawn ones is near a singular pose.*99 % of them: at most .* give the poses", told.message)
    assert not read(TOOL | {"armature": MOTORS}).near_singular


def test_a_stated_direction_is_told_beside_the_heaviest_one(read: Any) -> None:
    free = {name: each for name, each in TOOL.items() if name != "direction"} | {"armature": MOTORS}
    poses = {"poses": [*POSES, {"shoulder": 0.8, "elbow": 0.9, "wrist_1": 0.5}]}
    heaviest = read(free | poses)
    assert heaviest.heaviest_mass is None
    for direction in ([1.0, 0.0, 0.0], [0.0, 0.0, -3.0]):
        stated = read(free | poses | {"direction": direction})
        assert stated.heaviest_mass == heaviest.directional_mass >= stated.directional_mass


def test_robots_that_hardly_weigh_anything_are_doubted(read: Any) -> None:
    assert codes(read({"mass": 0.008})) == ["implausible"]
    assert read({"mass": 8.0}).warnings == ()
    assert codes(read({"mass": 16350.0})) == []
    assert len(read({"mass": 16350.0}).warnings) == 1


def test_a_rolling_base_without_the_inertia_of_its_motors_is_a_lower_bound(read: Any) -> None:
    base = {"base": "differential", "mass": 20.0, "inertia": 0.8, "point": [0.2, 0.1], "normal": [0.8, 0.6]}
    assert codes(read(base)) == ["no_motor_inertia"]
    wheels = {"wheel_inertia": 0.001, "wheel_radius": 0.08, "half_track": 0.2}
    assert codes(read(base | wheels)) == []
    # The inertia of a rotor before its gear, or millimeters, silence nothing.
    assert codes(read(base | wheels | {"wheel_inertia": 1e-6})) == ["armature_suspicious"]
    assert set(codes(read(base | wheels | {"wheel_radius": 80.0, "half_track": 200.0}))) == {
        "implausible",
        "armature_suspicious",
    }
    assert codes(read(base | wheels | {"offset": 50.0})) == ["implausible"]
    assert {each.safe_side for each in read(base | wheels | {"wheel_inertia": 1000.0}).warnings} == {True}
    sideways = base | {"point": [0.0, 0.1], "normal": [0.0, 1.0]}
    assert math.isinf(read(sideways).mass)
    assert codes(read(sideways)) == []
    assert codes(read(base | wheels | {"inertia": 8e-7})) == ["implausible"]
    assert set(codes(read(base | wheels | {"point": [200.0, 100.0]}))) == {"implausible"}


def test_inertias_that_no_body_has_are_repaired_on_request(read: Any) -> None:
    wrong = EXAMPLE.replace('ixx="0.42"', 'ixx="0.9"')
    with pytest.raises(InvalidParameterError, match="repair_inertia = true"):
        read(TOOL | {"armature": MOTORS}, wrong)
    assert codes(read(TOOL | {"armature": MOTORS, "repair_inertia": True}, wrong)) == ["inertia_projected"]
    assert codes(read(TOOL | {"armature": MOTORS, "repair_inertia": True, "mass_rule": "iso"}, wrong)) == []


def test_a_cell_without_poses_tells_of_its_singular_draw_once(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    motors = ", ".join(f"{name} = {value}" for name, value in MOTORS.items())
    (tmp_path / "arm.urdf").write_text(EXAMPLE, encoding="utf-8")
    cell = tmp_path / "cell.toml"
    contacts = "".join(f'[[contacts]]\nregion = "{each}"\n' for each in ("hand_finger", "chest", "thigh_knee"))
    cell.write_text(
        'title = "t"\nspeed = 0.05\ncontact_area = 1e-4\n[robot]\nurdf = "arm.urdf"\n'
        f"armature = {{ {motors} }}\n{contacts}",
        encoding="utf-8",
    )
    main(["contact", str(cell), "--out", str(tmp_path / "report")])
    told = capsys.readouterr().err
    assert told.count("near a singular pose") == 1
    assert "g or t given" not in told
    page = (tmp_path / "report" / "report.html").read_text(encoding="utf-8")
    assert ", near a singular one" in page
    assert "Effective mass of 99 % of the drawn poses" in page
