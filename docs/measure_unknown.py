"""Print what a robot reaches in places that it knows from its scans alone, or write it into the guide.

``python docs/measure_unknown.py`` prints, ``--write`` replaces what stands between the marks of
docs/guides/unknown_building.md. BARN worlds are those of ``HRSAFETY_BARN``, a folder that ``challenge_worlds.py``
fills; rows are kept in ``HRSAFETY_ROWS`` where that is set, and the run resumes there.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from hrsafety.benchmarks import benchmark
from hrsafety.benchmarks.suites import SUITES
from page_tables import DOCS, head, line, percent, print_or_write

PAGE = DOCS / "guides" / "unknown_building.md"
WORLDS = 150
"""BARN worlds, those of even numbers."""


def worlds() -> Path:
    """Return the folder of BARN worlds."""
    return Path(os.environ["HRSAFETY_BARN"])


def suites() -> str:
    """Return the table of episodes."""
    lines = head(
        "place", "robot", "episodes", "arrived %", "contact %", "score", "time mean, max s", "least clearance m"
    )
    for place, suite, data in (("BARN, even worlds", "unknown_barn", worlds()), ("dead ends", "dead_ends", None)):
        for name in SUITES[suite].laws:
            cases = WORLDS if suite == "unknown_barn" else None
            result = benchmark(suite, [name], cases=cases, data=data, out=os.environ.get("HRSAFETY_ROWS"))
            rows = result.rows[name]
            arrived = [row for row in rows if row.outcome == "arrived"]
            times = [row.arrival_time for row in arrived]
            score = result.mean_score(name)
            lines.append(
                line(
                    place,
                    f"`{name}`",
                    len(rows),
                    percent(len(arrived), len(rows)),
                    percent(sum(row.contacts > 0 for row in rows), len(rows)),
                    "-" if np.isnan(score) else f"{score:.4f}",
                    f"{np.mean(times):.1f}, {max(times):.1f}",
                    f"{min(row.clearance for row in rows):.3f}",
                )
            )
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    print_or_write(PAGE, {"suites": ("unknown suites", suites)})
