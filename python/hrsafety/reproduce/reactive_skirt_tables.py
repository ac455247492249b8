"""Printed numbers of Gussu and Lin (2017) beside the measured ones."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping

import numpy as np

from hrsafety import reactive
from hrsafety._statistics import Share, wilson
from hrsafety.reproduce.cells import Cell, Tolerance
from hrsafety.reproduce.impact_cells import claim, listed, number
from hrsafety.reproduce.published import published_tables
from hrsafety.reproduce.reactive_skirt_study import CLOSELY, CLOSELY_FITTED, CONDITIONS, SkirtStudy, limit_for

__all__ = ["cells", "cells_of_tests"]

SENSORS, STATES, VECTORS, MOTIONS, TESTS = (
    "gussu2017 sensors",
    "gussu2017 Table 1",
    "gussu2017 Table 2",
    "gussu2017 Table 3",
    "gussu2017 Table 4",
)
ANGLE = Tolerance(0.05, relative=False)  # deg, printed with one decimal
LENGTH = Tolerance(0.0005, relative=False)  # m, printed with three decimals
FACTOR = Tolerance(0.005, relative=False)
ORIENTATION = Tolerance(0.0005, relative=False)  # in pi, printed with three decimals
EXACT = Tolerance(1e-12, relative=False)
_PUBLISHED_TESTS = 40
_WORDS = {"spin": "spin", "keep": "arbitrary"}


def cells() -> list[Cell]:
    """Return the cells of the sensors and of Tables 1 to 3."""
    return [*_sensors(), *_states(), *_vectors(), *_motions()]


def cells_of_tests(study: SkirtStudy) -> list[Cell]:
    """Return the cells of Table 4."""
    return [*_published_shares(study), *_conditions(study)]


def _figures() -> dict[str, float]:
    return {row["figure"]: float(row["value"]) for row in published_tables()["gussu2017:text"]["rows"]}


def _sensors() -> Iterator[Cell]:
    printed = _figures()
    spacing = reactive.skirt.skirt_spacing()
    gap = printed["theta"]
    unknown = "L, r and r_1 are not printed; here L = 46 mm (the sensor's board) and r = r_1 = R."
    for column, angle, reason in (
        ("theta of the ring that closes", spacing.closing_gap, ""),
        (
            "theta by (3), a = 0.68",
            spacing.printed_gap,
            f"{unknown} (1) lacks 67.5 deg of the turn, which a N L hides.",
        ),
        ("theta by (5), a = 0.68", spacing.printed_gap_closed, f"{unknown} (5) is (3) with (4)."),
    ):
        measured = math.degrees(angle)
        yield number(
            SENSORS, "Spacing", column, printed=gap, measured=measured, tolerance=ANGLE, unit="deg", reason=reason
        )
    yield number(
        SENSORS,
        "Spacing",
        "a for which (3) closes the ring",
        printed=printed["a"],
        measured=spacing.closing_correction,
        tolerance=FACTOR,
        unit="1",
        reason=f"{unknown} a = 0.68 needs L = 63.5 mm, or r = r_1 = 0.351 m.",
    )
    least = reactive.skirt.least_skirt_sensors(wheel_sensor_radius=0.33, sensor_radius=0.33)
    yield claim(
        SENSORS,
        "Number",
        "least N by (6), r_1 = r",
        printed="9",
        measured=f"{least.least}; the next multiple of three is {least.multiple_of_three}",
        holds=least.multiple_of_three == 9,
    )
    yield from _distances(printed["R_S"])


def _distances(safe_distance: float) -> Iterator[Cell]:
    skirt = reactive.UltrasonicSkirt()
    yield number(
        SENSORS,
        "Safe distance",
        "R_S by Figure 1(b)",
        printed=safe_distance,
        measured=skirt.meeting_distance,
        tolerance=LENGTH,
        unit="m",
        reason="R_S = r/(cos - sin)(22.5 deg) at the largest gap, 45 deg beside a wheel. 0.666 m needs sensors 30 mm "
        "outside the chassis or a gap of 49.0 deg; 2 R is 0.660 m. The tests use the printed value.",
    )
    as_printed = reactive.UltrasonicSkirt(triggering="printed").trigger_distances
    shown = " / ".join(f"{distance:.3f}" for distance in as_printed)
    yield claim(
        SENSORS,
        "Safe distance",
        "readings that trigger sensors 1 to 9",
        printed="an obstacle within R_S",
        measured=f"as printed {shown} m; R - w + cm <= R_S means {skirt.trigger_distances[0]:.3f} m",
        holds=bool(np.ptp(as_printed) < LENGTH.limit),
        reason="d1 to d4 contain - R_S and are compared with R_S sin; d5 to d8 do not. d5 has two different sines.",
    )


def _states() -> Iterator[Cell]:
    for row, own in zip(published_tables()["gussu2017:1"]["rows"], reactive.skirt.skirt_states(), strict=True):
        state = int(row["state"])
        printed, measured = f"{row['sensors']}: {row['action']}", f"{own.pattern}: {_WORDS.get(own.action, own.action)}"
        reason = {
            6: "The printed sensors 5, 6, 7 lie 39.8 deg off the opposite of the north; 6, 7, 8 lie exactly opposite.",
            9: "The present direction is kept.",
        }.get(state, "")
        column = "sensors 9 to 1 (0: obstacle) and action"
        holds = printed == measured
        yield claim(STATES, f"State {state}", column, printed=printed, measured=measured, holds=holds, reason=reason)


def _vectors() -> Iterator[Cell]:
    platform = reactive.skirt.TriOmniKinematics()
    # Column j of the wheel speeds of unit velocities is -t_j / r_w.
    tangents = -platform.wheel_radius * platform.wheel_speeds(np.eye(2)).T
    for row, own in zip(published_tables()["gussu2017:2"]["rows"], tangents, strict=True):
        name = row["vector"]
        yield number(VECTORS, name, "x", printed=row["x"], measured=own[0], tolerance=EXACT, unit="1")
        lost = "The row of y is lost in print; it follows from (14) and from the rolling of the wheels."
        yield listed(VECTORS, name, "y", printed="lost", measured=f"{own[1]:+.4f}", unit="1", reason=lost)
    speeds = platform.wheel_speeds([[0.3 * math.cos(angle), 0.3 * math.sin(angle)] for angle in _angles()])
    rates = platform.body_velocity(np.abs(speeds))[1]
    yield claim(
        VECTORS,
        "Algorithm 1",
        "motion with magnitudes of the wheel speeds",
        printed="the right direction of rotation",
        measured=f"yaw rate {rates.min():.2f} to {rates.max():.2f} rad/s where none is wanted, at 0.3 m/s",
        holds=bool(np.abs(rates).max() < 1e-12),
        reason="The sign of each wheel speed has to be sent, too.",
    )


def _angles() -> list[float]:
    return list(reactive.skirt.MOTION_DIRECTIONS.values())


def _motions() -> Iterator[Cell]:
    for row in published_tables()["gussu2017:3"]["rows"]:
        name, printed = row["motion"], float(row["orientation_pi"])
        # Angles are given between -pi/2 and 3 pi/2, as printed.
        measured = reactive.skirt.MOTION_DIRECTIONS[name] / math.pi
        reason = (
            "North-west is the mirror of north-east, as the south-west is of the south-east." if name == "NW" else ""
        )
        yield number(
            MOTIONS,
            f"V_{name}",
            "orientation",
            printed=printed,
            measured=measured,
            tolerance=ORIENTATION,
            unit="pi",
            reason=reason,
        )
        signal = row["signal"]
        sensors = _triggering_sensors(name)
        yield claim(
            MOTIONS,
            f"V_{name}",
            "triggering signal and its sensors",
            printed=signal,
            measured=f"sensor {' and '.join(map(str, sensors))}",
            holds=name not in _SIGNALS_OFF,
            reason=_SIGNALS_OFF.get(name, ""),
        )


_SIGNALS_OFF: Mapping[str, str] = {
    "W": "d3 belongs to sensor 3 in the north; the east has sensor 5, d5 <= d5', the mirror of the row of V_E.",
    "S": "l3 = (cm[0] - cm[1]) cos is no distance; used is R - w + min(cm[1], cm[2]) <= R_S, the mirror of y.",
    "E": "d8 is printed with cm[7]; its sensor 9 is cm[8].",
}


def _triggering_sensors(direction: str) -> list[int]:
    """Return the sensors that, triggered alone, cause a motion."""
    skirt = reactive.UltrasonicSkirt()
    readings = np.full((9, 9), skirt.most_range)
    np.fill_diagonal(readings, 0.2)
    return [place + 1 for place, row in enumerate(readings) if skirt.action(row) == direction]


# ---- Table 4 ----------------------------------------------------------------------------------------


def _shown(share: Share) -> str:
    return f"{100 * share.value:.1f} % [{100 * share.low:.1f}, {100 * share.high:.1f}]"


def _published_shares(study: SkirtStudy) -> Iterator[Cell]:
    (row,) = published_tables()["gussu2017:4"]["rows"]
    printed = float(row["completely_avoids"])
    of_40 = wilson(round(printed * _PUBLISHED_TESTS), _PUBLISHED_TESTS)
    names = list(CONDITIONS)
    ideal, low = (study.tests[name] for name in names[:2])
    limits = [limit_for(test, printed) for test in (ideal, low)]
    for name, test, limit in ((names[0], ideal, CLOSELY), (names[1], low, CLOSELY_FITTED)):
        shares = test.shares(limit)
        fitted = limit == CLOSELY_FITTED
        yield claim(
            TESTS,
            name,
            f'completely avoids, "closely" below {limit:.2f} m',
            printed=f"{100 * printed:.1f} %, 31 of 40 tests [{100 * of_40.low:.1f}, {100 * of_40.high:.1f}]",
            measured=_shown(shares.completely_avoids),
            holds=shares.completely_avoids.low <= of_40.high and shares.completely_avoids.high >= of_40.low,
            reason=(
                "Limit and share of low discs are fitted, so this is no confirmation."
                if fitted
                else 'The source gives no limit of "closely", and says that some obstacles were below the sensors.'
            ),
        )
        yield claim(
            TESTS,
            name,
            "collides",
            printed=f"less than {100 * (1 - float(row['no_collision_at_least'])):.0f} %",
            measured=_shown(shares.collides),
            holds=shares.collides.high < 1.0 - float(row["no_collision_at_least"]),
        )
    yield listed(
        TESTS,
        "Limit",
        'limit of "closely" at which 77.5 % avoid completely',
        printed="not given",
        measured=f"{limits[0]:.3f} m ({names[0]}), {limits[1]:.3f} m ({names[1]})",
        unit="",
        reason="The share falls steeply with the limit; the curve is drawn below.",
    )


def _conditions(study: SkirtStudy) -> Iterator[Cell]:
    for name, words in list(CONDITIONS.items())[2:]:
        shares = study.tests[name].shares(CLOSELY)
        yield listed(
            TESTS,
            name,
            'avoids completely / "closely" below 0.10 m / collides',
            printed="not given",
            measured=" / ".join(_shown(share) for share in shares),
            unit="",
            reason=f"{words[0].upper()}{words[1:]}; {study.tests[name].min_clearance.size} tests, 95 % intervals.",
        )
