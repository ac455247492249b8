"""Convex outline of a robot that drives and turns: distances, swept distances along arcs, the room ahead."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import field
from typing import Annotated, Self

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, finite, finite_pair, not_negative, numbers, points, positive
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = ["Footprint"]

Array = npt.NDArray[np.float64]
Pair = tuple[float, float]


@dataclass(frozen=True, slots=True)
class Footprint(Parameters):
    """Convex polygon around the point of a robot that drives and turns, in coordinates of its body.

    The origin is the middle of the axle (or the center of a holonomic robot), x points ahead, y to the left. Distances
    are exact: no outline is replaced by discs, no arc by chords.

    Parameters
    ----------
    corners : sequence of (float, float)
        Corners in m, in their order in either direction; 3 to 64, the origin inside.

    Attributes
    ----------
    outer_radius, inner_radius : float
        Radius in m of the circle around the origin that holds the outline, and of the one that it holds.

    Raises
    ------
    InvalidParameterError
        If the polygon is not convex, has equal corners or three on a line, or does not hold the origin inside.

    See Also
    --------
    hrsafety.io.read_nav2 : Footprints as Nav2 writes them.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> robot = nav.robots.Footprint.rectangle(0.508, 0.430)
    >>> round(robot.outer_radius, 4), robot.inner_radius
    (0.3328, 0.215)
    >>> robot.swept_distance([(0.5, 0.4)], distance=1.0, angle=0.0).round(3).tolist()
    [0.185]
    """

    corners: Annotated[tuple[Pair, ...], "m"]
    outer_radius: Annotated[float, "m"] = field(init=False, compare=False)
    inner_radius: Annotated[float, "m"] = field(init=False, compare=False)
    _native: _hrsafety.Footprint = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        native = _hrsafety.Footprint(points("corners", self.corners))
        _, outer, inner = native.facts()
        corners = tuple((float(x), float(y)) for x, y in points("corners", self.corners).tolist())
        self._set(corners=corners, outer_radius=outer, inner_radius=inner, _native=native)

    @classmethod
    def rectangle(cls, length: float, width: float, *, center: Sequence[float] = (0.0, 0.0)) -> Self:
        """Return a rectangle with sides along and across the heading.

        Parameters
        ----------
        length, width : float
            Sides in m along and across the heading.
        center : (float, float)
            Its center in m, seen from the point that drives and turns.
        """
        half_length, half_width = positive("length", length) / 2.0, positive("width", width) / 2.0
        x, y = finite_pair("center", center)
        return cls(
            (
                (x + half_length, y + half_width),
                (x - half_length, y + half_width),
                (x - half_length, y - half_width),
                (x + half_length, y - half_width),
            )
        )

    def distance(self, places: npt.ArrayLike) -> Array:
        """Return the distances of points from the outline at rest.

        Parameters
        ----------
        places : array_like, shape (n, 2)
            Points in coordinates of the body in m.

        Returns
        -------
        ndarray, shape (n,)
            Distances in m; inside, minus the distance to the nearest side.
        """
        return self._native.distances(_finite(points("places", places)))

    def swept_distance(self, places: npt.ArrayLike, *, distance: float, angle: float) -> Array:
        """Return the least distances of what stands still from the outline while the robot drives along an arc.

        Parameters
        ----------
        places : array_like, shape (n, 2) or (n, 4)
            Points (x, y) or segments (x, y, x, y) in coordinates of the body at the start, in m. Subtract the radius of
            a disc or capsule.
        distance : float
            Way of the origin along the arc in m, negative backward.
        angle : float
            Angle turned in rad, positive to the left; 0 for a straight way.

        Returns
        -------
        ndarray, shape (n,)
            Distances in m, 0 where the outline reaches the point or segment.

        Raises
        ------
        ShapeError
            If ``places`` has neither two nor four columns.
        InvalidParameterError
            If a number is not finite.
        """
        arc = (finite("distance", distance), finite("angle", angle))
        rows = _finite(numbers("places", places, "be an array of numbers"))
        if rows.ndim != 2 or rows.shape[1] not in (2, 4):
            raise ShapeError("places", "(n, 2) or (n, 4)", rows.shape)
        return (self._native.swept_points if rows.shape[1] == 2 else self._native.swept_segments)(rows, arc)

    def room_ahead_distance(self, places: npt.ArrayLike, *, velocity: float, turn_rate: float, depth: float) -> Array:
        """Return the distances of points from the room ahead of the part of the outline that moves outward.

        A robot is passively safe as long as no person is in that room with the depth of a person's radius: whoever is
        touched elsewhere walked into the robot.

        Parameters
        ----------
        places : array_like, shape (n, 2)
            Points in coordinates of the body in m.
        velocity, turn_rate : float
            Twist in m/s and rad/s.
        depth : float
            Depth of the room outward of the outline in m: radius of a person and margin.

        Returns
        -------
        ndarray, shape (n,)
            Distances in m, 0 inside, infinite for a robot at rest.
        """
        twist = (finite("velocity", velocity), finite("turn_rate", turn_rate))
        return self._native.room_ahead_distances(_finite(points("places", places)), twist, not_negative("depth", depth))


def _finite(places: Array) -> Array:
    if not np.isfinite(places).all():
        raise InvalidParameterError("places", "be finite", float(places[~np.isfinite(places)][0]))
    return places
