"""Curves in the space of the joints: cubic polynomials of a parameter between nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple, Self

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array

Indices = npt.NDArray[np.intp]

__all__ = ["Indices", "JointCurve"]


class JointCurve(NamedTuple):
    """Cubics of the parameter s, one for each interval between neighboring nodes.

    Attributes
    ----------
    nodes : ndarray (n + 1,)
        Values of s, increasing from 0.
    coefficients : ndarray (n, 4, joints)
        Of the powers 0 to 3 of the way from the node before.
    """

    nodes: Array
    coefficients: Array

    @property
    def length(self) -> float:
        """Last value of s."""
        return float(self.nodes[-1])

    @property
    def end(self) -> tuple[Array, Array]:
        """Joint values and tangent at the end."""
        value, first, _ = self.at(self.nodes[-1:])
        return value[0], first[0]

    @property
    def start(self) -> tuple[Array, Array]:
        """Joint values and tangent at the start."""
        return self.coefficients[0, 0], self.coefficients[0, 1]

    def at(self, s: Array, interval: Indices | None = None) -> tuple[Array, Array, Array]:
        """Return joint values with first and second derivative by s.

        Parameters
        ----------
        s : ndarray (...)
            Places.
        interval : ndarray (...) or None
            Whose polynomial counts; ``None``: that which the place lies in, on a node the one behind it.

        Returns
        -------
        tuple of three ndarray (..., joints)
            q, q' and q''.
        """
        if interval is None:
            interval = np.clip(np.searchsorted(self.nodes, s, side="right") - 1, 0, len(self.coefficients) - 1)
        d = (s - self.nodes[interval])[..., np.newaxis]
        a, b, c, e = np.moveaxis(self.coefficients[interval], -2, 0)
        return a + d * (b + d * (c + d * e)), b + d * (2.0 * c + 3.0 * d * e), 2.0 * c + 6.0 * d * e

    def part(self, start: float, end: float) -> JointCurve:
        """Return the part between two places, its parameter from 0."""
        inner = self.nodes[(self.nodes > start) & (self.nodes < end)]
        nodes = np.concatenate([[start], inner, [end]])
        middles = 0.5 * (nodes[:-1] + nodes[1:])
        at = np.clip(np.searchsorted(self.nodes, middles, side="right") - 1, 0, len(self.coefficients) - 1)
        value, first, second = self.at(nodes[:-1], at)
        third = self.coefficients[at, 3]
        return JointCurve(nodes - start, np.stack([value, first, 0.5 * second, third], axis=1))

    @classmethod
    def straight(cls, start: Array, end: Array) -> Self:
        """Return the straight line between two poses; s is its length."""
        length = float(np.linalg.norm(end - start))
        way = (end - start) / length
        return cls(np.array([0.0, length]), np.stack([start, way, 0.0 * way, 0.0 * way])[np.newaxis])

    @classmethod
    def bend(cls, start: tuple[Array, Array], end: tuple[Array, Array], length: float) -> Self:
        """Return the cubic with given values and tangents at both ends."""
        (first, tangent), (last, leaving) = start, end
        slope = (last - first) / length
        second = (3.0 * slope - 2.0 * tangent - leaving) / length
        third = (tangent + leaving - 2.0 * slope) / length**2
        return cls(np.array([0.0, length]), np.stack([first, tangent, second, third])[np.newaxis])

    @classmethod
    def spline(cls, knots: Array, values: Array) -> Self:
        """Return the cubic spline through points with the condition not-a-knot at both ends; s begins at 0."""
        return cls(knots - knots[0], _hrsafety.program_spline(knots - knots[0], np.ascontiguousarray(values)))

    @classmethod
    def joined(cls, curves: Sequence[JointCurve]) -> Self:
        """Return curves one behind the other."""
        starts = np.concatenate([[0.0], np.cumsum([each.length for each in curves])])
        parts = [each.nodes[1:] + start for each, start in zip(curves, starts, strict=False)]
        return cls(np.concatenate([[0.0], *parts]), np.concatenate([each.coefficients for each in curves]))

    def reversed(self) -> JointCurve:
        """Return the same curve from its end to its start."""
        value, first, second = self.at(self.nodes[1:], np.arange(len(self.coefficients)))
        powers = np.stack([value, -first, 0.5 * second, -self.coefficients[:, 3]], axis=1)
        return JointCurve(self.nodes[-1] - self.nodes[::-1], powers[::-1].copy())

    def refined(self, parts: npt.NDArray[np.int64]) -> JointCurve:
        """Return the same curve with each interval cut into so many equal ones."""
        return JointCurve(*_hrsafety.program_refine(self.nodes, self.coefficients, parts))
