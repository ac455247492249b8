"""A world of people as the surroundings of a robot that is driven over ROS 2."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import field, replace
from typing import Any

import numpy as np

from hrsafety._arguments import Pair, Parameters, flag, instance, not_negative, number, positive, word
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.maps.outlines import standing
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.sensing.lidar import Lidar
from hrsafety.ros import messages
from hrsafety.ros.base import MovingBase, limits_of
from hrsafety.ros.bus import EVENTS, LATCHED, SENSOR, Bus, Quality
from hrsafety.ros.commands import Commands
from hrsafety.ros.floor import Crowd, largest_step, walk
from hrsafety.ros.messages import Pose, Seen
from hrsafety.ros.record import BusRecord
from hrsafety.ros.scanner import Scanner
from hrsafety.ros.steering import Steering

__all__ = ["Bridge", "Settings"]

_TICK = 0.01
_ODOMETRY, _SCAN, _PEOPLE, _VERDICT = 0.02, 0.05, 0.1, 1.0
"""Periods of topics in s."""
_REPEAT = 0.2
"""Period of the state while lock-step waits for its first command, in s of the wall."""
_ANSWER = 1.0
"""Longest wait for a command in lock-step, in s of the wall."""
_BEHIND = 0.1
"""A world that falls behind the wall by more seconds is late from then on."""
_RESTED, _SLOW = 1.0, 0.05
"""A run ends when the robot has arrived and rested for so many seconds, slower than so many m/s."""
_MARGIN = 2.0
"""Free ground around everything on the map that is published, in m."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Settings(Parameters):
    """How a bridge runs.

    Parameters
    ----------
    lockstep : bool
        Whether every step waits for its command: the same bits for the same world and commands. Else the clock runs
        with that of the wall.
    period : float
        Control period in s: the step of lock-step.
    delay : float
        Time from hearing a command until the robot executes it, in s.
    speed : float
        Seconds of the world in one of the wall, without lock-step.
    lidar : Lidar
        Beams and ranges of the lidar in the middle of the robot; it sees the walls of the world and its people.
    resolution : float
        Of the map that is published, in m.
    commands : {"auto", "twist", "stamped"}
        Messages of velocity commands: as their publisher has them, ``Twist``, or ``TwistStamped``.
    topic : str
        Where they come.
    wait : bool
        Whether people and robot stand until the first command comes; the clock runs meanwhile, but in lock-step.
    stay : bool
        Whether the run continues to its time limit when the robot rests at its goal.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety.ros import Settings
    >>> Settings(lockstep=True).period
    0.05
    """

    lockstep: bool = False
    period: float = 0.05
    delay: float = 0.0
    speed: float = 1.0
    lidar: Lidar = field(default_factory=lambda: Lidar(beams=720, range_max=12.0))
    resolution: float = 0.05
    commands: str = "auto"
    topic: str = "cmd_vel"
    wait: bool = False
    stay: bool = False

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ("lockstep", "wait", "stay"):
            flag(name, getattr(self, name))
        period, delay = positive("period", self.period), not_negative("delay", self.delay)
        speed, size = positive("speed", self.speed), positive("resolution", self.resolution)
        for name, value, low, high, unit in (
            ("period", period, 0.005, 1.0, "s"),
            ("delay", delay, 0.0, 10.0, "s"),
            ("speed", speed, 0.01, 1000.0, ""),
            ("resolution", size, 0.005, 1.0, "m"),
        ):
            if not low <= value <= high:
                raise InvalidParameterError(name, f"be from {low:g} to {high:g} {unit}".rstrip(), number(name, value))
        self._set(period=period, delay=delay, speed=speed, resolution=size)
        instance("lidar", self.lidar, Lidar)
        word("commands", self.commands, ("auto", "twist", "stamped"))
        instance("topic", self.topic, str)


class Bridge:
    """A world on a bus: it publishes what a robot among its people measures, and moves the robot as it is told.

    Parameters
    ----------
    world : World or Scenario
        One robot, whose law drives nothing, its goal, walls, people. A person who reacts to robots reacts to it.
    bus : Bus
        Where topics are published.
    settings : Settings or None
        How it runs.

    Raises
    ------
    InvalidParameterError
        If the world has not one robot, or repeats itself.

    Examples
    --------
    >>> from hrsafety import ros, scenarios  # doctest: +SKIP
    >>> from hrsafety.ros.rcl import connected  # doctest: +SKIP
    >>> with connected("hrsafety") as bus:  # doctest: +SKIP
    ...     run = ros.Bridge(scenarios.load_world("hall.toml"), bus).run()
    """

    def __init__(self, world: World | Scenario, bus: Bus, settings: Settings | None = None) -> None:
        self._world = world = World.of(instance("world", world, World, Scenario))
        if len(world.robots) != 1:
            raise InvalidParameterError("world.robots", "be one robot", len(world.robots))
        self._bus = bus
        self.settings = Settings() if settings is None else instance("settings", settings, Settings)
        (robot,) = world.robots
        self._radius = robot.body.radius
        self._base = MovingBase(limits_of(robot.body), Pose(*robot.start, robot.heading))
        self._commands = Commands(self._base.limits, self.settings.delay, self._warn)
        self._map = standing(world.walls)
        self._scanner = Scanner(replace(self.settings.lidar, map=self._map))
        self._step = self.settings.period if self.settings.lockstep else _SCAN
        self._part = largest_step(world, self._step, at_most=_SCAN)
        # What is scored has the step of the bridge, and is under no law.
        scored = replace(world, step=self._part, robots=[replace(robot, law=None, control_period=None)])
        self.record = BusRecord(scored, self._map)
        self._time, self._offset = 0.0, 0.0
        self._origin = Pose(0.0, 0.0, 0.0)
        self._due = dict.fromkeys(("odometry", "people", "verdict"), 0.0)
        self._answered = False
        self._wishes: deque[tuple[str, Pose | None, str]] = deque(maxlen=16)
        self._rested: float | None = None
        self._crowd = Crowd(np.empty(0, dtype=np.int64), np.empty((0, 2)), np.empty((0, 2)), np.empty(0))
        self._shown: frozenset[str] = frozenset()
        self._begun: float | None = None
        self._late = 0.0
        self._announce()
        self._steering = Steering(bus, self.settings.topic, self.settings.commands, self._hear, self._warn)

    # ---- topics ---------------------------------------------------------------------------------

    def _announce(self) -> None:
        bus = self._bus
        self._tf = bus.has("tf2_msgs/msg/TFMessage")
        self._as_people = bus.has("people_msgs/msg/People")
        self._clock = bus.publisher("/clock", "rosgraph_msgs/msg/Clock", Quality(1, reliable=False))
        self._odometry = bus.publisher("/odom", "nav_msgs/msg/Odometry", Quality(10))
        self._scan = bus.publisher("/scan", "sensor_msgs/msg/LaserScan", SENSOR)
        self._verdict = bus.publisher("/hrsafety/verdict", "diagnostic_msgs/msg/DiagnosticArray", Quality(10))
        if self._as_people:
            self._people = bus.publisher("/people", "people_msgs/msg/People", Quality(10))
        else:
            self._people = bus.publisher("/people_markers", "visualization_msgs/msg/MarkerArray", Quality(10))
        if self._tf:
            self._transforms = bus.publisher("/tf", "tf2_msgs/msg/TFMessage", Quality(100))
            fixed = bus.publisher("/tf_static", "tf2_msgs/msg/TFMessage", LATCHED)
            base, here = "base_footprint", Pose(0.0, 0.0, 0.0)
            fixed(messages.transforms(0.0, (base, "base_link", here, 0.0), (base, "base_scan", here, 0.2)))
        else:
            self._warn("tf2_msgs is not installed: /tf is not published, and /odom is in the frame of the map")
        grid = bus.publisher("/map", "nav_msgs/msg/OccupancyGrid", LATCHED)
        grid(messages.grid(0.0, self._map, self._box(), self.settings.resolution))
        bus.subscribe("/initialpose", "geometry_msgs/msg/PoseWithCovarianceStamped", EVENTS, self._place)
        bus.subscribe("/goal_pose", "geometry_msgs/msg/PoseStamped", EVENTS, self._aim)

    def _box(self) -> tuple[float, float, float, float]:
        """Return the box around walls, people at the start, robot and goal, with a margin."""
        (robot,) = self._world.robots
        points = [robot.start, robot.goal, *(person.start for person in self._world.people)]
        points += [corner for source in self._world.sources for corner in (source.low, source.high)]
        points += self._map.bounds or ()
        (left, low), (right, high) = np.min(points, axis=0), np.max(points, axis=0)
        return float(left - _MARGIN), float(low - _MARGIN), float(right + _MARGIN), float(high + _MARGIN)

    def _warn(self, text: str) -> None:
        self._bus.log("warn", text)

    # ---- what comes -----------------------------------------------------------------------------

    def _hear(self, twist: tuple[float, float, float], stamp: float | None) -> None:
        """Take a velocity command."""
        own = None if stamp is None or stamp == 0.0 else stamp - self._offset
        self._answered |= self._commands.received(twist, own, self._time)

    def _place(self, message: Any) -> None:
        """Put the robot to another place at the next instant, unless a person or an obstacle is there."""
        self._wishes.append(("initialpose", messages.pose_in(message.pose.pose), message.header.frame_id))

    def _aim(self, message: Any) -> None:
        """Take another goal at the next instant."""
        self._wishes.append(("goal_pose", messages.pose_in(message.pose), message.header.frame_id))

    def _grant(self) -> None:
        """Take the places and goals that were asked for, or say why not."""
        while self._wishes:
            topic, pose, frame = self._wishes.popleft()
            refused = self._objection(pose, frame, touching=topic == "initialpose")
            if refused is not None or pose is None:
                self._commands.counts[f"{topic}_refused"] += 1
                self._warn(f"/{topic} is refused: {refused}")
                continue
            self._commands.counts[topic] += 1
            if topic == "goal_pose":
                self.record.aim((pose.x, pose.y))
                continue
            self.record.begin(topic)
            odometry = self._origin.inverse() @ self._base.pose
            self._base = MovingBase(self._base.limits, pose)
            if self._tf:
                self._origin = pose @ odometry.inverse()  # the odometry of a robot that is carried does not jump
            self._commands.forget()
            self.record.note(self._time, self._base, self._crowd, silent=True)

    def _objection(self, pose: Pose | None, frame: str, *, touching: bool) -> str | None:
        """Return why a pose is not taken."""
        if pose is None:
            return "it is not finite, or its quaternion has not the length 1"
        if frame.lstrip("/") not in ("map", ""):
            return f"it is in the frame {frame!r}, not in map"
        left, low, right, high = self._box()
        if not (left <= pose.x <= right and low <= pose.y <= high):
            return "it is not on the map"
        if not touching:
            return None
        if float(self._map.clearance((pose.x, pose.y))) < self._radius:
            return "a wall is there"
        away = np.hypot(*(self._crowd.position - (pose.x, pose.y)).T) - self._crowd.radius
        return "somebody is there" if (away < self._radius).any() else None

    # ---- the run --------------------------------------------------------------------------------

    def run(self) -> BusRecord:
        """Run the world to its end: its time limit, or a rest at the goal.

        Returns
        -------
        BusRecord
            What happened; also in `record` if Ctrl-C ends the run.
        """
        self._steering.look()
        try:
            self.record.legs[-1].diverged = walk(self._world, self._part, self._meet)
        finally:
            pace = None if self.settings.lockstep else self.settings.speed
            several = self._steering.several
            self.record.end(self._commands.counts, late=self._late, several=several, pace=pace)
        return self.record

    def _meet(self, time: float, crowd: Crowd) -> Pair | None:
        """Publish what there is at an instant, and move the robot to the next one."""
        self._time, self._crowd = time, crowd
        if self.settings.wait and time == 0.0:
            self._stand_by()
        self.record.note(time, self._base, crowd, silent=self._commands.silent)
        self._grant()
        if self._over(time):
            return None
        if self.settings.lockstep:
            self._step_with_others(time)
        else:
            self._keep_pace(time)
        return self._base.pose.x, self._base.pose.y

    def _over(self, time: float) -> bool:
        """Return whether the run is over: at its time limit, or after a rest at the goal."""
        rests = self.record.arrived and math.hypot(*self._base.twist[:2]) < _SLOW
        self._rested = (time if self._rested is None else self._rested) if rests else None
        rested = self._rested is not None and time - self._rested >= _RESTED - 1e-9 and not self.settings.stay
        return rested or time >= self._world.time_limit - 1e-9

    def _is_due(self, name: str, period: float, time: float) -> bool:
        if time < self._due[name] - 1e-9:
            return False
        self._due[name] = max(self._due[name] + period, time)
        return True

    def _step_with_others(self, time: float) -> None:
        """Publish everything at the start of a control period, wait for its command, and move."""
        answered = self.settings.wait and time == 0.0  # while everybody stood
        if not answered and abs(time / self._step - round(time / self._step)) < 1e-6:
            self._answered = False
            self._publish_crowd(time)
            self._publish_scan(time, self._step)
            self._publish_robot(time)
            self._publish_verdict(time)
            self._clock(messages.clock(self._offset + time))
            self._await_command()
        self._advance(time, time + self._part)

    def _await_command(self) -> None:
        """Wait for a command that answers, at most a second of the wall."""
        bus = self._bus
        until = bus.wall() + _ANSWER
        while not self._answered and (left := until - bus.wall()) > 0.0:
            bus.spin(min(left, 0.05))
            self._steering.look()
        if not self._answered:
            self._commands.counts["lockstep_timeout"] += 1
            if self._commands.counts["lockstep_timeout"] == 1:
                self._warn(f"no velocity command came within {_ANSWER:g} s of the wall: the step continues without")

    def _keep_pace(self, time: float) -> None:
        """Publish what is due at an instant, and move with the clock of the wall."""
        self._publish_scan(time, _SCAN)
        if self._is_due("people", _PEOPLE, time):
            self._publish_crowd(time)
        self._publish_verdict(time)
        ticks = max(1, round(self._part / _TICK))
        for tick in range(ticks):
            now, then = (time + self._part * index / ticks for index in (tick, tick + 1))
            if self._is_due("odometry", _ODOMETRY, now):
                self._publish_robot(now)
            self._clock(messages.clock(self._offset + now))
            self._advance(now, then)
            self._until(then)
        self._steering.look()

    def _until(self, then: float) -> None:
        """Take what comes until the wall shows an instant of the world."""
        bus, speed = self._bus, self.settings.speed
        if self._begun is None:
            self._begun = bus.wall() - self._time / speed
        wanted = self._begun + then / speed
        bus.spin(0.0)
        while (left := wanted - bus.wall()) > 0.0:
            bus.spin(left)
        if left < -_BEHIND:
            self._late -= left
            self._begun -= left  # the world continues from here, slower than it was to
            self._commands.counts["overrun"] += 1
            if self._commands.counts["overrun"] == 1:
                self._warn(f"the world cannot keep up with {speed:g} times real time on this machine")

    def _stand_by(self) -> None:
        """Publish the start until the first command comes; the clock runs, but in lock-step."""
        begun, shown = self._bus.wall(), -math.inf
        self._bus.log("info", f"waiting for the first command on {self.settings.topic}")
        while not self._commands.counts["commands"]:
            now = self._bus.wall()
            if now - shown >= (_REPEAT if self.settings.lockstep else _ODOMETRY):
                shown = now
                self._offset = 1.0 if self.settings.lockstep else now - begun  # a stamp of 0 is none
                self._publish_crowd(0.0)
                self._publish_scan(0.0, _SCAN)
                self._publish_robot(0.0)
                self._clock(messages.clock(self._offset))
            self._bus.spin(_ODOMETRY)
            self._steering.look()

    def _advance(self, begin: float, end: float) -> None:
        """Move the robot, with each command from the instant on at which it is to be executed."""
        now = begin
        while now < end - 1e-9:
            self._base.wanted = self._commands.at(now)
            then = min(max(self._commands.next_change(), now + 1e-6), end)
            self._base.advance(then - now)
            now = then
        self._time = end

    # ---- what goes ------------------------------------------------------------------------------

    def _publish_robot(self, time: float) -> None:
        now = self._offset + time
        pose = self._origin.inverse() @ self._base.pose
        if self._tf:
            edges = (("map", "odom", self._origin, 0.0), ("odom", "base_footprint", pose, 0.0))
            self._transforms(messages.transforms(now, *edges))
        self._odometry(messages.odometry(now, pose, self._base.twist))

    def _publish_scan(self, time: float, period: float) -> None:
        ranges = self._scanner.scan(self._base.pose, self._crowd)
        self._scan(messages.scan(self._offset + time, self._scanner.lidar, ranges, period))

    def _publish_crowd(self, time: float) -> None:
        crowd = self._crowd
        columns = (*crowd.position.T.tolist(), *crowd.velocity.T.tolist(), crowd.radius.tolist())
        seen = list(map(Seen, map(str, crowd.number.tolist()), *columns))
        if self._as_people:
            self._people(messages.people(self._offset + time, seen))
            return
        names = frozenset(each.name for each in seen)
        gone = sorted(self._shown - names, key=int)
        self._shown = names
        self._people(messages.markers(self._offset + time, seen, gone))

    def _publish_verdict(self, time: float) -> None:
        if not self._is_due("verdict", _VERDICT, time):
            return
        record, silent = self.record, self._commands.silent
        level, said = (
            (2, "contact")
            if record.touched or record.touched_wall
            else (1, "no command")
            if silent
            else (0, "no contact so far")
        )
        values = {
            "clearance_m": f"{record.nearest:.3f}",
            "people_touched": len(record.touched),
            "wall_touched": record.touched_wall,
            "speed_m_s": f"{math.hypot(*self._base.twist[:2]):.3f}",
            "goal_distance_m": f"{math.dist(self._base.pose[:2], record.goal):.3f}",
            **self._commands.counts,
        }
        self._verdict(messages.diagnostics(self._offset + time, level, said, values))
