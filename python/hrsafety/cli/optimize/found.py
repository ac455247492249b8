"""Findings of a gain study: gain sets with their scores, flatness, sensitivity, the front."""

from __future__ import annotations

from hrsafety import navigation as nav
from hrsafety._records import dataclass
from hrsafety.cli.optimize.file import Gains, GainStudy
from hrsafety.navigation.tables.runs import RunTable

__all__ = ["METRIC_UNITS", "MOST_COLUMNS", "MOST_PATHS", "NOT_EVERYWHERE", "FoundGains", "Scored", "gain_words"]

METRIC_UNITS = {
    "performance": "",
    "performance_arrival_time": "",
    "performance_avoidance": "",
    "performance_energy_saving": "",
    "arrival_time": "s",
    "energy": "J",
    "path_length": "m",
    "min_clearance": "m",
}
"""Units of the metrics."""
MOST_PATHS = 8
"""Scenarios whose paths are drawn."""
NOT_EVERYWHERE = "they touch an obstacle or do not arrive somewhere, which the study allows (require_arrival = false)"
"""Shortcoming of best gains that need not arrive everywhere."""
MOST_COLUMNS = 6
"""Scenarios that have a column of their own in the table of gain sets."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Scored:
    """A gain set with what it reaches.

    Attributes
    ----------
    name : str
        As in the file; ``"best"`` for the best set, ``"nearest"`` if none keeps the constraints.
    law : Law
        The law with these gains.
    value : float
        Objective in its own unit: not turned around where small is good.
    scores : RunTable
        One run for each scenario, with its own seed where there is noise.
    runs : tuple of Trajectory
        The same runs through the scenarios whose paths are drawn.
    """

    name: str
    law: nav.Law
    value: float
    scores: RunTable
    runs: tuple[nav.Trajectory, ...]


@dataclass(frozen=True, kw_only=True, slots=True)
class FoundGains:
    """Findings of a gain study.

    Attributes
    ----------
    path : str
        The study file.
    study : GainStudy
        What was asked.
    search : GainSearch
        What was found.
    sets : tuple of Scored
        The best gain set, or the nearest where none is feasible, then those to compare with.
    flatness : Flatness
        The objective along each gain.
    sensitivity : GainSensitivity
        The mean H when one gain changes.
    front : ParetoFront or None
        The front, if asked for.
    seconds : float
        Wall time of the search, in s, without the front; since it was resumed, if it was.
    resumed : bool
        Whether the search went on from a checkpoint.
    """

    path: str
    study: GainStudy
    search: nav.GainSearch
    sets: tuple[Scored, ...]
    flatness: nav.gains.Flatness
    sensitivity: nav.gains.GainSensitivity
    front: nav.gains.ParetoFront | None
    seconds: float
    resumed: bool

    @property
    def objective(self) -> str:
        """Name of the objective."""
        return self.study.objective


def gain_words(gains: Gains) -> str:
    """Return gains in one line."""
    attraction, repulsion, detour, ratio = (f"{gain:.4g}" for gain in gains)
    return f"K_1 {attraction} N/m, K_3 {repulsion} N/m, K_5 {detour} N/m^2, b {ratio} s"
