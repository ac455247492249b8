"""Studies: what is computed for each row of a design."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy.typing as npt

from hrsafety._arguments import Array, sequence, word
from hrsafety._display import displayed
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.sweep.axes import Column
from hrsafety.sweep.designs import Design
from hrsafety.sweep.identity import described
from hrsafety.sweep.storage import SweepError

__all__ = ["Cases", "Found", "Study", "checked_study", "chosen", "raised"]

Found = Mapping[str, npt.NDArray[Any]]


@displayed
class Cases(NamedTuple):
    """Several result rows for each row of the design, as those of several scenarios.

    Attributes
    ----------
    name : str
        Name of the column that tells them apart.
    words : tuple of str
        One for each case; the cases vary fastest.
    """

    name: str
    words: tuple[str, ...]


class Study(ABC):
    """Base of the studies.

    A study is pickled to wherever its rows are computed, and described in the manifest of the
    results. The result of a row depends on that row alone.
    """

    __slots__ = ()

    @property
    def cases(self) -> Cases | None:
        """Result rows of each row of the design; ``None`` for one."""
        return None

    @abstractmethod
    def units(self, names: Sequence[str]) -> dict[str, str]:
        """Return the units of axes with these names.

        Parameters
        ----------
        names : sequence of str
            Names of the axes of a design.

        Returns
        -------
        dict of str to str
            Unit by name; without names whose unit the study does not know.

        Raises
        ------
        InvalidParameterError
            If the study cannot vary one of them.
        """

    @abstractmethod
    def columns(self) -> tuple[Column, ...]:
        """Return what is found for each row, without the axes and cases."""

    @abstractmethod
    def compute(self, rows: dict[str, Array], threads: int | None = None) -> Found:
        """Return the columns for some rows of a design.

        Parameters
        ----------
        rows : dict of str to ndarray, shape (n,)
            Values of the axes.
        threads : int or None
            Number of threads; all cores when ``None``.

        Returns
        -------
        dict of str to ndarray, shape (n * number of cases,)
            A column for each of `columns`.
        """

    def doubts(self, rows: dict[str, Array]) -> tuple[ResultWarning, ...]:  # noqa: ARG002  # for studies that look
        """Return why rows may not mean what they seem to.

        Parameters
        ----------
        rows : dict of str to ndarray, shape (n,)
            Values of the axes: the corners of a design, or its ends.

        Returns
        -------
        tuple of ResultWarning
            The first warning of each kind; none where the study does not know its numbers.
        """
        return ()

    def judged(self, design: Design) -> tuple[ResultWarning, ...]:
        """Return the doubts of a design before it runs: those of the rows that stand for it, see `doubts`.

        Parameters
        ----------
        design : Design
            Which rows.

        Returns
        -------
        tuple of ResultWarning
            The first warning of each kind.
        """
        return self.doubts(design.looked_at())

    def settings(self) -> dict[str, Any]:
        """Return everything that the result depends on, as plain data."""
        found: dict[str, Any] = described(self)
        return found


def raised(function: object, row: Mapping[str, Any], given: str, error: Exception) -> SweepError:
    """Return the error of a sweep for one of a function of its study.

    Parameters
    ----------
    function : callable
        Which raised it.
    row : mapping of str to number
        The axes of the first row that raised it; nothing if no row does by itself.
    given : str
        What the function gets, in words.
    error : Exception
        What it raised.
    """
    values = ", ".join(f"{name} = {float(value):g}" for name, value in row.items())
    where = f" in the row {values}" if row else ""
    name = getattr(function, "__qualname__", type(function).__name__)
    kind = type(error).__name__
    return SweepError(f"the function {name} of the study raised {kind}: {error}{where}; {given}")


def checked_study(study: object) -> Study:
    """Return ``study`` if it is one, or say that it should have been."""
    if not isinstance(study, Study):
        raise InvalidParameterError("study", "be an ImpactStudy, NavigationStudy or FunctionStudy", study)
    return study


def chosen(columns: Sequence[Column], outputs: object) -> tuple[str, ...] | None:
    """Return the names of the columns to keep, all known."""
    if outputs is None:
        return None
    names = tuple(sequence("outputs", "be a sequence of names of columns", outputs))
    known = [column.name for column in columns]
    for name in names:
        word("outputs", name, known)
    if not names or len(set(names)) != len(names):
        raise InvalidParameterError("outputs", "be at least one name, none of them twice", names)
    return names
