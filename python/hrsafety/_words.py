"""Which word was meant."""

from __future__ import annotations

from collections.abc import Iterable

__all__ = ["meant", "nearest"]


def meant(value: object, words: Iterable[str]) -> str | None:
    """Return the question whether the nearest of the words was meant; ``None`` when none is near."""
    near = nearest(value, words)
    return None if near is None else f'did you mean "{near}"?'


def nearest(value: object, words: Iterable[str]) -> str | None:
    """Return the nearest of the words; ``None`` when none is near."""
    if not isinstance(value, str):
        return None
    import difflib  # for errors only

    by_form = {each.lower().replace("-", "_"): each for each in words}
    near = difflib.get_close_matches(value.lower().replace("-", "_"), list(by_form), n=1, cutoff=0.66)
    return by_form[near[0]] if near else None
