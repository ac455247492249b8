"""Tasks of robots: motion, points that may touch people, regions within reach, and rules."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

import numpy as np

from hrsafety._arguments import checked_text, count, instance, number, positive, sequence, vector, word
from hrsafety._records import dataclass
from hrsafety._words import meant
from hrsafety.arms.masses import RULES
from hrsafety.contact import Covering, Drive, annex_of
from hrsafety.contact.cell.cell import MOST_COVERINGS, confirmed_of
from hrsafety.contact.cell.stops import separation_of
from hrsafety.errors import InvalidParameterError
from hrsafety.program.draws import DrawnMotions
from hrsafety.program.exposures import ContactPoint, Segment
from hrsafety.program.motion import ArmMotion
from hrsafety.standards.limit_sets import LimitSet
from hrsafety.standards.sets import limits as limit_set

__all__ = ["DIRECTIONS", "ContactTask", "ProgramTask", "ZoneRules"]

DIRECTIONS = ("motion", "worst")
MOST_EXPOSURES = 10**4
"""Points times regions."""
MOST_ZONES = 100
MOST_SEGMENTS = 1000
FASTEST_TCP = 20.0


@dataclass(frozen=True, kw_only=True, slots=True)
class ZoneRules:
    """How speeds are typed into the pendant of a robot.

    Parameters
    ----------
    count : int
        Number of zones at most.
    step : float
        Speeds are whole multiples of this one, in m/s.
    percent : float or None
        Step of an override in percent of the full speed of the joints, in place of `step`.
    deceleration : float
        With which the controller slows down before a slower zone, in m/s^2 of the tool center point.

    Examples
    --------
    >>> from hrsafety import program
    >>> program.ZoneRules(deceleration=2.5).count
    8
    """

    deceleration: float
    count: int = 8
    step: float = 0.05
    percent: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        count("zones.count", self.count, most=MOST_ZONES)
        for name in ("deceleration", "step", "percent"):
            given = getattr(self, name)
            if given is not None:
                object.__setattr__(self, name, positive(f"zones.{name}", given))
        if self.percent is not None and self.percent > 100.0:
            raise InvalidParameterError("zones.percent", "be at most 100", self.percent)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ContactTask:
    """Task of a robot: its motion, its points, and the people within their reach, see `Program`."""

    motion: ArmMotion | DrawnMotions
    points: tuple[ContactPoint, ...]
    segments: tuple[Segment, ...]
    limits: LimitSet = field(default_factory=limit_set)
    coverings: Mapping[str, Covering] = field(default_factory=dict)
    strains: Mapping[str, float | None] = field(default_factory=dict)
    drive: Drive | None = None
    robot_mass: str = "larger"
    direction: str = "motion"
    link: str | None = None
    point: tuple[float, float, float] = (0.0, 0.0, 0.0)
    tcp_speed: float | None = None
    separation: Mapping[str, Any] | None = None
    confirmed: Mapping[str, str] = field(default_factory=dict)
    annex: Mapping[str, Any] = field(default_factory=dict)
    title: str = "Contact of a robot program with people"
    given: Mapping[str, Any] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the values."""
        instance("limits", self.limits, LimitSet)
        checked_text("title", self.title, "be a text")
        word("robot_mass", self.robot_mass, RULES)
        word("direction", self.direction, DIRECTIONS)
        for name in ("coverings", "strains", "confirmed", "annex", "given", "files"):
            if not isinstance(getattr(self, name), Mapping):
                raise InvalidParameterError(name, "be a mapping", getattr(self, name))
        annex_of(self.annex)
        if self.drive is not None:
            instance("drive", self.drive, Drive)
        made: dict[str, Any] = {
            "points": tuple(sequence("points", "be points", self.points)),
            "segments": tuple(sequence("segments", "be segments", self.segments)),
            "confirmed": confirmed_of(self.confirmed),
            "separation": self._separation(),
        }
        arm = self.motion.arm
        link = arm.moved_links[-1] if self.link is None else word("link", self.link, arm.moved_links)
        place = vector("point", self.point)
        if place.shape != (3,) or not np.isfinite(place).all():
            raise InvalidParameterError("point", "be three finite numbers in m", self.point)
        made |= {"link": link, "point": tuple(place.tolist())}
        if self.tcp_speed is not None:
            made["tcp_speed"] = number("tcp_speed", self.tcp_speed)
            if not 0.0 < made["tcp_speed"] <= FASTEST_TCP:
                raise InvalidParameterError("tcp_speed", f"be above 0 and at most {FASTEST_TCP:g}", self.tcp_speed)
        if not arm.iso_mass > 0.0:
            raise InvalidParameterError("arm", "have links with masses", f"{arm.iso_mass:g} kg")
        for name, value in made.items():
            object.__setattr__(self, name, value)
        self._checked_points()
        self._checked_segments()

    def _separation(self) -> dict[str, Any] | None:
        """Return the rules of the stop; the speed is that of the program."""
        if self.separation is None:
            return None
        if not isinstance(self.separation, Mapping):
            raise InvalidParameterError("separation", "be a mapping or None", self.separation)
        return separation_of({"max_speed": 1.0, **self.separation})

    def _checked_points(self) -> None:
        """Refuse points that are not of the arm, or without their covering."""
        if not self.points:
            raise InvalidParameterError("points", "name one point of the robot or more", 0)
        if len(self.coverings) > MOST_COVERINGS:
            raise InvalidParameterError("coverings", f"be at most {MOST_COVERINGS}", len(self.coverings))
        for name, pad in self.coverings.items():
            instance(f"coverings[{name!r}]", pad, Covering)
        names: list[str] = []
        links, moved = self.motion.arm.link_names, self.motion.arm.moved_links
        for place, each in enumerate(self.points):
            instance(f"points[{place}]", each, ContactPoint)
            if each.name in names:
                raise InvalidParameterError(f"points[{place}].name", "be a name that no other has", each.name)
            names.append(each.name)
            if each.link not in links:
                rule = f"be a link of the arm: {', '.join(links)}"
                raise InvalidParameterError(f"points[{place}].link", rule, each.link, meant(each.link, links))
            if each.link not in moved:
                rule = f"be a link that a joint moves ({', '.join(moved)}): nothing else hits anybody"
                raise InvalidParameterError(f"points[{place}].link", rule, each.link)
            if each.covering is not None and each.covering not in self.coverings:
                rule = f"name a covering ({', '.join(self.coverings) or 'none is given'})"
                remedy = meant(each.covering, self.coverings)
                raise InvalidParameterError(f"points[{place}].covering", rule, each.covering, remedy)

    def _checked_segments(self) -> None:
        """Refuse segments with regions that the limits do not know, or too many."""
        if not 1 <= len(self.segments) <= MOST_SEGMENTS:
            raise InvalidParameterError("segments", f"be 1 to {MOST_SEGMENTS}", len(self.segments))
        regions, areas = 0, self.limits.areas()
        names = dict.fromkeys((*self.limits.regions, *areas, *(each.partition(", ")[0] for each in areas)))
        for place, each in enumerate(self.segments):
            instance(f"segments[{place}]", each, Segment)
            regions += len(each.regions)
            for region in each.regions:
                if region not in names:
                    rule = f"name regions ({', '.join(self.limits.regions)}) or areas of the limits"
                    raise InvalidParameterError(f"segments[{place}].regions", rule, region, meant(region, names))
        if regions * len(self.points) > MOST_EXPOSURES:
            rule = f"be at most {MOST_EXPOSURES} points times regions"
            raise InvalidParameterError("segments", rule, regions * len(self.points))

    def segment_name(self, segment: int) -> str:
        """Return the name of a segment."""
        return self.segments[segment].name or f"segment {segment + 1}"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ProgramTask(ContactTask):
    """Task of a robot program along a path, see `Program`."""

    motion: ArmMotion
    zone_rules: ZoneRules | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        instance("motion", self.motion, ArmMotion)
        if self.zone_rules is not None:
            instance("zone_rules", self.zone_rules, ZoneRules)
        ContactTask.__post_init__(self)
        for place in range(len(self.segments)):
            self.span(place)

    def span(self, segment: int) -> tuple[float, float]:
        """Return the path parameter where a segment begins and ends.

        Parameters
        ----------
        segment : int
            Its place.

        Returns
        -------
        tuple of two floats
            Of the path of `motion`.

        Raises
        ------
        InvalidParameterError
            If it names no part of the path.
        """
        each, motion = self.segments[segment], self.motion
        found = []
        for name, given, side in (("from", each.start, 0), ("to", each.end, 1)):
            path = f"segments[{segment}].{name}"
            if motion.marks:
                if given not in motion.marks:
                    rule = f"name a move ({', '.join(list(motion.marks)[:12])})"
                    remedy = meant(given, motion.marks) if isinstance(given, str) else None
                    raise InvalidParameterError(path, rule, given, remedy)
                found.append(motion.marks[str(given)][side])
            elif given is None or isinstance(given, str):
                raise InvalidParameterError(path, "be a time in s, or a path parameter", given)
            elif motion.log is not None and motion.place is not None:
                begun, ended = float(motion.log.time[0]), float(motion.log.time[-1])
                if not begun <= given <= ended:
                    raise InvalidParameterError(path, f"be within the log, {begun:g} to {ended:g} s", given)
                found.append(float(np.interp(given, motion.log.time, motion.place)))
            else:
                if not 0.0 <= given <= motion.curve.length:
                    raise InvalidParameterError(path, f"be within the path, 0 to {motion.curve.length:g}", given)
                found.append(given)
        if not found[1] > found[0]:
            remedy = "a segment begins before it ends, and the robot moves in it"
            raise InvalidParameterError(f"segments[{segment}].to", "lie behind from on the path", each.end, remedy)
        return found[0], found[1]

    @property
    def uncovered(self) -> float:
        """Share of the path that no segment speaks of."""
        length, end, missing = self.motion.curve.length, 0.0, 0.0
        for first, last in sorted(self.span(place) for place in range(len(self.segments))):
            missing += max(first - end, 0.0)
            end = max(end, last)
        missing += max(length - end, 0.0)
        return 0.0 if missing <= 1e-9 * length else missing / length
