"""Files of others: recorded people, logs of robots, maps, scenes and settings, read by their contents and written."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.errors import FileError as FileError
    from hrsafety.io.logs.load import load_log as load_log
    from hrsafety.io.logs.robot_log import RobotLog as RobotLog
    from hrsafety.io.people.loading import load_people as load_people
    from hrsafety.io.places.crowdnav import CrowdNavScene as CrowdNavScene
    from hrsafety.io.places.hunav import HuNavAgent as HuNavAgent, HuNavScene as HuNavScene
    from hrsafety.io.places.maps import load_map as load_map
    from hrsafety.io.places.nav2 import Nav2Settings as Nav2Settings, read_nav2 as read_nav2
    from hrsafety.io.places.scenes import load_scene as load_scene
    from hrsafety.io.people.tracks import load_track as load_track
    from hrsafety.io.people.writers import write_people as write_people
    from hrsafety.io.reader import Provenance as Provenance
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
