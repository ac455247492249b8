"""Entries of a comparison: a law and the parts around it, in a word such as ``field+shield+yielding``."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, replace
from types import MappingProxyType
from typing import TypeVar

from hrsafety import navigation as nav
from hrsafety._arguments import checked_text, meant
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.filters import FILTERS
from hrsafety.navigation.laws.known import LAWS

__all__ = ["MARGIN", "PARTS", "Entry", "entry", "settings_of"]

MARGIN = 0.005
"""Error of the robot's motion that shields assume unless a protocol says otherwise, in m."""
Whose = TypeVar("Whose", nav.Law, nav.laws.SafetyFilter)

PARTS = ("guide", "shield", "yielding", "foresight")
"""Parts that a word may add to a law."""
_OWN: Mapping[str, nav.Law] = MappingProxyType(
    {
        "field": nav.VirtualForceField(),
        "straight": nav.laws.BorensteinKoren(attractive_gain=50.0, repulsive_gain=0.0),
    }
)


@dataclass(frozen=True, kw_only=True, slots=True)
class Entry:
    """A law and its parts.

    Parameters
    ----------
    name : str
        The word.
    law : Law
        The law itself.
    parts : tuple of str
        Which of ``PARTS`` are around it.
    filter : SafetyFilter or None
        Filter in the place of the shield.
    """

    name: str
    law: nav.Law
    parts: tuple[str, ...]
    filter: nav.laws.SafetyFilter | None = None

    def built(
        self,
        *,
        person_speed: float,
        preferred_speed: float | None = None,
        latency: float = 0.0,
        position_error: float = 0.0,
        margin: float = MARGIN,
        map: nav.maps.StaticMap | None = None,
        guide: nav.maps.Guide | None = None,
        yielding: nav.laws.Yielding | None = None,
        foresight: nav.laws.Foresight | None = None,
        takeover: bool | None = None,
    ) -> nav.Law:
        """Return the law with its parts.

        Parameters
        ----------
        person_speed : float
            What the shield assumes of people, in m/s.
        preferred_speed : float or None
            Limit of the wanted velocity in m/s.
        latency, position_error : float
            What the shield assumes of measurements, in s and m.
        margin : float
            What it assumes of the robot's motion, in m, and keeps from walls.
        map : StaticMap or None
            What the law knows to stand.
        guide, yielding, foresight : Guide, Yielding, Foresight or None
            Those of the protocol, for entries that have these parts.
        takeover : bool or None
            As of `SafeNavigation`.

        Returns
        -------
        Law
            The law itself without parts and map.
        """
        if not self.parts and self.filter is None and map is None:
            return self.law
        shield = nav.laws.Shield(
            person_speed=person_speed,
            latency=latency,
            position_error=position_error,
            margin=margin,
            wall_margin=margin,
        )
        return nav.laws.SafeNavigation(
            self.law,
            map=map,
            guide=(guide or nav.maps.Guide()) if "guide" in self.parts else None,
            shield=shield if "shield" in self.parts else None,
            filter=self.filter,
            yielding=(yielding or nav.laws.Yielding()) if "yielding" in self.parts else None,
            foresight=(foresight or nav.laws.Foresight()) if "foresight" in self.parts else None,
            preferred_speed=preferred_speed,
            takeover=takeover if self.parts else None,
        )


def entry(word: str) -> Entry:
    """Return the law and the parts that a word names.

    Parameters
    ----------
    word : str
        A law by its long or short name (``field`` is the virtual force field), its gains in brackets where they
        are others than usual (``straight`` heads for the goal at full speed, whoever is there), then ``+guide``,
        ``+shield`` and ``+yielding``, or ``+foresight`` in its place; in place of the shield one of ``FILTERS``.

    Returns
    -------
    Entry
        What is to be run.

    Raises
    ------
    InvalidParameterError
        If the law, a gain or a part is unknown.

    Examples
    --------
    >>> from hrsafety.benchmarks import entry
    >>> entry("orca+shield").parts
    ('shield',)
    >>> entry("field(attractive_gain=13)").law.attractive_gain
    13.0
    >>> entry("straight+barrier(margin=0.2)").filter.margin
    0.2
    """
    checked_text("laws", word, "hold words such as field+shield")
    name, *added = word.strip().lower().split("+")
    parts = [each for each in added if each.partition("(")[0] not in FILTERS]
    rules = [each for each in added if each not in parts]
    for part in parts:
        if part not in PARTS:
            known = (*PARTS, *FILTERS)
            raise InvalidParameterError("laws", f"add {' or '.join(known)} to a law", word, meant(part, known))
    if len(rules) > 1 or (rules and "shield" in parts):
        raise InvalidParameterError("laws", "add one filter or a shield to a law", word)
    if {"yielding", "foresight"} <= set(parts):
        raise InvalidParameterError("laws", "add yielding or foresight to a law, not both", word)
    rule = None
    for each in rules:
        plain, gains = _gains(FILTERS[each.partition("(")[0]](), each, word)
        rule = replace(plain, **gains)  # type: ignore[type-var]  # filters are dataclasses
    drives, own = _gains(_law(name.partition("(")[0], word), name, word)
    law = drives.replaced(**own) if own else drives
    return Entry(name=word, law=law, parts=tuple(each for each in PARTS if each in parts), filter=rule)


def settings_of(word: str, names: Sequence[str], settings: Sequence[str]) -> dict[str, float]:
    """Return the settings in the brackets of a word.

    Parameters
    ----------
    word : str
        A name, with settings in brackets or without: ``rollouts(noise=0.03,drift=1)``.
    names, settings : sequence of str
        Names and settings that there are.

    Returns
    -------
    dict of str to float
        The settings that are given.

    Raises
    ------
    InvalidParameterError
        If the name or a setting is unknown, or a setting is given twice or no number.
    """
    example = f"{names[0]}({settings[0]}=3)"
    checked_text("laws", word, f"hold words such as {example}")
    name, bracket, rest = word.strip().lower().partition("(")
    if name not in names or (bracket and not rest.endswith(")")):
        rule = f"be {' or '.join(names)}, with settings as in {example}"
        raise InvalidParameterError("laws", rule, word, meant(name, names))
    values: dict[str, float] = {}
    for part in rest[:-1].split(",") if bracket else ():
        setting, _, value = (text.strip() for text in part.partition("="))
        if setting not in settings or setting in values:
            rule = f"give one of {', '.join(settings)} once"
            raise InvalidParameterError("laws", rule, word, meant(setting, settings))
        try:
            values[setting] = float(value)
        except ValueError:
            raise InvalidParameterError("laws", f"give {setting} a number", word) from None
    return values


def _gains(law: Whose, name: str, word: str) -> tuple[Whose, dict[str, float]]:
    """Return a law or a filter, and the numbers that stand in brackets after its name."""
    _, bracket, rest = name.partition("(")
    gains: dict[str, float] = {}
    if not bracket:
        return law, gains
    if not rest.endswith(")"):
        raise InvalidParameterError("laws", "close the bracket of the gains, as field(attractive_gain=13)", word)
    names = [each.name for each in fields(law)]  # type: ignore[arg-type]  # both are dataclasses
    for part in rest[:-1].split(","):
        gain, _, value = part.partition("=")
        known = [name for name in names if isinstance(getattr(law, name), float)]
        if gain not in known or gain in gains:
            raise InvalidParameterError("laws", f"give one of {', '.join(known)} once", word, meant(gain, known))
        try:
            gains[gain] = float(value)
        except ValueError:
            raise InvalidParameterError("laws", f"give {gain} a number", word) from None
    return law, gains


def _law(name: str, word: str) -> nav.Law:
    plain = name.replace("-", "_")
    if plain in _OWN:
        return _OWN[plain]
    for known, kind in LAWS.items():
        if plain == known or plain in kind.OTHER_NAMES:
            return kind()
    names = [*_OWN, *LAWS]
    others = [name for kind in LAWS.values() for name in kind.OTHER_NAMES]
    raise InvalidParameterError("laws", f"name {', '.join(names)}", word, meant(plain, [*names, *others]))
