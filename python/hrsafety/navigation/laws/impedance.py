"""Virtual impedance of the sound-following robot as a navigation law with ideal sensing."""

from __future__ import annotations

import math
from typing import Literal

from hrsafety._arguments import number, positive, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.declared import Law, gain, law

__all__ = ["VirtualImpedanceLaw"]

Form = Literal["active", "conventional"]


@law("virtual_impedance", "impedance")
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

    form: Form = "active"
    attraction_stiffness: float = gain(2.0, unit="N/m", bounds=(0.5, 20.0), symbol="K_r")
    attraction_damping: float = gain(1.0, unit="N s/m", bounds=(0.0, 20.0), symbol="D_r")
    stiffness: float = gain(40.0, unit="N/m", bounds=(10.0, 80.0), symbol="K_0")
    damping: float = gain(10.0, unit="N s/m", bounds=(2.0, 30.0), symbol="D_0")
    safe_distance: float = gain(0.8, unit="m", bounds=(0.3, 1.5), symbol="rho_0")
    speed_limit: float = gain(0.72, unit="m/s", bounds=(0.3, 1.5), symbol="mu_0")
    reach: float = 3.0
    view: float = math.pi

    def __post_init__(self) -> None:
        """Check the values."""
        word("form", self.form, ("active", "conventional"))
        self._set(reach=positive("reach", self.reach))
        self._set(view=number("view", self.view))
        if not 0.0 < self.view <= math.pi:
            raise InvalidParameterError("view", "be an angle above 0 and at most pi", self.view)
        self._make(reach=self.reach, view=self.view, active=self.form == "active")
