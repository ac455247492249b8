"""Warnings that a user gives to what is made of doubtful data, and those that are found on request."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import Any, overload

from hrsafety._arguments import instance, sequence
from hrsafety.plausibility import ResultWarning

__all__ = ["LateDoubts", "checked_doubts"]


class LateDoubts(Sequence[ResultWarning]):
    """Warnings that are found when they are read: those of a large recording take seconds.

    Parameters
    ----------
    find : callable
        Returns them.
    """

    __slots__ = ("_find", "_found")

    def __init__(self, find: Callable[[], Iterable[ResultWarning]]) -> None:
        self._find = find
        self._found: tuple[ResultWarning, ...] | None = None

    def _all(self) -> tuple[ResultWarning, ...]:
        if self._found is None:
            self._found = tuple(self._find())
        return self._found

    @overload
    def __getitem__(self, index: int) -> ResultWarning: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[ResultWarning, ...]: ...
    def __getitem__(self, index: int | slice) -> ResultWarning | tuple[ResultWarning, ...]:
        return self._all()[index]

    def __len__(self) -> int:
        return len(self._all())

    def __repr__(self) -> str:
        return repr(self._all())

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle what was found, without what it was found in."""
        return tuple, (self._all(),)


def checked_doubts(name: str, value: object) -> Sequence[ResultWarning]:
    """Return the warnings of a sequence as a tuple, or say what it should have been; late ones stay late."""
    if isinstance(value, LateDoubts):
        return value
    found = sequence(name, "be a sequence of warnings", value)
    for index, doubt in enumerate(found):
        instance(f"{name}[{index}]", doubt, ResultWarning)
    return tuple(found)
