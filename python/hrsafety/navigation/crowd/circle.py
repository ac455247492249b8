"""Where people start who cross a circle."""

from __future__ import annotations

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, checked_seed, count
from hrsafety.errors import InvalidParameterError

__all__ = ["circle_starts"]

_MOST = 100


def circle_starts(seed: int, people: int = 5) -> Array:
    """Return starts of people on a circle of 4 m whose goals are the opposite points, as CrowdNav draws them.

    Each coordinate is disturbed by up to 0.5 m. A start is drawn again if it, or its goal, is nearer than
    0.8 m to a start or goal before, those of the robot at (0, -4) and (0, 4) included.

    Parameters
    ----------
    seed : int
        Number of the case, 0 <= seed < 2**64.
    people : int
        How many people, at most 100.

    Returns
    -------
    ndarray of shape (people, 2)
        Positions in m. Person k is the same for any number of people above k.

    Raises
    ------
    InvalidParameterError
        If seed or people is out of range, or so many find no room.

    Examples
    --------
    >>> from hrsafety import navigation as nav
    >>> nav.crowd.circle_starts(7).shape
    (5, 2)
    """
    wanted = count("people", people, least=0, most=_MOST)
    found = _hrsafety.crowd_circle(checked_seed("seed", seed), wanted)
    if len(found) < wanted:
        rule = "find room on the circle"
        raise InvalidParameterError("people", rule, people, f"there is room for {len(found)}")
    return np.array(found, dtype=float).reshape(-1, 2)
