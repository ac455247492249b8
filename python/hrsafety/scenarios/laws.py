"""Laws as tables of files: the name of each law and the kind of each of its values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from types import MappingProxyType
from typing import Any

from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError
from hrsafety.scenarios import keys as kind
from hrsafety.scenarios.keys import Keys, Kind, checked, located

__all__ = ["LAWS", "keys_of", "law_of", "name_of"]

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


def law_of(table: dict[str, Any]) -> nav.Law:
    """Return the law that a table ``[law]`` describes."""
    if "type" not in table:
        raise InvalidParameterError("law.type", "be given", "nothing")
    name = kind.word("law.type", table["type"])
    if name not in LAWS:
        raise InvalidParameterError("law.type", f"be {' or '.join(LAWS)}", kind.shown(name))
    given = checked("law", table, keys_of(LAWS[name]))
    del given["type"]
    with located("law"):
        return LAWS[name](**given)
