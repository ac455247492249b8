"""Mobile bases as masses: what a person feels of one that touches at a place in a direction."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, finite, not_negative, pair, positive
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["Base", "DifferentialBase", "HolonomicBase"]

_GYRATIONS = (0.03, 5.0)
# Shares of the mass of a base that wheels with their motors add: the smallest ones of a heavy base, and far too many.
_LEAST_WHEELS = 0.001
_MOST_WHEELS = 10.0
_SIZES = {"base.wheel_radius": "wheel_radius", "base.half_track": "half_track", "base.offset": "axle_offset"}
_NO_WHEELS = (
    "no inertia of wheels and motors given: the mass of a base that rolls is a lower bound, on the unsafe side; give "
    "wheel_inertia (with the motor behind its gear, n^2 J_m), wheel_radius and half_track"
)


def _odd_inertia(mass: float, inertia: float) -> tuple[ResultWarning, ...]:
    """Return the doubt about an inertia that no base of this mass has; a too large one is more careful."""
    least, most = _GYRATIONS
    radius = (inertia / mass) ** 0.5
    if least <= radius <= most:
        return ()
    message = (
        f"the base has a radius of gyration of {radius:.3g} m by inertia and mass, outside the plausible {least:g} to "
        f"{most:g} m: another unit than kg m^2?"
    )
    return (ResultWarning("implausible", "base.inertia", message, safe_side=radius > most),)


def _odd_wheels(base: DifferentialBase) -> Iterator[ResultWarning]:
    """Yield doubts about wheels: none, of another unit, or without the motors that turn them."""
    if base.wheel_inertia == 0.0 or base.wheel_radius is None or base.half_track is None:
        yield ResultWarning("no_motor_inertia", "base.wheel_inertia", _NO_WHEELS)
        return
    sizes = {"wheel_radius": base.wheel_radius, "half_track": base.half_track}
    yield from implausible({f"base.{name}": size for name, size in sizes.items()}, _SIZES)
    share = 2.0 * base.wheel_inertia / base.wheel_radius**2 / base.mass
    if share < _LEAST_WHEELS:
        message = (
            f"wheels make the base heavier by {100.0 * share:.2g} % only, less than {100.0 * _LEAST_WHEELS:g} %: the "
            "inertia of a wheel without motor, of a rotor before its gear, or another unit than kg m^2?"
        )
        yield ResultWarning("armature_suspicious", "base.wheel_inertia", message)
    elif share > _MOST_WHEELS:
        message = f"wheels make the base heavier by {100.0 * share:.3g} %: another unit than kg m^2?"
        yield ResultWarning("implausible", "base.wheel_inertia", message, safe_side=True)


@dataclass(frozen=True, kw_only=True, slots=True)
class HolonomicBase:
    """A base that is free to move any way.

    Parameters
    ----------
    mass : float
        In kg.
    inertia : float
        About the center of mass, in kg m^2.

    Examples
    --------
    >>> from hrsafety import contact
    >>> base = contact.HolonomicBase(mass=4.4, inertia=0.1)
    >>> base.effective_mass((0.2, 0.0), (1.0, 0.0))
    4.4
    """

    mass: float
    inertia: float

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ("mass", "inertia"):
            object.__setattr__(self, name, positive(f"base.{name}", getattr(self, name)))

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why masses of the base may not be what they seem."""
        return _odd_inertia(self.mass, self.inertia)

    def effective_mass(self, point: Pair, direction: Pair) -> float:
        """Return 1/(1/M + (x u_y - y u_x)^2/I).

        Parameters
        ----------
        point : tuple of two floats
            About the center of mass, x forward, in m.
        direction : tuple of two floats
            Horizontal, of any length.

        Returns
        -------
        float
            In kg.
        """
        return _hrsafety.contact_holonomic_mass(
            mass=self.mass, inertia=self.inertia, point=pair("point", point), direction=pair("direction", direction)
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class DifferentialBase:
    """A base on two wheels that do not slip.

    Parameters
    ----------
    mass : float
        In kg.
    inertia : float
        About the center of mass, in kg m^2.
    offset : float
        Center of mass ahead of the axle, in m.
    wheel_inertia : float
        Of each wheel with its motor behind the gear, in kg m^2; 0: massless, so that masses are lower bounds.
    wheel_radius, half_track : float or None
        In m, needed with a wheel inertia.

    Examples
    --------
    >>> from hrsafety import contact
    >>> base = contact.DifferentialBase(
    ...     mass=20.0, inertia=0.8, offset=0.05, wheel_inertia=0.001, wheel_radius=0.08, half_track=0.2
    ... )
    >>> round(base.effective_mass((0.2, 0.1), (0.8, 0.6)), 5)
    29.97354
    """

    mass: float
    inertia: float
    offset: float = 0.0
    wheel_inertia: float = 0.0
    wheel_radius: float | None = None
    half_track: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ("mass", "inertia"):
            object.__setattr__(self, name, positive(f"base.{name}", getattr(self, name)))
        object.__setattr__(self, "offset", finite("base.offset", self.offset))
        object.__setattr__(self, "wheel_inertia", not_negative("base.wheel_inertia", self.wheel_inertia))
        for name in ("wheel_radius", "half_track"):
            given = getattr(self, name)
            if given is None and self.wheel_inertia > 0.0:
                raise InvalidParameterError(f"base.{name}", "be given with a wheel inertia", None)
            if given is not None:
                object.__setattr__(self, name, positive(f"base.{name}", given))

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why masses of the base may not be what they seem: without the inertia of its wheels they are too low."""
        ahead = implausible({"base.offset": abs(self.offset)}, _SIZES)
        return (*_odd_inertia(self.mass, self.inertia), *ahead, *_odd_wheels(self))

    def effective_mass(self, point: Pair, direction: Pair) -> float:
        """Return the mass at a point about the middle of the axle; inf where the base cannot move.

        Parameters
        ----------
        point : tuple of two floats
            About the middle of the axle, x forward, in m.
        direction : tuple of two floats
            Horizontal, of any length.

        Returns
        -------
        float
            In kg.
        """
        drive = (self.offset, self.wheel_inertia, self.wheel_radius or 1.0, self.half_track or 1.0)
        return _hrsafety.contact_differential_mass(
            mass=self.mass,
            inertia=self.inertia,
            drive=drive,
            point=pair("point", point),
            direction=pair("direction", direction),
        )


Base = HolonomicBase | DifferentialBase
