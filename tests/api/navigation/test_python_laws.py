"""Laws written in Python: in every function that takes a law, with their errors."""

import math
import os
import signal
import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios

C1 = scenarios.configuration("c1")


def field(seen):
    """The virtual force field without the stabilizing force, for discs off the line to the goal."""
    attraction, repulsion, detour, ratio = 3.0, 20.0, 17.0, 0.25
    force = attraction * (seen.goal - seen.position - ratio * seen.velocity)
    for index in np.flatnonzero(seen.obstacle_present):
        offset = seen.position - seen.obstacle_position[index]
        relative = seen.velocity - seen.obstacle_velocity[index]
        distance = math.hypot(*offset)
        depth = seen.active_radius[index] - distance
        margin = distance - seen.critical_radius[index]
        assert margin > 0.0  # the robot never brakes in c1
        if depth <= 0.0:
            continue
        outward = offset / distance
        left = np.array([-outward[1], outward[0]])
        potential = depth**2 / margin
        rate = -(outward @ relative) * depth**2 / margin**2
        force = force + repulsion * (potential + ratio * rate) * outward
        to_goal = seen.goal - seen.obstacle_position[index]
        angle = math.atan2(offset[0] * to_goal[1] - offset[1] * to_goal[0], offset @ to_goal)
        turning = depth**2 * (angle - ratio * (left @ relative) / distance)
        force = force + detour * turning * left
    return force


class ToGoal:
    """A velocity law: 0.5 m/s toward the goal."""

    name = "to goal"

    def velocity(self, seen):
        away = seen.goal - seen.position
        return 0.5 * away / math.hypot(*away)


class Counting:
    """A law that remembers: it pushes harder with every period of a run."""

    def __init__(self):
        self.starts = []
        self.count = None

    def start(self, seen, seed):
        self.starts.append((seen.time, seen.position.tolist(), seed))
        self.count = 0

    def command(self, seen):
        self.count += 1
        return 0.5 * self.count * (seen.goal - seen.position) - 3.0 * seen.velocity


def test_a_copy_of_the_field_takes_its_path():
    native = nav.simulate(C1, nav.VirtualForceField(stabilizing="off"))
    run = nav.simulate(C1, field)
    assert run.outcome == "arrived"
    assert run.position.shape == native.position.shape
    assert np.abs(run.position - native.position).max() <= 1e-12
    assert np.abs(run.force - native.force).max() <= 1e-9
    assert run.arrival_time == pytest.approx(native.arrival_time, abs=1e-12)


def test_a_velocity_law_keeps_its_speed():
    free = replace(C1, obstacles=())
    run = nav.simulate(free, ToGoal())
    assert run.outcome == "arrived"
    cruising = (run.time > 0.2) & (run.time < 7.0)
    assert np.linalg.norm(run.velocity[cruising], axis=1) == pytest.approx(0.5, abs=1e-12)
    assert run.law.name == "to goal"


def test_planners_and_velocity_laws_share_the_force():
    scene = replace(C1, obstacles=())
    seen = nav.Run(scene).observe()
    wanted = ToGoal().velocity(seen)
    force = nav.laws.command(ToGoal(), scene, position=scene.start, velocity=(0.0, 0.0))
    assert force == pytest.approx(scene.robot.mass * wanted / scene.control_period, rel=1e-15)


def test_a_law_that_remembers_starts_afresh_in_every_run():
    law = Counting()
    first = nav.simulate(C1, law)
    again = nav.simulate(C1, law)
    assert first.position.tobytes() == again.position.tobytes()
    assert law.starts == [(0.0, [3.9, 0.6], 0)] * 2
    noisy = replace(C1, measurement=nav.Measurement(of="both"))
    law.starts.clear()
    runs = nav.simulate_many(noisy, law, seeds=[7, 9, 7], paths=True, threads=4)
    # The run without obstacles and noise, which the others are scored against, comes first.
    assert [seed for _, _, seed in law.starts] == [0, 7, 9, 7]
    assert runs.position is not None
    assert runs.position[0].tobytes() == runs.position[2].tobytes()
    assert runs.position[0].tobytes() != runs.position[1].tobytes()


@pytest.mark.parametrize("threads", [None, 1, 2])
def test_batches_and_comparisons(threads):
    scenes = [scenarios.configuration(name) for name in ("c1", "c2", "c3")]
    alone = [nav.simulate(scene, Counting()) for scene in scenes]
    table = nav.simulate_batch(scenes, Counting(), threads=threads)
    assert table.outcome.tolist() == [run.outcome for run in alone]
    assert table.path_length.tolist() == [run.path_length for run in alone]
    assert table.gains.shape == (3, 0)
    assert table.gain_names == ()
    assert "path_length_m" in table.columns()
    assert not any(name.startswith("gains") for name in table.columns())
    result = nav.compare({"c1": C1}, [field, nav.VirtualForceField(stabilizing="off")], threads=threads)
    assert result.laws == ("field", "VirtualForceField")
    assert result.outcome[:, 0].tolist() == ["arrived", "arrived"]
    assert result.arrival_time[0] == pytest.approx(result.arrival_time[1], abs=1e-12)
    assert result.performance_total[0] == pytest.approx(result.performance_total[1], abs=1e-12)


def test_evaluate_and_robots_as_built():
    native = nav.VirtualForceField(stabilizing="off")
    assert nav.evaluate(C1, field).total == pytest.approx(nav.evaluate(C1, native).total, abs=1e-12)
    built = nav.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS)
    own, other = nav.simulate(C1, field, built=built), nav.simulate(C1, native, built=built)
    assert np.abs(own.position - other.position).max() < 1e-9
    assert nav.evaluate(C1, field, built=built).trajectory.outcome == own.outcome
    many = nav.simulate_many(C1, {"own": field, "other": native}, built=built, threads=2)
    assert many.energy[0] == own.energy
    assert many.energy[1] == other.energy
    assert many.gains.shape == (2, 4)
    assert np.isnan(many.gains[0]).all()


def test_two_wheels_show_their_heading_and_point_mass():
    seen_by_law = []

    def law(seen):
        seen_by_law.append(seen)
        return 3.0 * (seen.goal - seen.position) - 4.0 * seen.velocity

    scene = replace(scenarios.configuration("n1"), robot=nav.DifferentialDriveRobot())
    run = nav.simulate(scene, law)
    sampled = np.array([seen.time for seen in seen_by_law])
    rows = np.searchsorted(run.time, sampled - 1e-9)
    assert [seen.heading for seen in seen_by_law] == run.heading[rows].tolist()
    assert seen_by_law[0].robot.max_speed < scene.robot.max_speed  # the robot must catch up


def test_without_holding_every_stage_asks():
    times = []

    def law(seen):
        times.append(seen.time)
        return field(seen)

    run = nav.simulate(C1, law, integrator="rk4", hold=False)
    native = nav.simulate(C1, nav.VirtualForceField(stabilizing="off"), integrator="rk4", hold=False)
    assert np.abs(run.position - native.position).max() <= 1e-12
    assert times[:4] == pytest.approx([0.0, 0.005, 0.005, 0.01])


def test_absent_obstacles_are_not_shown():
    path = ([1.0, 9.0], [(0.5, 3.0), (3.5, 3.0)])
    person = nav.Human.from_path(time=path[0], position=path[1])
    shown = []

    def law(seen):
        shown.append((seen.time, bool(seen.obstacle_present[0]), bool(np.isnan(seen.obstacle_position).any())))
        return 3.0 * (seen.goal - seen.position) - 4.0 * seen.velocity

    nav.simulate(replace(C1, obstacles=(person,)), law)
    assert {present == (t >= 1.0) for t, present, _ in shown} == {True}
    assert all(present != missing for _, present, missing in shown)


class BrokenError(Exception):
    """An error of the user's own."""


def failing_at(moment):
    def law(seen):
        if seen.time >= moment:
            raise BrokenError("no idea")
        return (-1.0, 0.0)

    return law


@pytest.mark.parametrize(
    "call",
    [
        lambda law: nav.simulate(C1, law),
        lambda law: nav.evaluate(C1, law),
        lambda law: nav.simulate(C1, law, built=nav.robots.AsBuilt()),
        lambda law: nav.simulate_many(C1, law, paths=True),
        lambda law: nav.simulate_batch([C1], law),
        lambda law: nav.compare(C1, {"own": law}),
        lambda law: [run.step() for run in [nav.Run(C1, law)] * 9],
    ],
)
def test_an_error_in_the_law_arrives_unchanged_with_a_note(call):
    with pytest.raises(BrokenError, match="no idea") as caught:
        call(failing_at(0.3))
    (note,) = caught.value.__notes__
    assert note.startswith("raised by law 'law' at t = 0.3 s, in the run from (3.9, 0.6) to (0, 0.6) with seed 0")
    nav.simulate(C1, nav.Masoud())  # nothing is left behind


@pytest.mark.parametrize(
    ("answer", "error", "words"),
    [
        (
            None,
            nav.InvalidParameterError,
            r"force of law 'mine' at t = 0 s must be two numbers \(x, y\) in N, got None",
        ),
        ((1.0, math.nan), nav.InvalidParameterError, "force of law 'mine' at t = 0 s must be finite, in N"),
        ((1.0, math.inf), nav.InvalidParameterError, "must be finite"),
        ((1.0, 2.0, 3.0), nav.ShapeError, r"force of law 'mine' at t = 0 s must have shape \(2,\), got \(3,\)"),
        (1.0, nav.ShapeError, r"must have shape \(2,\), got \(\)"),
        (("a", "b"), nav.InvalidParameterError, "must be two numbers"),
        ((1j, 0.0), nav.InvalidParameterError, "must be two numbers"),
    ],
)
def test_bad_answers_name_the_law_and_the_time(answer, error, words):
    with pytest.raises(error, match=words):
        nav.simulate(C1, nav.laws.PythonLaw(function=lambda _: answer, name="mine"))


def test_bad_velocities_name_their_unit():
    class Lost:
        def velocity(self, _):
            return (math.nan, 0.0)

    with pytest.raises(nav.InvalidParameterError, match="velocity of law 'Lost' at t = 0 s must be finite, in m/s"):
        nav.simulate(C1, Lost())


class Steered:
    def __init__(self, twist):
        self.answer, self.headings, self.period = twist, [], None

    def twist(self, seen):
        self.headings.append(seen.heading)
        self.period = seen.control_period
        return self.answer


WHEELED = nav.Scenario(
    start=(0.0, 0.0), goal=(30.0, 0.0), robot=nav.DifferentialDriveRobot(max_turn_rate=2.0), time_limit=6.0
)


@pytest.mark.parametrize("twist", [(0.3, 0.5), (-0.3, 0.5), (0.4, 0.0), (0.0, -1.0), (0.0, 0.0), (0.5, 30.0)])
def test_wheels_take_up_twists(twist):
    law = Steered(twist)
    run = nav.simulate(WHEELED, law)
    speed, rate = twist[0], min(twist[1], 2.0)
    turned = np.diff(np.unwrap(law.headings[20:]))
    np.testing.assert_allclose(turned, rate * law.period, atol=1e-9)
    # Positions of the last seconds, on the circle or line that follows from the twist.
    way = np.diff(run.position[-41:-1:20], axis=0)
    lasting = run.time[-21] - run.time[-41]
    chord = speed * lasting if rate == 0.0 else 2.0 * speed / rate * math.sin(0.5 * rate * lasting)
    np.testing.assert_allclose(np.hypot(*way.T), abs(chord), atol=1e-6)


def test_a_shield_takes_twists():
    ahead = Steered((0.5, 0.0))
    wall = nav.Rectangle(center=(2.0, 0.0), length=0.5, width=8.0)
    blocked = replace(WHEELED, obstacles=[wall], time_limit=10.0)
    assert nav.simulate(blocked, ahead).outcome == "collided"
    kept = nav.simulate(blocked, nav.SafeNavigation(ahead, shield=nav.Shield()))
    assert kept.outcome == "timed_out"
    assert kept.position[-1, 0] > 0.9


def test_a_law_of_twists_is_one_law_wherever_laws_are_taken():
    one = Steered((0.5, 0.1))
    assert nav.simulate_many([WHEELED], one).law_names == ("Steered",)
    table = nav.compare({"empty": WHEELED}, {"one": one, "other": Steered((0.4, 0.0))})
    assert table.outcome.shape == (2, 1)
    plotting = pytest.importorskip("hrsafety.plotting")
    pytest.importorskip("matplotlib")
    runs = {"one": nav.simulate(WHEELED, one), "kept": nav.simulate(WHEELED, nav.SafeNavigation(one))}
    assert plotting.comparison_paths(runs).axes


def test_twists_need_two_wheels():
    with pytest.raises(nav.InvalidParameterError, match="robot must have two wheels under a law that answers twists"):
        nav.simulate(C1, Steered((0.5, 0.0)))
    with pytest.raises(
        nav.InvalidParameterError, match=r"twist of law 'Steered' at t = 0 s must be finite, in m/s and"
    ):
        nav.simulate(WHEELED, Steered((math.nan, 0.0)))
    with pytest.raises(nav.InvalidParameterError, match=r"two numbers \(speed, turn rate\) in m/s and rad/s"):
        nav.simulate(WHEELED, Steered(("fast", 0.0)))


class Both:
    def command(self, _):
        return (0.0, 0.0)

    def velocity(self, _):
        return (0.0, 0.0)


def test_a_law_of_several_methods_says_which_is_asked():
    class Free(Both):
        asked = "velocity"

    assert nav.simulate(C1, Free()).outcome == "stopped"


@pytest.mark.parametrize(
    ("law", "words"),
    [
        (3, "law must be a Law, a function that takes a Situation"),
        (None, "law must be a Law, a function"),
        ("field", "law must be a Law, a function"),
        (ToGoal, "ToGoal is a class: make one of it first"),
        (nav.Masoud, "Masoud is a class: make one of it first"),
        (Both(), "not both"),
    ],
)
def test_what_is_no_law_is_refused(law, words):
    calls = [
        lambda: nav.simulate(C1, law),
        lambda: nav.evaluate(C1, law),
        lambda: nav.simulate_batch([C1], law),
    ]
    if law is not None:
        calls.append(lambda: nav.Run(C1, law))
    for call in calls:
        with pytest.raises(nav.InvalidParameterError, match=words):
            call()
    with pytest.raises(nav.InvalidParameterError, match=r"laws\['own'\] must"):
        nav.compare(C1, {"own": law})


def test_searches_and_terms_need_a_law_with_gains():
    for call in (
        lambda: nav.optimize_gains([C1], field),
        lambda: nav.gain_sensitivity([C1], field),
        lambda: nav.gains.gain_gradient([C1], nav.laws.PythonLaw(function=field)),
    ):
        with pytest.raises(nav.InvalidParameterError, match="law must be a Law with gains"):
            call()
    with pytest.raises(nav.InvalidParameterError, match="gains must be None"):
        nav.simulate_batch([C1], field, {"attractive_gain": 2.0})


def test_laws_in_threads_and_nested_runs():
    reference = nav.simulate(C1, field).position.tobytes()
    found = []
    threads = [threading.Thread(target=lambda: found.append(nav.simulate(C1, field).position)) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert [position.tobytes() for position in found] == [reference] * 4

    def looking_ahead(seen):
        nav.simulate_batch([C1], nav.VirtualForceField())  # a run of its own, on all cores
        return field(seen)

    assert nav.simulate(replace(C1, time_limit=0.6), looking_ahead).outcome == "timed_out"


def test_an_error_in_a_nested_run_is_the_one_that_arrives():
    def outer(_):
        nav.simulate(C1, failing_at(0.0))
        return (0.0, 0.0)

    with pytest.raises(BrokenError) as caught:
        nav.simulate(C1, outer)
    assert [note.split(" at ")[0] for note in caught.value.__notes__] == [
        "raised by law 'law'",
        "raised by law 'outer'",
    ]


@pytest.mark.parametrize("call", [nav.simulate, nav.simulate_many, lambda scene, law: nav.simulate_batch([scene], law)])
def test_ctrl_c_in_a_law(call):
    def slow(_):
        time.sleep(0.02)
        return (0.0, 0.0)

    def interrupt():
        time.sleep(0.3)
        os.kill(os.getpid(), signal.SIGINT)

    # A caller that was started in the background may ignore the signal.
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    thread = threading.Thread(target=interrupt)
    start = time.monotonic()
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        call(C1, slow)
    signal.signal(signal.SIGINT, before)
    assert time.monotonic() - start < 0.3 + 0.5
    thread.join()


def test_progress_of_slow_laws():
    heard = []
    nav.simulate_many(C1, field, seeds=30, progress=lambda done, total: heard.append((done, total)))
    assert heard[-1] == (30, 30)
    assert [done for done, _ in heard] == sorted({done for done, _ in heard})


def test_a_name_and_a_start_are_checked():
    with pytest.raises(nav.InvalidParameterError, match="name"):
        nav.laws.PythonLaw(function=field, name=3)

    class Odd:
        start = 3

        def command(self, _):
            return (0.0, 0.0)

    with pytest.raises(nav.InvalidParameterError, match="start must be a method"):
        nav.laws.PythonLaw(function=Odd())


def test_results_know_the_law():
    run = nav.simulate(C1, field)
    assert isinstance(run.law, nav.laws.PythonLaw)
    assert run.law.function is field
    assert run.law.gains == ()
    assert run.warnings == ()
