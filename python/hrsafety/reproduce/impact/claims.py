"""Every percentage and claim of sections 3.6 (head and neck) and 3.9 (foam design), measured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from hrsafety import impact
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact.cases import (
    CLOSING_SPEED,
    FOAM_OF_FIGURES,
    KILO,
    MANIPULATOR_SPEED,
    foam,
    manipulator,
    printed_metrics,
    simulations,
)
from hrsafety.reproduce.sheets import Sheet

__all__ = ["cells"]

SHEET = Sheet("chapter_3")
LIMIT_G = 10.0
FINE_STEP = 1e-5  # s, on which the instant of the peak is read
Cases = Mapping[int, tuple[impact.Manipulator, impact.Head]]
Found = Mapping[int, impact.ImpactMetrics]


def cells() -> list[PrintedValue]:
    """Return the cells of sections 3.6 and 3.9, in the order of the text."""
    return [*_section_6(), *_section_9()]


def _ratio_percent(first: float, second: float) -> float:
    return 100.0 * (first / second - 1.0)


# ---- section 3.6 ------------------------------------------------------------------------------------


def _section_6() -> Iterator[PrintedValue]:
    cases = simulations()
    found = {
        key: impact.metrics(arm, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED)
        for key, (arm, head) in cases.items()
    }
    yield from _peaks(cases)
    for first, second in ((2, 1), (1, 3), (4, 2)):
        yield from _compared(cases, found, first, second)
    yield from _parameters(cases)
    yield _first_peak(cases, found)
    yield _constrained()
    yield SHEET.claim("direction", holds=False, least=found[3], stiffer=found[1])


def _peaks(cases: Cases) -> Iterator[PrintedValue]:
    """Yield the instant of the largest force, and the step at first contact."""
    steps = []
    for key, (arm, head) in cases.items():
        run = impact.simulate(arm, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED, duration=0.06, step=FINE_STEP)
        inside = run.time <= run.metrics.impact_duration
        steps.append(float(run.contact_force[0]))
        peak = float(run.time[np.argmax(np.where(inside, run.contact_force, -np.inf))])
        yield SHEET.number("peak_time", peak, simulation=key)
    expected = CLOSING_SPEED * FOAM_OF_FIGURES.damping
    same = all(abs(step - expected) <= 1e-9 * expected for step in steps)
    yield SHEET.claim("step", holds=same, step=steps[0], expected=expected)


def _compared(cases: Cases, found: Found, first: int, second: int) -> Iterator[PrintedValue]:
    """Yield two percentages of one simulation against another."""
    as_printed = [printed_metrics(*cases[key]) for key in (first, second)]
    for name, quantity, figure in (
        ("f_c,max", "peak_contact_force", "force"),
        ("a_h,max", "peak_head_acceleration", "acceleration"),
    ):
        yield SHEET.number(
            "compared",
            _ratio_percent(getattr(found[first], quantity), getattr(found[second], quantity)),
            first=first,
            second=second,
            name=name,
            figure=figure,
            as_printed=_ratio_percent(*(getattr(each, quantity) for each in as_printed)),
        )


def _parameters(cases: Cases) -> Iterator[PrintedValue]:
    """Yield the ratios of parameters that the text names, and the range of the neck damping."""
    ratios = (
        ("mass_2_1", "M_r, 2 against 1", cases[2][0].mass, cases[1][0].mass),
        ("neck_stiffness_1_3", "K_h, 1 against 3", cases[1][1].stiffness, cases[3][1].stiffness),
        ("neck_damping_1_3", "C_h, 1 against 3", cases[1][1].damping, cases[3][1].damping),
        ("head_mass_4_2", "M_h, 4 against 2", cases[4][1].mass, cases[2][1].mass),
    )
    for figure, name, one, other in ratios:
        yield SHEET.number("ratio", _ratio_percent(one, other), figure=figure, name=name)
    for figure, ratio, head in (
        ("neck_damping_minimum", 0.2, impact.Head.minimum()),
        ("neck_damping_maximum", 0.4, impact.Head.maximum()),
    ):
        damping = 2.0 * ratio * float(np.sqrt(head.mass * head.stiffness))
        yield SHEET.number("neck", damping, figure=figure, ratio=ratio)


def _first_peak(cases: Cases, found: Found) -> PrintedValue:
    later = []
    for key, (arm, head) in cases.items():
        run = impact.simulate(arm, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED, duration=0.5, step=1e-4)
        after = np.abs(run.head_acceleration[run.time > found[key].impact_duration])
        later.append(float(after.max()) / found[key].peak_head_acceleration)
    return SHEET.claim("first_peak", holds=max(later) < 1.0, later=100.0 * max(later))


def _constrained() -> PrintedValue:
    still, free = (
        impact.metrics(manipulator(1), FOAM_OF_FIGURES, head, closing_speed=MANIPULATOR_SPEED).peak_contact_force
        for head in (impact.ConstrainedHead(), impact.Head.minimum())
    )
    return SHEET.claim("constrained", holds=still / free > 1.5, still=still, free=free, ratio=still / free)


# ---- section 3.9 ------------------------------------------------------------------------------------

# What the text says of each foam and the upper and lower curve.
_VERDICTS = {1: ("below", "above"), 2: ("below", "below"), 3: ("", "")}


def _section_9() -> Iterator[PrintedValue]:
    for arm in (1, 2):
        for key, said in _VERDICTS.items():
            yield from _classified(arm, key, *said)
    widths = {}
    for arm in (1, 2):
        sides = [
            boundary(manipulator(arm), damping=[FOAM_OF_FIGURES.damping], closing_speed=CLOSING_SPEED).stiffness
            for boundary in (impact.foam_stiffness_upper, impact.foam_stiffness_lower)
        ]
        widths[arm] = [float(np.ravel(side)[0]) / KILO for side in sides]
    narrower = widths[2][0] - widths[2][1] < widths[1][0] - widths[1][1]
    yield SHEET.claim("width", holds=narrower, first=widths[1], second=widths[2])


def _classified(arm: int, key: int, upper: str, lower: str) -> Iterator[PrintedValue]:
    """Yield two cells: below the upper curve, above the lower one."""
    hard = impact.metrics(manipulator(arm), foam(key), impact.Head.minimum(), closing_speed=CLOSING_SPEED)
    deep = impact.metrics(manipulator(arm), foam(key), impact.Head.maximum(), closing_speed=CLOSING_SPEED)
    below = hard.peak_head_acceleration_g < LIMIT_G
    above = deep.max_compression < foam(key).linear_range
    for side, said, found, value in (
        ("upper", upper, "below" if below else "above", hard.peak_head_acceleration_g),
        ("lower", lower, "above" if above else "below", KILO * deep.max_compression),
    ):
        words = {"foam": key, "arm": arm, "said": said, "found": found, "value": value}
        note = SHEET.text(f"note_{key}")
        if said:
            yield SHEET.claim(side, holds=found == said, note=note, **words)
        else:
            yield SHEET.listed(side, printed="not said", note=note, **words)
