"""Exact derivatives of every metric against differences in 50 digits."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import impact
from reference.impact_mpmath import Parameters
from reference.impact_powers import POWERS
from reference.make_impact_golden import GRADIENT_TARGET, gradient_row

GOLDEN = json.loads(Path(GRADIENT_TARGET).read_text(encoding="utf-8"))
CASES: list[dict[str, Any]] = GOLDEN["cases"]
TOLERANCE = GOLDEN["tolerance"]
"""Of a derivative, each brought to the metric's own scale by its parameter over the metric."""
SPEED = GOLDEN["parameter_names"].index("closing_speed")


def gradients(case: dict[str, Any], **speeds: float) -> impact.ImpactGradients:
    p = Parameters(*case["parameters"])
    return impact.gradients(
        impact.Manipulator(mass=p[0], damping=p[1], stiffness=p[2]),
        impact.Foam(stiffness=p[6], damping=p[7]),
        impact.Head(mass=p[3], damping=p[4], stiffness=p[5]),
        closing_speed=p.closing_speed,
        **speeds,
    )


def exact(case: dict[str, Any], metric: str, parameter: str) -> float:
    row = GOLDEN["parameter_names"].index(parameter)
    return float(case["derivatives"][row][GOLDEN["metric_names"].index(metric)])


@pytest.mark.parametrize("metric", GOLDEN["metric_names"])
def test_derivatives_are_exact(metric: str) -> None:
    column, off = GOLDEN["metric_names"].index(metric), []
    for case in CASES:
        p = Parameters(*case["parameters"])
        found = gradients(case, manipulator_speed=p.manipulator_speed).of(metric)
        assert set(found) == set(GOLDEN["parameter_names"])
        size = abs(case["metrics"][column])
        for parameter, value in found.items():
            scale = max(abs(exact(case, metric, parameter)), size / getattr(p, parameter))
            off.append((abs(value - exact(case, metric, parameter)) / scale, parameter, case["parameters"]))
    assert not any(np.isnan(each[0]) for each in off)
    assert max(off)[0] <= TOLERANCE, sorted(off, reverse=True)[:5]


def test_closing_speed_carries_a_manipulator_speed_that_is_not_given() -> None:
    case = next(case for case in CASES if case["parameters"][SPEED] == case["parameters"][SPEED + 1])
    metric = "peak_power_manipulator"
    expected = exact(case, metric, "closing_speed") + exact(case, metric, "manipulator_speed")
    assert gradients(case).of(metric)["closing_speed"] == pytest.approx(expected, rel=TOLERANCE, abs=0.0)


def test_derivatives_come_with_the_metrics_themselves() -> None:
    for case in CASES:
        p = Parameters(*case["parameters"])
        found = gradients(case, manipulator_speed=p.manipulator_speed).metrics
        for name, value in zip(GOLDEN["metric_names"], case["metrics"], strict=True):
            assert getattr(found, name) == pytest.approx(value, rel=1e-11, abs=0.0), name


@pytest.mark.evidence
def test_golden_gradients_are_what_their_script_makes() -> None:
    assert gradient_row(Parameters(*CASES[3]["parameters"])) == CASES[3]


def test_relative_derivatives_of_a_proportional_impact_are_its_powers() -> None:
    found = impact.gradients(impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum(), closing_speed=1.25)
    speed = found.relative[:, found.parameter_names.index("closing_speed")]
    wanted = [POWERS[name] for name in found.metric_names]
    assert speed == pytest.approx(wanted, abs=1e-9)
    # Scaling all masses, dampings and stiffnesses together changes the forces and nothing else.
    bodies = [i for i, name in enumerate(found.parameter_names) if not name.endswith("speed")]
    together = dict(zip(found.metric_names, found.relative[:, bodies].sum(axis=1), strict=True))
    for name, value in together.items():
        assert value == pytest.approx(1.0 if "force" in name or "power" in name else 0.0, abs=1e-9), name
