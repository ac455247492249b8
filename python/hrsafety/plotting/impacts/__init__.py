"""Pictures of impacts and of foam designs."""

from hrsafety.plotting.impacts.boundaries import foam_boundaries, foam_map
from hrsafety.plotting.impacts.histories import impact_histories, impact_study, measured_impact
from hrsafety.plotting.impacts.traces import measured_records

__all__ = [
    "foam_boundaries",
    "foam_map",
    "impact_histories",
    "impact_study",
    "measured_impact",
    "measured_records",
]
