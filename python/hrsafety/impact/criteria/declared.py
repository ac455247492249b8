"""The criteria of an impact: one list, from which rows, columns, units and documentation follow."""

from __future__ import annotations

from collections import namedtuple
from collections.abc import Callable, Iterable, Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NamedTuple, Self, TypeVar

from hrsafety import _hrsafety
from hrsafety._records import dataclass

__all__ = ["CRITERIA", "Criterion", "CriterionValues", "LoadRow", "with_criteria"]

T_co = TypeVar("T_co", covariant=True)
C = TypeVar("C", bound=type)


class Criterion(NamedTuple):
    """Declaration of a criterion: label, unit, symbol.

    Attributes
    ----------
    name : str
        Its name, in files too.
    label : str
        What it is, in words.
    unit : str
        Its unit; empty where sources give numbers without one.
    symbol : str
        Its symbol in the source; empty without one.
    is_peak : bool
        Whether peaks alone give it, without the course of the acceleration.
    """

    name: str
    label: str
    unit: str
    symbol: str
    is_peak: bool


CRITERIA: Mapping[str, Criterion] = MappingProxyType({row[0]: Criterion(*row) for row in _hrsafety.impact_criteria()})
"""Declaration of each criterion by the native core, in the order of rows."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CriterionValues(Generic[T_co]):
    """A value for each of `CRITERIA`, for type checkers: names cannot come from a module that is compiled."""

    peak_head_acceleration: T_co
    peak_head_acceleration_g: T_co
    mean_head_acceleration_g: T_co
    peak_contact_force: T_co
    max_compression: T_co
    impact_duration: T_co
    hic15: T_co
    hic36: T_co
    average_3ms_g: T_co
    clip_3ms_g: T_co
    peak_power_manipulator: T_co
    peak_power_foam: T_co


if TYPE_CHECKING:

    class LoadRow(CriterionValues[float]):
        """The named tuple below."""

        status: str
        beyond_linear_range: bool
        _fields: ClassVar[tuple[str, ...]]

        @classmethod
        def _make(cls, iterable: Iterable[object]) -> Self: ...
        def _replace(self, /, **kwargs: object) -> Self: ...
        def _asdict(self) -> dict[str, Any]: ...
        def __iter__(self) -> Iterator[Any]: ...  # noqa: D105  # those of a tuple
        def __len__(self) -> int: ...  # noqa: D105  # those of a tuple
        def __getitem__(self, index: int, /) -> Any: ...  # noqa: D105  # those of a tuple

else:
    LoadRow = namedtuple("LoadRow", (*CRITERIA, "status", "beyond_linear_range"))


def with_criteria(kind: str) -> Callable[[C], C]:
    """Put the criteria, as attributes of a type, where ``{criteria}`` stands in the docstring of a class."""
    entries = [f"    {each.name} : {kind}\n        {_sentence(each)}" for each in CRITERIA.values()]

    def fill(owner: C) -> C:
        owner.UNITS = {name: each.unit for name, each in CRITERIA.items()}  # type: ignore[attr-defined]  # read by _display
        # Without docstrings, as under python -OO, there is nothing to fill.
        if owner.__doc__:
            owner.__doc__ = owner.__doc__.replace("    {criteria}", "\n".join(entries))
        return owner

    return fill


def _sentence(criterion: Criterion) -> str:
    unit = f", in {criterion.unit}" if criterion.unit else ""
    return f"{criterion.label[0].upper()}{criterion.label[1:]}{unit}."
