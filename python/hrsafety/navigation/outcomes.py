"""How a run can end: the words of the core, and what each says."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Literal

from hrsafety import _hrsafety

__all__ = ["OUTCOMES", "Outcome"]

# For type checkers, which cannot ask the core; a test compares it with the list.
Outcome = Literal["arrived", "collided", "timed_out", "stopped", "diverged"]

OUTCOMES: Mapping[str, str] = MappingProxyType(
    dict(_hrsafety.run_outcomes()) | {"diverged": "a state of the world was no longer finite"}
)
"""Meaning of each outcome, by its word, in the order of the core; a world that diverges ends, a scenario fails."""
