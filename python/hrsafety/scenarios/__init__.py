"""Ready scenarios: published configurations, files, random crowds, recorded people."""

from hrsafety.scenarios.configurations import CONFIGURATIONS, configuration
from hrsafety.scenarios.crowds import random_crowd
from hrsafety.scenarios.files import ScenarioFile, load
from hrsafety.scenarios.recorded_people import Crossing, crossings

__all__ = [
    "CONFIGURATIONS",
    "Crossing",
    "ScenarioFile",
    "configuration",
    "crossings",
    "load",
    "random_crowd",
]
