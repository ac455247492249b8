"""Peer of the follower: the same loop in plain scalar code, compiled by numba, one run after the other.


Every ray of every sensor is cast in every step, and random numbers are NumPy's: other layouts and
other noise than the package's, so rates agree within their intervals, not run by run.
"""

# ruff: noqa: NPY002  # numba compiles the seeded legacy functions only

from __future__ import annotations

import math

import numba
import numpy as np

STEP, FILTER_TIME, BURST_STEPS = 0.025, 0.15, 80
MASS, BODY, WHEEL_BASE, FASTEST = 3.94, 0.25, 0.41, 0.72
RANGE_DEVIATION = np.array([[0.02, 0.03, 0.07], [0.05, 0.08, 0.13], [0.09, 0.12, 0.37], [0.48, 0.20, 0.43]])
BEARING_DEVIATION = np.radians([[0.08, 0.20, 0.20], [0.05, 0.34, 0.54], [0.15, 0.35, 0.66], [1.12, 2.27, 2.40]])
KINDS = {"static": 0, "one_dynamic": 1, "two_dynamic": 2}
LAWS = {"off": 0, "conventional": 1, "active": 2}


@numba.njit(error_model="numpy")
def deviation(table, distance, bearing):
    """Return a bilinear value of Table 2, its edges outside."""
    row, column = min(max(distance, 1.0), 4.0) - 1.0, min(abs(bearing) / math.radians(30.0), 2.0)
    i, j = min(int(row), 2), min(int(column), 1)
    down, right = row - i, column - j
    upper = table[i, j] * (1.0 - right) + table[i, j + 1] * right
    lower = table[i + 1, j] * (1.0 - right) + table[i + 1, j + 1] * right
    return upper * (1.0 - down) + lower * down


@numba.njit(error_model="numpy")
def nearest_echo(x, y, axis, boxes, count):
    """Return the shortest of 13 rays over 30 degrees."""
    best = np.inf
    for ray in range(13):
        angle = axis + math.radians(-15.0 + 2.5 * ray)
        dx, dy = math.cos(angle), math.sin(angle)
        for m in range(count):
            x1, x2 = (boxes[m, 0] - boxes[m, 2] - x) / dx, (boxes[m, 0] + boxes[m, 2] - x) / dx
            y1, y2 = (boxes[m, 1] - boxes[m, 3] - y) / dy, (boxes[m, 1] + boxes[m, 3] - y) / dy
            enter, leave = max(min(x1, x2), min(y1, y2)), min(max(x1, x2), max(y1, y2))
            if enter <= leave and leave > 0.0:
                best = min(best, max(enter, 0.0))
    return best


@numba.njit(error_model="numpy")
def draw_layout(kind, boxes, motion):
    """Fill in boxes (center, half sides) and motion (crossing, side, speed, time, run-in, drift, stop)."""
    u = np.random.random(8)
    if kind == 0:
        boxes[0] = np.array([1.6 + 0.8 * u[0], -0.6 + 1.2 * u[1], 0.25, 0.5])
        boxes[1] = np.array([3.4 + 0.8 * u[2], -0.6 + 1.2 * u[3], 0.25, 0.4])
        return 2
    side, drift = (-1.0 if u[0] < 0.5 else 1.0), -0.2 + 0.4 * u[1]
    for m in range(kind):
        crossing = 2.5 + 1.5 * u[2] if m == 0 else 4.5 + 2.0 * u[5]
        speed = 0.15 + 0.35 * u[3 + 3 * m]
        due = (crossing - 0.1) / 0.3 - 2.0 + 4.0 * u[4 + 3 * m]
        own = side if m == 0 else -side
        motion[m] = np.array([crossing, own, speed, due, min(3.0, speed * due), drift, due + 3.0 / speed])
        boxes[m, 2], boxes[m, 3] = (0.4, 0.25) if m == 0 else (0.25, 0.1)
    return kind


@numba.njit(error_model="numpy")
def repulsion(law, readings, px, py, heading, memory, weight, limit, force):
    """Add the repulsive force of all collision vectors to ``force``."""
    vx, vy, case = np.zeros(3), np.zeros(3), np.zeros(3, np.int64)
    used = np.zeros(3, np.bool_)
    for i in range(2):
        if readings[i] < 9.0 and readings[i + 1] < 9.0 and not used[i]:
            ux, uy = px[i + 1] - px[i], py[i + 1] - py[i]
            if math.hypot(ux, uy) < 0.5 + 0.6 * min(readings[i], readings[i + 1]):
                share = min(max(-(px[i] * ux + py[i] * uy) / (ux * ux + uy * uy), 0.0), 1.0)
                vx[i], vy[i], case[i] = px[i] + share * ux, py[i] + share * uy, 4 + i
                used[i], used[i + 1] = True, True
    for i in range(3):
        if readings[i] < 9.0 and not used[i]:
            vx[i], vy[i], case[i] = px[i], py[i], 1 + i
    for j in range(3):
        if case[j] == 0:
            memory[j, 0] = 0.0
            continue
        distance = math.hypot(vx[j], vy[j])
        if memory[j, 0] != case[j]:
            memory[j, 0], memory[j, 1], memory[j, 2] = case[j], distance, 0.0
        else:
            raw = (memory[j, 1] - distance) / STEP
            if abs(raw) <= 4.0:
                memory[j, 2] += weight * (raw - memory[j, 2])
            memory[j, 1] = distance
        speed, size = max(memory[j, 2], 0.0), 0.0
        if law == 1 and distance < 0.8:
            size = 40.0 * (0.8 - distance) + 10.0 * speed
        elif law == 2:
            size = math.e * 40.0 * math.exp(-distance / 0.4) * distance
            if speed <= limit:
                size += 10.0 / math.e * math.exp(2.0 * speed / limit) * (limit - speed)
        c, s = math.cos(heading), math.sin(heading)
        force[0] -= size * (c * vx[j] - s * vy[j]) / distance
        force[1] -= size * (s * vx[j] + c * vy[j]) / distance


@numba.njit(error_model="numpy")
def run(kind, law, seed):
    """Return whether a run touches a box."""
    np.random.seed(seed)
    boxes, motion, memory = np.zeros((2, 4)), np.zeros((2, 7)), np.zeros((3, 3))
    count = draw_layout(kind, boxes, motion)
    steps, limit = (1600, 0.6) if kind == 0 else (1040, 0.72)
    weight = 1.0 - math.exp(-STEP / FILTER_TIME)
    x = y = heading = vx = vy = tx = ty = 0.0
    readings, px, py, force = np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(2)
    for step in range(steps + 1):
        time = step * STEP
        source = 6.0 if kind == 0 else min(1.2 + 0.3 * time, 7.5)
        for m in range(count):
            if kind:
                crossing, side, speed, due, run_in, drift, stop = motion[m]
                moved = min(max(time, due - run_in / speed), stop) - due
                boxes[m, 0], boxes[m, 1] = crossing + drift * moved, -side * speed * moved
            gap_x, gap_y = max(abs(x - boxes[m, 0]) - boxes[m, 2], 0.0), max(abs(y - boxes[m, 1]) - boxes[m, 3], 0.0)
            if gap_x * gap_x + gap_y * gap_y < BODY * BODY:
                return True
        if step % BURST_STEPS == 0:
            distance, bearing = math.hypot(source - x, y), math.atan2(-y, source - x) - heading
            bearing = math.atan2(math.sin(bearing), math.cos(bearing))
            heard = distance + deviation(RANGE_DEVIATION, distance, bearing) * np.random.normal()
            angle = heading + bearing + deviation(BEARING_DEVIATION, distance, bearing) * np.random.normal()
            ahead = max(heard - 0.9, 0.0)
            tx, ty = x + ahead * math.cos(angle), y + ahead * math.sin(angle)
        c, s = math.cos(heading), math.sin(heading)
        force[0], force[1] = 2.0 * (tx - x) - vx, 2.0 * (ty - y) - vy
        if law:
            for i in range(3):
                side = i - 1.0
                axis = side * math.pi / 6.0
                at_x, at_y = x + 0.2 * c - 0.15 * side * s, y + 0.2 * s + 0.15 * side * c
                reading = nearest_echo(at_x, at_y, heading + axis, boxes, count)
                readings[i] = reading + 0.005 * np.random.normal() if 0.03 <= reading <= 3.0 else np.inf
                px[i], py[i] = readings[i] * math.cos(axis), 0.15 * side + readings[i] * math.sin(axis)
            repulsion(law, readings, px, py, heading, memory, weight, limit, force)
        vx, vy = vx + STEP / MASS * force[0], vy + STEP / MASS * force[1]
        size = math.hypot(vx, vy)
        if size > FASTEST:
            vx, vy, size = vx * FASTEST / size, vy * FASTEST / size, FASTEST
        error = math.atan2(vy * c - vx * s, vx * c + vy * s)
        turning = 4.0 * error if size >= 0.02 else 0.0
        ahead = size * max(math.cos(error), 0.0)
        wheels = max(abs(ahead - 0.5 * WHEEL_BASE * turning), abs(ahead + 0.5 * WHEEL_BASE * turning))
        if wheels > FASTEST:
            ahead, turning = ahead * FASTEST / wheels, turning * FASTEST / wheels
        middle = heading + 0.5 * turning * STEP
        x, y = x + ahead * STEP * math.cos(middle), y + ahead * STEP * math.sin(middle)
        heading += turning * STEP
    return False


@numba.njit(error_model="numpy")
def _touches(kind, law, first, count):
    touched = tried = kept = 0
    while kept < count:
        if run(kind, 0, first + tried):
            kept += 1
            touched += run(kind, law, first + tried)
        tried += 1
    return touched


def touches(kind: str, law: str, count: int, first: int = 0) -> int:
    """Return in how many of the layouts that touch without repulsion the law touches."""
    return int(_touches(KINDS[kind], LAWS[law], first, count))
