"""Peaks of an impact by partial fractions of (3.5.14) and (3.9.2), with the printed or the right q2.

Nothing of the package is used: roots of the quartic by NumPy, residues, samples.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import impact

SAMPLES_PER_SECOND = 400_000  # the peaks of the parabola-like tops are then good to 1e-6
HORIZON = 0.06  # s; every first zero of the acceleration lies before


class ModalPeaks(NamedTuple):
    """Largest values within the impact period, in m/s^2 and N."""

    head_acceleration: float
    contact_force: float


def modal_peaks(
    manipulator: impact.Manipulator, foam: impact.Foam, head: impact.Head, *, closing_speed: float, printed: bool
) -> ModalPeaks:
    """Return the peaks; the roots must be distinct."""
    polynomial = _denominator(manipulator, foam, head, printed=printed)
    roots = np.roots(polynomial)
    slope = np.polyval(np.polyder(polynomial), roots)
    time = np.arange(int(HORIZON * SAMPLES_PER_SECOND)) / SAMPLES_PER_SECOND
    modes = np.exp(np.outer(roots, time))
    covering = np.array([foam.damping, foam.stiffness])
    arm = np.array([1.0, manipulator.damping / manipulator.mass, manipulator.stiffness / manipulator.mass])
    neck = np.array([1.0, head.damping / head.mass, head.stiffness / head.mass])
    pushed = closing_speed * np.polymul(covering, arm) / head.mass
    acceleration: npt.NDArray[np.float64] = ((np.polyval(pushed, roots) / slope) @ modes).real
    numerator = closing_speed * np.polymul(np.polymul(covering, arm), neck)
    # The double pole at zero is a ramp: numerator / polynomial to first order in s.
    ramp = numerator[-1] / polynomial[-1]
    start = (numerator[-2] - ramp * polynomial[-2]) / polynomial[-1]
    force: npt.NDArray[np.float64] = (
        ((np.polyval(numerator, roots) / (roots**2 * slope)) @ modes).real + ramp * time + start
    )
    inside = slice(0, int(np.argmax(acceleration < 0.0)) or None)
    return ModalPeaks(float(acceleration[inside].max()), float(force[inside].max()))


def _denominator(
    manipulator: impact.Manipulator, foam: impact.Foam, head: impact.Head, *, printed: bool
) -> npt.NDArray[np.float64]:
    """Return the coefficients of (3.5.14), highest power first."""
    m_r, c_r, k_r = manipulator.mass, manipulator.damping, manipulator.stiffness
    m_h, c_h, k_h = head.mass, head.damping, head.stiffness
    k_c, c_c = foam.stiffness, foam.damping
    product = 0.0 if printed else c_r * c_h
    q1 = (c_r + c_c) / m_r + (c_c + c_h) / m_h
    q2 = (k_r + k_c) / m_r + (k_h + k_c) / m_h + (product + c_c * c_r + c_c * c_h) / (m_r * m_h)
    q3 = (k_r * (c_c + c_h) + k_c * (c_r + c_h) + k_h * (c_c + c_r)) / (m_r * m_h)
    q4 = (k_r * k_h + k_c * k_h + k_r * k_c) / (m_r * m_h)
    return np.array([1.0, q1, q2, q3, q4])
