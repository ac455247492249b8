"""Numbers that the documents print are those that the package computes."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

import measure_stabilizing
from hrsafety import io, scenarios
from hrsafety import navigation as nav
from measure_shares import SENSINGS
from page_tables import written

REPOSITORY = Path(__file__).resolve().parents[2]
VALIDATION = (REPOSITORY / "docs" / "validation.md").read_text(encoding="utf-8")
MEASURED = (REPOSITORY / "docs" / "measured.md").read_text(encoding="utf-8")

GAIN_SETS = {
    "New": nav.VirtualForceField(stabilizing="off"),
    "New*": nav.VirtualForceField(
        attractive_gain=4.3, repulsive_gain=20.3, detour_gain=240.7, gain_ratio=0.68, stabilizing="off"
    ),
}
ROWS = re.findall(
    r"^\| (New\*?), ([cn]\d) \| (.+?) \(.*?\) \| (.+?) \(.*?\) \| (.+?) \(.*?\) \|$", VALIDATION, re.MULTILINE
)


def crossed(recording: Path, measurement: nav.Measurement | None) -> nav.RunTable:
    crossings = scenarios.crossings(io.load_people(recording), runs=24)
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


def test_measured_numbers_print_the_arrival_times_of_the_validation() -> None:
    times = [time for gains, name, time, *_ in ROWS if gains == "New" and name.startswith("c")]
    line = next(line for line in MEASURED.splitlines() if line.startswith("| arrival times of c1 to c4"))
    assert re.findall(r"(\d+\.\d+) \(", line) == times


@pytest.mark.evidence
def test_tables_of_the_stabilizing_modes_are_what_is_computed() -> None:
    assert written(VALIDATION, measure_stabilizing.MARKS) == measure_stabilizing.page()


def sensed_cells(sized: bool) -> dict[str, list[str]]:
    """Return the cells of a table of contacts with each sensing, by the title of the row."""
    tables = written(VALIDATION, measure_stabilizing.SENSING_MARKS).strip().split("\n\n")
    rows = [row.strip("| ").split(" | ") for row in tables[2 * sized + 1].splitlines()[2:]]
    return {row[0].replace("\\|", "|"): row[2:] for row in rows}


@pytest.mark.parametrize("sized", [False, True])
def test_contacts_of_the_stabilizing_modes_have_every_sensing(sized: bool) -> None:
    rows = sensed_cells(sized)
    found = measure_stabilizing
    assert len(rows) == len(found.EXPERIMENTS) * len(found.GAINS) * len(found.MODES)
    assert all(len(cells) == len(SENSINGS) for cells in rows.values())


@pytest.mark.evidence
@pytest.mark.parametrize("sized", [False, True])
@pytest.mark.parametrize("sensing", SENSINGS)
@pytest.mark.parametrize(("name", "body"), [("c2", "people"), ("c3", "people and robot"), ("crowds of 3", "people")])
def test_contacts_with_a_sensing_are_what_is_computed(name: str, body: str, sensing: str, sized: bool) -> None:
    column = list(SENSINGS).index(sensing)
    rows = sensed_cells(sized)
    for (gains, mode), cell in measure_stabilizing.contact_cells(name, body, sensing, sized).items():
        title = f"{name}, {body} measured, {measure_stabilizing.GAINS[gains]}, {mode}"
        assert rows[title][column] == cell


def test_text_quotes_the_contacts_with_a_delay() -> None:
    of_source, sized = sensed_cells(sized=False), sensed_cells(sized=True)
    people = {title: cells[2] for title, cells in sized.items() if "people measured" in title}
    assert {part.split()[0] for cell in people.values() for part in cell.split("; ")[:2]} == {"0.0"}
    words = "moves toward somebody in {:.1f} to {:.1f} % of the crowds of 12, "
    words += "and is touched while it retreats in {:.1f} to {:.1f} %"
    crowds = [of_source[title][2].split("; ") for title in people if title.startswith("crowds of 12")]
    toward, away = ([float(cell[part].split()[0]) for cell in crowds] for part in (0, 1))
    assert words.format(min(toward), max(toward), min(away), max(away)) in " ".join(VALIDATION.split())
    for gains, words in (("New*", "in {:.1f} to {:.1f} % of the runs"), ("New", "in up to {1:.1f} %")):
        titles = [f"c3, people and robot measured, {gains}, {mode}" for mode in measure_stabilizing.MODES]
        narrow = [float(sized[title][2].split()[0]) for title in titles]
        assert words.format(min(narrow), max(narrow)) in " ".join(VALIDATION.split())
        assert {of_source[title][2].split()[0] for title in titles} == {"0.0"}


def counts(table: nav.RunTable) -> list[int]:
    moving = table.contacts_moving > 0
    standing = (table.contacts_standing > 0) & ~moving
    columns = (table.outcome == "arrived", moving, standing, table.arrival_time > 0, table.entered_active >= 5)
    return [int(column.sum()) for column in columns]


@pytest.mark.evidence
@pytest.mark.parametrize("recording", ["zara01", "zara03"])
def test_rows_of_a_recording_are_what_is_computed(recording: str, shared: Path) -> None:
    shown = ("exact", "25 mm noise", "25 mm noise, 0.1 s delay")
    for (name, measurement), sensing in zip(SENSINGS.items(), shown, strict=True):
        table = crossed(shared / "data" / "pedestrians" / f"{recording}.csv", measurement)
        found = counts(table)
        cells = [*map(str, found), f"{table.min_clearance.min():.2f}"]
        assert f"| {recording}, {name} | {' | '.join(cells)} |" in VALIDATION.splitlines()
        _, moving, standing, reached, _ = found
        toward = int((table.contacts_toward > 0).sum())
        away = int(((table.contacts_away > 0) & ~(table.contacts_toward > 0)).sum())
        assert toward + away == moving
        assert f"| {recording} | {sensing} | {reached} | {toward} | {away} | {standing} |" in MEASURED.splitlines()
