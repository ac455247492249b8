"""Studies of any function: for each row of a design what the user computes."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, sequence
from hrsafety._records import dataclass
from hrsafety.errors import HrsafetyError, InvalidParameterError, Shown
from hrsafety.sweep.axes import Column, checked_name
from hrsafety.sweep.studies import Found, Study, raised

__all__ = ["FunctionStudy"]


@dataclass(frozen=True, slots=True, kw_only=True)
class FunctionStudy(Study):
    """Any function of the axes.

    The function is called with keyword arguments: an array for each axis, all of one length n,
    and the ``parameters``; it returns a mapping of names to arrays of that length. The result of
    a row must depend on that row alone. For a process pool or a cluster it must be importable
    there, so it stands in a module, not in another function.

    Parameters
    ----------
    function : callable
        ``function(**axes, **parameters) -> mapping of str to array``.
    results : sequence of Column or str
        What the function returns; a text is a column of numbers without a unit.
    parameters : mapping
        Further keyword arguments, the same for all rows. They are part of what a sweep is
        recognized by, as are name and source text of the function; what the function reads
        from elsewhere is not.
    axis_units : mapping of str to str
        Units of the axes, if they are not given there.

    Raises
    ------
    InvalidParameterError
        If an argument is of the wrong kind.

    Examples
    --------
    >>> from hrsafety import sweep
    >>> def stopping(speed, deceleration):
    ...     return {"distance": speed**2 / (2.0 * deceleration)}
    >>> study = sweep.FunctionStudy(
    ...     function=stopping, results=[sweep.Column(name="distance", unit="m")], parameters={"deceleration": 2.0}
    ... )
    >>> speeds = sweep.Grid([sweep.Axis(name="speed", unit="m/s", values=[0.5, 1.0])])
    >>> sweep.run(speeds, study)["distance"].tolist()
    [0.0625, 0.25]
    """

    function: Callable[..., Mapping[str, npt.ArrayLike]]
    results: tuple[Column, ...]
    parameters: Mapping[str, Any] = field(default_factory=dict)
    axis_units: Mapping[str, str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        """Check the values."""
        if not callable(self.function):
            raise InvalidParameterError("function", "be callable", self.function)
        results = []
        for index, each in enumerate(sequence("results", "be a sequence of Column", self.results)):
            result = Column(name=each) if isinstance(each, str) else each
            if not isinstance(result, Column):
                raise InvalidParameterError(f"results[{index}]", "be a Column or a text", each)
            results.append(result)
        names = [column.name for column in results]
        if not names or len(set(names)) != len(names):
            raise InvalidParameterError("results", "be at least one column, no name twice", names)
        for name in ("parameters", "axis_units"):
            given = getattr(self, name)
            if not isinstance(given, Mapping):
                raise InvalidParameterError(name, "be a mapping", given)
            object.__setattr__(self, name, {checked_name(name, key): value for key, value in given.items()})
        object.__setattr__(self, "results", tuple(results))

    def columns(self) -> tuple[Column, ...]:
        """Return what is found for each row, without the axes."""
        return self.results

    def units(self, names: Sequence[str]) -> dict[str, str]:
        """Return the units of axes with these names, see `Study.units`."""
        for name in names:
            if name in self.parameters:
                raise InvalidParameterError("parameters", "not name an axis of the design", name)
        return {name: unit for name, unit in self.axis_units.items() if name in names}

    def compute(self, rows: dict[str, Array], threads: int | None = None) -> Found:  # noqa: ARG002  # a function knows no threads
        """Return the columns for some rows, see `Study.compute`."""
        try:
            found = self._called(rows, slice(None))
        except HrsafetyError:
            raise
        except Exception as error:  # whatever a function raises: it is the cause of what is raised here
            first, cause = self._first_failing(rows, error)
            row = {} if first is None else {name: values[first] for name, values in rows.items()}
            more = f" and the parameters {', '.join(self.parameters)}" if self.parameters else ""
            raise raised(self.function, row, f"it is called with the axes {', '.join(rows)}{more}", cause) from cause
        if not isinstance(found, Mapping):
            kind = type(found).__name__
            raise InvalidParameterError("result of the function", "be a mapping of names to arrays", kind)
        names = [column.name for column in self.results]
        if set(found) != set(names):
            raise InvalidParameterError("result of the function", f"have the names {', '.join(names)}", sorted(found))
        try:
            return {name: np.asanyarray(found[name]) for name in names}
        except ValueError as error:
            raise InvalidParameterError("result of the function", "hold arrays", Shown(str(error))) from None

    def _called(self, rows: dict[str, Array], part: slice) -> Any:
        # Copies: what a function does to its arguments must not change the rows that are kept.
        return self.function(**{name: values[part].copy() for name, values in rows.items()}, **self.parameters)

    def _first_failing(self, rows: dict[str, Array], error: Exception) -> tuple[int | None, Exception]:
        """Return the first row that fails by itself, found by halves, and its error; ``None`` if none does."""
        low, high = 0, len(next(iter(rows.values())))
        while low < high:
            middle = max((low + high) // 2, low + 1)
            try:
                self._called(rows, slice(low, middle))
            except Exception as of_part:  # as of all rows; the last one is returned
                error = of_part
                if middle == low + 1:
                    return low, error
                high = middle
            else:
                low = middle
        return None, error
