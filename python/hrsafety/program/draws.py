"""Motions of an arm without a program: drawn within the limits of its joints."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, checked_seed, count, instance
from hrsafety._records import dataclass
from hrsafety.arms import Arm
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.program.motion import velocities_of

__all__ = ["LISTED", "OUTSIDE", "DrawnMotions", "Quantile", "quantiles_of"]

FEWEST_DRAWS = 100
MOST_DRAWS = 10**6
LISTED = (0.5, 0.95, 0.99)
"""Quantiles that are always told."""
OUTSIDE = 0.025
"""Probability that a quantile lies beyond one end of its interval."""


class Quantile(NamedTuple):
    """A quantile of draws with its interval between order statistics, which holds it with 95 %.

    Attributes
    ----------
    level : float
        Share of the draws that are not larger.
    value, low, high : float
        The quantile of the draws and the ends of its interval; inf or -inf where the draws are too few for an end.
    """

    level: float
    value: float
    low: float
    high: float


def quantiles_of(values: Array, levels: tuple[float, ...]) -> tuple[Quantile, ...]:
    """Return quantiles of independent draws with intervals that ask nothing of their distribution.

    Parameters
    ----------
    values : ndarray (n,)
        Draws; inf is larger than all.
    levels : tuple of float
        Within 0 and 1.
    """
    ordered, size = np.sort(values), len(values)
    logs = np.concatenate([[0.0], np.cumsum(np.log(np.arange(1, size + 1)))])
    ways = logs[-1] - logs - logs[::-1]
    steps = np.arange(size + 1)
    found = []
    for level in levels:
        below = np.cumsum(np.exp(ways + steps * np.log(level) + steps[::-1] * np.log1p(-level)))
        first = int(np.searchsorted(below, OUTSIDE, side="right"))  # rank of the lower end, 0: none
        last = int(np.searchsorted(below, 1.0 - OUTSIDE)) + 1
        low = float(ordered[first - 1]) if first > 0 else -np.inf
        high = float(ordered[last - 1]) if last <= size else np.inf
        rank = min(max(int(np.ceil(level * size)), 1), size)
        found.append(Quantile(level, float(ordered[rank - 1]), low, high))
    return tuple(found)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class DrawnMotions:
    """Motions of an arm that has no program: poses between the limits of the joints, and directions of their rates.

    Values are uniform between the limits of each joint; rates have all directions alike, each joint in units of its
    largest rate. Every motion is as fast as the joints allow in its direction.

    Parameters
    ----------
    arm : Arm
        The arm.
    velocity : float, array_like (joints,), mapping of str to float, or None
        Largest rates in rad/s or m/s; those of the URDF when ``None``.
    draws : int
        How many, 100 to 1,000,000.
    seed : int
        Of the draws.

    Raises
    ------
    InvalidParameterError
        If a value is out of its range, or a joint slides without limits.

    Examples
    --------
    >>> from hrsafety import arms, program
    >>> motions = program.DrawnMotions(arm=arms.Arm.example(), velocity=2.0, draws=1000)
    >>> float(abs(motions.rates).max(axis=1).min())
    2.0
    """

    arm: Arm
    velocity: object = None
    draws: int = 20_000
    seed: int = 0

    def __post_init__(self) -> None:
        """Check the values."""
        if instance("arm", self.arm, Arm).base_joints:
            raise InvalidParameterError("arm", "stand still without a program", Shown("a base that rolls"))
        count("draws", self.draws, least=FEWEST_DRAWS, most=MOST_DRAWS)
        object.__setattr__(self, "seed", checked_seed("seed", self.seed))
        object.__setattr__(self, "velocity", velocities_of(self.arm, self.velocity))
        _hrsafety.program_draws(self.arm._native, self.rates_most, 1, self.seed)

    @property
    def rates_most(self) -> Array:
        """Largest rates (joints,) in rad/s or m/s."""
        return np.asarray(self.velocity)

    def drawn(self) -> tuple[Array, Array]:
        """Return joint values and rates.

        Returns
        -------
        tuple of two ndarray (draws, joints)
            In rad and rad/s, or m and m/s where a joint slides.
        """
        joints, rates = _hrsafety.program_draws(self.arm._native, self.rates_most, self.draws, self.seed)
        share = np.abs(rates / self.rates_most).max(axis=1, keepdims=True)
        if not share.all():
            raise InvalidParameterError("seed", "give draws that move", self.seed)
        return joints, rates / share

    @property
    def rates(self) -> Array:
        """Rates (draws, joints) in rad/s or m/s."""
        return self.drawn()[1]
