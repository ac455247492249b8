"""The results of ``hrsafety optimize`` as JSON and CSV."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from hrsafety import __version__
from hrsafety import navigation as nav
from hrsafety.cli.optimize.file import GAIN_NAMES, GainStudy
from hrsafety.cli.optimize.found import FoundGains, Scored
from hrsafety.pages.report import json_text

__all__ = ["best_so_far", "settings", "values"]


def values(report: FoundGains) -> dict[str, Any]:
    """Return every value that was found.

    Parameters
    ----------
    report : FoundGains
        What was found.

    Returns
    -------
    dict
        By name.
    """
    found = report.flatness
    return _head(report.path, report.study, report.search) | {
        "seconds": report.seconds,
        "gain_sets": [_scored(entry, report.study) for entry in report.sets],
        "flatness": {
            "tolerance": found.tolerance,
            "low": _by_gain(found.low),
            "high": _by_gain(found.high),
            "near_best_share": found.near_best_share,
            "gains": dict(zip(found.gain_names, found.gains, strict=True)),
            "values": dict(zip(found.gain_names, found.values, strict=True)),
        },
        "sensitivity": report.sensitivity.columns(),
        "history": [_round(entry) for entry in report.search.grids],
        "convergence": report.search.convergence,
        "local": [_local(entry) for entry in report.search.local],
        "front": None if report.front is None else _front(report.front),
    }


def best_so_far(path: str, study: GainStudy, search: nav.GainSearch) -> str:
    """Return what an interrupted search found as JSON.

    Parameters
    ----------
    path : str
        The study file.
    study : GainStudy
        What was asked.
    search : GainSearch
        What was found so far.

    Returns
    -------
    str
        JSON text.
    """
    unfinished = {"interrupted": True}  # the front, if the search itself came to its end
    return json_text(_head(path, study, search) | unfinished | {"history": [_round(entry) for entry in search.grids]})


def _head(path: str, study: GainStudy, search: nav.GainSearch) -> dict[str, Any]:
    """Return what finished and interrupted searches share."""
    confidence = search.confidence
    return {
        "hrsafety": __version__,
        "study": path,
        "title": study.title,
        "interrupted": search.interrupted,
        "status": search.status,
        "shortcoming": search.shortcoming or None,
        "remedy": search.remedy or None,
        "best_gains": _by_gain(search.nearest.gains) if search.valid else None,
        "best_value": search.best_value if search.valid else None,
        "nearest_gains": _by_gain(search.nearest.gains),
        "nearest_value": search.best_value,
        "best_performance": dict(zip(study.names, search.best_performance, strict=True)),
        "feasible": search.feasible,
        "violation": search.violation,
        "confidence": None if confidence is None else confidence._asdict(),
        "evaluations": search.evaluations,
        "episodes": search.episodes,
        "failures": search.failures,
        "warnings": [warning.message for warning in search.warnings],
        "settings": settings(study, search.settings),
    }


def settings(study: GainStudy, found: nav.gains.SearchSettings) -> dict[str, Any]:
    """Return the settings of a search as plain values.

    Parameters
    ----------
    study : GainStudy
        Gives the names of the scenarios.
    found : SearchSettings
        What was searched with.

    Returns
    -------
    dict
        Values by name.
    """
    law = found.law
    modes = ("stabilizing", "stabilizing_force_cap", "stabilizing_momentum_cap", "pass_behind", "side_hysteresis")
    plain: tuple[str, ...] = ("method", "grid", "refinements", "survivors", "local_starts", "evaluations", "seed")
    plain += ("objectives", "weights", "require_arrival", "cap_ratios", "seeds", "robustness")
    plain += ("integrator", "step", "hold")
    return {
        "scenarios": list(study.names),
        "law": {"type": "virtual_force_field"} | {name: getattr(law, name) for name in modes},
        "bounds": _by_gain(found.bounds),
        "constraints": [_constraint(study, entry) for entry in found.constraints],
        "time_limit": study.search.get("time_limit"),
    } | {name: getattr(found, name) for name in plain}


def _constraint(study: GainStudy, entry: object) -> dict[str, Any]:
    assert isinstance(entry, nav.gains.GainConstraint)  # a file cannot name a callable
    place = None if entry.scenario is None else study.names[entry.scenario]
    return {"metric": entry.metric, "at_least": entry.at_least, "at_most": entry.at_most, "scenario": place}


def _scored(entry: Scored, study: GainStudy) -> dict[str, Any]:
    table, runs = entry.scores, {}
    for index, (name, scenario) in enumerate(zip(study.names, study.scenarios, strict=True)):
        runs[name] = {
            "outcome": table.outcome[index],
            "arrival_time_s": table.arrival_time[index],
            "energy_J": table.energy[index],
            "path_length_m": table.path_length[index],
            "min_distance_m": table.min_distance[index, : len(scenario.obstacles)],
            "min_clearance_m": table.min_clearance[index],
            "performance": table.performance_total[index],
            "performance_arrival_time": table.performance_arrival_time[index],
            "performance_avoidance": table.performance_avoidance[index],
            "performance_energy_saving": table.performance_energy_saving[index],
        }
    return {"name": entry.name, "gains": _by_gain(entry.law.gains), "value": entry.value, "scenarios": runs}


def _round(entry: nav.gains.SearchStage) -> dict[str, Any]:
    return {
        "low": _by_gain([axis[0] for axis in entry.axes]),
        "high": _by_gain([axis[-1] for axis in entry.axes]),
        "increments": _by_gain(entry.increments),
        "evaluations": entry.evaluations,
        "failures": entry.failures,
        "best_value": entry.best_value,
        "best_gains": _by_gain(entry.best_gains),
        "survivor_low": _by_gain(entry.survivor_low),
        "survivor_high": _by_gain(entry.survivor_high),
        "worst_survivor": entry.worst_survivor,
    }


def _local(entry: nav.gains.SearchStage) -> dict[str, Any]:
    return {
        "start": _by_gain(entry.start),
        "start_value": entry.start_value,
        "gains": _by_gain(entry.best_gains),
        "value": entry.best_value,
        "violation": entry.violation,
        "evaluations": entry.evaluations,
        "status": entry.status,
    }


def _front(front: nav.gains.ParetoFront) -> dict[str, Any]:
    return {
        "objectives": front.objectives,
        "maximized": front.maximized,
        "gains": front.gains,
        "values": front.values,
        "reference": front.reference,
        "hypervolume": front.hypervolume,
        "evaluations": front.evaluations,
        "failures": front.failures,
    }


def _by_gain(values: Sequence[Any] | np.ndarray[Any, Any]) -> dict[str, Any]:
    return dict(zip(GAIN_NAMES, values, strict=True))
