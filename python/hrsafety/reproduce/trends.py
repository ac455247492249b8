"""Printed and measured values of appendix C over the change of a gain."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hrsafety.pages import Picture
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.figures import captioned

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["make"]

# Gain as a reader knows it, its table of T, L, d and its table of scores.
GAINS = (("K_1", "C.2", "C.3"), ("K_3", "C.4", "C.5"), ("K_5", "C.6", "C.7"), ("b", "C.8", "C.9"))
# Panels: label and the columns of configuration 1, 2, 3. The heads of the two distance columns
# of configuration 3 are exchanged in the source: this is the distance to the rectangle.
PANELS = (
    ("arrival time (s)", ("T_arrive_1", "T_arrive_2", "T_arrive_3")),
    ("least distance (m)", ("d_circle_min_1", "d_human_min_2", "d_circle_min_3")),
    ("score H", ("H_1", "H_2", "H_3")),
)
NAMES = ("c1, disc", "c2, person", "c3, rectangle")
COLORS = ("#0072B2", "#D55E00", "#009E73")


def make(cells: Sequence[PrintedValue]) -> list[Picture]:
    """Draw one picture for each gain: time, distance and score over its change."""
    pictures = []
    for gain, *tables in GAINS:
        own = [cell for cell in cells if cell.table in tables]
        pictures.append(
            captioned(
                f"trend-{gain.replace('_', '').lower()}",
                _figure(gain, own),
                key="trend",
                gain=gain,
                tables=" and ".join(tables),
            )
        )
    return pictures


def _figure(gain: str, cells: Sequence[PrintedValue]) -> Figure:
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8.0, 3.4), layout="constrained")
    panels = figure.subplots(1, len(PANELS))
    for axes, (label, columns) in zip(panels, PANELS, strict=True):
        for column, name, color in zip(columns, NAMES, COLORS, strict=True):
            _draw(axes, [cell for cell in cells if cell.column == column], name, color)
        symbol = f"${gain}$" if "_" in gain else f"$\\mathit{{{gain}}}$"
        axes.set_xlabel(f"change of {symbol} (%)")
        axes.set_ylabel(label)
        axes.grid(color="#E3E3E3", linewidth=0.6)
        axes.spines[["top", "right"]].set_visible(False)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=3, frameon=False, fontsize=9)
    return figure


def _draw(axes: Axes, cells: Sequence[PrintedValue], name: str, color: str) -> None:
    changes = [float(cell.row.removesuffix(" %")) for cell in cells]
    measured = [cell.measured if isinstance(cell.measured, float) else float("nan") for cell in cells]
    printed = [float(cell.printed) for cell in cells]
    axes.plot(changes, measured, color=color, linewidth=1.6, label=f"{name}: measured")
    axes.plot(changes, printed, "o", color=color, markersize=4, fillstyle="none", label=f"{name}: printed")
