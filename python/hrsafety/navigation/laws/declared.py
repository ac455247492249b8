"""Declaration of a law, once: its name, and the unit, bounds, symbol and default of each of its gains.

The list `hrsafety.navigation.laws.known.LAWS` follows from the declarations, and from the list the names in files and
on the command line, the axes of sweeps, the bounds of searches and the colors of pictures.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field, fields, replace
from types import MappingProxyType
from typing import Any, ClassVar, Self, TypeVar

from hrsafety import _hrsafety
from hrsafety._arguments import Parameters
from hrsafety._records import dataclass

__all__ = ["DECLARED", "Gain", "Law", "gain", "law"]

L = TypeVar("L", bound="type[Law]")


@dataclass(frozen=True, kw_only=True, slots=True)
class Gain:
    """Declaration of a gain besides its name and default.

    Parameters
    ----------
    unit : str
        Its unit; empty without one.
    bounds : (float, float)
        Where a search looks for it without bounds of its own.
    symbol : str
        Its symbol in the source; empty without one.
    """

    unit: str
    bounds: tuple[float, float]
    symbol: str


def gain(default: float, *, unit: str, bounds: tuple[float, float], symbol: str = "") -> Any:
    """Return the field of a gain, a number that a search may choose."""
    return field(default=default, metadata={"gain": Gain(unit=unit, bounds=bounds, symbol=symbol)})


class Law(Parameters):
    """Base of the navigation laws: numbers that a search may choose, by name.

    Attributes
    ----------
    NAME : str
        Name of the law in files and on the command line.
    OTHER_NAMES : tuple of str
        Short names that are understood, too.
    COLOR : str
        Color of its runs in pictures; empty for a neutral one.
    PLANS : bool
        Whether it chooses a velocity or a path instead of a force.
    MAPS_SCANS : bool
        Whether it knows its surroundings from the scans of the robot's lidars alone.
    GAIN_NAMES : tuple of str
        Names of the gains, in the order in which batches and searches take them.
    GAIN_BOUNDS : mapping of str to (float, float)
        Where a search looks for them without bounds of its own.
    GAIN_UNITS : mapping of str to str
        Their units.
    GAIN_SYMBOLS : mapping of str to str
        Their symbols in the source.
    """

    __slots__ = ("_native",)
    NAME: ClassVar[str]
    OTHER_NAMES: ClassVar[tuple[str, ...]]
    COLOR: ClassVar[str]
    PLANS: ClassVar[bool]
    MAPS_SCANS: ClassVar[bool] = False
    GAIN_NAMES: ClassVar[tuple[str, ...]]
    GAIN_BOUNDS: ClassVar[Mapping[str, tuple[float, float]]]
    GAIN_UNITS: ClassVar[Mapping[str, str]]
    GAIN_SYMBOLS: ClassVar[Mapping[str, str]]
    _native: _hrsafety.Law

    def __post_init__(self) -> None:
        """Check the gains; laws with more than gains do more."""
        self._make()

    def _make(self, **others: object) -> None:
        """Make the native law of the gains and of what else it needs; it checks all values."""
        self._set(_native=_hrsafety.Law.named(self.NAME, **self._as_numbers(*self.GAIN_NAMES), **others))

    @property
    def gains(self) -> tuple[float, ...]:
        """The numbers in the order of `GAIN_NAMES`."""
        return tuple(getattr(self, name) for name in self.GAIN_NAMES)

    def replaced(self, **changes: object) -> Self:
        """Return the law with some fields changed.

        Parameters
        ----------
        **changes
            New values by the names of the fields.

        Returns
        -------
        Law
            A law of the same kind.

        Raises
        ------
        InvalidParameterError
            If a value is not allowed.
        """
        return replace(self, **changes)  # type: ignore[type-var]  # every law is a dataclass


DECLARED: dict[str, type[Law]] = {}
"""The laws by name whose modules are loaded; all of them are in `hrsafety.navigation.laws.known`."""


def law(name: str, *other_names: str, color: str = "", plans: bool = False) -> Callable[[L], L]:
    """Declare a law: put its class into `DECLARED`, and what its fields say about gains into the class."""

    def declare(owner: L) -> L:
        gains: dict[str, Gain] = {
            each.name: each.metadata["gain"]
            for each in fields(owner)  # type: ignore[arg-type]  # every law is a dataclass
            if "gain" in each.metadata
        }
        owner.NAME, owner.OTHER_NAMES, owner.COLOR, owner.PLANS = name, other_names, color, plans
        owner.GAIN_NAMES = tuple(gains)
        owner.GAIN_BOUNDS = MappingProxyType({key: each.bounds for key, each in gains.items()})
        owner.GAIN_UNITS = MappingProxyType({key: each.unit for key, each in gains.items()})
        owner.GAIN_SYMBOLS = MappingProxyType({key: each.symbol for key, each in gains.items()})
        DECLARED[name] = owner
        return owner

    return declare
