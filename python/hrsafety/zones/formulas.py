"""Closed forms of protective zones: how far a zone must reach for a robot that brakes when a person enters it.

A robot of speed v begins to brake T after a person enters the zone, the deceleration builds up linearly within t_b and
is d from then on. It stops after the travel s and the time t_s; a person walks u t_s meanwhile.
"""

from __future__ import annotations

import math
from typing import Annotated, NamedTuple

import numpy as np

from hrsafety._arguments import Array, finite, not_negative, positive
from hrsafety._arguments import count as whole
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.zones.reach import footprint_of, stopping_paths

__all__ = [
    "Extents",
    "StoppingTravel",
    "allowed_speed",
    "approach_contact_speed",
    "blind_range",
    "leg_depth",
    "protective_field",
    "rear_extension",
    "stopping_travel",
    "turning_extents",
]

INSTANTS = 4001
"""Instants of the path of a stop in a turn: extents are exact to 1e-7 m."""
APPROACH_STEPS = 2000
"""Steps of one delay of `approach_contact_speed`."""
MOST_DELAYS = 2000
"""Delays after which a robot that has not touched anybody is taken to stop before."""


@displayed
class StoppingTravel(NamedTuple):
    """Way and time from the instant at which a person enters a zone until the robot stands.

    Attributes
    ----------
    travel : float
        In m.
    time : float
        In s.
    """

    travel: Annotated[float, "m"]
    time: Annotated[float, "s"]


def stopping_travel(
    speed: float, *, deceleration: float, reaction_time: float, build_up: float = 0.0
) -> StoppingTravel:
    """Return travel and time of a stop: s = v (T + t_b/2) + v^2/2d - d t_b^2/24, t_s = T + t_b/2 + v/d.

    A robot that stands before its brakes have built up, v < d t_b/2, stops after T + sqrt(2 v t_b/d).

    Parameters
    ----------
    speed : float
        Speed v in m/s.
    deceleration : float
        Full deceleration d in m/s^2.
    reaction_time : float
        Time T in s until the robot begins to brake.
    build_up : float
        Time t_b in s in which the deceleration rises to d.

    Returns
    -------
    StoppingTravel
        Travel s and time t_s.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import zones
    >>> stop = zones.stopping_travel(1.0, deceleration=1.5, reaction_time=0.3, build_up=0.25)
    >>> f"{stop.travel:.6f} m, {stop.time:.6f} s"
    '0.754427 m, 1.091667 s'
    """
    v, d = not_negative("speed", speed), positive("deceleration", deceleration)
    reaction, rise = not_negative("reaction_time", reaction_time), not_negative("build_up", build_up)
    if v < 0.5 * d * rise:
        braking = math.sqrt(2.0 * v * rise / d)
        return StoppingTravel(v * reaction + 2.0 * v * braking / 3.0, reaction + braking)
    travel = v * (reaction + rise / 2.0) + v * v / (2.0 * d) - d * rise * rise / 24.0
    return StoppingTravel(travel, reaction + rise / 2.0 + v / d)


def protective_field(
    speed: float,
    *,
    deceleration: float,
    control_time: float,
    scanner_time: float,
    tolerance: float = 0.065,
    reflector: float = 0.35,
    clearance: float = 0.15,
    brake_wear: float = 0.1,
    person_speed: float = 0.0,
) -> float:
    """Return the length of a protective field as manuals of safety scanners compute it.

    S_L = S_A + TZ + Z_R + Z_F + Z_B with S_A = v^2/2d + v t_control + v t_scanner and Z_B = z_b v^2/2d. Manuals take
    the person to stand, ``person_speed=0``; one who walks adds u (t_control + t_scanner + v/d). Print both.

    Parameters
    ----------
    speed : float
        Speed v in m/s.
    deceleration : float
        Of the brakes, d in m/s^2.
    control_time, scanner_time : float
        Response times of control and scanner in s.
    tolerance : float
        Tolerance zone TZ of the scanner in m.
    reflector : float
        Supplement Z_R for reflectors in m; 0 where there are none.
    clearance : float
        Supplement Z_F in m where the robot has less than 0.12 m of ground clearance, else 0.
    brake_wear : float
        Share z_b of the braking distance.
    person_speed : float
        Speed u of people in m/s; 0 for the number of the manuals.

    Returns
    -------
    float
        Length S_L in m.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import zones
    >>> given = {"deceleration": 0.9, "control_time": 0.08, "scanner_time": 0.12}
    >>> lengths = [zones.protective_field(1.2, **given, person_speed=u) for u in (0.0, 1.6)]
    >>> [round(each, 3) for each in lengths]
    [1.685, 4.138]
    """
    v, d = not_negative("speed", speed), positive("deceleration", deceleration)
    reaction = not_negative("control_time", control_time) + not_negative("scanner_time", scanner_time)
    braking = v * v / (2.0 * d)
    supplements = not_negative("tolerance", tolerance) + not_negative("reflector", reflector)
    supplements += not_negative("clearance", clearance) + not_negative("brake_wear", brake_wear) * braking
    return braking + v * reaction + supplements + not_negative("person_speed", person_speed) * (reaction + v / d)


def rear_extension(
    speed: float, *, deceleration: float, reaction_time: float, person_speed: float, error: float = 0.0
) -> float:
    """Return how far a zone reaches behind a robot that drives ahead: max(0, u t_s - s) + e.

    Parameters
    ----------
    speed, deceleration, reaction_time
        As for `stopping_travel`.
    person_speed : float
        Speed u of people in m/s.
    error : float
        Error e of measured positions in m.

    Returns
    -------
    float
        In m.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import zones
    >>> f"{zones.rear_extension(0.6, deceleration=1.0, reaction_time=0.25, person_speed=1.6):.2f} m"
    '1.03 m'
    """
    stop = stopping_travel(speed, deceleration=deceleration, reaction_time=reaction_time)
    behind = not_negative("person_speed", person_speed) * stop.time - stop.travel
    return max(0.0, behind) + not_negative("error", error)


def leg_depth(leg_radius: float, *, distance: float, beam_step: float, points: int) -> float:
    """Return how deep a leg must enter a zone before so many beams are in it: p = rho - sqrt(rho^2 - (n q r/2)^2).

    Parameters
    ----------
    leg_radius : float
        Radius rho in m.
    distance : float
        Distance r of the leg from the scanner in m.
    beam_step : float
        Angle q between beams in rad.
    points : int
        Points n that the zone asks for.

    Returns
    -------
    float
        Depth p in m, of a zone whose border is met head on; infinite beyond `blind_range`.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> import math
    >>> from hrsafety import zones
    >>> f"{zones.leg_depth(0.06, distance=2.0, beam_step=math.radians(0.5), points=4):.4f} m"
    '0.0112 m'
    """
    rho = positive("leg_radius", leg_radius)
    half = whole("points", points) * positive("beam_step", beam_step) * not_negative("distance", distance) / 2.0
    return rho - math.sqrt(rho * rho - half * half) if half <= rho else math.inf


def blind_range(leg_radius: float, *, beam_step: float, points: int) -> float:
    """Return the range beyond which a leg may have fewer beams than a zone asks for: 2 rho/(n q).

    Parameters
    ----------
    leg_radius, beam_step, points
        As for `leg_depth`.

    Returns
    -------
    float
        In m.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> import math
    >>> from hrsafety import zones
    >>> f"{zones.blind_range(0.06, beam_step=math.radians(0.5), points=4):.1f} m"
    '3.4 m'
    """
    return 2.0 * positive("leg_radius", leg_radius) / (whole("points", points) * positive("beam_step", beam_step))


def allowed_speed(
    margin: float, *, deceleration: float, reaction_time: float, person_speed: float, error: float = 0.0
) -> float:
    """Return the greatest speed for which a zone holds that reaches a margin ahead of the robot.

    v = -(d T + u) + sqrt((d T + u)^2 + 2 d (m - e - u T)), and 0 where m - e - u T is not positive.

    Parameters
    ----------
    margin : float
        Margin m between robot and border in m.
    deceleration, reaction_time
        As for `stopping_travel`; half of the build-up of the brakes belongs to the reaction.
    person_speed : float
        Speed u of people toward the robot in m/s.
    error : float
        Error e of measured positions in m.

    Returns
    -------
    float
        In m/s.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import zones
    >>> given = {"deceleration": 2.5, "reaction_time": 0.15, "error": 0.02}
    >>> [round(zones.allowed_speed(0.08, **given, person_speed=u), 3) for u in (0.0, 1.6)]
    [0.289, 0.0]
    """
    d, reaction = positive("deceleration", deceleration), not_negative("reaction_time", reaction_time)
    u = not_negative("person_speed", person_speed)
    room = finite("margin", margin) - not_negative("error", error) - u * reaction
    if room <= 0.0:
        return 0.0
    pace = d * reaction + u
    # The root with its cancellation taken out.
    return 2.0 * d * room / (pace + math.sqrt(pace * pace + 2.0 * d * room))


def approach_contact_speed(
    speed: float, *, person_speed: float, reaction_time: float, time_before_collision: float
) -> float:
    """Return the speed at which a robot under ``approach`` touches a person who walks toward it.

    The gap g obeys g' = -u - min(v, g(t - T)/tau) from g = v tau; the speed at g = 0 is min(v, g(t - T)/tau). It comes
    near u (z - 1) with z = exp(z T/tau) and never vanishes while u and T are positive: ``approach`` holds against
    people who stand, not against those who walk.

    Parameters
    ----------
    speed : float
        Commanded speed v in m/s.
    person_speed : float
        Speed u of the person toward the robot in m/s.
    reaction_time : float
        Delay T in s, below tau/e.
    time_before_collision : float
        Time tau in s.

    Returns
    -------
    float
        In m/s.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import zones
    >>> given = {"person_speed": 1.6, "reaction_time": 0.2, "time_before_collision": 2.0}
    >>> f"{zones.approach_contact_speed(0.5, **given):.4f} m/s"
    '0.1892 m/s'
    """
    v, u = not_negative("speed", speed), not_negative("person_speed", person_speed)
    tau, delay = positive("time_before_collision", time_before_collision), not_negative("reaction_time", reaction_time)
    if delay >= tau / math.e:
        rule = f"be below time_before_collision/e ({tau / math.e:.4g} s)"
        raise InvalidParameterError(
            "reaction_time", rule, reaction_time, "with more, the gap swings instead of closing"
        )
    if min(v, u, delay) == 0.0:
        return 0.0
    step = delay / APPROACH_STEPS
    # Speeds of the robot during one delay; the gap at the end of the delay before decides the next ones.
    speeds, gap = np.full(APPROACH_STEPS + 1, v), v * tau
    for _ in range(MOST_DELAYS):
        closing = np.concatenate([[0.0], np.cumsum(u + 0.5 * (speeds[1:] + speeds[:-1]))]) * step
        gaps = gap - closing
        if gaps[-1] <= 0.0:
            after = int(np.argmax(gaps <= 0.0))
            share = gaps[after - 1] / (gaps[after - 1] - gaps[after])
            return float(speeds[after - 1] + share * (speeds[after] - speeds[after - 1]))
        speeds, gap = np.minimum(v, gaps / tau), float(gaps[-1])
    raise InvalidParameterError(
        "person_speed", "bring the person to the robot", person_speed, Shown(f"it takes more than {MOST_DELAYS} delays")
    )


@displayed
class Extents(NamedTuple):
    """Reach of an area ahead, behind, to the left and to the right of the base frame.

    Attributes
    ----------
    front, rear, left, right : float
        In m.
    """

    front: Annotated[float, "m"]
    rear: Annotated[float, "m"]
    left: Annotated[float, "m"]
    right: Annotated[float, "m"]


def turning_extents(
    speed: float,
    turn_rate: float,
    *,
    footprint: object,
    deceleration: float,
    reaction_time: float,
    person_speed: float = 0.0,
    error: float = 0.0,
    build_up: float = 0.0,
) -> Extents:
    """Return the reach of the union over t of the footprint grown by u t + e while a robot stops in a turn.

    Speed and turn rate brake together, so the robot stays on its arc.

    Parameters
    ----------
    speed : float
        Speed v in m/s, negative backward.
    turn_rate : float
        In rad/s, positive to the left.
    footprint : float or array_like (n, 2)
        Radius in m about the base frame, or corners in m.
    deceleration, reaction_time, build_up
        As for `stopping_travel`.
    person_speed : float
        Speed u of people in m/s.
    error : float
        Error e of measured positions in m.

    Returns
    -------
    Extents
        From the base frame.

    Raises
    ------
    InvalidParameterError
        If a number is out of range, or the robot turns in place: its brakes are given in m/s^2.

    Examples
    --------
    >>> from hrsafety import zones
    >>> body = [(0.4, 0.3), (0.4, -0.3), (-0.4, -0.3), (-0.4, 0.3)]
    >>> reach = zones.turning_extents(
    ...     0.8, 0.6, footprint=body, deceleration=1.0, reaction_time=0.3, person_speed=1.0
    ... )
    >>> [round(each, 3) for each in reach]
    [2.131, 1.044, 1.653, 1.421]
    """
    v, w = finite("speed", speed), finite("turn_rate", turn_rate)
    if v == 0.0 and w != 0.0:
        raise InvalidParameterError("speed", "not be 0 in a turn", speed, "a robot that turns in place: zones.design")
    body = footprint_of(footprint)
    u, wide = not_negative("person_speed", person_speed), not_negative("error", error)
    stop = stopping_travel(abs(v), deceleration=deceleration, reaction_time=reaction_time, build_up=build_up)
    path = stopping_paths(
        np.array([[v, 0.0, w]]),
        deceleration=deceleration,
        turn_deceleration=math.inf,
        reaction_time=reaction_time,
        build_up=build_up,
        instants=INSTANTS,
    )
    assert math.isclose(float(path.time[0, -1]), stop.time, rel_tol=1e-9)
    return _reach(body.placed(path.pose[0]), body.rounding + u * path.time[0] + wide)


def _reach(corners: Array, radii: Array) -> Extents:
    """Return the reach of discs about the corners at each instant, corners (t, n, 2) and radii (t,)."""
    high, low = corners.max(axis=1) + radii[:, np.newaxis], corners.min(axis=1) - radii[:, np.newaxis]
    front, left = high.max(axis=0)
    rear, right = -low.min(axis=0)
    return Extents(float(front), float(rear), float(left), float(right))
