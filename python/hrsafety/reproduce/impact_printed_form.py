"""Impact responses with the printed coefficient of (3.5.14), only to explain printed percentages.

The printed q2 lacks the product C_r C_h / (M_r M_h). Nothing else in the package uses it: the
responses of `hrsafety.impact` have the right one.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

if TYPE_CHECKING:
    import numpy.typing as npt

    from hrsafety import impact

    Array = npt.NDArray[np.float64]

__all__ = ["PrintedPeaks", "printed_peaks"]

SAMPLES_PER_SECOND = 400_000  # the peaks of the parabola-like tops are then good to 1e-6
HORIZON = 0.06  # s; every first zero of the acceleration lies before


class PrintedPeaks(NamedTuple):
    """Largest values within the impact period.

    Attributes
    ----------
    head_acceleration : float
        In m/s^2.
    contact_force : float
        In N.
    """

    head_acceleration: float
    contact_force: float


def printed_peaks(
    manipulator: impact.Manipulator,
    foam: impact.Foam,
    head: impact.Head,
    *,
    closing_speed: float,
    printed_coefficient: bool = True,
) -> PrintedPeaks:
    """Return the peaks by partial fractions of (3.5.14) and (3.9.2) with the printed or right q2.

    Parameters
    ----------
    manipulator, foam, head : Manipulator, Foam, Head
        What meets; the roots must be distinct.
    closing_speed : float
        In m/s.
    printed_coefficient : bool
        Whether q2 is the printed one, without C_r C_h.

    Returns
    -------
    PrintedPeaks
        Found on samples.
    """
    polynomial = _denominator(manipulator, foam, head, printed_coefficient=printed_coefficient)
    roots = np.roots(polynomial)
    slope = np.polyval(np.polyder(polynomial), roots)
    time = np.arange(int(HORIZON * SAMPLES_PER_SECOND)) / SAMPLES_PER_SECOND
    modes = np.exp(np.outer(roots, time))
    covering = np.array([foam.damping, foam.stiffness])
    arm = np.array([1.0, manipulator.damping / manipulator.mass, manipulator.stiffness / manipulator.mass])
    neck = np.array([1.0, head.damping / head.mass, head.stiffness / head.mass])
    pushed = closing_speed * np.polymul(covering, arm) / head.mass
    acceleration: Array = ((np.polyval(pushed, roots) / slope) @ modes).real
    numerator = closing_speed * np.polymul(np.polymul(covering, arm), neck)
    # The double pole at zero is a ramp: numerator / polynomial to first order in s.
    ramp = numerator[-1] / polynomial[-1]
    start = (numerator[-2] - ramp * polynomial[-2]) / polynomial[-1]
    force: Array = ((np.polyval(numerator, roots) / (roots**2 * slope)) @ modes).real + ramp * time + start
    inside = slice(0, int(np.argmax(acceleration < 0.0)) or None)
    return PrintedPeaks(float(acceleration[inside].max()), float(force[inside].max()))


def _denominator(
    manipulator: impact.Manipulator, foam: impact.Foam, head: impact.Head, *, printed_coefficient: bool
) -> Array:
    """Return the coefficients of (3.5.14), highest power first."""
    M_r, C_r, K_r = manipulator.mass, manipulator.damping, manipulator.stiffness  # noqa: N806
    M_h, C_h, K_h = head.mass, head.damping, head.stiffness  # noqa: N806
    K_c, C_c = foam.stiffness, foam.damping  # noqa: N806
    product = 0.0 if printed_coefficient else C_r * C_h
    q1 = (C_r + C_c) / M_r + (C_c + C_h) / M_h
    q2 = (K_r + K_c) / M_r + (K_h + K_c) / M_h + (product + C_c * C_r + C_c * C_h) / (M_r * M_h)
    q3 = (K_r * (C_c + C_h) + K_c * (C_r + C_h) + K_h * (C_c + C_r)) / (M_r * M_h)
    q4 = (K_r * K_h + K_c * K_h + K_r * K_c) / (M_r * M_h)
    return np.array([1.0, q1, q2, q3, q4])
