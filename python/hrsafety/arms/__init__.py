"""Arms from URDF: the mass that a point of an arm has for the person it hits, by pose and direction."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.arms.arm import Arm as Arm
    from hrsafety.arms.histories import MassHistory as MassHistory, along as along
    from hrsafety.arms.inertias import NearestInertia as NearestInertia, nearest_inertia as nearest_inertia
    from hrsafety.arms.masses import EffectiveMass as EffectiveMass, Extremes as Extremes, PointMasses as PointMasses
    from hrsafety.arms.payload import Payload as Payload
    from hrsafety.arms.rolling import RollingBase as RollingBase
    from hrsafety.arms.workspaces import Workspace as Workspace, workspace as workspace
    from hrsafety.errors import InvalidParameterError as InvalidParameterError, ShapeError as ShapeError
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
