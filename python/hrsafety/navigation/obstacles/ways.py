"""Where bodies that move go, and whether walls stand there."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from hrsafety._arguments import Array, Pair
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.obstacles.moving import Human
from hrsafety.navigation.obstacles.moving_rectangle import Mobile
from hrsafety.plausibility import ResultWarning

__all__ = ["through", "way"]

CURVED = 33
"""Places of a piece of a motion that is accelerated."""

HALVINGS = 40
"""Of a leg, to find where it meets a wall."""

Way = tuple[Array, Array]
"""Instants in s and places in m, shape (n, 2), joined by straight or nearly straight legs."""


def _center(body: Mobile) -> Pair:
    """Return where the center of a body is when it sets out, in m."""
    return body.start if isinstance(body, Human) else body.center


def way(body: Mobile, until: float) -> Way:
    """Return where a body goes up to an instant in s."""
    if body.path is not None:
        instants = np.array(body.path[0], dtype=np.float64)
        known = int(np.searchsorted(instants, until)) + 1
        return instants[:known], np.array(body.path[1], dtype=np.float64)[:known]
    acceleration = getattr(body, "acceleration", (0.0, 0.0))
    pieces = list(body.segments or [(math.inf, body.velocity, acceleration)])
    if body.stop is not None and (speed := math.hypot(*body.velocity)):
        pieces = [(math.dist(_center(body), body.stop) / speed, body.velocity, acceleration)]
    elif body.segments:
        duration, velocity, acceleration = pieces[-1]
        reached = [each + duration * more for each, more in zip(velocity, acceleration, strict=True)]
        pieces.append((math.inf, (reached[0], reached[1]), (0.0, 0.0)))
    times, places = [0.0], [np.array(_center(body), dtype=np.float64)]
    for duration, velocity, acceleration in pieces:
        instant, place = times[-1], places[-1]
        length = min(duration, until - instant)
        for share in np.linspace(0.0, 1.0, CURVED if any(acceleration) else 2)[1:] if length > 0.0 else ():
            gone = share * length
            times.append(instant + gone)
            places.append(place + gone * np.array(velocity) + 0.5 * gone**2 * np.array(acceleration))
    return np.array(times), np.array(places)


def through(gone: Way, walls: StaticMap, what: str, *, recorded: bool) -> Iterator[ResultWarning]:
    """Yield a doubt about somebody whose center goes through walls.

    Parameters
    ----------
    gone : tuple of ndarray
        Instants in s and places in m.
    walls : StaticMap
        What stands.
    what : str
        What it is called.
    recorded : bool
        Whether the way is a recording.

    Yields
    ------
    ResultWarning
        With the code ``"recording_in_wall"`` of a recorded way, else ``"way_through_wall"``.
    """
    met = _met(gone, walls)
    if met is None:
        return
    kind = "recording" if recorded else "way"
    message = (
        f"{kind} leads through {what} at ({met[1]:.4g}, {met[2]:.4g}) m at {met[0]:.4g} s: nobody walks there; {what} "
        f"and {kind} do not fit together, or are in different units or frames"
    )
    if recorded:
        yield ResultWarning("recording_in_wall", "recording", message)
    else:
        yield ResultWarning("way_through_wall", "velocity", f"{message}; give stop= before it, or segments around it")


def _met(gone: Way, walls: StaticMap) -> tuple[float, float, float] | None:
    """Return when and where a way first meets walls, in s and m; ``None`` where it does not."""
    time, places = gone
    length = np.append(np.hypot(*np.diff(places, axis=0).T), 0.0)
    for row in np.flatnonzero(np.asarray(walls.clearance(places)) <= length).tolist():
        leg = places[row : row + 2]
        if walls.segment_clearance(leg[0], leg[-1]) > 0.0:
            continue
        low, high = 0.0, 1.0
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            free = walls.segment_clearance(leg[0], leg[0] + middle * (leg[-1] - leg[0])) > 0.0
            low, high = (middle, high) if free else (low, middle)
        x, y = leg[0] + high * (leg[-1] - leg[0])
        return float(time[row] + high * (time[row : row + 2][-1] - time[row])), float(x), float(y)
    return None
