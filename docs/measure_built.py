"""Print what noise does to the virtual force field, or write it into the guide on robots as built.

``python docs/measure_built.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/built.md; ``--only sensing`` makes the last table alone. The hysteresis of the
recommendation was chosen on the seeds 0 to 199; here are others.
"""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.navigation.metrics import Share, compare_paired, wilson

PAGE = Path(__file__).resolve().parent / "guides" / "built.md"
MARKS = ("<!-- tables of measure_built.py begin -->\n", "<!-- tables of measure_built.py end -->\n")
SENSING_MARKS = ("<!-- sensing of measure_built.py begin -->\n", "<!-- sensing of measure_built.py end -->\n")
SENSINGS: dict[str, nav.Measurement | None] = {
    "exact": None,
    "±25 mm": nav.Measurement(scale=0.025, of="both"),
    "±25 mm, 0.1 s late": nav.Measurement(scale=0.025, of="both", latency=0.1),
}
SEEDS = range(1000, 2000)
CROWD_SEEDS = range(1000, 2000)
PEOPLE = 10
ERRORS = {
    "±25 mm": {"scale": 0.025, "distribution": "uniform"},
    "mean 4 mm": {"scale": 0.0032, "distribution": "gaussian"},
}
BODIES = {"obstacles": "person", "robot": "robot", "both": "both"}
SIDES: dict[str, float | None] = {"afresh": None, "kept beyond 3.0": 3.0, "kept beyond 3.05": 3.05}
GAINS = {"New": (3.0, 20.0, 17.0, 0.25), "New*": (4.3, 20.3, 240.7, 0.68)}

Table = dict[str, nav.BatchSummary]


def law(gains: str, side: float | None, stabilizing: str = "capped") -> nav.VirtualForceField:
    """Return the field with gains and a rule for its sides."""
    values = dict(zip(nav.VirtualForceField.GAIN_NAMES, GAINS[gains], strict=True))
    return nav.VirtualForceField(**values, stabilizing=stabilizing, side_hysteresis=side)


def shares(outcomes: Sequence[str]) -> tuple[Share, Share]:
    """Return the shares of runs that arrived without a contact, and of runs with one."""
    words = list(outcomes)
    return wilson(words.count("arrived"), len(words)), wilson(words.count("collided"), len(words))


def cell(outcomes: Sequence[str]) -> str:
    """Return success and contact in percent, each with its interval."""
    return "; ".join(f"{100 * s.value:.1f} ({100 * s.low:.1f}-{100 * s.high:.1f})" for s in shares(outcomes))


def noisy_scenes(name: str, error: str, of: str) -> list[nav.Scenario]:
    """Return a configuration with every seed."""
    measurement = nav.Measurement(**ERRORS[error], of=of)
    exact = replace(scenarios.configuration(name), measurement=measurement)
    return [replace(exact, seed=seed) for seed in SEEDS]


def configurations(gains: str, stabilizing: str) -> list[str]:
    """Return the table of the configurations for one gain set."""
    lines = [f"| {gains}, stabilizing force {stabilizing} | {' | '.join(SIDES)} |", "|---|" + "---|" * len(SIDES)]
    for name in ("c1", "c2", "c3", "c4"):
        for error in ERRORS:
            for of, body in BODIES.items():
                if of != "robot" and name in ("c1", "c3"):
                    continue  # nothing moves there: the positions of what stands are known
                scenes = noisy_scenes(name, error, of)
                cells = [
                    cell(nav.simulate_batch(scenes, law(gains, side, stabilizing)).outcome.tolist())
                    for side in SIDES.values()
                ]
                lines.append(f"| {name}, {error}, {body} | {' | '.join(cells)} |")
    return [*lines, ""]


def crowds() -> list[str]:
    """Return the table of random crowds with both measured to 25 mm."""
    measurement = nav.Measurement(**ERRORS["±25 mm"], of="both")
    scenes = [
        replace(scenarios.random_crowd(PEOPLE, seed=seed), measurement=measurement, seed=seed) for seed in CROWD_SEEDS
    ]
    tables = {name: nav.simulate_batch(scenes, law("New", side)) for name, side in SIDES.items()}
    touched = {name: table.contacts_moving > 0 for name, table in tables.items()}
    lines = [
        "| side | success; contact (%) | contact while moving (%) | only this / only afresh, p |",
        "|---|---|---|---|",
    ]
    for name, table in tables.items():
        moving = wilson(int(touched[name].sum()), len(touched[name]))
        paired = compare_paired(touched[name], touched["afresh"])
        versus = "" if name == "afresh" else f"{paired.only_first} / {paired.only_second}, {paired.p_value:.2g}"
        share = f"{100 * moving.value:.1f} ({100 * moving.low:.1f}-{100 * moving.high:.1f})"
        lines.append(f"| {name} | {cell(table.outcome.tolist())} | {share} | {versus} |")
    return [*lines, ""]


def cameras() -> list[str]:
    """Return the table of the holonomic robot as built, with two estimators and two rules."""
    error = nav.sensing.PositionNoise(distribution="gaussian", scale=0.0032)
    estimators = {"differences": nav.sensing.Differences(), "Kalman filter": nav.sensing.Kalman()}
    rules = {name: SIDES[name] for name in ("afresh", "kept beyond 3.05")}
    columns = [f"{estimator}, {side}" for estimator in estimators for side in rules]
    lines = [f"| | {' | '.join(columns)} |", "|---|" + "---|" * len(columns)]
    for name in ("c1", "c2", "c3", "c4"):
        cells = []
        for estimator in estimators.values():
            camera = nav.sensing.Vision(error=error, estimator=estimator)
            built = nav.robots.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS, robot_vision=camera, obstacle_vision=camera)
            for side in rules.values():
                runs = nav.metrics.repeat(scenarios.configuration(name), law("New", side), seeds=SEEDS, built=built)
                cells.append(cell(runs.outcome.tolist()))
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return [*lines, ""]


def page() -> str:
    """Return the tables."""
    lines = [
        f"Success, then contact, in percent of {len(SEEDS)} seeds, each with its 95 % Wilson interval. In c1 and c3 "
        "nothing moves, so only the robot's position can be noisy.",
        "",
    ]
    for gains in GAINS:
        for mode in ("capped", "off"):
            lines += configurations(gains, mode)
    lines += [
        "The holonomic robot as built: wheels with controllers, and a camera with 16.7 frames per second and a mean "
        "error of 4 mm for robot and person; gains New, stabilizing force capped:",
        "",
        *cameras(),
        f"{len(CROWD_SEEDS)} random crowds of {PEOPLE} people, robot and people measured to ±25 mm, gains New:",
        "",
        *crowds(),
    ]
    return "\n".join(lines)


def sensing() -> str:
    """Return the table of the crowds with exact, noisy, and noisy and late sensing."""
    lines = [f"| side | {' | '.join(SENSINGS)} |", "|---" * (len(SENSINGS) + 1) + "|"]
    crowd = [scenarios.random_crowd(PEOPLE, seed=seed) for seed in CROWD_SEEDS]
    for name, side in SIDES.items():
        cells = []
        for measurement in SENSINGS.values():
            table = nav.simulate_batch([replace(each, measurement=measurement) for each in crowd], law("New", side))
            moving = table.contacts_moving > 0
            counts = (moving, (table.contacts_standing > 0) & ~moving)
            found = [wilson(int(each.sum()), len(each)) for each in counts]
            cells.append("; ".join(f"{100 * s.value:.1f} ({100 * s.low:.1f}-{100 * s.high:.1f})" for s in found))
        lines.append(f"| {name} | {' | '.join(cells)} |")
    return "\n" + "\n".join(lines) + "\n\n"


def main() -> None:
    """Print the tables or write them into the page."""
    parts = {"noise": (MARKS, lambda: f"\n{page()}\n"), "sensing": (SENSING_MARKS, sensing)}
    parser = argparse.ArgumentParser(description="Tables of docs/guides/built.md.")
    parser.add_argument("--only", choices=parts, help="one part instead of both")
    parser.add_argument("--write", action="store_true", help="replace the tables of the page")
    options = parser.parse_args()
    for (begin, end), made in parts.values() if options.only is None else [parts[options.only]]:
        tables = made()
        if not options.write:
            print(tables)
            continue
        before, _, rest = PAGE.read_text(encoding="utf-8").partition(begin)
        PAGE.write_text(before + begin + tables + end + rest.partition(end)[2], encoding="utf-8")


if __name__ == "__main__":
    main()
