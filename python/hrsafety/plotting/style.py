"""One look for every picture: sizes, fonts and colors, without global state."""

from __future__ import annotations

import functools
import importlib.util
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, ParamSpec, TypeVar

import numpy as np

from hrsafety.errors import HrsafetyError, MissingExtraError
from hrsafety.plotting.given import check_given

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.colorbar import Colorbar
    from matplotlib.figure import Figure

__all__ = ["MissingExtraError"]

P = ParamSpec("P")
R = TypeVar("R")
Properties = dict[str, Any]
Limits = tuple[tuple[float, float], tuple[float, float]]

WIDTH = 8.0  # figure width in inch: 800 px wide at 100 dpi, with text that can still be read
DPI = 150
FONT_SIZE = 11.0
SMALL_FONT_SIZE = 9.5

# Okabe and Ito's colors, which differ for every common kind of color vision, split into those
# for runs (cool) and for what the robot meets (warm and grey).
RUN_COLORS = ("#0072B2", "#009E73", "#CC79A7", "#000000", "#56B4E9")
RUN_STYLES = ("-", (0, (6, 2)), (0, (4, 1.5, 1, 1.5)), (0, (1.5, 1.5)), "-")
PERSON_COLORS = ("#D55E00", "#E69F00", "#CC79A7", "#6B3E00", "#882255", "#F4A582")
MOVING_COLORS = ("#AA4499", "#882255", "#CC79A7")
STATIONARY_COLORS = ("#404040", "#8A8A8A", "#6A8030", "#5A7A8C", "#A08060", "#303060")
WHEEL_COLORS = ("#0072B2", "#E69F00", "#009E73", "#CC79A7")
CONTACT_COLOR = "#C00000"
GOAL_COLOR = "#00795C"
NEUTRAL = "#555555"
ACTIVE_ALPHA = 0.13
CRITICAL_ALPHA = 0.30

LEGEND_BESIDE: Properties = {"loc": "upper left", "bbox_to_anchor": (1.01, 1.02), "borderaxespad": 0.0}

_LOOK: Properties = {
    "font.family": "sans-serif",
    "font.sans-serif": ["DejaVu Sans"],  # ships with matplotlib: the same picture everywhere
    "mathtext.fontset": "dejavusans",
    "font.size": FONT_SIZE,
    "axes.titlesize": FONT_SIZE + 1.0,
    "axes.labelsize": FONT_SIZE,
    "figure.titlesize": FONT_SIZE + 1.5,
    "legend.fontsize": SMALL_FONT_SIZE,
    "legend.frameon": False,
    "legend.handlelength": 2.2,
    "xtick.labelsize": FONT_SIZE - 0.5,
    "ytick.labelsize": FONT_SIZE - 0.5,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.linewidth": 0.8,
    "axes.grid": True,
    "axes.axisbelow": True,
    "axes.formatter.useoffset": False,
    "grid.color": "#E3E3E3",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.8,
    "image.cmap": "viridis",
}


def require_matplotlib() -> None:
    """Raise `MissingExtraError` unless matplotlib can be imported."""
    try:
        found = importlib.util.find_spec("matplotlib") is not None
    except ValueError:  # a module that is marked as missing has no specification
        found = False
    if not found:
        raise MissingExtraError("pictures need matplotlib: pip install matplotlib")


def styled(function: Callable[P, R]) -> Callable[P, R]:
    """Run a plotting function with the look of this package, leaving matplotlib's settings alone.

    Where a picture fails, the plain argument that its annotation forbids is named. Numbers that overflow on the way to
    a pixel are no warnings.
    """

    @functools.wraps(function)
    def wrapper(*args: P.args, **kwargs: P.kwargs) -> R:
        require_matplotlib()
        from matplotlib import rc_context

        with rc_context(_LOOK), np.errstate(all="ignore"):  # type: ignore[arg-type]  # keys are literals to matplotlib
            try:
                return function(*args, **kwargs)
            except HrsafetyError:
                raise
            except Exception:
                check_given(function, args, kwargs)
                raise

    return wrapper


def new_figure(
    height: float, *, width: float = WIDTH, title: str | None = None, dpi: float = DPI, compressed: bool = False
) -> Figure:
    """Return an empty figure, in inch, that fits its contents by itself."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), dpi=dpi, layout="compressed" if compressed else "constrained")
    figure.get_layout_engine().set(w_pad=0.06, h_pad=0.08)  # type: ignore[union-attr, call-arg]  # constrained layout has both
    if title is not None:
        figure.suptitle(title)
    return figure


def one_panel(height: float, **options: Any) -> tuple[Figure, Axes]:
    """Return an empty figure with axes that fill it; options as for `new_figure`."""
    figure = new_figure(height, **options)
    return figure, figure.subplots()


def scene_height(
    limits: Limits,
    *,
    rows: int = 1,
    columns: int = 1,
    legend_rows: int = 0,
    titled: bool = False,
    color_bar: bool = False,
) -> float:
    """Return the height in inch at which equal axes fill the width of a figure."""
    (left, right), (bottom, top) = limits
    panel_width = (WIDTH - 0.75 - (1.05 if color_bar else 0.0)) / columns - 0.1
    panel_height = panel_width * (top - bottom) / (right - left)
    panel_title = 0.3 if rows * columns > 1 else 0.0
    return rows * (panel_height + panel_title) + 0.72 + 0.24 * legend_rows + (0.38 if titled else 0.0)


def frame_scene(axes: Axes, limits: Limits) -> None:
    """Give axes equal scales, limits in m and labels."""
    axes.set_aspect("equal")
    axes.set_xlim(*limits[0])
    axes.set_ylim(*limits[1])
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")


def legend_below(figure: Figure, handles: Sequence[Artist], *, columns: int) -> None:
    """Put a legend below all axes, where it covers nothing."""
    figure.legend(handles=list(handles), loc="outside lower center", ncols=columns, columnspacing=1.4)


def run_look(index: int) -> Properties:
    """Return color and line style of the run with this index; they differ in both."""
    return {
        "color": RUN_COLORS[index % len(RUN_COLORS)],
        "linestyle": RUN_STYLES[(index + index // len(RUN_COLORS)) % len(RUN_STYLES)],
    }


def log_ticks(low: float, high: float) -> tuple[list[float], list[str]]:
    """Return ticks of a logarithmic scale, few enough to be read, and their labels as plain numbers."""
    decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    for digits in ((1,), (1, 3), (1, 2, 5), (1, 1.5, 2, 3, 4, 5, 6, 8)):
        ticks = [digit * 10.0**decade for decade in decades for digit in digits]
        ticks = [tick for tick in ticks if low <= tick <= high]
        if len(ticks) >= 3:
            break
    return ticks, [f"{tick:g}" if 1e-3 <= tick < 1e5 else f"$10^{{{math.log10(tick):g}}}$" for tick in ticks]


def set_log_ticks(bar: Colorbar, low: float, high: float) -> None:
    """Give a logarithmic color bar ticks with plain numbers."""
    ticks, labels = log_ticks(low, high)
    bar.set_ticks(ticks, labels=labels)
    bar.minorticks_off()
