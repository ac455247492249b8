"""Where people of drawn worlds stand, and what their models are when none is given."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety._arguments import checked_seed, instance, positive
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd import Pedestrian

__all__ = ["FAR", "MOST_PEOPLE", "RADIUS", "drawn", "extent", "lattice", "model_of"]

Array = npt.NDArray[np.float64]

MOST_PEOPLE = 100_000
"""Most people of a world that is drawn here."""
RADIUS = 0.25
"""Radius of a person in m."""
FAR = 1e6
"""Distance in m of goals that no person reaches; no world that is drawn is larger."""
MOST_CELLS_EACH = 1000
"""Most cells of a lattice for each person: thinner rectangles have no room for the others."""


def extent(name: str, value: float) -> float:
    """Return a length of a world that is drawn, or say what it should have been."""
    length = positive(name, value)
    if length > FAR:
        raise InvalidParameterError(name, f"be at most {FAR:g} m", value)
    return length


@functools.cache
def _collision_free() -> Pedestrian:
    return nav.crowd.CollisionFreeSpeed()


def model_of(given: Pedestrian | None) -> Pedestrian:
    """Return a model, `CollisionFreeSpeed` where none is given."""
    return _collision_free() if given is None else instance("model", given, Pedestrian)


def drawn(seed: int) -> tuple[int, np.random.Generator]:
    """Return a checked seed and what draws from it."""
    checked = checked_seed("seed", seed)
    return checked, np.random.Generator(np.random.PCG64(checked))


def lattice(generator: np.random.Generator, people: int, low: Sequence[float], high: Sequence[float]) -> Array:
    """Return places in a rectangle, one in each of so many equal cells, at random within the room of the cell."""
    size = np.subtract(high, low)
    columns = max(1, math.ceil(min(math.sqrt(people * size[0] / size[1]), MOST_CELLS_EACH * people)))
    rows = max(1, math.ceil(people / columns))
    chosen = np.sort(generator.permutation(columns * rows)[:people])
    cell = size / (columns, rows)
    middle = np.column_stack([chosen % columns, chosen // columns]) + 0.5
    slack = np.maximum(0.5 * cell - RADIUS, 0.0)
    places: Array = low + middle * cell + generator.uniform(-1.0, 1.0, (people, 2)) * slack
    return places
