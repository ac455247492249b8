"""Environments for learners, for Gymnasium: one robot among people that react, single or a thousand side by side.

`parallel_env` has many robots in one world, for PettingZoo.

Importing this module registers ``hrsafety/CircleCrossing-v0``, ``hrsafety/Corridor-v0``, ``hrsafety/Crossing-v0`` and
``hrsafety/Bottleneck-v0``; ``gymnasium.make("hrsafety.gym:hrsafety/CircleCrossing-v0")`` imports it by itself. It needs
``pip install gymnasium``.
"""

import importlib.util

from hrsafety._calls import suggest
from hrsafety.errors import MissingExtraError

if importlib.util.find_spec("gymnasium") is None:
    raise MissingExtraError("environments for learners need gymnasium: pip install gymnasium")

from hrsafety.gym.parallel import parallel_env
from hrsafety.gym.policy_law import PolicyLaw
from hrsafety.gym.registration import IDS, register
from hrsafety.gym.single import CrowdEnv
from hrsafety.gym.vector import CrowdVectorEnv
from hrsafety.gym.videos import video
from hrsafety.gym.worlds import Task, bottleneck, circle_crossing, corridor, crossing

__all__ = [
    "IDS",
    "CrowdEnv",
    "CrowdVectorEnv",
    "PolicyLaw",
    "Task",
    "bottleneck",
    "circle_crossing",
    "corridor",
    "crossing",
    "parallel_env",
    "register",
    "video",
]

suggest(__all__, globals())
register()
