"""Studies over the avoidance test: the smallest skirt that keeps contacts rare enough."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Annotated

import numpy as np

from hrsafety._arguments import callback, count, instance, number, positive, sequence, word
from hrsafety._records import dataclass
from hrsafety._statistics import Share
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.reactive.skirt.ring import (
    PUBLISHED_CHASSIS_RADIUS,
    PUBLISHED_SAFE_DISTANCE,
    Layout,
    Policy,
    UltrasonicSkirt,
)
from hrsafety.reactive.skirt.runs import SkirtMotion, SkirtScene, skirt_test
from hrsafety.tables import Columns, Table

__all__ = ["SmallestSkirt", "smallest_skirt"]

_TRIGGER_DISTANCE = PUBLISHED_SAFE_DISTANCE - PUBLISHED_CHASSIS_RADIUS
# A ring beside three wheels has the same number of sensors between each two of them.
_COUNTS = {"even": tuple(range(3, 17)), "wheels": (6, 9, 12, 15, 18)}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class SmallestSkirt(Table):
    """Result of `smallest_skirt`.

    Attributes
    ----------
    sensors : int or None
        Smallest number of sensors with which the share of contacts is surely below the limit, by
        the upper end of its 95 % interval; ``None`` if there is none among the numbers tried.
    contact_share : float
        The limit.
    chassis_radius, speed : float
        In m and m/s.
    counts : tuple of int
        Numbers of sensors that were tried.
    contacts : tuple of Share
        Share of the tests with contact, for each of them.
    skirts : tuple of UltrasonicSkirt
        The skirts.
    """

    sensors: int | None
    contact_share: float
    chassis_radius: Annotated[float, "m"]
    speed: Annotated[float, "m/s"]
    counts: tuple[int, ...]
    contacts: tuple[Share, ...]
    skirts: tuple[UltrasonicSkirt, ...]

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, ready for a data frame.

        Returns
        -------
        dict of str to ndarray
            Number of sensors, and share of contacts with its interval.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> reactive.smallest_skirt(0.2, counts=[6, 12], layouts=5).columns()["sensors"].tolist()
        [6.0, 12.0]
        """
        return {
            "sensors": np.array(self.counts, dtype=np.float64),
            "contact_share": np.array([share.value for share in self.contacts]),
            "contact_share_low": np.array([share.low for share in self.contacts]),
            "contact_share_high": np.array([share.high for share in self.contacts]),
        }


def smallest_skirt(
    contact_share: float,
    *,
    chassis_radius: float = PUBLISHED_CHASSIS_RADIUS,
    speed: float = 0.3,
    counts: Sequence[int] | None = None,
    layout: Layout = "even",
    policy: Policy = "best_direction",
    trigger_distance: float = _TRIGGER_DISTANCE,
    skirt: UltrasonicSkirt | None = None,
    scene: SkirtScene | None = None,
    motion: SkirtMotion | None = None,
    layouts: int = 100,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> SmallestSkirt:
    """Find the smallest number of sensors that keeps contacts below a share of the tests.

    More sensors leave fewer blind places, but each of them fires less often. The discs of a test are
    the same for every number of sensors. For another chassis radius than the published one, the
    default scene grows by the difference: gaps between robot and discs stay alike.

    Parameters
    ----------
    contact_share : float
        Limit of the share of tests with contact, between 0 and 1.
    chassis_radius : float
        R in m.
    speed : float
        In m/s.
    counts : sequence of int or None
        Numbers of sensors to try; 3 to 16, and 6 to 18 in steps of three for ``"wheels"``, when
        ``None``.
    layout : str
        ``"even"`` or ``"wheels"``, as for `UltrasonicSkirt`.
    policy : str
        As for `UltrasonicSkirt`; only the published ring of nine has a state table beside it.
    trigger_distance : float
        Reading at which a sensor is triggered, in m: R_S is so far outside the sensors.
    skirt : UltrasonicSkirt or None
        Gives beams, ranges, noise, inset and firing period.
    scene : SkirtScene or None
        How discs are laid out.
    motion : SkirtMotion or None
        Gives acceleration, yaw rate and duration.
    layouts, seed, threads
        As for `skirt_test`.
    progress : callable or None
        Called now and then as ``progress(done, total)`` with numbers of tests, and at the end.

    Returns
    -------
    SmallestSkirt
        The number, and the share of contacts for every number tried.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, or a number of sensors does not fit the layout.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> study = reactive.smallest_skirt(0.2, counts=[4, 12], layouts=10)
    >>> study.sensors, [share.value > 0.2 for share in study.contacts]
    (12, [True, False])
    """
    limit = number("contact_share", contact_share)
    if not 0.0 < limit < 1.0:
        raise InvalidParameterError("contact_share", "be between 0 and 1", contact_share)
    words = ("wheels", "even")
    tried = _counts(counts, _COUNTS[word("layout", layout, words)])
    base = UltrasonicSkirt() if skirt is None else instance("skirt", skirt, UltrasonicSkirt)
    radius, reading = positive("chassis_radius", chassis_radius), positive("trigger_distance", trigger_distance)
    skirts = tuple(
        replace(
            base,
            sensors=size,
            layout=layout,
            policy=policy,
            triggering="consistent",
            chassis_radius=radius,
            safe_distance=radius - base.sensor_inset + reading,
        )
        for size in tried
    )
    moves = SkirtMotion() if motion is None else instance("motion", motion, SkirtMotion)
    way = replace(moves, speed=positive("speed", speed))
    place = scene if scene is not None else _grown(radius - PUBLISHED_CHASSIS_RADIUS)
    report = callback("progress", progress)
    contacts = []
    for index, each in enumerate(skirts):
        told = None if report is None else _Shifted(report, index, len(skirts))
        tests = skirt_test(each, scene=place, motion=way, layouts=layouts, seed=seed, threads=threads, progress=told)
        contacts.append(tests.shares().collides)
    enough = [size for size, share in zip(tried, contacts, strict=True) if share.high < limit]
    return SmallestSkirt(
        sensors=min(enough, default=None),
        contact_share=limit,
        chassis_radius=radius,
        speed=way.speed,
        counts=tried,
        contacts=tuple(contacts),
        skirts=skirts,
    )


class _Shifted:
    """Progress of one of several batches of the same size as progress of all of them."""

    def __init__(self, report: Callable[[int, int], object], index: int, batches: int) -> None:
        self._report = report
        self._index = index
        self._batches = batches

    def __call__(self, done: int, total: int) -> object:
        return self._report(self._index * total + done, self._batches * total)


def _counts(counts: Sequence[int] | None, usual: tuple[int, ...]) -> tuple[int, ...]:
    if counts is None:
        return usual
    given = tuple(
        count(f"counts[{index}]", each)
        for index, each in enumerate(sequence("counts", "be a sequence of integers", counts))
    )
    if not given:
        raise InvalidParameterError("counts", "hold at least one number", Shown("an empty list"))
    return given


def _grown(by: float) -> SkirtScene:
    """Return the usual scene around a robot whose radius is larger by so much."""
    usual = SkirtScene()
    least, most = usual.course_distance
    return replace(usual, course_distance=(least + by, most + by), half_size=usual.half_size + by)
