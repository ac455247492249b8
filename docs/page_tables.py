"""Tables that a script measures, and their place between two marks of a page."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

from hrsafety import navigation as nav
from hrsafety.navigation.metrics import wilson

DOCS = Path(__file__).resolve().parent
ERROR, LATENCY = 0.025, 0.1
"""Half width of the error of each coordinate of measured people in m, and their age in s, beside exact sensing."""
LATE = f"±{1e3 * ERROR:g} mm, {LATENCY:g} s late"
SENSING: dict[str, dict[str, float]] = {"exact": {}, LATE: {"noise": ERROR, "latency": LATENCY}}
"""Arguments of a benchmark by how people are measured; shields know it."""


def line(*cells: object) -> str:
    """Return a row of a table."""
    return f"| {' | '.join(str(cell) for cell in cells)} |"


def head(*cells: str) -> list[str]:
    """Return the first two lines of a table."""
    return [line(*cells), "|---" * len(cells) + "|"]


def percent(count: int, runs: int, digits: int = 1) -> str:
    """Return a share in percent with its 95 % Wilson interval."""
    share = wilson(count, runs)
    return f"{100 * share.value:.{digits}f} ({100 * share.low:.{digits}f} to {100 * share.high:.{digits}f})"


def shares(table: nav.RunTable) -> str:
    """Return the shares of runs with a contact, by what the robot did.

    It moved toward somebody, was touched from behind or from the side while it moved, or only while it stood, a run in
    the first of these that it has.
    """
    toward, moving = table.contacts_toward > 0, table.contacts_moving > 0
    standing = (table.contacts_standing > 0) & ~moving
    split = (toward, moving & ~toward, standing)
    return "; ".join(percent(int(each.sum()), len(each)) for each in split)


def marks(name: str) -> tuple[str, str]:
    """Return the lines between which tables stand on a page."""
    return f"<!-- {name} begin -->\n", f"<!-- {name} end -->\n"


def written(text: str, name: str) -> str:
    """Return the tables that a page holds."""
    begin, end = marks(name)
    return text.split(begin)[1].split(end)[0]


def selected(table: str, keep: Callable[[dict[str, str]], bool], columns: Sequence[str]) -> str:
    """Return some columns of those rows of a table that a reader decides by.

    Parameters
    ----------
    table : str
        The whole table, as it stands on its page.
    keep : callable
        Takes the cells of a row by the titles of their columns, and returns whether the row is shown.
    columns : sequence of str
        Titles of the columns that are shown.
    """
    titles, _, *rows = ([cell.strip() for cell in row.strip("| \n").split(" | ")] for row in table.strip().splitlines())
    found = [dict(zip(titles, row, strict=True)) for row in rows]
    return "\n".join([*head(*columns), *(line(*(row[name] for name in columns)) for row in found if keep(row))]) + "\n"


def print_or_write(page: Path, parts: Mapping[str, tuple[str, Callable[[], str]]]) -> None:
    """Print tables, or write them into a page: the command line of the scripts that measure.

    Parameters
    ----------
    page : Path
        Where they stand.
    parts : mapping of str to (str, callable)
        Name of the marks, and what makes the tables, by the word for ``--only``.
    """
    parser = argparse.ArgumentParser(description=f"Tables of {page.relative_to(DOCS.parent)}.")
    parser.add_argument("--only", choices=parts, help="one part instead of all")
    parser.add_argument("--write", action="store_true", help="replace the tables of the page")
    options = parser.parse_args()
    for name, made in parts.values() if options.only is None else [parts[options.only]]:
        tables = made()
        if not options.write:
            print(tables)
            continue
        begin, end = marks(name)
        before, found, rest = page.read_text(encoding="utf-8").partition(begin)
        if not found:
            raise SystemExit(f"{page} has no line {begin.strip()}")
        page.write_text(before + begin + tables + end + rest.partition(end)[2], encoding="utf-8")
