"""Moves as a robot program has them: straight in the joints or straight in space, with stops or blends between them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, checked_text, finite, number, vector, word
from hrsafety._records import dataclass
from hrsafety._words import meant
from hrsafety.arms import Arm
from hrsafety.arms.inputs import poses_of
from hrsafety.arms.link_doubts import several
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.program.curves import JointCurve

__all__ = ["KINDS", "MOST_MOVES", "Legs", "Move", "legs_of"]

KINDS = ("joint", "linear")
MOST_MOVES = 1000
LONGEST_LINE = 20.0
"""Longest straight line in m; no arm reaches farther."""
STEP = 1e-3
"""Longest step along a line in m."""
STOP_TURN = 1e-3
"""Change of the tangent, as a share of it, beyond which the robot stops between two moves."""
NEAR_SINGULAR = 1e-3
"""Ratio of least and largest singular value of the Jacobian below which a pose is near a singular one."""
EXACT = 1e-10
MOST_ROUNDS = 50
SAME = 1e-9
LEAST_BLEND = 1e-6


@dataclass(frozen=True, kw_only=True, slots=True)
class Move:
    """A move of a robot program.

    Parameters
    ----------
    kind : {"joint", "linear"}
        Straight in the values of the joints, or a link shifted along a straight line in space, its orientation kept.
    to : mapping of str to float, or sequence of float
        Of a joint move values by joint in rad or m, those that are not named as before. Of a linear one the place of
        the origin of the link at the end, in m, in the frame of the root.
    link : str or None
        Of a linear move; that of the tool center point when ``None``.
    blend : float
        Way before the end of the move from which a curve leads to the next one, in rad of a joint move and m of a
        linear one; 0 stops where the path has a corner.
    dwell : float
        Time that the robot stands at the end, in s.
    name : str
        Name for segments; ``move N`` when empty.

    Examples
    --------
    >>> from hrsafety import program
    >>> program.Move(kind="linear", to=(0.5, 0.0, 0.4), blend=0.02).link is None
    True
    """

    kind: str
    to: Any
    link: str | None = None
    blend: float = 0.0
    dwell: float = 0.0
    name: str = ""

    def __post_init__(self) -> None:
        """Check the values."""
        word("kind", self.kind, KINDS)
        for name in ("blend", "dwell"):
            value = number(name, getattr(self, name))
            if not 0.0 <= value < 1e6:
                raise InvalidParameterError(name, "be at least 0 and finite", value)
            object.__setattr__(self, name, value)
        if self.link is not None:
            checked_text("link", self.link, "be the name of a link")
            if self.kind == "joint":
                raise InvalidParameterError("link", "be left out of a joint move", self.link)
        if not isinstance(self.name, str):
            raise InvalidParameterError("name", "be a text", self.name)
        if 0.0 < self.blend < LEAST_BLEND:
            raise InvalidParameterError("blend", f"be 0, a stop, or at least {LEAST_BLEND:g}", self.blend)
        if self.blend > 0.0 and self.dwell > 0.0:
            raise InvalidParameterError("blend", "be left out where the robot dwells", self.blend)
        if self.kind == "linear":
            place = vector("to", self.to)
            if place.shape != (3,) or not np.isfinite(place).all():
                raise InvalidParameterError("to", "be three finite numbers in m", self.to)
            object.__setattr__(self, "to", tuple(place.tolist()))
        elif isinstance(self.to, Mapping):
            for joint, value in self.to.items():
                finite(f"to[{joint!r}]", value)
        elif not np.isfinite(vector("to", self.to)).all():
            raise InvalidParameterError("to", "be finite numbers in rad or m", self.to)


class Legs(NamedTuple):
    """Moves as a path.

    Attributes
    ----------
    curves : list of JointCurve
        Pieces between which the robot stands.
    dwells : list of float
        Time in s that it stands before each piece, and behind the last one.
    marks : dict of str to (float, float)
        Path parameter where each move begins and ends; within a blend the middle of it.
    warnings : tuple of ResultWarning
        Poses near a singular one.
    """

    curves: list[JointCurve]
    dwells: list[float]
    marks: dict[str, tuple[float, float]]
    warnings: tuple[ResultWarning, ...]


def legs_of(arm: Arm, moves: Sequence[Move], link: str) -> Legs:
    """Return the path of moves; the first one names the pose in which the program starts.

    Parameters
    ----------
    arm : Arm
        The arm.
    moves : sequence of Move
        Two at least, the first one a joint move with every joint.
    link : str
        Link of linear moves that name none.

    Raises
    ------
    InvalidParameterError
        If a move leads nowhere, out of reach or beyond the limits of joints, or a blend takes more than half of it.
    """
    if not 2 <= len(moves) <= MOST_MOVES:
        raise InvalidParameterError("moves", f"be 2 to {MOST_MOVES}, the first one the start", len(moves))
    names = [each.name or f"move {place + 1}" for place, each in enumerate(moves)]
    for place, name in enumerate(names):
        if name in names[:place]:
            raise InvalidParameterError(f"moves[{place}].name", "be a name that no other move has", name)
    pose = _start(arm, moves[0])
    legs: list[JointCurve] = []
    doubts: list[ResultWarning] = []
    for place, move in enumerate(moves[1:], start=1):
        path = f"moves[{place}]"
        if move.kind == "joint":
            target = _pose(arm, move, pose, path)
            if np.linalg.norm(target - pose) < SAME:
                raise InvalidParameterError(f"{path}.to", "lead somewhere", Shown("where the robot is already"))
            legs.append(JointCurve.straight(pose, target))
        else:
            leg, nearest = _line(arm, pose, move, link if move.link is None else move.link, path)
            legs.append(leg)
            if nearest < NEAR_SINGULAR:
                message = (
                    f"{names[place]} passes near a singular pose (ratio of singular values {nearest:.2g}): there a "
                    "controller may stop, or turn joints another way"
                )
                doubts.append(ResultWarning("near_singular", path, message))
        pose = legs[-1].end[0]
    return _assembled(legs, moves, names, tuple(doubts))


def _start(arm: Arm, move: Move) -> Array:
    """Return the pose of the first move."""
    if move.kind != "joint":
        raise InvalidParameterError("moves[0].kind", "be 'joint': the pose in which the program starts", move.kind)
    if move.blend:
        raise InvalidParameterError("moves[0].blend", "be left out at the start", move.blend)
    if isinstance(move.to, Mapping):
        missing = [joint for joint in arm.free_joints if joint not in (*move.to, *arm.base_joints)]
        if missing:
            rule = "hold every joint: it is the pose in which the program starts"
            remedy = f"give {several(missing)} in rad, or m, too"
            raise InvalidParameterError("moves[0].to", rule, Shown(f"{len(move.to)} of them"), remedy)
    return _pose(arm, move, np.zeros(len(arm.joint_names)), "moves[0]")


def _pose(arm: Arm, move: Move, before: Array, path: str) -> Array:
    """Return the pose that a joint move leads to."""
    names = arm.joint_names
    given = move.to
    if isinstance(given, Mapping):
        for joint in given:
            if joint not in names:
                rule = f"name joints of the arm: {', '.join(names)}"
                raise InvalidParameterError(f"{path}.to", rule, joint, meant(str(joint), names))
        given = [given.get(joint, value) for joint, value in zip(names, before.tolist(), strict=True)]
    try:
        found = poses_of(given, names, f"{path}.to")
        if found.shape != (len(names),):
            raise InvalidParameterError(f"{path}.to", f"be {len(names)} numbers", found.shape)
        arm.position(found, link=arm.link_names[-1])
    except InvalidParameterError as error:
        raise error if error.argument.startswith(path) else error.renamed(f"{path}.to") from None
    return np.asarray(found)


def _line(arm: Arm, pose: Array, move: Move, link: str, path: str) -> tuple[JointCurve, float]:
    """Return the spline along a straight line, and the least ratio of singular values on it."""
    word(f"{path}.link", link, arm.moved_links)
    # A base that rolls stands while the arm draws a line.
    free = np.isin(arm.joint_names, [each for each in arm.free_joints if each not in arm.base_joints])
    frame = _Frame(arm, link, free)
    start = frame.places(pose)
    shift = np.asarray(move.to) - start[0]
    length = float(np.linalg.norm(shift))
    if length < SAME:
        raise InvalidParameterError(f"{path}.to", "lead somewhere", Shown("where the link is already"))
    if length > LONGEST_LINE:
        raise InvalidParameterError(f"{path}.to", f"be within {LONGEST_LINE:g} m of the start", length, "mm for m?")
    steps = max(int(np.ceil(length / STEP)), 3)
    poses, nearest = [pose], np.inf
    for place in range(1, steps + 1):
        found, ratio = frame.solved(_ahead(poses), start + shift * (place / steps))
        if found is None or np.abs(found - poses[-1]).max() > 1.0:
            here = length * (place - 1) / steps
            rule = (
                f"stay where the arm can keep the orientation of {link} (no_solution beyond {here:.3f} m of the line)"
            )
            remedy = "out of reach, or through a singular pose"
            if free.sum() < 6:
                remedy = (
                    f"the arm has {free.sum()} joints that move, and to keep an orientation on any line takes 6: write "
                    f"joint moves, or a line that these joints can draw; or {remedy}"
                )
            raise InvalidParameterError(f"{path}.to", rule, list(move.to), remedy)
        poses.append(found)
        nearest = min(nearest, ratio)
    rows = np.array(poses)
    low, high = arm.limits.T
    out = (rows < low - SAME) | (rows > high + SAME)
    if out.any():
        row, joint = np.argwhere(out)[0]
        rule = f"keep {arm.joint_names[joint]} within {low[joint]:g} to {high[joint]:g} (no_solution)"
        raise InvalidParameterError(f"{path}.to", rule, float(rows[row, joint]))
    return JointCurve.spline(np.linspace(0.0, length, steps + 1), rows), float(nearest)


def _ahead(poses: list[Array]) -> Array:
    """Return the pose that follows if the last ones continue as a parabola."""
    if len(poses) < 3:
        return poses[-1].copy()
    return np.asarray(3.0 * (poses[-1] - poses[-2]) + poses[-3])


class _Frame:
    """Frame of a link by four points, its origin and one on each axis, and the poses that bring it somewhere."""

    def __init__(self, arm: Arm, link: str, free: npt.NDArray[np.bool_]) -> None:
        self.arm, self.free = arm, free
        self.given: dict[str, Any] = {
            "link": link,
            "point": np.vstack([np.zeros(3), np.eye(3)]),
            "check_limits": False,
            "threads": 1,
        }
        self.rates = np.eye(len(free))[free][:, np.newaxis, :]

    def places(self, pose: Array) -> Array:
        """Return the four points (4, 3) in m."""
        return np.asarray(self.arm.position(pose, **self.given))

    def solved(self, pose: Array, target: Array) -> tuple[Array | None, float]:
        """Return the pose in which the points are at their targets, near another one, and the ratio there."""
        pose = pose.copy()
        ratio = np.inf
        for _ in range(MOST_ROUNDS):
            now = self.places(pose)
            axes = now[1:] - now[0]
            turn = 0.5 * _cross(axes, target[1:] - target[0]).sum(axis=0)
            missing = np.concatenate([target[0] - now[0], turn])
            if np.abs(missing).max() < EXACT and ratio < np.inf:
                return pose, ratio
            velocity = self.arm.velocity(pose, self.rates, **self.given)
            spin = 0.5 * _cross(axes, velocity[:, 1:] - velocity[:, :1]).sum(axis=1)
            left, values, right = np.linalg.svd(np.hstack([velocity[:, 0], spin]).T, full_matrices=False)
            ratio = float(values[-1] / values[0]) if values[0] > 0.0 else 0.0
            used = values > 1e-9 * values[0]
            change = right.T[:, used] @ ((left.T[used] @ missing) / values[used])
            if not np.isfinite(change).all() or np.abs(change).max() > 1.0:
                return None, ratio
            pose[self.free] += change
        return None, ratio


def _cross(first: Array, second: Array) -> Array:
    """Return cross products along the last axis."""
    on, behind = [1, 2, 0], [2, 0, 1]
    return np.asarray(first[..., on] * second[..., behind] - first[..., behind] * second[..., on])


def _assembled(
    legs: list[JointCurve], moves: Sequence[Move], names: list[str], doubts: tuple[ResultWarning, ...]
) -> Legs:
    """Return legs joined by stops or blends."""
    blends = _blends(legs, moves)
    pieces: list[list[JointCurve]] = [[]]
    dwells = [moves[0].dwell]
    marks: dict[str, tuple[float, float]] = {names[0]: (0.0, 0.0)}
    begun = length = 0.0
    for place, leg in enumerate(legs):
        before = blends[place - 1] if place else 0.0
        after = blends[place]
        if not before and not after:
            pieces[-1].append(leg)
        elif leg.length - before - after > SAME * leg.length:
            pieces[-1].append(leg.part(before, leg.length - after))
        length += leg.length - before - after
        if after:
            following = legs[place + 1]
            start, tangent, _ = leg.at(np.array([leg.length - after]))
            end, leaving, _ = following.at(np.array([after]))
            pieces[-1].append(JointCurve.bend((start[0], tangent[0]), (end[0], leaving[0]), 2.0 * after))
            length += 2.0 * after
        ended = length - after
        marks[names[place + 1]] = (begun, ended)
        begun = ended
        dwell = moves[place + 1].dwell
        if place + 1 == len(legs):
            dwells.append(dwell)
        elif not after and (dwell > 0.0 or _corner(leg.end[1], legs[place + 1].start[1])):
            pieces.append([])
            dwells.append(dwell)
    return Legs([JointCurve.joined(each) for each in pieces], dwells, marks, doubts)


def _blends(legs: list[JointCurve], moves: Sequence[Move]) -> list[float]:
    """Return the blend behind each leg."""
    found = []
    for place, leg in enumerate(legs):
        blend, path = moves[place + 1].blend, f"moves[{place + 1}].blend"
        if blend and place + 1 == len(legs):
            raise InvalidParameterError(path, "be left out of the last move", blend)
        if blend:
            half = 0.5 * min(leg.length, legs[place + 1].length)
            if blend > half * (1.0 + SAME):
                rule = f"be at most half of this move and of the next one ({half:.4g})"
                raise InvalidParameterError(path, rule, blend)
        found.append(min(blend, 0.5 * leg.length))
    return found


def _corner(before: Array, after: Array) -> bool:
    """Whether the robot has to stop between two tangents."""
    return bool(np.linalg.norm(after - before) > STOP_TURN * np.linalg.norm(before))
