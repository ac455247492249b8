"""Numbers that the documents print are those that the package computes."""

from __future__ import annotations

import re
import runpy
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


def crossed(recording: Path) -> nav.BatchSummary:
    crossings = scenarios.crossings(datasets.load_pedestrians(recording), runs=24)
    return nav.simulate_batch([crossing.scenario for crossing in crossings], nav.VirtualForceField())


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


@pytest.mark.parametrize("recording", ["zara01", "zara03"])
def test_row_of_a_recording_is_what_is_computed(recording: str, shared: Path) -> None:
    table = crossed(shared / "data" / "pedestrians" / f"{recording}.csv")
    moving = table.contacts_moving > 0
    standing = (table.contacts_standing > 0) & ~moving
    reached = int((table.arrival_time > 0).sum())
    counts = [
        int((table.outcome == "arrived").sum()),
        int(moving.sum()),
        int(standing.sum()),
        reached,
        int((table.entered_active >= 5).sum()),
    ]
    row = f"| {recording} | {' | '.join(map(str, counts))} | {table.min_clearance.min():.2f} |"
    assert row in VALIDATION.splitlines()
    words = f"{reached} reached the goal; {counts[1]} ran into anybody; "
    words += f"in {counts[2]} somebody walked into the standing robot"
    assert f"| robot across {recording}, 24 busiest start times | {words} |" in README.splitlines()
