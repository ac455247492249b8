"""Entries of a comparison: a law and the parts around it, in a word such as ``field+shield+yielding``."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from types import MappingProxyType

from hrsafety import navigation as nav
from hrsafety._arguments import checked_text, meant
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.known import LAWS

__all__ = ["MARGIN", "PARTS", "Entry", "entry"]

MARGIN = 0.005
"""Error of the robot's motion that shields assume unless a protocol says otherwise, in m."""
PARTS = ("guide", "shield", "yielding", "foresight")
"""Parts that a word may add to a law."""
_OWN: Mapping[str, nav.Law] = MappingProxyType({"field": nav.VirtualForceField()})


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
    """

    name: str
    law: nav.Law
    parts: tuple[str, ...]

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
        if not self.parts and map is None:
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
        are others than usual, then ``+guide``, ``+shield`` and ``+yielding``, or ``+foresight`` in its place.

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
    """
    checked_text("laws", word, "hold words such as field+shield")
    name, *parts = word.strip().lower().split("+")
    for part in parts:
        if part not in PARTS:
            raise InvalidParameterError("laws", f"add {' or '.join(PARTS)} to a law", word, meant(part, PARTS))
    if {"yielding", "foresight"} <= set(parts):
        raise InvalidParameterError("laws", "add yielding or foresight to a law, not both", word)
    return Entry(name=word, law=_with_gains(name, word), parts=tuple(each for each in PARTS if each in parts))


def _with_gains(name: str, word: str) -> nav.Law:
    """Return the law of a word with the gains that stand in brackets."""
    plain, bracket, rest = name.partition("(")
    law = _law(plain, word)
    if not bracket:
        return law
    if not rest.endswith(")"):
        raise InvalidParameterError("laws", "close the bracket of the gains, as field(attractive_gain=13)", word)
    names = [each.name for each in fields(law)]  # type: ignore[arg-type]  # laws are dataclasses
    gains: dict[str, float] = {}
    for part in rest[:-1].split(","):
        gain, _, value = part.partition("=")
        known = [name for name in names if isinstance(getattr(law, name), float)]
        if gain not in known or gain in gains:
            raise InvalidParameterError("laws", f"give one of {', '.join(known)} once", word, meant(gain, known))
        try:
            gains[gain] = float(value)
        except ValueError:
            raise InvalidParameterError("laws", f"give {gain} a number", word) from None
    return law.replaced(**gains)


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
