"""Pictures of environments, drawn by `hrsafety.plotting`."""

from __future__ import annotations

from typing import Any

import numpy as np

from hrsafety.gym.environments import ELAPSED, Environments, Frame
from hrsafety.plotting.crowds.instants import crowd_instant

__all__ = ["picture"]

DPI = 85  # as animations have it


def picture(environments: Environments, index: int, **more: Any) -> Frame:
    """Return a picture of one environment, shape (height, width, 3); `more` as `crowd_instant` takes it."""
    robot, people, robots = environments.places(index)
    world = environments.task.world
    elapsed = float(environments.observations[index, ELAPSED]) * world.time_limit
    bodies = {"robot": robot, "people": people, "robots": robots, "headings": environments.headings(index)}
    figure = crowd_instant(world, time=elapsed, **bodies, **more)
    # Imported when a picture is asked for, as all of matplotlib is.
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure.set_dpi(DPI)
    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    drawn = np.array(canvas.buffer_rgba(), dtype=np.uint8)
    height, width = (size - size % 2 for size in drawn.shape[:2])  # videos want even numbers
    return drawn[:height, :width, :3].copy()
