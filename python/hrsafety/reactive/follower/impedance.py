"""Virtual impedance: repulsion from collision vectors, conventional and active."""

from __future__ import annotations

import math
from dataclasses import field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Pair, Parameters, flag, number, numbers, pair
from hrsafety._records import dataclass
from hrsafety.errors import ShapeError

__all__ = ["VirtualImpedance"]

Form = Literal["off", "conventional", "active", "twice_scaled"]
_NUMBERS = ("stiffness", "damping", "safe_distance", "speed_limit", "filter_time", "largest_rate")


@dataclass(frozen=True, kw_only=True, slots=True)
class VirtualImpedance(Parameters):
    """Repulsion by a virtual spring and damper between the robot and what it senses.

    Force along u = -C/||C|| for a collision vector C; equation numbers of Avi (2019):

    - conventional, (19-a): K_0 (rho_0 - ||C||) + D_0 ||C'|| where ||C|| < rho_0, else 0;
    - active, (20): k_ref exp(-||C||/alpha) ||C|| + d_ref exp(||C'||/beta) (mu_0 - ||C'||) with
      alpha = rho_0/(2 ln(k_ref/K_0)) and beta = mu_0/(2 ln(D_0/d_ref)).

    Parameters
    ----------
    form : str
        ``"active"``, ``"conventional"``, ``"off"``: no repulsion, or ``"twice_scaled"``: (19-b) as
        printed, with the factors of (19-a) once more.
    stiffness, damping : float
        K_0 in N/m, D_0 in N s/m.
    safe_distance : float
        rho_0 in m.
    speed_limit : float
        mu_0 in m/s.
    reference_stiffness, reference_damping : float or None
        k_ref > K_0 in N/m and d_ref < D_0 in N s/m; e K_0 and D_0/e when ``None``.
    clamp : bool
        No damping above mu_0; ``False`` gives the printed law, which pulls there.
    speed : str
        What ||C'|| is: ``"closing"``, max(0, -d||C||/dt), or ``"norm"`` of the vector's change.
    filter_time : float
        Time constant of the filter of the speed, in s.
    largest_rate : float
        Faster changes between two samples are left out, in m/s.
    outlives_gaps : bool
        The estimate of the speed starts anew when the case of a collision vector changes or
        there was no echo for a sample; ``True``: only when the case changes. A speed from before
        a gap has no physical ground, and with it the conventional law touches more standing boxes.
    pairing_gap, pairing_share : float
        Echoes of neighboring sensors make one vector if their points are less than
        gap (m) + share * (smaller reading) apart.
    rotation : str
        From the robot to the world: ``"heading"``, or ``"printed"``: by the printed (15).
    world_start : tuple of float or None
        Adds the position of the sensors to the vector, in a world in which the robot starts here, in
        m: the printed (16).

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> law = reactive.VirtualImpedance()
    >>> law.distance_scale, law.speed_scale
    (0.4, 0.36)
    """

    form: Form = "active"
    stiffness: float = 40.0
    damping: float = 10.0
    safe_distance: float = 0.8
    speed_limit: float = 0.72
    reference_stiffness: float | None = None
    reference_damping: float | None = None
    clamp: bool = True
    speed: Literal["closing", "norm"] = "closing"
    filter_time: float = 0.15
    largest_rate: float = 4.0
    outlives_gaps: bool = False
    pairing_gap: float = 0.5
    pairing_share: float = 0.6
    rotation: Literal["heading", "printed"] = "heading"
    world_start: Pair | None = None
    _native: _hrsafety.VirtualImpedance = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers(*_NUMBERS, "pairing_gap", "pairing_share")
        references = {
            "reference_stiffness": math.e * self.stiffness,
            "reference_damping": self.damping / math.e,
        }
        for name in references:
            if getattr(self, name) is not None:
                references[name] = number(name, getattr(self, name))
        self._set(**{name: value for name, value in references.items() if getattr(self, name) is not None})
        if self.world_start is not None:
            self._set(world_start=pair("world_start", self.world_start))
        self._set(
            _native=_hrsafety.VirtualImpedance(
                form=str(self.form),
                clamp=flag("clamp", self.clamp),
                speed=str(self.speed),
                outlives_gaps=flag("outlives_gaps", self.outlives_gaps),
                rotation=str(self.rotation),
                translated_by=self.world_start,
                **references,
                **values,
            )
        )

    @property
    def distance_scale(self) -> float:
        """Distance alpha in m: at rho_0/2 the spring force is that of K_0, (21)."""
        return float(self._parts(0.0, 0.0)["distance_scale"])

    @property
    def speed_scale(self) -> float:
        """Speed beta in m/s: at mu_0/2 the damping force is that of D_0, (22)."""
        return float(self._parts(0.0, 0.0)["speed_scale"])

    def _parts(self, distance: npt.ArrayLike, speed: npt.ArrayLike) -> dict[str, Any]:
        given = {"distance": numbers("distance", distance), "speed": numbers("speed", speed)}
        try:
            both = np.broadcast_arrays(given["distance"], given["speed"])
        except ValueError:
            raise ShapeError("speed", f"that broadcasts with {given['distance'].shape}", given["speed"].shape) from None
        shape = both[0].shape
        flat = [np.ascontiguousarray(array).reshape(-1) for array in both]
        found = _hrsafety.impedance_forces(self._native, *flat)
        return {name: found[name].reshape(shape) for name in ("spring", "damper")} | {
            name: found[name] for name in ("distance_scale", "speed_scale")
        }

    def spring_force(self, distance: npt.ArrayLike) -> Array:
        """Return the spring part of the repulsion.

        Parameters
        ----------
        distance : array_like
            ||C|| in m.

        Returns
        -------
        ndarray
            In N, positive away from the obstacle.

        Raises
        ------
        InvalidParameterError
            If the distance is not made of numbers.

        Examples
        --------
        Both laws agree at half the safe distance:

        >>> from hrsafety import reactive
        >>> active, conventional = reactive.VirtualImpedance(), reactive.VirtualImpedance(form="conventional")
        >>> round(float(active.spring_force(0.4)), 12), float(conventional.spring_force(0.4))
        (16.0, 16.0)
        """
        found: Array = self._parts(distance, 0.0)["spring"]
        return found

    def damping_force(self, distance: npt.ArrayLike, speed: npt.ArrayLike) -> Array:
        """Return the damping part of the repulsion.

        Parameters
        ----------
        distance : array_like
            ||C|| in m; the conventional law has a damper inside the safe distance only.
        speed : array_like
            ||C'|| in m/s.

        Returns
        -------
        ndarray
            In N, positive away from the obstacle, of the broadcast shape.

        Raises
        ------
        InvalidParameterError
            If an argument is not made of numbers.
        ShapeError
            If the two do not broadcast.

        Examples
        --------
        The printed active law pulls beyond its speed limit:

        >>> from hrsafety import reactive
        >>> law = reactive.VirtualImpedance(clamp=False)
        >>> round(float(law.damping_force(1.0, 1.0)), 1)
        -16.6
        """
        found: Array = self._parts(distance, speed)["damper"]
        return found
