"""Print who passes a narrow corridor and all statuses, or write both into the page on limits.

``python docs/measure_limits.py`` prints, ``--write`` replaces what stands between the marks of
docs/limits.md; ``--only corridors`` and ``--only statuses`` make one of the two tables. A corridor is
the gap between two rectangles; a robot starts at random places before it, and the goal lies behind it.
"""

from __future__ import annotations

import ast
import functools
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import get_args

import numpy as np

import hrsafety
from hrsafety import navigation as nav
from hrsafety.impact.batch import STATUS_WORDS as IMPACT_WORDS
from hrsafety.navigation.trajectory import Outcome
from hrsafety.reactive.sound.fixes import STATUS_WORDS as FIX_WORDS
from hrsafety.standards.verdicts import VERDICTS
from measure_laws import LAWS
from page_tables import DOCS, head, line, percent, print_or_write

PAGE = DOCS / "limits.md"
PARTS = ("corridors", "statuses")
WIDTHS = (0.5, 0.6, 0.8, 1.0, 1.2, 1.4, 1.6)
LENGTH, DEPTH = 2.0, 6.0
"""Of each rectangle along the corridor and across it, in m."""
LONGEST = 9.0
"""Path through the corridor in m; one around a rectangle is longer than the depth of both sides."""
STARTS, SLOW_STARTS = 200, {"Extended RRT": 50, "Field D*": 50}
TIME_LIMIT = 120.0


def corridor(width: float, start: tuple[float, float]) -> nav.Scenario:
    """Return a robot before a corridor of a width whose goal lies behind it."""
    offset = (width + DEPTH) / 2.0
    places = [nav.Rectangle(center=(0.0, side * offset), length=LENGTH, width=DEPTH) for side in (-1.0, 1.0)]
    radii = nav.region_radii(nav.HolonomicRobot(), places[0], faced_side=LENGTH)
    walls = [replace(place, **radii._asdict()) for place in places]
    return nav.Scenario(start=start, goal=(3.0, 0.0), obstacles=walls, time_limit=TIME_LIMIT)


def starts(number: int) -> np.ndarray:
    """Return random starts before the corridor, the same for every width and law."""
    generator = np.random.Generator(np.random.PCG64(3))
    return np.array([-3.0, -1.0]) + np.array([1.0, 2.0]) * generator.random((number, 2))


def rows() -> Iterator[str]:
    """Yield the table: through the corridor, around the walls, contact, by law and width."""
    yield from head("", "runs", *(f"{width:.1f} m" for width in WIDTHS))
    for name, law in LAWS.items():
        places = starts(SLOW_STARTS.get(name, STARTS))
        cells = []
        for width in WIDTHS:
            runs = nav.simulate_batch([corridor(width, (x, y)) for x, y in places.tolist()], law)
            through = (runs.outcome == "arrived") & (runs.path_length < LONGEST)
            ends = (through, (runs.outcome == "arrived") & ~through, runs.outcome == "collided")
            cells.append("; ".join(percent(int(each.sum()), len(each), digits=0) for each in ends))
        print(name, file=sys.stderr, flush=True)
        yield line(name, len(places), *cells)


@functools.cache
def warning_codes() -> list[str]:
    """Return the codes of all warnings that results carry, as the sources of the package build them."""
    codes = set()
    for path in Path(hrsafety.__file__).parent.rglob("*.py"):
        source = ast.parse(path.read_text(encoding="utf-8"))
        constants = {}
        for node in source.body:
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant):
                constants |= {each.id: node.value.value for each in node.targets if isinstance(each, ast.Name)}
        for node in ast.walk(source):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "ResultWarning":
                given = [*node.args[:1], *(each.value for each in node.keywords if each.arg == "code")]
                codes |= {each.value for each in given if isinstance(each, ast.Constant)}
                codes |= {constants[each.id] for each in given if isinstance(each, ast.Name) and each.id in constants}
    return sorted(codes)


def statuses() -> dict[str, list[str]]:
    """Return every word that says how far a result can be trusted, by what carries it."""
    return {
        "`outcome` of a run": list(get_args(Outcome)),
        "`status` of an impact": list(IMPACT_WORDS),
        "`status` of a located sound": list(FIX_WORDS),
        "`verdict` of a limit of contact": list(VERDICTS),
        "`code` of a warning (`ResultWarning`)": warning_codes(),
    }


def table(part: str) -> str:
    """Return one table as it stands on the page."""
    if part == "corridors":
        lines = list(rows())
    else:
        lines = ["| what | words |", "|---|---|"]
        lines += [f"| {what} | {', '.join(f'`{word}`' for word in words)} |" for what, words in statuses().items()]
    return "\n" + "\n".join(lines) + "\n\n"


if __name__ == "__main__":
    print_or_write(PAGE, {part: (f"{part} of measure_limits.py", functools.partial(table, part)) for part in PARTS})
