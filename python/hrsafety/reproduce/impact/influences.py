"""Section 3.7: what mass, stiffness, damping, foam and impact point do to the head, measured."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact.cases import KILO, foam, manipulator
from hrsafety.reproduce.impact.studies import along_arm, over_foam, over_mass, over_stiffness
from hrsafety.reproduce.sheets import Sheet

__all__ = ["cells"]

SHEET = Sheet("chapter_3")
LIMIT_G = 10.0
LITTLE = 0.05  # half of the 10 % that the source calls an influence in section 3.6


def _percent(first: float, second: float) -> float:
    return 100.0 * (first / second - 1.0)


def cells() -> list[PrintedValue]:
    """Return the cells of section 3.7, in the order of the text."""
    return [*_mass_and_stiffness(), *_foam_parameters(), *_impact_point()]


def _mass_and_stiffness() -> Iterator[PrintedValue]:
    light, middle, heavy, endless = over_mass(foam(1), np.array([5.0, 20.0, 40.0, 400.0]))
    below, above = _percent(light, middle), _percent(endless, heavy)
    yield SHEET.claim("mass", holds=abs(below) > 2.0 * abs(above), below=below, above=above)
    heaviest = {key: float(over_mass(foam(key), np.array([1000.0]))[0]) for key in (1, 2, 3)}
    holds = heaviest[1] < LIMIT_G and heaviest[2] < LIMIT_G < heaviest[3]
    yield SHEET.claim("heavy", holds=holds, foams=heaviest)
    arm = manipulator(1)
    half_mass, whole = over_mass(foam(1), np.array([arm.mass / 2.0, arm.mass]))
    half_stiffness = float(over_stiffness(foam(1), np.array([arm.stiffness / 2.0]))[0])
    yield SHEET.claim(
        "stiffness",
        holds=abs(half_stiffness - whole) < abs(half_mass - whole),
        half_mass=_percent(half_mass, whole),
        half_stiffness=_percent(half_stiffness, whole),
    )
    stiff = over_stiffness(foam(1), 40.0 * foam(1).stiffness * np.array([1.0, 10.0]))
    yield SHEET.claim("stiff", holds=abs(stiff[1] / stiff[0] - 1.0) < LITTLE, change=_percent(stiff[1], stiff[0]))
    damped = float(over_mass(foam(1), np.array([arm.mass]), damping=500.0)[0])
    yield SHEET.claim("damping", holds=abs(damped / whole - 1.0) < LITTLE, change=_percent(damped, whole))


def _foam_parameters() -> Iterator[PrintedValue]:
    stiffness = np.geomspace(2e3, 100e3, 60)
    curves = {(arm, ratio): over_foam(manipulator(arm), stiffness, ratio) for arm in (1, 2) for ratio in (0.05, 0.2)}
    softest = max(float(curve[0]) for curve in curves.values())
    yield SHEET.claim("softest", holds=softest < LIMIT_G / 2.0, value=softest)
    for arm in (1, 2):
        change = 100.0 * (curves[arm, 0.2] / curves[arm, 0.05] - 1.0)
        smaller = bool((change < 0.0).all())
        since = np.nan if smaller else stiffness[change >= 0.0].max() / KILO
        yield SHEET.claim("ratio_of_foam", holds=smaller, arm=arm, most=change.max(), least=change.min(), since=since)
    lighter = [100.0 * (curves[1, ratio] / curves[2, ratio] - 1.0) for ratio in (0.05, 0.2)]
    most, least = max(map(np.max, lighter)), min(map(np.min, lighter))
    yield SHEET.claim("lighter", holds=bool(most < 0.0), most=most, least=least)
    hardest = min(float(curve[-1]) for curve in curves.values())
    yield SHEET.claim("hardest", holds=hardest > LIMIT_G, value=hardest)


def _impact_point() -> Iterator[PrintedValue]:
    arm = np.concatenate([[1e-4], np.arange(0.0005, 0.4 + 1e-9, 0.0005)])
    found = along_arm(1, arm)
    best = int(np.argmax(found))
    yield SHEET.number("worst_point", float(arm[best]))
    yield SHEET.number("at_joint", _percent(float(found[0]), float(found[best])))
    farther = np.linspace(0.01, 0.5, 50)
    worst = int(np.argmax(along_arm(2, farther)))
    yield SHEET.claim("far_end", holds=worst == len(farther) - 1, place=farther[worst])
