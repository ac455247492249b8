"""The robot of a cell file: an arm from URDF, a mobile base, or a mass that is known."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from hrsafety import arms, contact
from hrsafety._records import dataclass
from hrsafety.arms.inputs import poses_of
from hrsafety.arms.masses import RULES, mass_by_rule
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning
from hrsafety.scenarios import keys as kind
from hrsafety.scenarios.keys import Keys, checked, one_of

__all__ = ["RobotFacts", "robot_of"]

MOST_POSES = 10_000
MOST_SAMPLES = 1_000_000

_GIVEN: Keys = MappingProxyType({"mass": kind.number})
_ARM: Keys = MappingProxyType(
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
        "armature": kind.table,
        "locked": kind.words,
    }
)
_PAYLOAD: Keys = MappingProxyType({"link": kind.word, "mass": kind.number, "center": kind.triple})
_BASE: Keys = MappingProxyType(
    {
        "base": kind.word,
        "point": kind.pair,
        "normal": kind.pair,
        **dict.fromkeys(("mass", "inertia", "offset", "wheel_inertia", "wheel_radius", "half_track"), kind.number),
    }
)
_BASES = MappingProxyType({"holonomic": contact.HolonomicBase, "differential": contact.DifferentialBase})


@dataclass(frozen=True, kw_only=True, slots=True)
class RobotFacts:
    """A robot as a contact feels it.

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
    moving_mass, payload_mass : float or None
        Of an arm, in kg.
    pose : dict of str to float or None
        The worst pose, values by joint.
    position, direction : tuple of float or None
        The point in it and the direction of the mass.
    poses : int
        How many were looked at.
    file, sha256, name : str or None
        The URDF.
    warnings : tuple of ResultWarning
        Why masses may not be what they seem.
    inputs : dict
        Defaults that the file did not give.
    """

    kind: str
    mass: float
    rule: str
    directional_mass: float | None = None
    iso_mass: float | None = None
    moving_mass: float | None = None
    payload_mass: float | None = None
    pose: Mapping[str, float] | None = None
    position: tuple[float, ...] | None = None
    direction: tuple[float, ...] | None = None
    poses: int = 0
    file: str | None = None
    sha256: str | None = None
    name: str | None = None
    warnings: tuple[ResultWarning, ...] = ()
    inputs: Mapping[str, Any] = field(default_factory=dict)


def robot_of(table: Mapping[str, Any], folder: Path) -> RobotFacts:
    """Return the robot of a table.

    Parameters
    ----------
    table : mapping
        ``[robot]`` of the file.
    folder : Path
        Where the file is.

    Returns
    -------
    RobotFacts
        With the mass that contacts feel.
    """
    if "urdf" in table:
        return _arm(checked("", table, _ARM, required=("urdf",)), folder)
    if "base" in table:
        return _base(checked("", table, _BASE, required=("base", "mass", "inertia", "point", "normal")))
    mass = checked("", table, _GIVEN, required=("mass",))["mass"]
    if not 0.0 < mass < float("inf"):
        raise InvalidParameterError("mass", "be finite and positive", mass, "or give urdf, or base")
    return RobotFacts(kind="mass", mass=mass, rule="given")


def _base(values: dict[str, Any]) -> RobotFacts:
    made: Any = _BASES[one_of("base", values.pop("base"), _BASES)]
    point, normal = values.pop("point"), values.pop("normal")
    for name in values:
        if name not in made.__dataclass_fields__:
            raise InvalidParameterError(name, "be left out for a holonomic base", values[name])
    base = made(**values)
    mass = base.effective_mass(point, normal)
    length = float(np.hypot(*normal))
    return RobotFacts(
        kind="base",
        mass=mass,
        rule="directional",
        directional_mass=mass,
        moving_mass=base.mass,
        position=point,
        direction=tuple(each / length for each in normal),
    )


def _arm(values: dict[str, Any], folder: Path) -> RobotFacts:
    payload = None
    if "payload" in values:
        given = checked("payload", values["payload"], _PAYLOAD, required=("link", "mass"))
        payload = arms.Payload(**given)
    motors = {name: kind.number(f"armature.{name}", value) for name, value in values.get("armature", {}).items()}
    options: dict[str, Any] = {"payload": payload, "armature": motors or None, "locked": values.get("locked") or None}
    try:
        arm = arms.Arm.from_urdf(folder / values["urdf"], **options)
    except InvalidParameterError as error:
        raise error.renamed("urdf" if error.argument == "path_or_text" else error.argument) from None
    if not arm.moved_links:
        raise InvalidParameterError("urdf", "have a link that some joint moves", values["urdf"])
    rule = one_of("mass_rule", values.get("mass_rule", "larger"), RULES)
    place: dict[str, Any] = {"link": values.get("link", arm.moved_links[-1]), "point": values.get("point", (0.0,) * 3)}
    poses, more = _poses(arm, values, place)
    if "direction" in values:
        masses = np.atleast_1d(arm.effective_mass(poses, direction=values["direction"], **place))
        length = float(np.linalg.norm(values["direction"]))
        directions = np.broadcast_to(np.asarray(values["direction"]) / length, (len(poses), 3))
    else:
        found = arm.extremes(poses, **place)
        masses, directions = found.worst_mass, found.worst_direction
    worst = int(np.argmax(masses))
    pose = dict(zip(arm.joint_names, poses[worst].tolist(), strict=True))
    return RobotFacts(
        kind="arm",
        mass=float(mass_by_rule(rule, masses[worst], arm.iso_mass)),
        rule=rule,
        directional_mass=float(masses[worst]),
        iso_mass=arm.iso_mass,
        moving_mass=arm.moving_mass,
        payload_mass=arm.payload_mass,
        pose=pose,
        position=tuple(arm.position(poses[worst], **place).tolist()),
        direction=tuple(directions[worst].tolist()),
        poses=len(poses),
        file=values["urdf"],
        sha256=arm.sha256,
        name=arm.name,
        warnings=arm.warnings,
        inputs={"link": place["link"], "point": list(place["point"]), "mass_rule": rule, **more},
    )


def _poses(arm: arms.Arm, values: Mapping[str, Any], place: Mapping[str, Any]) -> tuple[Any, dict[str, Any]]:
    """Return the poses that are looked at, (n, joints), and what the file left to a default."""
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
        return np.array(rows).reshape(len(rows), len(arm.joint_names)), {}
    samples, seed = values.get("samples", 2000), values.get("seed", 0)
    if not 1 <= samples <= MOST_SAMPLES:
        raise InvalidParameterError("samples", f"be from 1 to {MOST_SAMPLES}", samples)
    drawn = arms.workspace(arm, samples=samples, seed=seed, **place).joints
    return drawn, {"samples": samples, "seed": seed}
