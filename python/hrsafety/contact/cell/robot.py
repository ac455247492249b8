"""The robot of a cell: an arm from URDF, a mobile base, or a mass that is known."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import field, replace
from pathlib import Path
from types import MappingProxyType
from typing import Annotated, Any, Self

import numpy as np
import numpy.typing as npt

from hrsafety import _keys as kind
from hrsafety._arguments import Array, Pair, checked_seed, count, instance, pair, positive, vector, word
from hrsafety._display import displayed
from hrsafety._keys import Keys, checked, one_of
from hrsafety._records import dataclass
from hrsafety.arms.arm import Arm
from hrsafety.arms.doubts import doubts_of_base, doubts_of_point, doubts_of_poses, for_rule
from hrsafety.arms.inputs import poses_of
from hrsafety.arms.masses import RULES, mass_by_rule
from hrsafety.arms.payload import Payload
from hrsafety.arms.rolling import BASE_JOINTS, RollingBase
from hrsafety.arms.tool_doubts import doubts_of_tool
from hrsafety.arms.workspaces import workspace
from hrsafety.contact.base import Base, DifferentialBase, HolonomicBase
from hrsafety.contact.drive import push_limit_of_torques
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import RANGES, ResultWarning

__all__ = ["ARM_KEYS", "ContactRobot", "arm_of", "robot_of"]

MOST_POSES = 10_000
MOST_SAMPLES = 1_000_000
LEAST_MASS = 0.3
"""A robot that weighs less, in kg, is hardly one that works beside people."""
SINGULAR = 10.0
"""A drawn pose whose mass is so many times the median is near a singular one."""
QUANTILE = 0.99
LEAST_SAMPLES = 1000
"""Fewer drawn poses hardly show the heaviest ones: a hundredth of the poses of an arm weighs many times the median."""
MOTORS = frozenset({"no_motor_inertia", "armature_suspicious"})
"""Doubts about what could only make a mass larger."""


def _motors(name: str, value: Any) -> Any:
    """Return motor inertias: one number for every joint, or a table by joint."""
    if isinstance(value, (int, float)) and not isinstance(value, bool):
        return kind.number(name, value)
    return {each: kind.number(f"{name}.{each}", inertia) for each, inertia in kind.table(name, value).items()}


EXAMPLE = "example"
"""Word in the place of a URDF for the arm of examples."""
_GIVEN: Keys = MappingProxyType({"mass": kind.number})
ARM_KEYS: Keys = MappingProxyType(
    {
        "urdf": kind.word,
        "link": kind.word,
        "point": kind.triple,
        "direction": kind.triple,
        "mass_rule": kind.word,
        "poses": kind.tables,
        "samples": kind.integer,
        "seed": kind.integer,
        "payload": kind.table,
        "armature": _motors,
        "locked": kind.words,
        "robot_mass": kind.word,
        "type_plate_mass": kind.number,
        "repair_inertia": kind.boolean,
        "mass_source": kind.word,
        "link_masses": kind.table,
        "base": kind.word,
        "base_axle": kind.pair,
        **dict.fromkeys(("base_mass", "base_inertia", "base_heading"), kind.number),
    }
)
_OPTIONS = ("armature", "locked", "type_plate_mass", "repair_inertia", "mass_source")
_PAYLOAD: Keys = MappingProxyType({"link": kind.word, "mass": kind.number, "center": kind.triple})
_BASE: Keys = MappingProxyType(
    {
        "base": kind.word,
        "point": kind.pair,
        "normal": kind.pair,
        **dict.fromkeys(("mass", "inertia", "offset", "wheel_inertia", "wheel_radius", "half_track"), kind.number),
    }
)
_BASES = MappingProxyType({"holonomic": HolonomicBase, "differential": DifferentialBase})


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class ContactRobot:
    """A robot as a contact feels it: `of_mass`, `of_base` and `of_arm` make one.

    Attributes
    ----------
    kind : {"arm", "base", "mass"}
        Where the mass is from.
    mass : float
        Mass that contacts are computed with, in kg; inf where the robot cannot yield.
    rule : str
        Which of both masses that is.
    directional_mass, iso_mass : float or None
        Effective mass in the worst pose, and that of ISO/TS 15066, in kg.
    total_mass, moving_mass, payload_mass : float or None
        Of an arm, in kg: all links, those that joints move, and what it carries.
    quantile_mass : float or None
        Of drawn poses, 99 % have at most this directional mass, in kg.
    held_mass : float or None
        Of an arm on a base that rolls: the largest directional mass if the base stood still, in kg.
    heaviest_mass : float or None
        Of an arm whose direction was given: the largest effective mass in any direction of the poses, in kg.
    push_limit : float or None
        Largest push of given joint torques in the poses, in N.
    near_singular : bool
        Whether the worst pose was drawn and weighs more than ten times the median of the draws.
    pose : dict of str to float or None
        The worst pose, values by joint.
    position, direction : tuple of float or None
        The point in it and the direction of the mass.
    poses : int
        How many were examined.
    file, sha256, name : str or None
        The URDF.
    warnings : tuple of ResultWarning
        Why masses may not be what they seem.
    inputs : dict
        Values that the robot was made with and a cell file need not give.
    """

    kind: str
    mass: Annotated[float, "kg"]
    rule: str
    directional_mass: Annotated[float | None, "kg"] = None
    iso_mass: Annotated[float | None, "kg"] = None
    total_mass: Annotated[float | None, "kg"] = None
    moving_mass: Annotated[float | None, "kg"] = None
    payload_mass: Annotated[float | None, "kg"] = None
    quantile_mass: Annotated[float | None, "kg"] = None
    held_mass: Annotated[float | None, "kg"] = None
    heaviest_mass: Annotated[float | None, "kg"] = None
    push_limit: Annotated[float | None, "N"] = None
    near_singular: bool = False
    pose: Mapping[str, float] | None = None
    position: tuple[float, ...] | None = None
    direction: tuple[float, ...] | None = None
    poses: int = 0
    file: str | None = None
    sha256: str | None = None
    name: str | None = None
    warnings: tuple[ResultWarning, ...] = ()
    inputs: Mapping[str, Any] = field(default_factory=dict)

    @classmethod
    def of_mass(cls, mass: float) -> Self:
        """Return a robot of which the mass that a contact feels is known.

        Parameters
        ----------
        mass : float
            In kg.

        Returns
        -------
        ContactRobot
            With a doubt about a mass that hardly any robot has.

        Raises
        ------
        InvalidParameterError
            If the mass is not finite and positive.

        Examples
        --------
        >>> from hrsafety import contact
        >>> contact.ContactRobot.of_mass(8.0).warnings
        ()
        """
        mass = positive("mass", mass)
        return cls(kind="mass", mass=mass, rule="given", warnings=tuple(_unlikely(mass)), inputs={"mass": mass})

    @classmethod
    def of_base(cls, base: Base, *, point: Pair, normal: Pair) -> Self:
        """Return a mobile base that touches at a point.

        Parameters
        ----------
        base : HolonomicBase or DifferentialBase
            The base.
        point, normal : tuple of two floats
            Place that touches, in m, x forward, and the outward direction there, of any length.

        Returns
        -------
        ContactRobot
            With the doubts about the base and its point.

        Raises
        ------
        InvalidParameterError
            If a value is out of its range.

        Examples
        --------
        >>> from hrsafety import contact
        >>> base = contact.HolonomicBase(mass=4.4, inertia=0.1)
        >>> contact.ContactRobot.of_base(base, point=(0.2, 0.0), normal=(1.0, 0.0)).mass
        4.4
        """
        instance("base", base, HolonomicBase, DifferentialBase)
        point, normal = pair("point", point), pair("normal", normal)
        mass = base.effective_mass(point, normal)
        length = float(np.hypot(*normal))
        return cls(
            kind="base",
            warnings=tuple(_doubts_of_base(base, point, mass)),
            mass=mass,
            rule="directional",
            directional_mass=mass,
            moving_mass=base.mass,
            position=point,
            direction=tuple(each / length for each in normal),
            inputs={"base": next(name for name, kind in _BASES.items() if isinstance(base, kind))},
        )

    @classmethod
    def of_arm(
        cls,
        arm: Arm,
        *,
        link: str | None = None,
        point: Sequence[float] = (0.0, 0.0, 0.0),
        direction: Sequence[float] | None = None,
        mass_rule: str = "larger",
        poses: npt.ArrayLike | None = None,
        samples: int = 2000,
        seed: int = 0,
        joint_torques: Mapping[str, float] | None = None,
    ) -> Self:
        """Return an arm whose worst pose counts.

        Parameters
        ----------
        arm : Arm
            With its payload and motors.
        link : str or None
            Link that touches; the last one that a joint moves when ``None``.
        point : sequence of three floats
            Place on it that touches, in m.
        direction : sequence of three floats or None
            Direction of the contact in world axes, of any length; the heaviest one when ``None``.
        mass_rule : {"larger", "iso", "directional"}
            Effective mass, that of ISO/TS 15066, or the larger one.
        poses : array_like (n, joints) or None
            Poses of the task, rad or m; drawn between the limits of the joints when ``None``.
        samples, seed : int
            Of drawn poses.
        joint_torques : mapping of str to float or None
            Largest torque of each joint in N m (N where it slides), for a push limit.

        Returns
        -------
        ContactRobot
            With the doubts about its masses.

        Raises
        ------
        InvalidParameterError
            If a value is out of its range, or no joint moves a link.
        ShapeError
            If poses are not those of the joints.

        Examples
        --------
        >>> from hrsafety import arms, contact
        >>> arm = arms.Arm.example(payload=arms.Payload("tool", 2.0))
        >>> robot = contact.ContactRobot.of_arm(arm, link="tool", poses=[[0.0, 0.4, 1.4, 0.0, 0.0, 0.0]])
        >>> round(robot.mass, 3), robot.rule
        (16.5, 'larger')
        """
        instance("arm", arm, Arm)
        if not arm.moved_links:
            raise InvalidParameterError("arm", "have a link that some joint moves", arm.name)
        rule = word("mass_rule", mass_rule, RULES)
        place: dict[str, Any] = {
            "link": arm.moved_links[-1] if link is None else link,
            "point": tuple(vector("point", point).tolist()),
        }
        more: dict[str, Any] = {} if poses is not None else _drawing(samples, seed)
        rows = workspace(arm, **more, **place).joints if poses is None else _given(poses, arm.joint_names)
        masses, directions = _masses(arm, rows, direction, place)
        worst = int(np.argmax(masses))
        mass = float(mass_by_rule(rule, masses[worst], arm.iso_mass))
        if mass <= 0.0:
            raise InvalidParameterError(
                "urdf", f"have links with masses for the rule {rule!r}", f"{mass:g} kg", "give each link its inertial"
            )
        median = float(np.quantile(masses, 0.5, method="higher"))
        quantile = float(np.quantile(masses, QUANTILE, method="higher"))
        singular = bool(more) and not masses[worst] <= SINGULAR * median
        held = _held(arm, rows, direction, place)
        doubts = [
            *for_rule(arm.warnings, rule, masses[worst], arm.iso_mass, arm.mass_source),
            *(() if more else doubts_of_poses(rows, arm.joint_names, arm.joint_kinds)),
            *doubts_of_point(place["point"], arm.reach),
            *doubts_of_tool(arm, place["link"], place["point"]),
            *(() if held is None else doubts_of_base(rule, mass, held)),
            *(() if singular else _unlikely(mass)),
        ]
        if more and len(rows) < LEAST_SAMPLES:
            doubts.append(_few_poses(len(rows)))
        if singular:
            doubts.append(_near_singular(float(masses[worst]), quantile, len(rows)))
        return cls(
            kind="arm",
            mass=mass,
            rule=rule,
            directional_mass=float(masses[worst]),
            iso_mass=arm.iso_mass,
            total_mass=arm.total_mass,
            moving_mass=arm.moving_mass,
            payload_mass=arm.payload_mass,
            quantile_mass=quantile if more else None,
            held_mass=held,
            heaviest_mass=None if direction is None else float(_masses(arm, rows, None, place)[0].max()),
            push_limit=_push(arm, rows, joint_torques, directions, place),
            near_singular=singular,
            pose=dict(zip(arm.joint_names, rows[worst].tolist(), strict=True)),
            position=tuple(arm.position(rows[worst], **place).tolist()),
            direction=tuple(directions[worst].tolist()),
            poses=len(rows),
            sha256=arm.sha256,
            name=arm.name,
            warnings=tuple(doubts),
            inputs={"link": place["link"], "point": list(place["point"]), "mass_rule": rule, **more},
        )


def _drawing(samples: int, seed: int) -> dict[str, Any]:
    return {"samples": count("samples", samples, most=MOST_SAMPLES), "seed": checked_seed("seed", seed)}


def _few_poses(rows: int) -> ResultWarning:
    words = (
        f"no poses given: the worst of {rows} drawn ones may be far from the heaviest; give the poses of the task as "
        f"poses, or {LEAST_SAMPLES} samples at least"
    )
    return ResultWarning("few_poses", "samples", words)


def _given(poses: npt.ArrayLike, names: tuple[str, ...]) -> Array:
    """Return poses of a task as rows (n, joints)."""
    rows = np.atleast_2d(poses_of(poses, names, "poses"))
    if rows.ndim != 2 or not 1 <= len(rows) <= MOST_POSES:
        raise InvalidParameterError("poses", f"be 1 to {MOST_POSES}", len(rows))
    return rows


def _masses(arm: Arm, poses: Array, direction: Sequence[float] | None, place: Mapping[str, Any]) -> tuple[Array, Array]:
    """Return directional masses in some poses and their directions: the given one, or the heaviest of each."""
    if direction is None:
        found = arm.extremes(poses, **place)
        return found.worst_mass, found.worst_direction
    masses = np.atleast_1d(arm.effective_mass(poses, direction=direction, **place).mass)
    length = float(np.linalg.norm(direction))
    return masses, np.broadcast_to(np.asarray(direction) / length, (len(poses), 3))


def _held(arm: Arm, poses: Array, direction: Sequence[float] | None, place: Mapping[str, Any]) -> float | None:
    """Return the largest directional mass if a base that rolls stood still."""
    if not isinstance(arm.base, RollingBase):
        return None
    joints = tuple(name for name in arm.free_joints if name in BASE_JOINTS)
    return float(_masses(replace(arm, locked=(*arm.locked, *joints)), poses, direction, place)[0].max())


def _push(
    arm: Arm, poses: Array, torques: Mapping[str, float] | None, directions: Array, place: Mapping[str, Any]
) -> float | None:
    """Return the largest push of joint torques in some poses, each in its own direction."""
    if torques is None:
        return None
    with kind.located("joint_torques"):
        return float(np.max(push_limit_of_torques(arm, poses, torques, direction=directions, **place)))


def _near_singular(worst: float, quantile: float, poses: int) -> ResultWarning:
    """Return the note that the worst drawn pose is one in which an arm hardly yields."""
    shown = "unbounded" if np.isinf(worst) else f"{worst:.4g} kg"
    others = "unbounded" if np.isinf(quantile) else f"at most {quantile:.4g} kg"
    message = (
        f"no poses given: the worst of {poses} drawn ones is near a singular pose, in which the point hardly yields "
        f"({shown}; {100 * QUANTILE:g} % of them: {others}): give the poses of the task as poses"
    )
    return ResultWarning("near_singular", "robot.poses", message, safe_side=True)


def _unlikely(mass: float) -> Iterator[ResultWarning]:
    """Yield a doubt about a mass that hardly any robot has; a heavier robot than meant is the more careful one."""
    most = RANGES["effective_mass"].most
    if mass < LEAST_MASS:
        message = (
            f"the robot weighs {mass:.3g} kg, less than {LEAST_MASS:g} kg: t given for kg, or masses that are no data?"
        )
        yield ResultWarning("implausible", "robot.mass", message)
    elif most < mass < float("inf"):
        message = f"the robot weighs {mass:g} kg, more than {most:g} kg: g given for kg?"
        yield ResultWarning("implausible", "robot.mass", message, safe_side=True)


def _doubts_of_base(base: Base, point: Pair, mass: float) -> Iterator[ResultWarning]:
    """Yield what is hardly meant of a mobile base."""
    yield from _unlikely(mass)
    # What no wheel can make heavier is not a doubt.
    yield from (each for each in base.warnings if each.code not in MOTORS or mass < float("inf"))
    away = float(np.hypot(*point))
    if away > 5.0:
        message = f"the point is {away:g} m from the middle of the base: mm or cm given for m?"
        yield ResultWarning("implausible", "robot.point", message)


# ---- tables of files ------------------------------------------------------------------------------


def robot_of(table: Mapping[str, Any], folder: Path, joint_torques: Mapping[str, float] | None = None) -> ContactRobot:
    """Return the robot of a table.

    Parameters
    ----------
    table : mapping
        ``[robot]`` of the file.
    folder : Path
        Where the file is.
    joint_torques : mapping of str to float or None
        Of the drive of an arm.

    Returns
    -------
    ContactRobot
        With the mass that contacts feel.
    """
    if "urdf" in table:
        return _arm(checked("", table, ARM_KEYS, required=("urdf",)), folder, joint_torques)
    if "base" in table:
        return _base(checked("", table, _BASE, required=("base", "mass", "inertia", "point", "normal")))
    mass = checked("", table, _GIVEN, required=("mass",))["mass"]
    if not 0.0 < mass < float("inf"):
        raise InvalidParameterError("mass", "be finite and positive", mass, "or give urdf, or base")
    return ContactRobot.of_mass(mass)


def _base(values: dict[str, Any]) -> ContactRobot:
    made: Any = _BASES[one_of("base", values.pop("base"), _BASES)]
    point, normal = values.pop("point"), values.pop("normal")
    for name in values:
        if name not in made.__dataclass_fields__:
            raise InvalidParameterError(name, "be left out for a holonomic base", values[name])
    return ContactRobot.of_base(made(**values), point=point, normal=normal)


def arm_of(values: Mapping[str, Any], folder: Path) -> Arm:
    """Return the arm of a table."""
    payload = None
    if "payload" in values:
        payload = Payload(**checked("payload", values["payload"], _PAYLOAD, required=("link", "mass")))
    options: dict[str, Any] = {name: values[name] for name in _OPTIONS if name in values}
    options = {name: None if each in ({}, ()) else each for name, each in options.items()}
    options |= {"payload": payload, "base": _rolling(values)}
    if "link_masses" in values:
        masses = values["link_masses"]
        options["link_masses"] = {name: kind.number(f"link_masses.{name}", each) for name, each in masses.items()}
    try:
        own = values["urdf"] == EXAMPLE and not (folder / EXAMPLE).exists()
        arm = Arm.example(**options) if own else Arm.from_urdf(folder / values["urdf"], **options)
    except InvalidParameterError as error:
        raise error.renamed("urdf" if error.argument == "path_or_text" else error.argument) from None
    if not arm.moved_links:
        raise InvalidParameterError("urdf", "have a link that some joint moves", values["urdf"])
    return arm


def _rolling(values: Mapping[str, Any]) -> RollingBase | str | None:
    """Return what an arm stands on."""
    given = {key: values[f"base_{key}"] for key in ("mass", "inertia", "axle", "heading") if f"base_{key}" in values}
    word = values.get("base")
    if word is None or one_of("base", word, ("fixed", "differential", "omni")) == "fixed":
        if given:
            name = f"base_{next(iter(given))}"
            raise InvalidParameterError(name, "come with a base that rolls", values[name], 'base = "differential"')
        return word
    if "mass" not in given:
        raise kind.missing("base_mass", "of all that rolls below the arm, in kg")
    return RollingBase(kind=word, **given)


def _rule(values: Mapping[str, Any]) -> str:
    if "robot_mass" in values and "mass_rule" in values:
        raise InvalidParameterError("robot_mass", "be left out beside mass_rule", values["robot_mass"])
    name = "robot_mass" if "robot_mass" in values else "mass_rule"
    return one_of(name, values.get(name, "larger"), RULES)


def _arm(values: dict[str, Any], folder: Path, joint_torques: Mapping[str, float] | None) -> ContactRobot:
    arm, rule = arm_of(values, folder), _rule(values)
    given: dict[str, Any] = {
        name: values[name] for name in ("link", "point", "direction", "samples", "seed") if name in values
    }
    if "poses" in values:
        for name in ("samples", "seed"):
            if name in values:
                raise InvalidParameterError(name, "be left out beside poses", values[name])
        if not 1 <= len(values["poses"]) <= MOST_POSES:
            raise InvalidParameterError("poses", f"be 1 to {MOST_POSES}", len(values["poses"]))
        rows = []
        for index, each in enumerate(values["poses"]):
            with kind.located(f"poses[{index}]"):
                numbers = {name: kind.number(name, value) for name, value in each.items()}
                rows.append(poses_of(numbers, arm.joint_names))
        given["poses"] = np.array(rows).reshape(len(rows), len(arm.joint_names))
    made = ContactRobot.of_arm(arm, mass_rule=rule, joint_torques=joint_torques, **given)
    return replace(made, file=values["urdf"])
