"""Appendix A: foam, direct-drive joint and its gains, from the printed tests."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np

from hrsafety import impact
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact import rig as impact_rig
from hrsafety.reproduce.impact.cases import CLOSING_SPEED, FOAM_OF_FIGURES, KILO, manipulator, published_lever_arm
from hrsafety.reproduce.published import printed_figure, printed_rows
from hrsafety.reproduce.sheets import Sheet

__all__ = ["cells", "drives"]

SHEET = Sheet("appendix_a")


def cells() -> list[PrintedValue]:
    """Return the cells of appendix A."""
    return [*_foam(), *impact_rig.arm(), *_table(), *_constants(), *_gains(), *_saturation(), *impact_rig.cylinder()]


def _figure(name: str) -> float:
    return printed_figure("A.2", name)


def _foam() -> Iterator[PrintedValue]:
    head = impact.Head.apparatus().mass
    for key, ratio, kept in ((1, 0.11, 0.112), (2, 0.086, 0.09)):
        damping = 2.0 * math.sqrt(head * (KILO * printed_figure("A.1", f"stiffness_{key}")))
        yield SHEET.number(f"damping_{key}", ratio * damping, kept=kept * damping)
    for key in (1, 2):
        yield from _recovered(key, seed=key)


def _recovered(foam: int, seed: int) -> Iterator[PrintedValue]:
    """Yield what the fits give back from tests made with the printed values of a foam."""
    mass, friction = printed_figure("A.1", "moving_mass"), printed_figure("A.1", "friction")
    stiffness, ratio = KILO * printed_figure("A.1", f"stiffness_{foam}"), printed_figure("A.1", f"damping_ratio_{foam}")
    source = np.random.default_rng(seed)
    time = np.arange(0.0, 0.4, 0.001)
    setting: dict[str, Any] = {"mass": mass, "stiffness": stiffness, "damping_ratio": ratio, "friction": friction}
    drops = [impact.identification.drop_trajectory(time, height=height, **setting) for height in (0.03, 0.045, 0.06)]
    compression = np.linspace(0.0, 0.008, 17)
    fit = impact.identify_foam(
        stiffness * compression + source.normal(0.0, 1.0, compression.size),
        compression,
        [time] * len(drops),
        [np.round(drop, 4) for drop in drops],
        mass,
    )
    for name, printed, measured, unit in (
        ("K_c", stiffness / KILO, fit.stiffness / KILO, "kN/m"),
        ("xi_c", ratio, fit.damping_ratio, "1"),
        ("friction", friction, fit.friction, "N"),
    ):
        yield SHEET.number("fitted", measured, printed=printed, foam=foam, name=name, unit=unit)


def _table() -> Iterator[PrintedValue]:
    for row in printed_rows("A.1"):
        yield SHEET.number("mean", float(np.mean(row["A"])), printed=row["A_mean"], voltage=row["u"])


@cache
def _fit() -> impact.identification.DirectDriveFit:
    rows = printed_rows("A.1")
    decay = [value for row in rows for value in row["kappa"]]
    return impact.identification.identify_direct_drive(
        [row["u"] for row in rows], [row["A_mean"] for row in rows], decay, _figure("inertia")
    )


def _constants() -> Iterator[PrintedValue]:
    fit = _fit()
    names = ("decay", "command_gain", "friction_offset", "torque_constant", "viscous_friction", "static_friction")
    for name in names:
        yield SHEET.number(name, getattr(fit, name))


@cache
def drives() -> dict[str, impact.joints.DirectDrive]:
    """Return the joint of Manipulator 1 with the printed constants and with the right ones."""
    fit = _fit()
    wanted = manipulator(1)
    made = {}
    for name, constant, friction, static in (
        ("printed", _figure("torque_constant"), _figure("viscous_friction"), _figure("static_friction")),
        ("right", fit.torque_constant, fit.viscous_friction, fit.static_friction),
    ):
        gains = impact.identification.pd_gains(
            stiffness=wanted.stiffness,
            damping=wanted.damping,
            lever_arm=published_lever_arm(1),
            torque_constant=constant,
            viscous_friction=friction,
        )
        made[name] = impact.joints.DirectDrive(
            proportional=gains.proportional,
            derivative=gains.derivative,
            inertia=wanted.mass * published_lever_arm(1) ** 2,
            lever_arm=published_lever_arm(1),
            torque_constant=constant,
            viscous_friction=friction,
            static_friction=static,
            voltage_limit=_figure("voltage_limit"),
        )
    return made


def _gains() -> Iterator[PrintedValue]:
    found = drives()
    for name in ("proportional", "derivative"):
        yield SHEET.number(name, getattr(found["printed"], name), right=getattr(found["right"], name))


def _saturation() -> Iterator[PrintedValue]:
    """Yield how far the real joint is from the linear one that the tables assume."""
    head = impact.Head.apparatus()
    wanted = manipulator(1)
    linear = impact.simulate(
        wanted, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED, manipulator_speed=0.25, duration=0.06, step=1e-5
    )
    end = int(np.searchsorted(linear.time, linear.metrics.impact_duration))
    push = -wanted.damping * (linear.manipulator_velocity - 0.25) - wanted.stiffness * (
        linear.manipulator_position - 0.25 * linear.time
    )
    drive = drives()["right"]
    real = impact.joints.simulate_direct_drive(
        drive, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED, manipulator_speed=0.25, duration=0.06, step=1e-5
    )
    yield SHEET.listed(
        "force_of_joint",
        limit=drive.torque_constant * drive.voltage_limit / drive.lever_arm,
        push=push[end],
        since=KILO * real.saturated_from,
    )
    yield SHEET.listed(
        "saturated",
        peak=100.0 * (real.peak_head_acceleration / linear.metrics.peak_head_acceleration - 1.0),
        deeper=100.0 * (real.max_compression / linear.metrics.max_compression - 1.0),
        real=KILO * real.impact_duration,
        linear=KILO * linear.metrics.impact_duration,
    )
