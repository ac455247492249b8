"""Parameters of the published impacts, read from the shipped tables."""

from __future__ import annotations

from functools import cache
from typing import Any

from hrsafety import impact
from hrsafety._records import dataclass
from hrsafety.reproduce.published import printed_rows

__all__ = [
    "CLOSING_SPEED",
    "FOAM_OF_FIGURES",
    "HEAD_SPEED",
    "LEVER_ARM",
    "MANIPULATOR_SPEED",
    "ParameterSet",
    "foam",
    "manipulator",
    "parameter_sets",
    "printed_metrics",
    "published_lever_arm",
    "simulations",
]

KILO = 1000.0
CLOSING_SPEED = 1.25
"""Fastest impact of the source in m/s: a person at 1.0 m/s, a manipulator at 0.25 m/s."""
MANIPULATOR_SPEED, HEAD_SPEED = 0.25, -1.0
STANDARD_GRAVITY = 9.80665
FOAM_OF_FIGURES = impact.Foam(stiffness=24250.0, damping=71.9)
"""Foam 1 as measured in appendix A, used for Figs. 3.10 to 3.12, 3.16 and 3.17."""
LEVER_ARM = {1: 0.4, 2: 0.5}
"""Length at whose end a manipulator moves at 0.25 m/s in Fig. 3.16, in m."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ParameterSet:
    """One reading of the foam parameters behind Tables 4.1 and 4.2.

    Attributes
    ----------
    name : str
        A or B.
    words : str
        What is read how.
    direct_drive : dict of float to Foam
        Foams of Table 4.1 by their printed stiffness in kN/m.
    puma : Foam
        Foam of Table 4.2.
    gravity : float
        m/s^2 in one g.
    """

    name: str
    words: str
    direct_drive: dict[float, impact.Foam]
    puma: impact.Foam
    gravity: float


@cache
def parameter_sets() -> tuple[ParameterSet, ParameterSet]:
    """Return the two readings: as printed, and as measured in appendix A."""
    soft = {13.8: impact.Foam(stiffness=13800.0, damping=43.8)}
    printed = ParameterSet(
        name="A",
        words="foams as printed in Table 4.1 and 3.3 (24.3 kN/m with 71.1 or 71.9 N s/m, 13.8 kN/m), g = 9.80665 m/s^2",
        direct_drive={24.3: impact.Foam(stiffness=24300.0, damping=71.1), **soft},
        puma=foam(1),
        gravity=STANDARD_GRAVITY,
    )
    measured = ParameterSet(
        name="B",
        words="foams as measured in appendix A (24.25 kN/m with 71.9 N s/m, 13.48 kN/m), g = 9.81 m/s^2",
        direct_drive={24.3: FOAM_OF_FIGURES, 13.8: impact.Foam(stiffness=13480.0, damping=43.8)},
        puma=FOAM_OF_FIGURES,
        gravity=9.81,
    )
    return printed, measured


def manipulator(number: int, **changes: float) -> impact.Manipulator:
    """Return a manipulator of Table 3.1, with changes."""
    row = _row("3.1", "manipulator", number)
    values: dict[str, Any] = {"mass": row["M_r"], "damping": row["C_r"], "stiffness": KILO * row["K_r"]}
    return impact.Manipulator(**(values | changes))


def published_lever_arm(number: int) -> float:
    """Return the distance in m at which Table 3.1 gives a manipulator."""
    return float(_row("3.1", "manipulator", number)["l_1"])


def foam(number: int) -> impact.Foam:
    """Return a foam of Table 3.3."""
    row = _row("3.3", "foam", number)
    return impact.Foam(stiffness=KILO * row["K_c"], damping=row["C_c"])


def simulations() -> dict[int, tuple[impact.Manipulator, impact.Head]]:
    """Return manipulator and head of the four simulations of Table 3.2."""
    return {
        row["simulation"]: (
            manipulator(row["manipulator"]),
            impact.Head(mass=row["M_h"], damping=row["C_h"], stiffness=KILO * row["K_h"]),
        )
        for row in printed_rows("3.2")
    }


def _row(table: str, key: str, number: int) -> dict[str, Any]:
    (row,) = (row for row in printed_rows(table) if row[key] == number)
    return row


def printed_metrics(arm: impact.Manipulator, head: impact.Head) -> impact.ImpactMetrics:
    """Return the peaks that the printed coefficient q_2 of (3.5.14) gives with the foam of the figures."""
    run = impact.simulate(arm, FOAM_OF_FIGURES, head, closing_speed=CLOSING_SPEED, equations="as_printed")
    return run.metrics
