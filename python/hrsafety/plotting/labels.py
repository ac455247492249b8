"""Labels that stand clear of curves, markers and each other.

A label has an anchor, the point that it names. Where it stands around the anchor is chosen when everything
else is drawn: nearest first, in twelve directions, and further away, with a thin line to the
anchor, where nothing near it is free.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from hrsafety.plotting import style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from matplotlib.text import Annotation
    from matplotlib.transforms import Bbox

Array = npt.NDArray[np.float64]

_NEAR = (5.0, 9.0, 14.0)  # pt between anchor and label
_FAR = (22.0, 32.0, 44.0, 58.0, 74.0, 92.0)  # pt; with a line to the anchor
_DIRECTIONS = (0, 180, 90, 270, 30, 150, 330, 210, 60, 120, 300, 240)  # degrees, preferred ones first
_POINTS_PER_INCH = 72.0
_SAMPLE = 2.0  # px between points of a curve that are examined
_CLEAR = 2.0  # px around a label
_MOST_SAMPLES = 200_000


def label(axes: Axes, text: str, anchor: tuple[float, float], **look: object) -> Annotation:
    """Add a label that names a point in data coordinates; `clear_labels` finds its place."""
    line: style.Properties = {"arrowstyle": "-", "linewidth": 0.7, "shrinkA": 0.0, "shrinkB": 3.0}
    line["color"] = look.get("color", style.NEUTRAL)
    words: style.Properties = {"fontsize": style.SMALL_FONT_SIZE, "zorder": 7.5, **look}
    drawn = axes.annotate(
        text, anchor, (0.0, 0.0), textcoords="offset points", ha="center", va="center", arrowprops=line, **words
    )
    drawn.set_in_layout(False)  # labels stay within their axes
    return drawn


def clear_labels(figure: Figure, labels: Iterable[Annotation]) -> None:
    """Move each label to the nearest place where no curve, marker, edge or other text is; the first ones first."""
    wanted = list(labels)
    if not wanted:
        return
    figure.draw_without_rendering()  # lays out the axes, so that places in px are known
    taken: dict[Axes, tuple[Array, list[Bbox]]] = {}
    for drawn in wanted:
        axes: Any = drawn.axes
        if axes not in taken:
            taken[axes] = (_curve_points(axes), _boxes(axes, wanted))
        points, boxes = taken[axes]
        boxes.append(_place(axes, drawn, points, boxes))


def _place(axes: Axes, drawn: Annotation, points: Array, boxes: list[Bbox]) -> Bbox:
    """Move one label to its best place and return the box that it takes."""
    from matplotlib.transforms import Bbox

    scale = axes.figure.dpi / _POINTS_PER_INCH
    own = text_box(drawn)
    half = np.array([own.width, own.height]) / 2.0
    anchor = np.asarray(axes.transData.transform(drawn.xy))
    best: tuple[float, Array, Bbox, float] | None = None
    for rank, (distance, offset) in enumerate(_offsets(half, scale)):
        center = anchor + offset
        box = Bbox([center - half - _CLEAR, center + half + _CLEAR])
        cost = _hits(box, points, boxes, axes.bbox) + 1e-6 * rank
        if best is None or cost < best[0]:
            best = (cost, offset, box, distance)
        if cost < 1.0:
            break
    assert best is not None
    _, offset, box, distance = best
    drawn.set_position(tuple(offset / scale))
    if drawn.arrow_patch is not None:
        drawn.arrow_patch.set_visible(distance >= _FAR[0])
    return box


def _offsets(half: Array, scale: float) -> Iterator[tuple[float, Array]]:
    """Yield distance in pt and offset in px of the center of a label, nearest first."""
    for distance in (*_NEAR, *_FAR):
        for degrees in _DIRECTIONS:
            toward = np.array([math.cos(math.radians(degrees)), math.sin(math.radians(degrees))])
            yield distance, toward * (distance * scale + half)


def _hits(box: Bbox, points: Array, boxes: list[Bbox], room: Bbox) -> float:
    """Return how much of a picture a box would cover; 0 for none, much for leaving the axes."""
    inside = (points[:, 0] > box.x0) & (points[:, 0] < box.x1) & (points[:, 1] > box.y0) & (points[:, 1] < box.y1)
    texts = sum(1 for other in boxes if box.overlaps(other))
    outside = box.x0 < room.x0 or box.x1 > room.x1 or box.y0 < room.y0 or box.y1 > room.y1
    return float(inside.sum()) + 1e4 * texts + (1e6 if outside else 0.0)


def text_box(text: object) -> Bbox:
    """Return the box of the words of a text in px, without the line to its anchor."""
    from matplotlib.text import Text

    return Text.get_window_extent(text)  # type: ignore[arg-type]  # the base method leaves the arrow out


def _boxes(axes: Axes, placed_later: list[Annotation]) -> list[Bbox]:
    """Return the boxes of texts that stay where they are."""
    return [
        text_box(text) for text in axes.texts if text not in placed_later and text.get_visible() and text.get_text()
    ]


def _curve_points(axes: Axes) -> Array:
    """Return points in px, close together, on every curve, marker and outline of axes."""
    found = [np.empty((0, 2))]
    for line in axes.lines:
        if not line.get_visible():
            continue
        where = np.asarray(line.get_transform().transform(np.asarray(line.get_xydata(), dtype=np.float64)))
        if line.get_linestyle() not in {"None", "none", "", " "}:
            found.append(_dense(where))
        if line.get_marker() not in {"None", "none", "", " ", None}:
            half = 0.5 * float(line.get_markersize()) * axes.figure.dpi / _POINTS_PER_INCH
            square = half * np.array([(x, y) for x in (-1.0, 0.0, 1.0) for y in (-1.0, 0.0, 1.0)])
            found.append((where[:, np.newaxis] + square).reshape(-1, 2))
    for patch in axes.patches:
        if patch.get_visible():
            found += [
                _dense(np.asarray(each))
                for each in patch.get_transform().transform_path(patch.get_path()).to_polygons()
            ]
    for collection in axes.collections:
        segments: Any = getattr(collection, "get_segments", list)
        found += [_dense(np.asarray(axes.transData.transform(each))) for each in segments()]
    points = np.concatenate(found)
    return points[np.isfinite(points).all(axis=1)]


def _dense(points: Array) -> Array:
    """Return points on a polyline that are at most some px apart; gaps stay gaps."""
    if len(points) < 2:
        return points
    start, step = points[:-1], np.diff(points, axis=0)
    known = np.isfinite(step).all(axis=1)
    start, step = start[known], step[known]
    if not len(start):
        return np.empty((0, 2))
    pieces = np.clip(np.ceil(np.hypot(*step.T) / _SAMPLE).astype(np.int64), 1, _MOST_SAMPLES // len(start) + 1)
    which = np.repeat(np.arange(len(start)), pieces)
    share = (np.arange(len(which)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[which]
    dense: Array = start[which] + share[:, np.newaxis] * step[which]
    return np.concatenate([dense, points[-1:]])
