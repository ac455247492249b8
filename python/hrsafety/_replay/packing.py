"""Numbers of a player as small text: whole numbers, differences from frame to frame, byte planes, deflate, base64."""

from __future__ import annotations

import base64
import math
import zlib
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

__all__ = ["ABSENT", "Block", "Scale", "block", "counted"]

Array = npt.NDArray[np.float64]

ABSENT = -32768
MOST = 32_500
"""Largest whole number of a position on either side of the middle: the span has 65,000 of them."""
FINEST = 1e-3
"""Unit of a position in m where the span allows it."""


class Block(NamedTuple):
    """Packed numbers.

    Attributes
    ----------
    name : str
        What they are.
    kind : {"i16", "u16", "u8"}
        What they are kept as.
    shape : (int, int)
        Rows and columns.
    text : str
        Base64 of the deflated bytes.
    """

    name: str
    kind: str
    shape: tuple[int, int]
    text: str


class Scale(NamedTuple):
    """How positions become whole numbers.

    Attributes
    ----------
    unit : float
        Length of one in m.
    middle : (float, float)
        Place of (0, 0) in m.
    """

    unit: float
    middle: tuple[float, float]

    @classmethod
    def of(cls, *places: Array) -> Scale:
        """Return the scale that holds all places, NaN left out."""
        every = np.concatenate([np.asarray(each, dtype=np.float64).reshape(-1, 2) for each in places])
        every = every[np.isfinite(every).all(axis=1)]
        if not len(every):
            return cls(FINEST, (0.0, 0.0))
        low, high = every.min(axis=0), every.max(axis=0)
        middle = 0.5 * low + 0.5 * high
        unit = max(FINEST, float((high - low).max()) / (2 * MOST))
        return cls(unit, (float(middle[0]), float(middle[1])))

    def whole(self, places: Array) -> npt.NDArray[np.int16]:
        """Return places (..., 2) as whole numbers; who is not at a finite place is absent."""
        with np.errstate(invalid="ignore"):
            found = np.round((places - np.array(self.middle)) / self.unit)
        here = np.isfinite(found).all(axis=-1, keepdims=True) & (np.abs(found) <= MOST + 1).all(axis=-1, keepdims=True)
        return np.where(here, found, ABSENT).astype(np.int16)


def counted(values: Array, unit: float) -> npt.NDArray[np.int16]:
    """Return numbers as multiples of a unit, the nearest that there is for larger ones; absent for NaN."""
    with np.errstate(invalid="ignore", over="ignore"):
        found = np.clip(np.round(np.asarray(values, dtype=np.float64) / unit), -32_767, 32_767)
    return np.where(np.isnan(found), ABSENT, found).astype(np.int16)


def block(name: str, values: npt.NDArray[Any], *, kind: str = "i16") -> Block:
    """Return numbers packed, each column for itself.

    Parameters
    ----------
    name : str
        What they are.
    values : ndarray, shape (n,) or (n, c)
        Whole numbers; differences are taken along the rows, modulo what the kind holds.
    kind : {"i16", "u16", "u8"}
        What they are kept as.
    """
    table = values.reshape(len(values), math.prod(values.shape[1:]))
    store = np.dtype("u1") if kind == "u8" else np.dtype("<u2")
    series = np.ascontiguousarray(table.T).astype(np.int64)
    steps = np.diff(series, axis=1, prepend=0) if series.size else series
    flat = np.mod(steps, 256**store.itemsize).astype(store).ravel()
    planes = np.ascontiguousarray(flat.view(np.uint8).reshape(-1, store.itemsize).T)
    packer = zlib.compressobj(6, zlib.DEFLATED, -15)
    packed = packer.compress(planes.tobytes()) + packer.flush()
    return Block(name, kind, (table.shape[0], table.shape[1]), base64.b64encode(packed).decode("ascii"))
