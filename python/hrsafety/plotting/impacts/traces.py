"""Measured records: traces with their contacts, peaks and limits."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from hrsafety._arguments import instance, positive
from hrsafety.errors import InvalidParameterError
from hrsafety.plotting import notes, style
from hrsafety.plotting.impacts.histories import LIMIT_LOOK, MILLI, PEAK_LOOK

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from hrsafety.records import AccelerationRecord, ForceRecord

__all__ = ["measured_records"]

_SHADE = 0.08


@notes.picture
def measured_records(
    records: Sequence[AccelerationRecord | ForceRecord],
    *,
    names: Sequence[str] | None = None,
    limits: Mapping[str, float] | None = None,
    title: str | None = None,
) -> Figure:
    """Draw measured records of one kind, with contact periods shaded, peaks marked and limits as lines.

    Parameters
    ----------
    records : sequence of AccelerationRecord or ForceRecord
        At least one.
    names : sequence of str or None
        Names of the records.
    limits : mapping of str to float or None
        Levels in the unit of the records by what they are called.
    title : str or None
        Title of the figure.

    Returns
    -------
    matplotlib.figure.Figure
        One panel.

    Raises
    ------
    InvalidParameterError
        If there is no record, or they are of different kinds.
    MissingExtraError
        If matplotlib is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import plotting, records
    >>> time = np.arange(0.0, 1.0, 5e-4)
    >>> push = np.where((time >= 0.2) & (time <= 0.26), 180.0 * np.sin(np.pi * (time - 0.2) / 0.06), 0.0)
    >>> figure = plotting.measured_records([records.force(time, push)], limits={"transient limit": 280.0})
    """
    from hrsafety.records import AccelerationRecord, ForceRecord

    given: list[AccelerationRecord | ForceRecord] = []
    for place, each in enumerate(records):
        instance(f"records[{place}]", each, AccelerationRecord, ForceRecord)
        given.append(each)
    if len({type(each) for each in given}) != 1:
        raise InvalidParameterError("records", "be one or more of one kind", [type(each).__name__ for each in given])
    labels = [f"record {place + 1}" for place in range(len(given))] if names is None else [str(each) for each in names]
    if len(labels) != len(given):
        raise InvalidParameterError("names", f"name {len(given)} records", labels)
    figure, axes = style.one_panel(3.6, title=title)
    for place, (each, label) in enumerate(zip(given, labels, strict=True)):
        look = style.run_look(place)
        if isinstance(each, AccelerationRecord):
            values, peak, spans = each.signal_g, each.peak_g, [(each.start, each.end)]
        else:
            values, peak = each.force, each.peak
            spans = [(contact.start, contact.end) for contact in each.contacts]
        axes.plot(MILLI * each.time, values, label=label, **look)
        look_of_peak = PEAK_LOOK | {"color": look["color"], "label": "peak" if place == 0 else "_peak"}
        axes.plot(MILLI * each.peak_time, peak, **look_of_peak)
        for start, end in spans:
            first, last = (
                bound if bound is not None else edge for bound, edge in ((start, each.time[0]), (end, each.time[-1]))
            )
            axes.axvspan(MILLI * first, MILLI * last, color=look["color"], alpha=_SHADE, linewidth=0.0)
    for name, level in (limits or {}).items():
        axes.axhline(positive(f"limits[{name!r}]", level), label=name, **LIMIT_LOOK)
    axes.set_xlabel("time (ms)")
    axes.set_ylabel("acceleration (g)" if isinstance(given[0], AccelerationRecord) else "contact force (N)")
    axes.margins(x=0.0)
    handles, texts = axes.get_legend_handles_labels()
    figure.legend(handles, texts, loc="outside lower center", ncols=3)
    notes.add_warnings(figure, *given)
    return figure
