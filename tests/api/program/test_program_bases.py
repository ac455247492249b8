"""Programs of arms whose base drives: speeds and masses with the motion of the base, logs of its pose, doubts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrsafety import arms, contact, program
from hrsafety.errors import InvalidParameterError

START = {"turn": -0.6, "shoulder": 0.35, "elbow": 1.45, "wrist_1": -0.23, "wrist_2": -1.5708, "wrist_3": 0.0}
MOTORS = dict(zip(START, [1.2, 1.2, 1.0, 0.3, 0.3, 0.3], strict=True))
BASES = {
    "differential": {"axle": (0.15, 0.0), "heading": 0.4},
    "omni": {"heading": -0.7},
}
LIMITS: dict[str, Any] = {"velocity": 1.5, "acceleration": 2.0}
GRIPPER = program.ContactPoint(name="gripper", link="tool", area=4e-4)
CHASSIS = program.ContactPoint(name="bumper", link="base", point=(0.4, 0.1, 0.2), area=4e-3)


def robot(kind: str, **more: Any) -> arms.Arm:
    """Return the arm of examples on a base."""
    base = arms.RollingBase(kind=kind, mass=60.0, **({"inertia": 4.0} | BASES[kind] | more))
    return arms.Arm.example(armature=MOTORS, base=base, payload=arms.Payload("tool", 1.0))


def judged(motion: program.ArmMotion, *points: program.ContactPoint, **more: Any) -> program.ProgramStudy:
    """Return the study of a motion beside a chest."""
    names = list(motion.marks)
    ends = {"start": names[0], "end": names[-1]} if names else {"start": 0.0, "end": float(motion.log.time[-1])}
    part = program.Segment(regions=["chest"], clamped=False, reason="nothing stands behind", **ends)
    return program.Program(motion=motion, points=points, segments=[part], **more).report(intervals=200)


def log_of(arm: arms.Arm, ways: np.ndarray, time: np.ndarray, turn: np.ndarray) -> str:
    """Return a log as a controller writes it: joints of the arm, and the pose of the base on the floor."""
    poses = arm.base.on_floor(ways) + np.array([2.0, -1.0, 0.0])  # type: ignore[union-attr]  # rolls
    poses[:, 2] = np.remainder(poses[:, 2] + np.pi, 2.0 * np.pi) - np.pi
    columns = {"time": time} | {name: np.full(len(time), value) for name, value in START.items()} | {"turn": turn}
    columns |= dict(zip(("base_x", "base_y", "base_turn"), poses.T, strict=True))
    rows = "\n".join(",".join(f"{value:.9f}" for value in row) for row in np.column_stack(list(columns.values())))
    return ",".join(columns) + "\n" + rows + "\n"


@given(seed=st.integers(0, 10**6), kind=st.sampled_from(sorted(BASES)))
def test_ways_are_those_of_poses_on_the_floor(seed: int, kind: str) -> None:
    draw = np.random.default_rng(seed)
    base = arms.RollingBase(
        kind=kind, mass=1.0, inertia=1.0, axle=tuple(draw.normal(0.0, 0.3, 2)), heading=draw.uniform(-3.0, 3.0)
    )
    ways = np.cumsum(draw.uniform(-0.2, 0.2, (30, 3)), axis=0)
    ways -= ways[0]
    ways[:, 1] *= kind == "omni"
    floor = base.on_floor(ways)
    angle = draw.uniform(-3.0, 3.0)
    turned = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    # Wherever the floor has its origin, and with angles within half a turn of 0.
    moved = np.column_stack([floor[:, :2] @ turned.T + draw.normal(0.0, 5.0, 2), floor[:, 2] + angle])
    moved[:, 2] = np.remainder(moved[:, 2] + np.pi, 2.0 * np.pi) - np.pi
    assert base.ways(moved) == pytest.approx(ways, abs=1e-9)


@pytest.mark.parametrize("kind", sorted(BASES))
def test_points_move_with_the_base(kind: str, tmp_path: Path) -> None:
    arm = robot(kind)
    time = np.linspace(0.0, 4.0, 401)
    share = 0.5 - 0.5 * np.cos(np.pi * time / 4.0)
    ways = np.column_stack([0.6 * share, (0.2 if kind == "omni" else 0.0) * share, 1.1 * share])
    file = tmp_path / "log.csv"
    file.write_text(log_of(arm, ways, time, -0.6 + 0.5 * share))
    motion = program.ArmMotion.from_log(arm, file, **LIMITS)
    study = judged(motion, GRIPPER, CHASSIS)
    assert "base_taken_as_parked" not in {each.code for each in study.warnings}
    assert "base_without_point" not in {each.code for each in study.warnings}
    # Places on the floor, found without the package's velocities: the frame of the root moves with its pose.
    poses = arm.base.on_floor(ways)
    joints = np.zeros((len(time), len(arm.joint_names)))
    for name, value in START.items():
        joints[:, arm.joint_names.index(name)] = value
    joints[:, arm.joint_names.index("turn")] = -0.6 + 0.5 * share
    columns = study.columns()
    for point in (GRIPPER, CHASSIS):
        own = arm.position(joints, link=point.link, point=point.point)
        cosine, sine = np.cos(poses[:, 2]), np.sin(poses[:, 2])
        x = poses[:, 0] + cosine * own[:, 0] - sine * own[:, 1]
        y = poses[:, 1] + sine * own[:, 0] + cosine * own[:, 1]
        speed = np.linalg.norm(np.gradient(np.column_stack([x, y, own[:, 2]]), time, axis=0), axis=1)
        found = columns["speed_m_per_s"][columns["point"] == point.name]
        assert found[5:-5] == pytest.approx(speed[5:-5], rel=2e-3, abs=1e-4)


def test_masses_are_those_of_the_base_and_the_arm_together() -> None:
    arm = robot("omni")
    still = [program.Move(kind="joint", to=START)]
    driving = program.ArmMotion.from_moves(arm, [*still, program.Move(kind="joint", to={"base_x": 1.0})], **LIMITS)
    study = judged(driving, GRIPPER, robot_mass="directional")
    # All of it moves along one line: the energy is that of one body.
    columns = study.columns()
    energies = columns["mass_energy_kg"]
    assert energies[np.isfinite(energies)] == pytest.approx(arm.total_mass + arm.payload_mass, rel=1e-9)
    assert "base_without_point" in {each.code for each in study.warnings}
    assert study.verdict != "within_limits"
    masses = columns["mass_along_motion_kg"]
    assert (masses[np.isfinite(masses)] <= energies[np.isfinite(energies)]).all()


@pytest.mark.parametrize("kind", sorted(BASES))
def test_where_a_base_stands_on_the_floor_changes_nothing(kind: str) -> None:
    arm = robot(kind)
    there = {"base_x": 3.0, "base_turn": 2.0} | ({"base_y": -1.0} if kind == "omni" else {})
    for link in ("tool", "base"):
        at_zero = arm.effective_mass(START, link=link, point=(0.1, 0.2, 0.0), direction=(0.6, 0.8, 0.0)).mass
        elsewhere = arm.effective_mass(START | there, link=link, point=(0.1, 0.2, 0.0), direction=(0.6, 0.8, 0.0)).mass
        assert elsewhere == at_zero


def test_a_retimed_log_is_read_again(tmp_path: Path) -> None:
    arm = robot("differential")
    moves = [program.Move(kind="joint", to=START), program.Move(kind="joint", to={"base_x": 0.8, "base_turn": 0.9})]
    run = program.ArmMotion.from_moves(arm, moves, **LIMITS).retimed()
    columns = run.columns()
    file = tmp_path / "again.csv"
    names = [f"{name} [s]" if name == "time" else name for name in columns]
    rows = "\n".join(",".join(repr(value) for value in row) for row in np.column_stack(list(columns.values())).tolist())
    file.write_text(",".join(names) + "\n" + rows + "\n")
    again = program.ArmMotion.from_log(arm, file, **LIMITS)
    assert again.retimed().time == pytest.approx(run.time, rel=5e-3)
    assert again.log.joints[-1] == pytest.approx(run.motion.curve.end[0], abs=1e-9)


def test_logs_that_leave_the_base_open_are_doubted_or_refused(tmp_path: Path) -> None:
    arm, fixed = robot("differential"), arms.Arm.example(armature=MOTORS)
    time = np.linspace(0.0, 2.0, 201)
    ways = np.zeros((201, 3))
    ways[:, 0] = 0.3 * (1.0 - np.cos(np.pi * time / 2.0))
    text = log_of(arm, ways, time, -0.6 + 0.1 * np.sin(time))

    def read(content: str, of: arms.Arm = arm, **more: Any) -> program.ArmMotion:
        (tmp_path / "log.csv").write_text(content)
        return program.ArmMotion.from_log(of, tmp_path / "log.csv", **(LIMITS | more))

    without = "\n".join(",".join(line.split(",")[:-3]) for line in text.split("\n"))
    parked = read(without)
    assert [each.code for each in parked.warnings if each.code.startswith("base")] == ["base_taken_as_parked"]
    assert judged(parked, GRIPPER).verdict == "not_checked"
    confirmed = {"base_taken_as_parked": "brakes were on, J. Doe"}
    codes = judged(parked, GRIPPER, confirmed=confirmed).fields["doubts"]
    assert "base_taken_as_parked" not in codes
    with pytest.raises(InvalidParameterError, match="have all columns of a base or none"):
        read(text.replace("base_turn", "yaw"))
    with pytest.raises(InvalidParameterError, match=r"base_x.*stand still: the robot has no base that rolls"):
        read(text, fixed)
    with pytest.raises(InvalidParameterError, match="drive along the heading of a differential base"):
        read(text, robot("differential", heading=1.2))
    with pytest.raises(InvalidParameterError, match=r"acceleration.base_x must be given: the base drives"):
        read(text, acceleration=dict.fromkeys(START, 2.0))
    turning = ways + np.column_stack([0.0 * time, 0.0 * time, 0.4 * ways[:, 0]])
    with pytest.raises(InvalidParameterError, match="a base without inertia does not"):
        read(log_of(arm, turning, time, -0.6 + 0.0 * time), robot("differential", inertia=None))


def test_a_driving_base_is_slowed_down_for_people() -> None:
    arm = robot("differential")
    moves = [program.Move(kind="joint", to=START), program.Move(kind="joint", to={"base_x": 2.0})]
    motion = program.ArmMotion.from_moves(arm, moves, **LIMITS)
    drive = contact.Drive(model="any_stiffness", reaction_time=0.02, deceleration=20.0)
    study = judged(motion, GRIPPER, CHASSIS, drive=drive)
    assert study.limited.status == "verified"
    assert study.limited.time > 1.5 * study.free.time
    assert study.limited.largest_share <= 1.0 + 1e-6


def test_a_base_that_may_be_held_is_doubted_where_that_is_heavier() -> None:
    moves = [program.Move(kind="joint", to=START), program.Move(kind="joint", to={"turn": 0.2})]
    motion = program.ArmMotion.from_moves(robot("omni"), moves, **LIMITS)
    for rule, doubted in (("directional", True), ("larger", False), ("iso", False)):
        study = judged(motion, GRIPPER, robot_mass=rule)
        assert any("base_may_be_held" in row["doubts"] for row in study.fields["rows"]) == doubted
    confirmed = judged(
        motion, GRIPPER, robot_mass="directional", confirmed={"base_may_be_held": "wheels are free, N. N."}
    )
    assert all("base_may_be_held" in row["confirmed"] for row in confirmed.fields["rows"])
