"""Ready scenarios: published configurations, files, random crowds, recorded people, worlds of people that react."""

from hrsafety._calls import suggest
from hrsafety.scenarios.circles import antipodal, circle_crossing
from hrsafety.scenarios.configurations import CONFIGURATIONS, configuration
from hrsafety.scenarios.crowds import random_crowd, random_crowd_batch
from hrsafety.scenarios.files import ScenarioFile, load
from hrsafety.scenarios.recorded_people import Crossing, crossings
from hrsafety.scenarios.recorded_worlds import with_recording
from hrsafety.scenarios.social_scenes import SOCIAL, social
from hrsafety.scenarios.streams import bottleneck, corridor, cross_torus, crossing
from hrsafety.scenarios.traffic import random_traffic, random_traffic_batch
from hrsafety.scenarios.world_files import load_world

__all__ = [
    "CONFIGURATIONS",
    "SOCIAL",
    "Crossing",
    "ScenarioFile",
    "antipodal",
    "bottleneck",
    "circle_crossing",
    "configuration",
    "corridor",
    "cross_torus",
    "crossing",
    "crossings",
    "load",
    "load_world",
    "random_crowd",
    "random_crowd_batch",
    "random_traffic",
    "random_traffic_batch",
    "social",
    "with_recording",
]

suggest(__all__, globals())
