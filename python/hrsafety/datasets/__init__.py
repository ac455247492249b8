"""Recorded people: read, check and cut tables of positions over time."""

from hrsafety._calls import suggest
from hrsafety.datasets.flow import Flow
from hrsafety.datasets.recording import Recording
from hrsafety.datasets.robots import RecordedRobot
from hrsafety.datasets.tables import load_pedestrians, load_track

__all__ = ["Flow", "RecordedRobot", "Recording", "load_pedestrians", "load_track"]

suggest(__all__, globals())
