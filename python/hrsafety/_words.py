"""Which word was meant."""

from __future__ import annotations

from collections.abc import Iterable

__all__ = ["meant"]


def meant(value: object, words: Iterable[str]) -> str | None:
    """Return the question whether the nearest of the words was meant; ``None`` when none is near."""
    if not isinstance(value, str):
        return None
    import difflib  # for errors only

    by_form = {each.lower().replace("-", "_"): each for each in words}
    near = difflib.get_close_matches(value.lower().replace("-", "_"), list(by_form), n=1, cutoff=0.66)
    return f'did you mean "{by_form[near[0]]}"?' if near else None
