"""Print who passes a narrow corridor and all statuses, or write both into the page on limits.

``python docs/measure_limits.py`` prints, ``--write`` replaces what stands between the marks of
docs/limits.md; ``--only corridors`` and ``--only statuses`` make one of the two tables. A corridor is
the gap between two rectangles; a robot starts at random places before it, and the goal lies behind it.
"""

from __future__ import annotations

import argparse
import ast
import runpy
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import get_args

import numpy as np

import hrsafety
from hrsafety import navigation as nav
from hrsafety.impact.batch import STATUS_WORDS as IMPACT_WORDS
from hrsafety.navigation.metrics import wilson
from hrsafety.navigation.trajectory import Outcome
from hrsafety.reactive.sound.fixes import STATUS_WORDS as FIX_WORDS

PAGE = Path(__file__).resolve().parent / "limits.md"
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


def percent(count: int, runs: int) -> str:
    """Return a share in percent with its 95 % Wilson interval."""
    share = wilson(count, runs)
    return f"{100 * share.value:.0f} ({100 * share.low:.0f} to {100 * share.high:.0f})"


def rows() -> Iterator[str]:
    """Yield the table: through the corridor, around the walls, contact, by law and width."""
    laws = runpy.run_path(str(PAGE.parent / "measure_laws.py"))["LAWS"]
    yield f"|  | runs | {' | '.join(f'{width:.1f} m' for width in WIDTHS)} |"
    yield "|---" * (len(WIDTHS) + 2) + "|"
    for name, law in laws.items():
        places = starts(SLOW_STARTS.get(name, STARTS))
        cells = []
        for width in WIDTHS:
            runs = nav.simulate_batch([corridor(width, (x, y)) for x, y in places.tolist()], law)
            through = (runs.outcome == "arrived") & (runs.path_length < LONGEST)
            ends = (through, (runs.outcome == "arrived") & ~through, runs.outcome == "collided")
            cells.append("; ".join(percent(int(each.sum()), len(each)) for each in ends))
        print(name, file=sys.stderr, flush=True)
        yield f"| {name} | {len(places)} | {' | '.join(cells)} |"


def marks(part: str) -> tuple[str, str]:
    """Return the lines between which a table stands on the page."""
    return f"<!-- {part} of measure_limits.py begin -->\n", f"<!-- {part} of measure_limits.py end -->\n"


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


def written(text: str, part: str) -> str:
    """Return the table that the page holds."""
    begin, end = marks(part)
    return text.split(begin)[1].split(end)[0]


def main() -> None:
    """Print the tables or write them into the page."""
    parser = argparse.ArgumentParser(description="Tables of docs/limits.md.")
    parser.add_argument("--only", choices=PARTS, help="one table instead of both")
    parser.add_argument("--write", action="store_true", help="replace the tables of the page")
    options = parser.parse_args()
    for part in PARTS if options.only is None else [options.only]:
        found = table(part)
        if not options.write:
            print(found)
            continue
        text = PAGE.read_text(encoding="utf-8")
        begin, end = marks(part)
        before, _, rest = text.partition(begin)
        PAGE.write_text(before + begin + found + end + rest.partition(end)[2], encoding="utf-8")


if __name__ == "__main__":
    main()
