"""Own pictures for Figures D.4 and E.2, and of the identification."""

from __future__ import annotations

from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.pages import Picture
from hrsafety.reproduce.figures import picture
from hrsafety.reproduce.wheels_tables import COMMANDS, ROBOTS, sine_runs

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
            picture(
                f"wheels-{letter}-tracking",
                f"Wheel {index + 1} of the {name} after 1 rad/s, 0.5 Hz, with the speed from differences of counts and "
                f"from the observer (section {letter}.3, Figure {figure}).",
                plotting.robots.wheel_tracking(runs, labels=["differences of counts", "observer"]),
            )
        )
        tests = nav.robots.open_loop_tests(wheels[index], COMMANDS)
        made.append(
            picture(
                f"wheels-{letter}-identification",
                f"Simulated open-loop tests of wheel {index + 1} of the {name} with the encoder's counts, and the "
                f"wheel that is identified from them (section {letter}.2); a cross is a test that did not move.",
                plotting.robots.wheel_identification(tests, nav.robots.identify_wheel(tests)),
            )
        )
    return made
