"""A limit of contact: what a region of the body may bear, and what is known about the number."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, number, numbers
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import RANGES, ImplausibleWarning, ResultWarning, implausible, issue
from hrsafety.standards.verdicts import doubted, strictest

__all__ = ["CERTAINTIES", "CONTACTS", "ContactLimit", "Quantity", "Verdict"]

CONTACTS = ("quasi_static", "transient")
"""Clamped: the region cannot give way. Transient: it is free to."""

CERTAINTIES = ("certain", "likely", "single_source", "not_stated")
"""How sure a number is; only the first one goes without saying."""

AREAS = (1e-5, 0.01)
"""Force over pressure of one contact, in m^2: a tip of 3.5 mm to the largest part of a body that a covering meets."""

Words = npt.NDArray[np.str_]


@displayed
class Quantity(NamedTuple):
    """A number with what is known about it.

    Attributes
    ----------
    value : float
        The number, in SI units.
    certainty : str
        One of ``certain``, ``likely``, ``single_source``, ``not_stated``.
    sources : tuple of str
        Where it was read.
    """

    value: float
    certainty: str
    sources: tuple[str, ...]


class _Words(NamedTuple):
    """Words of a verdict."""

    overall: str
    force: str
    pressure: str


@displayed
class Verdict(_Words):
    """Verdict on a force and a pressure against a limit.

    Attributes
    ----------
    overall : str
        ``not_permitted``, ``exceeds``, ``not_checked`` or ``within_limits``: the first of them that holds.
    force, pressure : str
        The same for each of both.
    warnings : tuple of ResultWarning
        Doubts for which a load is not checked: none is given, or one that is hardly meant in its unit.
    """

    warnings: tuple[ResultWarning, ...] = ()


@displayed
@dataclass(frozen=True, slots=True)
class ContactLimit:
    """Limits of a region of the body in one class of contact.

    Parameters
    ----------
    region : str
        The region, for example ``"chest"``.
    area : str or None
        The area within it whose pressure counts, if one was named.
    contact : {"quasi_static", "transient"}
        Class of contact.
    permitted : bool
        Whether contact is permitted at all: transient contact of head and face is not.
    force_limit, pressure_limit : Quantity or None
        Limits in N and Pa; ``None`` where there is none, which is not checked and never counts as kept.
    spring, mass : Quantity or None
        Spring constant of the region in N/m and its effective mass in kg.
    pressure_area : str or None
        The area that the pressure limit belongs to.
    set_id, edition, title : str
        The set that it is from.

    Examples
    --------
    >>> from hrsafety import standards
    >>> limit = standards.limits().contact("chest", "transient")
    >>> limit.force, limit.status
    (280.0, 'limited')
    >>> standards.limits().contact("face", "transient").status
    'not_permitted'
    """

    region: str
    area: str | None
    contact: str
    permitted: bool
    force_limit: Annotated[Quantity | None, "N"]
    pressure_limit: Annotated[Quantity | None, "Pa"]
    spring: Annotated[Quantity | None, "N/m"]
    mass: Quantity | None
    pressure_area: str | None
    set_id: str
    edition: str
    title: str

    @property
    def status(self) -> str:
        """``"limited"``, ``"not_permitted"``, or ``"not_checked"`` where the set has no number at all."""
        if not self.permitted:
            return "not_permitted"
        return "not_checked" if self.force_limit is None and self.pressure_limit is None else "limited"

    @property
    def force(self) -> float | None:
        """Force limit in N, ``None`` where there is none."""
        return None if self.force_limit is None else self.force_limit.value

    @property
    def pressure(self) -> float | None:
        """Pressure limit in Pa, ``None`` where there is none."""
        return None if self.pressure_limit is None else self.pressure_limit.value

    @property
    def spring_constant(self) -> float | None:
        """Spring constant of the region in N/m, ``None`` where it is not known."""
        return None if self.spring is None else self.spring.value

    @property
    def body_mass(self) -> float | None:
        """Effective mass of the region in kg, inf where it is clamped, ``None`` where it is not known."""
        if self.contact == "quasi_static":
            return math.inf
        return None if self.mass is None else self.mass.value

    @property
    def certainty(self) -> dict[str, str]:
        """Certainty of every number that there is, by quantity."""
        known = {
            "force": self.force_limit,
            "pressure": self.pressure_limit,
            "spring_constant": self.spring,
            "effective_mass": self.mass,
        }
        return {name: quantity.certainty for name, quantity in known.items() if quantity is not None}

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes beside the numbers: the edition, every certainty below certain, missing values."""
        lines = [f"{self.title}, edition {self.edition}"]
        lines += [f"{name}: {word}" for name, word in self.certainty.items() if word != "certain"]
        if not self.permitted:
            return (*lines, f"{self.contact} contact of {self.region} is not permitted: there is no limit to keep")
        for name, quantity in (("force", self.force_limit), ("pressure", self.pressure_limit)):
            if quantity is None:
                lines.append(f"{name}: not_checked, the set has no limit")
        return tuple(lines)

    def __str__(self) -> str:
        """Return the limit in one line with its set, edition and certainties."""
        force = "force not_checked" if self.force is None else f"{self.force:g} N"
        pressure = "pressure not_checked" if self.pressure is None else f"{self.pressure / 1e4:g} N/cm2"
        numbers = "not_permitted" if not self.permitted else f"{force}, {pressure}"
        place = self.region if self.area is None else f"{self.region} ({self.area})"
        return f"{place}, {self.contact}: {numbers} [{'; '.join(self.notes)}]"

    # ---- judging --------------------------------------------------------------------------------

    def force_verdict(self, force: object) -> Words:
        """Return what forces mean.

        Parameters
        ----------
        force : array_like
            Peak forces in N; inf is a force.

        Returns
        -------
        ndarray of str
            ``within_limits``, ``exceeds``, ``not_permitted`` or ``not_checked``.

        Warns
        -----
        ImplausibleWarning
            If the largest force is hardly meant in N; none is within limits then.
        """
        self._warn("force", force)
        return self._verdicts("force", force, self.force)

    def pressure_verdict(self, pressure: object) -> Words:
        """Return what pressures mean.

        Parameters
        ----------
        pressure : array_like
            Peak pressures in Pa; inf is a pressure.

        Returns
        -------
        ndarray of str
            ``within_limits``, ``exceeds``, ``not_permitted`` or ``not_checked``.

        Warns
        -----
        ImplausibleWarning
            If the largest pressure is hardly meant in Pa; none is within limits then.
        """
        self._warn("pressure", pressure)
        return self._verdicts("pressure", pressure, self.pressure)

    def force_margin(self, force: object) -> Array | None:
        """Return which share of the force limit is left, negative beyond it.

        Parameters
        ----------
        force : array_like
            Peak forces in N.

        Returns
        -------
        ndarray or None
            Shares; ``None`` where contact is not permitted or the set has no force limit.
        """
        given = _loads("force", force)
        return None if self.force is None or not self.permitted else np.asarray(1.0 - given / self.force)

    def verdict(self, *, force: float | None = None, pressure: float | None = None) -> Verdict:
        """Return what a force and a pressure mean together.

        Parameters
        ----------
        force : float or None
            Peak force in N; without it the force is not checked.
        pressure : float or None
            Peak pressure in Pa; without it the pressure is not checked.

        Returns
        -------
        Verdict
            A limit that was not checked never counts as kept.

        Examples
        --------
        >>> from hrsafety import standards
        >>> standards.limits().contact("chest", "transient").verdict(force=100.0)
        Verdict(overall='not_checked', force='within_limits', pressure='not_checked')
        warning: no pressure is given: its limit is not checked
        """
        missing = "not_checked" if self.permitted else "not_permitted"
        words, doubts = [], []
        for name, load, limit in (("force", force, self.force), ("pressure", pressure, self.pressure)):
            if load is None:
                words.append(missing)
                doubts += [ResultWarning("not_checked", name, f"no {name} is given: its limit is not checked")]
                continue
            given = number(name, load)
            words.append(str(self._verdicts(name, given, limit)))
            doubts += _doubts(name, given)
            if limit is None and self.permitted:
                doubts.append(ResultWarning("not_checked", name, f"the set has no limit of {name}: it is not checked"))
        if force and pressure and not doubts and (odd := _odd_pair(float(force), float(pressure))):
            doubts += odd
            words = [doubted(word, odd) for word in words]
        found = Verdict(strictest(words), *words)
        found.warnings = tuple(doubts) if self.permitted else ()
        return found

    def _warn(self, name: str, given: object) -> None:
        """Issue the doubts about loads that end in words without any."""
        for doubt in _doubts(name, _loads(name, given)) if self.permitted else ():
            issue(doubt.message, ImplausibleWarning, stacklevel=3)

    def _verdicts(self, name: str, given: object, limit: float | None) -> Words:
        loads = _loads(name, given)
        if not self.permitted:
            return np.full(loads.shape, "not_permitted")
        if limit is None:
            return np.full(loads.shape, "not_checked")
        return np.where(loads <= limit, doubted("within_limits", _doubts(name, loads)), "exceeds")


def _odd_pair(force: float, pressure: float) -> tuple[ResultWarning, ...]:
    """Return the doubt about a force and a pressure that no contact area fits."""
    least, most = AREAS
    area = force / pressure
    if least <= area <= most or not math.isfinite(area):
        return ()
    message = (
        f"force and pressure belong to a contact of {area:.3g} m^2, outside the plausible {least:g} to {most:g} m^2: "
        "kN given for N, or N/cm^2, N/mm^2 or kPa for Pa?"
    )
    return (ResultWarning("implausible", "force", message),)


def _doubts(name: str, given: object) -> tuple[ResultWarning, ...]:
    """Return the doubts about loads: of a history the largest one counts, for it starts and ends near 0."""
    loads = np.asarray(given)
    largest = float(np.max(loads[np.isfinite(loads)], initial=0.0))
    if loads.size and not (loads > 0.0).any():
        message = f"{name} is 0: nothing was touched, or nothing was measured; what was not measured is not kept"
        return (ResultWarning("no_push", name, message),)
    found = implausible({name: largest} if largest > 0.0 else {}, {name: f"load_{name}"})
    return tuple(replace(each, safe_side=largest > RANGES[f"load_{name}"].most) for each in found)


def _loads(name: str, given: object) -> Array:
    loads = numbers(name, given)
    if np.isnan(loads).any() or (loads < 0.0).any():
        bad = loads[np.isnan(loads) | (loads < 0.0)].flat[0]
        raise InvalidParameterError(name, "be at least 0", float(bad))
    return loads
