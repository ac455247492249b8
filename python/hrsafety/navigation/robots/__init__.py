"""Robots: bodies, wheels with motors and controllers, kinematics, and robots as built."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation.robots.as_built import AsBuilt as AsBuilt, PoseFusion as PoseFusion
    from hrsafety.navigation.robots.bodies import (
        DifferentialDriveRobot as DifferentialDriveRobot,
        HolonomicRobot as HolonomicRobot,
    )
    from hrsafety.navigation.robots.footprint import Footprint as Footprint
    from hrsafety.navigation.robots.kinematics import (
        DifferentialKinematics as DifferentialKinematics,
        OmniKinematics as OmniKinematics,
        Slip as Slip,
    )
    from hrsafety.navigation.robots.published_wheels import (
        DIFFERENTIAL_WHEELS as DIFFERENTIAL_WHEELS,
        HOLONOMIC_WHEELS as HOLONOMIC_WHEELS,
    )
    from hrsafety.navigation.robots.wheel_identification import (
        OpenLoopTest as OpenLoopTest,
        WheelFit as WheelFit,
        identify_wheel as identify_wheel,
        open_loop_tests as open_loop_tests,
    )
    from hrsafety.navigation.robots.wheels import (
        WheelDrive as WheelDrive,
        WheelReference as WheelReference,
        WheelRun as WheelRun,
        follow_wheel as follow_wheel,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
