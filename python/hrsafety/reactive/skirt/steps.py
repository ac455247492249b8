"""Tests of the skirt: whole, or advanced from outside, one firing at a time."""

from __future__ import annotations

import numpy as np

from hrsafety import _hrsafety
from hrsafety._arguments import checked_seed, count, word
from hrsafety._bounds import MOST_LAYOUTS
from hrsafety.errors import InvalidParameterError
from hrsafety.reactive.percept import Percept
from hrsafety.reactive.skirt.ring import MOTION_DIRECTIONS, UltrasonicSkirt
from hrsafety.reactive.skirt.runs import SkirtMotion, SkirtRun, SkirtScene, limited, native_parts
from hrsafety.reactive.stepped import Stepped

__all__ = ["SkirtSteps", "skirt_run"]


class SkirtSteps(Stepped[SkirtRun]):
    """One of the tests of `skirt_test` that is advanced from outside, one firing at a time.

    Stepped to its end without actions, it has the same bits as `skirt_run`.

    Parameters
    ----------
    skirt : UltrasonicSkirt or None
        The skirt; the published one when ``None``.
    direction : str
        Direction of escape, a word of `MOTION_DIRECTIONS`.
    layout, repeat : int
        Row of the test.
    scene : SkirtScene or None
        How discs are laid out.
    motion : SkirtMotion or None
        How the robot moves.
    repeats, seed : int
        As in the call of `skirt_test`.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, or the discs leave no room for each other.

    Notes
    -----
    Tests are independent of each other and may be stepped in turn, or each in a thread of its own.
    A test that is under way cannot be copied or pickled.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> run = reactive.SkirtSteps(direction="SE", layout=3)
    >>> while not run.finished:
    ...     seen = run.step("keep" if run.time < 0.5 else None)
    >>> set(run.record.action[:5].tolist())
    {'keep'}
    """

    __slots__ = ("_course", "_skirt")
    _native: _hrsafety.SkirtSteps

    def __init__(
        self,
        skirt: UltrasonicSkirt | None = None,
        *,
        direction: str = "N",
        layout: int = 0,
        repeat: int = 0,
        scene: SkirtScene | None = None,
        motion: SkirtMotion | None = None,
        repeats: int = 5,
        seed: int = 0,
    ) -> None:
        names = tuple(MOTION_DIRECTIONS)
        place = names.index(word("direction", direction, names))
        times = limited("repeats", repeats, MOST_LAYOUTS)
        if count("repeat", repeat, least=0) >= times:
            raise InvalidParameterError("repeat", f"be an integer from 0 to {times - 1}", repeat)
        index = (limited("layout", layout, MOST_LAYOUTS, least=0) * len(names) + place) * times + repeat
        parts = native_parts(skirt, scene, motion)
        self._native = _hrsafety.SkirtSteps(*parts, index=index, repeats=times, seed=checked_seed("seed", seed))
        self._skirt = UltrasonicSkirt() if skirt is None else skirt
        self._course = MOTION_DIRECTIONS[direction] + np.pi

    @property
    def skirt(self) -> UltrasonicSkirt:
        """The skirt."""
        return self._skirt

    @property
    def record(self) -> SkirtRun:
        """The test so far: a row for each firing."""
        return SkirtRun(skirt=self._skirt, course=self._course, **self._native.recorded())

    def step(self, action: str | None = None) -> Percept:
        """Advance by one firing period, or to the end of the test.

        Parameters
        ----------
        action : str or None
            A word of `MOTION_DIRECTIONS`, ``"keep"`` or ``"spin"``; ``None``: what the skirt decides.

        Returns
        -------
        Percept
            What the skirt decides by then.

        Raises
        ------
        InvalidParameterError
            If the action is none.
        SimulationError
            If the test has ended, the state became non-finite, or another thread is stepping it.
        """
        self._check_under_way()
        words = ("keep", "spin", *MOTION_DIRECTIONS)
        self._native.step(action=None if action is None else word("action", action, words))
        return self.observe()

    def __repr__(self) -> str:
        """Return time and whether it has ended."""
        return f"SkirtSteps(skirt={self._skirt!r}, time={self.time:.6g}, finished={self.finished})"


def skirt_run(
    skirt: UltrasonicSkirt | None = None,
    *,
    direction: str = "N",
    layout: int = 0,
    repeat: int = 0,
    scene: SkirtScene | None = None,
    motion: SkirtMotion | None = None,
    repeats: int = 5,
    seed: int = 0,
) -> SkirtRun:
    """Run one of the tests of `skirt_test` again and keep every step.

    Parameters
    ----------
    skirt : UltrasonicSkirt or None
        The skirt; the published one when ``None``.
    direction : str
        Direction of escape, a word of `MOTION_DIRECTIONS`.
    layout, repeat : int
        Row of the test.
    scene : SkirtScene or None
        How discs are laid out.
    motion : SkirtMotion or None
        How the robot moves.
    repeats, seed : int
        As in the call of `skirt_test`.

    Returns
    -------
    SkirtRun
        Motion, readings and decisions; the same bits as in the batch.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, or the discs leave no room for each other.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> run = reactive.skirt_run(direction="SE", layout=3)
    >>> bool(run.min_clearance == reactive.skirt_test(layouts=4).min_clearance[3 * 40 + 35])
    True
    """
    run = SkirtSteps(
        skirt,
        direction=direction,
        layout=layout,
        repeat=repeat,
        scene=scene,
        motion=motion,
        repeats=repeats,
        seed=seed,
    )
    return run.finish()
