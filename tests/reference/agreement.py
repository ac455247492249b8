"""Differences of the package from the second evaluation, each at the scale of its parts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from reference import plain_field as pf
from reference.random_states import State


def norm(vector: pf.Vector) -> float:
    return math.hypot(*vector)


class Scales(NamedTuple):
    """Magnitudes that rounding acts on: of a difference, the sum of the magnitudes of its parts."""

    attractive: float
    repulsive: list[float]
    detour: list[float]
    omega: float
    stabilizing: float
    total: float
    value: float
    derivative: float


def scales(law: pf.Law, state: State, plain: pf.Evaluation) -> Scales:
    """Return the scales of all terms at a state outside the critical regions."""
    gains = law.gains
    repulsive, detour = [], []
    for obstacle in state.obstacles:
        g = pf.geometry(obstacle, state.position, state.velocity, state.goal)
        near = 1.0 if g.region == "active" else 0.0
        repulsive.append(near * gains.repulsive * g.a**2 / g.c * (1.0 + gains.ratio * abs(g.d_dot) / g.c))
        detour.append(near * gains.detour * g.a**2 * (abs(g.phi) + gains.ratio * abs(g.phi_dot)))
    attractive = gains.attractive * (norm(pf.minus(state.goal, state.position)) + gains.ratio * norm(state.velocity))
    stabilizing = 0.0
    if norm(plain.stabilizing) > 0.0:
        cancelled = plain.v_l_magnitude / norm(plain.v_l) + plain.omega_magnitude / plain.omega
        stabilizing = norm(plain.stabilizing) * cancelled
    work = plain.v_l_magnitude * (gains.ratio * plain.v_l_magnitude + stabilizing)
    return Scales(
        attractive=attractive,
        repulsive=repulsive,
        detour=detour,
        omega=plain.omega_magnitude,
        stabilizing=stabilizing,
        total=attractive + math.fsum(repulsive) + math.fsum(detour) + stabilizing,
        value=plain.value,
        derivative=plain.omega_magnitude + work,
    )


class Worst:
    """The largest scaled difference of each term."""

    def __init__(self) -> None:
        self.found: dict[str, float] = {}

    def see(self, term: str, actual: object, expected: object, scale: float) -> None:
        """Take one comparison into account; a scale of zero demands equality."""
        difference = float(np.linalg.norm(np.asarray(actual, dtype=float) - np.asarray(expected, dtype=float)))
        share = difference / scale if scale > 0.0 else math.copysign(math.inf, difference) if difference else 0.0
        self.found[term] = max(self.found.get(term, 0.0), math.inf if math.isnan(share) else share)

    def see_each(self, term: str, actual: Sequence[object], expected: Sequence[object], scale: Sequence[float]) -> None:
        """Take one comparison for each obstacle into account."""
        for pair in zip(actual, expected, scale, strict=True):
            self.see(term, *pair)

    def largest(self) -> float:
        """Return the largest of all scaled differences."""
        return max(self.found.values())

    def __str__(self) -> str:
        """Return every term with its largest scaled difference."""
        return ", ".join(f"{term} {share:.1e}" for term, share in self.found.items())
