"""Sonar, virtual impedance and follower as a user calls them."""

from __future__ import annotations

import itertools
import math
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.interrupting import check_work_is_interrupted, needs_signals
from hrsafety import reactive
from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError

KINDS = ("static", "one_dynamic", "two_dynamic")
LAWS = ("conventional", "active")
LAYOUTS = 1000
# Collision rates of the specification: contacts and layouts.
SPECIFIED = {
    ("static", "conventional"): (480, 4000),
    ("static", "active"): (0, 2500),
    ("one_dynamic", "conventional"): (3498, 6000),
    ("one_dynamic", "active"): (1435, 5000),
    ("two_dynamic", "conventional"): (9912, 12000),
    ("two_dynamic", "active"): (2005, 5000),
}
SPECIFIED_REAR = {"one_dynamic": 227, "two_dynamic": 254}


@pytest.fixture(scope="module", params=[2 * LAYOUTS, pytest.param(None, marks=pytest.mark.evidence)])
def runs(request: pytest.FixtureRequest) -> dict[tuple[str, str], reactive.FollowerExperiment]:
    """Return runs in some layouts, or in as many as the specification, the same number with both laws."""
    most = {kind: request.param or max(SPECIFIED[kind, law][1] for law in LAWS) for kind in KINDS}
    return {
        (kind, law): reactive.experiment(kind, law, layouts=most[kind])  # type: ignore[arg-type]  # words of the call
        for kind in KINDS
        for law in LAWS
    }


def overlap(one: Any, count: int, runs: int = LAYOUTS) -> bool:
    """Return whether the 95 % intervals of both samples overlap."""
    from hrsafety._statistics import wilson

    other = wilson(count, runs)
    return bool(one.low <= other.high and one.high >= other.low)


# ---- rates ----------------------------------------------------------------------------------


@pytest.mark.parametrize(("place", "specified"), SPECIFIED.items())
def test_collision_rates_are_those_of_the_specification(
    runs: dict[tuple[str, str], reactive.FollowerExperiment], place: tuple[str, str], specified: tuple[int, int]
) -> None:
    assert overlap(runs[place].collision_rate, *specified), runs[place].collision_rate


def test_no_speed_is_kept_from_before_a_gap() -> None:
    """By default, as a stale speed has no ground; it makes the conventional law touch standing boxes."""
    assert not reactive.VirtualImpedance().outlives_gaps
    kept = reactive.VirtualImpedance(form="conventional", speed_limit=0.6, outlives_gaps=True)
    stale = reactive.experiment("static", kept, layouts=LAYOUTS)
    pair = reactive.follower.compare_experiments(stale, reactive.experiment("static", "conventional", layouts=LAYOUTS))
    assert pair.difference.low > 0.05
    assert overlap(stale.collision_rate, 200)


@pytest.mark.parametrize("kind", KINDS)
def test_active_law_collides_less_in_the_same_layouts(
    runs: dict[tuple[str, str], reactive.FollowerExperiment], kind: str
) -> None:
    pair = reactive.follower.compare_experiments(runs[kind, "conventional"], runs[kind, "active"])
    assert pair.difference.low > 0.1
    assert pair.collisions.p_value < 1e-6
    first, second = pair.first.collision_rate.value, pair.second.collision_rate.value
    assert math.isclose(pair.difference.value, first - second, abs_tol=1e-12)


@pytest.mark.parametrize(("kind", "count"), SPECIFIED_REAR.items())
def test_rear_sensors_help_the_active_law(
    runs: dict[tuple[str, str], reactive.FollowerExperiment], kind: str, count: int
) -> None:
    robot = reactive.Follower(sonar=reactive.Sonar(rear=True))
    found = reactive.experiment(kind, "active", layouts=LAYOUTS, follower=robot)  # type: ignore[arg-type]  # word
    assert found.collision_rate.high < runs[kind, "active"].collision_rate.value
    assert overlap(found.collision_rate, count)


def test_touches_come_from_beside(runs: dict[tuple[str, str], reactive.FollowerExperiment]) -> None:
    found = runs["one_dynamic", "active"]
    directions = ("front", "left", "right", "rear")
    shares = [found.collision_rate_from(each) for each in directions]  # type: ignore[arg-type]  # words
    assert sum(share.count for share in shares) == found.collision_rate.count
    assert shares[0].count < 0.1 * found.collision_rate.count


@pytest.mark.parametrize(
    ("options", "kind", "count"),
    [
        ({"rotation": "printed"}, "one_dynamic", 980),
        ({"rotation": "printed"}, "two_dynamic", 1000),
        ({"world_start": (-10.0, -10.0)}, "one_dynamic", 820),
        # Its specified rate is as old as those with a speed that outlives gaps, for which it is held.
        ({"world_start": (5.0, 5.0), "outlives_gaps": True}, "one_dynamic", 510),
        ({"form": "twice_scaled", "speed_limit": 0.6}, "static", 990),
    ],
)
def test_printed_forms_collide_as_the_specification_says(options: dict[str, Any], kind: str, count: int) -> None:
    law = reactive.VirtualImpedance(**options)
    found = reactive.experiment(kind, law, layouts=LAYOUTS)  # type: ignore[arg-type]  # word
    # Printed with two digits, some as shares of the runs that were looked at: half a unit more.
    assert overlap(found.collision_rate, count) or abs(found.collision_rate.value - count / 1000) < 0.015


def test_printed_translation_makes_the_rate_depend_on_the_origin() -> None:
    found = [
        reactive.experiment("one_dynamic", reactive.VirtualImpedance(world_start=start), layouts=LAYOUTS).collision_rate
        for start in ((0.0, 0.0), (5.0, 5.0), (-10.0, -10.0))
    ]
    # The specification has .23, .51 and .82; the first of an unknown number of runs.
    assert found[0].high < found[1].low
    assert found[1].high < found[2].low
    assert found[0].low > 0.15


def test_resetting_the_virtual_velocity_is_another_robot() -> None:
    robot = reactive.Follower(velocity_rule="reset")
    for law, count in (("conventional", 370), ("active", 120)):
        found = reactive.experiment("one_dynamic", law, layouts=LAYOUTS, follower=robot)  # type: ignore[arg-type]  # word
        assert overlap(found.collision_rate, count)


# ---- runs and batches -----------------------------------------------------------------------


def test_threads_never_change_a_bit() -> None:
    one, three = (reactive.experiment("two_dynamic", layouts=60, threads=threads) for threads in (1, 3))
    for name in ("seed", "collided", "contact_bearing", "end_time", "source_distance", "min_clearance", "turning"):
        np.testing.assert_array_equal(getattr(one, name), getattr(three, name))


def test_progress_ends_at_the_number_of_layouts() -> None:
    calls: list[tuple[int, int]] = []
    reactive.experiment("static", layouts=40, progress=lambda done, total: calls.append((done, total)))
    assert calls[-1] == (40, 40)


def test_a_batch_is_its_single_runs() -> None:
    found = reactive.experiment("one_dynamic", "active", layouts=12)
    for index, seed in enumerate(found.seed):
        run = reactive.follow(found.layouts.scene(int(seed)), law=found.law, seed=int(seed))
        assert run.collided == found.collided[index]
        assert run.time[-1] == found.end_time[index]
        assert run.min_clearance == pytest.approx(found.min_clearance[index], abs=1e-12)
        assert run.source_distance == found.source_distance[index]


def test_a_run_obeys_its_own_equations() -> None:
    robot = reactive.Follower()
    run = reactive.follow(reactive.FollowerLayouts(kind="one_dynamic").scene(5), follower=robot, seed=5)
    pull = robot.attraction_stiffness * (run.target[1:] - run.position[1:])
    pull -= robot.attraction_damping * run.virtual_velocity[:-1]
    np.testing.assert_allclose(run.attraction[1:], pull, atol=1e-12)
    free = run.virtual_velocity[:-1] + robot.step / robot.mass * (run.attraction[1:] + run.repulsion[1:])
    speed = np.linalg.norm(free, axis=1, keepdims=True)
    limited = free * np.minimum(1.0, robot.wheel_speed / speed)
    np.testing.assert_allclose(run.virtual_velocity[1:], limited, atol=1e-12)
    assert np.abs(run.wheel_speed).max() <= robot.wheel_speed + 1e-12
    assert run.wheel_speed.sum(axis=1).min() >= -1e-12


def test_leader_that_is_seen_keeps_the_active_law_away() -> None:
    layouts = reactive.FollowerLayouts(kind="one_dynamic", leader_size=(0.326, 0.352))
    found = reactive.experiment(layouts, "active", layouts=200)
    assert found.following_rate.value < 0.05


def test_tracking_keeps_every_layout() -> None:
    found = reactive.experiment("tracking", "off", layouts=20)
    assert found.seed.tolist() == list(range(20))
    assert found.following_rate.count == 20


def test_scene_of_shapes_of_every_kind() -> None:
    scene = reactive.FollowerScene(
        leader=reactive.SoundLeader(start=(4.0, 0.0)),
        obstacles=[
            reactive.Cylinder(center=(2.0, 0.5), radius=0.2),
            reactive.Wall(start=(0.0, -1.0), end=(4.0, -1.0)),
            reactive.MovingObstacle(shape=reactive.Box(center=(3.0, 2.0), size=(0.4, 0.4)), velocity=(0.0, -0.2)),
        ],
        duration=5.0,
    )
    run = reactive.follow(scene)
    assert run.shift[-1, 2, 1] == pytest.approx(-0.2 * run.time[-1])
    assert run.clearance.shape == (len(run), 3)
    assert run.clearance[0, 1] == pytest.approx(1.0 - run.body_radius)


# ---- arguments ------------------------------------------------------------------------------


INSTANCES: list[Any] = [
    reactive.Box(center=(1.0, 2.0), size=(0.5, 0.25), angle=0.3),
    reactive.Cylinder(center=(1.0, 2.0), radius=0.5),
    reactive.Wall(start=(0.0, 0.0), end=(1.0, 0.0)),
    reactive.Sonar(rear=True, firing="in_turn"),
    reactive.VirtualImpedance(form="conventional", stiffness=80.0),
    reactive.Follower(standoff=1.2),
    reactive.MovingObstacle(shape=reactive.Cylinder(center=(1.0, 2.0), radius=0.5), velocity=(0.1, 0.0), stop=3.0),
    reactive.SoundLeader(start=(1.0, 0.0), end=(2.0, 0.0)),
    reactive.FollowerScene(leader=reactive.SoundLeader(start=(1.0, 0.0))),
    reactive.FollowerLayouts(kind="static"),
]


@pytest.mark.parametrize("value", INSTANCES, ids=lambda value: type(value).__name__)
def test_parameters_are_values(value: Any) -> None:
    assert pickle.loads(pickle.dumps(value)) == value  # pickled here
    assert type(value).__name__ in repr(value)
    assert "_native" not in repr(value)


BAD: list[tuple[Callable[[], object], str]] = [
    (lambda: reactive.Box(center=(0.0, 0.0), size=(0.0, 1.0)), "size"),
    (lambda: reactive.Box(center=(math.nan, 0.0), size=(1.0, 1.0)), "center"),
    (lambda: reactive.Cylinder(center=(0.0, 0.0), radius=-1.0), "radius"),
    (lambda: reactive.Wall(start=(math.inf, 0.0), end=(0.0, 0.0)), "start"),
    (lambda: reactive.Sonar(rays=0), "rays"),
    (lambda: reactive.Sonar(beam_width=4.0), "beam_width"),
    (lambda: reactive.Sonar(most_range=0.01), "most_range"),
    (lambda: reactive.Sonar(firing="never"), "firing"),  # type: ignore[arg-type]  # the failure is the test
    (lambda: reactive.Sonar(temperature=-600.0), "temperature"),
    (lambda: reactive.Sonar().readings([1.0]), "shapes"),  # type: ignore[list-item]  # the failure is the test
    (lambda: reactive.VirtualImpedance(form="other"), "form"),  # type: ignore[arg-type]  # the failure is the test
    (lambda: reactive.VirtualImpedance(reference_stiffness=40.0), "reference_stiffness"),
    (lambda: reactive.VirtualImpedance(reference_damping=10.0), "reference_damping"),
    (lambda: reactive.VirtualImpedance(safe_distance=0.0), "safe_distance"),
    (lambda: reactive.VirtualImpedance(filter_time=-1.0), "filter_time"),
    (lambda: reactive.Follower(mass=0.0), "mass"),
    (lambda: reactive.Follower(step=math.nan), "step"),
    (lambda: reactive.Follower(velocity_rule="none"), "velocity_rule"),  # type: ignore[arg-type]  # the failure
    (lambda: reactive.Follower(sonar=3), "sonar"),  # type: ignore[arg-type]  # the failure is the test
    (lambda: reactive.SoundLeader(start=(0.0, 0.0), speed=0.0), "speed"),
    (lambda: reactive.FollowerLayouts(kind="maze"), "kind"),  # type: ignore[arg-type]  # the failure is the test
    (lambda: reactive.FollowerLayouts(kind="static", obstacle_speed=(0.5, 0.1)), "obstacle_speed"),
    (lambda: reactive.experiment("static", "best"), "law"),  # type: ignore[arg-type]  # the failure is the test
    (lambda: reactive.experiment("static", layouts=0), "layouts"),
    (lambda: reactive.experiment("static", threads=0), "threads"),
    (lambda: reactive.experiment("tracking", layouts=1, touching=True), "layouts"),
    (lambda: reactive.follow(3), "scene"),  # type: ignore[arg-type]  # the failure is the test
    (lambda: reactive.sonar.cast_rays([], [(0.0, math.nan)], [0.0]), "origins"),
    (lambda: reactive.follower.fix_deviations([math.inf], [0.0]), "range"),
]


@pytest.mark.parametrize(("call", "name"), BAD, ids=[f"{index}-{name}" for index, (_, name) in enumerate(BAD)])
def test_bad_arguments_are_named(call: Callable[[], object], name: str) -> None:
    with pytest.raises(InvalidParameterError, match=name):
        call()


@pytest.mark.parametrize(
    "call",
    [
        lambda: reactive.sonar.cast_rays([], [0.0, 1.0], [0.0]),
        lambda: reactive.sonar.cast_rays([], [(0.0, 1.0)], [0.0, 1.0]),
        lambda: reactive.Sonar().readings([], (0.0, 0.0)),
        lambda: reactive.follower.collision_vector((0.0, 1.0), (0.0, 1.0, 2.0)),
        lambda: reactive.follower.fix_deviations([1.0], [0.0, 1.0]),
        lambda: reactive.VirtualImpedance().damping_force([1.0, 2.0], [1.0, 2.0, 3.0]),
    ],
)
def test_bad_shapes_are_refused(call: Callable[[], object]) -> None:
    with pytest.raises(ShapeError):
        call()


def test_experiments_in_other_layouts_are_not_compared() -> None:
    one = reactive.experiment("static", layouts=5)
    with pytest.raises(ShapeError):
        reactive.follower.compare_experiments(one, reactive.experiment("static", layouts=6))
    with pytest.raises(InvalidParameterError, match="second"):
        reactive.follower.compare_experiments(one, reactive.experiment("static", layouts=5, first_seed=100))


# ---- pictures -------------------------------------------------------------------------------


def test_pictures_and_animation(tmp_path: Path) -> None:
    plotting = pytest.importorskip("hrsafety.plotting")
    pytest.importorskip("matplotlib")
    run = reactive.follow(reactive.FollowerLayouts(kind="two_dynamic").scene(0))
    figures = [
        plotting.reactive.follower_runs({"one": run, "two": run, "three": run}, times=[1.0, 99.0]),
        plotting.reactive.follower_rates({"a": {"law": reactive.experiment("static", layouts=10).collision_rate}}),
        plotting.reactive.impedance_forces({"active": reactive.VirtualImpedance()}),
    ]
    for figure, name in zip(figures, itertools.count(), strict=False):
        figure.savefig(tmp_path / f"{name}.png")
    pytest.importorskip("PIL")
    from PIL import Image

    file = plotting.reactive.animate_follower(run, tmp_path / "run.gif", frames_per_second=2, speed=4.0)
    with Image.open(file) as movie:
        assert getattr(movie, "n_frames", 1) > 5
    for options in ({"speed": 0.0}, {"frames_per_second": 100}, {"speed": 1e-4}):
        with pytest.raises(HrsafetyError):
            plotting.reactive.animate_follower(run, tmp_path / "bad.gif", **options)
    with pytest.raises(HrsafetyError):
        plotting.reactive.follower_runs({})


# ---- Ctrl-C ---------------------------------------------------------------------------------


@needs_signals
@pytest.mark.parametrize("touching", [True, False])
def test_ctrl_c_stops_selection_and_runs(touching: bool, capsys: pytest.CaptureFixture[str]) -> None:
    # Takes minutes, so the signal always arrives while it runs.
    work = f'reactive.experiment("static", "active", layouts=2_000_000, touching={touching}, threads=1)'
    check_work_is_interrupted("from hrsafety import reactive", work, capsys)
