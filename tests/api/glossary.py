"""The glossary: the page of symbols, with the tables of the pages that it names."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"
# A parameter of a law, a criterion: described once, in a table of its page.
TABLES = {"guides/laws.md": "| law | parameter | symbol |", "theory/impact.md": "| metric | identifier | symbol |"}


@cache
def rows() -> list[list[str]]:
    """Return the cells of every row."""
    lines = (DOCS / "theory" / "symbols.md").read_text(encoding="utf-8").splitlines()
    for page, header in TABLES.items():
        for table in (DOCS / page).read_text(encoding="utf-8").split(header)[1:]:
            lines += table.split("\n\n")[0].splitlines()
    return [line.strip().strip("|").split("|") for line in lines if line.startswith("|")]


@cache
def identifiers() -> set[str]:
    """Return every name that the glossary has."""
    return {word for row in rows() for word in re.findall(r"`([A-Za-z_][\w]*)`", " ".join(row))}


def units_of(name: str) -> list[str]:
    """Return the cells beside a name, one of which is its unit."""
    cells = [cell.strip() for row in rows() if any(f"`{name}`" in cell for cell in row) for cell in row]
    return [cell.replace("²", "^2").replace("³", "^3") for cell in cells]
