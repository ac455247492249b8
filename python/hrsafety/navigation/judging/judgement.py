"""``judge``: what can be said of a recorded robot among people, with times, errors, and what cannot be said."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, Pair, count, finite_pair, instance, not_negative, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._replay.played import Played
from hrsafety._replay.record import Replay
from hrsafety._tracks import WINDOW
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.judging.assumptions import ShieldAssumption, assumptions
from hrsafety.navigation.judging.doubts import continued_tracks, other_twists, people_off_map
from hrsafety.navigation.judging.permit import Passing, PermitRules, passings
from hrsafety.navigation.judging.replay import replay_of
from hrsafety.navigation.judging.synchronized import Logged, Synchronized, synchronized
from hrsafety.navigation.judging.touches import Touch, clearances, people_touched, runs_of, walls_touched
from hrsafety.navigation.judging.unjudged import NotJudged, judged_share, nearest_unseen, not_judged
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.maps.unknown import over_unknown
from hrsafety.navigation.metrics.between import Outlined
from hrsafety.navigation.metrics.declared import METRICS, OF_GOAL
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.metrics.scores import EpisodeMetrics, evaluate
from hrsafety.navigation.metrics.sights import unseen_instants
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.robots.footprint import Footprint
from hrsafety.plausibility import ResultWarning

__all__ = ["Judgement", "Moment", "judge"]

PERSON_SPEED = 1.6
"""Of people who are not seen, in m/s: ISO 13855."""
PERSON_ACCELERATION = 2.0
"""Of people between two sights, in m/s^2: a start or a stop of ordinary walking."""
NEAR = 3.6
"""Beyond the worst one only moments nearer than this are told, in m: the social distance."""
APART = 2.0
"""Worst moments are so far from each other in s."""
MOVING = 0.1
"""Speed in m/s above which the direction of a way is known."""
SIDEWAYS = 0.35
"""Angle in rad between way and heading that two wheels do not have most of the time."""
LOST = ("person_lost_nearby", "out_of_view")
"""Reasons of what is not judged of somebody who may be near."""
ENOUGH = 0.95
"""Share of a log that must be judged."""


@displayed
class Moment(NamedTuple):
    """One of the worst moments.

    Attributes
    ----------
    time : float
        In s.
    person : int or str
        Who was near.
    clearance : float
        Distance of the surfaces in m.
    error : float
        Of it in m.
    missing : float
        Clearance that the rule of passing would have asked for, less the clearance, in m.
    robot_speed, closing_speed : float
        In m/s.
    time_to_collision : float
        If both went on, in s; infinite if they do not meet.
    """

    time: Annotated[float, "s"]
    person: int | str
    clearance: Annotated[float, "m"]
    error: Annotated[float, "m"]
    missing: Annotated[float, "m"]
    robot_speed: Annotated[float, "m/s"]
    closing_speed: Annotated[float, "m/s"]
    time_to_collision: Annotated[float, "s"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Judgement(Played):
    """Judgement of a log; made by `judge`.

    It has ``time``, ``position``, ``velocity``, ``heading`` and ``obstacle_position``, so
    `hrsafety.contact.contact_margins` takes it as a run.

    Attributes
    ----------
    time : ndarray, shape (T,)
        Equal instants in s.
    position, velocity : ndarray, shape (T, 2)
        Of the robot in m and m/s; NaN where it has no pose.
    heading : ndarray, shape (T,)
        In rad.
    obstacle_position : ndarray, shape (T, n, 2)
        Of the people in m; NaN where they are not seen.
    people : ndarray of int or str, shape (n,)
        Their ids.
    clearance : ndarray, shape (T, n)
        Distances of the surfaces in m.
    wall_clearance : ndarray, shape (T,)
        Distance from the walls of the map in m; NaN without one.
    error : float
        Of a clearance in m: pose of the robot and position of a person.
    metrics : EpisodeMetrics
        Social metrics of the longest part without a gap or jump of the pose.
    scored : tuple of float
        Begin and end of that part in s.
    contacts, possible_contacts : tuple of Touch
        With people and walls; those which the error decides.
    assumptions : tuple of ShieldAssumption
        Of the shield; without one what it would have to assume.
    moments : tuple of Moment
        The worst ones, worst first.
    passings : tuple of Passing
        With the rules of permission.
    not_judged : tuple of NotJudged
        Times and reasons.
    judged_share : float
        Of the time of the log in which contacts are judged.
    step, window : float
        Time between instants and length of the fits that velocities come from, in s.
    bandwidth : tuple of float
        Frequencies in Hz up to which motions of robot and people are kept (-3 dB).
    robot_radius, person_radius : float
        In m; of a robot with a footprint that of the circle around it.
    footprint : Footprint or None
        Outline by which contacts are judged; ``None``: the disc.
    walls : StaticMap or None
        The map.
    shielded : bool
        Whether a shield was given: without one there are no assumptions to break.
    warnings : tuple of ResultWarning
        Of the log, the metrics and the judgement.
    """

    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    heading: Annotated[Array, "rad"]
    obstacle_position: Annotated[Array, "m"]
    people: npt.NDArray[Any]
    clearance: Annotated[Array, "m"]
    wall_clearance: Annotated[Array, "m"]
    error: Annotated[float, "m"]
    metrics: EpisodeMetrics
    scored: Annotated[tuple[float, float], "s"]
    contacts: tuple[Touch, ...]
    possible_contacts: tuple[Touch, ...]
    assumptions: tuple[ShieldAssumption, ...]
    moments: tuple[Moment, ...]
    passings: tuple[Passing, ...]
    not_judged: tuple[NotJudged, ...]
    judged_share: float
    step: Annotated[float, "s"]
    window: Annotated[float, "s"]
    bandwidth: tuple[float, float]
    robot_radius: Annotated[float, "m"]
    person_radius: Annotated[float, "m"]
    footprint: Footprint | None = None
    walls: StaticMap | None = None
    shielded: bool = False
    warnings: tuple[ResultWarning, ...] = ()

    def _replay(self) -> Replay:
        """Return what a player shows."""
        return replay_of(self)

    @property
    def counts(self) -> dict[str, int]:
        """Numbers of what may be held against the robot, by the words of ``hrsafety judge --fail-on``."""
        kinds = [each.kind for each in self.contacts]
        rules = [word for each in self.passings for word in each.kept.values()]
        found = {
            "contact": len(kinds),
            "moving_contact": sum(kind in ("toward", "away") for kind in kinds),
            "at_fault": sum(each.at_fault for each in self.contacts),
            "wall_contact": kinds.count("wall"),
            "possible_contact": len(self.possible_contacts),
            "broken_assumption": sum(each.status == "broken" for each in self.assumptions),
            "violated_rule": rules.count("violated"),
        }
        return found | {"any": sum(found.values())}


def judge(
    log: Logged,
    *,
    map: StaticMap | None = None,
    robot: HolonomicRobot | DifferentialDriveRobot | None = None,
    robot_radius: float | None = None,
    person_radius: float = 0.25,
    shield: Shield | None = None,
    rules: PermitRules | None = None,
    goal: Pair | None = None,
    step: float = 0.1,
    window: float = WINDOW,
    pose_error: float | None = None,
    person_error: float | None = None,
    view: float | None = None,
    moments: int = 5,
    control_period: float | None = None,
) -> Judgement:
    """Judge a recorded robot among people.

    Robot and people are brought to equal instants; poses that are more than 0.25 s apart, jumps of the pose, and rows
    of a person that are more than three periods apart are not bridged. Velocities are local quadratic fits.

    Parameters
    ----------
    log : RobotLog
        Of `hrsafety.io.load_log`; any object with ``time``, ``position``, ``heading`` and ``people``.
    map : StaticMap or None
        Walls.
    robot : HolonomicRobot, DifferentialDriveRobot or None
        Radius or footprint, greatest speed and deceleration. Contacts, clearances and metrics are those of the
        footprint at the heading of the log; rules of passing and what is not judged take the circle around it.
    robot_radius : float or None
        Radius in m of a disc that covers the robot, if it differs from ``robot`` or there is none.
    person_radius : float
        Of everybody in m.
    shield : Shield or None
        Assumptions that are compared with the log; without one nothing is assumed that could be broken.
    rules : PermitRules or None
        Thresholds of the rules of permission.
    goal : tuple of float, or None
        Where the robot was going, in m; metrics that need it are NaN when ``None``.
    step, window : float
        Time between instants, and length of the fits, in s.
    pose_error, person_error : float or None
        Errors of the positions of robot and people in m; twice the noise that is seen in the log when ``None``, and for
        people what they may do between two sights. What lasts longer than a row is not seen in a log.
    view : float or None
        Angle in rad, ahead of the robot, in which its sensors see people; all around when ``None``.
    moments : int
        How many of the worst moments are returned, 2 s apart at least.
    control_period : float or None
        Of the controller in s.

    Returns
    -------
    Judgement
        Contacts, metrics, rules, assumptions, and what is not judged.

    Raises
    ------
    InvalidParameterError
        If a value is out of range, or the radius of the robot is not known.

    Examples
    --------
    >>> from types import SimpleNamespace
    >>> import numpy as np
    >>> from hrsafety import datasets, navigation as nav
    >>> time = np.arange(81) / 10
    >>> walk = datasets.Recording(time_s=time, person=[7] * 81, position=[(8.0 - t, 0.9) for t in time])
    >>> straight = np.stack([0.5 * time, 0.0 * time], axis=1)
    >>> log = SimpleNamespace(time=time, position=straight, heading=0.0 * time, people=walk)
    >>> found = nav.metrics.judge(log, robot_radius=0.3)
    >>> found.counts["contact"], [round(each.passing_clearance, 2) for each in found.passings]
    (0, [0.35])
    """
    radius = _radius(robot, robot_radius)
    reach = radius + positive("person_radius", person_radius)
    step, window = positive("step", step), positive("window", window)
    if view is not None:
        positive("view", view)
    most = count("moments", moments, least=0, most=1000)
    target = None if goal is None else finite_pair("goal", goal)
    walls = None if map is None else instance("map", map, StaticMap)
    shield = None if shield is None else instance("shield", shield, Shield)
    rules = PermitRules() if rules is None else instance("rules", rules, PermitRules)
    _check_log(log)
    both = synchronized(log, step=step, window=window)
    outline = None
    if robot is not None and robot.footprint is not None and robot_radius is None:
        outline = Outlined(robot.footprint, both.heading, radius, reach - radius, both.step)
    own = _error("pose_error", pose_error, 2.0 * both.noise.position)
    if outline is not None:
        own += 2.0 * both.heading_noise.position * radius  # a corner that is turned
    between = 0.0 if np.isnan(both.person_period) else PERSON_ACCELERATION * both.person_period**2 / 8.0
    error = own + _error("person_error", person_error, 2.0 * both.person_noise.position + between)
    gaps = clearances(both, reach, outline)
    sure, possible = people_touched(both, gaps, reach, error, outline)
    away = np.full(len(both.time), np.nan)
    if walls is not None:
        # A wall is anywhere within a cell.
        cell = max((0.5 * grid.resolution for grid in walls.grids), default=0.0)
        away, touched = walls_touched(both, walls, radius, own + cell, outline)
        sure += [each for each in touched if each.kind == "wall"]
        possible += [each for each in touched if each.kind != "wall"]
    bound = nearest_unseen(both, PERSON_SPEED)
    parts = not_judged(both, log, bound=bound, reach=reach, walls=walls, view=view)
    share = judged_share(both, parts)
    scored_walls = (away, [each for each in sure if each.kind == "wall"])
    metrics, scored = _metrics(
        both, scored_walls, goal=target, radius=radius, person_radius=person_radius, robot=robot, outline=outline
    )
    doubtful = "clock" if any(each.reason == "clock" for each in parts) else ""
    passed = passings(
        both, reach=reach, rules=rules, bound=bound, jumps=getattr(log, "pose_jumps", ()), doubtful=doubtful
    )
    brakes = None if robot is None else (robot.max_deceleration or robot.max_acceleration)
    told = (
        *getattr(log, "warnings", ()),
        *getattr(log.people, "warnings", ()),
        *getattr(walls, "warnings", ()),
        *metrics.warnings,
        *_doubts(parts, share, possible),
        *continued_tracks(log.people, {each.person for each in parts if each.reason in LOST}),
        *_circled(outline),
        *_sideways(both, robot),
        *people_off_map(log.people, both, walls),
        *(() if walls is None else over_unknown(walls, both.position[both.known], "the log")),
        *other_twists(log, both),
    )
    return Judgement(
        time=both.time,
        position=both.position,
        velocity=both.velocity,
        heading=both.heading,
        obstacle_position=both.people,
        people=both.ids,
        clearance=gaps[0],
        wall_clearance=away,
        error=error,
        metrics=metrics,
        scored=scored,
        contacts=tuple(sorted(sure, key=lambda each: each.begin)),
        possible_contacts=tuple(sorted(possible, key=lambda each: each.begin)),
        assumptions=tuple(assumptions(both, log, shield, deceleration=brakes, control_period=control_period)),
        moments=tuple(_moments(both, gaps[0], rules, error, reach, most)),
        passings=tuple(passed),
        not_judged=tuple(parts),
        judged_share=share,
        step=step,
        window=window,
        bandwidth=both.bandwidth,
        robot_radius=radius,
        person_radius=person_radius,
        footprint=None if outline is None else outline.footprint,
        walls=walls,
        shielded=shield is not None,
        warnings=tuple(dict.fromkeys(told)),
    )


def _radius(robot: Any, radius: float | None) -> float:
    if robot is not None:
        instance("robot", robot, HolonomicRobot, DifferentialDriveRobot)
    if radius is not None:
        return positive("robot_radius", radius)
    if robot is None:
        remedy = "give robot_radius=, or robot= with its radius or footprint"
        raise InvalidParameterError("robot_radius", "be known", None, remedy)
    return float(robot.radius)


def _check_log(log: Any) -> None:
    for name in ("time", "position", "heading", "people"):
        if not hasattr(log, name):
            raise InvalidParameterError("log", f"have {name}", log, "read it by hrsafety.io.load_log")
    time = np.asarray(log.time, dtype=np.float64)
    if len(time) < 2 or not np.isfinite(time).all() or not (np.diff(time) > 0.0).all():
        raise InvalidParameterError("log.time", "hold two instants or more that increase", len(time))
    for name, shape in (("position", (len(time), 2)), ("heading", (len(time),))):
        values = np.asarray(getattr(log, name), dtype=np.float64)
        if values.shape != shape or not np.isfinite(values).all():
            raise InvalidParameterError(f"log.{name}", f"be finite and of shape {shape}", values.shape)


def _error(name: str, given: float | None, seen: float) -> float:
    return seen if given is None else not_negative(name, given)


def _metrics(
    both: Synchronized,
    walls: tuple[Array, Sequence[Touch]],
    *,
    goal: Pair | None,
    radius: float,
    person_radius: float,
    robot: Any,
    outline: Outlined | None,
) -> tuple[EpisodeMetrics, tuple[float, float]]:
    """Return the metrics of the longest part in which the robot is followed from instant to instant.

    ``walls``: distances from walls, (T,), and contacts with them.
    """
    parts = runs_of(np.append(both.linked, False))
    if not parts:
        return EpisodeMetrics({name: float("nan") for name in METRICS}), (float("nan"), float("nan"))
    begin, end = max(parts, key=lambda part: part[1] - part[0])
    rows = slice(begin, end + 1)
    there = both.seen[rows].any(axis=0)
    place = both.position[rows]
    speed = float(np.hypot(*np.diff(place, axis=0).T).max(initial=0.0)) / both.step
    # Without a goal the run must not end where it happens to pass its last place.
    target = (float(place[-1, 0]) + 1e5, float(place[-1, 1])) if goal is None else goal
    more: dict[str, Any] = {}
    if outline is not None:
        more = {"footprint": outline.footprint, "heading": both.heading[rows]}
    unseen = unseen_instants(both.people)[rows][:, there] if there.any() else None
    episode = Episode(
        position=place,
        step=both.step,
        goal=target,
        robot_radius=radius,
        people=both.people[rows][:, there],
        person_radius=person_radius,
        max_speed=max(robot.max_speed if robot is not None else 0.0, speed, 0.01),
        unseen=unseen,
        **more,
    )
    ids = tuple(both.ids[there].tolist())
    episode._set(_resampled=True, _begin=float(both.time[begin]), _ids=ids)
    found, scored = evaluate(episode), (float(both.time[begin]), float(both.time[end]))
    values: dict[str, Any] = dict(found.to_dict())
    touched = [each for each in walls[1] if each.begin <= scored[1] and each.end >= scored[0]]
    if np.isfinite(walls[0][rows]).any():
        values["wall_clearance"] = min([float(np.nanmin(walls[0][rows])), *(each.clearance for each in touched)])
    values["wall_contacts"] = len(touched)
    if touched:
        values |= {"success": False, "spl": 0.0}
    if goal is None:
        values |= dict.fromkeys(OF_GOAL, float("nan"))
    return EpisodeMetrics(
        values, [each for each in found.warnings if goal is not None or each.subject != "goal"]
    ), scored


def _doubts(parts: Sequence[NotJudged], share: float, possible: Sequence[Touch]) -> list[ResultWarning]:
    told = []
    lost = [each for each in parts if each.reason in LOST]
    if lost:
        first, people = lost[0], len({each.person for each in lost})
        message = (
            f"{_some(people, 'person', 'people')} not seen while near or maybe near, first person {first.person} from "
            f"{first.begin:.2f} to {first.end:.2f} s: a contact then is not judged"
        )
        told.append(ResultWarning("person_lost_nearby", "people", message))
    if share < ENOUGH:
        reasons = ", ".join(dict.fromkeys(each.reason for each in parts if each.reason != "smoothing_edge"))
        message = f"{100.0 * share:.1f} % of the log is judged; the rest is open ({reasons})"
        told.append(ResultWarning("not_judged", "log", message))
    if possible:
        first_one = possible[0]
        who = "a wall" if first_one.person is None else f"person {first_one.person}"
        message = (
            f"{_some(len(possible), 'contact')} possible within the error of the positions, first with {who} at "
            f"{first_one.begin:.2f} s: {first_one.clearance:.3f} m with an error of {first_one.error:.3f} m"
        )
        told.append(ResultWarning("possible_contact", "people", message))
    return told


def _circled(outline: Outlined | None) -> Iterator[ResultWarning]:
    """Yield where the circle around a footprint stands for it."""
    if outline is not None:
        yield ResultWarning(
            "circle_around_footprint",
            "robot.footprint",
            f"rules of passing, times to collision and what is not judged take the circle of "
            f"{outline.robot_radius:.4g} m around the footprint for the robot; contacts, clearances and metrics are "
            "those of the footprint itself",
            safe_side=True,  # the circle is nearer to everybody
        )


def _sideways(both: Synchronized, robot: object) -> Iterator[ResultWarning]:
    """Yield where a robot on two wheels seems to move sideways most of the time: places or headings are others."""
    speed = np.hypot(*both.velocity.T)
    moves = speed > MOVING
    if isinstance(robot, DifferentialDriveRobot) and moves.sum() * both.step >= 1.0:
        way = np.arctan2(both.velocity[moves, 1], both.velocity[moves, 0]) - both.heading[moves]
        off = float(np.median(np.abs(np.arcsin(np.clip(np.sin(way), -1.0, 1.0)))))
        if off > SIDEWAYS:
            message = (
                f"two wheels move {np.degrees(off):.0f} degrees beside their heading half of the time: x and y "
                "exchanged, degrees given for radians, or another frame?"
            )
            yield ResultWarning("sideways", "log.heading", message)


def _some(number: int, one: str, many: str = "") -> str:
    return f"1 {one} is" if number == 1 else f"{number} {many or one + 's'} are"


def _moments(
    both: Synchronized, gaps: Array, rules: PermitRules, error: float, reach: float, most: int
) -> list[Moment]:
    """Return the instants at which the clearance is farthest below the one that a passing asks for."""
    if not gaps.size or most == 0:
        return []
    speed = np.hypot(*both.velocity.T)
    missing = rules.passing_clearance + rules.passing_time * speed[:, None] - gaps
    worst = np.where(np.isnan(missing), -np.inf, missing)
    whom = worst.argmax(axis=1)
    height = worst[np.arange(len(worst)), whom].copy()
    found: list[Moment] = []
    while len(found) < most and height.max() > -np.inf:
        row = int(height.argmax())
        if found and gaps[row, whom[row]] > NEAR:
            break
        person = int(whom[row])
        away = both.people[row, person] - both.position[row]
        relative = both.person_velocity[row, person] - both.velocity[row]
        found.append(
            Moment(
                float(both.time[row]),
                both.ids[person].item(),
                float(gaps[row, person]),
                error,
                float(missing[row, person]),
                float(speed[row]),
                -float(away @ relative) / max(float(np.hypot(*away)), 1e-12),
                _time_to_collision(away, relative, reach),
            )
        )
        height[np.abs(both.time - both.time[row]) < APART - 1e-9] = -np.inf
    return found


def _time_to_collision(away: Array, relative: Array, reach: float) -> float:
    """Return when two discs meet at constant velocity, in s; infinite if they do not."""
    square, along = float(relative @ relative), float(away @ relative)
    inside = float(away @ away) - reach * reach
    if inside <= 0.0:
        return 0.0
    root = along * along - square * inside
    if not (along < 0.0 and root >= 0.0):
        return float("inf")
    return float((-along - root**0.5) / square)
