"""Exact motion of a robot behind the spring of its drive against a bare clamped region."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

__all__ = ["Pressing", "pressing"]

A_PERIOD = 128
"""Places of a period at which a rate is looked at for its roots."""
MOST_PLACES = 2_000_000


class Pressing(NamedTuple):
    """Motion of a robot that presses: compressions and the commanded path in m, times in s."""

    peak: float
    time_of_peak: float
    detection_time: float
    commanded: float
    at_rest: float


def pressing(
    mass: float, stiffness: float, drive: float, speed: float, detection: float, stop: tuple[float, float]
) -> Pressing | None:
    """Return the motion up to rest in its exact pieces: y'' + w^2 y = w^2 b x_d with b = K/(k + K).

    Parameters
    ----------
    mass, stiffness, drive : float
        m in kg, k of the region and K of the drive in N/m.
    speed : float
        v in m/s.
    detection : float
        Compression in m at which the robot notices the contact.
    stop : tuple of two floats
        Time to the first braking in s after that, and deceleration in m/s^2, which may be inf.

    Returns
    -------
    Pressing or None
        ``None`` where the contact is lost on the way, or never noticed.
    """
    b = drive / (stiffness + drive)
    w = math.sqrt((stiffness + drive) / mass)
    noticed = _noticed(b, w, speed, detection)
    if noticed is None:
        return None
    reaction, deceleration = stop
    begins = noticed + reaction
    braking = speed / deceleration
    if (begins + braking) * w / (2.0 * math.pi) * A_PERIOD > MOST_PLACES:
        return None
    # Place, rate and half of the acceleration of the commanded path, duration.
    pieces = [(0.0, speed, 0.0, begins)]
    if braking > 0.0:
        pieces.append((speed * begins, speed, -0.5 * deceleration, braking))
    end = speed * begins + 0.5 * speed * braking
    pieces.append((end, 0.0, 0.0, 2.0 * math.pi / w))
    y, rate, now = 0.0, speed, 0.0
    peak, when = 0.0, 0.0
    for place, along, half, duration in pieces:
        free = b * place - 2.0 * b * half / w**2
        cosine, sine = y - free, (rate - b * along) / w

        def moved(
            t: float,
            free: float = free,
            along: float = along,
            half: float = half,
            cosine: float = cosine,
            sine: float = sine,
        ) -> float:
            return free + b * (along * t + half * t * t) + cosine * math.cos(w * t) + sine * math.sin(w * t)

        def rises(
            t: float, along: float = along, half: float = half, cosine: float = cosine, sine: float = sine
        ) -> float:
            return b * (along + 2.0 * half * t) + w * (sine * math.cos(w * t) - cosine * math.sin(w * t))

        count = max(int(duration * w / (2.0 * math.pi) * A_PERIOD) + 2, 8)
        times = np.linspace(0.0, duration, count)
        rates = b * (along + 2.0 * half * times) + w * (sine * np.cos(w * times) - cosine * np.sin(w * times))
        turns = np.flatnonzero(np.sign(rates[:-1]) * np.sign(rates[1:]) < 0.0)
        found = [_root(rises, float(times[index]), float(times[index + 1])) for index in turns]
        for t in (*found, duration):
            if moved(t) > peak:
                peak, when = moved(t), now + t
        if any(moved(t) < 0.0 for t in found) or moved(duration) < 0.0:
            return None
        y, rate, now = moved(duration), rises(duration), now + duration
    return Pressing(peak, when, noticed, end, b * end)


def _noticed(b: float, w: float, speed: float, detection: float) -> float | None:
    """Return the time at which a compression is first reached while the commanded path moves on."""
    if detection <= 0.0:
        return 0.0

    def moved(t: float) -> float:
        return speed * (b * t + (1.0 - b) * math.sin(w * t) / w) - detection

    if b >= 0.5:
        until = detection / (speed * b) + 1.0 / w * (1.0 - b) / b
        return _root(moved, 0.0, until)
    turn = math.acos(-b / (1.0 - b))
    lowest = 2.0 * math.pi - turn
    if moved(turn / w) >= 0.0:
        return _root(moved, 0.0, turn / w)
    if moved(lowest / w) + detection < 0.0:
        return None
    # Every period is further by as much.
    humps = math.ceil(-moved(turn / w) / (speed * b * 2.0 * math.pi / w))
    before = (lowest + 2.0 * math.pi * (humps - 1)) / w
    return _root(moved, before, (turn + 2.0 * math.pi * humps) / w)


def _root(of: Callable[[float], float], low: float, high: float) -> float:
    """Return where a function passes zero between two times, by halving."""
    below = of(low) < 0.0
    for _ in range(200):
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        low, high = (middle, high) if (of(middle) < 0.0) == below else (low, middle)
    return high
