"""Measured people and commands of a controller."""

from __future__ import annotations

import itertools
import math
from collections.abc import Hashable
from typing import Literal, NamedTuple

from hrsafety._arguments import Pair, number
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError

__all__ = ["Command", "Sighting"]


class Sighting(NamedTuple):
    """Where a person was measured to be.

    Attributes
    ----------
    x, y : float
        Center in m.
    vx, vy : float or None
        Velocity in m/s; taken for zero when ``None``, which a shield that reckons with velocities refuses.
    time : float or None
        When it was measured, in s. When ``None``: at the update that tells of it, or before, by at most the
        ``latency`` of the shield.
    """

    x: float
    y: float
    vx: float | None = None
    vy: float | None = None
    time: float | None = None


@dataclass(frozen=True, kw_only=True, slots=True)
class Command:
    """Command of a robot until the next update.

    Attributes
    ----------
    force : (float, float)
        In N, before the limits of the robot, as a law asks for it.
    velocity : (float, float)
        To have a control period from now, within the limits, in m/s.
    speed, turn_rate : float or None
        The same for a robot with two wheels, in m/s and rad/s.
    status : {"kept", "changed", "braking", "not_guaranteed", "infeasible"} or None
        What the shield has done with the wanted velocity: commanded it, commanded the nearest verified one, or let
        the robot brake as its last plan ends; ``None`` without parts around the law. ``"not_guaranteed"`` stands
        for the first two where `doubts` is not empty: what is commanded is the best that is known, and a person may be
        moved into. ``"infeasible"``: nothing obeys the rule of the filter in the place of a shield.
    taken_over : bool
        Whether the robot heads for its (local) goal by itself.
    timing : {"regular", "late", "out_of_order", "lost"}
        What became of the update: in time; more than one and a half control periods after the last one; not
        after the last one, so that it counted for nothing and the robot brakes as its last plan ends (as much time
        went by as the clock came on, a control period where it went back or stands, and at least as much as the
        robot is farther on); or without the place of the robot, which then brakes alike. Out of order is, too, an
        update whose robot is farther on in its plan than the time tells, as after a clock that was set back. The
        robot continues with the plan that it has.
    arrived : bool
        Whether the robot is within the arrival tolerance of the goal.
    oldest : float
        Age of the oldest measurement of a person that counts, in s; infinite where it is not known, since the clock
        may have been set back: the robot then stays where it is until he is measured again, or is gone.
    clock_set_back : float or None
        By how much the clock was seen to be set back, at least, in s. The plan that the robot executes, and what the
        shield guarantees, hold on.
    robot_off_plan : (float, float) or None
        How far the robot was measured to be from the plan that it was to execute, in m and m/s beyond the
        ``margin``, ``position_tracking`` and ``velocity_tracking`` of the shield; ``None`` where no measurement
        refutes them. From that instant on nothing is guaranteed; the robot plans from what was measured, with
        twice the tracking errors.
    plan : tuple of (float, (float, float))
        The plan that the robot executes from the update on: seconds since the update, and the velocity in m/s
        (of two wheels speed and turn rate in m/s and rad/s) that it has then; between them it changes evenly, and
        after the last one the robot rests.
    heading : float
        Of a robot with two wheels at the update, in rad.
    faster : tuple of hashable
        Names of those who were measured to be faster than the shield reckons with, by their velocity or by two
        places too far apart for the time between them; what it guarantees does not hold for them.
    accelerated : tuple of hashable
        Names of those whose measured velocity changed faster than the ``person_acceleration`` of the shield; what
        it guarantees does not hold for them.
    velocity_off : tuple of hashable
        Names of those whose places do not fit the velocities that were told: by more than the ``velocity_error`` and
        ``person_acceleration`` of a shield allow, or, for a shield that assumes nothing of velocities, by more than
        0.3 m/s over at least 0.5 s; then yielding and the law are misled, and the shield is not.
    unexpected : tuple of hashable
        Names of those who were first seen where a shield with `Unseen` people reckoned with nobody: they were faster
        than ``person_speed``, came through a wall of the map or out of nothing, or a beam or the pose of the robot was
        less exact than is assumed. What it guarantees does not hold for them.
    lost : tuple of hashable
        Names of those who were not measured within the ``age_limit`` of the controller: until then they were reckoned
        with wherever they could be, now they count no more. They may be anywhere, until they are measured again or
        ``gone`` names them.
    renamed : tuple of hashable
        Names of those who were taken for others, who had other names and were not measured any more, since no person
        keeps his name or there is no room for more: so many are there as before, but who is who is not known.
    unknown_beams : int
        How many beams of the last scan read NaN: there may be something in their directions. What was seen there
        before counts on, ever older.
    unmeasured : bool
        Whether nobody looked for people: neither ``people`` (be it ``{}``) nor ``gone`` was told for more than 1 s, or
        ever; a scan shows a law few of its points. Whoever came meanwhile is not known. Never with room for nobody, or
        a shield with `Unseen` people.
    refuted : tuple of str
        Names of the fields that tell of an assumption of the shield that the measurements of this update refute:
        ``"faster"``, ``"accelerated"``, ``"velocity_off"`` (if the shield assumes anything of velocities),
        ``"unexpected"`` and ``"robot_off_plan"``.
    before : (float, float)
        Velocity at the update as the plan has it, in m/s.
    period, max_acceleration : float
        Control period in s, and the limit of the robot in m/s^2.
    """

    force: Pair
    velocity: Pair
    speed: float | None
    turn_rate: float | None
    status: Literal["kept", "changed", "braking", "not_guaranteed", "infeasible"] | None
    taken_over: bool
    timing: Literal["regular", "late", "out_of_order", "lost"]
    arrived: bool
    oldest: float
    clock_set_back: float | None
    robot_off_plan: Pair | None
    plan: tuple[tuple[float, Pair], ...]
    heading: float
    faster: tuple[Hashable, ...]
    accelerated: tuple[Hashable, ...]
    velocity_off: tuple[Hashable, ...]
    unexpected: tuple[Hashable, ...]
    lost: tuple[Hashable, ...]
    renamed: tuple[Hashable, ...]
    unknown_beams: int
    unmeasured: bool
    refuted: tuple[str, ...]
    before: Pair
    period: float
    max_acceleration: float

    @property
    def doubts(self) -> tuple[str, ...]:
        """Names of all fields for which the shield guarantees nothing: `refuted`, and what is not known."""
        return (*self.refuted, *(name for name in _UNKNOWN if getattr(self, name)))

    def velocity_after(self, seconds: float) -> Pair:
        """Return the velocity to have some time after the update if no other update comes.

        The plan that a shield has verified, as it was: the velocity is taken up evenly within a control period, and
        then the robot brakes to rest. After an update that did not count it is what is left of the plan before. A
        robot that executes it keeps the guarantee of the shield when updates are late or stop.

        Parameters
        ----------
        seconds : float
            Time since the update in s.

        Returns
        -------
        (float, float)
            In m/s.

        Raises
        ------
        InvalidParameterError
            If the time is negative or not finite.
        """
        since = _seconds(seconds)
        rates = self._rates(since)
        if self.speed is None:
            return rates
        heading = self.heading
        for (start, first), (end, last) in itertools.pairwise(self.plan):
            part = min(max(since - start, 0.0), end - start)
            if part == 0.0:
                continue
            change = (last[1] - first[1]) * (part / (end - start))
            heading += part * (first[1] + 0.5 * change)
        return rates[0] * math.cos(heading), rates[0] * math.sin(heading)

    def twist_after(self, seconds: float) -> Pair:
        """Return speed and turn rate of a robot with two wheels as `velocity_after` returns the velocity.

        Parameters
        ----------
        seconds : float
            Time since the update in s.

        Returns
        -------
        (float, float)
            In m/s and rad/s.

        Raises
        ------
        InvalidParameterError
            If the time is negative or not finite, or the robot has no wheels.
        """
        since = _seconds(seconds)
        if self.speed is None:
            raise InvalidParameterError(
                "twist_after", "be asked of a robot with two wheels", None, "take velocity_after"
            )
        return self._rates(since)

    def _rates(self, since: float) -> Pair:
        """Return what the plan has at a time since the update."""
        for (start, first), (end, last) in itertools.pairwise(self.plan):
            if since <= end and end > start:
                share = (since - start) / (end - start)
                return first[0] + (last[0] - first[0]) * share, first[1] + (last[1] - first[1]) * share
        return 0.0, 0.0


_UNKNOWN = ("lost", "renamed", "unknown_beams", "unmeasured")
"""Fields of a command that tell of what is not known."""


def _seconds(value: float) -> float:
    since = number("seconds", value)
    if not 0.0 <= since < math.inf:
        raise InvalidParameterError("seconds", "be finite and not negative", value)
    return since
