"""Foam design: which stiffness and damping keep the limits, and how fast the manipulator may be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Annotated

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, instance, not_negative, number, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
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
from hrsafety.impact.criteria.loads import check_speeds, speed_warnings
from hrsafety.impact.limits import FoamFeasibility, FoamLimits, FoamMargin
from hrsafety.impact.parameters import (
    THICKNESS,
    ConstrainedHead,
    Foam,
    Head,
    Manipulator,
    default_linear_range,
)
from hrsafety.plausibility import ResultWarning, telling, unsafe_doubts

__all__ = ["FoamDesign", "design_foam"]

# Limits that are judged with the heavy head.
_FORCE_LIKE = ("peak_contact_force", "max_compression")
# Limits that make an upper and a lower boundary of the stiffness.
_AGAINST_STIFFNESS = ("peak_head_acceleration_g", "peak_contact_force", "hic15", "hic36")
_AGAINST_SOFTNESS = ("max_compression",)
# Share of every limit that advice leaves by default.
DEFAULT_MARGIN = 0.1
# The core's word for the compression until the foam rebounds, also after the impact period.
_OF_CONTACT = "contact_compression"

# Range of foam damping that a design looks at when none is given, in N s/m.
DEFAULT_DAMPING = np.linspace(0.0, 300.0, 61)


@displayed
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
    linear_range : float
        Compression in m up to which a foam that is looked for is linear; one that is given has its own.
    """

    manipulator: Manipulator
    limits: FoamLimits
    closing_speed: Annotated[float, "m/s"]
    acceleration_head: Head
    force_head: AnyHead
    horizon: float | None = None
    linear_range: float = default_linear_range(THICKNESS)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Numbers that are hardly what was meant: of the manipulator, the limits, the heads and the speed."""
        parts = self.manipulator.warnings + self.limits.warnings
        heads = self.acceleration_head.warnings + self.force_head.warnings
        return tuple(dict.fromkeys(parts + heads + speed_warnings(self.closing_speed)))

    def _boundary(self, names: Sequence[str], damping: npt.ArrayLike, *, upper: bool) -> FoamBoundary:
        impact = Impact(self.closing_speed, self.horizon)
        found = boundary(self.manipulator, self._requirements(names), damping, impact, upper=upper)
        return replace(found, warnings=self.warnings)

    def _requirements(self, names: Sequence[str] | None = None) -> list[Requirement]:
        """Return limits with their heads, all or those of some names."""
        return [
            requirement(name, limit, self.force_head if name in _FORCE_LIKE else self.acceleration_head)
            for name, limit in self.limits.given().items()
            if names is None or name in names
        ]

    def _with_linear_range(self, linear_range: float, margin: float) -> list[Requirement]:
        """Return the limits less a margin, and the linear range for every head that loads are taken from.

        Loads beyond the linear range are wrong, so that it binds with the head of acceleration, too.
        """
        kept = [(name, (1.0 - margin) * limit, head) for name, limit, head in self._requirements()]
        accelerations = set(self.limits.given()) - set(_FORCE_LIKE)
        heads = [self.force_head, *([self.acceleration_head] if accelerations else [])]
        most = min(linear_range, self.limits.max_compression or math.inf)
        return kept + [requirement(_OF_CONTACT, (1.0 - margin) * most, head) for head in heads]

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
        """Return what a foam leaves of each limit, and whether it stays in its linear range.

        Parameters
        ----------
        foam : Foam
            All its numbers count.

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
        checked = instance("foam", foam, Foam)
        # The limits as they are, and the range as it is: the smaller of both is for advice.
        limits = self._requirements()
        contacts = [
            (name, checked.linear_range, head)
            for name, _, head in self._with_linear_range(checked.linear_range, 0.0)[len(limits) :]
        ]
        ratios = _hrsafety.foam_ratios(
            self.manipulator._native,
            limits + contacts,
            checked._native,
            closing_speed=self.closing_speed,
            horizon=self.horizon,
        )
        left = {name: 1.0 - ratio for name, ratio in zip(self.limits.given(), ratios, strict=False)}
        depth = max(ratios[len(limits) :])
        least = min(left.values())
        found = FoamMargin(
            **{each.name: left.get(each.name, math.nan) for each in fields(self.limits)},
            least=min(least, 1.0 - depth) if depth > 1.0 else least,
        )
        found.linear_range = 1.0 - depth
        if depth * checked.linear_range > checked.thickness:
            found.status = "bottomed"
        elif depth > 1.0:
            found.status = "beyond_linear_range"
        elif least < 0.0:
            found.status = "exceeded"
        elif unsafe_doubts((*self.warnings, *checked.warnings)):
            found.status = "not_checked"
        return found

    def accepts(self, foam: Foam, margin: float = 0.0) -> bool:
        """Return whether a foam keeps all limits and stays in its linear range.

        Parameters
        ----------
        foam : Foam
            All its numbers count.
        margin : float
            Share of every limit, and of the linear range, that has to be left.

        Returns
        -------
        bool
            Whether the status of the margin is ``"kept"``.

        Examples
        --------
        >>> from hrsafety import impact
        >>> design = impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.25)
        >>> [design.accepts(foam) for foam in (impact.FOAM_1, impact.FOAM_2, impact.FOAM_3)]
        [True, False, False]
        """
        left = self.margin(foam)
        return left.status == "kept" and min(left.least, left.linear_range) >= check_margin(margin)

    def max_closing_speed(self, damping: float, margin: float = 0.0) -> float:
        """Return the largest closing speed at which some stiffness keeps all limits and the linear range.

        Parameters
        ----------
        damping : float
            C_c in N s/m.
        margin : float
            Share of every limit that has to be left.

        Returns
        -------
        float
            In m/s; 0 if no foam does at any speed.

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
        given = np.array([not_negative("damping", damping)])
        return float(self._fastest(given, check_margin(margin))[0][0])

    def feasibility(self, damping: npt.ArrayLike = DEFAULT_DAMPING, margin: float = DEFAULT_MARGIN) -> FoamFeasibility:
        """Return whether some foam keeps all limits with a margin, and if not how fast the impact may be.

        Such a foam is stiff enough to give back within `linear_range`, whether compression is limited or
        not: without that the softest foam, or none at all, would be the best.

        Parameters
        ----------
        damping : array_like
            C_c that are examined, in N s/m.
        margin : float
            Share of every limit, and of the linear range, that has to be left.

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
        >>> found = design.feasibility([71.9], margin=0.0)
        >>> found.feasible, round(found.slow_down, 4)
        (False, 0.0746)
        """
        given = check_damping(damping).ravel()
        if not given.size:
            raise InvalidParameterError("damping", "hold at least one number", damping)
        speeds, stiffness = self._fastest(given, check_margin(margin))
        best = int(np.argmax(speeds))
        speed = float(speeds[best])
        return FoamFeasibility(
            feasible=speed >= self.closing_speed,
            max_closing_speed=speed,
            slow_down=max(0.0, self.closing_speed - speed),
            damping=float(given[best]),
            stiffness=float(stiffness[best]),
        )

    def stiffness_range(self, damping: npt.ArrayLike, margin: float = DEFAULT_MARGIN) -> tuple[Array, Array]:
        """Return the least and the largest stiffness that keep all limits with a margin.

        The foam gives back within the smaller of `linear_range` and the limit of the compression, both less
        the margin, at the least stiffness and at every larger one.

        Parameters
        ----------
        damping : array_like
            C_c in N s/m.
        margin : float
            Share of every limit, and of the linear range, that has to be left.

        Returns
        -------
        (ndarray, ndarray)
            In N/m, of the shape of damping; both NaN where no stiffness does. The largest is infinite where
            nothing limits it.

        Raises
        ------
        InvalidParameterError
            If a damping is negative or not finite, or the margin is not from 0 to below 1.

        Examples
        --------
        >>> from hrsafety import impact
        >>> design = impact.design_foam(impact.MANIPULATOR_2, impact.FoamLimits(), closing_speed=1.25)
        >>> least, largest = design.stiffness_range([71.9])
        >>> bool(least[0] < 24300.0 < largest[0])
        True
        """
        given, share = check_damping(damping), check_margin(margin)
        needed = self._with_linear_range(self.linear_range, share)
        impact = Impact(self.closing_speed, self.horizon)
        soft = boundary(
            self.manipulator, [each for each in needed if each[0] == _OF_CONTACT], given, impact, upper=False
        )
        hard_limits = [each for each in needed if each[0] in _AGAINST_STIFFNESS]
        least = np.where(soft.holds_above, soft.stiffness, np.nan)
        if not hard_limits:
            return least, np.where(np.isnan(least), np.nan, np.inf)
        hard = boundary(self.manipulator, hard_limits, given, impact, upper=True)
        unlimited = hard.holds_below & hard.holds_above & (hard.status == "none")
        largest = np.where(unlimited, np.inf, hard.stiffness)
        fits = least <= largest
        return np.where(fits, least, np.nan), np.where(fits, largest, np.nan)

    def _fastest(self, damping: Array, margin: float) -> tuple[Array, Array]:
        """Return the largest closing speed and its stiffness for each damping."""
        found = _hrsafety.foam_fastest(
            self.manipulator._native,
            self._with_linear_range(self.linear_range, margin),
            damping,
            closing_speed=self.closing_speed,
            horizon=self.horizon,
        )
        return found["closing_speed"], found["stiffness"]


def check_margin(margin: float) -> float:
    """Return a share of a limit, or say that it should have been one."""
    share = number("margin", margin)
    if not 0.0 <= share < 1.0:
        raise InvalidParameterError("margin", "be from 0 to below 1, a share of each limit", margin)
    return share


@telling()
def design_foam(
    manipulator: Manipulator,
    limits: FoamLimits,
    *,
    closing_speed: float,
    acceleration_head: Head | None = None,
    force_head: Head | ConstrainedHead | None = None,
    horizon: float | None = None,
    thickness: float = THICKNESS,
    linear_range: float | None = None,
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
    thickness, linear_range : float
        Of the foam that is looked for, as for `Foam`; a foam that is judged has its own.

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
    check_speeds(speed)
    # A foam of any stiffness checks the two for us.
    depths = {} if linear_range is None else {"linear_range": linear_range}
    within = Foam(stiffness=1e4, damping=0.0, thickness=positive("thickness", thickness), **depths).linear_range
    return FoamDesign(
        manipulator=instance("manipulator", manipulator, Manipulator),
        limits=instance("limits", limits, FoamLimits),
        closing_speed=speed,
        acceleration_head=(
            Head.minimum() if acceleration_head is None else instance("acceleration_head", acceleration_head, Head)
        ),
        force_head=Head.maximum() if force_head is None else check_head("force_head", force_head),
        horizon=end,
        linear_range=within,
    )
