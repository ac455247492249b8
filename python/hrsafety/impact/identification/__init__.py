"""Parameters from measurements: foam, joints, motors, tubes."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.impact.identification.foam import FoamFit, StaticFit, drop_trajectory, fit_static, identify_foam
    from hrsafety.impact.identification.joints import (
        DirectDriveFit,
        OpenLoopFit,
        PdGains,
        TubeInertia,
        fit_open_loop,
        identify_direct_drive,
        pd_gains,
        tube_inertia,
    )

__all__ = [
    "DirectDriveFit",
    "FoamFit",
    "OpenLoopFit",
    "PdGains",
    "StaticFit",
    "TubeInertia",
    "drop_trajectory",
    "fit_open_loop",
    "fit_static",
    "identify_direct_drive",
    "identify_foam",
    "pd_gains",
    "tube_inertia",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.impact.identification.foam": "FoamFit StaticFit drop_trajectory fit_static identify_foam",
            "hrsafety.impact.identification.joints": (
                "DirectDriveFit OpenLoopFit PdGains TubeInertia fit_open_loop identify_direct_drive "
                "pd_gains tube_inertia"
            ),
        },
    )
