"""Maps and floor plans of any format, as walls."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterable
from os import PathLike
from typing import Any

from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.io.places.dxf import is_dxf, read_dxf
from hrsafety.io.places.gazebo import is_gazebo, read_gazebo
from hrsafety.io.places.geojson import is_geojson, read_geojson
from hrsafety.io.places.svg import is_svg, read_svg
from hrsafety.io.reader import Document, Reader, reader_of
from hrsafety.navigation.maps.static_map import StaticMap

__all__ = ["READERS", "load_map"]

_IMAGES = (b"P2", b"P5", b"\x89PNG", b"\xff\xd8\xff", b"BM", b"GIF8")
LEAST_KEYS = 2
"""A file with so many keys of a map is one: what it lacks is then named."""
_DEFAULTS: dict[str, Any] = {
    "unit": None,
    "meters_per_unit": None,
    "layers": None,
    "blocks": False,
    "radius": 0.0,
    "unknown": "occupied",
    "outside": "unknown",
    "rule": "saved",
    "occupied_from": None,
    "trust_path": False,
}


def load_map(
    path: str | PathLike[str],
    *,
    format: str | None = None,
    unit: str | None = None,
    meters_per_unit: float | None = None,
    layers: Iterable[str] | None = None,
    blocks: bool = False,
    radius: float = 0.0,
    unknown: str = "occupied",
    outside: str = "unknown",
    rule: str = "saved",
    occupied_from: int | None = None,
    trust_path: bool = False,
) -> StaticMap:
    """Return the map of a file, whose format is told by its contents.

    ======================= ==========================================================================================
    format                  what is read
    ======================= ==========================================================================================
    ``map-server``          YAML of the ROS map server with its image, see `StaticMap.from_map_server`
    ``geojson``             lines and rings as walls, only with ``unit="m"``: the standard means degrees
    ``dxf``                 text DXF; LINE (those that continue where the last one ended are one wall), LWPOLYLINE,
                            POLYLINE with bulges, ARC and CIRCLE as walls, in the unit of $INSUNITS
    ``svg``                 line, polyline, polygon, rect, circle and path as walls, with transforms; the width in mm,
                            cm or m and the viewBox give the scale, else ``meters_per_unit``; the lower left corner of
                            the viewBox is (0, 0)
    ``barn-world``          cylinders of the models of a Gazebo world as filled discs
    ======================= ==========================================================================================

    Curves become chords at most 5 mm away from them, and rings repeat their first point.

    Parameters
    ----------
    path : path
        The file.
    format : str or None
        Its format, if contents are not to decide.
    unit : {"m", "cm", "mm", "inch", "ft"} or None
        Unit of a plan in DXF; ``None``: as it says. GeoJSON needs ``"m"``.
    meters_per_unit : float or None
        Meters of a unit of the viewBox of an SVG.
    layers : sequence of str or None
        Layers of a DXF that hold walls; ``None``: all.
    blocks : bool
        Whether what a DXF places as blocks (INSERT) is read, too, with ezdxf.
    radius : float
        Least half thickness of the walls of a plan in m. The width of a polyline of a DXF is read, strokes of an SVG
        are not.
    unknown, outside, rule, occupied_from, trust_path
        As in `StaticMap.from_map_server`, for its maps only.

    Returns
    -------
    StaticMap
        The map. Its warnings: those of `StaticMap.from_map_server`; ``skipped_entities`` with the counts of what a plan
        holds beside walls; ``implausible`` for the size of a plan; ``unit_contradicts_file`` where ``unit`` is not
        what a DXF says; ``assumed`` for its encoding.

    Raises
    ------
    InvalidParameterError
        If there is no such file, or an argument says nothing about its format.
    FileError
        If the file breaks a rule of its format, or does not say its unit or scale.
    MissingExtraError
        If the image of a map is PNG and Pillow is not installed, or blocks are to be read and ezdxf is not.

    Examples
    --------
    >>> import json, pathlib, tempfile
    >>> from hrsafety import io
    >>> room = {"type": "Polygon", "coordinates": [[[0, 0], [6, 0], [6, 4], [0, 4], [0, 0]]]}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     path = pathlib.Path(folder, "room.geojson")
    ...     _ = path.write_text(json.dumps(room))
    ...     print(io.load_map(path, unit="m"))
    StaticMap(1 wall, x 0 to 6 m, y 0 to 4 m)
    """
    given = {
        "unit": unit,
        "meters_per_unit": meters_per_unit,
        "layers": layers,
        "blocks": blocks,
        "radius": radius,
        "unknown": unknown,
        "outside": outside,
        "rule": rule,
        "occupied_from": occupied_from,
        "trust_path": trust_path,
    }
    document = Document(path)
    if format is None and document.head.startswith(_IMAGES):
        remedy = "give the YAML file beside it, which says its resolution and origin"
        raise document.error("unknown_format", "be a map or a floor plan", Shown("an image"), remedy)
    reader = reader_of("map", document, format)
    known = inspect.signature(reader.read).parameters
    said = {name: value for name, value in given.items() if name in known}
    for name, value in given.items():
        if name not in known and value is not _DEFAULTS[name] and value != _DEFAULTS[name]:
            shown = Shown(f"{value!r} for {document.name}")
            raise InvalidParameterError(name, f"be left out for a map of the format {reader.name}", shown)
    found = reader.read(document, **said)
    assert isinstance(found, StaticMap)
    return found


def _is_map_server(document: Document) -> bool:
    head = document.head if b"\0" not in document.head[:4] else document.head.replace(b"\0", b"")
    keys = (b"image", b"resolution", b"origin", b"occupied_thresh", b"free_thresh")
    found = sum(re.search(rb"(?m)(?:^|[{,\s\"'])%s[\"']?\s*:" % key, head) is not None for key in keys)
    return found >= LEAST_KEYS


def _read_map_server(
    document: Document,
    *,
    unknown: str = "occupied",
    outside: str = "unknown",
    rule: str = "saved",
    occupied_from: int | None = None,
    trust_path: bool = False,
) -> StaticMap:
    return StaticMap.from_map_server(
        document.path,
        unknown=unknown,
        outside=outside,
        rule=rule,
        occupied_from=occupied_from,
        trust_path=trust_path,
    )


READERS = [
    Reader(name="svg", title="floor plan in SVG", recognizes=is_svg, read=read_svg),
    Reader(name="barn-world", title="Gazebo world of BARN", recognizes=is_gazebo, read=read_gazebo),
    Reader(name="dxf", title="floor plan in text DXF", recognizes=is_dxf, read=read_dxf),
    Reader(name="geojson", title="floor plan in GeoJSON", recognizes=is_geojson, read=read_geojson),
    Reader(name="map-server", title="map of the ROS map server", recognizes=_is_map_server, read=_read_map_server),
]
