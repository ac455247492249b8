"""Joints, drives and cylinders that move the manipulator."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.impact.joints.cylinder import CylinderController
    from hrsafety.impact.joints.direct_drive import DirectDrive, DirectDriveResponse, simulate_direct_drive
    from hrsafety.impact.joints.joint import Joint, dashpots_in_series, impact_point_speed, uniform_links

__all__ = [
    "CylinderController",
    "DirectDrive",
    "DirectDriveResponse",
    "Joint",
    "dashpots_in_series",
    "impact_point_speed",
    "simulate_direct_drive",
    "uniform_links",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.impact.joints.cylinder": "CylinderController",
            "hrsafety.impact.joints.direct_drive": "DirectDrive DirectDriveResponse simulate_direct_drive",
            "hrsafety.impact.joints.joint": "Joint dashpots_in_series impact_point_speed uniform_links",
        },
    )
