"""What the guide to robots as built says follows from the tables beside it."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

import measure_built
from hrsafety import navigation as nav
from hrsafety import scenarios
from page_tables import written

GUIDE = (Path(__file__).resolve().parents[2] / "docs" / "guides" / "built.md").read_text(encoding="utf-8")
WORDS = " ".join(GUIDE.split())
MEASURED = (Path(__file__).resolve().parents[2] / "docs" / "measured.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| (c\d), (\w+), (.+?) \| (\w+) \| (.+) \|$", re.MULTILINE)
TABLE = re.compile(r"^\| (New\*?), stabilizing force (\w+) \|.*\n\|[-|]+\n((?:\|.*\n)+)", re.MULTILINE)
SENSINGS = [name for name in measure_built.SENSINGS if name != "exact"]
LATE, LATE_SIZED = SENSINGS[2], SENSINGS[4]
Key = tuple[str, str, str, str, str]


def successes() -> dict[Key, dict[str, float]]:
    """Return the percentage of successes by gains, mode, configuration, sensing and body, then by side."""
    found: dict[Key, dict[str, float]] = {}
    for gains, mode, rows in TABLE.findall(GUIDE):
        for name, body, side, exact, cells in ROW.findall(rows):
            assert exact == "arrived"
            for sensing, cell in zip(SENSINGS, cells.split(" | "), strict=True):
                key = (gains, mode, name, sensing, body)
                found.setdefault(key, {})[side.removeprefix("kept beyond ")] = float(cell.split()[0])
    return found


def test_all_conditions_are_in_the_tables() -> None:
    # c2 and c4 with three noisy bodies, c1 and c3 with the robot only; five sensings, two gain sets, two modes.
    assert len(successes()) == (2 * 3 + 2) * 5 * 4
    assert {tuple(row) for row in successes().values()} == {("afresh", "3.0", "3.05")}


def test_recommended_side_loses_nothing_with_the_default_gains() -> None:
    rows = [row for key, row in successes().items() if key[0] == "New" and key[3] in SENSINGS[:2]]
    assert all(row["3.05"] >= row["afresh"] for row in rows)
    assert min(row["3.05"] for row in rows) >= 97.0


def test_text_quotes_the_table() -> None:
    rows = successes()
    coarse = [rows["New", "capped", "c2", "±25 mm", body] for body in ("person", "both")]
    fine = [rows["New", "capped", "c2", "mean 4 mm", body] for body in ("person", "both")]
    assert {round(row["afresh"]) for row in coarse} <= {31, 32}
    assert sorted(row["3.05"] for row in coarse) == [98.6, 99.5]
    assert "98.6 to 99.5 %" in GUIDE
    assert {round(row["afresh"]) for row in fine} == {89, 90}
    assert {row["3.05"] for row in fine} == {100.0}
    worst = min(
        rows["New", "capped", "c4", error, body]["3.0"]
        for error in ("±25 mm", "mean 4 mm")
        for body in ("both", "person")
    )
    assert 78.0 < worst < 80.0


def test_optimized_gains_pay_in_configuration_4() -> None:
    rows = {key[3:]: row for key, row in successes().items() if key[:3] == ("New*", "capped", "c4")}
    assert all(row["3.05"] <= row["afresh"] for (sensing, _), row in rows.items() if sensing in SENSINGS[:2])
    assert rows[LATE_SIZED, "person"]["3.05"] > rows[LATE_SIZED, "person"]["afresh"] + 40.0


def test_text_quotes_what_a_delay_does() -> None:
    rows = successes()
    late = {body: rows["New", "capped", "c2", LATE, body]["3.05"] for body in ("person", "both")}
    assert f"stays at {late['person']} % where only the person is measured, and falls to {late['both']} %" in WORDS
    sized = {key[2:]: row["3.05"] for key, row in rows.items() if key[:2] == ("New", "capped") and "sized" in key[3]}
    assert sized["c2", LATE_SIZED, "both"] == 100.0
    assert sized.pop(("c3", LATE_SIZED, "robot")) == 0.0
    assert f"arrives in {min(sized.values())} % or more with regions for the sensing" in WORDS


CAMERA_ROWS = {
    row[:3]: row[3:] for row in re.findall(r"^\| (c\d), ([\w ]+), ([\w .]+) \| (\w+) \| (.+) \|$", GUIDE, re.M)
}


def test_cameras_have_every_sensing_and_the_text_quotes_them() -> None:
    rows = {key: row for key, row in CAMERA_ROWS.items() if key[1] in measure_built.ESTIMATORS}
    assert len(rows) == 4 * 2 * 2
    assert all(exact == "arrived" and len(cells.split(" | ")) == 3 for exact, cells in rows.values())
    late = {key[1:]: cells.split(" | ")[2].split()[0] for key, (_, cells) in rows.items() if key[0] == "c2"}
    both, neither = late["Kalman filter", "kept beyond 3.05"], late["differences", "afresh"]
    assert f"the Kalman filter and the kept side: {both} % instead of {neither} % with neither" in WORDS


@pytest.mark.evidence
@pytest.mark.parametrize("sensing", [LATE, LATE_SIZED])
@pytest.mark.parametrize(("name", "body"), [("c2", "both"), ("c3", "robot")])
def test_row_of_a_late_robot_is_what_is_computed(name: str, body: str, sensing: str) -> None:
    scenes = measure_built.SENSINGS[sensing].scenes(name, body)
    found = nav.simulate_batch(scenes, measure_built.law("New", 3.05)).outcome.tolist()
    (table,) = [rows for gains, mode, rows in TABLE.findall(GUIDE) if (gains, mode) == ("New", "capped")]
    (row,) = [line for line in table.splitlines() if line.startswith(f"| {name}, {body}, kept beyond 3.05 |")]
    assert row.strip("| ").split(" | ")[2 + SENSINGS.index(sensing)] == measure_built.cell(found)


@pytest.mark.evidence
def test_crowds_have_every_sensing_and_some_are_what_is_computed() -> None:
    shares = written(GUIDE, measure_built.CROWD_MARKS).split("\n\n")[1].splitlines()
    titles = shares[0].strip("| ").split(" | ")[1:]
    assert titles == [
        "exact",
        "±25 mm",
        "±25 mm, 0.1 s late",
        *(f"{name}, sized" for name in ("exact", *SENSINGS[1:3])),
    ]
    (row,) = [line for line in shares if line.startswith("| kept beyond 3.05 |")]
    tables = measure_built.crowd_tables(measure_built.Sensing(measure_built.LATE, sized=True))
    cell = row.strip("| ").split(" | ")[-1]
    assert cell == measure_built.shares(tables["kept beyond 3.05"])


def test_regions_for_a_late_robot_are_as_much_larger_as_the_text_says() -> None:
    exact = scenarios.configuration("c3")
    late = measure_built.sized_for_sensing(replace(exact, measurement=replace(measure_built.LATE, of="robot")))
    critical, active = (
        {f"{getattr(after, name) - getattr(before, name):.2f}" for before, after in zip(*pairs, strict=True)}
        for name, pairs in ((each, (exact.obstacles, late.obstacles)) for each in ("critical_radius", "active_radius"))
    )
    assert (critical, active) == ({"0.11"}, {"0.21"})
    assert "regions of rectangle and disc 0.11 m and the active ones 0.21 m larger" in WORDS


def test_measured_numbers_print_the_successes_with_every_sensing() -> None:
    rows = successes()
    found = [rows["New", "capped", "c2", SENSINGS[place], "person"] for place in (1, 2, 4)]
    start = "| c2, successes without and with the side kept"
    (line,) = [line for line in MEASURED.splitlines() if line.startswith(start)]
    shown = "; ".join(f"{row['afresh']}, {row['3.05']} %" for row in found)
    assert line.endswith(f"| {shown} |")
