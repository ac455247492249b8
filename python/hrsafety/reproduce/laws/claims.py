"""Claims of sections 2.2.5, 5.7 and 6.4 about the compared laws in their text, measured."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hrsafety import navigation as nav
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.laws.compared import COMPARED
from hrsafety.reproduce.laws.study import LawsStudy, compared_contacts
from hrsafety.reproduce.measured import measure_laws
from hrsafety.reproduce.sheets import Sheet

__all__ = ["TABLES", "cells"]

TABLES = ("Section 2.2.5", "Section 5.7", "Section 6.4.1", "Section 6.4.2", "Section 6.4.5")
"""Sections of the cells, in the order of the page."""
SHEET = Sheet("laws")
# A path that goes back farther than this swings to and fro; a detour alone goes back by less.
_SWINGING = 0.1
_PLANNERS = {"time_and_risk": "VO", "random_tree": "RRT", "field_d_star": "Field D*"}
_SECOND_CATEGORY = ("masoud", "ge_cui", "new_vff")


def cells(study: LawsStudy) -> list[PrintedValue]:
    """Return every claim of the part, in the order of `TABLES`."""
    return [*_collinear(study), *_unpredictable(study), *_oscillation(study), *_head_on(), *_parallel(study)]


def _collinear(study: LawsStudy) -> Iterator[PrintedValue]:
    for name in ("khatib", "borenstein_koren", "ge_cui", "new_vff"):
        own = name == "new_vff"
        runs = (study.demonstrations[name].standing, study.demonstrations[name].walking)
        yield SHEET.claim(
            "collinear",
            holds=all((run.outcome == "arrived") is own for run in runs),
            label=COMPARED[name].label,
            said="works (section 5.8)" if own else "collides with the obstacle or never reaches the goal",
            standing=_ending(runs[0]),
            walking=_ending(runs[1]),
        )


def _ending(run: nav.Trajectory) -> str:
    """Return how a run ended, in words."""
    (contact,) = run.contact_time.tolist()
    if np.isfinite(contact):
        return f"contact at {contact:.2f} s"
    return (
        f"arrival at {run.arrival_time:.2f} s" if run.outcome == "arrived" else f"no arrival within {run.time[-1]:g} s"
    )


def _passing(run: nav.Trajectory) -> str:
    return f"{_ending(run)}, d {run.min_distance[0]:.2f} m"


def _unpredictable(study: LawsStudy) -> Iterator[PrintedValue]:
    own = study.varied["new_vff"].touched.count
    for name, label in _PLANNERS.items():
        run, share = study.printed[name], study.varied[name].touched
        yield SHEET.claim(
            "planner",
            holds=bool(np.isfinite(run.contact_time[0])),
            label=label,
            passing=_passing(run),
            runs=share.runs,
            count=share.count,
            own=own,
            p_value=compared_contacts(study, name).p_value,
        )
    for name in _SECOND_CATEGORY:
        run = study.printed[name]
        touched = bool(np.isfinite(run.contact_time[0]))
        why = "See Table 5.1: the run is chaotic." if touched else ""
        holds = not touched and run.outcome == "arrived"
        yield SHEET.claim("force", holds=holds, label=COMPARED[name].label, passing=_passing(run), why=why)
    scores = {name: run.values["H"] for name, (run,) in measure_laws(["unpredictable_human"], _SECOND_CATEGORY).items()}
    listed = ", ".join(f"{COMPARED[name].label} {score:.3f}" for name, score in scores.items())
    best = scores["new_vff"] == max(scores.values())
    yield SHEET.claim("highest", holds=best, label=COMPARED["new_vff"].label, scores=listed)


def _oscillation(study: LawsStudy) -> Iterator[PrintedValue]:
    for name, said, swings in (
        ("ge_cui", "severe oscillation: the force jumps at the edge", True),
        ("masoud", "no oscillation, though the force jumps at the edge", False),
        ("new_vff", "smooth path: the force is continuous", False),
    ):
        shown = study.demonstrations[name]
        holds = (shown.way_back > _SWINGING) is swings and (shown.jump > 1.0) is (name != "new_vff")
        yield SHEET.claim("beside", holds=holds, label=COMPARED[name].label, said=said, shown=shown)


def _head_on() -> Iterator[PrintedValue]:
    """Yield what happens to Ge & Cui with the person of configuration 2, who has no row in Table 6.3."""
    (run,) = measure_laws(["c2"], ["ge_cui"])["ge_cui"]
    trajectory, label = nav.simulate(run.scenario, nav.GeCui()), COMPARED["ge_cui"].label
    yield SHEET.claim("head_on", holds=run.contact, label=label, passing=_passing(trajectory))
    yield SHEET.number("head_on_time", float(trajectory.contact_time[0]), label=label)


def _parallel(study: LawsStudy) -> Iterator[PrintedValue]:
    new, masoud, twice = (study.parallel[name] for name in ("new_vff", "masoud", "masoud_twice"))
    label = COMPARED["new_vff"].label
    yield SHEET.claim("passed", holds=new.outcome == "arrived", label=label, passing=_passing(new))
    yield SHEET.number("arrival", new.arrival_time, label=label)
    yield SHEET.number("contact_time", float(masoud.contact_time[0]), label=COMPARED["masoud"].label)
    arrives = twice.outcome == "arrived" and bool(twice.min_distance[0] > 0.61)
    yield SHEET.claim("twice", holds=arrives, passing=_passing(twice))
    before, after = study.twice_repulsion
    single = ", ".join(f"c{k} {100.0 * share:+.1f} %" for k, share in enumerate(after / before - 1.0, start=1))
    yield SHEET.number("score", 100.0 * float(after.mean() / before.mean() - 1.0), single=single)
