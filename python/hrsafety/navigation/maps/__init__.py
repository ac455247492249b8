"""What stands still, and plans through it: static maps of any source, the guide, distance transforms."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:
    from hrsafety.navigation.maps.distances import distance_transform
    from hrsafety.navigation.maps.guide import Guide, LocalGoal, Plan
    from hrsafety.navigation.maps.parts import Cells, Wall
    from hrsafety.navigation.maps.static_map import StaticMap

__all__ = ["Cells", "Guide", "LocalGoal", "Plan", "StaticMap", "Wall", "distance_transform"]

if not TYPE_CHECKING:  # loaded when they are asked for; a type checker asks for the place where a name stands
    __getattr__, __dir__ = names_of(
        __name__,
        __all__,
        {
            "hrsafety.navigation.maps.distances": "distance_transform",
            "hrsafety.navigation.maps.guide": "Guide LocalGoal Plan",
            "hrsafety.navigation.maps.parts": "Cells Wall",
            "hrsafety.navigation.maps.static_map": "StaticMap",
        },
    )
