"""Parameters from measurements: foam, joints, motors, tubes."""

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
