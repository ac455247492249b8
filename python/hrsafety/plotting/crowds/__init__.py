"""Pictures of people that react and of robots among them: paths, positions over time, animations."""

from hrsafety.plotting.crowds.animation import animate_crowd
from hrsafety.plotting.crowds.diagrams import fundamental_diagram
from hrsafety.plotting.crowds.paths import crowd_paths
from hrsafety.plotting.crowds.space_time import space_time

__all__ = ["animate_crowd", "crowd_paths", "fundamental_diagram", "space_time"]
