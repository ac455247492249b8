"""Numbers that the documents print are those that the package computes."""

from __future__ import annotations

import re
import runpy
from dataclasses import replace
from pathlib import Path

import pytest

from hrsafety import datasets, scenarios
from hrsafety import navigation as nav

REPOSITORY = Path(__file__).resolve().parents[2]
VALIDATION = (REPOSITORY / "docs" / "validation.md").read_text(encoding="utf-8")
README = (REPOSITORY / "README.md").read_text(encoding="utf-8")

GAIN_SETS = {
    "New": nav.VirtualForceField(stabilizing="off"),
    "New*": nav.VirtualForceField(
        attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="off"
    ),
}
ROWS = re.findall(
    r"^\| (New\*?), ([cn]\d) \| (.+?) \(.*?\) \| (.+?) \(.*?\) \| (.+?) \(.*?\) \|$", VALIDATION, re.MULTILINE
)


SENSINGS: dict[str, nav.Measurement | None] = {
    "exact": None,
    "25 mm noise": nav.Measurement(scale=0.025),
    "25 mm noise, 0.1 s late": nav.Measurement(scale=0.025, latency=0.1),
}


def crossed(recording: Path, measurement: nav.Measurement | None) -> nav.BatchSummary:
    crossings = scenarios.crossings(datasets.load_pedestrians(recording), runs=24)
    scenes = [replace(each.scenario, measurement=measurement, seed=seed) for seed, each in enumerate(crossings)]
    return nav.simulate_batch(scenes, nav.VirtualForceField())


@pytest.mark.parametrize(("gains", "name", "time", "distance", "score"), ROWS)
def test_row_of_the_published_configurations_is_what_is_computed(
    gains: str, name: str, time: str, distance: str, score: str
) -> None:
    found = nav.evaluate(scenarios.configuration(name), GAIN_SETS[gains])
    run = found.trajectory
    assert time == f"{run.arrival_time:.2f}"
    assert distance == ", ".join(f"{d:.3f}" for d in run.min_distance)
    assert score == f"{found.total:.2f}"


def test_every_published_configuration_has_a_row() -> None:
    assert len(ROWS) == 12
    assert len({row[:2] for row in ROWS}) == 12


def test_readme_prints_the_arrival_times_of_the_validation() -> None:
    times = [time for gains, name, time, *_ in ROWS if gains == "New" and name.startswith("c")]
    line = next(line for line in README.splitlines() if line.startswith("| arrival times of c1 to c4"))
    assert re.findall(r"(\d+\.\d+) \(", line) == times


def test_tables_of_the_stabilizing_modes_are_what_is_computed() -> None:
    script = runpy.run_path(str(REPOSITORY / "docs" / "measure_stabilizing.py"))
    assert script["written"](VALIDATION) == script["page"]()


def counts(table: nav.BatchSummary) -> list[int]:
    moving = table.contacts_moving > 0
    standing = (table.contacts_standing > 0) & ~moving
    columns = (table.outcome == "arrived", moving, standing, table.arrival_time > 0, table.entered_active >= 5)
    return [int(column.sum()) for column in columns]


@pytest.mark.parametrize(("recording", "title"), [("zara01", "24 busiest start times"), ("zara03", "the same")])
def test_rows_of_a_recording_are_what_is_computed(recording: str, title: str, shared: Path) -> None:
    found = []
    for name, measurement in SENSINGS.items():
        table = crossed(shared / "data" / "pedestrians" / f"{recording}.csv", measurement)
        found.append(counts(table))
        cells = [*map(str, found[-1]), f"{table.min_clearance.min():.2f}"]
        assert f"| {recording}, {name} | {' | '.join(cells)} |" in VALIDATION.splitlines()
    moving, standing = ("; ".join(str(row[column]) for row in found) for column in (1, 2))
    assert {row[3] for row in found} == {24}
    words = f"24 reached the goal each; {moving} ran into somebody; "
    words += f"in {standing} others somebody walked into the standing robot"
    (line,) = [line for line in README.splitlines() if line.startswith(f"| robot across {recording}, {title}")]
    assert line.endswith(f" | {words} |")
