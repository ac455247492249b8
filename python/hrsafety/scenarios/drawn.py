"""Seeds of scenes that are drawn in one call."""

from __future__ import annotations

from hrsafety._bounds import MOST_BODIES
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.run_arguments import Seeds, checked_seeds

__all__ = ["seeds_of"]


def seeds_of(seeds: Seeds, obstacles: int) -> list[int]:
    """Return the seeds if scenes with so many obstacles fit into memory.

    Parameters
    ----------
    seeds : int or iterable of int
        The seeds, or their number.
    obstacles : int
        Obstacles of each scene.

    Returns
    -------
    list of int
        The seeds.

    Raises
    ------
    InvalidParameterError
        If there are too many, or one is no seed.
    """
    drawn = checked_seeds(seeds)
    if len(drawn) * (1 + obstacles) > MOST_BODIES:
        rule = f"make at most {MOST_BODIES} scenarios and obstacles together"
        raise InvalidParameterError("seeds", rule, Shown(f"{len(drawn)} seeds"), "draw them in parts")
    return drawn
