"""What stands still, and plans through it: static maps of any source, the guide, distance transforms."""

from hrsafety.navigation.maps.distances import distance_transform
from hrsafety.navigation.maps.guide import Guide, LocalGoal, Plan
from hrsafety.navigation.maps.parts import Cells, Wall
from hrsafety.navigation.maps.static_map import StaticMap

__all__ = ["Cells", "Guide", "LocalGoal", "Plan", "StaticMap", "Wall", "distance_transform"]
