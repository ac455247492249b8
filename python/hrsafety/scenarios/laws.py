"""Laws as tables of files: the name of each law and the kind of each of its values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from types import MappingProxyType
from typing import Any

from hrsafety import _keys as kind
from hrsafety import navigation as nav
from hrsafety._arguments import meant
from hrsafety._keys import Keys, Kind, checked, located
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.laws.filters import FILTERS
from hrsafety.navigation.laws.known import LAWS

__all__ = ["LAWS", "SHORT_NAMES", "keys_of", "law_named", "law_of", "name_of", "safe_of"]

SHORT_NAMES: Mapping[str, str] = MappingProxyType(
    {short: name for name, law in LAWS.items() for short in law.OTHER_NAMES}
)
"""Short names that files and the command line take for a law, too."""
_SYMBOLS = {
    symbol: name
    for name, declared in nav.VirtualForceField.GAIN_SYMBOLS.items()
    for symbol in (declared.lower(), declared.lower().replace("_", ""))
}
_KINDS: Mapping[str, Kind] = MappingProxyType(
    {"float": kind.number, "float | None": kind.number, "bool": kind.boolean, "int": kind.integer}
)


def keys_of(law: type[nav.Law]) -> Keys:
    """Return the keys of the table of a law; what is no number and no flag is a word."""
    own = {each.name: _KINDS.get(str(each.type), kind.word) for each in fields(law) if each.init}  # type: ignore[arg-type]  # all are dataclasses
    return MappingProxyType({"type": kind.word, **own})


def name_of(law: nav.Law) -> str:
    """Return the name of the law's table."""
    return law.NAME


def law_named(path: str, word: str) -> type[nav.Law]:
    """Return the law of a name: long or short, with hyphens, blanks or capitals as in running text."""
    plain = word.strip().lower().replace("-", "_").replace(" ", "_").replace("d*", "d_star")
    name = SHORT_NAMES.get(plain, plain)
    if name not in LAWS:
        near = meant(plain, [*LAWS, *SHORT_NAMES])
        raise InvalidParameterError(path, f"be {' or '.join(LAWS)}", kind.shown(word), near)
    return LAWS[name]


def law_of(table: dict[str, Any]) -> nav.Law:
    """Return the law that a table ``[law]`` describes."""
    if "type" not in table:
        raise kind.missing("law.type", 'write type = "virtual_force_field" or the name of another law')
    law = law_named("law.type", kind.word("law.type", table["type"]))
    for key in table:
        if law is nav.VirtualForceField and key.lower() in _SYMBOLS:
            error = kind.unknown_key("law", key, keys_of(law))
            remedy = f"did you mean {_SYMBOLS[key.lower()]}?"
            raise InvalidParameterError(error.argument, error.requirement, error.value, remedy)
    given = checked("law", table, keys_of(law))
    del given["type"]
    with located("law"):
        return law(**given)


_PARTS: Mapping[str, type[nav.laws.Shield] | type[nav.laws.Yielding] | type[nav.laws.Foresight]] = MappingProxyType(
    {"shield": nav.laws.Shield, "yielding": nav.laws.Yielding, "foresight": nav.laws.Foresight}
)
_SAFE: Keys = MappingProxyType(
    {
        **dict.fromkeys((*_PARTS, "filter"), kind.table),
        "preferred_speed": kind.number,
        "takeover": kind.boolean,
        "critical_distance": kind.number,
    }
)


def safe_of(law: nav.Law, table: dict[str, Any]) -> nav.laws.SafeNavigation:
    """Return the law with the parts that a table ``[safe]`` describes."""
    given = checked("safe", table, _SAFE)
    for name, part in _PARTS.items():
        if name in given:
            kinds = {tuple: kind.pair, int: kind.integer}
            keys = {each.name: kinds.get(type(each.default), kind.number) for each in fields(part) if each.init}
            values = checked(f"safe.{name}", given[name], keys)
            with located(f"safe.{name}"):
                given[name] = part(**values)
    if "filter" in given:
        given["filter"] = _filter_of(given["filter"])
    with located("safe"):
        return nav.laws.SafeNavigation(law, **given)


def _filter_of(table: dict[str, Any]) -> nav.laws.SafetyFilter:
    """Return the filter that a table ``[safe.filter]`` describes."""
    if "type" not in table:
        raise kind.missing("safe.filter.type", f"write one of {', '.join(FILTERS)}")
    name = kind.word("safe.filter.type", table["type"])
    if name not in FILTERS:
        known = f"be one of {', '.join(FILTERS)}"
        raise InvalidParameterError("safe.filter.type", known, kind.shown(name), meant(name, [*FILTERS]))
    made = FILTERS[name]
    numbers = {each.name: kind.number for each in fields(made) if each.init}  # type: ignore[arg-type]  # all are dataclasses
    given = checked("safe.filter", table, {"type": kind.word, **numbers})
    del given["type"]
    with located("safe.filter"):
        return made(**given)
