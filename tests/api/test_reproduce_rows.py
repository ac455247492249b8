"""Every row of the published tables stands on the page, inputs included."""

from __future__ import annotations

import json
import os
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

import pytest

pytest.importorskip("matplotlib")
pytest.importorskip("scipy")

from hrsafety import reproduce
from hrsafety.reproduce import (
    gain_tables,
    impact_inputs,
    impact_page,
    impact_part,
    markup,
    page,
    published,
    reactive_follower_tables,
    reactive_skirt_tables,
    reactive_sound_study,
    reactive_sound_tables,
    tables,
    wheels_tables,
)
from hrsafety.reproduce.cells import Cell

SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[2].parent / "shared"))
ROWS = 203
# Tables of the page that hold the rows of a published table.
PLACES = {
    "avi2019:1": ("avi2019 Table 1",),
    "avi2019:2": ("avi2019 Table 2",),
    "avi2019:5-6": ("avi2019 Table 5", "avi2019 Table 6"),
    "gussu2017:4": ("gussu2017 Table 4",),
}


def specified() -> dict[str, list[dict[str, object]]]:
    """Return the rows of every table of the specification that a page must show."""
    source = SHARED / "spec" / "published_tables.json"
    if not source.is_file():
        pytest.skip(f"needs the specification's tables: {source}")
    entries = json.loads(source.read_text(encoding="utf-8"))
    return {name: entry["rows"] for name, entry in entries.items() if isinstance(entry, dict)}


def numbers(value: object) -> Iterator[float]:
    """Yield every number in a row, however deep."""
    if isinstance(value, dict):
        for each in value.values():
            yield from numbers(each)
    elif isinstance(value, list):
        for each in value:
            yield from numbers(each)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield float(value)
