"""Impact of a foam-covered manipulator on a human head: loads, criteria, foam design, identification."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.impact import criteria as criteria, identification as identification, joints as joints
    from hrsafety.impact.batch import ImpactMetricsBatch as ImpactMetricsBatch, metrics_batch as metrics_batch
    from hrsafety.impact.boundaries import (
        FoamBoundary as FoamBoundary,
        foam_stiffness_lower as foam_stiffness_lower,
        foam_stiffness_upper as foam_stiffness_upper,
    )
    from hrsafety.impact.criteria.loads import (
        HeadInjury as HeadInjury,
        ImpactMetrics as ImpactMetrics,
        hic as hic,
        metrics as metrics,
    )
    from hrsafety.impact.criteria.recorded import recorded_metrics as recorded_metrics
    from hrsafety.impact.design import FoamDesign as FoamDesign, design_foam as design_foam
    from hrsafety.impact.identification.foam import FoamFit as FoamFit, identify_foam as identify_foam
    from hrsafety.impact.joints.joint import Joint as Joint
    from hrsafety.impact.limits import (
        FoamFeasibility as FoamFeasibility,
        FoamLimits as FoamLimits,
        FoamMargin as FoamMargin,
    )
    from hrsafety.impact.parameters import (
        ConstrainedHead as ConstrainedHead,
        FOAM_1 as FOAM_1,
        FOAM_2 as FOAM_2,
        FOAM_3 as FOAM_3,
        Foam as Foam,
        Head as Head,
        MANIPULATOR_1 as MANIPULATOR_1,
        MANIPULATOR_2 as MANIPULATOR_2,
        Manipulator as Manipulator,
    )
    from hrsafety.impact.response import ImpactResponse as ImpactResponse, SetPoint as SetPoint, simulate as simulate
    from hrsafety.impact.sensitivity import ImpactGradients as ImpactGradients, gradients as gradients
else:
    __all__, __getattr__, __dir__ = names_of(
        __name__,
        below=[
            "hrsafety.impact.criteria",
            "hrsafety.impact.identification",
            "hrsafety.impact.joints",
            "hrsafety.errors",
        ],
    )
