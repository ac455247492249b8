"""The wheels of the robots of the thesis, which are made when they are first used."""

from __future__ import annotations

from hrsafety import _hrsafety
from hrsafety.navigation.robots.wheels import WheelDrive

__all__ = ["DIFFERENTIAL_WHEELS", "HOLONOMIC_WHEELS"]

HOLONOMIC_WHEELS: tuple[WheelDrive, ...] = tuple(WheelDrive(**each) for each in _hrsafety.holonomic_wheels())
"""Wheels 1 to 3 of the holonomic robot: (D.2.6) and Table D.2 of Zeng (2011)."""

DIFFERENTIAL_WHEELS: tuple[WheelDrive, ...] = tuple(WheelDrive(**each) for each in _hrsafety.differential_wheels())
"""Right and left wheel of the differential-drive robot: (E.2.6) and Table E.2 of Zeng (2011)."""
