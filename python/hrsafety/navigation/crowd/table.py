"""Many runs of laws in worlds of people, one robot a row."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Annotated, Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety._statistics import Share, wilson
from hrsafety.navigation.crowd.world import World
from hrsafety.navigation.laws.force_laws import Law
from hrsafety.navigation.metrics.declared import METRICS, WORLD_METRICS, Measured, MeasuredWorld
from hrsafety.navigation.tables.rows import RunRows
from hrsafety.plausibility import ResultWarning
from hrsafety.tables import Columns, unit_suffix

__all__ = ["CrowdTable"]

_OF_ROWS = ("law_index", "scenario_index", "gain_index", "robot", "seed", "gains", "outcome", "end_time")
CONTACTS = ("toward", "away", "standing", "at_fault", "apart")
_CONTACTS = ("contacts_moving", *(f"contacts_{name}" for name in CONTACTS))


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CrowdTable(
    RunRows, Measured[Array, npt.NDArray[np.int64], npt.NDArray[np.bool_]], MeasuredWorld[Array, npt.NDArray[np.int64]]
):
    """Runs of laws in worlds of people that react, a row for each robot; made by `simulate_many` and `compare`.

    The rows are ordered by law, scenario, seed, gains and robot, the robots fastest. Columns that a
    `RunTable` has, too, mean the same. Every metric of ``nav.metrics.METRICS`` (of the robot) and of
    ``WORLD_METRICS`` (of its world) is an attribute and a column.

    Attributes
    ----------
    law_names, scenario_names : tuple of str
        Names of the laws and of the worlds.
    laws, scenarios : sequence
        The laws and the worlds by these names.
    gain_names : tuple of str
        Names of the gains; of several kinds of laws, those of all of them.
    law_index, scenario_index, gain_index : ndarray of int, shape (n,)
        Which law, which world and which gain set.
    robot : ndarray of int, shape (n,)
        Which robot of the world.
    seed : ndarray of int, shape (n,)
        Seed of each run.
    gains : ndarray, shape (n, g)
        Gains of each run; NaN where its law has no such gain.
    outcome : ndarray of str, shape (n,)
        ``"arrived"`` without a contact with people or walls, ``"collided"``, ``"timed_out"``, or
        ``"diverged"`` where the state of the world was no longer finite before the robot arrived; such a run
        may have had a contact, too (``touched``). Contacts between robots change no outcome; they are counted
        for the whole world in ``robot_contacts``.
    end_time : ndarray, shape (n,)
        When the world ended, in s.
    contacts_moving, contacts_standing : ndarray of int, shape (n,)
        Number of people touched, up to the arrival, while the robot was moving (faster than 0.05 m/s at
        first contact), and while it stood; walls are in ``wall_contacts``.
    contacts_toward, contacts_away : ndarray of int, shape (n,)
        How many of those while moving it moved toward at the first touch, V.(o - P) > 0, and how many touched it
        from behind or from the side; their sum is ``contacts_moving``.
    contacts_at_fault : ndarray of int, shape (n,)
        Number of people toward whom the robot moved, faster than 0.05 m/s, at an instant of a contact from the first
        touch until the bodies first overlapped by 0.1 m; every contact with a wall counts.
    contacts_apart : ndarray of int, shape (n,)
        Number of people who appeared in the world where the robot was, and touched it within 0.2 s: in none of the
        others, and no reason for ``"collided"``.
    values : mapping of str to ndarray, shape (n,)
        The metrics by name.
    warnings : tuple of ResultWarning
        Bounds of shields that people, other robots or measurements exceed: the first of each kind; contacts that no
        instant shows, and those between robots.
    """

    law_names: tuple[str, ...]
    scenario_names: tuple[str, ...]
    laws: tuple[Law, ...]
    scenarios: Sequence[World]
    gain_names: tuple[str, ...]
    law_index: npt.NDArray[np.int64]
    scenario_index: npt.NDArray[np.int64]
    gain_index: npt.NDArray[np.int64]
    robot: npt.NDArray[np.int64]
    seed: npt.NDArray[np.uint64]
    gains: Array
    outcome: npt.NDArray[np.str_]
    end_time: Annotated[Array, "s"]
    contacts_toward: npt.NDArray[np.int64]
    contacts_away: npt.NDArray[np.int64]
    contacts_standing: npt.NDArray[np.int64]
    contacts_at_fault: npt.NDArray[np.int64]
    contacts_apart: npt.NDArray[np.int64]
    values: Mapping[str, npt.NDArray[Any]]
    warnings: tuple[ResultWarning, ...] = field(default=())

    def __getattr__(self, name: str) -> Any:
        """Return the column of a metric."""
        # Pickling asks before there are values.
        if name in METRICS or name in WORLD_METRICS:
            return object.__getattribute__(self, "values")[name]
        raise AttributeError(f"{type(self).__name__!r} object has no attribute {name!r}", name=name, obj=self)

    @property
    def success_share(self) -> Share:
        """Share of the rows that arrived without a contact, with its 95 % Wilson interval."""
        return wilson(int((self.outcome == "arrived").sum()), len(self))

    @property
    def contact_share(self) -> Share:
        """Share of the rows with a contact, those that diverged later included, with its 95 % Wilson interval."""
        return wilson(int(self.touched.sum()), len(self))

    @property
    def touched(self) -> npt.NDArray[np.bool_]:
        """Whether the robot of each run had a contact with people or walls, however the run ended."""
        counts: npt.NDArray[np.int64] = self.values["wall_contacts"]
        return (self.contacts_moving + self.contacts_standing + counts) > 0

    @property
    def contacts_moving(self) -> npt.NDArray[np.int64]:
        """Number of people touched while the robot was moving, toward them or away."""
        return self.contacts_toward + self.contacts_away

    def _telling(self) -> tuple[str, ...]:
        found = ("arrival_time_s", "min_clearance_m", "contacts_toward", "contacts_away", "wall_contacts")
        return ("law", "scenario", "outcome", *found)

    def columns(self) -> Columns:
        """Return one-dimensional columns by name, ready for a data frame.

        Returns
        -------
        dict of str to ndarray
            What each row is, how it ended, its contacts, and the metrics with their units.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> world = scenarios.circle_crossing(0, law=nav.VirtualForceField())
        >>> table = nav.simulate_many({"circle": world}, nav.OptimalReciprocalCollisionAvoidance()).columns()
        >>> list(table)[:3], table["outcome"].tolist(), "person_delay_s" in table
        (['law', 'scenario', 'seed'], ['arrived'], True)
        """
        return self._columns(slice(None))

    def _columns(self, rows: slice) -> Columns:
        found = self._of_law(rows) | {"robot": self.robot[rows]} | self._of_gains(rows)
        found |= {"outcome": self.outcome[rows], "end_time_s": self.end_time[rows]}
        found |= {name: getattr(self, name)[rows] for name in _CONTACTS}
        for metric in (*METRICS.values(), *WORLD_METRICS.values()):
            found[metric.name + unit_suffix(metric.unit)] = self.values[metric.name][rows]
        return found

    def _kept(self, kept: npt.NDArray[np.bool_]) -> dict[str, Any]:
        return super()._kept(kept) | {"values": {name: column[kept] for name, column in self.values.items()}}
