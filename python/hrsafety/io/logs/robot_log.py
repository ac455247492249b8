"""A log of a robot: where it was, which people it saw, how late that was, and what is doubtful about it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from typing import Annotated, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, finite
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.datasets.recording import Recording
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.io.reader import Provenance
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plausibility import ResultWarning

__all__ = ["Delay", "PoseJump", "RobotLog", "Scan"]


@displayed
class Delay(NamedTuple):
    """Record time less stamp of the messages of a topic.

    Attributes
    ----------
    median, high, most : float
        Median, 95 % quantile and greatest one, in s.
    """

    median: Annotated[float, "s"]
    high: Annotated[float, "s"]
    most: Annotated[float, "s"]


@displayed
class PoseJump(NamedTuple):
    """Two successive poses between which the robot did not drive.

    Attributes
    ----------
    begin, end : float
        Their times in s.
    length : float
        Way from where its velocity leads to where it was found, in m.
    """

    begin: Annotated[float, "s"]
    end: Annotated[float, "s"]
    length: Annotated[float, "m"]


@displayed
class Scan(NamedTuple):
    """A laser scan.

    Attributes
    ----------
    time : float
        In s.
    frame : str
        Of the sensor.
    angle, distance : ndarray, shape (k,)
        Direction and length of the beams, in rad and in m.
    valid : ndarray of bool, shape (k,)
        Which are finite and within the range of the sensor.
    """

    time: Annotated[float, "s"]
    frame: str
    angle: Annotated[Array, "rad"]
    distance: Annotated[Array, "m"]
    valid: npt.NDArray[np.bool_]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class RobotLog:
    """Poses of a robot over time, and people near it; made by `load_log`.

    Attributes
    ----------
    time : ndarray, shape (n,)
        From the first pose on, in s, increasing.
    position : ndarray, shape (n, 2)
        Of the robot in m.
    heading : ndarray, shape (n,)
        In rad, counter-clockwise.
    twist : ndarray, shape (n, 3)
        Velocity forward and to the left (m/s) and turn rate (rad/s) in the frame of the robot: the last that was
        stored at or before each pose; NaN without one.
    frame : str
        Frame of the positions.
    people : Recording or None
        In the same frame and time.
    people_topic : str
        Where people were reported; empty for those of another file.
    people_time : ndarray, shape (q,)
        Instants in s at which people were reported, with no person in it, too.
    commands : ndarray, shape (c, 4)
        Time (s), velocity forward and to the left (m/s) and turn rate (rad/s) that were asked for.
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
    map : StaticMap or None
        Walls of the last occupancy grid on a topic called ``map`` of a bag, in the same frame.
    source : Provenance
        Format, digest and arguments.
    warnings : tuple of ResultWarning
        What is doubtful.
    """

    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    heading: Annotated[Array, "rad"]
    twist: Array
    frame: str
    people: Recording | None
    source: Provenance
    people_topic: str = ""
    people_time: Annotated[Array, "s"] = field(default_factory=lambda: np.empty(0))
    commands: Array = field(default_factory=lambda: np.empty((0, 4)))
    delay: Mapping[str, Delay] = field(default_factory=dict)
    pose_jumps: tuple[PoseJump, ...] = ()
    time_from: Mapping[str, str] = field(default_factory=dict)
    time_factor: float | None = None
    time_origin: Annotated[float, "s"] = 0.0
    scans: tuple[Scan, ...] = ()
    map: StaticMap | None = None
    warnings: tuple[ResultWarning, ...] = ()

    def __len__(self) -> int:
        """Return the number of poses."""
        return len(self.time)

    @property
    def duration(self) -> float:
        """Time from the first to the last pose in s."""
        return float(self.time[-1] - self.time[0])

    def part(self, begin: float, end: float) -> RobotLog:
        r"""Return what was recorded from one time to another; times stay as they are.

        Parameters
        ----------
        begin, end : float
            In s.

        Returns
        -------
        RobotLog
            With two poses or more.

        Raises
        ------
        InvalidParameterError
            If fewer poses lie between both times.

        Examples
        --------
        >>> import pathlib, tempfile
        >>> from hrsafety import io
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     table = pathlib.Path(folder, "robot.csv")
        ...     _ = table.write_text("t_s,x_m,y_m,yaw_rad\n" + "".join(f"{k / 10},{k / 20},0,0\n" for k in range(9)))
        ...     log = io.load_log(table)
        >>> log.part(0.2, 0.5).time.tolist()
        [0.2, 0.3, 0.4, 0.5]
        """
        span = (finite("begin", begin) - 1e-9, finite("end", end) + 1e-9)

        def inside(time: Array) -> npt.NDArray[np.bool_]:
            return (time >= span[0]) & (time <= span[1])

        rows = inside(self.time)
        if rows.sum() < 2:
            shown = Shown(f"{begin:g} to {end:g} s of {self.time[0]:g} to {self.time[-1]:g} s")
            raise InvalidParameterError("end", "leave two poses or more", shown)
        people = self.people
        if people is not None:
            seen = inside(people.time_s)
            velocity = None if people.velocity is None else people.velocity[seen]
            fields: dict[str, Any] = {
                "time_s": people.time_s[seen],
                "person": people.person[seen],
                "position": people.position[seen],
            }
            people = replace(people, **fields, velocity=velocity) if seen.any() else None
        return replace(
            self,
            **{name: getattr(self, name)[rows] for name in ("time", "position", "heading", "twist")},
            people=people,
            people_time=self.people_time[inside(self.people_time)],
            commands=self.commands[inside(self.commands[:, 0])],
            pose_jumps=tuple(each for each in self.pose_jumps if each.end > span[0] and each.begin < span[1]),
            scans=tuple(each for each in self.scans if span[0] <= each.time <= span[1]),
        )
