"""A clamped part of a body at rest under a force: covering and region in series, and what they store."""

from __future__ import annotations

import math
from typing import NamedTuple

from hrsafety import _hrsafety
from hrsafety.contact.contact import Contact
from hrsafety.contact.covering import Covering
from hrsafety.contact.rows import Prepared, in_order
from hrsafety.errors import InvalidParameterError

__all__ = ["Loads", "Pressed", "pressed_of"]

ROUNDS = 200
NEAR = 4e-16


class Loads(NamedTuple):
    """Loads of a contact: force in N, pressure in Pa, strain of the covering; NaN where there is none."""

    force: float
    pressure: float
    strain: float


class Pressed(NamedTuple):
    """Covering and region in series on a support that does not yield, with the limits of the contact.

    Attributes
    ----------
    stiffness : float
        Of the region in N/m.
    pad : Covering or None
        The covering.
    area : float
        Of a bare contact in m^2, NaN if it is not given.
    force, pressure, strain : float
        Limits, inf where there is none.
    row : tuple of dict and list
        The covering as the core reads it.
    """

    stiffness: float
    pad: Covering | None
    area: float
    force: float
    pressure: float
    strain: float
    row: tuple[dict[str, object], list[float]]

    def depth(self, force: float) -> float:
        """Return the compression of the covering at a force, inf beyond its law."""
        return 0.0 if self.pad is None else self._where(lambda depth: self._resists(depth) - force)

    def way(self, force: float) -> float:
        """Return how far covering and region yield to a force, in m."""
        return self.depth(force) + force / self.stiffness

    def at(self, way: float) -> Loads:
        """Return the loads at rest where both yield by a way; inf beyond the law of the covering."""
        if self.pad is None:
            return self._loads(self.stiffness * way, 0.0)
        if math.isinf(way):
            return Loads(math.inf, math.inf, math.inf)
        depth = self._where(lambda depth: depth + self._resists(depth) / self.stiffness - way)
        # On a plateau the rest of the way tells the force better.
        force = self._resists(depth)
        return self._loads(force if math.isinf(force) else min(force, self.stiffness * way), depth)

    def pushed(self, energy: float, push: float) -> Loads:
        """Return the loads where an energy and a constant push are all stored: W(F) = energy + push x(F)."""
        if self.pad is None:
            force = push + math.sqrt(push**2 + 2.0 * self.stiffness * energy)
            return self._loads(force, 0.0)
        depth = self._where(lambda depth: self._stored(depth) - energy - push * self._way_at(depth), self.depth(push))
        return self._loads(self._resists(depth), depth)

    def stored(self, force: float) -> float:
        """Return the energy of both at a force in J."""
        return self._stored(self.depth(force)) if self.pad is not None else 0.5 * force**2 / self.stiffness

    def limit(self) -> tuple[float, str]:
        """Return the lowest force in N at which a limit is reached and its name; inf and ``"nothing"`` without any."""
        if self.pad is None:
            found = {"force": self.force, "pressure": self.pressure * self.area}
        else:
            depths = {
                "pressure": self._where(lambda depth: self._pressure(depth) - self.pressure),
                "strain": self.strain * self.pad.thickness,
            }
            depths = {name: min(depth, self.pad.thickness) for name, depth in depths.items() if math.isfinite(depth)}
            found = {"force": self.force} | {name: self._resists(depth) for name, depth in depths.items()}
        forces = {name: force for name, force in found.items() if math.isfinite(force)}
        least = min(forces, key=lambda name: forces[name], default="nothing")
        return forces.get(least, math.inf), least

    def share(self, loads: Loads) -> tuple[float, str]:
        """Return the largest load over its limit, and which one."""
        found = {
            name: load / most
            for name, load, most in zip(Loads._fields, loads, (self.force, self.pressure, self.strain), strict=True)
            if math.isfinite(most) and not math.isnan(load)
        }
        worst = max(found, key=lambda name: found[name], default="nothing")
        return found.get(worst, 0.0), worst

    def hurried(self, loads: Loads, speed: float) -> Loads:
        """Return bounds of loads that rise with the speed of the compression, at its largest one."""
        if self.pad is None or (self.pad.rate[:2] == (0.0, 0.0) and self.pad.damping == 0.0):
            return loads
        base, slope, reference = self.pad.rate
        factor = (1.0 + speed / (self.pad.thickness * reference)) ** max(base, base + slope * loads.strain)
        more = self.pad.damping * speed
        return Loads(
            loads.force * factor + more,
            loads.pressure * factor + (more / self.pad.area if self.pad.area else 0.0),
            loads.strain,
        )

    def _loads(self, force: float, depth: float) -> Loads:
        if self.pad is None:
            return Loads(force, force / self.area, math.nan)
        if math.isinf(force) or math.isinf(depth):
            return Loads(math.inf, math.inf, math.inf)
        pressure = force / self.pad.area if self.pad.shape == "flat" and self.pad.area else self._pressure(depth)
        return Loads(force, pressure, depth / self.pad.thickness)

    def _where(self, rising: object, least: float = 0.0) -> float:
        """Return the compression at which a rising function passes zero; inf if it does not within a thickness."""
        if self.pad is None or not callable(rising):
            return 0.0
        low, high = least, max(least, self.pad.thickness)
        below, above = rising(low), rising(high)
        if below >= 0.0:
            return low
        while above < 0.0:
            low, below, high = high, above, 2.0 * high
            above = rising(high)
            if high > 100.0 * self.pad.thickness:
                return math.inf
        side = 0
        for round_ in range(ROUNDS):
            # Secants whose end that stays twice loses half of its weight, and now and then a half.
            middle = high - above * (high - low) / (above - below) if math.isfinite(above) and round_ % 4 != 3 else 0.0
            if not low < middle < high:
                middle = 0.5 * (low + high)
            if middle in (low, high) or high - low <= NEAR * high:
                break
            value = rising(middle)
            if value < 0.0:
                low, below = middle, value
                above = 0.5 * above if side < 0 else above
                side = -1
            else:
                high, above = middle, value
                below = 0.5 * below if side > 0 else below
                side = 1
                if value == 0.0:
                    break
        return high

    def _resists(self, depth: float) -> float:
        return self._column(depth, 0)

    def _pressure(self, depth: float) -> float:
        if self.pad is not None and self.pad.shape == "flat" and self.pad.area:
            return self._resists(depth) / self.pad.area
        return self._column(depth, 2)

    def _column(self, depth: float, place: int) -> float:
        """Return force, stored work or pressure of the covering at rest, inf beyond its law."""
        if self.pad is None:
            return 0.0
        try:
            return float(_hrsafety.contact_column(*self.row, depth)[place])  # type: ignore[arg-type]  # no widths
        except InvalidParameterError:
            return math.inf

    def _stored(self, depth: float) -> float:
        force = self._resists(depth)
        return self._column(depth, 1) + 0.5 * force**2 / self.stiffness

    def _way_at(self, depth: float) -> float:
        force = self._resists(depth)
        return 0.0 if math.isinf(force) else depth + force / self.stiffness


def pressed_of(hit: Contact, given: Prepared) -> Pressed:
    """Return the clamped contact at rest.

    Parameters
    ----------
    hit : Contact
        With covering and area.
    given : Prepared
        Its numbers and limits.

    Raises
    ------
    InvalidParameterError
        If it is not clamped, has supports of its own, or its region is no spring with a constant stiffness.
    """
    values = given.values
    if not math.isinf(values["body_mass"]):
        raise InvalidParameterError("body", "be clamped for a drive that presses", values["body_mass"])
    for name in ("drive", "support"):
        if getattr(hit, name) is not None:
            raise InvalidParameterError(name, "be None beside a Drive", getattr(hit, name))
    if given.shared["region"] != "spring" or values["region_cubic"] != 0.0:
        raise InvalidParameterError("region", "be a spring of a constant stiffness for a drive", given.shared["region"])
    pad = given.pad
    strain = values["max_strain"]
    if pad is not None and math.isnan(strain):
        strain = pad.bottom[0] if pad.bottom[1] > 0.0 else math.inf
    area = values["area"] if pad is None else math.nan
    force, pressure = (
        math.inf if math.isnan(values[f"{name}_limit"]) else values[f"{name}_limit"] for name in Loads._fields[:2]
    )
    return Pressed(
        stiffness=values["stiffness"],
        pad=pad,
        area=area,
        force=force,
        pressure=math.inf if pad is None and math.isnan(area) else pressure,
        strain=math.inf if pad is None else strain,
        row=(given.shared | {"region": "rigid"}, in_order(values)),
    )
