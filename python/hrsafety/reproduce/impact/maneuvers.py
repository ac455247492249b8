"""Section 3.8: a manipulator that speeds up, slows down or stops during the impact."""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache

import numpy as np

from hrsafety import impact
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact.cases import (
    CLOSING_SPEED,
    FOAM_OF_FIGURES,
    MANIPULATOR_SPEED,
    STANDARD_GRAVITY,
    manipulator,
)
from hrsafety.reproduce.sheets import Sheet

__all__ = ["cells", "maneuvers", "stops"]

SHEET = Sheet("chapter_3")
ACCELERATION = 0.51 * STANDARD_GRAVITY
LASTING = 0.05  # s
DETECTION = 0.004  # s, the published detection time that section 3.6 quotes
DURATION, STEP = 0.06, 1e-4
_NAMES = {"accelerated": "speeding up", "decelerated": "slowing down"}


def _run(set_point: impact.SetPoint) -> impact.ImpactResponse:
    """Return Simulation 3 with a motion of the set-point."""
    return impact.simulate(
        manipulator(1),
        FOAM_OF_FIGURES,
        impact.Head.minimum(),
        closing_speed=CLOSING_SPEED,
        manipulator_speed=MANIPULATOR_SPEED,
        duration=DURATION,
        step=STEP,
        set_point=set_point,
    )


def _accelerated(acceleration: float, *, feed_forward: bool) -> impact.ImpactResponse:
    return _run(impact.SetPoint.accelerating(acceleration, duration=LASTING, feed_forward=feed_forward))


@cache
def maneuvers(*, feed_forward: bool) -> dict[str, impact.ImpactResponse]:
    """Return the impacts of Fig. 3.17."""
    return {
        "constant speed": _run(impact.SetPoint()),
        "speeding up": _accelerated(ACCELERATION, feed_forward=feed_forward),
        "slowing down": _accelerated(-ACCELERATION, feed_forward=feed_forward),
    }


@cache
def stops() -> dict[str, impact.ImpactResponse]:
    """Return the impact without and with a stop after detection."""
    braking = [
        impact.SetPoint.stopping(
            manipulator_speed=MANIPULATOR_SPEED, detection=DETECTION, rest=LASTING, feed_forward=feed_forward
        )
        for feed_forward in (True, False)
    ]
    return {
        "no stop": _run(impact.SetPoint()),
        "stop, fed forward": _run(braking[0]),
        "stop, position control alone": _run(braking[1]),
    }


def cells() -> list[PrintedValue]:
    """Return the cells of section 3.8."""
    return [*_percentages(), *_stopped()]


def _change(run: impact.ImpactResponse, base: impact.ImpactResponse, quantity: str) -> float:
    return 100.0 * (float(getattr(run.metrics, quantity)) / float(getattr(base.metrics, quantity)) - 1.0)


def _percentages() -> Iterator[PrintedValue]:
    fed, alone = maneuvers(feed_forward=True), maneuvers(feed_forward=False)
    for kind, name in _NAMES.items():
        for column, quantity, key in (
            ("f_c,max", "peak_contact_force", "force"),
            ("a_h,max", "peak_head_acceleration", "acceleration"),
        ):
            yield SHEET.number(
                "maneuver",
                _change(fed[name], fed["constant speed"], quantity),
                name=name,
                column=column,
                figure=f"{key}_{kind}",
                without=_change(alone[name], alone["constant speed"], quantity),
            )


def _stopped() -> Iterator[PrintedValue]:
    runs = stops()
    base = runs["no stop"]
    late = {name: float(np.max(run.contact_force[run.time >= 0.04])) for name, run in runs.items()}
    for name in list(runs)[1:]:
        yield SHEET.listed(
            "stop",
            name=name,
            force=_change(runs[name], base, "peak_contact_force"),
            acceleration=_change(runs[name], base, "peak_head_acceleration"),
            late=late[name],
            unstopped=late["no stop"],
        )
