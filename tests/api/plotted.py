"""Runs, scenes and fields that the tests of the pictures draw."""

from __future__ import annotations

import dataclasses

import numpy as np

from hrsafety import navigation as nav

STATIONARY = {"active_radius": 0.8, "critical_radius": 0.4}
WALKING = {"active_radius": 2.1, "critical_radius": 0.8}
DISC = nav.Disc(center=(2.45, 1.4), radius=0.1, **STATIONARY)
RECTANGLE = nav.Rectangle(center=(2.3, 0.0), length=1.4, width=0.6, **STATIONARY)
PERSON = nav.Human(start=(0.6, 0.6), velocity=(1.0, 0.0), stop=(4.0, 0.6), **WALKING)
LAW = nav.VirtualForceField(stabilizing="off")
STEP = 0.01


def scene(*obstacles: nav.Obstacle) -> nav.Scenario:
    return nav.Scenario(start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=obstacles)


def made_up_run(*obstacles: nav.Obstacle, duration: float = 5.5, arrived: bool = True) -> nav.Trajectory:
    """A run along a sine from start to goal; obstacles stand, people walk along x and are absent before 1 s."""
    scenario = scene(*obstacles)
    time = np.arange(round(duration / STEP) + 1) * STEP
    share = time / duration
    position = np.stack([3.9 * (1.0 - share), 0.6 + 0.9 * np.sin(np.pi * share)], axis=1)
    places = np.empty((len(time), len(obstacles), 2))
    for index, obstacle in enumerate(obstacles):
        if isinstance(obstacle, nav.Human):
            places[:, index] = np.array(obstacle.start) + time[:, np.newaxis] * np.array(obstacle.velocity)
            places[time < 1.0, index] = np.nan
        else:
            places[:, index] = obstacle.center
    distance = np.linalg.norm(position[:, np.newaxis] - places, axis=2)
    radii = np.array([getattr(obstacle, "radius", 0.0) + scenario.robot.radius for obstacle in obstacles])
    least = np.nanmin(distance, axis=0) if obstacles else np.empty(0)
    current = 0.2 * np.stack([np.sign(np.sin(time)), np.ones_like(time), -np.ones_like(time)], axis=1)
    return nav.Trajectory(
        scenario=scenario,
        law=LAW,
        time=time,
        position=position,
        velocity=np.gradient(position, time, axis=0),
        force=np.zeros_like(position),
        heading=np.zeros_like(time),
        wheel_current=current,
        obstacle_position=places,
        distance=distance,
        outcome="arrived" if arrived else "timed_out",
        arrival_time=float(time[-1]) if arrived else np.nan,
        energy=float(4.86 * STEP * (current[1:] ** 2).sum()),
        min_distance=least,
        min_clearance=least - radii,
        contact_time=np.full(len(obstacles), np.nan),
        contact_speed=np.full(len(obstacles), np.nan),
        contact_toward=np.zeros(len(obstacles), dtype=bool),
        contact_at_fault=np.zeros(len(obstacles), dtype=bool),
        contact_apart=np.zeros(len(obstacles), dtype=bool),
        path_length=4.5,
        stabilizing=np.zeros_like(position),
        lyapunov=100.0 * np.exp(-time),
    )


def crowd(people: int) -> list[nav.Human]:
    """People who walk through an area of 10 m x 8 m around the way of the robot."""
    places = np.random.default_rng(7).uniform((-4.0, -3.5), (6.0, 4.5), (people, 2))
    return [
        nav.Human(start=tuple(place), velocity=(0.5, 0.1), **WALKING) for place in places if abs(place[0] - 3.9) > 0.7
    ]


def made_up_field(*, hole: tuple[float, float] | None = (2.45, 1.4)) -> nav.laws.ForceField:
    x, y = np.meshgrid(np.linspace(0.0, 4.0, 33), np.linspace(-0.4, 2.6, 25))
    position = np.column_stack([x.ravel(), y.ravel()])
    offset = position - np.array(hole or (9.0, 9.0))
    distance = np.hypot(*offset.T)
    attraction = np.array([0.0, 0.6]) - position
    repulsion = np.where(distance < 0.8, 1.0 / np.maximum(distance - 0.4, 1e-9), 0.0)[:, np.newaxis] * offset
    inside = distance <= 0.4
    terms = {name: np.zeros_like(position) for name in ("detour", "stabilizing")}
    total = np.where(inside[:, np.newaxis], 0.0, attraction + repulsion)
    potential = np.where(inside, np.nan, (attraction**2).sum(axis=1) + (repulsion**2).sum(axis=1) + 1e-3)
    masked = {"attractive": attraction, "repulsive": repulsion, **terms}
    for values in masked.values():
        values[inside] = np.nan
    return nav.laws.ForceField(position=position, total=total, potential=potential, **masked)


def touched(run: nav.Trajectory, obstacle: int, instant: float) -> nav.Trajectory:
    times = run.contact_time.copy()
    times[obstacle] = instant
    return dataclasses.replace(run, contact_time=times, outcome="collided")
