"""Peer of the search for gains: the grids of appendix C.2 compiled by numba, one thread.

The law of `peer_numba` in configurations 1 to 3 with coarse motion: one step of semi-implicit
Euler for each control period of 0.06 s, as in quick sketches of such a search. A contact, five
seconds at rest or the time limit end a run with H = 0; the runs without obstacles are made once
for each (K_1, b).
"""

from __future__ import annotations

import math

import numba
import numpy as np

import peer_numba as law
from peer_numba import Array

PERIOD = 0.06
TIME_LIMIT, REST_TIME, AT_REST = 60.0, 5.0, 1e-3
STEPS = round(TIME_LIMIT / PERIOD)
CONTACT = np.array([0.6, 0.2, 0.3, 0.3])  # human, box, disc, disc ahead
MASS, MAX_SPEED, MAX_ACCELERATION, TOLERANCE = law.MASS, law.MAX_SPEED, law.MAX_ACCELERATION, law.TOLERANCE
C1, C2, C3 = (law.DISC_AHEAD,), (law.HUMAN,), (law.BOX, law.DISC)
NOBODY = (-1,)


@numba.njit
def run(k1, k3, k5, b, present, least, rest):
    """Return arrival time and energy, NaN after a failure; fill ``least``."""
    x, y, vx, vy = law.START_X, law.START_Y, 0.0, 0.0
    energy, moved = 0.0, 0.0
    before = math.hypot(law.GOAL_X - x, law.GOAL_Y - y)
    least[:] = math.inf
    for step in range(STEPS):
        if present[0] < 0:
            fx, fy = k1 * (law.GOAL_X - x - b * vx), k1 * (law.GOAL_Y - y - b * vy)
        else:
            fx, fy = law.force(k1, k3, k5, b, x, y, vx, vy, step * PERIOD, rest, present)
        ax, ay = fx / MASS, fy / MASS
        acceleration = math.sqrt(ax * ax + ay * ay)
        if acceleration > MAX_ACCELERATION:
            ax, ay = ax * MAX_ACCELERATION / acceleration, ay * MAX_ACCELERATION / acceleration
        old_x, old_y = vx, vy
        vx, vy = vx + PERIOD * ax, vy + PERIOD * ay
        speed = math.sqrt(vx * vx + vy * vy)
        if speed > MAX_SPEED:
            vx, vy = vx * MAX_SPEED / speed, vy * MAX_SPEED / speed
        x, y = x + PERIOD * vx, y + PERIOD * vy
        time = (step + 1) * PERIOD
        if present[0] >= 0:
            for index, which in enumerate(present):
                point_x, point_y = law.nearest(which, x, y, time)
                distance = math.sqrt((x - point_x) ** 2 + (y - point_y) ** 2)
                least[index] = min(least[index], distance)
                if distance <= CONTACT[which]:
                    return math.nan, math.nan
        if speed >= AT_REST:
            moved = time
        elif time - moved >= REST_TIME:
            return math.nan, math.nan
        after = math.sqrt((law.GOAL_X - x) ** 2 + (law.GOAL_Y - y) ** 2)
        share = (before - TOLERANCE) / (before - after) if after <= TOLERANCE else 1.0
        for wheel in range(3):
            rate = law.WHEELS[wheel, 0] * vx + law.WHEELS[wheel, 1] * vy
            rate_before = law.WHEELS[wheel, 0] * old_x + law.WHEELS[wheel, 1] * old_y
            direction = 0.0 if abs(rate) < law.ALIGNED else math.copysign(1.0, rate)
            current = (
                law.INERTIA[wheel] * (rate - rate_before) / PERIOD
                + law.VISCOUS[wheel] * rate
                + law.STATIC[wheel] * direction
            )
            energy += law.RESISTANCE * current * current * PERIOD * share
        if after <= TOLERANCE:
            return (step + share) * PERIOD, energy
        before = after
    return math.nan, math.nan


@numba.njit
def score(k1, k3, k5, b, present, free_time, free_energy, least, rest):
    """Return H of one configuration."""
    time, energy = run(k1, k3, k5, b, present, least, rest)
    if math.isnan(time) or math.isnan(free_time):
        return 0.0
    avoidance = 0.0
    for index, which in enumerate(present):
        room = law.R2[which] - CONTACT[which]
        avoidance += min((least[index] - CONTACT[which]) / room, 1.0) / len(present)
    return (free_time / time + avoidance + free_energy / energy) / 3.0


@numba.njit
def grid_scores(first, second, third, fourth):
    """Return the mean H over configurations 1 to 3 of every combination of four axes."""
    found = np.empty((len(first), len(second), len(third), len(fourth)))
    least, rest = np.empty(2), np.empty((3, 5))
    for i, k1 in enumerate(first):
        for m, b in enumerate(fourth):
            time, energy = run(k1, 0.0, 0.0, b, NOBODY, least, rest)
            for j, k3 in enumerate(second):
                for n, k5 in enumerate(third):
                    total = score(k1, k3, k5, b, C1, time, energy, least, rest)
                    total += score(k1, k3, k5, b, C2, time, energy, least, rest)
                    total += score(k1, k3, k5, b, C3, time, energy, least, rest)
                    found[i, j, n, m] = total / 3.0
    return found


def scores(axes: tuple[Array, ...]) -> Array:
    """Return the mean H of every point of a grid, the last axis fastest."""
    values: Array = grid_scores(*axes).ravel()
    return values
