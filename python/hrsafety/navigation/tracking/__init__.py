"""Two-wheel robots that follow a reference: tracking laws, references, runs."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
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

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.navigation.robots.tracking_laws": (
                "ExponentialTracking FullSpeedTracking NonlinearTracking Tracking Twist VirtualTorque"
            ),
            "hrsafety.navigation.tracking.references": (
                "CircleReference LineReference PathReference Reference ReferenceMotion"
            ),
            "hrsafety.navigation.tracking.runs": "TrackingSummary track track_batch",
        },
    )
