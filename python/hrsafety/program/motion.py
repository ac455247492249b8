"""Motions of a robot program: a path with stops and dwells, and the fastest way along it within limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field, replace
from itertools import pairwise
from os import PathLike
from typing import Annotated, Any, Self

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, count, instance, numbers, positive, sequence, vector
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.arms import Arm
from hrsafety.arms.doubts import doubts_of_poses
from hrsafety.arms.inputs import poses_of
from hrsafety.arms.rolling import BASE_JOINTS, RollingBase
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.program.curves import JointCurve
from hrsafety.program.moves import Legs, Move, legs_of
from hrsafety.program.recorded import JointLog, checked_log, doubts_of_log, followed, joint_values, read_log
from hrsafety.tables import Columns, Table

__all__ = ["INTERVALS", "ArmMotion", "Retimed", "velocities_of"]

INTERVALS = 2000
"""Intervals that a path is retimed in, at least."""
FEWEST = 40
"""Intervals of a piece between two stops, at least."""
MOST_INTERVALS = 10**6
LOG_STEP = 0.004
"""Step of a joint log in s."""
MOST_LOGGED = 10**6
FASTEST_JOINT = 1e6
"""Largest rate in rad/s or m/s that is taken for one."""
STANDS = 1e-9
"""Slopes of the path of a base that stands are smaller than this."""
PATH_TOLERANCE = 1e-3
REASONS = ("acceleration", "velocity", "contact", "zone")
"""Limits that bind at a place of the path, by the code of the core."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ArmMotion:
    """A path of an arm with the limits of its joints: `from_log`, `from_moves` and `from_waypoints` make one.

    Attributes
    ----------
    arm : Arm
        The arm.
    curve : JointCurve
        Cubics of the path parameter s between nodes.
    stops : tuple of int
        Nodes between the first and the last one at which the robot stands.
    dwells : tuple of float
        Time that it stands at the start, at each stop and at the end, in s.
    velocity, acceleration : ndarray (joints,)
        Limits in rad/s and rad/s^2, or m/s and m/s^2 where a joint slides; accelerations may be infinite.
    marks : dict of str to (float, float)
        Path parameter where each move begins and ends; none of a log.
    log : JointLog or None
        What was recorded.
    place : ndarray (m,) or None
        Path parameter of each recorded sample.
    residual : float
        Largest distance of a joint from its sample in rad or m, 0 of moves.
    warnings : tuple of ResultWarning
        Doubts about the path.
    """

    arm: Arm
    curve: JointCurve
    stops: tuple[int, ...]
    dwells: tuple[float, ...]
    velocity: Array
    acceleration: Array
    marks: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    log: JointLog | None = None
    place: Array | None = None
    residual: float = 0.0
    warnings: tuple[ResultWarning, ...] = ()

    @classmethod
    def from_log(
        cls,
        arm: Arm,
        log: str | PathLike[str] | None = None,
        *,
        time: npt.ArrayLike | None = None,
        joints: object = None,
        acceleration: object,
        velocity: object = None,
        path_tolerance: float = PATH_TOLERANCE,
    ) -> Self:
        """Return the motion of a joint log.

        The robot stands where every joint is slower than 1/1000 of its limit for 50 ms, and where the path turns by
        more than 90 degrees. Between them a spline of the length of chords, in units of the velocities, follows the
        samples within the tolerance.

        Parameters
        ----------
        arm : Arm
            The arm.
        log : path-like or None
            Table with a column of times and one for each joint, by its name, in rad or m. Columns ``base_x``,
            ``base_y`` and ``base_turn`` are poses of a base that rolls, on the floor.
        time, joints
            Instants in s and values (m, joints), or a mapping by joint, in place of a file; those of a base are ways
            driven, see `RollingBase.ways`.
        acceleration, velocity
            As for `from_moves`.
        path_tolerance : float
            In rad or m.

        Returns
        -------
        ArmMotion
            With the recorded times.

        Raises
        ------
        InvalidParameterError
            If a column is missing, times do not increase, values are degrees, or a limit is out of its range.

        Examples
        --------
        >>> import numpy as np
        >>> from hrsafety import arms, program
        >>> arm = arms.Arm.example()
        >>> time = np.linspace(0.0, 2.0, 501)
        >>> joints = {"turn": 0.5 - 0.5 * np.cos(np.pi * time / 2), "elbow": np.full(501, 1.4)}
        >>> motion = program.ArmMotion.from_log(arm, time=time, joints=joints, acceleration=4.0)
        >>> round(motion.retimed().time, 2)
        1.0
        """
        instance("arm", arm, Arm)
        if (log is None) == (time is None):
            raise InvalidParameterError("log", "be given, or time with joints in its place", log)
        recorded = read_log(log, arm) if log is not None else checked_log(arm, time, joints)
        if log is None and isinstance(joints, Mapping):
            recorded = recorded._replace(base_recorded=not arm.base_joints or any(n in joints for n in arm.base_joints))
        limits = _limits(arm, velocity, acceleration)
        tolerance = positive("path_tolerance", path_tolerance)
        way = followed(recorded, limits[0], tolerance)
        found = cls._of(arm, way.curves, way.dwells, limits, (velocity, acceleration))
        doubts = tuple(doubts_of_log(recorded, arm, *limits))
        doubts = (*found.warnings, *doubts)
        return replace(found, log=recorded, place=way.place, residual=way.residual, warnings=doubts)

    @classmethod
    def from_moves(
        cls,
        arm: Arm,
        moves: Sequence[Move],
        *,
        acceleration: object,
        velocity: object = None,
        link: str | None = None,
    ) -> Self:
        """Return the motion of moves.

        Parameters
        ----------
        arm : Arm
            The arm.
        moves : sequence of Move
            Two at least; the first one is the pose in which the program starts.
        acceleration : float, array_like (joints,) or mapping of str to float
            Largest accelerations of the joints in rad/s^2, or m/s^2 where they slide; inf: no limit.
        velocity : float, array_like (joints,), mapping of str to float, or None
            Largest rates in rad/s or m/s; those of the URDF when ``None``.
        link : str or None
            Link of linear moves that name none; the last one that a joint moves when ``None``.

        Returns
        -------
        ArmMotion
            The path.

        Raises
        ------
        InvalidParameterError
            If a move cannot be made, or a limit is out of its range.

        Examples
        --------
        >>> from hrsafety import arms, program
        >>> arm = arms.Arm.example()
        >>> start = {"turn": 0.0, "shoulder": 0.4, "elbow": 1.4, "wrist_1": -0.2, "wrist_2": 1.2, "wrist_3": 0.0}
        >>> moves = [program.Move(kind="joint", to=start), program.Move(kind="joint", to={"turn": 1.0})]
        >>> motion = program.ArmMotion.from_moves(arm, moves, acceleration=4.0, velocity=2.0)
        >>> round(motion.retimed().time, 6)
        1.0
        """
        instance("arm", arm, Arm)
        rows = [
            instance(f"moves[{place}]", each, Move) for place, each in enumerate(sequence("moves", "be moves", moves))
        ]
        legs: Legs = legs_of(arm, rows, arm.moved_links[-1] if link is None else link)
        limits = _limits(arm, velocity, acceleration)
        found = cls._of(arm, legs.curves, legs.dwells, limits, (velocity, acceleration))
        return replace(found, marks=legs.marks, warnings=(*found.warnings, *legs.warnings))

    @classmethod
    def from_waypoints(
        cls,
        arm: Arm,
        waypoints: object,
        *,
        acceleration: object,
        velocity: object = None,
        knots: npt.ArrayLike | None = None,
    ) -> Self:
        """Return the motion along the cubic spline through poses, not-a-knot at both ends.

        Parameters
        ----------
        arm : Arm
            The arm.
        waypoints : array_like (m, joints) or mapping of str to array_like
            Poses in rad or m.
        acceleration, velocity
            As for `from_moves`.
        knots : array_like (m,) or None
            Path parameter of the poses, increasing; even from 0 to 1 when ``None``.

        Returns
        -------
        ArmMotion
            The path.

        Raises
        ------
        InvalidParameterError, ShapeError
            If poses or knots do not fit each other.

        Examples
        --------
        >>> from hrsafety import arms, program
        >>> motion = program.ArmMotion.from_waypoints(arms.Arm.example(), {"turn": [0.0, 0.5, 1.0]}, acceleration=4.0)
        >>> round(motion.retimed().time, 6)
        1.0
        """
        poses = poses_of(waypoints, instance("arm", arm, Arm).joint_names, "waypoints")
        if poses.ndim != 2 or len(poses) < 2:
            raise ShapeError("waypoints", f"(m, {len(arm.joint_names)}) with two rows or more", poses.shape)
        if not np.isfinite(poses).all():
            raise InvalidParameterError("waypoints", "be finite", float(poses[~np.isfinite(poses)][0]))
        places = np.linspace(0.0, 1.0, len(poses)) if knots is None else vector("knots", knots)
        if len(places) != len(poses):
            raise ShapeError("knots", f"({len(poses)},)", places.shape)
        if not (np.diff(places) > 0.0).all() or not np.isfinite(places).all():
            raise InvalidParameterError("knots", "increase", places.tolist())
        curve = JointCurve.spline(places, poses)
        limits = _limits(arm, velocity, acceleration)
        return cls._of(arm, [curve], [0.0, 0.0], limits, (velocity, acceleration))

    @classmethod
    def _of(
        cls,
        arm: Arm,
        curves: list[JointCurve],
        dwells: list[float],
        limits: tuple[Array, Array],
        given: tuple[object, object],
    ) -> Self:
        for name in arm.base_joints:
            driven = _slope(arm, curves, name)
            for label, values in zip(("velocity", "acceleration"), given, strict=True):
                if driven > STANDS and (values is None or (isinstance(values, Mapping) and name not in values)):
                    rule = "be given: the base drives"
                    raise InvalidParameterError(f"{label}.{name}", rule, Shown("nothing"), "in m/s or rad/s, and per s")
        stops = np.cumsum([len(each.coefficients) for each in curves])[:-1].tolist()
        velocity, acceleration = limits
        curve = JointCurve.joined(curves)
        # A base that rolls drives and turns as far as it likes.
        own = [place for place, name in enumerate(arm.joint_names) if name not in arm.base_joints]
        names, kinds = ([each[place] for place in own] for each in (arm.joint_names, arm.joint_kinds))
        return cls(
            arm=arm,
            curve=curve,
            stops=tuple(stops),
            dwells=tuple(dwells),
            velocity=velocity,
            acceleration=acceleration,
            warnings=doubts_of_poses(curve.at(curve.nodes)[0][:, own], names, kinds),
        )

    @property
    def drives(self) -> bool:
        """Whether the base of the arm drives on the path."""
        return any(_slope(self.arm, [self.curve], name) > STANDS for name in self.arm.base_joints)

    def refined(self, intervals: int = INTERVALS) -> ArmMotion:
        """Return the same motion with intervals of about even length.

        Parameters
        ----------
        intervals : int
            How many there are at least; every piece between two stops has some.

        Returns
        -------
        ArmMotion
            With the nodes of this one among its own.
        """
        count("intervals", intervals, most=MOST_INTERVALS // 2)
        lengths = np.diff(self.curve.nodes)
        edges = [0, *self.stops, len(lengths)]
        parts = np.empty(len(lengths), dtype=np.int64)
        for first, last in pairwise(edges):
            rows = slice(first, last)
            piece = float(lengths[rows].sum())
            longest = min(self.curve.length / intervals, piece / FEWEST)
            parts[rows] = np.maximum(np.ceil(lengths[rows] / longest - 1e-9), 1.0)
        if int(parts.sum()) > MOST_INTERVALS:
            rule = f"need at most {MOST_INTERVALS} intervals"
            raise InvalidParameterError("motion", rule, int(parts.sum()), "fewer pieces between stops")
        ends = np.concatenate([[0], np.cumsum(parts)])
        stops = tuple(int(ends[each]) for each in self.stops)
        return replace(self, curve=self.curve.refined(parts), stops=stops)

    def retimed(
        self,
        contact: Any = None,
        *,
        path_speed: npt.ArrayLike | None = None,
        intervals: int = INTERVALS,
        threads: int | None = None,
    ) -> Retimed:
        """Return the fastest way along the path within the limits of joints, contacts and speeds.

        Accelerations keep their limits on whole intervals, velocities too; contact speeds are looked at again at 16
        places of each one.

        Parameters
        ----------
        contact : native contact of a program or None
            Limits of points, made by `Program.contact`.
        path_speed : array_like (n,) or None
            Largest ds/dt of each interval; the motion is not refined then.
        intervals : int
            As for `refined`.
        threads : int or None
            Number of threads; all cores when ``None``. It changes no bit.

        Returns
        -------
        Retimed
            Times along the path.

        Raises
        ------
        InvalidParameterError
            If a value is out of its range.
        """
        fine = self.refined(intervals) if path_speed is None else self
        found = _hrsafety.program_retime(
            fine.curve.nodes,
            fine.curve.coefficients,
            velocity=fine.velocity,
            acceleration=fine.acceleration,
            stops=np.array(fine.stops, dtype=np.int64),
            contact=contact,
            path_speed=None if path_speed is None else numbers("path_speed", path_speed),
            threads=threads,
        )
        return Retimed(
            motion=fine,
            status=found["status"],
            time=found["time"] + sum(fine.dwells),
            instants=found["t"],
            squared_speed=found["x"],
            largest_share=found["largest_share"],
            contact_share=found["contact_share"],
            reason=found["reason"],
            reason_index=found["reason_index"],
            contact_row=found["contact_row"],
            rounds=found["rounds"],
            standstill=found["standstill"],
            warnings=_doubts(found["status"], found["largest_share"]),
        )


def _slope(arm: Arm, curves: Sequence[JointCurve], joint: str) -> float:
    """Return the largest coefficient of a power of s in the path of a joint, 0 where it stands."""
    column = arm.joint_names.index(joint)
    return max(float(np.abs(each.coefficients[:, 1:, column]).max()) for each in curves)


def _doubts(status: str, share: float) -> tuple[ResultWarning, ...]:
    """Return the doubt whether limits are kept."""
    if status != "not_verified":
        return ()
    message = f"a limit is used to {share:.6g} of itself between the nodes of the retimed path"
    return (ResultWarning("not_verified", "retiming", message),)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Retimed(Table):
    """Times along a path, as fast as its limits allow.

    Attributes
    ----------
    motion : ArmMotion
        The path with the nodes of the intervals.
    status : {"verified", "not_verified", "standstill"}
        Whether every limit is kept at 16 places of each interval; ``"standstill"`` where some limit allows no motion.
    time : float
        Duration with all dwells in s, inf at a standstill.
    instants : ndarray (n + 1,)
        Times of the nodes without dwells, in s.
    squared_speed : ndarray (n + 1,)
        (ds/dt)^2 at the nodes.
    largest_share : float
        Largest share of a limit that is used, 1 at the limit.
    contact_share : ndarray (n,)
        Largest share of the allowed contact speed in each interval.
    reason : ndarray (n,)
        Code of the limit that is used most: 0 acceleration, 1 velocity, 2 contact, 3 path speed.
    reason_index : ndarray (n,)
        Its joint, or row of the contact limits.
    contact_row : ndarray (n,)
        Row of the contact limits that is hardest there, -1 for none.
    rounds : int
        How often caps were lowered after a check.
    standstill : int
        Interval that allows no motion, -1 for none.
    warnings : tuple of ResultWarning
        ``not_verified``: limits may not be kept between the nodes.
    """

    motion: ArmMotion
    status: str
    time: Annotated[float, "s"]
    instants: Annotated[Array, "s"]
    squared_speed: Array
    largest_share: float
    contact_share: Array
    reason: npt.NDArray[np.uint8]
    reason_index: npt.NDArray[np.int64]
    contact_row: npt.NDArray[np.int64]
    rounds: int
    standstill: int
    warnings: tuple[ResultWarning, ...] = ()

    @property
    def stopped(self) -> Array:
        """Times of the nodes with all dwells before them, in s; at a stop the end of its dwell."""
        waits = np.zeros(len(self.instants))
        edges = [0, *self.motion.stops]
        waits[edges] = self.motion.dwells[:-1]
        return np.asarray(self.instants + np.cumsum(waits))

    def at_place(self, place: npt.ArrayLike) -> Array:
        """Return when the robot passes places of the path.

        Parameters
        ----------
        place : array_like
            Path parameter s.

        Returns
        -------
        ndarray
            Times in s without dwells.
        """
        s = np.asarray(place, dtype=np.float64)
        nodes = self.motion.curve.nodes
        at = np.clip(np.searchsorted(nodes, s, side="right") - 1, 0, len(nodes) - 2)
        x0, x1 = self.squared_speed[at], self.squared_speed[at + 1]
        way = np.clip(s - nodes[at], 0.0, None)
        here = x0 + (x1 - x0) * way / (nodes[at + 1] - nodes[at])
        speed = np.sqrt(x0) + np.sqrt(np.maximum(here, 0.0))
        with np.errstate(divide="ignore", invalid="ignore"):
            more = np.where(way > 0.0, 2.0 * way / speed, 0.0)
        return np.asarray(self.instants[at] + more)

    def sampled(self, step: float = LOG_STEP) -> tuple[Array, Array]:
        """Return the motion at even instants, dwells among them.

        Parameters
        ----------
        step : float
            In s.

        Returns
        -------
        tuple of ndarray (m,) and ndarray (m, joints)
            Instants in s and joint values in rad or m; the last one is the end.

        Raises
        ------
        InvalidParameterError
            If the motion does not end, or has more than a million samples.
        """
        step = positive("step", step)
        if not np.isfinite(self.time):
            raise InvalidParameterError("motion", "end", Shown("a standstill: some limit allows no motion"))
        if self.time / step > MOST_LOGGED:
            raise InvalidParameterError("step", f"give at most {MOST_LOGGED} samples", step)
        time = np.append(np.arange(0.0, self.time - 1e-9, step), self.time)
        starts = self.stopped
        at = np.clip(np.searchsorted(starts, time, side="right") - 1, 0, len(self.motion.curve.coefficients) - 1)
        nodes, x = self.motion.curve.nodes, self.squared_speed
        length = nodes[at + 1] - nodes[at]
        u = (x[at + 1] - x[at]) / (2.0 * length)
        inside = np.maximum(time - starts[at], 0.0)
        way = np.sqrt(x[at]) * inside + 0.5 * u * inside**2
        # Behind the end of an interval the robot dwells there.
        beyond = inside >= self.instants[at + 1] - self.instants[at]
        way = np.clip(np.where(beyond, length, way), 0.0, length)
        return time, self.motion.curve.at(nodes[at] + way, at)[0]

    def columns(self) -> Columns:
        """Return the joint log of this motion with a step of 4 ms; of a base that rolls its poses on the floor.

        Returns
        -------
        dict of str to ndarray
            Time and a column for each joint.
        """
        time, joints = self.sampled()
        arm = self.motion.arm
        columns = dict(zip(arm.joint_names, joints.T, strict=True))
        if isinstance(arm.base, RollingBase):
            ways = [columns.get(name, np.zeros(len(time))) for name in BASE_JOINTS]
            columns |= dict(zip(BASE_JOINTS, arm.base.on_floor(np.column_stack(ways)).T, strict=True))
        return {"time": time} | columns


def _limits(arm: Arm, velocity: object, acceleration: object) -> tuple[Array, Array]:
    """Return the largest rates and accelerations of the joints."""
    rates = velocities_of(arm, velocity)
    if acceleration is None:
        raise InvalidParameterError("acceleration", "be given", Shown("nothing"), "no file of an arm has it")
    gains = joint_values("acceleration", acceleration, arm)
    for joint, value in zip(arm.joint_names, gains.tolist(), strict=True):
        if not value > 0.0:
            raise InvalidParameterError(f"acceleration.{joint}", "be above 0", value)
    return rates, gains


def velocities_of(arm: Arm, velocity: object) -> Array:
    """Return the largest rates of the joints, those of the URDF for ``None``."""
    if not arm.free_joints:
        raise InvalidParameterError("arm", "have a joint that moves", arm.name)
    rates = _of_file(arm) if velocity is None else joint_values("velocity", velocity, arm)
    for joint, value in zip(arm.joint_names, rates.tolist(), strict=True):
        if not 0.0 < value <= FASTEST_JOINT:
            rule = f"be finite and above 0, at most {FASTEST_JOINT:g}"
            raise InvalidParameterError(f"velocity.{joint}", rule, value)
    return rates


def _of_file(arm: Arm) -> Array:
    """Return the velocities of the URDF."""
    from xml.etree import ElementTree

    found = {}
    for joint in ElementTree.fromstring(arm.urdf).iter("joint"):
        limit = joint.find("limit")
        if limit is not None:
            found[joint.get("name", "")] = limit.get("velocity", "")
    values = []
    for name in arm.joint_names:
        try:
            value = float(found.get(name, ""))
        except ValueError:
            value = 0.0
        if not value > 0.0:
            if name in (*arm.locked, *arm.base_joints):
                value = 1.0
            else:
                rule = f"be given: the URDF has no limit of velocity for joint {name}"
                raise InvalidParameterError("velocity", rule, Shown("nothing"), "give it by joint in rad/s or m/s")
        values.append(value)
    return np.array(values)
