"""The Python face of tracking: arguments, records, summaries, threads, interruption."""

from __future__ import annotations

import dataclasses
import math
import pickle
import signal
import threading
import time
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import plotting, scenarios
from hrsafety.errors import InvalidParameterError, ShapeError

STILL = nav.tracking.LineReference(start=(0.0, 0.0))
LINE = nav.tracking.LineReference(start=(0.0, 0.0), velocity=(0.4, 0.2))
STARTS = np.random.default_rng(1).uniform((-1, -1, -math.pi), (1, 1, math.pi), (40, 3))
PATIENCE = 0.5  # s: 0.2 s is what is promised, the rest for a loaded machine


def test_record_begins_at_the_start_and_holds_every_step() -> None:
    run = nav.tracking.track(LINE, position=(0.3, -0.2), heading=1.0, speed=0.1, turn_rate=-0.5, duration=6.0)
    assert run.time.shape == (601,)
    assert run.time[-1] == pytest.approx(6.0)
    assert run.position[0].tolist() == [0.3, -0.2]
    assert (run.heading[0], run.speed[0], run.turn_rate[0]) == (1.0, 0.1, -0.5)
    assert run.reference_position[-1] == pytest.approx([2.4, 1.2])
    assert run.reference_velocity[-1].tolist() == [0.4, 0.2]
    assert run.error[0] == pytest.approx(math.hypot(0.3, 0.2))
    assert run.tracking == nav.tracking.FullSpeedTracking()
    assert run.reference is LINE
    # The command is held over the six steps of a period.
    held = run.commanded_turn_rate[:600].reshape(100, 6)
    assert (held == held[:, :1]).all()


def test_a_run_after_a_reference_is_a_trajectory_without_a_scene() -> None:
    run = nav.tracking.track(LINE, position=(0.0, 0.3), heading=0.4, duration=3.0)
    assert isinstance(run, nav.Trajectory)
    moved = np.diff(run.position, axis=0) / np.diff(run.time)[:, None]
    np.testing.assert_allclose(np.hypot(*run.velocity.T), np.abs(run.speed), rtol=1e-15)
    np.testing.assert_allclose(run.velocity[1:], moved, atol=0.02)
    assert run.path_length == pytest.approx(np.hypot(*np.diff(run.position, axis=0).T).sum(), rel=1e-3)
    table = run.columns()
    assert list(table)[:6] == ["t_s", "x_m", "y_m", "vx_m_per_s", "vy_m_per_s", "heading_rad"]
    assert list(table)[-3:] == ["commanded_turn_rate_rad_per_s", "goal_phase", "error_m"]
    assert not any(name.startswith(("force", "stabilizing", "current", "lyapunov")) for name in table)
    for name in ("scenario", "law", "force", "wheel_current", "outcome", "arrival_time", "energy", "lyapunov"):
        assert getattr(run, name) is None, name
    assert (run.warnings, run.contacts_moving, run.sensing.robot) == ((), 0, "exact")
    driven = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField(), built=nav.robots.AsBuilt())
    assert driven.error is not None
    assert "error_m" not in driven.columns()
    assert nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField()).error is None


def test_pictures_of_scenes_refuse_a_run_after_a_reference_and_the_other_way_round() -> None:
    run = nav.tracking.track(LINE, duration=0.6)
    for draw in (plotting.paths, plotting.energy, plotting.time_sequence, plotting.distances):
        with pytest.raises(InvalidParameterError, match=r"got a run after a reference; .*tracking_paths"):
            draw(run)
    with pytest.raises(InvalidParameterError, match=r"Trajectory of `tracking\.track`.* got the run of a scenario"):
        plotting.robots.tracking_paths([nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())])


def test_positions_are_those_of_exact_arcs() -> None:
    run = nav.tracking.track(LINE, position=(0.3, -0.2), heading=1.0, duration=3.0)
    middle = run.heading[:-1] + 0.5 * np.diff(run.heading)
    half = 0.5 * run.turn_rate[1:] * 0.01
    chord = run.speed[1:] * 0.01 * np.sinc(half / math.pi)
    steps = chord[:, np.newaxis] * np.stack([np.cos(middle), np.sin(middle)], axis=1)
    assert np.diff(run.position, axis=0) == pytest.approx(steps, abs=1e-15)
    assert np.diff(run.heading) == pytest.approx(run.turn_rate[1:] * 0.01, abs=1e-15)


def test_summary_is_that_of_the_single_runs() -> None:
    levels = (0.2, 0.02)
    table = nav.tracking.track_batch(LINE, nav.tracking.NonlinearTracking(), starts=STARTS, levels=levels, duration=9.0)
    assert len(table) == len(STARTS)
    for row in (0, 17, 39):
        run = nav.tracking.track(
            LINE, nav.tracking.NonlinearTracking(), position=STARTS[row, :2], heading=STARTS[row, 2], duration=9.0
        )
        assert table.final_error[row] == run.error[-1]
        assert table.max_error[row] == run.error.max()
        assert table.final_heading[row] == run.heading[-1]
        assert table.path_length[row] == pytest.approx(0.01 * np.abs(run.speed[1:]).sum())
        for level, settled in zip(levels, table.settling_time[row], strict=True):
            outside = np.flatnonzero(run.error >= level)
            if len(outside) == 0:
                assert settled == 0.0
            elif outside[-1] == len(run.error) - 1:
                assert math.isnan(settled)
            else:
                assert settled == pytest.approx(run.time[outside[-1] + 1])


def test_each_start_may_have_its_own_reference() -> None:
    circle = nav.tracking.CircleReference(center=(0.0, 0.0), radius=1.0, speed=-0.3)
    both = nav.tracking.track_batch([LINE, circle], starts=STARTS[:2], duration=6.0)
    for row, reference in enumerate((LINE, circle)):
        alone = nav.tracking.track_batch(reference, starts=STARTS[row : row + 1], duration=6.0)
        assert both.final_error[row] == alone.final_error[0]


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_threads_change_no_bit(threads: int) -> None:
    one, many = (
        nav.tracking.track_batch(LINE, starts=STARTS, duration=6.0, threads=count) for count in (None, threads)
    )
    for name in ("final_error", "max_error", "final_heading", "path_length", "settling_time"):
        assert getattr(one, name).tobytes() == getattr(many, name).tobytes()


def test_moving_starts_have_five_columns() -> None:
    moving = np.hstack([STARTS, np.full((40, 1), 0.3), np.full((40, 1), -1.0)])
    table = nav.tracking.track_batch(LINE, starts=moving, duration=3.0)
    run = nav.tracking.track(
        LINE, position=STARTS[3, :2], heading=STARTS[3, 2], speed=0.3, turn_rate=-1.0, duration=3.0
    )
    assert table.final_error[3] == run.error[-1]


def test_references_move_as_they_say() -> None:
    time = np.linspace(0.0, 4.0, 41)
    circle = nav.tracking.CircleReference(center=(1.0, -1.0), radius=0.5, speed=0.25, start_angle=0.3).at(time)
    angle = 0.3 + 0.5 * time
    assert circle.position == pytest.approx(np.stack([1 + 0.5 * np.cos(angle), -1 + 0.5 * np.sin(angle)], axis=1))
    assert np.gradient(circle.position, time, axis=0)[1:-1] == pytest.approx(circle.velocity[1:-1], abs=2e-4)
    assert np.gradient(circle.velocity, time, axis=0)[1:-1] == pytest.approx(circle.acceleration[1:-1], abs=2e-4)
    sampled = nav.tracking.PathReference(
        time=time[::8], position=circle.position[::8], velocity=circle.velocity[::8]
    ).at(time)
    # Hermite's cubic: h^4/384 of the fourth derivative, 0.8^4/384 * 0.5 * 0.5^4 m.
    assert np.abs(sampled.position - circle.position).max() < 4e-5


def test_path_of_a_reference_is_its_own() -> None:
    time, position, velocity = np.array([0.0, 1.0]), np.zeros((2, 2)), np.zeros((2, 2))
    path = nav.tracking.PathReference(time=time, position=position, velocity=velocity)
    position[:] = 5.0
    assert path.position.max() == 0.0
    with pytest.raises(ValueError, match="read-only"):
        path.position[0] = 1.0


@pytest.mark.parametrize(
    "value",
    [
        nav.tracking.FullSpeedTracking(position_gain=1.0),
        nav.tracking.NonlinearTracking(error_frame="world", reference_turn="printed"),
        nav.tracking.ExponentialTracking(goal_heading=1.0, capture_radius=math.inf),
        nav.tracking.VirtualTorque(damping_ratio=0.0, backward=True),
        nav.tracking.CircleReference(center=(1.0, 2.0), radius=0.4, speed=0.1),
        LINE,
    ],
    ids=lambda value: type(value).__name__,
)
def test_parameters_pickle_compare_and_print(value: Any) -> None:
    again = pickle.loads(pickle.dumps(value))
    assert again == value
    assert hash(again) == hash(value)
    assert type(value).__name__ in repr(value)
    with pytest.raises(AttributeError):
        setattr(value, dataclasses.fields(value)[0].name, None)


def test_sampled_path_pickles() -> None:
    path = nav.tracking.PathReference(time=[0.0, 1.0], position=[[0, 0], [1, 0]], velocity=[[0, 0], [0, 0]])
    again = pickle.loads(pickle.dumps(path))
    assert again.at([0.4]).position.tolist() == path.at([0.4]).position.tolist()


BAD_PARAMETERS: list[tuple[type, dict[str, Any], str]] = [
    (nav.tracking.FullSpeedTracking, {"position_gain": 0.0}, "position_gain"),
    (nav.tracking.FullSpeedTracking, {"heading_gain": math.nan}, "heading_gain"),
    (nav.tracking.FullSpeedTracking, {"heading_gain": "6"}, "heading_gain"),
    (nav.tracking.NonlinearTracking, {"damping_ratio": -1.0}, "damping_ratio"),
    (nav.tracking.NonlinearTracking, {"gain": math.inf}, "gain"),
    (nav.tracking.NonlinearTracking, {"error_frame": "camera"}, "error_frame"),
    (nav.tracking.NonlinearTracking, {"reference_turn": 3}, "reference_turn"),
    (nav.tracking.ExponentialTracking, {"distance_gain": 0.0}, "distance_gain"),
    (nav.tracking.ExponentialTracking, {"bearing_gain": -4.0}, "bearing_gain"),
    (nav.tracking.ExponentialTracking, {"orientation_gain": -1.0}, "orientation_gain"),
    (nav.tracking.ExponentialTracking, {"goal_heading": math.nan}, "goal_heading"),
    (nav.tracking.ExponentialTracking, {"capture_radius": -math.inf}, "capture_radius"),
    (nav.tracking.ExponentialTracking, {"capture_radius": math.nan}, "capture_radius"),
    (nav.tracking.ExponentialTracking, {"rest_radius": 0.0}, "rest_radius"),
    (nav.tracking.VirtualTorque, {"torque_gain": 0.0}, "torque_gain"),
    (nav.tracking.VirtualTorque, {"damping_ratio": -0.1}, "damping_ratio"),
    (nav.tracking.VirtualTorque, {"backward": 1}, "backward"),
    (nav.tracking.LineReference, {"start": (math.nan, 0.0)}, "start"),
    (nav.tracking.CircleReference, {"center": (0.0, 0.0), "radius": 0.0, "speed": 1.0}, "radius"),
    (nav.tracking.CircleReference, {"center": (0.0, 0.0), "radius": 1.0, "speed": math.inf}, "speed"),
    (nav.tracking.PathReference, {"time": [], "position": np.empty((0, 2)), "velocity": np.empty((0, 2))}, "time"),
    (nav.tracking.PathReference, {"time": [1, 1], "position": np.zeros((2, 2)), "velocity": np.zeros((2, 2))}, "time"),
]


@pytest.mark.parametrize(("kind", "values", "name"), BAD_PARAMETERS)
def test_bad_parameter_is_named(kind: type, values: dict[str, Any], name: str) -> None:
    with pytest.raises(InvalidParameterError, match=name):
        kind(**values)


BAD_RUNS: list[tuple[dict[str, Any], str]] = [
    ({"heading": math.nan}, "heading"),
    ({"position": (math.inf, 0.0)}, "position"),
    ({"speed": math.nan}, "speed"),
    ({"turn_rate": "fast"}, "turn_rate"),
    ({"control_period": 0.0}, "control_period"),
    ({"step": 0.007}, "step"),
    ({"step": math.nan}, "step"),
    ({"duration": 0.1}, "duration"),
    ({"duration": math.inf}, "duration"),
    ({"duration": 1e8}, "duration"),
    ({"goal": (math.nan, 0.0)}, "goal"),
    ({"robot": nav.HolonomicRobot()}, "robot"),
    ({"robot": 0}, "robot"),
    ({"tracking": "full speed"}, "tracking"),
    ({"tracking": nav.tracking.ExponentialTracking()}, "goal"),
]


@pytest.mark.parametrize(("changes", "name"), BAD_RUNS)
def test_bad_run_is_refused_by_name(changes: dict[str, Any], name: str) -> None:
    with pytest.raises(InvalidParameterError, match=name):
        nav.tracking.track(LINE, **changes)


def test_shapes_are_checked() -> None:
    with pytest.raises(ShapeError):
        nav.tracking.track(LINE, position=(1.0, 2.0, 3.0))
    with pytest.raises(ShapeError):
        nav.tracking.track_batch(LINE, starts=np.zeros((3, 4)))
    with pytest.raises(ShapeError):
        nav.tracking.track_batch(LINE, starts=STARTS, levels=[[0.1]])
    with pytest.raises(ShapeError):
        nav.tracking.PathReference(time=[0.0, 1.0], position=np.zeros((3, 2)), velocity=np.zeros((2, 2)))
    with pytest.raises(InvalidParameterError, match="starts"):
        nav.tracking.track_batch(LINE, starts=np.empty((0, 3)))
    with pytest.raises(InvalidParameterError, match=r"starts\[1\]"):
        nav.tracking.track_batch(LINE, starts=[[0, 0, 0], [0, math.nan, 0]])
    with pytest.raises(InvalidParameterError, match="reference"):
        nav.tracking.track_batch([LINE, STILL], starts=STARTS)
    with pytest.raises(InvalidParameterError, match="reference"):
        nav.tracking.track_batch([LINE, "path"], starts=STARTS[:2])  # type: ignore[list-item]  # the point of the test
    with pytest.raises(InvalidParameterError, match=r"levels\[0\]"):
        nav.tracking.track_batch(LINE, starts=STARTS, levels=[0.0])
    with pytest.raises(InvalidParameterError, match="threads"):
        nav.tracking.track_batch(LINE, starts=STARTS, threads=0)


def test_progress_reaches_the_number_of_runs() -> None:
    seen: list[tuple[int, int]] = []
    nav.tracking.track_batch(LINE, starts=STARTS, duration=3.0, progress=lambda done, total: seen.append((done, total)))
    assert seen[-1] == (40, 40)


@pytest.fixture
def listening() -> Iterator[None]:
    """Answer Ctrl-C, also if whoever started the tests ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.usefixtures("listening")
def test_interrupt_ends_a_batch_soon() -> None:
    starts = np.tile(STARTS, (500, 1))
    sent: list[float] = []

    def interrupt() -> None:
        sent.append(time.monotonic())
        signal.raise_signal(signal.SIGINT)

    timer = threading.Timer(0.3, interrupt)
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        nav.tracking.track_batch(LINE, starts=starts, duration=600.0)
    assert time.monotonic() - sent[0] < PATIENCE


def test_virtual_torque_of_the_source() -> None:
    torque = nav.tracking.VirtualTorque(torque_gain=2.0)
    assert torque.torque((1.0, 1.0), heading=0.0) == pytest.approx(2.0 * math.pi / 4)
    # The angle is wrapped: from 3 rad to -3 rad it is 2 pi - 6 to the left.
    behind = (math.cos(-3.0), math.sin(-3.0))
    assert torque.torque(behind, heading=3.0) == pytest.approx(2.0 * (math.tau - 6.0))
    assert torque.torque((0.0, 0.0), heading=1.0) == 0.0
    robot = nav.DifferentialDriveRobot()
    assert nav.tracking.VirtualTorque.tuned(robot).torque_gain == pytest.approx(
        nav.tracking.VirtualTorque().torque_gain, rel=1e-12
    )
    assert nav.tracking.VirtualTorque.tuned(robot, frequency=3.0).torque_gain == pytest.approx(0.666)
    with pytest.raises(InvalidParameterError, match="force"):
        torque.torque((math.nan, 0.0), heading=0.0)
    with pytest.raises(InvalidParameterError, match="control_period"):
        torque.command((1.0, 0.0), heading=0.0, control_period=0.0)
    with pytest.raises(InvalidParameterError, match="heading"):
        torque.command((1.0, 0.0), heading=math.inf)


def test_virtual_torque_reaches_a_goal_that_attracts() -> None:
    # The attraction of Borenstein and Koren, of constant strength, from 64 poses around the goal.
    torque, robot = nav.tracking.VirtualTorque(), nav.DifferentialDriveRobot()
    for direction in np.linspace(0.0, math.tau, 8, endpoint=False):
        for heading in np.linspace(0.1, 0.1 + math.tau, 8, endpoint=False):
            place, phi, twist = (
                2.0 * np.array([math.cos(direction), math.sin(direction)]),
                heading,
                nav.tracking.Twist(0.0, 0.0),
            )
            closest = 2.0
            for _ in range(400):
                force = -2.0 * place / np.hypot(*place)
                twist = torque.command(force, heading=phi, speed=twist.speed, turn_rate=twist.turn_rate, robot=robot)
                place = place + 0.06 * twist.speed * np.array([math.cos(phi), math.sin(phi)])
                phi += 0.06 * twist.turn_rate
                closest = min(closest, float(np.hypot(*place)))
            assert closest < 0.12
