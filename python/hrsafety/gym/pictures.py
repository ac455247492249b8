"""Pictures of environments, drawn by `hrsafety.plotting`."""

from __future__ import annotations

from typing import Any

import numpy as np

from hrsafety.gym.environments import Environments, Frame
from hrsafety.plotting.runs.crowd_instants import crowd_instant

__all__ = ["picture"]


def picture(environments: Environments, index: int) -> Frame:
    """Return a picture of one environment, shape (height, width, 3)."""
    robot, people, robots = environments.places(index)
    world = environments.task.world
    ends = {"start": world.robots[0].start, "goal": world.robots[0].goal}
    figure = crowd_instant(robot=robot, people=people, robots=robots, walls=world.walls, **ends)
    # Imported when a picture is asked for, as all of matplotlib is.
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas: Any = FigureCanvasAgg(figure)
    canvas.draw()
    return np.array(canvas.buffer_rgba(), dtype=np.uint8)[:, :, :3].copy()
