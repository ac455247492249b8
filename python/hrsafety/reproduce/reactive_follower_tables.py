"""What the source says of its experiments beside rates over many layouts."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety import reactive
from hrsafety._statistics import Share, wilson
from hrsafety.reactive import FollowerExperiment
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.impact_cells import claim
from hrsafety.reproduce.published import published_tables
from hrsafety.reproduce.reactive_follower_study import KINDS, LAWS, SETTINGS, FollowerStudy

__all__ = ["SECOND", "SECOND_CHANGED", "cells"]

TRACKING, RATES, DIRECTIONS, INFLUENCES, PRINTED = (
    "avi2019 experiment 1",
    "avi2019 experiments 2 and 3",
    "avi2019 directions of the touches",
    "avi2019 influences",
    "avi2019 printed forms",
)
LATERAL = 0.5  # m, how far off the leader's line the follower may be in experiment 1
LEADER = (
    "Input: the leader is a source of sound that moves as it is told; its size is seen by the sonar on request only."
)
BODY = "Input that is not used: the body is a disc of 0.25 m radius here."
UNEXPLAINED = "The 95 % intervals do not overlap; how the other layouts were selected is not said."
SELECTED = "One printed run each; here random layouts that all touch without repulsion."

# Collision rates of a second implementation of the same description in other layouts, and in how many:
# each layout with noise of its own.
SECOND: dict[tuple[str, str], tuple[float, int]] = {
    ("static", "conventional"): (0.120, 4000),
    ("static", "active"): (0.000, 2500),
    ("one_dynamic", "conventional"): (0.583, 6000),
    ("one_dynamic", "active"): (0.287, 5000),
    ("two_dynamic", "conventional"): (0.826, 12000),
    ("two_dynamic", "active"): (0.401, 5000),
}
# The same with one change, to two digits from about 1,000 layouts each.
SECOND_CHANGED: dict[tuple[str, str, str], float] = {
    ("mirrored rear sensors", "one_dynamic", "active"): 0.227,
    ("mirrored rear sensors", "two_dynamic", "active"): 0.254,
    ("speed kept without echo", "static", "conventional"): 0.20,
    ("speed kept without echo", "static", "active"): 0.00,
    ("standoff 0.6 m", "one_dynamic", "conventional"): 0.84,
    ("standoff 0.6 m", "one_dynamic", "active"): 0.51,
    ("standoff 1.2 m", "one_dynamic", "conventional"): 0.35,
    ("standoff 1.2 m", "one_dynamic", "active"): 0.11,
    ("one ray per sensor", "static", "conventional"): 0.80,
    ("one ray per sensor", "static", "active"): 0.33,
    ("one ray per sensor", "one_dynamic", "conventional"): 0.73,
    ("one ray per sensor", "one_dynamic", "active"): 0.62,
    ("one ray per sensor", "two_dynamic", "conventional"): 0.93,
    ("one ray per sensor", "two_dynamic", "active"): 0.84,
    ("virtual velocity reset every step", "static", "conventional"): 0.00,
    ("virtual velocity reset every step", "static", "active"): 0.00,
    ("virtual velocity reset every step", "one_dynamic", "conventional"): 0.37,
    ("virtual velocity reset every step", "one_dynamic", "active"): 0.12,
    ("virtual velocity reset every step", "two_dynamic", "conventional"): 0.39,
    ("virtual velocity reset every step", "two_dynamic", "active"): 0.11,
    ("(15) as printed", "one_dynamic", "active"): 0.98,
    ("(15) as printed", "two_dynamic", "active"): 1.00,
    ("(16) as printed, start at (0, 0)", "one_dynamic", "active"): 0.23,
    ("(16) as printed, start at (-10, -10)", "one_dynamic", "active"): 0.82,
    ("(16) as printed, start at (5, 5)", "one_dynamic", "active"): 0.51,
    ("(19-b) as printed", "static", "active"): 0.99,
    ("(19-b) as printed", "one_dynamic", "active"): 0.70,
    ("(19-b) as printed", "two_dynamic", "active"): 0.85,
}
_NOTES = {
    "with cross-talk": "The beams of neighboring sensors touch but do not overlap: nothing is overheard.",
    "leader visible": "Hardly any touch, because it does not follow: it keeps away from the leader.",
    "speed kept without echo": "A speed from before a gap has no physical ground: the estimate is forgotten.",
    "mirrored rear sensors": "The source leaves sensors at the back to the future.",
}
_WORDS = {
    ("static", "conventional"): "passes both boxes, less smoothly",
    ("static", "active"): "passes both boxes",
    ("one_dynamic", "conventional"): "collides",
    ("one_dynamic", "active"): "avoids the box and follows",
    ("two_dynamic", "conventional"): "collides",
    ("two_dynamic", "active"): "avoids both boxes and follows",
}


def cells(study: FollowerStudy) -> list[Cell]:
    """Return the cells of experiments 1 to 3, and what their rates depend on."""
    return [*_robots(), *_tracking(), *_rates(study), *_directions(study), *_influences(study)]


def _robots() -> Iterator[Cell]:
    robot = reactive.Follower()
    table = published_tables()["avi2019:5-6"]
    leader, row = table["rows"]
    for column, value in leader.items():
        if column != "robot":
            place = {"table": "avi2019 Table 5", "row": "Leader", "column": column.replace("_", " ")}
            yield Cell.listed(**place, printed=value, unit=table["units"][column], reason=LEADER)
    for column in ("wheel_radius", "width", "length", "height"):
        place = {"table": "avi2019 Table 6", "row": "Follower", "column": column.replace("_", " ")}
        yield Cell.listed(**place, printed=row[column], unit=table["units"][column], reason=BODY)
    for column, printed, own in (
        ("mass", row["mass"], robot.mass),
        ("distance of the wheels", row["wheel_base"], robot.wheel_base),
    ):
        yield claim(
            "avi2019 Table 6", "Follower", column, printed=f"{printed}", measured=f"{own}", holds=printed == own
        )


def _tracking() -> Iterator[Cell]:
    found = reactive.experiment("tracking", "off", layouts=1000)
    ends = sorted(found.source_distance)
    yield claim(
        TRACKING,
        "Following without obstacles",
        "distance from the source at the end",
        printed="follows the source; no number",
        measured=f"follows in {_shown(found.following_rate)}; median {ends[500]:.2f} m, 95 % from {ends[25]:.2f} to "
        f"{ends[975]:.2f} m",
        holds=found.following_rate.low > 0.95,
        reason="Standoff 0.9 m is not in the source. The robot never goes back: once too near it stays there.",
    )


def _shown(share: Share) -> str:
    return f"{share.value:.3f} ({share.low:.3f} to {share.high:.3f})"


def _rates(study: FollowerStudy) -> Iterator[Cell]:
    for kind in KINDS:
        for law in LAWS:
            found = study.base[kind, law]
            rate = found.collision_rate
            collides = "collides" in _WORDS[kind, law]
            yield claim(
                RATES,
                SETTINGS[kind],
                f"{law}: share with a contact",
                printed=_WORDS[kind, law],
                measured=f"{_shown(rate)}; follows in {_shown(found.following_rate)}",
                holds=rate.low > 0.5 if collides else rate.high < 0.05,
                reason=f"{SELECTED} {_second(rate, kind, law)}",
            )
        pair = reactive.follower.compare_experiments(study.base[kind, "conventional"], study.base[kind, "active"])
        change = pair.difference
        yield claim(
            RATES,
            SETTINGS[kind],
            "conventional minus active, same layouts",
            printed="the active law avoids better",
            measured=f"{change.value:.3f} ({change.low:.3f} to {change.high:.3f}); only the conventional law touches "
            f"in {pair.collisions.only_first}, only the active law in {pair.collisions.only_second} layouts, "
            f"p = {pair.collisions.p_value:.1g}",
            holds=change.low > 0.0,
            reason="Bootstrap interval over the layouts, exact McNemar test.",
        )


def _second(rate: Share, kind: str, law: str) -> str:
    value, runs = SECOND[kind, law]
    other = wilson(round(runs * value), runs)
    verdict = "the 95 % intervals of both samples overlap"
    if not _overlap(rate, other):
        verdict = "the 95 % intervals of both samples do not overlap"
    return (
        f"A second implementation has {value:.3f} ({other.low:.3f} to {other.high:.3f}, {runs:,} layouts): {verdict}."
    )


def _directions(study: FollowerStudy) -> Iterator[Cell]:
    for kind in KINDS:
        for law in LAWS:
            found = study.base[kind, law]
            shares = {name: found.collision_rate_from(name) for name in ("front", "left", "right", "rear")}
            off = found.collision_rate.count - shares["front"].count
            yield claim(
                DIRECTIONS,
                SETTINGS[kind],
                law,
                printed="sensors at the back are missing",
                measured="; ".join(f"{name} {_shown(share)}" for name, share in shares.items()),
                holds=off >= shares["front"].count,
                reason=f"{off} of {found.collision_rate.count} touches lie more than 45 deg off the front.",
            )


def _influences(study: FollowerStudy) -> Iterator[Cell]:
    for name, runs in study.found.items():
        if name == "as specified":
            continue
        table = PRINTED if "as printed" in name or name.startswith("(20)") else INFLUENCES
        for (kind, law), found in runs.items():
            yield _influence(study, table, name, (kind, law), found)


def _influence(study: FollowerStudy, table: str, name: str, place: tuple[str, str], found: FollowerExperiment) -> Cell:
    kind, law = place
    value = SECOND_CHANGED.get((name, kind, law))
    rate, base = found.collision_rate, study.base[kind, law].collision_rate
    return claim(
        table,
        name,
        f"{SETTINGS[kind]}, {law}",
        printed="-" if value is None else f"second implementation {value:.2f}",
        measured=f"{_shown(rate)}; without the change {base.value:.3f}",
        holds=value is None or _agrees(rate, value),
        reason=_NOTES.get(name, "") if value is None or _agrees(rate, value) else UNEXPLAINED,
    )


def _agrees(rate: Share, value: float) -> bool:
    """Whether the 95 % intervals of both samples overlap; the other one has two digits of about 1,000 runs."""
    return _overlap(rate, wilson(round(1000 * value), 1000))


def _overlap(one: Share, other: Share) -> bool:
    return one.low <= other.high and one.high >= other.low
