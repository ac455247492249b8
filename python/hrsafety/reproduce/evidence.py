"""The part of the summary page about the stabilizing force."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from html import escape

from hrsafety.navigation.metrics import Share
from hrsafety.reproduce.markup import head, scroll
from hrsafety.reproduce.names import GAIN_LABELS
from hrsafety.reproduce.ranking import BASELINE, Ranking
from hrsafety.reproduce.study import SIDES, Aggregate, Study

__all__ = ["section"]

_RULE = (
    "<p>All modes meet the same people and the same noise, so runs are compared in pairs. The rule: (1) a mode is "
    "out if it has significantly more runs with a contact than no force in any one experiment (exact McNemar "
    "test, Holm-corrected, 5 %), because a force that is meant to help must not harm anywhere; (2) over all runs "
    "with noise of &plusmn;0.025 m and all crowds, fewest runs with a contact, where differences that chance "
    "explains do not count; (3) most arrivals, likewise; (4) highest mean H. A person here walks straight on and "
    "never gives way, so a robot that stands still is walked into as well. Runs of both gain sets share their "
    "seeds, so p values of both together are somewhat too small.</p>"
)
_KEPT = (
    "<p>The law decides the side of a detour afresh each time unless <code>side_hysteresis</code> is set; kept beyond "
    "3 rad, noise cannot flip it while the robot is nearly head-on. That changes the head-on cases far more than the "
    "choice between off and capped does, so everything is shown for both.</p>"
)


def section(result: Study) -> Iterator[str]:
    """Yield the comparison of the stabilizing modes."""
    yield _RULE + _KEPT
    yield _rankings(result.rankings)
    yield "<p>Shares of runs stand with their 95 % Wilson intervals.</p>"
    default, *others = SIDES
    yield from _experiments([entry for entry in result.aggregates if entry.key.side == default])
    for side in others:
        tables = "".join(_experiments([entry for entry in result.aggregates if entry.key.side == side]))
        yield f"<details><summary>The same with the side of a detour {escape(side)}</summary>{tables}</details>"


def _rankings(rankings: Sequence[Ranking]) -> str:
    """Return what each ranking recommends, and the steps of the one that decides."""
    header = head(["Side of a detour", "Gains", "Mode", "Without rule 1"])
    lines = "".join(
        f'<tr><td class="text">{escape(ranking.side)}</td><td class="text">{escape(ranking.gains)}</td>'
        f'<td class="text"><strong>{escape(ranking.recommended)}</strong></td>'
        f'<td class="text">{escape(ranking.pooled_only)}</td></tr>'
        for ranking in rankings
    )
    steps = "".join(_steps(ranking, unfolded=ranking is rankings[0]) for ranking in rankings)
    return scroll(f"<table>{header}<tbody>{lines}</tbody></table>") + steps


def _steps(ranking: Ranking, *, unfolded: bool) -> str:
    items = "".join(f"<li>{escape(step)}</li>" for step in ranking.steps)
    title = f"Steps: side {escape(ranking.side)}, {escape(ranking.gains)}"
    return f"<details{' open' if unfolded else ''}><summary>{title}</summary><ol>{items}</ol></details>"


def _experiments(entries: Sequence[Aggregate]) -> Iterator[str]:
    """Yield one table for the single runs and one for each experiment with many runs."""
    single = [entry for entry in entries if entry.arrivals.runs == 1]
    if single:
        yield "<h3>Configurations c1 to c4, everything known exactly</h3>" + _single_runs(single)
    for experiment in dict.fromkeys(entry.key.experiment for entry in entries):
        group = [entry for entry in entries if entry.key.experiment == experiment and entry.arrivals.runs > 1]
        if group:
            title = escape(experiment.replace("crowds", "Crowds")).replace("+-", "&plusmn;")
            yield f"<h3>{title}: {group[0].arrivals.runs} runs each</h3>" + _many_runs(group)


def _single_runs(entries: Sequence[Aggregate]) -> str:
    header = head(["Where", "Gains", "Mode", "T (s)", "Least d (m)", "H", "V not growing", "Contact"])
    lines = []
    last = None
    for entry in entries:
        distances = " / ".join(f"{distance:.3f}" for distance in entry.min_distances)
        key = entry.key
        lines.append(
            ("<tr class=group>" if key[:3] != last else "<tr>")
            + f'<th scope="row">{escape(key.experiment)}</th><td class="text">{escape(GAIN_LABELS[key.gains])}</td>'
            + f'<td class="text">{escape(key.mode)}</td><td>{_number(entry.median_arrival_time, 2)}</td>'
            + f'<td class="text">{distances}</td><td>{entry.mean_score:.3f}</td>'
            + f"<td>{_percent(entry.descent_share)}</td><td>{'yes' if entry.contacts.count else 'no'}</td></tr>"
        )
        last = key[:3]
    return scroll(f"<table>{header}<tbody>{''.join(lines)}</tbody></table>")


_COLUMNS = (
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
    "Contact here only / off only, p",
)


def _many_runs(entries: Sequence[Aggregate]) -> str:
    lines = []
    last = None
    for entry in entries:
        paired = entry.against_off
        against = f"{paired.only_first} / {paired.only_second}, {paired.p_value:.2g}"
        if entry.key.mode == BASELINE:
            against = "&ndash;"
        gains = entry.key.gains
        lines.append(
            ("<tr class=group>" if gains != last else "<tr>")
            + f'<th scope="row">{escape(GAIN_LABELS[gains])}</th><td class="text">{escape(entry.key.mode)}</td>'
            + f"<td>{_share(entry.contacts_moving)}</td><td>{_share(entry.contacts_standing)}</td>"
            + f"<td>{_share(entry.contacts)}</td><td>{_percent(entry.arrivals.value)}</td>"
            + f"<td>{_number(entry.median_arrival_time, 2)}</td><td>{entry.mean_score:.3f}</td>"
            + f"<td>{entry.clearance_low:.3f} / {entry.clearance_median:.3f}</td>"
            + f"<td>{_percent(entry.descent_share)}</td><td>{against}</td></tr>"
        )
        last = gains
    return scroll(f'<table class="wide">{head(_COLUMNS)}<tbody>{"".join(lines)}</tbody></table>')


def _share(share: Share) -> str:
    return f"{100 * share.value:.1f} % <small>[{100 * share.low:.1f}, {100 * share.high:.1f}]</small>"


def _percent(value: float) -> str:
    return f"{100 * value:.1f} %" if math.isfinite(value) else "&ndash;"


def _number(value: float, digits: int) -> str:
    return f"{value:.{digits}f}" if math.isfinite(value) else "&ndash;"
