"""Where robots run: the base of worlds and scenarios."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from hrsafety._arguments import Parameters
from hrsafety.plausibility import ResultWarning

__all__ = ["Place"]


class Place(Parameters):
    """Place where robots run: a `World`, or a `Scenario`, which is a world of one robot whose people do not react.

    Every verb takes either. Runs of a scenario have a loop of their own, which also counts forces and currents; for
    what is made for worlds, `World.of` makes one of it.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> scene = scenarios.configuration("c2")
    >>> isinstance(scene, nav.Place), isinstance(nav.World.of(scene), nav.Place)
    (True, True)
    """

    __slots__ = ()

    if TYPE_CHECKING:
        time_limit: float
        seed: int
        doubts: Sequence[ResultWarning]

        @property
        def warnings(self) -> tuple[ResultWarning, ...]:
            """Why a run may not mean what it seems to."""

        @property
        def unit_doubts(self) -> tuple[ResultWarning, ...]:
            """Warnings about numbers that are hardly meant in their unit."""
