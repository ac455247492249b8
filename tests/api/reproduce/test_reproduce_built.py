"""Rows of the two-wheel robot and of the experiments, and the pictures of both robots."""

from __future__ import annotations

import math

import pytest

from hrsafety import navigation as nav
from hrsafety.reproduce import tables
from hrsafety.reproduce.built import figures as built_figures
from hrsafety.reproduce.built import runs as built_runs
from hrsafety.reproduce.built import tables as built_tables
from hrsafety.reproduce.cells import PrintedValue

STATIONARY = 0.06  # relative: distances to single stationary obstacles


@pytest.fixture(scope="module")
def chapter_7() -> list[PrintedValue]:
    return tables.chapter_7()


@pytest.mark.parametrize("name", ["n1", "n2", "n3", "n4"])
def test_two_wheel_rows_arrive_without_a_contact(name: str) -> None:
    row = built_runs.two_wheels(name)
    assert row.arrived
    assert not row.contact
    assert row.scenario.robot == nav.DifferentialDriveRobot()


def test_two_wheel_rows_stand_beside_every_printed_number(chapter_7: list[PrintedValue]) -> None:
    rows = [cell for cell in chapter_7 if cell.row == "nonholonomic" and cell.table.startswith("7.")]
    assert len(rows) == 4 + 4 + 5 + 6
    assert all(isinstance(cell.measured, float) and math.isfinite(cell.measured) for cell in rows)
    assert all(cell.reason for cell in rows if not cell.within)
    # Distances to what stands, where no person moves the way.
    still = [cell for cell in rows if cell.table in {"7.1", "7.3"} and cell.column.startswith("d_")]
    assert all(cell.deviation is not None and abs(cell.deviation) <= STATIONARY for cell in still)


def test_free_run_of_the_two_wheel_robot_takes_the_energy_that_the_printed_scores_imply() -> None:
    # H = (T*/T + H_D + L*/L)/3 solved for L* with the printed T, L, d and H of Tables 7.1 to 7.3.
    implied = []
    for name, time, energy, total, shares in (
        ("n1", 8.2, 5.9, 0.46, [(0.43 - 0.3) / (0.65 - 0.3)]),
        ("n2", 10.8, 14.5, 0.26, [(0.85 - 0.6) / (2.5 - 0.6)]),
        ("n3", 11.2, 4.3, 0.51, [(0.35 - 0.2) / (0.55 - 0.2), (0.56 - 0.3) / (0.65 - 0.3)]),
    ):
        free = 5.6  # s at 0.7 m/s
        implied.append(energy * (3.0 * total - free / time - sum(shares) / len(shares)))
        assert built_runs.two_wheels(name).nominal_energy == pytest.approx(implied[-1], rel=0.06)


def test_three_obstacles_are_passed_outside_their_critical_regions() -> None:
    cells = list(built_tables.multiple_obstacles())
    assert cells[0].within is True
    assert {cell.column for cell in cells[1:]} >= {"T_arrive", "meets person", "leaves disc", "meets robot"}
    assert all(cell.reason for cell in cells[1:])


@pytest.mark.parametrize("table", built_runs.EXPERIMENTS)
def test_experiments_stand_beside_noisy_runs(table: str) -> None:
    found = built_runs.experiment(table)
    assert found.success.runs == built_runs.SEEDS
    assert found.success.count > built_runs.SEEDS // 2
    assert 0.0 < found.values["H"] < 1.0
    # Feedback and noise cost energy that ideal wheels with exact sensing do not lose.
    name = built_runs.EXPERIMENTS[table]
    assert found.values["L_energy"] > nav.evaluate(built_runs.scene(name), built_runs.LAW).trajectory.energy


def test_pictures_have_names_of_their_own_and_captions_that_are_sentences() -> None:
    drawings = list(built_figures._pictures())
    assert len({name for name, _, _ in drawings}) == len(drawings) == 16
    assert all(caption.endswith(".") for _, caption, _ in drawings)
