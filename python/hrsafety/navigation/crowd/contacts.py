"""Contacts of a robot with people: whether it moved then, and whether toward them."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.navigation.metrics.between import until_arrival, wrapped
from hrsafety.navigation.metrics.episode import Episode
from hrsafety.navigation.trajectory import CONTACT_SPEED

__all__ = ["Contacts", "contacts_of"]


class Contacts(NamedTuple):
    """Numbers of people whom a robot touched up to its arrival.

    Attributes
    ----------
    moving, standing : int
        At first contact the robot was faster than 0.05 m/s, or it was not.
    at_fault : int
        The robot moved toward them, faster than 0.05 m/s, at some instant of a contact.
    """

    moving: int
    standing: int
    at_fault: int


def contacts_of(episode: Episode, arrival_time: float) -> Contacts:
    """Return whom a robot touched, from positions alone.

    Parameters
    ----------
    episode : Episode
        The robot and the people.
    arrival_time : float
        When the robot arrived, in s; NaN if it did not.

    Returns
    -------
    Contacts
        Numbers of people.
    """
    own, people = until_arrival(episode, arrival_time)
    if people.size == 0 or len(own) < 2:
        return Contacts(0, 0, 0)
    offset = wrapped(people - own[:, None], episode.period)
    distance = np.linalg.norm(offset, axis=2)
    touching = distance < episode.robot_radius + np.asarray(episode.person_radius)
    velocity = np.diff(own, axis=0) / episode.step
    # The speed of the step into the first contact; at the start that of the first step.
    first = np.maximum(touching.argmax(axis=0) - 1, 0)
    touched = touching.any(axis=0)
    moving = touched & (np.hypot(*velocity[first].T) > CONTACT_SPEED)
    at_fault = _moved_toward(offset, distance, touching, velocity)
    return Contacts(int(moving.sum()), int((touched & ~moving).sum()), int(at_fault.sum()))


def _moved_toward(
    offset: Array, distance: Array, touching: npt.NDArray[np.bool_], velocity: Array
) -> npt.NDArray[np.bool_]:
    """Return toward whom a robot moved at some instant of a contact.

    A step that begins or ends in the contact counts, by the place of the person before and after it.
    """
    with np.errstate(divide="ignore", invalid="ignore"):
        before = (velocity[:, None] * offset[:-1]).sum(axis=2) / distance[:-1]
        after = (velocity[:, None] * offset[1:]).sum(axis=2) / distance[1:]
    toward = np.fmax(before, after) > CONTACT_SPEED
    found: npt.NDArray[np.bool_] = ((touching[:-1] | touching[1:]) & toward).any(axis=0)
    return found
