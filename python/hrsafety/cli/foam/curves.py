"""Boundaries of a foam design that are asked for more than once."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from hrsafety.cli.foam.file import Array
from hrsafety.impact import FoamBoundary

__all__ = ["Remembered"]


class Remembered:
    """A boundary over the damping that is computed once for each damping.

    Table and picture ask for the same points, and a picture for a few more between them.

    Parameters
    ----------
    curve : callable
        Returns the boundary for an array of dampings; every point is independent of the others.
    """

    def __init__(self, curve: Callable[[Array], FoamBoundary]) -> None:
        self._curve = curve
        self._rows: dict[float, int] = {}
        self._found: FoamBoundary | None = None

    def __call__(self, damping: Array) -> FoamBoundary:
        """Return the boundary, of which only what is new is computed.

        Parameters
        ----------
        damping : ndarray, shape (n,)
            In N s/m.

        Returns
        -------
        FoamBoundary
            As the curve would return it.
        """
        new = [each for each in dict.fromkeys(damping.tolist()) if each not in self._rows]
        if new or self._found is None:
            found = self._curve(np.array(new))
            self._found = found if self._found is None else _joined(self._found, found)
            self._rows |= {each: len(self._rows) + place for place, each in enumerate(new)}
        return _at(self._found, [self._rows[each] for each in damping.tolist()])


def _joined(one: FoamBoundary, two: FoamBoundary) -> FoamBoundary:
    return FoamBoundary(
        damping=np.concatenate([one.damping, two.damping]),
        stiffness=np.concatenate([one.stiffness, two.stiffness]),
        status=np.concatenate([one.status, two.status]),
        limited_by=np.concatenate([one.limited_by, two.limited_by]),
        crossings=one.crossings + two.crossings,
        crossing_status=one.crossing_status + two.crossing_status,
        holds_below=np.concatenate([one.holds_below, two.holds_below]),
        holds_above=np.concatenate([one.holds_above, two.holds_above]),
        warnings=one.warnings,
    )


def _at(found: FoamBoundary, rows: list[int]) -> FoamBoundary:
    return FoamBoundary(
        damping=found.damping[rows],
        stiffness=found.stiffness[rows],
        status=found.status[rows],
        limited_by=found.limited_by[rows],
        crossings=tuple(found.crossings[row] for row in rows),
        crossing_status=tuple(found.crossing_status[row] for row in rows),
        holds_below=found.holds_below[rows],
        holds_above=found.holds_above[rows],
        warnings=found.warnings,
    )
