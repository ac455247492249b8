"""Loads of clamped contacts that a drive presses on."""

from __future__ import annotations

import math
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, instance
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.contact.contact import Contact
from hrsafety.contact.drive import FASTEST_BRAKE, Drive
from hrsafety.contact.elastic import pressing
from hrsafety.contact.pressed import Loads, Pressed, pressed_of
from hrsafety.contact.rows import Prepared
from hrsafety.contact.simulation import impacts_of
from hrsafety.errors import InvalidParameterError

__all__ = ["STIFFNESSES", "DrivenContact", "DrivenLoads"]

STIFFNESSES = np.geomspace(1e-2, 1e2, 25)
"""Stiffnesses of a drive of any stiffness over that of the region, beside none and a rigid one."""
SHORTEST, LONGEST = 1e-3, 60.0
"""Shortest and longest time in s that a simulation follows."""
LONGER = 1.137
"""Factor of a horizon at which a load is largest."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class DrivenLoads:
    """Largest loads of a clamped contact that a drive presses on.

    Attributes
    ----------
    force : float
        In N; inf where nothing is known: beyond measured stops, or beyond the law of the covering.
    pressure : float
        In Pa; NaN where there is no area.
    strain : float
        Of the covering; NaN where there is none.
    static_force : float
        Force that is left after the stop in N; NaN for a drive that is not followed to its rest.
    time_of_peak, detection_time : float
        After the touch, in s; NaN where it is not known.
    commanded : float
        Way of the commanded path from the touch to its stop in m; NaN for a drive without a path.
    stiffness : float
        Of the drive that presses hardest in N/m; inf if that is rigid, 0 if it is none.
    status : {"ok", "outside_table", "unfinished", "drive_not_given"}
        Whether the loads are known.
    """

    force: Annotated[float, "N"]
    pressure: Annotated[float, "Pa"] = math.nan
    strain: float = math.nan
    static_force: Annotated[float, "N"] = math.nan
    time_of_peak: Annotated[float, "s"] = math.nan
    detection_time: Annotated[float, "s"] = math.nan
    commanded: Annotated[float, "m"] = math.nan
    stiffness: Annotated[float, "N/m"] = math.nan
    status: str = "ok"


class DrivenContact:
    """A clamped contact with a drive: its loads at a speed."""

    def __init__(self, hit: Contact, drive: Drive, limits: object) -> None:
        instance("hit", hit, Contact)
        instance("drive", drive, Drive)
        self.drive = drive
        self.given: Prepared = hit._prepared(limits)
        self.rest: Pressed = pressed_of(hit, self.given)
        self.mass = self.given.values["robot_mass"]
        self.force, self.governs = self.rest.limit()
        self.noticed = self.rest.depth(drive.detection_force)

    # ---- loads ----

    def loads(self, speed: float) -> DrivenLoads:
        """Return the loads at a closing speed."""
        model = self.drive.model
        if model == "none":
            return DrivenLoads(force=math.inf, pressure=math.inf, status="drive_not_given")
        if model == "push_limit":
            return self._pushed(speed)
        if math.isinf(self.drive.path(speed)):
            return DrivenLoads(force=math.inf, pressure=math.inf, strain=math.inf, status="outside_table")
        if model == "rigid":
            return self._rigid(speed)
        if model == "elastic":
            return self._elastic(speed)
        bare = self.rest.pad is None and self.drive.detection_force == 0.0
        return self._any_bare(speed) if bare else self._any(speed)

    def _told(self, loads: Loads, **more: float) -> DrivenLoads:
        return DrivenLoads(force=loads.force, pressure=loads.pressure, strain=loads.strain, **more)  # type: ignore[arg-type]  # numbers

    def _pushed(self, speed: float) -> DrivenLoads:
        push = self.drive.pressing(self.mass)
        loads = self.rest.pushed(0.5 * self.mass * speed**2, push)
        return self._told(self.rest.hurried(loads, speed), static_force=push)

    def _rigid(self, speed: float) -> DrivenLoads:
        noticed = self.rest.way(self.drive.detection_force)
        way = noticed + float(self.drive.path(speed))
        if self.drive.path_left is not None:
            way = min(way, self.drive.path_left)
        loads = self.rest.at(way)
        return self._told(self.rest.hurried(loads, speed), static_force=loads.force, commanded=way, stiffness=math.inf)

    def _any_bare(self, speed: float) -> DrivenLoads:
        way, k = float(self.drive.path(speed)), self.rest.stiffness
        kinetic = speed * math.sqrt(self.mass * k)
        if 2.0 * way * math.sqrt(k) >= speed * math.sqrt(self.mass) and way > 0.0:
            softer = self.mass * speed**2 / (4.0 * way * way)
            force, b = k * way + way * softer, 1.0 - min(softer / k, 1.0)
            drive = math.inf if b >= 1.0 else k * b / (1.0 - b)
        else:
            force, drive = kinetic, 0.0
        return self._told(self.rest.at(force / k), commanded=way, stiffness=drive)

    def _elastic(self, speed: float) -> DrivenLoads:
        drive, k = self.drive, self.rest.stiffness
        if drive.stiffness is None or drive.reaction_time is None:
            raise InvalidParameterError("drive.stiffness", "be given for model 'elastic'", drive.stiffness)
        if self.rest.pad is None and drive.damping == 0.0 and drive.push_limit is None:
            brakes = float(drive.braking(np.array(speed)))
            stop = (drive.reaction_time, math.inf if brakes >= FASTEST_BRAKE else brakes)
            found = pressing(self.mass, k, drive.stiffness, speed, drive.detection_force / k, stop)
            if found is not None:
                return self._told(
                    self.rest.at(found.peak),
                    static_force=k * found.at_rest,
                    time_of_peak=found.time_of_peak,
                    detection_time=found.detection_time,
                    commanded=found.commanded,
                    stiffness=drive.stiffness,
                )
        (loads,) = self._simulated(np.array([speed]), np.array([drive.stiffness]))
        return loads

    def _any(self, speed: float, rows: list[DrivenLoads] | None = None) -> DrivenLoads:
        """Return the loads of the hardest one of drives of all stiffnesses, with those of a scan where it was made."""
        rigid = self._rigid(speed)
        bare = self.rest.hurried(self.rest.pushed(0.5 * self.mass * speed**2, 0.0), speed)
        kinetic = self._told(bare, stiffness=0.0)
        found = [kinetic, rigid, *(self._scanned(speed) if rows is None else rows)]
        worst = max(found, key=lambda each: (each.status != "ok", each.force))
        return DrivenLoads(
            force=worst.force,
            pressure=_most(each.pressure for each in found),
            strain=_most(each.strain for each in found),
            static_force=rigid.static_force,
            time_of_peak=worst.time_of_peak,
            commanded=worst.commanded,
            stiffness=worst.stiffness,
            status=worst.status,
        )

    def _scanned(self, speed: float) -> list[DrivenLoads]:
        """Return the loads with each stiffness of the scan."""
        return self._simulated(np.full(len(STIFFNESSES), speed), self.rest.stiffness * STIFFNESSES)

    def _simulated(
        self, speed: Array, stiffness: Array, longer: float = 1.0, tolerance: float | None = None
    ) -> list[DrivenLoads]:
        """Return the loads with some drives by the equation of motion, each with its own horizon."""
        drive = self.drive
        brakes = np.asarray(drive.braking(speed))
        # A robot is noticed when the drive has been stretched, then a period after the stop shows every peak.
        reaction = drive.reaction_time or 0.0
        noticed = drive.detection_force * (1.0 / self.rest.stiffness + 1.0 / stiffness) / speed
        period = 2.0 * np.pi * np.sqrt(self.mass / stiffness)
        noticed = noticed + self.noticed / speed
        horizon = noticed + reaction + speed / brakes + 1.1 * period + 0.02
        # What does not come to rest in that time is not known, and not simulated.
        beyond = ~(longer * horizon <= LONGEST)
        arrays: dict[str, npt.ArrayLike] = {
            "closing_speed": speed,
            "robot_stiffness": stiffness,
            "horizon": np.where(beyond, SHORTEST, longer * horizon),
            "stop_deceleration": brakes,
        }
        values = self.given.values | {
            "robot_damping": drive.damping,
            "stop_time": reaction,
            "detection_force": drive.detection_force,
        }
        if drive.push_limit is not None:
            values["push_limit"] = drive.push_limit
        values |= {"force_limit": math.nan, "pressure_limit": math.nan, "max_strain": math.nan}
        shared = self.given.shared | ({} if tolerance is None else {"tolerance": tolerance})
        rows = impacts_of(self.given._replace(shared=shared, values=values, limits=None), arrays, False, None, None)
        known = np.isfinite(rows.peak_force) & ~rows.rising & (rows.status == "horizon") & ~beyond
        found = []
        for row in range(len(speed)):
            force = float(rows.peak_force[row]) if known[row] else math.inf
            bare = self.rest.pad is None
            found.append(
                DrivenLoads(
                    force=force,
                    pressure=force / self.rest.area if bare else _or_inf(rows.peak_pressure[row], known[row]),
                    strain=math.nan if bare else _or_inf(rows.peak_strain[row], known[row]),
                    time_of_peak=float(rows.peak_force_time[row]) if known[row] else math.nan,
                    stiffness=float(stiffness[row]),
                    status="ok" if known[row] else "unfinished",
                )
            )
        # An oscillation at rest whose peak happens to be at the horizon has none later: another horizon shows it.
        again = np.flatnonzero(rows.rising & np.isfinite(rows.peak_force) & ~beyond).tolist()
        if len(again) and longer < LONGER**4:
            more = self._simulated(speed[again], stiffness[again], LONGER * longer, tolerance)
            for row, loads in zip(again, more, strict=True):
                found[row] = loads
        return found


def _most(values: Any) -> float:
    """Return the largest number, NaN where there is none."""
    known = [each for each in values if not math.isnan(each)]
    return max(known, default=math.nan)


def _or_inf(value: float, known: bool) -> float:
    return float(value) if known else math.inf
