"""Base of the sensors that ride on a robot."""

from __future__ import annotations

from typing import ClassVar

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters

__all__ = ["RobotSensor"]


class RobotSensor(Parameters):
    """A sensor on a robot, made by the core of its options by name; a robot carries any of them.

    Attributes
    ----------
    NAME : str
        Name in the core's list of sensors, which also tells what told a law of obstacles.
    RANGE : str
        Name of the option that says how far it reads.
    TELLS : bool
        Whether it tells a law of obstacles.
    max_speed : float
        Largest speed in m/s of what it sees, for which the regions of its readings are sized; of one that tells.
    """

    __slots__ = ("_native",)
    NAME: ClassVar[str]
    RANGE: ClassVar[str]
    TELLS: ClassVar[bool] = True
    max_speed: float
    _native: _hrsafety.Sensor

    def _make(self, **options: object) -> None:
        """Make the native sensor of its options; it checks all values."""
        self._set(_native=_hrsafety.Sensor.named(self.NAME, **options))
