"""A `Controller` as a node: what is measured comes over ROS 2, and velocity commands go out."""

from __future__ import annotations

import math
from collections import Counter, deque
from collections.abc import Hashable
from typing import Any, NamedTuple

import numpy as np

from hrsafety._arguments import Array, instance
from hrsafety.errors import HrsafetyError, InvalidParameterError
from hrsafety.navigation.controller import Controller
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.maps.outlines import standing
from hrsafety.navigation.robot_command import Command, Sighting
from hrsafety.navigation.sensing.lidar import Lidar, in_meters
from hrsafety.ros.base import STANDING, PlanarTwist
from hrsafety.ros.bus import EVENTS, SENSOR, Bus, Message, Quality
from hrsafety.ros.messages import Pose, pose_in, seconds, stamp, transform_in, twist_in
from hrsafety.ros.steering import STAMPED, TWIST

__all__ = ["SILENT", "LawNode"]

SILENT = 0.5
"""The robot brakes after so many seconds without its odometry or without people."""
_SPARE = 64
"""Places for people who are not in the file."""


class _Known(NamedTuple):
    """Where the robot was: time in s, pose, velocity in the frame of the map in m/s."""

    time: float
    pose: Pose
    velocity: tuple[float, float]


class LawNode:
    """A law on a robot that is seen and told over a bus.

    It starts when it has received the robot and people once, for a person who was not seen is not away, and commands
    at every odometry that comes a control period after the last one.

    Parameters
    ----------
    world : World
        The robot with its law and goal, and the walls that it knows.
    bus : Bus
        Where topics are heard.
    lockstep : bool
        Whether every odometry waits for the people of its instant, and is answered.
    commands : {"auto", "twist", "stamped"}
        Messages to send; ``"auto"``: with stamps.
    topic : str
        Where they go.
    complete : bool
        Whether everybody who is there is in every message: whoever is in it no more has left. Else a person who is not
        seen any more may be anywhere, as of `Controller`.
    age_limit : float or None
        As of `Controller`.

    Raises
    ------
    InvalidParameterError
        If the world has not one robot with a law, or the law cannot drive it.
    """

    def __init__(
        self,
        world: World,
        bus: Bus,
        *,
        lockstep: bool = False,
        commands: str = "auto",
        topic: str = "cmd_vel",
        complete: bool = False,
        age_limit: float | None = 30.0,
    ) -> None:
        self._world, self._bus, self._age_limit = instance("world", world, World), bus, age_limit
        if len(world.robots) != 1 or world.robots[0].law is None:
            raise InvalidParameterError("world.robots", "be one robot with a law", len(world.robots))
        (robot,) = world.robots
        self._period = world.step if robot.control_period is None else robot.control_period
        self._lockstep, self._complete = lockstep, complete
        self._logged: set[str] = set()
        self.counts: Counter[str] = Counter()
        self._goal = robot.goal
        self._poses: deque[_Known] = deque(maxlen=64)
        self._scan: tuple[float, Array] | None = None
        self._lidar: Lidar | None = None
        self._frames: dict[str, tuple[str, Pose | None, bool]] = {}  # parent, pose in it, whether it keeps up there
        self._base = "base_footprint"
        self._framed = bus.has("tf2_msgs/msg/TFMessage")
        self._people: deque[tuple[float, dict[str, Sighting]]] = deque(maxlen=64)
        self._gone: set[Hashable] = set()
        self._seen_at, self._done_at = -math.inf, -math.inf
        self._heard_at = bus.wall()
        self._controller = self._made(robot.start)
        self.last: Command | None = None
        self._answer: Message | None = None
        self._stamped = commands != "twist"
        self._send = bus.publisher(topic, STAMPED if self._stamped else TWIST, Quality(10))
        # People first: a node hands over messages in this order where several have come.
        if bus.has("people_msgs/msg/People"):
            bus.subscribe("/people", "people_msgs/msg/People", Quality(10), self._hear_people)
        else:
            bus.subscribe("/people_markers", "visualization_msgs/msg/MarkerArray", Quality(10), self._hear_markers)
        if self._framed:
            fixed = Quality(100, transient_local=True)
            bus.subscribe("/tf_static", "tf2_msgs/msg/TFMessage", fixed, self._hear_transforms)
            bus.subscribe("/tf", "tf2_msgs/msg/TFMessage", Quality(100), self._hear_transforms)
        else:
            text = "/odom is taken to be in the frame of the map, and a lidar in the middle of the robot, looking ahead"
            bus.log("warn", f"tf2_msgs is not installed: {text}")
        bus.subscribe("/scan", "sensor_msgs/msg/LaserScan", SENSOR, self._hear_scan)
        bus.subscribe("/goal_pose", "geometry_msgs/msg/PoseStamped", EVENTS, self._aim)
        bus.subscribe("/odom", "nav_msgs/msg/Odometry", Quality(10), self._hear_robot)

    def _made(self, start: tuple[float, float] | None) -> Controller:
        (robot,) = self._world.robots
        walls = standing(self._world.walls)
        sizes = [*(each.radius for each in self._world.people), *(each.radius for each in self._world.sources)]
        made = Controller(
            robot.law,  # type: ignore[arg-type]  # checked at construction
            robot.body,
            self._goal,
            walls if walls.bounds is not None else None,
            start=start,
            people=len(self._world.people) + _SPARE,
            person_radius=max(sizes, default=0.4),
            control_period=self._period,
            arrival_tolerance=robot.arrival_tolerance,
            lidar=self._lidar,
            age_limit=self._age_limit,
            seed=self._world.seed,
        )
        # With a lidar there are others than without.
        for text in map(str, made.warnings):
            if text not in self._logged:
                self._logged.add(text)
                self._bus.log("warn", text)
        return made

    # ---- what comes -----------------------------------------------------------------------------

    def _hear_people(self, message: Any) -> None:
        time = seconds(message.header.stamp)
        found: dict[str, tuple[float, float, float, float]] = {}
        for each in message.people:
            name = each.name
            while name in found:
                self._count("people_names", f"two people in one message are called {each.name!r}: both are there")
                name += "'"
            found[name] = (each.position.x, each.position.y, each.velocity.x, each.velocity.y)
        self._take(time, message.header.frame_id, {name: Sighting(*four, time) for name, four in found.items()})

    def _hear_markers(self, message: Any) -> None:
        if not message.markers:
            return
        head = message.markers[0].header
        time = seconds(head.stamp)
        there = {f"{each.ns}/{each.id}": each for each in message.markers if each.action == 0}
        self._gone |= {f"{each.ns}/{each.id}" for each in message.markers if each.action == 2} - set(there)
        places = {name: each.pose.position for name, each in there.items()}
        found = {name: Sighting(place.x, place.y, None, None, time) for name, place in places.items()}
        self._take(time, head.frame_id, found)

    def _take(self, time: float, frame: str, found: dict[str, Sighting]) -> None:
        """Keep people until the robot is known at their instant; whoever is not finite was not measured."""
        if frame.lstrip("/") not in ("map", ""):
            self._count("people_frame", f"people are in the frame {frame!r}, not in map: they are not heard")
            return
        if self._complete:
            last = self._people[-1][1] if self._people else {}
            self._gone = (self._gone | set(last) | set(self._controller.people)) - set(found)
        whole = {name: one for name, one in found.items() if all(map(math.isfinite, (each or 0.0 for each in one)))}
        if len(whole) < len(found):
            self._count("people_not_finite", "a person's place is not finite: taken as not measured")
        self._people.append((time, whole))
        self._try()

    def _hear_scan(self, message: Any) -> None:
        """Keep a scan, which tells that a person has left, and what else stands there."""
        ranges = np.asarray(message.ranges, dtype=np.float64)
        place = self._mounting(message.header.frame_id.lstrip("/"))
        if place is None or (self._lidar is None and not self._learn(message, len(ranges), place)):
            return
        if self._lidar is None or not _fits(self._lidar, message) or self._lidar.mounting != place:
            rule = "has other beams, or another place of the lidar, than those before"
            self._count("scan_refused", f"a scan {rule}: it is not used")
            return
        try:
            in_meters("ranges", ranges, self._lidar)
        except InvalidParameterError as error:
            self._count("scan_refused", f"a scan is not used: {error}")
            return
        self._scan = (seconds(message.header.stamp), np.where(ranges >= self._lidar.range_max, np.inf, ranges))
        self._try()

    def _mounting(self, frame: str) -> tuple[float, float, float] | None:
        """Return where a lidar is on the robot by its transforms, in m, m and rad; ``None`` where that is not known."""
        if not self._framed:
            return 0.0, 0.0, 0.0
        place = self._place(frame, self._base)
        if isinstance(place, str):
            self._count("lidar_place", f"scans are not used: the place of the lidar is not known: {place}")
            return None
        return place.x, place.y, math.remainder(place.yaw, math.tau)

    def _place(self, frame: str, root: str) -> Pose | str:
        """Return where a frame is in another one by the transforms, or why that is not known."""
        place, at, passed = Pose(0.0, 0.0, 0.0), frame, set[str]()
        while at != root:
            parent, pose, upright = self._frames.get(at, ("", None, True))
            if pose is None or at in passed:
                return f"no transforms lead from {frame!r} to {root!r}"
            if not upright:
                return f"{at!r} is tilted or upside down"
            passed.add(at)
            place, at = pose @ place, parent
        return place

    def _learn(self, message: Any, beams: int, mounting: tuple[float, float, float]) -> bool:
        """Return whether the lidar of a scan is one that the controller can have."""
        step, most = float(message.angle_increment), float(message.range_max)
        width = step * (beams - 1)
        turns = math.isfinite(width) and width + 1.5 * step > math.tau
        try:
            first = float(message.angle_min)
            view = math.tau if turns else width
            lidar = Lidar(beams=beams, field_of_view=view, angle_min=first, range_max=most, mounting=mounting)
            if not _fits(lidar, message):
                raise InvalidParameterError("angle_increment", "divide a whole turn evenly", step)
            self._lidar = lidar
            self._controller = self._made(self._poses[-1].pose[:2] if self._poses else None)
        except HrsafetyError as error:
            self._lidar = None
            self._count("scan_refused", f"scans are not used: {error}")
            return False
        self._seen_at = -math.inf  # the new controller knows no person yet
        return True

    def _hear_transforms(self, message: Any) -> None:
        for each in message.transforms:
            known = (each.header.frame_id.lstrip("/"), *transform_in(each.transform))
            self._frames[each.child_frame_id.lstrip("/")] = known

    def _hear_robot(self, message: Any) -> None:
        pose = pose_in(message.pose.pose)
        ahead, left, rate = twist_in(message.twist.twist)
        if pose is None or not all(map(math.isfinite, (ahead, left, rate))):
            self._count(
                "odometry_not_finite", "odometry is not finite, or its quaternion has not the length 1: ignored"
            )
            return
        self._base = message.child_frame_id.lstrip("/")
        if self._framed:
            origin = self._place(message.header.frame_id.lstrip("/"), "map")
            if isinstance(origin, str):
                self._count("odometry_frame", f"odometry is not used: its frame is not known in the map: {origin}")
                return
            pose = origin @ pose
        sin, cos = math.sin(pose.yaw), math.cos(pose.yaw)
        velocity = (cos * ahead - sin * left, sin * ahead + cos * left)
        time = seconds(message.header.stamp)
        if self._poses and time <= self._poses[-1].time:
            self._poses.clear()  # a clock that was set back: what was before is not between
        self._poses.append(_Known(time, pose, velocity))
        self._heard_at = self._bus.wall()
        if self._lockstep and time == self._done_at and self._answer is not None:
            self._send(self._answer)  # asked again: the answer did not arrive
            return
        self._try()

    def _aim(self, message: Any) -> None:
        pose = pose_in(message.pose)
        if pose is None or message.header.frame_id.lstrip("/") not in ("map", ""):
            self._count("goal_pose_refused", "/goal_pose is refused: it is not finite, or not in map")
            return
        before, self._goal = self._goal, pose[:2]
        try:
            self._controller = self._made(self._poses[-1].pose[:2] if self._poses else None)
        except HrsafetyError as error:
            self._goal = before
            self._count("goal_pose_refused", f"/goal_pose is refused: {error}")
            return
        self._seen_at = -math.inf  # the new one knows no person yet

    def _count(self, code: str, text: str) -> None:
        self.counts[code] += 1
        if self.counts[code] == 1:
            self._bus.log("warn", text)

    # ---- what goes ------------------------------------------------------------------------------

    def run(self) -> None:
        """Drive until Ctrl-C."""
        while True:
            self._bus.spin(0.05)
            self.watch()

    def watch(self) -> None:
        """Tell the robot to brake where nothing is heard of it any more; in lock-step time stands still meanwhile."""
        if not self._lockstep and self._poses and self._bus.wall() - self._heard_at > SILENT:
            self._count("odometry_silent", f"no odometry for {SILENT:g} s: the robot is told to brake")
            self._tell(self._poses[-1].time, STANDING)
            self._heard_at = self._bus.wall()

    def _instant(self) -> _Known | None:
        """Return where the robot was when a decision is due: at a scan where there are any, else at its odometry."""
        newest, scan = self._poses[-1], self._scan
        if newest.time < self._done_at - SILENT:  # a clock that was set back
            self._done_at, self._scan = -math.inf, None
        if scan is not None and self._done_at < scan[0] <= newest.time:
            return self._at(scan[0])
        if self._lockstep or newest.time < self._done_at + self._period - 1e-3:
            return None
        expected = scan is not None and newest.time - scan[0] < 3.0 * self._period
        return None if expected and newest.time < self._done_at + 2.0 * self._period else newest

    def _at(self, time: float) -> _Known:
        """Return where the robot was, straight between two odometries."""
        after = next(each for each in self._poses if each.time >= time)
        before = next((each for each in reversed(self._poses) if each.time <= time), after)
        share = (time - before.time) / (after.time - before.time) if after.time > before.time else 0.0
        turn = math.remainder(after.pose.yaw - before.pose.yaw, math.tau)

        def between(first: float, last: float) -> float:
            return first + share * (last - first)

        x, y = (between(*ends) for ends in zip(before.pose[:2], after.pose[:2], strict=True))
        vx, vy = (between(*ends) for ends in zip(before.velocity, after.velocity, strict=True))
        return _Known(time, Pose(x, y, before.pose.yaw + share * turn), (vx, vy))

    def _try(self) -> None:
        """Decide if it is time to, and everything is known that a decision waits for."""
        known = self._instant() if self._poses else None
        if known is None:
            return
        now = known.time
        due = [each for each in self._people if each[0] <= now + 1e-9]
        if self._lockstep and not any(abs(time - now) < 1e-6 for time, _ in due):
            return
        self._done_at = now
        self._seen_at = max([self._seen_at, *(time for time, _ in due)])
        self._people = deque((each for each in self._people if each[0] > now + 1e-9), maxlen=64)
        if self._seen_at == -math.inf:
            self._tell(now, STANDING)
            return
        told: dict[Hashable, Sighting] = {}
        for time, found in due:
            told |= {name: one._replace(time=min(time, now)) for name, one in found.items()}
        blind = now - self._seen_at > SILENT
        if blind:
            self._count("people_silent", f"no people for {SILENT:g} s: the robot brakes")
        try:
            self.last = self._controller.update(
                now,
                None if blind else known.pose[:2],
                None if blind else known.velocity,
                heading=known.pose.yaw,
                people=told if due else None,
                gone=self._gone - set(told),
                scan=self._scan[1] if self._scan is not None and self._scan[0] == now and not blind else None,
            )
        except InvalidParameterError as error:
            self._count("not_updated", f"the robot is told to brake: {error}")
            self._tell(now, STANDING)
            return
        self._gone.clear()
        for name in self.last.doubts:
            told_of = f"{name} is {getattr(self.last, name)}"
            self._count(
                f"doubt_{name}", f"{told_of}: as long as it is, the shield guarantees nothing, see Command.{name}"
            )
        self._tell(now, _twist(self.last, known.pose.yaw))

    def _tell(self, time: float, twist: PlanarTwist) -> None:
        fields = {
            "linear": {"x": twist.ahead, "y": twist.left, "z": 0.0},
            "angular": {"x": 0.0, "y": 0.0, "z": twist.rate},
        }
        head = {"frame_id": "base_footprint", "stamp": stamp(time)}
        self._answer = {"header": head, "twist": fields} if self._stamped else fields
        self._send(self._answer)


def _fits(lidar: Lidar, message: Any) -> bool:
    """Return whether the beams of a scan are those of a lidar, each within half of their step."""
    first, step = float(message.angle_min), float(message.angle_increment)
    beams = np.arange(len(message.ranges))
    return len(beams) == lidar.beams and bool(np.abs(lidar.bearings - (first + step * beams)).max() <= 0.5 * abs(step))


def _twist(command: Command, yaw: float) -> PlanarTwist:
    """Return what a base is told: of two wheels speed and turn rate, else the velocity in its own frame."""
    if command.speed is not None and command.turn_rate is not None:
        return PlanarTwist(command.speed, 0.0, command.turn_rate)
    (x, y), sin, cos = command.velocity, math.sin(yaw), math.cos(yaw)
    return PlanarTwist(cos * x + sin * y, cos * y - sin * x, 0.0)
