"""Reciprocal avoidance against pyrvo, which is by the authors of the method, in single precision.

Each step starts from the state that pyrvo has reached, so that errors do not add up. pyrvo works
in single precision. Where that is not enough, the program is solved once more in double precision
by trying every velocity that can be its solution.
"""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

import numpy as np
import pyrvo  # type: ignore[import-untyped]  # it has no type information
import pytest

from hrsafety import navigation as nav

Array = np.ndarray[Any, np.dtype[np.float64]]

EPISODES, STEPS = 500, 6
INTERVAL, HORIZON = 0.125, 2.0
FAR = 1000.0
VELOCITY = 1e-5  # m/s
EXACT = 1e-9  # m/s: two solutions of one program in double precision
TOUCHING = 2e-6  # m: rounding of a distance in single precision, a few units in the last place
LARGEST_SHARE = 1e-3
"""Share of the velocities that may differ by more than `VELOCITY`, all of them explained."""


class Agents(NamedTuple):
    """All agents of one step: n rows."""

    position: Array
    velocity: Array
    wanted: Array
    goal: Array
    radius: Array
    max_speed: Array


class Lines(NamedTuple):
    """Velocities on the left of n lines are permitted."""

    point: Array
    direction: Array

    def violation(self, velocity: Array) -> Array:
        """Return how far each velocity, (k, 2), is on the wrong side of each line, (k, n)."""
        offset = self.point - velocity[:, None, :]
        return np.asarray(self.direction[:, 0] * offset[..., 1] - self.direction[:, 1] * offset[..., 0])


def single(values: Array) -> Array:
    """Return the numbers that single precision has for these."""
    return values.astype(np.float32).astype(np.float64)


def scattered(generator: np.random.Generator, radius: Array) -> Array:
    """Return places on a crowded square where hardly anybody touches another."""
    half_side = 1.0 + 0.6 * math.sqrt(len(radius))
    places: list[Array] = []
    while len(places) < len(radius):
        place = single(generator.uniform(-half_side, half_side, 2))
        apart = 0.9 * (radius[: len(places)] + radius[len(places)])
        if all(np.hypot(*(place - other)) > least for other, least in zip(places, apart, strict=True)):
            places.append(place)
    return np.array(places)


def wanted_velocities(position: Array, goal: Array, max_speed: Array) -> Array:
    """Return the velocities straight to the goal that do not overshoot it."""
    way = goal - position
    distance = np.hypot(*way.T)
    return np.asarray(way * (np.minimum(max_speed, distance / INTERVAL) / distance)[:, None])


def episode(seed: int) -> list[tuple[Agents, Array, list[Lines]]]:
    """Return states, the new velocities of pyrvo and its lines, step by step."""
    generator = np.random.default_rng(seed)
    count = int(generator.integers(2, 21))
    # Numbers that single precision holds exactly.
    radius = generator.integers(8, 32, count) / 64.0
    max_speed = generator.integers(8, 32, count) / 16.0
    position = scattered(generator, radius)
    goal = -position + generator.normal(0.0, 0.3, (count, 2))
    simulator = pyrvo.RVOSimulator(INTERVAL, FAR, 25, HORIZON, HORIZON, 0.25, 1.0)
    for index in range(count):
        simulator.add_agent(tuple(position[index].tolist()))
        simulator.set_agent_radius(index, float(radius[index]))
        simulator.set_agent_max_speed(index, float(max_speed[index]))
        # Anywhere within the limit of speed.
        angle, speed = generator.uniform(-math.pi, math.pi), max_speed[index] * math.sqrt(generator.random())
        simulator.set_agent_velocity(index, (speed * math.cos(angle), speed * math.sin(angle)))

    def pairs(read: Any) -> Array:
        return np.array([read(index).to_tuple() for index in range(count)])

    steps = []
    for _ in range(STEPS):
        position, velocity = pairs(simulator.get_agent_position), pairs(simulator.get_agent_velocity)
        wanted = wanted_velocities(position, goal, max_speed)
        for index in range(count):
            simulator.set_agent_pref_velocity(index, tuple(wanted[index].tolist()))
        simulator.do_step()
        lines = [lines_of(simulator, index) for index in range(count)]
        agents = Agents(position, velocity, wanted, goal, radius, max_speed)
        steps.append((agents, pairs(simulator.get_agent_velocity), lines))
    return steps


def lines_of(simulator: Any, index: int) -> Lines:
    """Return the half-planes of an agent in the last step of pyrvo."""
    found = [simulator.get_agent_orca_line(index, k) for k in range(simulator.get_agent_num_orca_lines(index))]
    return Lines(np.array([point for _, point in found]), np.array([direction for direction, _ in found]))


LAW = nav.OptimalReciprocalCollisionAvoidance(horizon=HORIZON, reciprocal=True, turn=0.0, margin=0.0, reach=FAR)


def commanded(agents: Agents) -> Array:
    """Return the velocities that the law wants, one agent after the other."""
    discs = [
        # Regions mean nothing to this law; given ones leave no region to be computed.
        nav.MovingDisc(center=place, velocity=velocity, radius=radius, critical_clearance=0.0, active_clearance=1.0)
        for place, velocity, radius in zip(agents.position, agents.velocity, agents.radius, strict=True)
    ]
    found = []
    for index, place in enumerate(agents.position):
        robot = nav.HolonomicRobot(radius=agents.radius[index], max_speed=agents.max_speed[index])
        scenario = nav.Scenario(
            start=(FAR, FAR),  # the state is given below
            goal=agents.goal[index],
            obstacles=(*discs[:index], *discs[index + 1 :]),
            robot=robot,
            control_period=INTERVAL,
        )
        velocity = agents.velocity[index]
        force = nav.laws.command(LAW, scenario, position=place, velocity=velocity)
        found.append(velocity + force * INTERVAL / robot.mass)
    return np.array(found)


# ---- the program once more ------------------------------------------------------------------


def half_planes(agents: Agents, index: int) -> Lines:
    """Return the lines of van den Berg et al. (2011), section 4, from distances and angles."""
    points, directions = [], []
    others = [k for k in range(len(agents.radius)) if k != index]
    for other in others:
        place = agents.position[other] - agents.position[index]
        relative = agents.velocity[index] - agents.velocity[other]
        reach = agents.radius[index] + agents.radius[other]
        normal, depth = way_out(place, relative, reach)
        points.append(agents.velocity[index] + 0.5 * depth * normal)
        directions.append([normal[1], -normal[0]])
    return Lines(np.array(points), np.array(directions))


def way_out(place: Array, relative: Array, reach: float) -> tuple[Array, float]:
    """Return outward normal at the nearest edge of a velocity obstacle, and the way to it."""
    distance = float(np.hypot(*place))
    touching = distance <= reach
    scale = INTERVAL if touching else HORIZON
    from_front = relative - place / scale
    length = float(np.hypot(*from_front))
    front = from_front / length, reach / scale - length
    if touching:
        return front
    # The legs touch the disc where they are at right angles to its radius: the front lies between.
    half_angle = math.asin(reach / distance)
    bearing = math.atan2(place[1], place[0])
    off_axis = math.remainder(math.atan2(from_front[1], from_front[0]) - bearing - math.pi, 2.0 * math.pi)
    if abs(off_axis) < math.pi / 2.0 - half_angle:
        return front
    # Positive cross product: on the left of the axis, where the left leg is nearer.
    side = 1.0 if place[0] * relative[1] - place[1] * relative[0] > 0.0 else -1.0
    leg = bearing + side * half_angle
    normal = side * np.array([-math.sin(leg), math.cos(leg)])
    return np.asarray(normal), -float(normal @ relative)


def crossings(lines: Lines) -> Array:
    """Return the points where two lines cross, (k, 2)."""
    found = [np.empty((0, 2))]
    for one, other in itertools.combinations(range(len(lines.point)), 2):
        found.append(crossing(lines.point[[one, other]], lines.direction[[one, other]]))
    return np.vstack(found)


def crossing(point: Array, direction: Array) -> Array:
    """Return the point where two lines cross as a (1, 2) array, or (0, 2) for parallel ones."""
    sine = direction[0, 0] * direction[1, 1] - direction[0, 1] * direction[1, 0]
    if abs(sine) < 1e-12:
        return np.empty((0, 2))
    offset = point[1] - point[0]
    share = (offset[0] * direction[1, 1] - offset[1] * direction[1, 0]) / sine
    return np.asarray((point[0] + share * direction[0])[None, :])


def on_circle(lines: Lines, radius: float) -> Array:
    """Return the points where lines leave the circle of the largest speed, (k, 2)."""
    foot = np.sum(lines.point * lines.direction, axis=1)
    nearest = lines.point - foot[:, None] * lines.direction
    square = radius**2 - np.sum(nearest**2, axis=1)
    along = np.sqrt(np.maximum(square, 0.0))[:, None] * lines.direction
    return np.asarray(np.vstack([nearest + along, nearest - along])[np.tile(square >= 0.0, 2)])


def equal_violations(lines: Lines) -> Lines:
    """Return the lines on which two lines are violated equally."""
    points, directions = [np.empty((0, 2))], [np.empty((0, 2))]
    for one, other in itertools.combinations(range(len(lines.point)), 2):
        # A violation is n.v - n.p with the outward normal n: where two are equal is a line too.
        normals = np.column_stack([lines.direction[:, 1], -lines.direction[:, 0]])
        normal = normals[one] - normals[other]
        length = float(np.hypot(*normal))
        if length < 1e-12:
            continue
        level = normals[one] @ lines.point[one] - normals[other] @ lines.point[other]
        points.append((normal * level / length**2)[None, :])
        directions.append((np.array([-normal[1], normal[0]]) / length)[None, :])
    return Lines(np.vstack(points), np.vstack(directions))


def solved(lines: Lines, wanted: Array, max_speed: float) -> Array:
    """Return the permitted velocity nearest to the wanted one, or that with the least violation.

    Every velocity that can be the one is tried.
    """
    foot = np.sum((wanted - lines.point) * lines.direction, axis=1)
    feet = lines.point + foot[:, None] * lines.direction
    limited = wanted * min(1.0, max_speed / max(float(np.hypot(*wanted)), 1e-300))
    tried = np.vstack([limited, feet, crossings(lines), on_circle(lines, max_speed)])
    tried = tried[np.hypot(*tried.T) <= max_speed + 1e-12]
    permitted = tried[lines.violation(tried).max(axis=1) <= 1e-12]
    if len(permitted):
        return np.asarray(permitted[np.argmin(np.hypot(*(permitted - wanted).T))])
    equal = equal_violations(lines)
    straight = max_speed * np.column_stack([-lines.direction[:, 1], lines.direction[:, 0]])
    tried = np.vstack([straight, crossings(equal), on_circle(equal, max_speed)])
    tried = tried[np.hypot(*tried.T) <= max_speed + 1e-12]
    return np.asarray(tried[np.argmin(lines.violation(tried).max(axis=1))])


def explained(agents: Agents, index: int, ours: Array, theirs: Array, lines: Lines) -> bool:
    """Return whether it is single precision that sets two velocities apart, and ours is right."""
    limits = agents.wanted[index], float(agents.max_speed[index])
    if np.hypot(*(ours - solved(half_planes(agents, index), *limits))) > EXACT:
        return False
    of_their_lines = solved(lines, *limits)
    if np.hypot(*(ours - of_their_lines)) < VELOCITY:
        # Their own half-planes have our solution: the roundings are those of their program.
        return True
    # Two that just touch, or just do not, have different half-planes.
    others = np.arange(len(agents.radius)) != index
    gap = np.hypot(*(agents.position - agents.position[index]).T) - agents.radius - agents.radius[index]
    borderline = bool(np.abs(gap[others]).min() < TOUCHING)
    return borderline and bool(np.hypot(*(theirs - of_their_lines)) < VELOCITY)


def test_velocities_are_those_of_pyrvo() -> None:
    compared, unexplained, beyond, largest = 0, [], 0, 0.0
    sizes = set()
    for seed in range(EPISODES):
        for agents, theirs, lines in episode(seed):
            ours = commanded(agents)
            apart = np.hypot(*(ours - theirs).T)
            sizes.add(len(apart))
            compared += len(apart)
            for index in np.flatnonzero(apart > VELOCITY).tolist():
                beyond += 1
                if not explained(agents, index, ours[index], theirs[index], lines[index]):
                    unexplained.append((seed, index, float(apart[index])))
            largest = max(largest, float(apart[apart <= VELOCITY].max(initial=0.0)))
    assert not unexplained
    assert sizes == set(range(2, 21))
    assert compared > 30_000
    assert beyond <= LARGEST_SHARE * compared
    assert 0.0 < largest <= VELOCITY


def test_velocities_solve_the_program_exactly() -> None:
    blocked, touching = 0, 0
    for seed in range(0, EPISODES, 12):
        for agents, _, _ in episode(seed):
            ours = commanded(agents)
            for index, velocity in enumerate(ours):
                lines = half_planes(agents, index)
                best = solved(lines, agents.wanted[index], float(agents.max_speed[index]))
                assert velocity == pytest.approx(best, abs=EXACT)
                blocked += bool(lines.violation(best[None, :]).max() > 1e-6)
                gap = np.hypot(*(agents.position - agents.position[index]).T) - agents.radius - agents.radius[index]
                touching += bool(np.delete(gap, index).min() < 0.0)
    # Both parts of the method are there: programs without a solution, and contacts to be left.
    assert blocked > 30
    assert touching > 30
