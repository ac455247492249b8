"""Limits of contacts of a task: found for its points and the masses that its motions have."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array
from hrsafety.contact import Drive, push_limit_of_torques
from hrsafety.program.exposures import Exposer, Exposure, Masses, native_contact
from hrsafety.program.task import ContactTask
from hrsafety.standards.contact_limits import CONTACTS

__all__ = ["BLOCK", "MASSES", "Choice", "TaskContacts", "Waypoints"]

Choice = tuple[str | None, ...]
"""Covering of each point."""
BLOCK = 2 * 10**7
"""Waypoints times limits that are looked at together."""
MASSES = ("mass_along_motion", "mass_worst_normal", "mass_energy")
"""Masses of a point, in their order of size."""


class Waypoints(NamedTuple):
    """Places of a run: instants in s, joint values (m, joints), their rates, and the path parameter of each."""

    time: Array
    joints: Array
    rates: Array
    place: Array


class TaskContacts:
    """Limits of contacts of a task.

    Parameters
    ----------
    program : ContactTask
        The task.
    joints, rates : ndarray (m, joints)
        Poses and directions of motion, from which the range of the masses is known.
    spans : list of (float, float)
        Path parameter where each segment begins and ends.
    threads : int or None
        Number of threads; all cores when ``None``.
    """

    def __init__(
        self,
        program: ContactTask,
        joints: Array,
        rates: Array,
        spans: list[tuple[float, float]],
        threads: int | None,
    ) -> None:
        self.task, self.threads, self.spans = program, threads, spans
        self._rows: dict[Choice, tuple[Exposure, ...]] = {}
        self._exposer = Exposer(program.motion.arm, program.coverings, program.strains)
        self.planned: Choice = tuple(each.covering for each in program.points)
        found = self.contact(None).masses(joints, rates, body_masses=np.zeros(0), threads=threads)
        own = found[self.own]
        points = range(len(program.points))
        self._masses = [self._range(own[:, index]) for index in points]
        self._drives = [self._pushing(joints, found["velocity"][:, index], index) for index in points]

    @property
    def own(self) -> str:
        """Name of the directional mass that counts."""
        return MASSES[0] if self.task.direction == "motion" else MASSES[1]

    @property
    def everywhere(self) -> tuple[float, float]:
        """Path parameter of the whole path and beyond."""
        return -np.inf, np.inf

    def _pushing(self, joints: Array, velocity: Array, index: int) -> Drive | None:
        """Return the drive of a point, with the largest push of the torques of the joints along the path."""
        drive = self.task.drive
        if drive is None or drive.model == "none":
            return None
        moving = np.linalg.norm(velocity, axis=1) > 0.0
        if drive.joint_torques is None or not moving.any():
            return drive
        point = self.task.points[index]
        pushes = push_limit_of_torques(
            self.task.motion.arm,
            joints[moving],
            drive.joint_torques,
            link=point.link,
            point=point.point,
            direction=velocity[moving],
        )
        return drive.with_push_limit(float(np.max(pushes)))

    def _range(self, own: Array) -> Masses:
        """Return the range of the masses of a point that count along the path."""
        iso = self.task.motion.arm.iso_mass
        moving = own[np.isfinite(own)]
        if self.task.robot_mass == "iso" or not len(moving):
            return Masses(iso, iso)
        least, most = float(moving.min()), float(moving.max())
        if self.task.robot_mass == "larger":
            least, most = max(least, iso), max(most, iso)
        return Masses(least, most)

    def drive(self, index: int) -> Drive | None:
        """Return what pushes a clamped part of a body at a point; ``None`` where nothing is known."""
        return self._drives[index]

    def coverings(self, name: str | None) -> Choice:
        """Return the choice of one covering, or none, on all points."""
        return (name,) * len(self.task.points)

    def rows(self, choice: Choice) -> tuple[Exposure, ...]:
        """Return the limits of the contacts with a choice of coverings."""
        if choice not in self._rows:
            self._rows[choice] = tuple(self._limits(choice))
        return self._rows[choice]

    def _limits(self, choice: Choice) -> list[Exposure]:
        program = self.task
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
        program = self.task
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


def _region_of(program: ContactTask, area: str) -> str:
    """Return the region that an area belongs to, by its name with or without the side of the body."""
    limits = program.limits
    return next(
        region
        for region in limits.regions
        if any(area in (each, each.partition(", ")[0]) for each in limits.areas(region))
    )
