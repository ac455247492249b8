"""Positions that are measured with an error and late."""

from __future__ import annotations

from dataclasses import field
from typing import Literal

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters
from hrsafety._records import dataclass

__all__ = ["Measurement"]


@dataclass(frozen=True, kw_only=True, slots=True)
class Measurement(Parameters):
    """Noisy and late positions, measured once a control period; velocities are backward differences.

    What is measured at time t is the position at ``t - latency`` plus the noise. Obstacles at rest
    are known exactly. The noise is drawn from the seed of the scenario, one stream for the robot and
    one for each obstacle.

    Before time 0 the robot stood at its start, and an obstacle moved as the first piece of its
    motion says, run backwards: straight at its velocity, on its parabola if it accelerates, as
    recorded if the recording begins earlier. One that was absent ``latency`` ago is not seen yet,
    and one that has left since is still seen.

    Parameters
    ----------
    scale : float
        Half width of the uniform error of x and y each, or its standard deviation for
        ``"gaussian"``, in m.
    distribution : {"uniform", "gaussian"}
        Kind of error. A Gaussian error is drawn again beyond 8 standard deviations, so it is
        bounded; a scale of 0.0032 m has the mean error of 4 mm of the source's camera.
    of : {"obstacles", "robot", "both"}
        Which positions are noisy and late: those of moving obstacles, that of the robot, or both.
    latency : float
        Age of the measured positions, in s, at most 60.

    Raises
    ------
    InvalidParameterError
        If scale or latency is negative or not finite, latency is above 60 s, or a word is unknown.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.Measurement(scale=0.025).distribution
    'uniform'
    """

    scale: float = 0.025
    distribution: Literal["uniform", "gaussian"] = "uniform"
    of: Literal["obstacles", "robot", "both"] = "obstacles"
    latency: float = 0.0
    _native: _hrsafety.Measurement = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers("scale", "latency")
        self._set(_native=_hrsafety.Measurement(distribution=self.distribution, of=self.of, **values))
