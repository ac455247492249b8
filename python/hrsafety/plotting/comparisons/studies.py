"""Pictures of many runs: clearances and outcomes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import numbers
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.outcomes import OUTCOMES
from hrsafety.navigation.tables.runs import RunTable
from hrsafety.plotting import notes, style
from hrsafety.plotting.axis_numbers import blank_where_infinite

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

__all__ = ["clearances", "outcomes"]

Array = npt.NDArray[np.float64]
MOST_COUNTED = 2.0**53
"""Numbers up to this are whole without rounding."""
Counts = npt.NDArray[np.int64]

# From harmless to harmful; order of the bars and of the legend.
OUTCOME_COLORS = {
    "arrived": "#0072B2",
    "timed out": "#9CC9E3",
    "stopped": "#BDBDBD",
    "diverged": "#666666",
    "contact, robot standing": "#E69F00",
    "contact, robot moving away": "#E0A0A0",
    "contact, robot moving": "#C00000",
    "contact, robot moving toward it": "#C00000",
    "contact": "#C00000",
}
LEAST_SHARE_WITH_TEXT = 0.04
BAR_HEIGHT = 0.62


@notes.picture
def clearances(
    clearances: Mapping[str, RunTable | npt.ArrayLike],
    *,
    title: str | None = None,
) -> Figure:
    """Draw the distribution of the least clearance of many runs, one step curve for each group.

    The height of a curve at a clearance c is the share of runs that came as close as c or
    closer; where it crosses the line at zero it tells the share of runs with a contact. Runs
    that met no person have infinite clearance: they count, but their step is never reached.

    Parameters
    ----------
    clearances : mapping of str to RunTable or array_like, shape (n,)
        Least distance of the surfaces in each run in m, by the name of the group.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, in m and as a share of the runs.

    Raises
    ------
    InvalidParameterError
        If there is no group, a group is empty or holds NaN, or no run met anybody.
    ShapeError
        If an array is not one-dimensional.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting
    >>> figure = plotting.clearances({"off": [0.1, 0.4, -0.05], "capped": [0.2, 0.3, 0.5]})
    >>> figure.axes[0].get_xlabel()
    'least clearance (m)'
    """
    groups = {name: _checked_clearances(name, values) for name, values in _checked_groups("clearances", clearances)}
    finite = np.concatenate([values[np.isfinite(values)] for values in groups.values()])
    if len(finite) == 0:
        raise InvalidParameterError("clearances", "hold at least one finite value", Shown("only infinite values"))
    figure, axes = style.one_panel(3.8, title=title)
    low, high = min(0.0, float(finite.min())), max(0.0, float(finite.max()))
    pad = 0.03 * max(high - low, 0.1)
    axes.axvspan(low - 2.0 * pad, 0.0, color=style.CONTACT_COLOR, alpha=0.07, zorder=0.5)
    axes.axvline(0.0, color=style.CONTACT_COLOR, linewidth=1.2, zorder=1.5)
    note: style.Properties = {
        "color": style.CONTACT_COLOR,
        "fontsize": style.SMALL_FONT_SIZE,
        "rotation": 90,
        "va": "top",
        "ha": "left",
    }
    axes.text(0.15 * pad, 0.98, " contact", transform=axes.get_xaxis_transform(), **note)
    for index, (name, values) in enumerate(groups.items()):
        contacts = int(np.count_nonzero(values < 0.0))
        label = f"{name}: {len(values)} runs, {contacts} with contact"
        axes.step(*_steps(values, high + pad), where="post", label=label, zorder=3.0, **style.run_look(index))
    axes.set_xlim(low - 2.0 * pad, high + pad)
    axes.set_ylim(0.0, 1.02)
    axes.set_xlabel("least clearance (m)")
    axes.set_ylabel("share of runs")
    figure.legend(loc="outside lower center", ncols=1 if len(groups) > 2 else len(groups))
    return figure


def _checked_groups(argument: str, groups: object) -> list[tuple[str, object]]:
    """Return the groups of a mapping as pairs."""
    if not isinstance(groups, Mapping) or len(groups) == 0:
        shown = "an empty mapping" if isinstance(groups, Mapping) else type(groups).__name__
        raise InvalidParameterError(argument, "be a mapping with at least one group of runs", shown)
    return [(str(name), values) for name, values in groups.items()]


def _checked_clearances(name: str, values: object) -> Array:
    """Return the sorted clearances of one group."""
    argument = f"clearances[{name!r}]"
    raw = values.min_clearance if isinstance(values, RunTable) else values
    try:
        array: Array = np.asarray(raw, dtype=np.float64)
    except (TypeError, ValueError):
        raise InvalidParameterError(argument, "be an array of numbers", Shown(type(values).__name__)) from None
    if array.ndim != 1:
        raise ShapeError(argument, "(n,)", array.shape)
    if len(array) == 0 or np.isnan(array).any():
        raise InvalidParameterError(argument, "be numbers without NaN, at least one", array)
    blank_where_infinite(argument, array)  # how large they are
    return np.sort(array)


def _steps(values: Array, end: float) -> tuple[Array, Array]:
    """Return corners of an empirical distribution function of sorted values, infinite ones left out."""
    finite = values[np.isfinite(values)]
    share = np.arange(1, len(finite) + 1) / len(values)
    if len(finite) == 0:
        return np.array([0.0, end]), np.zeros(2)
    return np.concatenate([finite[:1], finite, [end]]), np.concatenate([[0.0], share, share[-1:]])


@notes.picture
def outcomes(
    outcomes: Mapping[str, RunTable | Sequence[str] | npt.NDArray[np.str_]],
    *,
    contacts_moving: Mapping[str, npt.ArrayLike] | None = None,
    contacts_standing: Mapping[str, npt.ArrayLike] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw the shares of outcomes of many runs, one bar for each group.

    With counts of contacts, runs with a contact are split: those in which the robot was
    moving at the first contact with anybody, and those in which it always stood. Counts of a
    RunTable are used by themselves; of these the runs in which it moved are split into those in which it moved
    toward a person whom it touched, and those in which it was touched from behind or from the side only.

    Parameters
    ----------
    outcomes : mapping of str to RunTable or sequence of str, shape (n,)
        Outcome of each run (``"arrived"``, ``"collided"``, ``"timed_out"``, ``"stopped"``), by
        the name of the group.
    contacts_moving, contacts_standing : mapping of str to array_like, shape (n,), or None
        Number of contacts of each run while the robot moved, and while it stood, by the same
        names; both or none.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        The picture, as shares of the runs.

    Raises
    ------
    InvalidParameterError
        If there is no group, a group is empty, an outcome is unknown, only one mapping of
        contacts is given, or a group has no contacts in them.
    ShapeError
        If there is not one count for each run.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> from hrsafety import plotting
    >>> figure = plotting.outcomes({"off": ["arrived", "collided"], "capped": ["arrived", "arrived"]})
    >>> [tick.get_text() for tick in figure.axes[0].get_yticklabels()]
    ['off (n = 2)', 'capped (n = 2)']
    """
    if (contacts_moving is None) != (contacts_standing is None):
        missing = "contacts_moving" if contacts_moving is None else "contacts_standing"
        raise InvalidParameterError(missing, "be given together with the other counts", None)
    bars: dict[str, dict[str, int]] = {}
    for name, values in _checked_groups("outcomes", outcomes):
        words = _checked_outcomes(name, values)
        contacts = _checked_contacts(name, values, len(words), contacts_moving, contacts_standing)
        if contacts is not None and contacts_moving is None and isinstance(values, RunTable):
            contacts = (*contacts, values.contacts_toward)
        bars[f"{name} (n = {len(words)})"] = _counts(words, contacts)
    figure, axes = style.one_panel(1.1 + 0.52 * len(bars) + (0.4 if title is not None else 0.0), title=title)
    _draw_bars(axes, bars)
    figure.legend(loc="outside lower center", ncols=3)
    return figure


def _checked_outcomes(name: str, values: object) -> npt.NDArray[np.str_]:
    """Return the outcomes of one group."""
    argument = f"outcomes[{name!r}]"
    words = np.asarray(values.outcome if isinstance(values, RunTable) else values)
    if words.ndim != 1:
        raise ShapeError(argument, "(n,)", words.shape)
    known = set(OUTCOMES)
    strange = sorted({str(word) for word in words} - known)
    if len(words) == 0 or strange:
        shown = strange[0] if strange else "an empty group"
        raise InvalidParameterError(argument, f"hold only {', '.join(sorted(known))}", shown)
    return words.astype(np.str_)


def _checked_contacts(
    name: str,
    values: object,
    count: int,
    moving: Mapping[str, npt.ArrayLike] | None,
    standing: Mapping[str, npt.ArrayLike] | None,
) -> tuple[Counts, ...] | None:
    """Return the number of contacts of each run of a group, moving and standing, if known."""
    if moving is None or standing is None:
        return (values.contacts_moving, values.contacts_standing) if isinstance(values, RunTable) else None
    found = []
    for argument, counts in (("contacts_moving", moving), ("contacts_standing", standing)):
        if name not in counts:
            raise InvalidParameterError(argument, f"hold the group {name!r}", sorted(counts))
        array = _whole(f"{argument}[{name!r}]", counts[name])
        if array.shape != (count,):
            raise ShapeError(f"{argument}[{name!r}]", f"({count},)", array.shape)
        found.append(array)
    return found[0], found[1]


def _whole(name: str, values: npt.ArrayLike) -> npt.NDArray[np.int64]:
    """Return counts as such, or say what they should have been."""
    found = numbers(name, values)
    if not ((found >= 0.0) & (found <= MOST_COUNTED) & (found == np.floor(found))).all():
        raise InvalidParameterError(name, "be whole numbers that are not negative", values)
    return found.astype(np.int64)


def _counts(words: npt.NDArray[np.str_], contacts: tuple[Counts, ...] | None) -> dict[str, int]:
    """Return the number of runs of each outcome, runs with a contact split if counts are known.

    They are those of contacts moving, standing and, if it is known, moving toward a person.
    """
    whole = [word for word in OUTCOMES if word != "collided"]
    counts = {word.replace("_", " "): int(np.count_nonzero(words == word)) for word in whole}
    collided = words == "collided"
    if contacts is None:
        return counts | {"contact": int(np.count_nonzero(collided))}
    moving = collided & (contacts[0] > 0)
    counts["contact, robot standing"] = int(np.count_nonzero(collided & ~moving))
    if len(contacts) == 2:
        return counts | {"contact, robot moving": int(np.count_nonzero(moving))}
    toward = collided & (contacts[2] > 0)
    return counts | {
        "contact, robot moving away": int(np.count_nonzero(moving & ~toward)),
        "contact, robot moving toward it": int(np.count_nonzero(toward)),
    }


def _draw_bars(axes: Axes, bars: Mapping[str, Mapping[str, int]]) -> None:
    """Draw one stacked horizontal bar for each group, with the number of runs in each part."""
    present = [word for word in OUTCOME_COLORS if any(bar.get(word, 0) for bar in bars.values())]
    left = np.zeros(len(bars))
    for word in present:
        number = np.array([bar.get(word, 0) for bar in bars.values()])
        share = number / np.array([sum(bar.values()) for bar in bars.values()])
        color = OUTCOME_COLORS[word]
        axes.barh(list(bars), share, BAR_HEIGHT, left=left, color=color, edgecolor="white", label=word, zorder=2.0)
        dark = word in {"arrived", "contact", "contact, robot moving", "contact, robot moving toward it"}
        for row in np.flatnonzero(share >= LEAST_SHARE_WITH_TEXT):
            look: style.Properties = {
                "ha": "center",
                "va": "center",
                "color": "white" if dark else "black",
                "zorder": 3.0,
            }
            axes.text(
                left[row] + share[row] / 2.0, float(row), str(number[row]), fontsize=style.SMALL_FONT_SIZE, **look
            )
        left += share
    axes.set_xlim(0.0, 1.0)
    axes.set_xlabel("share of runs")
    axes.invert_yaxis()
    axes.grid(visible=False, axis="y")
