"""Foam design: which stiffness and damping keep the limits, and how fast the manipulator may be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, instance, not_negative
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.boundaries import (
    AnyHead,
    FoamBoundary,
    Impact,
    Requirement,
    boundary,
    check_damping,
    check_head,
    check_impact,
    requirement,
)
from hrsafety.impact.limits import FoamFeasibility, FoamLimits, FoamMargin
from hrsafety.impact.parameters import ConstrainedHead, Foam, Head, Manipulator

__all__ = ["FoamDesign", "design_foam"]

# Limits that are judged with the heavy head.
_FORCE_LIKE = ("peak_contact_force", "max_compression")
# Limits that make an upper and a lower boundary of the stiffness.
_AGAINST_STIFFNESS = ("peak_head_acceleration_g", "peak_contact_force", "hic15", "hic36")
_AGAINST_SOFTNESS = ("max_compression",)

# Range of foam damping that a design looks at when none is given, in N s/m.
DEFAULT_DAMPING = np.linspace(0.0, 300.0, 61)


@dataclass(frozen=True, kw_only=True, slots=True)
class FoamDesign:
    """A manipulator, limits and a closing speed, ready for questions; made by `design_foam`.

    Attributes
    ----------
    manipulator : Manipulator
        What hits.
    limits : FoamLimits
        What has to be kept.
    closing_speed : float
        v_c in m/s.
    acceleration_head : Head
        Head for acceleration and injury criteria.
    force_head : Head or ConstrainedHead
        Head for force and compression.
    horizon : float or None
        As for `metrics`.
    """

    manipulator: Manipulator
    limits: FoamLimits
    closing_speed: float
    acceleration_head: Head
    force_head: AnyHead
    horizon: float | None = None

    def _boundary(self, names: Sequence[str], damping: npt.ArrayLike, *, upper: bool) -> FoamBoundary:
        impact = Impact(self.closing_speed, self.horizon)
        return boundary(self.manipulator, self._requirements(names), damping, impact, upper=upper)

    def _requirements(self, names: Sequence[str] | None = None) -> list[Requirement]:
        """Return limits with their heads, all or those of some names."""
        return [
            requirement(name, limit, self.force_head if name in _FORCE_LIKE else self.acceleration_head)
            for name, limit in self.limits.given().items()
            if names is None or name in names
        ]

    def upper(self, damping: npt.ArrayLike) -> FoamBoundary:
        """Return the stiffness up to which acceleration, force and injury criteria are kept.

        Parameters
        ----------
        damping : array_like
            C_c in N s/m.

        Returns
        -------
        FoamBoundary
            Of the shape of damping.

        Raises
        ------
        InvalidParameterError
            If a damping is negative, or no such limit is set.
        """
        return self._boundary(_AGAINST_STIFFNESS, damping, upper=True)

    def lower(self, damping: npt.ArrayLike) -> FoamBoundary:
        """Return the stiffness from which on the compression is kept.

        Parameters
        ----------
        damping : array_like
            C_c in N s/m.

        Returns
        -------
        FoamBoundary
            Of the shape of damping.

        Raises
        ------
        InvalidParameterError
            If a damping is negative, or no limit of compression is set.
        """
        return self._boundary(_AGAINST_SOFTNESS, damping, upper=False)

    def margin(self, foam: Foam) -> FoamMargin:
        """Return what a foam leaves of each limit.

        Parameters
        ----------
        foam : Foam
            Its stiffness and damping count.

        Returns
        -------
        FoamMargin
            Shares of the limits.

        Examples
        --------
        >>> from hrsafety import impact
        >>> design = impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.25)
        >>> round(design.margin(impact.FOAM_2).max_compression, 3)
        -0.202
        """
        ratios = _hrsafety.foam_ratios(
            self.manipulator._native,
            self._requirements(),
            instance("foam", foam, Foam)._native,
            closing_speed=self.closing_speed,
            horizon=self.horizon,
        )
        left = {name: 1.0 - ratio for name, ratio in zip(self.limits.given(), ratios, strict=True)}
        return FoamMargin(
            **{each.name: left.get(each.name, math.nan) for each in fields(self.limits)}, least=min(left.values())
        )

    def accepts(self, foam: Foam) -> bool:
        """Return whether a foam keeps all limits.

        Parameters
        ----------
        foam : Foam
            Its stiffness and damping count.

        Returns
        -------
        bool
            Whether no limit is exceeded.

        Examples
        --------
        >>> from hrsafety import impact
        >>> design = impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.25)
        >>> [design.accepts(foam) for foam in (impact.FOAM_1, impact.FOAM_2, impact.FOAM_3)]
        [True, False, False]
        """
        return self.margin(foam).least >= 0.0

    def max_closing_speed(self, damping: float) -> float:
        """Return the largest closing speed at which some stiffness keeps all limits.

        Parameters
        ----------
        damping : float
            C_c in N s/m.

        Returns
        -------
        float
            In m/s.

        Raises
        ------
        InvalidParameterError
            If the damping is negative or not finite.

        Examples
        --------
        >>> from hrsafety import impact
        >>> design = impact.design_foam(impact.MANIPULATOR_1, impact.FoamLimits(), closing_speed=1.25)
        >>> round(design.max_closing_speed(71.9), 5)
        1.91113
        """
        return float(self._fastest(np.array([not_negative("damping", damping)]))[0][0])

    def feasibility(self, damping: npt.ArrayLike = DEFAULT_DAMPING) -> FoamFeasibility:
        """Return whether some foam keeps all limits, and if not how fast the impact may be.

        Parameters
        ----------
        damping : array_like
            C_c that are looked at, in N s/m.

        Returns
        -------
        FoamFeasibility
            With the foam that allows the largest closing speed.

        Raises
        ------
        InvalidParameterError
            If a damping is negative or not finite, or there is none.

        Examples
        --------
        >>> from hrsafety import impact
        >>> design = impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.7)
        >>> found = design.feasibility([71.9])
        >>> found.feasible, round(found.slow_down, 4)
        (False, 0.0746)
        """
        given = check_damping(damping).ravel()
        if not given.size:
            raise InvalidParameterError("damping", "hold at least one number", damping)
        speeds, stiffness = self._fastest(given)
        best = int(np.argmax(speeds))
        speed = float(speeds[best])
        return FoamFeasibility(
            feasible=speed >= self.closing_speed,
            max_closing_speed=speed,
            slow_down=max(0.0, self.closing_speed - speed),
            damping=float(given[best]),
            stiffness=float(stiffness[best]),
        )

    def _fastest(self, damping: Array) -> tuple[Array, Array]:
        """Return the largest closing speed and its stiffness for each damping."""
        found = _hrsafety.foam_fastest(
            self.manipulator._native,
            self._requirements(),
            damping,
            closing_speed=self.closing_speed,
            horizon=self.horizon,
        )
        return found["closing_speed"], found["stiffness"]


def design_foam(
    manipulator: Manipulator,
    limits: FoamLimits,
    *,
    closing_speed: float,
    acceleration_head: Head | None = None,
    force_head: Head | ConstrainedHead | None = None,
    horizon: float | None = None,
) -> FoamDesign:
    """Return a design that answers which foams keep the limits (flowchart of Fig. 3.20 of Zeng 2011).

    Parameters
    ----------
    manipulator : Manipulator
        What hits.
    limits : FoamLimits
        What has to be kept.
    closing_speed : float
        v_c in m/s, positive.
    acceleration_head : Head or None
        Head for acceleration and injury criteria; ``Head.minimum()`` when ``None``.
    force_head : Head, ConstrainedHead or None
        Head for force and compression; ``Head.maximum()`` when ``None``.
    horizon : float or None
        As for `metrics`.

    Returns
    -------
    FoamDesign
        With `FoamDesign.feasibility`, boundaries, margins and largest closing speeds.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    >>> from hrsafety import impact
    >>> design = impact.design_foam(impact.MANIPULATOR_1, impact.FoamLimits(), closing_speed=1.25)
    >>> design.accepts(impact.FOAM_1), design.feasibility([71.9]).feasible
    (True, True)
    """
    speed, end = check_impact(closing_speed, horizon)
    return FoamDesign(
        manipulator=instance("manipulator", manipulator, Manipulator),
        limits=instance("limits", limits, FoamLimits),
        closing_speed=speed,
        acceleration_head=(
            Head.minimum() if acceleration_head is None else instance("acceleration_head", acceleration_head, Head)
        ),
        force_head=Head.maximum() if force_head is None else check_head("force_head", force_head),
        horizon=end,
    )
