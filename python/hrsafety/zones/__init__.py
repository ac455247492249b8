"""Zones that stop a robot before it touches a person: closed forms, Nav2's collision monitor, design and attacks."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.errors import InfeasibleError as InfeasibleError, InvalidParameterError as InvalidParameterError
    from hrsafety.zones.attacks import (
        GENES as GENES,
        Attacked as Attacked,
        AttackRun as AttackRun,
        attack as attack,
        replay as replay,
    )
    from hrsafety.zones.checking import ShapeCheck as ShapeCheck, ZoneCheck as ZoneCheck, check as check
    from hrsafety.zones.conditions import Conditions as Conditions
    from hrsafety.zones.field_design import (
        CommandRange as CommandRange,
        Zone as Zone,
        ZoneSet as ZoneSet,
        design as design,
    )
    from hrsafety.zones.formulas import (
        Extents as Extents,
        StoppingTravel as StoppingTravel,
        allowed_speed as allowed_speed,
        approach_contact_speed as approach_contact_speed,
        blind_range as blind_range,
        leg_depth as leg_depth,
        protective_field as protective_field,
        rear_extension as rear_extension,
        stopping_travel as stopping_travel,
        turning_extents as turning_extents,
    )
    from hrsafety.zones.monitor import (
        CollisionMonitor as CollisionMonitor,
        MonitoredVelocity as MonitoredVelocity,
        MonitorPolygon as MonitorPolygon,
        VelocityRange as VelocityRange,
    )
    from hrsafety.zones.monitor_files import load_monitor as load_monitor
    from hrsafety.zones.monitor_text import mended as mended
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
