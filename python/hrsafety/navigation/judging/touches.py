"""Contacts of a recorded robot with people and walls, on straight lines from instant to instant."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._display import displayed
from hrsafety.navigation.crowd.contacts import appears_until, touch_of, touch_of_outline, touching_share
from hrsafety.navigation.judging.synchronized import Flags, Synchronized
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.navigation.metrics.between import PASSED, Outlined, distances_of, least_of_outline
from hrsafety.navigation.trajectory import CONTACT_SPEED

__all__ = ["BETWEEN", "Touch", "clearances", "people_touched", "walls_touched"]

BETWEEN = 1e-3
"""Distance of a footprint from walls in m that may be overlooked between two places at which it is computed."""
MOST_PLACES = 2000


@displayed
class Touch(NamedTuple):
    """A contact, or one that may have been.

    Attributes
    ----------
    begin, end : float
        Of the contact, or of the time in which the error allows a possible one, in s.
    person : int, str or None
        Who; ``None``: a wall.
    kind : str
        ``"toward"``, ``"away"``, ``"standing"``, ``"apart"`` (a person appeared where the robot was), ``"wall"``, or
        ``"possible_contact"``.
    at_fault : bool
        Whether the robot moved toward the person during the contact.
    speed : float
        Of the robot at the start in m/s.
    clearance : float
        Least distance of the surfaces in m, negative where they overlap.
    error : float
        Of that distance in m: with it the contact may not have been, or may have been.
    earliest, latest : float
        Between these times the surfaces are nearer than the error, in s.
    """

    begin: Annotated[float, "s"]
    end: Annotated[float, "s"]
    person: int | str | None
    kind: str
    at_fault: bool
    speed: Annotated[float, "m/s"]
    clearance: Annotated[float, "m"]
    error: Annotated[float, "m"]
    earliest: Annotated[float, "s"]
    latest: Annotated[float, "s"]

    @property
    def certain(self) -> bool:
        """Whether the touch is a contact whatever the error."""
        return self.clearance + self.error < 0.0


def clearances(both: Synchronized, reach: float, outline: Outlined | None = None) -> tuple[Array, Array]:
    """Return distances of the surfaces at instants (T, n) and the least ones in steps (T - 1, n), NaN where unknown.

    ``reach`` is the sum of the radii; of a robot with an outline that of the circle around it counts.
    """
    away = both.people - both.position[:, None]
    ways = np.diff(away, axis=0)
    square = np.einsum("kij,kij->ki", ways, ways)
    along = np.einsum("kij,kij->ki", away[:-1], ways)
    share = np.clip(np.divide(-along, square, out=np.zeros_like(square), where=square > 0.0), 0.0, 1.0)
    nearest = away[:-1] + share[..., None] * ways
    joined = both.linked[:, None] & both.person_linked
    between = np.where(joined, np.hypot(nearest[..., 0], nearest[..., 1]), np.nan)
    if outline is None:
        return np.hypot(away[..., 0], away[..., 1]) - reach, between - reach
    between = np.where(joined, least_of_outline(outline, away, ways, between), np.nan)
    return distances_of(outline, away) - reach, between - reach


def people_touched(
    both: Synchronized, gaps: tuple[Array, Array], reach: float, error: float, outline: Outlined | None = None
) -> tuple[list[Touch], list[Touch]]:
    """Return contacts, and possible ones: those which the error decides.

    Parameters
    ----------
    both : Synchronized
        Robot and people.
    gaps : tuple of ndarray
        Of `clearances`.
    reach : float
        Sum of the radii in m.
    error : float
        Of the distance between both in m.
    outline : Outlined or None
        The robot, if it is no disc.
    """
    sure: list[Touch] = []
    possible: list[Touch] = []
    shown, between = gaps
    with np.errstate(invalid="ignore"):
        near = (shown < error).any(axis=0) | (between < error).any(axis=0)
    for column in np.flatnonzero(near).tolist():
        for touch in _of_person(both, column, (shown[:, column], between[:, column]), reach, error, outline):
            (possible if touch.kind == "possible_contact" else sure).append(touch)
    return sure, possible


def _of_person(
    both: Synchronized,
    column: int,
    gaps: tuple[Array, Array],
    reach: float,
    error: float,
    outline: Outlined | None,
) -> Iterator[Touch]:
    shown, between = gaps
    with np.errstate(invalid="ignore"):
        near = (between < error) | ((shown[:-1] < error) | (shown[1:] < error)) & np.isfinite(between)
    away = both.people[:, column] - both.position
    ways = np.diff(away, axis=0)
    velocity = np.diff(both.position, axis=0) / both.step
    appears = appears_until(both.people[:, column], both.step)
    person = both.ids[column].item()
    for begin, end in runs_of(near):
        steps = np.arange(begin, end)
        least = float(np.nanmin([np.nanmin(between[begin:end]), np.nanmin(shown[begin : end + 1])]))
        earliest, latest = _span(both, away, ways, steps, reach + error)
        inside = steps[between[begin:end] < 0.0]
        speed = float(np.hypot(*velocity[begin]))
        if len(inside) == 0:
            yield Touch(earliest, latest, person, "possible_contact", False, speed, least, error, earliest, latest)
            continue
        # Of a footprint the circle around it tells when, a step too early or late at most.
        begun, ended = _span(both, away, ways, inside, reach)
        paths = (away[:-1], ways)
        if outline is None:
            found = touch_of(inside, paths, velocity, reach, appears, both.step)
        else:
            found = touch_of_outline(outline, (inside, column), paths, velocity, appears)
        kind = "apart" if math.isnan(found.time) else "standing"
        if found.speed > CONTACT_SPEED:
            kind = "toward" if found.toward else "away"
        speed = float(np.hypot(*velocity[inside[0]]))
        yield Touch(begun, ended, person, kind, found.at_fault, speed, least, error, earliest, latest)
    alone = (shown < error) & ~np.append(near, False) & ~np.append(False, near)
    for begin, end in runs_of(alone):
        at = (float(both.time[begin]), float(both.time[end - 1]))
        least = float(np.nanmin(shown[begin:end]))
        kind = "apart" if least < 0.0 else "possible_contact"
        yield Touch(*at, person, kind, False, float("nan"), least, error, *at)


def _span(
    both: Synchronized, away: Array, ways: Array, steps: npt.NDArray[np.intp], distance: float
) -> tuple[float, float]:
    """Return when both are first and last within a distance of each other in some steps, in s."""
    begin, _, _ = touching_share(away[steps[0]], ways[steps[0]], distance)
    last = int(steps[-1])
    # From the end of the last step back.
    back, _, _ = touching_share(away[last + 1], -ways[last], distance)
    return float(both.time[steps[0]] + begin * both.step), float(both.time[last + 1] - back * both.step)


def runs_of(flags: Flags) -> list[tuple[int, int]]:
    """Return begin and end (one more) of every run of true values."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], flags, [False]]).astype(np.int8)))
    return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))


def walls_touched(
    both: Synchronized, walls: StaticMap, radius: float, error: float, outline: Outlined | None = None
) -> tuple[Array, list[Touch]]:
    """Return distances of the robot from walls at instants (T,), and contacts with them, possible ones too."""
    known = both.known
    shown = np.full(len(both.time), np.nan)
    way = np.hypot(*np.diff(both.position, axis=0).T)
    reach = way
    if outline is None:
        shown[known] = np.asarray(walls.clearance(both.position[known])) - radius
    else:
        error += BETWEEN
        shown[known] = outline.footprint.clearance(walls, both.position[known], both.heading[known])
        reach = way + radius * np.abs(np.diff(both.heading))
    with np.errstate(invalid="ignore"):
        may = both.linked & (np.fmin(shown[:-1], shown[1:]) - 0.5 * reach < error)
    between = np.fmin(shown[:-1], shown[1:])
    for step in np.flatnonzero(may).tolist():
        if outline is None:
            found = walls.segment_clearance(both.position[step], both.position[step + 1]) - radius
        else:
            share = np.linspace(0.0, 1.0, min(int(0.5 * reach[step] / BETWEEN) + 2, MOST_PLACES))[:, None]
            places = both.position[step] + share * (both.position[step + 1] - both.position[step])
            turned = both.heading[step] + share[:, 0] * (both.heading[step + 1] - both.heading[step])
            found = float(outline.footprint.clearance(walls, places, turned).min())
        between[step] = min(found, between[step])
    with np.errstate(invalid="ignore"):
        near = may & (between < error)
    found_ones = []
    for begin, end in runs_of(near):
        least = float(between[begin:end].min())
        # A footprint that overlaps a wall is at a distance of 0.
        touched = least < 0.0 if outline is None else least <= PASSED
        kind = "wall" if touched else "possible_contact"
        at = (float(both.time[begin]), float(both.time[end]))
        speed = float(way[begin] / both.step)
        found_ones.append(Touch(*at, None, kind, kind == "wall" and speed > CONTACT_SPEED, speed, least, error, *at))
    return shown, found_ones
