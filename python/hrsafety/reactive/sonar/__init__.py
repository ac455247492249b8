"""Ultrasonic sensors and what returns their echoes."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.reactive.sonar.echoes import Box, Disc, Sonar, SonarMounts, Wall, cast_rays, speed_of_sound

__all__ = [
    "Box",
    "Disc",
    "Sonar",
    "SonarMounts",
    "Wall",
    "cast_rays",
    "speed_of_sound",
]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.reactive.sonar.echoes": "Box Disc Sonar SonarMounts Wall cast_rays speed_of_sound",
        },
    )
