"""Printed forms of chapters 2 to 4 and appendix A that the errata list are told apart from the right ones.

Each test evaluates both forms with plain numbers: the package must agree with the right one and
not with the printed one.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from hrsafety import impact
from hrsafety.reproduce.impact.cases import FOAM_OF_FIGURES, printed_metrics, simulations
from reference.impact_modes import modal_peaks

EXACT = 1e-12  # a few operations apart
SAMPLED = 1e-6  # peaks on samples of 2.5 us
SEPARATED = 1e-3  # printed forms are farther off than any rounding

JOINT = impact.Joint(
    inertia=0.059,
    mechanical_stiffness=300.0,
    mechanical_damping=0.4,
    control_stiffness=121.68,
    control_damping=1.521,
)
LINKS = {"mass": (3.0, 2.0), "length": (0.43, 0.4)}


def off(one: float, other: float) -> float:
    return abs(one / other - 1.0)


@pytest.mark.parametrize("row", [1, 2, 3, 4])
def test_coefficient_q2_has_the_product_of_both_dampings(row: int) -> None:
    arm, head = simulations()[row]
    exact = impact.metrics(arm, FOAM_OF_FIGURES, head, closing_speed=1.25)
    printed = printed_metrics(arm, head)
    for found, form in ((exact, False), (printed, True)):
        wanted = modal_peaks(arm, FOAM_OF_FIGURES, head, closing_speed=1.25, printed=form)
        assert off(wanted.head_acceleration, found.peak_head_acceleration) < SAMPLED
        assert off(wanted.contact_force, found.peak_contact_force) < SAMPLED
    assert off(printed.peak_head_acceleration, exact.peak_head_acceleration) > SEPARATED
    assert off(printed.peak_contact_force, exact.peak_contact_force) > SEPARATED


@pytest.mark.parametrize(("neck", "arm"), [(0.0, 250.0), (46.0, 0.0)])
def test_both_forms_of_q2_agree_without_damping_of_neck_or_arm(neck: float, arm: float) -> None:
    setting = (
        impact.Manipulator(mass=9.6, damping=arm, stiffness=20e3),
        FOAM_OF_FIGURES,
        impact.Head(mass=4.4, damping=neck, stiffness=4e3),
    )
    right = impact.simulate(*setting, closing_speed=1.25)
    printed = impact.simulate(*setting, closing_speed=1.25, equations="as_printed")
    for name in ("contact_force", "head_acceleration", "head_position", "manipulator_velocity", "compression"):
        one, other = getattr(right, name), getattr(printed, name)
        assert np.abs(one - other).max() < EXACT * np.abs(one).max(), name


def test_power_of_the_injury_criterion_is_taken_of_the_integral() -> None:
    time = np.linspace(0.0, 0.01, 1001)
    pulse = 40.0 + 2000.0 * time
    found = impact.hic(time, pulse)
    width = found.end - found.start
    inside = (time >= found.start) & (time <= found.end)
    right = float(np.trapezoid(pulse[inside], time[inside])) ** 2.5 / width**1.5
    printed = float(np.trapezoid(pulse[inside] ** 2.5, time[inside])) / width**1.5
    assert off(found.value, right) < 1e-9  # windows end at samples
    assert off(found.value, printed) > SEPARATED


def test_error_of_the_reduced_joint_is_not_the_printed_one() -> None:
    omega = 95.0
    s = 1j * omega
    k_m, c_m, k_c, c_c = 300.0, 0.4, 121.68, 1.521
    exact = (k_m + c_m * s) * (k_c + c_c * s) / (k_m + k_c + (c_m + c_c) * s)
    right = -((k_c * c_m - k_m * c_c) ** 2) * s**2 / ((k_m + k_c) ** 2 * (k_m + k_c + (c_m + c_c) * s))
    printed = (c_m * c_c - (c_m + c_c) * JOINT.damping) * s**2 / (k_m + k_c + (c_m + c_c) * s)
    found = float(JOINT.model_error(omega))
    assert off(found, abs(right) / abs(exact)) < 1e-9  # the package subtracts two joints
    assert abs(exact - (JOINT.stiffness + JOINT.damping * s) - right) < 1e-9 * abs(exact)
    # The printed form has the letter C_r where the reduced damping stands; read so, it agrees.
    assert off(abs(printed), abs(right)) < 1e-9
    effective = JOINT.at(0.078).damping
    as_printed = (c_m * c_c - (c_m + c_c) * effective) * s**2 / (k_m + k_c + (c_m + c_c) * s)
    assert off(abs(as_printed), abs(right)) > SEPARATED


def test_printed_inertia_matrix_is_indefinite() -> None:
    (m2, m3), (a2, a3) = LINKS["mass"], LINKS["length"]
    right = impact.joints.uniform_links(**LINKS)
    diagonal = m2 * a2**2 / 3.0 + m3 * a2**2 + m3 * a3**2 / 3.0 + m3 * a2 * a3
    off_diagonal = m3 * a3**2 / 3.0 + m3 * a2 * a3
    printed = np.array([[diagonal, off_diagonal], [off_diagonal, m3 * a3**2 / 3.0]])
    assert np.linalg.eigvalsh(right).min() > 0.0
    assert np.linalg.eigvalsh(printed).min() < 0.0
    assert right[0, 1] == pytest.approx(m3 * a3**2 / 3.0 + m3 * a2 * a3 / 2.0, rel=EXACT)


@pytest.mark.parametrize(("damping", "equal"), [((40.0, 10.0), True), ((40.0, 25.0), False)])
def test_effective_damping_is_not_that_of_dashpots_alone(damping: tuple[float, float], equal: bool) -> None:
    stiffness, second, lever = (8000.0, 2000.0), 0.43, 0.4
    arm = impact.Manipulator.from_two_joints(
        mass_matrix=impact.joints.uniform_links(**LINKS),
        damping=damping,
        stiffness=stiffness,
        second_link=second,
        lever_arm=lever,
    )
    jacobian = np.array([second + lever, lever])
    right = arm.stiffness**2 * float(np.sum(jacobian**2 * np.array(damping) / np.array(stiffness) ** 2))
    printed = 1.0 / float(np.sum(jacobian**2 / np.array(damping)))
    assert off(arm.damping, right) < EXACT
    assert (off(arm.damping, printed) < EXACT) is equal


def test_stretched_arm_has_the_smallest_effective_mass() -> None:
    masses = [
        impact.Manipulator.from_two_joints(
            mass_matrix=impact.joints.uniform_links(**LINKS, elbow=elbow),
            damping=(40.0, 10.0),
            stiffness=(8000.0, 2000.0),
            second_link=0.43,
            lever_arm=0.4,
            elbow=elbow,
        ).mass
        for elbow in np.linspace(0.0, 1.5, 16)
    ]
    assert np.argmin(masses) == 0


def test_smaller_neck_gives_a_larger_acceleration_and_a_smaller_force() -> None:
    soft, stiff = (
        impact.metrics(impact.MANIPULATOR_1, FOAM_OF_FIGURES, simulations()[row][1], closing_speed=1.25)
        for row in (3, 1)
    )
    assert soft.peak_head_acceleration > stiff.peak_head_acceleration
    assert soft.peak_contact_force < stiff.peak_contact_force


def test_open_loop_angle_starts_with_half_the_acceleration() -> None:
    acceleration, decay = 1.504, 0.111
    time = np.linspace(0.0, 2.0, 201)
    right = acceleration * (decay * time - 1.0 + np.exp(-decay * time)) / decay**2
    printed = decay * (acceleration * time - 1.0 + np.exp(-acceleration * time)) / acceleration
    assert right[1] == pytest.approx(acceleration * time[1] ** 2 / 2.0, rel=1e-3)  # next term is of order kappa t
    assert printed[1] != pytest.approx(acceleration * time[1] ** 2 / 2.0, rel=0.1)
    fit = impact.identification.fit_open_loop(time, right)
    assert fit.acceleration == pytest.approx(acceleration, rel=1e-6)  # least squares on noiseless data
    assert fit.decay == pytest.approx(decay, rel=1e-4)


def test_derivative_gain_takes_the_friction_off_the_joint_not_off_the_impact_point() -> None:
    lever, constant, friction = 0.078, 0.27121, 0.0079945
    gains = impact.identification.pd_gains(
        stiffness=20e3, damping=250.0, lever_arm=lever, torque_constant=constant, viscous_friction=friction
    )
    drive = impact.joints.DirectDrive(
        proportional=gains.proportional,
        derivative=gains.derivative,
        torque_constant=constant,
        viscous_friction=friction,
    )
    assert drive.linear().damping == pytest.approx(250.0, rel=EXACT)
    printed = (250.0 - friction) * lever**2 / constant
    assert off(printed, gains.derivative) > SEPARATED


def test_foam_2_follows_from_13_48_and_not_from_the_printed_line() -> None:
    assert 2.0 * 0.086 * math.sqrt(4.4 * 13840.0) == pytest.approx(42.44, abs=0.005)
    assert 2.0 * 0.09 * math.sqrt(4.4 * 13480.0) == pytest.approx(43.84, abs=0.005)


def test_tube_of_the_printed_inertia_has_open_ends_and_thin_walls() -> None:
    tube = impact.identification.tube_inertia(
        density=2700.0, length=0.664, width=0.0508, height=0.0508, wall=0.0254 / 16.0
    )
    assert tube.inertia == pytest.approx(0.020811, abs=5e-7)
    thick = impact.identification.tube_inertia(density=2700.0, length=0.664, width=0.0508, height=0.0508, wall=0.003)
    assert off(thick.inertia, 0.0208) > 0.5
