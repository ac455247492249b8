"""What the commands print and write: aligned tables, CSV, pictures."""

from __future__ import annotations

import argparse
import csv
import io
import math
import os
import sys
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from hrsafety import navigation as nav
from hrsafety._atomic import write_file
from hrsafety.cli.exit_codes import WARNED
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.scenarios.laws import LAWS, name_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = [
    "aligned",
    "animation",
    "decimal",
    "folder",
    "law_words",
    "report_warnings",
    "stepping_words",
    "with_options",
    "write_csv",
    "write_picture",
    "write_text",
]


def aligned(headers: Sequence[Sequence[str]], rows: Iterable[Sequence[object]], *, left: Sequence[int] = ()) -> str:
    """Return a table as text, numbers to the right.

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
    lines = [[str(cell) for cell in row] for row in (*headers, *rows)]
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


def decimal(value: float, digits: int = 2) -> str:
    """Return a number with fixed digits, or a dash where there is none."""
    return f"{value:.{digits}f}" if math.isfinite(value) else "-"


def with_options(law: nav.Law, options: argparse.Namespace) -> nav.Law:
    """Return the law with what the command line changes."""
    if options.law is not None:
        named = LAWS[options.law.replace("-", "_")]
        law = law if type(law) is named else named()
    changes: dict[str, object] = {}
    if options.gains is not None:
        names = law.GAIN_NAMES
        if len(options.gains) != len(names):
            raise InvalidParameterError("--gains", f"be {len(names)} numbers: {', '.join(names)}", options.gains)
        changes |= dict(zip(names, options.gains, strict=True))
    if options.stabilizing is not None:
        if not isinstance(law, nav.VirtualForceField):
            raise InvalidParameterError("--stabilizing", "come with the virtual force field", options.stabilizing)
        changes["stabilizing"] = options.stabilizing
        if options.stabilizing != "capped":
            changes |= {"stabilizing_force_cap": None, "stabilizing_momentum_cap": None}
    return law.replaced(**changes)


def law_words(law: nav.Law) -> str:
    """Return the law in one line."""
    if not isinstance(law, nav.VirtualForceField):
        numbers = (f"{name} {value:g}" for name, value in zip(law.GAIN_NAMES, law.gains, strict=True))
        return f"{name_of(law).replace('_', ' ')}, {', '.join(numbers)}"
    attraction, repulsion, detour, ratio = (f"{gain:g}" for gain in law.gains)
    return (
        f"virtual force field, K_1 {attraction} N/m, K_3 {repulsion} N/m, K_5 {detour} N/m^2, b {ratio} s, "
        f"stabilizing force {law.stabilizing}"
    )


def stepping_words(options: argparse.Namespace, control_period: float) -> str:
    """Return the time stepping in one line."""
    force = f"force held for {control_period:g} s" if options.hold else "force at every step"
    return f"{options.integrator}, step {options.step:g} s, {force}"


def report_warnings(found: Iterable[ResultWarning], strict: bool) -> None:
    """Print every different warning on stderr, in yellow on a terminal.

    Parameters
    ----------
    found : iterable of ResultWarning
        Warnings of all results, repeated ones too.
    strict : bool
        Whether warnings end the command with exit code 4. Call this after everything was written.

    Raises
    ------
    SystemExit
        If there are warnings and ``strict`` is true.
    """
    different = tuple(dict.fromkeys(found))
    begin, end = ("\x1b[33m", "\x1b[0m") if _colored() else ("", "")
    for each in different:
        print(f"{begin}hrsafety: {' '.join(str(each).split())}{end}", file=sys.stderr)
    if different and strict:
        print(f"hrsafety: warnings with --strict: exit code {WARNED}", file=sys.stderr)
        raise SystemExit(WARNED)


def _colored() -> bool:
    """Return whether stderr is a terminal whose user does not refuse color (https://no-color.org)."""
    return sys.stderr.isatty() and not os.environ.get("NO_COLOR") and os.environ.get("TERM") != "dumb"


def folder(path: str) -> Path:
    """Return a folder that exists."""
    place = Path(path)
    if place.exists() and not place.is_dir():
        raise InvalidParameterError("--out", "be a folder or not exist", path)
    place.mkdir(parents=True, exist_ok=True)
    return place


def write_text(path: Path, text: str) -> Path:
    """Write a text file whole or not at all, with its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    return write_file(path, text)


def write_csv(path: Path, header: Sequence[str], rows: Iterable[Sequence[object]]) -> Path:
    """Write a table; what is not a finite number is left empty."""
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(header)
    for row in rows:
        writer.writerow(["" if isinstance(cell, float) and not math.isfinite(cell) else cell for cell in row])
    return write_text(path, buffer.getvalue())


def write_picture(path: Path, figure: Figure) -> Path:
    """Write a picture as PNG."""
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png")
    return write_file(path, buffer.getvalue())


def animation(trajectory: nav.Trajectory, path: str) -> Path:
    """Write an animation of a run, with its folder."""
    from hrsafety import plotting

    Path(path).parent.mkdir(parents=True, exist_ok=True)
    return plotting.animate(trajectory, path)
