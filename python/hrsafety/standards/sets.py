"""Sets of limits that ship with the package, and those of the user."""

from __future__ import annotations

import os
from pathlib import Path

from hrsafety._arguments import meant
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.standards.contact_limits import ContactLimit
from hrsafety.standards.limit_sets import SQUARE_CENTIMETER, LimitSet
from hrsafety.standards.shipped import SETS, shipped
from hrsafety.standards.user_sets import SUFFIXES, load_limits

__all__ = ["SETS", "above_published", "limits"]


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


def above_published(limit: ContactLimit) -> tuple[ResultWarning, ...]:
    """Return the doubts about limits of the user that are higher than those that ship with the package.

    Parameters
    ----------
    limit : ContactLimit
        Of any set.

    Returns
    -------
    tuple of ResultWarning
        One for a force and one for a pressure, none where the package knows no such region.
    """
    published = shipped(SETS[0])
    if limit.set_id in SETS or limit.region not in published.regions or not limit.permitted:
        return ()
    rows = [row for row in published.rows if (row.region, row.contact) == (limit.region, limit.contact)]
    found = []
    for name, own, unit, scale in (
        ("force", limit.force, "N", 1.0),
        ("pressure", limit.pressure, "N/cm2", SQUARE_CENTIMETER),
    ):
        # Names of areas are the user's: the one that bears most counts.
        known = [getattr(row, name).value for row in rows if getattr(row, name) is not None and row.permitted]
        if own is None or (known and own <= max(known)):
            continue
        says = f"at most {max(known) * scale:g} {unit}" if known else "that no such contact is permitted"
        if known or any(not row.permitted for row in rows):
            message = (
                f"{name} is {own * scale:g} {unit} for {limit.region}, {limit.contact}: {published.title} says {says}; "
                "with numbers that are too high every speed is"
            )
            found.append(ResultWarning("above_published", f"limits.{name}", message))
    return tuple(found)
