"""People of scenes of HuNavSim."""

from __future__ import annotations

import re
from typing import Annotated, Any

from hrsafety._arguments import Pair, instance, meant
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._yaml.documents import YamlDocument, YamlSection
from hrsafety.io.reader import Document, Provenance
from hrsafety.navigation.crowd.agents import Person
from hrsafety.navigation.crowd.pedestrians import Moussaid, Pedestrian
from hrsafety.navigation.crowd.world import World
from hrsafety.plausibility import ResultWarning

__all__ = ["HuNavAgent", "HuNavScene", "is_hunav", "read_hunav"]

MOST_AGENTS = 10_000
BEHAVIORS = ("regular", "impassive", "surprised", "scared", "curious", "threatening")
_RUN = ("regular", "impassive")


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class HuNavAgent:
    """A person of HuNavSim.

    Attributes
    ----------
    name : str
        As in the list of agents.
    start : (float, float)
        Position in m.
    heading : float
        In rad.
    route : tuple of (float, float)
        Goals in m, in their order.
    desired_speed : float
        In m/s.
    radius : float
        In m.
    group : int or None
        Number of the group.
    at_end : {"stop", "repeat"}
        What follows the last goal.
    arrival_radius : float
        Distance at which a goal is reached, in m.
    behavior : str
        What the person does about the robot.
    """

    name: str
    start: Annotated[Pair, "m"]
    heading: Annotated[float, "rad"]
    route: Annotated[tuple[Pair, ...], "m"]
    desired_speed: Annotated[float, "m/s"]
    radius: Annotated[float, "m"]
    group: int | None
    at_end: str
    arrival_radius: Annotated[float, "m"]
    behavior: str


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class HuNavScene:
    """People of a scene of HuNavSim.

    Attributes
    ----------
    people : tuple of HuNavAgent
        In the order of the list of agents.
    map : str or None
        Name of the world that the file means.
    warnings : tuple of ResultWarning
        ``behavior_not_available`` for behaviors towards the robot that are not simulated; ``assumed`` for the encoding.
    source : Provenance
        The file.
    """

    people: tuple[HuNavAgent, ...]
    map: str | None
    warnings: tuple[ResultWarning, ...]
    source: Provenance

    def world(self, *, model: Pedestrian | None = None, **given: Any) -> World:
        """Return the world of the people.

        Parameters
        ----------
        model : Pedestrian or None
            How people decide; ``None``: `Moussaid`, which keeps groups together.
        **given
            What else `World` takes: ``walls``, ``robots``, ``time_limit``, ``seed``.

        Returns
        -------
        World
            Impassive people do not notice robots, all others treat them as people.

        Raises
        ------
        InvalidParameterError
            If a value is out of the range of `Person` or `World`.
        """
        of = Moussaid() if model is None else instance("model", model, Pedestrian)
        people = [
            Person(
                start=each.start,
                route=each.route,
                model=of,
                radius=each.radius,
                desired_speed=each.desired_speed,
                at_end="repeat" if each.at_end == "repeat" and each.route else "stay",
                arrival_radius=each.arrival_radius,
                awareness=0.0 if each.behavior == "impassive" else 1.0,
                group=each.group,
            )
            for each in self.people
        ]
        return World(people=people, doubts=self.warnings, **given)


def is_hunav(document: Document) -> bool:
    """Return whether a file holds agents of HuNavSim."""
    return all(
        re.search(rb"(?m)^[ \t\"'{]*%s[\"']?\s*:" % key, document.head) for key in (b"agents", b"ros__parameters")
    ) and (b"max_vel" in document.head or b"init_pose" in document.head or b"hunav" in document.head)


def read_hunav(document: Document) -> HuNavScene:
    """Return the people of a file of agents; see `load_scene`."""
    root = YamlDocument(document.text, document.name).root
    node = root.get("hunav_loader")
    if node is None:
        nodes = [each for key in root if (each := root[key]).is_map and "ros__parameters" in each]
        node = nodes[0] if len(nodes) == 1 else root["hunav_loader"]
    parameters = node["ros__parameters"]
    names = parameters["agents"].texts()
    if len(names) > MOST_AGENTS:
        raise parameters["agents"].error(f"name at most {MOST_AGENTS} agents")
    for index, name in enumerate(names):
        if name in names[:index]:
            raise parameters["agents"][index].error("name every agent once")
    people = tuple(_agent(parameters, name) for name in names)
    ids: dict[int, str] = {}
    for name in names:
        entry = parameters[name]["id"]
        if entry.whole() in ids:
            raise entry.error(f"be another number than that of {ids[entry.whole()]}")
        ids[entry.whole()] = name
    place = parameters.get("map")
    doubts = list(document.warnings)
    others = [f"{each.name} ({each.behavior})" for each in people if each.behavior not in _RUN]
    if others:
        message = (
            f"of {', '.join(others[:10])}{' and others' if others[10:] else ''} the behavior towards the robot is not "
            "simulated: they walk as regular people, and do not come to the robot, flee from it or stop for it"
        )
        doubts.append(ResultWarning("behavior_not_available", "behavior", message))
    return HuNavScene(
        people=people,
        map=None if place is None else place.text(),
        warnings=tuple(doubts),
        source=Provenance(path=str(document.path), format="hunavsim", sha256=document.sha256),
    )


def _agent(parameters: YamlSection, name: str) -> HuNavAgent:
    agent = parameters[name]
    group = agent.get("group_id")
    number = -1 if group is None else group.whole()
    if group is not None and not -1 <= number < 2**32 - 1:
        raise group.error("be the number of a group, or -1 for none")
    pose, goals = agent["init_pose"], agent["goals"]
    heading, cyclic = pose.get("h"), agent.get("cyclic_goals")
    shared = parameters.get("global_goals")
    return HuNavAgent(
        name=name,
        start=_place(pose),
        heading=0.0 if heading is None else heading.number(),
        route=tuple(_goal(agent, shared, goals[index], each) for index, each in enumerate(goals.texts())),
        desired_speed=_positive(agent["max_vel"]),
        radius=_positive(agent["radius"]),
        group=None if number < 0 else number,
        at_end="repeat" if cyclic is not None and cyclic.flag() else "stop",
        arrival_radius=_positive(agent["goal_radius"]),
        behavior=_behavior(agent["behavior"]),
    )


def _goal(agent: YamlSection, shared: YamlSection | None, entry: YamlSection, name: str) -> Pair:
    """Return the place of a goal that an agent names: one of its own, or of all."""
    found = agent.get(name)
    if found is None and shared is not None:
        found = shared.get(name)
    if found is None:
        raise entry.error(f"name a goal of {agent.path[-1]}", meant(name, [each for each in agent if each != "goals"]))
    return _place(found)


def _behavior(entry: YamlSection) -> str:
    """Return the name of a behavior, which is a number, or stands beside its settings as ``type``."""
    kind = entry["type"] if entry.is_map else entry
    if not 1 <= kind.whole() <= len(BEHAVIORS):
        words = ", ".join(f"{number} {name}" for number, name in enumerate(BEHAVIORS, start=1))
        raise kind.error(f"be a behavior ({words})")
    return BEHAVIORS[kind.whole() - 1]


def _place(entry: YamlSection) -> Pair:
    return entry["x"].number(), entry["y"].number()


def _positive(entry: YamlSection) -> float:
    value = entry.number()
    if not value > 0.0:
        raise entry.error("be finite and positive")
    return value
