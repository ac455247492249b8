"""Twists of the laws that run on robots in the situations of `law_cases.json`."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav

CASES: dict[str, list[dict[str, Any]]] = json.loads(
    (Path(__file__).parent / "law_cases.json").read_text(encoding="utf-8")
)["laws"]
KINDS: dict[str, Any] = {
    "dwa": nav.DynamicWindow,
    "dwb": nav.DWB,
    "rpp": nav.RegulatedPurePursuit,
    "mppi": nav.PathIntegral,
}
TOLERANCE = 1e-9


@pytest.mark.parametrize("kind", KINDS)
def test_laws_choose_as_the_cases_have_it(kind: str) -> None:
    for case in CASES[kind]:
        place, expected = case["situation"], case["expected"]
        names = ("pose", "twist", "goal", "path", "people", "walls", "radius")
        # Rows of the cases are (forward, turn rate, left).
        plan = None if case.get("plan") is None else np.array(case["plan"])[:, [0, 2, 1]]
        choice = KINDS[kind](**case["parameters"]).choose(
            **{name: place[name] for name in names},
            control_period=place["period"],
            plan=plan,
            call=case.get("call", 0),
            seed=case.get("seed", 0),
        )
        wanted = (expected["v"], expected.get("vy", 0.0), expected["w"])
        assert np.allclose(choice[:3], wanted, rtol=0.0, atol=TOLERANCE)
        if expected.get("score") is not None:
            assert choice.score == pytest.approx(expected["score"], abs=TOLERANCE)
        if "mode" in expected:
            assert choice.mode == expected["mode"]
        if "blocked" in expected:
            assert (choice.mode == "blocked") == expected["blocked"]
        if "second" in expected:
            assert np.allclose(choice.plan[1, [0, 2, 1]], expected["second"], rtol=0.0, atol=TOLERANCE)


def test_a_robot_walks_as_a_person_of_the_model() -> None:
    for case in CASES["social_force"]:
        place = case["situation"]
        people = [nav.MovingDisc(center=(x, y), velocity=(vx, vy), radius=r) for x, y, vx, vy, r in place["people"]]
        # Walls as bodies have a thickness: they are in the map.
        world_map = nav.StaticMap.from_polylines(place["walls"])
        robot = nav.HolonomicRobot(mass=1.0, radius=0.25, max_speed=1.0, max_acceleration=1e3)
        scene = nav.Scenario(
            robot=robot, start=(-30.0, 0.0), goal=place["goal"], obstacles=people, control_period=0.1, time_limit=1.0
        )
        law = nav.SafeNavigation(nav.SocialForce(), map=world_map)
        velocity = np.array(place["twist"][:2])
        force = nav.laws.command(law, scene, position=place["pose"][:2], velocity=velocity)
        assert np.allclose(velocity + 0.1 * force, case["expected"]["u"], rtol=0.0, atol=TOLERANCE)
