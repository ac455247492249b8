"""Rules of permission for sidewalks: how early a robot makes way, how far it passes, and how calmly."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import fields
from typing import Annotated, NamedTuple

import numpy as np

from hrsafety._arguments import Array, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.navigation.judging.synchronized import Flags, Synchronized
from hrsafety.navigation.judging.touches import runs_of

__all__ = ["Passing", "PermitRules", "passings"]

Jumps = Sequence[Sequence[float]]

SWAY = 1.0
"""Two passings of a person are told apart if the distance grows by so much between them, in m."""
SURE = 3.0
"""A quantity is measurable if its limit is so many standard deviations of its noise."""
KEPT, VIOLATED, NOT_MEASURABLE, NOT_JUDGED = "kept", "violated", "not_measurable", "not_judged"


@dataclass(frozen=True, kw_only=True, slots=True)
class PermitRules:
    """Thresholds of the rules of permission; cities ask for the rules and publish no numbers: these are choices.

    Parameters
    ----------
    encounter_distance : float
        Nearer than this, a person ahead of a robot that moves is encountered, in m.
    least_speed : float
        A slower robot stands, in m/s.
    clearance : float
        Predicted clearance in m that an adjustment must bring.
    lead_time, lead_distance : float
        How long in s before the passing, and how far from the person in m, it must be there.
    passing_clearance, passing_time : float
        Least clearance of a moving robot in m, and what is added to it for each m/s of its speed.
    swerve_time, swerve_distance : float
        Last part of a passing, in s and m, in which the robot must not swerve.
    lateral_acceleration, turn, braking : float
        Limits of a swerve in m/s^2, rad and m/s^2.
    judged_share : float
        Share of an encounter that must be judged before a rule counts as kept.

    Raises
    ------
    InvalidParameterError
        If a threshold is not finite and positive.
    """

    encounter_distance: float = 10.0
    least_speed: float = 0.1
    clearance: float = 0.6
    lead_time: float = 3.0
    lead_distance: float = 4.0
    passing_clearance: float = 0.5
    passing_time: float = 0.2
    swerve_time: float = 1.5
    swerve_distance: float = 2.5
    lateral_acceleration: float = 0.5
    turn: float = 0.35
    braking: float = 1.5
    judged_share: float = 0.95

    def __post_init__(self) -> None:
        """Check the thresholds."""
        for each in fields(self):
            positive(each.name, getattr(self, each.name))


@displayed
class Passing(NamedTuple):
    """A robot that passes a person, and which rules it keeps.

    Attributes
    ----------
    person : int or str
        Who.
    begin, pass_time : float
        Begin of the encounter, and when both are nearest, in s.
    lead_time, lead_distance : float
        How long before, in s and m, the predicted clearance was reached and kept; 0 where it never was.
    robot_lead_time : float
        The same as if the person had kept the first velocity: the share of the robot, in s.
    passing_clearance, required_clearance : float
        Clearance where it falls short most, or exceeds least, what is required there, both in m; NaN without a moving
        robot.
    lateral_acceleration, turn, braking : float
        Largest ones of the last part in m/s^2, rad and m/s^2; NaN where they are not known.
    judged_share : float
        Share of the encounter in which both are known.
    early_adjustment, clearance_kept, no_swerve : str
        ``"kept"``, ``"violated"``, ``"not_measurable"`` (noise is too large) or ``"not_judged"``.
    reason : str
        Why something is not judged.
    """

    person: int | str
    begin: Annotated[float, "s"]
    pass_time: Annotated[float, "s"]
    lead_time: Annotated[float, "s"]
    lead_distance: Annotated[float, "m"]
    robot_lead_time: Annotated[float, "s"]
    passing_clearance: Annotated[float, "m"]
    required_clearance: Annotated[float, "m"]
    lateral_acceleration: Annotated[float, "m/s^2"]
    turn: Annotated[float, "rad"]
    braking: Annotated[float, "m/s^2"]
    judged_share: float
    early_adjustment: str
    clearance_kept: str
    no_swerve: str
    reason: str

    @property
    def kept(self) -> dict[str, str]:
        """Words of the three rules by their names."""
        return {
            "early_adjustment": self.early_adjustment,
            "passing_clearance": self.clearance_kept,
            "no_swerve": self.no_swerve,
        }


def passings(
    both: Synchronized, *, reach: float, rules: PermitRules, bound: Array, jumps: Jumps = (), doubtful: str = ""
) -> list[Passing]:
    """Return every passing in the order of time.

    Parameters
    ----------
    both : Synchronized
        Robot and people.
    reach : float
        Sum of the radii in m.
    rules : PermitRules
        Thresholds.
    bound : ndarray, shape (T, n)
        How near the centers of both may be while one of them is not known, in m; infinite while both are.
    jumps : sequence of (float, float, float)
        Begin, end and length of jumps of the pose, in s and m.
    doubtful : str
        Why nothing counts as kept; empty if it may.
    """
    context = _Context(np.hypot(*both.velocity.T), reach, bound, both.leaps, jumps, doubtful)
    found = [each for column in range(len(both.ids)) for each in _of_person(both, column, rules, context)]
    return sorted(found, key=lambda each: (each.pass_time, str(each.person)))


class _Context(NamedTuple):
    """Speed of the robot (T,), sum of the radii, distances of the unseen, jumps of people and robot, and a doubt."""

    speed: Array
    reach: float
    bound: Array
    leaps: Flags
    jumps: Jumps
    doubtful: str


class _Pair(NamedTuple):
    """A person: number, offset from the robot, distance, velocity, and the last instant at which both are known."""

    column: int
    away: Array
    distance: Array
    velocity: Array
    last: int


def _of_person(both: Synchronized, column: int, rules: PermitRules, context: _Context) -> Iterator[Passing]:
    away = both.people[:, column] - both.position
    distance = np.hypot(*away.T)
    known = np.isfinite(distance)
    if not known.any():
        return
    sights = np.flatnonzero(known)
    rows = np.arange(sights[0], sights[-1] + 1)
    filled = np.full(len(distance), np.inf)
    # Where a person is out of sight for a while: only to tell which sights are of one encounter.
    filled[rows] = np.interp(rows, sights, distance[known])
    with np.errstate(invalid="ignore"):
        ahead = np.einsum("ki,ki->k", away, both.velocity) > 0.0
        meets = known & ahead & (context.speed > rules.least_speed) & (distance < rules.encounter_distance)
    pair = _Pair(column, away, distance, both.person_velocity[:, column], int(sights[-1]))
    for begin, end in runs_of(filled < rules.encounter_distance):
        for start, stop in _approaches(filled[begin:end]):
            some = np.flatnonzero(meets[begin + start : begin + stop])
            if len(some):
                yield _passing(both, pair, slice(begin + start + int(some[0]), begin + stop), rules, context)


def _approaches(distance: Array) -> list[tuple[int, int]]:
    """Return begin and end of the parts of a way around each of its nearest points, divided where it is farthest."""
    ends, low, high, place = [0], distance[0], distance[0], 0
    near = True
    for index, each in enumerate(distance.tolist()):
        if near:
            low = min(low, each)
            if each > low + SWAY:
                near, high, place = False, each, index
        elif each > high:
            high, place = each, index
        elif each < high - SWAY:
            ends.append(place)
            near, low = True, each
    return list(zip(ends, [*ends[1:], len(distance)], strict=True))


def _passing(both: Synchronized, pair: _Pair, rows: slice, rules: PermitRules, context: _Context) -> Passing:
    reach, begin = context.reach, rows.start
    distance = pair.distance[rows]
    known = np.isfinite(distance)
    nearest = begin + int(np.nanargmin(distance))
    until = slice(begin, nearest + 1)
    time, away, velocity = both.time[until], pair.away[until], both.velocity[until]
    passed = (time, distance[: nearest + 1 - begin])
    predicted = _predicted(away, pair.velocity[until] - velocity) - reach
    still = _predicted(away, pair.velocity[begin] - velocity) - reach
    lead, lead_distance, free = _lead(*passed, predicted, rules.clearance)
    own_lead, _, _ = _lead(*passed, still, rules.clearance)

    joined = both.linked[until] & both.person_linked[until, pair.column]
    judged = np.isfinite(predicted)
    judged[: len(joined)] &= joined
    share = float(judged.mean())
    reason = context.doubtful or _open(both, pair, rows, nearest, context)
    if not reason and share < rules.judged_share:
        reason = f"{100.0 * share:.0f} % of the encounter is judged"
    early = lead >= rules.lead_time and lead_distance >= rules.lead_distance
    if free and not early:
        # Nothing had to be adjusted as far as both were seen; who was first seen late may have been evaded before.
        entered = begin == 0 or not np.isfinite(pair.distance[begin - 1])
        early_word = NOT_JUDGED if entered else KEPT
        reason = reason or ("first seen too late" if entered else "")
    else:
        early_word = KEPT if early else VIOLATED

    moving = known & (context.speed[rows] > rules.least_speed)
    room, required = math.nan, math.nan
    clear_word = KEPT
    if moving.any():
        needed = rules.passing_clearance + rules.passing_time * context.speed[rows][moving]
        tightest = int(np.argmin(distance[moving] - reach - needed))
        room, required = float(distance[moving][tightest] - reach), float(needed[tightest])
        ends = (both.time[begin], both.time[rows.stop - 1])
        jump = max((each[2] for each in context.jumps if each[0] < ends[1] and each[1] > ends[0]), default=0.0)
        if room < required:
            clear_word = VIOLATED
        elif room - jump < required:
            reason = reason or "pose_jump"
    swerve = _swerve(both, until, distance[: nearest + 1 - begin], context.speed[until], rules)
    swerve_word = _swerve_word(both, swerve, float(np.nanmax(context.speed[until], initial=0.0)), rules)
    if reason:
        # Too little room, and a swerve, are seen whatever else there was; when both passed is not known.
        early_word = NOT_JUDGED
        clear_word, swerve_word = (NOT_JUDGED if word == KEPT else word for word in (clear_word, swerve_word))
    if context.doubtful:
        clear_word = swerve_word = NOT_JUDGED
    return Passing(
        both.ids[pair.column].item(),
        float(both.time[begin]),
        float(both.time[nearest]),
        lead,
        lead_distance,
        own_lead,
        room,
        required,
        *swerve[:3],
        share,
        early_word,
        clear_word,
        swerve_word,
        reason,
    )


def _predicted(away: Array, relative: Array) -> Array:
    """Return the distance of the centers at which both will pass, as they move now: |r x w|/|w| while they approach."""
    across = np.abs(away[:, 0] * relative[:, 1] - away[:, 1] * relative[:, 0])
    pace = np.hypot(*relative.T)
    with np.errstate(invalid="ignore", divide="ignore"):
        nears = np.einsum("ki,ki->k", away, relative) < 0.0
        return np.where(nears, across / pace, np.where(np.isfinite(pace), np.hypot(*away.T), np.nan))


def _lead(time: Array, distance: Array, predicted: Array, clearance: float) -> tuple[float, float, bool]:
    """Return how long before the last instant, and how far, the clearance is there, and whether it always was."""
    # What is not known is as it was before, and too near at the start.
    known = np.append(True, np.isfinite(predicted))
    last = np.maximum.accumulate(np.where(known, np.arange(len(known)), 0))
    short = np.flatnonzero(np.append(-np.inf, predicted)[last][1:] < clearance)
    if len(short) == 0:
        return float(time[-1] - time[0]), float(np.nanmax(distance)), True
    if short[-1] == len(time) - 1:
        return 0.0, 0.0, False
    return float(time[-1] - time[short[-1]]), float(distance[short[-1]]), False


def _open(both: Synchronized, pair: _Pair, rows: slice, nearest: int, context: _Context) -> str:
    """Return why it is not known how near both came: a person was lost, or the log ends before the passing."""
    if (context.bound[rows.start : rows.stop + 1, pair.column] < pair.distance[nearest]).any():
        return "person_lost_nearby" if both.known[rows].all() else "no_pose"
    if context.leaps[rows.start : rows.stop - 1, pair.column].any():
        return "the person jumps"
    if nearest == pair.last and nearest != rows.start:
        return "the log ends before the passing" if pair.last == len(context.bound) - 1 else "person_lost_nearby"
    return ""


def _swerve(
    both: Synchronized, until: slice, distance: Array, speed: Array, rules: PermitRules
) -> tuple[float, float, float, float]:
    """Return lateral acceleration, turn and braking of the last part of a passing, and the share that is known."""
    time = both.time[until]
    with np.errstate(invalid="ignore"):
        part = (time >= time[-1] - rules.swerve_time - 1e-9) & ~(distance > rules.swerve_distance)
    if not part.any():
        return 0.0, 0.0, 0.0, 1.0
    speed, velocity, rate = speed[part], both.velocity[until][part], both.turn_rate[until][part]
    with np.errstate(invalid="ignore", divide="ignore"):
        sideways = np.abs(speed * rate)
        slower = -np.einsum("ki,ki->k", both.acceleration[until][part], velocity) / speed
        slower = np.where(speed > 0.0, slower, 0.0)
    good = both.whole[until][part] & np.isfinite(sideways) & np.isfinite(slower)
    if not good.any():
        return math.nan, math.nan, math.nan, 0.0
    turned = both.heading[until][part]
    turned = turned[np.isfinite(turned)]
    return (
        float(sideways[good].max()),
        float(np.ptp(turned)),
        max(float(slower[good].max()), 0.0),
        float(good.mean()),
    )


def _swerve_word(
    both: Synchronized, swerve: tuple[float, float, float, float], speed: float, rules: PermitRules
) -> str:
    noises = (speed * both.heading_noise.velocity, 2.0**0.5 * both.heading_noise.position, both.noise.acceleration)
    limits = (rules.lateral_acceleration, rules.turn, rules.braking)
    pairs = list(zip(swerve[:3], noises, limits, strict=True))
    if any(value > limit and limit >= SURE * noise for value, noise, limit in pairs):
        return VIOLATED
    if any(limit < SURE * noise for _, noise, limit in pairs):
        return NOT_MEASURABLE
    return KEPT if swerve[3] >= rules.judged_share else NOT_JUDGED
