"""A world that runs while people and the goal are dragged and the robot is set otherwise: ``hrsafety play``."""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety.live.server import serve as serve
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
