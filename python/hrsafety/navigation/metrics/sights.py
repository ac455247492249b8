"""When people are seen, and when they are not and may be there."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array

__all__ = ["LOST", "last_sight", "next_sight", "seen_instants", "track_ends", "unseen_instants"]

Flags = npt.NDArray[np.bool_]

LOST = 2.0
"""Before the first and after the last sight of a person the person may still be there for this long, in s."""


def unseen_instants(people: Array) -> Flags:
    """Return when a person is not seen and is taken to be there: between two sights, and who is never seen.

    Parameters
    ----------
    people : ndarray, shape (T + 1, n, 2)
        Positions in m, NaN where no person was seen.

    Returns
    -------
    ndarray of bool, shape (T + 1, n)
        Whether a person is not seen and is taken to be there.
    """
    seen = seen_instants(people)
    before, after = last_sight(seen) < 0, next_sight(seen) >= len(people)
    found: Flags = ~seen & (before == after)
    return found


def track_ends(people: Array, step: float) -> Flags:
    """Return when a person may be there unseen for 2 s before the first and after the last sight.

    Parameters
    ----------
    people : ndarray, shape (T + 1, n, 2)
        Positions in m, NaN where no person was seen.
    step : float
        Time between two instants in s.

    Returns
    -------
    ndarray of bool, shape (T + 1, n)
        Whether a person is not seen and may be there.
    """
    seen = seen_instants(people)
    instants = np.arange(len(people))[:, None]
    last, following = last_sight(seen), next_sight(seen)
    lost = int(LOST / step + 1e-9)
    before, after = last < 0, following >= len(people)
    found: Flags = ~seen & (
        (before & ~after & (following - instants <= lost)) | (after & ~before & (instants - last <= lost))
    )
    return found


def seen_instants(people: Array) -> Flags:
    """Return when people are seen, (instants, people)."""
    found: Flags = np.isfinite(people[..., 0]) & np.isfinite(people[..., 1])
    return found


def last_sight(seen: Flags) -> npt.NDArray[np.int64]:
    """Return the last instant at or before each at which people were seen, -1 without one."""
    instants = np.arange(len(seen), dtype=np.int64)[:, None]
    return np.maximum.accumulate(np.where(seen, instants, -1), axis=0)


def next_sight(seen: Flags) -> npt.NDArray[np.int64]:
    """Return the first instant at or after each at which people are seen, the number of instants without one."""
    instants = np.arange(len(seen), dtype=np.int64)[:, None]
    return np.minimum.accumulate(np.where(seen, instants, len(seen))[::-1], axis=0)[::-1]
