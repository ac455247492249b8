"""Limits of contact as audited data, and protective separation distances."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.errors import InvalidParameterError, ShapeError
    from hrsafety.standards.contact_limits import CONTACTS, ContactLimit, Quantity, Verdict
    from hrsafety.standards.guards import GuardDistance, minimum_distance
    from hrsafety.standards.limit_sets import LimitRow, LimitSet
    from hrsafety.standards.separation import (
        SpeedCurve,
        StoppingData,
        separation_distance,
        separation_speed,
        speed_over_distance,
    )
    from hrsafety.standards.sets import SETS, limits
    from hrsafety.standards.user_sets import load_limits, template

__all__ = [
    "CONTACTS",
    "SETS",
    "ContactLimit",
    "GuardDistance",
    "InvalidParameterError",
    "LimitRow",
    "LimitSet",
    "Quantity",
    "ShapeError",
    "SpeedCurve",
    "StoppingData",
    "Verdict",
    "limits",
    "load_limits",
    "minimum_distance",
    "separation_distance",
    "separation_speed",
    "speed_over_distance",
    "template",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.errors": "InvalidParameterError ShapeError",
            "hrsafety.standards.contact_limits": "CONTACTS ContactLimit Quantity Verdict",
            "hrsafety.standards.guards": "GuardDistance minimum_distance",
            "hrsafety.standards.limit_sets": "LimitRow LimitSet",
            "hrsafety.standards.separation": (
                "SpeedCurve StoppingData separation_distance separation_speed speed_over_distance"
            ),
            "hrsafety.standards.sets": "SETS limits",
            "hrsafety.standards.user_sets": "load_limits template",
        },
    )
