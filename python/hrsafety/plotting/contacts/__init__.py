"""Pictures of contacts with people."""

from hrsafety.plotting.contacts.loads import contact_forces, forces_over_speed
from hrsafety.plotting.contacts.programs import speed_over_path
from hrsafety.plotting.contacts.speeds import contact_sensitivity, speed_map, speed_over_distance

__all__ = [
    "contact_forces",
    "contact_sensitivity",
    "forces_over_speed",
    "speed_map",
    "speed_over_distance",
    "speed_over_path",
]
