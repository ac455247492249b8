"""Doubts about filters: what they assume and the scene does not give."""

from __future__ import annotations

from collections.abc import Iterator

from hrsafety.navigation.laws.filters import SafetyFilter
from hrsafety.navigation.laws.safe_navigation import SafeNavigation
from hrsafety.plausibility import ResultWarning

__all__ = ["FILTER_ASSUMES_LESS", "of_filter"]

FILTER_ASSUMES_LESS = "filter_assumes_less"


def _filters(law: object) -> Iterator[SafetyFilter]:
    while isinstance(law, SafeNavigation):
        if law.filter is not None:
            yield law.filter
        law = law.law


def of_filter(law: object, owner: str = "law", *, measured: bool, walls: bool) -> Iterator[ResultWarning]:
    """Warn of people who are not known exactly to a filter, and of walls that it does not look at.

    Parameters
    ----------
    law : law
        What drives the robot.
    owner : str
        How the warning calls it.
    measured : bool
        Whether positions of people have errors or are late.
    walls : bool
        Whether something stands.

    Yields
    ------
    ResultWarning
        With the code ``"filter_assumes_less"``.
    """
    for each in _filters(law):
        subject = f"{owner}.filter"
        if measured:
            said = "takes people for where they are measured: errors and age of measurements are not in its rule"
            yield ResultWarning(FILTER_ASSUMES_LESS, subject, f"the filter {each.NAME} {said}; a margin holds some")
        if walls and not each.LOOKS_AT_WALLS:
            said = "does not look at what stands: it may turn the robot into a wall"
            yield ResultWarning(FILTER_ASSUMES_LESS, subject, f"the filter {each.NAME} {said}")
