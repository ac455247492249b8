"""Many scenarios from arrays: one crossing of the boundary for all of them."""

from __future__ import annotations

import functools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import fields
from typing import Any, Literal, Self, overload

import numpy as np
import numpy.typing as npt

from hrsafety import _hrsafety
from hrsafety._arguments import Array, checked_seed, flag, instance, number, numbers, own, points
from hrsafety._bounds import MOST_BODIES, MOST_TABLE_ROWS
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.navigation.obstacles.base import Obstacle
from hrsafety.navigation.obstacles.moving import Human, MovingDisc
from hrsafety.navigation.robots.bodies import DifferentialDriveRobot, HolonomicRobot
from hrsafety.navigation.scenario import Scenario
from hrsafety.plausibility import RANGES

__all__ = ["Numbers", "Scenarios", "checked_robot"]


# Slower than this may stand in m/s; also the room for rounding of a distance in m.
STANDING = 1e-6


class Scenarios(Sequence[Scenario]):
    """Many scenarios with one kind of robot, made in one call.

    A sequence: an index gives an ordinary `Scenario`, a slice other `Scenarios`. Wherever a list of
    scenarios is taken, this is, and nothing is made for each row in Python.

    Made by `from_arrays`, `hrsafety.scenarios.random_traffic_batch` and
    `hrsafety.scenarios.random_crowd_batch`.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import navigation as nav
    >>> x = np.random.default_rng(1).uniform(2.0, 9.0, (100, 3))
    >>> scenes = nav.Scenarios.from_arrays(
    ...     start=np.zeros((100, 2)), goal=np.tile([10.0, 0.0], (100, 1)),
    ...     obstacle_position=np.stack([x, x - 5.0], axis=-1), obstacle_velocity=np.zeros((100, 3, 2)),
    ...     obstacle_radius=0.1, person=False,
    ... )
    >>> len(scenes), len(scenes[7].obstacles), len(nav.simulate_many(scenes, nav.VirtualForceField()))
    (100, 3, 100)
    """

    __slots__ = ("_doubt", "_kept", "_made", "_native", "_rows")

    def __init__(
        self,
        native: _hrsafety.Scenarios,
        again: tuple[Callable[..., Any], dict[str, Any]],
        row: Callable[[int], Scenario],
        doubt: Callable[[], npt.NDArray[np.bool_]] | None = None,
    ) -> None:
        self._doubt = doubt  # where a row may have warnings; any may when None
        self._native = native
        self._made = again  # what makes them again: a function and its arguments
        self._rows = range(len(native))
        self._kept = row

    @classmethod
    def from_arrays(
        cls,
        *,
        start: npt.ArrayLike,
        goal: npt.ArrayLike,
        obstacle_position: npt.ArrayLike | None = None,
        obstacle_velocity: npt.ArrayLike | None = None,
        obstacle_radius: npt.ArrayLike = 0.4,
        person: bool = True,
        robot: HolonomicRobot | DifferentialDriveRobot | None = None,
        control_period: float = 0.06,
        time_limit: float = 60.0,
        arrival_tolerance: float = 0.12,
        heading: float = 0.0,
        rest_time: float = 5.0,
        seed: npt.ArrayLike = 0,
    ) -> Self:
        """Return scenarios with discs that move straight on, a scenario a row.

        Parameters
        ----------
        start, goal : array_like of shape (n, 2)
            Positions in m; a pair stands for all rows.
        obstacle_position, obstacle_velocity : array_like of shape (n, m, 2), or None
            Positions at time 0 in m and velocities in m/s. A position that is NaN means that there is
            no such obstacle in the row.
        obstacle_radius : float or array_like of shape (n, m)
            Radii in m.
        person : bool
            Whether the obstacles are people (`Human`) or discs (`MovingDisc`).
        robot : HolonomicRobot or DifferentialDriveRobot
            The robot of all rows; the default one when ``None``.
        control_period, time_limit, arrival_tolerance, heading, rest_time : float
            As for `Scenario`, for all rows.
        seed : int or array_like of int, shape (n,)
            Seed of each row.

        Returns
        -------
        Scenarios
            ``scenes[i]`` equals the `Scenario` of row i.

        Raises
        ------
        InvalidParameterError
            As `Scenario`; the message names the row. Also if there are more than ten million rows and
            obstacles together.
        ShapeError
            If the arrays do not fit together.
        """
        rows = _row_count(start=start, goal=goal, obstacle_position=obstacle_position)
        ends = own(_ends("start", start, rows)), own(_ends("goal", goal, rows))
        places, speeds, radii = _bodies(obstacle_position, obstacle_velocity, obstacle_radius, rows)
        bodies = own(places), own(speeds), own(radii)
        rules = {
            "control_period": number("control_period", control_period),
            "time_limit": number("time_limit", time_limit),
            "arrival_tolerance": number("arrival_tolerance", arrival_tolerance),
            "heading": number("heading", heading),
            "rest_time": number("rest_time", rest_time),
        }
        driven = checked_robot(robot)
        seeds = own(_seeds(seed, rows))
        of_run = (
            rules["control_period"],
            rules["time_limit"],
            rules["arrival_tolerance"],
            rules["heading"],
            rules["rest_time"],
        )
        native = _hrsafety.Scenarios(ends, bodies, flag("person", person), driven._native, of_run, seeds)

        def row(index: int) -> Scenario:
            return Scenario(
                start=tuple(ends[0][index].tolist()),
                goal=tuple(ends[1][index].tolist()),
                obstacles=tuple(_obstacles(index, bodies, person=person)),
                robot=driven,
                seed=int(seeds[index]),
                **rules,  # type: ignore[arg-type]  # numbers by their names
            )

        again = {
            "start": ends[0],
            "goal": ends[1],
            "obstacle_position": bodies[0],
            "obstacle_velocity": bodies[1],
            "obstacle_radius": bodies[2],
            "person": person,
            "robot": driven,
            "seed": seeds,
        }
        doubt = functools.partial(_may_warn, ends, bodies, driven, rules, person=person)
        return cls(native, (_from_arrays, {**again, **rules}), row, doubt)

    @classmethod
    def _drawn(
        cls,
        kind: Literal["random_traffic", "random_crowd"],
        count: int,
        robot: HolonomicRobot | DifferentialDriveRobot,
        seeds: Sequence[int],
        again: tuple[Callable[..., Any], dict[str, Any]],
        row: Callable[[int], Scenario],
    ) -> Self:
        """Return scenes that the core draws, one for each seed; `row` draws one of them by itself."""
        draw: Callable[..., _hrsafety.Scenarios] = getattr(_hrsafety.Scenarios, kind)

        def doubt() -> npt.NDArray[np.bool_]:
            # What is drawn is plausible, moves and leaves ways: doubts are those of robot and regions, the same in all.
            return np.full(len(seeds), len(seeds) > 0 and len(row(0).warnings) > 0)

        return cls(draw(count, robot._native, seeds), again, row, doubt)

    def __len__(self) -> int:
        """Return the number of scenarios."""
        return len(self._rows)

    @overload
    def __getitem__(self, index: int) -> Scenario: ...
    @overload
    def __getitem__(self, index: slice) -> Self: ...
    def __getitem__(self, index: int | slice) -> Scenario | Self:
        """Return a scenario, or those of a slice."""
        if isinstance(index, slice):
            return self._chosen(range(len(self))[index])
        return self._kept(self._rows[index])

    def _chosen(self, rows: range) -> Self:
        """Return some of them, by their places here."""
        chosen = object.__new__(type(self))
        chosen._made, chosen._kept, chosen._doubt = self._made, self._kept, self._doubt
        chosen._native = self._native.rows(list(rows))
        chosen._rows = self._rows[rows.start : None if rows.stop < 0 else rows.stop : rows.step]
        return chosen

    def __iter__(self) -> Iterator[Scenario]:
        """Return the scenarios one after the other."""
        return map(self._kept, self._rows)

    def __repr__(self) -> str:
        """Return how many there are."""
        return f"Scenarios({len(self)} rows)"

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickle what they were made from."""
        return _again, (*self._made, self._rows)

    @property
    def robot(self) -> HolonomicRobot | DifferentialDriveRobot:
        """The robot of all of them."""
        return self[0].robot

    def doubtful(self) -> Sequence[int]:
        """Return the rows that may have warnings: the others need not be examined one by one."""
        if self._doubt is None:
            return range(len(self))
        found: list[int] = np.flatnonzero(self._doubt()[list(self._rows)]).tolist()
        return found

    @property
    def seeds(self) -> npt.NDArray[np.uint64]:
        """Seed of each of them."""
        return np.array(self._native.seeds(), dtype=np.uint64)


class Numbers(Sequence[str]):
    """The names of scenarios that are numbered, made when they are read.

    Parameters
    ----------
    count : int
        How many.
    """

    __slots__ = ("_total",)

    def __init__(self, count: int) -> None:
        self._total = count

    def __len__(self) -> int:
        """Return how many there are."""
        return self._total

    def __getitem__(self, index: Any) -> Any:
        """Return a name, or those of a slice."""
        found = range(self._total)[index]
        return str(found) if isinstance(found, int) else tuple(map(str, found))

    def __eq__(self, other: object) -> bool:
        """Return whether these are the same names."""
        return tuple(self) == (tuple(other) if isinstance(other, Sequence) else other)

    __hash__ = None  # type: ignore[assignment]  # as for lists


def checked_robot(robot: HolonomicRobot | DifferentialDriveRobot | None) -> HolonomicRobot | DifferentialDriveRobot:
    """Return the robot, or the default one."""
    if robot is None:
        return HolonomicRobot()
    if not isinstance(robot, (HolonomicRobot, DifferentialDriveRobot)):
        instance("robot", robot, HolonomicRobot, DifferentialDriveRobot)
    return robot


def _from_arrays(**given: Any) -> Scenarios:
    return Scenarios.from_arrays(**given)


def _again(make: Callable[..., Scenarios], given: dict[str, Any], rows: range) -> Scenarios:
    made = make(**given)
    return made if rows == range(len(made)) else made._chosen(rows)


def _row_count(**given: object) -> int:
    """Return the number of rows: that of the first array with rows."""
    for name, value in given.items():
        if value is None:
            continue
        shape = _shape(name, value)
        if len(shape) >= 2:
            rows = shape[0]
            if rows == 0:
                raise InvalidParameterError(name, "hold at least one row", Shown("none"))
            if rows > MOST_TABLE_ROWS:
                raise InvalidParameterError(name, f"hold at most {MOST_TABLE_ROWS} rows", Shown(f"{rows} rows"))
            return rows
    raise ShapeError("start", "(n, 2)", np.shape(given["start"]))  # type: ignore[call-overload]  # numbers


def _shape(name: str, value: object) -> tuple[int, ...]:
    """Return the shape of what may be too large to be copied."""
    try:
        return tuple(np.shape(value))  # type: ignore[call-overload]  # the failure is the check
    except ValueError:
        raise InvalidParameterError(name, "be an array of numbers", value) from None


def _ends(name: str, value: object, rows: int) -> Array:
    array = numbers(name, value, "be an array of numbers")
    if array.shape == (2,):
        return np.ascontiguousarray(np.broadcast_to(array, (rows, 2)))
    if points(name, array).shape != (rows, 2):
        raise ShapeError(name, f"({rows}, 2)", array.shape)
    return array


def _bodies(position: object, velocity: object, radius: object, rows: int) -> tuple[Array, Array, Array]:
    """Return positions, velocities and radii of the obstacles of all rows."""
    if position is None:
        if velocity is not None:
            raise InvalidParameterError("obstacle_velocity", "be None without obstacle_position", Shown("an array"))
        nobody = np.empty((rows, 0, 2))
        return nobody, nobody, np.empty((rows, 0))
    shape = _shape("obstacle_position", position)
    if len(shape) != 3 or shape[0] != rows or shape[2] != 2:
        raise ShapeError("obstacle_position", f"({rows}, m, 2)", shape)
    if rows * (1 + shape[1]) > MOST_BODIES:
        rule = f"have at most {MOST_BODIES} rows and obstacles together"
        raise InvalidParameterError("obstacle_position", rule, Shown(str(shape)), "make them in parts")
    places = numbers("obstacle_position", position, "be an array of numbers")
    speeds = np.zeros_like(places) if velocity is None else numbers("obstacle_velocity", velocity)
    if speeds.shape != places.shape:
        raise ShapeError("obstacle_velocity", str(places.shape), speeds.shape)
    radii = numbers("obstacle_radius", radius)
    if radii.ndim == 0:
        radii = np.full(places.shape[:2], float(radii))
    if radii.shape != places.shape[:2]:
        raise ShapeError("obstacle_radius", str(places.shape[:2]), radii.shape)
    return places, speeds, radii


def _may_warn(
    ends: tuple[Array, Array],
    bodies: tuple[Array, Array, Array],
    robot: HolonomicRobot | DifferentialDriveRobot,
    rules: dict[str, float],
    *,
    person: bool,
) -> npt.NDArray[np.bool_]:
    """Return where `Scenario.warnings` may find something: rows that are left out have none."""
    position, velocity, radius = bodies
    driven = {f"robot_{each.name}": getattr(robot, each.name) for each in fields(robot)}
    given = {**driven, **rules}.items()
    common = {name: value for name, value in given if name in RANGES and value is not None}
    if any(_outside(name, np.asarray(value)).any() for name, value in common.items()):
        return np.ones(len(ends[0]), dtype=bool)
    speed = np.hypot(velocity[..., 0], velocity[..., 1])
    size, pace = ("person_radius", "person_speed") if person else ("obstacle_size", "obstacle_speed")
    odd = _outside("floor_position", position).any(axis=-1) | _outside(size, radius) | _outside(pace, speed)
    # What stands may close the way; people faster than the regions reckon with may come too near.
    odd |= (speed < STANDING) | (person & (speed > 1.0))
    there = ~np.isnan(position).all(axis=-1)
    reach = robot.max_speed * rules["time_limit"] + rules["arrival_tolerance"]
    far = np.hypot(*(ends[1] - ends[0]).T) > reach - STANDING
    away = _outside("floor_position", np.concatenate(ends, axis=1)).any(axis=1)
    found: npt.NDArray[np.bool_] = (odd & there).any(axis=1) | far | away
    return found


def _outside(quantity: str, values: Array) -> npt.NDArray[np.bool_]:
    least, most = RANGES[quantity][:2]
    found: npt.NDArray[np.bool_] = (values < least) | (values > most)
    return found


def _seeds(seed: object, rows: int) -> npt.NDArray[np.uint64]:
    if np.ndim(seed) == 0:  # type: ignore[arg-type]  # anything
        return np.full(rows, checked_seed("seed", seed), dtype=np.uint64)
    given = np.asarray(seed)
    if given.shape != (rows,):
        raise ShapeError("seed", f"({rows},)", given.shape)
    if given.dtype.kind not in "iu" or (given.dtype.kind == "i" and (given < 0).any()):
        raise InvalidParameterError("seed", "hold integers from 0 to 2**64 - 1", Shown(f"{given.dtype} values"))
    return np.ascontiguousarray(given, dtype=np.uint64)


def _obstacles(row: int, bodies: tuple[Array, Array, Array], *, person: bool) -> list[Obstacle]:
    """Return the obstacles of a row."""
    found: list[Obstacle] = []
    for place, speed, radius in zip(*(values[row] for values in bodies), strict=True):
        if np.isnan(place).all():
            continue
        at, velocity = tuple(place.tolist()), tuple(speed.tolist())
        if person:
            found.append(Human(start=at, velocity=velocity, radius=float(radius)))
        else:
            found.append(MovingDisc(center=at, velocity=velocity, radius=float(radius)))
    return found
