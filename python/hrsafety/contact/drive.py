"""Drives that press a clamped part of a body until the robot has noticed it, reacted and braked."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import fields, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from hrsafety import _keys as kind
from hrsafety._arguments import Array, instance, not_negative, number, numbers, positive, word
from hrsafety._keys import Keys, checked, located
from hrsafety._records import dataclass
from hrsafety.arms.arm import Arm
from hrsafety.arms.inputs import armature_of, vectors_of
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, implausible
from hrsafety.standards.separation import StoppingData, lighter_load

__all__ = ["FASTEST_BRAKE", "MODELS", "Drive", "drive_of", "push_limit_of_torques"]

MODELS = ("any_stiffness", "rigid", "push_limit", "elastic", "none")
"""Kinds of knowledge about a drive; the first one covers every spring."""
_QUANTITIES = {
    "deceleration": "robot_deceleration",
    "stiffness": "drive_stiffness",
    "push_limit": "drive_force",
    "weight": "drive_force",
}
BRAKING = ("any_stiffness", "rigid", "elastic")
"""Models that push until they have braked."""
MOST = MappingProxyType({"stiffness": 1e9, "damping": 1e6, "reaction_time": 60.0})
"""Largest stiffness in N/m, damping in N s/m and time in s of a drive."""
SLOWEST_BRAKE = 1e-3
"""Deceleration in m/s^2 below which no robot brakes."""
FASTEST_BRAKE = 1e12
"""Deceleration in m/s^2 of a stop without a way, as a simulation takes it."""
GRAVITY = 9.80665
_NO_STOP = ("reaction_time", "deceleration", "stopping", "path_left")
_OF_MODEL = MappingProxyType(
    {
        "stiffness": ("elastic",),
        "damping": ("elastic",),
        "push_limit": ("elastic", "push_limit"),
        "joint_torques": ("elastic", "push_limit"),
        "path_left": ("rigid",),
        "weight": ("push_limit",),
    }
)
"""Models that a number belongs to."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Drive:
    """Drive that pushes a robot against a clamped part of a body, and how it stops.

    Parameters
    ----------
    model : {"any_stiffness", "rigid", "push_limit", "elastic", "none"}
        A spring of any stiffness between the commanded path and the robot; a path that is followed whatever the force;
        a controller that pushes at most so much; a known spring; nothing known, so that no clamped contact is checked.
    reaction_time : float or None
        From the detection to the first braking in s, filters and bus with it; for all models that brake.
    deceleration : float or None
        Of the commanded path in m/s^2, which may be inf. Or `stopping` in its place.
    stopping : StoppingData or None
        Measured stops; beyond the table nothing is known (``outside_table``).
    load, extension : float or None
        Where to read them.
    detection_force : float
        Contact force in N that the robot notices, its error with it; 0 is the first touch.
    stiffness, damping : float
        Of an elastic drive, in N/m and N s/m.
    push_limit : float or None
        Largest force of the drive in N.
    joint_torques : mapping of str to float or None
        Largest torque of each joint in N m (N where it slides), which give the push limit of an arm in a pose.
    gravity : {"compensated", "acts"}
        Whether the weight of the robot presses beside the push limit.
    weight : float or None
        That weight in N; that of the mass of the contact where it is not given.
    path_left : float or None
        Way in m that the commanded path has left after the touch.

    Raises
    ------
    InvalidParameterError
        If a number is out of its range, is missing, or belongs to another model.

    Examples
    --------
    >>> from hrsafety import contact
    >>> drive = contact.Drive(model="rigid", reaction_time=0.05, deceleration=3.0)
    >>> f"{drive.path(0.25):.5f} m"
    '0.02292 m'
    """

    model: str = MODELS[0]
    reaction_time: float | None = None
    deceleration: float | None = None
    stopping: StoppingData | None = None
    load: float | None = None
    extension: float | None = None
    detection_force: float = 0.0
    stiffness: float | None = None
    damping: float = 0.0
    push_limit: float | None = None
    joint_torques: Mapping[str, float] | None = None
    gravity: str = "compensated"
    weight: float | None = None
    path_left: float | None = None

    def __post_init__(self) -> None:
        """Check the values."""
        word("model", self.model, MODELS)
        word("gravity", self.gravity, ("compensated", "acts"))
        made: dict[str, Any] = {}
        for name in ("reaction_time", "detection_force", "damping", "weight"):
            if getattr(self, name) is not None:
                made[name] = not_negative(name, getattr(self, name))
        for name in ("stiffness", "push_limit", "path_left"):
            if getattr(self, name) is not None:
                made[name] = positive(name, getattr(self, name))
        for name, most in MOST.items():
            if made.get(name, 0.0) > most:
                raise InvalidParameterError(name, f"be at most {most:g}", getattr(self, name))
        if self.deceleration is not None:
            made["deceleration"] = number("deceleration", self.deceleration)
            if not made["deceleration"] > 0.0:
                raise InvalidParameterError("deceleration", "be positive, or inf", self.deceleration)
            if made["deceleration"] < SLOWEST_BRAKE:
                raise InvalidParameterError("deceleration", f"be at least {SLOWEST_BRAKE:g}", self.deceleration)
        if self.stopping is not None:
            instance("stopping", self.stopping, StoppingData)
        if self.joint_torques is not None:
            made["joint_torques"] = _torques(self.joint_torques)
        for name, value in made.items():
            object.__setattr__(self, name, value)
        self._check_belonging()
        self._check_needed()
        if self.stopping is not None:
            self._curve()

    def _check_belonging(self) -> None:
        for name, models in _OF_MODEL.items():
            if getattr(self, name) not in (None, 0.0) and self.model not in models:
                rule = f"be left out for model {self.model!r}: it belongs to {' and '.join(models)}"
                raise InvalidParameterError(name, rule, getattr(self, name))
        if self.push_limit is not None and self.joint_torques is not None:
            raise InvalidParameterError("joint_torques", "be left out beside push_limit", dict(self.joint_torques))
        if self.gravity == "acts" and self.model != "push_limit":
            rule = "be 'compensated' for a drive that follows its path: it bears the weight"
            raise InvalidParameterError("gravity", rule, self.gravity)
        if self.weight is not None and self.gravity != "acts":
            raise InvalidParameterError("weight", "come with gravity 'acts'", self.weight)
        for name in ("load", "extension"):
            if getattr(self, name) is not None and self.stopping is None:
                raise InvalidParameterError(name, "stand beside measured stops", getattr(self, name))

    def _check_needed(self) -> None:
        if self.model in BRAKING:
            if self.reaction_time is None:
                raise kind.missing("reaction_time", "the time from the detection to the first braking in s")
            if (self.deceleration is None) == (self.stopping is None):
                rule = "be given, or measured stops in its place"
                raise InvalidParameterError("deceleration", rule, self.deceleration, "inf stops at once")
        if self.model == "elastic" and self.stiffness is None:
            raise kind.missing("stiffness", "of the drive in N/m, or model any_stiffness")
        if self.model == "push_limit" and self.push_limit is None and self.joint_torques is None:
            raise kind.missing("push_limit", "in N, or joint_torques of an arm")

    def _curve(self) -> Any:
        return instance("stopping", self.stopping, StoppingData).curve(self.load, self.extension)

    def path(self, speed: object) -> Any:
        """Return the way of the commanded path from the detection to its stop, X = v T_r + v^2/2a.

        Parameters
        ----------
        speed : array_like
            In m/s, not negative.

        Returns
        -------
        float or ndarray
            In m; inf for speeds beyond measured stops.

        Raises
        ------
        InvalidParameterError
            If a speed is negative or the drive does not brake.
        """
        given = numbers("speed", speed)
        if self.model not in BRAKING or self.reaction_time is None:
            raise InvalidParameterError("model", f"be one that brakes: {', '.join(BRAKING)}", self.model)
        if not (given >= 0.0).all():
            raise InvalidParameterError("speed", "not be negative", float(given.min()))
        way = given * self.reaction_time + self._brakes(given)
        return way if way.ndim else float(way)

    def braking(self, speed: Array) -> Array:
        """Return the deceleration in m/s^2 that brakes each speed within its way; NaN beyond measured stops."""
        with np.errstate(divide="ignore", invalid="ignore"):
            way = self._brakes(speed)
            found = np.where(way > 0.0, 0.5 * speed**2 / way, FASTEST_BRAKE)
        return np.where(np.isinf(way), np.nan, np.minimum(found, FASTEST_BRAKE))

    def _brakes(self, speed: Array) -> Array:
        """Return the way of braking in m."""
        if self.deceleration is not None:
            return np.asarray(0.5 * speed**2 / self.deceleration)
        table = np.atleast_1d(instance("stopping", self.stopping, StoppingData).speed)
        # A slower robot needs no longer way than the slowest one that was measured.
        within = np.clip(speed, table[0], table[-1]).ravel()
        rules = ("human_speed", "reaction_time", "intrusion", "uncertainty", "target_speed")
        ways = self._curve().distances(within, {name: np.zeros(within.size) for name in rules})
        return np.where(speed > table[-1], np.inf, ways.reshape(np.shape(speed)))

    def pressing(self, mass: float) -> float:
        """Return the largest force of the drive on a contact at rest in N: its push limit, and weight that acts."""
        if self.push_limit is None:
            rule = "be given: joint torques give it for an arm in a pose, see push_limit_of_torques"
            raise InvalidParameterError("push_limit", rule, None)
        own = 0.0 if self.gravity == "compensated" else (mass * GRAVITY if self.weight is None else self.weight)
        return self.push_limit + own

    def fields(self) -> dict[str, Any]:
        """Return what was given, or is a default of the model, as plain values.

        Returns
        -------
        dict
            By the keys of ``[drive]``.
        """
        found = {each.name: getattr(self, each.name) for each in fields(self)}
        found = {name: value for name, value in found.items() if value is not None}
        if self.deceleration is not None and math.isinf(self.deceleration):
            found["deceleration"] = "unbounded"  # as results hold it
        if self.stopping is not None:
            names = ("speed", "time", "distance", "load", "extension")
            found["stopping"] = {name: np.asarray(getattr(self.stopping, name)).tolist() for name in names}
        if self.joint_torques is not None:
            found["joint_torques"] = dict(self.joint_torques)
        return found

    def with_push_limit(self, force: float) -> Drive:
        """Return the drive with a push limit in the place of joint torques.

        Parameters
        ----------
        force : float
            In N.

        Returns
        -------
        Drive
            Another drive.
        """
        return replace(self, push_limit=force, joint_torques=None)

    @property
    def doubts(self) -> tuple[ResultWarning, ...]:
        """Numbers that are hardly meant, measured stops that no robot makes, and a drive that is not given."""
        if self.model == "none":
            return (ResultWarning("drive_not_given", "drive.model", "nothing is known of the drive"),)
        slow = None if self.deceleration is None or math.isinf(self.deceleration) else self.deceleration
        given = {"reaction_time": self.reaction_time, "deceleration": slow, "stiffness": self.stiffness}
        # 0 N is the first touch, or a weight that does not press.
        forces = {"push_limit": self.push_limit, "weight": self.weight, "detection_force": self.detection_force}
        given |= {name: force or None for name, force in forces.items()}
        found = implausible(given, _QUANTITIES)
        stops = () if self.stopping is None else self.stopping.doubts
        return tuple(replace(each, subject=f"drive.{each.subject}") for each in (*found, *stops))

    def doubts_with(self, payload: float | None) -> tuple[ResultWarning, ...]:
        """Return the doubts about a drive whose robot carries a payload.

        Parameters
        ----------
        payload : float or None
            In kg; ``None`` where it is not known.

        Returns
        -------
        tuple of ResultWarning
            `doubts`, and ``lighter_load`` where the stops were measured with less.
        """
        if self.stopping is None:
            return self.doubts
        return (*self.doubts, *lighter_load("drive.stopping", self.stopping, self.load, payload))


def _torques(given: object) -> Mapping[str, float]:
    if not isinstance(given, Mapping) or not given:
        raise InvalidParameterError("joint_torques", "be a table of torques by joint", given)
    return MappingProxyType({str(name): positive(f"joint_torques[{name!r}]", each) for name, each in given.items()})


# ---- files ----------------------------------------------------------------------------------------

_STOPPING: Keys = MappingProxyType(
    {
        **dict.fromkeys(("speed", "load", "extension"), kind.numbers),
        **dict.fromkeys(("time", "distance"), lambda _, value: value),
    }
)
_DRIVE: Keys = MappingProxyType(
    {
        "model": kind.word,
        **dict.fromkeys(
            ("stiffness", "damping", "push_limit", "detection_force", "reaction_time", "deceleration", "path_left"),
            kind.number,
        ),
        **dict.fromkeys(("weight", "load", "extension"), kind.number),
        "joint_torques": kind.table,
        "stopping": kind.table,
        "gravity": kind.word,
    }
)


def drive_of(table: Mapping[str, Any], path: str = "drive") -> Drive:
    """Return the drive of a table of a file.

    Parameters
    ----------
    table : mapping
        ``[drive]``.
    path : str
        What errors call it.

    Returns
    -------
    Drive
        Checked.

    Raises
    ------
    InvalidParameterError
        If a key is unknown or a value breaks a rule; the message names it.

    Examples
    --------
    >>> from hrsafety import contact
    >>> contact.drive_of({"model": "push_limit", "push_limit": 60.0}).push_limit
    60.0
    """
    given = checked(path, table, _DRIVE)
    with located(path):
        if "stopping" in given:
            stops = checked("stopping", given["stopping"], _STOPPING, required=("speed", "time", "distance"))
            with located("stopping"):
                given["stopping"] = StoppingData(**stops)
        return Drive(**given)


# ---- arms -----------------------------------------------------------------------------------------


def push_limit_of_torques(
    arm: Arm,
    joints: object,
    torques: Mapping[str, float] | float,
    *,
    link: str,
    point: object = (0.0, 0.0, 0.0),
    direction: object,
) -> Any:
    """Return the largest push of an arm in motion, F_p = m_u sum_j |(M^-1 J^T u)_j| (tau_j + |g_j|).

    The static min_j tau_j/|(J^T u)_j| is no bound while joints accelerate.

    Parameters
    ----------
    arm : Arm
        With payload and motors.
    joints : mapping or array_like (..., n)
        Values of the joints in rad, or m.
    torques : mapping of str to float, or float
        Largest torque of each free joint in N m, or N where it slides.
    link, point
        Place that touches.
    direction : array_like (..., 3)
        Direction of the push in world axes, of any length.

    Returns
    -------
    float or ndarray
        In N; inf where the point cannot move along the direction.

    Raises
    ------
    InvalidParameterError
        If a torque is missing or no joint has its name, or a value is out of range.

    Examples
    --------
    >>> from hrsafety import arms, contact
    >>> torques = {"turn": 300.0, "shoulder": 300.0, "elbow": 150.0, "wrist_1": 28.0, "wrist_2": 28.0, "wrist_3": 28.0}
    >>> arm = arms.Arm.example(armature=0.5)
    >>> pose = {"shoulder": 0.4, "elbow": 1.4}
    >>> push = contact.push_limit_of_torques(arm, pose, torques, link="tool", direction=(1, 0, 0))
    >>> 500.0 < push < 5000.0
    True
    """
    instance("arm", arm, Arm)
    given = dict(armature_of(torques, arm.free_joints))
    for name in given:
        if name not in arm.joint_names:
            rule = f"name joints that take a value: {', '.join(arm.joint_names)}"
            raise InvalidParameterError("joint_torques", rule, name)
    missing = [name for name in arm.free_joints if name not in given]
    if missing:
        raise InvalidParameterError("joint_torques", "have a torque for every free joint", missing[0], "it lacks one")
    most = np.array([positive(f"joint_torques[{name!r}]", given[name]) for name in arm.free_joints])
    unit = vectors_of("direction", direction)
    mass = np.asarray(arm.effective_mass(joints, link=link, point=point, direction=direction).mass)
    unit = unit / np.linalg.norm(unit, axis=-1, keepdims=True)
    ways = (arm.velocity(joints, {name: 1.0}, link=link, point=point) for name in arm.free_joints)
    rates = np.stack([(way * unit).sum(axis=-1) for way in ways], axis=-1)
    answers = np.linalg.solve(arm.mass_matrix(joints), rates[..., np.newaxis])[..., 0]
    pushes = (np.abs(answers) * (most + np.abs(arm.gravity_torques(joints)))).sum(axis=-1)
    found = np.where(np.isinf(mass), np.inf, np.where(np.isinf(mass), 0.0, mass) * pushes)
    return found if found.ndim else float(found)
