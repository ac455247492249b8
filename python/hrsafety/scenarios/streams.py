"""Streams of people that react: corridors, crossings, a bottleneck."""

from __future__ import annotations

from collections.abc import Sequence

from hrsafety._arguments import count, flag, number, positive
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.crowd.agents import Person, Robot, Source
from hrsafety.navigation.crowd.pedestrians import Pedestrian
from hrsafety.navigation.crowd.world import World
from hrsafety.scenarios.placing import FAR, MOST_PEOPLE, RADIUS, drawn, extent, lattice, model_of

__all__ = ["bottleneck", "corridor", "cross_torus", "crossing"]

FASTEST = 4.0
"""Faster than anybody walks, in m/s: walls of worlds that repeat themselves are long enough for it."""
CORRIDOR = 3.0
"""Width of the corridors of a crossing, in m."""
ARM = 8.0
"""Length of each arm of a crossing from its middle, in m."""
ROOM = 8.0
"""Side of the room before a bottleneck, in m."""
BEHIND = 2.0
"""Distance behind the door of a bottleneck at which people have left, in m."""


def corridor(
    n: int,
    *,
    length: float = 10.0,
    width: float = 3.0,
    two_way: bool = True,
    model: Pedestrian | None = None,
    radius: float = RADIUS,
    desired_speed: float | None = None,
    robots: Sequence[Robot] = (),
    seed: int = 0,
    time_limit: float = 40.0,
) -> World:
    """Return people in a corridor that repeats itself along x.

    Parameters
    ----------
    n : int
        How many people.
    length, width : float
        Of the corridor in m; its walls are y = 0 and y = width.
    two_way : bool
        Whether every second person walks to -x.
    model : Pedestrian or None
        Model of the people; ``None``: `CollisionFreeSpeed`.
    radius : float
        Of the people, in m.
    desired_speed : float or None
        Of the people, in m/s; ``None``: drawn.
    robots : sequence of Robot
        Robots among them.
    seed : int
        Seed of the places and of the world.
    time_limit : float
        Longest simulated time in s.

    Returns
    -------
    World
        The same for the same arguments.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> world = scenarios.corridor(30, seed=1)
    >>> world.period
    (10.0, 0.0)
    """
    people = count("n", n, least=0, most=MOST_PEOPLE)
    checked, generator = drawn(seed)
    long, wide = extent("length", length), extent("width", width)
    limit = positive("time_limit", time_limit)
    body = positive("radius", radius)
    of, both = model_of(model), flag("two_way", two_way)
    edge = min(body, 0.5 * wide)
    places = lattice(generator, people, (0.0, edge), (long, wide - edge) if wide > 2 * edge else (long, edge + 1e-9))
    end = long + FASTEST * limit
    return World(
        people=[
            Person(
                start=(x, y),
                route=[(x + (-FAR if both and index % 2 else FAR), y)],
                model=of,
                radius=body,
                desired_speed=desired_speed,
            )
            for index, (x, y) in enumerate(places.tolist())
        ],
        robots=robots,
        walls=[((-end, 0.0), (end, 0.0)), ((-end, wide), (end, wide))],
        period=(long, 0.0),
        seed=checked,
        time_limit=limit,
    )


def crossing(
    n: int = 0,
    *,
    rate: float = 1.0,
    model: Pedestrian | None = None,
    desired_speed: float | None = None,
    robots: Sequence[Robot] = (),
    seed: int = 0,
    time_limit: float = 60.0,
) -> World:
    """Return two streams of people at right angles, in corridors of 3 m that cross.

    People come from (-8, 0) and from (0, -8) and leave 8 m beyond the crossing.

    Parameters
    ----------
    n : int
        How many people are there at the start, half of them in each of the arms where people come from.
    rate : float
        People per second of each source.
    model : Pedestrian or None
        Model of the people; ``None``: `CollisionFreeSpeed`.
    desired_speed : float or None
        Of the people, in m/s; ``None``: drawn.
    robots : sequence of Robot
        Robots among them.
    seed : int
        Seed of the places and of the world.
    time_limit : float
        Longest simulated time in s.

    Returns
    -------
    World
        The same for the same arguments.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> len(scenarios.crossing(10).people)
    10
    """
    people = count("n", n, least=0, most=MOST_PEOPLE)
    checked, generator = drawn(seed)
    of = model_of(model)
    half = 0.5 * CORRIDOR
    edge = half - RADIUS
    along = lattice(generator, people - people // 2, (-ARM + 1.0, -edge), (-half, edge)).tolist()
    across = lattice(generator, people // 2, (-ARM + 1.0, -edge), (-half, edge)).tolist()
    ends = ((ARM, 0.0), (0.0, ARM))
    starts = [(x, y, ends[0]) for x, y in along] + [(y, x, ends[1]) for x, y in across]
    corner = [(-ARM - 1.0, half), (-half, half), (-half, ARM + 1.0)]
    turns = ((1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0))
    entries = (((-ARM, -edge), (-ARM + 0.5, edge)), ((-edge, -ARM), (edge, -ARM + 0.5)))
    return World(
        people=[
            Person(
                start=(x, y), route=[end], model=of, desired_speed=desired_speed, at_end="leave", arrival_radius=half
            )
            for x, y, end in starts
        ],
        sources=[
            Source(
                low=low,
                high=high,
                rate=rate,
                route=[end],
                model=of,
                desired_speed=desired_speed,
                arrival_radius=half,
            )
            for (low, high), end in zip(entries, ends, strict=True)
        ],
        robots=robots,
        walls=[tuple((sx * x, sy * y) for x, y in corner) for sx, sy in turns],
        seed=checked,
        time_limit=time_limit,
    )


def cross_torus(
    n: int,
    *,
    side: float = 10.0,
    model: Pedestrian | None = None,
    desired_speed: float | None = None,
    robots: Sequence[Robot] = (),
    seed: int = 0,
    time_limit: float = 60.0,
) -> World:
    """Return a square that repeats itself, in which half of the people walk along x and half along y.

    Parameters
    ----------
    n : int
        How many people.
    side : float
        Of the square, in m.
    model : Pedestrian or None
        Model of the people; ``None``: `CollisionFreeSpeed`.
    desired_speed : float or None
        Of the people, in m/s; ``None``: drawn.
    robots : sequence of Robot
        Robots among them.
    seed : int
        Seed of the places and of the world.
    time_limit : float
        Longest simulated time in s.

    Returns
    -------
    World
        The same for the same arguments.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> scenarios.cross_torus(20, side=8.0).period
    (8.0, 8.0)
    """
    people = count("n", n, least=0, most=MOST_PEOPLE)
    checked, generator = drawn(seed)
    length = extent("side", side)
    of = model_of(model)
    places = lattice(generator, people, (0.0, 0.0), (length, length))
    ways = generator.permutation(people) % 2
    return World(
        people=[
            Person(
                start=(x, y),
                route=[(x, y + FAR) if way else (x + FAR, y)],
                model=of,
                desired_speed=desired_speed,
            )
            for (x, y), way in zip(places.tolist(), ways.tolist(), strict=True)
        ],
        robots=robots,
        period=(length, length),
        seed=checked,
        time_limit=time_limit,
    )


def bottleneck(
    n: int = 100,
    *,
    door: float = 1.0,
    model: Pedestrian | None = None,
    desired_speed: float | None = None,
    robots: Sequence[Robot] = (),
    seed: int = 0,
    time_limit: float = 120.0,
) -> World:
    """Return a room of 8 m x 8 m that people leave through a door in the middle of x = 8.

    Parameters
    ----------
    n : int
        How many people.
    door : float
        Width of the door in m.
    model : Pedestrian or None
        Model of the people; ``None``: `CollisionFreeSpeed`.
    desired_speed : float or None
        Of the people, in m/s; ``None``: drawn.
    robots : sequence of Robot
        Robots among them.
    seed : int
        Seed of the places and of the world.
    time_limit : float
        Longest simulated time in s.

    Returns
    -------
    World
        The same for the same arguments. People go to the nearest point of the line of the door, and leave where they
        are 2 m behind it.

    Raises
    ------
    InvalidParameterError
        If an argument is out of range.

    Examples
    --------
    >>> from hrsafety import scenarios
    >>> scenarios.bottleneck(20, door=1.2).people[0].at_end
    'leave'
    """
    people = count("n", n, least=0, most=MOST_PEOPLE)
    checked, generator = drawn(seed)
    wide = number("door", door)
    if not 0.0 < wide < ROOM:
        raise InvalidParameterError("door", f"be positive and below {ROOM:g} m", door)
    of = model_of(model)
    places = lattice(generator, people, (RADIUS, RADIUS), (ROOM - 1.0, ROOM - RADIUS)).tolist()
    middle = 0.5 * ROOM
    low, high = middle - 0.5 * wide, middle + 0.5 * wide
    walls = [(ROOM, low), (ROOM, 0.0), (0.0, 0.0), (0.0, ROOM), (ROOM, ROOM), (ROOM, high)]
    return World(
        people=[
            Person(
                start=(x, y),
                route=[((ROOM, low), (ROOM, high)), ((ROOM + BEHIND, 0.0), (ROOM + BEHIND, ROOM))],
                model=of,
                desired_speed=desired_speed,
                at_end="leave",
            )
            for x, y in places
        ],
        robots=robots,
        walls=[walls],
        seed=checked,
        time_limit=time_limit,
    )
