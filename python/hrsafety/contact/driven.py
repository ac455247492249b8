"""Allowed speeds of clamped contacts that a drive presses on."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial
from typing import Annotated

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, not_negative, numbers, positive
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.contact.contact import Contact
from hrsafety.contact.doubts import Doubts
from hrsafety.contact.drive import Drive
from hrsafety.contact.driving import STIFFNESSES, DrivenContact, DrivenLoads
from hrsafety.contact.pressed import Loads
from hrsafety.contact.speed import allowed_of
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning

__all__ = ["DrivenSpeed", "driven_loads", "driven_speed", "driven_speeds"]

FASTEST = 20.0
"""Speeds up to this one are looked at, in m/s."""
SLOWEST = 1e-4
SCANS = 49
SCAN_STEP, SCAN_BLOCK = 1.08, 8
"""Ratio of neighboring speeds of a scan where a force has to be detected, and how many are simulated together."""
COARSE, SURELY = 1e-5, 0.9
"""Tolerance of a first look, and the share of a limit below which its loads, within 0.02, surely keep it."""
PRECISE = 1e-12
SIMULATED = 1e-5
"""Nearness of loads to their limits, from formulas and from simulations."""
INSIDE = 3e-5
"""Share of a limit that simulated loads stay below, more than their error."""
MASSES = 64
"""Masses of a grid between which the slower neighbor counts."""
_ROUNDS = 60


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class DrivenSpeed:
    """A closing speed at which a clamped contact keeps its limits with a drive.

    Attributes
    ----------
    speed : float or None
        In m/s; ``None`` where no limit is given, or nothing is known of the drive.
    governs : {"force", "pressure", "strain", "nothing"}
        The limit that governs.
    status : str
        ``"ok"``; ``"threshold_above_limit"`` where the robot notices no force below the limit, and
        ``"push_above_half_limit"`` where the drive alone presses too hard, both with speed 0; ``"outside_table"``
        where the largest measured speed is the allowed one; ``"unlimited_up_to_20"``; ``"unbounded_mass"``,
        ``"not_checked"``, ``"unfinished"``, ``"drive_not_given"``.
    kinetic_speed : float or None
        Speed for the kinetic energy alone in m/s.
    robot_speed : float or None
        The speed less that of the person towards the robot in m/s, at least 0.
    warnings : tuple of ResultWarning
        Those of the contact, and why the speed may not be what it seems.
    """

    speed: Annotated[float | None, "m/s"]
    governs: str
    status: str
    kinetic_speed: Annotated[float | None, "m/s"]
    robot_speed: Annotated[float | None, "m/s"]
    warnings: Doubts


class _Pressing(DrivenContact):
    """A clamped contact with a drive, with the speeds at which it keeps its limits."""

    def speed(self) -> tuple[float | None, str, str]:
        """Return the allowed closing speed, the limit that governs and the status."""
        model, most = self.drive.model, self.force
        if model == "none":
            return None, "nothing", "drive_not_given"
        if math.isinf(most):
            return None, "nothing", "not_checked"
        if model == "push_limit":
            return self._push_speed()
        if self.drive.detection_force >= most:
            return 0.0, self.governs, "threshold_above_limit"
        if model == "rigid":
            return self._rigid_speed()
        if math.isinf(self.mass):
            return 0.0, self.governs, "unbounded_mass"
        if model == "any_stiffness" and self.rest.pad is None and self.drive.detection_force == 0.0:
            return self._within(float(_any_speeds(np.array([self.mass]), self.rest.stiffness, self.drive, most)[0]))
        return self._searched()

    def _within(self, speed: float) -> tuple[float | None, str, str]:
        """Return a speed with its status: that of the largest measured one, of all that are looked at, or its own."""
        top = _top(self.drive)
        if speed >= min(top, FASTEST):
            beyond = "outside_table" if top < FASTEST else "unlimited_up_to_20"
            return (top, "nothing", beyond) if top < FASTEST else (None, "nothing", beyond)
        return speed, self.governs, "ok"

    def _push_speed(self) -> tuple[float | None, str, str]:
        push = self.drive.pressing(self.mass)
        room = self.rest.stored(self.force) - push * self.rest.way(self.force)
        if room <= 0.0 or push >= self.force:
            return 0.0, self.governs, "push_above_half_limit"
        if math.isinf(self.mass):
            return 0.0, self.governs, "unbounded_mass"
        return self._slower(math.sqrt(2.0 * room / self.mass))

    def _rigid_speed(self) -> tuple[float | None, str, str]:
        left = self.drive.path_left
        if left is not None and self.rest.way(self.force) >= left:
            return self._slower(FASTEST)
        room = self.rest.way(self.force) - self.rest.way(self.drive.detection_force)
        reaction, brakes = self.drive.reaction_time or 0.0, self.drive.deceleration
        if brakes is None:
            return self._slower(
                _rising(lambda speed: float(self.drive.path(speed)) / room, min(FASTEST, _top(self.drive)))
            )
        root = reaction + math.sqrt(reaction**2 + 2.0 * room / brakes)
        return self._slower(2.0 * room / root if root > 0.0 else FASTEST)

    def _slower(self, speed: float) -> tuple[float | None, str, str]:
        """Return a speed at which loads that rise with it keep their limits, too."""
        pad = self.rest.pad
        if pad is not None and (pad.damping > 0.0 or pad.rate[:2] != (0.0, 0.0)):
            speed = _rising(self._share, min(speed, FASTEST))
        return self._within(speed)

    def _share(self, speed: float, chosen: Array | None = None) -> float:
        """Return the largest load over its limit, or that with some stiffnesses of the drive."""
        found = [self.loads(speed)] if chosen is None else self._simulated(np.full(len(chosen), speed), chosen)
        return max(self._shared(each)[0] for each in found)

    def _inside(self, speed: float, chosen: Array | None = None) -> float:
        """Return that share of a simulation, more than 1 where its error may exceed the limit."""
        return self._share(speed, chosen) * (1.0 + INSIDE)

    def _searched(self) -> tuple[float | None, str, str]:
        """Return the lowest speed at which a load reaches its limit, by simulations."""
        if self.drive.model == "any_stiffness":
            return self._any_speed()
        top = min(FASTEST, _top(self.drive))
        fine = math.ceil(math.log(top / SLOWEST) / math.log(SCAN_STEP)) if self.drive.detection_force > 0.0 else SCANS
        slow = self._quiet(top) if self.drive.damping == 0.0 else SLOWEST
        if slow >= top:
            return self._within(top)
        speeds = np.geomspace(min(max(slow, SLOWEST), 0.5 * top), top, fine)
        shares = np.array([self._share(speed) for speed in speeds])
        beyond = np.flatnonzero(shares > 1.0)
        if not len(beyond):
            return self._within(float(speeds[-1]))
        first = int(beyond[0])
        if first == 0:
            return 0.0, self.governs, "unfinished"
        found = _rising(self._inside, float(speeds[first]), float(speeds[first - 1]), near=SIMULATED)
        return self._within(found)

    def _any_speed(self) -> tuple[float | None, str, str]:
        """Return the speed that is allowed with the hardest drive of any stiffness."""
        # A robot without a drive and a rigid one are among the drives.
        kinetic = allowed_of(self.given, 0.0).speed
        rigid = self._rigid_speed()
        start = min(each for each in (kinetic, rigid[0], FASTEST) if each is not None)
        if self.drive.detection_force > 0.0:
            start = self._unnoticed(start)
        found, governs, looked_at = start, self.governs, start
        rows, hardest = self._scanned(start), np.zeros(0)
        for _ in STIFFNESSES:
            hardest = np.union1d(hardest, self._hardest(rows))
            found = _rising(partial(self._inside, chosen=hardest), found, near=SIMULATED)
            if found == 0.0:
                return 0.0, self.governs, "unfinished"
            if found != looked_at:
                rows, looked_at = self._scanned(found), found
            share, governs = self._shared(self._any(found, rows))
            # The speeds of no drive and of a rigid one are exact: at them a load is its limit but for rounding.
            if share <= 1.0 + PRECISE:
                break
        if found == rigid[0] and rigid[2] != "ok":
            return found, "nothing", rigid[2]
        return (None, "nothing", "unlimited_up_to_20") if found >= FASTEST else (found, governs, "ok")

    def _unnoticed(self, top: float) -> float:
        """Return the lowest speed of a scan up to `top` at which a load exceeds its limit, else `top`.

        A robot that touches gently is noticed late, and presses harder than a faster one that is noticed at once:
        loads do not rise with the speed where a force has to be detected.
        """
        slow = self._quiet(top)
        if not 0.0 < slow < top:
            return top
        speeds = np.geomspace(slow, top, 2 + math.ceil(math.log(top / slow) / math.log(SCAN_STEP)))
        stiffness = self.rest.stiffness * STIFFNESSES
        for first in range(0, len(speeds), SCAN_BLOCK):
            block = speeds[first : first + SCAN_BLOCK]
            speed, drives = np.repeat(block, len(stiffness)), np.tile(stiffness, len(block))
            shares = np.array([self._shared(each)[0] for each in self._simulated(speed, drives, tolerance=COARSE)])
            near = np.flatnonzero(shares > SURELY)
            if len(near):
                shares[near] = [self._shared(each)[0] for each in self._simulated(speed[near], drives[near])]
            shares = shares.reshape(len(block), -1).max(axis=1)
            beyond = np.flatnonzero(shares > 1.0)
            if len(beyond):
                return float(block[beyond[0]])
        return top

    def _quiet(self, top: float) -> float:
        """Return a speed up to `top` below which no spring of a drive presses a region to its limit.

        The largest load of an undamped drive of any stiffness is at most F_d + k X + 2 v sqrt(k m), with the stiffness
        of the region, that a covering in series does not exceed.
        """
        drive, k = self.drive, self.rest.stiffness

        def bound(speed: float) -> float:
            pressed = k * float(drive.path(speed)) + 2.0 * speed * math.sqrt(k * self.mass)
            return (drive.detection_force + pressed) / self.force

        return _rising(bound, top)

    def _hardest(self, rows: list[DrivenLoads]) -> Array:
        """Return the two stiffnesses of a scan with the largest loads."""
        shares = [self._shared(each)[0] for each in rows]
        return np.asarray(self.rest.stiffness * STIFFNESSES[np.argsort(shares)[-2:]])

    def _shared(self, loads: DrivenLoads) -> tuple[float, str]:
        """Return the largest load over its limit, and which one that is."""
        return self.rest.share(Loads(loads.force, loads.pressure, loads.strain))


def _rising(share: Callable[[float], float], high: float, low: float = 0.0, *, near: float = PRECISE) -> float:
    """Return the largest speed up to `high` at which a share that rises with it is at most 1, by secants."""
    at_high = share(high)
    if at_high <= 1.0:
        return high
    if low <= 0.0:
        low, at_low = 0.5 * high, math.inf
        for _ in range(_ROUNDS):
            at_low = share(low)
            if at_low <= 1.0:
                break
            high, at_high, low = low, at_low, 0.5 * low
        if at_low > 1.0:
            return 0.0
    else:
        at_low = share(low)
    side = 0
    below, above = at_low - 1.0, at_high - 1.0
    for _ in range(_ROUNDS):
        if high - low <= near * high or below == 0.0:
            break
        middle = low - below * (high - low) / (above - below) if math.isfinite(above) else 0.5 * (low + high)
        if not low < middle < high:
            middle = 0.5 * (low + high)
        # A step beyond the root brings the other end near it.
        value = share(middle) - 1.0
        if value <= 0.0:
            low, below = middle, value
            above = 0.5 * above if side == -1 else above
            side = -1
            if -value <= near:
                break
        else:
            high, above = middle, value
            below = 0.5 * below if side == 1 else below
            side = 1
    return low


def _any_speeds(mass: Array, stiffness: float, drive: Drive, force: float) -> Array:
    """Return the allowed speeds of bare regions with a drive of any stiffness and a stop from the first touch.

    The largest force is convex and rises with the speed: Newton's steps from the speed of the kinetic energy come from
    above, and the last one is made to keep the limit.
    """
    k, reaction = stiffness, drive.reaction_time or 0.0
    if drive.deceleration is None:
        top = min(FASTEST, _top(drive))
        return np.array([_rising(partial(_any_share, one, k, drive, force), top) for one in mass.tolist()])
    half, heavy = 0.5 / drive.deceleration, np.isinf(mass)
    mass = np.where(heavy, 1.0, mass)
    speed = force / np.sqrt(k * mass)
    for _ in range(_ROUNDS):
        time = reaction + half * speed
        slow = k * time
        fast = mass / (4.0 * np.maximum(time, 1e-300))
        pressed = slow > fast
        value = np.where(pressed, speed * (slow + fast), speed * np.sqrt(k * mass)) - force
        if not np.any(value > 1e-14 * force):
            break
        slope = np.where(pressed, slow + fast + speed * half * (k - fast / np.maximum(time, 1e-300)), np.sqrt(k * mass))
        speed = np.where(value > 0.0, speed - value / slope, speed)
    return np.where(heavy, 0.0, speed)


def _top(drive: Drive) -> float:
    """Return the largest speed that is looked at: the largest one at which a stop was measured."""
    return FASTEST if drive.stopping is None else float(np.max(drive.stopping.speed))


def _any_share(mass: float, k: float, drive: Drive, limit: float, speed: float) -> float:
    way = float(drive.path(speed))
    kinetic = speed * math.sqrt(mass * k)
    pressed = way > 0.0 and 2.0 * way * math.sqrt(k) >= speed * math.sqrt(mass)
    return (k * way + mass * speed**2 / (4.0 * way) if pressed else kinetic) / limit


# ---- questions -----------------------------------------------------------------------------------


def driven_loads(hit: Contact, speed: float, drive: Drive) -> DrivenLoads:
    """Return the largest loads of a clamped contact that a drive presses on.

    Parameters
    ----------
    hit : Contact
        Clamped, on a region that is a spring, without supports.
    speed : float
        Closing speed in m/s.
    drive : Drive
        What presses.

    Returns
    -------
    DrivenLoads
        Of a drive of any stiffness those of the hardest one. With a rate or a damper of the covering loads of rigid
        drives and of push limits are bounds: the largest compression at the largest speed of compression.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or the contact is none that a drive presses.

    Examples
    --------
    >>> from hrsafety import contact
    >>> hit = contact.Contact(robot=12.0, region=75e3)
    >>> drive = contact.Drive(model="rigid", reaction_time=0.05, deceleration=3.0)
    >>> f"{contact.driven_loads(hit, 0.25, drive).force:.2f} N"
    '1718.75 N'
    """
    closing = positive("speed", speed)
    return _Pressing(hit, drive, None if hit.body is not None else {}).loads(closing)


def driven_speed(hit: Contact, drive: Drive, limits: object = None, *, human_speed: float = 0.0) -> DrivenSpeed:
    """Return the closing speed at which a clamped contact keeps its limits with a drive.

    Parameters
    ----------
    hit : Contact
        Clamped, on a region that is a spring, without supports.
    drive : Drive
        What presses.
    limits : mapping, object or None
        As for `Contact.allowed_speed`.
    human_speed : float
        Speed of the person towards the robot in m/s.

    Returns
    -------
    DrivenSpeed
        The speed with what governs. For a drive of any stiffness, and an elastic one, the lowest speed at which a load
        reaches its limit.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, or the contact is none that a drive presses.

    Examples
    --------
    >>> from hrsafety import contact
    >>> hit = contact.Contact(robot=12.0, region=75e3)
    >>> drive = contact.Drive(reaction_time=0.005, deceleration=20.0)
    >>> found = contact.driven_speed(hit, drive, {"force": 140.0})
    >>> round(found.speed, 4), round(found.kinetic_speed, 4)
    (0.1412, 0.1476)
    """
    walking = not_negative("human_speed", human_speed)
    found = _Pressing(hit, drive, limits)
    speed, governs, status = found.speed()
    kinetic = allowed_of(found.given, walking)
    doubts = tuple(each for each in kinetic.warnings if (each.code, each.subject) != ("drive_not_given", "drive"))
    if status == "unfinished":
        doubts = (
            *doubts,
            ResultWarning(
                "unfinished",
                "drive",
                "loads with the drive are not known even when slow: a shorter stop or damping of the drive may help",
            ),
        )
    return DrivenSpeed(
        speed=speed,
        governs=governs,
        status=status,
        kinetic_speed=kinetic.speed,
        robot_speed=None if speed is None else max(speed - walking, 0.0),
        warnings=(*doubts, *drive.doubts),
    )


def driven_speeds(hit: Contact, drive: Drive, robot_mass: npt.ArrayLike, limits: object = None) -> Array:
    """Return the allowed closing speeds of many masses of the robot against one region, with one covering.

    Parameters
    ----------
    hit : Contact
        As for `driven_speed`; the mass of its robot does not matter.
    drive : Drive
        What presses.
    robot_mass : array_like
        In kg, inf where the robot cannot yield.
    limits : mapping, object or None
        As for `Contact.allowed_speed`.

    Returns
    -------
    ndarray
        In m/s, of the shape of the masses; inf where nothing limits the speed. Where simulations decide, that of the
        slower neighbor on a geometric grid of 64 masses.

    Raises
    ------
    InvalidParameterError
        If a mass is not positive, or as for `driven_speed`.

    Examples
    --------
    >>> from hrsafety import contact
    >>> hit = contact.Contact(robot=1.0, region=75e3)
    >>> drive = contact.Drive(reaction_time=0.005, deceleration=20.0)
    >>> contact.driven_speeds(hit, drive, [6.0, 12.0], {"force": 140.0}).round(4).tolist()
    [0.165, 0.1412]
    """
    masses = numbers("robot_mass", robot_mass)
    if masses.size and not (masses > 0.0).all():
        raise InvalidParameterError("robot_mass", "be positive", float(masses.min()))
    found = _Pressing(hit, drive, limits)
    exact = found.drive.model == "any_stiffness" and found.rest.pad is None and drive.detection_force == 0.0
    if exact and math.isfinite(found.force) and drive.stopping is None:
        speeds = _any_speeds(masses.ravel(), found.rest.stiffness, drive, found.force)
        return np.where(speeds >= FASTEST, np.inf, speeds).reshape(masses.shape)

    def of(mass: float) -> float:
        found.mass = mass
        found.given.values["robot_mass"] = mass
        speed = found.speed()[0]
        return math.inf if speed is None else speed

    different = np.unique(masses)
    if len(different) > MASSES:
        finite = different[np.isfinite(different)]
        # The heavier neighbor is the slower one.
        grid = np.append(np.geomspace(finite[0], finite[-1], MASSES), np.inf)
        grid[MASSES - 1] = finite[-1]
        values = np.minimum.accumulate(np.array([of(float(mass)) for mass in grid]))
        return np.asarray(values[np.searchsorted(grid, masses, side="left")])
    values = np.array([of(float(mass)) for mass in different])
    return np.asarray(values[np.searchsorted(different, masses)])
