"""The page about failures says what the validation page measured, beside tables of its own script."""

from __future__ import annotations

import re
from pathlib import Path

import measure_failures
from hrsafety.cli.parsers import ARENA_LAWS
from page_tables import written

DOCS = Path(__file__).resolve().parents[2] / "docs"
PAGE = DOCS / "guides" / "where_laws_fail.md"
SHARE = re.compile(r"\d+\.\d \(\d+\.\d to \d+\.\d\)")
PARTS = [f"{part} of measure_failures.py" for part in ("persons", "scenes", "first rows")]


def test_every_share_of_the_page_is_measured() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for part in PARTS:
        page = page.replace(written(page, part), "")
    measured = set(SHARE.findall((DOCS / "validation.md").read_text(encoding="utf-8")))
    shown = SHARE.findall(" ".join(page.split()))
    assert len(shown) > 30
    assert set(shown) <= measured


def test_every_entry_of_the_arena_stands_in_its_tables() -> None:
    page = PAGE.read_text(encoding="utf-8")
    for part, rows in zip(PARTS[:2], (1, measure_failures.WORST), strict=True):
        first = [line.split(" | ")[0] for line in written(page, part).splitlines()[2:]]
        assert first == [f"| `{word}`" for word in ARENA_LAWS for _ in range(rows)]


def test_no_shield_is_at_fault_against_a_searched_person() -> None:
    rows = written(PAGE.read_text(encoding="utf-8"), PARTS[0]).splitlines()[2:]
    shielded = [row.split(" | ") for row in rows if "shield" in row]
    assert len(shielded) == 2
    for row in shielded:
        assert row[1] == "20000"
        assert row[2].startswith("0.00 (")
        assert row[3].startswith("0.00 (")
        assert row[4] == "0"
