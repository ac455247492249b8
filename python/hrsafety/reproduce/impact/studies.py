"""Peak head acceleration over one parameter, as in Figs. 3.13 to 3.16."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hrsafety import impact
from hrsafety.reproduce.impact.cases import (
    CLOSING_SPEED,
    FOAM_OF_FIGURES,
    HEAD_SPEED,
    LEVER_ARM,
    MANIPULATOR_SPEED,
    manipulator,
    published_lever_arm,
)

Array = npt.NDArray[np.float64]

__all__ = ["along_arm", "over_foam", "over_mass", "over_stiffness"]


def over_mass(foam: impact.Foam, mass: Array, *, damping: float = 250.0) -> Array:
    """Return the peak head acceleration in g over the effective mass in kg (Fig. 3.13)."""
    return impact.metrics_batch(
        manipulator=manipulator(1, damping=damping),
        manipulator_mass=mass,
        foam=foam,
        head=impact.Head.minimum(),
        closing_speed=CLOSING_SPEED,
    ).peak_head_acceleration_g


def over_stiffness(foam: impact.Foam, stiffness: Array, *, damping: float = 250.0) -> Array:
    """Return the peak head acceleration in g over the effective stiffness in N/m (Fig. 3.14)."""
    return impact.metrics_batch(
        manipulator=manipulator(1, damping=damping),
        manipulator_stiffness=stiffness,
        foam=foam,
        head=impact.Head.minimum(),
        closing_speed=CLOSING_SPEED,
    ).peak_head_acceleration_g


def over_foam(arm: impact.Manipulator, stiffness: Array, damping_ratio: float) -> Array:
    """Return the peak head acceleration in g over the foam stiffness in N/m (Fig. 3.15)."""
    head = impact.Head.minimum()
    return impact.metrics_batch(
        manipulator=arm,
        foam_stiffness=stiffness,
        foam_damping=2.0 * damping_ratio * np.sqrt(head.mass * stiffness),
        foam=FOAM_OF_FIGURES,
        head=head,
        closing_speed=CLOSING_SPEED,
    ).peak_head_acceleration_g


def along_arm(number: int, lever_arm: Array) -> Array:
    """Return the peak head acceleration in g over the lever arm in m (Fig. 3.16); its far end moves at 0.25 m/s."""
    arm = manipulator(number)
    ratio = (published_lever_arm(number) / lever_arm) ** 2
    return impact.metrics_batch(
        manipulator_mass=arm.mass * ratio,
        manipulator_damping=arm.damping * ratio,
        manipulator_stiffness=arm.stiffness * ratio,
        foam=FOAM_OF_FIGURES,
        head=impact.Head.minimum(),
        closing_speed=MANIPULATOR_SPEED * lever_arm / LEVER_ARM[number] - HEAD_SPEED,
    ).peak_head_acceleration_g
