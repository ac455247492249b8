"""The suites: which episodes, with which robot, and what counts."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from itertools import groupby
from pathlib import Path

import numpy as np

from hrsafety import datasets, io, scenarios
from hrsafety import navigation as nav
from hrsafety._arguments import readable
from hrsafety.benchmarks import barn
from hrsafety.benchmarks.drawn import DRAWN, among, crowd, drifting, first_of
from hrsafety.benchmarks.hidden import HIDDEN
from hrsafety.benchmarks.protocol import Case, Suite
from hrsafety.benchmarks.reacting import REACTING
from hrsafety.benchmarks.results import Row
from hrsafety.benchmarks.unknown import UNKNOWN
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import ResultWarning, gathered

__all__ = ["SUITES"]

CHUNK = 50
"""Episodes that are run, and kept, together."""
ERROR = 0.025
"""Error of measured positions in the adversary suite, in m and each axis."""
LATENCY = 0.1
"""Age of measured positions there, in s."""
PURSUED = 12.0
"""Length of an episode there, in s."""
PERSON_SPEED = 1.6
"""Largest speed of the person there, in m/s, whatever shields assume."""


# ---- recorded people ------------------------------------------------------------------------


def recordings(folder: Path | None) -> list[Path]:
    """Return the recordings in a folder, or the one that is named."""
    files = [] if folder is None else sorted(folder.glob("*.csv")) if folder.is_dir() else [readable("data", folder)]
    if not files:
        raise InvalidParameterError("data", "be a folder with recordings (.csv), or one of them", str(folder))
    return files


def _chosen(case: Case, index: int) -> tuple[datasets.Recording, scenarios.Crossing]:
    files = recordings(case.data)
    number, run = divmod(index, RUNS)
    if number >= len(files):
        raise InvalidParameterError("cases", f"be below {RUNS * len(files)}: {RUNS} of each recording", index)
    recording, crossings = _known(files[number])
    return recording, crossings[run]


def _crossing(case: Case, index: int) -> tuple[nav.Scenario, nav.Law]:
    _, crossing = _chosen(case, index)
    scene = crossing.scenario
    return replace(scene, measurement=case.measurement, seed=scene.seed + case.seed), case.built()


RUNS = 24
_KNOWN: dict[Path, tuple[datasets.Recording, list[scenarios.Crossing]]] = {}


def _known(path: Path) -> tuple[datasets.Recording, list[scenarios.Crossing]]:
    if path not in _KNOWN:
        recording = io.load_people(path)
        try:
            found = list(scenarios.crossings(recording, runs=RUNS))
        except InvalidParameterError as error:
            rule = f"hold {RUNS} starts of a robot across its people ({error.argument} must {error.requirement})"
            remedy = "a longer recording, or hrsafety simulate --people FILE --runs N"
            raise InvalidParameterError("data", rule, str(path), remedy) from None
        _KNOWN[path] = recording, found
    return _KNOWN[path]


def _recorded_doubts(folder: Path | None, cases: int) -> tuple[ResultWarning, ...]:
    """Return the doubts about the recordings that so many episodes cross."""
    files = recordings(folder)[: -(-cases // RUNS)]
    return gathered([(file.name, _known(file)[0].warnings) for file in files], "recordings")


def _cross(case: Case) -> Iterator[Row]:
    for index in case.cases:
        place, law = _crossing(case, index)
        recording, crossing = _chosen(case, index)
        run = nav.simulate(place, law)
        yield Row(
            case=index,
            outcome=str(run.outcome),
            arrival_time=float(run.arrival_time),
            end_time=float(run.time[-1]),
            contacts=run.contacts_moving + run.contacts_standing,
            toward=run.contacts_toward,
            away=run.contacts_away,
            at_fault=run.contacts_at_fault,
            walls=run.wall_contacts,
            apart=run.contacts_apart,
            lost=int(bool(recording.lost_near(run, start_time=crossing.start_time))),
            clearance=float(run.min_clearance.min(initial=np.inf)),
        )


# ---- people who want to be touched ----------------------------------------------------------


def _pursued(case: Case) -> tuple[nav.Scenario, nav.Law]:
    measurement = nav.Measurement(scale=ERROR, of="obstacles", latency=LATENCY)
    place = nav.Scenario(
        start=(0.0, 0.0), goal=(8.0, 0.0), time_limit=PURSUED, rest_time=PURSUED, measurement=measurement
    )
    error = float(np.hypot(ERROR, ERROR))
    law = case.entry.built(person_speed=case.person_speed, latency=LATENCY, position_error=error)
    return place, law


def _pursue(case: Case) -> Iterator[Row]:
    place, law = _pursued(case)
    # Persons are drawn block by block: they are the same wherever a run was stopped and resumed.
    for block, group in groupby(case.cases, lambda index: index // CHUNK):
        first, cases = CHUNK * block, list(group)
        found = nav.metrics.falsify(
            place,
            law,
            episodes=cases[-1] - first + 1,
            seed=case.seed + first,
            person_speed=PERSON_SPEED,
            threads=case.threads,
        )
        for index in cases:
            at = index - first
            touched, arrived = found.min_clearance[at] <= 0.0, not np.isnan(found.arrival_time[at])
            yield Row(
                case=index,
                outcome="collided" if touched else "arrived" if arrived else "timed_out",
                arrival_time=float(found.arrival_time[at]),
                end_time=float(found.end_time[at]),
                contacts=int(touched),
                toward=int(found.contacts_toward[at]),
                away=int(found.contacts_away[at]),
                at_fault=int(found.margin[at] < 0.0),
                walls=0,
                apart=0,
                clearance=float(found.margin[at]),
            )


_GUARDED = ("field", "field+shield+yielding", "orca", "orca+shield+yielding")

SUITES: dict[str, Suite] = {
    suite.name: suite
    for suite in (
        Suite(
            name="s4",
            fastest=1.0,
            summary="3 discs drift across 10 m",
            laws=_GUARDED,
            cases=DRAWN,
            seed=1,
            most=DRAWN,
            accepted={(_GUARDED[1], 1.0): "99.5 / 0 / 0"},
            scene=first_of(drifting(3)),
            run=among(drifting(3)),
        ),
        Suite(
            name="s5",
            fastest=1.0,
            summary="12 discs drift across 10 m",
            laws=_GUARDED,
            cases=DRAWN,
            seed=1,
            most=DRAWN,
            accepted={
                (_GUARDED[1], 1.0): "98 / 0.5 / 0",
                (_GUARDED[1], 1.6): "95 / 0.5 / 0",
                (_GUARDED[3], None): "95 / 0.5 / 0",
            },
            scene=first_of(drifting(12)),
            run=among(drifting(12)),
        ),
        Suite(
            name="crowd",
            fastest=1.0,
            summary="12 people cross the way of the robot and do not give way",
            laws=("field", "field+shield+yielding", "orca", "orca+shield", "orca+shield+yielding"),
            cases=1000,
            seed=0,
            most=1_000_000,
            accepted={
                (_GUARDED[1], 1.0): "99.3 / 0.5 / 0",
                (_GUARDED[1], 1.6): "99.3 / 0.5 / 0",
                **{(f"orca+{parts}", None): "- / - / 0" for parts in ("shield", "shield+yielding")},
            },
            scene=first_of(crowd),
            run=among(crowd),
        ),
        Suite(
            name="recordings",
            fastest=None,
            summary="the robot crosses recorded people",
            laws=("field", "field+shield+yielding"),
            cases=RUNS,
            seed=0,
            most=1_000_000,
            files=recordings,
            doubts=_recorded_doubts,
            accepted={(_GUARDED[1], 1.6): "- / - / 0"},
            scene=_crossing,
            run=_cross,
        ),
        Suite(
            name="adversary",
            fastest=PERSON_SPEED,
            summary="a person who sees the robot wants it to be at fault",
            laws=("field", "field+shield", "orca", "orca+shield", "velocity_obstacle", "velocity_obstacle+shield"),
            cases=1000,
            seed=0,
            most=10_000_000,
            sensed=False,
            accepted={(f"{law}+shield", None): "- / - / 0" for law in ("field", "orca", "velocity_obstacle")},
            run=_pursue,
        ),
        Suite(
            name="barn",
            fastest=0.0,
            summary="300 fields of cylinders that the map shows",
            sensed=False,
            laws=barn.LAWS,
            cases=300,
            seed=0,
            most=barn.MOST_WORLDS,
            files=barn.world_files,
            available=barn.worlds_in,
            accepted=barn.ACCEPTED,
            scene=barn.world_scene,
            run=barn.run_worlds,
        ),
        *(
            Suite(
                name=name,
                fastest=None,
                summary=f"60 worlds of cylinders that move, in 10 phases, a robot of {most:g} m/s^2",
                laws=barn.DYNAMIC_LAWS,
                cases=600,
                seed=0,
                most=600,
                files=barn.dynamic_files,
                sensed=False,
                step=0.025,
                accepted={(barn.DYNAMIC_LAWS[0], None): f"{asked} / - / -"},
                scene=barn.dynamic_scene(most),
                run=barn.run_dynamic(most),
            )
            for name, most, asked in (("dynabarn", 10.0, 97), ("dynabarn3", 3.0, 94))
        ),
        *REACTING,
        *UNKNOWN,
        *HIDDEN,
    )
}
"""The suites by name."""
