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
@pytest.mark.parametrize("period", PERIODS)
def test_no_strict_fault_of_a_robot_that_foresees(wheels: bool, period: float) -> None:
    found = [episode(seed, wheels=wheels, period=period, foresees=True) for seed in range(20)]
    assert [seed for seed, each in enumerate(found) if each.fault] == []
    assert sum(each.touched for each in found) > 0


@pytest.mark.parametrize("wheels", [False, True], ids=["holonomic", "two wheels"])
@pytest.mark.parametrize("period", PERIODS[1:])
def test_no_strict_fault_after_a_clock_was_set_back_beyond_the_last_update(wheels: bool, period: float) -> None:
    found = [episode(seed, wheels=wheels, period=period, set_back=(5.0, 9.0)) for seed in range(EPISODES)]
    assert [seed for seed, each in enumerate(found) if each.fault] == []
    assert sum(each.touched for each in found) > 0.2 * EPISODES


@pytest.mark.parametrize("takes_all", [False, True], ids=["keeps its plan", "takes every answer"])
@pytest.mark.parametrize("wheels", [False, True], ids=["holonomic", "two wheels"])
@pytest.mark.parametrize("period", PERIODS)
def test_no_strict_fault_after_a_clock_was_set_back_by_any_amount(wheels: bool, period: float, takes_all: bool) -> None:
    options = {"wheels": wheels, "period": period, "set_back": (0.001, 9.0), "takes_all": takes_all}
    found = [episode(seed, **options) for seed in range(EPISODES)]
    assert [seed for seed, each in enumerate(found) if each.fault] == []
    assert sum(each.touched for each in found) > 0.2 * EPISODES
    assert sum(each.way for each in found) > 0.1 * EPISODES


@pytest.mark.parametrize(
    ("period", "wheels", "seeds"),
    [
        (0.01, False, (1602,)),
        (0.1, False, (449, 480, 935, 1016, 1392, 2843, 11249)),
        (0.3, False, (995,)),
        (0.1, True, (449,)),
        (0.3, True, (995, 2406)),
    ],
)
def test_ages_that_a_clock_tells_too_short_lead_into_nobody(
    period: float, wheels: bool, seeds: tuple[int, ...]
) -> None:
    """Each of these was a fault where ages and plans were counted by the clock alone."""
    for seed in seeds:
        assert not episode(seed, wheels=wheels, period=period, set_back=(0.001, 9.0)).fault


def test_a_robot_off_its_plan_does_not_trust_a_clock_that_was_set_back() -> None:
    """It carried out an answer that did not count: its place told nothing about the time that went by."""
    assert not episode(42603, wheels=True, period=0.1, set_back=(0.001, 9.0), takes_all=True).fault
