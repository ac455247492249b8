"""Rows of recorded people as a file has them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._records import dataclass
from hrsafety.datasets.robots import RecordedRobot
from hrsafety.io.reader import Document
from hrsafety.plausibility import ResultWarning

__all__ = ["Rows", "assumed", "lost_rows"]

Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True, slots=True)
class Rows:
    """Rows of a file in its order and its units, one for each person and instant.

    Attributes
    ----------
    clock : ndarray, shape (n,)
        Frames, or instants in s.
    person : ndarray, shape (n,)
        Ids.
    position : ndarray, shape (n, 2)
        In units of the file; NaN where unknown.
    velocity : ndarray, shape (n, 2), or None
        In units of the file per second.
    lines : ndarray of int, shape (n,), or None
        Line of each row.
    frames : bool
        Whether the clock counts frames.
    rate : float or None
        Frames per second that the file tells.
    rate_of_format : float or None
        Frames per second that all files of the format have.
    rate_from_velocity : bool
        Whether stored velocities tell the rate if nothing else does.
    unit : str
        Unit of positions that the file or its format tells: a key of `LENGTHS`, ``"px"``, or empty.
    unit_fixed : bool
        Whether a unit of the caller would contradict the file.
    unit_guess : bool
        Whether meters are assumed, if the recording is plausible then.
    guessed : bool
        Whether positions without a unit are refused only after the frame rate is known.
    flip : bool
        Whether y points down.
    """

    clock: Array
    person: npt.NDArray[Any]
    position: Array
    velocity: Array | None = None
    lines: npt.NDArray[np.int64] | None = None
    frames: bool
    rate: float | None = None
    rate_of_format: float | None = None
    rate_from_velocity: bool = False
    unit: str = ""
    unit_fixed: bool = True
    unit_guess: bool = False
    flip: bool = False
    walls: tuple[Array, ...] = ()
    robot: RecordedRobot | None = None
    format: str = ""
    notes: tuple[ResultWarning, ...] = ()
    details: Mapping[str, Any] = field(default_factory=dict)


def assumed(subject: str, message: str) -> ResultWarning:
    """Return the warning about something that a file does not say and that was taken from evidence."""
    return ResultWarning("assumed", subject, message)


def lost_rows(
    document: Document, lost: npt.NDArray[np.bool_], lines: npt.NDArray[np.int64], person: npt.NDArray[Any]
) -> ResultWarning:
    """Return the warning about rows in which a file says that a person was not seen."""
    first = int(np.flatnonzero(lost)[0])
    message = (
        f"{int(lost.sum())} rows of {document.name} are marked as lost (line {lines[first]}, person {person[first]}): "
        "the people are taken to go straight on in between, and are away before and after it"
    )
    return ResultWarning("lost_rows", "position", message)
