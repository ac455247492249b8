"""Every printed form of Omega that the errata list is told apart from the right one.

Omega is written here term by term, for two moving and accelerating discs, with the names of
`docs/theory/equations.md`. The right sum must be the package's; each sum with one printed term
put back must not.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cache

import numpy as np
import pytest

from hrsafety import navigation as nav

K1, K3, K5 = 3.0, 20.0, 17.0
MASS = nav.HolonomicRobot().mass
GOAL = np.array([0.0, 0.0])
STATES = 300
ROUNDING = 1e-9  # relative to the sum of the magnitudes: Omega cancels by a few decades
SEPARATED = 1e-4  # the same measure, in the median of the states that the term concerns


@dataclass(frozen=True)
class Term:
    """What one disc contributes at one state; vectors in the plane, scalars as named there."""

    E: np.ndarray
    Edot: np.ndarray
    u: np.ndarray
    u_psi: np.ndarray
    a_o: np.ndarray
    d: float
    ddot: float
    a: float
    c: float
    s: float
    Phi: float
    Phidot: float
    betadot: float
    alphaddot: float

    @property
    def L(self) -> float:  # noqa: N802  # letters of the source
        return self.a**2 / self.c

    @property
    def Ld(self) -> float:  # noqa: N802  # letters of the source
        return -self.ddot * self.a**2 / self.c**2

    @property
    def KLdot(self) -> float:  # noqa: N802  # letters of the source
        return -2.0 * self.ddot * (self.a**2 / self.c**3 + self.a / self.c**2)

    @property
    def psi(self) -> float:
        return self.a**2 * abs(self.Phi)

    @property
    def psid(self) -> float:
        return self.a**2 * self.s * self.Phidot

    @property
    def f(self) -> np.ndarray:
        return K3 * self.L * self.u + K5 * self.psi * self.u_psi

    @property
    def l(self) -> np.ndarray:  # noqa: E743  # letter of the source
        return K3 * self.Ld * self.u + K5 * self.psid * self.u_psi


RIGHT: dict[str, Callable[[Term], float]] = {
    "attraction": lambda n: -K1 * n.Edot @ n.f,
    "repulsion": lambda n: -2.0 * K3**2 * n.ddot * n.a / n.c * n.L,
    "approach": lambda n: MASS / 2.0 * K3 * n.KLdot * n.ddot**2,
    "a_o along u_psi": lambda n: K5 * n.psid * MASS * n.a_o @ n.u_psi,
    "E along u_psi": lambda n: -K5 * n.psid * K1 * n.E @ n.u_psi,
    "alphaddot": lambda n: K5 * n.psid * n.s * MASS * n.d * n.alphaddot,
    "Coriolis": lambda n: K5 * n.psid * 2.0 * n.s * MASS * n.ddot * n.betadot,
    "E along u": lambda n: -K3 * n.Ld * K1 * n.E @ n.u,
    "a_o along u": lambda n: K3 * n.Ld * MASS * n.a_o @ n.u,
    "centrifugal": lambda n: -K3 * n.Ld * MASS * n.d * n.betadot**2,
    "turning": lambda n: MASS * K5 * (n.a**2 / 2.0 - n.a * n.d) * n.ddot * n.Phidot**2,
    "detour": lambda n: -2.0 * K5**2 * n.a**3 * n.ddot * n.Phi**2,
    "side rule": lambda n: (n.s * math.copysign(1.0, n.Phi) - 1.0) * K5**2 * n.psi * n.psid,
}

# Printed in the source; a term that is missing there is zero.
PRINTED: dict[str, dict[str, Callable[[Term], float]]] = {
    "(B.2.4)": {"centrifugal": lambda _: 0.0},
    "(B.2.5)": {"alphaddot": lambda _: 0.0, "Coriolis": lambda _: 0.0},
    "(B.2.3)": {"approach": lambda n: -MASS / 2.0 * K3 * n.KLdot * n.d**2},
    "(5.5.8), a_o along u_psi": {"a_o along u_psi": lambda n: K5 * n.psid * n.a_o @ n.u_psi},
    "(5.5.8), a_o along u": {"a_o along u": lambda n: K3 * n.Ld * n.a_o @ n.u},
    "(5.5.8), last term": {"detour": lambda n: -(K5**2) * n.a * n.ddot * n.Phi**2},
    "(B.2.7), last term": {"detour": lambda n: -(K5**2) * n.a * n.ddot * n.Phidot**2},
    "(B.3.2), first term": {
        "attraction": lambda n: K1 * n.Edot @ (K3 * n.Ld * n.u + K5 * n.psid * n.u_psi),
    },
    "no term of the side rules": {"side rule": lambda _: 0.0},
}


def disc_term(disc: nav.MovingDisc, position: np.ndarray, velocity: np.ndarray, side: int) -> Term:
    """Return the geometry of one disc."""
    V_o, a_o = np.array(disc.velocity), np.array(disc.acceleration)  # noqa: N806  # letters of the source
    D, W = position - disc.center, GOAL - disc.center  # noqa: N806  # letters of the source
    d, w = float(np.hypot(*D)), float(np.hypot(*W))
    u, u_w = D / d, W / w
    t, t_w = np.array([-u[1], u[0]]), np.array([-u_w[1], u_w[0]])
    betadot = t @ (velocity - V_o) / d
    alphadot = t_w @ -V_o / w
    return Term(
        E=GOAL - position,
        Edot=-velocity,
        u=u,
        u_psi=side * t,
        a_o=a_o,
        d=d,
        ddot=u @ (velocity - V_o),
        a=disc.active_radius - d,
        c=d - disc.critical_radius,
        s=side,
        Phi=math.atan2(u[0] * u_w[1] - u[1] * u_w[0], u @ u_w),
        Phidot=alphadot - betadot,
        betadot=betadot,
        alphaddot=(t_w @ -a_o - 2.0 * (u_w @ -V_o) * alphadot) / w,
    )


@dataclass(frozen=True)
class Sample:
    """Omega of the package at one state, and the discs there."""

    omega: float
    terms: list[Term]

    def parts(self, changes: dict[str, Callable[[Term], float]]) -> list[float]:
        return [float(part(term)) for part in (RIGHT | changes).values() for term in self.terms]

    def cross(self) -> float:
        return -sum(float(one.l @ other.f) for one in self.terms for other in self.terms if one is not other)


def discs(source: np.random.Generator, position: np.ndarray) -> Iterator[nav.MovingDisc]:
    for _ in range(2):
        angle, distance = source.uniform(-math.pi, math.pi), source.uniform(0.9, 1.8)
        yield nav.MovingDisc(
            center=tuple(position + distance * np.array([math.cos(angle), math.sin(angle)])),
            radius=0.4,
            velocity=tuple(source.uniform(-1.0, 1.0, 2)),
            acceleration=tuple(source.uniform(-1.0, 1.0, 2)),
            active_radius=2.1,
            critical_radius=0.8,
        )


@cache
def samples() -> list[Sample]:
    source = np.random.default_rng(558)
    law = nav.VirtualForceField(attractive_gain=K1, repulsive_gain=K3, detour_gain=K5)
    found = []
    for _ in range(STATES):
        position, velocity = source.uniform(2.0, 4.0, 2), source.uniform(-0.5, 0.5, 2)
        obstacles = list(discs(source, position))
        scene = nav.Scenario(start=(90.0, 90.0), goal=tuple(GOAL), obstacles=obstacles)
        terms = nav.force_terms(law, scene, position=position, velocity=velocity)
        sides = zip(obstacles, terms.side.tolist(), strict=True)
        found.append(Sample(terms.omega, [disc_term(disc, position, velocity, side) for disc, side in sides]))
    return found


def test_right_form_is_what_the_package_evaluates() -> None:
    for sample in samples():
        parts = [*sample.parts({}), sample.cross()]
        assert abs(sum(parts) - sample.omega) <= ROUNDING * sum(map(abs, parts))


@pytest.mark.parametrize("place", PRINTED)
def test_printed_form_is_told_apart(place: str) -> None:
    differences = []
    for sample in samples():
        right, printed = sample.parts({}), sample.parts(PRINTED[place])
        if right != printed:
            differences.append(abs(sum(printed) - sum(right)) / sum(map(abs, right)))
    assert len(differences) > STATES // 10
    assert np.median(differences) > SEPARATED


def test_cross_terms_are_told_apart() -> None:
    differences = [abs(sample.cross()) / sum(map(abs, sample.parts({}))) for sample in samples()]
    assert np.median(differences) > SEPARATED
