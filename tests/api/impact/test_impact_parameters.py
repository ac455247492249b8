"""Parameter classes of an impact: published numbers, equality, and the formulas of joints."""

from __future__ import annotations

import math
import pickle
from typing import Any

import numpy as np
import pytest

from hrsafety import impact

JOINT = impact.Joint(
    inertia=0.059,
    mechanical_stiffness=1216.8,
    mechanical_damping=0.3,
    control_stiffness=121.68,
    control_damping=1.521,
)

# Formulas of a few operations: a few units in the last place.
ROUNDING = 1e-14


def test_constrained_heads_are_equal() -> None:
    head = impact.ConstrainedHead()
    assert pickle.loads(pickle.dumps(head)) == head == impact.ConstrainedHead()
    assert repr(head) == "ConstrainedHead()"
    assert head != impact.Head.minimum()


def test_values_of_another_class_are_not_equal() -> None:
    assert impact.Head(mass=9.6, damping=250.0, stiffness=20e3) != impact.MANIPULATOR_1


def test_numbers_of_any_kind_are_accepted() -> None:
    made = impact.Manipulator(mass=np.float32(4.0), damping=np.int64(250), stiffness=np.float64(2e4))
    assert made == impact.Manipulator(mass=4, damping=250, stiffness=20_000)
    assert type(made.mass) is float


def test_same_parameters_give_the_same_bits_after_a_pickle() -> None:
    parts = (impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum())
    first = impact.metrics(*parts, closing_speed=1.25)
    assert impact.metrics(*pickle.loads(pickle.dumps(parts)), closing_speed=1.25) == first
    assert pickle.loads(pickle.dumps(first)) == first


# ---- published sets ---------------------------------------------------------------------------


def numbers(value: Any) -> tuple[float, ...]:
    return tuple(getattr(value, name) for name in ("mass", "damping", "stiffness") if hasattr(value, name))


def test_sets_are_those_of_the_tables() -> None:
    assert numbers(impact.MANIPULATOR_1) == (9.6, 250.0, 20e3)
    assert numbers(impact.MANIPULATOR_2) == (49.4, 111.0, 14.4e3)
    assert [numbers(impact.Head.simulation(row)) for row in (1, 2, 3, 4)] == [
        (4.4, 130.0, 5e3),
        (4.4, 130.0, 5e3),
        (4.4, 46.0, 3e3),
        (5.3, 130.0, 5e3),
    ]
    assert numbers(impact.Head.apparatus()) == (4.4, 0.0, 4e3)
    assert [(foam.stiffness, foam.damping) for foam in (impact.FOAM_1, impact.FOAM_2, impact.FOAM_3)] == [
        (24.3e3, 71.9),
        (13.8e3, 43.8),
        (60.6e3, 113.6),
    ]


def test_extreme_heads_are_rows_of_the_table() -> None:
    assert impact.Head.minimum() == impact.Head.simulation(3)
    assert impact.Head.maximum() == impact.Head.simulation(4)


# ---- joints -----------------------------------------------------------------------------------


def test_reduced_joint_is_the_series_of_springs() -> None:
    mechanical, control = JOINT.mechanical_stiffness, JOINT.control_stiffness
    assert JOINT.stiffness == pytest.approx(mechanical * control / (mechanical + control), rel=ROUNDING)
    total = (mechanical + control) ** 2
    damping = (control**2 * JOINT.mechanical_damping + mechanical**2 * JOINT.control_damping) / total
    assert JOINT.damping == pytest.approx(damping, rel=ROUNDING)


@pytest.mark.parametrize(("factor", "printed"), [(10.0, 0.075), (1.0, 0.23)])
def test_model_error_is_the_published_share_of_the_exact_joint(factor: float, printed: float) -> None:
    joint = impact.Joint(
        inertia=0.059,
        mechanical_stiffness=factor * 121.68,
        mechanical_damping=0.0,
        control_stiffness=121.68,
        control_damping=1.521,
    )
    digits = 3 if printed < 0.1 else 2
    assert round(float(joint.model_error(95.0)), digits) == printed


def test_model_error_is_the_one_of_the_series_in_complex_numbers() -> None:
    omega = np.array([[0.0, 1.0, 10.0], [95.0, 1e3, 1e5]])
    s = 1j * omega
    mechanical = JOINT.mechanical_stiffness + JOINT.mechanical_damping * s
    control = JOINT.control_stiffness + JOINT.control_damping * s
    exact = mechanical * control / (mechanical + control)
    share = np.abs(exact - (JOINT.stiffness + JOINT.damping * s)) / np.abs(exact)
    found = JOINT.model_error(omega)
    assert found.shape == omega.shape
    assert found == pytest.approx(share, rel=1e-9, abs=1e-12)


def test_joint_without_a_proportional_mismatch_has_no_model_error() -> None:
    joint = impact.Joint(
        inertia=1.0,
        mechanical_stiffness=200.0,
        mechanical_damping=2.0,
        control_stiffness=100.0,
        control_damping=1.0,
    )
    assert joint.model_error([0.0, 10.0, 1e4]) == pytest.approx(np.zeros(3), abs=ROUNDING)


def test_one_joint_scales_with_the_square_of_the_lever() -> None:
    near, far = JOINT.at(0.1), JOINT.at(0.2)
    assert numbers(near) == pytest.approx([4.0 * value for value in numbers(far)], rel=ROUNDING)
    assert near.mass == pytest.approx(0.059 / 0.01, rel=ROUNDING)


MATRIX = np.array([[3.0, 1.0], [1.0, 0.6]])
DAMPING, STIFFNESS = (40.0, 10.0), (8000.0, 2000.0)


@pytest.mark.parametrize("elbow", [0.0, 0.4, -1.2, 2.5, math.pi])
def test_two_joints_are_reduced_along_the_normal_of_the_last_link(elbow: float) -> None:
    arm = impact.Manipulator.from_two_joints(
        mass_matrix=MATRIX, damping=DAMPING, stiffness=STIFFNESS, second_link=0.43, lever_arm=0.4, elbow=elbow
    )
    row = np.array([0.43 * np.cos(elbow) + 0.4, 0.4])
    compliance = np.diag(1.0 / np.array(STIFFNESS))
    stiffness = 1.0 / (row @ compliance @ row)
    assert arm.mass == pytest.approx(1.0 / (row @ np.linalg.solve(MATRIX, row)), rel=1e-12)
    assert arm.stiffness == pytest.approx(stiffness, rel=1e-12)
    damping = stiffness**2 * (row @ compliance @ np.diag(DAMPING) @ compliance @ row)
    assert arm.damping == pytest.approx(damping, rel=1e-12)


def test_damping_ratio_is_rescaled_to_the_moving_mass() -> None:
    foam = impact.Foam.from_damping_ratio(stiffness=24.25e3, damping_ratio=0.112, moving_mass=4.4)
    assert foam.damping == pytest.approx(2 * 0.112 * math.sqrt(4.4 * 24.25e3), rel=ROUNDING)
    assert foam.stiffness == 24.25e3


def test_speed_of_the_impact_point_is_that_of_its_links() -> None:
    second, lever, elbow, rates = 0.43, 0.4, 0.7, np.array([0.8, -0.3])
    step = 1e-6

    def place(time: float) -> np.ndarray:
        first, both = 0.2 + rates[0] * time, 0.2 + elbow + rates.sum() * time
        return second * np.array([np.cos(first), np.sin(first)]) + lever * np.array([np.cos(both), np.sin(both)])

    normal = np.array([-np.sin(0.2 + elbow), np.cos(0.2 + elbow)])
    wanted = float(normal @ (place(step) - place(-step))) / (2.0 * step)
    found = impact.joints.impact_point_speed(rates, second_link=second, lever_arm=lever, elbow=elbow)
    assert found == pytest.approx(wanted, rel=1e-9)  # central differences
    straight = impact.joints.impact_point_speed(rates, second_link=second, lever_arm=lever)
    assert straight == pytest.approx((second + lever) * rates[0] + lever * rates[1], rel=ROUNDING)


def test_cylinder_is_commanded_by_its_errors_and_its_wanted_motion() -> None:
    command = impact.joints.CylinderController().command
    moving = {"desired_position": 0.2, "desired_velocity": 1.0, "position": 0.2, "velocity": 1.0}
    assert command(**moving) == pytest.approx(0.44, rel=ROUNDING)
    assert command(**moving, desired_acceleration=2.0) == pytest.approx(0.44 + 2.0 * 0.34, rel=ROUNDING)
    assert command(**{**moving, "position": 0.199}) == pytest.approx(0.44 + 0.2085, rel=1e-12)  # a difference
    assert command(**{**moving, "velocity": 0.9}) == pytest.approx(0.44 + 1.49, rel=1e-12)
