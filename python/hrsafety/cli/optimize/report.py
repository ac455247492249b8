"""What a search for gains found, as the page, the files and the terminal show it."""

from __future__ import annotations

from hrsafety import navigation as nav
from hrsafety._records import dataclass
from hrsafety.cli.optimize.file import Gains, GainStudy
from hrsafety.cli.output import decimal
from hrsafety.navigation.tables.runs import RunTable

__all__ = [
    "METRIC_UNITS",
    "MOST_PATHS",
    "NOT_EVERYWHERE",
    "GainReport",
    "Scored",
    "Table",
    "confidence_words",
    "gain_words",
    "scenario_table",
    "scenario_words",
    "search_words",
    "set_table",
]

Table = tuple[tuple[tuple[str, ...], tuple[str, ...]], list[tuple[str, ...]]]
"""Names and units of the columns, and the rows."""

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
"""What is wrong with best gains that need not arrive everywhere."""
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
class GainReport:
    """Everything that page and files show.

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


def scenario_words(study: GainStudy) -> str:
    """Return the names of the scenarios, of many the first ones."""
    more = len(study.names) - MOST_PATHS
    names = ", ".join(study.names[:MOST_PATHS])
    return f"{names} and {more} more" if more > 0 else names


def search_words(search: nav.GainSearch) -> str:
    """Return how a search went about it, in one line."""
    settings = search.settings
    if settings.method != "grid":
        return f"{settings.method.replace('_', ' ')}, {search.evaluations:,} gain sets"
    grid = " x ".join(str(count) for count in settings.grid)
    return (
        f"grid {grid}, {settings.refinements} refinements to the {settings.survivors} best, "
        f"{len(search.local)} local searches"
    )


def confidence_words(search: nav.GainSearch) -> str:
    """Return what fresh noise says about the best value; empty without noise."""
    if search.confidence is None:
        return ""
    found = search.confidence
    return (
        f"; with {found.seeds} fresh seeds {found.mean:.5f}, {100.0 * found.level:g} % interval "
        f"[{found.low:.5f}, {found.high:.5f}]"
    )


def set_table(report: GainReport) -> Table:
    """Return the gain sets with their objectives and scores as header and rows."""
    several = len(report.study.names) > MOST_COLUMNS
    scenarios = ("least H", "mean H") if several else tuple(f"H {name}" for name in report.study.names)
    names = ("gains", "K_1", "K_3", "K_5", "b", report.objective, *scenarios)
    units = ("", "N/m", "N/m", "N/m^2", "s", METRIC_UNITS[report.objective], *("" for _ in scenarios))
    rows = []
    for entry in report.sets:
        total = entry.scores.performance_total
        shown = (total.min(), total.mean()) if several else total
        gains = (f"{gain:.3f}" for gain in entry.law.gains)
        rows.append((entry.name, *gains, f"{entry.value:.5f}", *(f"{score:.4f}" for score in shown)))
    return (names, units), rows


def scenario_table(report: GainReport) -> Table:
    """Return the runs of the best gain set, or the nearest without one, as header and rows."""
    first = f"{report.sets[0].name} gains in"
    names = (first, "outcome", "arrival", "energy", "path", "clearance", "H", "H_T", "H_D", "H_E")
    units = ("", "", "s", "J", "m", "m", "", "", "", "")
    table = report.sets[0].scores
    lengths = (table.arrival_time, table.energy, table.path_length)
    shares = (table.performance_arrival_time, table.performance_avoidance, table.performance_energy_saving)
    rows = [
        (
            name,
            str(table.outcome[index]),
            *(decimal(float(column[index])) for column in lengths),
            decimal(float(table.min_clearance[index]), 3),
            *(f"{column[index]:.4f}" for column in (table.performance_total, *shares)),
        )
        for index, name in enumerate(report.study.names)
    ]
    return (names, units), rows
