"""Who stands where after many episodes: shares of success and contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.arena import ranks
from hrsafety.benchmarks import Result
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.comparison import Comparison
from hrsafety.plotting import inputs, notes, style
from hrsafety.plotting.comparisons.studies import OUTCOME_COLORS
from hrsafety.plotting.floor import handle

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from hrsafety.navigation.metrics import Share

__all__ = ["comparison_standings"]

ROW_HEIGHT = 0.42
MOST_DRAWS = 100_000_000
"""Episodes that are drawn again in all for the intervals of ranks."""


@notes.picture
def comparison_standings(result: Comparison | Result, *, title: str | None = None) -> Figure:
    """Draw the shares of success and of contact of each law with their 95 % intervals.

    Below the share of the episodes with a contact, a hollow circle is the share of those with a contact at fault, and a
    cross that of those in which the robot was touched from behind or from the side while it moved. The last panel has
    the rank of each law by its success, with the 95 % interval over episodes that are drawn again.

    Parameters
    ----------
    result : Comparison or Result
        What `hrsafety.navigation.compare` or `hrsafety.benchmarks.benchmark` returned.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, one axes for success, one for contacts, as shares of the episodes, and one for ranks.

    Raises
    ------
    InvalidParameterError
        If the result is neither.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> laws = {"field": nav.VirtualForceField(), "Masoud": nav.Masoud()}
    >>> episodes = [scenarios.random_traffic(3, seed=seed) for seed in range(10)]
    >>> figure = plotting.comparison_standings(nav.compare(episodes, laws))
    >>> [tick.get_text() for tick in figure.axes[0].get_yticklabels()]
    ['field', 'Masoud']
    """
    if not isinstance(result, (Comparison, Result)):
        raise InvalidParameterError(
            "result", "be a Comparison or the Result of a benchmark", Shown(type(result).__name__)
        )
    if isinstance(result, Result) and not (result.rows and all(result.rows.values())):
        raise InvalidParameterError("result.rows", "hold an episode of each entry", Shown("none"))
    names, shares, success = _of_comparison(result) if isinstance(result, Comparison) else _of_benchmark(result)
    figure = style.new_figure(1.35 + ROW_HEIGHT * len(names) + (0.4 if title is not None else 0.0), title=title)
    left, right, places = figure.subplots(1, 3, sharey=True, width_ratios=(3, 3, 2))
    blue, red = OUTCOME_COLORS["arrived"], OUTCOME_COLORS["contact"]
    _draw_shares(left, shares[0], blue, offset=0.0)
    _draw_shares(right, shares[1], red, offset=-0.2)
    _draw_shares(right, shares[2], red, offset=0.0, face="white")
    _draw_shares(right, shares[3], red, offset=0.2, marker="x")
    left.set_yticks(range(len(names)), names)
    left.set_ylim(len(names) - 0.5, -0.5)
    episodes = f"of {success.shape[1]} episodes"
    for axes, words in ((left, "arrived without contact"), (right, "with a contact")):
        axes.set_xlim(-0.03, 1.03)
        axes.set_xlabel(f"share {episodes}")
        axes.set_title(words)
    if success.size:
        _draw_ranks(places, success)
    handles = [
        handle("arrived without contact", marker="o", markersize=7, color=blue),
        handle("with a contact", marker="o", markersize=7, color=red),
        handle("at fault", marker="o", markersize=7, color=red, markerfacecolor="white"),
        handle("touched from behind or from the side", marker="x", markersize=7, color=red),
    ]
    style.legend_below(figure, handles, columns=len(handles))
    return figure


def _of_comparison(result: Comparison) -> tuple[list[str], list[list[Share]], inputs.Array]:
    """Return names of laws, shares of success, contact, fault and touches from behind, and each success by law."""
    standings = result.standings()
    shares = [
        [each.success for each in standings],
        [each.contact for each in standings],
        [each.at_fault for each in standings],
        [each.away_contact for each in standings],
    ]
    return [each.law for each in standings], shares, (result.outcome == "arrived").astype(np.float64)


def _of_benchmark(result: Result) -> tuple[list[str], list[list[Share]], inputs.Array]:
    """Return the same of a benchmark; episodes that some entry has not run count for no rank."""
    names = list(result.rows)
    found = (result.success, result.contact, result.at_fault, result.away)
    cases = set.intersection(*({row.case for row in rows} for rows in result.rows.values()))
    success = [[row.outcome == "arrived" for row in rows if row.case in cases] for rows in result.rows.values()]
    return names, [[share(name) for name in names] for share in found], np.array(success, dtype=np.float64)


def _draw_ranks(axes: Axes, success: inputs.Array) -> None:
    """Draw the rank of each law by its successes, and its interval."""
    laws, episodes = success.shape
    found = ranks(success[:, np.newaxis], replicates=int(np.clip(MOST_DRAWS // (laws * episodes), 50, 2000)))
    beyond = np.stack([found.median - found.low, found.high - found.median])
    look: style.Properties = {"color": style.NEUTRAL, "capsize": 2.5, "markersize": 6}
    axes.errorbar(found.median, np.arange(laws), xerr=beyond, fmt="D", **look)
    axes.set_xlim(laws + 0.4, 0.6)
    axes.set_xticks(sorted({1, laws} if laws > 4 else set(range(1, laws + 1))))
    axes.set_xlabel("rank")
    axes.set_title("by success")


def _draw_shares(
    axes: Axes, shares: Sequence[Share], color: str, *, offset: float, face: str | None = None, marker: str = "o"
) -> None:
    """Draw shares and their intervals, one row for each."""
    value = np.array([share.value for share in shares])
    beyond = np.array([[share.value - share.low, share.high - share.value] for share in shares]).T
    look: style.Properties = {"color": color, "markerfacecolor": color if face is None else face, "capsize": 2.5}
    axes.errorbar(
        value,
        np.arange(len(shares)) + offset,
        xerr=np.maximum(beyond, 0.0),
        fmt=marker,
        markersize=6,
        zorder=3,
        **look,
    )
