"""Laws that drive a robot: virtual forces, planners, and the parts of the virtual force field."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation.laws.blind_corners import blind_corner_speed as blind_corner_speed
    from hrsafety.navigation.laws.filters import (
        ApproachMonitor as ApproachMonitor,
        Barrier as Barrier,
        BarrierUnicycle as BarrierUnicycle,
        CollisionCone as CollisionCone,
        FilterDecision as FilterDecision,
        ResponsibilityRule as ResponsibilityRule,
        SafetyFilter as SafetyFilter,
        VelocityClamp as VelocityClamp,
    )
    from hrsafety.navigation.laws.force_laws import (
        BorensteinKoren as BorensteinKoren,
        GeCui as GeCui,
        Khatib as Khatib,
        Law as Law,
        Masoud as Masoud,
        VirtualForceField as VirtualForceField,
    )
    from hrsafety.navigation.laws.forces import (
        ForceField as ForceField,
        ForceTerms as ForceTerms,
        Lyapunov as Lyapunov,
        command as command,
        force_field as force_field,
        force_terms as force_terms,
        lyapunov as lyapunov,
    )
    from hrsafety.navigation.laws.impedance import VirtualImpedanceLaw as VirtualImpedanceLaw
    from hrsafety.navigation.laws.foresight import Foresight as Foresight
    from hrsafety.navigation.laws.local_planners import (
        DWB as DWB,
        DynamicWindow as DynamicWindow,
        PathIntegral as PathIntegral,
        RegulatedPurePursuit as RegulatedPurePursuit,
    )
    from hrsafety.navigation.laws.planners import (
        FieldDStar as FieldDStar,
        OptimalReciprocalCollisionAvoidance as OptimalReciprocalCollisionAvoidance,
        RapidlyExploringRandomTree as RapidlyExploringRandomTree,
        SocialForce as SocialForce,
        VelocityObstacle as VelocityObstacle,
    )
    from hrsafety.navigation.laws.python_law import (
        ForceLaw as ForceLaw,
        PythonLaw as PythonLaw,
        TwistLaw as TwistLaw,
        VelocityLaw as VelocityLaw,
    )
    from hrsafety.navigation.laws.safe_navigation import SafeNavigation as SafeNavigation, SafetyTrace as SafetyTrace
    from hrsafety.navigation.laws.shield import (
        Shield as Shield,
        ShieldDecision as ShieldDecision,
        speed_bound as speed_bound,
    )
    from hrsafety.navigation.laws.situation import PointMass as PointMass, Situation as Situation
    from hrsafety.navigation.laws.twists import TwistChoice as TwistChoice
    from hrsafety.navigation.laws.unseen import Unseen as Unseen
    from hrsafety.navigation.laws.yielding import Yielding as Yielding
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
