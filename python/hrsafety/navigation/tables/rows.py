"""Rows of tables of runs: laws in scenarios or worlds, with their gains."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, Self

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, word
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.tables import SHOWN_ROWS, Columns, Table, unit_suffix

__all__ = ["RunRows"]


class RunRows(Table, ABC):
    """Base of tables of runs: which law, which scenario and which gains each row has."""

    __slots__ = ()
    law_names: tuple[str, ...]
    scenario_names: Sequence[str]
    laws: tuple[Law, ...]
    scenarios: Sequence[Any]
    gain_names: tuple[str, ...]
    law_index: npt.NDArray[np.int64]
    scenario_index: npt.NDArray[np.int64]
    seed: npt.NDArray[np.uint64]
    gains: Array
    outcome: npt.NDArray[np.str_]

    def __len__(self) -> int:
        """Return the number of rows."""
        return len(self.outcome)

    @property
    def law(self) -> npt.NDArray[np.str_]:
        """Name of the law of each run."""
        return np.array(self.law_names)[self.law_index]

    @property
    def scenario(self) -> npt.NDArray[np.str_]:
        """Name of the scenario or world of each run."""
        return np.array(self.scenario_names)[self.scenario_index]

    def select(self, *, law: str | None = None, scenario: str | None = None) -> Self:
        """Return the runs of one law, of one scenario, or of both.

        Parameters
        ----------
        law, scenario : str or None
            Name; all when ``None``.

        Returns
        -------
        RunTable
            These runs in the same order.

        Raises
        ------
        InvalidParameterError
            If there is no such law or scenario.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> places = {name: scenarios.configuration(name) for name in ("c1", "c2")}
        >>> runs = nav.simulate_many(places, [nav.VirtualForceField(), nav.Masoud()])
        >>> len(runs.select(law="Masoud")), len(runs.select(law="Masoud", scenario="c2"))
        (2, 1)
        """
        found = self
        if law is not None:
            found = found._only("law", self.law_names.index(word("law", law, self.law_names)))
        if scenario is not None:
            found = found._only("scenario", self.scenario_names.index(word("scenario", scenario, self.scenario_names)))
        return found

    def _only(self, what: str, index: int) -> Self:
        """Return the runs of one law or scenario, by its index."""
        kept = getattr(self, f"{what}_index") == index
        columns = self._kept(kept) | {f"{what}_index": np.zeros(int(kept.sum()), dtype=np.int64)}
        names, objects = getattr(self, f"{what}_names"), getattr(self, f"{what}s")
        single = {f"{what}_names": (names[index],), f"{what}s": (objects[index],)}
        table: Any = self
        found: Self = replace(table, **columns, **single)
        return found

    def _kept(self, kept: npt.NDArray[Any]) -> dict[str, Any]:
        """Return the fields that have a row for each run, for some of the runs."""
        table: Any = self
        found = {field.name: getattr(self, field.name) for field in fields(table)}
        columns = {name: values[kept] for name, values in found.items() if isinstance(values, np.ndarray)}
        return columns | {"values": {name: column[kept] for name, column in found["values"].items()}}

    def _head(self) -> tuple[Columns, int]:
        return self._columns(slice(SHOWN_ROWS)), len(self)

    def _shown(self) -> tuple[list[str], list[list[str]], str]:
        header, cells, title = super()._shown()
        words, counts = np.unique(self.outcome, return_counts=True)
        ended = ", ".join(f"{word} {count}" for word, count in zip(words.tolist(), counts.tolist(), strict=True))
        return header, cells, f"{title}; outcomes: {ended}"

    @abstractmethod
    def _columns(self, rows: slice) -> Columns:
        """Return the columns of some rows; names are written out for these only."""

    def _of_law(self, rows: slice) -> Columns:
        """Return law, scenario and seed of some rows."""
        return {
            "law": np.array(self.law_names)[self.law_index[rows]],
            "scenario": np.array(self.scenario_names)[self.scenario_index[rows]],
            "seed": self.seed[rows],
        }

    def _of_gains(self, rows: slice) -> Columns:
        """Return the gains of some rows by name and unit."""
        units = {name: unit for law in reversed(self.laws) for name, unit in law.GAIN_UNITS.items()}
        names = [name + unit_suffix(units.get(name, "")) for name in self.gain_names]
        return {name: self.gains[rows, index] for index, name in enumerate(names)}
