"""A plant for robots with a shield, and people who want to be touched: neither is the simulation of the package.

The robot carries out what `Controller` commands, exactly; what the controller is told of it is wrong, late, dropped, or
comes with a clock that was set back. A strict fault is an instant at which robot and person overlap by less than
0.1 m while the robot moves toward the person faster than 1 mm/s.
"""

from __future__ import annotations

import math
import random
from dataclasses import dataclass

from hrsafety import navigation as nav

SLOWEST = 1e-3
"""Slower than this toward somebody is no fault, in m/s."""
DEEPEST = 0.1
"""A person who overlaps the robot farther walks through it, in m."""
POSE = 0.0035
"""Largest error of the told position of the robot in m."""
SEEN = 0.025
"""Largest error of the told position of a person on each axis in m."""
DROPPED = 0.3
"""Share of updates, and of people in an update, that are dropped."""
PERIODS = (0.01, 0.1, 0.3)
"""Control periods in s."""


class Told:
    """A law that wants whatever velocity it was told last."""

    def __init__(self) -> None:
        self.wanted = (0.0, 0.0)

    def velocity(self, _: nav.Situation) -> tuple[float, float]:
        return self.wanted


@dataclass
class Outcome:
    """How an episode went: largest speed toward a person in contact in m/s, contact while moving, way in m, doubts."""

    toward: float = 0.0
    touched: bool = False
    way: float = 0.0
    updates: int = 0
    off_plan: int = 0

    @property
    def fault(self) -> bool:
        return self.toward > SLOWEST


@dataclass
class Body:
    """Place and heading of the robot."""

    x: float = 0.0
    y: float = 0.0
    heading: float = 0.0
    vx: float = 0.0
    vy: float = 0.0

    def drive(self, command: nav.Command | None, since: float, step: float, wheels: bool) -> None:
        """Move on for a step in s, of a plan that was commanded some time ago; the middle of the step counts."""
        if command is None:
            return
        middle = since + 0.5 * step
        if wheels:
            speed, turn_rate = command.twist_after(middle)
            half = self.heading + 0.5 * turn_rate * step
            moved = (speed * math.cos(half), speed * math.sin(half))
            self.heading += turn_rate * step
            speed = command.twist_after(since + step)[0]
            self.vx, self.vy = speed * math.cos(self.heading), speed * math.sin(self.heading)
        else:
            moved = command.velocity_after(middle)
            self.vx, self.vy = command.velocity_after(since + step)
        self.x += moved[0] * step
        self.y += moved[1] * step


class Pursuer:
    """Somebody who sees the robot and wants to be touched: pursuit with lead, random legs, or circles and a dash."""

    def __init__(self, draw: random.Random, speed: float) -> None:
        self.draw, self.speed = draw, speed
        away, angle = draw.uniform(0.9, 3.5), draw.uniform(-math.pi, math.pi)
        self.x, self.y = away * math.cos(angle), away * math.sin(angle)
        self.lead = draw.uniform(0.0, 0.6)
        self.way = draw.choice(("pursuit", "legs", "dash", "feint"))
        self.side = draw.choice((-1.0, 1.0))
        self.dash_at = draw.uniform(0.3, 1.5)
        self.turn_at, self.course, self.backs, self.bold = 0.0, 0.0, False, draw.uniform(0.0, 1.0)

    def move(self, time: float, step: float, robot: Body) -> None:
        x, y = robot.x + self.lead * robot.vx - self.x, robot.y + self.lead * robot.vy - self.y
        toward = math.atan2(y, x)
        if self.way == "pursuit":
            self.course = toward
        elif self.way == "legs":
            if time >= self.turn_at:
                self.turn_at = time + 0.35
                random_way = self.draw.random() < 0.4
                self.course = self.draw.uniform(-math.pi, math.pi) if random_way else toward
        elif self.way == "dash":
            self.course = toward + (self.side * 1.4 if time < self.dash_at else 0.0)
        else:
            # Backs off while the robot is slow, and meets it head on once it comes.
            if time >= self.turn_at:
                self.turn_at = time + 0.1
                closing = robot.vx * math.cos(toward) + robot.vy * math.sin(toward)
                self.backs = closing > -0.5 * self.bold
            self.course = toward + (math.pi if self.backs else 0.0)
        self.x += self.speed * math.cos(self.course) * step
        self.y += self.speed * math.sin(self.course) * step


def episode(
    seed: int,
    *,
    wheels: bool = False,
    period: float | None = None,
    set_back: tuple[float, float] | None = None,
    takes_all: bool = False,
    foresees: bool = False,
    length: float = 3.0,
) -> Outcome:
    """Return how one adversarial episode went.

    In some the clock is set back by seconds between two bounds, by 1 ms as often as by 1 s. A robot that
    ``takes_all`` carries out the plan of each answer from the update on, also of those that did not count, instead of
    continuing with the last one that did. One that ``foresees`` chooses its own way, whatever the law wants.
    """
    draw = random.Random(seed)
    period = draw.choice(PERIODS) if period is None else period
    fastest, most = draw.uniform(0.3, 1.5), draw.uniform(1.0, 10.0)
    radius, person, speed = draw.uniform(0.15, 0.35), draw.uniform(0.2, 0.5), draw.uniform(0.4, 2.0)
    latency = draw.uniform(0.0, 0.15)
    kind = nav.DifferentialDriveRobot if wheels else nav.HolonomicRobot
    robot = kind(radius=radius, max_speed=fastest, max_acceleration=most)
    shield = nav.Shield(
        person_speed=speed, latency=latency, position_error=math.hypot(SEEN, SEEN), margin=POSE, position_tracking=0.001
    )
    asks = Told()
    yielding = nav.Yielding() if draw.random() < 0.3 and not foresees else None
    foresight = nav.Foresight() if foresees else None
    law = nav.SafeNavigation(asks, shield=shield, yielding=yielding, foresight=foresight)
    controller = nav.Controller(
        law,
        robot,
        (20.0, 0.0),
        start=(0.0, 0.0),
        people=1,
        person_radius=person,
        person_speed=speed,
        control_period=period,
    )
    body, pursuer, found = Body(heading=draw.uniform(-math.pi, math.pi)), Pursuer(draw, speed), Outcome()
    # A constant error of the odometer, or another at each update.
    scale = draw.choice((None, draw.uniform(-0.01, 0.01)))
    # Errors are the largest and lead the robot to the person.
    mean = draw.random() < 0.7
    resets = draw.random() < 0.4
    seen_before = [(0.0, pursuer.x, pursuer.y)]
    time, clock, due, command, ordered = 0.0, 0.0, 0.0, None, 0.0
    while time < length:
        if time >= due - 1e-12:
            due = time + period * (1.0 + draw.uniform(0.0, 0.1))
            if draw.random() < 0.1:
                due += draw.uniform(0.0, 2.0) * period
            if set_back and resets and draw.random() < 0.08:
                # In half of all cases it is set right again with the next update.
                clock = -math.exp(draw.uniform(*map(math.log, set_back)))
            elif clock and draw.random() < 0.5:
                clock = 0.0
            if found.updates == 0 or draw.random() >= DROPPED:
                wrong = draw.uniform(-0.01, 0.01) if scale is None else scale
                toward = math.atan2(pursuer.y - body.y, pursuer.x - body.x)
                angle, off = toward + math.pi, POSE
                if not mean:
                    angle, off = draw.uniform(-math.pi, math.pi), draw.uniform(0.0, POSE)
                place = body.x + off * math.cos(angle), body.y + off * math.sin(angle)
                told = body.vx * (1.0 + wrong), body.vy * (1.0 + wrong)
                asks.wanted = _wanted(draw, body, pursuer, fastest)
                late = latency if mean else draw.uniform(0.0, latency)
                shown = next((row for row in reversed(seen_before) if row[0] <= time - late), seen_before[0])
                people = {}
                if found.updates == 0 or draw.random() >= DROPPED:
                    error = draw.uniform(-SEEN, SEEN), draw.uniform(-SEEN, SEEN)
                    if mean:
                        error = math.copysign(SEEN, math.cos(toward)), math.copysign(SEEN, math.sin(toward))
                    people = {"a": (shown[1] + error[0], shown[2] + error[1], 0.0, 0.0)}
                    if shown[0] < time - latency:
                        people = {"a": (shown[1], shown[2], 0.0, 0.0, shown[0] + clock)}
                answer = controller.update(
                    time + clock, place, told, heading=body.heading if wheels else None, people=people
                )
                found.updates += 1
                found.off_plan += getattr(answer, "robot_off_plan", None) is not None
                # What runs on is the plan, counted from the last update that was accepted.
                if takes_all or answer.timing != "out_of_order":
                    command, ordered = answer, time
        step = min(0.005, 0.25 * period, due - time if due > time else 0.005)
        body.drive(command, time - ordered, step, wheels)
        pursuer.move(time, step, body)
        time += step
        seen_before.append((time, pursuer.x, pursuer.y))
        found.way += math.hypot(body.vx, body.vy) * step
        x, y = pursuer.x - body.x, pursuer.y - body.y
        away = math.hypot(x, y)
        overlap = radius + person - away
        if overlap >= DEEPEST:
            break
        if overlap > 0.0:
            found.touched = True
            found.toward = max(found.toward, (body.vx * x + body.vy * y) / max(away, 1e-12))
    return found


def _wanted(draw: random.Random, body: Body, pursuer: Pursuer, speed: float) -> tuple[float, float]:
    """Return what the law is to want: to the person, across, or anywhere, faster than the robot can."""
    toward = math.atan2(pursuer.y - body.y, pursuer.x - body.x)
    angle = toward + draw.choice((0.0, 0.0, draw.gauss(0.0, 0.7), draw.uniform(-math.pi, math.pi)))
    return 1.2 * speed * math.cos(angle), 1.2 * speed * math.sin(angle)
