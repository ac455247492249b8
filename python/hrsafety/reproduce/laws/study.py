"""Every law with the unpredictable person, and the demonstrations of section 2.2.5."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety._records import dataclass
from hrsafety.navigation.metrics import Paired, Share, compare_paired, wilson
from hrsafety.reproduce.laws.compared import COMPARED, FORCES, LIKE_SOURCE, Compared, printed_walk, varied_walk
from hrsafety.reproduce.measured import LAWS

__all__ = [
    "WALKS",
    "Demonstration",
    "Encounters",
    "LawsStudy",
    "compare",
    "compared_contacts",
    "rows",
]

Array = npt.NDArray[np.float64]

WALKS = 200
# Below this speed the robot stands: it is touched, it does not touch.
STANDING = 0.05
DRAWING_LAW = "random_tree"
_TWICE = nav.Masoud(repulsive_gain=48.0)
_FULL_SPEED, _HAIR = 0.7, 1e-9  # m/s, and m on either side of an edge


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Encounters:
    """Encounters of one law with many walks of the person, walk by walk.

    Attributes
    ----------
    contact, standing : ndarray of bool, shape (n,)
        Whether robot and person touched, and whether the robot stood when they did.
    contact_time, least_distance, arrival_time : ndarray, shape (n,)
        First contact in s (NaN without), least distance of the centers in m, arrival in s (NaN
        without).
    """

    contact: npt.NDArray[np.bool_]
    standing: npt.NDArray[np.bool_]
    contact_time: Array
    least_distance: Array
    arrival_time: Array

    @property
    def touched(self) -> Share:
        """Share of the walks with a contact."""
        return wilson(int(self.contact.sum()), len(self.contact))

    @property
    def touched_moving(self) -> Share:
        """Share of the walks with a contact while the robot was moving."""
        return wilson(int((self.contact & ~self.standing).sum()), len(self.contact))

    @property
    def arrived(self) -> Share:
        """Share of the walks with an arrival and without a contact."""
        return wilson(int((np.isfinite(self.arrival_time) & ~self.contact).sum()), len(self.contact))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Demonstration:
    """One law of virtual forces in the cases of section 2.2.5.

    Attributes
    ----------
    standing, walking : Trajectory
        Exactly collinear with a standing disc, and with a person who comes the other way.
    beside : Trajectory
        Configuration 1: the disc 5 mm beside the line to the goal.
    jump : float
        By how much the force jumps at the edge of the active region of the disc, in N, for a
        robot that comes straight on at full speed.
    """

    standing: nav.Trajectory
    walking: nav.Trajectory
    beside: nav.Trajectory
    jump: float

    @property
    def crossings(self) -> int:
        """How often the robot crosses the edge of the active region in configuration 1."""
        return crossings(self.beside)

    @property
    def way_back(self) -> float:
        """Way that the robot goes away from the goal in configuration 1, in m."""
        return way_back(self.beside)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LawsStudy:
    """All runs of the part.

    Attributes
    ----------
    printed : dict of str to Trajectory
        By law, with the printed walk.
    varied : dict of str to Encounters
        By law, with the varied walks, in the order of their seeds.
    drawn : Encounters
        The tree that draws, with the printed walk and the same seeds.
    demonstrations : dict of str to Demonstration
        By law of virtual forces.
    parallel : dict of str to Trajectory
        Section 6.4.5: the new field, Masoud, and Masoud with twice the repulsion.
    twice_repulsion : ndarray, shape (2, 4)
        H of configurations c1 to c4 with Masoud and with Masoud with twice the repulsion.
    """

    printed: dict[str, nav.Trajectory]
    varied: dict[str, Encounters]
    drawn: Encounters
    demonstrations: dict[str, Demonstration]
    parallel: dict[str, nav.Trajectory]
    twice_repulsion: Array


def compare(progress: Callable[[str], object] | None = None) -> LawsStudy:
    """Run every law with the printed walk and its variations, and the demonstrations."""
    everything = {**COMPARED, **LIKE_SOURCE}
    walks = [varied_walk(seed) for seed in range(WALKS)]
    varied = {}
    for name, entry in everything.items():
        if progress is not None:
            progress(f"laws: {entry.label}, {len(walks)} walks of the person")
        varied[name] = _encounters(walks, entry.law)
    seeded = [replace(printed_walk(), seed=seed) for seed in range(WALKS)]
    return LawsStudy(
        printed={name: nav.simulate(printed_walk(), entry.law) for name, entry in everything.items()},
        varied=varied,
        drawn=_encounters(seeded, COMPARED[DRAWING_LAW].law),
        demonstrations={name: _demonstrate(entry) for name, entry in FORCES.items()},
        parallel=_parallel(),
        twice_repulsion=np.stack([_scores(law) for law in (nav.Masoud(), _TWICE)]),
    )


def _encounters(places: Sequence[nav.Scenario], law: nav.Law) -> Encounters:
    runs = [nav.simulate(place, law) for place in places]
    speed = np.array([run.contact_speed[0] for run in runs])
    instant = np.array([run.contact_time[0] for run in runs])
    return Encounters(
        contact=np.isfinite(instant),
        standing=np.isfinite(instant) & (speed <= STANDING),
        contact_time=instant,
        least_distance=np.array([run.min_distance[0] for run in runs]),
        arrival_time=np.array([run.arrival_time for run in runs]),
    )


def _demonstrate(entry: Compared) -> Demonstration:
    beside = scenarios.configuration("c1")
    disc = nav.Disc(center=(2.45, 0.6), radius=0.1, critical_radius=0.4, active_radius=0.8)
    collinear = replace(beside, obstacles=(disc,))
    edge = 2.45 + 0.8
    force = [
        nav.laws.command(entry.law, collinear, position=(edge + side, 0.6), velocity=(-_FULL_SPEED, 0.0))
        for side in (-_HAIR, _HAIR)
    ]
    return Demonstration(
        standing=nav.simulate(collinear, entry.law),
        walking=nav.simulate(scenarios.configuration("c2"), entry.law),
        beside=nav.simulate(beside, entry.law),
        jump=float(np.hypot(*(force[0] - force[1]))),
    )


def crossings(run: nav.Trajectory) -> int:
    """Return how often the robot crosses the edge of the active region of the first obstacle."""
    radius = float(getattr(run.scenario.obstacles[0], "active_radius", 0.0))
    return int(np.count_nonzero(np.diff(run.distance[:, 0] < radius)))


def way_back(run: nav.Trajectory) -> float:
    """Return the way that the robot goes away from the goal, in m."""
    to_goal = np.hypot(*(run.position - np.asarray(run.scenario.goal)).T)
    return float(np.maximum(np.diff(to_goal), 0.0).sum())


def _parallel() -> dict[str, nav.Trajectory]:
    place = scenarios.configuration("parallel_human")
    laws: Mapping[str, nav.Law] = {"new_vff": LAWS["new_vff"], "masoud": LAWS["masoud"], "masoud_twice": _TWICE}
    return {name: nav.simulate(place, law) for name, law in laws.items()}


def _scores(law: nav.Law) -> Array:
    places = [scenarios.configuration(name) for name in ("c1", "c2", "c3", "c4")]
    return np.asarray(nav.simulate_batch(places, law).performance_total)


def rows(study: LawsStudy) -> list[dict[str, Any]]:
    """Return one row for each law with the unpredictable person, columns with units."""
    table = []
    for name, entry in {**COMPARED, **LIKE_SOURCE}.items():
        run, many = study.printed[name], study.varied[name]
        times = many.contact_time[many.contact]
        apart = compared_contacts(study, name)
        row: dict[str, Any] = {
            "law": entry.label,
            "printed_contact": bool(np.isfinite(run.contact_time[0])),
            "printed_contact_time_s": float(run.contact_time[0]),
            "printed_least_distance_m": float(run.min_distance[0]),
            "printed_arrival_time_s": float(run.arrival_time),
            "walks": len(many.contact),
        }
        for word, share in (("contact", many.touched), ("moving", many.touched_moving), ("arrival", many.arrived)):
            row |= {word: share.count, f"{word}_share": share.value}
            row |= {f"{word}_share_low": share.low, f"{word}_share_high": share.high}
        row |= {
            "median_contact_time_s": float(np.median(times)) if len(times) else math.nan,
            "least_distance_smallest_m": float(many.least_distance.min()),
            "least_distance_median_m": float(np.median(many.least_distance)),
            "contact_here_only": apart.only_first,
            "contact_new_vff_only": apart.only_second,
            "paired_p_value": apart.p_value,
        }
        table.append({key: None if isinstance(v, float) and not math.isfinite(v) else v for key, v in row.items()})
    return table


def compared_contacts(study: LawsStudy, name: str) -> Paired:
    """Compare the contacts of a law with those of the new field, walk by walk."""
    return compare_paired(study.varied[name].contact, study.varied["new_vff"].contact)
