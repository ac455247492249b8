"""How a two-wheel robot follows a reference, or a force with a torque of its own."""

from __future__ import annotations

from dataclasses import field
from typing import Annotated, Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, Parameters, flag, instance, number, pair, positive, word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, two_wheels

__all__ = [
    "ExponentialTracking",
    "FullSpeedTracking",
    "NonlinearTracking",
    "Tracking",
    "Twist",
    "VirtualTorque",
]

ErrorFrame = Literal["robot", "world"]
ReferenceTurn = Literal["derivative", "printed"]


@dataclass(frozen=True, kw_only=True, slots=True)
class FullSpeedTracking(Parameters):
    """Tracking that holds up to the full speed of the robot.

    The robot drives along U = V_d + K_p (P_d - P) and turns toward it: with alpha the angle from
    the heading to U, v = abs(U) max(cos(alpha), 0) and omega = omega_d cos(alpha) + K_h alpha.
    V_d and omega_d are the velocity of the reference and its turn rate. The robot never drives
    backward. Stable as long as neither gain times the control period exceeds 1.

    Parameters
    ----------
    position_gain : float
        K_p in 1/s.
    heading_gain : float
        K_h in 1/s.

    Raises
    ------
    InvalidParameterError
        If a gain is not finite and positive.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.tracking.FullSpeedTracking()
    FullSpeedTracking(position_gain=2.0, heading_gain=6.0)
    """

    position_gain: float = 2.0
    heading_gain: float = 6.0
    _native: _hrsafety.Tracking = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(_native=_hrsafety.Tracking.full_speed(**self._as_numbers("position_gain", "heading_gain")))


@dataclass(frozen=True, kw_only=True, slots=True)
class NonlinearTracking(Parameters):
    """The tracking law (7.2.2)-(7.2.3) of Zeng (2011), after Klancar and Skrjanc (2007).

    v = v_d cos(phi_e) + K_x x_e and omega = omega_d + K_y y_e + K_phi phi_e with
    omega_n = sqrt(omega_d^2 + k v_d^2), K_x = K_phi = 2 xi omega_n and K_y = k v_d. It has no gain
    toward a reference that stands, and may drive backward.

    Parameters
    ----------
    damping_ratio : float
        xi; between 0 and 1 in the source.
    gain : float
        k in rad^2/m^2.
    error_frame : {"robot", "world"}
        Axes of x_e and y_e: ahead and to the left of the robot, or those of the world, as
        printed.
    reference_turn : {"derivative", "printed"}
        omega_d as the turn rate of the reference's velocity, limited to what the robot can turn,
        or as printed, phi_e over the control period.

    Raises
    ------
    InvalidParameterError
        If a gain is not finite and positive or a word is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.tracking.NonlinearTracking().damping_ratio
    0.95
    """

    damping_ratio: float = 0.95
    gain: float = 10.0
    error_frame: ErrorFrame = "robot"
    reference_turn: ReferenceTurn = "derivative"
    _native: _hrsafety.Tracking = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._as_numbers("damping_ratio", "gain")
        self._set(
            _native=_hrsafety.Tracking.nonlinear(
                damping_ratio=self.damping_ratio,
                gain=self.gain,
                error_frame=word("error_frame", self.error_frame, get_args(ErrorFrame)),
                reference_turn=word("reference_turn", self.reference_turn, get_args(ReferenceTurn)),
            )
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class ExponentialTracking(Parameters):
    """Tracking as `FullSpeedTracking`; near the goal exponentially to it.

    Within ``capture_radius`` of the goal the robot leaves the reference. With rho the distance to
    the goal, delta its bearing, alpha = delta - phi and theta = delta - ``goal_heading``:
    v = K_rho rho max(cos(alpha), 0), at most the speed limit, and with r = v / rho
    omega = K_alpha alpha + r sin(alpha) + K_theta r theta sin(alpha) / alpha, both scaled
    together where the turn rate is limited. After Aicardi et al. (1995), here without driving
    backward. The goal phase knows no obstacles; a run with obstacles permits it outside their
    active regions only.

    Parameters
    ----------
    position_gain, heading_gain : float
        K_p and K_h of `FullSpeedTracking` in 1/s, used before.
    distance_gain : float
        K_rho in 1/s: the rate at which the distance falls.
    bearing_gain : float
        K_alpha in 1/s.
    orientation_gain : float
        K_theta, without unit.
    goal_heading : float or None
        Heading at the goal in rad; any when ``None``.
    capture_radius : float
        Distance from the goal at which the goal phase begins, in m; it ends beyond twice of it.
        May be infinite.
    rest_radius : float
        Distance at which the robot stands, in m.

    Raises
    ------
    InvalidParameterError
        If a value is not finite and positive; the radius of capture may be infinite, the
        orientation gain zero.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav
    >>> parking = nav.tracking.ExponentialTracking(goal_heading=0.0)
    >>> line = nav.tracking.LineReference(start=(0.0, 0.0))
    >>> run = nav.tracking.track(line, parking, position=(1.0, 1.0), heading=2.0, goal=(0.0, 0.0))
    >>> bool(run.error[-1] < 1e-5), round(float(np.cos(run.heading[-1])), 6)
    (True, 1.0)
    """

    position_gain: float = 2.0
    heading_gain: float = 6.0
    distance_gain: float = 1.5
    bearing_gain: float = 4.0
    orientation_gain: float = 1.5
    goal_heading: float | None = None
    capture_radius: float = 0.5
    rest_radius: float = 1e-6
    _native: _hrsafety.Tracking = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        gains = ("position_gain", "heading_gain", "distance_gain", "bearing_gain", "orientation_gain")
        values = self._as_numbers(*gains, "capture_radius", "rest_radius")
        if self.goal_heading is not None:
            self._as_numbers("goal_heading")
        self._set(_native=_hrsafety.Tracking.exponential(**values, goal_heading=self.goal_heading))


Tracking = FullSpeedTracking | NonlinearTracking | ExponentialTracking
"""The tracking laws."""


@displayed
class Twist(NamedTuple):
    """Velocity that two wheels can give.

    Attributes
    ----------
    speed : float
        Forward speed v in m/s.
    turn_rate : float
        Turn rate omega in rad/s, counter-clockwise.
    """

    speed: Annotated[float, "m/s"]
    turn_rate: Annotated[float, "rad/s"]


@dataclass(frozen=True, kw_only=True, slots=True)
class VirtualTorque(Parameters):
    """Torque that turns the robot toward the force, (2.2.7) of Zeng (2011).

    M_phi = K_BT Y with Y the angle from the heading to the force. It turns a disc with the mass
    and radius of the robot, J = m rho^2 / 2, against a damping torque, and the force along the
    heading moves the robot: J domega/dt = M_phi - c omega, m dv/dt = F . h. The part of the force
    across the heading is lost. The source gives neither gain nor inertia nor damping; without
    damping the heading oscillates for ever.

    Parameters
    ----------
    torque_gain : float
        K_BT in N m/rad. The default gives the robot of chapter 7 (J = 0.074 kg m^2) the angular
        frequency sqrt(K_BT / J) = 6 rad/s, which is the heading gain of `FullSpeedTracking`.
    damping_ratio : float
        c / (2 sqrt(J K_BT)); 1 is critical, 0 none.
    backward : bool
        Whether the force may drive the robot backward.

    Raises
    ------
    InvalidParameterError
        If the gain is not finite and positive or the damping ratio is negative.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> round(nav.tracking.VirtualTorque().torque((0.0, 2.0), heading=0.0), 3)
    4.185
    """

    torque_gain: float = 2.664
    damping_ratio: float = 1.0
    backward: bool = False
    _native: _hrsafety.VirtualTorque = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers("torque_gain", "damping_ratio")
        self._set(backward=flag("backward", self.backward))
        self._set(_native=_hrsafety.VirtualTorque(**values, backward=self.backward))

    @classmethod
    def tuned(cls, robot: DifferentialDriveRobot, *, frequency: float = 6.0) -> VirtualTorque:
        """Return the critically damped torque that gives a robot an angular frequency in rad/s."""
        body = instance("robot", robot, DifferentialDriveRobot)
        gain = _hrsafety.VirtualTorque.gain_for(body._native, positive("frequency", frequency))
        return cls(torque_gain=gain)

    def torque(self, force: npt.ArrayLike, *, heading: float) -> float:
        """Return M_phi in N m for a force in N and a heading in rad; 0 for no force."""
        return self._native.torque(_finite("heading", heading), _finite_pair("force", force))

    def command(
        self,
        force: npt.ArrayLike,
        *,
        heading: float,
        speed: float = 0.0,
        turn_rate: float = 0.0,
        robot: DifferentialDriveRobot | None = None,
        control_period: float = 0.06,
    ) -> Twist:
        """Return the twist to ask for over the next control period, within the limits of the robot.

        Parameters
        ----------
        force : array_like, shape (2,)
            Force of a law in N.
        heading : float
            Heading in rad.
        speed, turn_rate : float
            Motion now, in m/s and rad/s.
        robot : DifferentialDriveRobot or None
            The robot; that of the source when ``None``.
        control_period : float
            In s.

        Returns
        -------
        Twist
            Speed and turn rate.

        Raises
        ------
        InvalidParameterError
            If a number is not finite or the period not positive.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> nav.tracking.VirtualTorque().command((3.7, 0.0), heading=0.0)
        Twist(speed=0.06, turn_rate=0.0)
        """
        body = two_wheels(robot)
        wish = self._native.command(
            body._native,
            force=_finite_pair("force", force),
            heading=number("heading", heading),
            speed=number("speed", speed),
            turn_rate=number("turn_rate", turn_rate),
            control_period=positive("control_period", control_period),
        )
        return Twist(*wish)


def _finite(name: str, value: object) -> float:
    given = number(name, value)
    if not np.isfinite(given):
        raise InvalidParameterError(name, "be finite", value)
    return given


def _finite_pair(name: str, value: object) -> Pair:
    given = pair(name, value)
    if not np.isfinite(given).all():
        raise InvalidParameterError(name, "be finite", given)
    return given
