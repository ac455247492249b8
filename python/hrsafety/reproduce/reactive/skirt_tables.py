"""Printed numbers of Gussu and Lin (2017) beside the measured ones."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from hrsafety import reactive
from hrsafety._statistics import Share, wilson
from hrsafety.pages import share_words
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.published import published_tables
from hrsafety.reproduce.reactive.skirt_study import CLOSELY, CLOSELY_FITTED, CONDITIONS, SkirtStudy, limit_for
from hrsafety.reproduce.sheets import Sheet

__all__ = ["cells", "cells_of_tests"]

SHEET = Sheet("reactive")
_PUBLISHED_TESTS = 40
_WORDS = {"spin": "spin", "keep": "arbitrary"}
_SIGNALS_OFF = ("W", "S", "E")


def cells() -> list[PrintedValue]:
    """Return the cells of the sensors and of Tables 1 to 3, in the order of the source."""
    return [*_sensors(), *_states(), *_vectors(), *_motions()]


def cells_of_tests(study: SkirtStudy) -> list[PrintedValue]:
    """Return the cells of Table 4: the two shares of the text, and what they depend on."""
    return [*_published_shares(study), *_conditions(study)]


def _rows(number: str) -> list[dict[str, object]]:
    return list(published_tables()[f"gussu2017:{number}"]["rows"])


def _sensors() -> Iterator[PrintedValue]:
    printed = {str(row["figure"]): float(str(row["value"])) for row in _rows("text")}
    spacing = reactive.skirt.skirt_spacing()
    for column, angle, reason in (
        ("theta of the ring that closes", spacing.closing_gap, "closes"),
        ("theta by (3), a = 0.68", spacing.printed_gap, "spacing_3"),
        ("theta by (5), a = 0.68", spacing.printed_gap_closed, "spacing_5"),
    ):
        why = SHEET.text(reason)
        yield SHEET.number("gap", math.degrees(angle), printed=printed["theta"], column=column, why=why)
    yield SHEET.number("correction", spacing.closing_correction, printed=printed["a"])
    least = reactive.skirt.least_skirt_sensors(wheel_sensor_radius=0.33, sensor_radius=0.33)
    nine = least.multiple_of_three == 9
    yield SHEET.claim("number", holds=nine, least=least.least, multiple=least.multiple_of_three)
    skirt = reactive.UltrasonicSkirt()
    yield SHEET.number("safe_distance", skirt.meeting_distance, printed=printed["R_S"])
    as_printed = reactive.UltrasonicSkirt(triggering="printed").trigger_distances
    yield SHEET.claim(
        "readings",
        holds=bool(np.ptp(as_printed) < SHEET.tolerances["length"].limit),
        shown=" / ".join(f"{distance:.3f}" for distance in as_printed),
        own=skirt.trigger_distances[0],
    )


def _states() -> Iterator[PrintedValue]:
    for row, own in zip(_rows("1"), reactive.skirt.skirt_states(), strict=True):
        said, found = f"{row['sensors']}: {row['action']}", f"{own.pattern}: {_WORDS.get(own.action, own.action)}"
        state = row["state"]
        why = SHEET.text(f"state_{state}") if state in (6, 9) else ""
        yield SHEET.claim("state", holds=said == found, state=state, said=said, own=found, why=why)


def _vectors() -> Iterator[PrintedValue]:
    platform = reactive.skirt.TriOmniKinematics()
    # Column j of the wheel speeds of unit velocities is -t_j / r_w.
    tangents = -platform.wheel_radius * platform.wheel_speeds(np.eye(2)).T
    for row, own in zip(_rows("2"), tangents, strict=True):
        yield SHEET.number("x", own[0], printed=float(str(row["x"])), row=row["vector"])
        yield SHEET.listed("y", row=row["vector"], own=own[1])
    angles = list(reactive.skirt.MOTION_DIRECTIONS.values())
    speeds = platform.wheel_speeds([[0.3 * math.cos(angle), 0.3 * math.sin(angle)] for angle in angles])
    rates = platform.body_velocity(np.abs(speeds))[1]
    still = bool(np.abs(rates).max() < 1e-12)
    yield SHEET.claim("magnitudes", holds=still, least=rates.min(), most=rates.max())


def _motions() -> Iterator[PrintedValue]:
    for row in _rows("3"):
        name, printed = str(row["motion"]), float(str(row["orientation_pi"]))
        # Angles are given between -pi/2 and 3 pi/2, as printed.
        measured = reactive.skirt.MOTION_DIRECTIONS[name] / math.pi
        why = SHEET.text("mirror_NW") if name == "NW" else ""
        yield SHEET.number("orientation", measured, printed=printed, motion=name, why=why)
        off = name in _SIGNALS_OFF
        sensors = " and ".join(map(str, _triggering_sensors(name)))
        why = SHEET.text(f"signal_{name}") if off else ""
        yield SHEET.claim("signal", holds=not off, motion=name, said=row["signal"], sensors=sensors, why=why)


def _triggering_sensors(direction: str) -> list[int]:
    """Return the sensors that, triggered alone, cause a motion."""
    skirt = reactive.UltrasonicSkirt()
    readings = np.full((9, 9), skirt.most_range)
    np.fill_diagonal(readings, 0.2)
    return [place + 1 for place, row in enumerate(readings) if skirt.action(row) == direction]


# ---- Table 4 ----------------------------------------------------------------------------------------


def _shown(share: Share) -> str:
    return share_words(share.value, share.low, share.high)


def _published_shares(study: SkirtStudy) -> Iterator[PrintedValue]:
    (row,) = _rows("4")
    printed, kept = float(str(row["completely_avoids"])), float(str(row["no_collision_at_least"]))
    of_40 = wilson(round(printed * _PUBLISHED_TESTS), _PUBLISHED_TESTS)
    names = list(CONDITIONS)
    ideal, low = (study.tests[name] for name in names[:2])
    for name, test, limit in ((names[0], ideal, CLOSELY), (names[1], low, CLOSELY_FITTED)):
        shares = test.shares(limit)
        avoids = shares.completely_avoids
        yield SHEET.claim(
            "avoids",
            holds=avoids.low <= of_40.high and avoids.high >= of_40.low,
            row=name,
            limit=limit,
            share=_shown(avoids),
            said=f"{100 * printed:.1f} %, 31 of 40 tests [{100 * of_40.low:.1f}, {100 * of_40.high:.1f}]",
            why=SHEET.text("fitted" if limit == CLOSELY_FITTED else "not_fitted"),
        )
        holds, share = shares.collides.high < 1.0 - kept, _shown(shares.collides)
        yield SHEET.claim("collides", holds=holds, row=name, most=100 * (1 - kept), share=share)
    yield SHEET.listed("limit", limits=[limit_for(test, printed) for test in (ideal, low)], names=names)


def _conditions(study: SkirtStudy) -> Iterator[PrintedValue]:
    for name, words in list(CONDITIONS.items())[2:]:
        listed = " / ".join(_shown(share) for share in study.tests[name].shares(CLOSELY))
        tests = study.tests[name].min_clearance.size
        yield SHEET.listed("condition", row=name, shares=listed, words=f"{words[0].upper()}{words[1:]}", tests=tests)
