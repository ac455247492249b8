"""Tables D.1, D.2, E.1, E.2: wheels identified again, and their controllers at work."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator, Sequence
from functools import cache

import numpy as np

from hrsafety import navigation as nav
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.published import Row, printed_rows
from hrsafety.reproduce.sheets import Sheet

__all__ = ["COMMANDS", "ROBOTS", "cells", "in_direction", "sine_runs"]

COMMANDS = (0.25, 0.3, 0.35, 0.4, 0.45, 0.5)
ROBOTS = {"D": nav.robots.HOLONOMIC_WHEELS, "E": nav.robots.DIFFERENTIAL_WHEELS}
"""Wheels by the letter of the appendix."""
SHEET = Sheet("built")
MODEL = {"K_over_J": "rad/(s^2 V)", "B_over_J": "1/s", "tau_over_J": "rad/s^2"}
SYMBOLS = {
    "K_over_J": "K/J",
    "B_over_J": "B/J",
    "tau_over_J": "tau/J",
    "J_over_K": "J/K",
    "B_over_K": "B/K",
    "tau_over_K": "tau/K",
}
FACTORS = {"J_over_K": "V s^2", "B_over_K": "V s", "tau_over_K": "V"}
MILLI = 1000.0


def cells() -> list[PrintedValue]:
    """Return the cells of both appendices."""
    made: list[PrintedValue] = []
    for letter in ROBOTS:
        made += [*_recovered(letter), *_means(letter), *_feed_forward(letter), *_loops(letter)]
    return [*made, *_stuck(), *_observer(), *_period()]


def in_direction(wheel: nav.robots.WheelDrive, row: Row) -> nav.robots.WheelDrive:
    """Return a wheel with the parameters that are printed for one direction."""
    gain = row["K_over_J"]
    return dataclasses.replace(
        wheel, inertia=1.0 / gain, viscous_friction=row["B_over_J"] / gain, static_friction=row["tau_over_J"] / gain
    )


def _recovered(letter: str) -> Iterator[PrintedValue]:
    """Yield what open-loop tests with the printed parameters of each direction give back."""
    for row in printed_rows(f"{letter}.1"):
        wheel = in_direction(ROBOTS[letter][row["wheel"] - 1], row)
        sign = 1.0 if row["direction"] == "forward" else -1.0
        fit = nav.robots.identify_wheel(nav.robots.open_loop_tests(wheel, sign * np.array(COMMANDS)))
        found = {
            "K_over_J": fit.command_gain,
            "B_over_J": fit.decay,
            "tau_over_J": fit.friction_deceleration,
        }
        still = int((~fit.moved).sum())
        held = f" {still} of the 12 tests do not move and are left out." if still else ""
        for name, unit in MODEL.items():
            words = {"letter": letter, "wheel": row["wheel"], "direction": row["direction"], "name": SYMBOLS[name]}
            yield SHEET.number("recovered", found[name], printed=row[name], unit=unit, held=held, **words)


@cache
def _mean_model(letter: str) -> list[dict[str, float]]:
    """Return the means of both directions of each wheel."""
    rows = printed_rows(f"{letter}.1")
    pairs = [[row for row in rows if row["wheel"] == wheel + 1] for wheel in range(len(ROBOTS[letter]))]
    return [{name: float(np.mean([row[name] for row in pair])) for name in MODEL} for pair in pairs]


def _means(letter: str) -> Iterator[PrintedValue]:
    for row, mean in zip(printed_rows(f"{letter}.2.6"), _mean_model(letter), strict=True):
        for name, unit in MODEL.items():
            words = {"letter": letter, "wheel": row["wheel"], "name": SYMBOLS[name], "unit": unit, "limit": name}
            yield SHEET.number("mean", mean[name], printed=row[name], **words)


def _feed_forward(letter: str) -> Iterator[PrintedValue]:
    for row, mean in zip(printed_rows(f"{letter}.2"), _mean_model(letter), strict=True):
        gain = mean["K_over_J"]
        found = {"J_over_K": 1.0 / gain, "B_over_K": mean["B_over_J"] / gain, "tau_over_K": mean["tau_over_J"] / gain}
        for name, value in found.items():
            words = {"letter": letter, "wheel": row["wheel"], "name": SYMBOLS[name], "unit": FACTORS[name]}
            limit = "half_a_hundredth" if letter == "E" and name == "tau_over_K" else name
            odd = letter == "E" and name == "J_over_K" and row["wheel"] == 1
            why = SHEET.text("rounded_factor") if odd else ""
            yield SHEET.number("feed_forward", value, printed=row[name], limit=limit, why=why, **words)


@cache
def sine_runs(letter: str, feedback: nav.robots.wheels.Feedback, quantized: bool) -> tuple[nav.robots.WheelRun, ...]:
    """Return the wheels of a robot after a sine of 1 rad/s and 0.5 Hz for 8 s."""
    reference = nav.robots.WheelReference.sine(speed=1.0, frequency=0.5, duration=8.0)
    wheels = [dataclasses.replace(wheel, feedback=feedback) for wheel in ROBOTS[letter]]
    if not quantized:
        wheels = [dataclasses.replace(wheel, encoder_counts=None) for wheel in wheels]
    return tuple(nav.robots.follow_wheel(wheel, reference) for wheel in wheels)


def _loops(letter: str) -> Iterator[PrintedValue]:
    """Yield what the gains, which are tuned by hand, amount to."""
    runs = sine_runs(letter, "observer", True)
    for row, wheel, run in zip(printed_rows(f"{letter}.2"), ROBOTS[letter], runs, strict=True):
        frequency = math.sqrt(wheel.proportional_gain / wheel.inertia)
        ratio = (wheel.derivative_gain + wheel.viscous_friction) / (2.0 * wheel.inertia * frequency)
        yield SHEET.listed(
            "loop",
            letter=letter,
            wheel=row["wheel"],
            K_P=row["K_P"],
            K_D=row["K_D"],
            frequency=frequency,
            ratio=ratio,
            error=MILLI * run.rms_angle_error,
            loss=run.energy,
            ideal=run.ideal_energy,
        )


def _stuck() -> Iterator[PrintedValue]:
    run = nav.robots.open_loop_tests(nav.robots.DIFFERENTIAL_WHEELS[1], [0.25], repeats=1)[0]
    friction = nav.robots.DIFFERENTIAL_WHEELS[1].static_friction
    turned = np.abs(run.angle).max()
    yield SHEET.claim("stuck", holds=bool(turned > 0.0), turned=turned, friction=friction)


def _jump(runs: Sequence[nav.robots.WheelRun]) -> float:
    """Return the rms change of the current from one wheel period to the next, in mA."""
    return MILLI * max(float(np.sqrt(np.mean(np.diff(run.current) ** 2))) for run in runs)


def _observer() -> Iterator[PrintedValue]:
    for letter in ROBOTS:
        rough, smooth = sine_runs(letter, "differences", True), sine_runs(letter, "observer", True)
        exact = sine_runs(letter, "differences", False)
        words = [
            f"{name} {MILLI * max(run.rms_angle_error for run in runs):.2f} mrad, {_jump(runs):.1f} mA, "
            f"{sum(run.energy for run in runs):.2f} J"
            for name, runs in (("differences", rough), ("observer", smooth), ("differences without counts", exact))
        ]
        smoother = _jump(rough) > 5.0 * _jump(smooth)
        yield SHEET.claim("observer", holds=smoother, letter=letter, words="; ".join(words))


def _period() -> Iterator[PrintedValue]:
    for letter, wheels in ROBOTS.items():
        words = []
        for period in (0.001, 0.005, 0.01, 0.02):
            reference = nav.robots.WheelReference.sine(duration=8.0, period=period)
            runs = [nav.robots.follow_wheel(dataclasses.replace(wheel, period=period), reference) for wheel in wheels]
            words.append(f"{MILLI * period:g} ms {MILLI * max(run.rms_angle_error for run in runs):.3g} mrad")
        yield SHEET.listed("period", letter=letter, words=", ".join(words))
