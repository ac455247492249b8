"""A robot that was recorded among people."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._display import displayed

__all__ = ["RecordedRobot"]

Array = npt.NDArray[np.float64]


@displayed
class RecordedRobot(NamedTuple):
    """Robot among recorded people.

    Attributes
    ----------
    time_s : ndarray, shape (n,)
        Instants in s, with the clock of the people.
    position : ndarray, shape (n, 2)
        Positions in m.
    heading : ndarray, shape (n,)
        Angles to the x axis in rad.
    shape : mapping or None
        Shape as it was stored.
    """

    time_s: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    heading: Annotated[Array, "rad"]
    shape: Mapping[str, Any] | None
