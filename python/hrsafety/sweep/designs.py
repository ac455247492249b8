"""Which rows are run: what all designs share, and grids."""

from __future__ import annotations

import itertools
import math
from abc import ABC, abstractmethod
from collections.abc import Collection, Mapping
from dataclasses import replace
from typing import Any, ClassVar, Self

import numpy as np

from hrsafety._arguments import Array, count, sequence
from hrsafety._bounds import MOST_ROWS_AT_ONCE
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Axis

__all__ = ["Design", "Grid", "checked_design"]

MOST_ROWS = 2**53
# Rows that are examined for warnings before a sweep runs.
MOST_LOOKED_AT = 64


@dataclass(frozen=True, slots=True)
class Design(ABC):
    """Base of the designs: rows over named axes, computed when they are asked for.

    Parameters
    ----------
    axes : sequence of Axis
        At least one, of different names.
    """

    axes: tuple[Axis, ...]
    kind: ClassVar[str]

    def __post_init__(self) -> None:
        """Check the axes."""
        axes = tuple(sequence("axes", "be a sequence of Axis", self.axes))
        for index, axis in enumerate(axes):
            if not isinstance(axis, Axis):
                raise InvalidParameterError(f"axes[{index}]", "be an Axis", axis)
        names = [axis.name for axis in axes]
        if not axes:
            raise InvalidParameterError("axes", "hold at least one Axis", Shown("an empty sequence"))
        for name in names:
            if names.count(name) > 1:
                raise InvalidParameterError("axes", "have different names", name)
        object.__setattr__(self, "axes", axes)

    @abstractmethod
    def __len__(self) -> int:
        """Return the number of rows."""

    @abstractmethod
    def _block(self, start: int, stop: int) -> Array:
        """Return rows of a range that is known to be right."""

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the axes."""
        return tuple(axis.name for axis in self.axes)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Doubts about the design that a reader of the results should know; empty when there is nothing."""
        return ()

    def rows(self, start: int = 0, stop: int | None = None) -> Array:
        """Return a range of rows; nothing else is computed or kept.

        Parameters
        ----------
        start : int
            First row.
        stop : int or None
            End of the range; the last row when ``None``.

        Returns
        -------
        ndarray, shape (stop - start, number of axes)
            A column for each axis, in its unit.

        Raises
        ------
        InvalidParameterError
            If the range is not inside the design.
        """
        first = count("start", start, least=0)
        end = len(self) if stop is None else count("stop", stop, least=0)
        if not first <= end <= len(self):
            raise InvalidParameterError("stop", f"be from start = {first} to {len(self)}", end)
        if (end - first) * len(self.axes) > MOST_ROWS_AT_ONCE:
            raise InvalidParameterError("stop", f"ask for at most {MOST_ROWS_AT_ONCE} values at once", end - first)
        return self._block(first, end)

    def looked_at(self) -> dict[str, Array]:
        """Return the rows by which a study is judged before it runs: of a grid its corners, else the first rows.

        Returns
        -------
        dict of str to ndarray
            At most 64 rows, a column for each axis.
        """
        return self._by_axis(self._block(0, min(len(self), MOST_LOOKED_AT)))

    def spread(self, most: int, without: Collection[str] = ()) -> tuple[dict[str, Array], int]:
        """Return rows spread over the whole design: all of them where they are few.

        Parameters
        ----------
        most : int
            Most rows.
        without : collection of str
            Axes that do not matter: a grid is spread over the others alone.

        Returns
        -------
        rows : dict of str to ndarray
            A column for each axis, the first and the last row among them.
        total : int
            Of how many.
        """
        design = self._without(without)
        places = np.unique(np.linspace(0, len(design) - 1, min(most, len(design))).round().astype(np.int64))
        rows = np.concatenate([design._block(place, place + 1) for place in places.tolist()])
        return design._by_axis(rows), len(design)

    def sampled(self, most: int) -> dict[str, Array]:
        """Return all rows, or of more than ``most`` those that stand for the others: a column for each axis.

        The first rows of a sample are spread already.

        Parameters
        ----------
        most : int
            Most rows.

        Returns
        -------
        dict of str to ndarray
            A column for each axis.
        """
        return self._by_axis(self._block(0, min(most, len(self))))

    def _without(self, names: Collection[str]) -> Design:  # noqa: ARG002  # only a grid has rows without an axis
        return self

    def _by_axis(self, rows: Array) -> dict[str, Array]:
        return dict(zip(self.names, rows.T, strict=True))

    def with_units(self, units: Mapping[str, str]) -> Self:
        """Return the design with units on the axes that had none.

        Parameters
        ----------
        units : mapping of str to str
            Unit by name of the axis.

        Returns
        -------
        Design
            Of the same rows.

        Raises
        ------
        InvalidParameterError
            If an axis has another unit already.
        """
        axes = []
        for axis in self.axes:
            unit = units.get(axis.name, axis.unit or "")
            if axis.unit not in (None, unit):
                raise InvalidParameterError(f"unit of axis {axis.name!r}", f"be {unit!r} in this study", axis.unit)
            axes.append(replace(axis, unit=unit))
        return replace(self, axes=tuple(axes))

    def settings(self) -> dict[str, Any]:
        """Return the fields for the manifest."""
        return {"kind": self.kind, "rows": len(self), "axes": [axis.settings() for axis in self.axes]}


@dataclass(frozen=True, slots=True)
class Grid(Design):
    """Every combination of the levels of the axes; the last axis varies fastest.

    Parameters
    ----------
    axes : sequence of Axis
        Each with values, or a range with ``points``.

    Raises
    ------
    InvalidParameterError
        If there is no axis, a name occurs twice, a range has no ``points``, or there are more
        than 2**53 rows.

    Examples
    --------
    >>> from hrsafety import sweep
    >>> grid = sweep.Grid([
    ...     sweep.Axis(name="closing_speed", values=[0.5, 1.0]),
    ...     sweep.Axis(name="foam_damping", low=0.0, high=100.0, points=3),
    ... ])
    >>> len(grid), grid.rows(2, 4).tolist()
    (6, [[0.5, 100.0], [1.0, 0.0]])
    """

    kind: ClassVar[str] = "grid"

    def __post_init__(self) -> None:
        """Check the axes."""
        Design.__post_init__(self)
        for axis in self.axes:
            if axis.size is None:
                raise InvalidParameterError(f"points of axis {axis.name!r}", "be given for a grid", None)
        if math.prod(self.shape) > MOST_ROWS:
            raise InvalidParameterError("axes", "give at most 2**53 rows", math.prod(self.shape))

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of levels of each axis."""
        return tuple(axis.size or 0 for axis in self.axes)

    def __len__(self) -> int:
        """Return the number of rows."""
        return math.prod(self.shape)

    def looked_at(self) -> dict[str, Array]:
        """Return the corners; of more than six axes the first and the last row, see `Design.looked_at`."""
        ends = [axis.levels()[[0, -1]] for axis in self.axes]
        few = 2 ** len(ends) <= MOST_LOOKED_AT
        return self._by_axis(np.array(list(itertools.product(*ends) if few else zip(*ends, strict=True))))

    def sampled(self, most: int) -> dict[str, Array]:
        """Return all rows, or of more than ``most`` a grid of fewer levels with the same ends, see `Design.sampled`."""
        each = max(int(most ** (1.0 / len(self.axes))), 2)
        if len(self) <= most or 2 ** len(self.axes) > most:
            return Design.sampled(self, most)
        axes = [axis.levels() for axis in self.axes]
        few = [
            values[np.unique(np.linspace(0, len(values) - 1, min(each, len(values))).astype(int))] for values in axes
        ]
        return self._by_axis(np.array(list(itertools.product(*few))))

    def _without(self, names: Collection[str]) -> Design:
        left = [axis for axis in self.axes if axis.name not in names]
        return Grid(tuple(left)) if left else self

    def _block(self, start: int, stop: int) -> Array:
        places = np.unravel_index(np.arange(start, stop), self.shape)
        return np.stack([axis.levels()[place] for axis, place in zip(self.axes, places, strict=True)], axis=1)


def checked_design(value: object) -> Design:
    """Return ``value`` if it is a design."""
    if not isinstance(value, Design):
        raise InvalidParameterError("design", "be a Grid, LatinHypercube or Sobol", value)
    return value
