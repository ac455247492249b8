"""Open-loop tests of a wheel, and its parameters from them (sections D.2 and E.2 of Zeng 2011)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Annotated

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import (
    Array,
    checked_seed,
    columns,
    count,
    followed,
    instance,
    number,
    own,
    positive,
    sequence,
    vector,
    whole_steps,
)
from hrsafety._bounds import MOST_REPEATS, MOST_RUNS, MOST_SAMPLES
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.robots.wheels import WheelDrive

__all__ = ["OpenLoopTest", "WheelFit", "identify_wheel", "open_loop_tests"]

COMMANDS = (0.25, 0.3, 0.35, 0.4, 0.45, 0.5)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class OpenLoopTest:
    """A wheel at rest that is given one command.

    Parameters
    ----------
    command : float
        In V; negative drives backward.
    time : array_like of shape (n,)
        In s, increasing from the start of the command.
    angle : array_like of shape (n,)
        Turned since then, in rad.

    Raises
    ------
    InvalidParameterError
        If the command is zero or not finite.
    ShapeError
        If the arrays are not one-dimensional and of one length.
    """

    command: Annotated[float, "V"]
    time: Annotated[Array, "s"]
    angle: Annotated[Array, "rad"]

    def __post_init__(self) -> None:
        """Check the values."""
        command = number("command", self.command)
        if command == 0.0 or not np.isfinite(command):
            raise InvalidParameterError("command", "be finite and not zero", self.command)
        time, angle = columns(time=self.time, angle=self.angle)
        for name, samples in (("time", time), ("angle", angle)):
            if not np.isfinite(samples).all():
                raise InvalidParameterError(name, "be finite", float(samples[~np.isfinite(samples)][0]))
        for name, value in (("command", command), ("time", own(time)), ("angle", own(angle))):
            object.__setattr__(self, name, value)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class WheelFit:
    """Wheel model theta'' = K/J u - B/J theta' - tau/J sgn(theta') from open-loop tests.

    Attributes
    ----------
    command_gain : float
        K/J in rad/(s^2 V).
    decay : float
        B/J in 1/s, the mean over the tests.
    friction_deceleration : float
        tau/J in rad/s^2.
    covariance : ndarray of shape (2, 2)
        Covariance of `command_gain` and -`friction_deceleration`.
    interval : ndarray of shape (3, 2)
        95 % confidence intervals of gain, decay and friction.
    command : ndarray of shape (n,)
        Commands of all tests, in V.
    moved : ndarray of shape (n,)
        Which tests moved; the others are left out.
    acceleration : ndarray of shape (n,)
        A of each test in rad/s^2, NaN where it did not move.
    test_decay : ndarray of shape (n,)
        kappa of each test in 1/s, NaN where it did not move.
    residual_deviation : ndarray of shape (n,)
        Of the angles of each test from its fit, in rad.
    """

    command_gain: float
    decay: Annotated[float, "1/s"]
    friction_deceleration: Annotated[float, "rad/s^2"]
    covariance: Array
    interval: Array
    command: Annotated[Array, "V"]
    moved: npt.NDArray[np.bool_]
    acceleration: Annotated[Array, "rad/s^2"]
    test_decay: Annotated[Array, "1/s"]
    residual_deviation: Annotated[Array, "rad"]

    @property
    def inertia(self) -> float:
        """J/K for an amplifier of 1 A/V, in A s^2."""
        return 1.0 / self.command_gain

    @property
    def viscous_friction(self) -> float:
        """B/K for an amplifier of 1 A/V, in A s."""
        return self.decay / self.command_gain

    @property
    def static_friction(self) -> float:
        """tau/K for an amplifier of 1 A/V, in A."""
        return self.friction_deceleration / self.command_gain

    def angle(self, command: float, time: npt.ArrayLike) -> Array:
        """Return how the identified wheel turns from rest under one command.

        Parameters
        ----------
        command : float
            In V, at an amplifier of 1 A/V.
        time : array_like of shape (n,)
            In s from the start of the command, not negative.

        Returns
        -------
        ndarray of shape (n,)
            In rad; zero where friction holds the wheel.

        Raises
        ------
        InvalidParameterError
            If a value is not finite or a time negative.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> fit = nav.robots.identify_wheel(nav.robots.open_loop_tests(nav.robots.HOLONOMIC_WHEELS[0]))
        >>> fit.angle(0.1, [0.0, 1.0])
        array([0., 0.])
        """
        instants = vector("time", time)
        if not (np.isfinite(instants).all() and (instants >= 0.0).all()):
            raise InvalidParameterError("time", "hold finite numbers that are not negative", time)
        held = number("command", command)
        if not np.isfinite(held):
            raise InvalidParameterError("command", "be finite", command)
        dynamics = (self.inertia, self.viscous_friction, self.static_friction)
        return _hrsafety.wheel_response(instants, dynamics=dynamics, current=held)


def open_loop_tests(
    drive: WheelDrive,
    commands: npt.ArrayLike = COMMANDS,
    *,
    repeats: int = 2,
    duration: float = 1.0,
    seed: int = 0,
    progress: Callable[[int, int], object] | None = None,
) -> list[OpenLoopTest]:
    """Return simulated open-loop tests of a wheel, as its encoder sees them.

    Each test begins at an angle between two counts that is drawn anew.

    Parameters
    ----------
    drive : WheelDrive
        The wheel; its controller rests.
    commands : array_like of shape (n,)
        In V, by default those of the thesis.
    repeats : int
        Tests for each command.
    duration : float
        Length of a test in s; a sample is taken each wheel period.
    seed : int
        Of the angles at the start.
    progress : callable or None
        Called with (tests done, tests in all) at the start and after each.

    Returns
    -------
    list of OpenLoopTest
        In the order of the commands, repeats together.

    Raises
    ------
    InvalidParameterError
        If a value is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> tests = nav.robots.open_loop_tests(nav.robots.HOLONOMIC_WHEELS[0], [0.3, 0.5])
    >>> len(tests), tests[0].command
    (4, 0.3)
    """
    wheel = instance("drive", drive, WheelDrive)
    wanted = vector("commands", commands)
    times = count("repeats", repeats, most=MOST_REPEATS)
    periods = round(whole_steps("duration", positive("duration", duration), wheel.period, MOST_SAMPLES))
    if periods < 4:
        raise InvalidParameterError("duration", "hold at least 4 wheel periods", duration)
    if periods * times * len(wanted) > MOST_RUNS:
        raise InvalidParameterError("repeats", f"give at most {MOST_RUNS} samples in all", repeats)
    draws = np.random.default_rng(checked_seed("seed", seed))
    time = wheel.period * np.arange(periods + 1, dtype=np.float64)
    tests = []
    for command in followed(np.repeat(wanted, times).tolist(), progress):
        start = wheel.resolution * draws.uniform(-0.5, 0.5)
        angle = wheel._native.open_loop_angles(command=float(command), start_angle=start, periods=periods)
        tests.append(OpenLoopTest(command=float(command), time=time, angle=angle))
    return tests


def identify_wheel(tests: Sequence[OpenLoopTest], *, least_angle: float = 0.01) -> WheelFit:
    """Return the parameters of a wheel from open-loop tests at several commands.

    Each test is fitted by theta = A (kappa t - 1 + exp(-kappa t)) / kappa^2, (D.2.3) of Zeng (2011)
    with its letters in their places; A = K/J u - tau/J is a line through all tests, and B/J the mean
    of kappa (D.2.4). Backward tests count with both signs reversed.

    Parameters
    ----------
    tests : sequence of OpenLoopTest
        At least three that move, at two commands or more.
    least_angle : float
        A test that never turns so far, in rad, did not move and is left out.

    Returns
    -------
    WheelFit
        Parameters with covariance and intervals.

    Raises
    ------
    InvalidParameterError
        If too few tests move, or a value is out of range.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> fit = nav.robots.identify_wheel(nav.robots.open_loop_tests(nav.robots.HOLONOMIC_WHEELS[0]))
    >>> round(fit.command_gain), round(fit.friction_deceleration, 1)
    (137, 25.7)
    """
    each = [instance("tests", test, OpenLoopTest) for test in sequence("tests", "be a sequence of OpenLoopTest", tests)]
    least = positive("least_angle", least_angle)
    moved = np.array([bool(np.abs(test.angle).max(initial=0.0) >= least) for test in each], dtype=np.bool_)
    if moved.sum() < 3:
        raise InvalidParameterError("tests", "hold at least 3 tests that move", int(moved.sum()))
    found = np.full((3, len(each)), np.nan)
    for index in np.flatnonzero(moved):
        test = each[index]
        fit = _hrsafety.fit_open_loop(test.time, np.sign(test.command) * test.angle)
        found[:, index] = fit["acceleration"], fit["decay"], fit["residual_deviation"]
    commands = np.array([test.command for test in each])
    accelerations, decays = np.ascontiguousarray(found[0, moved]), np.ascontiguousarray(found[1, moved])
    line = _hrsafety.identify_direct_drive(np.abs(commands[moved]), accelerations, decays, 1.0, 1.0)
    gain, offset = line["interval"]
    return WheelFit(
        command_gain=line["command_gain"],
        decay=line["decay"],
        friction_deceleration=-line["friction_offset"],
        covariance=line["covariance"],
        interval=np.array([gain, line["decay_interval"], -offset[::-1]]),
        command=commands,
        moved=moved,
        acceleration=found[0],
        test_decay=found[1],
        residual_deviation=found[2],
    )
