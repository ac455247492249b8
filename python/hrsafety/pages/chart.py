"""Charts of lines as SVG that stands in a page: few bytes, the same ones every time, and no library to load."""

from __future__ import annotations

import html
import math
from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from hrsafety._arguments import Array

__all__ = ["ChartLine", "line_chart"]

WIDTH, HEIGHT = 640.0, 330.0
LEFT, RIGHT, BOTTOM = 52.0, 628.0, 286.0
"""Edges of the frame, the names of bands and the legend above it."""
ROW, LETTER, SAMPLE = 17.0, 6.4, 26.0
"""Height of a row of text, width of a letter, and length of the line beside a name in the legend."""
TICKS = 8
UNSEEN = 0.04
"""Distance in units of the picture by which a point may be moved."""


class ChartLine(NamedTuple):
    """A line of a chart.

    Attributes
    ----------
    label : str
        In the legend; empty: not there.
    x, y : ndarray (n,)
        Its points; where y is not finite the line has a gap.
    color : str
        As CSS tells it.
    dash : str
        Lengths of dashes and gaps, empty for a whole line.
    width : float
        Of the stroke.
    """

    label: str
    x: Array
    y: Array
    color: str
    dash: str = ""
    width: float = 1.6


def line_chart(
    name: str,
    caption: str,
    lines: Sequence[ChartLine],
    *,
    labels: tuple[str, str],
    ends: tuple[float, float],
    bands: Mapping[str, tuple[float, float]] | None = None,
) -> str:
    """Return a chart as an element of a page.

    Parameters
    ----------
    name : str
        Of its parts: no other picture of the page has it.
    caption : str
        What it shows, for those who do not see it.
    lines : sequence of ChartLine
        The lines, the last one above.
    labels : tuple of two str
        Of the axes.
    ends : tuple of two floats
        Where the axes end; they begin at 0.
    bands : mapping of str to (float, float) or None
        Parts of the first axis that are shaded, by name.
    """
    legend, rows = _legend([each for each in lines if each.label])
    bands = bands or {}
    top = ROW * (rows + (1 if bands else 0)) + 8.0
    over = (RIGHT - LEFT) / ends[0]
    down = (BOTTOM - top) / ends[1]
    text = [
        f'<svg role="img" aria-label="{html.escape(caption)}" viewBox="0 0 {WIDTH:g} {HEIGHT:g}" '
        'xmlns="http://www.w3.org/2000/svg" font-family="sans-serif" font-size="12" fill="#222">',
        f'<clipPath id="{name}-frame"><rect x="{LEFT:g}" y="{top:g}" width="{RIGHT - LEFT:g}" '
        f'height="{BOTTOM - top:g}"/></clipPath>',
        *legend,
    ]
    for index, (label, (first, last)) in enumerate(bands.items()):
        x, width = LEFT + over * first, over * (last - first)
        shade = 0.06 if index % 2 else 0.13
        text.append(
            f'<rect x="{x:.1f}" y="{top:g}" width="{width:.1f}" height="{BOTTOM - top:g}" fill="#555" '
            f'fill-opacity="{shade:g}"><title>{html.escape(label)}</title></rect>'
        )
    text += _names_of(bands, over, top - 4.0)
    for tick in _ticks(ends[0]):
        x = LEFT + over * tick
        text.append(f'<path d="M{x:.1f} {top:g}V{BOTTOM + 4.0:g}" stroke="#ccc" stroke-width="0.6"/>')
        text.append(f'<text x="{x:.1f}" y="{BOTTOM + 17.0:g}" text-anchor="middle">{tick:g}</text>')
    for tick in _ticks(ends[1]):
        y = BOTTOM - down * tick
        text.append(f'<path d="M{LEFT - 4.0:g} {y:.1f}H{RIGHT:g}" stroke="#ccc" stroke-width="0.6"/>')
        text.append(f'<text x="{LEFT - 7.0:g}" y="{y + 4.0:.1f}" text-anchor="end">{tick:g}</text>')
    text.append(f'<path d="M{LEFT:g} {top:g}V{BOTTOM:g}H{RIGHT:g}" stroke="#222" fill="none"/>')
    for line in lines:
        path = _path(LEFT + over * line.x, BOTTOM - down * line.y)
        text.append(f'<path d="{path}" clip-path="url(#{name}-frame)" fill="none" {_stroke(line)}/>')
    middle = 0.5 * (top + BOTTOM)
    text.append(
        f'<text x="{0.5 * (LEFT + RIGHT):g}" y="{HEIGHT - 8.0:g}" text-anchor="middle">{html.escape(labels[0])}</text>'
        f'<text transform="translate(13 {middle:g}) rotate(-90)" text-anchor="middle">{html.escape(labels[1])}</text>'
    )
    return "\n".join([*text, "</svg>"])


def _stroke(line: ChartLine) -> str:
    dash = f' stroke-dasharray="{line.dash}"' if line.dash else ""
    return f'stroke="{line.color}" stroke-width="{line.width:g}"{dash}'


def _legend(lines: Sequence[ChartLine]) -> tuple[list[str], int]:
    """Return the names of lines in as many rows as they need, and how many these are."""
    x, row, found = LEFT, 0, []
    for line in lines:
        width = SAMPLE + 6.0 + LETTER * len(line.label) + 14.0
        if x + width > RIGHT and x > LEFT:
            x, row = LEFT, row + 1
        y = ROW * row + 13.0
        found.append(
            f'<path d="M{x:.1f} {y - 4.0:g}h{SAMPLE:g}" {_stroke(line)}/>'
            f'<text x="{x + SAMPLE + 6.0:.1f}" y="{y:g}">{html.escape(line.label)}</text>'
        )
        x += width
    return found, row + 1 if lines else 0


def _names_of(bands: Mapping[str, tuple[float, float]], over: float, y: float) -> Iterator[str]:
    """Yield the names of bands above them, those that have room."""
    free = 0.0
    for label, (first, last) in bands.items():
        half = 0.5 * LETTER * len(label)
        middle = min(max(LEFT + 0.5 * over * (first + last), half), WIDTH - half)
        if middle - half >= free:
            yield f'<text x="{middle:.1f}" y="{y:g}" text-anchor="middle">{html.escape(label)}</text>'
            free = middle + half + LETTER


def _ticks(end: float) -> Iterator[float]:
    """Yield even places from 0 to the end of an axis, multiples of 1, 2 or 5 times a power of ten."""
    power = 10.0 ** math.floor(math.log10(end / TICKS))
    step = next(each * power for each in (1.0, 2.0, 5.0, 10.0) if end <= each * power * TICKS * (1.0 + 1e-9))
    for place in range(int(end / step + 1e-9) + 1):
        yield float(f"{place * step:.9g}")


def _path(x: Array, y: Array) -> str:
    """Return a path through points with their gaps, without those on the line of their neighbors."""
    points = np.column_stack([x, np.clip(y, -1e4, 1e4)])
    points[~np.isfinite(y)] = np.nan
    while len(points) > 2:
        before, here, after = points[:-2], points[1:-1], points[2:]
        way = after - before
        off = np.abs(way[:, 0] * (here - before)[:, 1] - way[:, 1] * (here - before)[:, 0])
        even = off <= UNSEEN * np.maximum(np.hypot(*way.T), UNSEEN)
        even[1::2] = False
        if not even.any():
            break
        points = points[np.concatenate([[True], ~even, [True]])]
    text, pen = [], "M"
    for across, along in points.tolist():
        if math.isnan(along):
            pen = "M"
            continue
        text.append(f"{pen}{across:.1f} {along:.1f}")
        pen = "L"
    return "".join(text)
