"""A judged log as a player shows it."""

from __future__ import annotations

from typing import Any

import numpy as np

from hrsafety._replay.record import Event, PlayedRobot, Replay, UnjudgedTime
from hrsafety.navigation.judging.unjudged import REASONS

__all__ = ["replay_of"]

_QUIET = ("smoothing_edge", "outside_map")
"""Reasons that concern no contact."""


def replay_of(judgement: Any) -> Replay:
    """Return what a player shows of a judged log: contacts, worst moments, broken rules, and what is not judged."""
    gaps = np.concatenate([judgement.clearance, judgement.wall_clearance[:, None]], axis=1)
    least = np.nanmin(np.where(np.isnan(gaps), np.inf, gaps), axis=1, initial=np.inf)
    robot = PlayedRobot(
        name="robot",
        position=judgement.position,
        radius=judgement.robot_radius,
        heading=judgement.heading,
        footprint=() if judgement.footprint is None else judgement.footprint.corners,
        speed=np.hypot(*judgement.velocity.T),
        clearance=np.where(np.isfinite(judgement.position[:, 0]), least, np.nan),
    )
    crowd = len(judgement.people)
    return Replay(
        title="judged log",
        time=judgement.time,
        robots=[robot],
        people=judgement.obstacle_position if crowd else None,
        radius=np.full(crowd, judgement.person_radius) if crowd else None,
        names=[str(each) for each in judgement.people.tolist()],
        maps=[] if judgement.walls is None else [judgement.walls],
        events=_events(judgement),
        not_judged=[
            UnjudgedTime(each.begin, each.end, REASONS[each.reason])
            for each in judgement.not_judged
            if each.reason not in _QUIET
        ],
        facts=[("judged", f"{100.0 * judgement.judged_share:.1f} % of the log")],
        warnings=judgement.warnings,
    )


def _events(judgement: Any) -> list[Event]:
    found = []
    for touch in (*judgement.contacts, *judgement.possible_contacts):
        who = "wall" if touch.person is None else f"person {touch.person}"
        kind = "note" if touch.kind == "possible_contact" else "fault" if touch.at_fault else "contact"
        found.append(Event(touch.begin, kind, f"{touch.kind.replace('_', ' ')}: {who}, {touch.clearance:.2f} m"))
    for passing in judgement.passings:
        broken = [name.replace("_", " ") for name, word in passing.kept.items() if word == "violated"]
        if broken:
            found.append(Event(passing.pass_time, "note", f"person {passing.person}: {', '.join(broken)} violated"))
    for number, moment in enumerate(judgement.moments, start=1):
        words = f"worst moment {number}: person {moment.person} at {moment.clearance:.2f} m"
        found.append(Event(moment.time, "note", words))
    return sorted(found, key=lambda each: each.time)
