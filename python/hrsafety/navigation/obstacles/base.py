"""Base of the obstacles: an active and a critical region."""

from __future__ import annotations

import dataclasses
import functools
from collections.abc import Callable
from typing import Any, Self

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, not_negative, number, positive
from hrsafety.errors import InvalidParameterError

__all__ = ["LIMITS", "Limits", "Obstacle"]

LIMITS = ("active_radius", "critical_radius", "max_speed")
"""The limits that every obstacle may have."""
Limits = tuple[float | None, float | None, float | None]


class Obstacle(Parameters):
    """Base of the obstacles: an active and a critical region.

    A region is given by its radius as in the source, from the center of a disc and from the contour
    of a rectangle to the center of the robot, or by its clearance, between the surfaces of obstacle
    and robot for every shape. What is left ``None`` is computed by a `Scenario` from the limits of
    its robot (see `region_radii`). Given values must obey active > critical >= 0, and a critical
    radius may not be below the distance at which the scenario's robot touches the obstacle.
    """

    __slots__ = ("_given",)  # set only where a scenario filled in radii
    active_radius: float | None
    critical_radius: float | None
    active_clearance: float | None
    critical_clearance: float | None
    max_speed: float | None
    _native: _hrsafety.Obstacle

    def as_given(self) -> Self:
        """Return the obstacle as it was before a scenario filled in the radii of its regions.

        Returns
        -------
        Obstacle
            The obstacle itself if no radius was filled in.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> scene = nav.Scenario(start=(4, 0), goal=(0, 0), obstacles=[nav.Disc(center=(2, 0), radius=0.1)])
        >>> scene.obstacles[0].as_given() == nav.Disc(center=(2, 0), radius=0.1)
        True
        """
        given: Self = getattr(self, "_given", self)
        return given

    def filled_in(self, **radii: float) -> Self:
        """Return the obstacle with the radii that were not given.

        Parameters
        ----------
        **radii : float
            ``active_radius`` and ``critical_radius`` in m.

        Returns
        -------
        Obstacle
            A copy that remembers what was given.
        """
        values = {name: getattr(self, name) for name in _init_names(type(self))}  # type: ignore[arg-type]  # a class
        values |= {name: value for name, value in radii.items() if values[name] is None}
        if self._by_clearance():
            values |= dict.fromkeys(_CLEARANCES.values())
        filled = type(self)(**values)
        object.__setattr__(filled, "_given", self)
        return filled

    def _sized(self, critical_radius: float, active_radius: float) -> Self:
        """Return `filled_in` with radii that the native scenario has found and checked already."""
        filled = object.__new__(type(self))
        for read, write in _slots(type(self)):  # type: ignore[arg-type]  # a class
            write(filled, read(self))
        native = self._native.sized(critical_radius, active_radius)
        filled._set(critical_radius=critical_radius, active_radius=active_radius, _native=native, _given=self)
        return filled

    def _by_clearance(self) -> bool:
        return self.active_clearance is not None or self.critical_clearance is not None

    def contact_distance(self, robot_radius: float) -> float:
        """Return the distance, measured as the radii are, at which a robot touches the obstacle.

        Parameters
        ----------
        robot_radius : float
            Radius of the robot in m.

        Returns
        -------
        float
            Distance in m from the center of a disc or the contour of a rectangle.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.Human(start=(0, 0), velocity=(1, 0)).contact_distance(0.25)
        0.65
        """
        return not_negative("robot_radius", robot_radius) + self._inner_radius()

    def _inner_radius(self) -> float:
        """Return the part of the radii that lies inside the obstacle, in m."""
        return float(getattr(self, "radius", 0.0))

    def radii_from_clearances(self, robot_radius: float) -> dict[str, float]:
        """Return the radii of the regions that were given by clearances.

        Parameters
        ----------
        robot_radius : float
            Radius of the robot in m.

        Returns
        -------
        dict of str to float
            ``active_radius`` and ``critical_radius`` in m, as far as given.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.Disc(center=(0, 0), radius=0.5, critical_clearance=0.25).radii_from_clearances(0.25)
        {'critical_radius': 1.0}
        """
        if not self._by_clearance():
            return {}
        contact = self.contact_distance(robot_radius)
        given = {radius: getattr(self, clearance) for radius, clearance in _CLEARANCES.items()}
        return {radius: contact + clearance for radius, clearance in given.items() if clearance is not None}

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle by public fields; what a scenario filled in is filled in again."""
        given = self.as_given()
        if given is self:
            return super().__reduce__()
        return _filled_in, (given, {name: getattr(self, name) for name in _CLEARANCES})

    def _limits(self) -> Limits:
        """Return the limits in the order of `LIMITS` as checked numbers."""
        if self.active_radius is self.critical_radius is self.max_speed is None:  # nearly always
            limits: Limits = (None, None, None)
        else:
            values = [(name, getattr(self, name)) for name in LIMITS]
            active, critical, speed = [None if value is None else number(name, value) for name, value in values]
            limits = (active, critical, speed)
            self._set(active_radius=active, critical_radius=critical, max_speed=speed)
        if self.active_clearance is not None or self.critical_clearance is not None:
            self._check_clearances()
        return limits

    def _check_clearances(self) -> None:
        """Check clearances, which exclude radii."""
        for radius, clearance in _CLEARANCES.items():
            value = getattr(self, clearance)
            if value is not None:
                check = positive if radius == "active_radius" else not_negative
                self._set(**{clearance: check(clearance, value)})
            if getattr(self, radius) is not None:
                given = next(name for name in _CLEARANCES.values() if getattr(self, name) is not None)
                remedy = "a radius is measured to the center of the robot, a clearance between the surfaces"
                raise InvalidParameterError(radius, f"be None where {given} is given", getattr(self, radius), remedy)
        active, critical = self.active_clearance, self.critical_clearance
        if active is not None and critical is not None and active <= critical:
            raise InvalidParameterError(
                "active_clearance", f"be larger than critical_clearance, {critical:g} m", active
            )


# The clearance that stands for each radius.
_CLEARANCES = {"active_radius": "active_clearance", "critical_radius": "critical_clearance"}


@functools.cache
def _init_names(kind: type[Obstacle]) -> tuple[str, ...]:
    """Return the fields that a class takes; `dataclasses.replace` would look them up for every obstacle."""
    return tuple(each.name for each in dataclasses.fields(kind) if each.init)  # type: ignore[arg-type]  # a dataclass


@functools.cache
def _slots(kind: type[Obstacle]) -> tuple[tuple[Callable[[object], Any], Callable[[object, Any], None]], ...]:
    """Return what reads and writes the fields of a class, for copies that need no second check."""
    members = [getattr(kind, each.name) for each in dataclasses.fields(kind)]  # type: ignore[arg-type]  # a dataclass
    return tuple((member.__get__, member.__set__) for member in members)


def _filled_in(given: Obstacle, radii: dict[str, float]) -> Obstacle:
    return given.filled_in(**radii)
