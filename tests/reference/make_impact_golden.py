"""Writes ``tests/golden/impact_exact.json``: metrics and trajectories of random impacts in 50 digits.

    python tests/reference/make_impact_golden.py [exact] [gradients]

``impact_gradients.json`` holds derivatives of every metric by every parameter, of central differences
with a relative step of 1e-15: their own error is near 1e-28.

Every number is the double nearest to the exact one for parameters that are exactly the listed
doubles, so comparisons carry the error of the other side alone. ``null`` stands for an infinite
impact period (metrics are then those of the horizon) or an average that the period is too short for.
"""

from __future__ import annotations

import json
import math
import random
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np
from mpmath import mp, mpf

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from reference.impact_metrics import METRICS, Extent, metrics
from reference.impact_mpmath import DIGITS, Impact, Parameters, first_fall, root_gap
from reference.impact_sets import FAMILIES

SEED = 2011
TARGET = Path(__file__).resolve().parents[1] / "golden" / "impact_exact.json"
TOLERANCE = 1e-11
"""Of the metric itself, and of a trajectory's own peak on [0, 60 ms]."""
GRADIENT_TARGET = TARGET.with_name("impact_gradients.json")
GRADIENTS = 24
GRADIENT_TOLERANCE = 1e-8
HORIZON = 0.2
TIMES = (0.001, 0.01, 0.03, 0.06)
SPAN = 0.06
FAST = 2e4  # 1/s: faster modes would need thousands of panels
LEAST_CROSSING = 1e-4
"""Least slope, times the period over the peak, at which the head acceleration passes through zero.
Below it roundings of the parameters alone move the end of the period by more than the tolerance."""
TRAJECTORIES = (
    "contact_force",
    "head_acceleration",
    "head_position",
    "head_velocity",
    "manipulator_position",
    "manipulator_velocity",
    "compression",
)


def is_well_posed(p: Parameters) -> bool:
    """Say whether the end of the impact period is where it is by more than rounding."""
    impact = Impact(p, exact=False)
    if impact.rate > FAST:
        return False
    end = first_fall(impact, "a", 1.05 * HORIZON)
    if end is None:
        return True
    if abs(end - HORIZON) < 1e-6 or abs(end - 0.003) < 1e-9:
        return False
    peak = Extent(impact, HORIZON).maximum("a")[0]
    return bool(abs(impact.value("a", end, 1)) * end > LEAST_CROSSING * peak)


def draw() -> list[tuple[str, Parameters]]:
    """Return the seeded sets of all families."""
    drawn = []
    for family, (count, make) in FAMILIES.items():
        source = random.Random(f"{SEED} {family}")
        found: list[Parameters] = []
        while len(found) < count:
            p = make(source)
            if is_well_posed(p):
                found.append(p)
        drawn += [(family, p) for p in found]
    return drawn


def plain(value: Any) -> float | None:
    number = float(value)
    return number if math.isfinite(number) else None


def row(case: tuple[str, Parameters]) -> dict[str, Any]:
    """Return one line of the file."""
    family, p = case
    with mp.workdps(DIGITS):
        found = metrics(p, horizon=HORIZON)
        impact = Impact(p)
        states = [impact.state(mpf(t)) for t in TIMES]
        peaks = {name: 0.0 for name in TRAJECTORIES}
        for t in np.linspace(0.0, SPAN, 241):
            for name, value in impact.state(mpf(float(t))).items():
                peaks[name] = max(peaks[name], abs(float(value)))
    return {
        "family": family,
        "root_gap": float(f"{root_gap(p):.3g}"),
        "parameters": list(p),
        "metrics": [plain(found[name]) for name in METRICS],
        "peaks": [float(f"{peaks[name]:.4g}") for name in TRAJECTORIES],
        "states": [[float(state[name]) for name in TRAJECTORIES] for state in states],
    }


def gradient_row(p: Parameters) -> dict[str, Any]:
    """Return the derivatives of every metric, one list per parameter."""
    with mp.workdps(DIGITS):
        derivatives = []
        for k, value in enumerate(p):
            step = mpf(value) * mpf(10) ** -15
            sides = [metrics(p._replace(**{p._fields[k]: mpf(value) + s * step})) for s in (-1, 1)]
            derivatives.append([float((sides[1][name] - sides[0][name]) / (2 * step)) for name in METRICS])
        found = metrics(p)
    return {"parameters": list(p), "metrics": [float(found[name]) for name in METRICS], "derivatives": derivatives}


def draw_smooth() -> list[Parameters]:
    """Return typical sets whose impact period ends and is long enough for every metric, and the nominal one."""
    source = random.Random(f"{SEED} gradients")
    found = [Parameters(9.6, 250.0, 20e3, 4.4, 46.0, 3e3, 24.25e3, 71.9, 1.25, 0.25)]
    while len(found) < GRADIENTS:
        p = FAMILIES["typical"][1](source)
        end = first_fall(Impact(p, exact=False), "a", HORIZON)
        if min(p) > 0.0 and end is not None and end > 0.003:
            found.append(p)
    return found


def write(path: Path, head: dict[str, Any], key: str, rows: list[dict[str, Any]]) -> None:
    lines = ",\n".join(json.dumps(line, allow_nan=False) for line in rows)
    text = json.dumps(head, indent=1)[:-2] + f',\n "{key}": [\n{lines}\n]\n}}\n'
    json.loads(text)
    path.write_text(text, encoding="utf-8")


def main(parts: list[str]) -> None:
    head = {
        "about": "Impacts of a manipulator, foam and head on a neck, evaluated in 50 digits by Taylor series.",
        "made_by": "tests/reference/make_impact_golden.py",
        "seed": SEED,
        "horizon_s": HORIZON,
        "parameter_names": list(Parameters._fields),
        "metric_names": list(METRICS),
    }
    exact = {
        "tolerance": TOLERANCE,
        "tolerance_of": "the metric itself; for states the trajectory's own peak on [0, 60 ms]",
        "null": "an infinite impact period, or an average that the period is too short for",
        "trajectory_names": list(TRAJECTORIES),
        "times_s": list(TIMES),
    }
    gradients = {
        "tolerance": GRADIENT_TOLERANCE,
        "tolerance_of": "the sum over parameters of |derivative times parameter|, over the parameter",
        "derivatives": "one list per parameter, one number per metric",
    }
    with ProcessPoolExecutor(2) as pool:
        if "exact" in parts:
            write(TARGET, head | exact, "cases", list(pool.map(row, draw(), chunksize=10)))
        if "gradients" in parts:
            write(GRADIENT_TARGET, head | gradients, "cases", list(pool.map(gradient_row, draw_smooth())))


if __name__ == "__main__":
    main(sys.argv[1:] or ["exact", "gradients"])
