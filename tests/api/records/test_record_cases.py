"""Loads of measured signals against numbers that were computed two ways."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import contact, records

_SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[4] / "shared"))
CASES: dict[str, Any] = json.loads((_SHARED / "spec" / "program_cases.json").read_text(encoding="utf-8"))


def signal(about: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """Return the times and values of a described signal."""
    start, step = about.get("start", 0.0), about["step"]
    time = start + step * np.arange(round((about["duration"] - start) / step) + 1)
    values = np.zeros_like(time)
    for shape, begin, end, size in about["pulses"]:
        share = (time - begin) / (end - begin)
        inside = (share >= -1e-9) & (share <= 1.0 + 1e-9)
        form = {
            "half_sine": np.sin(np.pi * share),
            "square": np.ones_like(share),
            "triangle": 1.0 - np.abs(2.0 * share - 1.0),
            "ramp": share,
        }[shape]
        values += np.where(inside, size * form, 0.0)
    for size, frequency, phase in about.get("ripple", []):
        values += size * np.sin(2.0 * np.pi * frequency * time + phase)
    if "clip" in about:
        values = np.clip(values, -about["clip"], about["clip"])
    return time, about.get("sign", 1) * values + about.get("offset", 0.0)


@pytest.mark.parametrize("case", CASES["acceleration"], ids=lambda case: case["name"])
def test_accelerations(case: dict[str, Any]) -> None:
    time, values = signal(case["signal"])
    if "direction" in case:
        values = np.outer(values, np.array(case["direction"]) / 3.0) + np.array(case["axis_offsets"])
    found = records.acceleration(time, values, unit=case["unit"], filter_class=case.get("filter_class"))
    assert sorted(each.code for each in found.warnings) == case["codes"]
    close = {"rel": case["tolerance"], "abs": 1e-9}
    for name in ("peak_g", "peak_time", "start", "end", "hic15", "hic36", "clip_3ms_g", "velocity_change"):
        expected = case[name]
        assert getattr(found, name) == (None if expected is None else pytest.approx(expected, **close)), name
    assert found.offsets_g.tolist() == pytest.approx(case["offsets"], **close)
    assert [list(hit) for hit in found.hits] == [pytest.approx(hit, **close) for hit in case["hits"]]


@pytest.mark.parametrize("case", CASES["force"], ids=lambda case: case["name"])
def test_forces(case: dict[str, Any]) -> None:
    found = records.force(*signal(case["signal"]), unit=case["unit"])
    assert sorted(each.code for each in found.warnings) == case["codes"]
    close = {"rel": case["tolerance"], "abs": 1e-9}
    assert (found.peak, found.transient, found.offset) == pytest.approx(
        (case["peak"], case["transient"], case["offset"]), **close
    )
    expected = case["quasi_static"]
    assert found.quasi_static == (None if expected is None else pytest.approx(expected, **close))
    assert len(found.contacts) == len(case["contacts"])
    for each, told in zip(found.contacts, case["contacts"], strict=True):
        assert each.ends == told["ends"]
        for name in ("start", "end", "transient", "quasi_static"):
            value = told[name]
            assert getattr(each, name) == (None if value is None else pytest.approx(value, **close)), name


@pytest.mark.parametrize("case", CASES["patch"])
def test_pressures(case: dict[str, Any]) -> None:
    about = case["gaussian"]
    rows, columns = np.mgrid[0 : case["rows"], 0 : case["columns"]]
    away = (rows - about["center"][0]) ** 2 + (columns - about["center"][1]) ** 2
    foil = about["peak"] * np.exp(-away / (2.0 * about["sigma_cells"] ** 2))
    found = records.pressure(foil, pitch=case["pitch"])
    assert (found.cell, found.patch) == pytest.approx((case["cell"], case["patch"]), rel=1e-9)


@pytest.mark.parametrize("case", CASES["acceptance"])
def test_repetitions(case: dict[str, Any]) -> None:
    found = records.repetitions(case["values"], case["limit"], device_uncertainty=case["device_uncertainty"])
    expected = [case["mean"], case["largest"], case["expanded_uncertainty"]]
    assert [found.mean, found.largest, found.expanded_uncertainty] == pytest.approx(expected, rel=1e-9)
    assert ":".join(filter(None, (found.verdict, found.reason))) == case["verdict"]


def test_without_the_uncertainty_of_the_device_no_limit_is_kept() -> None:
    values = [121.0, 126.0, 118.0]
    found = records.repetitions(values, 280.0)
    assert (found.verdict, found.reason) == ("not_checked", "no_device_uncertainty")
    assert records.repetitions(values, 280.0, device_uncertainty=0.0).verdict == "within_limits"
    assert records.repetitions(values, 120.0).verdict == "exceeds"
    row = contact.PlannedMeasurement(
        place="tool", region="chest", contact="transient", speed=0.25, spring=25e3, limit=280.0
    )
    (filled,) = contact.MeasurementPlan(rows=[row]).filled({0: values}).rows
    assert filled.accept == "no device uncertainty"


@pytest.mark.parametrize("seed", range(40))
def test_a_pulse_among_offset_noise_and_weaker_hits_keeps_its_criterion_or_has_a_code(seed: int) -> None:
    draw = np.random.default_rng(seed)
    step, peak = 1e-4, float(draw.uniform(30.0, 120.0))
    time = np.arange(0.0, 0.25, step)
    width = float(draw.uniform(0.006, 0.015))

    def pulse(start: float, height: float, length: float) -> np.ndarray:
        inside = (time >= start) & (time <= start + length)
        return np.where(inside, height * np.sin(np.pi * (time - start) / length), 0.0)

    clean = pulse(0.1, peak, width)
    weaker = sum(
        pulse(float(start), float(draw.uniform(0.05, 0.25)) * peak, 0.006)
        for start in draw.choice([0.06, 0.16, 0.2], 2)
    )
    noise = np.where(time < 0.09, draw.normal(0.0, 0.5, len(time)), 0.0)
    offset = float(draw.uniform(-0.5, 0.5)) * peak
    measured = float(draw.choice([-1.0, 1.0])) * (clean + weaker + noise + offset)
    exact = records.acceleration(time, clean, unit="g")
    found = records.acceleration(time, measured, unit="g")
    if abs(found.hic15 / exact.hic15 - 1.0) > 0.03:
        assert any(not each.safe_side for each in found.warnings)
    else:
        assert found.peak_g == pytest.approx(peak, rel=0.03)
    # The offset is told where it is large.
    if abs(offset) > 0.1 * peak:
        assert "offset_removed" in {each.code for each in found.warnings}
