"""Replays as MCAP files, with the standard schemas that viewers of robot logs know."""

from __future__ import annotations

import importlib
import math
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

from hrsafety import __version__
from hrsafety._atomic import replacing
from hrsafety._replay.page import frame_rows, least_since, verdicts_of
from hrsafety._replay.record import VERDICTS, PlayedRobot, Replay
from hrsafety.errors import MissingExtraError

__all__ = ["write_mcap"]

MAP = "map"
TALL, LOW = 1.7, 0.3
"""Heights of people and robots in m, of which a plan of the floor tells nothing."""
WALL = (0.23, 0.25, 0.27, 1.0)
PERSON = (0.84, 0.37, 0.0, 0.9)
ROBOT = (0.0, 0.45, 0.7, 1.0)
COLORS = (
    (0.55, 0.58, 0.62, 0.3),
    (0.1, 0.5, 0.22, 0.3),
    (0.85, 0.66, 0.0, 0.35),
    (0.03, 0.34, 0.66, 0.3),
    (0.7, 0.14, 0.1, 0.4),
)
"""Of the swept area, by verdict."""
PATH = (0.0, 0.47, 0.36, 1.0)
UNSEEN = 255
STATE = {
    "type": "object",
    "title": "hrsafety.State",
    "properties": {
        "robot": {"type": "string"},
        "time": {"type": "number", "description": "s"},
        "speed": {"type": ["number", "null"], "description": "m/s"},
        "clearance": {
            "type": ["number", "null"],
            "description": "m, of the surfaces; null where nothing is near or known",
        },
        "clearance_known": {"type": "boolean"},
        "margin": {"type": ["number", "null"], "description": "m, of the shield"},
        "verdict": {"type": "string", "enum": list(VERDICTS)},
        "not_judged": {"type": "string", "description": "why nothing is judged at this instant; empty otherwise"},
    },
}


def write_mcap(replay: Replay, path: Path) -> Path:
    """Write what happened as an MCAP file.

    Parameters
    ----------
    replay : Replay
        What happened.
    path : Path
        Where; its folder must exist.

    Returns
    -------
    Path
        The same path.

    Raises
    ------
    MissingExtraError
        If foxglove-sdk is not installed.
    """
    try:
        foxglove = importlib.import_module("foxglove")
        kinds = importlib.import_module("foxglove.messages")
        channels = importlib.import_module("foxglove.channels")
    except ImportError:
        raise MissingExtraError("an MCAP file needs foxglove-sdk: pip install foxglove-sdk") from None
    with replacing(path) as file:
        context = foxglove.Context()
        writer = foxglove.open_mcap(file, context=context)
        try:
            _Log(replay, kinds, channels, foxglove, context).write()
        finally:
            writer.close()
    return path


class _Log:
    """The channels of a file, and what is written into them."""

    def __init__(self, replay: Replay, kinds: Any, channels: Any, foxglove: Any, context: Any) -> None:
        self.replay, self.kinds = replay, kinds
        time = np.asarray(replay.time, dtype=np.float64)
        self.zero = min(0.0, float(time[0]))  # stamps are not negative
        named = {
            "tf": channels.FrameTransformsChannel,
            "scene": channels.SceneUpdateChannel,
            "map": channels.GridChannel,
            "scan": channels.LaserScanChannel,
            "events": channels.LogChannel,
        }
        self.on = {name: made(f"/{name}", context=context) for name, made in named.items() if self._has(name)}
        many = len(replay.robots) > 1
        self.frames = [f"robot_{index}" if many else "robot" for index in range(len(replay.robots))]
        self.robots = [channels.PoseInFrameChannel(f"/{frame}", context=context) for frame in self.frames]
        self.state = foxglove.Channel("/state", schema=STATE, context=context) if replay.robots else None

    def _has(self, name: str) -> bool:
        if name == "map":
            return any(each.grids for each in self.replay.maps)
        if name == "scan":
            return any(each.scan is not None for each in self.replay.robots)
        return name in ("scene", "events") or bool(self.replay.robots)

    # ---- stamps and shapes ----------------------------------------------------------------------

    def nanoseconds(self, time: float) -> int:
        """Return an instant as log time."""
        return round((time - self.zero) * 1e9)

    def stamp(self, time: float) -> Any:
        """Return an instant as the stamp of a message."""
        return self.kinds.Timestamp(*divmod(self.nanoseconds(time), 1_000_000_000))

    def pose(self, place: Any, angle: float = 0.0, height: float = 0.0) -> Any:
        """Return a place on the floor with a heading."""
        position = self.kinds.Vector3(x=float(place[0]), y=float(place[1]), z=height)
        return self.kinds.Pose(position=position, orientation=self.turn(angle))

    def turn(self, angle: float) -> Any:
        """Return a heading."""
        return self.kinds.Quaternion(x=0.0, y=0.0, z=math.sin(angle / 2.0), w=math.cos(angle / 2.0))

    def color(self, given: tuple[float, float, float, float]) -> Any:
        """Return a color."""
        red, green, blue, alpha = given
        return self.kinds.Color(r=red, g=green, b=blue, a=alpha)

    def cylinder(self, place: Any, radius: float, height: float, color: Any) -> Any:
        """Return an upright body."""
        size = self.kinds.Vector3(x=2.0 * radius, y=2.0 * radius, z=height)
        return self.kinds.CylinderPrimitive(
            pose=self.pose(place, height=0.5 * height), size=size, bottom_scale=1.0, top_scale=1.0, color=color
        )

    def line(self, points: Any, color: Any, thickness: float, *, closed: bool = False, pose: Any = None) -> Any:
        """Return a line on the floor, as wide as told in m, or a few pixels."""
        types = self.kinds.LinePrimitiveLineType
        return self.kinds.LinePrimitive(
            type=types.LineLoop if closed else types.LineStrip,
            pose=self.pose((0.0, 0.0)) if pose is None else pose,
            thickness=thickness or 3.0,
            scale_invariant=thickness == 0.0,
            points=[self.kinds.Point3(x=float(x), y=float(y), z=0.01) for x, y in points],
            color=color,
        )

    def entity(self, time: float, name: str, **parts: Any) -> Any:
        """Return something in the scene, which replaces what had its name."""
        return self.kinds.SceneEntity(timestamp=self.stamp(time), frame_id=MAP, id=name, **parts)

    # ---- messages -------------------------------------------------------------------------------

    def write(self) -> None:
        """Write everything, in the order of time."""
        replay = self.replay
        rows = frame_rows(replay)
        first = float(replay.time[rows[0]])
        self.ground(first)
        people = np.empty((len(replay.time), 0, 2)) if replay.people is None else replay.people
        verdicts = [verdicts_of(each.decisions, replay.time[rows]) for each in replay.robots]
        gaps = [
            np.full(len(rows), np.nan) if each.clearance is None else least_since(np.asarray(each.clearance), rows)
            for each in replay.robots
        ]
        events = sorted(replay.events, key=lambda each: each.time)
        there: set[int] = set()
        for index, row in enumerate(rows.tolist()):
            time = float(replay.time[row])
            while events and events[0].time <= time + 1e-9:
                self.event(events.pop(0))
            now = set(np.flatnonzero(np.isfinite(people[row]).all(axis=1)).tolist())
            entities = [self.person(time, each, people[row, each]) for each in sorted(now)]
            gone = [self.gone(time, self.name(each)) for each in sorted(there - now)]
            there = now
            transforms = []
            for k, robot in enumerate(replay.robots):
                verdict, margin, decision = (values[index] for values in verdicts[k])
                self.tell(time, row, robot, int(verdict), float(margin), float(gaps[k][index]))
                if np.isfinite(robot.position[row]).all():
                    transforms.append(self.robot(time, row, k, robot))
                    entities += self.bodies(time, row, k, robot, int(verdict), int(decision))
                else:
                    gone.append(self.gone(time, self.frames[k]))
            when = self.nanoseconds(time)
            if transforms:
                self.on["tf"].log(self.kinds.FrameTransforms(transforms=transforms), log_time=when)
            if entities or gone:
                update = self.kinds.SceneUpdate(entities=entities, deletions=gone)
                self.on["scene"].log(update, log_time=when)
        for each in events:
            self.event(each)

    def name(self, person: int) -> str:
        """Return what a person is called."""
        return self.replay.names[person] if self.replay.names else f"person {person}"

    def gone(self, time: float, name: str) -> Any:
        """Return that something is no longer in the scene."""
        kind = self.kinds.SceneEntityDeletionType.MatchingId
        return self.kinds.SceneEntityDeletion(timestamp=self.stamp(time), type=kind, id=name)

    def person(self, time: float, index: int, place: Any) -> Any:
        """Return a person as an entity by name."""
        box = (self.replay.boxes or {}).get(index)
        named = [self.kinds.KeyValuePair(key="kind", value=self.replay.kinds[index] if self.replay.kinds else "person")]
        name = self.name(index)
        if box is not None:
            size = self.kinds.Vector3(x=box[0], y=box[1], z=LOW)
            cube = self.kinds.CubePrimitive(
                pose=self.pose(place, box[2], 0.5 * LOW), size=size, color=self.color(PERSON)
            )
            return self.entity(time, name, cubes=[cube], metadata=named)
        radius = 0.25 if self.replay.radius is None else float(self.replay.radius[index])
        return self.entity(
            time, name, cylinders=[self.cylinder(place, radius, TALL, self.color(PERSON))], metadata=named
        )

    def robot(self, time: float, row: int, index: int, robot: PlayedRobot) -> Any:
        """Write the pose of a robot and its scan, and return its transform."""
        place, angle = robot.position[row], 0.0 if robot.heading is None else float(robot.heading[row])
        pose, when = self.pose(place, angle), self.nanoseconds(time)
        message = self.kinds.PoseInFrame(timestamp=self.stamp(time), frame_id=MAP, pose=pose)
        self.robots[index].log(message, log_time=when)
        if robot.scan is not None:
            ranges = [float(each) for each in robot.scan.ranges(row)]
            scan = self.kinds.LaserScan(
                timestamp=self.stamp(time),
                frame_id=self.frames[index],
                pose=self.pose((0.0, 0.0)),
                start_angle=robot.scan.start_angle,
                end_angle=robot.scan.end_angle,
                ranges=ranges,
            )
            self.on["scan"].log(scan, log_time=when)
        shift = self.kinds.Vector3(x=float(place[0]), y=float(place[1]), z=0.0)
        return self.kinds.FrameTransform(
            timestamp=self.stamp(time),
            parent_frame_id=MAP,
            child_frame_id=self.frames[index],
            translation=shift,
            rotation=self.turn(angle),
        )

    def bodies(
        self, time: float, row: int, index: int, robot: PlayedRobot, verdict: int, decision: int
    ) -> Iterator[Any]:
        """Yield the footprint of a robot, what its plan sweeps, and the path of its guide."""
        place, color, frame = robot.position[row], self.color(ROBOT), self.frames[index]
        if robot.footprint:
            pose = self.pose(place, 0.0 if robot.heading is None else float(robot.heading[row]))
            yield self.entity(time, frame, lines=[self.line(robot.footprint, color, 0.03, closed=True, pose=pose)])
        else:
            yield self.entity(time, frame, cylinders=[self.cylinder(place, robot.radius, LOW, color)])
        made = robot.decisions
        if made is None or decision < 0:
            return
        if len(made.plan) and len(made.plan[decision]):
            plan = np.asarray(made.plan[decision])
            swept = self.color(COLORS[verdict])
            parts: dict[str, Any] = {
                "cylinders": [self.cylinder(each, robot.radius, 0.01, swept) for each in plan[[0, -1]]]
            }
            if len(plan) > 1:
                parts["lines"] = [self.line(plan, swept, 2.0 * robot.radius), self.line(plan, color, 0.0)]
            yield self.entity(time, f"{frame} swept area", **parts)
        if len(made.path) and len(made.path[decision]) > 1:
            yield self.entity(time, f"{frame} path", lines=[self.line(made.path[decision], self.color(PATH), 0.0)])

    def tell(self, time: float, row: int, robot: PlayedRobot, verdict: int, margin: float, gap: float) -> None:
        """Write the state of a robot in numbers."""
        part = next((each.reason for each in self.replay.not_judged if each.begin <= time <= each.end), "")
        state = {
            "robot": robot.name,
            "time": time,
            "speed": None if robot.speed is None else _finite(float(robot.speed[row])),
            "clearance": _finite(gap),
            "clearance_known": not math.isnan(gap) and not part,
            "margin": _finite(margin),
            "verdict": VERDICTS[verdict],
            "not_judged": part,
        }
        assert self.state is not None
        self.state.log(state, log_time=self.nanoseconds(time))

    def event(self, event: Any) -> None:
        """Write an event as a line of a log."""
        levels = self.kinds.LogLevel
        level = {"fault": levels.Error, "contact": levels.Warning}.get(event.kind, levels.Info)
        message = self.kinds.Log(
            timestamp=self.stamp(event.time), level=level, message=event.words, name=f"hrsafety {__version__}"
        )
        self.on["events"].log(message, log_time=self.nanoseconds(event.time))

    def ground(self, time: float) -> None:
        """Write what stands, and unobserved floor."""
        lines: list[Any] = []
        cylinders: list[Any] = []
        wall = self.color(WALL)
        for each in self.replay.maps:
            lines += [self.line(part.points, wall, 2.0 * part.radius) for part in each.walls]
            lines += [self.line(outline, wall, 0.0, closed=True) for outline in each.polygons]
            cylinders += [
                self.cylinder((x, y), radius, 1.0, wall) for x, y, radius in np.asarray(each.discs).reshape(-1, 3)
            ]
            for grid in each.grids:
                self.grid(time, grid)
        if lines or cylinders:
            update = self.kinds.SceneUpdate(
                entities=[self.entity(time, "walls", lines=lines, cylinders=cylinders)], deletions=[]
            )
            self.on["scene"].log(update, log_time=self.nanoseconds(time))
        for doubt in dict.fromkeys(each.message for each in self.replay.warnings):
            message = self.kinds.Log(
                timestamp=self.stamp(time), level=self.kinds.LogLevel.Warning, message=doubt, name="hrsafety doubt"
            )
            self.on["events"].log(message, log_time=self.nanoseconds(time))

    def grid(self, time: float, grid: Any) -> None:
        """Write a grid of cells: 0 free, 100 occupied, 255 not seen by anybody."""
        columns = grid.shape[1]
        cells = np.where(grid.occupied, 100, np.where(grid.unseen, UNSEEN, 0)).astype(np.uint8)
        numeric = self.kinds.PackedElementFieldNumericType.Uint8
        side = float(grid.resolution)
        message = self.kinds.Grid(
            timestamp=self.stamp(time),
            frame_id=MAP,
            pose=self.pose(grid.origin, float(grid.yaw)),
            column_count=columns,
            cell_size=self.kinds.Vector2(x=side, y=side),
            row_stride=columns,
            cell_stride=1,
            fields=[self.kinds.PackedElementField(name="occupancy", offset=0, type=numeric)],
            data=cells.tobytes(),
        )
        self.on["map"].log(message, log_time=self.nanoseconds(time))


def _finite(value: float) -> float | None:
    return value if math.isfinite(value) else None
