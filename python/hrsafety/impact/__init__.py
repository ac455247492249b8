"""Impact of a foam-covered manipulator on a human head: loads, criteria, foam design, identification."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.impact import criteria, identification, joints
    from hrsafety.impact.batch import ImpactMetricsBatch, metrics_batch
    from hrsafety.impact.boundaries import FoamBoundary, foam_stiffness_lower, foam_stiffness_upper
    from hrsafety.impact.criteria.loads import HeadInjury, ImpactMetrics, hic, metrics
    from hrsafety.impact.criteria.recorded import recorded_metrics
    from hrsafety.impact.design import FoamDesign, design_foam
    from hrsafety.impact.identification.foam import FoamFit, identify_foam
    from hrsafety.impact.joints.joint import Joint
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
    from hrsafety.impact.response import ImpactResponse, SetPoint, simulate
    from hrsafety.impact.sensitivity import ImpactGradients, gradients

__all__ = [
    "FOAM_1",
    "FOAM_2",
    "FOAM_3",
    "MANIPULATOR_1",
    "MANIPULATOR_2",
    "ConstrainedHead",
    "Foam",
    "FoamBoundary",
    "FoamDesign",
    "FoamFeasibility",
    "FoamFit",
    "FoamLimits",
    "FoamMargin",
    "Head",
    "HeadInjury",
    "ImpactGradients",
    "ImpactMetrics",
    "ImpactMetricsBatch",
    "ImpactResponse",
    "Joint",
    "Manipulator",
    "SetPoint",
    "criteria",
    "design_foam",
    "foam_stiffness_lower",
    "foam_stiffness_upper",
    "gradients",
    "hic",
    "identification",
    "identify_foam",
    "joints",
    "metrics",
    "metrics_batch",
    "recorded_metrics",
    "simulate",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.impact.batch": "ImpactMetricsBatch metrics_batch",
            "hrsafety.impact.boundaries": "FoamBoundary foam_stiffness_lower foam_stiffness_upper",
            "hrsafety.impact.criteria.loads": "HeadInjury ImpactMetrics hic metrics",
            "hrsafety.impact.criteria.recorded": "recorded_metrics",
            "hrsafety.impact.design": "FoamDesign design_foam",
            "hrsafety.impact.identification.foam": "FoamFit identify_foam",
            "hrsafety.impact.joints.joint": "Joint",
            "hrsafety.impact.limits": "FoamFeasibility FoamLimits FoamMargin",
            "hrsafety.impact.parameters": (
                "FOAM_1 FOAM_2 FOAM_3 MANIPULATOR_1 MANIPULATOR_2 ConstrainedHead Foam Head Manipulator"
            ),
            "hrsafety.impact.response": "ImpactResponse SetPoint simulate",
            "hrsafety.impact.sensitivity": "ImpactGradients gradients",
        },
        below=[
            "hrsafety.impact.criteria",
            "hrsafety.impact.identification",
            "hrsafety.impact.joints",
            "hrsafety.errors",
        ],
    )
