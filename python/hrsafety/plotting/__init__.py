"""Pictures of results: paths, forces, distances, energies, studies and animations.

Every function takes results of `hrsafety.navigation`, `.impact`, `.contact`, `.standards` or `.arms`, computes no
physics, and returns a ``matplotlib.figure.Figure`` that needs no display and leaves no trace in ``pyplot``; save it
with ``figure.savefig(path)``. `animate` writes a file and returns its path. Axis labels carry
units. `player` makes an HTML file and needs nothing. matplotlib is imported when a picture is asked for; without it
the functions raise
`MissingExtraError`, which names ``pip install matplotlib``.
"""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.plotting import (
        arms as arms,
        comparisons as comparisons,
        contacts as contacts,
        crowds as crowds,
        gains as gains,
        impacts as impacts,
        reactive as reactive,
        robots as robots,
        runs as runs,
        sweeps as sweeps,
    )
    from hrsafety.plotting.arms.ellipses import mass_ellipse as mass_ellipse
    from hrsafety.plotting.comparisons.law_runs import (
        comparison_distances as comparison_distances,
        comparison_paths as comparison_paths,
        comparison_sequence as comparison_sequence,
    )
    from hrsafety.plotting.comparisons.repeated import (
        repeated_distances as repeated_distances,
        repeated_paths as repeated_paths,
    )
    from hrsafety.plotting.comparisons.standings import comparison_standings as comparison_standings
    from hrsafety.plotting.comparisons.studies import clearances as clearances, outcomes as outcomes
    from hrsafety.plotting.gains.searches import pareto_front as pareto_front, search_history as search_history
    from hrsafety.plotting.gains.sensitivity import flatness as flatness, gain_sensitivity as gain_sensitivity
    from hrsafety.plotting.impacts.boundaries import foam_boundaries as foam_boundaries, foam_map as foam_map
    from hrsafety.plotting.impacts.histories import (
        impact_histories as impact_histories,
        impact_study as impact_study,
        measured_impact as measured_impact,
    )
    from hrsafety.plotting.impacts.traces import measured_records as measured_records
    from hrsafety.plotting.players import mcap as mcap, player as player
    from hrsafety.plotting.runs.animation import animate as animate
    from hrsafety.plotting.runs.energies import energy as energy
    from hrsafety.plotting.runs.fields import force_field as force_field, potential_valley as potential_valley
    from hrsafety.plotting.runs.histories import distances as distances, lyapunov as lyapunov
    from hrsafety.plotting.runs.layouts import layout as layout
    from hrsafety.plotting.runs.scenes import paths as paths
    from hrsafety.plotting.runs.sequences import time_sequence as time_sequence
    from hrsafety.plotting.style import MissingExtraError as MissingExtraError
    from hrsafety.plotting.sweeps.lines import sweep_lines as sweep_lines, sweep_map as sweep_map
    from hrsafety.plotting.sweeps.overviews import sweep_parallel as sweep_parallel, sweep_scatter as sweep_scatter
    from hrsafety.plotting.zones import zone_attack as zone_attack, zone_fields as zone_fields
else:
    __all__, __getattr__, __dir__ = names_of(
        __name__,
        below=[
            "hrsafety.plotting.arms",
            "hrsafety.plotting.comparisons",
            "hrsafety.plotting.contacts",
            "hrsafety.plotting.crowds",
            "hrsafety.plotting.gains",
            "hrsafety.plotting.impacts",
            "hrsafety.plotting.reactive",
            "hrsafety.plotting.robots",
            "hrsafety.plotting.runs",
            "hrsafety.plotting.sweeps",
        ],
    )
