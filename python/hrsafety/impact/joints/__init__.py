"""Joints, drives and cylinders that move the manipulator."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.impact.joints.cylinder import CylinderController as CylinderController
    from hrsafety.impact.joints.direct_drive import (
        DirectDrive as DirectDrive,
        DirectDriveResponse as DirectDriveResponse,
        simulate_direct_drive as simulate_direct_drive,
    )
    from hrsafety.impact.joints.joint import (
        Joint as Joint,
        dashpots_in_series as dashpots_in_series,
        impact_point_speed as impact_point_speed,
        uniform_links as uniform_links,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
