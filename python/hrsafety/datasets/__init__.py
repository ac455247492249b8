"""Recorded people: who is where at which instant, checked, cut and doubted; `hrsafety.io` reads the files."""

from hrsafety._calls import suggest
from hrsafety.datasets.flow import Flow
from hrsafety.datasets.motion import RecordedMotion
from hrsafety.datasets.recording import Recording
from hrsafety.datasets.robots import RecordedRobot

__all__ = ["Flow", "RecordedMotion", "RecordedRobot", "Recording"]

suggest(__all__, globals())
