"""Warnings of scenarios that matter for the law that drives the robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import replace

from hrsafety.navigation.laws.force_laws import Law, VirtualForceField
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.scenario_warnings import BELOW_SAFE, IN_CRITICAL_REGION
from hrsafety.plausibility import ResultWarning

__all__ = ["of_run", "of_runs"]


def of_run(scenario: Scenario, law: Law) -> tuple[ResultWarning, ...]:
    """Return the warnings of a scenario that matter for a law.

    Parameters
    ----------
    scenario : Scenario
        Where it runs.
    law : Law
        What drives the robot. Only the virtual force field brakes in critical regions, so their size
        says nothing about the other laws.

    Returns
    -------
    tuple of ResultWarning
        The warnings.
    """
    if isinstance(law, VirtualForceField):
        return scenario.warnings
    about_regions = (BELOW_SAFE, IN_CRITICAL_REGION)
    return tuple(each for each in scenario.warnings if each.code not in about_regions)


def of_runs(scenarios: Sequence[Scenario], names: Sequence[str], laws: Iterable[Law]) -> tuple[ResultWarning, ...]:
    """Return the warnings of many runs, the first of each kind with the number of the others.

    Parameters
    ----------
    scenarios : sequence of Scenario
        Where they run.
    names : sequence of str
        Their names, for the subjects.
    laws : iterable of Law
        What drives the robots.

    Returns
    -------
    tuple of ResultWarning
        One for each code, in the order in which they were found.
    """
    kept = list(laws)
    first: dict[str, ResultWarning] = {}
    others: dict[str, int] = {}
    for name, scenario in zip(names, scenarios, strict=True):
        seen = {each: None for law in kept for each in of_run(scenario, law)}
        for each in seen:
            if each.code in first:
                others[each.code] = others.get(each.code, 0) + 1
            else:
                message = f"{name}: {each.message}"
                first[each.code] = ResultWarning(each.code, f"{name}.{each.subject}", message)
    more = {code: f" ({count} more of this kind in these scenarios)" for code, count in others.items()}
    return tuple(replace(each, message=each.message + more.get(each.code, "")) for each in first.values())
