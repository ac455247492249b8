"""Logs and arms that are not what they are called: columns of other joints, tools that weigh nothing."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.program.chains import example
from hrsafety import arms, program
from hrsafety.errors import InvalidParameterError

START = {"turn": -0.6, "shoulder": 0.35, "elbow": 1.45, "wrist_1": -0.23, "wrist_2": -1.5708, "wrist_3": 0.0}
VELOCITY = {"turn": 1.5, "shoulder": 1.5, "elbow": 1.5, "wrist_1": 3.0, "wrist_2": 3.0, "wrist_3": 3.0}
OF_LOGS = {"faster_than_drive", "log_disagrees_with_tool"}


def log(folder: Path, swapped: tuple[str, str] = ("turn", "turn"), **recorded: np.ndarray) -> Path:
    """Write a log of a turn with a twist of the hand, columns of two joints swapped in its names."""
    time = np.linspace(0.0, 2.0, 401)
    share = 0.5 - 0.5 * np.cos(np.pi * time / 2.0)
    values = {name: np.full(401, value) for name, value in START.items()}
    values["turn"] = -0.6 + 0.8 * share
    values["wrist_3"] = 2.8 * share
    names = dict(zip(swapped, swapped[::-1], strict=True))
    columns = {"time": time} | {names.get(name, name): value for name, value in values.items()} | recorded
    rows = "\n".join(",".join(f"{value:.6f}" for value in row) for row in np.column_stack(list(columns.values())))
    (folder / "log.csv").write_text(",".join(columns) + "\n" + rows + "\n")
    return folder / "log.csv"


def judged(file: Path, arm: arms.Arm | None = None, **more: Any) -> program.ProgramStudy:
    motion = program.ArmMotion.from_log(arm or example(), file, velocity=VELOCITY, acceleration=30.0)
    part = program.Segment(
        start=0.0, end=2.0, regions=["chest"], clamped=False, reason="nothing stands behind the person"
    )
    gripper = program.ContactPoint(name="gripper", link="tool", area=4e-4)
    return program.Program(motion=motion, points=[gripper], segments=[part], **more).report(intervals=200)


def codes(study: program.ProgramStudy) -> set[str]:
    return {each.code for each in study.warnings} & OF_LOGS


def test_a_right_log_has_no_doubt_with_or_without_what_the_controller_says_of_the_tool(tmp_path: Path) -> None:
    study = judged(log(tmp_path))
    assert codes(study) == set()
    arm = example()
    motion = study.program.motion
    places = arm.position(motion.log.joints, link="tool") + np.array([0.3, -2.0, 1.0])
    recorded = dict(zip(("tcp_x", "tcp_y", "tcp_z"), places.T, strict=True))
    assert codes(judged(log(tmp_path, **recorded))) == set()
    speed = np.linalg.norm(np.gradient(places, motion.log.time, axis=0), axis=1)
    assert codes(judged(log(tmp_path, tcp_speed=speed))) == set()
    # Another place on the tool is another motion.
    assert codes(judged(log(tmp_path, tcp_speed=speed), point=(0.1, 0.1, 0.0))) == {"log_disagrees_with_tool"}


def test_swapped_columns_are_doubted_where_a_limit_or_the_tool_refutes_them(tmp_path: Path) -> None:
    study = judged(log(tmp_path, ("turn", "wrist_3")))
    assert codes(study) == {"faster_than_drive"}
    assert study.verdict in ("not_checked", "exceeds")
    arm = example()
    places = arm.position(judged(log(tmp_path)).program.motion.log.joints, link="tool")
    speed = np.linalg.norm(np.gradient(places, 0.005, axis=0), axis=1)
    assert codes(judged(log(tmp_path, ("turn", "wrist_3"), tcp_speed=speed))) == {
        "faster_than_drive",
        "log_disagrees_with_tool",
    }
    # Joints slow enough for each other: only the tool tells.
    assert codes(judged(log(tmp_path, ("turn", "wrist_1")))) == set()
    assert codes(judged(log(tmp_path, ("turn", "wrist_1"), tcp_speed=speed))) == {"log_disagrees_with_tool"}


def test_values_beyond_the_limits_of_a_joint_are_refused(tmp_path: Path) -> None:
    text = arms.Arm.example().urdf.replace('lower="-2.8" upper="2.8"', 'lower="-2.8" upper="1.2"')
    assert text != arms.Arm.example().urdf
    arm = arms.Arm.from_urdf(text, armature=1.0, payload=arms.Payload("tool", 1.0))
    with pytest.raises(InvalidParameterError, match=r'"elbow"\] must be from -2.8 to 1.2, got 1.45'):
        judged(log(tmp_path), arm)


@pytest.mark.parametrize(
    ("place", "payload", "doubted"),
    [((0.0, 0.0, 0.15), None, True), ((0.0, 0.0, 0.15), 1.0, False), ((0.0, 0.0, 0.03), None, True)],
)
def test_a_tool_that_weighs_nothing_is_doubted(
    place: tuple[float, float, float], payload: float | None, doubted: bool
) -> None:
    carried = None if payload is None else arms.Payload("tool", payload)
    arm = arms.Arm.example(armature=1.0, payload=carried)
    moves = [program.Move(kind="joint", to=each) for each in (START, START | {"turn": 0.2})]
    motion = program.ArmMotion.from_moves(arm, moves, velocity=0.02, acceleration=4.0)
    part = program.Segment(start="move 1", end="move 2", regions=["chest"], clamped=False, reason="open space behind")
    points = [program.ContactPoint(name="gripper", link="tool", point=place, area=4e-4)]
    study = program.Program(motion=motion, points=points, segments=[part]).report(intervals=100)
    assert ("tool_without_mass" in study.fields["doubts"]) == doubted
    assert study.verdict == ("not_checked" if doubted else "within_limits")
    alone = {"tool_without_mass": "it pushes boxes with its flange, J. Doe"}
    assert program.Program(motion=motion, points=points, segments=[part], confirmed=alone).report(
        intervals=100
    ).verdict == ("within_limits")
