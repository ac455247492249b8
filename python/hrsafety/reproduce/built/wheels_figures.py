"""Own pictures for Figures D.4 and E.2, and of the identification."""

from __future__ import annotations

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.pages import Picture
from hrsafety.reproduce.built.wheels_tables import COMMANDS, ROBOTS, sine_runs
from hrsafety.reproduce.figures import captioned

__all__ = ["make"]

NAMES = {"D": ("holonomic robot", "D.4"), "E": ("differential-drive robot", "E.2")}


def make() -> list[Picture]:
    """Draw tracking with and without observer, and open-loop tests with the identified wheel."""
    made = []
    for letter, wheels in ROBOTS.items():
        name, figure = NAMES[letter]
        index = len(wheels) - 1
        runs = [sine_runs(letter, "differences", True)[index], sine_runs(letter, "observer", True)[index]]
        made.append(
            captioned(
                f"wheels-{letter}-tracking",
                plotting.robots.wheel_tracking(runs, labels=["differences of counts", "observer"]),
                key="wheels-tracking",
                wheel=index + 1,
                robot=name,
                letter=letter,
                figure=figure,
            )
        )
        tests = nav.robots.open_loop_tests(wheels[index], COMMANDS)
        made.append(
            captioned(
                f"wheels-{letter}-identification",
                plotting.robots.wheel_identification(tests, nav.robots.identify_wheel(tests)),
                key="wheels-identification",
                wheel=index + 1,
                robot=name,
                letter=letter,
            )
        )
    return made
