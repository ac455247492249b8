"""Joints, drives and cylinders that move the manipulator."""

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
