"""Print strict faults of robots with a shield whose own motion is told wrong, late, or by a clock that was set back.

``python docs/measure_tracking_errors.py --episodes 20001`` takes so many episodes of each robot and clock, a third with
each control period. The plant, the persons and the errors are those of tests/properties/pursued_robot.py, not the
simulation of the package: own speed told +-1 %, pose +-3.5 mm, updates 0 to 10 % late and up to two periods late, 30 %
of updates and of people dropped. A fault is strict: the robot moves toward the person, faster than 1 mm/s, before they
overlap by 0.1 m.
"""

from __future__ import annotations

import argparse
import sys
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests"))

from hrsafety._statistics import wilson
from page_tables import head, line, percent
from properties.pursued_robot import PERIODS, episode

CLOCKS: dict[str, dict[str, object]] = {
    "runs": {},
    "set back by 5 to 9 s": {"set_back": (5.0, 9.0)},
    "set back by 1 ms to 9 s": {"set_back": (0.001, 9.0)},
    "set back by 1 ms to 9 s, all": {"set_back": (0.001, 9.0), "takes_all": True},
}


def counted(seed: int, **options: object) -> tuple[bool, bool, bool]:
    """Return whether an episode has a strict fault, a contact, and an update that was off the plan."""
    found = episode(seed, **options)  # type: ignore[arg-type]  # options of the table below
    return found.fault, found.touched, found.off_plan > 0


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--episodes", type=int, default=3000, help="of each robot and clock")
    parser.add_argument("--first", type=int, default=0, help="number of the first one")
    options = parser.parse_args()
    rows = head(
        "robot", "clock", "control period, s", "episodes", "strict faults", "at most %", "touched %", "off plan %"
    )
    seeds = range(options.first, options.first + options.episodes // len(PERIODS))
    with ProcessPoolExecutor() as pool:
        for wheels in (False, True):
            for clock, told in CLOCKS.items():
                for period in PERIODS:
                    ask = partial(counted, wheels=wheels, period=period, **told)
                    faults, touched, off = (sum(each) for each in zip(*pool.map(ask, seeds, chunksize=50), strict=True))
                    most = f"{100 * wilson(faults, len(seeds)).high:.2f}"
                    shares = (percent(count, len(seeds)) for count in (touched, off))
                    robot = "two wheels" if wheels else "holonomic"
                    rows.append(line(robot, clock, period, len(seeds), faults, most, *shares))
                    print(rows[-1].rstrip(), file=sys.stderr, flush=True)
    print("".join(rows) if rows[0].endswith("\n") else "\n".join(rows))


if __name__ == "__main__":
    main()
