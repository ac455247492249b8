"""Floor plans in GeoJSON, of which the coordinates are meters only if the caller says so."""

from __future__ import annotations

import json
from typing import Any

from hrsafety._arguments import Pair, not_negative
from hrsafety.errors import Shown
from hrsafety.io.places.drawing import FloorPlan, check_size
from hrsafety.io.reader import Document
from hrsafety.navigation.maps.static_map import StaticMap

__all__ = ["is_geojson", "read_geojson"]

MOST_DEPTH = 20
_LINES = {"LineString": 0, "MultiLineString": 1, "Polygon": 1, "MultiPolygon": 2}


def is_geojson(document: Document) -> bool:
    """Return whether a file is GeoJSON."""
    head = document.head.lstrip(b"\xef\xbb\xbf \t\r\n")
    return (
        head[:1] == b"{"
        and b'"type"' in head
        and any(b'"%s"' % key in head for key in (b"features", b"geometry", b"coordinates", b"geometries"))
    )


def read_geojson(document: Document, *, unit: str | None = None, radius: float = 0.0) -> StaticMap:
    """Return the lines and rings of a GeoJSON file as walls; see `load_map`."""
    thickness = not_negative("radius", radius)
    check_size(document)
    if unit != "m":
        remedy = 'unit="m" says that they are meters on a floor'
        shown = Shown("degrees, which the standard means" if unit is None else f"unit={unit!r}")
        raise document.error("unit_needed", "have coordinates in meters", shown, remedy)
    try:
        found = json.loads(document.text)
    except (ValueError, RecursionError) as error:
        line = getattr(error, "lineno", None)
        raise document.error("unreadable", "be JSON", Shown(str(error) or "nesting"), line=line) from None
    plan = _Plan(FloorPlan(document, thickness))
    plan.add(found, "", 0)
    return plan.drawing.map("unit")


class _Plan:
    """Walls of objects within each other."""

    def __init__(self, drawing: FloorPlan) -> None:
        self.drawing = drawing

    def add(self, given: Any, key: str, depth: int) -> None:
        """Add the walls of an object and of those in it."""
        if depth > MOST_DEPTH:
            raise self.drawing.error("unreadable", f"be nested at most {MOST_DEPTH} deep", Shown("more"), key=key)
        kind = given.get("type") if isinstance(given, dict) else None
        if kind == "FeatureCollection":
            for index, each in enumerate(self.listed(given, "features", key)):
                self.add(each, f"{key}features[{index}].", depth + 1)
        elif kind == "GeometryCollection":
            for index, each in enumerate(self.listed(given, "geometries", key)):
                self.add(each, f"{key}geometries[{index}].", depth + 1)
        elif kind == "Feature":
            if given.get("geometry") is None:
                self.drawing.skipped["Feature without geometry"] += 1
            else:
                self.add(given["geometry"], f"{key}geometry.", depth + 1)
        elif kind in ("Point", "MultiPoint"):
            self.drawing.skipped[kind] += 1
        elif isinstance(kind, str) and kind in _LINES:
            self.lines(kind, given.get("coordinates"), f"{key}coordinates", _LINES[kind])
        else:
            shown = given if kind is None else kind
            raise self.drawing.error("unreadable", "have a type of GeoJSON", shown, key=f"{key}type")

    def listed(self, given: dict[str, Any], name: str, key: str) -> list[Any]:
        found = given.get(name)
        if not isinstance(found, list):
            raise self.drawing.error("unreadable", "be a list", found, key=f"{key}{name}")
        return found

    def lines(self, kind: str, given: Any, key: str, depth: int) -> None:
        """Add lines, or lists of them."""
        if not isinstance(given, list):
            raise self.drawing.error("unreadable", "be a list", given, key=key)
        if depth:
            for index, each in enumerate(given):
                self.lines(kind, each, f"{key}[{index}]", depth - 1)
            return
        points = [self.point(each, f"{key}[{index}]") for index, each in enumerate(given)]
        if "Polygon" in kind and (len(points) < 4 or points[0] != points[-1]):
            rule = "be a ring of four positions or more, the last as the first"
            raise self.drawing.error("unreadable", rule, Shown(f"{len(points)} positions"), key=key)
        self.drawing.add(kind, points, key=key)

    def point(self, given: Any, key: str) -> Pair:
        if not isinstance(given, list) or not 2 <= len(given) <= 4:
            raise self.drawing.error("unreadable", "be a position, x and y", given, key=key)
        for each in given:
            if isinstance(each, bool) or not isinstance(each, (int, float)) or not abs(each) < 1e15:
                raise self.drawing.error("unreadable_number", "be finite numbers", given, key=key)
        return float(given[0]), float(given[1])
