"""Two-wheel robots that follow a reference: tracking laws, references, runs."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation.robots.tracking_laws import (
        ExponentialTracking as ExponentialTracking,
        FullSpeedTracking as FullSpeedTracking,
        NonlinearTracking as NonlinearTracking,
        Tracking as Tracking,
        Twist as Twist,
        VirtualTorque as VirtualTorque,
    )
    from hrsafety.navigation.tracking.references import (
        CircleReference as CircleReference,
        LineReference as LineReference,
        PathReference as PathReference,
        Reference as Reference,
        ReferenceMotion as ReferenceMotion,
    )
    from hrsafety.navigation.tracking.runs import (
        TrackingSummary as TrackingSummary,
        track as track,
        track_batch as track_batch,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
