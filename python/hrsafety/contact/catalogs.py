"""Catalogs of materials: the user's own laws of stress over strain, in one file with their sources."""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType
from typing import Any, NamedTuple

from hrsafety._arguments import number, readable
from hrsafety._display import displayed
from hrsafety._words import meant
from hrsafety.contact.compression import compression_test
from hrsafety.contact.materials import Material, material
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["CatalogMaterial", "load_materials", "material_beside"]

MOST_BYTES = 2**22
MOST_MATERIALS = 1000
_WORDS = ("name", "source", "note")
_OF_TEST = ("law", "file", "thickness", "area", "loading")


@displayed
class CatalogMaterial(NamedTuple):
    """A material of a catalog.

    Attributes
    ----------
    name : str
        By which a covering names it.
    source : str
        Where its numbers come from: a test, a data sheet.
    note : str
        What else has to be said.
    law : Material
        Stress over strain.
    """

    name: str
    source: str
    note: str
    law: Material


def load_materials(path: str | os.PathLike[str]) -> Mapping[str, CatalogMaterial]:
    r"""Read a catalog of materials.

    Parameters
    ----------
    path : path-like
        A TOML file with a table ``[[materials]]`` for each: ``name``, ``source``, ``law`` and the numbers of
        the law as in `contact.material`, in Pa; ``note`` if wanted. A table may name a compression test in place of
        its points: ``law = "table"``, ``file``, and what `load_compression_test` takes beside it.

    Returns
    -------
    mapping of str to CatalogMaterial
        By name, in the order of the file.

    Raises
    ------
    InvalidParameterError
        If the file cannot be read, a key is unknown, a number is out of its range, a material has no source,
        or two have one name; the message names the material.

    Examples
    --------
    >>> from pathlib import Path
    >>> from hrsafety import contact
    >>> text = '[[materials]]\nname = "grey foam"\nsource = "press, 2026-03"\nlaw = "linear"\nE = 1.2e5\n'
    >>> _ = Path("foams.toml").write_text(text)
    >>> contact.load_materials("foams.toml")["grey foam"].law
    Linear(modulus=120000.0)
    """
    place = readable("path", path)
    size = place.stat().st_size
    if size > MOST_BYTES:
        raise InvalidParameterError(place.name, f"have at most {MOST_BYTES} bytes", size)
    try:
        data = tomllib.loads(place.read_text(encoding="utf-8-sig"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError) as error:
        raise InvalidParameterError(place.name, "be TOML in UTF-8", Shown(str(error)[:200])) from None
    for key in data:
        if key != "materials":
            raise InvalidParameterError(place.name, "have the table [[materials]] and nothing else", key)
    entries = data.get("materials", [])
    if not isinstance(entries, list) or not 0 < len(entries) <= MOST_MATERIALS:
        rule = f"name 1 to {MOST_MATERIALS} materials, each below [[materials]]"
        raise InvalidParameterError(f"{place.name}: materials", rule, Shown(f"{type(entries).__name__}"))
    found: dict[str, CatalogMaterial] = {}
    for index, entry in enumerate(entries):
        read = _material(f"{place.name}: materials[{index}]", entry, place.parent)
        if read.name in found:
            raise InvalidParameterError(f"{place.name}: materials[{index}].name", "differ from the others", read.name)
        found[read.name] = read
    return MappingProxyType(found)


def material_beside(given: Mapping[str, Any], folder: Path) -> Material:
    """Return a law from the table of a file; a compression test that it names lies beside that file."""
    if "file" not in given:
        return material(given)
    for key in given:
        if key not in _OF_TEST:
            raise InvalidParameterError("material", f"have no keys but {', '.join(_OF_TEST)} with a file", key)
    if given.get("law") != "table":
        raise InvalidParameterError("material.law", 'be "table" with a file', given.get("law"))
    if not isinstance(given["file"], str):
        raise InvalidParameterError("material.file", "be a text in quotes", given["file"])
    sizes = {name: number(f"material.{name}", given[name]) for name in ("thickness", "area") if name in given}
    return compression_test(folder / given["file"], **sizes, loading=given.get("loading"))


def _material(where: str, entry: Any, folder: Path) -> CatalogMaterial:
    if not isinstance(entry, dict):
        raise InvalidParameterError(where, "be a table", Shown(type(entry).__name__))
    words = {}
    for name in _WORDS:
        given = entry.get(name, "")
        if not isinstance(given, str) or (name != "note" and not given.strip()):
            raise InvalidParameterError(f"{where}.{name}", "be a text in quotes", Shown(repr(given)[:80]))
        words[name] = given
    law = {key: value for key, value in entry.items() if key not in _WORDS}
    if "law" not in law:
        raise InvalidParameterError(f"{where}.law", "be given", Shown("nothing"), meant("law", entry))
    try:
        return CatalogMaterial(words["name"], words["source"], words["note"], material_beside(law, folder))
    except InvalidParameterError as error:
        raise error.renamed(f"{where} ({words['name']!r}): {error.argument}") from None
