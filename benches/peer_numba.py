"""Peer of the batch path: configuration 4 compiled by numba, one scalar run after the other.

The same law, side rules, scheme and outputs as `peer_numpy`; obstacles that are out of reach are
skipped before any angle is computed. No fast-math, so the results stay comparable.
"""

from __future__ import annotations

import math

import numba
import numpy as np

import peer_numpy as same
from peer_numpy import Array, Runs

MASS, MAX_SPEED, MAX_ACCELERATION = same.MASS, same.MAX_SPEED, same.MAX_ACCELERATION
STEP, STEPS_PER_PERIOD, TIME_LIMIT, TOLERANCE = same.STEP, same.STEPS_PER_PERIOD, same.TIME_LIMIT, same.TOLERANCE
STEPS = round(TIME_LIMIT / STEP)
(START_X, START_Y), (GOAL_X, GOAL_Y) = same.START, same.GOAL
(HUMAN_X, HUMAN_Y), HUMAN_SPEED, HUMAN_STOP_TIME = same.HUMAN_START, same.HUMAN_SPEED, same.HUMAN_STOP_TIME
(BOX_X, BOX_Y), HALF_LENGTH, HALF_WIDTH = same.BOX_CENTER, same.BOX_HALF_LENGTH, same.BOX_HALF_WIDTH
DISC_X, DISC_Y = same.DISC_CENTER
AHEAD_X, AHEAD_Y = 2.45, 0.595  # the disc of configuration 1
R3, R2 = (np.array(column) for column in zip(*same.RADII, same.RADII[2], strict=True))
WHEELS, INERTIA, VISCOUS, STATIC = same.WHEELS, same.INERTIA, same.VISCOUS, same.STATIC
RESISTANCE, ALIGNED = same.RESISTANCE, same.ALIGNED
HUMAN, BOX, DISC, DISC_AHEAD = 0, 1, 2, 3
CONFIGURATION_4 = (HUMAN, BOX, DISC)


@numba.njit(inline="always")
def nearest(which, x, y, time):
    """Return the point of the obstacle that distances are measured from."""
    if which == HUMAN:
        return HUMAN_X + HUMAN_SPEED * min(time, HUMAN_STOP_TIME), HUMAN_Y
    if which == BOX:
        near_x = BOX_X + min(max(x - BOX_X, -HALF_LENGTH), HALF_LENGTH)
        near_y = BOX_Y + min(max(y - BOX_Y, -HALF_WIDTH), HALF_WIDTH)
        return near_x, near_y
    if which == DISC_AHEAD:
        return AHEAD_X, AHEAD_Y
    return DISC_X, DISC_Y


@numba.njit(inline="always")
def wrap(angle):
    if angle > math.pi:
        return angle - 2.0 * math.pi
    if angle <= -math.pi:
        return angle + 2.0 * math.pi
    return angle


@numba.njit
def box_separates(x, y):
    first, last = 0.0, 1.0
    for start, along, half in ((x - BOX_X, GOAL_X - x, HALF_LENGTH), (y - BOX_Y, GOAL_Y - y, HALF_WIDTH)):
        if along == 0.0:
            if abs(start) > half:
                return False
            continue
        one, other = (-half - start) / along, (half - start) / along
        first, last = max(first, min(one, other)), min(last, max(one, other))
    return first <= last and first < 1.0 and last > 0.0


@numba.njit
def side_of(which, x, y, point_y, moving, phi):
    """Return the side of the detour, 0 where the other obstacles decide it."""
    if which == BOX and box_separates(x, y):
        around = wrap(math.atan2(GOAL_Y - BOX_Y, GOAL_X - BOX_X) - math.atan2(y - BOX_Y, x - BOX_X))
        if math.pi - abs(around) < ALIGNED:
            return 0.0
        return 1.0 if around >= 0.0 else -1.0
    if which == HUMAN and moving > 0.0:
        robot_off, goal_off = y - point_y, GOAL_Y - point_y
        if robot_off * goal_off < 0.0 and min(abs(robot_off), abs(goal_off)) > ALIGNED:
            return 1.0 if robot_off > 0.0 else -1.0
    if math.pi - abs(phi) < ALIGNED:
        return 0.0
    return 1.0 if phi >= 0.0 else -1.0


@numba.njit
def force(k1, k3, k5, b, x, y, vx, vy, time, rest, present):
    """Return the commanded force; ``rest`` is scratch space for undecided detours."""
    fx, fy = k1 * (GOAL_X - x - b * vx), k1 * (GOAL_Y - y - b * vy)
    push_x, push_y, size, undecided = 0.0, 0.0, 0.0, 0
    for which in present:
        point_x, point_y = nearest(which, x, y, time)
        dx, dy = x - point_x, y - point_y
        d2 = dx * dx + dy * dy
        if d2 >= R2[which] * R2[which]:
            continue
        d = math.sqrt(d2)
        if d <= R3[which]:
            speed = math.hypot(vx, vy)
            if speed == 0.0:
                return 0.0, 0.0
            brake = -MASS * min(MAX_ACCELERATION, speed / (STEP * STEPS_PER_PERIOD)) / speed
            return brake * vx, brake * vy
        ux, uy = dx / d, dy / d
        moving = HUMAN_SPEED if which == HUMAN and time < HUMAN_STOP_TIME else 0.0
        slide_x, slide_y, turns = moving, 0.0, 1.0
        if which == BOX:
            slide_x = 0.0 if abs(x - BOX_X) > HALF_LENGTH else vx
            slide_y = 0.0 if abs(y - BOX_Y) > HALF_WIDTH else vy
            turns = 1.0 if abs(x - BOX_X) > HALF_LENGTH and abs(y - BOX_Y) > HALF_WIDTH else 0.0
        d_dot = ux * (vx - moving) + uy * vy
        beta_dot = turns * (-uy * (vx - moving) + ux * vy) / d
        wx, wy = GOAL_X - point_x, GOAL_Y - point_y
        w2 = wx * wx + wy * wy
        phi, alpha_dot = 0.0, 0.0
        if w2 > 0.0:
            phi = math.atan2(ux * wy - uy * wx, ux * wx + uy * wy)
            alpha_dot = (wy * slide_x - wx * slide_y) / w2
        a, c = R2[which] - d, d - R3[which]
        repulsion = k3 * a * a * (1.0 - b * d_dot / c) / c
        fx += repulsion * ux
        fy += repulsion * uy
        weight, damping = k5 * a * a, b * (alpha_dot - beta_dot)
        side = side_of(which, x, y, point_y, moving, phi)
        if side == 0.0:
            rest[undecided, 0], rest[undecided, 1], rest[undecided, 2] = ux, uy, weight
            rest[undecided, 3], rest[undecided, 4] = abs(phi), damping
            undecided += 1
            continue
        detour = weight * (side * abs(phi) + damping)
        push_x -= detour * uy
        push_y += detour * ux
        size += abs(detour)
    for i in range(undecided):
        ux, uy, weight, turn, damping = rest[i, 0], rest[i, 1], rest[i, 2], rest[i, 3], rest[i, 4]
        side = -1.0 if -uy * push_x + ux * push_y < -ALIGNED * size else 1.0
        detour = weight * (side * turn + damping)
        push_x -= detour * uy
        push_y += detour * ux
        size += abs(detour)
    return fx + push_x, fy + push_y


@numba.njit
def run(k1, k3, k5, b, least, rest):
    """Return arrival time, energy and force evaluations of one run; fill ``least``."""
    x, y, vx, vy, fx, fy = START_X, START_Y, 0.0, 0.0, 0.0, 0.0
    energy, evaluations = 0.0, 0
    before = math.hypot(GOAL_X - x, GOAL_Y - y)
    for which in range(3):
        point_x, point_y = nearest(which, x, y, 0.0)
        least[which] = math.hypot(x - point_x, y - point_y)
    for step in range(STEPS):
        if step % STEPS_PER_PERIOD == 0:
            fx, fy = force(k1, k3, k5, b, x, y, vx, vy, step * STEP, rest, CONFIGURATION_4)
            evaluations += 1
        ax, ay = fx / MASS, fy / MASS
        acceleration = math.sqrt(ax * ax + ay * ay)
        if acceleration > MAX_ACCELERATION:
            ax, ay = ax * MAX_ACCELERATION / acceleration, ay * MAX_ACCELERATION / acceleration
        old_x, old_y = vx, vy
        vx, vy = vx + STEP * ax, vy + STEP * ay
        speed = math.sqrt(vx * vx + vy * vy)
        if speed > MAX_SPEED:
            vx, vy = vx * MAX_SPEED / speed, vy * MAX_SPEED / speed
        x, y = x + STEP * vx, y + STEP * vy
        for which in range(3):
            point_x, point_y = nearest(which, x, y, (step + 1) * STEP)
            least[which] = min(least[which], math.sqrt((x - point_x) ** 2 + (y - point_y) ** 2))
        after = math.sqrt((GOAL_X - x) ** 2 + (GOAL_Y - y) ** 2)
        share = (before - TOLERANCE) / (before - after) if after <= TOLERANCE else 1.0
        for wheel in range(3):
            rate = WHEELS[wheel, 0] * vx + WHEELS[wheel, 1] * vy
            rate_before = WHEELS[wheel, 0] * old_x + WHEELS[wheel, 1] * old_y
            direction = 0.0 if abs(rate) < ALIGNED else math.copysign(1.0, rate)
            current = INERTIA[wheel] * (rate - rate_before) / STEP + VISCOUS[wheel] * rate + STATIC[wheel] * direction
            energy += RESISTANCE * current * current * STEP * share
        if after <= TOLERANCE:
            return (step + share) * STEP, energy, evaluations
        before = after
    return math.nan, energy, evaluations


@numba.njit
def run_all(gains, arrival, energy, least):
    """Run every gain set; return the number of force evaluations."""
    evaluations = 0
    rest = np.empty((3, 5))
    for i in range(len(gains)):
        arrival[i], energy[i], n = run(gains[i, 0], gains[i, 1], gains[i, 2], gains[i, 3], least[i], rest)
        evaluations += n
    return evaluations


def simulate(gains: Array) -> Runs:
    """Run configuration 4 with every gain set, ``gains`` of shape (n, 4)."""
    count = len(gains)
    arrival, energy, least = np.empty(count), np.empty(count), np.empty((count, 3))
    return Runs(arrival, energy, least, run_all(gains, arrival, energy, least))
