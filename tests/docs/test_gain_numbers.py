"""Tables of appendix C in the documents are those that the package computes."""

from __future__ import annotations

from pathlib import Path

import pytest

import measure_gains
from page_tables import written

REPOSITORY = Path(__file__).resolve().parents[2]


@pytest.mark.evidence
def test_tables_of_appendix_c_are_what_is_computed() -> None:
    validation = (REPOSITORY / "docs" / "validation.md").read_text(encoding="utf-8")
    page = measure_gains.page()
    assert written(validation, measure_gains.MARKS) == page
    assert page.count("| no |") >= 7
