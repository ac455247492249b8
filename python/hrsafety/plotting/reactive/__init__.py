"""Pictures of the follower, the skirt and sounds."""

from hrsafety.plotting.reactive.follower import follower_rates, follower_runs, impedance_forces
from hrsafety.plotting.reactive.follower_movies import animate_follower
from hrsafety.plotting.reactive.skirt import skirt_clearances, skirt_ring, skirt_runs, skirt_sensor_counts
from hrsafety.plotting.reactive.sound import sound_burst, sound_fixes, sound_likeness

__all__ = [
    "animate_follower",
    "follower_rates",
    "follower_runs",
    "impedance_forces",
    "skirt_clearances",
    "skirt_ring",
    "skirt_runs",
    "skirt_sensor_counts",
    "sound_burst",
    "sound_fixes",
    "sound_likeness",
]
