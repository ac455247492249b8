"""Sets of limits that ship with the package, and those of the user."""

from __future__ import annotations

import os
from pathlib import Path

from hrsafety._arguments import meant
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.standards.contact_limits import ContactLimit
from hrsafety.standards.limit_sets import LimitSet
from hrsafety.standards.shipped import SETS, shipped
from hrsafety.standards.user_sets import SUFFIXES, load_limits

__all__ = ["SETS", "limits", "looser_than_published"]


def limits(name_or_path: str | os.PathLike[str] = SETS[0]) -> LimitSet:
    """Return a set of limits of contact.

    Parameters
    ----------
    name_or_path : str or path-like
        One of `SETS`, or a TOML or CSV file of the user (see `template`).

    Returns
    -------
    LimitSet
        The set.

    Raises
    ------
    InvalidParameterError
        If there is no such set, or the file breaks a rule; the message names the row.

    Examples
    --------
    >>> from hrsafety import standards
    >>> standards.limits().edition
    '2016'
    """
    if isinstance(name_or_path, str) and name_or_path in SETS:
        return shipped(name_or_path)
    if not isinstance(name_or_path, (str, os.PathLike)) or Path(name_or_path).suffix.lower() not in SUFFIXES:
        rule = f"be {' or '.join(SETS)}, or a file that ends in {' or '.join(SUFFIXES)}"
        raise InvalidParameterError("name_or_path", rule, name_or_path, meant(name_or_path, SETS))
    return load_limits(name_or_path)


def looser_than_published(limit: ContactLimit) -> tuple[ResultWarning, ...]:
    """Return the doubts about numbers of the user that allow more than those that ship with the package.

    Parameters
    ----------
    limit : ContactLimit
        Of any set.

    Returns
    -------
    tuple of ResultWarning
        One for each number, none where the package knows no such region. An area that it does not know is compared with
        the weakest one of the region.
    """
    base = shipped(SETS[0])
    if limit.set_id in SETS or limit.region not in base.regions or not limit.permitted:
        return ()
    names = {name for each in base.areas(limit.region) for name in (each, each.partition(", ")[0])}
    published = base.contact(limit.region, limit.contact, area=limit.area if limit.area in names else None)
    where = f"{limit.region}, {limit.contact}: {published.title} has"
    if not published.permitted:
        message = f"contact is permitted for {where} no such contact; a speed for it is on the user's account"
        return (ResultWarning("looser_than_published", "limits", message),)
    found = []
    for name, own, theirs, unit, looser in (
        ("force", limit.force, published.force, "N", "higher"),
        ("pressure", limit.pressure, published.pressure, "Pa", "higher"),
        ("spring_constant", limit.spring_constant, published.spring_constant, "N/m", "lower"),
        ("effective_mass", limit.body_mass, published.body_mass, "kg", "lower"),
    ):
        if own is not None and theirs is not None and (own > theirs if looser == "higher" else own < theirs):
            message = f"{name} is {own:g} {unit} for {where} {theirs:g} {unit}; a {looser} number allows higher speeds"
            found.append(ResultWarning("looser_than_published", f"limits.{name}", message))
    return tuple(found)
