"""Laws as tables of files: the name of each law and the kind of each of its values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from types import MappingProxyType
from typing import Any

from hrsafety import navigation as nav
from hrsafety._arguments import meant
from hrsafety.errors import InvalidParameterError
from hrsafety.scenarios import keys as kind
from hrsafety.scenarios.keys import Keys, Kind, checked, located

__all__ = ["LAWS", "SHORT_NAMES", "keys_of", "law_named", "law_of", "name_of"]

LAWS: Mapping[str, type[nav.Law]] = MappingProxyType(
    {
        "virtual_force_field": nav.VirtualForceField,
        "khatib": nav.Khatib,
        "borenstein_koren": nav.BorensteinKoren,
        "masoud": nav.Masoud,
        "ge_cui": nav.GeCui,
        "virtual_impedance": nav.VirtualImpedanceLaw,
        "velocity_obstacle": nav.VelocityObstacle,
        "rapidly_exploring_random_tree": nav.RapidlyExploringRandomTree,
        "field_d_star": nav.FieldDStar,
        "optimal_reciprocal_collision_avoidance": nav.OptimalReciprocalCollisionAvoidance,
    }
)
SHORT_NAMES: Mapping[str, str] = MappingProxyType(
    {
        "vff": "virtual_force_field",
        "zeng": "virtual_force_field",
        "borenstein": "borenstein_koren",
        "bk": "borenstein_koren",
        "gecui": "ge_cui",
        "impedance": "virtual_impedance",
        "vo": "velocity_obstacle",
        "velocity_obstacles": "velocity_obstacle",
        "rrt": "rapidly_exploring_random_tree",
        "tree": "rapidly_exploring_random_tree",
        "dstar": "field_d_star",
        "d_star": "field_d_star",
        "field_dstar": "field_d_star",
        "orca": "optimal_reciprocal_collision_avoidance",
        "rvo2": "optimal_reciprocal_collision_avoidance",
    }
)
"""Short names that files and the command line take for a law, too."""
_SYMBOLS = {
    **dict.fromkeys(("k1", "k_1"), "attractive_gain"),
    **dict.fromkeys(("k3", "k_3"), "repulsive_gain"),
    **dict.fromkeys(("k5", "k_5"), "detour_gain"),
    "b": "gain_ratio",
}
"""Symbols of the source for the gains of the field, which files name by their words."""
_KINDS: Mapping[str, Kind] = MappingProxyType(
    {"float": kind.number, "float | None": kind.number, "bool": kind.boolean, "int": kind.integer}
)


def keys_of(law: type[nav.Law]) -> Keys:
    """Return the keys of the table of a law; what is no number and no flag is a word."""
    own = {each.name: _KINDS.get(str(each.type), kind.word) for each in fields(law) if each.init}  # type: ignore[arg-type]  # all are dataclasses
    return MappingProxyType({"type": kind.word, **own})


def name_of(law: nav.Law) -> str:
    """Return the name of the law's table."""
    return next(name for name, each in LAWS.items() if each is type(law))


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
