"""Robots: bodies, wheels with motors and controllers, kinematics, and robots as built."""

from hrsafety.navigation.robots.as_built import AsBuilt, PoseFusion
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.robots.kinematics import DifferentialKinematics, OmniKinematics, Slip
from hrsafety.navigation.robots.wheel_identification import OpenLoopTest, WheelFit, identify_wheel, open_loop_tests
from hrsafety.navigation.robots.wheels import (
    DIFFERENTIAL_WHEELS,
    HOLONOMIC_WHEELS,
    WheelDrive,
    WheelReference,
    WheelRun,
    follow_wheel,
)

__all__ = [
    "DIFFERENTIAL_WHEELS",
    "HOLONOMIC_WHEELS",
    "AsBuilt",
    "DifferentialDriveRobot",
    "DifferentialKinematics",
    "HolonomicRobot",
    "OmniKinematics",
    "OpenLoopTest",
    "PoseFusion",
    "Slip",
    "WheelDrive",
    "WheelFit",
    "WheelReference",
    "WheelRun",
    "follow_wheel",
    "identify_wheel",
    "open_loop_tests",
]
