"""Floor plans in SVG."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator

from hrsafety._arguments import Pair, not_negative, positive
from hrsafety.errors import FileError, Shown
from hrsafety.io.places.curves import arc_points
from hrsafety.io.places.drawing import FloorPlan, check_size
from hrsafety.io.places.svg_paths import AffineMap, path_points, transform_of
from hrsafety.io.places.xml_elements import Element, root_element
from hrsafety.io.reader import Document
from hrsafety.navigation.maps.static_map import StaticMap

__all__ = ["is_svg", "read_svg"]

_METERS = {"mm": 1e-3, "cm": 1e-2, "m": 1.0}
_SHAPES = ("line", "polyline", "polygon", "rect", "circle", "path")
_GROUPS = ("g", "a", "switch")
_UNDRAWN = frozenset(
    [
        "title",
        "desc",
        "metadata",
        "defs",
        "style",
        "script",
        "symbol",
        "namedview",
        "clipPath",
        "mask",
        "marker",
        "pattern",
        "linearGradient",
        "radialGradient",
        "filter",
        "view",
    ]
)
LARGEST = 1e14
"""Lengths in units of a drawing are smaller."""
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def is_svg(document: Document) -> bool:
    """Return whether a file is SVG."""
    head = document.head
    return re.search(rb"<(?:\w+:)?svg[\s>]", head) is not None or "<svg".encode("utf-16-le") in head


def read_svg(document: Document, *, meters_per_unit: float | None = None, radius: float = 0.0) -> StaticMap:
    """Return the outlines of an SVG file as walls; see `load_map`."""
    thickness = not_negative("radius", radius)
    check_size(document)
    root = root_element(document)
    if root.tag != "svg":
        raise document.error("unreadable", "be an svg", Shown(root.tag), line=root.line)
    plan = _Plan(FloorPlan(document, thickness), root, meters_per_unit)
    for each in root.children:
        plan.add(each, plan.whole)
    return plan.drawing.map("meters_per_unit")


class _Plan:
    """Walls of the shapes of a drawing."""

    def __init__(self, drawing: FloorPlan, root: Element, told: float | None) -> None:
        self.drawing = drawing
        view = root.attributes.get("viewBox")
        box = [float(each) for each in re.findall(_NUMBER, view)] if view is not None else []
        if view is not None and (len(box) != 4 or not all(map(math.isfinite, box)) or min(box[2:]) <= 0.0):
            raise self.error("have a viewBox of four numbers, width and height above 0", view, root)
        size = [
            re.fullmatch(rf"\s*({_NUMBER})\s*([a-z%]*)\s*", root.attributes.get(name, ""))
            for name in ("width", "height")
        ]
        if not box:
            if not all(each and each[2] in ("", "px") and float(each[1]) > 0.0 for each in size):
                rule = "have a viewBox, or width and height in its units"
                raise drawing.error("scale_needed", rule, Shown("neither"), "save it with a viewBox", line=root.line)
            box = [0.0, 0.0, *(float(each[1]) for each in size if each)]
        scale = self.scale(root, box, size, told)
        # Up is down in SVG; the lower left corner of the view box is the origin.
        self.whole = AffineMap(scale, 0.0, 0.0, -scale, -box[0] * scale, (box[1] + box[3]) * scale)

    def scale(self, root: Element, box: list[float], size: list[re.Match[str] | None], told: float | None) -> float:
        """Return the meters of a unit."""
        if told is not None:
            return positive("meters_per_unit", told)
        found = [
            float(each[1]) * _METERS[each[2]] / length
            for each, length in zip(size, box[2:], strict=True)
            if each and each[2] in _METERS
        ]
        if not found or not (size[0] and size[0][2] in _METERS):
            shown = Shown(f"width {root.attributes.get('width', 'none')}")
            rule = "have a viewBox and a width in mm, cm or m"
            raise self.drawing.error(
                "scale_needed", rule, shown, "meters_per_unit= says it", line=root.line, key="width"
            )
        if (len(found) == 2 and abs(found[1] - found[0]) > 0.01 * abs(found[0])) or not found[0] > 0.0:
            shown = Shown(f"{root.attributes.get('width')} and {root.attributes.get('height')}")
            raise self.drawing.error(
                "scale_needed",
                "have width and height in the proportion of its viewBox",
                shown,
                "meters_per_unit= says the scale",
                line=root.line,
            )
        return found[0]

    def add(self, element: Element, above: AffineMap) -> None:
        """Add the walls of an element and of those in it."""
        tag = element.tag
        if tag in _UNDRAWN:
            return
        style = re.sub(r"\s", "", element.attributes.get("style", "")).lower()
        if "display:none" in style or element.attributes.get("display") == "none":
            self.drawing.skipped[f"{tag} that is hidden"] += 1
            return
        if tag not in (*_SHAPES, *_GROUPS):
            self.drawing.skipped[tag] += 1
            return
        if "transform:" in style:
            raise self.error("have transforms as attributes, not in its style", element.attributes["style"], element)
        here = above
        if "transform" in element.attributes:
            own = transform_of(element.attributes["transform"])
            if own is None:
                raise self.error("have a transform of SVG", element.attributes["transform"], element, "transform")
            here = above.after(own)
        if tag in _GROUPS:
            for each in element.children:
                self.add(each, here)
            return
        try:
            for points in self.outlines(element, here):
                self.drawing.add(tag, points, line=element.line, key=element.attributes.get("id"))
        except OverflowError as error:
            raise self.error("be of a size that walls have", str(error), element, code="too_large") from None

    def outlines(self, element: Element, here: AffineMap) -> Iterator[list[Pair]]:
        """Yield the outlines of a shape in m."""
        tag = element.tag
        if tag == "path":
            data = element.attributes.get("d", "")
            try:
                yield from path_points(data, here)
            except ValueError as error:
                raise self.error("have path data of SVG", str(error), element, "d") from None
        elif tag == "line":
            x, y, u, v = (self.length(element, name) for name in ("x1", "y1", "x2", "y2"))
            yield [here.at((x, y)), here.at((u, v))]
        elif tag in ("polyline", "polygon"):
            yield self.corners(element, here)
        elif tag == "rect":
            yield from self.rectangle(element, here)
        else:
            yield list(self.circle(element, here))

    def corners(self, element: Element, here: AffineMap) -> list[Pair]:
        """Return the corners of a polyline, or those of a polygon with the first one again."""
        words = element.attributes.get("points", "")
        rest = re.sub(_NUMBER, "", words)
        values = [float(each) for each in re.findall(_NUMBER, words)]
        if rest.strip(" \t\r\n,") or len(values) % 2:
            raise self.error("have pairs of numbers", words, element, "points")
        found = [here.at(each) for each in zip(values[::2], values[1::2], strict=True)]
        return [*found, *found[:1]] if element.tag == "polygon" else found

    def rectangle(self, element: Element, here: AffineMap) -> Iterator[list[Pair]]:
        """Yield the outline of a rectangle, which may have round corners."""
        x, y, width, height = (self.length(element, name) for name in ("x", "y", "width", "height"))
        if width < 0.0 or height < 0.0:
            raise self.error("have a width and height that are not negative", f"{width:g} x {height:g}", element)
        if not (width and height):
            self.drawing.skipped["rect without length"] += 1
            return
        across, along = (element.attributes.get(name, "auto").strip() for name in ("rx", "ry"))
        names = ("ry" if across == "auto" else "rx", "rx" if along == "auto" else "ry")
        rx, ry = (
            0.0 if element.attributes.get(name, "auto").strip() == "auto" else self.length(element, name)
            for name in names
        )
        rx, ry = min(rx, 0.5 * width), min(ry, 0.5 * height)
        right, low = x + width, y + height
        if rx <= 0.0 or ry <= 0.0:
            data = f"M{x!r},{y!r}H{right!r}V{low!r}H{x!r}Z"
        else:
            turn = f"A{rx!r},{ry!r},0,0,1,"
            data = (
                f"M{x + rx!r},{y!r}H{right - rx!r}{turn}{right!r},{y + ry!r}V{low - ry!r}{turn}{right - rx!r},{low!r}"
            )
            data += f"H{x + rx!r}{turn}{x!r},{low - ry!r}V{y + ry!r}{turn}{x + rx!r},{y!r}Z"
        yield from path_points(data, here)

    def circle(self, element: Element, here: AffineMap) -> Iterator[Pair]:
        """Yield the outline of a circle, from as many points as the widest axis of its ellipse needs."""
        x, y, radius = (self.length(element, name) for name in ("cx", "cy", "r"))
        if radius < 0.0:
            raise self.error("have a radius that is not negative", f"{radius:g}", element, "r")
        widest = radius * here.stretch
        angles = arc_points((0.0, 0.0), min(widest, 1e12), 0.0, 2.0 * math.pi)
        points = [here.at((x + u / here.stretch, y + v / here.stretch)) for u, v in angles] if radius else []
        yield from [*points[:-1], *points[:1]]

    def length(self, element: Element, name: str) -> float:
        """Return a length in units of the drawing, 0 where there is none."""
        given = element.attributes.get(name, "0")
        match = re.fullmatch(rf"\s*({_NUMBER})(?:px)?\s*", given)
        value = float(match[1]) if match else math.inf
        if not abs(value) < LARGEST:
            raise self.error("be a number in units of the drawing", given, element, name)
        return value

    def error(
        self, rule: str, shown: str, element: Element, name: str | None = None, *, code: str = "unreadable"
    ) -> FileError:
        owner = element.attributes.get("id", element.tag)
        key = f"{owner}.{name}" if name else owner
        return self.drawing.error(code, rule, Shown(repr(shown[:80])), line=element.line, key=key)
