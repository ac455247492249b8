"""Discs and rectangles that stand."""

from __future__ import annotations

from dataclasses import field

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, assign, number, pair
from hrsafety._records import dataclass
from hrsafety.navigation.obstacles.base import LIMITS, Obstacle

__all__ = ["Disc", "Rectangle"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Disc(Obstacle):
    """A disc that stands still.

    Parameters
    ----------
    center : tuple of float
        Position (x, y) of the centre, in m.
    radius : float
        Radius in m.
    active_radius, critical_radius : float or None
        Radii r_2 and r_3 of the active and critical region around the centre, in m; computed
        by the scenario when ``None``.
    active_clearance, critical_clearance : float or None
        The same regions measured between the surfaces of obstacle and robot, in m; instead of the
        radii.
    max_speed : float or None
        Speed that the regions are sized for, in m/s; ``None`` means 0.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, a radius is not positive, or active_radius is not larger
        than critical_radius.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Disc(center=(2.45, 0.595), radius=0.1, active_radius=0.8, critical_radius=0.4).radius
    0.1
    """

    center: Pair
    radius: float
    active_radius: float | None = None
    critical_radius: float | None = None
    active_clearance: float | None = None
    critical_clearance: float | None = None
    max_speed: float | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        center, radius = pair("center", self.center), number("radius", self.radius)
        if center is not self.center or radius is not self.radius:
            self._set(center=center, radius=radius)
        active, critical, speed = self._limits()
        native = _hrsafety.Obstacle.disc(
            center=center, radius=radius, active_radius=active, critical_radius=critical, max_speed=speed
        )
        assign(self, "_native", native)


@dataclass(frozen=True, kw_only=True, slots=True)
class Rectangle(Obstacle):
    """A rectangle that stands still, at any heading.

    Its regions are measured from the contour, not from the centre.

    Parameters
    ----------
    center : tuple of float
        Position (x, y) of the centroid, in m.
    length, width : float
        Sides in m; ``length`` lies along ``heading``.
    heading : float
        Angle of the length to the x axis, in rad.
    active_radius, critical_radius : float or None
        Distances r_2 and r_3 of the borders of the active and critical region from the
        contour, in m; computed by the scenario when ``None``.
    active_clearance, critical_clearance : float or None
        The same regions measured between the surfaces of obstacle and robot, in m; instead of the
        radii.
    max_speed : float or None
        Must be ``None`` or 0: a rectangle does not move.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, a side is not positive, or active_radius is not larger than
        critical_radius.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Rectangle(center=(2.3, 0.0), length=1.4, width=0.6).heading
    0.0
    """

    center: Pair
    length: float
    width: float
    heading: float = 0.0
    active_radius: float | None = None
    critical_radius: float | None = None
    active_clearance: float | None = None
    critical_clearance: float | None = None
    max_speed: float | None = None
    _native: _hrsafety.Obstacle = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        center = pair("center", self.center)
        sides = {name: number(name, getattr(self, name)) for name in ("length", "width", "heading")}
        self._converted(center=center, **sides)
        limits = dict(zip(LIMITS, self._limits(), strict=True))
        assign(self, "_native", _hrsafety.Obstacle.rectangle(center=center, **sides, **limits))
