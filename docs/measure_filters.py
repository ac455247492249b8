"""Print how often the filters of the field are at fault against a searched person, or write it into their guide.

``python docs/measure_filters.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/filters.md; ``--only faults`` is the searched person, ``--only price`` the time among people who walk.
"""

from __future__ import annotations

import functools
import sys
import time
from dataclasses import replace

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks import entry
from hrsafety.navigation.metrics import mean_interval
from page_tables import DOCS, ERROR, LATE, LATENCY, head, line, percent, print_or_write

STRAIGHT = entry("straight").law
ORCA = nav.OptimalReciprocalCollisionAvoidance()
FASTEST, WIDTH, LIMIT = 1.6, 0.25, 12.0
"""Speed in m/s and radius in m of the person, and time limit in s."""
OFF = float(np.hypot(ERROR, ERROR)) + LATENCY * FASTEST
"""How far a person can be from where he was measured, in m: the margin of filters that are to know of it."""
RANDOM, SHIELDED, EXACT = 4000, 20_000, 2000
"""Random persons against each robot, against one with a shield, and where people are known exactly."""
SEARCHES, EVALUATIONS = 10, 300
CROWDS, FIRST = 300, 60_000
"""Crowds of six people who walk straight on, and the seed of the first one."""
HOLONOMIC = nav.HolonomicRobot(radius=0.25, max_speed=1.0, max_acceleration=3.0)
WHEELS = nav.DifferentialDriveRobot(radius=0.25, max_speed=1.0)
MEASURED = nav.Measurement(scale=ERROR, of="obstacles", latency=LATENCY)


def say(*words: object) -> None:
    """Tell what is under way."""
    print(time.strftime("%H:%M:%S"), *words, file=sys.stderr, flush=True)


def filters(margin: float) -> dict[str, nav.laws.SafetyFilter]:
    """Return the filters for a robot that moves in any direction."""
    kinds = (
        nav.laws.Barrier,
        nav.laws.CollisionCone,
        nav.laws.VelocityClamp,
        nav.laws.ResponsibilityRule,
        nav.laws.ApproachMonitor,
    )
    return {f"`{kind.__name__}`": kind(margin=margin) for kind in kinds}


def shield(*, late: bool) -> nav.Shield:
    """Return a shield that knows how people are measured."""
    told = {"latency": LATENCY, "position_error": float(np.hypot(ERROR, ERROR))} if late else {}
    return nav.Shield(person_speed=FASTEST, **told)


@functools.cache
def entries(
    *, late: bool
) -> dict[tuple[str, str], tuple[nav.laws.Law, nav.HolonomicRobot | nav.DifferentialDriveRobot]]:
    """Return laws and robots by what is around which law."""
    guarded, yielding = shield(late=late), nav.Yielding()
    found: dict[tuple[str, str], tuple[nav.laws.Law, nav.HolonomicRobot | nav.DifferentialDriveRobot]] = {}
    for name, law in (("straight", STRAIGHT), ("ORCA", ORCA)):
        found[name, "nothing"] = law, HOLONOMIC
        for margin in (0.0, OFF) if law is STRAIGHT else (0.0,):
            for word, rule in filters(margin).items():
                around = f"{word}, margin {margin:.3f} m" if margin else word
                found[name, around] = nav.SafeNavigation(law, filter=rule), HOLONOMIC
    found["straight", "shield"] = nav.SafeNavigation(STRAIGHT, shield=guarded), HOLONOMIC
    found["ORCA", "shield, yielding"] = nav.SafeNavigation(ORCA, shield=guarded, yielding=yielding), HOLONOMIC
    for margin in (0.0, OFF):
        around = f"`BarrierUnicycle`, margin {margin:.3f} m" if margin else "`BarrierUnicycle`"
        rule = nav.laws.BarrierUnicycle(margin=margin)
        found["straight, two wheels", around] = nav.SafeNavigation(STRAIGHT, filter=rule), WHEELS
    found["straight, two wheels", "shield"] = nav.SafeNavigation(STRAIGHT, shield=guarded), WHEELS
    return found


def faults() -> str:
    """Return the table of the searched person."""
    rows = head(
        "law",
        "around it",
        "random persons",
        f"at fault, {LATE}, %",
        f"at fault, exact, {EXACT}, %",
        f"CMA-ES, {SEARCHES} searches: at fault",
        f"arrives, {LATE}, %",
        f"time to the goal, s, {LIMIT:g} s where late",
    )
    for (name, around), (law, robot) in entries(late=True).items():
        say(name, around)
        scene = nav.Scenario(
            start=(0.0, 0.0),
            goal=(8.0, 0.0),
            robot=robot,
            control_period=0.1,
            time_limit=LIMIT,
            rest_time=LIMIT,
        )
        late = replace(scene, measurement=MEASURED)
        search = functools.partial(nav.falsify, person_radius=WIDTH, person_speed=FASTEST)
        runs = SHIELDED if "shield" in around else RANDOM
        found = search(late, law, episodes=runs, seed=1)
        known = search(scene, entries(late=False)[name, around][0], episodes=EXACT, seed=1)
        worst = [search(late, law, method="cma_es", episodes=EVALUATIONS, seed=seed) for seed in range(SEARCHES)]
        toward = [percent(int((each.contacts_toward > 0).sum()), each.episodes, 2) for each in (found, known)]
        spent = mean_interval(np.where(np.isnan(found.arrival_time), LIMIT, found.arrival_time))
        rows.append(
            line(
                name,
                around,
                runs,
                *toward,
                sum(int(each.worst.contacts_toward > 0) for each in worst),
                percent(int(np.isfinite(found.arrival_time).sum()), runs),
                f"{spent.value:.2f} ({spent.low:.2f} to {spent.high:.2f})",
            )
        )
    return "\n".join(rows) + "\n"


def price() -> str:
    """Return the table of the time among people who walk straight on."""
    drawn = scenarios.random_traffic_batch(range(FIRST, FIRST + CROWDS), obstacles=6)
    rows = head(
        "law", "around it", "arrives without a contact, %", "moves toward whom it touches, %", "time to the goal, s"
    )
    for (name, around), (law, robot) in entries(late=True).items():
        say(name, around)
        scenes = [replace(each, robot=robot, measurement=MEASURED) for each in drawn]
        table = nav.simulate_many(scenes, [law], stop_on_contact=True)
        good = table.outcome == "arrived"
        spent = mean_interval(table.arrival_time[good])
        rows.append(
            line(
                name,
                around,
                percent(int(good.sum()), CROWDS),
                percent(int((table.contacts_toward > 0).sum()), CROWDS),
                f"{spent.value:.2f} ({spent.low:.2f} to {spent.high:.2f})",
            )
        )
    return "\n".join(rows) + "\n"


if __name__ == "__main__":
    print_or_write(
        DOCS / "guides" / "filters.md",
        {"faults": ("faults of measure_filters.py", faults), "price": ("price of measure_filters.py", price)},
    )
