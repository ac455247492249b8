"""Laws that drive a robot: virtual forces, planners, and the parts of the virtual force field."""

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
from hrsafety.navigation.laws.situation import PointMass, Situation

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
    "Situation",
    "VelocityLaw",
    "VelocityObstacle",
    "VirtualForceField",
    "VirtualImpedanceLaw",
    "command",
    "force_field",
    "force_terms",
    "lyapunov",
]
