"""Worlds of Gazebo as the Benchmark for Autonomous Robot Navigation (BARN) writes them."""

from __future__ import annotations

import math
import re
from collections import Counter

from hrsafety._arguments import Pair
from hrsafety.errors import FileError, Shown
from hrsafety.io.places.drawing import check_size
from hrsafety.io.places.xml_elements import Element, root_element
from hrsafety.io.reader import Document
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plausibility import ResultWarning

__all__ = ["is_gazebo", "read_gazebo"]

Pose = tuple[float, float, float]
"""Position in m and yaw in rad."""
UPRIGHT = 1e-3
_FLAT = ("sun", "ground_plane")


def is_gazebo(document: Document) -> bool:
    """Return whether a file is a world of Gazebo."""
    return re.search(rb"<(?:sdf|gazebo)[\s>]", document.head) is not None and b"<world" in document.head


def read_gazebo(document: Document) -> StaticMap:
    """Return the cylinders of the models of a world as discs; see `load_map`."""
    check_size(document)
    root = root_element(document)
    world = root.first("world")
    if world is None:
        raise document.error("unreadable", "hold a world", Shown(root.tag), line=root.line)
    reader = _World(document)
    for model in world.all("model"):
        reader.model(model, (0.0, 0.0, 0.0))
    for include in world.all("include"):
        uri = include.first("uri")
        name = "" if uri is None else uri.text.strip()
        if name.rpartition("/")[2] not in _FLAT:
            reader.skipped[f"include {name}".strip()] += 1
    for name in ("actor", "population", "road"):
        reader.skipped[name] += sum(1 for _ in world.all(name))
    return StaticMap(discs=reader.discs, warnings=reader.warnings())


class _World:
    """Discs of the cylinders of a world."""

    def __init__(self, document: Document) -> None:
        self.document = document
        self.discs: list[tuple[float, float, float]] = []
        self.skipped: Counter[str] = Counter()

    def warnings(self) -> tuple[ResultWarning, ...]:
        """Return what was left out."""
        kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(self.skipped.items()) if count)
        message = f"{self.document.name} holds what is not read as walls: {kinds}"
        return (ResultWarning("skipped_entities", "path", message),) if kinds else ()

    def model(self, model: Element, above: Pose) -> None:
        """Add the cylinders of a model and of those in it."""
        here = self.pose(model, above)
        for inner in model.all("model"):
            self.model(inner, here)
        for link in model.all("link"):
            place = self.pose(link, here)
            solids = list(link.all("collision"))
            for solid in solids or link.all("visual"):
                self.solid(solid, self.pose(solid, place))

    def solid(self, solid: Element, here: Pose) -> None:
        """Add a body if it is a cylinder; planes are ground."""
        geometry = solid.first("geometry")
        shapes = [] if geometry is None else geometry.children
        for shape in shapes:
            radius = shape.first("radius")
            if shape.tag == "cylinder" and radius is not None:
                value = self.numbers(radius, 1)[0]
                if not value > 0.0:
                    raise self.error("have a radius above 0", radius)
                self.discs.append((here[0], here[1], value))
            elif shape.tag not in ("plane", "empty"):
                self.skipped[shape.tag] += 1

    def pose(self, element: Element, above: Pose) -> Pose:
        """Return where an element stands on the floor."""
        pose = element.first("pose")
        if pose is None:
            return above
        if pose.attributes.get("frame") or pose.attributes.get("relative_to"):
            raise self.error("stand in the frame of what it belongs to", pose)
        x, y, _, roll, pitch, yaw = self.numbers(pose, 6)
        if abs(math.sin(roll)) > UPRIGHT or abs(math.sin(pitch)) > UPRIGHT:
            raise self.error("stand upright, roll and pitch 0", pose)
        turned = _turned((x, y), above[2])
        return above[0] + turned[0], above[1] + turned[1], above[2] + yaw

    def numbers(self, element: Element, count: int) -> list[float]:
        words = element.text.split()
        try:
            found = [float(each) for each in words]
        except ValueError:
            found = []
        if len(found) != count or not all(abs(each) < 1e9 for each in found):
            raise self.error(f"be {count} finite numbers" if count > 1 else "be a finite number", element)
        return found

    def error(self, rule: str, element: Element) -> FileError:
        shown = " ".join(element.text.split())[:80]
        return self.document.error("unreadable", rule, shown, line=element.line, key=element.tag)


def _turned(point: Pair, yaw: float) -> Pair:
    cosine, sine = math.cos(yaw), math.sin(yaw)
    return cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1]
