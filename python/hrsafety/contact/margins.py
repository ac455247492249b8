"""Contact of a mobile base: allowed speeds at regions, margins along a run."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType
from typing import Annotated, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, Pair, instance, positive, sequence
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.contact.base import Base, DifferentialBase, HolonomicBase
from hrsafety.contact.contact import Contact, Support
from hrsafety.contact.covering import Covering, covering_of
from hrsafety.contact.doubts import Doubts, counted
from hrsafety.contact.rows import HORIZON
from hrsafety.contact.runs import GAP, approach_of, doubts_of_run, gaps_of
from hrsafety.contact.speed import AllowedSpeed, AllowedSpeeds
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, telling, unsafe_doubts
from hrsafety.tables import Columns, Table, unit_suffix

__all__ = [
    "ContactMargins",
    "RegionSpeed",
    "contact_margins",
    "contact_speed_limit",
]

KNEE_HEIGHT = 0.35
"""Lowest knee that a cover may meet, in m: below that of nearly every adult, a choice of this project."""
LOWEST = MappingProxyType({"thigh_knee": KNEE_HEIGHT})
"""Height from which a region counts; what is not here counts from the floor on."""


FASTEST, SETTLING, LATEST = 20.0, 1.0, 60.0
"""Of a contact with a drive: fastest closing speed in m/s that is examined, time in s after the base stands in which
loads may still rise, and time in s up to which they are examined."""

_READ = ("region", "contact", "permitted", "force", "pressure", "spring_constant", "body_mass")
"""Attributes that are read of a limit of contact."""
_OF_RUN = ("time", "position", "velocity", "heading", "obstacle_position")


_UNKNOWN = ResultWarning(
    "closing_speed_unknown",
    "obstacle_position",
    "the velocity of a person, and with it the closing speed, is not known",
)


@displayed
class RegionSpeed(NamedTuple):
    """Allowed closing speed at a region in one class of contact.

    Attributes
    ----------
    region, contact : str
        Region and class, ``"transient"`` or ``"quasi_static"``.
    status : str
        ``"not_permitted"``, or the status of the speed.
    robot_mass : float
        Effective mass of the base in kg, inf where it cannot yield.
    speed : float
        Closing speed in m/s: 0 where contact is not permitted, NaN where nothing limits it.
    allowed : AllowedSpeed or None
        How it was found.
    warnings : tuple of ResultWarning
        Of the speed and of the base: why it may not be what it seems.
    """

    region: str
    contact: str
    status: str
    robot_mass: Annotated[float, "kg"]
    speed: Annotated[float, "m/s"]
    allowed: AllowedSpeed | None
    warnings: tuple[ResultWarning, ...] = ()


@telling()
def contact_speed_limit(
    base: Base,
    covering: Covering | Mapping[str, object] | None,
    point: Pair,
    normal: Pair,
    regions: Sequence[Any],
    *,
    area: float | None = None,
    drive: Support | None = None,
) -> tuple[RegionSpeed, ...]:
    """Return the allowed closing speed of a point of a base along a normal, for each region and class.

    The limits are those of adults; no limit set has values of children. Those of clamped contacts hold for a base whose
    drive pushes no further, unless it is described: the doubt ``drive_not_given`` says so.

    Parameters
    ----------
    base : HolonomicBase or DifferentialBase
        The base.
    covering : Covering, mapping or None
        ``None``: bare.
    point, normal : tuple of two floats
        Point of the base in its frame, in m, and outward direction of the contact.
    regions : sequence
        Limits with ``region``, ``contact``, ``permitted``, ``force``, ``pressure``, ``spring_constant`` and
        ``body_mass``, such as those of `hrsafety.standards`. Give both classes: transient and clamped.
    area : float or None
        Contact area of a bare contact in m^2.
    drive : Support or None
        Drive of the base, its stiffness and its stop. Clamped contacts are simulated with it.

    Returns
    -------
    tuple of RegionSpeed
        In the order of the regions.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or a region has no spring constant or mass.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from hrsafety import contact
    >>> leg = SimpleNamespace(
    ...     region="lower_leg", contact="transient", permitted=True, force=260.0, pressure=None,
    ...     spring_constant=60e3, body_mass=75.0,
    ... )
    >>> base = contact.HolonomicBase(mass=4.4, inertia=0.1)
    >>> round(contact.contact_speed_limit(base, None, (0.2, 0.0), (1.0, 0.0), [leg])[0].speed, 4)
    0.5207
    """
    instance("base", base, HolonomicBase, DifferentialBase)
    mass = base.effective_mass(point, normal)
    drive = _whole(drive)
    found = (_region_speed(mass, covering, each, area, drive) for each in _limits_of(regions))
    return tuple(each._replace(warnings=(*base.warnings, *each.warnings)) for each in found)


def _hit(
    mass: float, covering: Covering | Mapping[str, object] | None, limit: Any, area: float | None, drive: Support | None
) -> tuple[Contact, float]:
    """Return the contact with a region, and the time until which its loads are followed.

    A clamped region meets the drive, too; a free body is hit and left alone.
    """
    for name in ("spring_constant", "body_mass"):
        if getattr(limit, name) is None:
            raise InvalidParameterError(f"regions.{limit.region}.{name}", "be known", None)
    free = drive is None or drive.stop is None or math.isfinite(limit.body_mass)
    hit = Contact(robot=mass, body=limit, covering=covering, area=area, drive=None if free else drive)
    if free or drive is None or drive.stop is None:
        return hit, HORIZON
    # At rest by then, and pressed no further.
    return hit, min(drive.stop[0] + FASTEST / drive.stop[1] + SETTLING, LATEST)


def _whole(drive: Support | None) -> Support | None:
    """Return a drive of which stiffness and stop are known; half of one is none."""
    if drive is not None:
        instance("drive", drive, Support)
        for name, given in (("stop", drive.stop is not None), ("stiffness", drive.stiffness > 0.0)):
            if not given:
                rule = "be given: a drive of a base has a stiffness and a stop"
                raise InvalidParameterError(f"drive.{name}", rule, getattr(drive, name))
    return drive


def _limits_of(regions: Sequence[Any]) -> list[Any]:
    """Return limits of contact, each with all that is read of it."""
    found = sequence("regions", "be a sequence of limits", regions)
    for index, each in enumerate(found):
        for name in _READ:
            if not hasattr(each, name):
                remedy = 'for example standards.limits().contact("lower_leg", "quasi_static")'
                raise InvalidParameterError(f"regions[{index}]", f"be a limit of contact with {name}", each, remedy)
    return found


def _region_speed(
    mass: float,
    covering: Covering | Mapping[str, object] | None,
    limit: Any,
    area: float | None,
    drive: Support | None,
) -> RegionSpeed:
    if not limit.permitted:
        return RegionSpeed(limit.region, limit.contact, "not_permitted", mass, 0.0, None)
    hit, horizon = _hit(mass, covering, limit, area, drive)
    found = hit.allowed_speed(horizon=horizon)
    speed = math.nan if found.speed is None else found.speed
    return RegionSpeed(limit.region, limit.contact, found.status, mass, speed, found, found.warnings)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ContactMargins(Table):
    """Margins of a contact at each instant of a run: n instants, m obstacles.

    Attributes
    ----------
    time : ndarray, shape (n,)
        In s.
    closing_speed, robot_share : ndarray, shape (n, m)
        Speed at which robot and person close in along the line between them, and what of it is the
        robot's, in m/s; NaN while the person is absent. Of the person's speeds before and after an instant the
        one that closes in faster counts.
    margin : ndarray, shape (n, m)
        Allowed less closing speed in m/s; NaN where nothing limits it.
    verdict : ndarray of str, shape (n, m)
        ``"within_limits"``, also where both move apart; ``"exceeds"``; ``"not_permitted"``, also for a touch at
        closing speed 0; ``"not_checked"`` where a limit of some region was not checked, its speed or the velocity of
        the person is not known, or a doubt of `warnings` may lie on the unsafe side, and no other limit is exceeded, or
        a person is not seen between two sights; ``"absent"`` before the first and after the last one.
    touching : ndarray of bool, shape (n, m)
        Whether there is contact.
    region, contact : str
        The region and class with the lowest speed, to which the margins belong.
    warnings : tuple of ResultWarning
        Of the allowed speeds, by region, and velocities that are not known. Those whose error may lie on the unsafe
        side are why an instant is not checked.
    """

    time: Annotated[Array, "s"]
    closing_speed: Annotated[Array, "m/s"]
    robot_share: Annotated[Array, "m/s"]
    margin: Annotated[Array, "m/s"]
    verdict: npt.NDArray[np.str_]
    touching: npt.NDArray[np.bool_]
    region: str
    contact: str
    warnings: Doubts

    def columns(self) -> Columns:
        """Return one row for each instant and obstacle.

        Returns
        -------
        dict of str to ndarray
            Columns by name.
        """
        rows, obstacles = self.closing_speed.shape
        speeds = ("closing_speed", "robot_share", "margin")
        found: Columns = {"t_s": np.repeat(self.time, obstacles), "obstacle": np.tile(np.arange(obstacles), rows)}
        found |= {f"{name}{unit_suffix('m/s')}": getattr(self, name).ravel() for name in speeds}
        return found | {"verdict": self.verdict.ravel(), "touching": self.touching.ravel()}


@telling()
def contact_margins(
    trajectory: Any,
    *,
    base: Base,
    covering: Covering | Mapping[str, object] | None,
    regions: Sequence[Any],
    robot_radius: float,
    person_radius: float,
    area: float | None = None,
    cover_height: float | None = None,
    drive: Support | None = None,
) -> ContactMargins:
    """Return the margin of the closing speed at every instant of a run, as if the robot touched then.

    Clamped regions hold for a base whose drive pushes no further, and are not checked unless it is described.

    Parameters
    ----------
    trajectory : navigation.Trajectory
        The run: its ``time``, ``position``, ``velocity``, ``heading`` and ``obstacle_position``.
    base, covering, regions, area, drive
        As for `contact_speed_limit`. The lowest speed of all regions and classes counts.
    robot_radius, person_radius : float
        Radii in m, for the point of contact and for ``touching``.
    cover_height : float or None
        Height of the upper edge of the robot above the floor in m: thigh and knee count from `KNEE_HEIGHT`
        on. Every region that is given counts when ``None``.

    Returns
    -------
    ContactMargins
        Closing speeds, margins and verdicts.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or there is no region.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> from hrsafety import contact, navigation as nav, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> leg = SimpleNamespace(
    ...     region="lower_leg", contact="transient", permitted=True, force=260.0, pressure=None,
    ...     spring_constant=60e3, body_mass=75.0,
    ... )
    >>> found = contact.contact_margins(
    ...     run, base=contact.HolonomicBase(mass=4.4, inertia=0.1), covering=None, regions=[leg],
    ...     robot_radius=0.2, person_radius=0.1,
    ... )
    >>> bool(found.touching.any()), found.region
    (False, 'lower_leg')
    """
    instance("base", base, HolonomicBase, DifferentialBase)
    if not all(hasattr(trajectory, name) for name in _OF_RUN):
        raise InvalidParameterError("trajectory", f"be a run with {', '.join(_OF_RUN)}", trajectory)
    regions = _within_reach(_limits_of(regions), cover_height)
    if not len(regions):
        raise InvalidParameterError("regions", "name at least one limit that the robot reaches", len(regions))
    reach = positive("robot_radius", robot_radius)
    near = reach + positive("person_radius", person_radius)
    away = trajectory.obstacle_position - trajectory.position[:, None, :]
    distance = np.linalg.norm(away, axis=2)
    with np.errstate(invalid="ignore", divide="ignore"):
        normal = away / distance[:, :, None]
    share = np.einsum("nk,nmk->nm", trajectory.velocity, normal)
    closing = share + approach_of(trajectory.time, trajectory.obstacle_position, normal)
    drive = _whole(drive)
    limits = [_limit_at(trajectory, base, covering, each, normal, reach, (area, drive)) for each in regions]
    limit = np.min([each.speed for each in limits], axis=0)
    run_doubts = tuple(doubts_of_run(trajectory))
    refuted = any(each.code == "closing_speed_unknown" for each in run_doubts)
    own = (*base.warnings, *run_doubts)
    known = np.all([each.known for each in limits], axis=0) & (not unsafe_doubts(own))
    lowest = min(limits, key=lambda each: float(np.min(each.speed, initial=np.inf))).limit
    margin = limit - closing
    verdict = np.where(margin >= 0.0, np.where(known, "within_limits", "not_checked"), "exceeds")
    if not all(each.permitted for each in regions):
        verdict = np.full(closing.shape, "not_permitted")
    touching = distance <= near
    # Who moves apart is touched no more; a touch that lasts counts, whatever its closing speed.
    apart = (closing < 0.0) | ((closing == 0.0) & ~touching)
    verdict = np.where(apart, "not_checked" if refuted else "within_limits", verdict)
    unknown = np.isnan(closing) & ~np.isnan(distance)
    verdict = np.where(unknown & (verdict != "not_permitted"), "not_checked", verdict)
    gaps = gaps_of(distance)
    verdict = np.where(np.isnan(distance), np.where(gaps, "not_checked", "absent"), verdict)
    return ContactMargins(
        time=np.asarray(trajectory.time),
        closing_speed=closing,
        robot_share=share,
        margin=np.where(np.isinf(margin), np.nan, margin),
        verdict=verdict,
        touching=touching,
        region=lowest.region,
        contact=lowest.contact,
        warnings=(
            *own,
            *dict.fromkeys(doubt for each in limits for doubt in each.warnings),
            *((counted(_UNKNOWN, unknown),) if unknown.any() else ()),
            *((counted(GAP, gaps),) if gaps.any() else ()),
        ),
    )


def _within_reach(regions: Sequence[Any], cover_height: float | None) -> list[Any]:
    """Return the regions that a robot of some height can touch."""
    if cover_height is None:
        return list(regions)
    height = positive("cover_height", cover_height)
    return [each for each in regions if height >= LOWEST.get(each.region, 0.0)]


class _Limits(NamedTuple):
    """Allowed speed of a region at each instant and obstacle, inf where nothing limits it."""

    limit: Any
    speed: Array
    known: npt.NDArray[np.bool_]
    warnings: Doubts


def _limit_at(
    trajectory: Any,
    base: Base,
    covering: Any,
    limit: Any,
    normal: Array,
    reach: float,
    how: tuple[float | None, Support | None],
) -> _Limits:
    area, drive = how
    shape = normal.shape[:2]
    if not limit.permitted:
        return _Limits(limit, np.zeros(shape), np.ones(shape, dtype=bool), ())
    if isinstance(base, HolonomicBase):
        # The line to the person leads through the center: no direction differs from another.
        masses = np.array(base.effective_mass((reach, 0.0), (1.0, 0.0)))
    else:
        turned = np.arctan2(normal[:, :, 1], normal[:, :, 0]) - np.asarray(trajectory.heading)[:, None]
        masses = np.full(shape, base.mass)
        for place in map(tuple, np.argwhere(np.isfinite(turned)).tolist()):
            along = (math.cos(turned[place]), math.sin(turned[place]))
            masses[place] = base.effective_mass((reach * along[0], reach * along[1]), along)
    hit, horizon = _hit(math.inf, covering, limit, area, drive)
    found = hit.allowed_speeds(horizon=horizon, robot_mass=masses)
    unlimited = found.status == "unlimited_up_to_20"
    known = np.isfinite(found.speed) | unlimited
    # Some doubts hold for the instants of a flag; every other one holds for all of them.
    whole = any(doubt.code not in _OF_ROWS for doubt in unsafe_doubts(found.warnings))
    known &= ~_doubted(found, covering) & (not whole)
    speed = np.where(np.isnan(found.speed), np.inf, found.speed)
    return _Limits(limit, np.broadcast_to(speed, shape), np.broadcast_to(known, shape), tuple(_named(limit, found)))


def _doubted(found: AllowedSpeeds, covering: Covering | Mapping[str, object] | None) -> npt.NDArray[np.bool_]:
    """Return where loads may be larger than the model of the covering says."""
    pad = covering_of(covering)
    depth = found.covering_compression
    deeper = np.zeros(depth.shape, dtype=bool) if pad is None else depth > pad.thickness
    return np.asarray(found.rising | found.outside_paraboloid | found.beyond_pad | found.edge | deeper)


_OF_ROWS = ("rising_at_horizon", "outside_paraboloid", "beyond_pad", "edge", "beyond_thickness")
"""Doubts whose instants `_doubted` knows."""


def _named(limit: Any, found: AllowedSpeeds) -> Iterator[Any]:
    """Yield the warnings of a speed with the region that they belong to."""
    name = f"{limit.region}, {limit.contact}"
    for each in found.warnings:
        yield replace(each, subject=f"regions[{name}].{each.subject}", message=f"{name}: {each.message}")
