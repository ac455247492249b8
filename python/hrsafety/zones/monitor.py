"""Model of Nav2's collision monitor: what it makes of a commanded velocity and of points around the robot."""

from __future__ import annotations

import itertools
import math
from collections.abc import Mapping, Sequence
from dataclasses import field
from typing import Annotated, NamedTuple

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import (
    Array,
    Parameters,
    assign,
    checked_text,
    count,
    finite,
    instance,
    not_negative,
    number,
    numbers,
    points,
    positive,
    sequence,
    whole_steps,
    word,
)
from hrsafety._display import displayed
from hrsafety._doubts import checked_doubts
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, ShapeError, Shown
from hrsafety.plausibility import ResultWarning
from hrsafety.zones.polygons import checked, inside

__all__ = [
    "ACTIONS",
    "TYPES",
    "CollisionMonitor",
    "MonitorPolygon",
    "MonitorState",
    "MonitoredVelocity",
    "VelocityRange",
]

Flags = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.intp]

TYPES = ("polygon", "circle", "velocity_polygon")
ACTIONS = ("stop", "slowdown", "limit", "approach", "none")
"""Actions of polygons, as their files name them."""
NO_SHAPE = -1
MOST_STEPS = 10_000
"""Steps that an ``approach`` may simulate for a command."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class VelocityRange(Parameters):
    """A shape of a velocity polygon and the commands it is for.

    Parameters
    ----------
    name : str
        As in the file.
    corners : ndarray (n, 2)
        In m, in the base frame.
    linear_min, linear_max : float
        Range of vx in m/s; of sqrt(vx^2 + vy^2) where the polygon is holonomic. Borders belong to it.
    theta_min, theta_max : float
        Range of turn rates in rad/s.
    direction_start_angle, direction_end_angle : float
        Range of directions in rad of a holonomic polygon, counter-clockwise from start to end.
    """

    name: str
    corners: Array
    linear_min: float
    linear_max: float
    theta_min: float
    theta_max: float
    direction_start_angle: float = -math.pi
    direction_end_angle: float = math.pi

    def __post_init__(self) -> None:
        """Check shape and borders."""
        checked_text("name", self.name, "be a text")
        self._set(corners=checked("corners", self.corners))
        for name in (
            "linear_min",
            "linear_max",
            "theta_min",
            "theta_max",
            "direction_start_angle",
            "direction_end_angle",
        ):
            self._set(**{name: finite(name, getattr(self, name))})
        for low, high in (("linear_min", "linear_max"), ("theta_min", "theta_max")):
            if getattr(self, low) > getattr(self, high):
                raise InvalidParameterError(low, f"be at most {high} ({getattr(self, high):g})", getattr(self, low))

    def holds(self, command: Array, holonomic: bool) -> Flags:
        """Return which commands (n, 3) it is for."""
        along = np.hypot(command[:, 0], command[:, 1]) if holonomic else command[:, 0]
        held: Flags = (along >= self.linear_min) & (along <= self.linear_max)
        held &= (command[:, 2] >= self.theta_min) & (command[:, 2] <= self.theta_max)
        if holonomic:
            direction = np.where(along == 0.0, 0.0, np.arctan2(command[:, 1], command[:, 0]))
            after, before = direction >= self.direction_start_angle, direction <= self.direction_end_angle
            held &= after & before if self.direction_start_angle <= self.direction_end_angle else after | before
        return np.asarray(held)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class MonitorPolygon(Parameters):
    """A zone of the collision monitor and what is done when points are in it.

    Parameters
    ----------
    name : str
        As in the file.
    type : str
        ``"polygon"``, ``"circle"`` or ``"velocity_polygon"``.
    action : str
        ``"stop"``, ``"slowdown"``, ``"limit"``, ``"approach"`` or ``"none"``.
    corners : ndarray (n, 2) or None
        Of a polygon, in m; ``None`` where a topic brings the shape.
    radius : float
        Of a circle in m.
    ranges : tuple of VelocityRange
        Of a velocity polygon, in the order in which they are tried.
    holonomic : bool
        Whether these ranges are of speed and direction.
    min_points : int
        Points that make it act.
    trigger_consecutive_points, release_consecutive_points : int
        Commands in a row with, and without, so many points until it acts and until it ceases to.
    slowdown_ratio, linear_limit, angular_limit : float
        What is left of the command in its zone.
    time_before_collision, simulation_time_step : float
        Of ``"approach"``, in s.
    sources_names : tuple of str
        Sources that it looks at; all where empty.
    """

    name: str
    type: str
    action: str
    corners: Array | None = None
    radius: float = 0.0
    ranges: tuple[VelocityRange, ...] = ()
    holonomic: bool = False
    min_points: int = 4
    trigger_consecutive_points: int = 1
    release_consecutive_points: int = 1
    slowdown_ratio: float = 0.5
    linear_limit: float = 0.5
    angular_limit: float = 0.5
    time_before_collision: float = 2.0
    simulation_time_step: float = 0.1
    sources_names: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Check type, action, shape and numbers."""
        checked_text("name", self.name, "be a text")
        word("type", self.type, TYPES)
        word("action", self.action, ACTIONS)
        if self.corners is not None:
            self._set(corners=checked("corners", self.corners))
        if self.type == "circle":
            self._set(radius=positive("radius", self.radius))
        else:
            self._set(radius=not_negative("radius", self.radius))
        given = sequence("ranges", "be a list of VelocityRange", self.ranges)
        if self.type == "velocity_polygon" and not given:
            raise InvalidParameterError("ranges", "hold at least one VelocityRange", Shown("none"))
        self._set(ranges=tuple(instance(f"ranges[{index}]", each, VelocityRange) for index, each in enumerate(given)))
        named = sequence("sources_names", "be a list of names", self.sources_names)
        self._set(sources_names=tuple(checked_text("sources_names", each, "be a list of names") for each in named))
        count("min_points", self.min_points, least=0)
        for name in ("trigger_consecutive_points", "release_consecutive_points"):
            count(name, getattr(self, name))
        for name in ("slowdown_ratio", "linear_limit", "angular_limit"):
            self._set(**{name: not_negative(name, getattr(self, name))})
        for name in ("time_before_collision", "simulation_time_step"):
            self._set(**{name: positive(name, getattr(self, name))})
        whole_steps("time_before_collision", self.time_before_collision, self.simulation_time_step, MOST_STEPS)

    def shapes(self, command: Array, last: Indices) -> Indices:
        """Return which shape is used for each command: of several the first, without one the last used."""
        if self.type != "velocity_polygon":
            return np.zeros(len(command), dtype=np.intp)
        found = last.copy()
        open_ = np.ones(len(command), dtype=np.bool_)
        for index, each in enumerate(self.ranges):
            held = open_ & each.holds(command, self.holonomic)
            found[held] = index
            open_ &= ~held
        return found

    def covers(self, command: Array) -> Flags:
        """Return which commands (n, 3) a range holds; all of a polygon without ranges."""
        return np.not_equal(self.shapes(command, np.full(len(command), NO_SHAPE, dtype=np.intp)), NO_SHAPE)

    def count_inside(self, x: Array, y: Array, seen: Flags, shape: Indices) -> Indices:
        """Return how many points (n, m) that are seen lie in the shape of each row."""
        if self.type == "circle":
            return np.asarray((seen & (x * x + y * y < self.radius * self.radius)).sum(axis=1))
        if self.type == "polygon":
            held = np.zeros(x.shape, dtype=np.bool_) if self.corners is None else inside(self.corners, x, y, seen)
            return np.asarray(held.sum(axis=1))
        found = np.zeros(len(x), dtype=np.intp)
        for index, each in enumerate(self.ranges):
            rows = shape == index
            if rows.any():
                found[rows] = inside(each.corners, x[rows], y[rows], seen[rows]).sum(axis=1)
        return found

    def collision_time(self, command: Array, x: Array, y: Array, seen: Flags, shape: Indices) -> Array:
        """Return after which time each command brings so many points into the zone; NaN where it does not."""
        found = np.where(self.count_inside(x, y, seen, shape) >= self.min_points, 0.0, np.nan)
        heading, place = np.zeros(len(command)), np.zeros((len(command), 2))
        time, step = 0.0, self.simulation_time_step
        open_ = np.flatnonzero(np.isnan(found) & (shape != NO_SHAPE) & (command != 0.0).any(axis=1) & seen.any(axis=1))
        while time <= self.time_before_collision and len(open_):
            cos, sin = np.cos(heading[open_]), np.sin(heading[open_])
            vx, vy, turn = command[open_].T
            place[open_, 0] += (vx * cos - vy * sin) * step
            place[open_, 1] += (vx * sin + vy * cos) * step
            heading[open_] += turn * step
            cos, sin = np.cos(heading[open_])[:, np.newaxis], np.sin(heading[open_])[:, np.newaxis]
            away_x, away_y = x[open_] - place[open_, :1], y[open_] - place[open_, 1:]
            moved = cos * away_x + sin * away_y, cos * away_y - sin * away_x
            hit = self.count_inside(*moved, seen[open_], shape[open_]) >= self.min_points
            found[open_[hit]] = time
            open_ = open_[~hit]
            time += step
        return found


class MonitorState(NamedTuple):
    """Memory of the monitor between commands, a column for each polygon.

    Attributes
    ----------
    shape : ndarray (n, polygons) of int
        Shape that each velocity polygon used last; -1 before the first.
    row : ndarray (n, polygons) of int
        Commands in a row with enough points if positive, without if negative.
    acting : ndarray (n, polygons) of bool
        Whether the polygon acts.
    """

    shape: Indices
    row: Indices
    acting: Flags

    @classmethod
    def fresh(cls, robots: int, polygons: int) -> MonitorState:
        """Return the memory before the first command of so many robots."""
        shape = (robots, polygons)
        return cls(
            np.full(shape, NO_SHAPE, dtype=np.intp), np.zeros(shape, dtype=np.intp), np.zeros(shape, dtype=np.bool_)
        )

    def of(self, rows: Indices) -> MonitorState:
        """Return the memory of some of the robots."""
        return MonitorState(self.shape[rows], self.row[rows], self.acting[rows])

    def put(self, rows: Indices, other: MonitorState) -> None:
        """Write the memory of some of the robots."""
        for mine, new in zip(self, other, strict=True):
            mine[rows] = new


@displayed
class MonitoredVelocity(NamedTuple):
    """Velocity that leaves the monitor.

    Attributes
    ----------
    velocity : tuple of float
        vx and vy in m/s and turn rate in rad/s.
    action : str
        What was done; ``"none"`` where the command passes.
    polygon : str
        Name of the zone that did it; empty without one, and where a source is silent.
    covered : bool
        Whether a range of every velocity polygon holds the command.
    """

    velocity: tuple[float, float, float]
    action: str
    polygon: str
    covered: bool = True


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class CollisionMonitor:
    """Nav2's collision monitor: zones in their order, and the sources it listens to.

    Each command is examined once, with the points of the latest scans in the base frame. ``base_shift_correction`` is
    not credited: points stand where the scan saw them.

    Parameters
    ----------
    polygons : tuple of MonitorPolygon
        Zones in their order.
    source_timeout : float
        Silence of a source in s after which the robot stops; 0 for never.
    sources : tuple of str
        Names of the sources.
    warnings : tuple of ResultWarning
        What the file leaves open.
    source : str
        The file.

    Examples
    --------
    >>> from hrsafety import zones
    >>> zone = zones.MonitorPolygon(name="Stop", type="circle", action="stop", radius=0.5, min_points=1)
    >>> monitor = zones.CollisionMonitor(polygons=(zone,))
    >>> monitor.step([0.4, 0.0, 0.0], [[0.45, 0.0]])
    MonitoredVelocity(velocity=(0.0, 0.0, 0.0), action='stop', polygon='Stop', covered=True)
    """

    polygons: tuple[MonitorPolygon, ...]
    source_timeout: Annotated[float, "s"] = 2.0
    sources: tuple[str, ...] = ("scan",)
    warnings: tuple[ResultWarning, ...] = ()
    source: str = ""
    _memory: list[MonitorState] = field(init=False, default_factory=list, repr=False)

    def __post_init__(self) -> None:
        """Check zones and time."""
        given = sequence("polygons", "be a list of MonitorPolygon", self.polygons)
        if not given:
            raise InvalidParameterError("polygons", "hold at least one MonitorPolygon", Shown("none"))
        for index, each in enumerate(given):
            instance(f"polygons[{index}]", each, MonitorPolygon)
        assign(self, "polygons", tuple(given))
        names = sequence("sources", "be a list of names", self.sources)
        rule = "be the name of a source"
        assign(
            self, "sources", tuple(checked_text(f"sources[{place}]", each, rule) for place, each in enumerate(names))
        )
        assign(self, "source_timeout", not_negative("source_timeout", self.source_timeout))
        if not isinstance(self.source, str):
            raise InvalidParameterError("source", "be a text", self.source)
        assign(self, "warnings", tuple(checked_doubts("warnings", self.warnings)))

    def restart(self) -> None:
        """Forget the commands so far: shapes of velocity polygons, and counts of points in a row."""
        self._memory.clear()

    def step(
        self, command: object, seen: object = (), *, silence: float | Mapping[str, float] = 0.0
    ) -> MonitoredVelocity:
        """Return what the monitor makes of the next command.

        Parameters
        ----------
        command : array_like (3,)
            vx and vy in m/s, turn rate in rad/s.
        seen : array_like (n, 2) or mapping of str to array_like
            Points in m in the base frame, of all sources or of each by name.
        silence : float or mapping of str to float
            Time in s since the last message of the sources.

        Returns
        -------
        MonitoredVelocity
            Velocity, action and zone.

        Raises
        ------
        InvalidParameterError, ShapeError
            If an argument is no command or are no points.
        """
        given = numbers("command", command)
        if given.shape != (3,):
            raise ShapeError("command", "(3,)", given.shape)
        if not np.isfinite(given).all():
            raise InvalidParameterError("command", "be finite", given.tolist())
        by_source = dict(seen) if isinstance(seen, Mapping) else {"": seen}
        clouds = {name: _cloud(each) for name, each in by_source.items()}
        everything = np.concatenate([*clouds.values()]) if clouds else np.zeros((0, 2))
        names = np.repeat([*clouds], [len(each) for each in clouds.values()]) if clouds else np.zeros(0, dtype=str)
        if not self._memory:
            self._memory.append(MonitorState.fresh(1, len(self.polygons)))
        state = self._memory[0]
        silent = silence.values() if isinstance(silence, Mapping) else [silence]
        if any(self.is_silent(number("silence", each)) for each in silent):
            return MonitoredVelocity((0.0, 0.0, 0.0), "stop", "")
        covered = all(bool(each.covers(given[np.newaxis])[0]) for each in self.polygons)
        velocity, by = self.decide(
            given[np.newaxis],
            everything[np.newaxis],
            np.isfinite(everything).all(axis=1)[np.newaxis],
            state,
            {each.name: _looked_at(each.sources_names, names) for each in self.polygons},
        )
        zone = self.polygons[int(by[0])] if by[0] >= 0 else None
        out = (float(velocity[0, 0]), float(velocity[0, 1]), float(velocity[0, 2]))
        return MonitoredVelocity(out, zone.action if zone else "none", zone.name if zone else "", covered)

    def is_silent(self, silence: float) -> bool:
        """Return whether a source that has been silent for so long stops the robot."""
        return self.source_timeout > 0.0 and silence > self.source_timeout

    def decide(
        self,
        command: Array,
        place: Array,
        seen: Flags,
        state: MonitorState,
        looked_at: Mapping[str, Flags] | None = None,
    ) -> tuple[Array, Indices]:
        """Return what the monitors of n robots make of their commands, and which zone did it.

        Parameters
        ----------
        command : ndarray (n, 3)
            vx and vy in m/s, turn rate in rad/s.
        place : ndarray (n, m, 2)
            Points in m in the base frame.
        seen : ndarray (n, m) of bool
            Which of them exist.
        state : MonitorState
            Memory, written.
        looked_at : mapping of str to ndarray (m,) of bool
            Points that a zone looks at, by its name; all without it.

        Returns
        -------
        tuple of ndarray (n, 3) and ndarray (n,) of int
            Velocities, and indices of zones; -1 where the command passes.
        """
        best, by = command.copy(), np.full(len(command), -1, dtype=np.intp)
        x, y = place[..., 0], place[..., 1]
        stopped = np.zeros(len(command), dtype=np.bool_)
        for index, zone in enumerate(self.polygons):
            if zone.action == "none":
                continue
            rows = np.flatnonzero(~stopped)
            if not len(rows):
                break
            given, own = command[rows], seen[rows]
            if looked_at is not None and zone.name in looked_at:
                own = own & looked_at[zone.name]
            shape = zone.shapes(given, state.shape[rows, index])
            state.shape[rows, index] = shape
            if zone.action == "approach":
                time = zone.collision_time(given, x[rows], y[rows], own, shape)
                hit, share = np.isfinite(time), time / zone.time_before_collision
            else:
                counted = zone.count_inside(x[rows], y[rows], own, shape) if own.any() else np.zeros_like(shape)
                hit, share = (counted >= zone.min_points) & (shape != NO_SHAPE), _share(zone, given)
            acting = _debounced(zone, hit, state, rows, index)
            if zone.action == "approach":
                acting &= hit  # without a collision ahead there is no time to hold
            slowed = given * np.where(acting, share, 1.0)[:, np.newaxis]
            # Velocities are compared by their squares, as the node does.
            lower = acting & ((slowed**2).sum(axis=1) < (best[rows] ** 2).sum(axis=1))
            if zone.action == "stop":
                lower = acting
                stopped[rows[acting]] = True
            best[rows[lower]] = slowed[lower]
            by[rows[lower]] = index
        return best, by

    def doubts(self, *, reaction_time: float, limits: tuple[Array, Array] | None = None) -> tuple[ResultWarning, ...]:
        """Return what is wrong with the file whatever people do.

        Parameters
        ----------
        reaction_time : float
            Largest time T in s from a leg in a zone until the robot begins to brake.
        limits : tuple of ndarray (3,) or None
            Least and largest commands (m/s, m/s, rad/s) of the robot; ``None``: those that the ranges span.

        Returns
        -------
        tuple of ResultWarning
            ``uncovered_velocity`` for commands that no range of a velocity polygon holds, and
            ``source_timeout_above_reaction``.
        """
        found = []
        for zone in self.polygons:
            gap = first_gap(zone, limits)
            if gap is not None:
                words = ", ".join(f"{each:.4g}" for each in gap)
                message = (
                    f"{zone.name} has no range for commands such as ({words}) m/s, m/s, rad/s: its last shape stays, "
                    "or it has none; add a range that holds them"
                )
                found.append(ResultWarning("uncovered_velocity", zone.name, message))
        if not 0.0 < self.source_timeout <= number("reaction_time", reaction_time) * (1.0 + 1e-9):
            shown = f"{self.source_timeout:g} s" if self.source_timeout else "0, which lets a source be silent for good"
            message = (
                f"source_timeout is {shown}: a scanner that falls silent is noticed later than a leg in a zone "
                f"({reaction_time:g} s); set it to at most that"
            )
            found.append(ResultWarning("source_timeout_above_reaction", "source_timeout", message))
        return tuple(found)

    def uncovered(self, command: object) -> tuple[str, ...]:
        """Return the names of the velocity polygons none of whose ranges holds a command.

        Parameters
        ----------
        command : array_like (3,)
            vx and vy in m/s, turn rate in rad/s.

        Returns
        -------
        tuple of str
            Names in their order.
        """
        given = numbers("command", command).reshape(1, -1)
        if given.shape != (1, 3):
            raise ShapeError("command", "(3,)", given.shape[1:])
        return tuple(each.name for each in self.polygons if not each.covers(given)[0])


def _cloud(value: object) -> Array:
    """Return points (n, 2); an empty list holds none."""
    given = numbers("seen", value)
    return points("seen", given) if given.size else np.zeros((0, 2))


def first_gap(zone: MonitorPolygon, limits: tuple[Array, Array] | None) -> tuple[float, ...] | None:
    """Return a command that no range of a zone holds, ``None`` if there is none.

    Ranges are boxes: between two neighboring borders either all commands are held or none.
    """
    if not zone.ranges:
        return None
    ranges = zone.ranges
    linear = sorted({border for each in ranges for border in (each.linear_min, each.linear_max)})
    turns = sorted({border for each in ranges for border in (each.theta_min, each.theta_max)})
    low, high = (linear[0], turns[0]), (linear[-1], turns[-1])
    if limits is not None:
        low, high = (0.0 if zone.holonomic else limits[0][0], limits[0][2]), (limits[1][0], limits[1][2])
    speeds = _between(linear, low[0], high[0])
    rates = _between(turns, low[1], high[1])
    ways = [0.0]
    if zone.holonomic:
        borders = {way for each in ranges for way in (each.direction_start_angle, each.direction_end_angle)}
        ways = _between(sorted(borders), -math.pi, math.pi)
    grid = np.array([(v * math.cos(way), v * math.sin(way), w) for v in speeds for w in rates for way in ways])
    missing = ~zone.covers(grid)
    if zone.holonomic:  # a speed at a border, turned, may be rounded off it
        missing &= ~zone.covers(grid * (1.0 - 1e-9))
    if not missing.any():
        return None
    # The one nearest to the robot's straight way is the easiest to understand.
    place = np.flatnonzero(missing)
    return tuple(grid[place[np.argmin(np.abs(grid[place]).sum(axis=1))]].tolist())


def _between(borders: Sequence[float], low: float, high: float) -> list[float]:
    """Return limits, the borders between them, and the middles of their gaps."""
    inner = sorted({low, high, *(each for each in borders if low < each < high)})
    return sorted({*inner, *(0.5 * (first + last) for first, last in itertools.pairwise(inner))})


def _share(zone: MonitorPolygon, command: Array) -> Array:
    """Return which share of each command a zone leaves."""
    if zone.action == "stop":
        return np.zeros(len(command))
    if zone.action == "slowdown":
        return np.full(len(command), zone.slowdown_ratio)
    linear, turn = np.hypot(command[:, 0], command[:, 1]), np.abs(command[:, 2])
    with np.errstate(divide="ignore", invalid="ignore"):
        found = np.minimum(
            np.where(linear > 0.0, zone.linear_limit / linear, 1.0),
            np.where(turn > 0.0, zone.angular_limit / turn, 1.0),
        )
    return np.clip(found, 0.0, 1.0)


def _debounced(zone: MonitorPolygon, hit: Flags, state: MonitorState, rows: Indices, index: int) -> Flags:
    """Return where a zone acts: after so many commands in a row with points, until so many without."""
    row = state.row[rows, index]
    row = np.where(hit, np.maximum(row, 0) + 1, np.minimum(row, 0) - 1)
    acting = state.acting[rows, index]
    acting = np.where(acting, -row < zone.release_consecutive_points, row >= zone.trigger_consecutive_points)
    state.row[rows, index] = row
    state.acting[rows, index] = acting
    return np.asarray(acting)


def _looked_at(sources: Sequence[str], names: npt.NDArray[np.str_]) -> Flags:
    """Return which points a zone looks at; those without a source count for all."""
    return np.ones(len(names), dtype=np.bool_) if not sources else (np.isin(names, sources) | (names == ""))
