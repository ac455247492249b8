"""Arms of tests: chains of joints about one axis, and motions of programs along them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from hrsafety import arms, program

ROUND = 20.0
"""Limit of the joints of a chain in rad."""


def chain(joints: int, lengths: Sequence[float] = (), masses: Sequence[float] = ()) -> arms.Arm:
    """Return a chain of joints about z: links along x, each with a mass at its end."""
    lengths = lengths or [0.2] * joints
    masses = masses or [1.0] * joints
    parts = ['<robot name="chain"><link name="base"/>']
    for place, (length, mass) in enumerate(zip(lengths, masses, strict=True)):
        before = "base" if place == 0 else f"link{place}"
        origin = 0.0 if place == 0 else lengths[place - 1]
        parts.append(
            f'<link name="link{place + 1}"><inertial><origin xyz="{length} 0 0"/><mass value="{mass}"/>'
            '<inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial></link>'
            f'<joint name="joint{place + 1}" type="revolute"><parent link="{before}"/><child link="link{place + 1}"/>'
            f'<origin xyz="{origin} 0 0"/><axis xyz="0 0 1"/>'
            f'<limit lower="-{ROUND}" upper="{ROUND}" effort="1" velocity="2"/></joint>'
        )
    return arms.Arm.from_urdf("".join([*parts, "</robot>"]))


def motion_of(
    arm: arms.Arm, poses: Sequence[Sequence[float]], blends: Sequence[float] = (), **limits: object
) -> program.ArmMotion:
    """Return the motion through poses, straight in the joints, with blends at the corners."""
    blends = [*blends, *[0.0] * (len(poses) - len(blends))]
    moves = [program.Move(kind="joint", to=list(pose), blend=blend) for pose, blend in zip(poses, blends, strict=True)]
    return program.ArmMotion.from_moves(arm, moves, **limits)  # type: ignore[arg-type]  # limits of joints


def example() -> arms.Arm:
    """Return the arm of examples with motors and a payload."""
    motors = {"turn": 1.2, "shoulder": 1.2, "elbow": 1.0, "wrist_1": 0.3, "wrist_2": 0.3, "wrist_3": 0.3}
    payload = {"link": "tool", "mass": 2.0, "center": (0.0, 0.0, 0.06)}
    return arms.Arm.example(armature=motors, payload=payload)


def task(motion: program.ArmMotion, **more: object) -> program.Program:
    """Return a program with a gripper beside a hand on the whole path."""
    given: dict[str, object] = {
        "motion": motion,
        "points": [program.ContactPoint(name="gripper", link=motion.arm.moved_links[-1], area=1e-4)],
        "segments": [program.Segment(start=0.0, end=motion.curve.length, regions=["hand_finger"])],
    }
    return program.Program(**(given | more))  # type: ignore[arg-type]  # checked by the class


def sines(joints: int, seed: int) -> np.ndarray:
    """Return random poses that follow each other smoothly."""
    draw = np.random.default_rng(seed)
    return np.cumsum(draw.uniform(-0.6, 0.6, (8, joints)), axis=0)
