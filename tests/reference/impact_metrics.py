"""Metrics of an impact from the solution in ``impact_mpmath``: maxima, averages, head injury criterion.

Every candidate for an extremum is found as a zero of a derivative, bracketed on a float grid and
refined in the number type of the solution; the head injury criterion from the conditions of every
set of active limits, near the best pair of a grid.
"""

from __future__ import annotations

import math
from collections.abc import Iterable

import numpy as np
from mpmath import mp

from reference.impact_mpmath import (
    DIGITS,
    UNIFORM,
    Impact,
    Motion,
    Number,
    Parameters,
    Slope,
    bracketed,
    first_fall,
)

HEAD_INJURY_EXPONENT = 2.5
ZOOMS = 3

METRICS = (
    "peak_head_acceleration",
    "peak_head_acceleration_g",
    "mean_head_acceleration_g",
    "peak_contact_force",
    "max_compression",
    "impact_duration",
    "hic15",
    "hic36",
    "average_3ms_g",
    "clip_3ms_g",
    "peak_power_manipulator",
    "peak_power_foam",
)


class Extent:
    """The impact period of a response, or the horizon where it does not end before."""

    def __init__(self, impact: Impact, horizon: float) -> None:
        self.impact = impact
        self.released, self.end = False, impact.number(horizon)
        end_of_period = None if impact.constrained else first_fall(impact, "a", horizon)
        if end_of_period is not None:
            self.released, self.end = True, end_of_period
        self.times = np.append(impact.grid(float(self.end))[:-1], float(self.end))

    def zeros(self, sampled: np.ndarray, function: Slope) -> list[Number]:
        """Return the zeros of a function that is sampled at ``times``."""
        number = self.impact.number
        edges = [*map(number, self.times[:-1]), self.end]
        changes = np.nonzero(np.sign(sampled[:-1]) * np.sign(sampled[1:]) < 0)[0]
        on_grid = [edges[i] for i in np.nonzero(sampled == 0.0)[0]]
        return [*on_grid, *(bracketed(function, edges[i], edges[i + 1]) for i in changes)]

    def critical(self, name: str) -> list[Number]:
        """Return the times where a quantity may have its extrema: both ends and stationary points."""
        impact = self.impact

        def slope(t: Number) -> tuple[Number, Number]:
            return impact.value(name, t, 1), impact.value(name, t, 2)

        inside = self.zeros(impact.sample(name, self.times, 1), slope)
        return [impact.number(0), *inside, self.end]

    def maximum(self, name: str) -> tuple[Number, Number]:
        """Return the largest value of a quantity and its time."""
        return max((self.impact.value(name, t), t) for t in self.critical(name))

    def power(self, name: str) -> tuple[Number, Number]:
        """Return the largest f_c times the manipulator's velocity ("u") or the rate of compression ("eps")."""
        impact = self.impact
        ahead = impact.p.manipulator_speed if name == "u" else impact.number(0)

        def slope(t: Number) -> tuple[Number, Number]:
            f, df, ddf = (impact.value("f", t, k) for k in range(3))
            v, dv, ddv = (impact.value(name, t, k) for k in (1, 2, 3))
            return df * (v + ahead) + f * dv, ddf * (v + ahead) + 2 * df * dv + f * ddv

        sampled = [impact.sample("f", self.times, k) for k in range(2)]
        speed = [impact.sample(name, self.times, k) for k in (1, 2)]
        found = self.zeros(sampled[1] * (speed[0] + float(ahead)) + sampled[0] * speed[1], slope)
        times = [impact.number(0), *found, self.end]
        return max((impact.value("f", t) * (impact.value(name, t, 1) + ahead), t) for t in times)

    def chords(self, window: Number) -> list[Number]:
        """Return the times t with a(t) = a(t + window), and the ends of their range."""
        impact, last = self.impact, self.end - window
        times = np.append(np.linspace(0.0, float(last), max(len(self.times), 600))[:-1], float(last))
        late = np.minimum(times + float(window), float(self.end))
        sampled = impact.sample("a", late) - impact.sample("a", times)

        def slope(t: Number) -> tuple[Number, Number]:
            return (
                impact.value("a", t + window) - impact.value("a", t),
                impact.value("a", t + window, 1) - impact.value("a", t, 1),
            )

        edges = [*map(impact.number, times[:-1]), last]
        changes = np.nonzero(np.sign(sampled[:-1]) * np.sign(sampled[1:]) < 0)[0]
        return [impact.number(0), *(bracketed(slope, edges[i], edges[i + 1]) for i in changes), last]

    def average(self, window: Number) -> Number:
        """Return the largest moving average of the head acceleration."""
        speed = [self.impact.value("w", t + window, 1) - self.impact.value("w", t, 1) for t in self.chords(window)]
        return max(speed) / window

    def clip(self, window: Number) -> Number:
        """Return the largest level that the head acceleration keeps for a contiguous ``window``."""
        impact = self.impact
        turns = self.critical("a")[1:-1]
        minima = [t for t in turns if impact.value("a", t, 2) > 0]

        def lowest(start: Number) -> Number:
            inside = [t for t in minima if start <= t <= start + window]
            return min(impact.value("a", t) for t in [start, start + window, *inside])

        found = [lowest(t) for t in self.chords(window)]
        sampled = impact.sample("a", self.times)
        for t in minima:  # a valley is the level where a longer stay above it exists
            level, here = impact.value("a", t), int(np.searchsorted(self.times, float(t)))
            below = np.nonzero(sampled < float(level) * (1.0 - 1e-12))[0]
            left = self.times[below[below < here][-1]] if np.any(below < here) else 0.0
            right = self.times[below[below > here][0]] if np.any(below > here) else float(self.end)
            if right - left > float(window):
                found.append(level)
        return max(found)

    def head_injury(self, window: Number) -> tuple[Number, Number, Number]:
        """Return the head injury criterion with its two times."""
        impact = self.impact

        def score(t1: Number, t2: Number) -> Number:
            gain = impact.value("w", t2, 1) - impact.value("w", t1, 1)
            mean = gain / (t2 - t1) / impact.g
            return (t2 - t1) * mean ** impact.number(HEAD_INJURY_EXPONENT) if mean > 0 else impact.number(0)

        start = self._best_pair(float(window))
        found = [(score(t1, t2), t1, t2) for t1, t2 in self._stationary(window, *start)]
        best = max(found)
        on_grid = score(*map(impact.number, start))
        if best[0] < on_grid * (1 - impact.number(1e-11)):
            raise ArithmeticError(f"head injury criterion: {best[0]} below {on_grid} on the grid")
        return best

    def _best_pair(self, window: float) -> tuple[float, float]:
        """Return the best pair of times on a grid that is refined around the best of the last."""
        end, impact = float(self.end), self.impact
        low, high = (0.0, 0.0), (end, end)
        best = (0.0, end)
        for zoom in range(ZOOMS + 1):
            count = 400 if zoom == 0 else 61
            one, two = (np.linspace(low[i], high[i], count) for i in range(2))
            gain = impact.sample("w", two, 1)[None, :] - impact.sample("w", one, 1)[:, None]
            between = two[None, :] - one[:, None]
            allowed = (between > 0.0) & (between <= window * (1.0 + 1e-13))
            with np.errstate(all="ignore"):
                score = np.where(allowed & (gain > 0.0), gain**HEAD_INJURY_EXPONENT / between**1.5, 0.0)
            full = np.minimum(one + window, end)  # pairs that fill the window
            filled = np.maximum(impact.sample("w", full, 1) - impact.sample("w", one, 1), 0.0)
            with np.errstate(all="ignore"):
                edge = np.where(full > one, filled**HEAD_INJURY_EXPONENT / (full - one) ** 1.5, 0.0)
            i, j = np.unravel_index(int(np.argmax(score)), score.shape)
            k = int(np.argmax(edge))
            best = (one[i], two[j]) if score[i, j] >= edge[k] else (one[k], full[k])
            reach = 3.0 * max(one[1] - one[0], two[1] - two[0])
            low = (max(0.0, best[0] - reach), max(0.0, best[1] - reach))
            high = (min(end, best[0] + reach), min(end, best[1] + reach))
        return float(best[0]), float(best[1])

    def _stationary(self, window: Number, t1: float, t2: float) -> Iterable[tuple[Number, Number]]:
        """Yield every admissible pair near (t1, t2) that satisfies the conditions of some set of active limits."""
        impact, zero, end = self.impact, self.impact.number(0), self.end
        share = impact.number(3) / 5  # 1 - 1/2.5

        def one_free(time: Number, other: Number) -> tuple[Number, Number]:
            a, da = impact.value("a", time), impact.value("a", time, 1)
            gain = abs(impact.value("w", time, 1) - impact.value("w", other, 1))
            apart = abs(time - other)
            side = 1 if time > other else -1
            return a * apart - share * gain, da * apart + side * (1 - share) * a

        yield zero, min(window, end)
        yield max(zero, end - window), end
        for start in self.chords(window) if window < end else []:
            yield start, start + window
        later = newton(lambda t: one_free(t, zero), impact.number(t2), end)
        if later is not None and 0 < later <= min(window, end):
            yield zero, later
        earlier = newton(lambda t: one_free(t, end), impact.number(t1), end)
        if earlier is not None and max(zero, end - window) <= earlier < end:
            yield earlier, end
        both = self._both_free(impact.number(t1), impact.number(t2))
        if both is not None and 0 <= both[0] < both[1] <= end and both[1] - both[0] <= window:
            yield both

    def _both_free(self, t1: Number, t2: Number) -> tuple[Number, Number] | None:
        impact, share = self.impact, self.impact.number(3) / 5
        for _ in range(60):
            if not 0 <= t1 < t2 <= self.end:
                return None
            a, b = impact.value("a", t1), impact.value("a", t2)
            da, db = impact.value("a", t1, 1), impact.value("a", t2, 1)
            apart, gain = t2 - t1, impact.value("w", t2, 1) - impact.value("w", t1, 1)
            g = (a * apart - share * gain, b * apart - share * gain)
            j11, j12 = da * apart - (1 - share) * a, a - share * b
            j21, j22 = share * a - b, db * apart + (1 - share) * b
            determinant = j11 * j22 - j12 * j21
            if determinant == 0:
                return None
            step = ((g[0] * j22 - g[1] * j12) / determinant, (j11 * g[1] - j21 * g[0]) / determinant)
            t1, t2 = t1 - step[0], t2 - step[1]
            if max(map(abs, step)) <= (t2 - t1) * small_step(t1):
                return t1, t2
        return None


def small_step(like: Number) -> Number:
    return 1e-15 if isinstance(like, float) else mp.mpf(10) ** -(DIGITS - 12)


def newton(function: Slope, t: Number, end: Number) -> Number | None:
    """Return the zero that Newton's method reaches without leaving [0, end], or None."""
    for _ in range(60):
        if not 0 < t <= end:
            return None
        value, slope = function(t)
        if slope == 0:
            return None
        step = value / slope
        t = t - step
        if abs(step) <= abs(t) * small_step(t):
            return t
    return None


def metrics(p: Parameters, *, exact: bool = True, horizon: float = 0.2, motion: Motion = UNIFORM) -> dict[str, Number]:
    """Return every metric of an impact of a free head.

    Without an end of the impact period within ``horizon`` the duration is infinite and all other
    metrics are those of the horizon.
    """
    with mp.workdps(DIGITS):
        impact = Impact(p, exact=exact, motion=motion)
        extent = Extent(impact, horizon)
        number, g = impact.number, impact.g
        peak = extent.maximum("a")[0]
        end, three_ms = extent.end, number("0.003")
        defined = end >= three_ms
        return {
            "peak_head_acceleration": peak,
            "peak_head_acceleration_g": peak / g,
            "mean_head_acceleration_g": impact.value("w", end, 1) / end / g,
            "peak_contact_force": extent.maximum("f")[0],
            "max_compression": extent.maximum("eps")[0],
            "impact_duration": end if extent.released else number("inf"),
            "hic15": extent.head_injury(number("0.015"))[0],
            "hic36": extent.head_injury(number("0.036"))[0],
            "average_3ms_g": extent.average(three_ms) / g if defined else number("nan"),
            "clip_3ms_g": extent.clip(three_ms) / g if defined else number("nan"),
            "peak_power_manipulator": extent.power("u")[0],
            "peak_power_foam": extent.power("eps")[0],
        }


def constrained_metrics(p: Parameters, *, exact: bool = True, horizon: float = 0.05) -> dict[str, Number]:
    """Return the metrics that exist for a constrained head: maxima over the horizon."""
    with mp.workdps(DIGITS):
        extent = Extent(Impact(p._replace(head_mass=math.inf), exact=exact), horizon)
        return {
            "peak_contact_force": extent.maximum("f")[0],
            "max_compression": extent.maximum("eps")[0],
            "peak_power_manipulator": extent.power("u")[0],
            "peak_power_foam": extent.power("eps")[0],
        }
