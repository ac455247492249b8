"""Joint logs as paths: standstill becomes dwells, what is between them splines of the chord length."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from os import PathLike
from pathlib import Path
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import records
from hrsafety._arguments import Array, numbers, vector
from hrsafety.arms import Arm
from hrsafety.arms.inputs import poses_of
from hrsafety.arms.rolling import BASE_JOINTS, RollingBase
from hrsafety.errors import FileError, InvalidParameterError, ShapeError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.program.curves import JointCurve
from hrsafety.records.units import dimension_of

__all__ = ["MOST_WAYPOINTS", "FollowedLog", "JointLog", "doubts_of_log", "followed", "read_log"]

MOST_WAYPOINTS = 10**6
LARGEST_TURN = 7.0
"""Values of turning joints in rad beyond which degrees are meant."""
STILL = 1e-3
"""Share of the speed of its joint below which a robot stands."""
SHORTEST_DWELL = 0.05
"""Time in s for which it has to."""
THINNED = 0.25
"""Samples nearer to each other than this share of the tolerance are one place of the path."""
FIRST_KNOTS = 4
OFTEN_USED = 10.0
"""A joint is taken to have at most so many times the fastest recorded rate as its velocity, to tell standstill."""
CREEPS = 1e-2
"""Way in rad or m of a joint in a standstill beyond which the robot moves."""
FOLLOWS = 1e-2
"""Largest distance in rad or m of a joint of a log from where the arm has it."""
UNSEEN = 0.25
"""Share of the fastest recorded rate that may stay unseen between two samples."""
FULL_SPEED = 0.1
"""Time in s to the full speed of a joint whose acceleration has no limit."""
MOVING = 0.1
"""Share of the fastest recorded rate at which a robot moves where its log begins or ends."""
PLACES = ("tcp_x", "tcp_y", "tcp_z")
"""Columns of a log that hold the place of the tool center point in m; ``tcp_speed`` holds its speed in m/s."""
FASTER = 1.1
"""Share of the velocity of a joint that no drive exceeds."""
SAME = 1e-9
"""Poses that are no farther apart are the same."""


class JointLog(NamedTuple):
    """A recorded motion: instants in s, joint values (m, joints) with their rates, and the digest of its file.

    Attributes
    ----------
    base_recorded : bool
        Whether the log shows what a base that rolls does.
    tool_speed : ndarray (m,) or None
        Speed of the tool center point in m/s as the controller recorded it.
    """

    time: Array
    joints: Array
    rates: Array
    sha256: str = ""
    base_recorded: bool = True
    tool_speed: Array | None = None


class FollowedLog(NamedTuple):
    """A log as a path.

    Attributes
    ----------
    curves : list of JointCurve
        Pieces between which the robot stands.
    dwells : list of float
        Time in s that it stands before each piece, and behind the last one.
    place : ndarray (m,)
        Path parameter of each sample.
    residual : float
        Largest distance of a joint from its sample, in rad or m.
    """

    curves: list[JointCurve]
    dwells: list[float]
    place: Array
    residual: float


def read_log(path: str | PathLike[str], arm: Arm) -> JointLog:
    """Return a joint log: a table with a column of times and one for each joint, by its name.

    Raises
    ------
    FileError
        If a column is missing, times do not increase, or values are hardly radians.
    """
    record = records.load(path)
    name = Path(path).name
    driven = _driven(arm, record.columns, name)
    columns = []
    for joint in arm.joint_names:
        if joint in arm.base_joints:
            columns.append(np.zeros(len(record.time)) if driven is None else driven[:, BASE_JOINTS.index(joint)])
            continue
        if joint not in record.columns:
            if joint in arm.locked:
                columns.append(np.zeros(len(record.time)))
                continue
            remedy = f"name a column {joint}, in rad or m"
            raise FileError(name, f"have a column for each joint: {joint}", Shown(", ".join(record.columns)), remedy)
        unit = record.units[joint]
        if unit is not None and dimension_of(unit) not in ("angle", "length"):
            raise FileError(f"{name}, column {joint}", "be values of a joint in rad, deg, m or mm", unit)
        columns.append(record.columns[joint])
    _checked_others(arm, record.columns, dict(zip(arm.joint_names, columns, strict=True)), name)
    try:
        log = checked_log(arm, record.time, np.column_stack(columns), f"{name}, column ")
    except InvalidParameterError as error:
        raise error.renamed(f"{name}, column of times") if error.argument == "time" else error from None
    return log._replace(
        sha256=record.source.sha256,
        base_recorded=driven is not None or not arm.base_joints,
        tool_speed=_tool_speed(record.columns, record.time),
    )


def _tool_speed(columns: Mapping[str, Array], time: Array) -> Array | None:
    """Return the speed of the tool center point as it is recorded, or of its recorded places."""
    if "tcp_speed" in columns:
        return np.abs(columns["tcp_speed"])
    if not all(name in columns for name in PLACES):
        return None
    places = np.column_stack([columns[name] for name in PLACES])
    return np.asarray(np.linalg.norm(np.gradient(places, time, axis=0, edge_order=2), axis=1))


def _driven(arm: Arm, columns: Mapping[str, Array], name: str) -> Array | None:
    """Return the ways that the base drives by the poses of its root on the floor; ``None`` if none are recorded."""
    given = [joint for joint in BASE_JOINTS if joint in columns]
    if not isinstance(arm.base, RollingBase):
        for joint in given:
            if joint not in arm.joint_names and np.ptp(columns[joint]) > FOLLOWS:
                rule = "stand still: the robot has no base that rolls"
                raise FileError(f"{name}, column {joint}", rule, Shown("a base that drives"), "give its base and mass")
        return None
    if not given:
        return None
    if len(given) < len(BASE_JOINTS):
        rule = f"have all columns of a base or none: {', '.join(BASE_JOINTS)}, its pose on the floor in m and rad"
        raise FileError(name, rule, Shown(", ".join(given)))
    try:
        return arm.base.ways(np.column_stack([columns[joint] for joint in BASE_JOINTS]))
    except InvalidParameterError as error:
        raise error.renamed(f"{name}, columns {', '.join(BASE_JOINTS)}") from None


def _checked_others(arm: Arm, columns: Mapping[str, Array], own: Mapping[str, Array], name: str) -> None:
    """Refuse columns of joints that move otherwise than the arm lets them: fixed, locked, or following another one."""
    from xml.etree import ElementTree

    for joint in ElementTree.fromstring(arm.urdf).iter("joint"):
        column = columns.get(joint.get("name", ""))
        if column is None:
            continue
        label, mimic = joint.get("name", ""), joint.find("mimic")
        leader = None if mimic is None else own.get(mimic.get("joint", ""))
        if label in own and label not in arm.locked:
            continue
        if mimic is not None and leader is not None:
            expected = float(mimic.get("multiplier", 1.0)) * leader + float(mimic.get("offset", 0.0))
            rule = f"follow {mimic.get('joint')} as the URDF says"
        elif mimic is None:
            expected = np.full(len(column), column[0])
            rule = "not move: the joint is locked or fixed"
        else:
            continue
        off = float(np.abs(column - expected).max())
        if not off <= FOLLOWS:
            raise FileError(f"{name}, column {label}", rule, Shown(f"{off:.3g} rad or m off"))


def checked_log(arm: Arm, time: object, joints: object, prefix: str = "joints.") -> JointLog:
    """Return a recorded motion with its rates.

    Raises
    ------
    InvalidParameterError, ShapeError
        If times do not increase, or values are not finite or hardly radians.
    """
    clock = vector("time", time)
    poses = joints if isinstance(joints, np.ndarray) else poses_of(joints, arm.joint_names)
    poses = numbers("joints", poses)
    if poses.shape != (len(clock), len(arm.joint_names)):
        raise ShapeError("joints", f"({len(clock)}, {len(arm.joint_names)})", poses.shape)
    if not 3 <= len(clock) <= MOST_WAYPOINTS:
        raise InvalidParameterError("time", f"hold 3 to {MOST_WAYPOINTS} instants", len(clock))
    if not np.isfinite(clock).all():
        raise InvalidParameterError("time", "be finite", float(clock[~np.isfinite(clock)][0]))
    back = np.flatnonzero(np.diff(clock) <= 0.0)
    if len(back):
        rule = f"increase from line to line; behind {float(clock[back[0]])!r} it does not"
        raise InvalidParameterError("time", rule, float(clock[back[0] + 1]))
    for place, (joint, kind) in enumerate(zip(arm.joint_names, arm.joint_kinds, strict=True)):
        values = poses[:, place]
        if not np.isfinite(values).all():
            raise InvalidParameterError(f"{prefix}{joint}", "be finite", float(values[~np.isfinite(values)][0]))
        if kind == "turning" and np.isfinite(arm.limits[place]).all() and np.abs(values).max() > LARGEST_TURN:
            rule = f"be within {LARGEST_TURN:g} rad of 0 on a joint that turns"
            worst = float(values[np.argmax(np.abs(values))])
            raise InvalidParameterError(f"{prefix}{joint}", rule, worst, "degrees? write radians, or the unit [deg]")
    return JointLog(clock, poses, np.gradient(poses, clock, axis=0, edge_order=2))


def doubts_of_log(log: JointLog, arm: Arm, velocity: Array, acceleration: Array) -> Iterator[ResultWarning]:
    """Yield what a log may not show, as swings between its samples, and what its joints cannot have done.

    Parameters
    ----------
    log : JointLog
        Recorded motion.
    arm : Arm
        Its joints have velocities: what is faster is hardly the motion of the joint that a column is named by.
    velocity, acceleration : ndarray (joints,)
        Limits of the joints: between two samples a rate may leave what is seen by a quarter of the acceleration times
        the step.
    """
    if not log.base_recorded:
        message = (
            "the log has no columns base_x, base_y and base_turn: the base is taken to be parked, and what it adds to "
            "the speeds of contacts is not seen"
        )
        yield ResultWarning("base_taken_as_parked", "motion.log", message)
    shares = np.abs(log.rates / velocity)
    for column in np.flatnonzero(shares.max(axis=0) > FASTER).tolist():
        joint = arm.joint_names[column]
        message = (
            f"{joint} is recorded at {shares[:, column].max():.3g} times its velocity: is it the column of another "
            "joint, or is its velocity another one?"
        )
        yield ResultWarning("faster_than_drive", f"motion.log.{joint}", message)
    shares = shares.max(axis=1)
    fastest = float(shares.max())
    if fastest == 0.0:
        return
    step = float(np.diff(log.time).max())
    gains = np.where(np.isfinite(acceleration), acceleration, velocity / FULL_SPEED)
    unseen = 0.25 * step * float((gains / velocity).max())
    if unseen > UNSEEN * fastest:
        message = (
            f"the log has steps of up to {step:.3g} s: between two samples a joint may be faster than is seen by "
            f"{100.0 * unseen / fastest:.3g} % of the fastest recorded rate: record every "
            f"{step * UNSEEN * fastest / unseen:.2g} s or oftener"
        )
        yield ResultWarning("coarse_log", "motion.log", message)
    for name, share in (("begins", shares[0]), ("ends", shares[-1])):
        if share > MOVING * fastest:
            message = f"the log {name} while the robot moves: what it does beyond is not seen: record from rest to rest"
            yield ResultWarning("log_in_motion", "motion.log", message)


def followed(log: JointLog, velocity: Array, tolerance: float) -> FollowedLog:
    """Return the path of a log.

    Parameters
    ----------
    log : JointLog
        Recorded motion.
    velocity : ndarray (joints,)
        Largest rates: chords are measured in them.
    tolerance : float
        Largest distance of a joint from a sample in rad or m.

    Raises
    ------
    InvalidParameterError
        If nothing moves.
    """
    steps = np.diff(log.time)
    rates = np.abs(np.diff(log.joints, axis=0)) / steps[:, np.newaxis]
    curves: list[JointCurve] = []
    dwells, worst = [0.0], 0.0
    place = np.zeros(len(log.time))
    length = 0.0
    # Many files have velocities far beyond what the joints do.
    used = min(OFTEN_USED * float((rates / velocity).max()), 1.0)
    slow = np.asarray((rates <= STILL * used * velocity).all(axis=1))
    for first, last, still in _stretches(slow, steps, log.joints):
        if still:
            dwells[-1] += float(log.time[last] - log.time[first])
            place[first : last + 1] = length
            continue
        for begin, end in _between_turns(log.joints[first : last + 1], velocity, tolerance):
            rows = slice(first + begin, first + end + 1)
            joints, added = _from(curves, log.joints[rows])
            curve, own, residual = _fitted(joints, velocity, tolerance)
            place[rows] = length + own[added:]
            if curve is not None:
                curves.append(curve)
                dwells.append(0.0)
                length += curve.length
                worst = max(worst, residual)
            else:
                dwells[-1] += float(log.time[rows.stop - 1] - log.time[rows.start])
    if not curves:
        raise InvalidParameterError("log", "hold a motion", Shown("a robot that stands"))
    return FollowedLog(curves, dwells, place, worst)


def _from(curves: list[JointCurve], joints: Array) -> tuple[Array, int]:
    """Return samples that begin where the path ends so far, and how many were added: a robot may creep as it stands."""
    if not curves:
        return joints, 0
    end = curves[-1].end[0]
    if np.abs(joints[0] - end).max() > SAME:
        return np.vstack([end, joints]), 1
    return np.vstack([end, joints[1:]]), 0


def _stretches(still: npt.NDArray[np.bool_], steps: Array, joints: Array) -> Iterator[tuple[int, int, bool]]:
    """Yield first and last sample of each stretch, and whether the robot stands in it, for long enough and in place."""
    edges = np.flatnonzero(np.diff(still.astype(np.int8))) + 1
    runs = list(zip([0, *edges], [*edges, len(still)], strict=True))
    moving: int | None = None
    for first, last in runs:
        stands = still[first] and float(np.ptp(joints[first : last + 1], axis=0).max()) <= CREEPS
        if stands and float(steps[first:last].sum()) >= SHORTEST_DWELL * (1.0 - 1e-9):
            if moving is not None:
                yield moving, first, False
                moving = None
            yield first, last, True
        elif moving is None:
            moving = first
    if moving is not None:
        yield moving, len(still), False


def _between_turns(joints: Array, velocity: Array, tolerance: float) -> Iterator[tuple[int, int]]:
    """Yield first and last sample of the pieces between which chords turn by more than 90 degrees."""
    if _is_reverse(joints):
        yield from (
            (len(joints) - 1 - last, len(joints) - 1 - first)
            for first, last in reversed(list(_between_turns(joints[::-1], velocity, tolerance)))
        )
        return
    kept = _thinned(joints, tolerance)
    chords = np.diff(joints[kept] / velocity, axis=0)
    turns = kept[1:-1][np.einsum("ij,ij->i", chords[:-1], chords[1:]) < 0.0]
    edges = [0, *turns.tolist(), len(joints) - 1]
    yield from pairwise(edges)


def _is_reverse(joints: Array) -> bool:
    """Whether samples are taken from the last one on: a path and its reverse are followed by the same curve."""
    ahead = (joints - joints[::-1]).ravel()
    apart = np.flatnonzero(np.abs(ahead) > SAME)
    return len(apart) > 0 and bool(ahead[apart[0]] > 0.0)


def _thinned(joints: Array, tolerance: float) -> Array:
    """Return the samples, first and last among them, that are apart from the one before."""
    apart = THINNED * tolerance
    kept = [0]
    rows = joints.tolist()
    here = rows[0]
    for place, row in enumerate(rows):
        if any(abs(a - b) > apart for a, b in zip(row, here, strict=True)):
            kept.append(place)
            here = row
    if kept[-1] != len(rows) - 1:
        # The last one stays; one just before it would be a corner of noise.
        if len(kept) > 1:
            kept.pop()
        kept.append(len(rows) - 1)
    return np.array(kept)


def _fitted(joints: Array, velocity: Array, tolerance: float) -> tuple[JointCurve | None, Array, float]:
    """Return the spline of a piece, the place of each sample and the residual; no curve where nothing moves."""
    if _is_reverse(joints):
        back, own, residual = _fitted(joints[::-1], velocity, tolerance)
        return (None if back is None else back.reversed()), own[-1] - own[::-1], residual
    residual = float("inf")
    for kept in (_thinned(joints, tolerance), np.arange(len(joints))):
        chords = np.linalg.norm(np.diff(joints[kept] / velocity, axis=0), axis=1)
        moved = np.concatenate([[True], chords > 1e-12])
        kept, chords = kept[moved], chords[moved[1:]]
        if len(kept) < 2:
            return None, np.zeros(len(joints)), 0.0
        way = np.concatenate([[0.0], np.cumsum(chords)])
        # Samples between those that count lie at their share of the way in the record.
        own = np.interp(np.arange(len(joints)), kept, way)
        knots = FIRST_KNOTS
        while True:
            even = np.linspace(0.0, way[-1], knots + 1)
            chosen = np.unique(np.clip(np.searchsorted(way, even - 1e-12 * way[-1]), 0, len(way) - 1))
            if len(chosen) >= len(way) or knots >= 4 * len(way):
                chosen = np.arange(len(way))
            curve = JointCurve.spline(way[chosen], joints[kept[chosen]])
            residual = float(np.abs(curve.at(own)[0] - joints).max())
            if residual <= tolerance or len(chosen) == len(way):
                break
            knots *= 2
        if residual <= tolerance:
            break
    return curve, own, residual


def joint_values(name: str, given: object, arm: Arm) -> Array:
    """Return numbers for each joint of an arm: one for all, an array, or a mapping that names every free joint."""
    if isinstance(given, Mapping):
        for joint in given:
            if joint not in arm.joint_names:
                rule = f"name joints of the arm: {', '.join(arm.joint_names)}"
                raise InvalidParameterError(name, rule, joint)
        for joint in arm.free_joints:
            if joint not in given and joint not in arm.base_joints:
                raise InvalidParameterError(f"{name}.{joint}", "be given", Shown("nothing"))
        given = [given.get(joint, 1.0) for joint in arm.joint_names]
    values = numbers(name, given)
    if values.shape not in {(), (len(arm.joint_names),)}:
        raise ShapeError(name, f"({len(arm.joint_names)},)", values.shape)
    return np.broadcast_to(values, len(arm.joint_names)).copy()
