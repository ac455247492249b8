"""The first rows of a guide are those of the whole table that the page folds."""

from __future__ import annotations

from types import ModuleType

import pytest

import measure_built
import measure_foresight
import measure_hidden_people
from page_tables import written


@pytest.mark.parametrize(
    "script", [measure_built, measure_foresight, measure_hidden_people], ids=lambda script: script.__name__
)
def test_first_rows_are_those_of_the_whole_table(script: ModuleType) -> None:
    page = script.PAGE.read_text(encoding="utf-8")
    shown = written(page, script.FIRST_MARKS)
    assert shown == script.first()
    assert len(shown.splitlines()) > 4
