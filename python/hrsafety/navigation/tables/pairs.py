"""Runs of several laws side by side, episode by episode."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, word
from hrsafety._statistics import Mean, Paired, compare_paired, mean_interval
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Table

__all__ = ["PairedRuns"]


class PairedRuns(Table):
    """Runs of several laws in the same episodes: rows are laws, columns episodes."""

    __slots__ = ()
    runs: RunTable

    @property
    def laws(self) -> tuple[str, ...]:
        """Names of the laws."""
        return self.runs.law_names

    @property
    def scenario_names(self) -> Sequence[str]:
        """Names of the scenarios."""
        return self.runs.scenario_names

    @property
    def scenario(self) -> npt.NDArray[np.int64]:
        """Index of each episode's scenario."""
        first: npt.NDArray[np.int64] = self._by_law(self.runs.scenario_index)[0]
        return first

    @property
    def seed(self) -> npt.NDArray[np.uint64]:
        """Seed of each episode."""
        first: npt.NDArray[np.uint64] = self._by_law(self.runs.seed)[0]
        return first

    @property
    def outcome(self) -> npt.NDArray[np.str_]:
        """How each run ended."""
        return self._by_law(self.runs.outcome)

    def _by_law(self, values: npt.NDArray[Any]) -> npt.NDArray[Any]:
        return values.reshape(len(self.laws), -1, *values.shape[1:])

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Why episodes may not mean what they seem to: the first warning of each kind, and how many follow."""
        return self.runs.warnings

    def contacts_compared(self, first: str, second: str) -> Paired:
        """Compare the contacts of two laws in the same episodes by the exact McNemar test.

        Parameters
        ----------
        first, second : str
            Names of the laws.

        Returns
        -------
        Paired
            Episodes in which just one of them touched something, and the p value.

        Raises
        ------
        InvalidParameterError
            If there is no such law.
        """
        touched = self._touched()
        return compare_paired(touched[self._row("first", first)], touched[self._row("second", second)])

    def _touched(self) -> npt.NDArray[np.bool_]:
        """Return which runs had a contact."""
        return self._by_law(self.runs.touched)

    def _difference(self, first: str, second: str, values: Array, *, successful: bool) -> Mean:
        """Return the mean difference of two laws where both values are finite, or both arrived without a contact."""
        rows = [self._row("first", first), self._row("second", second)]
        one, other = values[rows]
        used = np.isfinite(one) & np.isfinite(other)
        if successful:
            used &= (self.outcome[rows] == "arrived").all(axis=0)
        return mean_interval(one[used] - other[used])

    def _row(self, argument: str, law: str) -> int:
        word(argument, law, self.laws)
        return self.laws.index(law)
