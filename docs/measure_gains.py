"""Print the tables of appendix C, or write them into the page on validation.

``python docs/measure_gains.py`` prints, ``--write`` replaces what stands between the two marks of
docs/validation.md. Nothing here depends on the machine: times are on the page on performance.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from hrsafety.reproduce.gain import claims as gain_claims
from hrsafety.reproduce.gain import deviations as gain_deviations
from hrsafety.reproduce.gain import tables as gain_tables
from hrsafety.reproduce.gain.runs import gain_runs
from page_tables import DOCS, line, print_or_write

PAGE = DOCS / "validation.md"
MARKS = "tables of measure_gains.py"
UNITS = ("N/m", "N/m", "N/m²", "s")
NAMES = ("$K_1$", "$K_3$", "$K_5$", "$b$")


def optimum() -> Iterator[str]:
    """Yield the printed and the found gains."""
    runs = gain_runs()
    search, flat = runs.search, runs.flatness
    printed = runs.changed.law.gains
    yield line("", *(f"{name} ({unit})" for name, unit in zip(NAMES, UNITS, strict=True)), "H c1, c2, c3", "mean H")
    yield "|---" * 7 + "|"
    for label, gains, scores in (
        ("printed optimum", printed, runs.changed.reference_performance),
        ("found by the search", search.best.gains, search.best_performance),
    ):
        shown = ", ".join(f"{score:.3f}" for score in scores)
        yield line(label, *(f"{gain:.4g}" for gain in gains), shown, f"{np.mean(scores):.4f}")
    ranges = (f"{low:.3g} to {high:.3g}" for low, high in zip(flat.low, flat.high, strict=True))
    yield line("range of one gain alone, at most 1 % less", *ranges, "", f"at least {0.99 * flat.best_value:.4f}")
    yield ""
    yield line("stage", "gain sets", "failed", "best mean H", "worst survivor")
    yield "|---" * 5 + "|"
    for index, entry in enumerate(search.grids, start=1):
        counts = (f"{entry.evaluations:,}", f"{entry.failures:,}")
        yield line(f"grid {index}", *counts, f"{entry.best_value:.5f}", f"{entry.worst_survivor:.5f}")
    evaluations = sum(entry.evaluations for entry in search.local)
    best = max(entry.best_value for entry in search.local)
    yield line(f"{len(search.local)} local searches", f"{evaluations:,}", "", f"{best:.5f}", "")
    yield ""


def deviations() -> Iterator[str]:
    """Yield the deviations over all rows of Tables C.2 to C.9."""
    yield line("", "values", "mean (%)", "largest (%)", "second largest (%)")
    yield "|---" * 5 + "|"
    for row in gain_deviations.deviations(gain_tables.appendix_c()):
        shares = (f"{row.mean:+.1f}", f"{row.worst:.1f}", f"{row.second_worst:.1f}")
        yield line(f"{row.configuration}, {row.quantity}", row.values, *shares)
    yield ""


def claims() -> Iterator[str]:
    """Yield the trends that the text of the source names, with what was found."""
    yield line("", "printed", "measured", "holds")
    yield "|---" * 4 + "|"
    for cell in gain_claims.trends(gain_runs()):
        yield line(f"{cell.row}: {cell.column}", cell.printed, cell.measured, "yes" if cell.within else "no")
    yield ""


def page() -> str:
    """Return the tables."""
    parts = (
        ("The search of section C.2 with its own settings.", optimum()),
        ("Measured against printed, over the 48 rows of Tables C.2 to C.9.", deviations()),
        ("Trends of section C.3.", claims()),
    )
    lines = [entry for words, rows in parts for entry in (words, "", *rows)]
    return "\n" + "\n".join(lines) + "\n"


if __name__ == "__main__":
    print_or_write(PAGE, {"tables": (MARKS, page)})
