"""Printed results of the source's experiments beside rates over many layouts."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from hrsafety import reactive
from hrsafety._statistics import Share, wilson
from hrsafety.reactive import FollowerExperiment
from hrsafety.reproduce import data
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.published import published_tables
from hrsafety.reproduce.reactive.follower_study import KINDS, LAWS, SETTINGS, FollowerStudy
from hrsafety.reproduce.sheets import Sheet

__all__ = ["SECOND", "SECOND_CHANGED", "cells"]

INFLUENCES, PRINTED = "avi2019 influences", "avi2019 printed forms"
SHEET = Sheet("reactive")
_DATA = data.table("follower")
SECOND: Mapping[str, tuple[float, int]] = {key: tuple(value) for key, value in _DATA["second"].items()}
"""Shares with a contact of a second implementation, and in how many layouts, by setting and law."""
SECOND_CHANGED: Mapping[str, Mapping[str, float]] = _DATA["changed"]
"""Rates with one change of the model, from about 1,000 layouts each."""


def cells(study: FollowerStudy) -> list[PrintedValue]:
    """Return the cells of experiments 1 to 3, and what their rates depend on, in the order of the source."""
    return [*_robots(), *_tracking(), *_rates(study), *_directions(study), *_influences(study)]


def _robots() -> Iterator[PrintedValue]:
    robot, table = reactive.Follower(), published_tables()["avi2019:5-6"]
    leader, row = table["rows"]
    sizes = {name: row[name] for name in ("wheel_radius", "width", "length", "height")}
    for key, values in (("leader", {name: leader[name] for name in leader if name != "robot"}), ("body", sizes)):
        for name, value in values.items():
            words = {"column": name.replace("_", " "), "unit": table["units"][name]}
            yield SHEET.printed_only(key, printed=value, **words)
    for column, said, own in (
        ("mass", row["mass"], robot.mass),
        ("distance of the wheels", row["wheel_base"], robot.wheel_base),
    ):
        yield SHEET.claim("robot", holds=said == own, column=column, said=said, own=own)


def _tracking() -> Iterator[PrintedValue]:
    found = reactive.experiment("tracking", "off", layouts=1000)
    ends, rate = sorted(found.source_distance), found.following_rate
    numbers = {"median": ends[500], "low": ends[25], "high": ends[975]}
    yield SHEET.claim("tracking", holds=rate.low > 0.95, rate=_shown(rate), **numbers)


def _shown(share: Share) -> str:
    return f"{share.value:.3f} ({share.low:.3f} to {share.high:.3f})"


def _rates(study: FollowerStudy) -> Iterator[PrintedValue]:
    for kind in KINDS:
        for law in LAWS:
            yield _rate(study.base[kind, law], kind, law)
        pair = reactive.follower.compare_experiments(study.base[kind, "conventional"], study.base[kind, "active"])
        better = pair.difference.low > 0.0
        words = {"setting": SETTINGS[kind], "change": pair.difference, "pair": pair.collisions}
        yield SHEET.claim("difference", holds=better, **words)


def _rate(found: FollowerExperiment, kind: str, law: str) -> PrintedValue:
    rate, said = found.collision_rate, _DATA["words"][f"{kind}_{law}"]
    value, runs = SECOND[f"{kind}_{law}"]
    other = wilson(round(runs * value), runs)
    return SHEET.claim(
        "rate",
        holds=rate.low > 0.5 if "collides" in said else rate.high < 0.05,
        setting=SETTINGS[kind],
        law=law,
        said=said,
        rate=_shown(rate),
        follows=_shown(found.following_rate),
        value=value,
        low=other.low,
        high=other.high,
        runs=runs,
        verdict="overlap" if _overlap(rate, other) else "do not overlap",
    )


def _directions(study: FollowerStudy) -> Iterator[PrintedValue]:
    for kind in KINDS:
        for law in LAWS:
            found = study.base[kind, law]
            shares = {name: found.collision_rate_from(name) for name in ("front", "left", "right", "rear")}
            front, count = shares["front"].count, found.collision_rate.count
            listed = "; ".join(f"{name} {_shown(share)}" for name, share in shares.items())
            words = {"setting": SETTINGS[kind], "law": law, "shares": listed, "off": count - front, "count": count}
            yield SHEET.claim("direction", holds=count - front >= front, **words)


def _influences(study: FollowerStudy) -> Iterator[PrintedValue]:
    for name, runs in study.found.items():
        if name != "as specified":
            for (kind, law), found in runs.items():
                yield _influence(study, name, kind, law, found)


def _influence(study: FollowerStudy, name: str, kind: str, law: str, found: FollowerExperiment) -> PrintedValue:
    value = SECOND_CHANGED.get(name, {}).get(f"{kind}_{law}")
    rate, base = found.collision_rate, study.base[kind, law].collision_rate
    # The other one has two digits of about 1,000 runs.
    agrees = value is None or _overlap(rate, wilson(round(1000 * value), 1000))
    return SHEET.claim(
        "influence",
        holds=agrees,
        number=PRINTED if "as printed" in name or name.startswith("(20)") else INFLUENCES,
        row=name,
        setting=SETTINGS[kind],
        law=law,
        rate=_shown(rate),
        base=base.value,
        said="-" if value is None else f"second implementation {value:.2f}",
        why=_DATA["notes"].get(name, "") if agrees else SHEET.text("unexplained"),
    )


def _overlap(one: Share, other: Share) -> bool:
    return one.low <= other.high and one.high >= other.low
