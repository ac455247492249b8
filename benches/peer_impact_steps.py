"""Peers that step through time: python-control and SciPy, with what a user would write for one impact."""

from __future__ import annotations

import math

import numpy as np
from scipy.integrate import solve_ivp

Array = np.ndarray
SPAN = 0.1  # s: every impact of the bench has ended by then
SAMPLES = 501


def state_matrix(row: Array) -> Array:
    """Return the matrix of (u, u', w, w', v_c t, v_c): both bodies from their uniform motion, and its ramp."""
    m_r, c_r, k_r, m_h, c_h, k_h, k_c, c_c, _ = row
    force = np.array([k_c, c_c, -k_c, -c_c, k_c, c_c])
    matrix = np.zeros((6, 6))
    matrix[0, 1] = matrix[2, 3] = matrix[4, 5] = 1.0
    matrix[1], matrix[3] = -force / m_r, force / m_h
    matrix[1, :2] -= np.array([k_r, c_r]) / m_r
    matrix[3, 2:4] -= np.array([k_h, c_h]) / m_h
    return matrix


def outputs(row: Array, states: Array) -> tuple[Array, Array, Array]:
    """Return head acceleration, force and compression, of states with time along axis 1."""
    k_c, c_c, v = row[6], row[7], row[8]
    compression = states[0] - states[2] + states[4]
    force = k_c * compression + c_c * (states[1] - states[3] + v)
    return state_matrix(row)[3] @ states, force, compression


def peaks_of_samples(row: Array, time: Array, states: Array) -> Array:
    """Return peaks over the samples before the head acceleration falls below zero; the end interpolated."""
    a, f, e = outputs(row, states)
    below = np.nonzero(a[1:] < 0.0)[0]
    if not len(below):
        return np.array([a.max(), f.max(), e.max(), math.inf])
    i = below[0]
    end = time[i] + (time[i + 1] - time[i]) * a[i] / (a[i] - a[i + 1])
    last = np.interp(end, time, f), np.interp(end, time, e)
    return np.array([a[: i + 1].max(), max(f[: i + 1].max(), last[0]), max(e[: i + 1].max(), last[1]), end])


def with_control(rows: Array) -> Array:
    """Simulate each impact with ``control.forced_response`` on a fixed grid."""
    import control

    time, found = np.linspace(0.0, SPAN, SAMPLES), []
    for row in rows:
        system = control.ss(state_matrix(row), np.zeros((6, 1)), np.eye(6), np.zeros((6, 1)))
        start = [0.0, 0.0, 0.0, 0.0, 0.0, row[8]]
        response = control.forced_response(system, time, np.zeros_like(time), start)
        found.append(peaks_of_samples(row, time, response.states))
    return np.array(found)


def with_solve_ivp(rows: Array) -> Array:
    """Simulate each impact with ``scipy.integrate.solve_ivp`` (LSODA), the usual tight tolerances."""
    time, found = np.linspace(0.0, SPAN, SAMPLES), []
    for row in rows:
        matrix, start = state_matrix(row), [0.0, 0.0, 0.0, 0.0, 0.0, row[8]]

        def rates(_: float, state: Array, matrix: Array = matrix) -> Array:
            return matrix @ state

        run = solve_ivp(rates, (0.0, SPAN), start, method="LSODA", rtol=1e-8, atol=1e-12, t_eval=time)
        found.append(peaks_of_samples(row, time, run.y))
    return np.array(found)
