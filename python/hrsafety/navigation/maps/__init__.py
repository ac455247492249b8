"""Static maps of any source, and plans through them: the guide, distance transforms."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.navigation.maps.distances import distance_transform as distance_transform
    from hrsafety.navigation.maps.guide import Guide as Guide, LocalGoal as LocalGoal, Plan as Plan
    from hrsafety.navigation.maps.parts import Cells as Cells, PolylineWall as PolylineWall
    from hrsafety.navigation.maps.static_map import StaticMap as StaticMap
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
