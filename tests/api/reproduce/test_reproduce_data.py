"""Cells from files: places, tolerances and reasons stand there once, and every entry is used."""

from __future__ import annotations

import ast
from collections import Counter
from pathlib import Path

import pytest

from hrsafety import reproduce
from hrsafety.reproduce import data, names, parts
from hrsafety.reproduce.sheets import Sheet

FOLDER = Path(reproduce.__file__).parent
SHEETS = ("appendix_a", "chapter_3", "chapter_4", "gains", "laws", "built", "reactive")
# Keys that a call puts together from a word and what it is about.
COMPOSED = ("damping_", "note_", "more_", "state_", "signal_")
FIELDS = {"row", "column", "printed", "figure", "unit", "tolerance", "measured", "reason", "if_off"}
NO_TABLES = {"texts", "tolerances", "printed"}


def entries(name: str) -> list[tuple[str, str, dict[str, object]]]:
    content = data.table(name)
    return [(table, key, entry) for table in content if table not in NO_TABLES for key, entry in content[table].items()]


def words_of_the_code() -> set[str]:
    """Return every string and keyword name of the modules, those of f-strings and their beginnings too."""
    found = set()
    for path in FOLDER.rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                found.add(node.value)
    return found


@pytest.mark.parametrize("name", SHEETS)
def test_a_key_stands_for_one_cell_and_has_no_unknown_field(name: str) -> None:
    keys = Counter(key for _, key, _ in entries(name))
    assert [key for key, count in keys.items() if count > 1] == []
    assert [(key, field) for _, key, entry in entries(name) for field in entry if field not in FIELDS] == []
    assert [key for _, key, entry in entries(name) if not {"row", "column"} <= entry.keys()] == []


def test_every_entry_and_every_shared_text_is_used() -> None:
    code = words_of_the_code()
    for name in SHEETS:
        texts = data.table(name).get("texts", {})
        inside = " ".join(str(value) for _, _, entry in entries(name) for value in entry.values())
        inside += " ".join(texts.values())
        for key in [*(key for _, key, _ in entries(name)), *texts]:
            known = key in code or key.startswith(COMPOSED) or f"{{{key}}}" in inside
            assert known, f"{name}.toml: {key}"


def test_every_named_tolerance_is_given() -> None:
    for name in SHEETS:
        given = Sheet(name).tolerances
        for _, key, entry in entries(name):
            tolerance = str(entry.get("tolerance", ""))
            assert not tolerance or "{" in tolerance or tolerance in given, f"{name}.toml: {key}"


def test_a_reason_that_is_given_only_where_a_value_is_off() -> None:
    sheet = Sheet("laws")
    within, off = (sheet.number("arrival", time, label="New VFF") for time in (7.3, 6.0))
    assert (within.within, within.reason) == (True, "")
    assert off.within is False
    assert off.reason.startswith("Not reproduced: ")
    assert (off.table, off.row, off.column, off.unit) == ("Section 6.4.5", "New VFF", "T_arrive", "s")


def test_printed_numbers_come_from_the_published_text_where_an_entry_names_a_figure() -> None:
    cell = Sheet("chapter_3").number("worst_point", 0.05)
    rows = reproduce.published_tables()["zeng2011:section 3.7"]["rows"]
    (printed,) = (row["value"] for row in rows if row["figure"] == "lever_arm_of_largest_acceleration")
    assert cell.printed == printed


def test_texts_can_name_other_texts_and_numbers_of_the_call() -> None:
    text = Sheet("built").text("at_most", seeds=7, noise=0.3, mean=12.34)
    assert "7 calibrations with Gaussian noise of 0.3 pixel" in text
    assert "is 12.3 mm" in text


def test_unknown_cell_or_word_is_an_error() -> None:
    with pytest.raises(KeyError):
        Sheet("laws").claim("no_such_cell", holds=True)
    with pytest.raises(KeyError):
        Sheet("laws").claim("passed", holds=True, label="only one of two words")


def test_every_part_has_words_a_maker_and_a_template() -> None:
    templates = FOLDER.parent / "pages" / "templates" / "reproduce"
    assert tuple(parts.PARTS) == reproduce.PARTS == tuple(data.table("parts"))
    for part in parts.PARTS.values():
        assert part.progress
        assert part.heading
        assert part.nav
        assert (templates / part.template).is_file()


def test_every_table_with_pictures_has_a_title_or_is_of_a_paper() -> None:
    placed = data.table("names")["pictures"]
    assert [table for table in placed if table not in names.TABLE_TITLES and not table[0].islower()] == []


def test_every_caption_is_a_sentence_and_is_used() -> None:
    captions = data.table("captions")
    code = words_of_the_code()
    for key, caption in captions.items():
        assert key in code, key
        assert caption[0].isupper() or caption.startswith("{")
        assert caption.endswith(".")
