"""Own pictures for Figs. 3.10 to 3.19 and 4.3 to 4.9.

The curves of the source are not available as numbers. Its experiments are: the peaks of Tables
4.1 and 4.2 stand as markers on the simulated curves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from hrsafety import impact, plotting
from hrsafety.pages import Picture
from hrsafety.plotting.impacts.boundaries import refined
from hrsafety.reproduce.data import caption
from hrsafety.reproduce.figures import picture
from hrsafety.reproduce.impact.appendix import drives
from hrsafety.reproduce.impact.cases import (
    CLOSING_SPEED,
    FOAM_OF_FIGURES,
    KILO,
    MANIPULATOR_SPEED,
    foam,
    manipulator,
    parameter_sets,
    simulations,
)
from hrsafety.reproduce.impact.maneuvers import maneuvers, stops
from hrsafety.reproduce.impact.studies import along_arm, over_foam, over_mass, over_stiffness
from hrsafety.reproduce.impact.tables import ImpactRow, experiments

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["make"]

LIMIT_G = 10.0
STEP = 1e-4  # s, between drawn points
DURATION = 0.06
DAMPING = np.linspace(0.0, 345.0, 139)
ARMS = {1: "Manipulator 1", 2: "Manipulator 2 (Puma 560)"}

Drawing = tuple[str, str, Callable[[], "Figure"]]


def make() -> list[Picture]:
    """Draw every picture."""
    return [picture(name, caption, draw()) for name, caption, draw in _drawings()]


def _drawings() -> Iterator[Drawing]:
    yield from _head_parameters()
    yield from _studies()
    yield from _maneuvers()
    yield from _boundaries()
    yield from _experiments()
    yield _saturated()


# ---- Figs. 3.10 to 3.12 ---------------------------------------------------------------------------


def _head_parameters() -> Iterator[Drawing]:
    runs = [
        impact.simulate(arm, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED, duration=DURATION, step=STEP)
        for arm, head in simulations().values()
    ]
    labels = [f"Simulation {key}" for key in simulations()]
    yield (
        "figure-3.10-forces",
        caption("figure-3.10-forces"),
        partial(plotting.impact_histories, runs, labels=labels, quantities=["contact_force"], peaks=range(4)),
    )
    yield (
        "figure-3.11-accelerations",
        caption("figure-3.11-accelerations"),
        partial(
            plotting.impact_histories,
            runs,
            labels=labels,
            quantities=["head_acceleration"],
            peaks=[2],
            limits={"head_acceleration": LIMIT_G},
        ),
    )
    pair = [
        impact.simulate(
            manipulator(1), FOAM_OF_FIGURES, head, closing_speed=MANIPULATOR_SPEED, duration=0.05, step=STEP
        )
        for head in (impact.Head.minimum(), impact.ConstrainedHead())
    ]
    yield (
        "figure-3.12-constrained",
        caption("figure-3.12-constrained"),
        partial(
            plotting.impact_histories, pair, labels=["free head", "constrained head"], quantities=["contact_force"]
        ),
    )


# ---- Figs. 3.13 to 3.16 ---------------------------------------------------------------------------


def _studies() -> Iterator[Drawing]:
    mass, stiffness = np.linspace(0.5, 80.0, 160), np.geomspace(1e3, 2e6, 160)
    for name, number, study, values, label, scale in (
        ("mass", "3.13", over_mass, mass, "effective mass (kg)", 1.0),
        ("stiffness", "3.14", over_stiffness, stiffness, "effective stiffness (kN/m)", KILO),
    ):
        curves = {f"Foam {key}": study(foam(key), values) for key in (1, 2, 3)}
        curves["Foam 1, 500 N s/m"] = study(foam(1), values, damping=500.0)
        fixed = "stiffness 20 kN/m" if name == "mass" else "mass 9.6 kg"
        yield (
            f"figure-{number}-{name}",
            caption("effective", name=name, figure=number, fixed=fixed),
            partial(
                plotting.impact_study,
                values / scale,
                curves,
                parameter=label,
                limit=LIMIT_G,
                log_parameter=name == "stiffness",
            ),
        )
    grid = np.geomspace(1e3, 100e3, 160)
    yield (
        "figure-3.15-foam",
        caption("figure-3.15-foam"),
        partial(
            plotting.impact_study,
            grid / KILO,
            {
                f"Manipulator {arm}, ratio {ratio:g}": over_foam(manipulator(arm), grid, ratio)
                for arm in (1, 2)
                for ratio in (0.05, 0.2)
            },
            parameter="foam stiffness (kN/m)",
            limit=LIMIT_G,
        ),
    )
    yield _impact_point()


def _impact_point() -> Drawing:
    share = np.linspace(0.001, 1.0, 400)
    first, second = along_arm(1, 0.4 * share), along_arm(2, 0.5 * share)
    best = int(np.argmax(first))
    return (
        "figure-3.16-impact-point",
        caption("figure-3.16-impact-point"),
        partial(
            plotting.impact_study,
            share,
            {"Manipulator 1": first, "Manipulator 2": second},
            parameter="distance from the joint over length of the arm",
            marks={f"{1000.0 * 0.4 * share[best]:.0f} mm": (float(share[best]), float(first[best]))},
        ),
    )


# ---- Fig. 3.17 and stops --------------------------------------------------------------------------


def _maneuvers() -> Iterator[Drawing]:
    quantities = ["contact_force", "head_acceleration"]
    for name, words, feed_forward in (
        ("with", "whose acceleration is fed forward", True),
        ("without", "that follows by its position control alone", False),
    ):
        runs = maneuvers(feed_forward=feed_forward)
        yield (
            f"figure-3.17-maneuvers-{name}",
            caption("maneuvers", words=words),
            partial(
                plotting.impact_histories, list(runs.values()), labels=list(runs), quantities=quantities, peaks=range(3)
            ),
        )
    runs = stops()
    yield (
        "stop-after-detection",
        caption("stop-after-detection"),
        partial(plotting.impact_histories, list(runs.values()), labels=list(runs), quantities=quantities),
    )


# ---- Figs. 3.18 and 3.19 --------------------------------------------------------------------------


def _boundaries() -> Iterator[Drawing]:
    foams = {f"Foam {key}": foam(key) for key in (1, 2, 3)}
    for arm, words in ARMS.items():
        own = manipulator(arm)
        design = impact.design_foam(own, impact.FoamLimits(), closing_speed=CLOSING_SPEED)
        damping = refined(DAMPING, [design.upper, design.lower])
        yield (
            f"figure-3.{17 + arm}-boundaries",
            caption("boundaries", figure=f"3.{17 + arm}", arm=words),
            partial(
                plotting.foam_boundaries,
                damping,
                design.upper(damping),
                design.lower(damping),
                foams=foams,
                accepted={name: design.accepts(each) for name, each in foams.items()},
                statuses={name: getattr(design.margin(each), "status", "") for name, each in foams.items()},
                results=[design],
                fitting=design.stiffness_range(damping, 0.0),
                upper_label="upper: 10 g",
                lower_label="lower: 20 mm",
            ),
        )


# ---- Figs. 4.3 to 4.9 -----------------------------------------------------------------------------

_SHOWN = (
    ("4.3", "4.1", 1, 0.4),
    ("4.4", "4.1", 2, 0.4),
    ("4.5", "4.1", 1, 1.25),
    ("4.6", "4.1", 2, 1.25),
    ("4.8", "4.2", 1, 0.4),
    ("4.9", "4.2", 1, 1.25),
)


def _experiments() -> Iterator[Drawing]:
    for figure, table, foam_number, speed in _SHOWN:
        rows = [
            row
            for row in experiments()
            if row.table == table
            and row.foam_number == foam_number
            and abs(row.closing_speed - speed) < 1e-9
            and (table == "4.2" or (row.stiffness == 20000.0 and row.damping == 250.0))
        ]
        arm = "direct drive, K_r 20 kN/m, C_r 250 N s/m" if table == "4.1" else "Puma 560"
        runs = sum(len(row.measured["a_h_max"]) for row in rows)
        yield (
            f"figure-{figure}-experiment",
            caption("experiment", figure=figure, foam=foam_number, arm=arm, speed=speed, runs=runs, table=table),
            partial(_with_runs, rows),
        )


def _with_runs(rows: list[ImpactRow]) -> Figure:
    choice, _ = parameter_sets()
    run = impact.simulate(
        rows[0].arm(),
        rows[0].covering(choice),
        impact.Head.apparatus(),
        closing_speed=rows[0].closing_speed,
        manipulator_speed=rows[0].manipulator_speed,
        duration=DURATION,
        step=STEP,
    )

    def every(column: str) -> list[float]:
        return [value for row in rows for value in row.measured[column]]

    return plotting.measured_impact(
        run,
        peak_head_acceleration_g=every("a_h_max"),
        impact_duration=every("impact_period"),
        max_compression=every("compression_max"),
    )


def _saturated() -> Drawing:
    """Return the direct-drive joint with friction and its limit of 5 V beside the linear joint."""
    setting: dict[str, Any] = {
        "closing_speed": CLOSING_SPEED,
        "manipulator_speed": MANIPULATOR_SPEED,
        "duration": DURATION,
        "step": STEP,
    }
    head = impact.Head.apparatus()
    linear = impact.simulate(manipulator(1), FOAM_OF_FIGURES, head, **setting)
    real = impact.joints.simulate_direct_drive(drives()["right"], FOAM_OF_FIGURES, head, **setting)
    return (
        "direct-drive-saturated",
        caption("direct-drive-saturated"),
        partial(
            plotting.impact_histories,
            [linear, real],
            labels=["linear joint", "joint with 5 V limit"],
            quantities=["head_acceleration", "manipulator_velocity"],
        ),
    )
