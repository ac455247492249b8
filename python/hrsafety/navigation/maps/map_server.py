"""Maps of the ROS map server: a YAML file beside an image."""

from __future__ import annotations

from collections.abc import Iterator
from os import PathLike
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import count, meant, readable, word
from hrsafety.errors import FileError, Shown
from hrsafety.navigation.maps.pgm import GrayImage
from hrsafety.navigation.maps.pictures import read_picture
from hrsafety.plausibility import ResultWarning, implausible

if TYPE_CHECKING:
    from pathlib import Path

    from hrsafety._yaml.documents import YamlSection

__all__ = ["BETWEEN", "FREE", "OCCUPIED", "UNKNOWN", "ServedMap", "cell_classes", "doubts_of_place", "read_map_server"]

CELLS_AT_ONCE = 1 << 21
FREE, UNKNOWN, OCCUPIED, BETWEEN = range(4)
"""State of a cell: `BETWEEN` has a value from 1 to 99 of 100."""
LARGEST = 1e300
"""Coordinates of a corner are smaller, so that all that is computed from them is finite."""
SAVED_UNKNOWN = 205
"""Gray value that map savers write for unknown cells."""
SAVED_FREE = 0.196
"""Usual ``free_thresh``: grayer cells are not what savers write for free."""
FEW_CELLS, MANY_CELLS = 1e-3, 0.1
"""Shares of cells that are an accident, and that are none."""
_NEEDED = ("image", "resolution", "origin", "occupied_thresh", "free_thresh")
_KEYS = (*_NEEDED, "negate", "mode")
_MODES = ("trinary", "scale", "raw")

Bits = npt.NDArray[np.bool_]
Classes = npt.NDArray[np.uint8]


class ServedMap(NamedTuple):
    """An occupancy grid with its place.

    Attributes
    ----------
    occupied : ndarray of bool, shape (rows, columns)
        What cells count as; row 0 has the lowest y.
    unseen : ndarray of bool, shape (rows, columns), or None
        Cells that count as free though they were not observed; ``None`` if there are none.
    resolution : float
        Side of a cell in m.
    origin : tuple of float
        Lower left corner in m.
    yaw : float
        Angle by which the grid is turned around it, in rad.
    warnings : tuple of ResultWarning
        Why the cells may not be what they seem to.
    """

    occupied: Bits
    unseen: Bits | None
    resolution: float
    origin: tuple[float, float]
    yaw: float
    warnings: tuple[ResultWarning, ...]


class _Rules(NamedTuple):
    """Rules of a YAML file and the arguments for gray values."""

    mode: str
    negate: bool
    free: float
    occupied: float
    letter: bool
    occupied_from: int | None


def read_map_server(
    path: str | PathLike[str],
    *,
    unknown: str = "occupied",
    rule: str = "saved",
    occupied_from: int | None = None,
    trust_path: bool = False,
) -> ServedMap:
    """Return the grid that a YAML file describes; see `StaticMap.from_map_server`."""
    fills = word("unknown", unknown, ("occupied", "free")) == "occupied"
    letter = word("rule", rule, ("saved", "nav2")) == "nav2"
    least = None if occupied_from is None else count("occupied_from", occupied_from, least=1, most=100)
    entries, assumed = _entries(path)
    rules = _rules(entries, letter=letter, occupied_from=least)
    resolution = _number(entries["resolution"])
    if not resolution > 0.0:
        raise entries["resolution"].error("be finite and positive")
    x, y, yaw = _origin(entries["origin"])
    picture = read_picture(_image(readable("path", path), entries["image"], trust_path=trust_path))
    classes, freed = _classes(picture.most, rules)
    seen = _histogram(picture)
    kept = _kept(classes, rules, picture.most, fills)
    found = (
        *assumed,
        *doubts_of_place(resolution, (x, y), yaw),
        *_doubts_of_cells(picture, rules, classes, freed, kept, seen, fills=fills),
    )
    trusted = ((classes == UNKNOWN) & (kept == FREE)) | (freed & letter)
    some = bool(seen[trusted].any()) or not (fills or picture.hidden is None)
    unseen = _upwards(picture, trusted, hidden=not fills) if some else None
    return ServedMap(_upwards(picture, kept != FREE, hidden=fills), unseen, resolution, (x, y), yaw, found)


def cell_classes(path: str | PathLike[str]) -> Classes:
    """Return what each cell of a map is, whatever it counts as; row 0 has the lowest y."""
    entries, _ = _entries(path)
    picture = read_picture(_image(readable("path", path), entries["image"], trust_path=False))
    classes, _ = _classes(picture.most, _rules(entries))
    found: Classes = classes[picture.values[::-1]]
    if picture.hidden is not None:
        found[picture.hidden[::-1]] = UNKNOWN
    return found


def _entries(path: str | PathLike[str]) -> tuple[YamlSection, tuple[ResultWarning, ...]]:
    from hrsafety._yaml.documents import read_yaml  # for those who have such a file

    document = read_yaml(path)
    root = document.root
    held = root.keys()
    for key in _NEEDED:
        if key not in held or root[key].plain in (None, "", []):
            alike = meant(key, [each for each in held if each not in _KEYS])
            raise FileError(key, f"stand in {readable('path', path).name}", Shown("nothing"), alike, code="missing_key")
    return root, document.warnings


def _rules(entries: YamlSection, *, letter: bool = False, occupied_from: int | None = None) -> _Rules:
    mode = "trinary" if "mode" not in entries else entries["mode"].text()
    if mode not in _MODES:
        raise entries["mode"].error('be "trinary", "scale" or "raw"', meant(mode, _MODES), code="mode")
    free, occupied = _number(entries["free_thresh"]), _number(entries["occupied_thresh"])
    if not 0.0 <= free < occupied <= 1.0:
        shown = Shown(f"free_thresh {free!r} and occupied_thresh {occupied!r}")
        place = entries["free_thresh"].place
        raise FileError(place, "be 0 <= free_thresh < occupied_thresh <= 1", shown, code="thresholds")
    return _Rules(mode, _negate(entries), free, occupied, letter, occupied_from)


# ---- gray values -----------------------------------------------------------------------------------


def _classes(most: int, rules: _Rules) -> tuple[Classes, Bits]:
    """Return what each gray value is, and which of them the letter of the file frees though savers mean unknown."""
    gray = np.arange(most + 1) * (255.0 / most)
    share = _share(most, rules)
    found = np.full(most + 1, UNKNOWN, dtype=np.uint8)
    if rules.mode == "raw":
        percent = np.round(gray)
        found[percent <= 100] = BETWEEN
        found[percent == 0], found[percent == 100] = FREE, OCCUPIED
        return found, np.zeros(most + 1, dtype=np.bool_)
    if rules.mode == "scale":
        found[:] = np.where(_percent(most, rules) >= 100.0, OCCUPIED, BETWEEN)
    found[share >= rules.occupied] = OCCUPIED
    found[share <= rules.free if rules.letter else share < rules.free] = FREE
    freed = _saved_unknown(most, rules) & (found == FREE)
    if not rules.letter:
        found[freed] = UNKNOWN
    return found, freed


def _share(most: int, rules: _Rules) -> npt.NDArray[np.float64]:
    """Return the occupancy from 0 to 1 that each gray value stands for."""
    gray = np.arange(most + 1) * (255.0 / most)
    return np.asarray(gray if rules.negate else 255.0 - gray, dtype=np.float64) / 255.0


def _saved_unknown(most: int, rules: _Rules) -> Bits:
    """Return which gray values are 205 of 255, rounded to a picture of this depth; with ``negate`` it is 50 of 255."""
    gray = np.arange(most + 1)
    own = 255 - SAVED_UNKNOWN if rules.negate else SAVED_UNKNOWN
    found: Bits = np.abs(gray * (255.0 / most) - own) < 0.5
    found |= gray == round(own * most / 255.0)
    found |= (gray == own) & (most <= 255)  # savers write the number itself, whatever white is
    found[0 if rules.negate else most] = False
    return found


def _percent(most: int, rules: _Rules) -> npt.NDArray[np.float64]:
    """Return the occupancy from 0 to 100 of each gray value between free and occupied."""
    gray = np.arange(most + 1) * (255.0 / most)
    if rules.mode == "raw":
        return np.round(gray)
    found: npt.NDArray[np.float64] = np.round(
        100.0 * (_share(most, rules) - rules.free) / (rules.occupied - rules.free)
    )
    return found


def _kept(classes: Classes, rules: _Rules, most: int, fills: bool) -> Classes:
    """Return what each gray value counts as, free or occupied."""
    kept = np.where((classes == OCCUPIED) | (classes == BETWEEN), OCCUPIED, FREE).astype(np.uint8)
    if rules.occupied_from is not None:
        kept[(classes == BETWEEN) & (_percent(most, rules) < rules.occupied_from)] = FREE
    if fills:
        kept[classes == UNKNOWN] = OCCUPIED
    return kept


def _histogram(picture: GrayImage) -> npt.NDArray[np.int64]:
    """Return how many opaque pixels have each gray value."""
    found = np.zeros(picture.most + 1, dtype=np.int64)
    for part in _parts(picture):
        values = picture.values[part]
        some = values.ravel() if picture.hidden is None else values[~picture.hidden[part]]
        found += np.bincount(some, minlength=len(found))
    return found


def _parts(picture: GrayImage) -> Iterator[slice]:
    """Yield some rows at a time, so that Ctrl-C is answered and little memory is taken."""
    rows, columns = picture.values.shape
    step = max(CELLS_AT_ONCE // columns, 1)
    for first in range(0, rows, step):
        yield slice(first, min(first + step, rows))


def _upwards(picture: GrayImage, chosen: Bits, *, hidden: bool) -> Bits:
    """Return which cells have one of the chosen gray values, the lowest row first."""
    rows, columns = picture.values.shape
    found = np.empty((rows, columns), dtype=np.bool_)
    for part in _parts(picture):
        cells = chosen[picture.values[part]]
        if picture.hidden is not None:
            cells[picture.hidden[part]] = hidden
        found[rows - part.stop : rows - part.start] = cells[::-1]
    return found


# ---- doubts ----------------------------------------------------------------------------------------


def doubts_of_place(resolution: float, corner: tuple[float, float], yaw: float) -> tuple[ResultWarning, ...]:
    """Return doubts about the units of a grid."""
    values = {"resolution": resolution, "origin": corner, "yaw of origin": yaw}
    quantities = {"resolution": "map_resolution", "origin": "floor_position", "yaw of origin": "heading"}
    return implausible(values, quantities)


def _doubts_of_cells(
    picture: GrayImage,
    rules: _Rules,
    classes: Classes,
    freed: Bits,
    kept: Classes,
    seen: npt.NDArray[np.int64],
    *,
    fills: bool,
) -> Iterator[ResultWarning]:
    """Yield why cells may not be what they seem to."""
    cells = picture.values.size
    if picture.spare:
        message = f"{picture.spare} bytes stand after the last gray value of the image: it may be another picture"
        yield ResultWarning("trailing_bytes", "image", message)
    gray = int(seen[freed].sum())
    if gray:
        does = "taken as free as the file says" if rules.letter else f"taken as unknown, {_as(fills)}"
        message = (
            f"{gray} of {cells} cells ({100.0 * gray / cells:.3g} %) have the gray {SAVED_UNKNOWN} that map savers "
            f"write for unknown, which free_thresh {rules.free:g} makes free: {does}; write free_thresh: 0.196"
        )
        yield ResultWarning("unknown_gray", "free_thresh", message)
    grayer = (classes == FREE) & ~freed & (_share(picture.most, rules) > SAVED_FREE)
    pale = 0 if rules.mode == "raw" else int(seen[grayer].sum())
    if pale > FEW_CELLS * cells:
        message = (
            f"{pale} of {cells} cells ({100.0 * pale / cells:.3g} %) are grayer than what savers write for free, and "
            f"free_thresh {rules.free:g} makes them free: ground that nobody has seen? Write free_thresh: 0.196"
        )
        yield ResultWarning("unknown_gray", "free_thresh", message)
    yield from _doubts_of_mode(picture.most, rules, seen)
    dark = 0 if picture.hidden is None else int(picture.hidden.sum())
    unknown = int(seen[classes == UNKNOWN].sum()) + dark
    if unknown and not fills:
        message = (
            f"{unknown} of {cells} cells ({100.0 * unknown / cells:.3g} %) are unknown and taken as free: nobody has "
            'seen what stands there; unknown="occupied" keeps robots away'
        )
        yield ResultWarning("unknown_ground", "unknown", message)
    between = int(seen[(classes == BETWEEN) & (kept == OCCUPIED)].sum())
    if between and rules.occupied_from is None:
        message = (
            f"{between} of {cells} cells ({100.0 * between / cells:.3g} %) lie between free and occupied and are taken "
            "as occupied; occupied_from=50 takes those above 50 of 100 only"
        )
        yield ResultWarning("between_counts_as_occupied", "mode", message, safe_side=True)
    if rules.mode == "scale" and rules.free == 0.0 and rules.occupied == 1.0:
        message = (
            "thresholds 0 and 1 with mode scale are those of a mask of speeds or of a filter, not of what stands "
            "there: give the map itself"
        )
        yield ResultWarning("mask_as_map", "mode", message)


def _doubts_of_mode(most: int, rules: _Rules, seen: npt.NDArray[np.int64]) -> Iterator[ResultWarning]:
    """Yield a doubt where gray values are those of another mode: raw ones are 0 to 100, and 255 for unknown."""
    gray = np.round(np.arange(most + 1) * (255.0 / most))
    cells = int(seen.sum())
    others, between = (int(seen[which].sum()) for which in ((gray > 100) & (gray < 255), (gray > 0) & (gray <= 100)))
    if rules.mode == "raw" and others > MANY_CELLS * cells:
        message = (
            f"{others} of {cells} cells ({100.0 * others / cells:.3g} %) have gray values from 101 to 254, which mode "
            "raw takes for unknown, and black for free: leave the mode out if black is occupied"
        )
        yield ResultWarning("other_mode", "mode", message)
    # Few dark cells, of which none is 100, are the edge of a drawing.
    is_raw = between > FEW_CELLS * cells or seen[gray == 100].any()
    if rules.mode != "raw" and not rules.negate and others == 0 and between and is_raw and seen[gray == 255].any():
        message = (
            f"all gray values are 0 to 100 or 255, as those of mode raw, where {between} cells above 0 are occupied "
            "and 255 is unknown: mode: raw reads them so, and negate: 1 if white is occupied"
        )
        yield ResultWarning("other_mode", "mode", message)


def _as(fills: bool) -> str:
    return "which counts as occupied" if fills else "which counts as free"


# ---- keys ------------------------------------------------------------------------------------------


def _number(entry: YamlSection) -> float:
    """Return a number, which may stand in quotes: the map server reads it all the same."""
    return entry.unquoted().number()


def _negate(entries: YamlSection) -> bool:
    """Return a value of 0 or 1, or a word for it; 0 where there is none."""
    if "negate" not in entries:
        return False
    entry = entries["negate"].unquoted()
    value = entry.plain
    if value not in (0, 1):
        raise entry.error("be 0 or 1")
    return bool(value)


def _origin(entry: YamlSection) -> tuple[float, float, float]:
    found = [each.unquoted().plain for each in entry.values()] if isinstance(entry.plain, list) else []
    if len(found) != 3 or not all(type(each) in (int, float) for each in found):
        raise entry.error("be three numbers, x, y and yaw", code="origin")
    if not all(abs(each) < LARGEST for each in found):
        raise entry.error("be finite", code="origin")
    x, y, yaw = map(float, found)
    return x, y, yaw


def _image(file: Path, entry: YamlSection, *, trust_path: bool) -> Path:
    """Return the image of a map, which lies in its folder unless another place is trusted."""
    folder = file.resolve().parent
    name = entry.text()
    try:
        image = (folder / name).resolve()
    except (OSError, ValueError, RuntimeError) as error:
        raise entry.error("name a file", str(error)) from None
    if not trust_path and not image.is_relative_to(folder):
        raise entry.error("lie in the folder of the YAML file", "trust_path=True reads it from there")
    return readable(entry.place, image)
