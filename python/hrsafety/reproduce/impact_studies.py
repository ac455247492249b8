"""Peak head acceleration over one parameter, as in Figs. 3.13 to 3.16."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hrsafety import impact
from hrsafety.reproduce.impact_cases import (
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
    """Return the peak head acceleration in g over the effective mass (Fig. 3.13).

    Parameters
    ----------
    foam : Foam
        Covering.
    mass : ndarray, shape (n,)
        M_r in kg.
    damping : float
        C_r in N s/m.

    Returns
    -------
    ndarray, shape (n,)
        With K_r of Manipulator 1 and the minimum head.
    """
    return impact.metrics_batch(
        manipulator=manipulator(1, damping=damping),
        manipulator_mass=mass,
        foam=foam,
        head=impact.Head.minimum(),
        closing_speed=CLOSING_SPEED,
    ).peak_head_acceleration_g


def over_stiffness(foam: impact.Foam, stiffness: Array, *, damping: float = 250.0) -> Array:
    """Return the peak head acceleration in g over the effective stiffness (Fig. 3.14).

    Parameters
    ----------
    foam : Foam
        Covering.
    stiffness : ndarray, shape (n,)
        K_r in N/m.
    damping : float
        C_r in N s/m.

    Returns
    -------
    ndarray, shape (n,)
        With M_r of Manipulator 1 and the minimum head.
    """
    return impact.metrics_batch(
        manipulator=manipulator(1, damping=damping),
        manipulator_stiffness=stiffness,
        foam=foam,
        head=impact.Head.minimum(),
        closing_speed=CLOSING_SPEED,
    ).peak_head_acceleration_g


def over_foam(arm: impact.Manipulator, stiffness: Array, damping_ratio: float) -> Array:
    """Return the peak head acceleration in g over the foam stiffness (Fig. 3.15).

    Parameters
    ----------
    arm : Manipulator
        What carries the foam.
    stiffness : ndarray, shape (n,)
        K_c in N/m.
    damping_ratio : float
        xi_c, with C_c = 2 xi_c sqrt(M_h K_c).

    Returns
    -------
    ndarray, shape (n,)
        With the minimum head.
    """
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
    """Return the peak head acceleration in g over the impact point (Fig. 3.16).

    Parameters
    ----------
    number : int
        Manipulator of Table 3.1.
    lever_arm : ndarray, shape (n,)
        l_1 in m, positive.

    Returns
    -------
    ndarray, shape (n,)
        The arm turns so that its far end moves at 0.25 m/s; the head comes at 1.0 m/s.
    """
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
