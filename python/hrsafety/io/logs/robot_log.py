"""A log of a robot: where it was, whom it saw, how late that was, and what is doubtful about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._records import dataclass
from hrsafety.datasets.recording import Recording
from hrsafety.io.reader import Source
from hrsafety.plausibility import ResultWarning

__all__ = ["Delay", "PoseJump", "RobotLog", "Scan"]


class Delay(NamedTuple):
    """Record time less stamp of the messages of a topic, in s.

    Attributes
    ----------
    median, high, most : float
        Median, 95 % quantile and greatest one.
    """

    median: float
    high: float
    most: float


class PoseJump(NamedTuple):
    """Two successive poses between which the robot did not drive.

    Attributes
    ----------
    begin, end : float
        Their times in s.
    length : float
        Way from where its velocity leads to where it was found, in m.
    """

    begin: float
    end: float
    length: float


class Scan(NamedTuple):
    """A laser scan.

    Attributes
    ----------
    time : float
        In s.
    frame : str
        Of the sensor.
    angle, distance : ndarray, shape (k,)
        Beams in rad and m, as measured.
    valid : ndarray of bool, shape (k,)
        Which are finite and within the range of the sensor.
    """

    time: float
    frame: str
    angle: Array
    distance: Array
    valid: npt.NDArray[np.bool_]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RobotLog:
    """Poses of a robot over time, and people near it; made by `load_log`.

    Attributes
    ----------
    time : ndarray, shape (n,)
        Increasing, in s from the first pose.
    position : ndarray, shape (n, 2)
        In m, in ``frame``.
    heading : ndarray, shape (n,)
        In rad, counter-clockwise.
    twist : ndarray, shape (n, 3)
        Velocity forward and to the left in m/s and turn rate in rad/s, in the frame of the robot: the last that was
        stored at or before each pose; NaN without one.
    frame : str
        Frame of the positions.
    people : Recording or None
        In the same frame and time.
    people_topic : str
        Where people were reported; empty for those of another file.
    people_time : ndarray, shape (q,)
        Instants in s at which people were reported, with nobody in it, too.
    commands : ndarray, shape (c, 4)
        Time in s, velocity forward, to the left (m/s) and turn rate (rad/s) that were asked for.
    delay : mapping of str to Delay
        By topic.
    pose_jumps : tuple of PoseJump
        Where the pose was corrected.
    time_from : mapping of str to str
        ``"header.stamp"`` or ``"record time"``, by topic.
    time_factor : float or None
        Simulated seconds in a second where there is a simulated clock.
    time_origin : float
        Time of the first pose as it stands in the log, in s.
    scans : tuple of Scan
        Laser scans, empty unless `load_log` is asked for them.
    source : Source
        Format, digest and arguments.
    warnings : tuple of ResultWarning
        What is doubtful.
    """

    time: Array
    position: Array
    heading: Array
    twist: Array
    frame: str
    people: Recording | None
    source: Source
    people_topic: str = ""
    people_time: Array = field(default_factory=lambda: np.empty(0))
    commands: Array = field(default_factory=lambda: np.empty((0, 4)))
    delay: Mapping[str, Delay] = field(default_factory=dict)
    pose_jumps: tuple[PoseJump, ...] = ()
    time_from: Mapping[str, str] = field(default_factory=dict)
    time_factor: float | None = None
    time_origin: float = 0.0
    scans: tuple[Scan, ...] = ()
    warnings: tuple[ResultWarning, ...] = ()

    def __len__(self) -> int:
        """Return the number of poses."""
        return len(self.time)

    @property
    def duration(self) -> float:
        """Time from the first to the last pose in s."""
        return float(self.time[-1] - self.time[0])
