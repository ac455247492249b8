"""Arms from MJCF, the format of MuJoCo: the compiled model written as a URDF."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple
from xml.sax.saxutils import quoteattr

import numpy as np

from hrsafety._arguments import Array
from hrsafety.errors import InvalidParameterError, MissingExtraError, Shown
from hrsafety.plausibility import ResultWarning

__all__ = ["MjcfArm", "is_mjcf", "mjcf_arm"]

# A comment, once read, is not read again as a longer one: no choice is taken back.
_ROOT = re.compile(r"\s*+(?>(?:<\?.*?\?>|<!--.*?-->|<!DOCTYPE[^>]*>)\s*+)*+<mujoco[\s/>]", re.DOTALL)
_NAN = re.compile(r"""["'\s]nan["'\s]""", re.IGNORECASE)
WATER = 1000.0
"""Density in kg/m^3 that MuJoCo takes where a file gives none."""
ALIKE = 3
"""Motors from which one number for all of them is doubted."""
SLIDE, HINGE = 2, 3
"""Codes of joints that an arm has."""
OF_JOINTS = 2
"""Code of an equality between joints."""


class MjcfArm(NamedTuple):
    """An arm of an MJCF file.

    Attributes
    ----------
    urdf : str
        Its links, joints and inertias.
    armature : dict of str to float
        Motor inertia of each joint that has one.
    doubts : tuple of ResultWarning
        About masses that the file does not give.
    """

    urdf: str
    armature: dict[str, float]
    doubts: tuple[ResultWarning, ...]


def is_mjcf(text: str) -> bool:
    """Return whether a text is MJCF, by its root element."""
    return _ROOT.match(text) is not None


def mjcf_arm(text: str, path: Path | None = None) -> MjcfArm:
    """Return the arm of an MJCF file, as MuJoCo compiles it.

    Parameters
    ----------
    text : str
        The file.
    path : Path or None
        Where it is: files that it includes are beside it.

    Raises
    ------
    MissingExtraError
        Without MuJoCo.
    InvalidParameterError
        If it cannot be compiled, or holds what an arm does not: free and ball joints, loops, joints whose zero is not
        the pose of the file.
    """
    name = "path_or_text" if path is None else path.name
    try:
        import mujoco
    except ModuleNotFoundError:
        raise MissingExtraError(f"{name} is MJCF and needs mujoco: pip install hrsafety[mjcf]") from None
    if _NAN.search(text) is not None:
        raise InvalidParameterError(name, "hold numbers", Shown("nan"))
    # Warnings of MuJoCo go to a file in the working folder unless somebody takes them.
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(lambda _message: None)
    try:
        described = mujoco.MjSpec.from_string(text) if path is None else mujoco.MjSpec.from_file(str(path))
        model = described.compile()
    except Exception as error:  # of the compiler: any may fail
        found = Shown(" ".join(str(error).split())[:200] or type(error).__name__)
        raise InvalidParameterError(name, "be MJCF that MuJoCo compiles", found) from None
    finally:
        mujoco.set_mju_user_warning(before)
    guessed = [
        each.name or "without a name"
        for each in described.bodies
        if not each.explicitinertial
        and any(np.isnan(geom.mass) and geom.density == WATER for geom in each.geoms)
        and float(model.body_mass[each.id]) > 0.0
    ]
    arm = _Written(model, name)
    urdf = "\n".join(arm.lines())
    doubts = () if not guessed else (_guessed(guessed),)
    return MjcfArm(urdf, arm.armature, doubts)


def _guessed(names: list[str]) -> ResultWarning:
    """Return the doubt about masses that are shapes filled with water."""
    shown = ", ".join(names[:5]) + (" and others" if len(names) > 5 else "")
    message = (
        f"masses of {shown} are volumes of shapes times {WATER:g} kg/m^3, for the MJCF gives none: "
        "give inertial, or mass or density of the geoms"
    )
    return ResultWarning("density", "urdf", message)


def filled_in(armature: dict[str, float]) -> Iterator[ResultWarning]:
    """Yield a doubt about motor inertias of a file that are one number for three joints or more."""
    values = list(armature.values())
    if len(values) >= ALIKE and len(set(values)) == 1:
        message = (
            f"armature of the MJCF is {values[0]:g} for all of its {len(values)} motors: such a number is often chosen "
            "for a stable simulation, and motors of a hand and of a shoulder differ; give armature"
        )
        yield ResultWarning("armature_suspicious", "armature", message)


class _Written:
    """A compiled model as the lines of a URDF."""

    def __init__(self, model: Any, name: str) -> None:
        self.model, self.name = model, name
        self.armature: dict[str, float] = {}
        self.mimics = dict(self._mimics())
        if np.any(model.tendon_armature > 0.0):
            self._refuse("tendon", "have no armature", "one that has")

    def _refuse(self, what: str, rule: str, found: object) -> None:
        raise InvalidParameterError(f"{self.name}: {what}", rule, Shown(str(found)))

    def _body(self, index: int) -> str:
        return str(self.model.body(index).name) or f"body_{index}"

    def _joint(self, index: int) -> str:
        return str(self.model.joint(index).name) or f"joint_{index}"

    def _mimics(self) -> Iterator[tuple[int, tuple[str, float, float]]]:
        """Yield the joint that another one moves, with multiplier and offset, of each joint that follows."""
        model = self.model
        for index in range(model.neq):
            if not model.eq_active0[index]:
                continue
            first, second = int(model.eq_obj1id[index]), int(model.eq_obj2id[index])
            rule = "be lines of two joints: loops and curves are not read"
            if int(model.eq_type[index]) != OF_JOINTS or second < 0 or np.any(model.eq_data[index, 2:5] != 0.0):
                self._refuse(f"equality {index + 1}", rule, "another one")
            offset, slope = model.eq_data[index, :2].tolist()
            yield first, (self._joint(second), slope, offset)

    def lines(self) -> Iterator[str]:
        """Yield the lines."""
        model = self.model
        yield '<robot name="mjcf">'
        yield f"<link name={quoteattr(self._body(0))}/>"
        for body in range(1, model.nbody):
            yield from self._chain(body)
            mass = float(model.body_mass[body])
            yield f"<link name={quoteattr(self._body(body))}>"
            if mass > 0.0:
                place = _origin(model.body_ipos[body], model.body_iquat[body])
                x, y, z = model.body_inertia[body].tolist()
                inertia = f'<inertia ixx="{x!r}" iyy="{y!r}" izz="{z!r}" ixy="0" ixz="0" iyz="0"/>'
                yield f'<inertial>{place}<mass value="{mass!r}"/>{inertia}</inertial>'
            yield "</link>"
        yield "</robot>"

    def _chain(self, body: int) -> Iterator[str]:
        """Yield the joints of a body, one behind the other, with the links between them."""
        model = self.model
        before, own = self._body(int(model.body_parentid[body])), self._body(body)
        joints = range(int(model.body_jntadr[body]), int(model.body_jntadr[body]) + int(model.body_jntnum[body]))
        turn: Array = _matrix(model.body_quat[body])
        origin = _origin(model.body_pos[body], model.body_quat[body])
        if not len(joints):
            yield _fixed(f"{own}/fixed", before, own, origin)
            return
        here = np.zeros(3)
        for place, joint in enumerate(joints):
            anchor = np.array(model.jnt_pos[joint])
            shift = np.array(model.body_pos[body]) + turn @ anchor if place == 0 else anchor - here
            rotation = model.body_quat[body] if place == 0 else np.array([1.0, 0.0, 0.0, 0.0])
            here = anchor
            last = place == len(joints) - 1 and not here.any()
            after = own if last else f"{own}/{self._joint(joint)}"
            yield from self._moving(joint, before, after, _origin(shift, rotation))
            if not last:
                yield f"<link name={quoteattr(after)}/>"
            before = after
        if here.any():
            yield _fixed(f"{own}/fixed", before, own, _origin(-here, np.array([1.0, 0.0, 0.0, 0.0])))

    def _moving(self, joint: int, before: str, after: str, origin: str) -> Iterator[str]:
        """Yield a joint that moves."""
        model, name = self.model, self._joint(joint)
        kind, at = int(model.jnt_type[joint]), int(model.jnt_qposadr[joint])
        if kind not in (SLIDE, HINGE):
            self._refuse(f"joint {name}", "be a hinge or a slide: the base stands still here", "a free or a ball joint")
        if float(model.qpos0[at]) != 0.0:
            self._refuse(f"joint {name}: ref", "be 0: values of joints are those of the file", float(model.qpos0[at]))
        armature = float(model.dof_armature[model.jnt_dofadr[joint]])
        if armature > 0.0:
            self.armature[name] = armature
        limited = bool(model.jnt_limited[joint])
        word = "prismatic" if kind == SLIDE else "revolute" if limited else "continuous"
        yield f'<joint name={quoteattr(name)} type="{word}">'
        yield f"<parent link={quoteattr(before)}/><child link={quoteattr(after)}/>{origin}"
        yield f'<axis xyz="{_numbers(model.jnt_axis[joint])}"/>'
        if limited:
            low, high = model.jnt_range[joint].tolist()
            yield f'<limit lower="{low!r}" upper="{high!r}"/>'
        elif kind == SLIDE:
            yield '<limit lower="-1e6" upper="1e6"/>'
        if joint in self.mimics:
            other, slope, offset = self.mimics[joint]
            yield f'<mimic joint={quoteattr(other)} multiplier="{slope!r}" offset="{offset!r}"/>'
        yield "</joint>"


def _fixed(name: str, before: str, after: str, origin: str) -> str:
    links = f"<parent link={quoteattr(before)}/><child link={quoteattr(after)}/>"
    return f'<joint name={quoteattr(name)} type="fixed">{links}{origin}</joint>'


def _numbers(values: Any) -> str:
    return " ".join(repr(float(each)) for each in values)


def _matrix(quaternion: Any) -> Array:
    w, x, y, z = (np.array(quaternion) / np.linalg.norm(quaternion)).tolist()
    return np.array(
        [
            [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
            [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
            [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
        ]
    )


def _origin(place: Any, quaternion: Any) -> str:
    """Return a frame by its place and its turns about the fixed axes x, y, z."""
    turn = _matrix(quaternion)
    yaw = np.arctan2(turn[1, 0], turn[0, 0])
    s, c = np.sin(yaw), np.cos(yaw)
    pitch = np.arctan2(-turn[2, 0], c * turn[0, 0] + s * turn[1, 0])
    # With the turn about z taken off, what is left is exact where the pitch is a right angle, too.
    roll = np.arctan2(s * turn[0, 2] - c * turn[1, 2], c * turn[1, 1] - s * turn[0, 1])
    return f'<origin xyz="{_numbers(place)}" rpy="{_numbers((roll, pitch, yaw))}"/>'
