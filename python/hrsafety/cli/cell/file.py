"""Cell files: TOML in, a robot, its coverings and the contacts that are planned out."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Mapping
from dataclasses import fields, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from hrsafety import contact, standards
from hrsafety._records import dataclass
from hrsafety._words import meant
from hrsafety.cli.cell.robot import RobotFacts, robot_of
from hrsafety.cli.cell.stops import separation_of
from hrsafety.errors import InvalidParameterError
from hrsafety.scenarios import files
from hrsafety.scenarios import keys as kind
from hrsafety.scenarios.keys import Keys, checked, located, one_of

__all__ = [
    "ALLOWED_CHANCE",
    "BASE_REGIONS",
    "Cell",
    "Planned",
    "canonical",
    "load",
    "pad_of",
]

MOST_CONTACTS = 64
MOST_COVERINGS = 16
MOST_DRAWS = 10**7
BASE_REGIONS = ("lower_leg", "thigh_knee")
"""What a mobile base meets, unless the file names regions."""

_TOP: Keys = MappingProxyType(
    {
        "title": kind.word,
        "limits": kind.word,
        "speed": kind.number,
        "human_speed": kind.number,
        "contact_area": kind.number,
        "covering": kind.word,
        "catalog": kind.word,
        "robot": kind.table,
        "contacts": kind.tables,
        "coverings": kind.tables,
        "separation": kind.table,
        "uncertain": kind.table,
        "draws": kind.integer,
        "seed": kind.integer,
        "allowed_chance": kind.number,
        "confirmed": kind.table,
    }
)
_CONTACT: Keys = MappingProxyType(
    {
        "region": kind.word,
        "area_name": kind.word,
        "contact": kind.word,
        "speed": kind.number,
        "covering": kind.word,
        "contact_area": kind.number,
    }
)
_COVERING: Keys = MappingProxyType(
    {
        "name": kind.word,
        "material": lambda path, value: value if isinstance(value, str) else kind.table(path, value),
        **dict.fromkeys(("thickness", "area", "radius", "second_radius", "length"), kind.number),
        **dict.fromkeys(("damping", "half_width", "max_strain"), kind.number),
        "shape": kind.word,
        "rate": kind.triple,
        "unloading": kind.pair,
        "bottom": kind.pair,
    }
)


ALLOWED_CHANCE = 0.01
"""Chance of being too fast that is still within limits, unless the file gives another one."""
NEVER_CONFIRMED = ("beyond_data", "invalid_numbers", "not_checked", "region_unknown", "unfinished")
"""Doubts that nobody can confirm away: nothing is known there."""
NO_COVERING = "none"
"""Word for a bare contact where the file has a covering for all others."""


class Planned(NamedTuple):
    """A contact that is planned.

    Attributes
    ----------
    limit : ContactLimit
        Region and class with what it may bear.
    speed : float
        Planned speed of the robot's point towards the person, in m/s.
    covering : str or None
        Name of the covering; ``None``: bare.
    area : float or None
        Area of the bare contact in m^2.
    own_area : bool
        Whether the contact itself gives that area: then it also takes the place of that of a flat covering.
    """

    limit: standards.ContactLimit
    speed: float
    covering: str | None
    area: float | None
    own_area: bool = False


@dataclass(frozen=True, kw_only=True, slots=True)
class Cell:
    """What a cell file describes.

    Attributes
    ----------
    title : str
        Heading of the page.
    limits : LimitSet
        The limits.
    robot : RobotFacts
        The robot with its masses.
    coverings : dict of str to Covering
        By name.
    strains : dict of str to float or None
        Largest strain of a covering, its e_b when ``None``.
    materials : dict of str to str
        Source of the material of a covering that is from a catalog.
    contacts : tuple of Planned
        What is judged.
    human_speed : float
        Speed of the person towards the robot in m/s.
    separation : dict or None
        Numbers of the stop by name, if given; measured stops as a table of arrays.
    uncertain : dict
        Distributions by name.
    draws, seed : int
        Of the chances.
    allowed_chance : float
        Chance of being too fast that is still within limits.
    confirmed : dict of str to str
        Doubts by code that somebody has confirmed not to hold here, with reason and name.
    inputs : dict
        Everything that was given or is a default, as JSON holds it.
    files : dict of str to str
        SHA-256 of other files that were read, by what they are.
    """

    title: str
    limits: standards.LimitSet
    robot: RobotFacts
    coverings: Mapping[str, contact.Covering]
    strains: Mapping[str, float | None]
    materials: Mapping[str, str]
    contacts: tuple[Planned, ...]
    human_speed: float
    separation: Mapping[str, Any] | None
    uncertain: Mapping[str, Any]
    draws: int
    seed: int
    allowed_chance: float
    confirmed: Mapping[str, str]
    inputs: Mapping[str, Any]
    files: Mapping[str, str]


@kind.top_level(_TOP)
def load(path: str) -> Cell:
    """Read a cell file.

    Parameters
    ----------
    path : str
        The file, see ``examples/contact_arm.toml``; paths in it are beside it.

    Returns
    -------
    Cell
        Checked.

    Raises
    ------
    InvalidParameterError
        If a file cannot be read or a value breaks a rule; the message names the key.
    """
    place = Path(path)
    given = checked("", files.parsed(place), _TOP, required=("robot",))
    read: dict[str, str] = {}
    limits = _limits(given.get("limits", standards.SETS[0]), place.parent, read)
    with located("robot"):
        robot = robot_of(given["robot"], place.parent)
    if robot.file is not None:
        read["robot"] = str(robot.sha256)
    coverings, strains, materials = _coverings(given, place.parent, read)
    human_speed = given.get("human_speed", 0.0)
    if not 0.0 <= human_speed < 20.0:
        raise InvalidParameterError("human_speed", "be at least 0 and below 20", human_speed)
    contacts = tuple(_contacts(given, limits, coverings, robot))
    uncertain = given.get("uncertain", {})
    draws, seed = given.get("draws", 100_000), given.get("seed", 0)
    if not 1 <= draws <= MOST_DRAWS:
        raise InvalidParameterError("draws", f"be from 1 to {MOST_DRAWS}", draws)
    if not 0 <= seed < 2**63:
        raise InvalidParameterError("seed", "be from 0 to 2^63 - 1", seed)
    allowed_chance = given.get("allowed_chance", ALLOWED_CHANCE)
    if not 0.0 < allowed_chance < 1.0:
        raise InvalidParameterError("allowed_chance", "be above 0 and below 1", allowed_chance)
    separation = separation_of(given.get("separation"))
    defaults: dict[str, Any] = {
        "limits": limits.id,
        "human_speed": human_speed,
        "draws": draws,
        "seed": seed,
        "allowed_chance": allowed_chance,
        "contacts": [_input(each) for each in contacts],
        "coverings": [_numbers(name, pad) | {"max_strain": strains[name]} for name, pad in coverings.items()],
        "robot": {**given["robot"], **robot.inputs},
    }
    if separation is not None:
        defaults["separation"] = separation
    return Cell(
        title=given.get("title", "Contact of a robot with people"),
        limits=limits,
        robot=robot,
        coverings=coverings,
        strains=strains,
        materials=materials,
        contacts=contacts,
        human_speed=human_speed,
        separation=separation,
        uncertain=uncertain,
        draws=draws,
        seed=seed,
        allowed_chance=allowed_chance,
        confirmed=_confirmed(given.get("confirmed", {})),
        inputs=canonical({**given, **defaults}),
        files=read,
    )


def _confirmed(table: Mapping[str, Any]) -> dict[str, str]:
    """Return reasons by code; what was not checked at all cannot be confirmed."""
    found = {}
    for code, reason in table.items():
        path = f"confirmed.{code}"
        if code in NEVER_CONFIRMED:
            raise InvalidParameterError(path, "be left out: nothing is known there", code, "give what is missing")
        found[code] = kind.word(path, reason)
        if not found[code].strip():
            raise InvalidParameterError(path, "say why the doubt does not hold here, and who says so", reason)
    return found


def pad_of(cell: Cell, planned: Planned, covering: str | None) -> contact.Covering | None:
    """Return a covering as a contact meets it: a flat one over the area that the contact gives itself."""
    if covering is None:
        return None
    pad = cell.coverings[covering]
    return replace(pad, area=planned.area) if planned.own_area and pad.shape == "flat" else pad


def canonical(value: Any, path: str = "") -> Any:
    """Return a value as JSON holds it: whole numbers are integers, however they were written."""
    if isinstance(value, Mapping):
        return {str(key): canonical(each, f"{path}.{key}" if path else str(key)) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [canonical(each, f"{path}[{index}]") for index, each in enumerate(value)]
    if isinstance(value, float):
        if not math.isfinite(value):
            raise InvalidParameterError(path, "be finite", value)
        return int(value) if value.is_integer() and abs(value) < 2**53 else value
    if value is None or isinstance(value, (bool, int, str)):
        return value
    raise InvalidParameterError(path, "be a number, a text, a truth value, an array or a table", kind.shown(value))


def _input(planned: Planned) -> dict[str, Any]:
    return {
        "region": planned.limit.region,
        "area_name": planned.limit.area,
        "contact": planned.limit.contact,
        "speed": planned.speed,
        "covering": planned.covering,
        "contact_area": planned.area,
    }


def _numbers(name: str, pad: contact.Covering) -> dict[str, Any]:
    """Return everything that a covering is, defaults included."""
    law = pad.material
    if isinstance(law, contact.StressTable):
        numbers: dict[str, Any] = {"strain": np.asarray(law.strain).tolist(), "stress": np.asarray(law.stress).tolist()}
    else:
        numbers = dict(zip(law.keys.values(), law.numbers, strict=True))
    shape = {each.name: getattr(pad, each.name) for each in fields(pad) if each.name != "material"}
    return {"name": name, "material": {"law": law.law, **numbers}, **shape}


def _limits(given: str, folder: Path, read: dict[str, str]) -> standards.LimitSet:
    """Return a set of limits by name, or of a file beside the cell."""
    if given.lower().endswith((".toml", ".csv")):
        place = folder / given
        with located("limits"):
            found = standards.load_limits(place)
        read["limits"] = _sha256(place)
        return found
    with located("limits"):
        return standards.limits(one_of("name", given, standards.SETS, listed=True))


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def _coverings(
    given: Mapping[str, Any], folder: Path, read: dict[str, str]
) -> tuple[dict[str, contact.Covering], dict[str, float | None], dict[str, str]]:
    catalog: Mapping[str, contact.CatalogMaterial] = {}
    if "catalog" in given:
        with located("catalog"):
            catalog = contact.load_materials(folder / given["catalog"])
        read["catalog"] = _sha256(folder / given["catalog"])
    entries = given.get("coverings", [])
    if len(entries) > MOST_COVERINGS:
        raise InvalidParameterError("coverings", f"be at most {MOST_COVERINGS}", len(entries))
    found: dict[str, contact.Covering] = {}
    strains: dict[str, float | None] = {}
    sources: dict[str, str] = {}
    for index, entry in enumerate(entries):
        path = f"coverings[{index}]"
        values = checked(path, entry, _COVERING, required=("name", "material", "thickness"))
        name = values.pop("name")
        if name in found or not name.strip() or name == NO_COVERING:
            raise InvalidParameterError(f"{path}.name", f"be a name that no other has, and not {NO_COVERING!r}", name)
        if isinstance(values["material"], str):
            known = values["material"]
            if known not in catalog:
                rule = f"name a material of the catalog ({', '.join(catalog) or 'none is given'}), or be a table"
                raise InvalidParameterError(f"{path}.material", rule, known, meant(known, catalog))
            values["material"], sources[name] = catalog[known].law, f"{known}: {catalog[known].source}"
        with located(path):
            strains[name] = values.pop("max_strain", None)
            found[name] = contact.Covering(**values)
    return found, strains, sources


def _contacts(
    given: Mapping[str, Any],
    limits: standards.LimitSet,
    coverings: Mapping[str, contact.Covering],
    robot: RobotFacts,
) -> list[Planned]:
    entries = given.get("contacts")
    if entries is None and robot.kind == "base":
        entries = [{"region": region} for region in BASE_REGIONS]
    if not entries or len(entries) > MOST_CONTACTS:
        rule = f"name 1 to {MOST_CONTACTS} regions, each below [[contacts]]"
        raise InvalidParameterError("contacts", rule, 0 if entries is None else len(entries))
    found: list[Planned] = []
    for index, entry in enumerate(entries):
        path = f"contacts[{index}]"
        values = checked(path, entry, _CONTACT, required=("region",))
        shared = {name: given[name] for name in ("speed", "covering", "contact_area") if name in given}
        found += _classes(path, {**shared, **values}, values, limits, coverings)
    return found


def _classes(
    path: str,
    values: Mapping[str, Any],
    entry: Mapping[str, Any],
    limits: standards.LimitSet,
    coverings: Mapping[str, contact.Covering],
) -> list[Planned]:
    """Return a planned contact in the class that it names, else in both."""
    region = one_of(f"{path}.region", values["region"], limits.regions, listed=True)
    if "speed" not in values:
        raise kind.missing(f"{path}.speed", "give it here or at the top of the file")
    speed = values["speed"]
    if not 0.0 < speed <= 20.0:
        raise InvalidParameterError(f"{path}.speed", "be above 0 and at most 20", speed)
    covering = values.get("covering")
    if covering is not None and covering != NO_COVERING and covering not in coverings:
        rule = f"name a covering ({', '.join(coverings) or 'none is given'}) or be {NO_COVERING!r}"
        raise InvalidParameterError(f"{path}.covering", rule, covering, meant(covering, coverings))
    area = values.get("contact_area")
    if area is not None and not 0.0 < area < 10.0:
        raise InvalidParameterError(f"{path}.contact_area", "be above 0 and below 10", area)
    own_area = "contact_area" in entry
    if own_area and covering not in {None, NO_COVERING} and coverings[covering].shape != "flat":
        rule = f"be left out beside covering {covering!r}, whose area follows from its shape"
        raise InvalidParameterError(f"{path}.contact_area", rule, area)
    classes: tuple[str, ...] = standards.CONTACTS
    if "contact" in values:
        classes = (one_of(f"{path}.contact", values["contact"], standards.CONTACTS),)
    with located(path):
        return [
            Planned(
                limit=limits.contact(region, each, area=values.get("area_name")),
                speed=speed,
                covering=None if covering == NO_COVERING else covering,
                area=area,
                own_area=own_area,
            )
            for each in classes
        ]
