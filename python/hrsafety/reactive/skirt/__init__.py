"""The ultrasonic skirt: a ring of sensors, its geometry, its runs and studies."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
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

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.reactive.skirt.geometry": (
                "SensorCount SkirtSpacing least_skirt_sensors skirt_closing_radius skirt_safe_distance skirt_spacing"
            ),
            "hrsafety.reactive.skirt.kinematics": "TriOmniKinematics",
            "hrsafety.reactive.skirt.ring": "MOTION_DIRECTIONS SkirtState UltrasonicSkirt skirt_states",
            "hrsafety.reactive.skirt.runs": "SkirtMotion SkirtRun SkirtScene SkirtShares SkirtTest skirt_test",
            "hrsafety.reactive.skirt.steps": "SkirtSteps skirt_run",
            "hrsafety.reactive.skirt.study": "SmallestSkirt smallest_skirt",
        },
    )
