"""Laws that drive a robot: virtual forces, planners, and the parts of the virtual force field."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.navigation.laws.force_laws import BorensteinKoren, GeCui, Khatib, Law, Masoud, VirtualForceField
    from hrsafety.navigation.laws.forces import (
        ForceField,
        ForceTerms,
        Lyapunov,
        command,
        force_field,
        force_terms,
        lyapunov,
    )
    from hrsafety.navigation.laws.impedance import VirtualImpedanceLaw
    from hrsafety.navigation.laws.planners import (
        FieldDStar,
        OptimalReciprocalCollisionAvoidance,
        RapidlyExploringRandomTree,
        VelocityObstacle,
    )
    from hrsafety.navigation.laws.python_law import ForceLaw, PythonLaw, VelocityLaw
    from hrsafety.navigation.laws.safe_navigation import SafeNavigation, SafetyTrace
    from hrsafety.navigation.laws.shield import Shield, ShieldDecision, speed_bound
    from hrsafety.navigation.laws.situation import PointMass, Situation
    from hrsafety.navigation.laws.yielding import Yielding

__all__ = [
    "BorensteinKoren",
    "FieldDStar",
    "ForceField",
    "ForceLaw",
    "ForceTerms",
    "GeCui",
    "Khatib",
    "Law",
    "Lyapunov",
    "Masoud",
    "OptimalReciprocalCollisionAvoidance",
    "PointMass",
    "PythonLaw",
    "RapidlyExploringRandomTree",
    "SafeNavigation",
    "SafetyTrace",
    "Shield",
    "ShieldDecision",
    "Situation",
    "VelocityLaw",
    "VelocityObstacle",
    "VirtualForceField",
    "VirtualImpedanceLaw",
    "Yielding",
    "command",
    "force_field",
    "force_terms",
    "lyapunov",
    "speed_bound",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.navigation.laws.force_laws": "BorensteinKoren GeCui Khatib Law Masoud VirtualForceField",
            "hrsafety.navigation.laws.forces": (
                "ForceField ForceTerms Lyapunov command force_field force_terms lyapunov"
            ),
            "hrsafety.navigation.laws.impedance": "VirtualImpedanceLaw",
            "hrsafety.navigation.laws.planners": (
                "FieldDStar OptimalReciprocalCollisionAvoidance RapidlyExploringRandomTree VelocityObstacle"
            ),
            "hrsafety.navigation.laws.python_law": "ForceLaw PythonLaw VelocityLaw",
            "hrsafety.navigation.laws.safe_navigation": "SafeNavigation SafetyTrace",
            "hrsafety.navigation.laws.shield": "Shield ShieldDecision speed_bound",
            "hrsafety.navigation.laws.situation": "PointMass Situation",
            "hrsafety.navigation.laws.yielding": "Yielding",
        },
    )
