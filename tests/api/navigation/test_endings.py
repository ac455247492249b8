"""How runs ended, and why robots did not get on, in one sentence."""

from __future__ import annotations

import math
from typing import Any

import pytest

from hrsafety import navigation as nav

FIELD = nav.VirtualForceField()
WALL = nav.StaticMap.from_polylines([[(2.0, -1.0), (2.0, 1.0)]])
STOPS = nav.Human(start=(4.0, 5.0), velocity=(0.0, -1.0), stop=(4.0, 1.2))
# Without detour and stabilizing force a robot that comes straight on is pushed to a stand.
STUBBORN = nav.VirtualForceField(stabilizing="off", detour_gain=0.0)
PILLAR = nav.Disc(center=(2.0, 0.0), radius=0.3, active_radius=1.5, critical_radius=0.6)


def run(law: nav.Law = FIELD, **fields: Any) -> nav.Trajectory:
    return nav.simulate(nav.Scenario(**{"start": (0.0, 0.0), "goal": (4.0, 0.0)} | fields), law)


ENDINGS: dict[str, tuple[nav.Trajectory, str, str]] = {
    "arrived": (run(), "arrived", "arrived after "),
    "wall": (run(walls=WALL), "collided", "contact with a wall at 2.70 s with 0.70 m/s, then arrived after "),
    "person": (
        run(nav.Khatib(), obstacles=[nav.Human(start=(3.0, 0.0), velocity=(-1.0, 0.0))]),
        "collided",
        "contact with obstacle 0 (Human) at ",
    ),
    "behind a wall": (run(nav.SafeNavigation(FIELD, map=WALL), walls=WALL), "timed_out", ": walls stand between it"),
    "too far": (run(time_limit=1.0), "timed_out", ": the goal is too far for time_limit, see .warnings"),
    "near a stop": (run(obstacles=[STOPS]), "timed_out", ": somebody stops near the goal, see .warnings"),
    "pushed away": (
        run(STUBBORN, obstacles=[PILLAR]),
        "stopped",
        ": it stands in the active region of obstacle 0 (Disc)",
    ),
}


@pytest.mark.parametrize("name", ENDINGS)
def test_a_run_says_how_it_ended_and_why(name: str) -> None:
    found, outcome, words = ENDINGS[name]
    assert found.outcome == outcome
    assert words in found.ending
    assert found.ending in repr(found)


def test_a_cause_is_told_only_where_it_is_known() -> None:
    late = run(time_limit=5.6, obstacles=[nav.Human(start=(9.0, 9.0), velocity=(0.0, 1.0))])
    assert late.outcome == "timed_out"
    assert late.ending == f"timed out after 5.60 s, {math.dist(late.position[-1], (4.0, 0.0)):.2f} m from the goal"


def test_robots_of_worlds_say_it_too() -> None:
    person = nav.Person(start=(4.0, 0.05), route=[(0.0, 0.05)], awareness=0.0)
    robots = [nav.Robot(start=(0.0, y), goal=(4.0, y), law=nav.Khatib()) for y in (0.0, 9.0)]
    met = nav.simulate(nav.World(robots=robots, people=[person], time_limit=20.0))
    assert [each.ending.split(" at ")[0].split(" after ")[0] for each in met.robots] == [
        "contact with person 0",
        "arrived",
    ]
    for name in ("ending", "contacts_moving"):
        with pytest.raises(AttributeError, match=rf"take run\.robots\[i\]\.{name}"):
            getattr(met, name)
