"""Ultrasonic sensors and what returns their echoes."""

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
