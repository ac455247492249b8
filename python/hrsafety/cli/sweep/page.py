"""The summary page of ``hrsafety sweep``."""

from __future__ import annotations

import json
from collections.abc import Sequence

from hrsafety.cli.sweep.summary import Summary
from hrsafety.pages import Picture, sentence, written
from hrsafety.sweep import Axis, SweepResult

__all__ = ["axis_words", "design_words", "html"]

_KINDS = {"grid": "grid", "latin_hypercube": "Latin hypercube", "sobol": "Sobol sequence"}
# More values than these are given as a count.
MOST_LISTED = 8


def design_words(result: SweepResult) -> str:
    """Return the design in a line."""
    settings = result.design.settings()
    seed = f", seed {settings['seed']}" if "seed" in settings else ""
    cases = f", {len(result.cases)} cases each" if result.cases else ""
    return f"{_KINDS[settings['kind']]} of {settings['rows']:,} rows{seed}{cases}"


def axis_words(axis: Axis) -> str:
    """Return the values of an axis in a line."""
    if axis.values is not None:
        if len(axis.values) <= MOST_LISTED:
            return ", ".join(f"{value:g}" for value in axis.values)
        return f"{len(axis.values)} values from {min(axis.values):g} to {max(axis.values):g}"
    number = f"{axis.size} values " if axis.size is not None else ""
    scale = {"linear": "", "log": ", logarithmic", "integer": ", whole numbers"}[axis.scale]
    return f"{number}{axis.low:g} to {axis.high:g}{scale}"


def html(title: str, summary: Summary, show: Sequence[str], pictures: Sequence[Picture]) -> str:
    """Return the page.

    Parameters
    ----------
    title : str
        Heading.
    summary : Summary
        What was found.
    show : sequence of str
        Columns that are drawn.
    pictures : sequence of Picture
        Their pictures.

    Returns
    -------
    str
        A complete HTML document.
    """
    result = summary.result
    cases = f" ({', '.join(result.cases)})" if result.cases else ""
    titles, extremes = _extremes(summary, show)
    return written(
        "sweep.html",
        title=title,
        warned=[f"{warning.message}" for warning in result.warnings],
        rows=len(result),
        design=f"{sentence(design_words(result))}{cases}",
        axes=[(axis.label, axis_words(axis)) for axis in result.axes],
        pictures=pictures,
        extreme_titles=titles,
        extremes=extremes,
        columns=[(each.label, *each.numbers()) for each in summary.numbers],
        words=summary.words,
        source=result.provenance,
        settings=json.dumps(result.provenance["settings"], indent=1, ensure_ascii=False),
    )


def _extremes(summary: Summary, show: Sequence[str]) -> tuple[list[str], list[tuple[str, ...]]]:
    """Return where the columns that are drawn are least and largest, as titles and rows."""
    drawn = [each for each in summary.numbers if each.column.name in show and each.finite]
    labels = {column.name: column.label for column in summary.result.columns}
    names = list(drawn[0].least_row) if drawn else []
    rows = [
        (each.label, word, f"{value:.5g}", *(_shown(row[name]) for name in names))
        for each in drawn
        for word, value, row in (("least", each.least, each.least_row), ("largest", each.largest, each.largest_row))
    ]
    return ["Quantity", "", "Value", *(labels[name] for name in names)], rows


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
