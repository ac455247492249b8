"""Ways over ground that was not observed."""

from __future__ import annotations

import numpy as np

from hrsafety._arguments import Array
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plausibility import ResultWarning

__all__ = ["over_unknown"]

PIECE = 0.02
"""A way is examined every so many m."""
MOST_PIECES = 1_000_000


def over_unknown(map: StaticMap, way: Array, what: str) -> tuple[ResultWarning, ...]:
    """Return a warning if a way leads over unknown cells that count as free, or out of the image, and how far.

    Parameters
    ----------
    map : StaticMap
        What is known.
    way : ndarray, shape (n, 2)
        Points of a polyline in m.
    what : str
        What leads there, for the message.

    Returns
    -------
    tuple of ResultWarning
        One, or none.
    """
    if len(way) < 2 or not any(grid.limits or grid.unseen_bits for grid in map.grids):
        return ()
    steps = np.hypot(*np.diff(way, axis=0).T)
    length = np.concatenate([[0.0], np.cumsum(steps)])
    pieces = int(min(max(length[-1] / PIECE, 1.0), MOST_PIECES)) + 1
    middles = (np.arange(pieces) + 0.5) * (length[-1] / pieces)
    places = np.stack([np.interp(middles, length, way[:, axis]) for axis in (0, 1)], axis=1)
    unseen = map.unseen(places)
    if not unseen.any():
        return ()
    far = float(unseen.sum()) * length[-1] / pieces
    first = places[int(np.argmax(unseen))]
    message = (
        f"{what} leads {max(far, PIECE):.3g} m over unknown ground, first at ({first[0]:.2f}, {first[1]:.2f}) m: "
        "nobody has seen what stands there"
    )
    return (ResultWarning("unknown_ground", "map", message),)
