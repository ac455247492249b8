"""Functions of the sweep tests that other processes can import."""

from __future__ import annotations

import os
import signal
from pathlib import Path

import numpy as np
import numpy.typing as npt

from hrsafety import impact
from hrsafety import navigation as nav

Array = npt.NDArray[np.float64]


def norms(x: Array, y: Array, offset: float = 0.0) -> dict[str, npt.ArrayLike]:
    """Return a number, an integer, a flag and a word for each row."""
    return {
        "norm": np.hypot(x, y) + offset,
        "quadrant": (x > 0).astype(np.int64) + 2 * (y > 0),
        "far": np.hypot(x, y) > 1.0,
        "side": np.where(x > 0, "right", "left"),
    }


def fails_beyond(x: Array, limit: float) -> dict[str, Array]:
    """Raise in the chunk that goes beyond a limit."""
    if (x > limit).any():
        raise ArithmeticError(f"x beyond {limit}")
    return {"y": 2.0 * x}


def counted(x: Array, folder: str) -> dict[str, Array]:
    """Leave a file for each call that tells who computed what."""
    Path(folder, f"{os.getpid()}_{x[0]:.6f}").touch()
    return {"y": np.sin(x)}


def peaks(closing_speed: Array) -> dict[str, Array]:
    """Return the peak force of impacts."""
    loads = impact.metrics_batch(
        manipulator=impact.MANIPULATOR_1,
        foam=impact.FOAM_1,
        head=impact.Head.minimum(),
        closing_speed=closing_speed,
        threads=1,
    )
    return {"force": loads.peak_contact_force}


def peaks_with_a_victim(closing_speed: Array, victim: float, marker: str) -> dict[str, Array]:
    """Return the peak force of impacts, but kill the first process that computes one of the rows."""
    if (closing_speed >= victim).any() and not Path(marker).exists():
        Path(marker).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return peaks(closing_speed)


def always_kills(x: Array) -> dict[str, Array]:
    """Kill the process."""
    os.kill(os.getpid(), signal.SIGKILL)
    return {"y": x}


def crossing(row: dict[str, float]) -> nav.Scenario:
    """Return a scene with a person who crosses at some place."""
    person = nav.Human(start=(row["place"], -2.0), velocity=(0.0, row["walking_speed"]))
    return nav.Scenario(start=(5.0, 0.0), goal=(0.0, 0.0), obstacles=[person])


def two_crossings(row: dict[str, float]) -> list[nav.Scenario]:
    """Return two scenes."""
    return [crossing(row), crossing({**row, "place": row["place"] + 0.5})]
