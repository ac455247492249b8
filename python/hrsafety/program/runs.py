"""Runs of a program: as it is planned, at the limits of the joints, and within those of contacts."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array
from hrsafety.contact import Drive, push_limit_of_torques
from hrsafety.program.exposures import Exposer, Exposure, Masses, native_contact
from hrsafety.program.motion import INTERVALS, ArmMotion, Retimed
from hrsafety.program.task import ProgramTask
from hrsafety.standards.contact_limits import CONTACTS

__all__ = ["BLOCK", "AllowedAlong", "Choice", "Runs", "Waypoints", "along"]

Choice = tuple[str | None, ...]
"""Covering of each point."""
BLOCK = 2 * 10**7
"""Waypoints times limits that are looked at together."""


class Waypoints(NamedTuple):
    """Places of a run: instants in s, joint values (m, joints), their rates, and the path parameter of each."""

    time: Array
    joints: Array
    rates: Array
    place: Array


class AllowedAlong(NamedTuple):
    """What limits of contacts allow at each waypoint to each point of a program.

    Attributes
    ----------
    speed, allowed : ndarray (m, points)
        Planned and allowed speed in m/s; inf where nothing limits a point.
    governs : ndarray (m, points) of int
        Row of the limits that governs, -1 for none.
    scale : ndarray (m, points)
        Share of the planned speed that is allowed, at most 1.
    """

    speed: Array
    allowed: Array
    governs: npt.NDArray[np.int64]
    scale: Array


class Runs:
    """Runs of a program; each is computed once."""

    def __init__(self, program: ProgramTask, intervals: int | None, threads: int | None) -> None:
        self.program, self.threads = program, threads
        self.motion: ArmMotion = program.motion.refined(intervals or INTERVALS)
        self.spans = [program.span(place) for place in range(len(program.segments))]
        self._rows: dict[Choice, tuple[Exposure, ...]] = {}
        self._runs: dict[object, Retimed] = {}
        self._exposer = Exposer(program.motion.arm, program.coverings, program.strains)
        self.planned: Choice = tuple(each.covering for each in program.points)
        nodes = self.motion.curve.nodes
        value, first, _ = self.motion.curve.at(nodes)
        found = self.contact(None).masses(value, first, body_masses=np.zeros(0), threads=threads)
        own = found["mass_along_motion" if program.direction == "motion" else "mass_worst_normal"]
        points = range(len(program.points))
        self._masses = [self._range(own[:, index]) for index in points]
        self._drives = [self._pushing(value, found["velocity"][:, index], index) for index in points]

    @property
    def everywhere(self) -> tuple[float, float]:
        """Path parameter of the whole path and beyond."""
        return -np.inf, np.inf

    def _pushing(self, joints: Array, velocity: Array, index: int) -> Drive | None:
        """Return the drive of a point, with the largest push of the torques of the joints along the path."""
        drive = self.program.drive
        if drive is None or drive.model == "none":
            return None
        moving = np.linalg.norm(velocity, axis=1) > 0.0
        if drive.joint_torques is None or not moving.any():
            return drive
        point = self.program.points[index]
        pushes = push_limit_of_torques(
            self.program.motion.arm,
            joints[moving],
            drive.joint_torques,
            link=point.link,
            point=point.point,
            direction=velocity[moving],
        )
        return drive.with_push_limit(float(np.max(pushes)))

    def _range(self, own: Array) -> Masses:
        """Return the range of the masses of a point that count along the path."""
        iso = self.program.motion.arm.iso_mass
        moving = own[np.isfinite(own)]
        if self.program.robot_mass == "iso" or not len(moving):
            return Masses(iso, iso)
        least, most = float(moving.min()), float(moving.max())
        if self.program.robot_mass == "larger":
            least, most = max(least, iso), max(most, iso)
        return Masses(least, most)

    def drive(self, index: int) -> Drive | None:
        """Return what pushes a clamped part of a body at a point; ``None`` where nothing is known."""
        return self._drives[index]

    def coverings(self, name: str | None) -> Choice:
        """Return the choice of one covering, or none, on all points."""
        return (name,) * len(self.program.points)

    def rows(self, choice: Choice) -> tuple[Exposure, ...]:
        """Return the limits of the contacts with a choice of coverings."""
        if choice not in self._rows:
            self._rows[choice] = tuple(self._limits(choice))
        return self._rows[choice]

    def _limits(self, choice: Choice) -> list[Exposure]:
        program = self.program
        found: list[Exposure] = []
        for number, segment in enumerate(program.segments):
            classes = CONTACTS if segment.clamped else ("transient",)
            first, last = self.spans[number]
            for region in segment.regions:
                of_set = region in program.limits.regions
                whole, area = (region, None) if of_set else (_region_of(program, region), region)
                for each in classes:
                    limit = program.limits.contact(whole, each, area=area)
                    for index, point in enumerate(program.points):
                        place: dict[str, Any] = {"point": index, "segment": number, "first": first, "last": last}
                        place["human_speed"] = segment.human_speed
                        found += self._exposer.rows(
                            point, limit, choice[index], self._drives[index], self._masses[index], place
                        )
        return found

    def contact(
        self, choice: Choice | None, speeds: tuple[tuple[float, float, float], ...] = ()
    ) -> _hrsafety.ProgramContact:
        """Return the limits of contacts and of the tool center point as the core reads them.

        Parameters
        ----------
        choice : tuple of str or None
            Coverings; ``None``: no limits of contacts.
        speeds : tuple of (float, float, float)
            Further speeds of the tool center point, each with its part of the path.
        """
        program = self.program
        caps = speeds if program.tcp_speed is None else ((program.tcp_speed, *self.everywhere), *speeds)
        return native_contact(
            program.motion.arm,
            program.points,
            () if choice is None else self.rows(choice),
            rule=program.robot_mass,
            direction=program.direction,
            tcp=(str(program.link), program.point),
            speeds=caps,
        )

    def retimed(
        self,
        choice: Choice | None,
        speeds: tuple[tuple[float, float, float], ...] = (),
        path_speed: Array | None = None,
    ) -> Retimed:
        """Return the fastest run within the limits of the joints, and of contacts with a choice of coverings.

        Parameters
        ----------
        choice, speeds
            As for `contact`.
        path_speed : ndarray (n,) or None
            Largest ds/dt of each interval of `motion`.
        """
        key = (choice, speeds, None if path_speed is None else path_speed.tobytes())
        if key not in self._runs:
            caps = np.full(len(self.motion.curve.coefficients), np.inf) if path_speed is None else path_speed
            contact = self.contact(choice, speeds)
            self._runs[key] = self.motion.retimed(contact, path_speed=caps, threads=self.threads)
        return self._runs[key]

    def allowed(self, waypoints: Waypoints) -> AllowedAlong:
        """Return what the limits with the planned coverings allow at waypoints."""
        contact = self.contact(self.planned)
        found = contact.allowed(waypoints.joints, waypoints.rates, waypoints.place, threads=self.threads)
        own = slice(len(self.program.points))
        return AllowedAlong(*(found[name][:, own] for name in ("speed", "lowest", "governs", "scale")))

    def waypoints(self) -> Waypoints:
        """Return the planned run: the log, or the moves at the limits of the joints and of the tool center point."""
        motion = self.program.motion
        if motion.log is not None and motion.place is not None:
            return Waypoints(motion.log.time, motion.log.joints, motion.log.rates, motion.place)
        return along(self.retimed(None))


def along(run: Retimed) -> Waypoints:
    """Return the nodes of a run and the middles between them."""
    nodes = run.motion.curve.nodes
    middles = 0.5 * (nodes[:-1] + nodes[1:])
    place = np.insert(nodes, np.arange(1, len(nodes)), middles)
    between = 0.5 * (run.squared_speed[:-1] + run.squared_speed[1:])
    squared = np.insert(run.squared_speed, np.arange(1, len(nodes)), between)
    value, first, _ = run.motion.curve.at(place)
    return Waypoints(run.at_place(place), value, first * np.sqrt(squared)[:, np.newaxis], place)


def _region_of(program: ProgramTask, area: str) -> str:
    """Return the region that an area belongs to, by its name with or without the side of the body."""
    limits = program.limits
    return next(
        region
        for region in limits.regions
        if any(area in (each, each.partition(", ")[0]) for each in limits.areas(region))
    )
