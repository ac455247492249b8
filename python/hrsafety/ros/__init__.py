"""People for ROS 2: a world of the package as the surroundings of a robot that is driven over topics.

rclpy is imported only where a bridge is connected to ROS 2; without it everything works on a bus of one's own.
"""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.ros.bridge import Bridge as Bridge, Settings as Settings
    from hrsafety.ros.bus import Bus as Bus, Publisher as Publisher, Quality as Quality
    from hrsafety.ros.record import Leg as Leg, BusRecord as BusRecord
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
