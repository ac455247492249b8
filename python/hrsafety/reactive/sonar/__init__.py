"""Ultrasonic sensors and what returns their echoes."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.reactive.sonar.echoes import (
        Box as Box,
        Cylinder as Cylinder,
        Sonar as Sonar,
        SonarMounts as SonarMounts,
        Wall as Wall,
        cast_rays as cast_rays,
        speed_of_sound as speed_of_sound,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
