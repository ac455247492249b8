"""Impact of a covered manipulator and a head: a second evaluation that knows no characteristic root.

The equations of motion are solved by Taylor series about points along the time axis, in 50 digits
(mpmath) or in float. With ``u = x_r - v_r t`` (manipulator from its set-point) and
``w = x_h - v_h t - T_u`` (head from the torso), which with their rates start at zero,

    eps = v_c t + u - w,      f_c = K_c eps + C_c eps'
    M_r u'' = -f_c - C_r u' - K_r u + (K_r d + C_r d' + M_r d''  with feed-forward),    d = x_d - v_r t
    M_h w'' =  f_c - C_h w' - K_h w        (w = 0 for a constrained head)

The coefficients of all series follow from these lines, so repeated, real and complex roots, and
systems without damping, are one case. Extrema and zeros are bracketed on a float grid far finer
than the fastest mode and refined by safeguarded Newton in the number type of the series; what is made
of the solution is in ``impact_metrics``.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from mpmath import mp, mpf

DIGITS = 50
GRAVITY = "9.80665"
PANEL = 4.0  # length of a panel times the fastest rate: terms stay below exp(4) of their sum
GRID = 64  # intervals of the bracketing grid per panel

Number = Any
"""A float or an mpf."""

Slope = Callable[[Number], tuple[Number, Number]]
"""Value and derivative of a function at a time."""


class Parameters(NamedTuple):
    """One impact; a head of mass ``math.inf`` is a constrained one."""

    manipulator_mass: float
    manipulator_damping: float
    manipulator_stiffness: float
    head_mass: float
    head_damping: float
    head_stiffness: float
    foam_stiffness: float
    foam_damping: float
    closing_speed: float
    manipulator_speed: float


class Motion(NamedTuple):
    """Set-point of the manipulator from its uniform motion: ``acceleration t^2/2``."""

    acceleration: Number = 0
    feed_forward: bool = True


UNIFORM = Motion()


class Panel(NamedTuple):
    """Taylor coefficients about ``start`` of u, w, eps, f_c and the head acceleration."""

    start: Number
    end: Number
    series: dict[str, list[Number]]


def quartic(p: Parameters) -> list[float]:
    """Return the characteristic polynomial, highest power first."""
    m_r, c_r, k_r, m_h, c_h, k_h, k_c, c_c = map(float, p[:8])
    if math.isinf(m_h):
        return [m_r, c_r + c_c, k_r + k_c]
    manipulator, head, foam = np.poly1d([m_r, c_r, k_r]), np.poly1d([m_h, c_h, k_h]), np.poly1d([c_c, k_c])
    return list((manipulator * head + foam * (manipulator + head)).coeffs)


class Impact:
    """The solution of one impact, continued panel by panel as far as it is asked for."""

    def __init__(self, p: Parameters, *, exact: bool = True, motion: Motion = UNIFORM) -> None:
        self.number: Callable[[Any], Number] = mpf if exact else float
        self.exact = exact
        with mp.workdps(DIGITS):
            self.p = Parameters(*(self.number(value) for value in p))
            self.motion = Motion(self.number(motion.acceleration), motion.feed_forward)
            self.g = self.number(GRAVITY)
        self.constrained = math.isinf(p.head_mass)
        self.rate = max([1.0, *np.abs(np.roots(quartic(p)))])
        length = PANEL if exact else PANEL / 4.0
        self.length = self.number(length / self.rate)
        smallest = 10.0 ** -(DIGITS + 3) if exact else 1e-18
        self.order = 4
        while length**self.order / math.factorial(self.order) > smallest:
            self.order += 1
        zero = self.number(0)
        self.panels: list[Panel] = [self._panel(zero, (zero,) * 4)]

    def _panel(self, start: Number, state: tuple[Number, ...]) -> Panel:
        p, zero = self.p, start * 0
        u, w = [state[0], state[1]], [state[2], state[3]]
        drive = self._drive(start)
        eps = [u[0] - w[0] + p.closing_speed * start, u[1] - w[1] + p.closing_speed]
        f, a = [], []
        for k in range(self.order):
            f.append(p.foam_stiffness * eps[k] + p.foam_damping * (k + 1) * eps[k + 1])
            pull = p.manipulator_damping * (k + 1) * u[k + 1] + p.manipulator_stiffness * u[k]
            given = drive[k] if k < len(drive) else zero
            u.append((given - f[k] - pull) / (p.manipulator_mass * ((k + 1) * (k + 2))))
            neck = p.head_damping * (k + 1) * w[k + 1] + p.head_stiffness * w[k]
            a.append(zero if self.constrained else (f[k] - neck) / p.head_mass)
            w.append(a[k] / ((k + 1) * (k + 2)))
            eps.append(u[k + 2] - w[k + 2])
        return Panel(start, start + self.length, {"u": u, "w": w, "eps": eps, "f": f, "a": a})

    def _drive(self, t: Number) -> list[Number]:
        """Return the coefficients about t of the force that the set-point adds."""
        p, (accel, feed) = self.p, self.motion
        fed = p.manipulator_mass * accel if feed else 0 * t
        return [
            p.manipulator_stiffness * accel * t * t / 2 + p.manipulator_damping * accel * t + fed,
            p.manipulator_stiffness * accel * t + p.manipulator_damping * accel,
            p.manipulator_stiffness * accel / 2,
        ]

    def extend(self) -> Panel:
        """Add one panel."""
        last = self.panels[-1]
        state = [evaluate(last.series[name], self.length, order) for name in ("u", "w") for order in (0, 1)]
        self.panels.append(self._panel(last.end, tuple(state)))
        return self.panels[-1]

    def panel_at(self, t: Number) -> Panel:
        index = max(0, int(t / self.length))
        while len(self.panels) <= index:
            self.extend()
        return self.panels[index]

    def value(self, name: str, t: Number, order: int = 0) -> Number:
        """Return a derivative of u, w, eps, f or a at a time."""
        panel = self.panel_at(t)
        return evaluate(panel.series[name], t - panel.start, order)

    def grid(self, until: float) -> np.ndarray:
        """Return times on [0, until] as fine as the bracketing needs."""
        count = math.ceil(until / float(self.length)) * GRID
        return np.linspace(0.0, until, max(count, 4 * GRID) + 1)

    def sample(self, name: str, times: np.ndarray, order: int = 0) -> np.ndarray:
        """Return float values at increasing times, for bracketing only."""
        which = np.floor(times / float(self.length)).astype(int)
        found = np.empty(len(times))
        for index in np.unique(which):
            rows = which == index
            panel = self.panel_at((index + 0.5) * float(self.length))
            series, h = panel.series[name], float(self.length)
            weights = [float(c * self.length**k) for k, c in enumerate(series)]
            polynomial = np.polynomial.Polynomial(weights).deriv(order) if order else np.polynomial.Polynomial(weights)
            found[rows] = polynomial((times[rows] - float(panel.start)) / h) / h**order
        return found

    def state(self, t: Number) -> dict[str, Number]:
        """Return every trajectory at a time; head position from T_u."""
        p = self.p
        u, w = self.value("u", t), self.value("w", t)
        du, dw = self.value("u", t, 1), self.value("w", t, 1)
        head_speed = p.manipulator_speed - p.closing_speed
        return {
            "contact_force": self.value("f", t),
            "head_acceleration": self.value("a", t),
            "head_position": head_speed * t + w,
            "head_velocity": head_speed + dw,
            "manipulator_position": p.manipulator_speed * t + u,
            "manipulator_velocity": p.manipulator_speed + du,
            "compression": self.value("eps", t),
        }


def evaluate(series: list[Number], x: Number, order: int = 0) -> Number:
    """Return a derivative of a polynomial, lowest power first, by Horner's rule."""
    total = series[0] * 0
    for k in range(len(series) - 1, order - 1, -1):
        total = total * x + series[k] * math.perm(k, order)
    return total


def refine(function: Slope, low: Number, high: Number) -> Number:
    """Return the zero between two times; ``function`` gives value and slope, with one change of sign."""
    at_low = function(low)[0]
    if at_low == 0:
        return low
    t, small = (low + high) / 2, (high - low) * (mp.mpf(10) ** -(DIGITS - 4) if not isinstance(low, float) else 1e-17)
    for _ in range(400):
        value, slope = function(t)
        if value == 0:
            return t
        if (value > 0) == (at_low > 0):
            low = t
        else:
            high = t
        step = -value / slope if slope != 0 else high - low
        after = t + step
        if not low < after < high:
            after = (low + high) / 2
        if abs(after - t) <= small:
            return after
        t = after
    raise ArithmeticError("no convergence")


def bracketed(function: Slope, low: Number, high: Number) -> Number:
    """Return the zero between two times that float values bracket; the bracket may be off by a rounding."""
    for _ in range(3):
        if (function(low)[0] > 0) != (function(high)[0] > 0):
            return refine(function, low, high)
        low, high = max(low - (high - low), low * 0), high + (high - low)
    raise ArithmeticError("bracket lost")


def first_fall(impact: Impact, name: str, horizon: float) -> Number | None:
    """Return the first time after 0 at which a quantity becomes negative, up to ``horizon``.

    Valleys between two samples are looked into, however shallow.
    """

    def with_slope(t: Number) -> tuple[Number, Number]:
        return impact.value(name, t), impact.value(name, t, 1)

    def slope(t: Number) -> tuple[Number, Number]:
        return impact.value(name, t, 1), impact.value(name, t, 2)

    start = 0.0
    while start < horizon:
        stop = min(start + float(impact.length), horizon)
        times = np.linspace(start, stop, GRID + 1)
        sampled, rising = impact.sample(name, times), impact.sample(name, times, 1)
        peak = max(np.abs(sampled).max(), 1e-300)
        below = sampled < -1e-14 * peak
        valleys = (rising[:-1] < 0.0) & (rising[1:] > 0.0) & ~below[:-1] & ~below[1:]
        reach = (times[1] - times[0]) * np.maximum(-rising[:-1], rising[1:])  # no valley is deeper than this
        valleys &= np.minimum(sampled[:-1], sampled[1:]) <= reach
        for i in np.nonzero(below[1:] | valleys)[0]:
            low, high = impact.number(times[i]), impact.number(times[i + 1])
            if not below[i + 1]:
                high = bracketed(slope, low, high)
                if impact.value(name, high) >= 0:
                    continue
            return bracketed(with_slope, low, high)
        start = stop
    return None


def release(p: Parameters, *, exact: bool = True, horizon: float = 0.2) -> tuple[Number, Number] | None:
    """Return when foam that cannot pull lets go, and its compression then; None if it does not."""
    with mp.workdps(DIGITS):
        impact = Impact(p, exact=exact)
        time = first_fall(impact, "f", horizon)
        return None if time is None else (time, impact.value("eps", time))


def root_gap(p: Parameters) -> float:
    """Return the smallest relative distance of two characteristic roots, zero below 1e-20."""
    with mp.workdps(3 * DIGITS):
        m_r, c_r, k_r, m_h, c_h, k_h, k_c, c_c = map(mpf, p[:8])
        rates = mp.matrix(
            [
                [0, 1, 0, 0],
                [-(k_r + k_c) / m_r, -(c_r + c_c) / m_r, k_c / m_r, c_c / m_r],
                [0, 0, 0, 1],
                [k_c / m_h, c_c / m_h, -(k_h + k_c) / m_h, -(c_h + c_c) / m_h],
            ]
        )
        roots = mp.eig(rates, left=False, right=False)
        size = max(map(abs, roots))
        roots = [root for root in roots if abs(root) > size * mpf(10) ** -20]  # those at the origin are no mode
        gaps = [abs(a - b) / max(abs(a), abs(b)) for i, a in enumerate(roots) for b in roots[:i]]
        least = float(min(gaps)) if gaps else math.inf
        return least if least > 1e-20 else 0.0
