"""The part of the summary page about the compared laws."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from html import escape

import numpy as np

from hrsafety import navigation as nav
from hrsafety.navigation.metrics import Share
from hrsafety.reproduce import laws_claims, markup
from hrsafety.reproduce.cells import Cell
from hrsafety.reproduce.figures import Picture
from hrsafety.reproduce.laws_compared import COMPARED, FORCES, LIKE_SOURCE
from hrsafety.reproduce.laws_study import Demonstration, LawsStudy, compared_contacts

__all__ = ["section"]

_INTRO = (
    "<p>All nine laws run with their default parameters: the new field with its stabilizing force capped, the "
    "others as "
    "documented with the package. The rows of Masoud and of Ge &amp; Cui in Tables 5.1 and 6.2 to 6.5 stand "
    "there; the new "
    "field of section 6.4.5 is that of the tables, without the stabilizing force.</p>"
)
_WALKS = (
    "<p>The printed walk: 1 s at 1 m/s towards the robot, to rest at 1 m/s&sup2;, then sideways at 1 m/s&sup2; "
    "up to 1 m/s. "
    "Nobody knows it in advance. Of the {runs} variations (seeds 0 to {last}) everything is drawn uniformly: the start "
    "within 0.3 m along and 0.2 m across the way, the walking speed from 0.7 to 1.0 m/s, the walking time from 0.5 to "
    "2.0 s, deceleration and later acceleration from 0.5 to 2.0 m/s&sup2;, the speed reached from 0.5 to 1.0 m/s, the "
    "course left or right within 30&deg; of straight across. No walk is left out. Robot and person touch at a "
    "distance of "
    "0.6 m of their centers; a run goes on after a contact, and its least distance is that of the whole run. All "
    "laws meet "
    "the same walks; the last column compares with the new field walk by walk (exact McNemar test).</p>"
)
_DRAWN = (
    "<p>RRT draws its tree: with {runs} other seeds in the printed walk it touches the person in {count} "
    "(95 % interval {low:.1f} to {high:.1f} %).</p>"
)
_CATEGORIES = (
    "<p>In the source its three planners touch the person in the printed walk, and its three laws of virtual forces do "
    "not. Here the person of the printed walk is touched by: {touching}. Laws without a contact in any varied walk: "
    "{clean}.</p>"
)


def section(study: LawsStudy, cells: Sequence[Cell], pictures: Sequence[Picture]) -> Iterator[str]:
    """Yield tables, claims and pictures of the compared laws."""
    yield _INTRO
    tables = markup.by_table(cells)
    yield "<h3>Demonstrations of section 2.2.5</h3>" + _demonstrations(study)
    yield from markup.figures(pictures, "figure-2")
    yield "<h3>The unpredictable person</h3>" + _WALKS.format(runs=_runs(study), last=_runs(study) - 1)
    yield _encounters(study)
    drawn = study.drawn.touched
    yield _DRAWN.format(runs=drawn.runs, count=drawn.count, low=100 * drawn.low, high=100 * drawn.high)
    yield _CATEGORIES.format(touching=_touching(study), clean=_clean(study))
    yield from markup.figures(pictures, "figure-5", "unpredictable")
    yield "<h3>What the text says</h3>"
    for table in laws_claims.TABLES:
        yield markup.table_of_cells(table, tables[table])
    yield from markup.figures(pictures, "figure-6")


def _runs(study: LawsStudy) -> int:
    return len(study.varied["new_vff"].contact)


def _touching(study: LawsStudy) -> str:
    names = [COMPARED[name].label for name in COMPARED if np.isfinite(study.printed[name].contact_time[0])]
    return escape(", ".join(names)) if names else "no law"


def _clean(study: LawsStudy) -> str:
    names = [COMPARED[name].label for name in COMPARED if not study.varied[name].contact.any()]
    return escape(", ".join(names)) if names else "none"


_DEMONSTRATION_HEAD = (
    "Law",
    "Standing disc",
    "Person",
    "Force jumps at the edge by (N)",
    "Edge crossed",
    "Way back (m)",
    "Path (m)",
    "T (s)",
)


def _demonstrations(study: LawsStudy) -> str:
    words = (
        "<p>Collinear condition: robot, obstacle and goal exactly on one line, with a standing disc and with the "
        "person of "
        "configuration 2. Oscillation: configuration 1, where the disc stands 5 mm beside the line. The jump is "
        "that of "
        "the force at the edge of the active region of the disc, for a robot that comes straight on at full speed; way "
        "back is how far the robot goes away from the goal in all.</p>"
    )
    lines = "".join(_demonstration(entry.label, study.demonstrations[name]) for name, entry in FORCES.items())
    return words + markup.scroll(
        f'<table class="wide">{markup.head(_DEMONSTRATION_HEAD)}<tbody>{lines}</tbody></table>'
    )


def _demonstration(label: str, shown: Demonstration) -> str:
    return (
        f'<tr><th scope="row">{escape(label)}</th><td class="text">{_ending(shown.standing)}</td>'
        f'<td class="text">{_ending(shown.walking)}</td><td>{shown.jump:.1f}</td><td>{shown.crossings}</td>'
        f"<td>{shown.way_back:.2f}</td><td>{shown.beside.path_length:.2f}</td>"
        f"<td>{_number(shown.beside.arrival_time)}</td></tr>"
    )


_HEAD = (
    "Law",
    "Printed walk",
    "Least d (m)",
    "T (s)",
    "Contact in varied walks",
    "while it moved",
    "Arrived, no contact",
    "First contact, median (s)",
    "Least distance, smallest / median (m)",
    "Contact here only / new field only, p",
)


def _encounters(study: LawsStudy) -> str:
    lines = "".join(_line(study, name) for name in {**COMPARED, **LIKE_SOURCE})
    return markup.scroll(f'<table class="wide">{markup.head(_HEAD)}<tbody>{lines}</tbody></table>')


def _line(study: LawsStudy, name: str) -> str:
    entry = {**COMPARED, **LIKE_SOURCE}[name]
    run, many, paired = study.printed[name], study.varied[name], compared_contacts(study, name)
    times = many.contact_time[many.contact]
    against = f"{paired.only_first} / {paired.only_second}, {paired.p_value:.2g}" if name != "new_vff" else "&ndash;"
    return (
        f'<tr><th scope="row">{escape(entry.label)}</th><td class="text">{_ending(run)}</td>'
        f'<td class="text">{run.min_distance[0]:.3f}</td><td>{_number(run.arrival_time)}</td>'
        f"<td>{_share(many.touched)}</td><td>{_share(many.touched_moving)}</td><td>{_share(many.arrived)}</td>"
        f"<td>{f'{np.median(times):.2f}' if len(times) else '&ndash;'}</td>"
        f"<td>{many.least_distance.min():.3f} / {np.median(many.least_distance):.3f}</td><td>{against}</td></tr>"
    )


def _ending(run: nav.Trajectory) -> str:
    contact = float(run.contact_time[0])
    if np.isfinite(contact):
        return f'<span class="bad">contact at {contact:.2f} s</span>'
    return "arrives, no contact" if np.isfinite(run.arrival_time) else '<span class="bad">never arrives</span>'


def _number(value: float) -> str:
    return f"{value:.2f}" if np.isfinite(value) else "&ndash;"


def _share(share: Share) -> str:
    return (
        f"{share.count} of {share.runs} <small>{100 * share.value:.1f} % "
        f"[{100 * share.low:.1f}, {100 * share.high:.1f}]</small>"
    )
