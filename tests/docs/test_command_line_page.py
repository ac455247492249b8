"""The page about the command line says what the program does."""

from __future__ import annotations

import re
from pathlib import Path

from hrsafety.cli import exit_codes, verdict
from hrsafety.scenarios.laws import LAWS, SHORT_NAMES

PAGE = (Path(__file__).resolve().parents[2] / "docs" / "guides" / "command_line.md").read_text(encoding="utf-8")


def rows(header: str) -> list[list[str]]:
    table = PAGE.split(header)[1].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in table]


def test_exit_codes_are_those_of_the_program() -> None:
    shown = {int(code): meaning.replace("`", "") for code, meaning in rows("| code | meaning |")}
    assert shown == exit_codes.MEANINGS


def test_every_word_of_fail_on_is_explained() -> None:
    assert [row[0].strip("`") for row in rows("| word of `--fail-on` | in any run |")] == list(verdict.FAILURES)


def test_every_short_name_of_a_law_is_listed() -> None:
    shown = {short: law.strip("`") for law, names in rows("| law | also |") for short in re.findall(r"`(\w+)`", names)}
    assert shown == dict(SHORT_NAMES)
    assert set(shown.values()) <= set(LAWS)
