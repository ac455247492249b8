"""Which word was meant, and words and numbers as they are printed."""

from __future__ import annotations

import re
from collections.abc import Iterable

__all__ = ["meant", "nearest", "some", "unsigned_zero"]

_ZERO = re.compile(r"(?<![\w.\-])-(0(?:\.0*)?)(?![\d.eE])")


def some(count: int, one: str, many: str = "", *, form: str = "") -> str:
    """Return a count with its word, in the plural unless it is one; ``form`` is that of the number."""
    return f"{count:{form}} {one if count == 1 else many or one + 's'}"


def unsigned_zero(text: str) -> str:
    """Return a text in which no number that was rounded to zero has a minus sign."""
    return _ZERO.sub(r"\1", text)


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
