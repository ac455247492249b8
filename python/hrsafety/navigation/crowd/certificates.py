"""Earliest arrivals of robots that know the future, of many worlds."""

from __future__ import annotations

from collections.abc import Sequence

from hrsafety import _hrsafety
from hrsafety._arguments import thread_count
from hrsafety.navigation.crowd.world import World

__all__ = ["Found", "earliest_arrivals"]

Found = tuple[float, list[list[float]]] | None


def earliest_arrivals(worlds: Sequence[World], threads: int | None) -> list[Found]:
    """Return the earliest arrival in s and places every 0.2 s in m of the first robot of each world, if it arrives."""
    return _hrsafety.crowd_certificates([world._native for world in worlds], threads=thread_count(threads))
