"""Many contacts at once: columns to the core and back, with what has to be said about them."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, thread_count
from hrsafety.contact.covering import Covering
from hrsafety.contact.doubts import Doubts, covering_flags, flagged, implausible_numbers
from hrsafety.contact.rows import NAMES, applying, columns_of

__all__ = ["Many", "many", "words_at"]

WORDS: dict[str, list[str]] = dict(zip(("collide", "speed", "thickness"), _hrsafety.contact_words(), strict=True))
"""Words of the statuses of collisions, allowed speeds and thicknesses, in the order of their codes."""
_DEPTHS = {"collide": "peak_covering_compression", "speed": "covering_compression"}


class Many(NamedTuple):
    """Results of many contacts in the broadcast shape.

    Attributes
    ----------
    numbers : dict of str to ndarray
        Columns of the core.
    status : ndarray of str
        Words, and ``"invalid_"`` with a name for rows with a bad number.
    flags : dict of str to ndarray of bool
        Why a row may not mean what it seems to.
    warnings : tuple of ResultWarning
        How many rows that holds for, and implausible numbers.
    given : dict of str to ndarray or float
        What the rows were given, by the names of a row.
    """

    numbers: dict[str, Array]
    status: npt.NDArray[np.str_]
    flags: dict[str, npt.NDArray[np.bool_]]
    warnings: Doubts
    given: dict[str, Any]

    def flag(self, name: str) -> npt.NDArray[np.bool_]:
        """Return a flag of every row; one that cannot hold is false."""
        return self.flags[name] if name in self.flags else np.zeros(self.status.shape, dtype=bool)


def many(
    kind: str,
    row: tuple[dict[str, object], dict[str, float]],
    varying: Mapping[str, object],
    covering: Covering | None,
    *,
    gravity: float | None = None,
    threads: int | None,
    progress: Callable[[int, int], object] | None,
) -> Many:
    """Return the results of many contacts; `kind` is ``"collide"`` or ``"speed"``."""
    shared, values = row
    region = str(shared["region"])
    columns, shape = columns_of(values, varying, applying(kind, region, covering))
    rows, count = int(np.prod(shape, dtype=np.int64)), thread_count(threads)
    found = _hrsafety.contact_rows(
        kind,
        shared,
        columns,
        rows,
        gravity=gravity,
        threads=count,
        progress=callback("progress", progress),
    )
    found = {name: each.reshape(shape) for name, each in found.items()}
    given = {
        name: each.reshape(shape) if isinstance(each, np.ndarray) else each
        for name, each in zip(NAMES, columns, strict=True)
    }
    codes, words = found.pop("status_code"), WORDS[kind]
    flags = covering_flags(covering, found[_DEPTHS[kind]], given)
    flags = {name: np.broadcast_to(each, shape) for name, each in flags.items()}
    there = (np.bincount(codes.reshape(-1), minlength=256) > 0).tolist()
    told = {"invalid": codes >= len(words)} if any(there[len(words) :]) else {}
    for name in ("unfinished", "beyond_data"):
        if name in words and there[words.index(name)]:
            told[name] = codes == words.index(name)
    flags["rising"] = found.pop("rising")
    return Many(
        numbers=found,
        status=_status(words, codes, there, covering),
        flags=flags,
        warnings=(*flagged(told | flags, covering, given), *implausible_numbers(covering, region, given)),
        given=given,
    )


def words_at(words: Sequence[str], codes: npt.NDArray[np.uint8]) -> npt.NDArray[np.str_]:
    """Return the words at codes; the last one stands for every code beyond it."""
    return np.asarray(words).take(codes, mode="clip")


def _status(
    words: list[str], codes: npt.NDArray[np.uint8], there: list[bool], covering: Covering | None
) -> npt.NDArray[np.str_]:
    """Return the words of statuses; invalid rows name the number as the caller does."""
    names = list(NAMES)
    if covering is not None:
        for place, name in enumerate(covering.material.keys.values()):
            names[names.index(f"material_{place}")] = name
    all_words = [*words, *(f"invalid_{name}" for name in names), "invalid_covering"]
    # Only as wide as the words that are there: the longest one takes many times the room of its code.
    used = [*there[: len(all_words) - 1], any(there[len(all_words) - 1 :])]
    return words_at([word if use else "" for word, use in zip(all_words, used, strict=True)], codes)
