"""Arms from URDF: the mass that a point of an arm has for whom it hits, by pose and direction."""

from hrsafety.arms.arm import Arm
from hrsafety.arms.histories import MassHistory, along
from hrsafety.arms.masses import Extremes, PointMasses
from hrsafety.arms.payload import Payload
from hrsafety.arms.workspace import Workspace, workspace
from hrsafety.errors import InvalidParameterError, ShapeError

__all__ = [
    "Arm",
    "Extremes",
    "InvalidParameterError",
    "MassHistory",
    "Payload",
    "PointMasses",
    "ShapeError",
    "Workspace",
    "along",
    "workspace",
]


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
