"""The virtual force field written a second time, for the tests only.

Plain scalars and tuples, one obstacle after the other, equations in the order of the
specification (numbers in brackets are equations of Zeng 2011). Nothing here is shared with the
kernels, so an agreement of the two is evidence for both. Speed does not matter.

Symbols: E goal - robot, D robot - obstacle, W goal - obstacle, u along D, t = u turned by +90
degrees, s the side of the detour, Phi the angle from D to W, a = r2 - d, c = d - r3.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

Vector = tuple[float, float]

COLLINEAR = 1e-9  # rad: robot, obstacle and goal count as one line when pi - |Phi| is below
NO_PREFERENCE = 1e-9  # of the summed magnitudes: detour forces of the others cancel
MOVING = 0.05  # m/s: slower obstacles count as standing for the pass-behind rule
OFF_LINE = 1e-9  # m: robot and goal lie off the velocity line
LEAST_V_L = 1e-6  # N/s: below, the stabilizing force is zero


class Gains(NamedTuple):
    attractive: float  # K1
    repulsive: float  # K3
    detour: float  # K5
    ratio: float  # b


class Round(NamedTuple):
    """A disc or a person, as it is at one instant."""

    center: Vector
    critical_radius: float
    active_radius: float
    velocity: Vector = (0.0, 0.0)
    acceleration: Vector = (0.0, 0.0)
    radius: float = 0.1


class Box(NamedTuple):
    """A rectangle at rest; regions are measured from its contour."""

    center: Vector
    length: float
    width: float
    heading: float
    critical_radius: float
    active_radius: float


class Stabilizing(NamedTuple):
    mode: str = "off"
    force_cap: float | None = None
    momentum_cap: float | None = None


class Law(NamedTuple):
    gains: Gains
    stabilizing: Stabilizing = Stabilizing()
    pass_behind: bool = True
    side_hysteresis: float | None = None


class Limits(NamedTuple):
    """What the robot and its controller can do."""

    mass: float = 4.4
    radius: float = 0.2
    max_speed: float = 0.7
    max_acceleration: float = 10.0
    control_period: float = 0.06


ROBOT = Limits()  # the holonomic robot of the source


class Geometry(NamedTuple):
    """Kinematics of robot, goal and one obstacle."""

    region: str  # free, active, critical
    d: float
    u: Vector
    t: Vector
    d_dot: float
    beta_dot: float
    phi: float
    phi_dot: float
    alpha_ddot: float
    a: float
    c: float


class Evaluation(NamedTuple):
    attractive: Vector
    repulsive: list[Vector]
    detour: list[Vector]
    stabilizing: Vector
    total: Vector
    region: list[str]
    side: list[int]
    omega: float
    omega_magnitude: float  # sum of the magnitudes of all terms of Omega: its scale for rounding
    v_l: Vector
    v_l_magnitude: float
    value: float  # Lyapunov function
    derivative: float


def dot(p: Vector, q: Vector) -> float:
    return p[0] * q[0] + p[1] * q[1]


def cross(p: Vector, q: Vector) -> float:
    return p[0] * q[1] - p[1] * q[0]


def minus(p: Vector, q: Vector) -> Vector:
    return (p[0] - q[0], p[1] - q[1])


def plus(p: Vector, q: Vector) -> Vector:
    return (p[0] + q[0], p[1] + q[1])


def times(k: float, p: Vector) -> Vector:
    return (k * p[0], k * p[1])


def left(p: Vector) -> Vector:
    return (-p[1], p[0])


def total(vectors: Sequence[Vector]) -> Vector:
    return (math.fsum(v[0] for v in vectors), math.fsum(v[1] for v in vectors))


def wrap(angle: float) -> float:
    """Return the same angle in (-pi, pi]."""
    while angle > math.pi:
        angle -= 2.0 * math.pi
    while angle <= -math.pi:
        angle += 2.0 * math.pi
    return angle


def sign(value: float) -> int:
    return 1 if value >= 0.0 else -1


def turned(p: Vector, angle: float) -> Vector:
    return (math.cos(angle) * p[0] - math.sin(angle) * p[1], math.sin(angle) * p[0] + math.cos(angle) * p[1])


def nearest_contour_point(box: Box, position: Vector, velocity: Vector) -> tuple[Vector, Vector, bool]:
    """Return the nearest point of the box, its velocity as it slides with the robot, and whether it is a corner."""
    x, y = turned(minus(position, box.center), -box.heading)
    v_x, v_y = turned(velocity, -box.heading)
    half_x, half_y = box.length / 2.0, box.width / 2.0
    beyond_x, beyond_y = abs(x) > half_x, abs(y) > half_y
    local = (math.copysign(half_x, x) if beyond_x else x, math.copysign(half_y, y) if beyond_y else y)
    sliding = (0.0 if beyond_x else v_x, 0.0 if beyond_y else v_y)
    return plus(box.center, turned(local, box.heading)), turned(sliding, box.heading), beyond_x and beyond_y


def separates(box: Box, position: Vector, goal: Vector) -> bool:
    """Say whether the open segment from robot to goal meets the box."""
    start = turned(minus(position, box.center), -box.heading)
    along = turned(minus(goal, position), -box.heading)
    first, last = 0.0, 1.0
    for axis, half in ((0, box.length / 2.0), (1, box.width / 2.0)):
        if along[axis] == 0.0:
            if abs(start[axis]) > half:
                return False
            continue
        enter = (-half - start[axis]) / along[axis]
        leave = (half - start[axis]) / along[axis]
        first, last = max(first, min(enter, leave)), min(last, max(enter, leave))
    return first <= last and first < 1.0 and last > 0.0


def distance_to(obstacle: Round | Box, position: Vector) -> float:
    if isinstance(obstacle, Box):
        point, _, _ = nearest_contour_point(obstacle, position, (0.0, 0.0))
        return math.hypot(*minus(position, point))
    return math.hypot(*minus(position, obstacle.center))


def geometry(obstacle: Round | Box, position: Vector, velocity: Vector, goal: Vector) -> Geometry:
    """Return items 1 and 5 of section 3."""
    d = distance_to(obstacle, position)
    r2, r3 = obstacle.active_radius, obstacle.critical_radius
    if d <= r3 or d >= r2:
        nothing = (0.0, 0.0)
        region = "critical" if d <= r3 else "free"
        return Geometry(region, d, nothing, nothing, 0.0, 0.0, 0.0, 0.0, 0.0, r2 - d, d - r3)
    if isinstance(obstacle, Box):
        point, point_velocity, corner = nearest_contour_point(obstacle, position, velocity)
        body_velocity, body_acceleration = (0.0, 0.0), (0.0, 0.0)
    else:
        point, point_velocity, corner = obstacle.center, obstacle.velocity, True
        body_velocity, body_acceleration = obstacle.velocity, obstacle.acceleration
    u = times(1.0 / d, minus(position, point))
    t = left(u)
    relative = minus(velocity, body_velocity)
    d_dot = dot(u, relative)
    beta_dot = dot(t, relative) / d if corner else 0.0
    w_vector = minus(goal, point)
    w = math.hypot(*w_vector)
    if w == 0.0:
        phi, alpha_dot, alpha_ddot = 0.0, 0.0, 0.0
    else:
        u_w = times(1.0 / w, w_vector)
        phi = wrap(math.atan2(w_vector[1], w_vector[0]) - math.atan2(u[1], u[0]))
        alpha_dot = -dot(left(u_w), point_velocity) / w
        w_dot = -dot(u_w, body_velocity)
        alpha_ddot = (-dot(left(u_w), body_acceleration) - 2.0 * w_dot * alpha_dot) / w
    return Geometry("active", d, u, t, d_dot, beta_dot, phi, alpha_dot - beta_dot, alpha_ddot, r2 - d, d - r3)


def rule_side(law: Law, obstacle: Round | Box, g: Geometry, position: Vector, goal: Vector) -> int:
    """Return the side that the obstacle alone decides (items 2 to 5), or 0 when robot and goal are in line with it."""
    if isinstance(obstacle, Box) and separates(obstacle, position, goal):
        to_goal, to_robot = minus(goal, obstacle.center), minus(position, obstacle.center)
        around = wrap(math.atan2(to_goal[1], to_goal[0]) - math.atan2(to_robot[1], to_robot[0]))
        return 0 if math.pi - abs(around) < COLLINEAR else sign(around)
    if isinstance(obstacle, Round) and law.pass_behind:
        speed = math.hypot(*obstacle.velocity)
        if speed > MOVING:
            heading = times(1.0 / speed, obstacle.velocity)
            robot_off = cross(heading, minus(position, obstacle.center))
            goal_off = cross(heading, minus(goal, obstacle.center))
            if min(abs(robot_off), abs(goal_off)) > OFF_LINE and robot_off * goal_off < 0.0:
                return sign(robot_off)
    return 0 if math.pi - abs(g.phi) < COLLINEAR else sign(g.phi)


def detour_force(gains: Gains, g: Geometry, side: int, turn: float) -> Vector:
    """Return (5.4.5): K5 (psi + b psi-dot*) u_psi."""
    psi = g.a**2 * turn
    psi_dot = g.a**2 * side * g.phi_dot
    return times(gains.detour * (psi + gains.ratio * psi_dot) * side, g.t)


def sides_and_turns(
    law: Law,
    obstacles: Sequence[Round | Box],
    views: Sequence[Geometry],
    position: Vector,
    goal: Vector,
    latch: Sequence[int] | None,
) -> tuple[list[int], list[float]]:
    """Return the side and the magnitude of the turn of every obstacle (items 2 to 5 and 24)."""
    sides = [0] * len(views)
    turns = [abs(g.phi) for g in views]
    undecided = []
    for i, g in enumerate(views):
        if g.region != "active":
            continue
        if law.side_hysteresis is not None and latch is not None and latch[i] and abs(g.phi) > law.side_hysteresis:
            sides[i] = latch[i]
            if latch[i] != sign(g.phi):
                turns[i] = 2.0 * math.pi - abs(g.phi)
            continue
        sides[i] = rule_side(law, obstacles[i], g, position, goal)
        if sides[i] == 0:
            undecided.append(i)
    for i in undecided:
        others = [detour_force(law.gains, g, sides[j], turns[j]) for j, g in enumerate(views) if sides[j] != 0]
        push = dot(views[i].t, total(others))
        magnitude = math.fsum(math.hypot(*force) for force in others)
        sides[i] = 1 if abs(push) <= NO_PREFERENCE * magnitude else sign(push)
    return sides, turns


def omega_terms(
    gains: Gains,
    mass: float,
    velocity: Vector,
    to_goal: Vector,
    g: Geometry,
    acceleration: Vector,
    side: int,
    turn: float,
) -> list[float]:
    """Return the terms of the corrected Omega (item 7) that belong to one obstacle alone."""
    k1, k3, k5, _ = gains
    a, c, d = g.a, g.c, g.d
    lam = a**2 / c
    lam_dot = -g.d_dot * a**2 / c**2
    psi = a**2 * turn
    psi_dot = a**2 * side * g.phi_dot
    u_psi = times(side, g.t)
    edot = times(-1.0, velocity)
    kl_dot = -2.0 * g.d_dot * (a**2 / c**3 + a / c**2)
    sigma = 1 if turn > math.pi or side == sign(g.phi) else -1
    return [
        -k1 * k3 * lam * dot(edot, g.u),
        -k1 * k5 * psi * dot(edot, u_psi),
        -2.0 * k3**2 * g.d_dot * a / c * lam,
        mass / 2.0 * k3 * kl_dot * g.d_dot**2,
        k5 * psi_dot * mass * dot(acceleration, u_psi),
        -k5 * psi_dot * k1 * dot(to_goal, u_psi),
        k5 * psi_dot * side * mass * d * g.alpha_ddot,
        k5 * psi_dot * 2.0 * side * mass * g.d_dot * g.beta_dot,
        -k3 * lam_dot * k1 * dot(to_goal, g.u),
        k3 * lam_dot * mass * dot(acceleration, g.u),
        -k3 * lam_dot * mass * d * g.beta_dot**2,
        mass / 2.0 * k5 * a**2 * g.d_dot * g.phi_dot**2,
        -mass * k5 * a * d * g.d_dot * g.phi_dot**2,
        -2.0 * k5**2 * a**3 * g.d_dot * turn**2,
        (sigma - 1) * k5**2 * psi * psi_dot,
    ]


def stabilizing_force(law: Law, limits: Limits, omega: float, v_l: Vector, velocity: Vector) -> Vector:
    """Return (5.5.9) in the mode of the law."""
    size = math.hypot(*v_l)
    if law.stabilizing.mode == "off" or omega <= 0.0 or size < LEAST_V_L:
        return (0.0, 0.0)
    magnitude = omega / size
    if law.stabilizing.mode == "capped":
        share, cap = law.stabilizing.momentum_cap, law.stabilizing.force_cap
        if share is not None:
            cap = share * limits.mass * math.hypot(*velocity) / limits.control_period
        magnitude = min(magnitude, 10.0 if cap is None else cap)
    return times(magnitude / size, v_l)


def lyapunov_value(
    gains: Gains,
    mass: float,
    velocity: Vector,
    to_goal: Vector,
    views: Sequence[Geometry],
    turns: Sequence[float],
) -> float:
    """Return V of (5.5.2) with the h of Q2, one pair of terms for each active obstacle."""
    k1, k3, k5, _ = gains
    parts = [k1**2 * dot(to_goal, to_goal) / 2.0, mass * k1 * dot(velocity, velocity) / 2.0]
    for g, turn in zip(views, turns, strict=True):
        if g.region == "active":
            parts += [
                k3**2 * (g.a**2 / g.c) ** 2 / 2.0,
                mass * k3 * (g.a / g.c) ** 2 * g.d_dot**2 / 2.0,
                k5**2 * (g.a**2 * turn) ** 2 / 2.0,
                mass * k5 * g.a**2 * g.d * g.phi_dot**2 / 2.0,
            ]
    return math.fsum(parts)


def brake(limits: Limits, velocity: Vector) -> Vector:
    """Return the full braking force of the critical region, which never reverses the motion."""
    speed = math.hypot(*velocity)
    if speed == 0.0:
        return (0.0, 0.0)
    return times(-limits.mass * min(limits.max_acceleration, speed / limits.control_period) / speed, velocity)


def evaluate(
    law: Law,
    limits: Limits,
    position: Vector,
    velocity: Vector,
    goal: Vector,
    obstacles: Sequence[Round | Box],
    latch: Sequence[int] | None = None,
) -> Evaluation:
    """Return every term of the field at one state; ``latch`` holds the sides of the last control period."""
    gains, mass = law.gains, limits.mass
    views = [geometry(obstacle, position, velocity, goal) for obstacle in obstacles]
    regions = [g.region for g in views]
    none: list[Vector] = [(0.0, 0.0)] * len(views)
    if "critical" in regions:
        return Evaluation(
            attractive=(0.0, 0.0),
            repulsive=none,
            detour=none,
            stabilizing=(0.0, 0.0),
            total=brake(limits, velocity),
            region=regions,
            side=[0] * len(views),
            omega=0.0,
            omega_magnitude=0.0,
            v_l=(0.0, 0.0),
            v_l_magnitude=0.0,
            value=math.nan,
            derivative=math.nan,
        )
    sides, turns = sides_and_turns(law, obstacles, views, position, goal, latch)
    to_goal = minus(goal, position)
    attractive = times(gains.attractive, minus(to_goal, times(gains.ratio, velocity)))
    repulsive, detour, terms = list(none), list(none), [0.0]
    f_parts, l_parts = list(none), list(none)
    for i, g in enumerate(views):
        if g.region != "active":
            continue
        lam, lam_dot = g.a**2 / g.c, -g.d_dot * g.a**2 / g.c**2
        psi, psi_dot = g.a**2 * turns[i], g.a**2 * sides[i] * g.phi_dot
        u_psi = times(sides[i], g.t)
        repulsive[i] = times(gains.repulsive * (lam + gains.ratio * lam_dot), g.u)
        detour[i] = detour_force(gains, g, sides[i], turns[i])
        f_parts[i] = plus(times(gains.repulsive * lam, g.u), times(gains.detour * psi, u_psi))
        l_parts[i] = plus(times(gains.repulsive * lam_dot, g.u), times(gains.detour * psi_dot, u_psi))
        obstacle = obstacles[i]
        acceleration = obstacle.acceleration if isinstance(obstacle, Round) else (0.0, 0.0)
        terms += omega_terms(gains, mass, velocity, to_goal, g, acceleration, sides[i], turns[i])
    count = range(len(views))
    terms += [-dot(l_parts[i], f_parts[j]) for i in count for j in count if i != j]
    omega = math.fsum(terms)
    v_l = total([times(-gains.attractive, velocity), *l_parts])
    stabilizing = stabilizing_force(law, limits, omega, v_l, velocity)
    return Evaluation(
        attractive=attractive,
        repulsive=repulsive,
        detour=detour,
        stabilizing=stabilizing,
        total=total([attractive, *repulsive, *detour, stabilizing]),
        region=regions,
        side=sides,
        omega=omega,
        omega_magnitude=math.fsum(abs(term) for term in terms),
        v_l=v_l,
        v_l_magnitude=gains.attractive * math.hypot(*velocity) + math.fsum(math.hypot(*part) for part in l_parts),
        value=lyapunov_value(gains, mass, velocity, to_goal, views, turns),
        derivative=-gains.ratio * dot(v_l, v_l) - dot(v_l, stabilizing) + omega,
    )
