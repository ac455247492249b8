"""Rectangles that move: carts, vehicles, gates."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import field
from typing import Any, Self

import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, number, pair
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.obstacles.base import LIMITS, Obstacle
from hrsafety.navigation.obstacles.motions import Path, Segment, frozen_path, frozen_segments, moving_body
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.obstacles.standing import Rectangle

__all__ = ["Box", "Mobile", "MovingRectangle"]


@dataclass(frozen=True, kw_only=True, slots=True)
class MovingRectangle(Obstacle):
    """A rectangle that moves and keeps its heading, for example a cart, a vehicle or a gate.

    Its regions are measured from the contour, not from the centre. Its nearest point moves with it and,
    along a side, with the robot. It does not turn: what turns is held by a `MovingDisc` around it.

    Parameters
    ----------
    center : tuple of float
        Position (x, y) of the centroid at time 0, in m.
    length, width : float
        Sides in m; ``length`` lies along ``heading``.
    velocity, acceleration : tuple of float
        Velocity at time 0 in m/s and constant acceleration in m/s^2.
    heading : float
        Angle of the length to the x axis, in rad; the way need not go along it.
    stop : tuple of float or None
        Where it comes to a sudden stop, in m; needs a velocity towards it and no acceleration.
    active_radius, critical_radius : float or None
        Distances r_2 and r_3 of the borders of the active and critical region from the
        contour, in m; computed by the scenario when ``None``.
    active_clearance, critical_clearance : float or None
        The same regions measured between the surfaces of obstacle and robot, in m; instead of the
        radii.
    max_speed : float or None
        Speed that the regions are sized for, in m/s; the largest initial speed of any segment
        of the motion when ``None``.
    segments, path : tuple or None
        Set by `from_segments` and `from_path`.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, a side is not positive, ``stop`` does not lie ahead, or
        active_radius is not larger than critical_radius.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> cart = nav.MovingRectangle(center=(3.0, 4.0), length=1.2, width=0.8, velocity=(0.0, -0.5))
    >>> nav.simulate(nav.Scenario(start=(0, 0), goal=(6, 0), obstacles=[cart]), nav.VirtualForceField()).outcome
    'arrived'
    """

    center: Pair
    length: float
    width: float
    velocity: Pair
    heading: float = 0.0
    acceleration: Pair = (0.0, 0.0)
    stop: Pair | None = None
    active_radius: float | None = None
    critical_radius: float | None = None
    active_clearance: float | None = None
    critical_clearance: float | None = None
    max_speed: float | None = None
    segments: tuple[Segment, ...] | None = None
    path: Path | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values and build the native counterpart from whichever motion was given."""
        self._converted(
            center=pair("center", self.center),
            velocity=pair("velocity", self.velocity),
            acceleration=pair("acceleration", self.acceleration),
            stop=None if self.stop is None else pair("stop", self.stop),
        )
        if self.path is None and not all(map(math.isfinite, self.center)):
            raise InvalidParameterError("center", "be finite", self.center)
        sides = {name: number(name, getattr(self, name)) for name in ("length", "width", "heading")}
        self._converted(**sides)
        given = {**sides, **dict(zip(LIMITS, self._limits(), strict=True))}
        if self.path is None and self.segments is None:
            motion = {"velocity": self.velocity, "acceleration": self.acceleration, "stop": self.stop}
            native = _hrsafety.Obstacle.moving_rectangle(start=self.center, **motion, **given)
        else:
            native = moving_body(self, self.center, given)
        self._set(_native=native)

    @classmethod
    def from_path(
        cls, time: npt.ArrayLike, position: npt.ArrayLike, *, length: float, width: float, **fields: Any
    ) -> Self:
        """Return a rectangle whose centroid follows a recording; see `Human.from_path`."""
        path = frozen_path(time, position)
        return cls(center=path[1][0], velocity=(0.0, 0.0), length=length, width=width, path=path, **fields)

    @classmethod
    def from_segments(
        cls,
        start: Pair,
        segments: Iterable[tuple[float, Sequence[float], Sequence[float]]],
        *,
        length: float,
        width: float,
        **fields: Any,
    ) -> Self:
        """Return a rectangle with piecewise constant acceleration; see `Human.from_segments`."""
        frozen = frozen_segments(segments)
        velocity = frozen[0][1] if frozen else (0.0, 0.0)
        return cls(center=start, velocity=velocity, length=length, width=width, segments=frozen, **fields)


Box = Rectangle | MovingRectangle
"""Obstacles with corners."""

Mobile = Human | MovingDisc | MovingRectangle
"""Obstacles of classes that can move."""
