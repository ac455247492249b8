"""Ready scenarios: published configurations, files, random crowds, recorded people."""

from hrsafety.scenarios.configurations import CONFIGURATIONS, configuration
from hrsafety.scenarios.crowds import random_crowd, random_crowd_batch
from hrsafety.scenarios.files import ScenarioFile, load
from hrsafety.scenarios.recorded_people import Crossing, crossings
from hrsafety.scenarios.traffic import random_traffic, random_traffic_batch

__all__ = [
    "CONFIGURATIONS",
    "Crossing",
    "ScenarioFile",
    "configuration",
    "crossings",
    "load",
    "random_crowd",
    "random_crowd_batch",
    "random_traffic",
    "random_traffic_batch",
]
