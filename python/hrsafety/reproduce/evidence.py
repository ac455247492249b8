"""The part of the summary page about the stabilizing force."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from html import escape

from hrsafety.reproduce.markup import head, scroll
from hrsafety.reproduce.names import GAIN_LABELS
from hrsafety.reproduce.statistics import Share
from hrsafety.reproduce.study import Aggregate, Study

__all__ = ["section"]


def section(result: Study) -> Iterator[str]:
    """Yield the comparison of the stabilizing modes.

    Parameters
    ----------
    result : Study
        What to show.

    Yields
    ------
    str
        HTML.
    """
    yield (
        "<p>Contacts first: the mode with the fewest runs with any contact is the reference; modes that a paired exact "
        "test (McNemar, Holm-corrected, 5 %) cannot tell from it stay in; among them most arrivals, by the same test; "
        "among those the highest mean H. All modes meet the same people and the same noise. A person here walks "
        "straight on and never gives way, so a robot that stands still is walked into as well.</p>"
    )
    for name, ranking in result.rankings.items():
        steps = "".join(f"<li>{escape(step)}</li>" for step in ranking.steps)
        title = GAIN_LABELS.get(name, name)
        yield f"<h3>Ranking, {escape(title)}: <strong>{escape(ranking.recommended)}</strong></h3><ol>{steps}</ol>"
    groups: dict[str, list[Aggregate]] = {}
    for aggregate in result.aggregates:
        groups.setdefault(aggregate.experiment, []).append(aggregate)
    single = [entry for group in groups.values() for entry in group if entry.arrivals.runs == 1]
    if single:
        yield "<h3>Configurations c1 to c4, everything known exactly</h3>"
        yield _single_runs(single)
    for experiment, group in groups.items():
        if group[0].arrivals.runs > 1:
            yield f"<h3>{escape(experiment[0].upper() + experiment[1:])}: {group[0].arrivals.runs} runs each</h3>"
            yield _many_runs(group)


def _single_runs(entries: Sequence[Aggregate]) -> str:
    header = head(["Where", "Gains", "Mode", "T (s)", "Least d (m)", "H", "V not growing", "Contact"])
    lines = []
    last = None
    for entry in entries:
        distances = " / ".join(f"{distance:.3f}" for distance in entry.min_distances)
        lines.append(
            ('<tr class="group">' if (entry.experiment, entry.gains) != last else "<tr>")
            + f'<th scope="row">{escape(entry.experiment)}</th><td class="text">{escape(GAIN_LABELS[entry.gains])}</td>'
            + f'<td class="text">{escape(entry.mode)}</td><td>{_number(entry.median_arrival_time, 2)}</td>'
            + f'<td class="text">{distances}</td><td>{entry.mean_score:.3f}</td>'
            + f"<td>{_percent(entry.descent_share)}</td><td>{'yes' if entry.contacts.count else 'no'}</td></tr>"
        )
        last = (entry.experiment, entry.gains)
    return scroll(f"<table>{header}<tbody>{''.join(lines)}</tbody></table>")


def _many_runs(entries: Sequence[Aggregate]) -> str:
    header = head(
        [
            "Gains",
            "Mode",
            "Contact, robot moving",
            "Contact, robot standing",
            "Any contact",
            "Arrived",
            "Median T (s)",
            "Mean H",
            "Least clearance, 5 % / median (m)",
            "V not growing",
            "Contact only here / only off, p",
        ]
    )
    lines = []
    last = None
    for entry in entries:
        paired = entry.against_off
        against = f"{paired.only_first} / {paired.only_second}, {paired.p_value:.2g}"
        lines.append(
            ('<tr class="group">' if entry.gains != last else "<tr>")
            + f'<th scope="row">{escape(GAIN_LABELS[entry.gains])}</th><td class="text">{escape(entry.mode)}</td>'
            + f"<td>{_share(entry.contacts_moving)}</td><td>{_share(entry.contacts_standing)}</td>"
            + f"<td>{_share(entry.contacts)}</td><td>{_percent(entry.arrivals.value)}</td>"
            + f"<td>{_number(entry.median_arrival_time, 2)}</td><td>{entry.mean_score:.3f}</td>"
            + f"<td>{entry.clearance_low:.3f} / {entry.clearance_median:.3f}</td>"
            + f"<td>{_percent(entry.descent_share)}</td><td>{'&ndash;' if entry.mode == 'off' else against}</td></tr>"
        )
        last = entry.gains
    note = "<p>Shares with 95 % Wilson intervals.</p>"
    return scroll(f"<table>{header}<tbody>{''.join(lines)}</tbody></table>") + note


def _share(share: Share) -> str:
    return f"{100 * share.value:.1f} % [{100 * share.low:.1f}, {100 * share.high:.1f}]"


def _percent(value: float) -> str:
    return f"{100 * value:.1f} %" if math.isfinite(value) else "&ndash;"


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "&ndash;"
