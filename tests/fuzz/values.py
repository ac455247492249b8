"""Values that break rules, and right values that are changed a little or a lot."""

from __future__ import annotations

import random
from typing import Any

import numpy as np

from api.fuzzing import EVIL, INF, NAN

__all__ = ["spoiled"]

_SPECIAL = (0.0, -0.0, 1.0, -1.0, NAN, INF, -INF, 5e-324, 1e-308, 1e308, 1e16, 0.1, 2**31 - 1, 2**31, 2**63 - 1, -1, 3)


def _number(draws: random.Random) -> float | int:
    """Return a number of any size."""
    kind = draws.randrange(4)
    if kind == 0:
        return draws.choice(_SPECIAL)
    if kind == 1:
        return draws.randint(-3, 12)
    if kind == 2:
        return draws.uniform(-10.0, 10.0)
    return draws.choice((1.0, -1.0)) * 10.0 ** draws.uniform(-20.0, 20.0)


def _array(draws: random.Random, shape: tuple[int, ...]) -> np.ndarray:
    """Return numbers of a shape, now and then with one that is no number, or of another shape."""
    if draws.random() < 0.2:
        shape = draws.choice(((), (0,), (2,), (3,), (2, 2), (3, 2), (5,), (5, 2), (1, 1, 2), (*shape, 1), shape[:-1]))
    found = np.array([_number(draws) for _ in range(int(np.prod(shape)))], dtype=np.float64)
    return found.reshape(shape)


def spoiled(right: Any, draws: random.Random) -> Any:
    """Return a value in place of a right one.

    Parameters
    ----------
    right : object
        What the argument may be.
    draws : random.Random
        Source of chance.

    Returns
    -------
    object
        A value of any kind, or one like the right one with other numbers.
    """
    if draws.random() < 0.45:
        return draws.choice(EVIL)
    if isinstance(right, bool) or right is None or right is ...:
        return draws.choice((True, False, 0, 1, None, _number(draws)))
    if isinstance(right, (int, float, np.number)):
        return _number(draws) if draws.random() < 0.7 else float(right) * 10.0 ** draws.uniform(-6.0, 6.0)
    if isinstance(right, str):
        return draws.choice((right.upper(), right + "_", right[:-1], "", "\x00", right[::-1], 7, "é" * 3))
    if isinstance(right, np.ndarray) and right.dtype.kind == "f" and right.size < 100:
        return _array(draws, right.shape)
    if isinstance(right, (tuple, list)) and right:
        changed = list(right)
        place = draws.randrange(len(changed))
        kind = draws.randrange(4)
        if kind == 0:
            del changed[place]
        elif kind == 1:
            changed.append(changed[place])
        else:
            changed[place] = spoiled(changed[place], draws)
        return type(right)(changed) if type(right) in (tuple, list) else changed
    return draws.choice(EVIL)
