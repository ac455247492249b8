"""Foam design: which stiffness and damping keep the limits, and how fast the manipulator may be."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, Parameters, instance, not_negative, numbers, positive
from hrsafety.errors import InvalidParameterError
from hrsafety.impact.parameters import ConstrainedHead, Foam, Head, Manipulator

__all__ = [
    "FoamBoundary",
    "FoamDesign",
    "FoamFeasibility",
    "FoamLimits",
    "FoamMargin",
    "design_foam",
    "foam_stiffness_lower",
    "foam_stiffness_upper",
]

AnyHead = Head | ConstrainedHead
_Requirement = tuple[str, float, _hrsafety.Head | _hrsafety.ConstrainedHead]

# Limits that are judged with the heavy head.
_FORCE_LIKE = ("peak_contact_force", "max_compression")
# Limits that make an upper and a lower boundary of the stiffness.
_AGAINST_STIFFNESS = ("peak_head_acceleration_g", "peak_contact_force", "hic15", "hic36")
_AGAINST_SOFTNESS = ("max_compression",)

# Range of foam damping that a design looks at when none is given, in N s/m.
DEFAULT_DAMPING = np.linspace(0.0, 300.0, 61)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FoamBoundary:
    """Boundary of the foam stiffness over the foam damping; every point says what it is.

    Attributes
    ----------
    damping : ndarray
        C_c in N s/m, as given.
    stiffness : ndarray
        K_c in N/m, on the side that keeps the limits; NaN where there is no boundary.
    status : ndarray of str
        What meets the limit there. ``"local_maximum"``: a maximum inside the impact period.
        ``"end_of_impact_period"``: the value at the end of it, or of the horizon.
        ``"initial_step"``: the value at first contact. ``"jump"``: nothing; the load jumps over
        the limit with the impact period. ``"none"``: there is no boundary, see `holds_below`
        and `holds_above`.
    limited_by : ndarray of str
        Field of `FoamLimits` that is met; empty where there is no boundary.
    crossings : tuple of ndarray
        For each damping, in flat order, every stiffness at which the limits begin or cease to
        be kept, increasing, in N/m. More than one or two are a reason to look closer.
    crossing_status : tuple of tuple of str
        The status of each.
    holds_below, holds_above : ndarray of bool
        Whether the limits are kept at the softest (1 N/m) and the stiffest (10 MN/m) foam that
        was looked at.
    """

    damping: Array
    stiffness: Array
    status: npt.NDArray[np.str_]
    limited_by: npt.NDArray[np.str_]
    crossings: tuple[Array, ...]
    crossing_status: tuple[tuple[str, ...], ...]
    holds_below: npt.NDArray[np.bool_]
    holds_above: npt.NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True, slots=True)
class FoamLimits(Parameters):
    """What a foam covering has to keep; ``None`` is no limit.

    Parameters
    ----------
    peak_head_acceleration_g : float or None
        In g.
    peak_contact_force : float or None
        In N.
    hic15, hic36 : float or None
        Head injury criterion.
    max_compression : float or None
        In m; the range in which the foam is linear.

    Raises
    ------
    InvalidParameterError
        If a limit is not finite and positive, or there is none at all.

    Examples
    --------
    >>> from hrsafety import impact
    >>> impact.FoamLimits(peak_contact_force=500.0).peak_head_acceleration_g
    10.0
    """

    peak_head_acceleration_g: float | None = 10.0
    peak_contact_force: float | None = None
    hic15: float | None = None
    hic36: float | None = None
    max_compression: float | None = 0.02

    def __post_init__(self) -> None:
        """Check the values."""
        for name in (each.name for each in fields(self)):
            value = getattr(self, name)
            self._set(**{name: None if value is None else positive(name, value)})
        if not self.given():
            raise InvalidParameterError("limits", "hold at least one limit", "none")

    def given(self) -> dict[str, float]:
        """Return the limits that are set.

        Returns
        -------
        dict of str to float
            By name.
        """
        values = {each.name: getattr(self, each.name) for each in fields(self)}
        return {name: value for name, value in values.items() if value is not None}


class FoamMargin(NamedTuple):
    """What is left of each limit, as a share of it; negative if it is exceeded, NaN without a limit.

    Attributes
    ----------
    peak_head_acceleration_g, peak_contact_force, hic15, hic36, max_compression : float
        1 - load / limit.
    least : float
        The least of them.
    """

    peak_head_acceleration_g: float
    peak_contact_force: float
    hic15: float
    hic36: float
    max_compression: float
    least: float


class FoamFeasibility(NamedTuple):
    """Whether some foam keeps all limits, and if not how much slower the manipulator has to be.

    Attributes
    ----------
    feasible : bool
        Whether a foam exists at the closing speed of the design.
    max_closing_speed : float
        Largest closing speed at which one exists, in m/s.
    slow_down : float
        How much the closing speed has to be reduced, in m/s; 0 if feasible.
    damping, stiffness : float
        The foam that allows the largest closing speed, in N s/m and N/m.
    """

    feasible: bool
    max_closing_speed: float
    slow_down: float
    damping: float
    stiffness: float


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

    def _requirements(self, names: Sequence[str] | None = None) -> list[_Requirement]:
        """Return limits with their heads, all or those of some names."""
        return [
            _requirement(name, limit, self.force_head if name in _FORCE_LIKE else self.acceleration_head)
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
        return _boundary(self.manipulator, self._requirements(_AGAINST_STIFFNESS), damping, self, upper=True)

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
        return _boundary(self.manipulator, self._requirements(_AGAINST_SOFTNESS), damping, self, upper=False)

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
        given = _damping(damping).ravel()
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


def _requirement(name: str, limit: float, head: AnyHead) -> _Requirement:
    return (name, limit, head._native)


def _damping(damping: npt.ArrayLike) -> Array:
    given = numbers("damping", damping)
    bad = given[~(np.isfinite(given) & (given >= 0.0))]
    if bad.size:
        raise InvalidParameterError("damping", "be finite and not negative", float(bad[0]))
    return given


def _check_head(name: str, head: AnyHead) -> AnyHead:
    if not isinstance(head, (Head, ConstrainedHead)):
        raise InvalidParameterError(name, "be a Head or a ConstrainedHead", head)
    return head


def _boundary(
    manipulator: Manipulator,
    requirements: list[_Requirement],
    damping: npt.ArrayLike,
    impact: _Impact | FoamDesign,
    *,
    upper: bool,
) -> FoamBoundary:
    if not requirements:
        raise InvalidParameterError("limits", "hold a limit for this boundary", "none")
    given = _damping(damping)
    found = _hrsafety.foam_boundary(
        instance("manipulator", manipulator, Manipulator)._native,
        requirements,
        given.ravel(),
        closing_speed=impact.closing_speed,
        horizon=impact.horizon,
        upper=upper,
    )
    return FoamBoundary(
        damping=given,
        stiffness=found["stiffness"].reshape(given.shape),
        status=_words(found["status"], given.shape),
        limited_by=_words(found["limited_by"], given.shape),
        crossings=found["crossings"],
        crossing_status=tuple(tuple(words) for words in found["crossing_status"]),
        holds_below=found["holds_below"].reshape(given.shape),
        holds_above=found["holds_above"].reshape(given.shape),
    )


def _words(words: list[str], shape: tuple[int, ...]) -> npt.NDArray[np.str_]:
    return np.array(words, dtype=np.str_).reshape(shape)


class _Impact(NamedTuple):
    closing_speed: float
    horizon: float | None


def _impact(closing_speed: float, horizon: float | None) -> _Impact:
    return _Impact(positive("closing_speed", closing_speed), None if horizon is None else positive("horizon", horizon))


def foam_stiffness_upper(
    manipulator: Manipulator,
    *,
    damping: npt.ArrayLike,
    closing_speed: float,
    head: Head | ConstrainedHead | None = None,
    peak_head_acceleration_g: float | None = 10.0,
    peak_contact_force: float | None = None,
    hic15: float | None = None,
    hic36: float | None = None,
    horizon: float | None = None,
) -> FoamBoundary:
    """Return the foam stiffness up to which limits of acceleration, force or injury are kept.

    The smallest stiffness above which they cease to be kept; safeguarded, on the exact response.

    Parameters
    ----------
    manipulator : Manipulator
        What hits.
    damping : array_like
        C_c in N s/m.
    closing_speed : float
        v_c in m/s, positive.
    head : Head, ConstrainedHead or None
        What is hit; ``Head.minimum()`` when ``None``. A constrained head has force limits only.
    peak_head_acceleration_g : float or None
        Limit in g.
    peak_contact_force : float or None
        Limit in N.
    hic15, hic36 : float or None
        Limits of the head injury criterion.
    horizon : float or None
        As for `metrics`.

    Returns
    -------
    FoamBoundary
        Of the shape of damping.

    Raises
    ------
    InvalidParameterError
        If a value is out of range, or there is no limit.

    Examples
    --------
    >>> from hrsafety import impact
    >>> found = impact.foam_stiffness_upper(impact.MANIPULATOR_1, damping=[0.0, 71.9, 400.0], closing_speed=1.25)
    >>> found.stiffness.round().tolist(), found.status.tolist()
    ([46036.0, 55860.0, nan], ['local_maximum', 'local_maximum', 'none'])
    """
    hit = Head.minimum() if head is None else _check_head("head", head)
    limits = {
        "peak_head_acceleration_g": peak_head_acceleration_g,
        "peak_contact_force": peak_contact_force,
        "hic15": hic15,
        "hic36": hic36,
    }
    requirements = [
        _requirement(name, positive(name, limit), hit) for name, limit in limits.items() if limit is not None
    ]
    return _boundary(manipulator, requirements, damping, _impact(closing_speed, horizon), upper=True)


def foam_stiffness_lower(
    manipulator: Manipulator,
    *,
    damping: npt.ArrayLike,
    closing_speed: float,
    head: Head | ConstrainedHead | None = None,
    max_compression: float = 0.02,
    horizon: float | None = None,
) -> FoamBoundary:
    """Return the foam stiffness from which on the compression keeps its limit.

    The smallest stiffness such that the limit is kept for every larger one.

    Parameters
    ----------
    manipulator : Manipulator
        What hits.
    damping : array_like
        C_c in N s/m.
    closing_speed : float
        v_c in m/s, positive.
    head : Head, ConstrainedHead or None
        What is hit; ``Head.maximum()`` when ``None``.
    max_compression : float
        Limit lambda in m.
    horizon : float or None
        As for `metrics`.

    Returns
    -------
    FoamBoundary
        Of the shape of damping.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    >>> from hrsafety import impact
    >>> found = impact.foam_stiffness_lower(impact.MANIPULATOR_1, damping=[71.9, 250.0], closing_speed=1.25)
    >>> found.stiffness.round().tolist(), found.status.tolist()
    ([12444.0, 15420.0], ['local_maximum', 'jump'])
    """
    hit = Head.maximum() if head is None else _check_head("head", head)
    requirements = [_requirement("max_compression", positive("max_compression", max_compression), hit)]
    return _boundary(manipulator, requirements, damping, _impact(closing_speed, horizon), upper=False)


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
    speed, end = _impact(closing_speed, horizon)
    return FoamDesign(
        manipulator=instance("manipulator", manipulator, Manipulator),
        limits=instance("limits", limits, FoamLimits),
        closing_speed=speed,
        acceleration_head=(
            Head.minimum() if acceleration_head is None else instance("acceleration_head", acceleration_head, Head)
        ),
        force_head=Head.maximum() if force_head is None else _check_head("force_head", force_head),
        horizon=end,
    )
