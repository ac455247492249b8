"""Properties of doubts about arms: numbers in another unit are told, and projections never lower a mass."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
from hypothesis import given
from hypothesis import strategies as some

from hrsafety import arms
from hrsafety.arms.masses import RULES
from hrsafety.plausibility import unsafe_doubts

MOTORS = [1.2, 1.2, 1.0, 0.3, 0.3, 0.3]
EXAMPLE = arms.Arm.example().urdf
PLACE = {"link": "tool", "direction": (0.6, -0.48, 0.64)}
POSE = [0.2, 0.4, 1.4, -0.3, 0.5, 0.1]
NUMBERS = some.floats(-1.0, 1.0)
MASSES = ("mass value", "ixx", "iyy", "izz")
FAR = some.floats(3.0, 6.0)


def scaled(factor: float, *names: str) -> arms.Arm:
    """Return the example arm with some numbers times a factor."""

    def times(match: re.Match[str]) -> str:
        values = (repr(factor * float(each)) for each in match[2].split())
        return f'{match[1]}="{" ".join(values)}"'

    return arms.Arm.from_urdf(re.sub(rf'({"|".join(names)})="([^"]*)"', times, EXAMPLE), armature=MOTORS)


@given(power=some.floats(1.1, 6.0))
def test_masses_too_small_by_any_unit_are_unsafe(power: float) -> None:
    arm = scaled(10.0**-power, *MASSES)
    for rule in RULES:
        assert unsafe_doubts(arm.robot_mass(POSE, **PLACE, rule=rule).warnings)


@given(power=FAR)
def test_masses_too_large_by_any_unit_are_told(power: float) -> None:
    assert scaled(10.0**power, *MASSES).effective_mass(POSE, **PLACE).warnings


@given(power=some.one_of(some.floats(0.5, 6.0), some.floats(-6.0, -3.0)))
def test_lengths_in_another_unit_are_told(power: float) -> None:
    assert unsafe_doubts(scaled(10.0**power, "origin xyz").warnings)


@given(power=some.floats(5.0, 9.0))
def test_inertias_in_another_unit_are_told(power: float) -> None:
    assert unsafe_doubts(scaled(10.0**-power, "ixx", "iyy", "izz").effective_mass(POSE, **PLACE).warnings)
    assert scaled(10.0**power, "ixx", "iyy", "izz").warnings


@given(powers=some.lists(some.floats(4.0, 9.0), min_size=6, max_size=6))
def test_motors_on_the_side_of_the_rotor_never_silence_the_doubt(powers: list[float]) -> None:
    arm = arms.Arm.example(armature=[10.0**-power for power in powers])
    assert "armature_suspicious" in {each.code for each in unsafe_doubts(arm.effective_mass(POSE, **PLACE).warnings)}


PAYLOADS = some.just(0.0) | some.floats(0.005, 20.0)


@given(mass=PAYLOADS, center=some.tuples(NUMBERS, NUMBERS, NUMBERS), unit=some.sampled_from([1e2, 1e3]))
def test_payloads_in_another_unit_are_told(mass: float, center: Any, unit: float) -> None:
    place = np.array(center) * 0.3 / max(np.linalg.norm(center), 0.3)
    assert arms.Arm.example(armature=MOTORS, payload=("tool", mass, place)).warnings == ()
    away = arms.Arm.example(armature=MOTORS, payload=("tool", mass, unit * place))
    assert bool(unsafe_doubts(away.warnings)) == (np.linalg.norm(unit * place) > 1.0)
    heavy = arms.Arm.example(armature=MOTORS, payload=("tool", 1000.0 * mass))
    assert bool(heavy.warnings) is (1000.0 * mass > 29.0)


@given(entries=some.lists(NUMBERS, min_size=6, max_size=6), shift=some.floats(0.0, 2.0))
def test_the_nearest_inertia_is_one_of_a_body_and_never_less(entries: list[float], shift: float) -> None:
    xx, xy, xz, yy, yz, zz = entries
    matrix = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) + shift * np.eye(3)
    found = arms.nearest_inertia(matrix)
    scale = max(np.abs(matrix).max(), 1e-300)
    second = 0.5 * np.trace(found.inertia) * np.eye(3) - found.inertia
    assert np.linalg.eigvalsh(second).min() >= -1e-6 * scale
    assert np.linalg.eigvalsh(found.inertia - matrix).min() >= -1e-13 * scale
    assert np.allclose(arms.nearest_inertia(found.inertia).inertia, found.inertia, atol=1e-6 * scale)
    own = 0.5 * np.trace(matrix) * np.eye(3) - matrix
    least = np.linalg.eigvalsh(own).min()
    if least >= 0.0:
        assert np.array_equal(found.inertia, matrix)
    elif np.trace(matrix) > 1e-9:
        assert math.isclose(found.violation, -least / np.trace(matrix), rel_tol=1e-6, abs_tol=1e-12)


@given(moment=some.floats(0.45, 5.0), axis=some.sampled_from(["ixx", "iyy", "izz"]))
def test_a_repaired_inertia_never_lowers_a_mass(moment: float, axis: str) -> None:
    upper = re.search(r'<link name="upper_arm">.*?</link>', EXAMPLE, flags=re.DOTALL)
    assert upper is not None
    text = EXAMPLE.replace(upper[0], re.sub(rf'{axis}="[^"]*"', f'{axis}="{moment}"', upper[0]))
    fixed = arms.Arm.from_urdf(text, armature=MOTORS, repair_inertia=True)
    # The moment is larger than that of the example, and the nearest inertia of a body is larger again.
    least = arms.Arm.from_urdf(EXAMPLE, armature=MOTORS).effective_mass(POSE, **PLACE)
    assert float(fixed.effective_mass(POSE, **PLACE)) >= float(least) * (1.0 - 1e-9)
