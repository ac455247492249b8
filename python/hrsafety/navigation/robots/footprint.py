"""Convex outline of a robot that drives and turns: distances, swept distances along arcs, the room ahead."""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import field
from typing import TYPE_CHECKING, Annotated, Self

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, finite, finite_pair, not_negative, numbers, points, positive
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown

if TYPE_CHECKING:
    from hrsafety.navigation.maps.static_map import StaticMap

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
        If the polygon is not convex, has equal corners or three on a line, or does not hold the origin inside; `around`
        gives the convex outline of others.

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
        try:
            native = _hrsafety.Footprint(points("corners", self.corners))
        except InvalidParameterError as error:
            if error.remedy is None and "convex" in error.requirement:
                remedy = "Footprint.around(corners) is the convex outline around them"
                raise InvalidParameterError(error.argument, error.requirement, error.value, remedy) from None
            raise
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

    @classmethod
    def around(cls, corners: npt.ArrayLike) -> Self:
        """Return the convex outline around points: of a polygon with notches or with corners along its sides.

        Whatever it adds belongs to the robot from then on, which makes results more careful.

        Parameters
        ----------
        corners : array_like, shape (n, 2)
            Points in coordinates of the body in m, three or more and not all on a line.

        Returns
        -------
        Footprint
            Their convex hull.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> notched = [(0.4, 0.3), (0.2, 0.0), (0.4, -0.3), (-0.3, -0.3), (-0.3, 0.0), (-0.3, 0.3)]
        >>> len(nav.robots.Footprint.around(notched).corners)
        4
        """
        given = _finite(points("corners", corners))
        if len(np.unique(given, axis=0)) < 3:
            raise InvalidParameterError("corners", "hold three corners or more that differ", Shown(given.tolist()))
        return cls(_hull(given))

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return the footprint that Nav2 writes as text, such as ``"[[0.3, 0.2], [0.3, -0.2], [-0.3, 0.0]]"``.

        Corners along its sides are left out, which changes nothing.

        Parameters
        ----------
        text : str
            Pairs [x, y] in m with commas between them, in brackets.

        Returns
        -------
        Footprint
            Without the padding that a costmap adds.

        Raises
        ------
        InvalidParameterError
            If the text is of another form, or the polygon is not convex or does not hold the origin.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.robots.Footprint.parse("[[0.3, 0.2], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]").inner_radius
        0.2
        """
        found = corners_of(text)
        if isinstance(found, str):
            raise InvalidParameterError("footprint", found, Shown(repr(text[:60])), NAV2)
        hull = _hull(np.array(found))
        return cls(hull if abs(_area(np.array(found))) > (1.0 - ROUNDING) * _area(np.array(hull)) else found)

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

    def clearance(self, map: StaticMap, places: npt.ArrayLike, heading: npt.ArrayLike) -> Array:
        """Return the distances of the outline from a map.

        Parameters
        ----------
        map : StaticMap
            What stands.
        places : array_like, shape (n, 2)
            Where the robot is, in m.
        heading : array_like, shape (n,)
            Where it looks, in rad.

        Returns
        -------
        ndarray, shape (n,)
            Distances in m, 0 where they meet.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> wall = nav.StaticMap.from_polylines([[(1.0, -2.0), (1.0, 2.0)]])
        >>> nav.robots.Footprint.rectangle(0.8, 0.4).clearance(wall, [(0, 0), (0, 0)], [0.0, np.pi / 2]).round(3)
        array([0.6, 0.8])
        """
        at = _finite(points("places", places))
        angle = _finite(numbers("heading", heading))
        if angle.shape not in ((), (len(at),)):
            raise ShapeError("heading", f"({len(at)},)", angle.shape)
        angle = np.broadcast_to(angle, len(at))
        return map._native.footprint_clearances(self._native, np.column_stack([at, angle]))

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


NAV2 = 'such as "[[0.3, 0.2], [0.3, -0.2], [-0.3, -0.2], [-0.3, 0.2]]"'
ROUNDING = 1e-9
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def corners_of(text: str) -> tuple[Pair, ...] | str:
    """Return the corners that Nav2 writes as text, none for empty brackets; or the rule that the text breaks.

    Parameters
    ----------
    text : str
        The text.
    """
    words = text.strip()
    if words.replace(" ", "") in ("", "[]"):
        return ()
    inner = re.fullmatch(r"\[(.*)\]", words, re.DOTALL)
    found: list[Pair] = []
    rest = "" if inner is None else inner[1]
    for part in re.findall(r"\[[^\[\]]*\]?|[^\[\],\s]+", rest):
        match = re.fullmatch(rf"\[\s*({_NUMBER})\s*,\s*({_NUMBER})\s*\]", part)
        if match is None or not max(abs(float(match[1])), abs(float(match[2]))) < 1e6:
            return f"be pairs of finite numbers [x, y], but holds {part[:40]}"
        found.append((float(match[1]), float(match[2])))
    if inner is None or not re.fullmatch(r"\s*\[[^\[\]]*\](?:\s*,\s*\[[^\[\]]*\])*\s*", rest):
        return "be pairs [x, y] with commas between them, in brackets"
    return tuple(found) if len(found) >= 3 else "have three corners or more"


def _area(corners: Array) -> float:
    """Return the area of a polygon in m^2, positive counterclockwise."""
    x, y = corners.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1)) if len(corners) else 0.0


def _hull(corners: Array) -> tuple[Pair, ...]:
    """Return the convex hull of points, counterclockwise and without corners on its sides."""
    ordered = sorted({(float(x), float(y)) for x, y in corners})
    size = max((abs(value) for corner in ordered for value in corner), default=0.0)

    def half(places: Iterable[Pair]) -> list[Pair]:
        kept: list[Pair] = []
        for x, y in places:
            while len(kept) > 1:
                (a, b), (c, d) = kept[-2:]
                if (c - a) * (y - b) - (d - b) * (x - a) > ROUNDING * size * size:
                    break
                kept.pop()
            kept.append((x, y))
        return kept[:-1]

    return (*half(ordered), *half(reversed(ordered)))


def _finite(places: Array) -> Array:
    if not np.isfinite(places).all():
        raise InvalidParameterError("places", "be finite", float(places[~np.isfinite(places)][0]))
    return places
