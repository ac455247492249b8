"""Pictures of wheels, tracking and cameras."""

from hrsafety.plotting.robots.camera import calibration_errors, velocity_estimates
from hrsafety.plotting.robots.tracking import tracking_errors, tracking_paths
from hrsafety.plotting.robots.wheels import wheel_identification, wheel_tracking

__all__ = [
    "calibration_errors",
    "tracking_errors",
    "tracking_paths",
    "velocity_estimates",
    "wheel_identification",
    "wheel_tracking",
]
