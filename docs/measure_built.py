"""Print what noise does to the virtual force field, or write it into the guide on robots as built.

``python docs/measure_built.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/built.md; ``--only configurations`` and ``--only crowds`` make one of the two parts, ``--only first`` the
first rows of the page, which are some of its tables. The hysteresis of the recommendation was chosen on the seeds 0 to
199; here are others.
"""

from __future__ import annotations

import functools
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.navigation.metrics import compare_paired
from measure_shares import sized_for_sensing
from page_tables import DOCS, head, line, percent, print_or_write, selected, shares, written

PAGE = DOCS / "guides" / "built.md"
MARKS = "tables of measure_built.py"
CROWD_MARKS = "sensing of measure_built.py"
FIRST_MARKS = "first rows of measure_built.py"
SEEDS = range(1000, 2000)
CROWD_SEEDS = range(1000, 2000)
PEOPLE = 10
BODIES = {"person": "obstacles", "robot": "robot", "both": "both"}
# Where nothing moves the positions of what stands are known.
MEASURED = {"c1": ("robot",), "c2": tuple(BODIES), "c3": ("robot",), "c4": tuple(BODIES)}


@dataclass(frozen=True)
class Sensing:
    """A column: what is measured how, and whether the regions are sized for it."""

    measurement: nav.Measurement | None
    sized: bool = False

    def scenes(self, name: str, body: str) -> list[nav.Scenario]:
        """Return a configuration with every seed, or once without noise."""
        exact = scenarios.configuration(name)
        if self.measurement is None:
            return [exact]
        scene = replace(exact, measurement=replace(self.measurement, of=BODIES[body]))
        if self.sized:
            scene = sized_for_sensing(scene)
        return [replace(scene, seed=seed) for seed in SEEDS]


UNIFORM, LATE = nav.Measurement(scale=0.025), nav.Measurement(scale=0.025, latency=0.1)
SENSINGS = {
    "exact": Sensing(None),
    "mean 4 mm": Sensing(nav.Measurement(scale=0.0032, distribution="gaussian")),
    "±25 mm": Sensing(UNIFORM),
    "±25 mm, 0.1 s late": Sensing(LATE),
    "±25 mm, sized": Sensing(UNIFORM, sized=True),
    "±25 mm, 0.1 s late, sized": Sensing(LATE, sized=True),
}
CAMERAS = {
    "mean 4 mm": nav.sensing.Vision(error=nav.sensing.PositionNoise(distribution="gaussian", scale=0.0032)),
    "±25 mm": nav.sensing.Vision(error=nav.sensing.PositionNoise(distribution="uniform", scale=0.025)),
    "±25 mm, 0.1 s late": nav.sensing.Vision(
        error=nav.sensing.PositionNoise(distribution="uniform", scale=0.025), delay=0.1
    ),
}
ESTIMATORS = {"differences": nav.sensing.Differences(), "Kalman filter": nav.sensing.Kalman()}
SIDES: dict[str, float | None] = {"afresh": None, "kept beyond 3.0": 3.0, "kept beyond 3.05": 3.05}
GAINS = {"New": (3.0, 20.0, 17.0, 0.25), "New*": (4.3, 20.3, 240.7, 0.68)}


def law(gains: str, side: float | None, stabilizing: str = "capped") -> nav.VirtualForceField:
    """Return the field with gains and a rule for its sides."""
    values = dict(zip(nav.VirtualForceField.GAIN_NAMES, GAINS[gains], strict=True))
    return nav.VirtualForceField(**values, stabilizing=stabilizing, side_hysteresis=side)


def cell(outcomes: Sequence[str]) -> str:
    """Return success and contact in percent, each with its interval; of a single run how it ended."""
    words = list(outcomes)
    if len(words) == 1:
        return words[0].replace("_", " ")
    return "; ".join(percent(words.count(word), len(words)) for word in ("arrived", "collided"))


def configurations(gains: str, stabilizing: str) -> Iterator[str]:
    """Yield the table of the configurations for one gain set."""
    yield from head(f"{gains}, stabilizing force {stabilizing}", *SENSINGS)
    for name, bodies in MEASURED.items():
        for body in bodies:
            columns = [sensing.scenes(name, body) for sensing in SENSINGS.values()]
            for side, angle in SIDES.items():
                driver = law(gains, angle, stabilizing)
                cells = [cell(nav.simulate_batch(scenes, driver).outcome.tolist()) for scenes in columns]
                yield line(f"{name}, {body}, {side}", *cells)
    yield ""


def as_built(camera: nav.sensing.Vision | None) -> nav.robots.AsBuilt:
    """Return the holonomic robot with a camera for itself and the person, or that knows both exactly."""
    return nav.robots.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS, robot_vision=camera, obstacle_vision=camera)


def cameras() -> Iterator[str]:
    """Yield the table of the holonomic robot as built, with two estimators and two rules."""
    yield from head("", "exact", *CAMERAS)
    for name in MEASURED:
        exact = scenarios.configuration(name)
        for estimator, filtered in ESTIMATORS.items():
            for side in ("afresh", "kept beyond 3.05"):
                driver = law("New", SIDES[side])
                cells = [cell([nav.simulate(exact, driver, built=as_built(None)).outcome])]
                for camera in CAMERAS.values():
                    built = as_built(replace(camera, estimator=filtered))
                    cells.append(cell(nav.simulate_many(exact, driver, seeds=SEEDS, built=built).outcome.tolist()))
                yield line(f"{name}, {estimator}, {side}", *cells)
    yield ""


def configuration_page() -> str:
    """Return the tables of the configurations."""
    lines = [
        f"Success, then contact, in percent of {len(SEEDS)} seeds, each with its 95 % Wilson interval; without noise "
        "there is one run, and the cell says how it ended. In c1 and c3 nothing moves, so only the robot's position "
        "can be noisy. The regions are those of the source; those of the columns *sized* are larger by what the "
        "sensing adds.",
        "",
    ]
    for gains in GAINS:
        for mode in ("capped", "off"):
            lines += configurations(gains, mode)
    lines += [
        "The holonomic robot as built: wheels with controllers, and a camera with 16.7 frames per second for robot and "
        "person; gains New, stabilizing force capped, regions of the source:",
        "",
        *cameras(),
    ]
    return "\n" + "\n".join(lines) + "\n"


def first() -> str:
    """Return the rows of measured people in c2 and c4 with the default law, from the tables of the page."""
    title = "New, stabilizing force capped"
    parts = written(PAGE.read_text(encoding="utf-8"), MARKS).split("\n\n")
    (table,) = (part for part in parts if part.startswith(f"| {title} |"))
    rows = {f"{name}, {body}, {side}" for name in ("c2", "c4") for body in ("person", "both") for side in SIDES}
    kept = rows - {row for row in rows if row.endswith(" 3.0")}
    columns = (title, "±25 mm", "±25 mm, 0.1 s late", "±25 mm, 0.1 s late, sized")
    return selected(table, lambda row: row[title] in kept, columns).replace(title, "success; contact, %", 1)


# ---- crowds -------------------------------------------------------------------------------------


@functools.lru_cache(maxsize=1)
def crowds() -> tuple[nav.Scenario, ...]:
    """Return the crowds as they are without noise."""
    return tuple(scenarios.random_crowd(PEOPLE, seed=seed) for seed in CROWD_SEEDS)


def crowd_tables(sensing: Sensing) -> dict[str, nav.RunTable]:
    """Return the runs with one sensing of robot and people, by the rule for the side."""
    measurement = None if sensing.measurement is None else replace(sensing.measurement, of="both")
    scenes = [replace(crowd, measurement=measurement) for crowd in crowds()]
    if sensing.sized:
        scenes = [sized_for_sensing(scene) for scene in scenes]
    return {name: nav.simulate_batch(scenes, law("New", side)) for name, side in SIDES.items()}


def compared(table: nav.RunTable, afresh: nav.RunTable) -> str:
    """Return in how many crowds only this side, and only the one decided afresh, moved into somebody."""
    paired = compare_paired(table.contacts_toward > 0, afresh.contacts_toward > 0)
    return f"{paired.only_first} / {paired.only_second}, {paired.p_value:.2g}"


def crowd_page() -> str:
    """Return the tables of the crowds, which arrive and whom they touch."""
    measured = {"exact": None, "±25 mm": UNIFORM, "±25 mm, 0.1 s late": LATE}
    columns = {name: Sensing(each) for name, each in measured.items()}
    columns |= {f"{name}, sized": Sensing(each, sized=True) for name, each in measured.items()}
    runs = {name: crowd_tables(sensing) for name, sensing in columns.items()}
    order = list(columns)
    lines = [
        f"{len(CROWD_SEEDS)} random crowds of {PEOPLE} people, robot and people measured, gains New. Contacts toward "
        "which the robot moves, then others that touch it moving, then only while it stands:",
        "",
        *head("side", *order),
        *(line(side, *(shares(runs[name][side]) for name in order)) for side in SIDES),
        "",
        "Success, then contact:",
        "",
        *head("side", *order),
        *(line(side, *(cell(runs[name][side].outcome.tolist()) for name in order)) for side in SIDES),
        "",
        "Crowds in which only this rule, and only the side decided afresh, moves into somebody, and p of the exact "
        "McNemar test:",
        "",
        *head("side", *order),
        *(
            line(side, *(compared(runs[name][side], runs[name]["afresh"]) for name in order))
            for side in SIDES
            if side != "afresh"
        ),
        "",
    ]
    return "\n" + "\n".join(lines) + "\n"


if __name__ == "__main__":
    tables = {"configurations": (MARKS, configuration_page), "crowds": (CROWD_MARKS, crowd_page)}
    print_or_write(PAGE, {**tables, "first": (FIRST_MARKS, first)})
