"""No robot with a shield moves toward whom it touches, whatever it is told wrong, late or not at all."""

from __future__ import annotations

import pytest

from properties.pursued_robot import PERIODS, episode

EPISODES = 60


@pytest.mark.parametrize("wheels", [False, True], ids=["holonomic", "two wheels"])
@pytest.mark.parametrize("period", PERIODS)
def test_no_strict_fault_under_tracking_errors(wheels: bool, period: float) -> None:
    found = [episode(seed, wheels=wheels, period=period) for seed in range(EPISODES)]
    assert [seed for seed, each in enumerate(found) if each.fault] == []
    # It moves, it is touched, and what is within the assumptions refutes none of them.
    assert sum(each.way for each in found) > 0.1 * EPISODES
    assert sum(each.touched for each in found) > 0.2 * EPISODES
    assert sum(each.off_plan for each in found) == 0


@pytest.mark.parametrize("wheels", [False, True], ids=["holonomic", "two wheels"])
@pytest.mark.parametrize("period", PERIODS[1:])
def test_no_strict_fault_after_a_clock_was_set_back_beyond_the_last_update(wheels: bool, period: float) -> None:
    found = [episode(seed, wheels=wheels, period=period, set_back=(5.0, 9.0)) for seed in range(EPISODES)]
    assert [seed for seed, each in enumerate(found) if each.fault] == []
    assert sum(each.touched for each in found) > 0.2 * EPISODES
