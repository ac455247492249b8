"""Runs of a program: as it is planned, at the limits of the joints, and within those of contacts."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.program.contacts import Choice, TaskContacts, Waypoints
from hrsafety.program.motion import INTERVALS, ArmMotion, Retimed
from hrsafety.program.task import ProgramTask

__all__ = ["AllowedAlong", "Runs", "along"]


class AllowedAlong(NamedTuple):
    """Speeds that the limits of contacts allow at each waypoint to each point of a program.

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


class Runs(TaskContacts):
    """Runs of a program; each is computed once."""

    def __init__(self, program: ProgramTask, intervals: int | None, threads: int | None) -> None:
        self.program = program
        self.motion: ArmMotion = program.motion.refined(intervals or INTERVALS)
        value, first, _ = self.motion.curve.at(self.motion.curve.nodes)
        spans = [program.span(place) for place in range(len(program.segments))]
        super().__init__(program, value, first, spans, threads)
        self._runs: dict[object, Retimed] = {}

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
