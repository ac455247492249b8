"""Decisions of the pedestrian models in the states of crowd_cases.json, which Rust reads too."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav

CASES = json.loads((Path(__file__).parent / "crowd_cases.json").read_text(encoding="utf-8"))
MODELS: dict[str, type[nav.crowd.Pedestrian]] = {
    "social_force_1995": nav.crowd.SocialForce1995,
    "social_force_2000": nav.crowd.SocialForce2000,
    "moussaid": nav.crowd.Moussaid,
    "collision_free_speed": nav.crowd.CollisionFreeSpeed,
    "orca": nav.crowd.ReciprocalAvoidance,
}
RELATIVE = 1e-10
"""Of the largest component of a state."""


def named(case: dict[str, Any]) -> str:
    return f"{case['model']}: {case['name']}"


def test_defaults_are_those_of_the_file() -> None:
    for name, kind in MODELS.items():
        model = kind()
        for parameter, value in CASES["defaults"][name].items():
            if parameter != "step":
                assert getattr(model, parameter) == value, (name, parameter)


@pytest.mark.parametrize("case", CASES["states"], ids=named)
def test_decisions_are_those_of_the_file(case: dict[str, Any]) -> None:
    given = {"margin": 0.0} if case["model"] == "orca" else {}
    model = MODELS[case["model"]](cutoff=case["cutoff"], **given, **case["params"])
    state = dict(case["state"])
    groups = state.pop("group", None)
    found = nav.crowd.decide(
        model,
        position=state["position"],
        velocity=state["velocity"],
        goal=state.get("goal", state["position"]),
        radius=state["radius"],
        desired_speed=state["desired_speed"],
        awareness=state.get("awareness"),
        robot=state.get("robot"),
        heading=state.get("heading"),
        group=None if groups is None else [None if each < 0 else each for each in groups],
        walls=state.get("walls", ()),
        step=CASES["defaults"]["orca"]["step"],
        period=state.get("period", (0.0, 0.0)),
    )
    expected = np.array([(np.nan, np.nan) if each is None else each for each in case["result"]])
    scale = max(np.nanmax(np.abs(expected)), 1e-3)
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=RELATIVE * scale)
