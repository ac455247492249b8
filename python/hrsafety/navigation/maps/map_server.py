"""Maps of the ROS map server: a YAML file beside a PGM image."""

from __future__ import annotations

import math
import re
from os import PathLike
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import positive, readable, word
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.maps.pgm import read_pgm

if TYPE_CHECKING:
    from pathlib import Path

__all__ = ["ServedMap", "read_map_server"]

MOST_BYTES = 1 << 20  # of a YAML file
CELLS_AT_ONCE = 1 << 23
_ENTRY = r"(\w+)\s*:\s*(.*)"
_NEEDED = ("image", "resolution", "origin", "occupied_thresh", "free_thresh")


class ServedMap(NamedTuple):
    """An occupancy grid with its place."""

    occupied: npt.NDArray[np.bool_]
    resolution: float
    origin: tuple[float, float]
    yaw: float


def read_map_server(path: str | PathLike[str], *, unknown: str = "occupied") -> ServedMap:
    """Return the grid that a YAML file describes; row 0 has the lowest y."""
    fills = word("unknown", unknown, ("occupied", "free")) == "occupied"
    file = readable("path", path)
    entries = _entries(file)
    for key in _NEEDED:
        if key not in entries:
            raise InvalidParameterError(key, f"stand in {file.name}", Shown("nothing"))
    if entries.get("mode", "trinary") not in ("trinary", "scale"):
        raise InvalidParameterError("mode", 'be "trinary" or "scale"', entries["mode"])
    resolution = positive("resolution", _number(entries, "resolution"))
    free, occupied = _number(entries, "free_thresh"), _number(entries, "occupied_thresh")
    if not 0.0 <= free <= occupied <= 1.0:
        shown = Shown(f"free_thresh {free!r} and occupied_thresh {occupied!r}")
        raise InvalidParameterError("thresholds", "be 0 <= free_thresh <= occupied_thresh <= 1", shown)
    x, y, yaw = _origin(entries["origin"])
    negate = _number(entries, "negate") if "negate" in entries else 0.0
    if negate not in (0.0, 1.0):
        raise InvalidParameterError("negate", "be 0 or 1", negate)
    picture = read_pgm(_image(file, str(entries["image"])))
    share = picture.gray / 255.0 if negate else (255.0 - picture.gray) / 255.0
    cells = share >= free if fills else share > occupied
    if fills:
        # Between the thresholds and on them nothing is known; above them it is occupied.
        cells |= share > occupied
    return ServedMap(_upwards(cells, picture.values), resolution, (x, y), yaw)


def _upwards(cells: npt.NDArray[np.bool_], values: npt.NDArray[np.uint8]) -> npt.NDArray[np.bool_]:
    """Return the cell of each value, the lowest row first; some rows at a time, so that Ctrl-C is answered."""
    rows, columns = values.shape
    found = np.empty((rows, columns), dtype=np.bool_)
    step = max(CELLS_AT_ONCE // columns, 1)
    for first in range(0, rows, step):
        last = min(first + step, rows)
        found[rows - last : rows - first] = cells[values[first:last]][::-1]
    return found


def _entries(file: Path) -> dict[str, Any]:
    """Return keys and values of a flat YAML file; a value is a word or a list of words."""
    try:
        if file.stat().st_size > MOST_BYTES:
            raise InvalidParameterError("path", f"be a YAML file of at most {MOST_BYTES} bytes", file.name)
        text = file.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidParameterError("path", "be a YAML file", Shown(f"{file.name} ({error})")) from None
    found: dict[str, Any] = {}
    listed = pending = ""
    for index, line in enumerate(text.splitlines(), start=1):
        bare = _without_comment(line).strip()
        if not bare or bare in ("---", "..."):
            continue
        if pending:  # a list in brackets over several lines
            bare = f"{pending}: {' '.join(found.pop(pending))} {bare}"
            pending = ""
        match = re.fullmatch(_ENTRY, bare)
        if match:
            key, value = match.groups()
            listed = "" if value else key
            if value.startswith("[") and not value.endswith("]"):
                found[key], pending = [value], key
            elif value.startswith("["):
                found[key] = [_unquoted(each) for each in value[1:-1].split(",")]
            else:
                found[key] = _unquoted(value) if value else []
        elif bare.startswith("-") and listed:
            found[listed].append(_unquoted(bare[1:]))
        else:
            shown = Shown(f"{line.strip()[:80]!r} in line {index}")
            raise InvalidParameterError(f"{file.name}", "be lines 'key: value' of a map", shown)
    return found


def _without_comment(line: str) -> str:
    return re.sub(r"(^|\s)#.*", "", line)


def _unquoted(value: str) -> str:
    value = value.strip()
    return value[1:-1] if len(value) > 1 and value[0] == value[-1] and value[0] in "'\"" else value


def _number(entries: dict[str, Any], key: str) -> float:
    given = entries[key]
    try:
        value = float(given)
    except (TypeError, ValueError):
        raise InvalidParameterError(key, "be a number", given) from None
    if not math.isfinite(value):
        raise InvalidParameterError(key, "be finite", value)
    return value


def _origin(given: Any) -> tuple[float, float, float]:
    rule = "be three numbers, x, y and yaw"
    try:
        x, y, yaw = (float(each) for each in given)
    except (TypeError, ValueError):
        raise InvalidParameterError("origin", rule, given) from None
    if not all(map(math.isfinite, (x, y, yaw))):
        raise InvalidParameterError("origin", "be finite", (x, y, yaw))
    return x, y, yaw


def _image(file: Path, name: str) -> Path:
    """Return the image of a map, which lies in its folder."""
    folder = file.resolve().parent
    try:
        image = (folder / name).resolve()
    except (OSError, ValueError) as error:
        raise InvalidParameterError("image", "name a file", Shown(f"{name[:80]!r} ({error})")) from None
    if not image.is_relative_to(folder):
        raise InvalidParameterError("image", "lie in the folder of the YAML file", name)
    return readable("image", image)
