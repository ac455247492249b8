"""Base of runs of reactive robots that are advanced from outside."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from typing import Any, Generic, NoReturn, Protocol, TypeVar

from hrsafety.errors import SimulationError
from hrsafety.reactive.percept import Percept, percept_of

__all__ = ["Stepped"]

Record = TypeVar("Record", covariant=True)


class _Native(Protocol):
    """A run of the core."""

    @property
    def time(self) -> float: ...
    @property
    def finished(self) -> bool: ...
    def percept(self) -> dict[str, Any]: ...
    def run(self) -> None: ...
    def recorded(self) -> Mapping[str, Any]: ...


class Stepped(ABC, Generic[Record]):
    """Base of runs that are advanced from outside; a class of it has `record` and its own `step`."""

    __slots__ = ("_native",)
    _native: _Native

    @property
    def time(self) -> float:
        """Time of the steps so far, in s."""
        return self._native.time

    @property
    def finished(self) -> bool:
        """Whether the run has ended, by a touch or because its time is over."""
        return self._native.finished

    @property
    @abstractmethod
    def record(self) -> Record:
        """The run so far."""

    def observe(self) -> Percept:
        """Return what the robot decides by now.

        Returns
        -------
        Percept
            The same until the next `step`.
        """
        return percept_of(self._native.percept())

    def finish(self) -> Record:
        """Run to the end under the robot's own decisions.

        Returns
        -------
        FollowerRun or SkirtRun
            The whole run.

        Raises
        ------
        SimulationError
            If the state became non-finite, or another thread is stepping it.
        """
        self._native.run()
        return self.record

    def _check_under_way(self) -> None:
        if self.finished:
            raise SimulationError(f"the run has ended (t = {self.time:.6g} s); make another to step")

    def __reduce__(self) -> NoReturn:
        """Refuse: a run under way is no value."""
        own = type(self).__name__
        raise SimulationError(f"{own} cannot be copied or pickled; make others with the same arguments")
