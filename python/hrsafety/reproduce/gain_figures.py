"""Pictures of the search for the best gains and of the sensitivity around the printed optimum."""

from __future__ import annotations

from hrsafety import plotting
from hrsafety.pages import Picture
from hrsafety.reproduce.figures import picture
from hrsafety.reproduce.gain_runs import gain_runs

__all__ = ["make"]


def make() -> list[Picture]:
    """Draw flatness, history and sensitivity."""
    runs = gain_runs()
    printed = {"printed optimum": (runs.changed.law.gains, float(runs.changed.reference_performance.mean()))}
    share = f"{100.0 * runs.flatness.tolerance:g} %"
    return [
        picture(
            "gains-flatness",
            f"Mean H of configurations 1 to 3 along each gain through the best set of the search; shaded is what is "
            f"within {share} of the best, dashed the range of that gain alone.",
            plotting.flatness(runs.flatness, marks=printed),
        ),
        picture(
            "gains-history",
            "How the search of section C.2 closes in: best and worst survivor, and the ranges of the gains, grid by "
            "grid.",
            plotting.search_history(runs.search),
        ),
        picture(
            "gains-sensitivity",
            "Mean H and its relative sensitivity over the change of one gain of the printed optimum (Tables C.3, C.5, "
            "C.7, C.9, section C.3).",
            plotting.gain_sensitivity(runs.changed),
        ),
    ]
