"""Ready scenarios: published configurations, files, random crowds, recorded people."""

from hrsafety.scenarios.configurations import CONFIGURATIONS, configuration
from hrsafety.scenarios.crowds import random_crowd
from hrsafety.scenarios.files import ScenarioFile, load
from hrsafety.scenarios.recorded_people import Crossing, crossings
from hrsafety.scenarios.traffic import random_traffic

__all__ = [
    "CONFIGURATIONS",
    "Crossing",
    "ScenarioFile",
    "configuration",
    "crossings",
    "load",
    "random_crowd",
    "random_traffic",
]
