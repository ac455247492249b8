"""Two-wheel robots that follow a reference: tracking laws, references, runs."""

from hrsafety.navigation.robots.tracking_laws import (
    ExponentialTracking,
    FullSpeedTracking,
    NonlinearTracking,
    Tracking,
    Twist,
    VirtualTorque,
)
from hrsafety.navigation.tracking.references import (
    CircleReference,
    LineReference,
    PathReference,
    Reference,
    ReferenceMotion,
)
from hrsafety.navigation.tracking.runs import TrackingSummary, track, track_batch

__all__ = [
    "CircleReference",
    "ExponentialTracking",
    "FullSpeedTracking",
    "LineReference",
    "NonlinearTracking",
    "PathReference",
    "Reference",
    "ReferenceMotion",
    "Tracking",
    "TrackingSummary",
    "Twist",
    "VirtualTorque",
    "track",
    "track_batch",
]
