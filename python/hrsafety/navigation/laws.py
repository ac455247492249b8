"""Navigation laws: what turns the state of robot and obstacles into a force."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import ClassVar, Literal

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters, flag, number
from hrsafety.errors import InvalidParameterError

__all__ = ["StabilizingMode", "VirtualForceField"]

StabilizingMode = Literal["off", "capped", "full"]


@dataclass(frozen=True, kw_only=True, slots=True)
class VirtualForceField(Parameters):
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

    GAIN_NAMES: ClassVar[tuple[str, ...]] = (
        "attractive_gain",
        "repulsive_gain",
        "detour_gain",
        "gain_ratio",
    )

    attractive_gain: float = 3.0
    repulsive_gain: float = 20.0
    detour_gain: float = 17.0
    gain_ratio: float = 0.25
    stabilizing: StabilizingMode = "capped"
    stabilizing_force_cap: float | None = None
    stabilizing_momentum_cap: float | None = None
    pass_behind: bool = True
    side_hysteresis: float | None = None
    _native: _hrsafety.VirtualForceField = field(init=False, repr=False, compare=False)

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
        native = _hrsafety.VirtualForceField(
            gains=self.gains,
            stabilizing=self.stabilizing,
            stabilizing_force_cap=self.stabilizing_force_cap,
            stabilizing_momentum_cap=self.stabilizing_momentum_cap,
            pass_behind=self.pass_behind,
            side_hysteresis=math.inf if self.side_hysteresis is None else self.side_hysteresis,
        )
        self._set(_native=native)

    @property
    def gains(self) -> tuple[float, float, float, float]:
        """The gains in the order of `GAIN_NAMES`."""
        return (self.attractive_gain, self.repulsive_gain, self.detour_gain, self.gain_ratio)
