"""Where everybody in a world was at every step."""

from __future__ import annotations

from typing import Literal

import numpy as np

from hrsafety._arguments import Array
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety.navigation.crowd.world import World
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

    time: float
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
    arrival_time : ndarray of shape (m,)
        When a person reached the end of the route, in s; NaN for those who did not.
    arrival_position : ndarray of shape (m, 2)
        Where that was, in m. Who leaves at the end is absent from ``position`` from that instant on.
    robot_arrival_time : ndarray of shape (k,)
        When a robot arrived, in s; NaN for those that did not.
    diverged : Divergence or None
        Whose state was no longer finite, if that ended the world.
    """

    world: World
    time: Array
    position: Array
    velocity: Array
    robot_position: Array
    robot_velocity: Array
    robot_heading: Array
    radius: Array
    desired_speed: Array
    awareness: Array
    arrival_time: Array
    arrival_position: Array
    robot_arrival_time: Array
    diverged: Divergence | None = None

    @property
    def warnings(self) -> tuple[ResultWarning, ...]:
        """Those of the world, and that it diverged if it did."""
        if self.diverged is None:
            return self.world.warnings
        who, when = f"{self.diverged.kind} {self.diverged.index}", self.diverged.time
        message = (
            f"the world diverged at {when:g} s, {who} first: nothing is known from then on; a smaller step may help"
        )
        return (ResultWarning("unfinished", "diverged", message), *self.world.warnings)

    @property
    def outcomes(self) -> tuple[str, ...]:
        """What became of each robot: ``"arrived"``, ``"timed_out"``, or ``"diverged"``."""
        missed = "timed_out" if self.diverged is None else "diverged"
        return tuple(missed if np.isnan(time) else "arrived" for time in self.robot_arrival_time)

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
