"""Impact of a foam-covered manipulator on a human head: loads, criteria, foam design, identification."""

from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError, SimulationError
from hrsafety.impact.batch import ImpactMetricsBatch, metrics_batch
from hrsafety.impact.boundaries import FoamBoundary, foam_stiffness_lower, foam_stiffness_upper
from hrsafety.impact.criteria import (
    HeadInjury,
    ImpactMetrics,
    MovingLevel,
    average_3ms,
    clip_3ms,
    hic,
    hic_half_sine,
    hic_square,
    hic_triangle,
    metrics,
)
from hrsafety.impact.cylinder import CylinderController
from hrsafety.impact.design import FoamDesign, design_foam
from hrsafety.impact.direct_drive import DirectDrive, DirectDriveResponse, simulate_direct_drive
from hrsafety.impact.filters import CHANNEL_CLASSES, channel_corner, channel_filter
from hrsafety.impact.foam_tests import FoamFit, StaticFit, drop_trajectory, fit_static, identify_foam
from hrsafety.impact.joint_tests import (
    DirectDriveFit,
    OpenLoopFit,
    PdGains,
    TubeInertia,
    fit_open_loop,
    identify_direct_drive,
    pd_gains,
    tube_inertia,
)
from hrsafety.impact.joints import Joint, dashpots_in_series, impact_point_speed, uniform_links
from hrsafety.impact.limits import FoamFeasibility, FoamLimits, FoamMargin
from hrsafety.impact.parameters import (
    FOAM_1,
    FOAM_2,
    FOAM_3,
    MANIPULATOR_1,
    MANIPULATOR_2,
    ConstrainedHead,
    Foam,
    Head,
    Manipulator,
)
from hrsafety.impact.recorded import recorded_metrics
from hrsafety.impact.response import ImpactResponse, SetPoint, simulate
from hrsafety.impact.sensitivity import ImpactGradients, gradients

__all__ = [
    "CHANNEL_CLASSES",
    "FOAM_1",
    "FOAM_2",
    "FOAM_3",
    "MANIPULATOR_1",
    "MANIPULATOR_2",
    "ConstrainedHead",
    "CylinderController",
    "DirectDrive",
    "DirectDriveFit",
    "DirectDriveResponse",
    "Foam",
    "FoamBoundary",
    "FoamDesign",
    "FoamFeasibility",
    "FoamFit",
    "FoamLimits",
    "FoamMargin",
    "Head",
    "HeadInjury",
    "HrsafetyError",
    "ImpactGradients",
    "ImpactMetrics",
    "ImpactMetricsBatch",
    "ImpactResponse",
    "InvalidParameterError",
    "Joint",
    "Manipulator",
    "MovingLevel",
    "OpenLoopFit",
    "PdGains",
    "SetPoint",
    "ShapeError",
    "SimulationError",
    "StaticFit",
    "TubeInertia",
    "average_3ms",
    "channel_corner",
    "channel_filter",
    "clip_3ms",
    "dashpots_in_series",
    "design_foam",
    "drop_trajectory",
    "fit_open_loop",
    "fit_static",
    "foam_stiffness_lower",
    "foam_stiffness_upper",
    "gradients",
    "hic",
    "hic_half_sine",
    "hic_square",
    "hic_triangle",
    "identify_direct_drive",
    "identify_foam",
    "impact_point_speed",
    "metrics",
    "metrics_batch",
    "pd_gains",
    "recorded_metrics",
    "simulate",
    "simulate_direct_drive",
    "tube_inertia",
    "uniform_links",
]
