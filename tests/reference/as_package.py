"""The objects of the package that correspond to those of the second evaluation."""

from __future__ import annotations

from collections.abc import Sequence

from hrsafety import navigation as nav
from reference import plain_field as pf

FAR_AWAY = (97.0, -91.0)  # m: a legal start, out of reach of every obstacle of a test state
BODY_SHARE = 0.1  # radius of the body over r3 where the state gives only regions; no force depends on it


def obstacle(plain: pf.Round | pf.Box) -> nav.Obstacle:
    """Return the same obstacle; at time 0 a moving one is where the plain one is."""
    radii = {"active_radius": plain.active_radius, "critical_radius": plain.critical_radius}
    if isinstance(plain, pf.Box):
        return nav.Rectangle(
            center=plain.center, length=plain.length, width=plain.width, heading=plain.heading, **radii
        )
    radius = BODY_SHARE * plain.critical_radius
    if plain.velocity == plain.acceleration == (0.0, 0.0):
        return nav.Disc(center=plain.center, radius=radius, **radii)
    return nav.MovingDisc(
        center=plain.center, radius=radius, velocity=plain.velocity, acceleration=plain.acceleration, **radii
    )


def law(plain: pf.Law) -> nav.VirtualForceField:
    """Return the same law."""
    attractive, repulsive, detour, ratio = plain.gains
    return nav.VirtualForceField(
        attractive_gain=attractive,
        repulsive_gain=repulsive,
        detour_gain=detour,
        gain_ratio=ratio,
        stabilizing=plain.stabilizing.mode,  # type: ignore[arg-type]  # one of the three words
        stabilizing_force_cap=plain.stabilizing.force_cap,
        stabilizing_momentum_cap=plain.stabilizing.momentum_cap,
        pass_behind=plain.pass_behind,
        side_hysteresis=plain.side_hysteresis,
    )


def scenario(goal: pf.Vector, obstacles: Sequence[pf.Round | pf.Box], limits: pf.Limits = pf.ROBOT) -> nav.Scenario:
    """Return a scenario with the same goal and obstacles."""
    robot = nav.HolonomicRobot(
        mass=limits.mass, radius=limits.radius, max_speed=limits.max_speed, max_acceleration=limits.max_acceleration
    )
    return nav.Scenario(
        start=FAR_AWAY,
        goal=goal,
        obstacles=[obstacle(plain) for plain in obstacles],
        robot=robot,
        control_period=limits.control_period,
    )
