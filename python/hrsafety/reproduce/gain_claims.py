"""What sections C.2 and C.3 say in their text, measured: the search, sensitivities and trends."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety.reproduce.cells import Cell, Tolerance
from hrsafety.reproduce.gain_runs import CHANGES_PERCENT, GAIN_TABLES, GainRuns
from hrsafety.reproduce.impact_cells import claim, listed, number
from hrsafety.reproduce.published import printed_rows
from hrsafety.reproduce.tables import GAIN_UNITS

__all__ = ["column", "printed_column", "search", "sensitivities", "trends"]

Array = npt.NDArray[np.float64]

SEARCH, TRENDS = "Section C.2", "Section C.3"
# Gain to the increment of the first and of the last grid.
_INCREMENTS = {"K_1": (5.0, 0.4), "K_3": (10.0, 0.8), "K_5": (25.0, 1.9), "b": (0.2, 0.02)}
# Gain to the largest and the average sensitivity in % that the text gives.
_SENSITIVITIES = {"K_1": (2.0, 1.0), "K_3": (0.52, 0.2), "K_5": (1.8, 0.7), "b": (0.4, 0.2)}
# Increments are quotients of round numbers; percentages of the text have one digit, so half a unit of it is
# up to 0.5 (K_1) and 0.05 (the others).
_EXACT = Tolerance(0.001, relative=True)
_ONE_DIGIT = {"K_1": Tolerance(0.5, relative=False)}
_TENTH = Tolerance(0.05, relative=False)
_FLAT_PERCENT = 1.0  # most that H mean changes around a flat optimum
_NEAR = 10.0  # % of a gain, what counts as around
_SAME_TIME = 0.1  # s
_UNEXPLAINED = "No single change of the scheme that was tried explains it."
# Gain to why its sensitivity is larger here than printed.
_MORE_SENSITIVE = {
    "K_1": "Half of K_1 misses the first pass of configuration 3; without that row it is {without:.2f} % at most.",
    "K_3": "Most of it comes from half of K_3; without that row it is {without:.2f} % at most.",
    "K_5": "The best gains found here have a larger K_5: at the printed ones H still rises with it.",
    "b": "More b slows the robot next to the person, see Table C.8.",
}


# ---- the search -------------------------------------------------------------------------------------


def search(runs: GainRuns) -> Iterator[Cell]:
    """Yield what section C.2 says about the search beside the own one."""
    rounds = runs.search.history
    sizes = [entry.evaluations for entry in rounds]
    yield claim(
        SEARCH,
        "Grids",
        "number of gain sets",
        printed="4 grids of 11 x 21 x 21 x 16 = 77,616 each",
        measured=f"{len(sizes)} grids of {' / '.join(f'{size:,}' for size in sizes)}, failures included",
        holds=sizes == [77_616] * 4,
    )
    for index, (name, (first, _)) in enumerate(_INCREMENTS.items()):
        found = float(rounds[0].increments[index])
        unit = GAIN_UNITS[name]
        yield number(SEARCH, "First grid", name, printed=first, measured=found, tolerance=_EXACT, unit=unit)
    for index, (name, (_, last)) in enumerate(_INCREMENTS.items()):
        found = float(rounds[-1].increments[index])
        reason = "Not judged: the grids close in on another part of the flat optimum."
        yield listed(SEARCH, "Last grid", name, printed=last, measured=found, unit=GAIN_UNITS[name], reason=reason)
    local = runs.search.local
    gain = max(entry.value - entry.start_value for entry in local)
    yield claim(
        SEARCH,
        "Local searches",
        "from the best gain sets",
        printed="20 constrained local searches",
        measured=f"{len(local)}, which raise H by {gain:.5f} at most",
        holds=len(local) == 20,
    )


# ---- sensitivities ----------------------------------------------------------------------------------


def sensitivities(runs: GainRuns) -> Iterator[Cell]:
    """Yield the largest and average sensitivities of the text of section C.3."""
    found = (100.0 * runs.changed.largest_sensitivity(), 100.0 * runs.changed.average_sensitivity())
    for index, (name, printed) in enumerate(_SENSITIVITIES.items()):
        for word, value, measured in zip(("largest", "average"), printed, found, strict=True):
            cell = number(
                TRENDS,
                f"Sensitivity of H mean to {name}",
                word,
                printed=value,
                measured=float(measured[index]),
                tolerance=_ONE_DIGIT.get(name, _TENTH),
                unit="%",
            )
            without = 100.0 * float(np.nanmax(np.abs(runs.changed.relative_sensitivity[index, 1:])))
            reason = _MORE_SENSITIVE[name].format(without=without)
            yield cell if cell.within else replace(cell, reason=reason)


# ---- trends -----------------------------------------------------------------------------------------


def trends(runs: GainRuns) -> Iterator[Cell]:
    """Yield what the source says about trends, with the own numbers and whether they hold."""
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
    _Trend("K_5", "arrival time", "T_arrive", 1, f"T falls slightly instead. {_UNEXPLAINED}"),
)
_UNIT_OF = {"T_arrive": "s", "d_circle_min": "m", "L_energy": "J"}


def _monotone(runs: GainRuns) -> Iterator[Cell]:
    for trend in _MONOTONE:
        values = column(runs, trend.gain, trend.column, 0)
        printed = printed_column(trend.gain, f"{trend.column}_1")
        direction = "rises" if trend.sign > 0 else "falls"
        holds = bool((trend.sign * np.diff(values) > 0.0).all())
        yield claim(
            TRENDS,
            f"Change of {trend.gain}",
            f"{trend.quantity} in configuration 1",
            printed=f"{direction}, {_span(printed, _UNIT_OF[trend.column])}",
            measured=f"{_span(values, _UNIT_OF[trend.column])}{', at every step' if holds else ''}",
            holds=holds,
            reason="" if holds else trend.reason,
        )


def _span(values: Array, unit: str) -> str:
    """Return the values at both ends of the changes."""
    digits = 2 if unit == "s" else 3
    return f"{values[0]:.{digits}f} to {values[-1]:.{digits}f} {unit} from -50 to +100 %"


def _flat(runs: GainRuns) -> Cell:
    """Return the flatness of the mean score around the printed optimum."""
    near = np.abs(CHANGES_PERCENT) <= _NEAR
    own = runs.changed.mean_performance[:, near]
    printed = np.array([printed_column(name, "H_mean", scores=True)[near] for name in GAIN_TABLES])
    shown = [100.0 * float(np.abs(values / values[:, [_at_zero(near)]] - 1.0).max()) for values in (printed, own)]
    return claim(
        TRENDS,
        "Flat optimum",
        "change of H mean by up to 10 % of any gain",
        printed=f"flat: {shown[0]:.2f} % at most in Tables C.3 to C.9",
        measured=f"{shown[1]:.2f} % at most",
        holds=shown[1] < _FLAT_PERCENT,
    )


def _at_zero(near: npt.NDArray[np.bool_]) -> int:
    return int(np.flatnonzero(np.array(CHANGES_PERCENT)[near] == 0.0)[0])


def _insensitive(runs: GainRuns) -> Iterator[Cell]:
    """Yield that T and d hardly depend on K_3 and b, which is not reproduced."""
    for name in ("K_3", "b"):
        for quantity, key in (("arrival time", "T_arrive"), ("distance", "d_circle_min")):
            values, printed = column(runs, name, key, 0), printed_column(name, f"{key}_1")
            spread, limit = (float(np.ptp(entry) / entry.mean()) for entry in (values, printed))
            holds = spread <= 2.0 * limit
            unit = _UNIT_OF[key]
            yield claim(
                TRENDS,
                f"Change of {name}",
                f"spread of the {quantity} in configuration 1",
                printed=f"hardly any: {printed.min():g} to {printed.max():g} {unit} ({100.0 * limit:.1f} %)",
                measured=f"{values.min():.3f} to {values.max():.3f} {unit} ({100.0 * spread:.1f} %)",
                holds=holds,
                reason="" if holds else f"More than twice the printed spread. {_UNEXPLAINED}",
            )


def _later(runs: GainRuns) -> Iterator[Cell]:
    """Yield that the printed optimum arrives later than here."""
    for place in range(3):
        printed = float(printed_column("K_1", f"T_arrive_{place + 1}")[CHANGES_PERCENT.index(0.0)])
        values = column(runs, "K_1", "T_arrive", place)
        measured = float(values[CHANGES_PERCENT.index(0.0)])
        holds = abs(measured - printed) < _SAME_TIME
        yield claim(
            TRENDS,
            "Printed optimum",
            f"arrival time in configuration {place + 1}",
            printed=f"{printed:.2f} s",
            measured=f"{measured:.2f} s, {printed - measured:.2f} s sooner",
            holds=holds,
            reason="" if holds else f"The robot is sooner here with these gains. {_UNEXPLAINED}",
        )


def _energy(runs: GainRuns) -> Iterator[Cell]:
    """Yield that energy rises with K_1, K_3, K_5 and falls with b."""
    for name in GAIN_TABLES:
        sign = -1 if name == "b" else 1
        values, printed = column(runs, name, "L_energy", 0), printed_column(name, "L_energy_1")
        holds = bool(sign * (values[-1] - values[0]) > 0.0)
        reason = "The source gives neither motor resistance nor wheel radius; the changes are within the calibration."
        yield claim(
            TRENDS,
            f"Change of {name}",
            "energy in configuration 1",
            printed=f"{'falls' if sign < 0 else 'rises'}, {_span(printed, 'J')}",
            measured=_span(values, "J"),
            holds=holds,
            reason="" if holds else reason,
        )


def column(runs: GainRuns, gain: str, quantity: str, place: int) -> Array:
    """Return a quantity of one configuration over the changes of a gain."""
    index = list(GAIN_TABLES).index(gain)
    rows = (runs.measured(index, change)[place] for change in range(len(CHANGES_PERCENT)))
    return np.array([row.values[quantity] for row in rows])


def printed_column(gain: str, name: str, *, scores: bool = False) -> Array:
    """Return a printed column over the changes of a gain."""
    rows = {row["change_percent"]: row for row in printed_rows(GAIN_TABLES[gain][scores])}
    return np.array([float(rows[change][name]) for change in CHANGES_PERCENT])
