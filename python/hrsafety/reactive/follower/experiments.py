"""Experiments 1 to 3 over many random layouts: collision rates, and two laws in the same layouts."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import field
from typing import Any, Literal

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, callback, count, flag, instance, thread_count
from hrsafety._bounds import MOST_COUNT, MOST_LAYOUTS, MOST_RESAMPLES
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._statistics import Mean, Paired, Share, compare_paired, mean_interval, wilson
from hrsafety.errors import InvalidParameterError, ShapeError
from hrsafety.reactive.follower.impedance import VirtualImpedance
from hrsafety.reactive.follower.layouts import FollowerLayouts, Kind
from hrsafety.reactive.follower.runs import Follower
from hrsafety.tables import Columns, Table, with_units

__all__ = ["FollowerExperiment", "LawComparison", "compare_experiments", "experiment"]

# More would only exhaust the system before it says no.
SPEED_LIMITS = {"static": 0.6}
"""mu_0 of experiment 2 in m/s; everywhere else that of `VirtualImpedance`."""
FOLLOWS = 0.6
"""A robot that ends at most so much farther from the source than its standoff follows, in m."""
FRONT = np.pi / 4.0
SIDE = 3.0 * np.pi / 4.0
Direction = Literal["front", "left", "right", "rear"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class FollowerExperiment(Table):
    """Ends of many runs, one a layout.

    Attributes
    ----------
    layouts : FollowerLayouts
        How the layouts were drawn.
    law : VirtualImpedance
        Repulsion.
    seed : ndarray of int, shape (n,)
        Seeds of the layouts.
    collided, follows : ndarray of bool, shape (n,)
        Whether the robot touched an obstacle; whether it did not, and ended near the source.
    contact_obstacle : ndarray of int, shape (n,)
        Which obstacle; -1 for none.
    contact_bearing : ndarray of shape (n,)
        Direction of the touch from the front, counterclockwise, in rad; NaN without one.
    end_time, source_distance, min_clearance, path_length, turning : ndarray of shape (n,)
        In s, m, m, m, rad.
    """

    layouts: FollowerLayouts
    law: VirtualImpedance
    seed: npt.NDArray[np.int64]
    collided: npt.NDArray[np.bool_]
    follows: npt.NDArray[np.bool_]
    contact_obstacle: npt.NDArray[np.int64]
    contact_bearing: Array = field(repr=False)
    end_time: Array = field(repr=False)
    source_distance: Array = field(repr=False)
    min_clearance: Array = field(repr=False)
    path_length: Array = field(repr=False)
    turning: Array = field(repr=False)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each run.

        Returns
        -------
        dict of str to ndarray
            Units are in the names.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> list(reactive.experiment("static", "active", layouts=2).columns())[:3]
        ['seed', 'collided', 'follows']
        """
        units = dict.fromkeys(("seed", "collided", "follows", "contact_obstacle"), "")
        units |= {"contact_bearing": "rad", "end_time": "s", "source_distance": "m"}
        return with_units(self, units | {"min_clearance": "m", "path_length": "m", "turning": "rad"})

    @property
    def collision_rate(self) -> Share:
        """Share of the runs with a touch, with its 95 % Wilson interval."""
        return _share(self.collided)

    @property
    def following_rate(self) -> Share:
        """Share of the runs that end near the source without a touch."""
        return _share(self.follows)

    def collision_rate_from(self, direction: Direction) -> Share:
        """Return the share of all runs that end with a touch from one direction.

        Parameters
        ----------
        direction : str
            ``"front"``: within 45 deg of the front, ``"rear"``: more than 135 deg off it,
            ``"left"`` or ``"right"`` between.

        Returns
        -------
        Share
            Share with its 95 % Wilson interval.

        Raises
        ------
        InvalidParameterError
            If the word is unknown.

        Examples
        --------
        >>> from hrsafety import reactive
        >>> found = reactive.experiment("one_dynamic", "active", layouts=50)
        >>> found.collision_rate_from("front").count <= found.collision_rate.count
        True
        """
        bearing = self.contact_bearing
        with np.errstate(invalid="ignore"):
            beside = (np.abs(bearing) > FRONT) & (np.abs(bearing) <= SIDE)
            masks = {
                "front": np.abs(bearing) <= FRONT,
                "left": beside & (bearing > 0.0),
                "right": beside & (bearing < 0.0),
                "rear": np.abs(bearing) > SIDE,
            }
        if direction not in masks:
            raise InvalidParameterError("direction", 'be one of "front", "left", "right", "rear"', direction)
        return _share(masks[direction])

    def __len__(self) -> int:
        """Return the number of runs."""
        return len(self.seed)


def _share(happened: npt.NDArray[np.bool_]) -> Share:
    return wilson(int(happened.sum()), len(happened))


def experiment(
    kind: Kind | FollowerLayouts,
    law: VirtualImpedance | Literal["conventional", "active", "off"] = "active",
    *,
    layouts: int = 1000,
    follower: Follower | None = None,
    touching: bool | None = None,
    first_seed: int = 0,
    threads: int | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> FollowerExperiment:
    """Run the follower through many random layouts.

    Parameters
    ----------
    kind : str or FollowerLayouts
        ``"tracking"``, ``"static"``, ``"one_dynamic"``, ``"two_dynamic"``, or how layouts are drawn.
    law : VirtualImpedance or str
        A law, or the word of one with its defaults; with mu_0 = 0.6 m/s for static boxes then.
    layouts : int
        Number of layouts.
    follower : Follower or None
        The robot; `Follower` when ``None``.
    touching : bool or None
        Keep only layouts in which the same robot without repulsion touches an obstacle. They are
        kept when ``None``, except for tracking, which has no obstacle.
    first_seed : int
        Seeds are tried from here on. Two calls with the same robot use the same layouts.
    threads : int or None
        Number of threads, up to 1024; all cores when ``None``. Never changes a bit.
    progress : callable or None
        Called now and then as ``progress(done, total)``, and at the end.

    Returns
    -------
    FollowerExperiment
        Ends of the runs, and rates with intervals.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range, or hardly any layout touches.
    SimulationError
        If a state becomes non-finite.
    KeyboardInterrupt
        Within 0.2 s of Ctrl-C.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> found = reactive.experiment("static", "active", layouts=100)
    >>> found.collision_rate.value <= 0.01, len(found)
    (True, 100)
    """
    drawn = kind if isinstance(kind, FollowerLayouts) else FollowerLayouts(kind=kind)
    repulsion = _law_of(law, drawn.kind)
    robot = Follower() if follower is None else instance("follower", follower, Follower)
    only_touching = drawn.kind != "tracking" if touching is None else flag("touching", touching)
    wanted = count("layouts", layouts, most=MOST_LAYOUTS)
    first = count("first_seed", first_seed, least=0, most=MOST_COUNT - 1001 * MOST_LAYOUTS)
    thread_count(threads)
    seeds = list(range(first, first + wanted))
    if only_touching:
        seeds = _hrsafety.follower_touching(robot._native, drawn._native, first=first, count=wanted, threads=threads)
    found = _hrsafety.follower_batch(
        robot._native, repulsion._native, drawn._native, seeds, threads=threads, progress=callback("progress", progress)
    )
    clearance = found.pop("least_clearance")
    near = found["source_distance"] <= robot.standoff + FOLLOWS
    return FollowerExperiment(
        layouts=drawn,
        law=repulsion,
        seed=np.array(seeds, dtype=np.int64),
        follows=~found["collided"] & near,
        min_clearance=clearance,
        **found,
    )


def _law_of(law: object, kind: str) -> VirtualImpedance:
    if isinstance(law, VirtualImpedance):
        return law
    rule = 'be a VirtualImpedance or one of "conventional", "active", "off"'
    if not isinstance(law, str):
        raise InvalidParameterError("law", rule, law)
    limit = SPEED_LIMITS.get(kind)
    options: dict[str, Any] = {} if limit is None else {"speed_limit": limit}
    if law == "conventional":
        return VirtualImpedance(form="conventional", **options)
    if law == "active":
        return VirtualImpedance(**options)
    if law == "off":
        return VirtualImpedance(form="off")
    raise InvalidParameterError("law", rule, law)


@displayed
@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LawComparison:
    """Two experiments in the same layouts.

    Attributes
    ----------
    first, second : FollowerExperiment
        The runs.
    collisions : Paired
        Layouts in which only one of them collides, and the exact McNemar test.
    difference : Mean
        Collision rate of the first minus that of the second, with its 95 % bootstrap interval over
        the layouts.
    """

    first: FollowerExperiment
    second: FollowerExperiment
    collisions: Paired
    difference: Mean


def compare_experiments(
    first: FollowerExperiment, second: FollowerExperiment, *, resamples: int = 2000, seed: int = 0
) -> LawComparison:
    """Compare two experiments layout by layout.

    Parameters
    ----------
    first, second : FollowerExperiment
        In the same layouts.
    resamples, seed : int
        Number of bootstrap samples, and the seed of their draws.

    Returns
    -------
    LawComparison
        Paired difference of the collision rates.

    Raises
    ------
    ShapeError
        If the numbers of layouts differ.
    InvalidParameterError
        If the layouts differ.

    Examples
    --------
    >>> from hrsafety import reactive
    >>> runs = [reactive.experiment("one_dynamic", law, layouts=200) for law in ("conventional", "active")]
    >>> reactive.follower.compare_experiments(*runs).difference.low > 0.0
    True
    """
    for name, value in (("first", first), ("second", second)):
        instance(name, value, FollowerExperiment)
    if first.seed.shape != second.seed.shape:
        raise ShapeError("second", str(first.seed.shape), second.seed.shape)
    if first.layouts != second.layouts or not np.array_equal(first.seed, second.seed):
        raise InvalidParameterError("second", "be an experiment in the layouts of the first", second.layouts)
    change = first.collided.astype(np.float64) - second.collided
    return LawComparison(
        first=first,
        second=second,
        collisions=compare_paired(first.collided, second.collided),
        difference=mean_interval(change, resamples=count("resamples", resamples, most=MOST_RESAMPLES), seed=seed),
    )
