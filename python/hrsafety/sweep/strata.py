"""Latin hypercubes of any length, any row at any time, without stored permutations.

Each axis has a keyed permutation of the strata: a Feistel network over a rectangle a x b that is
barely larger than the number of rows (Black and Rogaway, Ciphers with arbitrary finite domains,
2002). Numbers beyond the last row are permuted again until they fall inside. The place within the
stratum comes from a counter-based generator (Philox), so that row k is the same however the rows
are asked for.
"""

from __future__ import annotations

import math

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array

__all__ = ["latin_shares", "permuted"]

Words = npt.NDArray[np.uint64]

ROUNDS = 8
# Numbers that one Philox counter gives.
PER_COUNTER = 4


def latin_shares(rows: int, axes: int, seed: int, start: int, stop: int) -> Array:
    """Return rows of a Latin hypercube in the unit cube.

    Parameters
    ----------
    rows : int
        Length of the whole design: each axis is divided into so many strata.
    axes : int
        Number of axes.
    seed : int
        Which design.
    start, stop : int
        Range of rows.

    Returns
    -------
    ndarray, shape (stop - start, axes)
        From 0 up to, not including, 1.
    """
    index = np.arange(start, stop, dtype=np.uint64)
    shares = _jitter(axes, seed, start, stop)
    for axis in range(axes):
        shares[:, axis] += permuted(index, rows, seed, axis)
    shares /= rows
    # Rounding must not carry the last stratum to the end of the axis.
    return np.minimum(shares, np.nextafter(1.0, 0.0), out=shares)


def _jitter(axes: int, seed: int, start: int, stop: int) -> Array:
    """Return the places within the strata."""
    generator = np.random.Philox(np.random.SeedSequence([seed, axes]))
    skipped = start * axes
    generator.advance(skipped // PER_COUNTER)
    numbers = np.random.Generator(generator)
    numbers.random(skipped % PER_COUNTER)
    return numbers.random((stop - start, axes))


def permuted(index: Words, rows: int, seed: int, axis: int) -> Words:
    """Return where a keyed permutation of 0..rows-1 takes some numbers.

    Parameters
    ----------
    index : ndarray of uint64
        Numbers below ``rows``.
    rows : int
        Length of the permutation.
    seed, axis : int
        Key.

    Returns
    -------
    ndarray of uint64
        Of the same shape.
    """
    width = math.isqrt(rows - 1) + 1
    height = -(-rows // width)
    keys = np.asarray(np.random.SeedSequence([seed, axis, rows]).generate_state(ROUNDS, np.uint64), dtype=np.uint64)
    found = _round_trip(index, width, height, keys)
    outside = np.flatnonzero(found >= rows)
    while len(outside):
        found[outside] = _round_trip(found[outside], width, height, keys)
        outside = outside[found[outside] >= rows]
    return found


def _round_trip(index: Words, width: int, height: int, keys: Words) -> Words:
    """Return the image under a permutation of 0..width*height-1."""
    left, right = index // np.uint64(height), index % np.uint64(height)
    for first, second in zip(keys[::2], keys[1::2], strict=True):
        left = (left + _mixed(right, first) % np.uint64(width)) % np.uint64(width)
        right = (right + _mixed(left, second) % np.uint64(height)) % np.uint64(height)
    found: Words = left * np.uint64(height) + right
    return found


def _mixed(values: Words, key: np.uint64) -> Words:
    """Return a hash of the values: the finalizer of SplitMix64, arithmetic modulo 2**64."""
    mixed = values ^ key
    mixed = (mixed ^ (mixed >> np.uint64(30))) * np.uint64(0xBF58476D1CE4E5B9)
    mixed = (mixed ^ (mixed >> np.uint64(27))) * np.uint64(0x94D049BB133111EB)
    return mixed ^ (mixed >> np.uint64(31))
