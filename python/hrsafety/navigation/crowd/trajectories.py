"""Where everybody in a world was at every step."""

from __future__ import annotations

from typing import Annotated, Any, Literal

import numpy as np

from hrsafety._arguments import Array
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.navigation.crowd.contacts import contacts_of
from hrsafety.navigation.crowd.doubts import of_people
from hrsafety.navigation.crowd.episodes import episodes_in, outcome_of
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.metrics.scores import table_of
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, Table, plane

__all__ = ["CrowdTrajectories", "Divergence"]


@displayed
@dataclass(frozen=True, slots=True)
class Divergence:
    """Whose state was no longer finite, which ended the world.

    Parameters
    ----------
    time : float
        When, in s.
    kind : {"person", "robot"}
        Who.
    index : int
        Which of them.
    """

    time: Annotated[float, "s"]
    kind: Literal["person", "robot"]
    index: int


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class CrowdTrajectories(Table):
    """Everything that happened in a world: n instants, m people, k robots.

    The simulation ends at the time limit, or when all robots have arrived and nobody walks or may come.

    Parameters
    ----------
    world : World
        The world.
    time : ndarray of shape (n,)
        Instants in s.
    position, velocity : ndarray of shape (n, m, 2)
        Of the people, in m and m/s; NaN for those who are absent. People from sources come after the others.
    robot_position, robot_velocity : ndarray of shape (n, k, 2)
        Of the robots, in m and m/s.
    robot_heading : ndarray of shape (n, k)
        Headings of the robots in rad.
    radius, desired_speed, awareness : ndarray of shape (m,)
        Of the people, in m, in m/s, and from 0 to 1, as drawn.
    person_arrival_time : ndarray of shape (m,)
        When a person reached the end of the route, in s; NaN for those who did not.
    person_arrival_position : ndarray of shape (m, 2)
        Where that was, in m. Who leaves at the end is absent from ``position`` from that instant on.
    robot_arrival_time : ndarray of shape (k,)
        When a robot arrived, in s; NaN for those that did not.
    wall_rescues : int
        How often somebody was set back who would have passed a wall or come nearer to it than a tenth of the radius:
        nobody does, whatever a model decides.
    max_person_speed : float
        Largest speed of the people who decide, in m/s, also between instants and before walls take of it.
    diverged : Divergence or None
        Whose state was no longer finite, if that ended the world.
    """

    world: World
    time: Annotated[Array, "s"]
    position: Annotated[Array, "m"]
    velocity: Annotated[Array, "m/s"]
    robot_position: Annotated[Array, "m"]
    robot_velocity: Annotated[Array, "m/s"]
    robot_heading: Annotated[Array, "rad"]
    radius: Array
    desired_speed: Array
    awareness: Array
    person_arrival_time: Annotated[Array, "s"]
    person_arrival_position: Annotated[Array, "m"]
    robot_arrival_time: Annotated[Array, "s"]
    wall_rescues: int
    max_person_speed: Annotated[float, "m/s"]
    diverged: Divergence | None = None

    def __getattr__(self, name: str) -> Any:
        """Say whose arrival is meant, of people or of robots: elsewhere ``arrival_time`` is that of a robot."""
        meant = f": take person_{name} or robot_arrival_time" if name in ("arrival_time", "arrival_position") else ""
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}{meant}", name=name, obj=self)

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Those of the world; that it diverged, that people were set back at walls, or moved faster than people do."""
        # Of a world that diverged its end says more than a speed.
        speed = self.max_person_speed if self.diverged is None else 0.0
        found = (*of_people(self.wall_rescues, speed, self.desired_speed), *self.world.warnings)
        if self.diverged is None:
            return found
        who, when = f"{self.diverged.kind} {self.diverged.index}", self.diverged.time
        message = (
            f"the world diverged at {when:g} s, {who} first: nothing is known from then on; a smaller step may help"
        )
        return (ResultWarning("unfinished", "diverged", message), *found)

    @property
    def outcomes(self) -> tuple[str, ...]:
        """What became of each robot, by the rule and in the words of the tables of `simulate_many`.

        ``"arrived"`` without a contact with people or walls, ``"collided"``, ``"timed_out"``, or ``"diverged"`` where
        the world did so before the robot arrived.
        """
        if not self.world.robots:
            return ()
        episodes = episodes_in(self.world, self.robot_position, self.position, self.radius)
        table = table_of(episodes, threads=1)
        found = zip(episodes, table.arrival_time.tolist(), table.wall_contacts.tolist(), strict=True)
        contacts = [(contacts_of(episode, arrival), walls) for episode, arrival, walls in found]
        arrived = ~np.isnan(self.robot_arrival_time)
        diverged = self.diverged is not None
        return tuple(
            outcome_of(touched=own.moving + own.standing + walls > 0, arrived=bool(there), diverged=diverged)
            for (own, walls), there in zip(contacts, arrived, strict=True)
        )

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, a row for each instant.

        Returns
        -------
        dict of str to ndarray
            Units are in the names; people and robots are numbered.

        Examples
        --------
        >>> from hrsafety import navigation as nav
        >>> world = nav.crowd.World(people=[nav.crowd.Person(start=(0, 0), route=[(2, 0)])])
        >>> list(nav.crowd.simulate_crowd(world).columns())[:3]
        ['t_s', 'person_0_x_m', 'person_0_y_m']
        """
        found: Columns = {"t_s": self.time}
        kinds = (("person", self.position, self.velocity), ("robot", self.robot_position, self.robot_velocity))
        for kind, position, velocity in kinds:
            for index in range(position.shape[1]):
                found |= plane(f"{kind}_{index}_{{}}", position[:, index], "m")
                found |= plane(f"{kind}_{index}_v{{}}", velocity[:, index], "m/s")
        return found
