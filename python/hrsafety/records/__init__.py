"""Measured contacts: files of devices, and what acceleration, force and pressure say about limits."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.records.accelerations import AccelerationRecord as AccelerationRecord
    from hrsafety.records.accelerations import acceleration as acceleration
    from hrsafety.records.forces import ForceDevice as ForceDevice
    from hrsafety.records.forces import ForceRecord as ForceRecord
    from hrsafety.records.forces import MeasuredContact as MeasuredContact
    from hrsafety.records.forces import force as force
    from hrsafety.records.forces import load_device as load_device
    from hrsafety.records.pressures import PressureRecord as PressureRecord
    from hrsafety.records.pressures import pressure as pressure
    from hrsafety.records.record import Record as Record
    from hrsafety.records.record import load as load
    from hrsafety.records.repeated import Repetitions as Repetitions
    from hrsafety.records.repeated import repetitions as repetitions
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
