"""Every percentage and claim of sections 3.6 (head and neck) and 3.9 (foam design), measured."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

import numpy as np

from hrsafety import impact
from hrsafety.reproduce.cells import Cell, Tolerance
from hrsafety.reproduce.impact_cases import (
    CLOSING_SPEED,
    FOAM_OF_FIGURES,
    KILO,
    MANIPULATOR_SPEED,
    foam,
    manipulator,
    printed_metrics,
    simulations,
)
from hrsafety.reproduce.impact_cells import PERCENT, claim, listed, number
from hrsafety.reproduce.published import printed_figure

__all__ = ["cells"]

LIMIT_G = 10.0
PARAMETER = Tolerance(5.0, relative=False)  # ratios of parameters, printed in tens of percent
ROUGH_TIME = Tolerance(0.2, relative=True)  # "about"
NECK_DAMPING = Tolerance(0.5, relative=False)  # half a unit of 46; 130.2 has one digit more
FINE_STEP = 1e-5  # s, on which the instant of the peak is read
_FORM = "The printed figures were probably made with the printed q2, which lacks C_r C_h; with it: {:+.2f} %."
_RATIO = "A ratio of parameters of Tables 3.1 and 3.2."


def cells() -> list[Cell]:
    """Return the cells of sections 3.6 and 3.9."""
    return [*_section_6(), *_section_9()]


def _ratio_percent(first: float, second: float) -> float:
    return 100.0 * (first / second - 1.0)


# ---- section 3.6 ------------------------------------------------------------------------------------


def _section_6() -> Iterator[Cell]:
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
    yield claim(
        "Section 3.6",
        "Head-neck sets",
        "direction of the influence",
        printed="smaller head-neck parameters: smaller a_h,max, larger f_c",
        measured=f"minimum set: {found[3].peak_head_acceleration_g:.2f} g, {found[3].peak_contact_force:.0f} N; "
        f"stiffer neck (Simulation 1): {found[1].peak_head_acceleration_g:.2f} g, "
        f"{found[1].peak_contact_force:.0f} N",
        holds=False,
        reason="The reverse, as the comparisons before it say; the source then uses the sets the right way round.",
    )


def _peaks(cases: Mapping[int, tuple[impact.Manipulator, impact.Head]]) -> Iterator[Cell]:
    """Yield the instant of the largest force, and the step at first contact."""
    steps = []
    for key, (arm, head) in cases.items():
        run = impact.simulate(arm, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED, duration=0.06, step=FINE_STEP)
        inside = run.time <= run.metrics.impact_duration
        steps.append(float(run.contact_force[0]))
        yield number(
            "Section 3.6",
            f"Simulation {key}",
            "time of the force peak",
            printed=printed_figure("3.6", "time_of_peak_force"),
            measured=float(run.time[np.argmax(np.where(inside, run.contact_force, -np.inf))]),
            tolerance=ROUGH_TIME,
            unit="s",
            reason="One rough instant is given for all four curves. Here the peaks lie between 15 and 22 ms, with the "
            "printed q2 as well.",
        )
    expected = CLOSING_SPEED * FOAM_OF_FIGURES.damping
    yield claim(
        "Section 3.6",
        "All simulations",
        "step of the force at first contact",
        printed="v_c C_c",
        measured=f"{steps[0]:.3f} N; v_c C_c = {expected:.3f} N",
        holds=all(abs(step - expected) <= 1e-9 * expected for step in steps),
    )


def _compared(
    cases: Mapping[int, tuple[impact.Manipulator, impact.Head]],
    found: Mapping[int, impact.ImpactMetrics],
    first: int,
    second: int,
) -> Iterator[Cell]:
    """Yield two percentages of one simulation against another."""
    as_printed = [printed_metrics(*cases[key]) for key in (first, second)]
    for name, quantity, key in (
        ("f_c,max", "peak_contact_force", "force"),
        ("a_h,max", "peak_head_acceleration", "acceleration"),
    ):
        old = [getattr(each, quantity) for each in as_printed]
        yield number(
            "Section 3.6",
            f"Simulation {first} against {second}",
            name,
            printed=printed_figure("3.6", f"{key}_{first}_{second}"),
            measured=_ratio_percent(getattr(found[first], quantity), getattr(found[second], quantity)),
            tolerance=PERCENT,
            unit="%",
            reason=_FORM.format(_ratio_percent(old[0], old[1])),
        )


def _parameters(cases: Mapping[int, tuple[impact.Manipulator, impact.Head]]) -> Iterator[Cell]:
    """Yield the ratios of parameters that the text names, and the range of the neck damping."""
    ratios = (
        ("mass_2_1", "M_r, 2 against 1", cases[2][0].mass, cases[1][0].mass),
        ("neck_stiffness_1_3", "K_h, 1 against 3", cases[1][1].stiffness, cases[3][1].stiffness),
        ("neck_damping_1_3", "C_h, 1 against 3", cases[1][1].damping, cases[3][1].damping),
        ("head_mass_4_2", "M_h, 4 against 2", cases[4][1].mass, cases[2][1].mass),
    )
    for figure, name, one, other in ratios:
        yield number(
            "Section 3.6",
            "Parameters",
            name,
            printed=printed_figure("3.6", figure),
            measured=_ratio_percent(one, other),
            tolerance=PARAMETER,
            unit="%",
            reason=_RATIO,
        )
    for figure, ratio, head in (
        ("neck_damping_minimum", 0.2, impact.Head.minimum()),
        ("neck_damping_maximum", 0.4, impact.Head.maximum()),
    ):
        yield number(
            "Section 3.6",
            "Parameters",
            f"C_h at damping ratio {ratio:g}",
            printed=printed_figure("3.6", figure),
            measured=2.0 * ratio * float(np.sqrt(head.mass * head.stiffness)),
            tolerance=NECK_DAMPING,
            unit="N s/m",
            reason="2 xi sqrt(M_h K_h). Table 3.2 rounds the larger one to 130 N s/m, which is used here.",
        )


def _first_peak(
    cases: Mapping[int, tuple[impact.Manipulator, impact.Head]], found: Mapping[int, impact.ImpactMetrics]
) -> Cell:
    later = []
    for key, (arm, head) in cases.items():
        run = impact.simulate(arm, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED, duration=0.5, step=1e-4)
        after = np.abs(run.head_acceleration[run.time > found[key].impact_duration])
        later.append(float(after.max()) / found[key].peak_head_acceleration)
    return claim(
        "Section 3.6",
        "All simulations",
        "largest acceleration",
        printed="bounded; the first peak is the largest",
        measured=f"later than the impact period at most {100.0 * max(later):.0f} % of the peak within 0.5 s",
        holds=max(later) < 1.0,
    )


def _constrained() -> Cell:
    arm = manipulator(1)
    still = impact.metrics(arm, FOAM_OF_FIGURES, impact.ConstrainedHead(), closing_speed=MANIPULATOR_SPEED)
    free = impact.metrics(arm, FOAM_OF_FIGURES, impact.Head.minimum(), closing_speed=MANIPULATOR_SPEED)
    ratio = still.peak_contact_force / free.peak_contact_force
    return claim(
        "Section 3.6",
        "Constrained head",
        "contact force at 0.25 m/s",
        printed="much larger than with a free head",
        measured=f"{still.peak_contact_force:.1f} N within 50 ms against {free.peak_contact_force:.1f} N, "
        f"{ratio:.2f} times",
        holds=ratio > 1.5,
    )


# ---- section 3.9 ------------------------------------------------------------------------------------

_VERDICTS = {
    1: ("below", "above", ""),
    2: (
        "below",
        "below",
        "The printed 13.8 kN/m sits on the line of Manipulator 1 and passes by 8 um; with the 13.48 kN/m of "
        "appendix A it fails.",
    ),
    3: ("", "", "The source gives no verdict in words; it says that a stiffer foam such as Foam 3 may fail."),
}


def _section_9() -> Iterator[Cell]:
    for arm in (1, 2):
        for key, (upper, lower, note) in _VERDICTS.items():
            yield from _classified(arm, key, upper, lower, note)
    widths = {}
    for arm in (1, 2):
        sides = [
            boundary(manipulator(arm), damping=[FOAM_OF_FIGURES.damping], closing_speed=CLOSING_SPEED).stiffness
            for boundary in (impact.foam_stiffness_upper, impact.foam_stiffness_lower)
        ]
        widths[arm] = [float(np.ravel(side)[0]) / KILO for side in sides]
    yield claim(
        "Section 3.9",
        "Range of stiffness at C_c = 71.9 N s/m",
        "Manipulator 2 against 1",
        printed="smaller",
        measured="; ".join(f"Manipulator {arm}: {low:.2f} to {high:.2f} kN/m" for arm, (high, low) in widths.items()),
        holds=widths[2][0] - widths[2][1] < widths[1][0] - widths[1][1],
    )


def _classified(arm: int, key: int, upper: str, lower: str, note: str) -> Iterator[Cell]:
    """Yield two cells: below the upper curve, above the lower one."""
    hard = impact.metrics(manipulator(arm), foam(key), impact.Head.minimum(), closing_speed=CLOSING_SPEED)
    deep = impact.metrics(manipulator(arm), foam(key), impact.Head.maximum(), closing_speed=CLOSING_SPEED)
    row = f"Foam {key} on Manipulator {arm}"
    below = hard.peak_head_acceleration_g < LIMIT_G
    above = deep.max_compression < foam(key).linear_range
    for column, said, found, value in (
        ("upper boundary, 10 g", upper, "below" if below else "above", f"{hard.peak_head_acceleration_g:.2f} g"),
        ("lower boundary, 0.02 m", lower, "above" if above else "below", f"{KILO * deep.max_compression:.3f} mm"),
    ):
        measured = f"{found}: {value}"
        if not said:
            yield listed("Section 3.9", row, column, printed="not said", measured=measured, unit="", reason=note)
            continue
        yield claim(
            "Section 3.9",
            row,
            column,
            printed=f"{said} the curve",
            measured=measured,
            holds=found == said,
            reason="" if found == said else note,
        )
