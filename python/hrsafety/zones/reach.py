"""Areas that a stopping robot reaches: paths of stops, and supports of the footprint along them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from hrsafety._arguments import Array, number, positive
from hrsafety.errors import InvalidParameterError
from hrsafety.zones.polygons import checked, convex

__all__ = ["TOWARD", "RobotOutline", "StoppingPaths", "footprint_of", "stopping_paths", "supports"]

TOWARD = 1e-3
"""Speed in m/s of the robot's surface toward a person above which a contact is its fault."""
ROUND = 48
"""Directions of the boundary of a disc."""


class RobotOutline(NamedTuple):
    """Body of a robot: the hull of corners, rounded.

    Attributes
    ----------
    corners : ndarray (n, 2)
        In m, in the base frame; one corner and a rounding are a disc.
    rounding : float
        Radius about each point of the hull in m.
    """

    corners: Array
    rounding: float

    def placed(self, pose: Array) -> Array:
        """Return the corners (..., n, 2) at poses (..., 3)."""
        turned = np.cos(pose[..., 2])[..., np.newaxis], np.sin(pose[..., 2])[..., np.newaxis]
        x, y = self.corners[:, 0], self.corners[:, 1]
        return np.stack(
            [pose[..., :1] + turned[0] * x - turned[1] * y, pose[..., 1:2] + turned[1] * x + turned[0] * y], axis=-1
        )

    @property
    def circumscribed(self) -> float:
        """Distance of the farthest point from the base frame in m."""
        return float(np.linalg.norm(self.corners, axis=1).max()) + self.rounding

    def boundary(self) -> tuple[Array, Array]:
        """Return points of the boundary and their outward normals, each (m, 2)."""
        if len(self.corners) == 1:
            angles = np.arange(ROUND) * (2.0 * math.pi / ROUND)
            normals = np.stack([np.cos(angles), np.sin(angles)], axis=1)
            # Corners about the disc, not on it: what they reach holds all of it.
            return self.corners[0] + self.rounding / math.cos(math.pi / ROUND) * normals, normals
        ahead = np.roll(self.corners, -1, axis=0) - self.corners
        normals = np.stack([ahead[:, 1], -ahead[:, 0]], axis=1) / np.linalg.norm(ahead, axis=1, keepdims=True)
        shares = np.linspace(0.0, 1.0, 5)[:, np.newaxis, np.newaxis]
        place = self.corners + shares * ahead + self.rounding * normals
        return place.reshape(-1, 2), np.broadcast_to(normals, place.shape).reshape(-1, 2)

    def distance(self, place: Array) -> tuple[Array, Array, Array]:
        """Return the distance of points in the base frame, the nearest points of the body and the unit ways out.

        Parameters
        ----------
        place : ndarray (n, 2)
            In m.

        Returns
        -------
        tuple of ndarray (n,), (n, 2) and (n, 2)
            Distances in m, negative inside.
        """
        if len(self.corners) == 1:
            nearest = np.broadcast_to(self.corners[0], place.shape)
            within = np.zeros(len(place), dtype=bool)
        else:
            along = np.roll(self.corners, -1, axis=0) - self.corners
            away = place[:, np.newaxis] - self.corners
            share = np.clip((away * along).sum(axis=2) / (along * along).sum(axis=1), 0.0, 1.0)
            foot = self.corners + share[..., np.newaxis] * along
            gaps = ((place[:, np.newaxis] - foot) ** 2).sum(axis=2)
            best = gaps.argmin(axis=1)
            nearest = foot[np.arange(len(place)), best]
            # Convex and counter-clockwise: inside of every edge.
            within = np.all((along[:, 0] * away[..., 1] - along[:, 1] * away[..., 0]) > 0.0, axis=1)
        outward = place - nearest
        length = np.sqrt((outward * outward).sum(axis=1))
        way = outward / np.maximum(length, 1e-12)[:, np.newaxis]
        sign = np.where(within, -1.0, 1.0)
        return sign * length - self.rounding, nearest, way * sign[:, np.newaxis]


def footprint_of(value: object, name: str = "footprint") -> RobotOutline:
    """Return a body from a radius or from corners, which must be convex.

    Parameters
    ----------
    value : float or array_like (n, 2)
        Radius in m about the base frame, or corners in m.
    name : str
        Name of the argument.

    Returns
    -------
    RobotOutline
        Corners counter-clockwise.

    Raises
    ------
    InvalidParameterError
        If it is neither, or its corners do not form a convex polygon.
    """
    if isinstance(value, RobotOutline):
        return value
    if np.ndim(value) == 0:  # type: ignore[arg-type]  # what is no number fails below
        return RobotOutline(np.zeros((1, 2)), positive(name, number(name, value)))
    corners = checked(name, value)
    hull = convex(corners)
    if len(hull) < len(np.unique(corners, axis=0)):
        rule = "be convex"
        raise InvalidParameterError(name, rule, corners.tolist(), "give its convex hull: it is the larger body")
    return RobotOutline(hull, 0.0)


class StoppingPaths(NamedTuple):
    """Paths of stops, from the instant at which a zone was seen to be free until the robot stands.

    Attributes
    ----------
    time : ndarray (p, n)
        In s.
    pose : ndarray (p, n, 3)
        x, y in m and heading in rad in the base frame at the start.
    velocity : ndarray (p, n, 3)
        In m/s and rad/s, in the base frame of the instant.
    """

    time: Array
    pose: Array
    velocity: Array


def stopping_paths(
    command: Array,
    *,
    deceleration: float,
    turn_deceleration: float,
    reaction_time: float,
    build_up: float = 0.0,
    drift: Array | None = None,
    drift_time: float = 0.0,
    limits: tuple[Array, Array] | None = None,
    instants: int = 41,
) -> StoppingPaths:
    """Return the paths of robots that keep a velocity during the reaction and brake to rest.

    Parameters
    ----------
    command : ndarray (p, 3)
        Velocities (m/s, m/s, rad/s) at the end of the drift.
    deceleration, turn_deceleration : float
        Of the brakes in m/s^2 and rad/s^2; velocity and turn rate brake together, in the longer one of both times.
    reaction_time, build_up : float
        In s.
    drift : ndarray (p, 3) or None
        How fast the velocity still differs at the start and comes to the command, per second of the drift time left.
    drift_time : float
        In s.
    limits : tuple of ndarray (3,)
        Least and largest velocities of the robot: no drift leaves them.
    instants : int
        Number of instants of each path.

    Returns
    -------
    StoppingPaths
        Exact for velocities that are linear between the instants.
    """
    half = max(instants // 2, 2)
    early = np.linspace(0.0, reaction_time, half) if reaction_time > 0.0 else np.zeros(1)
    left = np.maximum(drift_time - early, 0.0)[:, np.newaxis]
    moving = command[:, np.newaxis] + (0.0 if drift is None else drift[:, np.newaxis] * left)
    moving = np.broadcast_to(moving, (len(command), len(early), 3))
    if limits is not None:
        moving = np.clip(moving, *limits)
    last = moving[:, -1]
    # The one that takes longer decides; as a speed of the brakes in m/s.
    turning = np.abs(last[:, 2]) * (deceleration / turn_deceleration)
    speed = np.maximum(np.hypot(last[:, 0], last[:, 1]), turning)
    soft = speed < 0.5 * deceleration * build_up
    braking = np.where(soft, np.sqrt(2.0 * speed * build_up / deceleration), 0.5 * build_up + speed / deceleration)
    late = braking[:, np.newaxis] * np.linspace(0.0, 1.0, instants - half + 1)[1:]
    rise = np.minimum(late, build_up)
    lost = deceleration * (0.5 * rise * rise / build_up if build_up > 0.0 else 0.0) + deceleration * (late - rise)
    share = np.clip(1.0 - lost / np.maximum(speed, 1e-300)[:, np.newaxis], 0.0, 1.0)
    velocity = np.concatenate([moving, last[:, np.newaxis] * share[..., np.newaxis]], axis=1)
    time = np.concatenate([np.broadcast_to(early, (len(command), len(early))), reaction_time + late], axis=1)
    step = np.diff(time, axis=1)
    mean = 0.5 * (velocity[:, 1:] + velocity[:, :-1])
    heading = np.concatenate([np.zeros((len(command), 1)), np.cumsum(mean[..., 2] * step, axis=1)], axis=1)
    middle = 0.5 * (heading[:, 1:] + heading[:, :-1])
    moves = np.stack(
        [
            (mean[..., 0] * np.cos(middle) - mean[..., 1] * np.sin(middle)) * step,
            (mean[..., 0] * np.sin(middle) + mean[..., 1] * np.cos(middle)) * step,
        ],
        axis=-1,
    )
    place = np.concatenate([np.zeros((len(command), 1, 2)), np.cumsum(moves, axis=1)], axis=1)
    return StoppingPaths(time, np.concatenate([place, heading[..., np.newaxis]], axis=-1), velocity)


def supports(
    paths: StoppingPaths,
    body: RobotOutline,
    directions: Array,
    *,
    person_speed: float,
    leading: bool,
    spread: tuple[float, float] = (0.0, 0.0),
) -> Array:
    """Return the supports of the union over t of the body grown by u t, in directions (k, 2).

    Parameters
    ----------
    paths : StoppingPaths
        Of the robot.
    body : RobotOutline
        Of the robot.
    directions : ndarray (k, 2)
        Unit vectors.
    person_speed : float
        Speed u in m/s.
    leading : bool
        Whether only those faces count that move outward.
    spread : tuple of float
        Acceleration a in m/s^2 and time L in s: the velocity may differ by a (L - t) in any direction until L.

    Returns
    -------
    ndarray (k,)
        In m; minus infinity where nothing counts.
    """
    place, normals = body.boundary()
    found = np.full(len(directions), -math.inf)
    for time, pose, velocity in zip(paths.time, paths.pose, paths.velocity, strict=True):
        cos, sin = np.cos(pose[:, 2:]), np.sin(pose[:, 2:])
        x = pose[:, :1] + cos * place[:, 0] - sin * place[:, 1]
        y = pose[:, 1:2] + sin * place[:, 0] + cos * place[:, 1]
        left = np.maximum(spread[1] - time, 0.0)
        wide = person_speed * time + 0.5 * spread[0] * (spread[1] ** 2 - left**2)
        radius = np.broadcast_to(wide[:, np.newaxis], x.shape)
        if leading:
            outward = (velocity[:, :1] - velocity[:, 2:] * place[:, 1]) * normals[:, 0]
            outward = outward + (velocity[:, 1:2] + velocity[:, 2:] * place[:, 0]) * normals[:, 1]
            counts = outward + spread[0] * left[:, np.newaxis] > 0.5 * TOWARD
            # A face that moved until the end of a step touches what is there at its end.
            counts[1:] |= counts[:-1]
            x, y, radius = x[counts], y[counts], radius[counts]
        reach = np.stack([x.ravel(), y.ravel()], axis=1) @ directions.T + radius.reshape(-1, 1)
        if len(reach):
            found = np.maximum(found, reach.max(axis=0))
    return found
