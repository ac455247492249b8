"""Properties of effective masses: bounds, symmetries, energies, whatever the arm."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some

from hrsafety import arms

ANGLES = some.lists(some.floats(-2.5, 2.5), min_size=6, max_size=6)
POINTS = some.tuples(*(some.floats(-0.2, 0.2) for _ in range(3)))
DIRECTIONS = some.tuples(*(some.floats(-1.0, 1.0) for _ in range(3))).filter(lambda each: np.linalg.norm(each) > 0.1)
ARM = arms.Arm.example()
JOINTS = some.sampled_from(ARM.joint_names)
EXACT = 1e-9


@given(pose=ANGLES, point=POINTS, direction=DIRECTIONS)
def test_masses_lie_between_the_extremes(pose: list[float], point: Any, direction: Any) -> None:
    place = {"link": "tool", "point": point}
    mass = ARM.effective_mass(pose, direction=direction, **place).mass
    found = ARM.extremes(pose, **place)
    assert found.least_mass * (1.0 - EXACT) <= mass
    assert mass <= found.worst_mass * (1.0 + 1e-6)  # ratios of up to 1e9 lose digits of the larger one
    turned = ARM.effective_mass(pose, direction=-7.0 * np.array(direction), **place).mass
    assert turned == pytest.approx(mass, rel=EXACT)
    along = ARM.effective_mass(pose, direction=found.least_direction, **place).mass
    assert along == pytest.approx(float(found.least_mass), rel=EXACT)


@given(
    pose=ANGLES, point=POINTS, direction=DIRECTIONS, joint=some.sampled_from(ARM.joint_names), more=some.floats(0, 5)
)
def test_motor_inertia_never_lowers_a_mass(pose: Any, point: Any, direction: Any, joint: str, more: float) -> None:
    place = {"link": "tool", "point": point, "direction": direction}
    heavier = arms.Arm.example(armature={joint: more})
    assert heavier.effective_mass(pose, **place).mass >= ARM.effective_mass(pose, **place).mass * (1.0 - EXACT)


@given(pose=ANGLES, direction=DIRECTIONS, joint=JOINTS)
def test_a_locked_joint_never_lowers_a_mass(pose: Any, direction: Any, joint: str) -> None:
    place = {"link": "tool", "direction": direction}
    locked = arms.Arm.example(locked=[joint])
    assert locked.effective_mass(pose, **place).mass >= ARM.effective_mass(pose, **place).mass * (1.0 - EXACT)


@given(pose=ANGLES, point=POINTS, turn=some.floats(-3.0, 3.0))
def test_turning_the_whole_arm_turns_the_mobility(pose: list[float], point: Any, turn: float) -> None:
    place = {"link": "tool", "point": point}
    turned = [pose[0] + turn, *pose[1:]]
    cosine, sine = np.cos(turn), np.sin(turn)
    rotation = np.array([[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]])
    before = ARM.mobility(pose, **place)
    after = ARM.mobility(turned, check_limits=False, **place)
    assert np.allclose(after, rotation @ before @ rotation.T, rtol=0, atol=1e-10 * np.trace(before))


@given(pose=ANGLES, point=POINTS, axis=some.integers(0, 5))
@settings(max_examples=50)
def test_velocity_is_the_derivative_of_the_position(pose: list[float], point: Any, axis: int) -> None:
    place = {"link": "tool", "point": point}
    step = 1e-5
    shift = np.eye(6)[axis] * step
    there, back = (ARM.position(np.array(pose) + sign * shift, check_limits=False, **place) for sign in (1.0, -1.0))
    velocity = ARM.velocity(pose, np.eye(6)[axis], **place)
    assert np.allclose(velocity, (there - back) / (2.0 * step), atol=1e-8)


@given(pose=ANGLES, direction=DIRECTIONS, factor=some.floats(0.1, 10.0))
def test_a_denser_arm_is_heavier_in_proportion(pose: Any, direction: Any, factor: float) -> None:
    def scaled(text: str, name: str) -> str:
        head, *parts = text.split(f'{name}="')
        return head + "".join(
            f'{name}="{factor * float(part[: part.index(chr(34))])!r}{part[part.index(chr(34)) :]}' for part in parts
        )

    text = ARM.urdf
    for name in ("<mass value", "ixx", "iyy", "izz"):
        text = scaled(text, name)
    place = {"link": "tool", "direction": direction}
    denser = arms.Arm.from_urdf(text).effective_mass(pose, **place).mass
    assert denser == pytest.approx(factor * ARM.effective_mass(pose, **place).mass, rel=1e-7)
