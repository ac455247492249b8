"""Limits of contact as audited data, and protective separation distances."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.errors import InvalidParameterError as InvalidParameterError, ShapeError as ShapeError
    from hrsafety.standards.contact_limits import (
        CONTACTS as CONTACTS,
        ContactLimit as ContactLimit,
        Quantity as Quantity,
        Verdict as Verdict,
    )
    from hrsafety.standards.fields import FieldDistances as FieldDistances, field_distances as field_distances
    from hrsafety.standards.guards import GuardDistance as GuardDistance, minimum_distance as minimum_distance
    from hrsafety.standards.limit_sets import LimitRow as LimitRow, LimitSet as LimitSet
    from hrsafety.standards.robot_classes import RobotClass as RobotClass, robot_class as robot_class
    from hrsafety.standards.separation import (
        SpeedCurve as SpeedCurve,
        StoppingData as StoppingData,
        separation_distance as separation_distance,
        separation_speed as separation_speed,
        speed_over_distance as speed_over_distance,
    )
    from hrsafety.standards.sets import SETS as SETS, limits as limits
    from hrsafety.standards.user_sets import load_limits as load_limits, template as template
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
