"""Pictures of sweeps."""

from hrsafety.plotting.sweeps.lines import sweep_lines, sweep_map
from hrsafety.plotting.sweeps.overviews import sweep_parallel, sweep_scatter

__all__ = [
    "sweep_lines",
    "sweep_map",
    "sweep_parallel",
    "sweep_scatter",
]
