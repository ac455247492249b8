"""How the criteria of an impact go with the closing speed."""

POWERS = {
    "peak_head_acceleration": 1.0,
    "peak_head_acceleration_g": 1.0,
    "mean_head_acceleration_g": 1.0,
    "peak_contact_force": 1.0,
    "max_compression": 1.0,
    "impact_duration": 0.0,
    "hic15": 2.5,
    "hic36": 2.5,
    "average_3ms_g": 1.0,
    "clip_3ms_g": 1.0,
    "peak_power_manipulator": 2.0,
    "peak_power_foam": 2.0,
}
"""Power of the closing speed that each criterion goes with, when the manipulator's speed goes with it."""
