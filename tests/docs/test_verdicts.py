"""The page on verdicts names every doubt with its side, every end of a report and every exit code that follows."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import list_doubts
from hrsafety.cli import exit_codes, verdict
from hrsafety.cli.cell import page
from hrsafety.standards.verdicts import VERDICTS
from page_tables import written

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "verdicts.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("part", list_doubts.PARTS)
def test_tables_are_those_of_the_code(part: str) -> None:
    assert written(PAGE, f"{part} of list_doubts.py") == list_doubts.table(part)


def test_every_verdict_has_an_end_and_a_color() -> None:
    assert set(verdict.OF_VERDICTS) == set(page.LOOKS) == set(VERDICTS)
    # Only what is within limits is green and ends with 0.
    assert [word for word, (_, code) in verdict.OF_VERDICTS.items() if code == exit_codes.DONE] == ["within_limits"]
    assert [word for word, look in page.LOOKS.items() if look == "good"] == ["within_limits"]
    assert {first for first, _ in verdict.OF_VERDICTS.values()} <= set(verdict.LOOKS)


def test_every_exit_code_of_a_verdict_is_on_the_page() -> None:
    cells = " ".join(re.findall(r"\| ([^|]*) \|$", PAGE, re.MULTILINE))
    for code in (exit_codes.DONE, exit_codes.ERROR, exit_codes.FAILED_RUN, exit_codes.WARNED, exit_codes.NOT_CHECKED):
        assert re.search(rf"\b{code}\b", cells), exit_codes.MEANINGS[code]
    for word in verdict.LOOKS:
        assert f"`{word}`" in PAGE


def test_doubts_about_limits_and_masses_are_unsafe() -> None:
    sides = list_doubts.sides()
    assert len(sides) > 40
    for code in ("not_checked", "drive_not_given", "probability", "covering_larger_than_part", "linear_beyond_half"):
        assert sides[code] == {"unsafe"}, code
    assert sides["goal_out_of_reach"] == {"safe"}
