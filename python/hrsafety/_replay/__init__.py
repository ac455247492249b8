"""Player of recorded motion among robots and people: one HTML file that needs nothing else.

Results say what they show as a `Replay`; this package knows none of them.
"""

from typing import TYPE_CHECKING

from hrsafety._namespace import names_of

if TYPE_CHECKING:  # the names of the package, each loaded when it is asked for
    from hrsafety._replay.page import PlayerPage as PlayerPage, player_page as player_page
    from hrsafety._replay.played import Played as Played
    from hrsafety._replay.record import (
        Decisions as Decisions,
        Event as Event,
        UnjudgedTime as UnjudgedTime,
        PlayedCells as PlayedCells,
        PlayedRobot as PlayedRobot,
        Replay as Replay,
    )
else:
    __all__, __getattr__, __dir__ = names_of(__name__)
