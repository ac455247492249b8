"""Social metrics of the episodes of `crowd_cases.json`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import pytest

from hrsafety import navigation as nav

CASES = json.loads((Path(__file__).parent / "crowd_cases.json").read_text(encoding="utf-8"))["episodes"]
NAMES = {
    "dt": "step",
    "group": "groups",
    "without": "people_without",
    "person_goal": "person_goals",
    "tolerance": "arrival_tolerance",
}
FORCES = ("force_on_people", "force_on_robot", "social_work")


def array(value: object) -> npt.NDArray[np.float64]:
    return np.array(value, dtype=object).astype(np.float64)


def episode(case: dict[str, Any]) -> nav.metrics.Episode:
    options = {NAMES.get(name, name): value for name, value in case["options"].items()}
    for name in ("people_without", "person_goals", "person_radius"):
        if name in options:
            options[name] = array(options[name])
    return nav.metrics.Episode(position=array(case["robot"]), people=array(case["people"]), **options)


@pytest.mark.parametrize("case", CASES, ids=lambda case: case["name"])
def test_metrics_equal_the_golden_episodes(case: dict[str, Any]) -> None:
    found = nav.metrics.evaluate(episode(case)).to_dict()
    assert set(found) == set(case["result"]) == set(nav.metrics.METRICS)
    for name, value in found.items():
        expected = case["result"][name]
        if nav.metrics.METRICS[name].kind == "number":
            tolerance = 1e-8 if name in FORCES else 1e-9
            np.testing.assert_allclose(value, float(expected), rtol=tolerance, atol=tolerance, err_msg=name)
        else:
            assert value == expected, name
            assert type(value) is type(expected), name


def test_many_episodes_equal_single_ones_for_any_number_of_threads() -> None:
    episodes = [episode(case) for case in CASES]
    tables = [nav.metrics.evaluate_many(episodes, threads=threads) for threads in (1, 2, 7)]
    assert tables[0] == tables[1] == tables[2]
    assert len(tables[0]) == 12
    for index, each in enumerate(episodes):
        assert tables[0][index] == nav.metrics.evaluate(each)
    assert tables[0][3] != tables[0][4]
