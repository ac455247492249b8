"""Pictures of environments, drawn by `hrsafety.plotting`."""

from __future__ import annotations

from typing import Any

import numpy as np

from hrsafety.gym.environments import ELAPSED, Environments, Frame
from hrsafety.plotting.crowds.instants import crowd_instant

__all__ = ["picture"]


def picture(environments: Environments, index: int) -> Frame:
    """Return a picture of one environment, shape (height, width, 3)."""
    robot, people, robots = environments.places(index)
    world = environments.task.world
    elapsed = float(environments.observations[index, ELAPSED]) * world.time_limit
    figure = crowd_instant(world, time=elapsed, robot=robot, people=people, robots=robots)
    # Imported when a picture is asked for, as all of matplotlib is.
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(canvas.buffer_rgba(), dtype=np.uint8)[:, :, :3].copy()
