"""Appendix C on the page of the published tables: own search beside the printed optimum, claims, pictures."""

from __future__ import annotations

import json
import math
from pathlib import Path

import pytest

from api.read_pages import page_of
from hrsafety import navigation as nav
from hrsafety import reproduce, scenarios
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.gain import deviations as gain_deviations
from hrsafety.reproduce.gain import tables as gain_tables
from hrsafety.reproduce.gain.runs import CHANGES_PERCENT, GAIN_TABLES, gain_runs

# Published numbers computed again, and pictures of them drawn.
pytestmark = pytest.mark.evidence

REPEATED = 1e-12  # the same operations in another order


@pytest.fixture(scope="module")
def cells() -> list[PrintedValue]:
    return gain_tables.appendix_c()


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return reproduce.run(tmp_path_factory.mktemp("appendix"), only="tables-c").parent


def of(cells: list[PrintedValue], table: str) -> list[PrintedValue]:
    return [cell for cell in cells if cell.table == table]


# ---- Table C.1 --------------------------------------------------------------------------------------


def test_optimum_is_that_of_the_own_search(cells: list[PrintedValue]) -> None:
    search = gain_runs().search
    row = {cell.column: cell for cell in of(cells, "C.1") if cell.row == "new_vff"}
    assert [row[name].measured for name in ("K_1", "K_3", "K_5", "b")] == list(search.best.gains)
    assert row["H_mean"].measured == search.best_value
    assert row["H_mean"].within is True
    assert search.settings.survivors == 500
    assert search.settings.grid == (11, 21, 21, 16)
    assert not search.interrupted


def test_gains_of_the_own_search_say_how_flat_the_optimum_is(cells: list[PrintedValue]) -> None:
    runs = gain_runs()
    for cell in of(cells, "C.1"):
        if cell.row == "new_vff" and cell.column != "H_mean":
            assert cell.within is None
            assert cell.deviation is not None
            assert f"{runs.changed.reference_performance.mean():.4f}" in cell.reason
            assert f"{runs.search.best_value:.4f}" in cell.reason
    at_bound = runs.search.best.gains[2] == 500.0
    (detour,) = (cell for cell in of(cells, "C.1") if (cell.row, cell.column) == ("new_vff", "K_5"))
    assert ("at the bound" in detour.reason) is at_bound


@pytest.mark.parametrize(("law", "where"), [("masoud", ("c1", "c2", "c3")), ("ge_cui", ("c1", "c3", "c4"))])
def test_compared_laws_keep_the_printed_gains(cells: list[PrintedValue], law: str, where: tuple[str, ...]) -> None:
    row = {cell.column: cell for cell in of(cells, "C.1") if cell.row == law}
    assert len(row) >= 4
    for column, cell in row.items():
        if column != "H_mean":
            assert (cell.measured, cell.within) == (None, None)
            assert cell.reason == f"An input, not a result: the runs use {cell.printed:g}."
    places = [scenarios.configuration(name) for name in where]
    scores = nav.simulate_batch(places, nav.Masoud() if law == "masoud" else nav.GeCui()).performance_total
    assert row["H_mean"].measured == pytest.approx(scores.mean(), rel=1e-12)
    assert row["H_mean"].within is (True if law == "masoud" else None)
    assert "not searched anew" in row["H_mean"].reason


# ---- Tables C.2 to C.9 ------------------------------------------------------------------------------


@pytest.mark.parametrize(("gain", "change"), [(0, -50.0), (1, 20.0), (2, 100.0), (3, -10.0)])
def test_tables_show_what_single_runs_give(cells: list[PrintedValue], gain: int, change: float) -> None:
    gains = list(gain_runs().changed.law.gains)
    gains[gain] *= 1.0 + change / 100.0
    law = nav.VirtualForceField(
        **dict(zip(nav.VirtualForceField.GAIN_NAMES, gains, strict=True)),  # type: ignore[arg-type]  # four gains
        stabilizing="off",
    )
    distances, scores = list(GAIN_TABLES.values())[gain]
    row = {(cell.table, cell.column): cell.measured for cell in cells if cell.row == f"{change:+g} %"}
    for place in (1, 2, 3):
        found = nav.evaluate(scenarios.configuration(f"c{place}"), law)
        assert row[distances, f"T_arrive_{place}"] == found.trajectory.arrival_time
        assert row[distances, f"L_energy_{place}"] == found.trajectory.energy
        assert row[scores, f"H_{place}"] == found.total
    # In configuration 3 the rectangle comes first; the source exchanges the heads of the columns.
    assert row[distances, "d_circle_min_3"] == found.trajectory.min_distance[0]
    assert row[distances, "d_rectangle_min_3"] == found.trajectory.min_distance[1]


def test_times_without_obstacles_belong_to_the_gains_of_the_row() -> None:
    runs = gain_runs()
    for gain in range(4):
        for change in (0, 5, 11):
            run = runs.measured(gain, change)[0]
            score = nav.evaluate(
                scenarios.configuration("c1"),
                nav.VirtualForceField(
                    **dict(zip(nav.VirtualForceField.GAIN_NAMES, runs.changed.gains[gain, change], strict=True)),
                    stabilizing="off",
                ),
            )
            assert run.nominal_time == pytest.approx(score.nominal.arrival_time, rel=REPEATED)
            assert run.nominal_energy == pytest.approx(score.nominal.energy, rel=REPEATED)


def test_changes_are_those_of_the_printed_rows(cells: list[PrintedValue]) -> None:
    for distances, scores in GAIN_TABLES.values():
        for table in (distances, scores):
            rows = dict.fromkeys(cell.row for cell in of(cells, table) if cell.row != "-100 %")
            assert [float(row.removesuffix(" %")) for row in rows] == list(CHANGES_PERCENT)


# ---- claims -----------------------------------------------------------------------------------------


def test_claims_that_do_not_hold_say_why(cells: list[PrintedValue]) -> None:
    claims = [*of(cells, "Section C.2"), *of(cells, "Section C.3")]
    assert len(claims) > 25
    assert {cell.within for cell in claims} == {True, False, None}
    assert [cell for cell in claims if not cell.within and not cell.reason] == []
    assert [cell for cell in claims if cell.within and cell.reason] == []


def test_deviations_are_over_all_rows(cells: list[PrintedValue]) -> None:
    found = {(row.configuration, row.quantity): row for row in gain_deviations.deviations(cells)}
    assert len(found) == 9
    assert {key: row.values for key, row in found.items() if key != ("c3", "d")} == dict.fromkeys(
        [key for key in found if key != ("c3", "d")], 48
    )
    assert found["c3", "d"].values == 96
    times = [cell for cell in cells if cell.column == "T_arrive_1"]
    shares = [100.0 * float(cell.deviation or 0.0) for cell in times]
    assert found["c1", "T"].mean == pytest.approx(math.fsum(shares) / 48)
    assert found["c1", "T"].worst == pytest.approx(max(map(abs, shares)))


# ---- the page ---------------------------------------------------------------------------------------


def test_page_has_tables_claims_deviations_and_pictures(folder: Path, cells: list[PrintedValue]) -> None:
    page = page_of(folder / "summary.html")
    names = {"gains-flatness", "gains-history", "gains-sensitivity"}
    assert names | {"tables-c", "table-C.1", "table-Section-C.2", "table-Section-C.3"} <= set(page.ids)
    assert {path.stem for path in (folder / "figures").iterdir()} == names
    text = " ".join(page.texts)
    for cell in [*of(cells, "C.1"), *of(cells, "Section C.2"), *of(cells, "Section C.3")]:
        assert cell.reason in text
        if isinstance(cell.printed, str):
            assert cell.printed in text
    for row in gain_deviations.deviations(cells):
        assert f"{row.mean:+.1f}" in text
    assert "All rows of Tables C.2 to C.9" in text


def test_values_of_the_page_are_those_of_the_cells(folder: Path, cells: list[PrintedValue]) -> None:
    values = json.loads((folder / "tables.json").read_text(encoding="utf-8"))
    assert [value["measured"] for value in values] == [cell.measured for cell in cells]
