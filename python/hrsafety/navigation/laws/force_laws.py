"""Navigation laws: what turns the state of robot and obstacles into a force."""

from __future__ import annotations

import math
from typing import Literal

from hrsafety import _hrsafety
from hrsafety._arguments import flag, number, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.declared import Law, gain, law

__all__ = ["BorensteinKoren", "GeCui", "Khatib", "Law", "Masoud", "StabilizingMode", "VirtualForceField"]

StabilizingMode = Literal["off", "capped", "full"]


@law("virtual_force_field", "vff", "zeng", color="#000000")
@dataclass(frozen=True, kw_only=True, slots=True)
class VirtualForceField(Law):
    """Virtual force field with a stabilizing force, Zeng (2011), chapter 5.

    In the free region only the attraction ``F_a = K_1 (E - b V)`` acts. In the active region
    of each obstacle a repulsion ``F_Lambda = K_3 (L + b Ld) u`` and a detour force
    ``F_psi = K_5 (psi + b psid) u_psi`` are added (5.4.3, 5.4.5), and once for all of them the
    stabilizing force ``F_L = Omega v_L / |v_L|^2`` where ``Omega > 0`` (5.5.9, with Omega
    corrected). Inside any critical region the field is off and the robot brakes.

    Parameters
    ----------
    attractive_gain : float
        K_1 in N/m.
    repulsive_gain : float
        K_3 in N/m.
    detour_gain : float
        K_5 in N/m^2.
    gain_ratio : float
        b = K_2/K_1 = K_4/K_3 = K_6/K_5 in s: damping of every term.
    stabilizing : {"off", "capped", "full"}
        Whether the stabilizing force acts, and whether its magnitude is capped. The default is
        the mode with the fewest contacts with noisy measurements and among random people;
        ``"off"`` is what the published tables were made with.
    stabilizing_force_cap : float or None
        Cap in N for ``"capped"``; 10 N when no cap is given.
    stabilizing_momentum_cap : float or None
        Cap as a share of the force that would stop the robot within one control period,
        ``share * m |V| / T_s``, for ``"capped"``, instead of a force.
    pass_behind : bool
        Whether people and other moving obstacles are passed behind where robot and goal lie
        on opposite sides of their velocity line; otherwise the shortest turn is taken.
    side_hysteresis : float or None
        Angle in rad, below pi: the side of a detour is kept as long as the angle between goal
        and robot, seen from the obstacle, is larger. ``None``: decided afresh each time.

    Raises
    ------
    InvalidParameterError
        If a gain is negative or not finite, the mode is unknown, a cap is given with another
        mode than ``"capped"``, or both caps are given.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.VirtualForceField(attractive_gain=4.3, gain_ratio=0.68).gains
    (4.3, 20.0, 17.0, 0.68)
    """

    # Bounds: Zeng (2011), appendix C.2.
    attractive_gain: float = gain(3.0, unit="N/m", bounds=(0.0, 50.0), symbol="K_1")
    repulsive_gain: float = gain(20.0, unit="N/m", bounds=(0.0, 200.0), symbol="K_3")
    detour_gain: float = gain(17.0, unit="N/m^2", bounds=(0.0, 500.0), symbol="K_5")
    gain_ratio: float = gain(0.25, unit="s", bounds=(0.0, 3.0), symbol="b")
    stabilizing: StabilizingMode = "capped"
    stabilizing_force_cap: float | None = None
    stabilizing_momentum_cap: float | None = None
    pass_behind: bool = True
    side_hysteresis: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(**{name: number(name, getattr(self, name)) for name in self.GAIN_NAMES})
        optional = ("stabilizing_force_cap", "stabilizing_momentum_cap", "side_hysteresis")
        for name in optional:
            value = getattr(self, name)
            self._set(**{name: None if value is None else number(name, value)})
        self._set(pass_behind=flag("pass_behind", self.pass_behind))
        if self.side_hysteresis is not None and not math.isfinite(self.side_hysteresis):
            raise InvalidParameterError("side_hysteresis", "be None or an angle below pi", self.side_hysteresis)
        native = _hrsafety.Law.virtual_force_field(
            gains=self.gains,
            stabilizing=self.stabilizing,
            stabilizing_force_cap=self.stabilizing_force_cap,
            stabilizing_momentum_cap=self.stabilizing_momentum_cap,
            pass_behind=self.pass_behind,
            side_hysteresis=math.inf if self.side_hysteresis is None else self.side_hysteresis,
        )
        self._set(_native=native)


@law("masoud", color="#332288")
@dataclass(frozen=True, kw_only=True, slots=True)
class Masoud(Law):
    """Circulating repulsion of Masoud (2007).

    ``F = K_1 E + sum (K_3 D + K_5 d t)`` over the obstacles whose active region the robot is in,
    (2.2.8)-(2.2.10) of Zeng (2011): a pull to the goal, a push that grows with the distance and
    a circulation that is always counter-clockwise. Nothing is damped and nothing brakes; what
    bounds the speed is the robot.

    Parameters
    ----------
    attractive_gain : float
        K_1 in N/m.
    repulsive_gain : float
        K_3 in N/m.
    detour_gain : float
        K_5 in N/m.

    Raises
    ------
    InvalidParameterError
        If a gain is negative or not finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> round(nav.simulate(scenarios.configuration("c1"), nav.Masoud()).arrival_time, 2)
    6.34
    """

    attractive_gain: float = gain(5.0, unit="N/m", bounds=(0.0, 50.0), symbol="K_1")
    repulsive_gain: float = gain(24.0, unit="N/m", bounds=(0.0, 200.0), symbol="K_3")
    detour_gain: float = gain(36.0, unit="N/m", bounds=(0.0, 500.0), symbol="K_5")


@law("ge_cui", "gecui", color="#56B4E9")
@dataclass(frozen=True, kw_only=True, slots=True)
class GeCui(Law):
    """Dynamic potential field of Ge and Cui (2002).

    ``F_a = K_1 (E - b V)``, ``F_Lambda = K (1 - ddot/a_max)/(d - r)^2 u`` and
    ``F_psi = -K ddot betadot d/(d - r)^2 t`` with the stopping distance
    ``r = ddot^2/(2 a_max)``, (2.2.11)-(2.2.15) of Zeng (2011): the detour goes along the
    tangential relative velocity while robot and obstacle approach, and against it afterwards.
    Nothing brakes; the force does not know the critical region.

    Parameters
    ----------
    attractive_gain : float
        K_1 in N/m.
    repulsive_gain : float
        K in N m^2, of repulsion and detour.
    gain_ratio : float
        b = K_2/K_1 in s.

    Raises
    ------
    InvalidParameterError
        If a gain is negative or not finite.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> nav.simulate(scenarios.configuration("c2"), nav.GeCui()).outcome
    'collided'
    """

    attractive_gain: float = gain(1.0, unit="N/m", bounds=(0.0, 50.0), symbol="K_1")
    repulsive_gain: float = gain(14.2, unit="N m^2", bounds=(0.0, 200.0), symbol="K")
    gain_ratio: float = gain(0.75, unit="s", bounds=(0.0, 3.0), symbol="b")


@law("khatib", color="#44AA99")
@dataclass(frozen=True, kw_only=True, slots=True)
class Khatib(Law):
    """Artificial potential field of Khatib (1986).

    ``F_a = K_1 (E - b V)`` and ``F_Lambda = K (1/d_s - 1/d_k2)/d_s^2 u``, (2.2.2)-(2.2.3) of Zeng
    (2011), with the distance ``d_s`` of the surfaces and its value ``d_k2`` where the active
    region begins. Surfaces nearer than 1 mm push as at 1 mm. The gains are those that the search of
    appendix C finds for c1, c2 and c4, where c2 fails; with them the robot gives up in c3.

    Parameters
    ----------
    attractive_gain : float
        K_1 in N/m.
    repulsive_gain : float
        K in N m^2; in N s for the printed form.
    gain_ratio : float
        b = K_2/K_1 in s.
    form : {"gradient", "printed"}
        Whether the repulsion goes along the gradient of the distance, as its author has it, or
        against the relative velocity, ``-K (d_k2 - d_s)/d_s^3 Ddot``, as (2.2.3) is printed. The
        printed form pulls at an obstacle that recedes.

    Raises
    ------
    InvalidParameterError
        If a gain is negative or not finite, or the form is unknown.
    """

    attractive_gain: float = gain(23.2, unit="N/m", bounds=(0.0, 50.0), symbol="K_1")
    repulsive_gain: float = gain(20.0, unit="N m^2", bounds=(0.0, 20.0), symbol="K")
    gain_ratio: float = gain(3.0, unit="s", bounds=(0.0, 3.0), symbol="b")
    form: Literal["gradient", "printed"] = "gradient"

    def __post_init__(self) -> None:
        """Check the values."""
        printed = word("form", self.form, ("gradient", "printed")) == "printed"
        self._make(printed=printed)


@law("borenstein_koren", "borenstein", "bk", color="#117733")
@dataclass(frozen=True, kw_only=True, slots=True)
class BorensteinKoren(Law):
    """Virtual force of Borenstein and Koren (1989).

    ``F_a = K_1 u_E`` and ``F_Lambda = K/d_s u``, (2.2.5)-(2.2.6) of Zeng (2011), with the
    distance ``d_s`` of the surfaces. Surfaces nearer than 1 mm push as at 1 mm. The gains are those
    that the search of appendix C finds for c1, c2 and c4, where c2 fails; with them the robot does
    not come past the obstacles of c3.

    Parameters
    ----------
    attractive_gain : float
        K_1 in N.
    repulsive_gain : float
        K in N m.
    attracted_inside : bool
        Whether the goal attracts inside an active region too, as its authors have it; (2.2.6) is
        printed without.

    Raises
    ------
    InvalidParameterError
        If a gain is negative or not finite.
    """

    attractive_gain: float = gain(16.93, unit="N", bounds=(0.0, 50.0), symbol="K_1")
    repulsive_gain: float = gain(14.21, unit="N m", bounds=(0.0, 20.0), symbol="K")
    attracted_inside: bool = True

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(attracted_inside=flag("attracted_inside", self.attracted_inside))
        self._make(attracted_inside=self.attracted_inside)
