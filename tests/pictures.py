"""What every picture must keep: labels clear of curves, complete legends, the whole scene, readable words."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.colors import to_rgb, to_rgba, to_rgba_array
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.text import Text
from matplotlib.transforms import Bbox

from hrsafety import navigation as nav
from hrsafety.plotting import shapes, style

SMALLEST_FONT = 8.0  # pt
SLACK = 1.0  # px by which boxes may overlap: rounding of glyphs
NO_LINE = {"None", "none", "", " "}


def laid_out(figure: Figure) -> Figure:
    """Return the figure with all places in pixels known."""
    figure.draw_without_rendering()
    return figure


def words_of(axes: Axes) -> list[Text]:
    """Return the labels inside axes that are seen."""
    return [text for text in axes.texts if text.get_visible() and text.get_text().strip()]


def box_of(text: Text) -> Bbox:
    """Return the box of the words in pixels, without the line to an anchor, a little smaller than drawn."""
    box = Text.get_window_extent(text)
    return Bbox.from_extents(box.x0 + SLACK, box.y0 + SLACK, box.x1 - SLACK, box.y1 - SLACK)


def curves_of(axes: Axes) -> Iterator[tuple[str, np.ndarray, float]]:
    """Yield name, points in pixels and drawing order of every curve."""
    for line in axes.lines:
        if line.get_visible() and line.get_linestyle() not in NO_LINE:
            points = np.asarray(line.get_xydata(), dtype=np.float64)
            yield str(line.get_label()), np.asarray(line.get_transform().transform(points)), line.get_zorder()
    for collection in axes.collections:
        if isinstance(collection, LineCollection):
            for points in collection.get_segments():
                yield "line of a collection", np.asarray(axes.transData.transform(points)), collection.get_zorder()


def crosses(points: np.ndarray, box: Bbox) -> bool:
    """Return whether a polyline passes through a box (clipping by Liang and Barsky)."""
    start, end = points[:-1], points[1:]
    known = np.isfinite(start).all(axis=1) & np.isfinite(end).all(axis=1)
    start, step = start[known], (end - start)[known]
    first, last = np.zeros(len(start)), np.ones(len(start))
    possible = np.ones(len(start), dtype=bool)
    for axis, low, high in ((0, box.x0, box.x1), (1, box.y0, box.y1)):
        still = step[:, axis] == 0.0
        possible &= ~still | ((start[:, axis] > low) & (start[:, axis] < high))
        moved = np.where(still, 1.0, step[:, axis])
        enter, leave = (low - start[:, axis]) / moved, (high - start[:, axis]) / moved
        first = np.where(still, first, np.maximum(first, np.minimum(enter, leave)))
        last = np.where(still, last, np.minimum(last, np.maximum(enter, leave)))
    return bool((possible & (first < last)).any())


def struck_labels(figure: Figure) -> list[str]:
    """Return labels that a curve passes through; a curve below an opaque box is hidden there."""
    found = []
    for axes in figure.axes:
        for text in words_of(axes):
            back = text.get_bbox_patch()
            opaque = back is not None and to_rgba(back.get_facecolor())[3] == 1.0 and back.get_alpha() in {None, 1.0}
            for name, points, order in curves_of(axes):
                if not (opaque and order < text.get_zorder()) and crosses(points, box_of(text)):
                    found.append(f"{text.get_text()!r} by {name!r}")
    return found


def covered_curves(figure: Figure) -> list[str]:
    """Return legends inside axes that lie on a curve."""
    found = []
    for axes in figure.axes:
        legend = axes.get_legend()
        box = None if legend is None else Bbox.intersection(legend.get_window_extent(), axes.bbox)
        if box is not None and box.width > SLACK and box.height > SLACK:
            found += [name for name, points, _ in curves_of(axes) if crosses(points, box)]
    return found


def piled_labels(figure: Figure) -> list[str]:
    """Return pairs of labels, titles and tick labels that overlap."""
    found = []
    for axes in figure.axes:
        texts = words_of(axes)
        for axis in (axes.xaxis, axes.yaxis) if axes.name != "3d" and axes.axison else ():
            texts += [
                tick.label1
                for tick in axis.get_major_ticks()
                if tick.label1.get_visible() and tick.label1.get_text() and _on_axis(axis, tick.get_loc())
            ]
        boxes = [(text.get_text(), box_of(text)) for text in texts]
        found += [
            f"{name!r} on {other!r}"
            for index, (name, box) in enumerate(boxes)
            for other, second in boxes[:index]
            if box.overlaps(second)
        ]
    return found


def _on_axis(axis: Any, place: float) -> bool:
    """Return whether a tick is within the limits of its axis: others are not drawn."""
    low, high = sorted(axis.get_view_interval())
    room = 1e-9 * (high - low)
    return bool(low - room <= place <= high + room)


def lost_words(figure: Figure) -> list[str]:
    """Return texts that leave the picture, and labels that leave their axes."""
    found = []
    page = figure.bbox.padded(SLACK)
    for text in figure.findobj(Text):
        if text.get_visible() and text.get_text().strip() and text.get_window_extent().width > 0:
            box = box_of(text)
            if text.axes is not None and text.axes.name == "3d":
                continue
            if text in seen_words(figure) and not (page.contains(box.x0, box.y0) and page.contains(box.x1, box.y1)):
                found.append(text.get_text())
    return found


def seen_words(figure: Figure) -> list[Text]:
    """Return every text that is drawn: of the figure, its legends, and titles and labels of axes."""
    seen = [*figure.texts, *(text for legend in legends_of(figure) for text in legend.get_texts())]
    if figure._suptitle is not None:
        seen.append(figure._suptitle)
    for axes in figure.axes:
        seen += [*words_of(axes), axes.title, axes.xaxis.label, axes.yaxis.label]
    return seen


def small_words(figure: Figure) -> list[str]:
    """Return texts that are hard to read."""
    return [
        f"{text.get_text()!r}: {text.get_fontsize():g} pt"
        for text in seen_words(figure)
        if text.get_text().strip() and text.get_fontsize() < SMALLEST_FONT
    ]


# ---- legends ----------------------------------------------------------------------------------------


def legends_of(figure: Figure) -> list[Legend]:
    """Return all legends."""
    return [*figure.legends, *(legend for axes in figure.axes if (legend := axes.get_legend()) is not None)]


def drawn_lines(figure: Figure) -> list[Line2D]:
    """Return the lines and markers that are in view of their axes."""
    return [line for axes in figure.axes for line in axes.lines if line.get_visible() and _in_view(axes, line)]


def _in_view(axes: Axes, line: Line2D) -> bool:
    points = np.asarray(line.get_transform().transform(np.asarray(line.get_xydata(), dtype=np.float64)))
    points = points[np.isfinite(points).all(axis=1)]
    room = axes.bbox.padded(2.0)
    if len(points) == 0:
        return False
    inside = any(room.contains(x, y) for x, y in points)
    return inside or (len(points) > 1 and crosses(points, room))


def _marker(line: Any) -> str:
    """Return a word for the shape of a marker; turned triangles are one shape."""
    marker = line.get_marker() if isinstance(line, Line2D) else None
    if marker is None or marker in NO_LINE:
        return ""
    return f"polygon of {marker[0]}" if isinstance(marker, tuple) else str(marker)


def _first(colors: Any) -> tuple[float, float, float]:
    """Return the first of one or several colors; white without one."""
    found = np.atleast_2d(np.asarray(to_rgba_array(colors)))
    return to_rgb(found[0]) if len(found) else (1.0, 1.0, 1.0)


def _face(handle: Any) -> tuple[float, float, float]:
    """Return the color of the area of a patch or of the first of a collection."""
    return _first(handle.get_facecolor())


def _edge(handle: Any) -> tuple[float, float, float]:
    """Return the color of the edge of a patch or of the first of a collection."""
    return _first(handle.get_edgecolor())


def unnamed_marks(figure: Figure) -> list[str]:
    """Return shapes of markers that are drawn, but neither in a legend nor beside a label; caps of intervals aside."""
    named = {_marker(handle) for legend in legends_of(figure) for handle in legend.legend_handles}
    said = {tuple(np.round(text.xy, 9)) for axes in figure.axes for text in words_of(axes) if hasattr(text, "xy")}
    found = set()
    for line in drawn_lines(figure):
        alone = line.get_linestyle() in NO_LINE or len(line.get_xdata()) == 1
        labelled = len(line.get_xdata()) == 1 and tuple(np.round(line.get_xydata()[0], 9)) in said
        if _marker(line) and line.get_label() != "_nolegend_" and alone and _marker(line) not in named and not labelled:
            found.add(_marker(line))
    return sorted(found)


def unnamed_lines(figure: Figure) -> list[str]:
    """Return dashed and dotted lines whose look is in no legend, in pictures that have one; short ones aside.

    A line is named by an entry of its color, or of neutral color and its dashes.
    """
    handles = [handle for legend in legends_of(figure) for handle in legend.legend_handles]
    named = {to_rgb(handle.get_color()) for handle in handles if isinstance(handle, Line2D)}
    named |= {to_rgb(handle.get_markeredgecolor()) for handle in handles if isinstance(handle, Line2D)}
    named |= {_face(each) for each in handles if hasattr(each, "get_facecolor")}
    return sorted(
        {
            f"{line.get_label()!r} in {line.get_color()}"
            for line in drawn_lines(figure)
            if handles
            and line.get_linestyle() not in {"-", *NO_LINE}
            and to_rgb(line.get_color()) not in named
            and not any(isinstance(each, Line2D) and each.get_linestyle() == line.get_linestyle() for each in handles)
            and not (line.get_color() == style.NEUTRAL or words_near(line))
        }
    )


def words_near(line: Line2D) -> bool:
    """Return whether a label in the color of a line names it in its axes."""
    return any(to_rgb(text.get_color()) == to_rgb(line.get_color()) for text in words_of(line.axes))


def empty_entries(figure: Figure) -> list[str]:
    """Return legend entries of nothing that is drawn: no line of their color, no mark of their shape, no such patch."""
    lines = drawn_lines(figure)
    drawn = {to_rgb(line.get_color()) for line in lines if line.get_linestyle() not in NO_LINE}
    marks = {_marker(line) for line in lines}
    patches = {to_rgb(patch.get_facecolor()) for axes in figure.axes for patch in axes.patches}
    edges = {to_rgb(patch.get_edgecolor()) for axes in figure.axes for patch in axes.patches}
    areas = {to_rgb(color) for axes in figure.axes for each in axes.collections for color in each.get_facecolor()}
    areas |= {to_rgb(color) for axes in figure.axes for each in axes.collections for color in each.get_edgecolor()}
    found = []
    for legend in legends_of(figure):
        for handle, text in zip(legend.legend_handles, legend.get_texts(), strict=True):
            if isinstance(handle, Line2D):
                shape = _marker(handle)
                color = to_rgb(handle.get_color())
                generic = color == to_rgb(style.NEUTRAL) or color == (0.0, 0.0, 0.0)
                there = shape in marks | {"o", ">"} if shape else generic or color in drawn | edges | areas
            elif hasattr(handle, "get_facecolor") and to_rgb(style.NEUTRAL) != _edge(handle):
                there = not {_face(handle), _edge(handle)}.isdisjoint(patches | areas)
            else:
                there = True  # grey samples of regions stand for every color
            if not there:
                found.append(text.get_text())
    return found


# ---- views ------------------------------------------------------------------------------------------


def hidden_walls(figure: Figure, obstacles: tuple[nav.Obstacle, ...]) -> list[str]:
    """Return standing obstacles that are not wholly in view of every axes with equal scales."""
    found = []
    for axes in figure.axes:
        if axes.get_aspect() != 1.0:
            continue
        (left, right), (bottom, top) = axes.get_xlim(), axes.get_ylim()
        for obstacle in obstacles:
            if not shapes.is_mobile(obstacle):
                box = shapes.body(obstacle, shapes.center(obstacle)).get_extents()
                if box.x0 < left or box.x1 > right or box.y0 < bottom or box.y1 > top:
                    found.append(f"{obstacle}")
    return found


def uneven_paths(figure: Figure) -> list[str]:
    """Return axes in m by m without equal scales."""
    return [
        axes.get_xlabel()
        for axes in figure.axes
        if axes.name != "3d"
        and axes.get_xlabel() == "x (m)"
        and axes.get_ylabel() == "y (m)"
        and axes.get_aspect() != 1.0
    ]


def unlabelled_axes(figure: Figure) -> list[str]:
    """Return axes with ticks but neither a label nor a neighbor that has one."""
    found = []
    for axes in figure.axes:
        if axes.name == "3d" or not axes.axison or not axes.get_visible():
            continue
        for which, label, ticks in (
            ("x", axes.get_xlabel(), axes.get_xticklabels()),
            ("y", axes.get_ylabel(), axes.get_yticklabels()),
        ):
            shown = [text.get_text() for text in ticks if text.get_visible() and text.get_text()]
            numbers = [text for text in shown if text.replace("\u2212", "-").replace(".", "").lstrip("-+").isdigit()]
            if len(numbers) > 1 and not label:
                shared = axes.get_shared_x_axes() if which == "x" else axes.get_shared_y_axes()
                others = shared.get_siblings(axes)
                if not any((each.get_xlabel() if which == "x" else each.get_ylabel()) for each in others):
                    found.append(f"{which} of {axes.get_title()!r}")
    return found


def assert_readable(figure: Figure, obstacles: tuple[nav.Obstacle, ...] = ()) -> None:
    """Raise unless a picture keeps everything."""
    laid_out(figure)
    checks: dict[str, list[str]] = {
        "labels struck through": struck_labels(figure),
        "curves below a legend": covered_curves(figure),
        "labels on each other": piled_labels(figure),
        "words outside the picture": lost_words(figure),
        "words too small": small_words(figure),
        "marks without a name": unnamed_marks(figure),
        "lines without a name": unnamed_lines(figure),
        "legend entries of nothing": empty_entries(figure),
        "obstacles out of view": hidden_walls(figure, obstacles),
        "paths without equal scales": uneven_paths(figure),
        "axes without a label": unlabelled_axes(figure),
    }
    assert not any(checks.values()), {name: found for name, found in checks.items() if found}
