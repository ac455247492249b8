"""Laws in the same worlds of people with the same seeds."""

from __future__ import annotations

from typing import Annotated

import numpy as np

from hrsafety._arguments import word
from hrsafety._display import displayed
from hrsafety._records import dataclass
from hrsafety._statistics import Mean, Share, mean_interval, wilson
from hrsafety.navigation.crowd.table import CrowdTable
from hrsafety.navigation.metrics.declared import METRICS
from hrsafety.navigation.tables.pairs import PairedRuns
from hrsafety.tables import Columns

__all__ = ["CrowdComparison", "CrowdStanding"]

_OF_SUCCESS = ("arrival_time", "path_length")
"""What a run that ended otherwise has no fair value of."""


@displayed
@dataclass(frozen=True, kw_only=True, slots=True)
class CrowdStanding:
    """What one law did in all episodes among people that react.

    Attributes
    ----------
    law : str
        Its name.
    success, contact, diverged : Share
        Share of the episodes in which the robot arrived without a contact with people or walls, in which it
        had one, however they ended, and in which the world diverged before the robot arrived, with 95 %
        Wilson intervals.
    person_contact, wall_contact : Share
        Share with a contact with a person, and with a wall.
    moving_contact, toward_contact, away_contact : Share
        Share with a contact with a person while the robot itself was moving; with one toward whom it moved, and with
        one who came from behind or from the side, as ``contacts_toward`` and ``contacts_away`` of a `CrowdTable`.
    at_fault : Share
        Share with a contact at fault; every one with a wall is.
    robot_contact : Share
        Share of the episodes in whose world robots touched each other, whichever; these are no contacts of
        the shares above.
    arrival_time, path_length : Mean
        Over the episodes with success, in s and m, with 95 % bootstrap intervals.
    min_clearance, discomfort_time : Mean
        Over all episodes, in m and s.
    person_delay : Mean
        Over the episodes in which it is known, in s: people were simulated without robots, too.
    """

    law: str
    success: Share
    contact: Share
    diverged: Share
    person_contact: Share
    wall_contact: Share
    moving_contact: Share
    toward_contact: Share
    away_contact: Share
    at_fault: Share
    robot_contact: Share
    arrival_time: Annotated[Mean, "s"]
    path_length: Annotated[Mean, "m"]
    min_clearance: Annotated[Mean, "m"]
    discomfort_time: Annotated[Mean, "s"]
    person_delay: Annotated[Mean, "s"]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class CrowdComparison(PairedRuns[CrowdTable]):
    """Runs of several laws in the same worlds of people: rows are laws, columns episodes.

    An episode is a robot of a world with a seed. Made by `compare`.

    Attributes
    ----------
    runs : CrowdTable
        All runs, one robot a row, as `simulate_many` returned them.
    laws, scenario_names : sequence of str
        Names of the laws and of the worlds.
    scenario, seed : ndarray of int, shape (episodes,)
        Index of each episode's world, and its seed.
    outcome : ndarray of str, shape (laws, episodes)
        ``"arrived"``, ``"collided"``, ``"timed_out"`` or ``"diverged"``.
    """

    runs: CrowdTable

    def columns(self) -> Columns:
        """Return the columns of the runs by name, a row for each law and episode.

        Returns
        -------
        dict of str to ndarray
            Laws by name, the episodes of a law in a row; units are in the names.

        Examples
        --------
        >>> from hrsafety import navigation as nav, scenarios
        >>> law = nav.OptimalReciprocalCollisionAvoidance()
        >>> worlds = [scenarios.circle_crossing(case, law=law) for case in range(3)]
        >>> nav.compare(worlds, {"reciprocal": law, "field": nav.VirtualForceField()}).columns()["law"].tolist()
        ['reciprocal', 'reciprocal', 'reciprocal', 'field', 'field', 'field']
        """
        return self.runs.columns()

    def metric(self, name: str) -> np.ndarray:
        """Return a metric of the robots.

        Parameters
        ----------
        name : str
            One of ``nav.metrics.METRICS``.

        Returns
        -------
        ndarray, shape (laws, episodes)
            Its values.

        Raises
        ------
        InvalidParameterError
            If there is no such metric.
        """
        return self._by_law(self.runs.values[word("name", name, tuple(METRICS))])

    def _touched(self) -> np.ndarray:
        return self._by_law(self.runs.touched)

    def standing(self, law: str) -> CrowdStanding:
        """Return what one law did in all episodes.

        Parameters
        ----------
        law : str
            Its name.

        Returns
        -------
        CrowdStanding
            Shares and means with intervals.

        Raises
        ------
        InvalidParameterError
            If there is no such law.
        """
        row = self._row("law", law)
        arrived = self.outcome[row] == "arrived"
        table = self.runs

        def share(flags: np.ndarray) -> Share:
            return wilson(int(flags.sum()), len(flags))

        def touched(counts: np.ndarray) -> Share:
            return share(self._by_law(counts)[row] > 0)

        def mean(name: str) -> Mean:
            values = self.metric(name)[row]
            return mean_interval(values[arrived if name in _OF_SUCCESS else np.isfinite(values)])

        return CrowdStanding(
            law=law,
            success=share(arrived),
            contact=share(self._touched()[row]),
            diverged=share(self.outcome[row] == "diverged"),
            person_contact=touched(table.contacts_moving + table.contacts_standing),
            wall_contact=touched(table.values["wall_contacts"]),
            moving_contact=touched(table.contacts_moving),
            toward_contact=touched(table.contacts_toward),
            away_contact=touched(table.contacts_away),
            at_fault=touched(table.contacts_at_fault),
            robot_contact=touched(table.values["robot_contacts"]),
            arrival_time=mean("arrival_time"),
            path_length=mean("path_length"),
            min_clearance=mean("min_clearance"),
            discomfort_time=mean("discomfort_time"),
            person_delay=mean("person_delay"),
        )

    def standings(self) -> list[CrowdStanding]:
        """Return the standing of every law, in the order given."""
        return [self.standing(law) for law in self.laws]

    def difference(self, first: str, second: str, metric: str = "arrival_time") -> Mean:
        """Return the mean difference of two laws, episode by episode.

        Parameters
        ----------
        first, second : str
            Names of the laws; the difference is first minus second.
        metric : str
            One of ``nav.metrics.METRICS``. Time and length are compared in the episodes in which both
            laws arrived without a contact, the others in all in which they are finite.

        Returns
        -------
        Mean
            Mean of the differences with its 95 % bootstrap interval.

        Raises
        ------
        InvalidParameterError
            If there is no such law or metric.
        """
        word("metric", metric, tuple(METRICS))
        values = self.metric(metric).astype(np.float64)
        return self._difference(first, second, values, successful=metric in _OF_SUCCESS)
