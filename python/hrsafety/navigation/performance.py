"""The score of a run: time, distance and energy."""

from __future__ import annotations

from collections.abc import Sequence

from hrsafety._arguments import number, sequence
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plausibility import ResultWarning

__all__ = ["Performance", "check_weights"]


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Performance:
    """Score of a run, each part from 0 to 1 in ordinary cases, Zeng (2011), section 5.6.

    Attributes
    ----------
    total : float
        H = w_T H_T + w_D H_D + w_E H_E; 0 after a contact or without arrival.
    arrival_time : float
        H_T = T*/T.
    avoidance : float
        H_D: mean over the obstacles of min(d_s / d_s*, 1).
    energy_saving : float
        H_E = L*/L.
    trajectory, nominal : Trajectory
        The run, and the run of the same law without obstacles that gives T* and L*.
    """

    total: float
    arrival_time: float
    avoidance: float
    energy_saving: float
    trajectory: Trajectory
    nominal: Trajectory

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the score may not mean what it seems to: the warnings of the run."""
        return self.trajectory.warnings


def check_weights(weights: Sequence[float]) -> tuple[float, float, float]:
    """Return three weights that are not negative and sum to 1."""
    rule = "be three numbers (time, distance, energy)"
    given = sequence("weights", rule, weights)
    if len(given) != 3:
        raise InvalidParameterError("weights", rule, weights)
    time, distance, energy = (number(f"weights[{i}]", each) for i, each in enumerate(given))
    if not min(time, distance, energy) >= 0.0 or not abs(time + distance + energy - 1.0) <= 1e-9:
        raise InvalidParameterError("weights", "not be negative and sum to 1", weights)
    return (time, distance, energy)
