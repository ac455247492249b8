"""Gain sets without number: tables of some of them at a time."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, callback, count, numbers
from hrsafety._bounds import MOST_POINTS, MOST_TABLE_ROWS
from hrsafety.errors import InvalidParameterError, ShapeError, Shown, SimulationError
from hrsafety.navigation.batch import check_scenarios, gain_sets, simulate_batch
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.python_law import AnyLaw, as_law
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.tables.runs import RunTable

__all__ = ["stream_batch"]


def stream_batch(
    scenarios: Sequence[Scenario],
    law: AnyLaw,
    gains: npt.ArrayLike | Mapping[str, npt.ArrayLike] | None = None,
    *,
    rows: int = 100_000,
    progress: Callable[[int, int], object] | None = None,
    **options: Any,
) -> Iterator[RunTable]:
    """Yield the table of `simulate_batch` in parts, so that memory does not grow with the gain sets.

    Nothing but a part is in memory at a time, beside ``gains`` as they were given: arrays by names are
    broadcast part by part, so that a grid takes no more than its axes. Each row has the bits of one call.

    Parameters
    ----------
    scenarios, law
        As for `simulate_batch`.
    gains : array_like of shape (n, g), mapping, or None
        As for `simulate_batch`; at most a hundred million sets.
    rows : int
        Runs of a part, about: a part holds whole gain sets, at least one. Half a kilobyte of memory each.
    progress : callable or None
        Called with (runs done, runs in all) about ten times a second.
    **options
        All other options of `simulate_batch`.

    Yields
    ------
    RunTable
        Some gain sets in every scenario, in their order; ``gain_index`` counts through all parts.

    Raises
    ------
    InvalidParameterError
        As `simulate_batch`, before the first part where the arguments themselves are wrong.
    ShapeError
        If gains does not have a column for each gain, or arrays do not broadcast.
    SimulationError
        If the state of a run became non-finite; its number counts through all parts.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    The best of a grid, of which no more than a thousand runs are in memory:

    >>> import numpy as np
    >>> from hrsafety import navigation as nav, scenarios
    >>> grid = {
    ...     "attractive_gain": np.linspace(1.0, 5.0, 60)[:, None], "repulsive_gain": np.linspace(0.05, 1.0, 50),
    ... }
    >>> parts = nav.gains.stream_batch([scenarios.configuration("c1")], nav.VirtualForceField(), grid, rows=1000)
    >>> best = max(float(part.performance_total.max()) for part in parts)
    >>> round(best, 2)
    0.62
    """
    scenes, driver = check_scenarios(scenarios), as_law(law)
    total, part_of = _sets(driver, gains)
    if total > MOST_POINTS:
        raise InvalidParameterError("gains", f"hold at most {MOST_POINTS} gain sets", Shown(f"{total} sets"))
    size = max(1, count("rows", rows, most=MOST_TABLE_ROWS) // len(scenes))
    heard = callback("progress", progress)

    def parts() -> Iterator[RunTable]:
        for first in range(0, total, size):
            sets = part_of(first, min(first + size, total))
            done = None if heard is None else _counted(heard, first * len(scenes), total * len(scenes))
            try:
                table = simulate_batch(scenes, driver, sets, progress=done, **options)
            except InvalidParameterError as error:
                raise _of_all(error, first) from None
            except SimulationError as error:
                raise _run_of_all(error, first * len(scenes)) from None
            yield replace(table, gain_index=table.gain_index + first)

    return parts()


def _sets(
    law: Law, gains: npt.ArrayLike | Mapping[str, npt.ArrayLike] | None
) -> tuple[int, Callable[[int, int], Array | None]]:
    """Return the number of gain sets, and what returns those from one to before another."""
    if gains is None or not law.GAIN_NAMES:
        gain_sets(law, gains)  # refuses gains of a law without any
        return 1, lambda _first, _last: None
    if not isinstance(gains, Mapping):
        given = numbers("gains", gains, "be an array of numbers, a mapping or None")
        if given.ndim != 2 or given.shape[1] != len(law.GAIN_NAMES):
            raise ShapeError("gains", f"(n, {len(law.GAIN_NAMES)})", given.shape)
        if len(given) == 0:
            raise InvalidParameterError("gains", "hold at least one gain set", Shown("none"))
        return len(given), lambda first, last: given[first:last]
    # Names are checked with the first number of each.
    axes = {name: numbers(f"gains[{name!r}]", values, "hold numbers") for name, values in gains.items()}
    gain_sets(law, {name: axis.flat[:1] for name, axis in axes.items()})
    own = dict(zip(law.GAIN_NAMES, law.gains, strict=True))
    columns = [axes.get(name, np.asarray(own[name])) for name in law.GAIN_NAMES]
    try:
        views = np.broadcast_arrays(*columns)
    except ValueError:
        shapes = tuple(column.shape for column in columns)
        raise ShapeError("gains", "arrays that broadcast", shapes) from None
    if views[0].size == 0:
        raise InvalidParameterError("gains", "hold at least one gain set", Shown("none"))
    return views[0].size, lambda first, last: np.stack([view.flat[first:last] for view in views], axis=1)


def _counted(progress: Callable[[int, int], object], before: int, total: int) -> Callable[[int, int], object]:
    """Return a progress callback that counts through all parts."""
    return lambda done, _: progress(before + done, total)


def _of_all(error: InvalidParameterError, first: int) -> InvalidParameterError:
    """Return an error about a gain set with its number among all."""
    head, bracket, rest = error.argument.partition("gains[")
    number, closing, tail = rest.partition("]")
    if head or not bracket or not closing or not number.isdigit():
        return error
    argument = f"gains[{first + int(number)}]{tail}"
    return InvalidParameterError(argument, error.requirement, error.value, error.remedy)


def _run_of_all(error: SimulationError, before: int) -> SimulationError:
    """Return an error about a run with its number among all."""
    if error.run is None:
        return error
    what = str(error).removesuffix(f" (run {error.run})")
    return SimulationError(f"{what} (run {before + error.run})", before + error.run)
