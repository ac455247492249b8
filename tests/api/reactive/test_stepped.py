"""Runs of follower and skirt that are stepped from outside."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

from hrsafety import errors, reactive

LAYOUTS = reactive.FollowerLayouts(kind="two_dynamic")
FOLLOWERS = {
    "sonar": reactive.Follower(),
    "arc": reactive.Follower(integration="arc", velocity_rule="reset"),
    "camera": reactive.Follower(obstacle_vision=reactive.follower.runs.Vision()),
}


def assert_same(one: object, other: object) -> None:
    assert type(one) is type(other)
    for name in type(one).__slots__:
        here, there = getattr(one, name), getattr(other, name)
        if isinstance(here, np.ndarray):
            np.testing.assert_array_equal(here, there, err_msg=name)
        else:
            assert here == there or here != here, name


@pytest.mark.parametrize("kind", FOLLOWERS)
@pytest.mark.parametrize("seed", [0, 7, 2**63])
def test_stepped_follower_has_the_bits_of_follow(kind: str, seed: int) -> None:
    scene, robot = LAYOUTS.scene(seed % 1000), FOLLOWERS[kind]
    run = reactive.FollowerSteps(scene, follower=robot, seed=seed)
    while not run.finished:
        assert len(run.record) == round(run.time / robot.step) or run.time == 0.0
        for _ in range(200):
            if not run.finished:
                run.step()
    assert_same(run.record, reactive.follow(scene, follower=robot, seed=seed))


@pytest.mark.parametrize("direction", reactive.skirt.MOTION_DIRECTIONS)
def test_stepped_skirt_has_the_bits_of_skirt_run(direction: str) -> None:
    run = reactive.SkirtSteps(direction=direction, layout=2, repeat=3, seed=5)
    while not run.finished:
        run.step()
    assert_same(run.record, reactive.skirt_run(direction=direction, layout=2, repeat=3, seed=5))


def test_own_decisions_that_copy_the_skirt_change_nothing() -> None:
    skirt = reactive.UltrasonicSkirt()
    run = reactive.SkirtSteps(skirt, direction="E", layout=1)
    seen = run.observe()
    while not run.finished:
        seen = run.step(skirt.action(seen.readings))
    whole = reactive.skirt_run(skirt, direction="E", layout=1)
    np.testing.assert_array_equal(run.record.position, whole.position)
    assert (run.record.action == whole.action).all()


def test_what_is_seen_is_what_is_recorded() -> None:
    run = reactive.FollowerSteps(LAYOUTS.scene(3), seed=3)
    seen = [run.observe()]
    while not run.finished:
        seen.append(run.step())
    record = run.record
    np.testing.assert_array_equal([each.position for each in seen], record.position)
    np.testing.assert_array_equal([each.readings for each in seen], record.readings)
    np.testing.assert_array_equal([each.heading for each in seen], record.heading)
    heard = [each.time for each in seen if each.source_range is not None]
    assert len(heard) >= 2
    assert np.allclose(np.diff(heard), 2.0)
    assert all(each.obstacle_position.shape == (0, 2) for each in seen)
    with pytest.raises(ValueError, match="read-only"):
        seen[0].position[0] = 1.0


def test_a_force_moves_the_robot_and_the_law_is_recorded() -> None:
    scene = LAYOUTS.scene(3)
    run = reactive.FollowerSteps(scene, seed=3)
    for _ in range(40):
        run.step(force=(0.0, 3.0))
    free = reactive.follow(scene, seed=3)
    assert run.record.position[-1, 1] > free.position[39, 1] + 0.05
    assert np.isfinite(run.record.attraction).all()


def test_what_cannot_be_stepped_is_said() -> None:
    run = reactive.FollowerSteps(LAYOUTS.scene(3))
    with pytest.raises(errors.InvalidParameterError, match="force"):
        run.step(force=(np.nan, 0.0))
    with pytest.raises(errors.ShapeError, match="force"):
        run.step(force=(1.0, 2.0, 3.0))
    assert run.time == 0.0
    assert len(run.record) == 0
    run.finish()
    with pytest.raises(errors.SimulationError, match="has ended"):
        run.step()
    ring = reactive.SkirtSteps()
    with pytest.raises(errors.InvalidParameterError, match='did you mean "spin"'):
        ring.step("spinn")
    assert ring.time == 0.0
    for each in (run, ring):
        for copied in (pickle.dumps, copy.copy, copy.deepcopy):
            with pytest.raises(errors.SimulationError, match="cannot be copied or pickled"):
                copied(each)
