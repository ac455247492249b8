"""Print how often the filters of the field are at fault against a searched person, or write it into their guide.

``python docs/measure_filters.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/filters.md; ``--only faults`` is the searched person, ``--only price`` the time among people who walk.
Rows of the first are kept in the folder of ``HRSAFETY_ROWS``, if there is one; all of it takes ten minutes of one core.
"""

from __future__ import annotations

import functools
from dataclasses import replace

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.benchmarks import entry
from hrsafety.navigation.metrics import mean_interval
from page_tables import DOCS, LATENCY, head, line, percent, print_or_write
from searched_person import FASTEST, HOLONOMIC, MEASURED, OFF, WHEELS, Robot, heading, row, say

STRAIGHT = entry("straight").law
ORCA = nav.OptimalReciprocalCollisionAvoidance()
MARGIN = OFF + LATENCY * FASTEST
"""How far a person can be from where he was measured, in m: the margin of filters that are to know of it."""
CROWDS, FIRST = 300, 60_000
"""Crowds of six people who walk straight on, and the seed of the first one."""


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
    told = {"latency": LATENCY, "position_error": OFF} if late else {}
    return nav.Shield(person_speed=FASTEST, **told)


@functools.cache
def entries(*, late: bool) -> dict[tuple[str, str], tuple[nav.laws.Law, Robot]]:
    """Return laws and robots by what is around which law."""
    guarded, yielding = shield(late=late), nav.Yielding()
    found: dict[tuple[str, str], tuple[nav.laws.Law, Robot]] = {}
    for name, law in (("straight", STRAIGHT), ("ORCA", ORCA)):
        found[name, "nothing"] = law, HOLONOMIC
        for margin in (0.0, MARGIN) if law is STRAIGHT else (0.0,):
            for word, rule in filters(margin).items():
                around = f"{word}, margin {margin:.3f} m" if margin else word
                found[name, around] = nav.SafeNavigation(law, filter=rule), HOLONOMIC
    found["straight", "shield"] = nav.SafeNavigation(STRAIGHT, shield=guarded), HOLONOMIC
    found["ORCA", "shield, yielding"] = nav.SafeNavigation(ORCA, shield=guarded, yielding=yielding), HOLONOMIC
    for margin in (0.0, MARGIN):
        around = f"`BarrierUnicycle`, margin {margin:.3f} m" if margin else "`BarrierUnicycle`"
        rule = nav.laws.BarrierUnicycle(margin=margin)
        found["straight, two wheels", around] = nav.SafeNavigation(STRAIGHT, filter=rule), WHEELS
    found["straight, two wheels", "shield"] = nav.SafeNavigation(STRAIGHT, shield=guarded), WHEELS
    return found


def faults() -> str:
    """Return the table of the searched person."""
    rows = heading("law", "around it")
    exact = entries(late=False)
    for names, (law, robot) in entries(late=True).items():
        rows.append(row(names, robot, law, exact[names][0]))
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
