"""World files: scenario files in which people react to the robot."""

from __future__ import annotations

import math
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hrsafety import _keys as kind
from hrsafety import navigation as nav
from hrsafety._keys import Keys, checked, located, parsed
from hrsafety.errors import FileError, InvalidParameterError
from hrsafety.io import load_map
from hrsafety.navigation.crowd.pedestrians import Pedestrian
from hrsafety.navigation.obstacles.moving_rectangle import MovingRectangle
from hrsafety.plausibility import ResultWarning
from hrsafety.scenarios.files import TOP, read_scenario

__all__ = ["load_world"]

_STEP = 0.05
_TOLERANCE = 0.3

_MODELS: Mapping[str, type[Pedestrian]] = MappingProxyType(
    {
        model.NAME: model
        for model in (
            *(nav.crowd.CollisionFreeSpeed, nav.crowd.ReciprocalAvoidance, nav.crowd.Moussaid),
            *(nav.crowd.SocialForce1995, nav.crowd.SocialForce2000),
        )
    }
)


def _listed(path: str, value: Any) -> list[Any]:
    """Check an array; who takes its entries checks them."""
    if not isinstance(value, list):
        raise InvalidParameterError(path, "be an array", kind.shown(value))
    return value


_TRAITS: dict[str, kind.Kind] = {
    "route": _listed,
    "model": kind.word,
    "radius": kind.number,
    "desired_speed": kind.number,
    "at_end": kind.word,
    "arrival_radius": kind.number,
    "awareness": kind.number,
    "distracted_share": kind.number,
}
_PERSON: Keys = MappingProxyType(
    _TRAITS | {"start": kind.pair, "velocity": kind.pair, "enters": kind.number, "group": kind.integer}
)
_SOURCE: Keys = MappingProxyType(
    _TRAITS | {"low": kind.pair, "high": kind.pair, "rate": kind.number, "arrivals": kind.word}
)
_OWN: Keys = MappingProxyType(
    {"people": kind.tables, "sources": kind.tables, "walls": kind.lines, "map": kind.word, "step": kind.number}
)


@kind.top_level(dict(TOP) | dict(_OWN))
def load_world(path: str | PathLike[str]) -> nav.World:
    r"""Read a scenario file as a world in which people react to the robot.

    Every file of `load` is one: what stands becomes walls, what moves becomes people who walk as the file says and
    react to no person. Beside its keys a file may have:

    - ``[[people]]``, each with the fields of `Person` but ``recording``; ``model`` is a word such as
      ``"collision_free_speed"``;
    - ``[[sources]]`` with the fields of `Source`;
    - ``walls``, an array of polylines, each an array of points [x, y] in m;
    - ``map``, a file that `hrsafety.io.load_map` reads, such as that of a map server, relative to the world file; the
      law knows it;
    - ``step``, the time step of the world in s.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    World
        With one robot under the law of the file, which has arrived 0.3 m from the goal unless the file says otherwise,
        and decides every ``control_period``, else every ``step`` of 0.05 s. Regions of obstacles and ``rest_time``
        mean nothing in it.

    Raises
    ------
    InvalidParameterError
        As `load`, for a rectangle that moves, and for a map that cannot be read.

    Examples
    --------
    >>> import pathlib, tempfile
    >>> from hrsafety import scenarios
    >>> text = '''
    ... start = [0.0, 0.0]
    ... goal = [6.0, 0.0]
    ... walls = [[[-1.0, 2.0], [7.0, 2.0]]]
    ... [[people]]
    ... start = [5.0, 0.2]
    ... route = [[0.0, 0.2]]
    ... '''
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = pathlib.Path(folder, "hall.toml")
    ...     _ = file.write_text(text)
    ...     scenarios.load_world(file).people[0].route
    ((0.0, 0.2),)
    """
    if not isinstance(path, (str, PathLike)):
        raise InvalidParameterError("path", "be a path", path)
    place = Path(path)
    whole = parsed(place)
    own = checked("", {key: whole.pop(key) for key in _OWN if key in whole}, _OWN)
    timed, tolerance = whole.get("control_period"), whole.get("arrival_tolerance")
    scenario, law = read_scenario(whole, place.parent)
    people = [_agent(f"people[{index}]", table, nav.Person) for index, table in enumerate(own.get("people", []))]
    sources = [_agent(f"sources[{index}]", each, nav.Source) for index, each in enumerate(own.get("sources", []))]
    for index, obstacle in enumerate(scenario.obstacles):
        if isinstance(obstacle, MovingRectangle):
            remedy = 'describe it by a "moving_disc", or run the file with hrsafety simulate'
            rule = "be round if it moves among people"
            raise InvalidParameterError(f"obstacles[{index}].type", rule, "moving_rectangle", remedy)
    walls: Any = own.get("walls", [])
    if "map" in own:
        walls = known = _map(place.parent / own["map"], walls)
        law = law.replaced(map=known) if isinstance(law, nav.SafeNavigation) else nav.SafeNavigation(law, map=known)
    step = own.get("step", _STEP if timed is None else timed / max(1, math.ceil(timed / _STEP - 1e-9)))
    with located(""):
        robot = nav.Robot(
            scenario.robot,
            start=scenario.start,
            goal=scenario.goal,
            law=law,
            heading=scenario.heading,
            control_period=timed,
            arrival_tolerance=_TOLERANCE if tolerance is None else tolerance,
            measurement=scenario.measurement,
        )
        return nav.World(
            people=people,
            robots=[robot],
            sources=sources,
            walls=walls,
            obstacles=scenario.obstacles,
            step=step,
            time_limit=scenario.time_limit,
            seed=scenario.seed,
            doubts=(*scenario.doubts, *_unused(whole)),
        )


def _unused(given: Mapping[str, Any]) -> list[ResultWarning]:
    """Return what a file says that means nothing in a world."""
    if "rest_time" not in given:
        return []
    message = "a robot in a world of people never counts as stopped for good: rest_time is not used"
    return [ResultWarning("not_used", "rest_time", message, safe_side=True)]


def _agent(path: str, table: dict[str, Any], of: type[Any]) -> Any:
    """Return a person or a source from its table."""
    person = of is nav.Person
    given = checked(
        path,
        table,
        _PERSON if person else _SOURCE,
        required=("start",) if person else ("low", "high", "rate", "route"),
    )
    if "model" in given:
        given["model"] = _MODELS[kind.one_of(f"{path}.model", given["model"], _MODELS)]()
    with located(path):
        return of(**given)


def _map(file: Path, walls: list[Any]) -> nav.StaticMap:
    """Return the map that a world file refers to, and its walls beside that."""
    try:
        return load_map(file) + nav.StaticMap.from_polylines(walls)
    except FileError:
        raise
    except InvalidParameterError as error:
        name = "map" if error.argument == "path" else error.argument.replace("polylines", "walls", 1)
        raise error.renamed(name) from None
