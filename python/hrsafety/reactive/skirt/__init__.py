"""The ultrasonic skirt: a ring of sensors, its geometry, its runs and studies."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.reactive.skirt.geometry import (
        SensorCount as SensorCount,
        SkirtSpacing as SkirtSpacing,
        least_skirt_sensors as least_skirt_sensors,
        skirt_closing_radius as skirt_closing_radius,
        skirt_safe_distance as skirt_safe_distance,
        skirt_spacing as skirt_spacing,
    )
    from hrsafety.reactive.skirt.kinematics import TriOmniKinematics as TriOmniKinematics
    from hrsafety.reactive.skirt.ring import (
        MOTION_DIRECTIONS as MOTION_DIRECTIONS,
        SkirtState as SkirtState,
        UltrasonicSkirt as UltrasonicSkirt,
        skirt_states as skirt_states,
    )
    from hrsafety.reactive.skirt.runs import (
        SkirtMotion as SkirtMotion,
        SkirtRun as SkirtRun,
        SkirtScene as SkirtScene,
        SkirtShares as SkirtShares,
        SkirtTest as SkirtTest,
        skirt_test as skirt_test,
    )
    from hrsafety.reactive.skirt.steps import SkirtSteps as SkirtSteps, skirt_run as skirt_run
    from hrsafety.reactive.skirt.study import SmallestSkirt as SmallestSkirt, smallest_skirt as smallest_skirt
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
