"""The page on limits names the statuses that exist, and what it says of corridors follows from its table."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pytest

import measure_limits
from hrsafety import navigation as nav
from hrsafety.navigation.robot_command import Command
from measure_laws import LAWS
from page_tables import written

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE = (REPOSITORY / "docs" / "limits.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| ([^|]+?) \| (\d+) \| (.+) \|$", re.MULTILINE)
COLUMNS = {"min_clearance", "contacts_moving", "contacts_standing", "contacts_at_fault"}
"""What reports a limit and is a number, not a status."""


def passing() -> dict[str, dict[float, tuple[int, int, int]]]:
    """Return the percentages through, around and in contact, by law and width."""
    found = {}
    for name, _, cells in ROW.findall(written(PAGE, "corridors of measure_limits.py")):
        parts = [tuple(int(share.split()[0]) for share in cell.split("; ")) for cell in cells.split(" | ")]
        found[name] = dict(zip(measure_limits.WIDTHS, parts, strict=True))
    return found


def test_table_of_statuses_is_that_of_the_code() -> None:
    assert written(PAGE, "statuses of measure_limits.py") == measure_limits.table("statuses")


def test_what_reports_a_limit_exists() -> None:
    known = {word for words in measure_limits.statuses().values() for word in words}
    rows = re.findall(r"^\| [a-z][^|]* \| [^|]*\| ([^|]*)\|$", PAGE, re.MULTILINE)
    named = {word for cell in rows for word in re.findall(r"`(\w+)`", cell)}
    assert len(rows) >= 25
    assert len(named) >= 12
    fields = {each.name for each in dataclasses.fields(Command)}
    assert named <= known | COLUMNS | fields | {*nav.metrics.METRICS, *nav.metrics.WORLD_METRICS}
    assert set(nav.RunTable.__dataclass_fields__) >= COLUMNS


def test_every_law_has_a_row_of_corridors() -> None:
    assert set(passing()) == set(LAWS)


def test_text_quotes_the_corridors() -> None:
    rows = passing()
    assert [width for width, cell in rows["New field"].items() if cell[0] == 100] == [1.0, 1.2, 1.4, 1.6]
    assert [width for width, cell in rows["Khatib"].items() if cell[0] == 100] == [1.4, 1.6]
    for name in ("Borenstein & Koren", "Ge & Cui"):
        assert set(rows[name].values()) == {(0, 0, 0)}
    assert set(rows["Masoud"].values()) == {(0, 0, 100)}


@pytest.mark.evidence
@pytest.mark.parametrize("name", ["New field", "Khatib", "Masoud", "Velocity obstacle"])
def test_corridor_of_a_law_is_what_is_computed(name: str) -> None:
    law = LAWS[name]
    start = tuple(measure_limits.starts(1)[0].tolist())
    for width, (through, _, contact) in passing()[name].items():
        run = nav.simulate(measure_limits.corridor(width, start), law)
        if through == 100:
            assert run.outcome == "arrived"
        if contact == 100:
            assert run.outcome == "collided"
        if through == contact == 0:
            assert run.outcome not in ("arrived", "collided") or run.path_length > measure_limits.LONGEST


@pytest.mark.parametrize("page", ["README.md", "docs/start.md", "docs/index.md"])
def test_page_on_limits_is_linked(page: str) -> None:
    text = (REPOSITORY / page).read_text(encoding="utf-8")
    assert "limits.md" in text or "\nlimits\n" in text
