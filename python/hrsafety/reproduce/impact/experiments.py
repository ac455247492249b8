"""Every claim of chapter 4, measured: errors of the prediction and influences in the experiments."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from hrsafety import impact
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact.cases import manipulator, published_lever_arm
from hrsafety.reproduce.impact.tables import ImpactRow, experiments
from hrsafety.reproduce.published import printed_figure
from hrsafety.reproduce.sheets import Sheet

__all__ = ["cells"]

SHEET = Sheet("chapter_4")
LITTLE_PERCENT = 3.0  # half spread of repeated runs, in the mean 1.6 % (a) and 4.2 % (eps)
_NAMES = {"a_h_max": "a_h,max", "compression_max": "eps_max"}
_KEYS = {"a_h_max": "acceleration", "compression_max": "compression"}


def cells() -> list[PrintedValue]:
    """Return the cells of sections 4.3 to 4.5."""
    return [*_direct_drive(), *_puma(), *_conclusions()]


def _of(table: str) -> list[ImpactRow]:
    return [row for row in experiments() if row.table == table]


def _errors(rows: Sequence[ImpactRow], column: str, *, own: bool = False) -> np.ndarray:
    """Return |prediction / run - 1| of every single run, in percent."""
    found = [
        abs((row.simulated["A"][column] if own else row.printed[column]) / run - 1.0)
        for row in rows
        for run in row.measured[column]
    ]
    return 100.0 * np.array(found)


def _error_cells(section: str, rows: Sequence[ImpactRow], name: str) -> Iterator[PrintedValue]:
    for column, key in _KEYS.items():
        printed, own = _errors(rows, column), _errors(rows, column, own=True)
        for kind, take in (("max", np.max), ("mean", np.mean)):
            words = {"section": section, "row": name, "name": _NAMES[column], "figure": key, "kind": kind}
            yield SHEET.number("error", float(take(printed)), own=float(take(own)), **words)


# ---- section 4.3 ------------------------------------------------------------------------------------


def _direct_drive() -> Iterator[PrintedValue]:
    rows = _of("4.1")
    yield from _settings()
    yield from _error_cells("4.3", rows, "Direct drive, all runs")
    yield _proportional(rows)
    yield _same_closing_speed(rows)
    yield from _influences(rows)
    yield _longer(experiments())


def _settings() -> Iterator[PrintedValue]:
    lever_arm, wanted = published_lever_arm(1), manipulator(1)
    yield SHEET.number("effective_mass", printed_figure("A.2", "inertia") / lever_arm**2)
    gains = impact.identification.pd_gains(
        stiffness=wanted.stiffness,
        damping=wanted.damping,
        lever_arm=lever_arm,
        torque_constant=printed_figure("A.2", "torque_constant"),
    )
    yield SHEET.number("proportional", gains.proportional)
    yield SHEET.number("derivative", gains.derivative)


def _mean(rows: Sequence[ImpactRow], column: str) -> float:
    return float(np.mean([run for row in rows for run in row.measured[column]]))


def _chosen(rows: Sequence[ImpactRow], **wanted: float) -> list[ImpactRow]:
    return [row for row in rows if all(getattr(row, name) == value for name, value in wanted.items())]


def _settings_of(rows: Sequence[ImpactRow]) -> Iterator[list[ImpactRow]]:
    """Yield the rows of each setting of joint and foam, at all speeds."""
    for stiffness, damping, foam in {(row.stiffness, row.damping, row.foam_number) for row in rows}:
        yield _chosen(rows, stiffness=stiffness, damping=damping, foam_number=foam)


def _proportional(rows: Sequence[ImpactRow]) -> PrintedValue:
    ratios = []
    for own in _settings_of(rows):
        slow = [row for row in own if row.closing_speed < 1.0]
        fast = [row for row in own if row.closing_speed > 1.0]
        ratios += [_mean(fast, column) / _mean(slow, column) for column in _NAMES]
    speeds = 1.25 / 0.4
    holds = all(abs(ratio / speeds - 1.0) < 0.15 for ratio in ratios)
    return SHEET.claim("linear", holds=holds, least=min(ratios), most=max(ratios), speeds=speeds)


def _same_closing_speed(rows: Sequence[ImpactRow]) -> PrintedValue:
    changes = []
    for own in _settings_of(rows):
        (moving,) = _chosen(own, manipulator_speed=0.4)
        (still,) = _chosen(own, manipulator_speed=0.0)
        changes.append(100.0 * (moving.mean("a_h_max") / still.mean("a_h_max") - 1.0))
    holds = max(map(abs, changes)) < 2.0 * LITTLE_PERCENT
    return SHEET.claim("same_speed", holds=holds, least=min(changes), most=max(changes))


def _influences(rows: Sequence[ImpactRow]) -> Iterator[PrintedValue]:
    """Yield the influence of K_r, C_r and of the foam, by printed simulations, experiments and exactly."""
    base = _chosen(rows, foam_number=1, stiffness=20000.0)
    half = _chosen(rows, foam_number=1, stiffness=10000.0)
    soft = _chosen(rows, foam_number=2, damping=250.0)
    damped = _chosen(rows, foam_number=2, damping=500.0)
    yield _influence("acceleration_half_stiffness", "K_r halved, Foam 1", half, base, "a_h_max", "half_percent")
    yield _none("K_r halved, Foam 1", half, base, "compression_max")
    for column in _NAMES:
        yield _none("C_r halved, Foam 2", soft, damped, column)
    yield _influence("acceleration_soft_foam", "Foam 2 against Foam 1", soft, base, "a_h_max", "percent")
    yield _influence("compression_soft_foam", "Foam 2 against Foam 1", soft, base, "compression_max", "percent")


def _three(one: Sequence[ImpactRow], other: Sequence[ImpactRow], column: str) -> tuple[float, float, float]:
    """Return the change in percent by printed simulations, experiments and exact responses."""
    pairs = list(zip(one, other, strict=True))
    printed = np.mean([first.printed[column] / second.printed[column] for first, second in pairs])
    measured = np.mean([first.mean(column) / second.mean(column) for first, second in pairs])
    exact = np.mean([first.simulated["A"][column] / second.simulated["A"][column] for first, second in pairs])
    by_simulation, by_experiment, by_response = (100.0 * (float(ratio) - 1.0) for ratio in (printed, measured, exact))
    return by_simulation, by_experiment, by_response


def _influence(
    figure: str, name: str, one: Sequence[ImpactRow], other: Sequence[ImpactRow], column: str, limit: str
) -> PrintedValue:
    printed, measured, exact = _three(one, other, column)
    slow, _, _ = _three(one[:1], other[:1], column)
    words = {"figure": figure, "row": name, "name": _NAMES[column], "limit": limit}
    return SHEET.number("influence", printed, measured=measured, exact=exact, slow=slow, **words)


def _none(name: str, one: Sequence[ImpactRow], other: Sequence[ImpactRow], column: str) -> PrintedValue:
    changes = _three(one, other, column)
    holds = max(map(abs, changes)) <= LITTLE_PERCENT
    numbers = dict(zip(("simulated", "measured", "exact"), changes, strict=True))
    return SHEET.claim("no_influence", holds=holds, row=name, name=_NAMES[column], **numbers)


def _longer(rows: Sequence[ImpactRow]) -> PrintedValue:
    runs = [(run, row.simulated["A"]["impact_period"]) for row in rows for run in row.measured["impact_period"]]
    longer = sum(run > own for run, own in runs)
    share = 100.0 * float(np.mean([run / own for run, own in runs]) - 1.0)
    return SHEET.claim("longer", holds=longer > 0.9 * len(runs), longer=longer, runs=len(runs), share=share)


# ---- sections 4.4 and 4.5 ---------------------------------------------------------------------------


def _puma() -> Iterator[PrintedValue]:
    rows = _of("4.2")
    yield from _error_cells("4.4", rows, "Puma 560, all runs")
    yield SHEET.claim("heads", holds=False)
    base = _chosen(_of("4.1"), foam_number=1, stiffness=20000.0)
    for column, key in _KEYS.items():
        for speed, chosen in (("slow", slice(0, 2)), ("fast", slice(2, 3))):
            yield _against(rows[chosen], base[chosen], column, f"{key}_against_direct_drive_{speed}")


def _against(puma: Sequence[ImpactRow], other: Sequence[ImpactRow], column: str, figure: str) -> PrintedValue:
    printed, _, exact = _three(puma, other, column)
    # Experiments with the same foam and closing speed, both stiffnesses of the direct drive.
    speed = puma[0].closing_speed
    same = [row for row in _of("4.1") if row.foam_number == 1 and abs(row.closing_speed - speed) < 1e-9]
    measured = 100.0 * (_mean(puma, column) / _mean(same, column) - 1.0)
    more = " The claim speaks of experiments." if column == "a_h_max" else ""
    if printed_figure("4.4", figure) > 2.0 * printed:
        more += " No pair of rows gives the printed figure."
    words = {"figure": figure, "name": _NAMES[column], "more": more}
    return SHEET.number("against", printed, speed=speed, measured=measured, exact=exact, **words)


def _conclusions() -> Iterator[PrintedValue]:
    rows = list(experiments())
    yield from _error_cells("4.5", rows, "Both manipulators")
    for column, name in _NAMES.items():
        pairs = [(run, row) for row in rows for run in row.measured[column]]
        above = sum(run > row.printed[column] for run, row in pairs)
        exact = sum(run > row.simulated["A"][column] for run, row in pairs)
        most = 100.0 * (max(run / row.printed[column] for run, row in pairs) - 1.0)
        yield SHEET.claim("smaller", holds=above == 0, name=name, above=above, exact=exact, runs=len(pairs), most=most)
