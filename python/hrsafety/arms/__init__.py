"""Arms from URDF: the mass that a point of an arm has for whom it hits, by pose and direction."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.arms.arm import Arm
    from hrsafety.arms.histories import MassHistory, along
    from hrsafety.arms.inertias import NearestInertia, nearest_inertia
    from hrsafety.arms.masses import EffectiveMass, Extremes, PointMasses
    from hrsafety.arms.payload import Payload
    from hrsafety.arms.workspaces import Workspace, workspace
    from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = [
    "Arm",
    "EffectiveMass",
    "Extremes",
    "InvalidParameterError",
    "MassHistory",
    "NearestInertia",
    "Payload",
    "PointMasses",
    "ShapeError",
    "Workspace",
    "along",
    "nearest_inertia",
    "workspace",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.arms.arm": "Arm",
            "hrsafety.arms.histories": "MassHistory along",
            "hrsafety.arms.inertias": "NearestInertia nearest_inertia",
            "hrsafety.arms.masses": "EffectiveMass Extremes PointMasses",
            "hrsafety.arms.payload": "Payload",
            "hrsafety.arms.workspaces": "Workspace workspace",
            "hrsafety.errors": "InvalidParameterError ShapeError",
        },
    )
