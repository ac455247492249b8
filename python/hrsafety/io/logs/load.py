"""``load_log``: what kind of log a file is, and the log that comes of it."""

from __future__ import annotations

import hashlib
import os
from collections.abc import Mapping, Sequence
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, checked_text, finite
from hrsafety.datasets.recording import Recording
from hrsafety.errors import FileError, InvalidParameterError, Shown
from hrsafety.io.logs.bags import kind_of_bag, opened
from hrsafety.io.logs.clocks import longest_part, restarted
from hrsafety.io.logs.from_bags import BagLog, lost_doubt
from hrsafety.io.logs.jumps import jump_doubt, pose_jumps
from hrsafety.io.logs.robot_log import RobotLog
from hrsafety.io.logs.tables import form_of, read_poses
from hrsafety.io.people.loading import load_people
from hrsafety.io.reader import Document, Provenance, Reader, reader_of
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["load_log"]

Instants = npt.NDArray[np.int64]
People = Recording | str | PathLike[str] | None

PEOPLE_OFFSET = "people"
"""Key of ``offset`` for people from another file."""


def load_log(
    path: str | PathLike[str],
    *,
    robot: str | None = None,
    people: People = None,
    frame: str = "map",
    offset: Mapping[str, float] | None = None,
    scans: bool = False,
) -> RobotLog:
    r"""Read a log of a robot among people.

    Bags of ROS 1 and 2 (SQLite or MCAP; a file, or a folder with or without ``metadata.yaml``; they need
    rosbags), trajectories of TUM (``t x y z qx qy qz qw``) and EuRoC (``ns,x,y,z,qw,qx,qy,qz``), and tables
    of odometry with a header (time, x, y, yaw; velocity and turn rate may follow). Contents decide, not names.

    In a bag the times are those of the headers. The robot is where the chain of transforms says, at the stamps of its
    odometry: the correction of the map (``map`` to ``odom``) holds until the next one, odometry is linear between two
    stamps. People are moved into ``frame`` at their own stamps.

    Parameters
    ----------
    path : path-like
        File or folder.
    robot : str or None
        Frame of the robot in a bag (``"base_link"``), or a topic of its poses (``"/amcl_pose"``); found by itself when
        ``None``.
    people : Recording, path-like, str or None
        Recorded people in the same clock and frame, a file of them, or of a bag a topic, or where people stand in
        messages of a topic: ``"/topic:agents[] id=id position=pose.position velocity=twist.linear"``. ``None``: the
        topic of the bag that holds people.
    frame : str
        Frame of the result. Logs without frames are taken to be in it.
    offset : mapping of str to float, or None
        Seconds that are added to the stamps of topics of a bag whose clocks differ, or to the times of ``"people"``
        from another file.
    scans : bool
        Whether laser scans of a bag are kept.

    Returns
    -------
    RobotLog
        Times from the first pose on.

    Raises
    ------
    FileError
        If the file breaks a rule of its format, or holds no pose of a robot.
    MissingExtraError
        If it is a bag and rosbags is not installed.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import io
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     table = pathlib.Path(folder, "robot.csv")
    ...     _ = table.write_text("t_s,x_m,y_m,yaw_rad\n" + "".join(f"{k / 10},{k / 20},0,0\n" for k in range(9)))
    ...     log = io.load_log(table)
    >>> len(log), log.duration, [each.code for each in log.warnings]
    (9, 0.8, ['no_people'])
    """
    for name, value in (("robot", robot), ("frame", frame)):
        if value is not None and not checked_text(name, value, "be a name").strip():
            raise InvalidParameterError(name, "be a name", value)
    offsets = _offsets(offset)
    place = Path(os.fspath(path)) if isinstance(path, (str, PathLike)) else path
    arguments: dict[str, Any] = {"robot": robot, "frame": None if frame == "map" else frame, "offset": offsets or None}
    arguments["people"] = people if people is None or isinstance(people, Recording) else os.fspath(people)
    given = {name: value for name, value in arguments.items() if value is not None}
    if isinstance(place, Path) and place.is_dir():
        digest = _digest_of_folder(place)
        return _from_bag(place, Provenance(path=str(path), format="", sha256=digest, arguments=given), offsets, scans)
    document = Document(path)
    reader = reader_of("log", document)
    source = Provenance(path=str(path), format=reader.name, sha256=document.sha256, arguments=given)
    found: RobotLog = reader.read(document, source, offsets, scans)
    return found


def _offsets(offset: Mapping[str, float] | None) -> dict[str, float]:
    if offset is None:
        return {}
    if not isinstance(offset, Mapping):
        raise InvalidParameterError("offset", "be a mapping of topics to seconds", offset)
    return {str(topic): finite(f"offset[{topic!r}]", value) for topic, value in offset.items()}


def _digest_of_folder(place: Path) -> str:
    digest = hashlib.sha256()
    for each in sorted(each for each in place.iterdir() if each.is_file()):
        with each.open("rb") as file:
            digest.update(hashlib.file_digest(file, "sha256").digest())
    return digest.hexdigest()


# ---- bags -----------------------------------------------------------------------------------------------


def _from_bag(place: Path, source: Provenance, offsets: dict[str, float], scans: bool) -> RobotLog:
    given = source.arguments
    people = given.get("people")
    topic = people if isinstance(people, str) and ("[]" in people or not Path(people).exists()) else None
    frame = given.get("frame", "map")
    beside = {} if topic is not None or people is None else {PEOPLE_OFFSET: offsets.pop(PEOPLE_OFFSET, 0.0)}
    with opened(place) as bag:
        found = BagLog(
            bag,
            robot=given.get("robot"),
            people=topic,
            crowded=not beside,
            offsets=offsets,
            scans=scans,
            name=place.name,
        )
        form, walls = bag.format, found.map(frame)
    tree, base, own = found.tree()
    told = found.clocks.cut(own)
    if told:
        tree, base, own = found.tree()
    instants, position, heading = found.robot_poses(tree, base, own, frame)
    twist = found.twist_at(instants)
    delays = found.clocks.delays(own)
    sensors = [name for name in delays if name == tree.edges[own].topic or name in found.odometry_frames]
    sensors += [each.name for each in found.bag.topics if each.type.endswith("/LaserScan")]
    told += found.clocks.doubts(delays, sensors)
    told += found.warnings + _not_finite(found.clocks.lost)
    origin = int(instants[0])
    time = (instants - origin) / 1e9
    fields: dict[str, Any] = {}
    if people is None or topic is not None:
        fields, more = _people_of(found, tree, frame, origin)
        told += more
    commands = [((stamp - origin) / 1e9, *twist) for stamp, twist in found.commands()]
    return _finished(
        (time, position, heading, twist),
        source=Provenance(path=source.path, format=form, sha256=source.sha256, arguments=given),
        frame=frame,
        told=told,
        beside=(people, beside) if beside else None,
        fields={
            **fields,
            "map": walls,
            "commands": np.array(commands, dtype=np.float64).reshape(-1, 4),
            "delay": delays,
            "time_from": found.clocks.time_from(),
            "time_factor": found.clocks.factor(),
            "time_origin": origin / 1e9,
            "scans": tuple(each._replace(time=(each.time - origin) / 1e9) for each in found.scans),
        },
    )


def _not_finite(lost: Mapping[str, int]) -> tuple[ResultWarning, ...]:
    if not lost:
        return ()
    shown = ", ".join(f"{count} from {name}" for name, count in lost.items())
    message = f"poses that are not finite are left out ({shown}): the robot has no pose then"
    return (ResultWarning("missing_positions", "position", message),)


def _people_of(found: BagLog, tree: Any, frame: str, origin: int) -> tuple[dict[str, Any], tuple[ResultWarning, ...]]:
    names, instants, position, velocity, lost, predicted, reports = found.people_rows(tree, frame)
    told = lost_doubt(lost, predicted, len(names) + lost + predicted)
    fields: dict[str, Any] = {
        "people_topic": "" if found.people is None else found.people[0].name,
        "people_time": (np.array(reports, dtype=np.int64) - origin) / 1e9,
    }
    if not names:
        return fields, told
    person = _ids(names)
    order = np.lexsort((person, instants))
    # A tracker that sends a state again sends it with the same stamp: the last one counts.
    last = np.append((np.diff(instants[order]) != 0) | (person[order][1:] != person[order][:-1]), True)
    order = order[last]
    fields["people"] = Recording(
        time_s=(instants[order] - origin) / 1e9,
        person=person[order],
        position=position[order],
        velocity=velocity[order] if np.isfinite(velocity).all() else None,
    )
    return fields, told


def _ids(names: Sequence[str]) -> npt.NDArray[Any]:
    """Return ids as numbers where all are whole numbers that read back the same, else as text."""
    found = np.array(names)
    try:
        whole = found.astype(np.int64)
    except (ValueError, OverflowError):
        return found
    return whole if (whole.astype(found.dtype) == found).all() else found


# ---- tables ---------------------------------------------------------------------------------------------


def _from_table(document: Document, source: Provenance, offsets: dict[str, float], scans: bool) -> RobotLog:
    for name, given in (("robot", source.arguments.get("robot")), ("scans", scans or None)):
        if given is not None:
            raise InvalidParameterError(name, "be left out for a log that is no bag", given)
    table = read_poses(document, source.format)
    told = tuple(document.warnings) + table.warnings
    instants, rows = table.instants, np.arange(len(table.instants))
    first, last, parts = longest_part(instants)
    if parts > 1:
        told += restarted(parts, (instants[last] - instants[first]) / 1e9)
        rows = rows[first : last + 1]
    rows = rows[np.argsort(instants[rows], kind="stable")]
    rows, again = _different(document, table, rows)
    told += again
    origin = int(instants[rows[0]])
    time = (instants[rows] - origin) / 1e9
    people, unknown = source.arguments.get("people"), [name for name in offsets if name != PEOPLE_OFFSET]
    if unknown:
        raise InvalidParameterError("offset", f'name "{PEOPLE_OFFSET}", where a log has no topics', unknown[0])
    return _finished(
        (time, table.position[rows], table.heading[rows], table.twist[rows]),
        source=source,
        frame=source.arguments.get("frame", "map"),
        told=told,
        beside=None if people is None else (people, offsets),
        fields={"time_origin": origin / 1e9, "time_from": {"rows": table.time_column}},
    )


def _different(document: Document, table: Any, rows: npt.NDArray[np.intp]) -> tuple[Any, tuple[ResultWarning, ...]]:
    """Return rows at different instants; equal ones are dropped, and others refused."""
    same = np.diff(table.instants[rows]) == 0
    if not same.any():
        return rows, ()
    first, second = rows[:-1][same], rows[1:][same]
    other = (table.position[first] != table.position[second]).any(axis=1) | (
        table.heading[first] != table.heading[second]
    )
    if other.any():
        row = int(second[int(np.argmax(other))])
        rule = "have one pose at each instant"
        shown = Shown(f"two at {table.instants[row] / 1e9:.9g} s")
        raise document.error("two_positions_at_one_instant", rule, shown, line=int(table.lines[row]))
    message = f"{int(same.sum())} rows repeat the one before and are left out"
    return rows[np.append(True, ~same)], (ResultWarning("repeated_rows", "time", message, safe_side=True),)


# ---- both -----------------------------------------------------------------------------------------------


def _finished(
    poses: tuple[Array, Array, Array, Array],
    *,
    source: Provenance,
    frame: str,
    told: Sequence[ResultWarning],
    beside: tuple[Any, Mapping[str, float]] | None,
    fields: dict[str, Any],
) -> RobotLog:
    """Return the log with its jumps, the people of another file, and all doubts."""
    time, position, heading, twist = poses
    name = Path(source.path).name
    if len(time) < 2:
        rule, remedy = "hold two poses of the robot or more", "a longer recording"
        raise FileError(name, rule, len(time), remedy, code="no_rows")
    if beside is not None:
        fields = fields | _beside(beside[0], beside[1].get(PEOPLE_OFFSET, 0.0), fields.get("time_origin", 0.0))
        people: Recording = fields["people"]
        if people.time_s[0] > time[-1] or people.time_s[-1] < time[0]:
            shown = Shown(f"{people.time_s[0]:g} to {people.time_s[-1]:g} s beside {time[0]:g} to {time[-1]:g} s")
            remedy = 'give both the same clock, or offset={"people": seconds}'
            raise FileError(name, "overlap in time with the people", shown, remedy, code="no_overlap")
    jumps = pose_jumps(time, position, heading, twist)
    told = [*told, *jump_doubt(jumps), *_implausible(time, position, heading)]
    if fields.get("people") is None:
        remedy = "name their topic or file: people="
        message = f"{name} holds no people: nothing can be said about how near the robot came to them; {remedy}"
        told.append(ResultWarning("no_people", "people", message))
    else:
        told += [each for each in fields["people"].warnings if each not in told]
    return RobotLog(
        time=_frozen(time),
        position=_frozen(position),
        heading=_frozen(heading),
        twist=_frozen(twist),
        frame=frame,
        source=source,
        pose_jumps=jumps,
        warnings=tuple(dict.fromkeys(told)),
        **({"people": None} | fields),
    )


def _beside(people: Any, offset: float, origin: float) -> dict[str, Any]:
    """Return people of another file in the time of the robot."""
    if not isinstance(people, Recording):
        people = load_people(people)
    moved = replace(people, time_s=people.time_s + (people.time_origin + offset - origin), time_origin=origin)
    return {"people": moved, "people_time": np.unique(moved.time_s)}


def _implausible(time: Array, position: Array, heading: Array) -> tuple[ResultWarning, ...]:
    """Return doubts about units: speeds and turn rates that no robot has."""
    steps = np.diff(time)
    speed = np.hypot(*np.diff(position, axis=0).T) / steps
    turn = np.abs((np.diff(heading) + np.pi) % (2.0 * np.pi) - np.pi) / steps
    values = {
        "robot_max_speed": max(float(np.quantile(speed, 0.95)), 0.01),
        "robot_max_turn_rate": max(float(np.quantile(turn, 0.95)), 0.01),
        "heading": min(max(float(np.abs(heading).max()) / 3.0, -6.0), 1e9),
    }
    return implausible(values)


def _frozen(array: Array) -> Array:
    array = np.ascontiguousarray(array, dtype=np.float64)
    array.setflags(write=False)
    return array


READERS = [
    Reader(
        name="bag",
        title="bag of ROS 1 or ROS 2 (SQLite, MCAP)",
        recognizes=lambda document: kind_of_bag(document.head) is not None,
        read=lambda document, source, offsets, scans: _from_bag(document.path, source, offsets, scans),
    ),
    *(
        Reader(
            name=form,
            title=title,
            recognizes=lambda document, form=form: form_of(document) == form,  # type: ignore[misc]
            read=_from_table,
        )
        for form, title in {
            "tum": "TUM trajectory: t x y z qx qy qz qw",
            "euroc": "EuRoC trajectory: ns,x,y,z,qw,qx,qy,qz",
            "odometry": "table of odometry with a header",
        }.items()
    ),
]
"""Formats of logs, in the order in which they are asked."""
