"""The page about the command line says what the program does."""

from __future__ import annotations

import re
from pathlib import Path

from hrsafety.cli import exit_codes, verdict
from hrsafety.scenarios.laws import LAWS, SHORT_NAMES

GUIDES = Path(__file__).resolve().parents[2] / "docs" / "guides"


def rows(header: str, page: str = "command_line.md") -> list[list[str]]:
    table = (GUIDES / page).read_text(encoding="utf-8").split(header)[1].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def test_exit_codes_are_those_of_the_program() -> None:
    shown = {int(code): meaning.replace("`", "") for code, meaning in rows("| code | meaning |")}
    assert shown == exit_codes.MEANINGS


def test_every_word_of_fail_on_is_explained() -> None:
    assert [row[0].strip("`") for row in rows("| word of `--fail-on` | in any run |")] == list(verdict.FAILURES)


def test_every_name_of_a_law_is_listed() -> None:
    listed = {law.strip("`"): re.findall(r"`(\w+)`", names) for law, names in rows("| law | also |", "laws.md")}
    assert {short: law for law, names in listed.items() for short in names} == dict(SHORT_NAMES)
    assert set(listed) == set(LAWS)
