"""Metrics and trajectories of impacts against their evaluation in 50 digits, and a second integrator."""

from __future__ import annotations

import json
import math
import random
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from hrsafety import impact
from reference.impact_metrics import METRICS, constrained_metrics, metrics
from reference.impact_mpmath import Parameters
from reference.impact_sets import REPEATED
from reference.make_impact_golden import TARGET, TRAJECTORIES, row

GOLDEN = json.loads(Path(TARGET).read_text(encoding="utf-8"))
TOLERANCE = GOLDEN["tolerance"]
"""1e-11 of the metric, or of a trajectory's own peak on [0, 60 ms], for every set."""
INTEGRATOR = 1e-10  # of the own peak: what DOP853 keeps at rtol 1e-12 over some hundred steps
RECOMPUTED = 6
STEP = 0.001
LINEAR_RANGE = 1e6  # m: far away, so that the status speaks of the impact period
THICKNESS = 0.0254  # m: where the head stands at first
NAMES = GOLDEN["parameter_names"]


def parts(p: Parameters, thickness: float = LINEAR_RANGE) -> tuple[impact.Manipulator, impact.Foam, impact.Head]:
    """Return the parameter objects of one set; the linear range is far away."""
    return (
        impact.Manipulator(mass=p[0], damping=p[1], stiffness=p[2]),
        impact.Foam(stiffness=p[6], damping=p[7], thickness=thickness, linear_range=thickness),
        impact.Head(mass=p[3], damping=p[4], stiffness=p[5]),
    )


def of_batch(rows: np.ndarray, **options: Any) -> impact.ImpactMetricsBatch:
    return impact.metrics_batch(**dict(zip(NAMES, rows.T, strict=True)), linear_range=LINEAR_RANGE, **options)


def cases() -> list[dict[str, Any]]:
    return GOLDEN["cases"]


@pytest.fixture(scope="module")
def parameters() -> np.ndarray:
    return np.array([case["parameters"] for case in cases()])


@pytest.fixture(scope="module")
def batch(parameters: np.ndarray) -> impact.ImpactMetricsBatch:
    return of_batch(parameters, horizon=GOLDEN["horizon_s"])


def relative(found: float, exact: float | None, name: str) -> float:
    """Return the relative difference; null demands infinity of the period and NaN of an average."""
    if exact is None:
        expected = math.isinf(found) if name == "impact_duration" else math.isnan(found)
        return 0.0 if expected else math.inf
    difference = abs(found - exact) / abs(exact)
    return math.inf if math.isnan(difference) else difference


def worst_first(errors: list[tuple[float, str]]) -> str:
    return "; ".join(f"{error:.1e} {label}" for error, label in sorted(errors, reverse=True)[:12])


def test_golden_sets_cover_repeated_roots() -> None:
    gaps = np.array([case["root_gap"] for case in cases()])
    assert len(cases()) == 1000
    assert np.sum(gaps <= 1e-2) >= 200
    assert np.sum(gaps < 1e-16) >= 40, "exactly repeated"
    assert all(np.sum((gaps >= 10.0**-k) & (gaps < 10.0 ** (1 - k))) >= 5 for k in range(3, 13)), "every decade"
    assert {case["family"] for case in cases()} >= set(REPEATED)


@pytest.mark.evidence
def test_golden_file_is_what_its_script_makes(parameters: np.ndarray) -> None:
    drawn = random.Random(60).sample(range(len(cases())), RECOMPUTED)
    for index in drawn:
        case = cases()[index]
        assert row((case["family"], Parameters(*parameters[index]))) == case


@pytest.mark.parametrize("name", METRICS)
def test_metric_is_exact(batch: impact.ImpactMetricsBatch, name: str) -> None:
    found, column = getattr(batch, name), GOLDEN["metric_names"].index(name)
    errors = [
        (relative(found[i], case["metrics"][column], name), f"row {i}, {case['family']}, gap {case['root_gap']}")
        for i, case in enumerate(cases())
    ]
    assert max(errors)[0] <= TOLERANCE, worst_first([each for each in errors if each[0] > TOLERANCE])


def test_status_tells_whether_the_impact_period_ends(batch: impact.ImpactMetricsBatch) -> None:
    column = GOLDEN["metric_names"].index("impact_duration")
    expected = ["no_release" if case["metrics"][column] is None else "released" for case in cases()]
    assert batch.status.tolist() == expected
    assert {"no_release", "released"} == set(expected)


def test_single_call_and_batch_agree(parameters: np.ndarray, batch: impact.ImpactMetricsBatch) -> None:
    words = batch.status
    for i, values in enumerate(parameters):
        p = Parameters(*values)
        speeds = {"closing_speed": p.closing_speed, "manipulator_speed": p.manipulator_speed}
        one = impact.metrics(*parts(p), **speeds, horizon=GOLDEN["horizon_s"])
        assert one.status == words[i]
        assert [getattr(one, name) for name in METRICS] == pytest.approx(
            [getattr(batch, name)[i] for name in METRICS], rel=TOLERANCE, abs=0.0, nan_ok=True
        ), f"row {i}"


@pytest.mark.parametrize("fields", ["all", "peaks"])
def test_lanes_and_threads_never_change_a_bit(parameters: np.ndarray, fields: str) -> None:
    names = METRICS if fields == "all" else ("peak_head_acceleration", "peak_contact_force", "impact_duration")
    first = of_batch(parameters, fields=fields, lanes=1, threads=1)
    for lanes in (1, 4, 8, 16, None):
        for threads in (1, 2, 3):
            other = of_batch(parameters, fields=fields, lanes=lanes, threads=threads)
            for name in names:
                assert getattr(other, name).tobytes() == getattr(first, name).tobytes(), (name, lanes, threads)
            assert other.status.tolist() == first.status.tolist()


def test_peaks_are_those_of_all_fields(parameters: np.ndarray, batch: impact.ImpactMetricsBatch) -> None:
    peaks = of_batch(parameters, fields="peaks", horizon=GOLDEN["horizon_s"])
    for name in ("peak_head_acceleration", "peak_contact_force", "max_compression", "impact_duration"):
        np.testing.assert_allclose(getattr(peaks, name), getattr(batch, name), rtol=TOLERANCE, atol=0.0)


def test_trajectories_are_exact(parameters: np.ndarray) -> None:
    rows = [round(t / STEP) for t in GOLDEN["times_s"]]
    errors = []
    for i, case in enumerate(cases()):
        p = Parameters(*parameters[i])
        speeds = {"closing_speed": p.closing_speed, "manipulator_speed": p.manipulator_speed}
        run = impact.simulate(*parts(p, THICKNESS), **speeds, duration=0.06, step=STEP)
        for k, name in enumerate(TRAJECTORIES):
            start = THICKNESS if name == "head_position" else 0.0  # the file counts from there
            found, scale = getattr(run, name)[rows], case["peaks"][k] + start
            difference = np.abs(found - start - [state[k] for state in case["states"]]).max()
            if not difference <= TOLERANCE * scale:
                errors.append((difference / scale, f"row {i}, {case['family']}, gap {case['root_gap']}, {name}"))
    assert not errors, f"{len(errors)} beyond: {worst_first(errors)}"


def right_hand_side(p: Parameters) -> Any:
    """Return the rates of x_r, x_r', and of the head from T_u, as the equations of motion stand."""
    head_speed = p.manipulator_speed - p.closing_speed

    def rates(t: float, state: np.ndarray) -> list[float]:
        x_r, dx_r, x_h, dx_h = state
        force = p.foam_stiffness * (x_r - x_h) + p.foam_damping * (dx_r - dx_h)
        held = p.manipulator_damping * (dx_r - p.manipulator_speed) + p.manipulator_stiffness * (
            x_r - p.manipulator_speed * t
        )
        neck = p.head_damping * (dx_h - head_speed) + p.head_stiffness * (x_h - head_speed * t)
        return [dx_r, -(force + held) / p.manipulator_mass, dx_h, (force - neck) / p.head_mass]

    return rates


def test_trajectories_agree_with_an_adaptive_integrator() -> None:
    """Equations in positions, no residue, no set-point frame: nothing in common with either evaluation."""
    times = np.linspace(0.0, 0.06, 61)
    chosen = [case for case in cases() if case["family"] in ("typical", "overdamped", "critical")][::12]
    assert len(chosen) >= 40
    for case in chosen:
        p = Parameters(*case["parameters"])
        start = [0.0, p.manipulator_speed, 0.0, p.manipulator_speed - p.closing_speed]
        options = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-15 * p.closing_speed, "t_eval": times}
        plain = solve_ivp(right_hand_side(p), (0.0, 0.06), start, **options).y
        speeds = {"closing_speed": p.closing_speed, "manipulator_speed": p.manipulator_speed}
        run = impact.simulate(*parts(p, THICKNESS), **speeds, duration=0.06, step=STEP)
        names = ("manipulator_position", "manipulator_velocity", "head_position", "head_velocity")
        for values, name in zip(plain, names, strict=True):
            scale = max(np.abs(values).max(), p.closing_speed * (0.06 if name.endswith("position") else 1.0))
            found = getattr(run, name) - (run.head_position[0] if name == "head_position" else 0.0)
            assert np.abs(found - values).max() <= INTEGRATOR * scale, (case["family"], name)


def test_constrained_head_loads_are_exact() -> None:
    source = random.Random(36)
    for _, p in source.sample(draw_typical(), 20):
        exact = constrained_metrics(p, horizon=0.05)
        manipulator, foam, _ = parts(p)
        speeds = {"closing_speed": p.closing_speed, "manipulator_speed": p.manipulator_speed}
        found = impact.metrics(manipulator, foam, impact.ConstrainedHead(), **speeds)
        for name, value in exact.items():
            assert getattr(found, name) == pytest.approx(float(value), rel=TOLERANCE, abs=0.0), name
        assert found.status == "constrained"
        for name in set(METRICS) - set(exact) - {"impact_duration"}:
            assert math.isnan(getattr(found, name)), name


def draw_typical() -> list[tuple[str, Parameters]]:
    return [("typical", Parameters(*case["parameters"])) for case in cases() if case["family"] == "typical"]


def test_horizon_bounds_the_maxima_without_release() -> None:
    chosen = [case for case in cases() if case["family"] == "typical"][:8]
    for case in chosen:
        p = Parameters(*case["parameters"])
        exact = metrics(p, horizon=0.016)
        speeds = {"closing_speed": p.closing_speed, "manipulator_speed": p.manipulator_speed}
        found = impact.metrics(*parts(p), **speeds, horizon=0.016)
        assert (found.status == "no_release") == math.isinf(float(exact["impact_duration"]))
        for name in METRICS:
            assert getattr(found, name) == pytest.approx(float(exact[name]), rel=TOLERANCE, abs=0.0), name


# A light, stiffly held manipulator rings at 200 to 600 Hz under a slow impact: a window has many good places.
MANY_HUMPS = [
    Parameters(
        0.06357485416098436,
        0.534205074040328,
        843635.5185878172,
        190.66857961307085,
        68.9005332313682,
        451.11952401553424,
        3.278164464732597,
        28.67523279716127,
        0.3832446641894292,
        0.4564597797123606,
    ),
    Parameters(
        0.1751548355588144,
        4.8303202459381485,
        320002.19009633793,
        59.55837233741595,
        61.43760516425755,
        4890.571853859283,
        15.763665236739216,
        3.045232819791663,
        0.5,
        0.5,
    ),
    Parameters(
        0.1858095676347152,
        1.825173486595916,
        646251.1469933257,
        113.76833687289725,
        15.637043614304346,
        1346.652191679578,
        23.058799800548442,
        38.29540426283958,
        0.5,
        0.5,
    ),
]


@pytest.mark.parametrize("p", MANY_HUMPS)
def test_head_injury_criterion_is_the_best_of_many_humps(p: Parameters) -> None:
    exact = metrics(p, exact=False)
    speeds = {"closing_speed": p.closing_speed, "manipulator_speed": p.manipulator_speed}
    found = impact.metrics(*parts(p), **speeds, horizon=GOLDEN["horizon_s"])
    assert found.hic15 == pytest.approx(exact["hic15"], rel=TOLERANCE, abs=0.0)
    assert found.hic36 == pytest.approx(exact["hic36"], rel=TOLERANCE, abs=0.0)
