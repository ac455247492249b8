"""Every row of the published tables stands on the page, inputs included."""

from __future__ import annotations

import json
import os
import re
from collections.abc import Iterator
from html import unescape
from pathlib import Path

import pytest

pytest.importorskip("matplotlib")
pytest.importorskip("scipy")

from hrsafety import reproduce
from hrsafety.reproduce import page, tables
from hrsafety.reproduce.built import wheels_tables
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.gain import tables as gain_tables
from hrsafety.reproduce.impact import inputs as impact_inputs
from hrsafety.reproduce.impact import part as impact_part
from hrsafety.reproduce.parts import Made
from hrsafety.reproduce.reactive import follower_tables as reactive_follower_tables
from hrsafety.reproduce.reactive import skirt_study as reactive_skirt_study
from hrsafety.reproduce.reactive import skirt_tables as reactive_skirt_tables
from hrsafety.reproduce.reactive import sound_study as reactive_sound_study
from hrsafety.reproduce.reactive import sound_tables as reactive_sound_tables
from hrsafety.reproduce.views import by_table, view

SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[3].parent / "shared"))
# The specification has 203; of five wheels the package ships both directions in place of their mean.
ROWS = 203 + 5
NUMBER = re.compile(r"[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
# Keys that number or name a row in the file; the page has its own words for them.
LABELS = {"manipulator", "simulation", "foam", "method", "change_percent", "note", "robot", "direction", "wheel"}
# Tables of the page that hold the rows of a published table, where they are not of the same number.
PLACES = {
    "avi2019:1": ("avi2019 Table 1",),
    "avi2019:2": ("avi2019 Table 2",),
    "avi2019:5-6": ("avi2019 Table 5", "avi2019 Table 6"),
    "gussu2017:4": ("gussu2017 Table 4",),
}


# Settings of an experiment, which its row names in words.
SETTINGS = {"zeng2011:4.1": {"K_c", "C_c", "K_r", "C_r", "v_r", "v_h"}}


def specified() -> dict[str, list[dict[str, object]]]:
    """Return the rows of every table of the specification, as this package ships them."""
    source = SHARED / "spec" / "published_tables.json"
    if not source.is_file():
        pytest.skip(f"needs the specification's tables: {source}")
    names = [name for name, entry in json.loads(source.read_text(encoding="utf-8")).items() if isinstance(entry, dict)]
    return {name: reproduce.published_tables()[name]["rows"] for name in names}


def numbers(value: object) -> Iterator[float]:
    """Yield every number in a row, however deep."""
    if isinstance(value, dict):
        for key, each in value.items():
            if key not in LABELS:
                yield from numbers(each)
    elif isinstance(value, list):
        for each in value:
            yield from numbers(each)
    elif isinstance(value, int | float):
        yield float(value)


@pytest.fixture(scope="module")
def shown() -> dict[str, set[float]]:
    """Numbers that the page shows, by its tables."""
    impacts = impact_part.cells()
    cells: list[PrintedValue] = [
        *tables.chapter_6(),
        *tables.chapter_7(),
        *tables.unpredictable_human(),
        *gain_tables.appendix_c(),
        *wheels_tables.cells(),
        *reactive_sound_tables.cells(reactive_sound_study.measure()),
        *reactive_follower_tables._robots(),
        *reactive_skirt_tables.cells_of_tests(reactive_skirt_study.run_study(layouts=20)),
    ]
    html = by_anchor(
        page.html(
            page.ReproductionReport(command="", made={"impact": Made(cells=impacts), "wheels": Made(cells=cells)})
        )
    )
    anchors = {table: f"table-{table.replace(' ', '-')}" for table in by_table([*impacts, *cells])}
    words = {table: unescape(re.sub(r"<[^>]*>", " ", html[anchor])) for table, anchor in anchors.items()}
    return {table: {float(each) for each in NUMBER.findall(text)} for table, text in words.items()}


def by_anchor(html: str) -> dict[str, str]:
    """Return what the page shows below the heading of each table."""
    pieces = re.split(r'<h3 id="([^"]+)">', html)
    return dict(zip(pieces[1::2], pieces[2::2], strict=True))


def on_page(value: float, found: set[float]) -> bool:
    """Whether a number is there; shares stand in percent, stiffness of rows in kN/m or N/m."""
    scaled = [value * factor for factor in (1.0, 100.0, 1000.0)]
    return any(abs(each - other) <= 1e-9 * max(1.0, abs(other)) for each in scaled for other in found)


def test_every_published_row_is_on_the_page(shown: dict[str, set[float]]) -> None:
    missing = []
    count = 0
    for name, rows in specified().items():
        places = PLACES.get(name, (name.removeprefix("zeng2011:"),))
        found = set().union(*(shown.get(place, set()) for place in places))
        for row in rows:
            count += 1
            results = {key: each for key, each in row.items() if name not in SETTINGS or key not in SETTINGS[name]}
            lost = [value for value in numbers(results) if not on_page(value, found)]
            if lost or not found:
                missing.append((name, row, lost))
    assert missing == []
    assert count == ROWS


def test_inputs_are_marked_as_inputs() -> None:
    cells = impact_inputs.cells()
    assert {cell.table for cell in cells} == {"3.1", "3.2", "3.3", "A.1"}
    assert all(cell.within is None and cell.reason == impact_inputs.INPUT for cell in cells)
    leader = [cell for cell in reactive_follower_tables._robots() if cell.table == "avi2019 Table 5"]
    assert {cell.printed for cell in leader} == {5.3, 0.29, 0.06, 0.352, 0.326, 0.32}
    for table, own in by_table([*(cell for cell in cells if cell.table != "A.1"), *leader]).items():
        assert view(table, own).verdict == "inputs"
