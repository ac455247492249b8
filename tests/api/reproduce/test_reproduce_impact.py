"""The impact part of the reproduction: every printed value has its cell, its verdict and its reason."""

from __future__ import annotations

import csv
import json
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

from api.read_pages import page_of
from hrsafety import reproduce
from hrsafety.reproduce import views
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.impact import appendix as impact_appendix
from hrsafety.reproduce.impact import cases as impact_cases
from hrsafety.reproduce.impact import experiments as impact_experiments
from hrsafety.reproduce.impact import maneuvers as impact_maneuvers
from hrsafety.reproduce.impact import part as impact_part
from hrsafety.reproduce.impact import studies as impact_studies
from hrsafety.reproduce.impact import tables as impact_tables
from hrsafety.reproduce.names import TABLE_TITLES
from hrsafety.reproduce.sheets import Sheet

# Published numbers computed again, and pictures of them drawn.
pytestmark = pytest.mark.evidence

SECTIONS = ("3.6", "3.7", "3.8", "4.3", "4.4", "4.5", "A.1", "A.2", "A.3")
# Figures are compared as rounded in the specification: half a unit of their last digit.
HUNDREDTH = 0.005


@pytest.fixture(scope="module")
def cells() -> list[PrintedValue]:
    return impact_part.cells()


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return reproduce.run(tmp_path_factory.mktemp("impact"), only="impact")


def places(cells: list[PrintedValue]) -> dict[tuple[str, str, str], PrintedValue]:
    return {(cell.table, cell.row, cell.column): cell for cell in cells}


def found(cells: list[PrintedValue], table: str, row: str, column: str) -> float:
    """Return the measured number of the one cell whose row and column begin so."""
    (cell,) = (
        cell for cell in cells if cell.table == table and cell.row.startswith(row) and cell.column.startswith(column)
    )
    assert isinstance(cell.measured, float)
    return cell.measured


# ---- the shipped numbers ----------------------------------------------------------------------------


@pytest.mark.parametrize("section", SECTIONS)
def test_figures_of_a_section_have_names_values_and_units(section: str) -> None:
    rows = reproduce.published_tables()[f"zeng2011:section {section}"]["rows"]
    assert rows
    assert len({row["figure"] for row in rows}) == len(rows)
    for row in rows:
        assert isinstance(row["value"], int | float)
        assert row["unit"]


# ---- cells ------------------------------------------------------------------------------------------


def test_every_cell_has_its_own_place(cells: list[PrintedValue]) -> None:
    twice = [place for place, count in Counter((c.table, c.row, c.column) for c in cells).items() if count > 1]
    assert not twice


def test_every_printed_figure_of_the_text_has_a_cell(cells: list[PrintedValue]) -> None:
    for section in SECTIONS:
        tables = {f"Section {section}", "A.1"} if section == "A.2" else {f"Section {section}"}
        own = [cell.printed for cell in cells if cell.table in tables]
        for row in reproduce.published_tables()[f"zeng2011:section {section}"]["rows"]:
            if row["figure"] in {"voltage_limit", "moving_mass"}:
                continue  # inputs of other cells
            assert float(row["value"]) in own, (section, row["figure"])


def test_every_experiment_and_simulation_of_both_tables_has_its_cells(cells: list[PrintedValue]) -> None:
    for number, rows in (("4.1", 12), ("4.2", 3)):
        own = [cell for cell in cells if cell.table == number]
        assert len(own) == rows * (9 + 6)
        assert sum("run" in cell.column for cell in own) == rows * 9


def test_cells_that_are_off_or_not_judged_say_why(cells: list[PrintedValue]) -> None:
    assert not [(cell.table, cell.row, cell.column) for cell in cells if not cell.within and not cell.reason]


def test_verdicts_follow_from_printed_and_measured(cells: list[PrintedValue]) -> None:
    judged = [cell for cell in cells if cell.tolerance is not None]
    assert len(judged) > 100
    for cell in judged:
        assert isinstance(cell.measured, float)
        assert isinstance(cell.printed, float)
        off = cell.measured - cell.printed
        deviation = off / cell.printed if cell.relative else off
        assert cell.deviation == pytest.approx(deviation)
        assert cell.tolerance is not None
        assert cell.within is (abs(deviation) <= cell.tolerance + 1e-9)


def test_both_verdicts_occur_so_that_nothing_was_tuned(cells: list[PrintedValue]) -> None:
    verdicts = Counter(cell.within for cell in cells)
    assert verdicts[True] > 100
    assert verdicts[False] > 20


def test_every_table_of_the_part_has_a_title(cells: list[PrintedValue]) -> None:
    assert {cell.table for cell in cells} <= set(TABLE_TITLES)


# ---- what the specification says about section 3.6 to 3.8 -------------------------------------------


@pytest.mark.parametrize(
    ("row", "column", "percent"),
    [
        ("Simulation 2 against 1", "f_c", 18.66),
        ("Simulation 1 against 3", "f_c", 4.93),
        ("Simulation 4 against 2", "f_c", 8.46),
        ("Simulation 2 against 1", "a_h", 11.61),
        ("Simulation 1 against 3", "a_h", -13.92),
        ("Simulation 4 against 2", "a_h", -7.40),
    ],
)
def test_percentages_of_section_3_6_are_those_of_the_right_coefficient(
    cells: list[PrintedValue], row: str, column: str, percent: float
) -> None:
    assert found(cells, "Section 3.6", row, column) == pytest.approx(percent, abs=HUNDREDTH)


@pytest.mark.parametrize(
    ("row", "column", "percent"),
    [
        ("Manipulator speeding up", "f_c", 4.68),
        ("Manipulator slowing down", "f_c", -4.41),
        ("Manipulator speeding up", "a_h", 3.97),
        ("Manipulator slowing down", "a_h", -3.77),
    ],
)
def test_percentages_of_section_3_8_need_the_feed_forward(
    cells: list[PrintedValue], row: str, column: str, percent: float
) -> None:
    assert found(cells, "Section 3.8", row, column) == pytest.approx(percent, abs=HUNDREDTH)


@pytest.mark.parametrize(
    ("name", "quantity", "percent"),
    [
        ("speeding up", "peak_contact_force", 0.899),
        ("slowing down", "peak_contact_force", -0.861),
        ("speeding up", "peak_head_acceleration", 0.634),
        ("slowing down", "peak_head_acceleration", -0.615),
    ],
)
def test_without_feed_forward_the_maneuvers_hardly_matter(name: str, quantity: str, percent: float) -> None:
    runs = impact_maneuvers.maneuvers(feed_forward=False)
    base, own = (getattr(runs[key].metrics, quantity) for key in ("constant speed", name))
    assert 100.0 * (own / base - 1.0) == pytest.approx(percent, abs=0.0005)


def test_stop_after_detection_lowers_what_comes_after_the_peak() -> None:
    runs = impact_maneuvers.stops()
    late = {name: run.contact_force[run.time > 0.04].max() for name, run in runs.items()}
    assert late["stop, fed forward"] < 0.85 * late["no stop"]
    assert late["stop, position control alone"] < 0.85 * late["no stop"]


def test_printed_coefficient_is_nearer_to_most_percentages_of_section_3_6(cells: list[PrintedValue]) -> None:
    cases = impact_cases.simulations()
    nearer = 0
    for first, second in ((2, 1), (1, 3), (4, 2)):
        peaks = [impact_cases.printed_metrics(*cases[key]) for key in (first, second)]
        for column, old in (
            ("f_c", peaks[0].peak_contact_force / peaks[1].peak_contact_force),
            ("a_h", peaks[0].peak_head_acceleration / peaks[1].peak_head_acceleration),
        ):
            cell = next(
                cell
                for cell in cells
                if cell.row == f"Simulation {first} against {second}" and cell.column.startswith(column)
            )
            assert isinstance(cell.printed, float)
            nearer += abs(100.0 * (old - 1.0) - cell.printed) < abs(cell.deviation or 0.0)
    assert nearer >= 4


def test_worst_point_of_the_light_arm_is_close_to_its_joint() -> None:
    arm = np.arange(0.002, 0.4, 0.001)
    assert arm[np.argmax(impact_studies.along_arm(1, arm))] == pytest.approx(0.010, abs=0.0005)


def test_foams_are_classified_as_the_specification_says(cells: list[PrintedValue]) -> None:
    words = {(cell.row, cell.column.split()[0]): str(cell.measured) for cell in cells if cell.table == "Section 3.9"}
    assert words["Foam 1 on Manipulator 1", "lower"].startswith("above")
    assert words["Foam 1 on Manipulator 2", "upper"].startswith("below")
    assert words["Foam 2 on Manipulator 1", "lower"] == "above: 19.992 mm"
    assert words["Foam 2 on Manipulator 2", "lower"].startswith("below: 24.05") or words[
        "Foam 2 on Manipulator 2", "lower"
    ].startswith("below: 24.04")
    assert words["Foam 3 on Manipulator 1", "upper"] == "above: 10.06 g"
    assert words["Foam 3 on Manipulator 2", "upper"] == "above: 11.55 g"


# ---- chapter 4 and appendix A -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("row", "choice", "acceleration", "period", "compression"),
    [
        ("Foam 1, K_r 20 kN/m, C_r 250 N s/m, v_r 0.4,", "A", 2.106, 0.0332, 0.00384),
        ("Foam 1, K_r 20 kN/m, C_r 250 N s/m, v_r 0.25,", "B", 6.566, 0.0332, 0.01198),
        ("Foam 1, K_r 10 kN/m, C_r 250 N s/m, v_r 0.25,", "A", 6.566, 0.0324, 0.01194),
        ("Foam 2, K_r 20 kN/m, C_r 250 N s/m, v_r 0.25,", "B", 4.855, 0.0437, 0.01694),
        ("Foam 2, K_r 20 kN/m, C_r 500 N s/m, v_r 0.25,", "A", 5.015, 0.0445, 0.01720),
        ("Puma 560, Foam 1, v_r 0.4,", "B", 2.381, 0.0349, 0.00443),
        ("Puma 560, Foam 1, v_r 0.25,", "A", 7.451, 0.0349, 0.01382),
    ],
)
def test_rows_of_the_tables_have_the_digits_of_the_specification(
    row: str, choice: str, acceleration: float, period: float, compression: float
) -> None:
    (own,) = (each for each in impact_tables.experiments() if each.name.startswith(row))
    values = own.simulated[choice]
    assert values["a_h_max"] == pytest.approx(acceleration, abs=0.0005)
    assert values["impact_period"] == pytest.approx(period, abs=0.00005)
    assert values["compression_max"] == pytest.approx(compression, abs=0.000005)


def test_errors_of_the_printed_simulations_are_those_of_the_specification(cells: list[PrintedValue]) -> None:
    for section, expected in (("4.3", (6.2, 2.3, 25.8, 7.2)), ("4.4", (9.8, 6.9, 11.9, 8.3))):
        own = [cell.measured for cell in cells if cell.table == f"Section {section}" and "error" in cell.column]
        assert own == [pytest.approx(value, abs=0.05) for value in expected]


def test_puma_claims_are_ratios_of_simulations_not_of_experiments(cells: list[PrintedValue]) -> None:
    own = [cell for cell in cells if cell.row.startswith("Puma 560 against")]
    assert [cell.measured for cell in own] == [pytest.approx(v, abs=0.05) for v in (17.6, 12.5, 20.5, 16.1)]
    for cell, experiment in zip(own, ("+11.0", "+10.8", "+22.4", "+14.2"), strict=True):
        assert f"experiments give {experiment} %" in cell.reason


def test_seven_measured_accelerations_exceed_the_prediction(cells: list[PrintedValue]) -> None:
    cell = places(cells)["Section 4.5", "Both manipulators", "a_h,max of the runs"]
    assert "in 7 of 45 runs" in str(cell.measured)
    assert cell.within is False


def test_gains_are_shown_with_the_printed_and_the_right_constants(cells: list[PrintedValue]) -> None:
    gain = places(cells)["Section A.2", "Gains for 20 kN/m and 250 N s/m", "K_p"]
    assert gain.measured == pytest.approx(433.488, abs=0.0005)
    assert "448.7" in gain.reason
    assert found(cells, "Section A.2", "Gains", "K_d") == pytest.approx(5.39045, abs=5e-6)
    assert found(cells, "A.1", "Regression", "K_t") == pytest.approx(0.27121, abs=5e-6)


def test_direct_drive_saturates(cells: list[PrintedValue]) -> None:
    cell = places(cells)["Section A.2", "5 V at the impact point, v_c 1.25 m/s", "force of the joint"]
    assert str(cell.measured).startswith("17.4 N available, 256.5 N asked for")
    assert set(impact_appendix.drives()) == {"printed", "right"}


def test_a_claim_that_does_not_hold_would_be_shown() -> None:
    cell = Sheet("chapter_3").claim("far_end", holds=False, place=0.2)
    assert cell.within is False
    (line,) = views.view("Section 3.7", [cell]).lines
    assert (line.within, line.values[1]) == (False, ("largest at l_1 = 0.20 m of 0.50 m", True))
    assert len(impact_experiments.cells()) > 20


# ---- the page ---------------------------------------------------------------------------------------


def test_page_is_whole_and_its_links_lead_somewhere(run: Path) -> None:
    page = page_of(run)
    assert page.images >= 19
    assert {link.removeprefix("#") for link in page.links} <= set(page.ids)


def test_page_shows_every_figure_of_chapters_3_and_4(run: Path) -> None:
    names = " ".join(path.name for path in (run.parent / "figures").glob("*.png"))
    for figure in (*(f"3.{n}" for n in range(10, 20)), "4.3", "4.4", "4.5", "4.6", "4.8", "4.9"):
        assert f"figure-{figure}-" in names, figure


def test_files_beside_the_page_hold_every_cell(run: Path, cells: list[PrintedValue]) -> None:
    with (run.parent / "tables.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(cells) == len(json.loads((run.parent / "tables.json").read_text(encoding="utf-8")))


def test_page_says_how_long_it_took(run: Path) -> None:
    text = run.read_text(encoding="utf-8")
    assert float(text.split("simulations and pictures took ")[1].split(" s.")[0]) > 0.0


def test_page_loads_nothing_from_elsewhere(run: Path) -> None:
    text = run.read_text(encoding="utf-8")
    assert "http" not in text.replace("http-equiv", "")
