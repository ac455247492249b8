"""Every bad input of the list is refused with exactly the message that the documents show."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

import list_bad_inputs
from bad_inputs import BAD_INPUTS, message

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE = (REPOSITORY / "docs" / "bad_inputs.md").read_text(encoding="utf-8")
CASES = [(name, call) for inputs in BAD_INPUTS.values() for name, call in inputs.items()]


@pytest.mark.parametrize(("name", "call"), CASES, ids=[name for name, _ in CASES])
def test_bad_input_gives_the_message_of_the_page(name: str, call: str, tmp_path: Path) -> None:
    said = message(call, tmp_path.resolve())
    assert list_bad_inputs.row(name, call, said) in PAGE.splitlines()
    assert str(tmp_path) not in said


def test_page_shows_every_bad_input_and_no_other() -> None:
    rows = re.findall(r"^\| (.+?) \| `", PAGE, re.MULTILINE)
    assert rows == [name for name, _ in CASES]
    assert len(rows) == len(set(rows)) >= 80


def test_no_input_is_listed_twice() -> None:
    calls = [call for inputs in BAD_INPUTS.values() for call in inputs.values()]
    assert len(calls) == len(set(calls))
