"""The example of a learned policy: as a law it does what it did in the environment, and keeps what is claimed."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import gymnasium
import numpy as np
import pytest

import hrsafety.gym  # noqa: F401  # registers the environments
from hrsafety import navigation as nav
from hrsafety import scenarios

EXAMPLE = Path(__file__).resolve().parents[3] / "examples" / "ppo" / "learned_law.py"
CASES = range(40)


@pytest.fixture(scope="module")
def learned() -> ModuleType:
    specification = importlib.util.spec_from_file_location("learned_law", EXAMPLE)
    assert specification is not None
    assert specification.loader is not None
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


def test_axes_to_the_goal_turn_back(learned: ModuleType) -> None:
    vectors = np.random.default_rng(0).normal(size=(20, 3, 2))
    axis = learned.direction(np.random.default_rng(1).normal(size=(20, 1, 2)))
    np.testing.assert_allclose(learned.turned(axis, axis), np.broadcast_to([1.0, 0.0], (20, 1, 2)), atol=1e-12)
    np.testing.assert_allclose(learned.turned_back(learned.turned(vectors, axis), axis), vectors, atol=1e-12)
    np.testing.assert_array_equal(learned.direction(np.zeros(2)), [1.0, 0.0])


@pytest.mark.parametrize("case", [0, 3, 7])
def test_the_law_drives_as_the_policy_did_in_the_environment(learned: ModuleType, case: int) -> None:
    law = learned.LearnedLaw.load(learned.WEIGHTS)
    run = nav.simulate(scenarios.circle_crossing(case, law=law, visible=False))
    env = gymnasium.make("hrsafety/CircleCrossing-v0", visible=False).unwrapped
    seen, _ = env.reset(seed=case)
    ended, places = False, []
    while not ended:
        row = seen.astype(np.float64)
        inputs = learned.inputs_of(row[None, :5], row[6:].reshape(1, learned.PEOPLE, 5))
        seen, _, *ends, _ = env.step(learned.turned_back(law.shares(inputs), learned.direction(row[:2]))[0])
        ended = any(ends)
        places.append([0.0, 4.0] - seen[:2].astype(np.float64))
    np.testing.assert_allclose(run.robot_position[1 : len(places) + 1, 0], places, atol=1e-3)


def test_it_succeeds_more_often_than_reciprocal_avoidance_and_drives_into_nobody_under_a_shield(
    learned: ModuleType,
) -> None:
    law = learned.LearnedLaw.load(learned.WEIGHTS)
    laws = nav.OptimalReciprocalCollisionAvoidance(), law, nav.SafeNavigation(law, shield=nav.Shield(person_speed=1.0))
    reciprocal, bare, shielded = (
        nav.simulate_many([scenarios.circle_crossing(case, law=each, visible=False) for case in CASES]) for each in laws
    )
    assert bare.success.low > reciprocal.success.high
    assert shielded.success.low > reciprocal.success.high
    assert (shielded.robot_on_person + shielded.mutual_contacts).sum() == 0


def test_the_example_prints_every_fault_as_the_table_of_the_guide_counts_it(
    learned: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    learned.compare(learned.WEIGHTS, cases=20)
    line = next(each for each in capsys.readouterr().out.splitlines() if each.startswith("reciprocal "))
    worlds = [scenarios.circle_crossing(case, visible=False) for case in range(20)]
    table = nav.simulate_many(worlds, nav.OptimalReciprocalCollisionAvoidance())
    counts = table.success, table.contact, nav.metrics.wilson(int((table.contacts_at_fault > 0).sum()), 20)
    assert all(str(share) in line for share in counts)
    # Contacts that the person brought about, while the robot moved toward them, too.
    assert (table.contacts_at_fault > 0).sum() > (table.robot_on_person + table.mutual_contacts > 0).sum()
