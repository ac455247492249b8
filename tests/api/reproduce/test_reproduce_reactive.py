"""The reactive part of the reproduction: every value has its place, its verdict and its reason."""

from __future__ import annotations

import functools
import json
import os
from collections import Counter
from pathlib import Path

import pytest

from api.read_pages import page_of
from hrsafety import reproduce
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.reactive import follower_study as reactive_follower_study
from hrsafety.reproduce.reactive import skirt_figures as reactive_skirt_figures
from hrsafety.reproduce.reactive import sound_study as reactive_sound_study

# Published numbers computed again, and pictures of them drawn.
pytestmark = pytest.mark.evidence

SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[3].parent / "shared"))
PAPERS = ("avi2019", "avi2017", "gussu2017")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    # The page, not its numbers: rates of the follower have tests of their own in thousands of layouts, and places of
    # sounds with all their bursts.
    few = functools.partial(reactive_follower_study.run_study, layouts=100, base_layouts=400)
    heard = functools.partial(reactive_sound_study.measure, runs=20)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(reactive_follower_study, "run_study", few)
        patch.setattr(reactive_sound_study, "measure", heard)
        patch.setattr(reactive_skirt_figures, "STUDY_LAYOUTS", 3)
        return reproduce.run(tmp_path_factory.mktemp("reactive"), only="reactive")


@pytest.fixture(scope="module")
def cells(run: Path) -> list[PrintedValue]:
    return [PrintedValue(**row) for row in json.loads((run.parent / "tables.json").read_text(encoding="utf-8"))]


def test_published_shares_equal_the_specification() -> None:
    source = SHARED / "spec" / "published_tables.json"
    if not source.is_file():
        pytest.skip(f"needs the specification's tables: {source}")
    original = json.loads(source.read_text(encoding="utf-8"))
    assert reproduce.published_tables()["gussu2017:4"] == original["gussu2017:4"]


def test_every_cell_has_its_own_place_and_names_its_paper(cells: list[PrintedValue]) -> None:
    twice = [place for place, count in Counter((c.table, c.row, c.column) for c in cells).items() if count > 1]
    assert not twice
    assert {cell.table.split()[0] for cell in cells} <= set(PAPERS)


def test_cells_that_are_off_or_not_judged_say_why(cells: list[PrintedValue]) -> None:
    assert not [(cell.table, cell.row, cell.column) for cell in cells if not cell.within and not cell.reason]


def test_verdicts_follow_from_printed_and_measured(cells: list[PrintedValue]) -> None:
    judged = [cell for cell in cells if cell.tolerance is not None]
    assert judged
    for cell in judged:
        assert isinstance(cell.measured, float)
        assert isinstance(cell.printed, float)
        off = cell.measured - cell.printed
        deviation = off / cell.printed if cell.relative else off
        assert cell.deviation == pytest.approx(deviation)
        assert cell.within is (abs(deviation) <= cell.tolerance + 1e-9)  # type: ignore[operator]  # not None here


def test_tables_of_the_skirt_are_complete(cells: list[PrintedValue]) -> None:
    own = Counter(cell.table for cell in cells if cell.table.startswith("gussu2017"))
    expected = {"sensors": 7, "Table 1": 10, "Table 2": 7, "Table 3": 16, "Table 4": 12}
    assert own == {f"gussu2017 {name}": count for name, count in expected.items()}


def test_known_misprints_of_the_skirt_are_off_and_nothing_else(cells: list[PrintedValue]) -> None:
    off = {(cell.table.removeprefix("gussu2017 "), cell.row) for cell in cells if cell.within is False}
    own = {place for place in off if place[0] in {"Table 1", "Table 2", "Table 3"}}
    tables = {"Table 1": ["State 6"], "Table 2": ["Algorithm 1"], "Table 3": ["V_S", "V_W", "V_E", "V_NW"]}
    assert own == {(table, row) for table, rows in tables.items() for row in rows}


def test_page_is_whole_and_shows_every_table_and_picture(run: Path, cells: list[PrintedValue]) -> None:
    text = run.read_text(encoding="utf-8")
    page_of(text)
    for table in {cell.table for cell in cells}:
        assert f'id="table-{table.replace(" ", "-")}"' in text
    pictures = sorted(path.stem for path in (run.parent / "figures").glob("*.png"))
    assert {"skirt-ring", "skirt-runs", "skirt-clearances", "skirt-sensor-counts"} <= set(pictures)
    assert all(f'<figure id="{name}">' in text for name in pictures)
    assert "http://" not in text.replace("http://www.w3.org", "")
