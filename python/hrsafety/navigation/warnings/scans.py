"""Warnings of laws that make their own map of scans: movers, and plans that are not verified."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety.plausibility import ResultWarning

__all__ = ["MOVERS_UNWATCHED", "unwatched"]

MOVERS_UNWATCHED = "movers_unwatched"
"""Code of people and things that move around a law that takes all it sees for standing."""


def unwatched(law: object, movers: int) -> Iterator[ResultWarning]:
    """Yield the doubts of a law that makes its own map of scans.

    Parameters
    ----------
    law : Law or None
        What drives the robot.
    movers : int
        People, robots and things around it that may move.

    Yields
    ------
    ResultWarning
        With the codes ``"movers_unwatched"`` and ``"not_verified"``; nothing for other laws.
    """
    if not getattr(law, "MAPS_SCANS", False):
        return
    if movers:
        message = (
            f"the law takes what its lidars see for standing, but {movers} around the robot may move: nothing keeps it "
            "from driving into their way; nothing is proved for this run"
        )
        yield ResultWarning(MOVERS_UNWATCHED, "law", message)
    if not getattr(law, "verify", True):
        message = "plans are not verified: nothing keeps the robot from contact"
        yield ResultWarning("not_verified", "law.verify", message)
