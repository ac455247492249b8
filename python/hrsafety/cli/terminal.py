"""How text looks on a terminal: rich draws tables and colors if it is installed, else everything is plain text.

Nothing but the look depends on it: a pipe, a file, ``TERM=dumb`` and an installation without rich get the same words.
"""

from __future__ import annotations

import importlib.util
import io
import os
import shutil
import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, TextIO

from hrsafety._words import unsigned_zero

if TYPE_CHECKING:
    from rich.console import Console

    from hrsafety.pages.report import Report

__all__ = ["can_draw", "colored", "console", "styled", "table", "told"]

WIDEST = 10_000  # columns


def can_draw(stream: TextIO) -> bool:
    """Return whether rich is there and the stream is a terminal that can do more than print lines."""
    drawing = stream.isatty() and os.environ.get("TERM") != "dumb"
    return drawing and importlib.util.find_spec("rich") is not None


def colored(stream: TextIO) -> bool:
    """Return whether text may have a color: on a terminal whose user does not refuse it (https://no-color.org)."""
    return can_draw(stream) and not os.environ.get("NO_COLOR")


def console(stream: TextIO, file: TextIO | None = None, *, width: int | None = None) -> Console:
    """Return a console that draws as the terminal behind a stream can, into the stream or into another file."""
    from rich.console import Console

    color = colored(stream)
    return Console(
        file=file or stream,
        force_terminal=color,
        color_system="standard" if color else None,
        width=width or shutil.get_terminal_size().columns,
        highlight=False,
        emoji=False,
        markup=False,
    )


def styled(text: str, style: str, stream: TextIO) -> str:
    """Return text in a style of rich, such as ``"yellow"``, where the stream takes it."""
    if not colored(stream):
        return text
    from rich.text import Text

    drawn = io.StringIO()
    console(stream, drawn).print(Text(text, style=style), end="", soft_wrap=True)
    return drawn.getvalue()


def table(headers: Sequence[Sequence[str]], rows: Iterable[Sequence[object]], *, left: Sequence[int] = ()) -> str:
    """Return a table for standard output, numbers to the right.

    Parameters
    ----------
    headers : sequence of sequence of str
        One or more header lines; the last one carries the units.
    rows : iterable of sequence
        Cells, formatted already or printed as they are.
    left : sequence of int
        Columns that are aligned to the left.

    Returns
    -------
    str
        Lines without a final newline.
    """
    cells = [[unsigned_zero(str(cell)) for cell in row] for row in rows]
    return (_drawn if can_draw(sys.stdout) else _aligned)(headers, cells, left)


def told(report: Report) -> str:
    """Return what the terminal shows of a report: its facts, and the tables that are printed."""
    parts = ["\n".join(f"{name:<15}{unsigned_zero(words)}" for name, words in report.facts)]
    for each in report.printed:
        rows = list(each.rows)
        more = [each.more] if each.most is not None and len(rows) > each.most else []
        parts.append("\n".join([table(each.headers, rows[: each.most], left=each.left), *more]))
    return "\n\n".join(filter(None, parts))


def _aligned(headers: Sequence[Sequence[str]], rows: Sequence[Sequence[str]], left: Sequence[int]) -> str:
    lines = [*headers, *rows]
    widths = [max(len(line[column]) for line in lines) for column in range(len(lines[0]))]
    text = []
    for line in lines:
        cells = (
            cell.ljust(width) if column in left else cell.rjust(width)
            for column, (cell, width) in enumerate(zip(line, widths, strict=True))
        )
        text.append("  ".join(cells).rstrip())
    text.insert(len(headers), "  ".join("-" * width for width in widths))
    return "\n".join(text)


def _drawn(headers: Sequence[Sequence[str]], rows: Sequence[Sequence[str]], left: Sequence[int]) -> str:
    from rich import box
    from rich.table import Table

    drawn = Table(box=box.SIMPLE_HEAD, pad_edge=False, header_style="bold" if colored(sys.stdout) else "")
    for column, titles in enumerate(zip(*headers, strict=True)):
        drawn.add_column("\n".join(titles), justify="left" if column in left else "right", overflow="fold")
    for row in rows:
        drawn.add_row(*row)
    text = io.StringIO()
    # A table that is wider than the terminal is broken at the ends of lines, as plain text is: no cell is cut.
    console(sys.stdout, text, width=WIDEST).print(drawn)
    return "\n".join(line.rstrip() for line in text.getvalue().splitlines()).strip("\n")
