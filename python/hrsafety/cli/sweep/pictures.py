"""Pictures of ``hrsafety sweep``: as many axes as the design has, so is the picture."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from hrsafety.sweep import Grid, SweepResult

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["make"]

# A larger grid is drawn from by chance.
MOST_ON_A_MAP = 4_000_000


def make(result: SweepResult, show: Sequence[str]) -> Iterator[tuple[str, Figure, str]]:
    """Draw columns of a sweep.

    Parameters
    ----------
    result : SweepResult
        The sweep.
    show : sequence of str
        Columns of numbers.

    Yields
    ------
    (str, Figure, str)
        File name without ending, picture, caption.
    """
    from hrsafety import plotting

    varying = [axis for axis in result.axes if axis.values is None or len(axis.values) > 1]
    labels = {column.name: column.label for column in result.columns}
    regular = isinstance(result.design, Grid) and len(result) <= MOST_ON_A_MAP
    for name in show if varying else ():
        words = f"{labels[name][0].upper()}{labels[name][1:]}"
        if len(varying) == 1 and len(result) <= MOST_ON_A_MAP:
            yield f"lines_{name}", plotting.sweep_lines(result, name), f"{words} over {varying[0].label}"
        elif len(varying) == 2 and regular:
            axes = " and ".join(axis.label for axis in varying)
            yield f"map_{name}", plotting.sweep_map(result, name), f"{words} over {axes}"
        else:
            yield f"points_{name}", plotting.sweep_scatter(result, name), f"{words} over each axis, all others varying"
            yield f"parallel_{name}", plotting.sweep_parallel(result, name), f"Rows across the axes, by {labels[name]}"
