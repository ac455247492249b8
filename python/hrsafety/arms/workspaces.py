"""Masses of a point over the whole of the joint space."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Annotated, Any

import numpy as np

from hrsafety._arguments import Array, callback, checked_seed, count, instance, meant, number
from hrsafety._bounds import MOST_POINT_STATES
from hrsafety._records import dataclass
from hrsafety.arms.arm import Arm
from hrsafety.arms.doubts import doubts_of_point
from hrsafety.arms.histories import plane_of
from hrsafety.arms.inputs import vectors_of
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, telling
from hrsafety.tables import Columns, Table, unit_suffix

__all__ = ["Workspace", "workspace"]

# Poses of one call of the core.
_BLOCK = 65_536


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Workspace(Table):
    """Masses of a point in many poses: one row for each.

    Parameters
    ----------
    joint_names, joint_kinds : tuple of str
        Joints in the order of the columns, and whether they turn or slide.
    joints : ndarray (n, joints)
        Poses in rad, or m where a joint slides.
    position : ndarray (n, 3)
        The point in m, in world axes.
    mass : ndarray (n,)
        Effective mass in kg along `direction`.
    direction : ndarray (n, 3)
        The direction that was asked about, or the heaviest one of each pose.
    iso_mass : float
        Mass of ISO/TS 15066 in kg.
    warnings : tuple of ResultWarning
        Why masses may not be what they seem.
    """

    joint_names: tuple[str, ...]
    joint_kinds: tuple[str, ...]
    joints: Annotated[Array, "rad"]
    position: Annotated[Array, "m"]
    mass: Annotated[Array, "kg"]
    direction: Array
    iso_mass: Annotated[float, "kg"]
    warnings: tuple[ResultWarning, ...]

    @property
    def worst(self) -> int:
        """Index of the pose with the largest mass."""
        return int(np.argmax(self.mass))

    @property
    def least(self) -> int:
        """Index of the pose with the least mass."""
        return int(np.argmin(self.mass))

    def columns(self) -> Columns:
        """Return the table as columns.

        Returns
        -------
        dict of str to ndarray
            Joints, position, mass and direction.
        """
        units = [unit_suffix("rad" if kind == "turning" else "m") for kind in self.joint_kinds]
        table = {f"{name}{unit}": self.joints[:, index] for index, (name, unit) in enumerate(self._named(units))}
        table |= dict(plane_of("position", self.position, "m"))
        return {**table, "effective_mass_kg": self.mass, **dict(plane_of("direction", self.direction, ""))}

    def _named(self, units: list[str]) -> list[tuple[str, str]]:
        return list(zip(self.joint_names, units, strict=True))


@telling()
def workspace(
    arm: Arm,
    *,
    link: str,
    point: object = (0.0, 0.0, 0.0),
    direction: object = None,
    samples: int = 1000,
    grid: int | None = None,
    fixed: object = None,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Workspace:
    """Return the masses of a point over the whole of the joint space.

    Parameters
    ----------
    arm : Arm
        The arm.
    link : str
        The link that the point is fixed to.
    point : array_like (3,)
        The point in the frame of the link, in m.
    direction : array_like (3,) or None
        The direction; the heaviest one of each pose when ``None``.
    samples : int
        Poses drawn evenly between the limits; joints without limits take one turn, or 1 m, around 0.
    grid : int or None
        Values of each joint, from limit to limit, instead of samples.
    fixed : mapping or None
        Values of joints that are not varied; locked joints are at 0 unless they are named here.
    seed : int
        Seed of the draws.
    threads : int or None
        Number of threads; all cores when ``None``. It changes no bit.
    progress : callable or None
        Called with (poses done, poses in all) at the start and after each 65,536 of them.

    Returns
    -------
    Workspace
        Poses, positions and masses, and which is the worst.

    Examples
    --------
    >>> from hrsafety import arms
    >>> found = arms.workspace(arms.Arm.example(), link="tool", samples=200, seed=1)
    >>> bool(found.mass[found.worst] == found.mass.max())
    True
    """
    instance("arm", arm, Arm)
    poses = _poses_over(
        arm.joint_names,
        arm.limits,
        arm.free_joints,
        turning=[kind == "turning" for kind in arm.joint_kinds],
        samples=samples,
        grid=grid,
        fixed=fixed,
        seed=seed,
    )
    told = callback("progress", progress)
    blocks = []
    for start in range(0, len(poses), _BLOCK):
        if told is not None:
            told(start, len(poses))
        rows = slice(start, start + _BLOCK)
        place: dict[str, Any] = {"link": link, "point": _rows_of("point", point, rows), "threads": threads}
        toward = None if direction is None else _rows_of("direction", direction, rows)
        blocks.append(_masses(arm, poses[rows], place, toward))
    if told is not None:
        told(len(poses), len(poses))
    position, mass, along = (np.concatenate(parts) for parts in zip(*blocks, strict=True))
    return Workspace(
        joint_names=arm.joint_names,
        joint_kinds=arm.joint_kinds,
        joints=poses,
        position=position,
        mass=mass,
        direction=along,
        iso_mass=arm.iso_mass,
        warnings=(*arm.warnings, *doubts_of_point(vectors_of("point", point), arm.reach)),
    )


def _rows_of(name: str, value: object, rows: slice) -> Array:
    """Return one vector for all poses, or those of some poses."""
    vectors = vectors_of(name, value)
    return vectors if vectors.ndim == 1 or len(vectors) == 1 else vectors[rows]


def _masses(arm: Arm, poses: Array, place: dict[str, Any], direction: Array | None) -> tuple[Array, Array, Array]:
    """Return position, mass and direction of some poses."""
    position = arm.position(poses, **place)
    extremes = arm.extremes(poses, **place)
    if direction is None:
        return position, extremes.worst_mass, extremes.worst_direction
    mass = np.asarray(arm.effective_mass(poses, direction=direction, **place).mass)
    return position, mass, np.broadcast_to(direction, extremes.worst_direction.shape)


def _poses_over(
    joint_names: Sequence[str],
    limits: Array,
    free: Sequence[str],
    *,
    turning: Sequence[bool],
    samples: object,
    grid: object,
    fixed: object,
    seed: object,
) -> Array:
    """Return poses over the joint space, on a grid or drawn evenly, as an array (n, joints)."""
    given = _fixed(fixed, joint_names)
    varied = [index for index, name in enumerate(joint_names) if name in free and name not in given]
    # One turn, or 1 m, around 0 where the file has no limits.
    reach = np.where(turning, math.pi, 0.5)
    low = np.where(np.isfinite(limits[:, 0]), limits[:, 0], -reach)
    high = np.where(np.isfinite(limits[:, 1]), limits[:, 1], reach)
    if grid is None:
        rows = count("samples", samples, most=MOST_POINT_STATES)
        draws = np.random.default_rng(checked_seed("seed", seed)).random((rows, len(varied)))
        drawn = low[varied] + draws * (high - low)[varied]
    else:
        points = count("grid", grid, least=2, most=MOST_POINT_STATES)
        rows = points ** len(varied)
        if rows > MOST_POINT_STATES:
            rule = f"give at most {MOST_POINT_STATES} poses of {len(varied)} joints"
            raise InvalidParameterError("grid", rule, points, "name joints that stay in fixed")
        axes = [np.linspace(low[index], high[index], points) for index in varied]
        drawn = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(rows, len(varied)) if axes else None
    poses = np.zeros((rows, len(joint_names)))
    poses[:] = [given.get(name, 0.0) for name in joint_names]
    if varied:
        poses[:, varied] = drawn
    return poses


def _fixed(given: object, joint_names: Sequence[str]) -> dict[str, float]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        raise InvalidParameterError("fixed", "map names of joints to values", given)
    for name in given:
        if name not in joint_names:
            rule = f"name joints that take a value: {', '.join(joint_names)}"
            raise InvalidParameterError("fixed", rule, name, meant(name, joint_names))
    return {name: number(f"fixed[{name!r}]", value) for name, value in given.items()}
