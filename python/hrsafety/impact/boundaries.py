"""Boundaries of the foam stiffness over the foam damping."""

from __future__ import annotations

from dataclasses import replace
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, instance, numbers, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.impact.criteria.loads import Doubts, speed_warnings
from hrsafety.impact.parameters import ConstrainedHead, Head, Manipulator
from hrsafety.plausibility import telling

__all__ = ["FoamBoundary", "foam_stiffness_lower", "foam_stiffness_upper"]

AnyHead = Head | ConstrainedHead
Requirement = tuple[str, float, _hrsafety.Head | _hrsafety.ConstrainedHead]


@displayed
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
        was examined.
    warnings : tuple of ResultWarning
        Numbers that are hardly what was meant: of the manipulator, the head and the speed.
    """

    damping: Annotated[Array, "N s/m"]
    stiffness: Annotated[Array, "N/m"]
    status: npt.NDArray[np.str_]
    limited_by: npt.NDArray[np.str_]
    crossings: Annotated[tuple[Array, ...], "N/m"]
    crossing_status: tuple[tuple[str, ...], ...]
    holds_below: npt.NDArray[np.bool_]
    holds_above: npt.NDArray[np.bool_]
    warnings: Doubts = ()


@telling()
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
    hit = Head.minimum() if head is None else check_head("head", head)
    limits = {
        "peak_head_acceleration_g": peak_head_acceleration_g,
        "peak_contact_force": peak_contact_force,
        "hic15": hic15,
        "hic36": hic36,
    }
    requirements = [
        requirement(name, positive(name, limit), hit) for name, limit in limits.items() if limit is not None
    ]
    found = boundary(manipulator, requirements, damping, check_impact(closing_speed, horizon), upper=True)
    return _doubted(found, manipulator, hit, closing_speed)


@telling()
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
    hit = Head.maximum() if head is None else check_head("head", head)
    requirements = [requirement("max_compression", positive("max_compression", max_compression), hit)]
    found = boundary(manipulator, requirements, damping, check_impact(closing_speed, horizon), upper=False)
    return _doubted(found, manipulator, hit, closing_speed)


def _doubted(found: FoamBoundary, manipulator: Manipulator, head: AnyHead, closing_speed: float) -> FoamBoundary:
    """Return a boundary with what is doubtful about its impact."""
    return replace(found, warnings=manipulator.warnings + head.warnings + speed_warnings(closing_speed))


class Impact(NamedTuple):
    closing_speed: float
    horizon: float | None


def check_impact(closing_speed: float, horizon: float | None) -> Impact:
    return Impact(positive("closing_speed", closing_speed), None if horizon is None else positive("horizon", horizon))


def requirement(name: str, limit: float, head: AnyHead) -> Requirement:
    return (name, limit, head._native)


def check_damping(damping: npt.ArrayLike) -> Array:
    given = numbers("damping", damping)
    bad = given[~(np.isfinite(given) & (given >= 0.0))]
    if bad.size:
        raise InvalidParameterError("damping", "be finite and not negative", float(bad[0]))
    return given


def check_head(name: str, head: AnyHead) -> AnyHead:
    if not isinstance(head, (Head, ConstrainedHead)):
        raise InvalidParameterError(name, "be a Head or a ConstrainedHead", head)
    return head


def boundary(
    manipulator: Manipulator,
    requirements: list[Requirement],
    damping: npt.ArrayLike,
    impact: Impact,
    *,
    upper: bool,
) -> FoamBoundary:
    if not requirements:
        raise InvalidParameterError("limits", "hold a limit for this boundary", Shown("none"))
    given = check_damping(damping)
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
