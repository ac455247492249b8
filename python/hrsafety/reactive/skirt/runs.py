"""The avoidance test of the ultrasonic skirt: eight directions, many random layouts of discs."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import (
    Array,
    Pair,
    Parameters,
    callback,
    checked_seed,
    count,
    instance,
    not_negative,
    pair,
)
from hrsafety._bounds import MOST_LAYOUTS, MOST_OBSTACLES, MOST_THREADS
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._statistics import Share, wilson
from hrsafety.errors import InvalidParameterError
from hrsafety.reactive.skirt.ring import MOTION_DIRECTIONS, UltrasonicSkirt
from hrsafety.tables import Columns, Table, each, plane

__all__ = ["SkirtMotion", "SkirtRun", "SkirtScene", "SkirtShares", "SkirtTest", "limited", "native_parts", "skirt_test"]

# More would only exhaust the system before it says no.
CLOSELY = 0.1


@dataclass(frozen=True, kw_only=True, slots=True)
class SkirtScene(Parameters):
    """How discs are laid out for a test; the robot starts at the origin.

    Parameters
    ----------
    obstacles : int
        Number of discs: one on the course, the others anywhere.
    disc_radius : tuple of float
        Smallest and largest radius, in m.
    course_distance : tuple of float
        Smallest and largest distance of the first one along the course, in m.
    course_offset : float
        Its largest offset to either side, in m.
    half_size : float
        The others lie within this of the start in x and in y, in m.
    start_clearance : float
        Least gap between the robot at the start and the others, in m.
    spacing : float
        Least gap between discs, in m.
    unseen_share : float
        Share of the discs that are below the sensors, from 0 to 1.

    Raises
    ------
    InvalidParameterError
        If a number is out of range.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.SkirtScene(unseen_share=0.05).obstacles
    8
    """

    obstacles: int = 8
    disc_radius: Pair = (0.05, 0.25)
    course_distance: Pair = (1.2, 2.0)
    course_offset: float = 0.3
    half_size: float = 3.0
    start_clearance: float = 0.8
    spacing: float = 0.1
    unseen_share: float = 0.0
    _native: _hrsafety.SkirtScene = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        self._set(
            disc_radius=pair("disc_radius", self.disc_radius),
            course_distance=pair("course_distance", self.course_distance),
        )
        self._set(
            _native=_hrsafety.SkirtScene(
                obstacles=limited("obstacles", self.obstacles, MOST_OBSTACLES),
                disc_radius=self.disc_radius,
                course_distance=self.course_distance,
                **self._as_numbers("course_offset", "half_size", "start_clearance", "spacing", "unseen_share"),
            )
        )


@dataclass(frozen=True, kw_only=True, slots=True)
class SkirtMotion(Parameters):
    """How the robot moves: always at one speed, in the direction that the skirt gives.

    It starts at rest and translates without turning, except where all sensors are triggered.

    Parameters
    ----------
    speed : float
        In m/s.
    acceleration : float
        Largest change of the velocity, in m/s^2.
    spin_rate : float
        Yaw rate while it stands and turns, in rad/s.
    duration : float
        Length of a run, in s.

    Raises
    ------
    InvalidParameterError
        If a number is not finite and positive.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> reactive.SkirtMotion(speed=0.5).duration
    12.0
    """

    speed: float = 0.3
    acceleration: float = 0.6
    spin_rate: float = 0.5
    duration: float = 12.0
    _native: _hrsafety.SkirtMotion = field(init=False, repr=False, compare=False)

    def __post_init__(self) -> None:
        """Check the values."""
        values = self._as_numbers("speed", "acceleration", "spin_rate", "duration")
        self._set(_native=_hrsafety.SkirtMotion(**values))


@displayed
class SkirtShares(NamedTuple):
    """Shares of the three marks of Table 4, each with its 95 % Wilson interval.

    Attributes
    ----------
    completely_avoids, closely_clears, collides : Share
        Never nearer than the limit; nearer without contact; contact.
    """

    completely_avoids: Share
    closely_clears: Share
    collides: Share


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class SkirtTest(Table):
    """Result of the avoidance test, one row for each test.

    Attributes
    ----------
    layout, repeat : ndarray of int, shape (n,)
        Which round of all directions, and which test of the direction in it.
    direction : ndarray of str, shape (n,)
        Direction of escape, a word of `MOTION_DIRECTIONS`; the robot starts the other way.
    min_clearance : ndarray, shape (n,)
        Least distance between the surfaces of robot and discs, in m; not positive after contact.
    contact_time : ndarray, shape (n,)
        In s; NaN without contact.
    nearest_seen : ndarray of bool, shape (n,)
        Whether the sensors could see the disc that was the nearest.
    """

    layout: npt.NDArray[np.int64]
    direction: npt.NDArray[np.str_]
    repeat: npt.NDArray[np.int64]
    min_clearance: Annotated[Array, "m"]
    contact_time: Annotated[Array, "s"]
    nearest_seen: npt.NDArray[np.bool_]

    def __len__(self) -> int:
        """Return the number of tests."""
        return len(self.min_clearance)

    @property
    def collided(self) -> npt.NDArray[np.bool_]:
        """Whether the robot touched a disc, test by test."""
        return self.min_clearance <= 0.0

    def shares(self, closely: float = CLOSELY) -> SkirtShares:
        """Return the shares of the three marks.

        Parameters
        ----------
        closely : float
            Clearance below which a test without contact counts as closely cleared, in m. The
            source gives none.

        Returns
        -------
        SkirtShares
            Shares with intervals; their sum is 1.

        Raises
        ------
        InvalidParameterError
            If the limit is not finite or below zero.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> reactive.skirt_test(layouts=1).shares().collides.runs
        40
        """
        limit = not_negative("closely", closely)
        touched = int(np.sum(self.collided))
        clear = int(np.sum(~self.collided & (self.min_clearance >= limit)))
        runs = len(self)
        return SkirtShares(wilson(clear, runs), wilson(runs - clear - touched, runs), wilson(touched, runs))

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, ready for a data frame.

        Returns
        -------
        dict of str to ndarray
            Every field.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> reactive.skirt_test(layouts=1).columns()["direction"][::5].tolist()
        ['N', 'S', 'W', 'E', 'NW', 'NE', 'SW', 'SE']
        """
        names = ("layout", "direction", "repeat", "min_clearance", "contact_time", "nearest_seen")
        return {name: getattr(self, name) for name in names}


def skirt_test(
    skirt: UltrasonicSkirt | None = None,
    *,
    scene: SkirtScene | None = None,
    motion: SkirtMotion | None = None,
    layouts: int = 100,
    repeats: int = 5,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> SkirtTest:
    """Run the avoidance test: for each of the eight directions of escape, several tests among discs.

    The robot starts opposite to the direction of escape, towards one disc, with more discs around.
    Sensors fire in turn; after each the skirt decides. Every test has discs of its own, which
    depend on the seed, the scene and the chassis radius only: tests of two skirts on the same
    chassis can be compared one by one.

    Parameters
    ----------
    skirt : UltrasonicSkirt or None
        The skirt; the published one when ``None``.
    scene : SkirtScene or None
        How discs are laid out.
    motion : SkirtMotion or None
        How the robot moves.
    layouts : int
        How often all directions are tested.
    repeats : int
        Tests of each direction in each of them; 5 as in Table 4 of Gussu and Lin (2017).
    seed : int
        Seed of discs and noise, 0 <= seed < 2**64.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``. Never changes a bit.
    progress : callable or None
        Called now and then as ``progress(done, total)`` with numbers of tests, and at the end.

    Returns
    -------
    SkirtTest
        One row for each of the 8 * layouts * repeats tests.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, or the discs leave no room for each other.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> shares = reactive.skirt_test(layouts=10).shares()
    >>> shares.completely_avoids.value > 0.9, shares.collides.value < 0.1
    (True, True)
    """
    columns = _hrsafety.skirt_test(
        *native_parts(skirt, scene, motion),
        layouts=limited("layouts", layouts, MOST_LAYOUTS),
        repeats=limited("repeats", repeats, MOST_LAYOUTS),
        seed=checked_seed("seed", seed),
        threads=None if threads is None else limited("threads", threads, MOST_THREADS),
        progress=callback("progress", progress),
    )
    index = np.arange(len(columns["min_clearance"]))
    tests = repeats * len(MOTION_DIRECTIONS)
    return SkirtTest(layout=index // tests, repeat=index % repeats, **columns)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class SkirtRun(Table):
    """One test, step by step; row k is the state after firing k.

    Attributes
    ----------
    skirt : UltrasonicSkirt
        The skirt.
    course : float
        Angle of the course at the start, in rad.
    time : ndarray, shape (n,)
        In s.
    position, velocity : ndarray, shape (n, 2)
        In m and m/s.
    heading, yaw_rate : ndarray, shape (n,)
        In rad and rad/s.
    readings : ndarray, shape (n, N)
        Latest reading of each sensor, in m.
    action : ndarray of str, shape (n,)
        What was decided: a word of `MOTION_DIRECTIONS`, ``"keep"`` or ``"spin"``.
    disc_center : ndarray, shape (m, 2)
        In m; the first disc is the one on the course.
    disc_radius : ndarray, shape (m,)
        In m.
    disc_seen : ndarray of bool, shape (m,)
        Whether the sensors can see it.
    min_clearance : float
        Least distance between the surfaces of robot and discs, in m; not positive after contact.
    contact_time : float
        In s; NaN without contact.
    """

    skirt: UltrasonicSkirt
    course: Annotated[float, "rad"]
    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    heading: Annotated[Array, "rad"]
    yaw_rate: Annotated[Array, "rad/s"]
    readings: Annotated[Array, "m"]
    action: npt.NDArray[np.str_]
    disc_center: Annotated[Array, "m"]
    disc_radius: Annotated[Array, "m"]
    disc_seen: npt.NDArray[np.bool_]
    min_clearance: Annotated[float, "m"]
    contact_time: Annotated[float, "s"]

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each firing.

        Returns
        -------
        dict of str to ndarray
            Units are in the names; sensors are numbered.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> list(reactive.skirt_run().columns())[:4]
        ['t_s', 'x_m', 'y_m', 'vx_m_per_s']
        """
        found = {"t_s": self.time, **plane("{}", self.position, "m"), **plane("v{}", self.velocity, "m/s")}
        found |= {"heading_rad": self.heading, "yaw_rate_rad_per_s": self.yaw_rate}
        return found | each("reading_{}", self.readings, "m") | {"action": self.action}


def native_parts(
    skirt: UltrasonicSkirt | None, scene: SkirtScene | None, motion: SkirtMotion | None
) -> tuple[_hrsafety.UltrasonicSkirt, _hrsafety.SkirtScene, _hrsafety.SkirtMotion]:
    """Return the native forms of skirt, scene and motion, or say which is none."""
    ring = UltrasonicSkirt() if skirt is None else instance("skirt", skirt, UltrasonicSkirt)
    place = SkirtScene() if scene is None else instance("scene", scene, SkirtScene)
    way = SkirtMotion() if motion is None else instance("motion", motion, SkirtMotion)
    return ring._native, place._native, way._native


def limited(name: str, value: int, most: int, *, least: int = 1) -> int:
    """Return a count that the core can take, or say that it is none."""
    if count(name, value, least=least) > most:
        raise InvalidParameterError(name, f"be at most {most}", value)
    return int(value)
