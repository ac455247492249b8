"""Worlds of the Benchmark for Autonomous Robot Navigation (BARN)."""

from __future__ import annotations

from collections.abc import Mapping
from os import PathLike
from typing import Any

from hrsafety._arguments import Array, count, number, points, readable
from hrsafety._arguments import sequence as items
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["barn_discs", "read_worlds"]

MM = 1e-3


def read_worlds(source: str | PathLike[str] | Mapping[str, Any]) -> Mapping[str, Any]:
    """Return what a file of worlds holds, or the mapping that was read from it."""
    rule = "be a file of BARN worlds in JSON, with cylinder_radius_m and worlds"
    if isinstance(source, Mapping):
        loaded: Any = source
    else:
        import json  # by those who have such a file

        path = readable("source", source)
        try:
            loaded = json.loads(path.read_text(encoding="utf-8"))
        except (OSError, ValueError, RecursionError) as error:
            raise InvalidParameterError("source", rule, Shown(f"{path.name} ({error})")) from None
    if not isinstance(loaded, Mapping) or not {"cylinder_radius_m", "worlds"} <= loaded.keys():
        keys = sorted(map(str, loaded)) if isinstance(loaded, Mapping) else type(loaded).__name__
        raise InvalidParameterError("source", rule, Shown(f"{keys}"))
    return loaded


def barn_discs(source: str | PathLike[str] | Mapping[str, Any], world: int) -> list[tuple[float, float, float]]:
    """Return centers and radii of the cylinders of a world, in m."""
    loaded = read_worlds(source)
    wanted = count("world", world, least=0)
    worlds = items("worlds", "be a list of worlds", loaded["worlds"])
    found = [(each.get("id"), each) for each in worlds if isinstance(each, Mapping)]
    known = {name: each for name, each in found if isinstance(name, int)}
    if len(known) < sum(isinstance(name, int) for name, _ in found):
        raise InvalidParameterError("source", "name every world once", Shown(f"{len(found)} worlds with fewer numbers"))
    if wanted not in known:
        numbers = sorted(known)
        shown = f"the file has {len(numbers)} worlds" + (f" from {numbers[0]} to {numbers[-1]}" if numbers else "")
        raise InvalidParameterError("world", "be the number of a world in the file", wanted, shown)
    centers: Array = points(f"cyl_mm of world {wanted}", known[wanted].get("cyl_mm"))
    radius = number("cylinder_radius_m", loaded["cylinder_radius_m"])
    return [(float(x) * MM, float(y) * MM, radius) for x, y in centers]
