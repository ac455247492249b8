"""The ultrasonic skirt: a ring of sensors, its geometry, its runs and studies."""

from hrsafety.reactive.skirt.geometry import (
    SensorCount,
    SkirtSpacing,
    least_skirt_sensors,
    skirt_closing_radius,
    skirt_safe_distance,
    skirt_spacing,
)
from hrsafety.reactive.skirt.kinematics import TriOmniKinematics
from hrsafety.reactive.skirt.ring import MOTION_DIRECTIONS, SkirtState, UltrasonicSkirt, skirt_states
from hrsafety.reactive.skirt.runs import (
    SkirtMotion,
    SkirtRun,
    SkirtScene,
    SkirtShares,
    SkirtTest,
    skirt_test,
)
from hrsafety.reactive.skirt.steps import SkirtSteps, skirt_run
from hrsafety.reactive.skirt.study import SmallestSkirt, smallest_skirt

__all__ = [
    "MOTION_DIRECTIONS",
    "SensorCount",
    "SkirtMotion",
    "SkirtRun",
    "SkirtScene",
    "SkirtShares",
    "SkirtSpacing",
    "SkirtState",
    "SkirtSteps",
    "SkirtTest",
    "SmallestSkirt",
    "TriOmniKinematics",
    "UltrasonicSkirt",
    "least_skirt_sensors",
    "skirt_closing_radius",
    "skirt_run",
    "skirt_safe_distance",
    "skirt_spacing",
    "skirt_states",
    "skirt_test",
    "smallest_skirt",
]
