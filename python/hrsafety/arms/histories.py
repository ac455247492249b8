"""Masses, speeds and contact forces of a point along a recorded motion."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, instance, positive, vector, word
from hrsafety._records import dataclass
from hrsafety.arms.arm import Arm
from hrsafety.arms.doubts import DIRECTIONAL, doubts_of_point, for_rule, governs
from hrsafety.arms.inputs import poses_of, vectors_of
from hrsafety.arms.masses import RULES, mass_by_rule
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.plausibility import ResultWarning, implausible, telling, unsafe_doubts
from hrsafety.standards import ContactLimit
from hrsafety.tables import Columns, Table

__all__ = ["MassHistory", "along", "plane_of"]

Words = npt.NDArray[np.str_]

LONGEST_STEP = 0.5
"""Records of joints have shorter steps, in s."""
FASTEST_TURN, FASTEST_SLIDE = 20.0, 10.0
"""Rates that hardly any joint reaches, in rad/s and m/s."""


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class MassHistory(Table):
    """A point of an arm along a recorded motion: one row for each instant.

    Parameters
    ----------
    time : ndarray (n,)
        Instants in s.
    position : ndarray (n, 3)
        The point in m, in world axes.
    velocity : ndarray (n, 3)
        Its velocity in m/s.
    speed : ndarray (n,)
        Magnitude of the velocity in m/s.
    effective_mass : ndarray (n,)
        Mass along the velocity in kg; that of the heaviest direction at rest.
    iso_mass : float
        Mass of ISO/TS 15066 in kg.
    robot_mass : ndarray (n,)
        The mass that the forces are computed with, in kg.
    status : ndarray (n,) of str
        ``"moving"``, ``"at_rest"`` (no velocity, so no direction), ``"unbounded_mass"``.
    force : ndarray (n,) or None
        Predicted peak force in N of a contact without a covering, with a person at rest.
    margin : ndarray (n,) or None
        Share of the force limit that is left, with a contact area the smaller one of force and pressure; negative
        beyond it.
    verdict : ndarray (n,) of str or None
        ``"within_limits"``, ``"exceeds"``, ``"not_permitted"`` or ``"not_checked"``: a limit that is not checked, as
        that of the pressure without a contact area, is not kept. A doubt whose error may lie on the unsafe side leaves
        no ``"within_limits"``; one about motor inertias does so at the instants whose mass depends on them.
    limit : ContactLimit or None
        The limit of the forces.
    warnings : tuple of ResultWarning
        Why masses and loads may not be what they seem.
    """

    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    speed: Annotated[Array, "m/s"]
    effective_mass: Annotated[Array, "kg"]
    iso_mass: Annotated[float, "kg"]
    robot_mass: Annotated[Array, "kg"]
    status: Words
    force: Annotated[Array | None, "N"]
    margin: Array | None
    verdict: Words | None
    limit: ContactLimit | None
    warnings: tuple[ResultWarning, ...]

    @property
    def worst(self) -> int:
        """Index of the worst instant: the largest force with a limit, else the largest energy of the point."""
        if self.force is not None:
            return int(np.argmax(self.force))
        moving = np.where(self.speed > 0.0, self.robot_mass, 0.0)
        return int(np.argmax(moving * self.speed**2))

    def columns(self) -> Columns:
        """Return the table as columns.

        Returns
        -------
        dict of str to ndarray
            Time, position, velocity, speed, masses, status, and with a limit force, margin and verdict.
        """
        names = [*plane_of("position", self.position, "m"), *plane_of("velocity", self.velocity, "m/s")]
        table: Columns = {"t_s": self.time, **dict(names), "speed_m_per_s": self.speed}
        table |= {"effective_mass_kg": self.effective_mass, "robot_mass_kg": self.robot_mass, "status": self.status}
        if self.force is not None and self.margin is not None and self.verdict is not None:
            table |= {"force_N": self.force, "margin": self.margin, "verdict": self.verdict}
        return table


@telling()
def along(
    arm: Arm,
    time: object,
    joints: object,
    *,
    link: str,
    point: object = (0.0, 0.0, 0.0),
    limit: ContactLimit | None = None,
    area: float | None = None,
    robot_mass: str = "larger",
    check_limits: bool = True,
    threads: int | None = None,
) -> MassHistory:
    """Return masses, speeds and contact forces of a point along a recorded motion.

    At each instant the direction is that of the velocity of the point. Rates of the joints are differences of
    second order of the record.

    Parameters
    ----------
    arm : Arm
        The arm.
    time : array_like (n,)
        Instants in s, increasing.
    joints : mapping or array_like (n, joints)
        Values of the joints at these instants.
    link : str
        The link that the point is fixed to.
    point : array_like (3,)
        The point in the frame of the link, in m.
    limit : ContactLimit or None
        A limit of contact, for example ``standards.limits().contact("chest", "transient")``: predicted forces are
        those of a contact without a covering on its region.
    area : float or None
        Contact area in m^2; without it the pressure is not checked.
    robot_mass : {"larger", "iso", "directional"}
        Which mass the robot has in the contact.
    check_limits : bool
        Whether values outside the limits of their joints are errors.
    threads : int or None
        Number of threads; all cores when ``None``. It changes no bit.

    Returns
    -------
    MassHistory
        One row for each instant, and the worst of them.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import arms, standards
    >>> time = np.linspace(0.0, 1.0, 101)
    >>> joints = {"shoulder": 0.3 * np.sin(time), "elbow": 1.4 - 0.5 * time}
    >>> limit = standards.limits().contact("chest", "transient")
    >>> arm = arms.Arm.example(armature=[1.2, 1.2, 1.0, 0.3, 0.3, 0.3])
    >>> history = arms.along(arm, time, joints, link="tool", limit=limit, area=1e-4)
    >>> str(history.verdict[history.worst])
    'within_limits'
    """
    instance("arm", arm, Arm)
    word("robot_mass", robot_mass, RULES)
    if limit is not None:
        instance("limit", limit, ContactLimit)
    surface = None if area is None else positive("area", area)
    clock, poses = _instants(time), poses_of(joints, arm.joint_names)
    rates, spot = _rates_of(clock, poses), vectors_of("point", point)
    if spot.ndim != 1:
        raise ShapeError("point", "(3,)", spot.shape)
    place: dict[str, Any] = {"link": link, "point": spot, "check_limits": check_limits, "threads": threads}
    velocity = arm.velocity(poses, rates, **place)
    speed = np.linalg.norm(velocity, axis=1)
    moving = speed > 0.0
    mass = arm.extremes(poses, **place).worst_mass.copy()
    if moving.any():
        mass[moving] = arm.effective_mass(poses[moving], direction=velocity[moving], **place).mass
    chosen = mass_by_rule(robot_mass, mass, arm.iso_mass)
    force = None if limit is None else _bare_force(limit, speed, chosen)
    # Motors count where something moves: at rest there is no force.
    governs_where = moving & governs(robot_mass, mass, arm.iso_mass)
    doubts = (
        *for_rule(arm.warnings, robot_mass, mass[moving], arm.iso_mass),
        *doubts_of_point(spot, arm.reach),
        *_doubts_of_record(clock, rates, arm.joint_names, arm.joint_kinds),
        *(() if limit is None or not limit.permitted else _doubts_of_limit(limit, surface)),
    )
    margin = None if limit is None or force is None else _margin(limit, force, surface)
    return MassHistory(
        time=clock,
        position=arm.position(poses, **place),
        velocity=velocity,
        speed=speed,
        effective_mass=mass,
        iso_mass=arm.iso_mass,
        robot_mass=chosen,
        status=np.where(moving, np.where(np.isinf(mass), "unbounded_mass", "moving"), "at_rest"),
        force=force,
        margin=margin,
        verdict=None if limit is None or force is None else _verdicts(limit, margin, doubts, governs_where),
        limit=limit,
        warnings=doubts,
    )


def _margin(limit: ContactLimit, force: Array, area: float | None) -> Array | None:
    """Return which share of the limits is left; ``None`` where contact is not permitted or nothing is limited."""
    margins = [limit.force_margin(force)]
    if limit.permitted and limit.pressure is not None and area is not None:
        margins.append(1.0 - force / area / limit.pressure)
    found = [each for each in margins if each is not None]
    return np.min(found, axis=0) if found else None


def _doubts_of_limit(limit: ContactLimit, area: float | None) -> Iterator[ResultWarning]:
    """Give what keeps no limit: a load that is not checked, a clamped contact of a robot whose drive is not known."""
    if limit.force is None:
        yield ResultWarning("not_checked", "limit", "the set has no limit of force: it is not checked")
    if limit.pressure is None or area is None:
        why = "the set has no limit of it" if limit.pressure is None else "no area of contact is given"
        yield ResultWarning("not_checked", "area", f"the pressure is not checked: {why}")
    if limit.body_mass is not None and np.isinf(limit.body_mass):
        message = (
            "a clamped contact is that of a robot without drive: one that is driven on until it has reacted and braked "
            "presses harder; a cell file with [separation] looks at it"
        )
        yield ResultWarning("drive_not_given", "limit", message)
    yield from implausible({} if area is None else {"area": area}, {"area": "contact_area"})


def _doubts_of_record(time: Array, rates: Array, names: Sequence[str], kinds: Sequence[str]) -> Iterator[ResultWarning]:
    """Give what is hardly meant of a record: milliseconds, degrees, millimeters."""
    step = float(np.median(np.diff(time)))
    if step > LONGEST_STEP:
        message = (
            f"time has steps of {step:g} s, longer than {LONGEST_STEP:g} s: ms given for s? Speeds are too low then"
        )
        yield ResultWarning("implausible", "time", message)
    most = np.array([FASTEST_TURN if kind == "turning" else FASTEST_SLIDE for kind in kinds])
    fastest = np.abs(rates).max(axis=0, initial=0.0)
    far = np.flatnonzero(fastest > most).tolist()
    if far:
        turning = kinds[far[0]] == "turning"
        unit, slip = ("rad/s", "degrees given for radians") if turning else ("m/s", "mm given for m")
        message = f"{names[far[0]]} moves at {fastest[far[0]]:g} {unit}: {slip}, or a jump of the record?"
        yield ResultWarning("implausible", "joints", message)


def _verdicts(
    limit: ContactLimit, margin: Array | None, doubts: tuple[ResultWarning, ...], governed: npt.NDArray[np.bool_]
) -> Words:
    """Return what loads mean for a limit beside the doubts about the masses that they come from."""
    if margin is None:
        return np.full(len(governed), "not_checked" if limit.permitted else "not_permitted")
    # Small forces are those of slow instants here, and no other unit.
    words = np.where(margin >= 0.0, "within_limits", "exceeds")
    unsafe = unsafe_doubts(doubts)
    everywhere = any(each.code not in DIRECTIONAL for each in unsafe)
    doubted = np.full(len(words), everywhere) | (governed if unsafe else False)
    return np.where(doubted & (words == "within_limits"), "not_checked", words)


def plane_of(name: str, values: Array, unit: str) -> list[tuple[str, Array]]:
    """Return the columns of vectors in space, named as those of vectors in the plane are."""
    prefix = {"position": "", "velocity": "v", "direction": "u"}[name]
    suffix = {"m": "_m", "m/s": "_m_per_s", "": ""}[unit]
    return [(f"{prefix}{axis}{suffix}", values[:, index]) for index, axis in enumerate("xyz")]


def _instants(given: object) -> Array:
    """Return the instants of a record, which increase."""
    time = vector("time", given)
    if len(time) < 3:
        raise InvalidParameterError("time", "hold at least 3 instants", len(time))
    if not np.isfinite(time).all():
        raise InvalidParameterError("time", "be finite", float(time[~np.isfinite(time)][0]))
    back = np.flatnonzero(np.diff(time) <= 0.0)
    if len(back):
        first = int(back[0]) + 1
        raise InvalidParameterError(f"time[{first}]", f"exceed {float(time[first - 1])!r}", float(time[first]))
    return time


def _rates_of(time: Array, joints: Array) -> Array:
    """Return the rates of recorded joints, by differences of second order."""
    if joints.ndim != 2 or len(joints) != len(time):
        raise ShapeError("joints", f"({len(time)}, {joints.shape[-1]})", joints.shape)
    return np.asarray(np.gradient(joints, time, axis=0, edge_order=2))


def _bare_force(limit: ContactLimit, speed: Array, mass: Array) -> Array:
    """Return the peak forces of contacts without a covering on the region of a limit, in N."""
    if limit.spring_constant is None or limit.body_mass is None:
        rule = "have a spring constant and a body mass, for a force to be predicted"
        raise InvalidParameterError("limit", rule, limit.region)
    return _hrsafety.bare_forces(speed, np.ascontiguousarray(mass), limit.body_mass, limit.spring_constant)
