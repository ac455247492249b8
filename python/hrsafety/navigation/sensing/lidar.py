"""A 2-D lidar on a navigation robot: scans, and a law that knows walls and people by them alone."""

from __future__ import annotations

import math
from dataclasses import field
from typing import ClassVar

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, checked_seed, count, empty, finite, flag, instance, number, numbers, pair
from hrsafety._bounds import MOST_RAYS
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.sensing.robot_sensor import RobotSensor

__all__ = ["Lidar", "in_meters"]

_OTHER_UNIT = ((10.0, 0.0), (2.0, 0.5))
"""More than such a share of the ranges beyond so many times the largest one is in another unit."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Lidar(RobotSensor):
    """A lidar on a robot, which tells a law of walls and people by its scans.

    A beam reads the exact distance to the nearest thing along it, with Gaussian noise if wanted; ``range_max``
    where nothing is hit, 0 inside of something or nearer than ``range_min``, NaN where it drops out. The points of a
    scan become the few boundary points that a law sees (as `StaticMap.boundary_points`): bodies of radius 0 at rest.
    **What no beam hits is not known to the law**, and a point has no velocity; where a beam drops out, what was seen
    there before stays. Contacts with the map count in runs, see ``map_contact_time`` of `Trajectory`.

    Parameters
    ----------
    map : StaticMap or None
        Walls that it sees.
    beams : int
        Number of beams.
    mounting : (float, float, float)
        Pose on the robot: x ahead and y to the left of its center in m, heading in rad.
    field_of_view : float
        Angle between the first and the last beam in rad; a whole turn is divided evenly.
    angle_min : float or None
        Bearing of the first beam in rad; ``None``: straight ahead of the lidar is the middle of all beams.
    range_min, range_max : float
        Least and largest range in m. What is nearer than the least one is taken to be at it: where that is
        outside of the robot, results carry the warning ``"blind_nearby"``.
    range_noise : float
        Standard deviation of a range in m.
    dropout : float
        Probability with which a beam reads nothing at all.
    latency : float
        Age of scans when they arrive, in s. They are entered with the pose that the robot took itself to have when
        they were made; before the first one nothing is known.
    sees_obstacles : bool
        Whether it sees people and other obstacles of the scene, too.
    kappa : float
        Share behind which boundary points are left out: 1/2 for force laws, 1 for half planes.
    influence : float
        Depth of the active region of a point beyond the radius of the robot, in m; the critical one is 1 mm.
    reach : float or None
        How far from the robot points are reported, in m. ``None``: the active region; planners want more.
    max_speed : float
        Largest speed in m/s of what is seen; above 0 the regions are sized for it in place of ``influence``.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> room = nav.maps.StaticMap.from_polylines([[(-2, -1), (2, -1), (2, 1), (-2, 1), (-2, -1)]])
    >>> lidar = nav.Lidar(map=room, beams=4)
    >>> lidar.scan((0.5, 0.0))
    array([2.5, 1. , 1.5, 1. ])
    """

    NAME: ClassVar[str] = "lidar"
    RANGE: ClassVar[str] = "range_max"

    map: StaticMap | None = None
    beams: int = 360
    mounting: tuple[float, float, float] = (0.0, 0.0, 0.0)
    field_of_view: float = 2.0 * math.pi
    angle_min: float | None = None
    range_min: float = 0.0
    range_max: float = 10.0
    range_noise: float = 0.0
    dropout: float = 0.0
    latency: float = 0.0
    sees_obstacles: bool = True
    kappa: float = 0.5
    influence: float = 0.3
    reach: float | None = None
    max_speed: float = 0.0
    _lidar: _hrsafety.Lidar = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        if self.map is not None:
            instance("map", self.map, StaticMap)
        given = [name for name in ("reach", "angle_min") if getattr(self, name) is not None]
        self._as_numbers(*given)
        mounting = numbers("mounting", self.mounting)
        if mounting.shape != (3,):
            raise ShapeError("mounting", "(3,)", mounting.shape)
        self._set(mounting=tuple(finite("mounting", value) for value in mounting.tolist()))
        names = ("field_of_view", "range_min", "range_max", "range_noise", "dropout", "latency", "kappa", "influence")
        lidar = _hrsafety.Lidar(
            map=None if self.map is None else self.map._native,
            beams=count("beams", self.beams, most=MOST_RAYS),
            sees_obstacles=flag("sees_obstacles", self.sees_obstacles),
            mounting=list(self.mounting),
            reach=self.reach,
            angle_min=self.angle_min,
            **self._as_numbers(*names, "max_speed"),
        )
        self._set(_lidar=lidar, _native=_hrsafety.Sensor.lidar(lidar))

    @property
    def bearings(self) -> Array:
        """Angles of the beams from straight ahead of the lidar in rad, (beams,)."""
        return np.asarray(self._lidar.bearings())

    def scan(
        self, position: npt.ArrayLike, heading: float = 0.0, *, people: npt.ArrayLike = (), seed: int = 0
    ) -> Array:
        """Return the ranges of all beams.

        Parameters
        ----------
        position : array_like, shape (2,)
            Where the robot is, in m.
        heading : float
            Where it looks, in rad.
        people : array_like, shape (n, 3)
            Centers and radii of discs beside the map, in m.
        seed : int
            Of noise and dropouts.

        Returns
        -------
        ndarray, shape (beams,)
            Ranges in m, NaN of beams that drop out.

        Raises
        ------
        InvalidParameterError
            If an argument is not finite or of another shape.
        """
        discs = numbers("people", people).reshape(0, 3) if empty("people", people) else numbers("people", people)
        if discs.ndim != 2 or discs.shape[1] != 3:
            raise ShapeError("people", "(n, 3)", discs.shape)
        if not np.isfinite(discs).all() or (discs[:, 2] <= 0.0).any():
            row = int(np.argmax(~np.isfinite(discs).all(axis=1) | (discs[:, 2] <= 0.0)))
            raise InvalidParameterError(
                f"people[{row}]", "be finite with a positive radius", tuple(discs[row].tolist())
            )
        return np.asarray(self._lidar.scan(_pose(position, heading), discs, checked_seed("seed", seed)))

    def points(self, position: npt.ArrayLike, heading: float, ranges: npt.ArrayLike) -> Array:
        """Return the points that a scan hit.

        Parameters
        ----------
        position : array_like, shape (2,)
            Where the robot takes itself to be, in m.
        heading : float
            Where it takes itself to look, in rad.
        ranges : array_like, shape (beams,)
            Ranges in m, NaN where nothing is known.

        Returns
        -------
        ndarray, shape (n, 2)
            Points in m; beams that hit or read nothing have none, and what was too near to be measured is taken to
            be at the least range.

        Raises
        ------
        InvalidParameterError
            If an argument is not finite or of another shape, or ranges are hardly in m.
        """
        scan = numbers("ranges", ranges)
        if scan.shape != (self.beams,):
            raise ShapeError("ranges", f"({self.beams},)", scan.shape)
        if (scan < 0.0).any():
            raise InvalidParameterError("ranges", "not be negative", float(scan[scan < 0.0][0]))
        return self._lidar.points(_pose(position, heading), in_meters("ranges", scan, self).tolist())


def in_meters(name: str, ranges: Array, lidar: Lidar) -> Array:
    """Return the ranges of a scan; in mm or cm everything would be farther than the lidar sees: free.

    Where nothing was hit, some drivers give one and the same number beyond all others.
    """
    measured = ranges[np.isfinite(ranges)]
    others = measured[measured < measured.max(initial=0.0)]
    for times, share in _OTHER_UNIT:
        beyond = others[others > times * lidar.range_max]
        if beyond.size > share * others.size:
            rule = f"be in m, up to range_max of {lidar.range_max:g}, or infinite where nothing was hit"
            raise InvalidParameterError(name, rule, float(beyond[0]), "mm or cm given for m?")
    return ranges


def _pose(position: object, heading: object) -> tuple[float, float, float]:
    x, y = pair("position", position)
    angle = number("heading", heading)
    for name, value in (("position", x), ("position", y), ("heading", angle)):
        if not math.isfinite(value):
            raise InvalidParameterError(name, "be finite", value)
    return x, y, angle
