"""Section 3.7: what mass, stiffness, damping, foam and impact point do to the head, measured."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hrsafety.reproduce.cells import Cell, Tolerance
from hrsafety.reproduce.impact_cases import KILO, foam, manipulator
from hrsafety.reproduce.impact_cells import PERCENT, claim, number
from hrsafety.reproduce.impact_studies import along_arm, over_foam, over_mass, over_stiffness
from hrsafety.reproduce.published import printed_figure

__all__ = ["cells"]

LIMIT_G = 10.0
LITTLE = 0.05  # half of the 10 % that the source calls an influence in section 3.6


def _ratio_percent(first: float, second: float) -> float:
    return 100.0 * (first / second - 1.0)


def cells() -> list[Cell]:
    """Return the cells of section 3.7."""
    return [*_mass_and_stiffness(), *_foam_parameters(), *_impact_point()]


def _mass_and_stiffness() -> Iterator[Cell]:
    light, middle, heavy, endless = over_mass(foam(1), np.array([5.0, 20.0, 40.0, 400.0]))
    below, above = _ratio_percent(light, middle), _ratio_percent(endless, heavy)
    yield claim(
        "Section 3.7",
        "Mass M_r, Foam 1",
        "influence",
        printed="strong below 20 kg, much smaller above 40 kg",
        measured=f"20 to 5 kg: {below:+.1f} %; 40 to 400 kg: {above:+.1f} %",
        holds=abs(below) > 2.0 * abs(above),
    )
    heaviest = {key: float(over_mass(foam(key), np.array([1000.0]))[0]) for key in (1, 2, 3)}
    yield claim(
        "Section 3.7",
        "Heavy manipulator, 1000 kg",
        "10 g",
        printed="Foams 1 and 2 stay below, Foam 3 may exceed",
        measured=", ".join(f"Foam {key}: {value:.2f} g" for key, value in heaviest.items()),
        holds=heaviest[1] < LIMIT_G and heaviest[2] < LIMIT_G < heaviest[3],
    )
    arm = manipulator(1)
    half_mass, whole = over_mass(foam(1), np.array([arm.mass / 2.0, arm.mass]))
    half_stiffness = float(over_stiffness(foam(1), np.array([arm.stiffness / 2.0]))[0])
    yield claim(
        "Section 3.7",
        "Stiffness K_r, Foam 1",
        "influence",
        printed="weaker than that of the mass",
        measured=f"half the mass: {_ratio_percent(half_mass, whole):+.1f} %; "
        f"half the stiffness: {_ratio_percent(half_stiffness, whole):+.1f} %",
        holds=abs(half_stiffness - whole) < abs(half_mass - whole),
    )
    stiff = over_stiffness(foam(1), 40.0 * foam(1).stiffness * np.array([1.0, 10.0]))
    yield claim(
        "Section 3.7",
        "Stiffness K_r, Foam 1",
        "above 40 K_c",
        printed="influence nearly vanishes",
        measured=f"40 to 400 times K_c: {_ratio_percent(stiff[1], stiff[0]):+.2f} %",
        holds=abs(stiff[1] / stiff[0] - 1.0) < LITTLE,
    )
    damped = float(over_mass(foam(1), np.array([arm.mass]), damping=500.0)[0])
    yield claim(
        "Section 3.7",
        "Damping C_r, Foam 1",
        "doubled",
        printed="minor effect",
        measured=f"{_ratio_percent(damped, whole):+.1f} %",
        holds=abs(damped / whole - 1.0) < LITTLE,
    )


def _foam_parameters() -> Iterator[Cell]:
    stiffness = np.geomspace(2e3, 100e3, 60)
    curves = {(arm, ratio): over_foam(manipulator(arm), stiffness, ratio) for arm in (1, 2) for ratio in (0.05, 0.2)}
    softest = max(float(curve[0]) for curve in curves.values())
    yield claim(
        "Section 3.7",
        "Soft foam, 2 kN/m",
        "a_h,max",
        printed="small whatever the damping ratio",
        measured=f"at most {softest:.2f} g for ratios 0.05 and 0.2 on both manipulators",
        holds=softest < LIMIT_G / 2.0,
    )
    for arm in (1, 2):
        change = 100.0 * (curves[arm, 0.2] / curves[arm, 0.05] - 1.0)
        yield claim(
            "Section 3.7",
            f"Damping ratio 0.2 against 0.05, Manipulator {arm}",
            "a_h,max",
            printed="smaller",
            measured=f"{change.max():+.1f} to {change.min():+.1f} % from 2 to 100 kN/m",
            holds=bool((change < 0.0).all()),
            reason=""
            if (change < 0.0).all()
            else f"Only from {stiffness[change >= 0.0].max() / KILO:.0f} kN/m on; with "
            "a softer foam the step v_c C_c at first contact is the peak.",
        )
    lighter = [100.0 * (curves[1, ratio] / curves[2, ratio] - 1.0) for ratio in (0.05, 0.2)]
    yield claim(
        "Section 3.7",
        "Manipulator 1 against 2",
        "a_h,max",
        printed="smaller, because the effective mass is",
        measured=f"{max(map(np.max, lighter)):+.1f} to {min(map(np.min, lighter)):+.1f} %",
        holds=bool(max(map(np.max, lighter)) < 0.0),
    )
    hardest = min(float(curve[-1]) for curve in curves.values())
    yield claim(
        "Section 3.7",
        "Stiff foam, 100 kN/m",
        "a_h,max",
        printed="can exceed the threshold",
        measured=f"at least {hardest:.2f} g",
        holds=hardest > LIMIT_G,
    )


def _impact_point() -> Iterator[Cell]:
    arm = np.concatenate([[1e-4], np.arange(0.0005, 0.4 + 1e-9, 0.0005)])
    found = along_arm(1, arm)
    best = int(np.argmax(found))
    yield number(
        "Section 3.7",
        "Impact point, Manipulator 1",
        "l_1 of the largest a_h,max",
        printed=printed_figure("3.7", "lever_arm_of_largest_acceleration"),
        measured=float(arm[best]),
        tolerance=Tolerance(0.001, relative=False),
        unit="m",
        reason="Needs 0.25 m/s at the far end of the arm, l_1 = 0.4 m, which the text does not say.",
    )
    yield number(
        "Section 3.7",
        "Impact point, Manipulator 1",
        "a_h,max at the joint against the largest",
        printed=printed_figure("3.7", "acceleration_at_the_joint"),
        measured=_ratio_percent(float(found[0]), float(found[best])),
        tolerance=PERCENT,
        unit="%",
        reason="At the joint the manipulator is rigid and at rest, so the head alone brings the 1.0 m/s. The printed "
        "q2 gives -0.3 % as well; left open.",
    )
    farther = np.linspace(0.01, 0.5, 50)
    puma = along_arm(2, farther)
    yield claim(
        "Section 3.7",
        "Impact point, Manipulator 2",
        "worst point",
        printed="far end",
        measured=f"largest at l_1 = {farther[int(np.argmax(puma))]:.2f} m of 0.50 m",
        holds=int(np.argmax(puma)) == len(farther) - 1,
    )
