"""Robots: bodies, wheels with motors and controllers, kinematics, and robots as built."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.navigation.robots.as_built import AsBuilt, PoseFusion
    from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
    from hrsafety.navigation.robots.kinematics import DifferentialKinematics, OmniKinematics, Slip
    from hrsafety.navigation.robots.published_wheels import DIFFERENTIAL_WHEELS, HOLONOMIC_WHEELS
    from hrsafety.navigation.robots.wheel_identification import OpenLoopTest, WheelFit, identify_wheel, open_loop_tests
    from hrsafety.navigation.robots.wheels import WheelDrive, WheelReference, WheelRun, follow_wheel

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

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.navigation.robots.as_built": "AsBuilt PoseFusion",
            "hrsafety.navigation.robots.bodies": "DifferentialDriveRobot HolonomicRobot",
            "hrsafety.navigation.robots.kinematics": "DifferentialKinematics OmniKinematics Slip",
            "hrsafety.navigation.robots.published_wheels": "DIFFERENTIAL_WHEELS HOLONOMIC_WHEELS",
            "hrsafety.navigation.robots.wheel_identification": "OpenLoopTest WheelFit identify_wheel open_loop_tests",
            "hrsafety.navigation.robots.wheels": "WheelDrive WheelReference WheelRun follow_wheel",
        },
    )
