"""Safe navigation: any law with a shield, yielding and a way out of local minima around it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field, replace
from typing import Annotated, NamedTuple

from hrsafety import _hrsafety
from hrsafety._arguments import Pair, instance, number
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.filters import SafetyFilter
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.laws.foresight import Foresight
from hrsafety.navigation.laws.python_law import as_law
from hrsafety.navigation.laws.shield import Shield
from hrsafety.navigation.laws.yielding import Yielding
from hrsafety.navigation.maps.guide import Guide
from hrsafety.navigation.maps.static_map import StaticMap

__all__ = ["SafeNavigation", "SafetyTrace"]

CRITICAL_DISTANCE = 0.02
"""Where force laws brake beside a shield that gives way, in m between the surfaces."""


@displayed
class SafetyTrace(NamedTuple):
    """Decisions of the parts around a law in a control period.

    Attributes
    ----------
    wanted, command : (float, float)
        Velocity that the law wanted, within its limit, or the takeover in its place, and the one that is
        commanded, in m/s.
    taken_over : bool
        Whether the law was taken over from.
    status : str
        ``"kept"``, ``"changed"`` or ``"braking"``; ``"infeasible"`` where no velocity obeys the rule of a filter.
    """

    wanted: Annotated[Pair, "m/s"]
    command: Annotated[Pair, "m/s"]
    taken_over: bool
    status: str


@dataclass(frozen=True, slots=True)
class SafeNavigation(Law):
    """A law with parts around it, each of which may be left out; it is a law like any other.

    ``wanted = law -> takeover -> yielding -> shield``, or ``foresight -> shield``: the law wants a velocity,
    ``V + F T/m`` for a force. If it has not brought the robot nearer to the goal for some time, the robot heads
    straight for the goal until it has come nearer. A velocity is chosen that gives way to people, and the shield
    lets through what is safe. What all parts keep is the law's own command, bit for bit. The gains are
    those of the law.

    Parameters
    ----------
    law : law
        What wants a velocity: any law of the package, or one of your own.
    map : StaticMap or None
        What stands and is known before. Laws see its boundary points, planners of whole paths the map
        itself; what stands in the scene and lies in the map as a whole is known by the map alone.
    guide : Guide or None
        Plan and local goal for the law. In a map the law is then taken over from where it makes no progress; without
        one it leads around those who stand, where the robot is stuck behind them.
    shield : Shield or None
        The shield.
    filter : SafetyFilter or None
        One of the filters of the field in the place of a shield, not beside one: what each assumes stands with it.
        `BarrierUnicycle` is for robots with two wheels, the others are for those that move in any direction.
    yielding : Yielding or None
        How the robot gives way.
    foresight : Foresight or None
        How the robot looks ahead, in the place of yielding and of the law itself.
    preferred_speed : float or None
        Limit of the wanted velocity in m/s, for which regions are sized; the robot may be faster to give
        way. ``None``: the largest speed of the robot.
    takeover : bool or None
        Whether the law is taken over from where it makes no progress. ``None``: with yielding, or with a
        guide in a map, but never with foresight; without a map it drives straight to the goal, and only yielding and
        shield keep it off people.
    critical_distance : float or None or "regions"
        Distance between the surfaces in m at which force laws brake, in place of the critical regions of
        the scene; active regions stay. ``None``: 0.02 m with a shield and yielding, else the regions of
        the scene, as for ``"regions"``.

    Raises
    ------
    InvalidParameterError
        If an argument is not of its kind or not positive. A preferred speed above that of the robot, a
        start in contact with the map and a goal nearer to it than the radius of the robot are refused when
        a run begins.

    Examples
    --------
    >>> from hrsafety import navigation as nav, scenarios
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), yielding=nav.Yielding())
    >>> nav.simulate(scenarios.random_traffic(12, seed=1), law).outcome
    'arrived'
    """

    law: Law
    map: StaticMap | None = field(default=None, kw_only=True)
    guide: Guide | None = field(default=None, kw_only=True)
    shield: Shield | None = field(default=None, kw_only=True)
    filter: SafetyFilter | None = field(default=None, kw_only=True)
    yielding: Yielding | None = field(default=None, kw_only=True)
    foresight: Foresight | None = field(default=None, kw_only=True)
    preferred_speed: float | None = field(default=None, kw_only=True)
    takeover: bool | None = field(default=None, kw_only=True)
    critical_distance: float | str | None = field(default=None, kw_only=True)
    _native: _hrsafety.Law = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(law=as_law(self.law))
        if self.map is not None:
            instance("map", self.map, StaticMap)
        if self.guide is not None:
            instance("guide", self.guide, Guide)
        if self.shield is not None:
            instance("shield", self.shield, Shield)
        if self.filter is not None:
            instance("filter", self.filter, SafetyFilter)
        if self.yielding is not None:
            instance("yielding", self.yielding, Yielding)
        if self.foresight is not None:
            instance("foresight", self.foresight, Foresight)
            if self.yielding is not None:
                raise InvalidParameterError(
                    "yielding", "be None beside foresight, which takes its place", self.yielding
                )
        if self.preferred_speed is not None:
            self._set(preferred_speed=number("preferred_speed", self.preferred_speed))
        if not (self.takeover is None or isinstance(self.takeover, bool)):
            raise InvalidParameterError("takeover", "be True, False or None", self.takeover)
        guide = Guide() if self.guide is None else self.guide
        native = _hrsafety.guarded_law(
            self.law._native,
            shield=None if self.shield is None else self.shield._native,
            filter=None if self.filter is None else self.filter._native,
            yielding=None if self.yielding is None else self.yielding._native,
            foresight=None if self.foresight is None else self.foresight._native,
            map=None if self.map is None else self.map._native,
            guide=None if self.guide is None else self.guide._native,
            takeover=self._takes_over,
            takeover_rule=(guide.takeover_progress, guide.takeover_window),
            preferred_speed=self.preferred_speed,
            critical_distance=self._critical_distance(),
        )
        self._set(_native=native)

    @property
    def _takes_over(self) -> bool:
        """Whether a guide or yielding takes over from a law that does not get on."""
        if self.takeover is not None:
            return self.takeover
        guided = self.guide is not None and self.map is not None
        return self.foresight is None and (guided or self.yielding is not None)

    def _critical_distance(self) -> float | None:
        given = self.critical_distance
        if given is None:
            return CRITICAL_DISTANCE if self.shield is not None and self.yielding is not None else None
        if isinstance(given, str):
            if given != "regions":
                raise InvalidParameterError("critical_distance", 'be a number, None or "regions"', given)
            return None
        distance = number("critical_distance", given)
        self._set(critical_distance=distance)
        return distance

    @property
    def NAME(self) -> str:  # type: ignore[override]  # noqa: N802  # that of the law within
        """Name of the law, with what is around it."""
        return f"safe {self.law.NAME}" if hasattr(self.law, "NAME") else "safe navigation"

    @property
    def PLANS(self) -> bool:  # type: ignore[override]  # noqa: N802
        """Whether the law chooses a velocity or a path instead of a force."""
        return self.foresight is not None or getattr(self.law, "PLANS", False)

    @property
    def parts_words(self) -> str:
        """Names of the parts around the law, in words."""
        parts = [
            words
            for words, part in (
                ("map", self.map),
                ("guide", self.guide),
                ("shield", self.shield),
                (f"filter {'' if self.filter is None else self.filter.NAME}", self.filter),
                ("yielding", self.yielding),
                ("foresight", self.foresight),
            )
            if part is not None
        ]
        return ", ".join(parts) or "nothing around it"

    @property
    def GAIN_NAMES(self) -> tuple[str, ...]:  # type: ignore[override]  # noqa: N802  # those of the law within
        """Names of the gains of the law."""
        return self.law.GAIN_NAMES

    @property
    def GAIN_BOUNDS(self) -> Mapping[str, tuple[float, float]]:  # type: ignore[override]  # noqa: N802
        """Where a search looks for them."""
        return self.law.GAIN_BOUNDS

    @property
    def GAIN_UNITS(self) -> Mapping[str, str]:  # type: ignore[override]  # noqa: N802
        """Their units."""
        return self.law.GAIN_UNITS

    @property
    def GAIN_SYMBOLS(self) -> Mapping[str, str]:  # type: ignore[override]  # noqa: N802
        """Their symbols in the source."""
        return self.law.GAIN_SYMBOLS

    @property
    def gains(self) -> tuple[float, ...]:
        """The gains of the law, in the order of `GAIN_NAMES`."""
        return self.law.gains

    def replaced(self, **changes: object) -> SafeNavigation:
        """Return it with some fields changed, its own or those of the law.

        Parameters
        ----------
        **changes
            New values by the names of the fields.

        Returns
        -------
        SafeNavigation
            The same with these values.

        Raises
        ------
        InvalidParameterError
            If a value is not allowed.
        """
        own = {name: changes.pop(name) for name in list(changes) if name in _FIELDS}
        if changes:
            inner = own.get("law", self.law)
            own["law"] = as_law(inner).replaced(**changes)
        return replace(self, **own)  # type: ignore[arg-type]  # checked at construction


_FIELDS = frozenset(
    {
        "law",
        "map",
        "guide",
        "shield",
        "filter",
        "yielding",
        "foresight",
        "preferred_speed",
        "takeover",
        "critical_distance",
    }
)
