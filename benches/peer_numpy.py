"""Peer of the batch path: configuration 4 in NumPy, vectorised over the gain sets.

The same law, side rules, scheme and outputs as `hrsafety.navigation.simulate_batch` with the
stabilizing force off: force every 0.06 s and held, semi-implicit Euler with 0.01 s, arrival at
0.12 m, distances and energy at every step. Runs that have arrived are dropped from the arrays.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

Array = npt.NDArray[np.float64]

MASS, MAX_SPEED, MAX_ACCELERATION = 4.4, 0.7, 10.0
STEP, STEPS_PER_PERIOD, TIME_LIMIT, TOLERANCE = 0.01, 6, 60.0, 0.12
START, GOAL = (3.9, 0.6), (0.0, 0.6)
HUMAN_START, HUMAN_SPEED, HUMAN_STOP_TIME = (0.6, 0.6), 1.0, 3.4
BOX_CENTER, BOX_HALF_LENGTH, BOX_HALF_WIDTH = (2.3, 0.0), 0.7, 0.3
DISC_CENTER = (2.45, 1.4)
RADII = ((0.8, 2.1), (0.4, 0.8), (0.4, 0.8))  # r3, r2 of human, box, disc
WHEELS = np.array([[-np.sqrt(3.0) / 2.0, -0.5], [np.sqrt(3.0) / 2.0, -0.5], [0.0, 1.0]]) / 0.10
INERTIA, VISCOUS, STATIC = np.array([[0.0073, 0.0074, 0.0065], [0.0019, 0.0020, 0.0024], [0.19, 0.22, 0.18]])
RESISTANCE = 4.86
ALIGNED = 1e-9


class Runs(NamedTuple):
    """One row for each gain set; times in s, energies in J, distances in m."""

    arrival_time: Array
    energy: Array
    min_distance: Array
    force_evaluations: int


class View(NamedTuple):
    """One obstacle as all runs see it; scalars of shape (n,), vectors of shape (2, n)."""

    d: Array
    u: Array
    d_dot: Array
    phi: Array
    phi_dot: Array
    side: Array
    active: npt.NDArray[np.bool_]


def wrap(angle: Array) -> Array:
    return np.pi - np.mod(np.pi - angle, 2.0 * np.pi)


def left(v: Array) -> Array:
    return np.stack([-v[1], v[0]])


def human_at(time: float) -> tuple[Array, Array]:
    walked = min(time, HUMAN_STOP_TIME)
    place = np.array([[HUMAN_START[0] + HUMAN_SPEED * walked], [HUMAN_START[1]]])
    return place, np.array([[HUMAN_SPEED if time < HUMAN_STOP_TIME else 0.0], [0.0]])


def contour_point(p: Array) -> tuple[Array, npt.NDArray[np.bool_], npt.NDArray[np.bool_]]:
    """Return the nearest point of the box and where the robot is beyond its sides."""
    local = p - np.array(BOX_CENTER)[:, None]
    half = np.array([[BOX_HALF_LENGTH], [BOX_HALF_WIDTH]])
    beyond = np.abs(local) > half
    return p - local + np.clip(local, -half, half), beyond[0], beyond[1]


def view(
    p: Array, v: Array, point: Array, point_velocity: Array, body_velocity: Array, turns: Array, r2: float
) -> View:
    """Return distance, angles and rates; ``turns`` is 0 where the direction of D is fixed."""
    away = p - point
    d = np.hypot(*away)
    u = away / d
    relative = v - body_velocity
    to_goal = np.array(GOAL)[:, None] - point
    w = np.hypot(*to_goal)
    safe = np.where(w > 0.0, w, 1.0)
    beta_dot = turns * (left(u) * relative).sum(axis=0) / d
    alpha_dot = -(left(to_goal / safe) * point_velocity).sum(axis=0) / safe
    phi = np.where(w > 0.0, wrap(np.arctan2(to_goal[1], to_goal[0]) - np.arctan2(u[1], u[0])), 0.0)
    side = np.where(phi >= 0.0, 1.0, -1.0)
    side[np.pi - np.abs(phi) < ALIGNED] = 0.0
    return View(d, u, (u * relative).sum(axis=0), phi, alpha_dot - beta_dot, side, d < r2)


def human_view(p: Array, v: Array, time: float) -> View:
    place, velocity = human_at(time)
    seen = view(p, v, place, velocity, velocity, np.ones(p.shape[1]), RADII[0][1])
    if velocity[0, 0] > 0.0:
        robot_off, goal_off = p[1] - place[1], GOAL[1] - place[1]
        opposite = (robot_off * goal_off < 0.0) & (np.minimum(np.abs(robot_off), np.abs(goal_off)) > ALIGNED)
        seen.side[opposite] = np.sign(robot_off)[opposite]
    return seen


def box_view(p: Array, v: Array) -> View:
    point, beyond_x, beyond_y = contour_point(p)
    sliding = np.stack([np.where(beyond_x, 0.0, v[0]), np.where(beyond_y, 0.0, v[1])])
    corner = (beyond_x & beyond_y).astype(float)
    seen = view(p, v, point, sliding, np.zeros((2, 1)), corner, RADII[1][1])
    start = p - np.array(BOX_CENTER)[:, None]
    along = np.array(GOAL)[:, None] - p
    half = np.array([[BOX_HALF_LENGTH], [BOX_HALF_WIDTH]])
    with np.errstate(divide="ignore", invalid="ignore"):
        ends = np.stack([(-half - start) / along, (half - start) / along])
    parallel = along == 0.0
    outside = parallel & (np.abs(start) > half)
    first = np.where(parallel, -np.inf, ends.min(axis=0)).max(axis=0)
    last = np.where(parallel, np.inf, ends.max(axis=0)).min(axis=0)
    meets = (np.maximum(first, 0.0) <= np.minimum(last, 1.0)) & (first < 1.0) & (last > 0.0) & ~outside.any(axis=0)
    to_goal = np.arctan2(GOAL[1] - BOX_CENTER[1], GOAL[0] - BOX_CENTER[0])
    around = wrap(to_goal - np.arctan2(start[1], start[0]))
    around_side = np.where(np.pi - np.abs(around) < ALIGNED, 0.0, np.where(around >= 0.0, 1.0, -1.0))
    seen.side[meets] = around_side[meets]
    return seen


def force(gains: Array, p: Array, v: Array, time: float) -> Array:
    """Return the commanded force, shape (2, n)."""
    k1, k3, k5, b = gains
    disc = np.array(DISC_CENTER)[:, None]
    still = np.zeros((2, 1))
    views = [human_view(p, v, time), box_view(p, v), view(p, v, disc, still, still, np.ones(p.shape[1]), RADII[2][1])]
    total = k1 * (np.array(GOAL)[:, None] - p - b * v)
    critical = np.zeros(p.shape[1], dtype=bool)
    detours = []
    for seen, (r3, r2) in zip(views, RADII, strict=True):
        critical |= seen.d <= r3
        a, c = r2 - seen.d, np.where(seen.d > r3, seen.d - r3, 1.0)
        total += np.where(seen.active, k3 * (a * a / c - b * seen.d_dot * a * a / (c * c)), 0.0) * seen.u
        detours.append(np.where(seen.active, a * a * k5, 0.0))
    push = np.zeros_like(p)
    size = np.zeros(p.shape[1])
    undecided = np.array([seen.active & (seen.side == 0.0) for seen in views])
    for chosen in (False, True):
        for seen, weight, open_ in zip(views, detours, undecided, strict=True):
            if chosen and not open_.any():
                continue
            t = left(seen.u)
            along = (t * push).sum(axis=0)
            side = seen.side if not chosen else np.where(along < -ALIGNED * size, -1.0, 1.0)
            part = np.where(open_ == chosen, weight * (side * np.abs(seen.phi) + b * seen.phi_dot), 0.0) * t
            push = push + part
            size = size + np.hypot(*part)
    speed = np.hypot(*v)
    braking = -MASS * np.minimum(MAX_ACCELERATION, speed / (STEP * STEPS_PER_PERIOD))
    brake = braking / np.where(speed > 0.0, speed, 1.0) * v
    return np.where(critical, brake, total + push)


def shortened(vector: Array, longest: float) -> Array:
    length = np.hypot(*vector)
    return vector * (longest / np.maximum(length, longest))


def distances(p: Array, time: float) -> Array:
    place, _ = human_at(time)
    point, _, _ = contour_point(p)
    disc = np.array(DISC_CENTER)[:, None]
    return np.stack([np.hypot(*(p - center)) for center in (place, point, disc)])


def power(old: Array, new: Array) -> Array:
    rate = WHEELS @ new
    direction = np.where(np.abs(rate) < ALIGNED, 0.0, np.sign(rate))
    current = INERTIA[:, None] * (WHEELS @ (new - old)) / STEP + VISCOUS[:, None] * rate + STATIC[:, None] * direction
    return RESISTANCE * (current**2).sum(axis=0)


def simulate(gains: Array) -> Runs:
    """Run configuration 4 with every gain set, ``gains`` of shape (n, 4)."""
    count = len(gains)
    arrival, energy, least = np.full(count, np.nan), np.zeros(count), np.full((3, count), np.inf)
    rows = np.arange(count)
    p = np.repeat(np.array(START)[:, None], count, axis=1)
    v, f, k = np.zeros((2, count)), np.zeros((2, count)), np.ascontiguousarray(gains.T)
    least[:] = distances(p, 0.0)
    goal, evaluations = np.array(GOAL)[:, None], 0
    before = np.hypot(*(goal - p))
    for step in range(round(TIME_LIMIT / STEP)):
        if step % STEPS_PER_PERIOD == 0:
            f = force(k, p, v, step * STEP)
            evaluations += len(rows)
        old = v
        v = shortened(v + STEP * shortened(f / MASS, MAX_ACCELERATION), MAX_SPEED)
        p = p + STEP * v
        least[:, rows] = np.minimum(least[:, rows], distances(p, (step + 1) * STEP))
        after = np.hypot(*(goal - p))
        arrived = after <= TOLERANCE
        share = np.where(arrived, (before - TOLERANCE) / np.where(arrived, before - after, 1.0), 1.0)
        energy[rows] += power(old, v) * STEP * share
        before = after
        if arrived.any():
            arrival[rows[arrived]] = (step + share[arrived]) * STEP
            stay = ~arrived
            rows, p, v, f, k, before = rows[stay], p[:, stay], v[:, stay], f[:, stay], k[:, stay], before[stay]
            if not len(rows):
                break
    return Runs(arrival, energy, least.T, evaluations)
