"""Random impacts for the comparison with the exact evaluation, most of them hard in a named way."""

from __future__ import annotations

import itertools
import math
import random
from collections.abc import Callable

import numpy as np

from reference.impact_metrics import Extent
from reference.impact_mpmath import Impact, Parameters, quartic

GAPS = (1e-2, 1e-12)


def log_uniform(source: random.Random, low: float, high: float) -> float:
    return math.exp(source.uniform(math.log(low), math.log(high)))


def speeds(source: random.Random) -> tuple[float, float]:
    closing = source.uniform(0.05, 2.0)
    return closing, source.choice([closing, source.uniform(0.0, 1.0)])


def typical(source: random.Random) -> Parameters:
    """Manipulators, heads and foams that one may meet."""
    return Parameters(
        log_uniform(source, 1.0, 100.0),
        source.uniform(0.0, 600.0),
        log_uniform(source, 1e3, 1e5),
        source.uniform(3.0, 7.0),
        source.choice([0.0, source.uniform(0.0, 200.0)]),
        source.uniform(5e2, 1e4),
        log_uniform(source, 2e3, 1.5e5),
        source.uniform(0.0, 350.0),
        *speeds(source),
    )


def extreme(source: random.Random) -> Parameters:
    """Ratios far from any real impact."""
    return Parameters(
        log_uniform(source, 0.05, 1e4),
        log_uniform(source, 1e-3, 1e3),
        log_uniform(source, 1e-2, 1e6),
        log_uniform(source, 0.05, 1e3),
        log_uniform(source, 1e-3, 3e2),
        log_uniform(source, 1e-2, 1e6),
        log_uniform(source, 1.0, 1e6),
        log_uniform(source, 1e-3, 1e3),
        *speeds(source),
    )


def missing_parts(source: random.Random) -> Parameters:
    """No damping somewhere, or no spring at the manipulator or the neck."""
    p = typical(source)
    names = ["manipulator_damping", "head_damping", "foam_damping", "manipulator_stiffness", "head_stiffness"]
    return p._replace(**dict.fromkeys(source.sample(names, source.randint(1, 5)), 0.0))


def overdamped(source: random.Random) -> Parameters:
    """Every uncoupled part has real rates."""
    p = typical(source)
    rates = [log_uniform(source, 5.0, 300.0) for _ in range(4)]
    return p._replace(
        manipulator_damping=p.manipulator_mass * (rates[0] + rates[1]),
        manipulator_stiffness=p.manipulator_mass * rates[0] * rates[1],
        head_damping=p.head_mass * (rates[2] + rates[3]),
        head_stiffness=p.head_mass * rates[2] * rates[3],
    )


def touching_zero(source: random.Random) -> Parameters:
    """The head acceleration dips just below zero, or nearly, before it really ends."""
    while True:
        p = typical(source)._replace(foam_damping=source.uniform(205.0, 320.0), head_mass=source.uniform(4.0, 6.0))
        p = p._replace(head_damping=source.uniform(80.0, 160.0), manipulator_damping=source.uniform(150.0, 400.0))
        jump = jump_of_period(p)
        if jump is not None:
            away = source.choice([-1.0, 1.0]) * log_uniform(source, 1e-4, 3e-2)
            return p._replace(foam_stiffness=jump * (1.0 + away))


def jump_of_period(p: Parameters, low: float = 3e3, high: float = 1e5) -> float | None:
    """Return a foam stiffness at which the impact period changes by a jump."""

    def period(stiffness: float) -> float:
        return float(Extent(Impact(p._replace(foam_stiffness=stiffness), exact=False), 0.2).end)

    grid = [low * (high / low) ** (k / 24) for k in range(25)]
    found = [period(stiffness) for stiffness in grid]
    drop, i = max((before - after, i) for i, (before, after) in enumerate(itertools.pairwise(found)))
    if drop < 0.2 * found[i] or found[i] >= 0.2:
        return None
    below, above, middle = grid[i], grid[i + 1], found[i] - drop / 2
    while above - below > 1e-13 * above:
        stiffness = (below + above) / 2
        below, above = (stiffness, above) if period(stiffness) > middle else (below, stiffness)
    return above if period(below) - period(above) > 0.05 * found[i] else None


def equal_uncoupled(source: random.Random) -> Parameters:
    """K_r/M_r = K_h/M_h and C_r/M_r = C_h/M_h, coupled by a foam so soft that the pairs nearly fall together."""
    gap = log_uniform(source, *GAPS)
    m_r, m_h = source.choice([(8.0, 4.0), (4.0, 4.0), (16.0, 4.0), (12.0, 4.0), (10.0, 5.0)])
    rate, damping = float(source.randint(300, 6000)), float(source.choice([0, 1, 5, 20, 30]))
    joint = 1.0 / m_r + 1.0 / m_h
    soft = 2.0 * rate * gap / joint
    c_c = source.choice([0.0, 2.0 * gap * math.sqrt(rate) / joint])
    return Parameters(m_r, m_r * damping, m_r * rate, m_h, m_h * damping, m_h * rate, soft, c_c, *speeds(source))


def critical(source: random.Random) -> Parameters:
    """Exactly repeated rates: a double, two double, a triple one, all in numbers without rounding."""
    m_r, m_h = source.choice([(4.0, 4.0), (12.0, 4.0), (8.0, 8.0), (2.0, 6.0)])
    joint = m_r * m_h / (m_r + m_h)  # a whole number for these
    one, two = sorted(source.sample(range(10, 200), 2))
    both, foam = source.choice(
        [
            ((2 * one, one * one), (2 * (two - one), two * two - one * one)),  # one, one, two, two
            ((2 * one, one * one), (two - one, one * two - one * one)),  # one three times, two
            ((2 * one, one * one), (0, two * two - one * one)),  # one, one and a pair of complex ones
        ]
    )
    c, k = map(float, both)
    return Parameters(m_r, m_r * c, m_r * k, m_h, m_h * c, m_h * k, joint * foam[1], joint * foam[0], *speeds(source))


def nearly_critical(source: random.Random) -> Parameters:
    """A perturbed repeated rate: a relative change of gap^2 parts a double root by gap."""
    p, change = critical(source), log_uniform(source, 1e-8, 3e-3) ** 2
    name = source.choice(["manipulator_damping", "manipulator_stiffness", "head_stiffness"])
    return p._replace(**{name: getattr(p, name) * (1.0 + source.choice([-1.0, 1.0]) * change)})


def merging(source: random.Random) -> Parameters:
    """No special parts, but the damping of the manipulator is where two complex rates become real."""

    def complex_rates(p: Parameters, damping: float) -> int:
        return int(np.sum(np.abs(np.roots(quartic(p._replace(manipulator_damping=damping))).imag) > 0.0))

    while True:
        p = typical(source)
        top = 20.0 * math.sqrt(p.manipulator_mass * p.manipulator_stiffness)
        low, high = 0.0, top
        if complex_rates(p, high) >= complex_rates(p, low):
            continue
        many = complex_rates(p, low)
        while high - low > 1e-15 * high:
            damping = (low + high) / 2
            if damping in (low, high):
                break
            low, high = (damping, high) if complex_rates(p, damping) == many else (low, damping)
        change = source.choice([-1.0, 1.0]) * log_uniform(source, 1e-8, 2e-3) ** 2
        return p._replace(manipulator_damping=high * (1.0 + change))


FAMILIES: dict[str, tuple[int, Callable[[random.Random], Parameters]]] = {
    "typical": (500, typical),
    "extreme": (120, extreme),
    "missing parts": (40, missing_parts),
    "overdamped": (40, overdamped),
    "touching zero": (60, touching_zero),
    "equal uncoupled": (80, equal_uncoupled),
    "critical": (60, critical),
    "nearly critical": (60, nearly_critical),
    "merging": (40, merging),
}
REPEATED = ("equal uncoupled", "critical", "nearly critical", "merging")
