"""People in the messages of a bag: which types hold them, and where in a message they stand."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from typing import Any, NamedTuple

from hrsafety._records import dataclass
from hrsafety.errors import FileError, InvalidParameterError, Shown
from hrsafety.io.logs.bags import Bag, Topic

__all__ = ["Layout", "PersonMessage", "layout_of", "sightings"]


class PersonMessage(NamedTuple):
    """A person at an instant.

    Attributes
    ----------
    stamp : int
        Time in ns, 0 if the message has none.
    frame : str
        Of the position, empty if the message has none.
    name : str
        Id.
    position, velocity : tuple of float
        x, y, z in m and m/s; NaN where unknown.
    predicted : bool
        Whether no person was seen and a tracker says where the person may be.
    """

    stamp: int
    frame: str
    name: str
    position: tuple[float, float, float]
    velocity: tuple[float, float, float]
    predicted: bool


_NOWHERE = (math.nan, math.nan, math.nan)


@dataclass(frozen=True, slots=True)
class Layout:
    """Where people stand in messages of a type.

    Attributes
    ----------
    people : str
        Path to their list.
    identity : tuple of str
        Paths to what makes up an id, in an element of the list; the first that exists, or all between ``+``.
    position, velocity : str
        Paths to objects with x and y; no velocity if empty.
    present : callable
        Whether an element is a person that is there.
    predicted : str
        Path to a flag of hidden elements.
    """

    people: str
    identity: tuple[str, ...]
    position: str
    velocity: str = ""
    present: Callable[[Any], bool] = lambda _: True
    predicted: str = ""


_TRACKED = Layout("tracks", ("track_id",), "pose.pose.position", "twist.twist.linear", predicted="is_occluded")
_LAYOUTS = {
    "people_msgs/msg/People": Layout("people", ("name",), "position", "velocity"),
    "hunav_msgs/msg/Agents": Layout(
        "agents", ("id",), "position.position", "velocity.linear", lambda agent: agent.type == 1
    ),
    "spencer_tracking_msgs/msg/TrackedPersons": _TRACKED,
    "vision_msgs/msg/Detection3DArray": Layout("detections", ("id", "tracking_id"), "bbox.center.position"),
    "visualization_msgs/msg/MarkerArray": Layout(
        "markers", ("ns+id",), "pose.position", present=lambda marker: marker.action not in (2, 3)
    ),
}
_ON_DEMAND = "visualization_msgs/msg/MarkerArray"
_NO_IDS = "geometry_msgs/msg/PoseArray"
_DESCRIBED = re.compile(r"(?P<topic>/?[^:\s]+):(?P<people>[\w.]+)\[\]\s+(?P<fields>\S.*)")


def layout_of(bag: Bag, people: str | None, name: str) -> tuple[Topic, Layout] | None:
    """Return the topic of the people of a bag and where they stand in it, ``None`` if there are none.

    Parameters
    ----------
    bag : Bag
        Open.
    people : str or None
        A topic, or ``"/topic:agents[] id=... position=... velocity=..."``; found by the types when ``None``.
    name : str
        Of the file, for errors.
    """
    if people is None:
        found = [each for each in bag.of_type(*_LAYOUTS) if each.type != _ON_DEMAND]
        if len(found) > 1:
            shown = Shown(", ".join(f"{each.name} ({each.type})" for each in found))
            remedy = f'name one of them: people="{found[0].name}"'
            raise FileError(name, "report people on one topic", shown, remedy, code="several_people_topics")
        return (found[0], _LAYOUTS[found[0].type]) if found else None
    described = _DESCRIBED.fullmatch(people.strip())
    wanted = described["topic"] if described else people.strip()
    topic = next((each for each in bag.topics if each.name.lstrip("/") == wanted.lstrip("/")), None)
    if topic is None:
        raise InvalidParameterError("people", "name a topic of the bag, or a file", people, f"topics: {bag.words()}")
    if described:
        return topic, _described(described, people)
    if topic.type == _NO_IDS:
        remedy = "people need ids: name a topic of a tracker"
        raise InvalidParameterError("people", "name a topic with ids", Shown(f"{wanted}, a PoseArray"), remedy)
    if topic.type not in _LAYOUTS:
        remedy = 'say where they stand: people="/topic:agents[] id=id position=pose.position velocity=twist.linear"'
        raise InvalidParameterError("people", "be of a known type", Shown(f"{wanted} ({topic.type})"), remedy)
    return topic, _LAYOUTS[topic.type]


def _described(match: re.Match[str], people: str) -> Layout:
    fields = dict(each.partition("=")[::2] for each in match["fields"].split())
    if not {"id", "position"} <= set(fields) or set(fields) - {"id", "position", "velocity"} or "" in fields.values():
        rule = 'say id=, position= and perhaps velocity= after "/topic:list[]"'
        raise InvalidParameterError("people", rule, people)
    return Layout(match["people"], (fields["id"],), fields["position"], fields.get("velocity", ""))


def sightings(message: Any, layout: Layout, name: str) -> Iterator[PersonMessage]:
    """Yield the people of a message.

    Parameters
    ----------
    message : object
        Decoded.
    layout : Layout
        Where they stand.
    name : str
        File and topic, for errors.

    Raises
    ------
    FileError
        If two people have one id (``two_positions_at_one_instant``), or one has none (``no_ids``).
    """
    common = getattr(message, "header", None)
    places: dict[tuple[str, int], tuple[float, float, float]] = {}
    for person in _at(message, layout.people, name):
        if not layout.present(person):
            continue
        own = getattr(person, "header", None)
        header = own if own is not None and (own.frame_id or common is None) else common
        stamp = 0 if header is None else header.stamp.sec * 10**9 + header.stamp.nanosec
        frame = "" if header is None else header.frame_id.lstrip("/")
        velocity = _three(_at(person, layout.velocity, name)) if layout.velocity else _NOWHERE
        predicted = bool(_at(person, layout.predicted, name)) if layout.predicted else False
        identity = _identity(person, layout.identity, name)
        place = _three(_at(person, layout.position, name))
        before = places.setdefault((identity, stamp), place)
        if before != place and all(map(math.isfinite, (*before, *place))):
            both = " and ".join(f"({x:.6g}, {y:.6g})" for x, y, _ in (before, place))
            found = Shown(f"{identity!r} at {both} in one message")
            remedy = 'people need ids of their own: name another field, people="/topic:list[] id=... position=..."'
            rule = "have one position of a person at one instant"
            raise FileError(name, rule, found, remedy, code="two_positions_at_one_instant")
        yield PersonMessage(stamp, frame, identity, place, velocity, predicted)


def _identity(person: Any, paths: Sequence[str], name: str) -> str:
    for path in paths:
        if hasattr(person, path.partition(".")[0].partition("+")[0]):
            found = "/".join(str(_at(person, part, name)) for part in path.split("+"))
            if found:
                return found
    remedy = "people need ids: name a topic of a tracker with people="
    raise FileError(name, "have an id for each person", Shown("an empty one"), remedy, code="no_ids")


def _at(thing: Any, path: str, name: str) -> Any:
    """Return what stands at a path of fields."""
    for part in path.split("."):
        if not hasattr(thing, part):
            fields = ", ".join(getattr(thing, "__dataclass_fields__", {}))
            rule = f"have a field {part} ({path})"
            raise FileError(name, rule, Shown(f"the fields {fields or 'of ' + type(thing).__name__}"), code="no_field")
        thing = getattr(thing, part)
    return thing


def _three(place: Any) -> tuple[float, float, float]:
    if hasattr(place, "x"):
        return float(place.x), float(place.y), float(getattr(place, "z", 0.0))
    x, y, *rest = place
    return float(x), float(y), float(rest[0]) if rest else 0.0
