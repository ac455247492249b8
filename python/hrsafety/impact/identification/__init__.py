"""Parameters from measurements: foam, joints, motors, tubes."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.impact.identification.foam import (
        FoamFit as FoamFit,
        StaticFit as StaticFit,
        drop_trajectory as drop_trajectory,
        fit_static as fit_static,
        identify_foam as identify_foam,
    )
    from hrsafety.impact.identification.joints import (
        DirectDriveFit as DirectDriveFit,
        OpenLoopFit as OpenLoopFit,
        PdGains as PdGains,
        TubeInertia as TubeInertia,
        fit_open_loop as fit_open_loop,
        identify_direct_drive as identify_direct_drive,
        pd_gains as pd_gains,
        tube_inertia as tube_inertia,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
