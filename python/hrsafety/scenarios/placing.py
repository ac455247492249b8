"""Where people of drawn worlds stand, and what their models are when none is given."""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety._arguments import checked_seed, instance
from hrsafety.navigation.crowd import Pedestrian

__all__ = ["MOST_PEOPLE", "RADIUS", "drawn", "lattice", "model_of"]

Array = npt.NDArray[np.float64]

MOST_PEOPLE = 100_000
"""Most people of a world that is drawn here."""
RADIUS = 0.25
"""Radius of a person in m."""


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
    columns = max(1, math.ceil(math.sqrt(people * size[0] / size[1])))
    rows = max(1, math.ceil(people / columns))
    chosen = np.sort(generator.permutation(columns * rows)[:people])
    cell = size / (columns, rows)
    middle = np.column_stack([chosen % columns, chosen // columns]) + 0.5
    slack = np.maximum(0.5 * cell - RADIUS, 0.0)
    places: Array = low + middle * cell + generator.uniform(-1.0, 1.0, (people, 2)) * slack
    return places
