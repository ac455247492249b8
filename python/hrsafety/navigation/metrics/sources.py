"""Episodes from runs of the package and from recordings: everybody at the same equal instants."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, count, numbers, whole_steps
from hrsafety._bounds import MOST_PATH_NUMBERS
from hrsafety._tracks import Ways
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.free_space import distance
from hrsafety.navigation.maps.outlines import outlines
from hrsafety.navigation.metrics.sights import LOST
from hrsafety.navigation.obstacles.moving import Human
from hrsafety.navigation.obstacles.standing import Disc, Rectangle
from hrsafety.navigation.robots.footprint import Footprint
from hrsafety.navigation.trajectory import Trajectory
from hrsafety.plausibility import ResultWarning

__all__ = ["at_instants", "doubts_of_run", "fields_in", "steps_of_run", "track_doubts", "without_noise"]

# Instants of a run that differ by less are the same, relative to the step.
_ROUNDING = 1e-9
MOST_STEPS = 3.0
"""Between rows that are more than so many median steps apart a person is not seen."""


def steps_of_run(run: Trajectory) -> dict[str, Any]:
    """Return the fields of an episode that a run in a scenario knows."""
    if run.scenario is None:
        remedy = "take its positions: metrics.Episode(position=..., goal=..., ...)"
        raise InvalidParameterError("trajectory", "be a run in a scenario", Shown("a run after a reference"), remedy)
    if len(run.time) < 2:
        raise InvalidParameterError("trajectory", "have two instants or more", Shown(f"{len(run.time)}"))
    if isinstance(run.scenario, World):
        places = (run.robot_position, run.obstacle_position, run.obstacle_radius)
        return fields_in(run.scenario, run.robot, places, run.robot_heading)
    scene, step = run.scenario, float(run.time[1] - run.time[0])
    obstacles = scene.obstacles
    people = [index for index, each in enumerate(obstacles) if isinstance(each, Human)]
    radii = [each.radius for each in obstacles if isinstance(each, Human)]
    return {
        "position": _whole_last_step(run.time, run.position, step),
        "people": _whole_last_step(run.time, run.obstacle_position[:, people], step),
        "person_radius": np.array(radii),
        "walls": [
            *(each for each in obstacles if isinstance(each, (Disc, Rectangle))),
            *(() if scene.walls is None else outlines(scene.walls)),
        ],
        "step": step,
        "goal": scene.goal,
        "robot_radius": scene.robot.radius,
        "arrival_tolerance": scene.arrival_tolerance,
        "max_speed": scene.robot.max_speed,
        **_outlined(scene.robot.footprint, run.heading),
    }


def _outlined(footprint: Footprint | None, heading: Array | None) -> dict[str, Any]:
    """Return the fields of an episode of a robot with a footprint, none for a disc."""
    return {} if footprint is None else {"footprint": footprint, "heading": heading}


def fields_in(
    world: World, robot: int, places: tuple[Array, Array, Array], heading: Array | None = None
) -> dict[str, Any]:
    """Return the fields of an episode of a robot of a world.

    Parameters
    ----------
    world : World
        The world.
    robot : int
        Which of its robots.
    places : (ndarray of shape (n, k, 2), ndarray of shape (n, m, 2), ndarray of shape (m,))
        Positions of the robots and of the people in m, and radii of the people in m.
    heading : ndarray of shape (n, k) or None
        Headings of the robots in rad, which those with a footprint need.

    Returns
    -------
    dict of str to object
        Fields of `Episode`. Other robots are no people.
    """
    groups = [-1 if person.group is None else person.group for person in world.people]
    groups += [-1] * (len(places[2]) - len(groups))
    own = world.robots[robot]
    return {
        "position": places[0][:, robot],
        "people": places[1],
        "person_radius": places[2],
        "groups": groups if any(group >= 0 for group in groups) else (),
        "walls": world.wall_shapes,
        "step": world.step,
        "goal": own.goal,
        "robot_radius": own.body.radius,
        "arrival_tolerance": own.arrival_tolerance,
        "max_speed": own.body.max_speed,
        "period": world.period,
        **_outlined(own.body.footprint, None if heading is None else heading[:, robot]),
    }


def doubts_of_run(run: Trajectory, *, walls: bool, people: bool) -> Iterator[ResultWarning]:
    """Yield warnings of what an episode from a run leaves out: maps, and what moves and is no person.

    ``walls`` and ``people``: whether those of the episode are those of the scenario.
    """
    if isinstance(run.scenario, World):
        return
    if walls and run.scenario.walls is None and math.isfinite(run.map_clearance):
        touched = "" if math.isnan(run.map_contact_time) else f" and touched it at {run.map_contact_time:.2f} s"
        message = (
            f"the map that the law or a sensor knows is not scored as a wall: the robot came within "
            f"{run.map_clearance:.3g} m of it{touched}; give its outlines as walls"
        )
        yield ResultWarning("not_scored", "walls", message)
    scored = (Human, Disc, Rectangle)
    if walls and people and run.scenario and len(run.time) > 1:
        yield from _between_rows(run)
    for index, each in enumerate(run.scenario.obstacles if people and run.scenario else ()):
        if not isinstance(each, scored) and math.isfinite(run.contact_time[index]):
            message = (
                f"obstacles[{index}] ({type(each).__name__}) is not scored, neither a person nor a wall: the robot "
                f"touched it at {run.contact_time[index]:.2f} s"
            )
            yield ResultWarning("not_scored", f"obstacles[{index}]", message)


def _between_rows(run: Trajectory) -> Iterator[ResultWarning]:
    """Yield a warning of contacts of a run that none of its rows shows, as every few steps are kept only."""
    hidden = []
    for index, each in enumerate(run.scenario.obstacles):
        if not isinstance(each, (Human, Disc, Rectangle)) or not math.isfinite(run.contact_time[index]):
            continue
        if isinstance(each, Human):
            away = np.linalg.norm(run.position - run.obstacle_position[:, index], axis=1) - each.radius
        else:
            away = np.array([distance(each, place) for place in run.position.tolist()])
            away -= each.radius if isinstance(each, Disc) else 0.0
        if not (away < run.scenario.robot.radius).any():
            hidden.append(f"obstacles[{index}] at {run.contact_time[index]:.4g} s")
    if hidden:
        more = f" and {len(hidden) - 3} more" if len(hidden) > 3 else ""
        message = (
            f"the run touched {', '.join(hidden[:3])}{more}, which none of its rows shows: contacts are counted at "
            "rows; keep more of them (every=)"
        )
        yield ResultWarning("contact_between_instants", "every", message)


def _whole_last_step(time: Array, places: Array, step: float) -> Array:
    """Return positions whose last row, an instant inside its step, is moved to the end of the step."""
    last = time[-1] - time[-2]
    if abs(last - step) <= _ROUNDING * step:
        return places
    found = places.copy()
    found[-1] = places[-2] + (places[-1] - places[-2]) * (step / last)
    return found


def without_noise(recording: Any) -> tuple[Any, tuple[ResultWarning, ...]]:
    """Return a recording whose positions are smooth if they were too noisy, and its doubts, of which one says so."""
    told = tuple(getattr(recording, "warnings", ()))
    noisy = [each for each in told if each.code == "noisy_positions"]
    if not noisy or not hasattr(recording, "smoothed"):
        return recording, told
    smooth = recording.smoothed()
    message = f"scores are those of smoothed positions: {noisy[0].message}"
    others = [each for each in smooth.warnings if each.code != "noisy_positions"]
    return smooth, (*others, ResultWarning("smoothed_positions", noisy[0].subject, message))


def at_instants(recording: Any, robot: int | str | npt.ArrayLike, step: float) -> dict[str, Any]:
    """Return positions of a robot and of all others while it is there, and when they are not seen.

    Its last position is the goal; a path of the robot that is none of the recording has doubts of its own.
    """
    ids = np.unique(recording.person)
    doubts: tuple[ResultWarning, ...] = ()
    if isinstance(robot, (int, str, np.integer)):
        who = robot if isinstance(robot, str) else count("robot", robot, least=-(2**63))
        if who not in ids.tolist():
            raise InvalidParameterError("robot", "be the id of a recorded person", robot)
        time, path = _track(recording, who)
        ids = ids[ids != who]
    else:
        time, path = _given_path(robot)
        doubts = track_doubts(Ways(time, np.zeros(len(time), dtype=np.int64), path), "the robot", _PATH_SMOOTHING)
    most = MOST_PATH_NUMBERS // (2 * len(ids) + 2)
    steps = int(whole_steps("step", float(time[-1] - time[0]), step, most) + _ROUNDING)
    instants = time[0] + step * np.arange(steps + 1)
    people = np.empty((len(instants), len(ids), 2))
    unseen = np.zeros((len(instants), len(ids)), dtype=np.bool_)
    for index, person in enumerate(ids.tolist()):
        rows, places = _track(recording, person)
        people[:, index] = _between(rows, places, instants)
        gap = _within_gaps(rows, instants)
        people[gap, index] = np.nan
        around = (instants > rows[0] - LOST) & (instants < rows[-1] + LOST)
        # Who is seen at no instant was there before or after.
        here = not np.isnan(people[:, index]).all()
        unseen[:, index] = gap | (around & np.isnan(people[:, index, 0]) & here)
    own = _between(time, path, np.minimum(instants, time[-1]))
    others = {"people": people, "unseen": unseen} if len(ids) else {}
    return {"position": own, "goal": tuple(path[-1].tolist()), "warnings": doubts, **others}


_PATH_SMOOTHING = "Episode.smoothed(0.6) takes the noise out"


def track_doubts(ways: Ways, name: str, smoothing: str) -> tuple[ResultWarning, ...]:
    """Return doubts about jumps, exchanged ids and noise of ways; several are told apart by their number."""
    named = (lambda index: f"{name}[{index}]") if name == "people" else (lambda _: name)
    found = ways.doubts(named, moving=name, of_frames="", smoothing=smoothing, units=False)
    return tuple(each for each in found if each.code != "gap_in_track")


def _within_gaps(time: Array, instants: Array) -> npt.NDArray[np.bool_]:
    """Return which instants lie between rows that are more than three median steps apart."""
    steps = np.diff(time)
    if len(steps) == 0:
        return np.zeros(len(instants), dtype=np.bool_)
    after = np.clip(np.searchsorted(time, instants, "left"), 1, len(time) - 1)
    inside = (instants > time[after - 1] + _ROUNDING) & (instants < time[after] - _ROUNDING)
    found: npt.NDArray[np.bool_] = inside & (
        steps[after - 1] > MOST_STEPS * float(np.median(steps)) * (1.0 + _ROUNDING)
    )
    return found


def _given_path(robot: npt.ArrayLike) -> tuple[Array, Array]:
    rows = numbers("robot", robot)
    if rows.ndim != 2 or rows.shape[1] != 3 or len(rows) == 0:
        raise ShapeError("robot", "(k, 3): instants and positions", rows.shape)
    if not np.isfinite(rows).all() or not (np.diff(rows[:, 0]) > 0.0).all():
        raise InvalidParameterError("robot", "hold finite rows of growing instants", Shown("others"))
    return rows[:, 0], rows[:, 1:]


def _track(recording: Any, person: int | str) -> tuple[Array, Array]:
    rows = recording.person == person
    return recording.time_s[rows], recording.position[rows]


def _between(time: Array, places: Array, instants: Array) -> Array:
    """Return positions linear between rows, NaN before the first and after the last one."""
    edges = {"left": np.nan, "right": np.nan}
    # An instant that rounding moves beyond the last row is still there.
    near = np.where(np.abs(instants - time[-1]) < _ROUNDING, time[-1], instants)
    return np.stack([np.interp(near, time, places[:, axis], **edges) for axis in (0, 1)], axis=1)
