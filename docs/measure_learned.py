"""Print how the learned law of ``examples/ppo`` does, or write it into the page on validation.

``python docs/measure_learned.py`` prints, ``--write`` replaces what stands between the marks of docs/validation.md. It
takes the weights beside the example, and needs neither torch nor stable-baselines3.
"""

from __future__ import annotations

import math
import sys
import time
from collections.abc import Iterator
from dataclasses import replace

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.navigation.crowd.contacts import contacts_of
from hrsafety.navigation.crowd.simulation import simulated
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.warnings.shields import Motion
from page_tables import DOCS, ERROR, LATE, LATENCY, head, line, percent, print_or_write

sys.path.insert(0, str(DOCS.parent / "examples" / "ppo"))

from learned_law import WEIGHTS, LearnedLaw

CASES = 500
SHORT = 0.05  # s, motion steps that a shield can reckon with
PERIOD = 0.25  # s, between two commands
UNSEEN = "unseen, as the benchmark"
FINE = f"unseen, motion steps of {SHORT:g} s"
MEASURED = f"unseen, {LATE}"
WORLDS = {
    UNSEEN: {"visible": False},
    FINE: {"visible": False},
    MEASURED: {"visible": False},
    "seen": {"visible": True},
    "unseen, 10 people": {"visible": False, "people": 10},
    "unseen, collision-free speed": {"visible": False, "model": nav.crowd.CollisionFreeSpeed()},
    "unseen, Moussaïd": {"visible": False, "model": nav.crowd.Moussaid()},
}
LAWS = {"reciprocal": nav.OptimalReciprocalCollisionAvoidance(), "learned": LearnedLaw.load(WEIGHTS)}


def shielded(law: object, step: float, *, late: bool) -> nav.Law:
    """Return a law under a shield that knows the sensing, and the motion steps if they leave the robot room."""
    error = Motion(nav.HolonomicRobot(radius=0.3, max_speed=1.0), PERIOD, step).execution_error
    usual = nav.Shield().margin
    margin = max(error, usual) if step == SHORT else usual
    sensing = {"latency": LATENCY, "position_error": math.hypot(ERROR, ERROR)} if late else {}
    return nav.SafeNavigation(law, shield=nav.Shield(person_speed=1.0, margin=margin, **sensing))


def finer(world: World, step: float, *, late: bool) -> World:
    """Return a world with other motion steps and sensing, whose robot is commanded as before."""
    sensing = nav.Measurement(scale=ERROR, latency=LATENCY, of="obstacles") if late else None
    return replace(world, step=step, robots=[replace(world.robots[0], control_period=PERIOD, measurement=sensing)])


def row(words: str, name: str, law: object) -> str:
    """Return a line of the table."""
    step = SHORT if words == FINE else PERIOD
    cases = (scenarios.circle_crossing(case, law=law, **WORLDS[words]) for case in range(CASES))
    runs = simulated([finer(world, step, late=words == MEASURED) for world in cases])
    episodes = [nav.crowd.episodes_of(run)[0] for run in runs]
    table = nav.metrics.evaluate_many(episodes)
    found = [contacts_of(*each) for each in zip(episodes, table.arrival_time.tolist(), strict=True)]
    touched = sum(each.moving + each.standing > 0 for each in found)
    kinds = (sum(getattr(each, kind) > 0 for each in found) for kind in ("toward", "away", "at_fault"))
    counts = (int(table.success.sum()), touched, *kinds)
    arrival = table.arrival_time[table.arrived].mean()
    return line(words, name, *(percent(count, CASES) for count in counts), f"{arrival:.2f}")


def rows() -> Iterator[str]:
    """Yield the lines of the table."""
    for words in WORLDS:
        for name, law in LAWS.items():
            print(time.strftime("%H:%M:%S"), words, name, file=sys.stderr, flush=True)
            yield row(words, name, law)
            if words in {UNSEEN, FINE, MEASURED}:
                yield row(
                    words, f"{name}, shield", shielded(law, SHORT if words == FINE else PERIOD, late=words == MEASURED)
                )


def table() -> str:
    """Return the table."""
    lines = head(
        "people", "law", "success %", "contact %", "moving toward %", "moving away %", "at fault %", "arrival, s"
    )
    return "\n".join([*lines, *rows()]) + "\n"


if __name__ == "__main__":
    print_or_write(DOCS / "validation.md", {"learned": ("table of measure_learned.py", table)})
