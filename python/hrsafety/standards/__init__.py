"""Limits of contact as audited data, and protective separation distances."""

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


def __dir__() -> list[str]:
    """List the public names."""
    return sorted(__all__)
