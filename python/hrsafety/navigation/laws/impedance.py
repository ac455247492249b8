"""Virtual impedance of the sound-following robot as a navigation law with ideal sensing."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import ClassVar, Literal

from hrsafety import _hrsafety
from hrsafety._arguments import number, positive, word
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.force_laws import Law

__all__ = ["VirtualImpedanceLaw"]

Form = Literal["active", "conventional"]


@dataclass(frozen=True, kw_only=True, slots=True)
class VirtualImpedanceLaw(Law):
    """Virtual impedance, conventional or active, with every obstacle known exactly.

    A spring and a damper pull to the goal, ``F_m = K_r E - D_r V``; every obstacle within reach
    pushes along its collision vector C, from the surface of the robot to the nearest point of the
    obstacle, by the laws (19-a) and (20) that `hrsafety.reactive.VirtualImpedance` has, with
    k_ref = e K_0 and d_ref = D_0/e. The speed is that of closing, max(0, -d||C||/dt). Where the
    robot of the source has three noisy cones, this one knows the nearest point of everything around
    it, or in a sector around its direction of motion; the law knows no regions and does not brake. As
    the active law pushes at any distance, it may stand before what is between it and the goal.

    Parameters
    ----------
    form : {"active", "conventional"}
        The law.
    attraction_stiffness, attraction_damping : float
        K_r in N/m, D_r in N s/m.
    stiffness, damping : float
        K_0 in N/m, D_0 in N s/m.
    safe_distance : float
        rho_0 in m.
    speed_limit : float
        mu_0 in m/s.
    reach : float
        Obstacles whose surface is farther away are not sensed, in m; that of the source's sensors.
    view : float
        Half of the sensed sector around the direction of motion in rad, above 0 and at most pi, which
        is all around; pi/4 for the three cones of the source. Standing still, it looks to the goal.

    Raises
    ------
    InvalidParameterError
        If a number is not finite, negative, or zero where it must not be, or the form is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> nav.simulate(scenarios.configuration("parallel_human"), nav.VirtualImpedanceLaw()).outcome
    'arrived'
    """

    GAIN_NAMES: ClassVar[tuple[str, ...]] = (
        "attraction_stiffness",
        "attraction_damping",
        "stiffness",
        "damping",
        "safe_distance",
        "speed_limit",
    )
    GAIN_BOUNDS: ClassVar[Mapping[str, tuple[float, float]]] = MappingProxyType(
        {
            "attraction_stiffness": (0.5, 20.0),
            "attraction_damping": (0.0, 20.0),
            "stiffness": (10.0, 80.0),
            "damping": (2.0, 30.0),
            "safe_distance": (0.3, 1.5),
            "speed_limit": (0.3, 1.5),
        }
    )
    GAIN_UNITS: ClassVar[Mapping[str, str]] = MappingProxyType(
        {
            "attraction_stiffness": "N/m",
            "attraction_damping": "N s/m",
            "stiffness": "N/m",
            "damping": "N s/m",
            "safe_distance": "m",
            "speed_limit": "m/s",
        }
    )

    form: Form = "active"
    attraction_stiffness: float = 2.0
    attraction_damping: float = 1.0
    stiffness: float = 40.0
    damping: float = 10.0
    safe_distance: float = 0.8
    speed_limit: float = 0.72
    reach: float = 3.0
    view: float = math.pi
    _native: _hrsafety.Law = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        word("form", self.form, ("active", "conventional"))
        self._set(reach=positive("reach", self.reach))
        self._set(view=number("view", self.view))
        if not 0.0 < self.view <= math.pi:
            raise InvalidParameterError("view", "be an angle above 0 and at most pi", self.view)
        numbers = self._as_numbers(*self.GAIN_NAMES)
        native = _hrsafety.Law.virtual_impedance(
            **numbers, reach=self.reach, view=self.view, active=self.form == "active"
        )
        self._set(_native=native)
