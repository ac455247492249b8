"""The tables about contacts on the validation page are those that the package computes."""

from __future__ import annotations

import pytest

import measure_contact
from page_tables import written


@pytest.mark.parametrize("part", measure_contact.PARTS)
def test_a_table_is_that_of_the_code(part: str) -> None:
    page = measure_contact.PAGE.read_text(encoding="utf-8")
    assert written(page, f"{part} of measure_contact.py") == measure_contact.table(part)


def test_what_the_page_says_of_the_misses() -> None:
    rows = {tuple(row.split(" | ")[:2]): row for row in measure_contact.measured()}
    power = next(row for key, row in rows.items() if "one power law" in key[0] and "force" in key[1])
    line = next(row for key, row in rows.items() if "a linear covering" in key[0])
    assert "-0.9 %" in power
    assert "-41" in line or "-40.9" in line
