"""Doubts about a result, written below its picture."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, ParamSpec, TypeVar
from weakref import WeakSet

from hrsafety._calls import suggesting
from hrsafety.plotting import style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

P = ParamSpec("P")
R = TypeVar("R")

MOST_WARNINGS = 2  # more are counted
_LINE = 0.19  # in
_LEFT = 0.1  # in, beside a note
_POINTS_PER_INCH = 72.0
_EDGE = 0.08  # in


def picture(function: Callable[P, R]) -> Callable[P, R]:
    """Make a function draw with the look of this package, and write the doubts about what it is given below.

    Parameters
    ----------
    function : callable
        Draws; of a figure that it returns the warnings of its arguments are the note, unless it has one already.

    Returns
    -------
    callable
        With the same arguments.
    """
    asked = suggesting(function)

    @functools.wraps(function)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> R:
        from matplotlib.figure import Figure

        drawn = asked(*args, **kwargs)
        if isinstance(drawn, Figure) and drawn not in _noted:
            add_warnings(drawn, *_carriers((*args, *kwargs.values())))
        return drawn

    return style.styled(wrapper)


_noted: WeakSet[Figure] = WeakSet()
"""Figures that have their note."""


def _carriers(values: Iterable[object]) -> Iterator[object]:
    """Yield what may carry warnings: the values themselves, and those in sequences and mappings."""
    for each in values:
        if hasattr(each, "warnings"):
            yield each
        elif isinstance(each, Mapping):
            yield from _carriers(each.values())
        elif isinstance(each, (list, tuple)):
            yield from _carriers(each)


def add_warnings(figure: Figure, *results: object) -> None:
    """Write the warnings that results carry below everything else, and make room for them.

    Parameters
    ----------
    figure : Figure
        Finished but for this note.
    *results : object
        What is drawn. Each warning of their attribute ``warnings`` is written once, those that may be on the unsafe
        side first; of more than two the codes of the others are.
    """
    _noted.add(figure)
    words = warning_lines(results, float(figure.get_figwidth()))
    if not words:
        return
    room = _LINE * len(words) + _EDGE
    height = float(figure.get_figheight()) + room
    figure.set_figheight(height)
    share = room / height
    for legend in figure.legends:
        legend.set_bbox_to_anchor((0.0, share, 1.0, 1.0 - share), transform=figure.transFigure)
    engine = figure.get_layout_engine()
    if engine is not None:
        # A legend that is anchored has no room of its own any longer.
        share += _legend_height(figure) / height
        engine.set(rect=(0.0, share, 1.0, 1.0 - share))  # type: ignore[call-arg]  # constrained layout has a rectangle
    look: style.Properties = {"fontsize": style.SMALL_FONT_SIZE, "color": style.CONTACT_COLOR, "va": "bottom"}
    left = _LEFT / float(figure.get_figwidth())
    note = figure.text(left, 0.5 * _EDGE / height, "\n".join(words), linespacing=1.15, **look)
    note.set_in_layout(False)


def _legend_height(figure: Figure) -> float:
    """Return the height of the legends below all axes, with the space around them, in inches."""
    boxes = [legend.get_tightbbox() for legend in figure.legends]
    tall = [float(box.height) / float(figure.dpi) for box in boxes if box is not None]
    return max(tall) + 2.0 * _EDGE if tall else 0.0


def warning_lines(results: Iterable[object], width: float) -> list[str]:
    """Return the lines of a note that is so many inch wide; none without warnings."""
    every = (each for result in results for each in getattr(result, "warnings", ()))
    # A plain text is what a page or a table holds of a warning.
    found = sorted(dict.fromkeys(every), key=lambda each: bool(getattr(each, "safe_side", False)))
    shown = list(dict.fromkeys(map(str, found)))
    kinds = dict.fromkeys(str(getattr(each, "code", "")) for each in found if str(each) not in shown[:MOST_WARNINGS])
    if len(shown) > MOST_WARNINGS:
        named = ", ".join(filter(None, kinds)) or "warnings"
        shown[MOST_WARNINGS:] = [f"and {len(shown) - MOST_WARNINGS} more ({named}): see .warnings of the result"]
    room = max(width, 2.0) - 2.0 * _LEFT
    return [line.replace("$", r"\$") for each in shown for line in _wrapped(each, room)]


def _wrapped(text: str, room: float) -> Iterator[str]:
    """Yield the lines of a text in the small font that are at most so many inch wide; longer words are broken."""
    from matplotlib.font_manager import FontProperties
    from matplotlib.textpath import text_to_path

    font = FontProperties(size=style.SMALL_FONT_SIZE)

    def fits(part: str) -> bool:
        return text_to_path.get_text_width_height_descent(part, font, ismath=False)[0] <= _POINTS_PER_INCH * room

    line = ""
    for word in text.split():
        if line and not fits(f"{line} {word}"):
            yield line
            line = ""
        line = f"{line} {word}" if line else word
        while not fits(line) and len(line) > 1:
            end = next((end for end in range(len(line) - 1, 0, -1) if fits(line[:end])), 1)
            yield line[:end]
            line = line[end:]
    if line:
        yield line
