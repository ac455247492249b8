"""The summary page of ``hrsafety sweep``."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from html import escape
from importlib import resources

from hrsafety.cli.sweep_summary import Numbers, Summary
from hrsafety.reproduce.markup import figure, head, scroll
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


def html(title: str, summary: Summary, show: Sequence[str], pictures: Mapping[str, tuple[str, bytes]]) -> str:
    """Return the page: style and pictures inside, nothing loaded from elsewhere.

    Parameters
    ----------
    title : str
        Heading.
    summary : Summary
        What was found.
    show : sequence of str
        Columns that are drawn.
    pictures : mapping of str to (str, bytes)
        Caption and PNG by name.

    Returns
    -------
    str
        A complete HTML document.
    """
    style = resources.files("hrsafety.reproduce").joinpath("page.css").read_text(encoding="utf-8")
    return "\n".join(
        [
            "<!DOCTYPE html>",
            '<html lang="en"><head><meta charset="utf-8">',
            '<meta name="viewport" content="width=device-width, initial-scale=1">',
            f"<title>{escape(title)}</title>",
            f"<style>{style}</style></head><body><main>",
            f"<h1>{escape(title)}</h1>",
            *_design(summary.result),
            *(figure(f"{words}.", png, name=name) for name, (words, png) in pictures.items()),
            *_extremes(summary, show),
            *_columns(summary),
            *_foot(summary.result),
            "</main></body></html>\n",
        ]
    )


def _design(result: SweepResult) -> Iterator[str]:
    yield (
        f'<p class="banner"><strong>{len(result):,} rows.</strong> {escape(design_words(result)).capitalize()}'
        f"{escape(f' ({chr(44).join(result.cases)})'.replace(',', ', ')) if result.cases else ''}.</p>"
    )
    for warning in result.warnings:
        yield f'<p class="banner no"><strong>Warning.</strong> {escape(warning.message)}.</p>'
    lines = "".join(
        f'<tr><th scope="row">{escape(axis.label)}</th><td class="text">{escape(axis_words(axis))}</td></tr>'
        for axis in result.axes
    )
    yield scroll(f"<table>{head(['Axis', 'Values'])}<tbody>{lines}</tbody></table>")


def _extremes(summary: Summary, show: Sequence[str]) -> Iterator[str]:
    """Yield where the columns that are drawn are least and largest."""
    shown = [each for each in summary.numbers if each.column.name in show and each.finite]
    if not shown:
        return
    labels = {column.name: column.label for column in summary.result.columns}
    names = list(shown[0].least_row)
    titles = ["Quantity", "", "Value", *(labels[name] for name in names)]
    lines = []
    for each in shown:
        for word, value, row in (("least", each.least, each.least_row), ("largest", each.largest, each.largest_row)):
            cells = "".join(f"<td>{escape(_shown(row[name]))}</td>" for name in names)
            title = f'<th scope="row">{escape(each.label)}</th>'
            lines.append(f'<tr>{title}<td class="text">{word}</td><td>{value:.5g}</td>{cells}</tr>')
    yield "<h2>Extremes</h2>"
    yield scroll(f'<table class="wide">{head(titles)}<tbody>{"".join(lines)}</tbody></table>')


def _shown(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)


def _columns(summary: Summary) -> Iterator[str]:
    """Yield range and mean of all columns, and how often words occur."""
    yield "<h2>Columns</h2>"
    titles = ["Quantity", "Least", "Mean", "Largest", "Without value"]
    lines = "".join(f"<tr>{_line(each)}</tr>" for each in summary.numbers)
    yield scroll(f"<table>{head(titles)}<tbody>{lines}</tbody></table>")
    for each in summary.words:
        counts = ", ".join(f"{escape(word)} {number:,}" for word, number in each.counts)
        yield f"<p>{escape(each.label).capitalize()}: {counts}.</p>"


def _line(each: Numbers) -> str:
    cells = "".join(f"<td>{text}</td>" for text in each.numbers())
    return f'<th scope="row">{escape(each.label)}</th>{cells}'


def _foot(result: SweepResult) -> Iterator[str]:
    """Yield where the numbers come from."""
    source = result.provenance
    settings = escape(json.dumps(source["settings"], indent=1, ensure_ascii=False))
    yield f"<details><summary>All settings</summary><pre>{settings}</pre></details>"
    yield (
        f"<p><small>hrsafety {escape(source['version'])}, begun {escape(source['created'])}, fingerprint "
        f"{escape(source['fingerprint'])}. Beside this page: sweep.json and the folder chunks, read with "
        f"<code>hrsafety.sweep.open</code>; the pictures.</small></p>"
    )
