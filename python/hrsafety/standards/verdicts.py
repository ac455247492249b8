"""Verdicts on loads and speeds against limits: their words, their order and how they are shown."""

from __future__ import annotations

from collections.abc import Iterable
from types import MappingProxyType

from hrsafety.plausibility import ResultWarning, unsafe_doubts

__all__ = ["VERDICTS", "VERDICT_WORDS", "doubted", "speed_verdict", "strictest"]

VERDICT_WORDS = MappingProxyType(
    {
        "not_permitted": "not permitted",
        "exceeds": "exceeds",
        "not_checked": "not checked",
        "within_limits": "within limits",
    }
)
"""Verdicts as pages and tables show them; only the last one is good."""

VERDICTS = tuple(VERDICT_WORDS)
"""Verdicts on a load against a limit: of several the first one counts."""


def strictest(words: Iterable[str]) -> str:
    """Return the verdict that counts of several; ``"not_checked"`` without any.

    Parameters
    ----------
    words : iterable of str
        Verdicts.

    Returns
    -------
    str
        One of `VERDICTS`.
    """
    given = set(words)
    return next((word for word in VERDICTS if word in given), "not_checked")


def doubted(word: str, warnings: Iterable[ResultWarning]) -> str:
    """Return what is left of a verdict beside the doubts of its result.

    Parameters
    ----------
    word : str
        One of `VERDICTS`.
    warnings : iterable of ResultWarning
        Of the result.

    Returns
    -------
    str
        ``"not_checked"`` for ``"within_limits"`` where the error of a doubt may lie on the unsafe side, else the word:
        what exceeds a limit as computed is no better for a doubt.
    """
    return "not_checked" if word == "within_limits" and unsafe_doubts(warnings) else word


def speed_verdict(planned: float, allowed: float | None, *, permitted: bool, checked: bool) -> str:
    """Return what a planned closing speed means beside the allowed one.

    Parameters
    ----------
    planned : float
        In m/s.
    allowed : float or None
        In m/s; ``None`` where nothing limits it, or nothing is known.
    permitted : bool
        Whether contact is permitted at all.
    checked : bool
        Whether every limit was checked: one that was not never counts as kept.

    Returns
    -------
    str
        One of `VERDICTS`.
    """
    if not permitted:
        return "not_permitted"
    if allowed is not None and not planned <= allowed:
        return "exceeds"
    return "within_limits" if checked else "not_checked"
