"""Pictures of the search for the best gains and of the sensitivity around the printed optimum."""

from __future__ import annotations

from hrsafety import plotting
from hrsafety.pages import Picture
from hrsafety.reproduce.figures import captioned
from hrsafety.reproduce.gain.runs import gain_runs

__all__ = ["make"]


def make() -> list[Picture]:
    """Draw flatness, history and sensitivity."""
    runs = gain_runs()
    printed = {"printed optimum": (runs.changed.law.gains, float(runs.changed.reference_performance.mean()))}
    share = f"{100.0 * runs.flatness.tolerance:g} %"
    return [
        captioned("gains-flatness", plotting.flatness(runs.flatness, marks=printed), share=share),
        captioned("gains-history", plotting.search_history(runs.search)),
        captioned("gains-sensitivity", plotting.gain_sensitivity(runs.changed)),
    ]
