"""Force terms, sides and Omega in the selected states of the golden file."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from reference import as_package
from reference import plain_field as pf

STATES: list[dict[str, Any]] = json.loads(Path(__file__).with_name("force_states.json").read_text())["states"]
NAMES = [f"{state['name']}, K1 {state['gains']['attractive_gain']}" for state in STATES]
REGIONS = {"C1": "free", "C2": "active", "C3": "critical"}
RELATIVE = 1e-12  # of the norm of a term: some hundred roundings, the file prints 16 digits


def plain_obstacle(entry: dict[str, Any]) -> pf.Round | pf.Box:
    center, r3, r2 = tuple(entry["center"]), entry["critical_radius"], entry["active_radius"]
    if entry["type"] == "rectangle":
        return pf.Box(center, entry["length"], entry["width"], entry["heading"], r3, r2)
    return pf.Round(center, r3, r2, tuple(map(float, entry["velocity"])), tuple(map(float, entry["acceleration"])))


def plain_state(state: dict[str, Any]) -> tuple[pf.Law, pf.Limits, list[pf.Round | pf.Box]]:
    gains = pf.Gains(*(state["gains"][name] for name in nav.VirtualForceField.GAIN_NAMES))
    law = pf.Law(gains, pf.Stabilizing("full"))
    return law, pf.Limits(mass=state["mass"]), [plain_obstacle(entry) for entry in state["obstacles"]]


def assert_equal(actual: Any, expected: Any, what: str) -> None:
    difference = float(np.linalg.norm(np.asarray(actual) - np.asarray(expected)))
    assert difference <= RELATIVE * float(np.linalg.norm(np.asarray(expected))), what


def assert_is_the_state(terms: nav.laws.ForceTerms | pf.Evaluation, state: dict[str, Any]) -> None:
    assert_equal(terms.attractive, state["attractive"], "attractive")
    for i in range(len(state["obstacles"])):
        assert_equal(terms.repulsive[i], state["repulsive"][i], f"repulsive {i}")
        assert_equal(terms.detour[i], state["detour"][i], f"detour {i}")
    assert_equal(terms.omega, state["omega"], "omega")
    assert_equal(terms.stabilizing, state["stabilizing_full"], "stabilizing")
    assert list(terms.region) == [REGIONS[region] for region in state["region"]]
    assert list(terms.side) == [side or 0 for side in state["side"]]


def test_file_holds_every_kind_of_state() -> None:
    assert len(STATES) == 24


@pytest.mark.parametrize("state", STATES, ids=NAMES)
def test_force_terms_equal_the_golden_state(state: dict[str, Any]) -> None:
    law, limits, obstacles = plain_state(state)
    scenario = as_package.scenario(tuple(state["goal"]), obstacles, limits)
    terms = nav.force_terms(as_package.law(law), scenario, position=state["position"], velocity=state["velocity"])
    assert_is_the_state(terms, state)
    summed = np.sum([state["attractive"], *state["repulsive"], *state["detour"], state["stabilizing_full"]], axis=0)
    scale = sum(math.hypot(*part) for part in (state["attractive"], *state["repulsive"], *state["detour"]))
    assert np.linalg.norm(terms.total - summed) <= RELATIVE * (scale + math.hypot(*state["stabilizing_full"]))


@pytest.mark.parametrize("state", STATES, ids=NAMES)
def test_second_evaluation_equals_the_golden_state(state: dict[str, Any]) -> None:
    law, limits, obstacles = plain_state(state)
    position, velocity, goal = (tuple(state[name]) for name in ("position", "velocity", "goal"))
    assert_is_the_state(pf.evaluate(law, limits, position, velocity, goal, obstacles), state)
