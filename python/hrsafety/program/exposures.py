"""Possible contacts along a program: points of the robot, segments of the path, and the limits of each pair."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, checked_text, finite, flag, number, positive, sequence, vector
from hrsafety._records import dataclass
from hrsafety.arms import Arm
from hrsafety.contact import Contact, Covering, Drive, driven_speed, driven_speeds
from hrsafety.contact.bodies import part_of
from hrsafety.contact.cell.judgement import REGION_UNKNOWN
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.standards.contact_limits import ContactLimit

__all__ = ["ContactPoint", "Exposer", "Exposure", "Masses", "Segment", "native_contact"]

GRID = 64
"""Masses, at most, at which speeds are computed that depend on them in their own way; the slower neighbor counts."""
STEP = 1.02
"""Ratio of neighboring masses of a grid that needs fewer."""
BEYOND = 4.0
"""A grid reaches so many times beyond the largest mass at the nodes of the path."""
FASTEST = 20.0
"""Speed in m/s up to which contacts with a rate are looked at."""
FASTEST_HUMAN = 20.0
NO_ROOM = ("threshold_above_limit", "push_above_half_limit")
"""Why a drive leaves no speed at all."""
NO_DRIVE = ResultWarning(
    "drive_not_given",
    "drive",
    "the allowed speeds of clamped contacts hold for a robot without drive: one that is driven on until it has reacted "
    "and braked presses harder; give [drive]",
)
NOT_PERMITTED = ResultWarning("not_permitted", "limits", "the limit set does not permit this contact")
UNFINISHED = ResultWarning(
    "unfinished",
    "covering",
    "a simulation of a contact did not end: no speed is "
    "allowed there; give a thicker covering, or one with another damping",
)


@dataclass(frozen=True, kw_only=True, slots=True)
class ContactPoint:
    """A point of the robot that may touch a person.

    Parameters
    ----------
    name : str
        Its name.
    link : str
        The link that it is fixed to.
    point : sequence of three floats
        Place in the frame of the link, in m.
    area : float or None
        Contact area of the bare point in m^2; without it and without `radius` its pressure is not checked.
    radius : float or None
        Radius of the fillet in m, from which the area is estimated.
    covering : str or None
        Name of the covering that is planned there; ``None``: bare.

    Examples
    --------
    >>> from hrsafety import program
    >>> program.ContactPoint(name="gripper", link="tool", area=1e-4).point
    (0.0, 0.0, 0.0)
    """

    name: str
    link: str
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    area: float | None = None
    radius: float | None = None
    covering: str | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ("name", "link"):
            if not checked_text(name, getattr(self, name), "be a text").strip():
                raise InvalidParameterError(name, "be a text that is not empty", getattr(self, name))
        place = vector("point", self.point)
        if place.shape != (3,) or not np.isfinite(place).all():
            raise InvalidParameterError("point", "be three finite numbers in m", self.point)
        object.__setattr__(self, "point", tuple(place.tolist()))
        for name, most in (("area", 10.0), ("radius", 10.0)):
            given = getattr(self, name)
            if given is not None:
                value = positive(name, given)
                if value >= most:
                    raise InvalidParameterError(name, f"be below {most:g}", value)
                object.__setattr__(self, name, value)
        if self.area is not None and self.radius is not None:
            raise InvalidParameterError("radius", "be left out beside an area", self.radius)
        if self.covering is not None:
            checked_text("covering", self.covering, "be the name of a covering")


@dataclass(frozen=True, kw_only=True, slots=True)
class Segment:
    """A part of the path with the regions of the body that may be touched there.

    Parameters
    ----------
    start, end : float, str or None
        Of a log times in s, of moves their names: from the start of one to the end of the other. ``None`` without a
        program.
    regions : sequence of str
        Regions or areas of the limit set. None at all needs a reason.
    clamped : bool
        Whether somebody may be clamped there; ``False`` needs a reason.
    human_speed : float
        Speed of the person towards the robot in m/s.
    reason : str
        Why nobody can be clamped, or touched.
    name : str
        Its name; ``segment N`` when empty.

    Examples
    --------
    >>> from hrsafety import program
    >>> program.Segment(start="pick", end="turn", regions=["hand_finger"]).clamped
    True
    """

    start: float | str | None = None
    end: float | str | None = None
    regions: tuple[str, ...]
    clamped: bool = True
    human_speed: float = 0.0
    reason: str = ""
    name: str = ""

    def __post_init__(self) -> None:
        """Check the values."""
        rule = "be names of regions or areas"
        regions = tuple(checked_text("regions", each, rule) for each in sequence("regions", rule, self.regions))
        object.__setattr__(self, "regions", regions)
        for name in ("start", "end"):
            given = getattr(self, name)
            if given is not None and not isinstance(given, str):
                object.__setattr__(self, name, finite(name, given))
        for name in ("reason", "name"):
            if not isinstance(getattr(self, name), str):
                raise InvalidParameterError(name, "be a text", getattr(self, name))
        walking = number("human_speed", self.human_speed)
        if not 0.0 <= walking < FASTEST_HUMAN:
            raise InvalidParameterError("human_speed", f"be at least 0 and below {FASTEST_HUMAN:g}", walking)
        object.__setattr__(self, "human_speed", walking)
        if not flag("clamped", self.clamped) and not self.reason.strip():
            raise InvalidParameterError("reason", "say why nobody can be clamped there", Shown("nothing"))
        if not regions and not self.reason.strip():
            remedy = "name regions, or say why nobody can be touched there"
            raise InvalidParameterError("regions", "name one region or more", Shown("none"), remedy)


class Masses(NamedTuple):
    """Least and largest mass in kg that a contact along the path may have."""

    least: float
    most: float


@dataclass(frozen=True, kw_only=True, slots=True)
class Exposure:
    """One limit along a part of the path: of a point, and of a region of the body in one class of contact.

    Attributes
    ----------
    point, segment : int
        Their places in the program.
    limit : ContactLimit
        What the region may bear.
    first, last : float
        Path parameter where it begins and ends.
    human_speed : float
        Speed of the person towards the robot in m/s.
    covering : str or None
        Covering between them.
    how : {"contact", "drive"}
        Kinetic energy alone, or the drive that pushes on.
    energy : float
        Energy in J that covering and region store at their limit; inf where a table takes its place or nothing limits.
    table : tuple of two ndarray or None
        Reduced masses in kg and allowed closing speeds in m/s.
    governs : str
        Limit that is reached first: force, pressure, strain or nothing.
    area : float or None
        Contact area in m^2 of a bare contact.
    warnings : tuple of ResultWarning
        Doubts about the limit.
    """

    point: int
    segment: int
    limit: ContactLimit
    first: float
    last: float
    human_speed: float = 0.0
    covering: str | None = None
    how: str = "contact"
    energy: float = math.inf
    table: tuple[Array, Array] | None = None
    governs: str = "nothing"
    area: float | None = None
    warnings: tuple[ResultWarning, ...] = ()

    @property
    def label(self) -> str:
        """Region or area, class and limit that governs."""
        governs = self.governs if self.how == "contact" or self.governs in NO_ROOM else "drive"
        return f"{self.limit.area or self.limit.region}/{self.limit.contact}/{governs}"


def native_contact(
    arm: Arm,
    points: Sequence[ContactPoint],
    rows: Sequence[Exposure],
    *,
    rule: str = "larger",
    direction: str = "motion",
    tcp: tuple[str, tuple[float, ...]],
    speeds: Sequence[tuple[float, float, float]] = (),
) -> _hrsafety.ProgramContact:
    """Return limits as the core reads them; the last point is the tool center point with its speeds.

    Parameters
    ----------
    arm : Arm
        The arm.
    points : sequence of ContactPoint
        Those of the program.
    rows : sequence of Exposure
        Limits of these points.
    rule : {"larger", "iso", "directional"}
        Which mass counts.
    direction : {"motion", "worst"}
        Along the motion, or along the worst normal.
    tcp : tuple of str and tuple of float
        Link and place of the tool center point.
    speeds : sequence of (float, float, float)
        Its largest speed in m/s, with the path parameter where that begins and ends.
    """
    tables = [each.table for each in rows if each.table is not None]
    numbers = iter(range(len(tables)))
    more = len(speeds)
    caps = np.array(speeds, dtype=np.float64).reshape(more, 3).T
    none = np.full(more, np.inf)

    def column(values: list[float], last: Array) -> Array:
        return np.concatenate([np.array(values, dtype=np.float64), last])

    limits = {
        "point": np.array([*(each.point for each in rows), *[len(points)] * more], dtype=np.int64),
        "energy": column([each.energy for each in rows], none),
        "body_mass": column([float(each.limit.body_mass or math.inf) for each in rows], none),
        "human_speed": column([each.human_speed for each in rows], np.zeros(more)),
        "speed": column([math.inf for _ in rows], caps[0]),
        "table": np.array(
            [*(-1 if each.table is None else next(numbers) for each in rows), *[-1] * more], dtype=np.int64
        ),
        "first": column([each.first for each in rows], caps[1]),
        "last": column([each.last for each in rows], caps[2]),
    }
    return _hrsafety.ProgramContact(
        arm._native,
        links=[*(each.link for each in points), tcp[0]],
        points=np.array([*(each.point for each in points), tcp[1]], dtype=np.float64),
        limits=limits,
        tables=tables,
        rule=rule,
        direction=direction,
        iso_mass=arm.iso_mass,
    )


class Exposer:
    """Limits of the contacts of a program: what each pair of a point and a region bears is found once."""

    def __init__(self, arm: Arm, coverings: Mapping[str, Covering], strains: Mapping[str, float | None]) -> None:
        self.arm, self.coverings, self.strains = arm, coverings, strains
        self._known: dict[tuple[object, ...], tuple[Exposure, ...]] = {}

    def rows(
        self,
        point: ContactPoint,
        limit: ContactLimit,
        covering: str | None,
        drive: Drive | None,
        masses: Masses,
        place: Mapping[str, Any],
    ) -> tuple[Exposure, ...]:
        """Return the limits of a pair, one with the drive among them where somebody is clamped and it is known.

        Parameters
        ----------
        point : ContactPoint
            The point.
        limit : ContactLimit
            Region and class.
        covering : str or None
            Covering there.
        drive : Drive or None
            What pushes a clamped part of a body there.
        masses : Masses
            Range of the masses along the path.
        place : mapping
            ``point``, ``segment``, ``first``, ``last`` and ``human_speed`` of the limits.
        """
        own = (point.area, point.radius, point.name if point.radius else "") if covering is None else ()
        key = (limit.region, limit.area, limit.contact, covering, own, id(drive), masses)
        if key not in self._known:
            self._known[key] = tuple(self._found(point, limit, covering, drive, masses))
        return tuple(replace(each, **place) for each in self._known[key])

    def _found(
        self, point: ContactPoint, limit: ContactLimit, covering: str | None, drive: Drive | None, masses: Masses
    ) -> list[Exposure]:
        bare: dict[str, Any] = dict.fromkeys(("point", "segment"), 0) | dict.fromkeys(("first", "last"), 0.0)
        bare |= {"limit": limit, "covering": covering}
        if not limit.permitted:
            return [Exposure(**bare, energy=0.0, governs="not_permitted", warnings=(NOT_PERMITTED,))]
        if limit.spring_constant is None or limit.body_mass is None:
            return [Exposure(**bare, energy=0.0, warnings=(REGION_UNKNOWN,))]
        area, doubts = (None, ()) if covering is not None else _area(point, limit)
        hit = self._hit(limit, covering, area)
        found = hit.allowed_speed()
        clamped = limit.contact == "quasi_static"
        told = tuple(each for each in found.warnings if each.code != "drive_not_given")
        doubts = (*told, *doubts)
        if clamped and drive is None:
            doubts = (*doubts, NO_DRIVE)
        row = Exposure(**bare, governs=found.governs, area=area, warnings=doubts)
        if found.status == "closed_form" and found.speed is not None:
            row = replace(row, energy=0.5 * _reduced(self.arm.iso_mass, limit) * found.speed**2)
        elif found.status != "not_checked":
            row = self._tabled(row, hit, masses)
        if not clamped or drive is None:
            return [row]
        grid = _grid(masses)
        speeds = driven_speeds(hit, drive, grid)
        status = row.governs if speeds.any() else driven_speed(hit, drive).status
        governs = status if status in NO_ROOM else row.governs
        table, told = (grid, np.minimum(speeds, FASTEST)), (*doubts, *drive.doubts_with(self.arm.payload_mass))
        return [row, replace(row, how="drive", energy=math.inf, table=table, governs=governs, warnings=told)]

    def _hit(self, limit: ContactLimit, covering: str | None, area: float | None) -> Contact:
        if covering is None:
            return Contact(robot=self.arm.iso_mass, body=limit, area=area)
        strain = self.strains.get(covering)
        return Contact(robot=self.arm.iso_mass, body=limit, covering=self.coverings[covering], max_strain=strain)

    def _tabled(self, row: Exposure, hit: Contact, masses: Masses) -> Exposure:
        """Return a limit whose speed depends on the mass in another way than by the energy."""
        grid = _grid(masses)
        found = hit.allowed_speeds(robot_mass=grid)
        unlimited = found.status == "unlimited_up_to_20"
        speeds = np.where(unlimited, FASTEST, np.nan_to_num(found.speed, nan=0.0))
        body = float(row.limit.body_mass or math.inf)
        reduced = grid if math.isinf(body) else grid * body / (grid + body)
        known = {each.code for each in row.warnings} | {"drive_not_given"}
        more = tuple(each for each in found.warnings if each.code not in known)
        ended = (unlimited | np.isfinite(found.speed)).all() or any(each.code == "unfinished" for each in more)
        lost = () if ended else (UNFINISHED,)
        return replace(row, table=(reduced, speeds), warnings=(*row.warnings, *more, *lost))


def _grid(masses: Masses) -> Array:
    """Return masses between which the slower neighbor counts: those of the path, and some room beyond."""
    count = min(GRID, 1 + math.ceil(math.log(masses.most / masses.least) / math.log(STEP)))
    # A mass at a node of the path is one of the grid, not the first one of the next step.
    inside = np.geomspace(masses.most, masses.least, count)[::-1] * (1.0 + 1e-9)
    return np.concatenate([inside, masses.most * np.array([STEP, BEYOND])])


def _reduced(mass: float, limit: ContactLimit) -> float:
    body = float(limit.body_mass or math.inf)
    return mass if math.isinf(body) else mass * body / (mass + body)


def _area(point: ContactPoint, limit: ContactLimit) -> tuple[float | None, tuple[ResultWarning, ...]]:
    """Return the contact area of a bare point: the given one, or that of a fillet at the force limit."""
    if point.area is not None or point.radius is None:
        return point.area, ()
    if limit.force is None or not limit.spring_constant:
        return None, ()
    area = 2.0 * math.pi * point.radius * limit.force / limit.spring_constant
    part = part_of(limit)
    most = math.inf if part is None else part.area
    message = (
        f"the contact area of {point.name} is estimated from its fillet of {1e3 * point.radius:g} mm as "
        f"{1e4 * min(area, most):.3g} cm2: measure it, and give it as area"
    )
    return min(area, most), (ResultWarning("estimated_area", f"points.{point.name}", message),)
