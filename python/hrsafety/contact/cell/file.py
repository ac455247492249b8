"""Cell files: TOML in, a robot, its coverings and the contacts that are planned out."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import Any

from hrsafety import _keys as kind
from hrsafety._keys import Keys, checked, located, one_of, parsed
from hrsafety._words import meant
from hrsafety.contact.catalogs import CatalogMaterial, load_materials, material_beside
from hrsafety.contact.cell.cell import (
    MOST_CONTACTS,
    MOST_COVERINGS,
    NO_COVERING,
    Cell,
    PlannedContact,
    checked_fit,
)
from hrsafety.contact.cell.robot import ContactRobot, robot_of
from hrsafety.contact.covering import Covering
from hrsafety.contact.drive import drive_of
from hrsafety.errors import InvalidParameterError
from hrsafety.standards.contact_limits import CONTACTS
from hrsafety.standards.limit_sets import LimitSet
from hrsafety.standards.sets import SETS
from hrsafety.standards.sets import limits as limit_set
from hrsafety.standards.user_sets import load_limits

__all__ = ["BASE_REGIONS", "coverings_of", "limits_of_file", "load_cell"]

_PLAIN = ("title", "human_speed", "separation", "uncertain", "draws", "seed", "allowed_chance", "confirmed", "annex")
"""Keys that are arguments of a cell as they are."""
BASE_REGIONS = ("lower_leg", "thigh_knee")
"""Regions that a mobile base meets, unless the file names others."""

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
        "drive": kind.table,
        "uncertain": kind.table,
        "draws": kind.integer,
        "seed": kind.integer,
        "allowed_chance": kind.number,
        "confirmed": kind.table,
        "annex": kind.table,
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


@kind.top_level(_TOP)
def load_cell(path: str | PathLike[str]) -> Cell:
    r"""Read a cell file.

    Parameters
    ----------
    path : path-like
        The file, see ``examples/contact_arm.toml``; paths in it are beside it.

    Returns
    -------
    Cell
        Checked.

    Raises
    ------
    InvalidParameterError
        If a file cannot be read or a value breaks a rule; the message names the key.

    Examples
    --------
    >>> from pathlib import Path
    >>> from hrsafety import contact
    >>> text = 'speed = 0.2\n[robot]\nmass = 8.0\n[[contacts]]\nregion = "chest"\ncontact = "transient"\n'
    >>> _ = Path("cell.toml").write_text(text)
    >>> contact.load_cell("cell.toml").contacts[0].limit.force
    280.0
    """
    if not isinstance(path, (str, PathLike)):
        raise InvalidParameterError("path", "be a path", path)
    place = Path(path)
    given = checked("", parsed(place), _TOP, required=("robot",))
    read: dict[str, str] = {}
    limits = limits_of_file(given.get("limits", SETS[0]), place.parent, read)
    drive = drive_of(given["drive"]) if "drive" in given else None
    with located("robot"):
        robot = robot_of(given["robot"], place.parent, None if drive is None else drive.joint_torques)
    if robot.file is not None:
        read["robot"] = str(robot.sha256)
    coverings, strains, materials = coverings_of(given, place.parent, read)
    return Cell(
        robot=robot,
        contacts=tuple(_contacts(given, limits, coverings, robot)),
        limits=limits,
        coverings=coverings,
        strains=strains,
        materials=materials,
        drive=drive,
        **{name: given[name] for name in _PLAIN if name in given},
        given=given,
        files=read,
    )


def limits_of_file(given: str, folder: Path, read: dict[str, str]) -> LimitSet:
    """Return a set of limits by name, or of a file beside the cell."""
    if given.lower().endswith((".toml", ".csv")):
        place = folder / given
        with located("limits"):
            found = load_limits(place)
        read["limits"] = _sha256(place)
        return found
    with located("limits"):
        return limit_set(one_of("name", given, SETS, listed=True))


def _sha256(path: Path) -> str:
    return hashlib.sha256(path.read_bytes()).hexdigest()


def coverings_of(
    given: Mapping[str, Any], folder: Path, read: dict[str, str]
) -> tuple[dict[str, Covering], dict[str, float | None], dict[str, str]]:
    """Return the coverings of a file by name, the largest strain of each, and the source of its material."""
    catalog: Mapping[str, CatalogMaterial] = {}
    if "catalog" in given:
        with located("catalog"):
            catalog = load_materials(folder / given["catalog"])
        read["catalog"] = _sha256(folder / given["catalog"])
    entries = given.get("coverings", [])
    if len(entries) > MOST_COVERINGS:
        raise InvalidParameterError("coverings", f"be at most {MOST_COVERINGS}", len(entries))
    found: dict[str, Covering] = {}
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
            if isinstance(values["material"], Mapping):
                test = values["material"].get("file")
                values["material"] = material_beside(values["material"], folder)
                if test is not None:
                    read[f"compression test of {name}"] = _sha256(folder / test)
            strains[name] = values.pop("max_strain", None)
            found[name] = Covering(**values)
    return found, strains, sources


def _contacts(
    given: Mapping[str, Any],
    limits: LimitSet,
    coverings: Mapping[str, Covering],
    robot: ContactRobot,
) -> list[PlannedContact]:
    entries = given.get("contacts")
    if entries is None and robot.kind == "base":
        entries = [{"region": region} for region in BASE_REGIONS]
    if not entries or len(entries) > MOST_CONTACTS:
        rule = f"name 1 to {MOST_CONTACTS} regions, each below [[contacts]]"
        raise InvalidParameterError("contacts", rule, 0 if entries is None else len(entries))
    found: list[PlannedContact] = []
    for index, entry in enumerate(entries):
        path = f"contacts[{index}]"
        values = checked(path, entry, _CONTACT, required=("region",))
        shared = {name: given[name] for name in ("speed", "covering", "contact_area") if name in given}
        covered = values.get("contact_area")
        if covered is not None and {**shared, **values}.get("covering", NO_COVERING) != NO_COVERING:
            # Beside the covering a contact may touch more than bare, which would flatter the bare one.
            values["contact_area"] = given.get("contact_area")
        found += _classes(path, {**shared, **values}, covered, limits, coverings)
    return found


def _classes(
    path: str,
    values: Mapping[str, Any],
    covered_area: float | None,
    limits: LimitSet,
    coverings: Mapping[str, Covering],
) -> list[PlannedContact]:
    """Return a planned contact in the class that it names, else in both."""
    region = one_of(f"{path}.region", values["region"], limits.regions, listed=True)
    if "speed" not in values:
        raise kind.missing(f"{path}.speed", "give it here or at the top of the file")
    covering = None if values.get("covering") == NO_COVERING else values.get("covering")
    checked_fit(path, covering, covered_area, coverings)
    classes: tuple[str, ...] = CONTACTS
    if "contact" in values:
        classes = (one_of(f"{path}.contact", values["contact"], CONTACTS),)
    with located(path):
        return [
            PlannedContact(
                limit=limits.contact(region, each, area=values.get("area_name")),
                speed=values["speed"],
                covering=covering,
                area=values.get("contact_area"),
                covered_area=covered_area,
            )
            for each in classes
        ]
