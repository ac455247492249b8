"""How well people are foretold: windows of a recording, and the errors of models in them."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Annotated, Any, Literal, NamedTuple, get_args

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array, points, positive, thread_count, vector, whole_steps, word
from hrsafety._bounds import MOST_INTERVAL
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.errors import InvalidParameterError, Shown
from hrsafety.navigation.crowd.agents import Person
from hrsafety.navigation.crowd.pedestrians import Pedestrian
from hrsafety.navigation.crowd.simulation import simulated
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.crowd.world_run import WorldRun
from hrsafety.navigation.metrics.episode import Recorded
from hrsafety.plausibility import ResultWarning, telling

__all__ = ["Baseline", "Part", "PredictionErrors", "Windows", "errors_of", "of_recording", "prediction_errors"]

Baseline = Literal["constant_velocity", "straight"]
Part = Literal["first", "second", "all"]

STEP = 0.05
"""Step of the worlds in s."""
ARRIVAL_RADIUS = 0.1
"""Distance to the end of the recorded way at which people stand, in m."""
_ROUNDING = 1e-6
"""Share of an interval by which instants of a recording may be off."""


@displayed
class PredictionErrors(NamedTuple):
    """Mean distances between where people were foretold and where they were recorded.

    Attributes
    ----------
    windows : int
        Of how many windows, each of one person.
    one_step : float
        After one interval of the recording, in m.
    average : float
        Over all instants that are foretold (ADE), in m.
    final : float
        At the last of them (FDE), in m.
    """

    windows: int
    one_step: Annotated[float, "m"]
    average: Annotated[float, "m"]
    final: Annotated[float, "m"]


class Track(NamedTuple):
    """A person of a recording: the number of the first instant, and positions in m."""

    first: int
    position: Array


@dataclass(frozen=True, slots=True)
class Windows:
    """Windows of a recording: people who are seen for some instants and foretold for others.

    Parameters
    ----------
    tracks : mapping of int to Track
        Everybody.
    scored : mapping of int to sequence of int
        Who is present all through the window, by the number of the last instant seen.
    interval : float
        Time between two instants in s.
    seen, foretold : int
        Numbers of instants.
    """

    tracks: Mapping[int, Track]
    scored: Mapping[int, Sequence[int]]
    interval: float
    seen: int
    foretold: int

    @classmethod
    def of(cls, recording: Recorded, *, seen: float, foretold: float, every: float) -> Windows:
        """Return the windows of a recording, with durations in s."""
        tracks, interval = _tracks(recording)
        counts = {"seen": seen, "foretold": foretold, "every": every}
        steps = {name: _whole(name, value, interval) for name, value in counts.items()}
        if steps["seen"] < 2:
            raise InvalidParameterError("seen", f"be at least two intervals of {interval:g} s", seen)
        length = steps["seen"] + steps["foretold"]
        ends = {who: track.first + len(track.position) for who, track in tracks.items()}
        scored: dict[int, list[int]] = {}
        for first in range(0, max(ends.values()) - length + 1, steps["every"]):
            whole = [who for who, track in tracks.items() if track.first <= first and first + length <= ends[who]]
            if whole:
                scored[first + steps["seen"] - 1] = whole
        if len(scored) < 2:
            rule = "hold two windows, each with a person who is there all through it"
            raise InvalidParameterError("recording", rule, Shown(f"{len(scored)}"), "shorten seen and foretold")
        return cls(tracks, scored, interval, steps["seen"], steps["foretold"])

    def part(self, part: Part) -> Windows:
        """Return those of the first or the second half of the instants, or all.

        Windows of the second half that share an instant with one of the first half are in neither: what is fitted in
        one half is not held out in the other.
        """
        every = sorted(self.scored)
        half = len(every) // 2
        apart = every[half - 1] + self.foretold + self.seen
        later = [instant for instant in every[half:] if instant >= apart]
        chosen = {"first": every[:half], "second": later, "all": every}[part]
        if not chosen:
            rule = "hold a window that shares no instant with those of its first half"
            advice = "take a longer one, shorten seen and foretold, or take all windows"
            raise InvalidParameterError("recording", rule, Shown("none"), advice)
        kept = {instant: self.scored[instant] for instant in chosen}
        return Windows(self.tracks, kept, self.interval, self.seen, self.foretold)

    def present(self, instant: int) -> dict[int, Array]:
        """Return what was seen, up to an instant, of everybody who is present at it."""
        found = {}
        for who, track in self.tracks.items():
            row = instant - track.first
            if 0 <= row < len(track.position):
                found[who] = track.position[max(0, row - self.seen + 1) : row + 1]
        return found

    def recorded(self, instant: int, who: int) -> Array:
        """Return where a person was at the instants that are foretold."""
        track = self.tracks[who]
        row = instant - track.first + 1
        return track.position[row : row + self.foretold]


def _rows_of(recording: Recorded) -> tuple[Array, npt.NDArray[np.int64], Array]:
    """Return instants, persons and positions, checked: the recording may be any object that has them."""
    try:
        given = recording.time_s, recording.person, recording.position
    except AttributeError:
        raise InvalidParameterError("recording", "have time_s, person and position", recording) from None
    time, person = vector("recording.time_s", given[0]), np.asarray(given[1])
    position = points("recording.position", given[2])
    if person.ndim != 1 or person.dtype.kind not in "iuU":
        raise InvalidParameterError("recording.person", "be an array (n,) of integers or words", given[1])
    if person.dtype.kind == "U":  # words by their place in the alphabet
        person = np.unique(person, return_inverse=True)[1].ravel()
    if not len(time) == len(person) == len(position):
        lengths = f"{len(time)}, {len(person)} and {len(position)} rows"
        raise InvalidParameterError("recording", "have as many persons and positions as instants", Shown(lengths))
    for name, values in (("time_s", time), ("position", position)):
        if not np.isfinite(values).all():
            row = int(np.flatnonzero(~np.isfinite(values).reshape(len(values), -1).all(axis=1))[0])
            raise InvalidParameterError(f"recording.{name}[{row}]", "be finite", values[row].tolist())
    return time, person, position


def _tracks(recording: Recorded) -> tuple[dict[int, Track], float]:
    """Return everybody's positions at equal instants, and the interval in s."""
    time, person, position = _rows_of(recording)
    rows = {int(who): person == who for who in np.unique(person)}
    gaps = [np.diff(time[kept]) for kept in rows.values()]
    if not any(len(each) for each in gaps):
        raise InvalidParameterError("recording", "have somebody at two instants", Shown("none"))
    interval = float(min(each.min() for each in gaps if len(each)))
    tracks = {}
    begin = float(time.min())
    for who, kept in rows.items():
        number = (time[kept] - begin) / interval
        whole = np.round(number)
        if np.abs(number - whole).max() > _ROUNDING * max(1.0, float(number[-1])) or (np.diff(whole) != 1.0).any():
            rule = f"have everybody at every interval of {interval:g} s while present"
            raise InvalidParameterError("recording", rule, Shown(f"person {who}"))
        tracks[who] = Track(int(whole[0]), position[kept])
    return tracks, interval


def _whole(name: str, duration: float, interval: float) -> int:
    """Return how many intervals a duration is."""
    steps = whole_steps(name, positive(name, duration), interval, MOST_INTERVAL)
    if abs(steps - round(steps)) > _ROUNDING or steps < 0.5:
        raise InvalidParameterError(name, f"be a multiple of the interval of the recording, {interval:g} s", duration)
    return round(steps)


def _mean_speed(seen: Array, interval: float) -> float:
    return float(np.hypot(*np.diff(seen, axis=0).T).sum()) / (interval * max(1, len(seen) - 1))


def _world(windows: Windows, instant: int, model: Pedestrian, radius: float) -> World:
    """Return everybody who is present at an instant, on the way to the end of the recorded track."""
    people = []
    for who, seen in windows.present(instant).items():
        velocity = (seen[-1] - seen[-2]) / windows.interval if len(seen) > 1 else np.zeros(2)
        people.append(
            Person(
                start=(float(seen[-1, 0]), float(seen[-1, 1])),
                route=[tuple(windows.tracks[who].position[-1].tolist())],
                velocity=(float(velocity[0]), float(velocity[1])),
                desired_speed=_mean_speed(seen, windows.interval),
                model=model,
                radius=radius,
                arrival_radius=ARRIVAL_RADIUS,
            )
        )
    parts = math.ceil(windows.interval / STEP - _ROUNDING)
    limit = windows.foretold * windows.interval
    return World(people=people, step=windows.interval / parts, time_limit=limit)


def errors_of(
    models: Sequence[Pedestrian], windows: Windows, *, radius: float, threads: int | None
) -> list[PredictionErrors]:
    """Return the errors of some models in the same windows, simulated side by side."""
    instants = list(windows.scored)
    worlds = [_world(windows, instant, model, radius) for model in models for instant in instants]
    runs = simulated(worlds, threads=threads)
    found = []
    for index in range(len(models)):
        own = runs[index * len(instants) : (index + 1) * len(instants)]
        parts = [_distances(windows, instant, run) for instant, run in zip(instants, own, strict=True)]
        found.append(_errors(np.concatenate(parts)))
    return found


def _distances(windows: Windows, instant: int, run: WorldRun) -> Array:
    """Return the errors of everybody who is scored, instant by instant; infinite where the world diverged."""
    parts = round(windows.interval / run.scenario.step)
    rows = parts * np.arange(1, windows.foretold + 1)
    numbers = {who: index for index, who in enumerate(windows.present(instant))}
    place = run.obstacle_position[np.minimum(rows, len(run.time) - 1)]
    apart = [np.hypot(*(place[:, numbers[who]] - windows.recorded(instant, who)).T) for who in windows.scored[instant]]
    # Who has arrived stands there; a world that diverged says nothing from then on.
    over = rows >= len(run.time) if run.diverged is not None else np.zeros(len(rows), dtype=bool)
    return np.where(over, np.inf, np.array(apart))


def _errors(distances: Array) -> PredictionErrors:
    return PredictionErrors(
        len(distances), float(distances[:, 0].mean()), float(distances.mean()), float(distances[:, -1].mean())
    )


def _baseline(kind: Baseline, windows: Windows) -> PredictionErrors:
    """Return the errors of people who do not react."""
    ahead = np.arange(1, windows.foretold + 1)[:, None]
    distances = []
    for instant, scored in windows.scored.items():
        present = windows.present(instant)
        for who in scored:
            seen = present[who]
            if kind == "constant_velocity":
                way = ahead * (seen[-1] - seen[-2])
            else:
                goal = windows.tracks[who].position[-1] - seen[-1]
                distance = float(np.hypot(*goal))
                gone = np.minimum(ahead * windows.interval * _mean_speed(seen, windows.interval), distance)
                way = gone * (goal / distance if distance > 0.0 else 0.0)
            distances.append(np.hypot(*(seen[-1] + way - windows.recorded(instant, who)).T))
    return _errors(np.array(distances))


def of_recording(*given: Any, **named: Any) -> Iterable[ResultWarning]:
    """Return the doubts about the recording of a call, its second argument."""
    recording = given[1] if len(given) > 1 else named.get("recording")
    return getattr(recording, "warnings", ())


@telling(of_recording)
def prediction_errors(
    model: Pedestrian | Baseline,
    recording: Recorded,
    *,
    part: Part = "all",
    seen: float = 3.2,
    foretold: float = 4.8,
    every: float = 1.6,
    radius: float = 0.2,
    threads: int | None = None,
) -> PredictionErrors:
    """Return how far people of a model are from recorded ones.

    A window holds people who are seen for a while and foretold for a while. All who are present at the last
    instant seen are simulated, from their places and velocities, with their mean speeds so far. Their goal is
    the end of their recorded track, which ``"constant_velocity"`` does not know.

    Parameters
    ----------
    model : Pedestrian, "constant_velocity" or "straight"
        What foretells; ``"straight"``: everybody walks straight to the goal and reacts to no person.
    recording : Recording
        People at equal instants; any object with ``time_s``, ``person`` and ``position``.
    part : {"first", "second", "all"}
        Which half of the instants with windows. Windows of the second half that share an instant with one of the
        first half are left out: no window is partly in both.
    seen, foretold, every : float
        Duration that is seen, that is foretold, and between two windows, in s: multiples of the interval of
        the recording.
    radius : float
        Of the people, in m.
    threads : int or None
        Number of threads; all cores when ``None``. Never changes a bit of the result.

    Returns
    -------
    PredictionErrors
        Errors after one interval, in the mean, and at the end.

    Raises
    ------
    InvalidParameterError
        If the recording has gaps or no two windows, or none in the half, or a value is out of range.

    Examples
    --------
    >>> import numpy as np
    >>> from hrsafety import datasets, navigation as nav
    >>> time, person = np.repeat(0.4 * np.arange(30), 2), np.tile([1, 2], 30)
    >>> place = np.column_stack([1.2 * time, 3.0 * person])
    >>> walk = datasets.Recording(time_s=time, person=person, position=place)
    >>> found = nav.crowd.prediction_errors("constant_velocity", walk)
    >>> found.windows, found.final < 1e-9
    (6, True)
    """
    if not isinstance(model, Pedestrian):
        word("model", model, get_args(Baseline))
    windows = Windows.of(recording, seen=seen, foretold=foretold, every=every)
    word("part", part, get_args(Part))
    windows = windows.part(part)
    body = positive("radius", radius)
    if isinstance(model, Pedestrian):
        return errors_of([model], windows, radius=body, threads=thread_count(threads))[0]
    return _baseline(model, windows)
