"""What makes a measured record look milder than the contact was: a doubt, and no limit counts as kept."""

from __future__ import annotations

import numpy as np
import pytest

from hrsafety import records

GENERATOR = np.random.default_rng(4)


def half_sine(time: np.ndarray, begin: float, width: float, size: float) -> np.ndarray:
    share = (time - begin) / width
    return np.where((share >= 0.0) & (share <= 1.0), size * np.sin(np.pi * share), 0.0)


TIME = np.arange(0.0, 1.6, 5e-4)
NOISE = GENERATOR.normal(0.0, 0.3, len(TIME))
HIT = half_sine(TIME, 0.2, 0.06, 120.0) + NOISE
RISING = np.clip(90.0 * (TIME - 0.2), 0.0, None) + NOISE
FORCES = {
    "as it is": (HIT, []),
    "held": (half_sine(TIME, 0.2, 0.04, 120.0) + np.where(TIME > 0.235, 60.0, 0.0) + NOISE, []),
    "kN": (1e-3 * HIT, ["implausible"]),
    "V": (1e-2 * HIT, ["implausible"]),
    "drifts": (HIT - np.where(TIME > 0.23, 20.0, 0.0), ["offset"]),
    "still rises": (RISING, ["ends_inside"]),
    "still rises, slowly": (60.0 + 10.0 * np.clip(TIME, 0.2, None) + np.where(TIME > 0.2, 0.0, -62.0), ["ends_inside"]),
    "one sample": (np.where(np.arange(len(TIME)) == 500, 120.0, 0.0) + NOISE, ["coarse_sampling"]),
}


@pytest.mark.parametrize("name", FORCES)
def test_forces(name: str) -> None:
    values, codes = FORCES[name]
    found = records.force(TIME, values)
    assert [each.code for each in found.warnings] == codes
    assert found.verdict(transient=280.0, quasi_static=140.0) == ("not_checked" if codes else "within_limits")


FAST = np.arange(0.0, 0.08, 5e-5)
HUM = GENERATOR.normal(0.0, 0.1, len(FAST))
BLOW = half_sine(FAST, 0.02, 0.01, 60.0) + HUM
ACCELERATIONS = {
    "as it is": (BLOW, None, []),
    "through class 1000": (BLOW, 1000, []),
    "of three axes": (np.column_stack([BLOW, HUM, HUM[::-1]]), None, []),
    "mV": (1e-3 * BLOW, None, ["implausible"]),
    "drifts": (BLOW - np.where(FAST > 0.025, 8.0, 0.0), None, ["offset"]),
    "too low a class": (half_sine(FAST, 0.02, 0.003, 150.0) + HUM, 60, ["filtered_pulse"]),
    "one sample": (np.where(np.arange(len(FAST)) == 500, 60.0, 0.0) + HUM, None, ["coarse_sampling"]),
}


@pytest.mark.parametrize("name", ACCELERATIONS)
def test_accelerations(name: str) -> None:
    values, filter_class, codes = ACCELERATIONS[name]
    found = records.acceleration(FAST, values, unit="g", filter_class=filter_class)
    assert [each.code for each in found.warnings] == codes
    assert found.verdict(hic15=700.0) == ("not_checked" if codes else "within_limits")


ROWS, COLUMNS = np.mgrid[0:20, 0:24]
FOIL = 2e6 * np.exp(-((ROWS - 8) ** 2 + (COLUMNS - 9) ** 2) / (2 * 3.5**2))


@pytest.mark.parametrize(
    ("foil", "pitch", "codes"),
    [
        (FOIL, 0.0025, []),
        (1e-6 * FOIL, 0.0025, ["implausible"]),
        (1e-3 * FOIL, 0.0025, ["implausible"]),
        (0.0 * FOIL, 0.0025, ["no_push"]),
        (np.minimum(FOIL, 1.5e6), 0.0025, ["saturated"]),
        (FOIL, 2.5, ["implausible"]),
    ],
)
def test_pressures(foil: np.ndarray, pitch: float, codes: list[str]) -> None:
    found = records.pressure(foil, pitch=pitch)
    assert [each.code for each in found.warnings] == codes
    assert found.verdict(2.1e6) == ("not_checked" if codes else "within_limits")
