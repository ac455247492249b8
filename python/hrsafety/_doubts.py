"""Warnings that a user gives to what is made of doubtful data."""

from __future__ import annotations

from hrsafety._arguments import instance, sequence
from hrsafety.plausibility import ResultWarning

__all__ = ["checked_doubts"]


def checked_doubts(name: str, value: object) -> tuple[ResultWarning, ...]:
    """Return the warnings of a sequence, or say what it should have been."""
    found = sequence(name, "be a sequence of warnings", value)
    for index, doubt in enumerate(found):
        instance(f"{name}[{index}]", doubt, ResultWarning)
    return tuple(found)
