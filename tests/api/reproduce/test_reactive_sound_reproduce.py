"""Tables 1 and 2 of the source of 2019: every printed number beside a measured one, with a reason."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from hrsafety import reproduce
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.reactive import sound_figures as reactive_sound_figures
from hrsafety.reproduce.reactive import sound_study as reactive_sound_study
from hrsafety.reproduce.reactive import sound_tables as reactive_sound_tables

# Published numbers computed again, and pictures of them drawn.
pytestmark = pytest.mark.evidence

PNG = b"\x89PNG\r\n\x1a\n"


@pytest.fixture(scope="module")
def cells() -> dict[tuple[str, str, str], PrintedValue]:
    found = reactive_sound_tables.cells(reactive_sound_study.measure())
    by_place = {(cell.table, cell.row, cell.column): cell for cell in found}
    assert len(by_place) == len(found)
    return by_place


def test_printed_numbers_are_those_of_the_specification(shared: Path) -> None:
    original = json.loads((shared / "spec" / "published_tables.json").read_text(encoding="utf-8"))
    for table in ("avi2019:1", "avi2019:2"):
        assert reproduce.published_tables()[table] == original[table]


@pytest.mark.parametrize(
    ("table", "columns"), [("1", ("jitter", "waveforms", "whole samples")), ("2", ("jitter", "waveforms"))]
)
def test_every_printed_number_stands_beside_measured_ones(
    cells: dict[tuple[str, str, str], PrintedValue], table: str, columns: tuple[str, ...]
) -> None:
    prefix = "measured" if table == "1" else "std"
    for row in reproduce.published_tables()[f"avi2019:{table}"]["rows"]:
        name = f"{row['distance']} m, {row['angle']} deg"
        for kind in ("distance", "angle"):
            for column in columns:
                cell = cells[f"avi2019 Table {table}", name, f"{kind}, {column}"]
                assert cell.printed == row[f"{prefix}_{kind}"]
                assert isinstance(cell.measured, float)


def test_every_deviation_has_a_reason(cells: dict[tuple[str, str, str], PrintedValue]) -> None:
    assert not [place for place, cell in cells.items() if not cell.within and not cell.reason]
    assert any(cell.within for cell in cells.values())
    assert any(cell.within is False for cell in cells.values())


def test_misprinted_formulas_are_shown_wrong(cells: dict[tuple[str, str, str], PrintedValue]) -> None:
    claims = {place: cell for place, cell in cells.items() if "(9)" in place[1] or "(10)" in place[1]}
    assert len(claims) == 4
    assert not any(cell.within for cell in claims.values())


@pytest.mark.parametrize(("angle", "deviation"), [(0, 0.120), (30, 0.159), (60, 0.518)])
def test_scatter_at_three_meters_is_that_of_the_specification(
    cells: dict[tuple[str, str, str], PrintedValue], angle: int, deviation: float
) -> None:
    cell = cells["avi2019 Table 2", f"3 m, {angle} deg", "distance, jitter"]
    assert cell.measured == pytest.approx(deviation, rel=0.02)  # 0.5 % of sampling, more with the tail


def test_means_of_jitter_are_the_places(cells: dict[tuple[str, str, str], PrintedValue]) -> None:
    for place in reactive_sound_study.places():
        found = cells["avi2019 Table 1", place.name, "angle, jitter"].measured
        assert found == pytest.approx(place.angle, abs=0.02)
        # The range goes with the inverse of a curvature: its mean is a little far.
        far = cells["avi2019 Table 1", place.name, "distance, jitter"].measured
        assert 0.0 <= float(far or 0.0) / place.distance - 1.0 + 0.002 < 0.06


def test_study_finds_the_sound_in_every_measurement_up_to_half_the_noise() -> None:
    study = reactive_sound_study.measure()
    for level in reactive_sound_study.LEVELS[:3]:
        assert study.waveforms[level].found.mean() > 0.99
    assert np.isfinite(study.jitter.range).all()


def test_pictures_are_drawn() -> None:
    pictures = reactive_sound_figures.make()
    assert [each.name for each in pictures] == ["sound_burst", "sound_likeness", "sound_fixes"]
    assert all(each.png.startswith(PNG) and each.caption.endswith(".") for each in pictures)
