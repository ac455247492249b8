"""Peer of the batch path: peaks of an impact from roots and residues, compiled by numba.

One impact after the other on one core: roots of the quartic by Aberth's simultaneous iteration,
residues, a scan of the time axis with an eighth of the fastest half period, bisection and Newton
in the brackets. It knows neither repeated roots nor valleys shorter than a step of the scan.
"""

from __future__ import annotations

import cmath
import math

import numba
import numpy as np

Array = np.ndarray
PEAKS = ("peak_head_acceleration", "peak_contact_force", "max_compression", "impact_duration")
ITERATIONS = 60


@numba.njit(error_model="numpy")
def roots_of_quartic(q1, q2, q3, q4, p):
    """Fill ``p`` with the four roots."""
    radius = max(abs(q1), math.sqrt(abs(q2)), abs(q3) ** (1.0 / 3.0), abs(q4) ** 0.25)
    for k in range(4):
        p[k] = 0.7 * radius * cmath.exp(1j * (2.0 * math.pi * k / 4.0 + 0.4))
    for _ in range(ITERATIONS):
        moved = 0.0
        for k in range(4):
            z = p[k]
            value = (((z + q1) * z + q2) * z + q3) * z + q4
            slope = ((4.0 * z + 3.0 * q1) * z + 2.0 * q2) * z + q3
            repelled = 0j
            for j in range(4):
                if j != k:
                    repelled += 1.0 / (z - p[j])
            newton = value / slope
            step = newton / (1.0 - newton * repelled)
            p[k] = z - step
            moved = max(moved, abs(step.real) + abs(step.imag))
        if moved < 1e-7 * radius:  # convergence is cubic
            break


@numba.njit(inline="always", error_model="numpy")
def value(p, r, order, t, constant, slope):
    """Return a derivative of ``constant + slope t + sum r exp(p t)``."""
    total = 0.0
    for k in range(4):
        factor = r[k] * cmath.exp(p[k] * t)
        for _ in range(order):
            factor *= p[k]
        total += factor.real
    if order == 0:
        return total + constant + slope * t
    return total + slope if order == 1 else total


@numba.njit(error_model="numpy")
def zero(p, r, order, low, high, constant, slope):
    """Return the zero of a derivative in a bracket by safeguarded Newton."""
    falling = value(p, r, order, low, constant, slope) > 0.0
    t = 0.5 * (low + high)
    for _ in range(60):
        f = value(p, r, order, t, constant, slope)
        if (f > 0.0) == falling:
            low = t
        else:
            high = t
        g = value(p, r, order + 1, t, constant, slope)
        after = t - f / g if g != 0.0 else low
        if not low < after < high:
            after = 0.5 * (low + high)
        if abs(after - t) <= 1e-9 * t:  # convergence is quadratic
            return after
        t = after
    return t


@numba.njit(error_model="numpy")
def scan(p, r, order, turn, state, constant, slope, step, end, first_fall):
    """Return the first falling zero of a derivative, or the maximum of the quantity on [0, end]."""
    for k in range(4):
        state[k] = r[k] * p[k] if order == 1 else r[k]
    best = 0.0
    if not first_fall:
        best = max(value(p, r, 0, 0.0, constant, slope), value(p, r, 0, end, constant, slope))
    low, before = 0.0, 1.0
    while low < end:
        high, after = low + step, slope if order == 1 else constant
        for k in range(4):
            state[k] *= turn[k]
            after += state[k].real
        if before > 0.0 and after <= 0.0:
            t = zero(p, r, order, low, high, constant, slope)
            if first_fall:
                return t if t < end else math.inf
            if t < end:
                best = max(best, value(p, r, 0, t, constant, slope))
        low, before = high, after
    return math.inf if first_fall else best


@numba.njit(error_model="numpy")
def impact(row, horizon, p, a, e, f, turn, state, out):
    """Fill ``out`` with the peaks of one impact."""
    m_r, c_r, k_r, m_h, c_h, k_h, k_c, c_c, v = row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7], row[8]
    both = m_r * m_h
    q1 = (c_r + c_c) / m_r + (c_c + c_h) / m_h
    q2 = (k_r + k_c) / m_r + (k_h + k_c) / m_h + (c_r * c_h + c_c * (c_r + c_h)) / both
    q3 = (k_r * (c_c + c_h) + k_c * (c_r + c_h) + k_h * (c_c + c_r)) / both
    q4 = (k_r * k_h + k_c * k_h + k_r * k_c) / both
    roots_of_quartic(q1, q2, q3, q4, p)
    b1r, b2r, b1h, b2h = c_r / m_r, k_r / m_r, c_h / m_h, k_h / m_h
    fastest = 0.0
    for k in range(4):
        s = p[k]
        fastest = max(fastest, abs(s))
        slope = ((4.0 * s + 3.0 * q1) * s + 2.0 * q2) * s + q3
        manipulator, head = (s + b1r) * s + b2r, (s + b1h) * s + b2h
        a[k] = (k_c + c_c * s) * v * manipulator / (m_h * slope)
        e[k] = v * manipulator * head / (s * s * slope)
        f[k] = (k_c + c_c * s) * e[k]
    e1 = v * b2r * b2h / q4
    e0 = v * ((b1r * b2h + b2r * b1h) * q4 - b2r * b2h * q3) / (q4 * q4)
    step = math.pi / (8.0 * fastest)
    for k in range(4):
        turn[k] = cmath.exp(p[k] * step)
    out[3] = scan(p, a, 0, turn, state, 0.0, 0.0, step, horizon, True)
    end = min(out[3], horizon)
    out[0] = scan(p, a, 1, turn, state, 0.0, 0.0, step, end, False)
    out[1] = scan(p, f, 1, turn, state, k_c * e0 + c_c * e1, k_c * e1, step, end, False)
    out[2] = scan(p, e, 1, turn, state, e0, e1, step, end, False)


@numba.njit(error_model="numpy")
def impacts(rows, horizon, out):
    """Fill ``out`` row by row."""
    p, a = np.empty(4, np.complex128), np.empty(4, np.complex128)
    e, f = np.empty(4, np.complex128), np.empty(4, np.complex128)
    turn, state = np.empty(4, np.complex128), np.empty(4, np.complex128)
    for i in range(len(rows)):
        impact(rows[i], horizon, p, a, e, f, turn, state, out[i])


def peaks(rows: Array, horizon: float = 0.2) -> Array:
    """Return the columns `PEAKS` for rows of parameters in the order of the package."""
    out = np.empty((len(rows), len(PEAKS)))
    impacts(rows, horizon, out)
    return out
