"""Claims of sections C.2 and C.3 in their text, measured: the search, sensitivities and trends."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety.reproduce import data
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.gain.runs import CHANGES_PERCENT, GAIN_TABLES, GainRuns
from hrsafety.reproduce.published import printed_rows
from hrsafety.reproduce.sheets import Sheet
from hrsafety.reproduce.tables import GAIN_UNITS

__all__ = ["column", "printed_column", "search", "sensitivities", "trends"]

Array = npt.NDArray[np.float64]

SHEET = Sheet("gains")
_PRINTED = data.table("gains")["printed"]
_FLAT_PERCENT = 1.0  # most that H mean changes around a flat optimum
_NEAR = 10.0  # % of a gain, what counts as around
_SAME_TIME = 0.1  # s


# ---- the search -------------------------------------------------------------------------------------


def search(runs: GainRuns) -> Iterator[PrintedValue]:
    """Yield what section C.2 says about the search beside the own one: grids and local searches."""
    rounds = runs.search.grids
    sizes = [entry.evaluations for entry in rounds]
    listed = " / ".join(f"{size:,}" for size in sizes)
    yield SHEET.claim("grids", holds=sizes == [77_616] * 4, number=len(sizes), sizes=listed)
    for grid, entry, make in (("first", rounds[0], SHEET.number), ("last", rounds[-1], SHEET.listed)):
        for index, (name, printed) in enumerate(_PRINTED.items()):
            own, given = float(entry.increments[index]), printed["increments"][grid == "last"]
            yield make(grid, own, printed=given, name=name, unit=GAIN_UNITS[name])
    local = runs.search.local
    gain = max(entry.best_value - entry.start_value for entry in local)
    yield SHEET.claim("local", holds=len(local) == 20, number=len(local), gain=gain)


# ---- sensitivities ----------------------------------------------------------------------------------


def sensitivities(runs: GainRuns) -> Iterator[PrintedValue]:
    """Yield the largest and average sensitivities of the text of section C.3, two for each gain."""
    found = (100.0 * runs.changed.largest_sensitivity(), 100.0 * runs.changed.average_sensitivity())
    for index, (name, printed) in enumerate(_PRINTED.items()):
        without = 100.0 * float(np.nanmax(np.abs(runs.changed.relative_sensitivity[index, 1:])))
        why, limit = SHEET.text(f"more_{name}", without=without), name if name in SHEET.tolerances else "tenth"
        for word, value, measured in zip(("largest", "average"), printed["sensitivities"], found, strict=True):
            own = float(measured[index])
            yield SHEET.number("sensitivity", own, printed=value, name=name, word=word, limit=limit, why=why)


# ---- trends -----------------------------------------------------------------------------------------


def trends(runs: GainRuns) -> Iterator[PrintedValue]:
    """Yield what the source says about trends: first what is reproduced, then what is not."""
    yield from _monotone(runs)
    yield _flat(runs)
    yield from _insensitive(runs)
    yield from _later(runs)
    yield from _energy(runs)


class _Trend(NamedTuple):
    """A quantity of configuration 1 that rises or falls with a gain at every printed step."""

    gain: str
    quantity: str
    column: str
    sign: int
    reason: str = ""


_MONOTONE = (
    _Trend("K_1", "arrival time", "T_arrive", -1),
    _Trend("K_1", "distance", "d_circle_min", -1),
    _Trend("K_3", "arrival time", "T_arrive", 1),
    _Trend("K_3", "distance", "d_circle_min", 1),
    _Trend("K_5", "distance", "d_circle_min", 1),
    _Trend("K_5", "arrival time", "T_arrive", 1, "falls_instead"),
)
_UNIT_OF = {"T_arrive": "s", "d_circle_min": "m", "L_energy": "J"}


def _monotone(runs: GainRuns) -> Iterator[PrintedValue]:
    for trend in _MONOTONE:
        values, unit = column(runs, trend.gain, trend.column, 0), _UNIT_OF[trend.column]
        holds = bool((trend.sign * np.diff(values) > 0.0).all())
        yield SHEET.claim(
            "monotone",
            holds=holds,
            gain=trend.gain,
            quantity=trend.quantity,
            direction="rises" if trend.sign > 0 else "falls",
            span=_span(printed_column(trend.gain, f"{trend.column}_1"), unit),
            own=f"{_span(values, unit)}{', at every step' if holds else ''}",
            why=SHEET.text(trend.reason) if trend.reason else "",
        )


def _span(values: Array, unit: str) -> str:
    """Return the values at both ends of the changes."""
    digits = 2 if unit == "s" else 3
    return f"{values[0]:.{digits}f} to {values[-1]:.{digits}f} {unit} from -50 to +100 %"


def _flat(runs: GainRuns) -> PrintedValue:
    """Return the flatness of the mean score around the printed optimum."""
    near = np.abs(CHANGES_PERCENT) <= _NEAR
    own = runs.changed.mean_performance[:, near]
    printed = np.array([printed_column(name, "H_mean", scores=True)[near] for name in GAIN_TABLES])
    shown = [100.0 * float(np.abs(values / values[:, [_at_zero(near)]] - 1.0).max()) for values in (printed, own)]
    return SHEET.claim("flat", holds=shown[1] < _FLAT_PERCENT, shown=shown)


def _at_zero(near: npt.NDArray[np.bool_]) -> int:
    return int(np.flatnonzero(np.array(CHANGES_PERCENT)[near] == 0.0)[0])


def _insensitive(runs: GainRuns) -> Iterator[PrintedValue]:
    """Yield that T and d hardly depend on K_3 and b, which is not reproduced."""
    for name in ("K_3", "b"):
        for quantity, key in (("arrival time", "T_arrive"), ("distance", "d_circle_min")):
            values, printed = column(runs, name, key, 0), printed_column(name, f"{key}_1")
            spread, limit = (float(np.ptp(entry) / entry.mean()) for entry in (values, printed))
            words: dict[str, object] = {"gain": name, "quantity": quantity, "unit": _UNIT_OF[key]}
            words |= {"least": printed.min(), "most": printed.max(), "limit": 100.0 * limit}
            words |= {"own_least": values.min(), "own_most": values.max(), "spread": 100.0 * spread}
            yield SHEET.claim("insensitive", holds=spread <= 2.0 * limit, **words)


def _later(runs: GainRuns) -> Iterator[PrintedValue]:
    """Yield that the printed optimum arrives later than here."""
    at_optimum = CHANGES_PERCENT.index(0.0)
    for place in range(3):
        printed = float(printed_column("K_1", f"T_arrive_{place + 1}")[at_optimum])
        own = float(column(runs, "K_1", "T_arrive", place)[at_optimum])
        holds = abs(own - printed) < _SAME_TIME
        yield SHEET.claim("later", holds=holds, place=place + 1, time=printed, own=own, sooner=printed - own)


def _energy(runs: GainRuns) -> Iterator[PrintedValue]:
    """Yield that energy rises with K_1, K_3, K_5 and falls with b."""
    for name in GAIN_TABLES:
        sign = -1 if name == "b" else 1
        values, printed = column(runs, name, "L_energy", 0), printed_column(name, "L_energy_1")
        words = {"direction": "falls" if sign < 0 else "rises", "span": _span(printed, "J"), "own": _span(values, "J")}
        yield SHEET.claim("energy", holds=bool(sign * (values[-1] - values[0]) > 0.0), gain=name, **words)


def column(runs: GainRuns, gain: str, quantity: str, place: int) -> Array:
    """Return a quantity of one configuration over the changes of a gain."""
    index = list(GAIN_TABLES).index(gain)
    rows = (runs.measured(index, change)[place] for change in range(len(CHANGES_PERCENT)))
    return np.array([row.values[quantity] for row in rows])


def printed_column(gain: str, name: str, *, scores: bool = False) -> Array:
    """Return a printed column over the changes of a gain."""
    rows = {row["change_percent"]: row for row in printed_rows(GAIN_TABLES[gain][scores])}
    return np.array([float(rows[change][name]) for change in CHANGES_PERCENT])
