"""Poses that were corrected: where a robot is found beside the way that its velocity leads."""

from __future__ import annotations

import numpy as np

from hrsafety._arguments import Array
from hrsafety.io.logs.robot_log import PoseJump
from hrsafety.plausibility import ResultWarning

__all__ = ["LONGEST_STEP", "jump_doubt", "pose_jumps"]

LONGEST_STEP = 0.25
"""Between poses that are farther apart in time, in s, nothing is known of the robot."""
CORRECTION = 0.05
"""Deviation in m beyond the noise that is a jump."""


def pose_jumps(time: Array, position: Array, heading: Array, twist: Array) -> tuple[PoseJump, ...]:
    """Return where successive poses are farther from each other than the velocity between them allows.

    Parameters
    ----------
    time, position, heading : ndarray
        Poses.
    twist : ndarray, shape (n, 3)
        Velocity at each pose, NaN where none is stored: the mean of the steps before and after stands for it.
    """
    steps = np.diff(time)
    if len(steps) < 1:
        return ()
    moved = np.diff(position, axis=0)
    expected = driven(twist[:-1], heading[:-1], steps)
    speed = moved / steps[:, None]
    beside = speed.copy()
    beside[1:-1] = 0.5 * (speed[:-2] + speed[2:])
    if len(speed) > 1:
        beside[0], beside[-1] = speed[1], speed[-2]
    expected = np.where(np.isfinite(expected), expected, beside * steps[:, None])
    off = np.hypot(*(moved - expected).T)
    near = steps <= LONGEST_STEP * (1.0 + 1e-9)
    if not near.any():
        return ()
    sigma = 1.4826 * float(np.median(off[near]))
    stored = np.isfinite(twist[:-1]).all(axis=1)
    found = near & (off > CORRECTION + 3.0 * sigma)
    # Without stored velocities the steps beside a jump are measured by it: of neighbors the largest is the jump.
    before, after = np.append(0.0, off[:-1]), np.append(off[1:], 0.0)
    found &= stored | ((off >= before) & (off >= after))
    return tuple(
        PoseJump(float(time[row]), float(time[row + 1]), float(off[row])) for row in np.flatnonzero(found).tolist()
    )


def driven(twist: Array, heading: Array, duration: Array) -> Array:
    """Return ways (n, 2) at constant velocity and turn rate, an arc from a heading on."""
    turn = twist[:, 2] * duration
    small = np.abs(turn) < 1e-6
    safe = np.where(small, 1.0, turn)
    sine = np.where(small, 1.0, np.sin(safe) / safe)
    versine = np.where(small, 0.5 * turn, (1.0 - np.cos(safe)) / safe)
    ahead = (sine * twist[:, 0] - versine * twist[:, 1]) * duration
    aside = (versine * twist[:, 0] + sine * twist[:, 1]) * duration
    cosine, side = np.cos(heading), np.sin(heading)
    return np.stack([cosine * ahead - side * aside, side * ahead + cosine * aside], axis=1)


def jump_doubt(jumps: tuple[PoseJump, ...]) -> tuple[ResultWarning, ...]:
    """Return a warning that names the longest jump."""
    if not jumps:
        return ()
    worst = max(jumps, key=lambda each: each.length)
    more = f" ({len(jumps) - 1} more jumps)" if len(jumps) > 1 else ""
    message = (
        f"the pose jumps by {worst.length:.3g} m between {worst.begin:g} and {worst.end:g} s{more}: the localization "
        "was corrected; the robot was elsewhere than its poses say before it, after it or both, and the step is not "
        "judged"
    )
    return (ResultWarning("pose_jump", "position", message),)
