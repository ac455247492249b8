"""Static maps: walls, polygons, discs and occupancy grids."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import field
from os import PathLike
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, empty, instance, not_negative, number, numbers, pair, points, word
from hrsafety._doubts import checked_doubts
from hrsafety._records import dataclass
from hrsafety.errors import ShapeError
from hrsafety.navigation.maps.barn import barn_discs
from hrsafety.navigation.maps.distances import occupied_cells
from hrsafety.navigation.maps.map_server import doubts_of_place, read_map_server
from hrsafety.navigation.maps.parts import (
    Cells,
    PolylineWall,
    checked_finite,
    checked_place,
    checked_points,
    checked_wall,
    corners_of,
    counted,
    in_parts,
    items,
    outline,
)
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.plausibility import ResultWarning, telling

__all__ = ["StaticMap"]


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class StaticMap(Parameters):
    """Map of standing obstacles: walls, filled polygons, filled discs, occupancy grids.

    Everything becomes segments with a radius, and filled interiors. Distances are exact, and zero
    inside; an index makes them fast. Maps are added with ``+``.

    Parameters
    ----------
    walls : sequence of PolylineWall or (points, radius)
        Polylines with a radius in m.
    polygons : sequence of array_like, shape (n, 2)
        Corners of filled polygons in m; the first one is not repeated at the end.
    discs : array_like, shape (n, 3)
        Centers and radii of filled discs, in m.
    grids : sequence of Cells
        Occupancy grids; see `from_grid`.
    warnings : sequence of ResultWarning
        Why the map may not be what it seems to; runs in it carry them.

    Raises
    ------
    InvalidParameterError
        If a number is not finite, a radius or resolution is out of range, a wall has no length, a polygon has
        fewer than three corners or touches or crosses itself, or there are too many segments.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> walls = nav.maps.StaticMap.from_polylines([[(0, 0), (6, 0), (6, 4)]])
    >>> pillar = nav.maps.StaticMap(discs=[(1.5, 1.5, 0.3)])
    >>> (walls + pillar).clearance([(3.0, 0.5), (1.5, 1.5)])
    array([0.5, 0. ])
    """

    walls: Sequence[PolylineWall] = ()
    polygons: Sequence[npt.ArrayLike] = ()
    discs: npt.ArrayLike = ()
    grids: Sequence[Cells] = ()
    warnings: Sequence[ResultWarning] = field(default=(), compare=False)
    _native: _hrsafety.StaticMap = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        walls = [checked_wall(f"walls[{i}]", wall) for i, wall in enumerate(items("walls", self.walls))]
        polygons = [points(f"polygons[{i}]", each) for i, each in enumerate(items("polygons", self.polygons))]
        discs = (
            numbers("discs", self.discs).reshape(0, 3) if empty("discs", self.discs) else numbers("discs", self.discs)
        )
        if discs.ndim != 2 or discs.shape[1] != 3:
            raise ShapeError("discs", "(n, 3)", discs.shape)
        grids = [instance(f"grids[{i}]", each, Cells) for i, each in enumerate(items("grids", self.grids))]
        self._set(
            warnings=checked_doubts("warnings", self.warnings),
            walls=tuple(PolylineWall(outline(corners), radius) for corners, radius in walls),
            polygons=tuple(outline(corners) for corners in polygons),
            discs=tuple((float(x), float(y), float(radius)) for x, y, radius in discs),
            grids=tuple(grids),
            _native=_hrsafety.StaticMap(
                polylines=walls,
                polygons=polygons,
                discs=discs,
                grids=[(each.occupied, each.resolution, each.origin, each.yaw, each.limits) for each in grids],
            ),
        )

    # ---- sources --------------------------------------------------------------------------------

    @classmethod
    def from_polylines(cls, polylines: Iterable[npt.ArrayLike], *, radius: float = 0.0) -> Self:
        """Return a map of walls along polylines.

        Parameters
        ----------
        polylines : iterable of array_like, shape (n, 2)
            Corners in m.
        radius : float
            Half the thickness of the walls in m, round at their ends.

        Returns
        -------
        StaticMap
            The map.

        Raises
        ------
        InvalidParameterError
            If a number is not finite, the radius is negative, or a polyline has no length.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.maps.StaticMap.from_polylines([[(3, -1.5), (3, 1.5)]], radius=0.1)
        StaticMap(1 wall, x 2.9 to 3.1 m, y -1.6 to 1.6 m)
        """
        thickness = not_negative("radius", radius)
        each = items("polylines", polylines)
        lines = [points(f"polylines[{i}]", line) for i, line in enumerate(each)]
        return cls(walls=[PolylineWall(outline(line), thickness) for line in lines])

    @classmethod
    def from_polygons(cls, polygons: Iterable[npt.ArrayLike]) -> Self:
        """Return a map of filled polygons.

        Parameters
        ----------
        polygons : iterable of array_like, shape (n, 2)
            Corners in m, in either sense; the first one is not repeated at the end.

        Returns
        -------
        StaticMap
            The map.

        Raises
        ------
        InvalidParameterError
            If a polygon has fewer than three corners, or touches or crosses itself.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.maps.StaticMap.from_polygons([[(0, 0), (2, 0), (1, 1)]]).clearance([1.0, 0.5])
        0.0
        """
        return cls(polygons=tuple(items("polygons", polygons)))

    @classmethod
    def from_obstacles(cls, obstacles: Iterable[Disc | Rectangle]) -> Self:
        """Return a map of discs and rectangles that stand.

        Parameters
        ----------
        obstacles : iterable of Disc or Rectangle
            What stands.

        Returns
        -------
        StaticMap
            The map.

        Raises
        ------
        InvalidParameterError
            If something else is among them.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> table = nav.Rectangle(center=(2.0, 0.0), length=1.0, width=0.5)
        >>> nav.maps.StaticMap.from_obstacles([table, nav.Disc(center=(0.0, 2.0), radius=0.5)]).clearance((0.0, 0.0))
        1.5
        """
        each = items("obstacles", obstacles)
        kept = [instance(f"obstacles[{i}]", given, Disc, Rectangle) for i, given in enumerate(each)]
        discs = [(*given.center, given.radius) for given in kept if isinstance(given, Disc)]
        boxes = [corners_of(given) for given in kept if isinstance(given, Rectangle)]
        return cls(polygons=boxes, discs=discs)

    @classmethod
    @telling()
    def from_grid(
        cls,
        occupied: npt.ArrayLike,
        *,
        resolution: float,
        origin: tuple[float, float] = (0.0, 0.0),
        yaw: float = 0.0,
        outside: str = "free",
    ) -> Self:
        """Return the map of an occupancy grid.

        Parameters
        ----------
        occupied : array_like of bool, shape (rows, columns)
            Which cells are occupied; row 0 has the lowest y.
        resolution : float
            Side of a cell in m.
        origin : (float, float)
            Lower left corner of the first cell, in m.
        yaw : float
            Angle by which the grid is turned around it, in rad.
        outside : {"free", "unknown"}
            What lies outside of the grid. A guide plans no way through what is unknown, unless its box is given.

        Returns
        -------
        StaticMap
            The map; the boundary between occupied and free cells are its walls. A resolution outside 0.005 to 1 m
            and a yaw beyond one turn are ``implausible`` in its warnings.

        Raises
        ------
        InvalidParameterError
            If the cells are no truth values or too many, or a number is out of range.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> room = nav.maps.StaticMap.from_grid([[1, 1, 1], [1, 0, 1], [1, 1, 1]], resolution=1.0)
        >>> room.clearance((1.5, 1.25))
        0.25
        """
        cells = occupied_cells("occupied", occupied)
        rows, columns = cells.shape
        size, turned = number("resolution", resolution), number("yaw", yaw)
        limits = word("outside", outside, ("free", "unknown")) == "unknown"
        bits = np.packbits(cells).tobytes()
        corner = pair("origin", origin)
        grid = Cells(bits, (rows, columns), size, corner, turned, limits)
        return cls(grids=[grid], warnings=doubts_of_place(size, corner, turned))

    @classmethod
    @telling()
    def from_map_server(
        cls,
        path: str | PathLike[str],
        *,
        unknown: str = "occupied",
        outside: str = "unknown",
        rule: str = "saved",
        occupied_from: int | None = None,
        trust_path: bool = False,
    ) -> Self:
        """Return the map that a YAML file of the ROS map server describes, with its image.

        With ``p = (255 - x)/255`` of the gray value ``x`` (scaled to 0 to 255), or ``x/255`` with ``negate``, a cell
        is occupied for ``p >= occupied_thresh``, free for ``p < free_thresh``, else unknown (``mode: trinary``) or in
        between (``mode: scale``); with ``mode: raw`` the gray value is the occupancy from 0 to 100, and unknown above.
        What is not opaque is unknown, and so is the gray 205 that map savers write for unknown cells, also where
        ``free_thresh: 0.25`` makes it free.

        Parameters
        ----------
        path : path
            The YAML file, in block or flow style. Its image, PGM with up to 16 bits or PNG (with Pillow), is read from
            the same folder or one below.
        unknown : {"occupied", "free"}
            What unknown cells count as.
        outside : {"unknown", "free"}
            What lies outside of the image. A guide plans no way through what is unknown, unless its box is given.
        rule : {"saved", "nav2"}
            Whether the gray 205 stays unknown, or the file is followed by the letter, as Nav2 does: free for
            ``p <= free_thresh``.
        occupied_from : int or None
            Occupancy from 1 to 100 from which a cell in between counts as occupied; ``None``: all of them do.
        trust_path : bool
            Whether the image may lie in another folder.

        Returns
        -------
        StaticMap
            The map, at the origin and yaw of the file. Its warnings: ``unknown_gray`` and ``unknown_ground`` with the
            share of cells, ``between_counts_as_occupied``, ``mask_as_map``, ``trailing_bytes``, and ``implausible`` for
            a resolution outside 0.005 to 1 m or a yaw beyond one turn.

        Raises
        ------
        InvalidParameterError
            If a file cannot be read, a key is missing, stands twice or is out of range, or the image is of another
            kind or size.
        MissingExtraError
            If the image is PNG and Pillow is not installed.
        """
        limits = word("outside", outside, ("unknown", "free")) == "unknown"
        read = read_map_server(path, unknown=unknown, rule=rule, occupied_from=occupied_from, trust_path=trust_path)
        bits = np.packbits(read.occupied).tobytes()
        unseen = b"" if read.unseen is None else np.packbits(read.unseen).tobytes()
        grid = Cells(bits, read.occupied.shape, read.resolution, read.origin, read.yaw, limits, unseen)
        return cls(grids=[grid], warnings=read.warnings)

    @classmethod
    def from_barn(cls, source: str | PathLike[str] | Mapping[str, Any], world: int) -> Self:
        """Return a world of the Benchmark for Autonomous Robot Navigation (BARN).

        Parameters
        ----------
        source : path or mapping
            A file of worlds in JSON, or what was read from it: ``cylinder_radius_m``, and ``worlds`` with
            ``id`` and ``cyl_mm`` (centers in mm) of each.
        world : int
            Number of the world.

        Returns
        -------
        StaticMap
            The cylinders of the world as discs.

        Raises
        ------
        InvalidParameterError
            If the file cannot be read, is no such file, or has no world of this number.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> worlds = {"cylinder_radius_m": 0.075, "worlds": [{"id": 6, "cyl_mm": [[-75, 75], [-225, 75]]}]}
        >>> nav.maps.StaticMap.from_barn(worlds, 6)
        StaticMap(2 discs, x -0.3 to 0 m, y 0 to 0.15 m)
        """
        return cls(discs=barn_discs(source, world))

    # ---- queries --------------------------------------------------------------------------------

    def clearance(self, point: npt.ArrayLike) -> Any:
        """Return the distance of points from the map.

        Parameters
        ----------
        point : array_like, shape (2,) or (n, 2)
            One point or several, in m.

        Returns
        -------
        float or ndarray, shape (n,)
            Distances in m: zero inside, infinite for an empty map.

        Raises
        ------
        InvalidParameterError
            If the points are no points.
        """
        found = in_parts(self._native.clearance, checked_points(point))
        return float(found[0]) if np.ndim(point) == 1 else found

    def segment_clearance(self, start: npt.ArrayLike, end: npt.ArrayLike) -> float:
        """Return the least distance of the points of a segment from the map.

        Parameters
        ----------
        start, end : array_like, shape (2,)
            Its ends in m.

        Returns
        -------
        float
            The distance in m, zero where it meets something.

        Raises
        ------
        InvalidParameterError
            If an end is no point.
        """
        return self._native.segment_clearance(checked_place("start", start), checked_place("end", end))

    def nearest(self, point: npt.ArrayLike) -> Array:
        """Return the boundary points nearest to points.

        Parameters
        ----------
        point : array_like, shape (2,) or (n, 2)
            One point or several, in m.

        Returns
        -------
        ndarray, shape (2,) or (n, 2)
            Points of the boundary in m, NaN for an empty map.

        Raises
        ------
        InvalidParameterError
            If the points are no points.
        """
        found = in_parts(self._native.nearest, checked_points(point))
        return found[0] if np.ndim(point) == 1 else found

    def ray(self, start: npt.ArrayLike, bearing: npt.ArrayLike) -> Any:
        """Return how far a ray goes until it hits something.

        Parameters
        ----------
        start : array_like, shape (2,)
            Where the rays start, in m.
        bearing : array_like, shape () or (n,)
            Their angles from the x axis in rad.

        Returns
        -------
        float or ndarray, shape (n,)
            Distances in m: zero inside, infinite where nothing is hit.

        Raises
        ------
        InvalidParameterError
            If an argument is not finite.
        """
        begin, bearings = checked_place("start", start), checked_finite("bearing", numbers("bearing", bearing))
        found = in_parts(lambda part: self._native.ray(begin, part.tolist()), bearings.ravel())
        return float(found[0]) if bearings.ndim == 0 else found.reshape(bearings.shape)

    def boundary_points(self, point: npt.ArrayLike, *, reach: float, kappa: float = 0.5) -> Array:
        """Return the few boundary points that a law sees from a point, the nearest first.

        ``b_1`` is the nearest boundary point; every one with ``n_1.(b - P) >= kappa d_1`` is left out, the next
        is the nearest of what is left, and so on. Cutting a wall into pieces changes nothing.

        Parameters
        ----------
        point : array_like, shape (2,)
            The position ``P`` in m.
        reach : float
            How far points may be away, in m.
        kappa : float
            Above 0 and at most 1; 1/2 for force laws, 1 for half planes that span the convex free region.

        Returns
        -------
        ndarray, shape (n, 2)
            At most eight points in m.

        Raises
        ------
        InvalidParameterError
            If an argument is out of range.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> corridor = nav.maps.StaticMap.from_polylines([[(0, 0), (9, 0)], [(0, 2), (9, 2)]])
        >>> corridor.boundary_points((4.0, 0.5), reach=3.0)
        array([[4., 0.],
               [4., 2.]])
        """
        place = checked_place("point", point)
        return self._native.boundary_points(place, not_negative("reach", reach), number("kappa", kappa))

    def unseen(self, point: npt.ArrayLike) -> Any:
        """Return whether points are unobserved: unknown cells, and what lies outside of the image.

        Parameters
        ----------
        point : array_like, shape (2,) or (n, 2)
            One point or several, in m.

        Returns
        -------
        bool or ndarray of bool, shape (n,)
            Whether it is unknown and not counted as occupied.

        Raises
        ------
        InvalidParameterError
            If the points are no points.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> room = nav.maps.StaticMap.from_grid([[0, 0], [0, 1]], resolution=1.0, outside="unknown")
        >>> room.unseen([(0.5, 0.5), (2.5, 0.5)])
        array([False,  True])
        """
        places = checked_points(point)
        found = ~np.array(in_parts(self._native.knows, places), dtype=np.bool_)
        for grid in self.grids:
            found |= grid.unseen_at(places)
        return bool(found[0]) if np.ndim(point) == 1 else found

    @property
    def segments(self) -> Array:
        """All segments with their radii, rows (x, y, x, y, radius) in m, (n, 5)."""
        return self._native.segments()

    @property
    def bounds(self) -> tuple[tuple[float, float], tuple[float, float]] | None:
        """Lower and upper corner of the box around everything in m, ``None`` for an empty map."""
        found = self._native.bounds()
        if found is None:
            return None
        (left, low), (right, high) = found
        return (left, low), (right, high)

    def __add__(self, other: StaticMap) -> StaticMap:
        """Return everything in both maps."""
        if not isinstance(other, StaticMap):
            return NotImplemented
        names = ("walls", "polygons", "discs", "grids")
        joined: dict[str, Any] = {name: (*getattr(self, name), *getattr(other, name)) for name in names}
        return StaticMap(**joined, warnings=tuple(dict.fromkeys((*self.warnings, *other.warnings))))

    def __repr__(self) -> str:
        """Return what is in the map and how far it reaches."""
        counts = {"wall": self.walls, "polygon": self.polygons, "disc": self.discs, "grid": self.grids}
        parts = [counted(word, len(each)) for word, each in counts.items() if len(each)]  # type: ignore[arg-type]  # arrays have a length
        if self.bounds is None:
            return "StaticMap(nothing)"
        (left, low), (right, high) = self.bounds
        parts += [f"x {left + 0.0:g} to {right + 0.0:g} m", f"y {low + 0.0:g} to {high + 0.0:g} m"]
        return f"StaticMap({', '.join(parts)})"
