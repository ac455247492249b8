"""Mobile robots: mass, shape, limits, wheels."""

from __future__ import annotations

from dataclasses import field, fields
from functools import cache

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, Parameters, instance, number, sequence
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.robots.footprint import Footprint

__all__ = ["DifferentialDriveRobot", "HolonomicRobot"]

Triple = tuple[float, float, float]
RADIUS = 0.2
"""Radius of the robots of Zeng (2011) in m, the default of every disc."""


def _of_wheels(name: str, value: object, wheels: int) -> tuple[float, ...]:
    """Return a number for each wheel, or say what it should have been."""
    rule = f"be {('two', 'three')[wheels - 2]} numbers, one for each wheel"
    parts = sequence(name, rule, value)
    if len(parts) != wheels:
        raise InvalidParameterError(name, rule, value)
    return tuple(number(name, part) for part in parts)


def _shape(radius: object, footprint: object) -> dict[str, object]:
    """Return radius and footprint of a robot, as far as they are told otherwise than they are kept."""
    if footprint is None:
        return {}
    if isinstance(footprint, int | float) and not isinstance(footprint, bool):
        given = number("footprint", footprint)
        if radius is not RADIUS and radius != given:
            raise InvalidParameterError("radius", "be left out where the footprint is a radius", radius)
        return {"radius": given, "footprint": None}
    outline = footprint
    if isinstance(footprint, str):
        outline = Footprint.parse(footprint)
    elif not isinstance(footprint, Footprint):
        corners = sequence("footprint", "be a Footprint, text, corners or a radius", footprint)
        try:
            outline = Footprint(tuple(corners))
        except InvalidParameterError as error:
            raise InvalidParameterError("footprint", error.requirement, error.value, error.remedy) from None
    around = instance("footprint", outline, Footprint).outer_radius
    if radius is not RADIUS and (not isinstance(radius, int | float) or abs(radius - around) > ROUNDING):
        rule = f"be left out beside a footprint, whose circle has a radius of {around:.6g} m"
        raise InvalidParameterError("radius", rule, radius, f"give radius={around!r} where another robot is copied")
    return {"radius": around, "footprint": outline}


def least_reach(robot: HolonomicRobot | DifferentialDriveRobot) -> float:
    """Return the radius of the largest circle around the center that a robot covers, in m.

    Parameters
    ----------
    robot : HolonomicRobot or DifferentialDriveRobot
        The robot.
    """
    return robot.radius if robot.footprint is None else robot.footprint.inner_radius


ROUNDING = 1e-9
"""Difference of radii that rounding explains, in m."""

NUMBERS = (
    *("mass", "radius", "max_speed", "max_acceleration", "max_deceleration"),
    *("max_angular_acceleration", "max_turn_rate", "max_turn_acceleration"),
)
"""Numbers of robots that have plausible ranges; not every robot has all of them."""


def _limits(robot: object, *names: str) -> dict[str, float | None]:
    """Return limits that a robot may have, by name."""
    given = {name: getattr(robot, name) for name in names}
    return {name: None if value is None else number(name, value) for name, value in given.items()}


@dataclass(frozen=True, kw_only=True, slots=True)
class HolonomicRobot(Parameters):
    """Three-wheel robot that can accelerate in any direction.

    The motion is that of a point mass with limited speed and acceleration; the wheels give
    the motor currents, by (D.1.4) and (D.3.2) of Zeng (2011), and so the energy. Defaults are
    the robot of that thesis.

    Parameters
    ----------
    mass : float
        Mass M_r in kg.
    radius : float
        Radius of the disc that models the robot, in m; of a robot with a footprint that of the circle around it, which
        is all that laws know of it.
    max_speed : float
        Largest speed, in m/s.
    max_acceleration : float
        Largest acceleration, in m/s^2.
    max_deceleration : float or None
        Largest deceleration, in m/s^2: a change of velocity against the motion lies in the half ellipse with this
        half axis along the motion and `max_acceleration` across it. ``None``: as `max_acceleration`. Laws and shields
        that look ahead count on the smaller one of the two for changes in any direction.
    wheel_radius : float
        Wheel radius r_w in m. The default is a calibration of the published energies, see
        `winding_resistance`.
    winding_resistance : float
        Effective winding resistance R_a in ohm. The thesis gives no value; 4.86 ohm together
        with a wheel radius of 0.10 m fits its 16 printed energies best (rms 0.52 J). Energy
        scores need ratios only and do not depend on it.
    wheel_inertia : tuple of float
        Feed-forward J/K of each wheel, in A s^2.
    wheel_viscous_friction : tuple of float
        Feed-forward B/K of each wheel, in A s.
    wheel_static_friction : tuple of float
        Feed-forward tau/K of each wheel, in A.
    footprint : Footprint, str, sequence of (float, float), float or None
        Convex outline at its heading, in place of a disc: contacts, clearances and the `Shield` are those of the
        polygon, a `Guide` keeps half of its width from walls. Text is a footprint as Nav2 writes it; a number is a
        ``radius``.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, or negative or zero where it must not be.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.HolonomicRobot().max_speed
    0.7
    """

    mass: float = 4.4
    radius: float = RADIUS
    max_speed: float = 0.7
    max_acceleration: float = 10.0
    max_deceleration: float | None = None
    wheel_radius: float = 0.10
    winding_resistance: float = 4.86
    wheel_inertia: Triple = (0.0073, 0.0074, 0.0065)
    wheel_viscous_friction: Triple = (0.0019, 0.0020, 0.0024)
    wheel_static_friction: Triple = (0.19, 0.22, 0.18)
    footprint: Footprint | None = None
    _native: _hrsafety.HolonomicRobot = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(**_shape(self.radius, self.footprint))
        scalars = ("mass", "radius", "max_speed", "max_acceleration", "wheel_radius")
        self._set(**{name: number(name, getattr(self, name)) for name in scalars})
        self._set(winding_resistance=number("winding_resistance", self.winding_resistance))
        self._set(**_limits(self, "max_deceleration"))
        wheels = ("wheel_inertia", "wheel_viscous_friction", "wheel_static_friction")
        self._set(**{name: _of_wheels(name, getattr(self, name), 3) for name in wheels})
        self._set(
            _native=_hrsafety.HolonomicRobot(
                None if self.footprint is None else self.footprint._native,
                mass=self.mass,
                radius=self.radius,
                max_speed=self.max_speed,
                max_acceleration=self.max_acceleration,
                max_deceleration=self.max_deceleration,
                wheel_radius=self.wheel_radius,
                winding_resistance=self.winding_resistance,
                wheel_inertia=self.wheel_inertia,
                wheel_viscous_friction=self.wheel_viscous_friction,
                wheel_static_friction=self.wheel_static_friction,
            )
        )

    @property
    def deceleration(self) -> float:
        """Deceleration in m/s^2 that it brakes with at most: `max_deceleration`, or `max_acceleration` without one."""
        return self.max_acceleration if self.max_deceleration is None else self.max_deceleration

    @property
    def guaranteed_acceleration(self) -> float:
        """Acceleration in m/s^2 that it has in every direction: the smaller one of acceleration and deceleration."""
        return min(self.max_acceleration, self.deceleration)


@dataclass(frozen=True, kw_only=True, slots=True)
class DifferentialDriveRobot(Parameters):
    """Two-wheel robot that has to turn before it can go sideways.

    A law drives a point mass with the same mass, size and acceleration and a share of the speed;
    the robot follows it, Zeng (2011), section 7.2. The force is computed at the position and
    velocity of the robot itself. `region_radii` sizes the regions with the time that the robot
    needs to turn. Defaults are the robot of chapter 7 and Table E.2 of that thesis; limits that are ``None`` leave it
    as it is there: it turns at up to 5 rad/s, more than most robots among people may. Limits hold for what
    the wheels are told; wheels with controllers (`AsBuilt`) may overshoot.

    Parameters
    ----------
    mass : float
        Mass in kg.
    radius : float
        Radius of the disc that models the robot, in m; of a robot with a footprint that of the circle around it, which
        is all that laws know of it.
    max_speed : float
        Largest speed, in m/s.
    max_acceleration : float
        Largest acceleration, in m/s^2.
    max_deceleration : float or None
        Largest deceleration, in m/s^2. ``None``: as `max_acceleration`. Laws and shields that look ahead count on the
        smaller one of the two for changes in any direction.
    max_angular_acceleration : float
        Largest angular acceleration alpha_max that the motors can give, in rad/s^2.
    max_turn_rate : float or None
        Largest turn rate, in rad/s. ``None``: only what the wheels can give, 2 V/l, at which they run at the largest
        speed against each other; that limits it beside a number, too.
    max_turn_acceleration : float or None
        Largest change of the turn rate, in rad/s^2, beside `max_angular_acceleration`: the smaller one holds. ``None``:
        that alone.
    reference_speed_share : float
        Share of the largest speed that the point mass may use, above 0 and at most 1. At 1 the
        robot has no speed left to catch up with it.
    wheel_radius : float
        Wheel radius r_w in m.
    wheel_span : float
        Span l between the driven wheels in m.
    winding_resistance : float
        Winding resistance R_a in ohm; the default is that of the motor's datasheet. The thesis gives
        no value, but the printed H, T, L and d of Tables 7.1 to 7.3 imply free runs of 1.95, 1.86
        and 1.91 J, and with the default a free run takes 1.95 J. Energy scores need ratios only and
        do not depend on it.
    wheel_inertia : tuple of float
        Feed-forward J/K of each wheel, in A s^2.
    wheel_viscous_friction : tuple of float
        Feed-forward B/K of each wheel, in A s.
    wheel_static_friction : tuple of float
        Feed-forward tau/K of each wheel, in A.
    footprint : Footprint, str, sequence of (float, float), float or None
        Convex outline at its heading, in place of a disc: contacts, clearances and the `Shield` are those of the
        polygon, a `Guide` keeps half of its width from walls. Text is a footprint as Nav2 writes it; a number is a
        ``radius``.

    Raises
    ------
    InvalidParameterError
        If a value is not finite, or negative or zero where it must not be, or the share is above 1.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.DifferentialDriveRobot().mass
    3.7
    """

    mass: float = 3.7
    radius: float = RADIUS
    max_speed: float = 0.7
    max_acceleration: float = 10.0
    max_deceleration: float | None = None
    max_angular_acceleration: float = 70.0
    max_turn_rate: float | None = None
    max_turn_acceleration: float | None = None
    reference_speed_share: float = 0.9
    wheel_radius: float = 0.025
    wheel_span: float = 0.28
    winding_resistance: float = 1.16
    wheel_inertia: Pair = (0.0079, 0.0057)
    wheel_viscous_friction: Pair = (0.0032, 0.0030)
    wheel_static_friction: Pair = (0.18, 0.28)
    footprint: Footprint | None = None
    _native: _hrsafety.DifferentialDriveRobot = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(**_shape(self.radius, self.footprint))
        wheels = ("wheel_inertia", "wheel_viscous_friction", "wheel_static_friction")
        self._set(**{name: _of_wheels(name, getattr(self, name), 2) for name in wheels})
        limits = _limits(self, "max_deceleration", "max_turn_rate", "max_turn_acceleration")
        self._set(**limits)
        others = (item.name for item in fields(self) if item.init and item.name not in (*wheels, *limits, "footprint"))
        scalars = self._as_numbers(*others)
        self._set(
            _native=_hrsafety.DifferentialDriveRobot(
                None if self.footprint is None else self.footprint._native,
                **scalars,
                **limits,
                wheel_inertia=self.wheel_inertia,
                wheel_viscous_friction=self.wheel_viscous_friction,
                wheel_static_friction=self.wheel_static_friction,
            )
        )

    @property
    def deceleration(self) -> float:
        """Deceleration in m/s^2 that it brakes with at most: `max_deceleration`, or `max_acceleration` without one."""
        return self.max_acceleration if self.max_deceleration is None else self.max_deceleration

    @property
    def guaranteed_acceleration(self) -> float:
        """Acceleration in m/s^2 that it has in every direction: the smaller one of acceleration and deceleration."""
        return min(self.max_acceleration, self.deceleration)


@cache
def _default_two_wheels() -> DifferentialDriveRobot:
    """Return the default two-wheel robot, which is made once."""
    return DifferentialDriveRobot()


def two_wheels(robot: object) -> DifferentialDriveRobot:
    """Return ``robot`` if it has two wheels, the default one for ``None``."""
    return _default_two_wheels() if robot is None else instance("robot", robot, DifferentialDriveRobot)
