"""Walls that are gathered from the drawing of a floor plan."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Iterator

from hrsafety._arguments import Pair
from hrsafety._bounds import MOST_WALL_POINTS
from hrsafety.errors import Shown
from hrsafety.io.reader import Document
from hrsafety.navigation.maps.parts import PolylineWall
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plausibility import ResultWarning, implausible

__all__ = ["UNITS", "FloorPlan", "check_size"]

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254, "ft": 0.3048}
"""Meters of each unit of a plan."""
MOST_BYTES = 1 << 25
"""Of files that are held as objects: half a gigabyte while they are read."""
LARGEST = 1e9
"""Coordinates in m are smaller: beyond, the rounding of numbers moves walls."""
_NOTES = {"TEXT", "MTEXT", "DIMENSION", "LEADER", "MULTILEADER", "ATTDEF", "ATTRIB", "VIEWPORT", "POINT", "TOLERANCE"}
_NOTES |= {"text", "Point", "MultiPoint"}


def check_size(document: Document, most: int = MOST_BYTES) -> None:
    """Refuse plans that would take more memory than a plan should."""
    if len(document.data) > most:
        found = Shown(f"{len(document.data)} bytes")
        raise document.error("too_large", f"be a plan of at most {most} bytes", found)


class FloorPlan:
    """Walls of a floor plan as they are read, and what was left out.

    Parameters
    ----------
    document : Document
        The file.
    radius : float
        Half the thickness of the walls in m.
    """

    def __init__(self, document: Document, radius: float) -> None:
        self.document = document
        self.error = document.error
        self.radius = radius
        self.walls: list[PolylineWall] = []
        self.skipped: Counter[str] = Counter()
        self.doubts: list[ResultWarning] = []
        self._points = 0

    def add(
        self,
        kind: str,
        points: Iterable[Pair],
        *,
        ring: bool = False,
        width: float = 0.0,
        line: int | None = None,
        key: str | None = None,
    ) -> None:
        """Add a wall along points in m; the last one of a ring is the first. One without length is left out.

        Its radius is half of what is drawn as its width, and at least that of all walls.
        """
        kept: list[Pair] = []
        for x, y in self._within_bounds(points, line, key):
            if not (abs(x) < LARGEST and abs(y) < LARGEST):
                shown = Shown(f"({x:g}, {y:g}) m")
                rule = f"have coordinates below {LARGEST:.0e} m"
                raise self.error("coordinates", rule, shown, "look at its unit", line=line, key=key)
            if not kept or (x, y) != kept[-1]:
                kept.append((x + 0.0, y + 0.0))
                self._points += 1
            if self._points > MOST_WALL_POINTS:
                rule = f"have at most {MOST_WALL_POINTS} points"
                raise self.error("too_large", rule, Shown("more"), "look at its unit", line=line, key=key)
        if ring and len(kept) > 2:
            kept[-1] = kept[0]
        if len(kept) < 2:
            self.skipped[f"{kind} without length"] += 1
            return
        self.walls.append(PolylineWall(tuple(kept), max(self.radius, 0.5 * width)))

    def _within_bounds(self, points: Iterable[Pair], line: int | None, key: str | None) -> Iterator[Pair]:
        """Yield points, and turn curves of too many chords into an error about their place."""
        try:
            yield from points
        except OverflowError as error:
            rule = "be of a size that walls have"
            raise self.error("too_large", rule, Shown(str(error)), "look at its unit", line=line, key=key) from None

    def map(self, unit: str, hint: str = "") -> StaticMap:
        """Return the map of the walls.

        Parameters
        ----------
        unit : str
            Argument that mends an implausible size, for messages.
        hint : str
            What reads more of the file.
        """
        doubts = [*self.document.warnings, *self.doubts]
        if self.skipped:
            kinds = ", ".join(f"{count} {kind}" for kind, count in sorted(self.skipped.items()))
            notes = all(kind in _NOTES or " without length" in kind for kind in self.skipped)
            message = f"{self.document.name} holds what is not read as walls: {kinds}{'; ' if hint else ''}{hint}"
            doubts.append(ResultWarning("skipped_entities", "path", message, safe_side=notes))
        if not self.walls:
            found = Shown(", ".join(f"{count} {kind}" for kind, count in self.skipped.items()) or "nothing")
            raise self.error("no_walls", "hold walls that are read", found)
        places = [point for wall in self.walls for point in wall.points]
        width, height = (max(each) - min(each) for each in zip(*places, strict=True))
        name = f"extent of {self.document.name}"
        found_doubts = implausible({name: math.hypot(width, height)}, {name: "plan_extent"})
        doubts += [
            ResultWarning(each.code, each.subject, f"{each.message}; {unit} says another") for each in found_doubts
        ]
        return StaticMap(walls=self.walls, warnings=doubts)
