"""How runs of several laws are told apart: checks, colors, legends and the view they share."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.declared import Law
from hrsafety.navigation.laws.known import LAWS
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plotting import inputs, shapes, style
from hrsafety.plotting.floor import CONTACT, handle
from hrsafety.plotting.runs.scenes import MARGIN

if TYPE_CHECKING:
    from matplotlib.artist import Artist

Runs = dict[str, Trajectory]

# Tol's muted colors, which differ for every common kind of color vision, as the laws declare them; planners are dashed.
LAW_COLORS: dict[type[Law], str] = {each: each.COLOR for each in LAWS.values() if each.COLOR}
FORCE_STYLES = ("-", (0, (8, 1.5)), (0, (1.2, 1.2)))
PLANNER_STYLES = ((0, (5, 2)), (0, (5, 1.5, 1, 1.5)), (0, (2.5, 1.2)))
CROSS: style.Properties = CONTACT | {"markersize": 9}


def checked_runs(runs: object) -> Runs:
    """Return the runs by name; all of one scenario."""
    if not isinstance(runs, Mapping) or not runs:
        raise InvalidParameterError("runs", "be a mapping of names to runs that is not empty", runs)
    given = {str(name): inputs.checked_trajectory(f"runs[{name!r}]", run) for name, run in runs.items()}
    first = next(iter(given.values())).scenario
    for name, run in given.items():
        other = run.scenario
        for part in ("start", "goal", "obstacles", "robot"):
            if getattr(other, part) != getattr(first, part):
                rule = f"have the {part} of the first run, because all are drawn in one scene"
                raise InvalidParameterError(f"runs[{name!r}]", rule, getattr(other, part))
    return given


def longest(runs: Runs) -> Trajectory:
    """Return the run that lasts longest: it knows most of the obstacles."""
    return max(runs.values(), key=lambda run: float(run.time[-1]))


def looks_of(runs: Runs) -> dict[str, style.Properties]:
    """Return color and line style of each run: the color by the kind of law."""
    seen: dict[type[Law], int] = {}
    found: dict[str, style.Properties] = {}
    for name, run in runs.items():
        kind = type(run.law)
        styles = PLANNER_STYLES if getattr(run.law, "PLANS", False) else FORCE_STYLES
        number = seen.get(kind, 0)
        seen[kind] = number + 1
        color = LAW_COLORS.get(kind, style.NEUTRAL)
        found[name] = {"color": color, "linestyle": styles[number % len(styles)], "linewidth": 1.9}
    return found


def limits_of(runs: Runs, *, whole: bool, least_ratio: float = 0.4) -> style.Limits:
    """Return limits that hold all paths and what stands: all of it, or what is within reach of the paths."""
    first = next(iter(runs.values())).scenario
    points = [run.position for run in runs.values()] + [np.array([first.start, first.goal])]
    for index, obstacle in enumerate(first.obstacles):
        if not shapes.is_mobile(obstacle):
            near = min(float(np.nanmin(run.distance[:, index])) for run in runs.values())
            if whole or near < shapes.region_radii(obstacle)[0]:
                points.append(shapes.body(obstacle, shapes.center(obstacle)).get_extents().get_points())
    return inputs.view_limits(points, margin=MARGIN, least_ratio=least_ratio)


def cross_handle() -> Artist:
    """Return the legend entry of a first contact."""
    return handle("first contact", **CROSS)


def law_handles(looks: Mapping[str, style.Properties], **mark: object) -> list[Artist]:
    """Return one legend entry for each law."""
    return [handle(name, **(look | mark)) for name, look in looks.items()]


def event_handles(runs: Runs, *, ends: bool = True, until: float = np.inf) -> list[Artist]:
    """Return legend entries for ends without arrival, and for contacts up to an instant in s, if there are any."""
    handles: list[Artist] = []
    if ends and any(not np.isfinite(run.arrival_time) for run in runs.values()):
        handles.append(handle("end, not arrived", marker="s", markersize=7))
    if any((inputs.contact_times(run) <= until).any() for run in runs.values()):
        handles.append(cross_handle())
    return handles


def obstacle_color(obstacle: Obstacle) -> str:
    """Return the color of an obstacle: one for all that move, so that the others stay for the laws."""
    return style.PERSON_COLORS[0] if shapes.is_mobile(obstacle) else style.STATIONARY_COLORS[0]


def scene_handles(runs: Runs, *, regions: bool) -> list[Artist]:
    """Return legend entries for start, goal and obstacles."""
    from matplotlib.patches import Patch

    obstacles = longest(runs).scenario.obstacles
    standing = [obstacle for obstacle in obstacles if not shapes.is_mobile(obstacle)]
    kinds = {shapes.kind(obstacle): obstacle_color(obstacle) for obstacle in obstacles}
    handles: list[Artist] = [Patch(facecolor=color, label=kind) for kind, color in kinds.items()]
    if regions:
        handles += shapes.obstacle_handles(standing, regions=True)[-2:]
    return [*shapes.start_and_goal_handles(), *handles]
