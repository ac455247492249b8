"""Checks of the inputs of pictures: results and labels, instants and view limits."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import word
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.crowd.as_scenario import run_in_scenario, scenario_at_start
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.trajectory import OPTIONAL_COLUMNS, Trajectory
from hrsafety.plotting.style import Limits

VIEWS = ("scene", "paths")
Array = npt.NDArray[np.float64]


def some(name: str, given: object, what: str) -> None:
    """Refuse an argument that holds nothing."""
    if not given:
        raise InvalidParameterError(name, f"hold at least one {what}", Shown("none"))


def checked_trajectory(name: str, value: object, columns: Sequence[str] = ()) -> Trajectory:
    """Return ``value`` if it is a trajectory; of a world as its robot has it, with the columns that are asked for."""
    if not isinstance(value, Trajectory):
        raise InvalidParameterError(name, "be a Trajectory", Shown(type(value).__name__))
    if isinstance(value.scenario, World):
        return _of_world(name, value, columns)
    if value.scenario is None:
        remedy = "`plotting.robots.tracking_paths` and `tracking_errors` draw it"
        raise InvalidParameterError(name, "be the run of a scenario", Shown("a run after a reference"), remedy)
    missing = [column for column in OPTIONAL_COLUMNS if getattr(value, column) is None]
    if missing:
        found = Shown(f"a run without {', '.join(missing)}")
        raise InvalidParameterError(name, "hold all columns of a run", found, "simulate without `record`")
    return value


def _of_world(name: str, run: Trajectory, columns: Sequence[str]) -> Trajectory:
    """Return the run of a world as that of a scenario whose obstacles are people and robots as they went."""
    remedy = "`plotting.crowds` draws worlds"
    if columns:
        found = Shown(f"the run of a world, which has no {', '.join(columns)}")
        raise InvalidParameterError(name, "be the run of a scenario", found, remedy)
    robots = len(run.scenario.robots)
    if run.scenario.period != (0.0, 0.0):
        raise InvalidParameterError(name, "be of a world that does not repeat itself", run.scenario.period, remedy)
    if getattr(run, "position", None) is None:
        advice = "take run.robots[i]" if robots else remedy
        raise InvalidParameterError(name, "be that of one robot", Shown(f"a world with {robots} robots"), advice)
    return run_in_scenario(run)


def checked_runs(trajectories: Trajectory | Sequence[Trajectory], columns: Sequence[str] = ()) -> list[Trajectory]:
    """Return one or several trajectories as a list."""
    if isinstance(trajectories, Trajectory):
        return [checked_trajectory("trajectories", trajectories, columns)]
    if isinstance(trajectories, (str, bytes)) or not isinstance(trajectories, Sequence):
        requirement = "be a Trajectory or a sequence of them"
        raise InvalidParameterError("trajectories", requirement, Shown(type(trajectories).__name__))
    if len(trajectories) == 0:
        raise InvalidParameterError("trajectories", "hold at least one Trajectory", Shown("an empty sequence"))
    return [checked_trajectory(f"trajectories[{i}]", run, columns) for i, run in enumerate(trajectories)]


def checked_scenario(value: object) -> Scenario:
    """Return ``value`` if it is a scenario; a world of one robot as it starts."""
    if isinstance(value, World):
        if len(value.robots) != 1:
            raise InvalidParameterError("scenario.robots", "be one to be drawn", Shown(str(len(value.robots))))
        return scenario_at_start(value)
    if not isinstance(value, Scenario):
        raise InvalidParameterError("scenario", "be a Scenario", Shown(type(value).__name__))
    return value


def checked_labels(labels: Sequence[str] | None, count: int, *, name: str = "labels", stem: str = "run") -> list[str]:
    """Return one label for each of ``count`` things."""
    if labels is None:
        return [stem] if count == 1 else [f"{stem} {i + 1}" for i in range(count)]
    if isinstance(labels, str) or len(labels) != count:
        raise InvalidParameterError(name, f"be {count} strings", labels)
    return [str(label) for label in labels]


def check_same_scene(runs: Sequence[Trajectory]) -> None:
    """Raise unless all runs have the goal and the obstacles of the first, or no obstacles."""
    first = runs[0].scenario
    for index, run in enumerate(runs[1:], start=1):
        same = run.scenario.obstacles in {(), first.obstacles}
        if run.scenario.goal != first.goal or not same:
            requirement = "share goal and obstacles with the first run, because they are drawn in one scene"
            raise InvalidParameterError(f"trajectories[{index}]", requirement, run.scenario)


def contact_times(run: Trajectory) -> Array:
    """Return the instants of first contacts in s, with each obstacle that was touched and with the walls."""
    instants = np.append(run.contact_time, run.map_contact_time)
    found: Array = instants[np.isfinite(instants)]
    return found


def row_at(run: Trajectory, instant: float) -> int:
    """Return the row that is nearest to an instant in s."""
    after = int(np.searchsorted(run.time, instant))
    if after == 0:
        return 0
    if after == len(run.time):
        return after - 1
    return after if run.time[after] - instant <= instant - run.time[after - 1] else after - 1


def closest_row(run: Trajectory, obstacle: int) -> int | None:
    """Return the row of the closest approach to an obstacle, or ``None`` if it never appeared."""
    distance = run.distance[:, obstacle]
    return None if np.all(np.isnan(distance)) else int(np.nanargmin(distance))


def view_limits(points: Sequence[npt.ArrayLike], *, margin: float, least_ratio: float = 0.4) -> Limits:
    """Return limits in m that hold all points and a margin, neither too flat nor too narrow.

    Parameters
    ----------
    points : sequence of array_like, shape (n, 2)
        What must be in view, in m; rows with NaN are left out.
    margin : float
        Free space around the points in m.
    least_ratio : float
        Least height over width; the height is never more than 1.1 times the width.
    """
    stacked = np.concatenate([np.asarray(group, dtype=np.float64).reshape(-1, 2) for group in points])
    stacked = stacked[np.isfinite(stacked).all(axis=1)]
    low, high = stacked.min(axis=0) - margin, stacked.max(axis=0) + margin
    width, height = high - low
    center = (low + high) / 2.0
    width, height = max(width, height / 1.1), max(height, least_ratio * width)
    x = (float(center[0] - width / 2.0), float(center[0] + width / 2.0))
    y = (float(center[1] - height / 2.0), float(center[1] + height / 2.0))
    return x, y


def checked_view(view: str) -> bool:
    """Return whether all that stands is to be in view."""
    return word("view", view, VIEWS) == "scene"


def time_limit(runs: Sequence[Trajectory]) -> float:
    """Return an upper limit of the time axis, in s, that leaves the last instant visible."""
    return 1.01 * max(float(run.time[-1]) for run in runs)
