"""A set of limits of contact with its edition."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np

from hrsafety._arguments import flag, instance, positive, word
from hrsafety._records import dataclass
from hrsafety.standards.contact_limits import CONTACTS, ContactLimit, Quantity
from hrsafety.tables import Columns, Table

__all__ = ["LimitRow", "LimitSet"]

SQUARE_CENTIMETER = 1e-4
MILLIMETER = 1e-3


@dataclass(frozen=True, slots=True)
class LimitRow:
    """One row of a set: a region, or an area of it, in one class of contact.

    Parameters
    ----------
    region : str
        The region.
    area : str or None
        The area; ``None`` for what holds for the whole region.
    contact : {"quasi_static", "transient"}
        Class of contact.
    permitted : bool
        Whether contact is permitted at all.
    force, pressure, spring_constant, effective_mass : Quantity or None
        Numbers in N, Pa, N/m and kg.
    """

    region: str
    area: str | None
    contact: str
    permitted: bool = True
    force: Quantity | None = None
    pressure: Quantity | None = None
    spring_constant: Quantity | None = None
    effective_mass: Quantity | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        instance("region", self.region, str)
        if self.area is not None:
            instance("area", self.area, str)
        word("contact", self.contact, CONTACTS)
        flag("permitted", self.permitted)
        for name in ("force", "pressure", "spring_constant", "effective_mass"):
            given = getattr(self, name)
            if given is not None:
                positive(name, instance(name, given, Quantity).value)


@dataclass(frozen=True, slots=True, repr=False)
class LimitSet(Table):
    """Limits of contact for the regions of the body.

    Parameters
    ----------
    id : str
        Name of the set.
    title, edition : str
        What it is, and of when.
    note : str
        What else has to be said about it.
    rows : tuple of LimitRow
        All rows.
    sources : dict of str to str
        What the tags of the sources stand for.

    Examples
    --------
    >>> from hrsafety import standards
    >>> iso = standards.limits("iso_ts_15066_2016")
    >>> len(iso.regions), len(iso.areas())
    (12, 29)
    >>> print(iso.contact("pelvis", "quasi_static"))
    pelvis, quasi_static: 180 N, 210 N/cm2 [ISO/TS 15066:2016, Annex A, edition 2016; force: single_source; pressure: single_source]
    """  # noqa: E501  # the line that is printed

    id: str
    title: str
    edition: str
    note: str
    rows: tuple[LimitRow, ...]
    sources: dict[str, str]

    def __post_init__(self) -> None:
        """Check the values."""
        for name in ("id", "title", "edition", "note"):
            instance(name, getattr(self, name), str)
        for index, row in enumerate(instance("rows", self.rows, tuple)):
            instance(f"rows[{index}]", row, LimitRow)
        instance("sources", self.sources, dict)

    @property
    def regions(self) -> tuple[str, ...]:
        """Names of the regions in the order of the set."""
        return tuple(dict.fromkeys(row.region for row in self.rows))

    def areas(self, region: str | None = None) -> tuple[str, ...]:
        """Return the names of areas.

        Parameters
        ----------
        region : str or None
            Of this region only.

        Returns
        -------
        tuple of str
            In the order of the set.
        """
        if region is not None:
            word("region", region, self.regions)
        rows = (row for row in self.rows if row.area is not None and region in {None, row.region})
        return tuple(dict.fromkeys(row.area for row in rows if row.area is not None))

    def contact(self, region: str, contact: str = "transient", *, area: str | None = None) -> ContactLimit:
        """Return what a region may bear.

        Parameters
        ----------
        region : str
            One of `regions`.
        contact : {"transient", "quasi_static"}
            Class of contact; clamped is ``"quasi_static"``.
        area : str or None
            One of its areas, by its name with or without the side of the body. Without it, and where a name fits
            several, the smallest pressure counts.

        Returns
        -------
        ContactLimit
            The limit; numbers that the set does not have are ``None`` there, and ``not_checked``.
        """
        word("region", region, self.regions)
        word("contact", contact, CONTACTS)
        if area is not None:
            instance("area", area, str)
        of_region = [row for row in self.rows if row.region == region]
        chosen = of_region if area is None else self._of_area(of_region, area)
        whole = [row for row in of_region if row.area is None]
        rows = [row for row in chosen if row.contact == contact]
        general = [row for row in whole if row.contact == contact]
        force = _least(row.force for row in rows) or _least(row.force for row in general)
        pressure = _least(row.pressure for row in rows) or _least(row.pressure for row in general)
        governing = [row.area for row in rows if row.pressure is not None and row.pressure == pressure]
        return ContactLimit(
            region=region,
            area=area,
            contact=contact,
            permitted=all(row.permitted for row in (*rows, *general)),
            force_limit=force,
            pressure_limit=pressure,
            spring=next((row.spring_constant for row in of_region if row.spring_constant), None),
            mass=next((row.effective_mass for row in of_region if row.effective_mass), None),
            pressure_area=governing[0] if governing else None,
            set_id=self.id,
            edition=self.edition,
            title=self.title,
        )

    def _of_area(self, rows: list[LimitRow], area: str) -> list[LimitRow]:
        exact = [row for row in rows if row.area == area]
        if exact:
            return exact
        of_name = [row for row in rows if row.area is not None and row.area.partition(", ")[0] == area]
        if not of_name:
            word("area", area, self.areas(rows[0].region))
        return of_name

    def columns(self) -> Columns:
        """Return the table as columns.

        Returns
        -------
        dict of str to ndarray
            One row for each row of the set, with certainty and sources of every number; NaN where there is none.
        """
        rows = self.rows
        table: Columns = {
            "region": np.array([row.region for row in rows]),
            "area": np.array([row.area or "" for row in rows]),
            "contact": np.array([row.contact for row in rows]),
            "permitted": np.array([row.permitted for row in rows]),
        }
        scales = {
            "force_N": ("force", 1.0),
            "pressure_N_per_cm2": ("pressure", SQUARE_CENTIMETER),
            "spring_constant_N_per_mm": ("spring_constant", MILLIMETER),
            "effective_mass_kg": ("effective_mass", 1.0),
        }
        for column, (name, scale) in scales.items():
            found: list[Quantity | None] = [getattr(row, name) for row in rows]
            table[column] = np.array([np.nan if each is None else each.value * scale for each in found])
            table[f"{name}_certainty"] = np.array(["" if each is None else each.certainty for each in found])
            table[f"{name}_sources"] = np.array(["" if each is None else ", ".join(each.sources) for each in found])
        table["set"] = np.array([self.id] * len(rows))
        table["edition"] = np.array([self.edition] * len(rows))
        return table


def _least(found: Iterable[Quantity | None]) -> Quantity | None:
    return min((each for each in found if each is not None), key=lambda each: each.value, default=None)
