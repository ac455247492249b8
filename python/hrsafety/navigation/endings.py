"""How a run ended, in one sentence, and why it did not get on where that is known."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from hrsafety import _hrsafety
from hrsafety.navigation.laws.force_laws import VirtualForceField
from hrsafety.navigation.laws.safe_navigation import SafeNavigation
from hrsafety.navigation.scenario import Scenario
from hrsafety.navigation.warnings.runs import keeps_to_regions
from hrsafety.navigation.warnings.scenarios import CLOSED_IN, GOAL_NEAR_STOP, IN_CRITICAL_REGION, OUT_OF_REACH
from hrsafety.navigation.warnings.shields import maps_of

__all__ = ["ending_of", "robot_then"]

_DOUBTED = {
    "goal_in_wall": "the goal lies within walls",
    CLOSED_IN: "what stands leaves no way to the goal",
    IN_CRITICAL_REGION: "the start lies in a critical region",
    OUT_OF_REACH: "the goal is too far for time_limit",
    GOAL_NEAR_STOP: "somebody stops near the goal",
}
"""Doubts about arriving that the run has confirmed, by their codes."""


def ending_of(run: Any) -> str:
    """Return how the run of a robot ended, see `Trajectory.ending`."""
    if run.outcome is None:
        return ""
    in_scenario = isinstance(run.scenario, Scenario)
    goal = run.scenario.goal if in_scenario else run.scenario.robots[run.robot].goal
    last, left = f"{run.time[-1]:.2f} s", f"{math.dist(run.position[-1], goal):.2f} m from the goal"
    if run.outcome == "arrived":
        return f"arrived after {run.arrival_time:.2f} s without a contact"
    if run.outcome == "collided":
        end = f"arrived after {run.arrival_time:.2f} s" if math.isfinite(run.arrival_time) else f"ended {left}"
        times = np.append(run.contact_time, run.map_contact_time)
        first = int(np.nanargmin(times))
        if first == len(run.contact_time):
            return f"contact with a wall at {times[first]:.2f} s with {run.map_contact_speed:.2f} m/s, then {end}"
        who = f"obstacle {first} ({type(run.scenario.obstacles[first]).__name__})" if in_scenario else f"person {first}"
        when = f"at {times[first]:.2f} s with {run.contact_speed[first]:.2f} m/s ({robot_then(run, first)})"
        return f"contact with {who} {when}, then {end}"
    words = {"timed_out": "timed out", "stopped": "stopped for good", "running": "under way"}
    told = f"{words.get(run.outcome, run.outcome)} after {last}, {left}"
    cause = _cause(run) if in_scenario and run.outcome != "running" else None
    return told if cause is None else f"{told}: {cause}"


def robot_then(run: Any, index: int) -> str:
    """Return what the robot did at the first contact with an obstacle."""
    if run.contact_apart[index] and math.isnan(run.contact_time[index]):
        return "appeared on it"
    if math.isnan(run.contact_time[index]):
        return ""
    if run.contact_speed[index] <= _hrsafety.CONTACT_SPEED:
        did = "standing"
    else:
        did = "toward it" if run.contact_toward[index] else "away"
    return f"{did}, at fault" if run.contact_at_fault[index] else did


def _cause(run: Any) -> str | None:
    """Return why a robot in a scenario did not get on: a doubt that came true, a region, or a wall; else ``None``."""
    codes = {each.code for each in run.warnings}
    doubted = next((words for code, words in _DOUBTED.items() if code in codes), None)
    if doubted is not None:
        return f"{doubted}, see .warnings"
    scene, law, place = run.scenario, run.law, run.position[-1]
    if run.distance is not None and keeps_to_regions(law):
        brakes = isinstance(law.law if isinstance(law, SafeNavigation) else law, VirtualForceField)
        for index, (obstacle, away) in enumerate(zip(scene.obstacles, run.distance[-1].tolist(), strict=True)):
            who = f"obstacle {index} ({type(obstacle).__name__})"
            if brakes and away < obstacle.critical_radius:
                return f"it stands in the critical region of {who}, where its law brakes"
            if away < obstacle.active_radius:
                return f"it stands in the active region of {who}, which pushes it away"
    guided = isinstance(law, SafeNavigation) and law.guide is not None
    maps = [*maps_of(law), *([] if scene.walls is None else [scene.walls])]
    if not guided and any(each.segment_clearance(place, scene.goal) < scene.robot.radius for each in maps):
        return "walls stand between it and the goal, and its law has no guide around them"
    return None
