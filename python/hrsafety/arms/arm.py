"""An arm from URDF: masses of its points by pose and direction."""

from __future__ import annotations

import hashlib
import os
from dataclasses import field
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import Array, checked_text, count, flag, instance, positive, sequence, thread_count, word
from hrsafety._bounds import MOST_MASSES, MOST_POINT_STATES
from hrsafety._records import dataclass
from hrsafety.arms.doubts import doubts_of_point, doubts_of_poses, for_rule
from hrsafety.arms.facts import Facts
from hrsafety.arms.inputs import (
    armature_of,
    broadcast,
    locked_of,
    motors_of,
    poses_of,
    urdf_text,
    vectors_of,
)
from hrsafety.arms.masses import RULES, EffectiveMass, Extremes, PointMasses, mass_by_rule
from hrsafety.arms.mjcf import filled_in, is_mjcf, mjcf_arm
from hrsafety.arms.payload import Payload, payloads_of
from hrsafety.arms.rolling import RollingBase
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, telling

__all__ = ["MASS_SOURCES", "Arm"]

MASS_SOURCES = ("links", "type_plate", "scaled")
GRAVITY = 9.80665


@dataclass(frozen=True, slots=True, repr=False)
class Arm(Facts):
    """An arm on a base that stands still, as a URDF describes it.

    Make it by `from_urdf`. Values of joints are arrays whose last axis has the order of `joint_names`, or mappings
    from names to numbers or arrays; joints that are not named are at 0. Values, points and directions broadcast.

    Parameters
    ----------
    urdf : str
        Text of the URDF.
    payloads : tuple of Payload
        What the arm carries.
    armature : tuple of (str, float)
        Reflected motor inertia n^2 J_m by joint, in kg m^2, or in kg where the joint slides.
    locked : tuple of str
        Joints that keep their value.
    repair_inertia : bool
        Whether every inertia that no rigid body has is replaced by the nearest one, see `from_urdf`.
    type_plate_mass : float or None
        Mass on the type plate, without payload and controller, in kg.
    mass_source : {"links", "type_plate", "scaled"}
        Where masses are from, see `from_urdf`.
    link_masses : tuple of (str, float)
        Masses in kg of links whose URDF has none.
    base : RollingBase, "fixed" or None
        What the arm stands on; ``None``: it is taken to stand still, and doubted where it looks like one that rolls.
    notes : tuple of ResultWarning
        Doubts about the file that the URDF was made of.

    Raises
    ------
    InvalidParameterError
        If an element of the URDF breaks a rule; the message names it.

    Examples
    --------
    >>> from hrsafety import arms
    >>> arm = arms.Arm.example()
    >>> arm.joint_names[:3]
    ('turn', 'shoulder', 'elbow')
    >>> pose = {"shoulder": 0.4, "elbow": 1.4}
    >>> found = arm.effective_mass(pose, link="tool", direction=(1, 0, 0))
    >>> f"{float(found):.3f} kg, ISO {arm.iso_mass:.1f} kg"
    '6.923 kg, ISO 14.5 kg'
    >>> [doubt.code for doubt in found.warnings]
    ['no_motor_inertia']
    """

    urdf: str
    payloads: tuple[Payload, ...] = ()
    armature: tuple[tuple[str, float], ...] = ()
    locked: tuple[str, ...] = ()
    repair_inertia: bool = False
    type_plate_mass: float | None = None
    mass_source: str = "links"
    link_masses: tuple[tuple[str, float], ...] = ()
    base: RollingBase | str | None = None
    notes: tuple[ResultWarning, ...] = ()
    _native: _hrsafety.Arm = field(init=False, repr=False, compare=False)
    _facts: dict[str, Any] = field(init=False, repr=False, compare=False)
    _doubts: tuple[ResultWarning, ...] = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Read the URDF and check everything."""
        checked_text("urdf", self.urdf, "be the text of a URDF")
        self._set(
            payloads=payloads_of(list(sequence("payloads", "be a tuple of Payload", self.payloads))),
            armature=motors_of(self.armature),
            locked=locked_of(sequence("locked", "be a tuple of names of joints", self.locked)),
            repair_inertia=flag("repair_inertia", self.repair_inertia),
        )
        if self.type_plate_mass is not None:
            self._set(type_plate_mass=positive("type_plate_mass", self.type_plate_mass))
        word("mass_source", self.mass_source, MASS_SOURCES)
        if self.mass_source != "links" and self.type_plate_mass is None:
            raise InvalidParameterError("type_plate_mass", f"be given for mass_source {self.mass_source!r}", None)
        self._set(link_masses=motors_of(self.link_masses, "link_masses", "a link and its mass"))
        if self.base != "fixed" and self.base is not None:
            instance("base", self.base, RollingBase)
        for each in sequence("notes", "be a tuple of ResultWarning", self.notes):
            instance("notes", each, ResultWarning)
        self._set(notes=tuple(self.notes))
        native = _hrsafety.Arm(
            self.urdf,
            payloads=[(each.link, each.mass, each.center, each.inertia) for each in self.payloads],
            armature=list(self.armature),
            locked=list(self.locked),
            repair_inertia=self.repair_inertia,
            link_masses=list(self.link_masses),
            scaled_to=self.type_plate_mass if self.mass_source == "scaled" else None,
            base=self.base.native if isinstance(self.base, RollingBase) else None,
        )
        self._set(_native=native, _facts=dict(native.facts()))
        self._set(_doubts=self._doubted())

    @classmethod
    @telling()
    def from_urdf(
        cls,
        path_or_text: str | os.PathLike[str],
        payload: object = None,
        armature: object = None,
        locked: object = None,
        *,
        repair_inertia: bool = False,
        type_plate_mass: float | None = None,
        mass_source: str = "links",
        link_masses: object = None,
        base: RollingBase | str | None = None,
    ) -> Arm:
        """Read an arm.

        Parameters
        ----------
        path_or_text : path-like or str
            A URDF file, a file of macros (``.xacro``, with the extra ``arms``), or one of MuJoCo (with the extra
            ``mjcf``), or the text of a URDF or MJCF. Motor inertias of MJCF are taken unless others are given.
        payload : Payload, mapping, tuple, or sequence of them, or None
            What the arm carries: link, mass, center and inertia of each.
        armature : mapping of str to float, array_like (n,), float or None
            Reflected motor inertia n^2 J_m of each joint. URDF cannot hold it; without it effective masses are lower
            bounds, on the unsafe side.
        locked : iterable of str or None
            Joints that keep their value, such as those of a closed gripper; a joint that mimics another one follows
            that one, locked or not.
        repair_inertia : bool
            An inertia I belongs to a rigid body if S = tr(I)/2 - I, the second moments of its mass, is positive
            semidefinite. Where it is not, eigenvalues of S below 0 become 0, and tr(S') - S' is taken: the nearest
            in the Frobenius norm of S, which never lowers an effective mass. That is done with a warning where the
            least eigenvalue of S is at most 10 % of tr(I) below 0, and for links below 1 % of the moving mass. Any
            other one is an error, or with this option repaired, too. Inertias of links that stand still are not used.
        type_plate_mass : float or None
            Mass of the arm on its type plate, without payload and controller, in kg: masses of links that do not fit
            it are doubted.
        mass_source : {"links", "type_plate", "scaled"}
            Masses of the URDF; or the mass of ISO/TS 15066 from half of the type plate; or masses and inertias of the
            URDF in proportion, so that they weigh what the type plate says.
        link_masses : mapping of str to float or None
            Masses in kg of links whose URDF has none: their collision shape filled evenly if that is of primitives,
            else a solid cylinder from the joint to the middle of the next ones with a tenth of that for a radius.
        base : RollingBase, "fixed" or None
            What the arm stands on.

        Returns
        -------
        Arm
            The arm.

        Raises
        ------
        InvalidParameterError
            If the file cannot be read, or an element breaks a rule, which the message names.
        """
        text, name = urdf_text(path_or_text)
        notes: tuple[ResultWarning, ...] = ()
        if is_mjcf(text):
            found = mjcf_arm(text, Path(str(path_or_text)) if name else None)
            text, notes = found.urdf, found.doubts
            if armature is None:
                armature = found.armature or None
                notes = (*notes, *filled_in(found.armature))
        try:
            motors = armature_of(armature, () if armature is None else tuple(_hrsafety.urdf_joint_names(text)))
            masses = armature_of(link_masses, (), "link_masses")
            more = (repair_inertia, type_plate_mass, mass_source, masses, base)
            return cls(text, payloads_of(payload), motors, locked_of(locked), *more, notes)
        except InvalidParameterError as error:
            options = ("payload", "armature", "locked", "repair_inertia", "type_plate_mass")
            if not name or error.argument.startswith((*options, "mass_source", "link_masses", "base")):
                raise
            raise error.renamed(f"{name}: {error.argument}") from None

    @classmethod
    def example(cls, **options: Any) -> Arm:
        """Return an arm of six axes and 1.3 m reach for examples; no real product.

        Parameters
        ----------
        **options
            As for `from_urdf`.

        Returns
        -------
        Arm
            The arm; its last link is ``tool``.
        """
        file = resources.files("hrsafety.arms") / "data" / "example_arm.urdf"
        return cls.from_urdf(file.read_text(encoding="utf-8"), **options)

    @property
    def sha256(self) -> str:
        """SHA-256 of the text of the URDF, as hexadecimal digits."""
        return hashlib.sha256(self.urdf.encode("utf-8")).hexdigest()

    def __repr__(self) -> str:
        """Return name, joints, masses and the start of the hash."""
        carried = f", payload {self.payload_mass:g} kg" if self.payloads else ""
        locked = f", locked {', '.join(self.locked)}" if self.locked else ""
        joints = f"{len(self.joint_names)} joints{locked}, {self.moving_mass:g} kg moving{carried}"
        return f"<Arm {self.name!r}: {joints}, SHA-256 {self.sha256[:12]}>"

    # ---- masses ---------------------------------------------------------------------------------

    @telling()
    def effective_mass(
        self,
        joints: object = None,
        *,
        link: str,
        point: object = (0.0, 0.0, 0.0),
        direction: object,
        check_limits: bool = True,
        threads: int | None = None,
    ) -> EffectiveMass:
        """Return the mass of a point along directions, m_u = 1/(u^T J M^-1 J^T u).

        Parameters
        ----------
        joints : mapping or array_like (..., n)
            Values of the joints in rad, or m where they slide.
        link : str
            The link that the point is fixed to.
        point : array_like (..., 3)
            The point in the frame of the link, in m.
        direction : array_like (..., 3)
            Directions in world axes; their length does not matter.
        check_limits : bool
            Whether values outside the limits of their joints are errors.
        threads : int or None
            Number of threads; all cores when ``None``. It changes no bit.

        Returns
        -------
        EffectiveMass
            Masses in kg, inf where no motion of the joints moves the point along the direction, and the doubts about
            them.

        Raises
        ------
        InvalidParameterError
            If a value is out of range, a direction is zero, or the mass matrix of a pose is singular.
        """
        return self.robot_mass(
            joints,
            link=link,
            point=point,
            direction=direction,
            rule="directional",
            check_limits=check_limits,
            threads=threads,
        )

    @telling()
    def point_masses(
        self,
        joints: object = None,
        *,
        link: str,
        point: object = (0.0, 0.0, 0.0),
        direction: object,
        check_limits: bool = True,
        threads: int | None = None,
    ) -> PointMasses:
        """Return all masses of a point: along directions, the extremes, and that of ISO/TS 15066.

        Parameters
        ----------
        joints, link, point, direction, check_limits, threads
            As for `effective_mass`.

        Returns
        -------
        PointMasses
            The masses with the warnings that belong beside them.
        """
        poses, points = poses_of(joints, self.joint_names), vectors_of("point", point)
        directions = vectors_of("direction", direction)
        mass = self._along(poses, points, directions, link, check_limits, threads)
        states = self._states(poses, points, link, check_limits, threads)
        scaled = directions / np.max(np.abs(directions), axis=-1, keepdims=True)
        return PointMasses(
            position=states["position"],
            direction=scaled / np.linalg.norm(scaled, axis=-1, keepdims=True),
            effective_mass=mass,
            iso_mass=self.iso_mass,
            extremes=self._extremes(states, poses, points),
            mobility=states["mobility"],
            warnings=(*self.warnings, *self._placed(poses, points)),
        )

    @telling()
    def extremes(
        self,
        joints: object = None,
        *,
        link: str,
        point: object = (0.0, 0.0, 0.0),
        check_limits: bool = True,
        threads: int | None = None,
    ) -> Extremes:
        """Return the heaviest and the lightest direction of a point.

        Parameters
        ----------
        joints, link, point, check_limits, threads
            As for `effective_mass`.

        Returns
        -------
        Extremes
            Masses and directions; the worst mass is inf where a direction is unbounded.
        """
        poses, points = poses_of(joints, self.joint_names), vectors_of("point", point)
        return self._extremes(self._states(poses, points, link, check_limits, threads), poses, points)

    def mobility(
        self,
        joints: object = None,
        *,
        link: str,
        point: object = (0.0, 0.0, 0.0),
        check_limits: bool = True,
        threads: int | None = None,
    ) -> Array:
        """Return the mobility L = J M^-1 J^T of a point.

        Parameters
        ----------
        joints, link, point, check_limits, threads
            As for `effective_mass`.

        Returns
        -------
        ndarray (..., 3, 3)
            In 1/kg, along world axes.
        """
        poses, points = poses_of(joints, self.joint_names), vectors_of("point", point)
        return self._states(poses, points, link, check_limits, threads)["mobility"]

    def position(
        self,
        joints: object = None,
        *,
        link: str,
        point: object = (0.0, 0.0, 0.0),
        check_limits: bool = True,
        threads: int | None = None,
    ) -> Array:
        """Return where a point stands.

        Parameters
        ----------
        joints, link, point, check_limits, threads
            As for `effective_mass`.

        Returns
        -------
        ndarray (..., 3)
            In m, in world axes.
        """
        poses, points = poses_of(joints, self.joint_names), vectors_of("point", point)
        return self._states(poses, points, link, check_limits, threads)["position"]

    def mass_matrix(self, joints: object = None, *, check_limits: bool = True, threads: int | None = None) -> Array:
        """Return the joint-space mass matrix M of the free joints, motors and payload with it.

        Parameters
        ----------
        joints, check_limits, threads
            As for `effective_mass`.

        Returns
        -------
        ndarray (..., n, n)
            In kg m^2, or kg where joints slide, in the order of `free_joints`.
        """
        shape, lower, _ = self._dynamics(joints, check_limits, threads)
        size = len(self.free_joints)
        found = np.zeros((*shape, size, size))
        rows, columns = np.tril_indices(size)
        found[..., rows, columns] = lower
        found[..., columns, rows] = lower
        return found

    def gravity_torques(self, joints: object = None, *, check_limits: bool = True, threads: int | None = None) -> Array:
        """Return the torque of the weight on each free joint, for gravity along -z of the world.

        Parameters
        ----------
        joints, check_limits, threads
            As for `effective_mass`.

        Returns
        -------
        ndarray (..., n)
            In N m, or N where a joint slides, in the order of `free_joints`.
        """
        return self._dynamics(joints, check_limits, threads)[2]

    def _dynamics(self, joints: object, check_limits: object, threads: object) -> tuple[tuple[int, ...], Array, Array]:
        """Return the shape of the poses, the lower triangles of mass matrices, and torques of the weight."""
        poses = poses_of(joints, self.joint_names)
        shape, (rows, spots) = broadcast(MOST_POINT_STATES, joints=poses, point=np.zeros(3))
        given = self._given(self.link_names[0], rows, spots, shape, check_limits, threads)
        masses, torques = self._native.dynamics(given, GRAVITY)
        size = len(self.free_joints)
        return shape, masses.reshape((*shape, size * (size + 1) // 2)), torques.reshape((*shape, size))

    def velocity(
        self,
        joints: object,
        rates: object,
        *,
        link: str,
        point: object = (0.0, 0.0, 0.0),
        check_limits: bool = True,
        threads: int | None = None,
    ) -> Array:
        """Return the velocity of a point.

        Parameters
        ----------
        joints, link, point, check_limits, threads
            As for `effective_mass`.
        rates : mapping or array_like (..., n)
            Rates of the joints in rad/s, or m/s where they slide.

        Returns
        -------
        ndarray (..., 3)
            In m/s, in world axes.
        """
        shape, (poses, points, speeds) = broadcast(
            MOST_POINT_STATES,
            joints=poses_of(joints, self.joint_names),
            point=vectors_of("point", point),
            rates=poses_of(rates, self.joint_names, "rates"),
        )
        given = self._given(link, poses, points, shape, check_limits, threads)
        return self._native.velocities(given, speeds).reshape((*shape, 3))

    @telling()
    def robot_mass(
        self,
        joints: object = None,
        *,
        link: str,
        point: object = (0.0, 0.0, 0.0),
        direction: object,
        rule: str = "larger",
        check_limits: bool = True,
        threads: int | None = None,
    ) -> EffectiveMass:
        """Return the mass of the robot by a rule.

        Parameters
        ----------
        joints, link, point, direction, check_limits, threads
            As for `effective_mass`.
        rule : {"larger", "iso", "directional"}
            The larger one of both masses, that of ISO/TS 15066, or that along the direction.

        Returns
        -------
        EffectiveMass
            Masses in kg with the doubts that are left with this rule: what only concerns masses along a direction,
            such as missing motor inertias, lies on the safe side where the mass of ISO/TS 15066 governs, which no
            motor changes. With the larger one of both that is where the directional mass is below a third of it.
        """
        word("rule", rule, RULES)
        poses, points = poses_of(joints, self.joint_names), vectors_of("point", point)
        mass = self._along(poses, points, vectors_of("direction", direction), link, check_limits, threads)
        told = for_rule(self.warnings, rule, mass, self.iso_mass, self.mass_source)
        doubts = (*told, *self._placed(poses, points))
        chosen = mass_by_rule(rule, mass, self.iso_mass)
        return EffectiveMass(chosen if chosen.ndim else float(chosen), rule, self.iso_mass, doubts)

    def skeleton(self, joints: object = None, *, check_limits: bool = True) -> Array:
        """Return the origins of all links and of the links before them, for pictures.

        Parameters
        ----------
        joints, check_limits
            As for `effective_mass`; one pose.

        Returns
        -------
        ndarray (links - 1, 2, 3)
            Lines from link to link in m.
        """
        pose = poses_of(joints, self.joint_names)
        places = [self.position(pose, link=link, check_limits=check_limits) for link in self.link_names]
        pairs = [(parent, child) for child, parent in enumerate(self._facts["parents"]) if parent is not None]
        return np.array([[places[parent], places[child]] for parent, child in pairs]).reshape(len(pairs), 2, 3)

    # ---- crossing the boundary ------------------------------------------------------------------

    def _given(
        self,
        link: object,
        poses: tuple[Array, list[int]],
        points: tuple[Array, list[int]],
        shape: tuple[int, ...],
        check_limits: object,
        threads: object,
    ) -> dict[str, object]:
        return {
            "link": word("link", link, self.link_names),
            "joints": poses,
            "points": points,
            "shape": [count("shape", length, least=0) for length in shape],
            "check_limits": flag("check_limits", check_limits),
            "threads": thread_count(threads),
        }

    def _along(
        self, poses: Array, points: Array, directions: Array, link: object, check_limits: object, threads: object
    ) -> Array:
        """Return masses along directions."""
        shape, (rows, spots, ways) = broadcast(MOST_MASSES, joints=poses, point=points, direction=directions)
        given = self._given(link, rows, spots, shape, check_limits, threads)
        return self._native.effective_mass(given, ways).reshape(shape)

    def _states(
        self, poses: Array, points: Array, link: object, check_limits: object, threads: object
    ) -> dict[str, Array]:
        shape, (rows, spots) = broadcast(MOST_POINT_STATES, joints=poses, point=points)
        given = self._given(link, rows, spots, shape, check_limits, threads)
        states = self._native.point_states(given)
        return {name: values.reshape((*shape, *values.shape[1:])) for name, values in states.items()}

    def _placed(self, poses: Array, points: Array) -> tuple[ResultWarning, ...]:
        """Return the doubts about poses and points."""
        turned = doubts_of_poses(poses, self.joint_names, self.joint_kinds)
        return (*turned, *doubts_of_point(points, self.reach))

    def _extremes(self, states: dict[str, Array], poses: Array, points: Array) -> Extremes:
        return Extremes(
            worst_mass=states["worst_mass"],
            worst_direction=states["worst_direction"],
            least_mass=states["least_mass"],
            least_direction=states["least_direction"],
            warnings=(*self.warnings, *self._placed(poses, points)),
        )
