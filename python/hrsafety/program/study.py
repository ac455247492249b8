"""Study of a program: verdict, cycle times, what each segment costs, zones, measurement plan, scanner field."""

from __future__ import annotations

import math
from typing import Annotated, Any, NamedTuple

import numpy as np

from hrsafety._records import dataclass
from hrsafety.contact import Annex, MeasurementPlan
from hrsafety.contact.cell.handover import distances_fields
from hrsafety.contact.cell.stops import distances_of, doubts_of
from hrsafety.plausibility import ResultWarning
from hrsafety.program.annexed import annex_of_task
from hrsafety.program.contacts import MASSES, Choice, Waypoints
from hrsafety.program.judged import JudgedExposure, fields_of, judged, named_doubts, path_doubts, robot_fields
from hrsafety.program.motion import Retimed
from hrsafety.program.plan import plan_of
from hrsafety.program.runs import Runs
from hrsafety.program.task import ProgramTask
from hrsafety.program.zoned import PathSpeeds, SpeedZones, speeds_of, told_limit, zones_of
from hrsafety.standards.fields import FieldDistances
from hrsafety.standards.verdicts import doubted, strictest
from hrsafety.tables import Columns, Table

__all__ = ["CycleTime", "ProgramStudy", "SegmentCost", "study_of"]


class CycleTime(NamedTuple):
    """A duration of the program in s, ``None`` where some limit allows no motion, with what it holds for."""

    name: str
    covering: str | None
    time: float | None
    status: str


class SegmentCost(NamedTuple):
    """Cost of the limits of contacts in a segment.

    Attributes
    ----------
    segment : int
        Its place in the program.
    name : str
        Its name.
    free, limited : float
        Duration at the limits of the joints, and within those of contacts, in s; inf at a standstill.
    governs : str
        What limits it for the longest time.
    share : float
        Share of its duration in which that does.
    """

    segment: int
    name: str
    free: float
    limited: float
    governs: str
    share: float

    @property
    def cost(self) -> float:
        """Time that the limits of contacts cost in s; what is nothing but rounding is 0."""
        more = self.limited - self.free
        return 0.0 if abs(more) <= 1e-9 * self.free else more


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class ProgramStudy(Table):
    """Results of a program.

    Attributes
    ----------
    program : ProgramTask
        What was asked.
    verdict : {"not_permitted", "exceeds", "not_checked", "within_limits"}
        Of the program as it is planned: that of its worst limit.
    rows : tuple of JudgedExposure
        Each limit with the waypoint that uses it most, the hardest one first.
    times : tuple of CycleTime
        As recorded, at the limits of the joints, within limits of contacts bare and with each covering, with zones.
    segments : tuple of SegmentCost
        The most expensive one first.
    free, limited : Retimed
        Runs at the limits of the joints, and within those of contacts with the coverings that are planned.
    zones : SpeedZones or None
        As typed into the pendant.
    plan : MeasurementPlan
        What has to be measured.
    annex : Annex
        For the technical file of Regulation (EU) 2023/1230.
    distances : FieldDistances or None
        Of the scanner field, with a separation.
    fastest, least_allowed : float
        Largest planned speed of a point, and smallest speed that is allowed to one along the path, in m/s.
    waypoints : Waypoints
        Planned places.
    speeds : PathSpeeds
        What holds along the path.
    warnings : tuple of ResultWarning
        Of all results.
    fields : dict
        Every result by name, as report.json holds it.
    """

    program: ProgramTask
    verdict: str
    rows: tuple[JudgedExposure, ...]
    times: tuple[CycleTime, ...]
    segments: tuple[SegmentCost, ...]
    free: Retimed
    limited: Retimed
    zones: SpeedZones | None
    plan: MeasurementPlan
    annex: Annex
    distances: FieldDistances | None
    fastest: Annotated[float, "m/s"]
    least_allowed: Annotated[float, "m/s"]
    waypoints: Waypoints
    speeds: PathSpeeds
    warnings: tuple[ResultWarning, ...]
    fields: dict[str, Any]
    _table: Columns

    def columns(self) -> Columns:
        """Return one row for each waypoint and point of the planned program.

        Returns
        -------
        dict of str to ndarray
            Time, path parameter, point, its velocity and masses, the allowed speed, what governs and the scale.
        """
        return dict(self._table)


def study_of(program: ProgramTask, *, intervals: int | None = None, threads: int | None = None) -> ProgramStudy:
    """Return the study of a program, see `Program.report`."""
    runs = Runs(program, intervals, threads)
    choice = runs.planned
    rows, contact, waypoints = runs.rows(choice), runs.contact(choice), runs.waypoints()
    general = tuple(path_doubts(runs))
    found = judged(runs, waypoints, contact, rows, general)
    found.sort(key=lambda each: -each.share if each.exposure.limit.permitted else -math.inf)
    free, limited, zones = runs.retimed(None), runs.retimed(choice), zones_of(runs, choice)
    table, fastest, least = _table(runs, waypoints, choice)
    segments = tuple(sorted(_costs(runs, free, limited, choice), key=lambda each: -_ranked(each)))
    times = tuple(_times(runs, zones))
    warnings = _warnings(runs, found, (free, limited, *(() if zones is None or zones.run is None else (zones.run,))))
    distances = None
    if program.separation is not None and fastest > 0.0:
        slow = min(least, fastest) if least > 0.0 else None
        distances = distances_of(program.separation, fastest, slow)
    # Distances are handed over beside the contacts: a doubt about them is one about the whole.
    apart = doubts_of(None, distances, program.separation, program.motion.arm.payload_mass)
    own = tuple(each for each in (*general, *apart) if each.code not in program.confirmed)
    verdict = doubted(strictest(each.verdict for each in found), own) if found else doubted("within_limits", own)
    plan = plan_of(runs, limited, choice)
    annex = annex_of_task(program, found, fastest, distances)
    fields = _fields(runs, verdict, found, times, segments, zones, distances) | {"annex": annex.fields()}
    return ProgramStudy(
        program=program,
        verdict=verdict,
        rows=tuple(found),
        times=times,
        segments=segments,
        free=free,
        limited=limited,
        zones=zones,
        plan=plan,
        annex=annex,
        distances=distances,
        fastest=fastest,
        least_allowed=least,
        waypoints=waypoints,
        speeds=speeds_of(runs, choice),
        warnings=tuple(dict.fromkeys([*warnings, *apart])),
        fields=fields,
        _table=table,
    )


def _ranked(each: SegmentCost) -> float:
    return each.cost if math.isfinite(each.limited) else math.inf


def _table(runs: Runs, waypoints: Waypoints, choice: Choice) -> tuple[Columns, float, float]:
    """Return one row for each waypoint and point, the fastest planned and the least allowed speed."""
    program, contact, rows = runs.program, runs.contact(choice), runs.rows(choice)
    points = len(program.points)
    allowed = contact.allowed(waypoints.joints, waypoints.rates, waypoints.place, threads=runs.threads)
    masses = contact.masses(waypoints.joints, waypoints.rates, body_masses=np.zeros(0), threads=runs.threads)
    lowest, speed = allowed["lowest"][:, :points], allowed["speed"]
    moving = (speed[:, :points] > 0.0) & (allowed["governs"][:, :points] >= 0)
    names = np.array([*(told_limit(runs, rows, place) for place in range(len(rows) + 1)), ""])
    governs = np.minimum(allowed["governs"][:, :points], len(rows))
    velocity = masses["velocity"][:, :points].reshape(-1, 3)
    table: Columns = {
        "t_s": np.repeat(waypoints.time, points),
        "s": np.repeat(waypoints.place, points),
        "point": np.tile(np.array([each.name for each in program.points]), len(waypoints.time)),
        "vx_m_per_s": velocity[:, 0],
        "vy_m_per_s": velocity[:, 1],
        "vz_m_per_s": velocity[:, 2],
        "speed_m_per_s": speed[:, :points].reshape(-1),
        **{f"{name}_kg": masses[name][:, :points].reshape(-1) for name in MASSES},
        "allowed_speed_m_per_s": lowest.reshape(-1),
        "governs": names[governs.reshape(-1)],
        "scale": allowed["scale"][:, :points].reshape(-1),
    }
    least = float(lowest[moving].min()) if moving.any() else math.inf
    return table, float(speed.max(initial=0.0)), least


def _costs(runs: Runs, free: Retimed, limited: Retimed, choice: Choice) -> list[SegmentCost]:
    """Return what limits of contacts cost in each segment."""
    found = []
    nodes, lasting = runs.motion.curve.nodes, (math.isfinite(free.time), math.isfinite(limited.time))
    for place, (first, last) in enumerate(runs.spans):
        name = runs.program.segment_name(place)
        without = float(np.diff(free.at_place([first, last]))[0]) if lasting[0] else math.inf
        if not all(lasting):
            found.append(SegmentCost(place, name, without, math.inf, "a limit that allows no motion", 1.0))
            continue
        within, steps = float(np.diff(limited.at_place([first, last]))[0]), np.diff(limited.instants)
        inside = (nodes[1:] > first) & (nodes[:-1] < last)
        spent: dict[tuple[int, int], float] = {}
        for reason, index, step in zip(
            limited.reason[inside].tolist(), limited.reason_index[inside].tolist(), steps[inside].tolist(), strict=True
        ):
            spent[reason, index] = spent.get((reason, index), 0.0) + step
        longest = max(spent, key=lambda each: spent[each])
        share = spent[longest] / max(sum(spent.values()), 1e-300)
        found.append(SegmentCost(place, name, without, within, _governs(runs, choice, *longest), share))
    return found


def _governs(runs: Runs, choice: Choice, reason: int, index: int) -> str:
    """Return what limits a place in words."""
    if reason < 2:
        return f"{('acceleration', 'velocity')[reason]} of {runs.program.motion.arm.joint_names[index]}"
    return told_limit(runs, runs.rows(choice), index) if reason == 2 else "zone"


def _times(runs: Runs, zones: SpeedZones | None) -> list[CycleTime]:
    """Return the durations of the program."""
    motion, program = runs.motion, runs.program
    found = []
    if motion.log is not None:
        found.append(CycleTime("as recorded", None, float(motion.log.time[-1] - motion.log.time[0]), "recorded"))
    found.append(_timed("at robot limits", None, runs.retimed(None)))
    choices = {"bare": runs.coverings(None)} | {name: runs.coverings(name) for name in program.coverings}
    if runs.planned not in choices.values():
        found.append(_timed("within limits of contacts, as planned", None, runs.retimed(runs.planned)))
    for name, choice in choices.items():
        covering = None if name == "bare" else name
        found.append(_timed(f"within limits of contacts, {name}", covering, runs.retimed(choice)))
    if zones is not None:
        status = zones.status
        run = zones.run
        found.append(
            _timed("with typed zones", None, run) if run else CycleTime("with typed zones", None, None, status)
        )
    return found


def _timed(name: str, covering: str | None, run: Retimed) -> CycleTime:
    return CycleTime(name, covering, run.time if math.isfinite(run.time) else None, run.status)


def _warnings(runs: Runs, found: list[JudgedExposure], retimed: tuple[Retimed, ...]) -> tuple[ResultWarning, ...]:
    """Return each doubt once."""
    doubts = [*named_doubts(runs.program, found)]
    if not found:
        doubts = [*path_doubts(runs), *runs.program.motion.arm.warnings]
    return tuple(dict.fromkeys([*doubts, *(each for run in retimed for each in run.warnings)]))


def _fields(
    runs: Runs,
    verdict: str,
    found: list[JudgedExposure],
    times: tuple[CycleTime, ...],
    segments: tuple[SegmentCost, ...],
    zones: SpeedZones | None,
    distances: FieldDistances | None,
) -> dict[str, Any]:
    """Return every result by name."""
    program = runs.program
    names = program.motion.arm.joint_names
    codes = [code for row in found for code in dict.fromkeys(each.code for each in row.doubts)]
    return {
        "verdict": verdict,
        "doubts": {code: codes.count(code) for code in sorted(set(codes))},
        "confirmed": dict(program.confirmed),
        "times": [each._asdict() for each in times],
        "segments": [_segment(runs, each) for each in segments],
        "rows": [fields_of(each, runs) for each in found],
        "zones": None if zones is None else _zones(zones),
        "distances": None if distances is None else distances_fields(distances),
        "robot": robot_fields(program, runs.motion.velocity)
        | {"acceleration": dict(zip(names, runs.motion.acceleration.tolist(), strict=True))},
        "path": {
            "length": runs.motion.curve.length,
            "intervals": len(runs.motion.curve.coefficients),
            "stops": len(runs.motion.stops),
            "dwell": sum(runs.motion.dwells),
            "residual": runs.motion.residual,
            "without_segment": program.uncovered,
        },
        "retimed": {
            name: {"status": run.status, "largest_share": run.largest_share, "rounds": run.rounds}
            for name, run in (("joints", runs.retimed(None)), ("contact", runs.retimed(runs.planned)))
        },
    }


def _segment(runs: Runs, each: SegmentCost) -> dict[str, Any]:
    segment = runs.program.segments[each.segment]
    first, last = runs.spans[each.segment]
    return {
        "name": each.name,
        "from": segment.start,
        "to": segment.end,
        "regions": list(segment.regions),
        "clamped": segment.clamped,
        "reason": segment.reason,
        "human_speed": segment.human_speed,
        "first": first,
        "last": last,
        "time_joints": each.free if math.isfinite(each.free) else None,
        "time_contact": each.limited if math.isfinite(each.limited) else None,
        "cost": each.cost if math.isfinite(each.limited) else None,
        "governs": each.governs,
        "governs_share": each.share,
    }


def _zones(zones: SpeedZones) -> dict[str, Any]:
    rows = [
        {
            "from": each.start._asdict(),
            "to": each.end._asdict(),
            "speed": each.speed,
            "change": each.change,
            "reason": each.reason,
        }
        for each in zones.zones
    ]
    time = None if zones.run is None or not math.isfinite(zones.run.time) else zones.run.time
    return {
        "status": zones.status,
        "unit": "%" if zones.percent else "m/s",
        "zones": rows,
        "time": time,
        "blocked": [each._asdict() for each in zones.blocked],
    }
