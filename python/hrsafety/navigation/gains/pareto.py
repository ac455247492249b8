"""Fronts of gains, and gains as columns of a table."""

from __future__ import annotations

from hrsafety._arguments import Array, count
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.gains.metrics import METRIC_UNITS
from hrsafety.navigation.gains.problem import with_gains
from hrsafety.navigation.gains.settings import SearchSettings
from hrsafety.navigation.gains.worlds import doubts_of
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.warnings import runs as run_warnings
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table, unit_suffix

__all__ = ["ParetoFront", "gain_columns"]


def gain_columns(law: Law, gains: Array) -> Columns:
    """Return a column for each gain, with its unit in the name."""
    names = [f"{name}{unit_suffix(law.GAIN_UNITS.get(name, ''))}" for name in law.GAIN_NAMES]
    return {name: gains[:, index] for index, name in enumerate(names)}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ParetoFront(Table):
    """Gain sets that no other one beats in every objective.

    Attributes
    ----------
    objectives : tuple of str
        Names of the metrics.
    maximized : tuple of bool
        Whether large values of each are good.
    gains : ndarray, shape (n, 4)
        K_1, K_3, K_5, b; ordered by the first objective, best first.
    values : ndarray, shape (n, objectives)
        Metrics in their own units: the mean over the scenarios, for a clearance the least.
    reference : ndarray, shape (objectives,)
        Corner that the hypervolume is measured from: the worst value of each on the front.
    hypervolume : float
        Volume between front and reference, each objective divided by its range on the front.
    evaluations, episodes, failures : int
        As in `GainSearch`.
    interrupted : bool
        Whether the search was stopped before its end.
    settings : SearchSettings
        Everything that is needed to run the same search again.
    """

    objectives: tuple[str, ...]
    maximized: tuple[bool, ...]
    gains: Array
    values: Array
    reference: Array
    hypervolume: float
    evaluations: int
    episodes: int
    failures: int
    interrupted: bool
    settings: SearchSettings

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why the numbers may not mean what they seem to: the first warning of each kind, and how many follow."""
        if isinstance(self.settings.scenarios[0], World):
            return doubts_of(self.settings.scenarios, self.settings.law)
        return run_warnings.of_scenes(self.settings.scenarios, [self.settings.law], self.settings.step)

    def __len__(self) -> int:
        """Return the number of gain sets."""
        return len(self.gains)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each gain set.

        Returns
        -------
        dict of str to ndarray
            Gains, then objectives; units are in the names.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> front = nav.gains.pareto_front([scenarios.configuration("c1")], grid=(3, 3, 3, 3), refinements=0)
        >>> list(front.columns())[2:]
        ['detour_gain_N_per_m2', 'gain_ratio_s', 'arrival_time_s', 'min_clearance_m', 'energy_J']
        """
        found = gain_columns(self.settings.law, self.gains)
        units = (unit_suffix(METRIC_UNITS.get(name, "")) for name in self.objectives)
        named = zip(self.objectives, units, self.values.T, strict=True)
        return found | {f"{name}{unit}": values for name, unit, values in named}

    def law(self, index: int) -> Law:
        """Return the law with the gains of one point of the front.

        Parameters
        ----------
        index : int
            Row of ``gains``.

        Returns
        -------
        Law
            The searched law with these gains.

        Raises
        ------
        InvalidParameterError
            If there is no such row.
        """
        row = count("index", index, least=0)
        if row >= len(self.gains):
            raise InvalidParameterError("index", f"be below {len(self.gains)}", index)
        return with_gains(self.settings.law, self.gains[row])
