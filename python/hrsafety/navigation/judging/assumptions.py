"""Assumptions of a shield beside what a log shows: held, broken, or not measurable."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Annotated, Any, NamedTuple

import numpy as np

from hrsafety._arguments import Array
from hrsafety._display import displayed
from hrsafety.navigation.judging.synchronized import Synchronized
from hrsafety.navigation.laws.shield import Shield

__all__ = ["ShieldAssumption", "assumptions"]

HELD, BROKEN, NOT_MEASURABLE, NOT_ASSUMED = "held", "broken", "not_measurable", "not_assumed"
SURE = 3.0
"""Standard deviations of noise that are no breach."""
ROUNDING = 1e-6
"""Numbers differ from limits by more."""
SLOW = 0.05
"""A command below it, in m/s, is one to stop."""
SETTLED = 0.5
"""So long in s a command must stay before the robot has followed it."""
LEAST_ROWS = 20
"""With fewer values a 99 % quantile is the largest one."""


@displayed
class ShieldAssumption(NamedTuple):
    """Assumption of a shield beside the measured value.

    Attributes
    ----------
    name : str
        Of the assumption, as `Shield` calls it where it has a name there.
    status : str
        ``"held"``, ``"broken"``, ``"not_measurable"``, or ``"not_assumed"`` of a value that no shield was given for.
    limit : float
        What is assumed, NaN without a number.
    quantile : float
        99 % quantile of what was found; NaN if it is not measurable.
    most : float
        Largest value that was found (of deceleration, too).
    error : float
        Of the values: three standard deviations.
    unit : str
        Of all numbers.
    time : float
        When the largest value was found, in s.
    note : str
        Who, and why something is not measurable.
    """

    name: str
    status: str
    limit: float
    quantile: float
    most: float
    error: float
    unit: str
    time: Annotated[float, "s"]
    note: str = ""


def assumptions(
    both: Synchronized, log: Any, shield: Shield | None, *, deceleration: float | None, control_period: float | None
) -> list[ShieldAssumption]:
    """Return the assumptions of a shield that concern this log.

    Parameters
    ----------
    both : Synchronized
        Robot and people.
    log : Logged
        What they come from.
    shield : Shield or None
        What is assumed; ``None``: nothing, and what would have to be assumed is measured.
    deceleration, control_period : float or None
        Of the robot, in m/s^2 and s.
    """
    if shield is None:
        found = assumptions(both, log, Shield(), deceleration=deceleration, control_period=control_period)
        return [
            each._replace(limit=np.nan, status=NOT_ASSUMED, note="")
            if np.isfinite(each.most)
            else each._replace(limit=np.nan)
            for each in found
        ]
    return [
        *_of_people(both, shield),
        _latency(log, shield),
        _position_error(both, shield),
        _margin(log, shield),
        _tracking(both, log, shield),
        _deceleration(both, deceleration),
        _period(log, control_period),
    ]


def _found(
    name: str, limit: float | None, values: Array, times: Array, error: float, unit: str, note: str
) -> ShieldAssumption:
    """Return what values say about a limit: broken beyond it and the error, held below it with the error."""
    bound = float("nan") if limit is None else float(limit)
    good = np.isfinite(values)
    values, times = values[good], times[good]
    if len(values) == 0:
        return ShieldAssumption(
            name, NOT_MEASURABLE, bound, np.nan, np.nan, error, unit, np.nan, note or "nothing was recorded"
        )
    worst = int(np.argmax(values))
    most, high = float(values[worst]), float(np.quantile(values, 0.99))
    error += ROUNDING
    if limit is None:
        status, note = NOT_MEASURABLE, note or "the shield assumes nothing"
    elif most - error > bound:
        status = BROKEN
    elif most + error <= bound + 2.0 * ROUNDING:
        status = HELD
    else:
        status, note = NOT_MEASURABLE, f"noise of {error:.2g} {unit} is larger than the distance from the limit"
    return ShieldAssumption(name, status, bound, high, most, error, unit, float(times[worst]), note)


def _of_people(both: Synchronized, shield: Shield) -> Iterator[ShieldAssumption]:
    speed = np.hypot(both.person_velocity[..., 0], both.person_velocity[..., 1])
    # Across the steps that are not bridged a person may have been fast without being noticed.
    instants = np.broadcast_to(both.time[:, None], speed.shape)
    flat, times = speed.ravel(), instants.ravel()
    error = SURE * both.person_noise.velocity
    who = ""
    if np.isfinite(flat).any():
        who = f"person {both.ids[int(np.nanargmax(flat)) % speed.shape[1]]}"
    yield _found("person_speed", shield.person_speed, flat, times, error, "m/s", who)
    if len(both.time) < 3:
        rate = np.full(speed.shape, np.nan)
    else:
        change = np.diff(both.person_velocity, axis=0) / both.step
        rate = np.hypot(change[..., 0], change[..., 1])
        rate = np.where(both.person_linked, rate, np.nan)
    error = SURE * both.person_noise.acceleration
    who = ""
    if np.isfinite(rate).any():
        who = f"person {both.ids[int(np.nanargmax(rate)) % speed.shape[1]]}"
    times = np.broadcast_to(both.time[: len(rate), None], rate.shape).ravel()
    yield _found("person_acceleration", shield.person_acceleration, rate.ravel(), times, error, "m/s^2", who)


def _latency(log: Any, shield: Shield) -> ShieldAssumption:
    """Return the delay of people and the age of the newest one when a command took effect."""
    delays = getattr(log, "delay", {}) or {}
    topic = getattr(log, "people_topic", "")
    delay = delays.get(topic)
    reports = np.asarray(getattr(log, "people_time", ()), dtype=np.float64)
    commands = np.asarray(getattr(log, "commands", np.empty((0, 4))), dtype=np.float64).reshape(-1, 4)
    if delay is None or len(reports) == 0:
        note = "the log holds no record times of people"
        return ShieldAssumption("latency", NOT_MEASURABLE, shield.latency, np.nan, np.nan, 0.0, "s", np.nan, note)
    # The newest report that had arrived by then.
    when = commands[:, 0] if len(commands) else reports + delay.median
    last = np.searchsorted(reports, when - delay.median + 1e-9, "right") - 1
    age = np.where(last >= 0, when - reports[np.maximum(last, 0)], np.nan) + (delay.most - delay.median)
    note = "" if len(commands) else "without commands: age on arrival only"
    found = _found("latency", shield.latency, age, when, 0.0, "s", note)
    if not len(commands) and found.status == HELD:
        return found._replace(status=NOT_MEASURABLE)
    return found


def _position_error(both: Synchronized, shield: Shield) -> ShieldAssumption:
    sigma = both.person_noise.position
    note = "noise from row to row; an error that lasts is not seen in a log"
    if sigma < ROUNDING:
        return ShieldAssumption(
            "position_error", NOT_MEASURABLE, shield.position_error, np.nan, np.nan, 0.0, "m", np.nan, note
        )
    size = SURE * sigma
    status = BROKEN if size > shield.position_error else NOT_MEASURABLE
    return ShieldAssumption(
        "position_error", status, shield.position_error, size, size, 0.0, "m", float(both.time[0]), note
    )


def _margin(log: Any, shield: Shield) -> ShieldAssumption:
    jumps = getattr(log, "pose_jumps", ())
    if not jumps:
        note = "no jump of the pose; an error that lasts is not seen in a log"
        return ShieldAssumption("margin", NOT_MEASURABLE, shield.margin, np.nan, np.nan, 0.0, "m", np.nan, note)
    lengths = np.array([each[2] for each in jumps])
    times = np.array([each[0] for each in jumps])
    return _found("margin", shield.margin, lengths, times, 0.0, "m", f"{len(jumps)} jumps of the pose")


def _tracking(both: Synchronized, log: Any, shield: Shield) -> ShieldAssumption:
    """Return how far the speed is from the one that was asked for, after the robot has had time to follow."""
    commands = np.asarray(getattr(log, "commands", np.empty((0, 4))), dtype=np.float64).reshape(-1, 4)
    absolute, share = shield.velocity_tracking
    if len(commands) < 2:
        note = "the log holds no commands"
        return ShieldAssumption("velocity_tracking", NOT_MEASURABLE, absolute, np.nan, np.nan, 0.0, "m/s", np.nan, note)
    last = np.clip(np.searchsorted(commands[:, 0], both.time, "right") - 1, 0, None)
    asked = np.hypot(commands[:, 1], commands[:, 2])
    changed = np.append(0, np.flatnonzero(np.abs(np.diff(asked)) > 1e-3) + 1)
    since = commands[changed[np.searchsorted(changed, last, "right") - 1], 0]
    settled = (both.time - since > SETTLED) & (both.time >= commands[0, 0]) & (both.time - commands[last, 0] < 1.0)
    off = np.abs(np.hypot(*both.velocity.T) - asked[last]) - share * asked[last]
    off = np.where(settled & both.whole, np.maximum(off, 0.0), np.nan)
    note = f"beside {100.0 * share:g} % of the speed asked for, {SETTLED:g} s after it changed"
    return _found("velocity_tracking", absolute, off, both.time, SURE * both.noise.velocity, "m/s", note)


def _deceleration(both: Synchronized, assumed: float | None) -> ShieldAssumption:
    """Return the deceleration that was reached: what is less than assumed may have been all that was asked for."""
    speed = np.hypot(*both.velocity.T)
    with np.errstate(invalid="ignore", divide="ignore"):
        slower = -np.einsum("ki,ki->k", both.acceleration, both.velocity) / speed
    slower = np.where(both.whole & (speed > SLOW), slower, np.nan)
    error = SURE * both.noise.acceleration
    limit = float("nan") if assumed is None else assumed
    if not np.isfinite(slower).any():
        return ShieldAssumption(
            "deceleration", NOT_MEASURABLE, limit, np.nan, np.nan, error, "m/s^2", np.nan, "too few poses"
        )
    worst = int(np.nanargmax(slower))
    most, high = float(slower[worst]), float(np.nanquantile(slower, 0.99))
    reached = assumed is not None and most - error >= assumed
    note = "" if reached else "the robot never braked harder, which does not say that it could not"
    status = HELD if reached else NOT_MEASURABLE
    return ShieldAssumption("deceleration", status, limit, high, most, error, "m/s^2", float(both.time[worst]), note)


def _period(log: Any, assumed: float | None) -> ShieldAssumption:
    commands = np.asarray(getattr(log, "commands", np.empty((0, 4))), dtype=np.float64).reshape(-1, 4)
    steps = np.diff(commands[:, 0])
    # Times are those of recording, or rounded.
    slack = None if assumed is None else assumed * 1.05
    found = _found("control_period", slack, steps, commands[:-1, 0], 0.0, "s", "")
    limit = float("nan") if assumed is None else assumed
    note = found.note if len(steps) == 0 or assumed is not None else "the period of the controller is not given"
    return found._replace(limit=limit, note=note)
