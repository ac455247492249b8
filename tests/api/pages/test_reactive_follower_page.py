"""The follower's part of the page, in few layouts."""

from __future__ import annotations

import pytest

pytest.importorskip("matplotlib")

from hrsafety.reproduce.reactive import follower_figures as reactive_follower_figures
from hrsafety.reproduce.reactive import follower_study as reactive_follower_study
from hrsafety.reproduce.reactive import follower_tables as reactive_follower_tables
from hrsafety.reproduce.reactive.follower_study import KINDS, LAWS, FollowerStudy

LAYOUTS, BASE_LAYOUTS = 25, 60


@pytest.fixture(scope="module")
def study() -> FollowerStudy:
    return reactive_follower_study.run_study(layouts=LAYOUTS, base_layouts=BASE_LAYOUTS)


def test_every_variant_is_run_where_it_is_to_be(study: FollowerStudy) -> None:
    for name, variant in reactive_follower_study.variants().items():
        assert set(study.found[name]) == {(kind, law) for kind in variant.kinds for law in variant.laws}
    assert set(study.base) == {(kind, law) for kind in KINDS for law in LAWS}
    for name, runs in study.found.items():
        number = BASE_LAYOUTS if name == "as specified" else LAYOUTS
        assert all(len(found) == number for found in runs.values())


def test_variants_differ_from_each_other() -> None:
    seen = list(reactive_follower_study.variants().values())
    assert all(seen.count(each) == 1 for each in seen)


def test_every_known_rate_has_a_cell(study: FollowerStudy) -> None:
    cells = reactive_follower_tables.cells(study)
    for value, runs in reactive_follower_tables.SECOND.values():
        assert [cell for cell in cells if f"has {value:.3f} (" in cell.reason and f"{runs:,} layouts" in cell.reason]
    changed = reactive_follower_tables.SECOND_CHANGED
    rates = {(name, place): value for name, values in changed.items() for place, value in values.items()}
    assert len(rates) == 28
    for (name, where), value in rates.items():
        kind, _, law = where.rpartition("_")
        place = (name, f"{reactive_follower_study.SETTINGS[kind]}, {law}")
        found = [cell for cell in cells if (cell.row, cell.column) == place]
        assert f"{value:.2f}" in str(found[0].printed)
    assert all(cell.reason for cell in cells if cell.within is False)


def test_pictures_are_pngs(study: FollowerStudy) -> None:
    pictures = reactive_follower_figures.make(study)
    assert len({picture.name for picture in pictures}) == len(pictures) == 6
    assert all(picture.png.startswith(b"\x89PNG") for picture in pictures)
