"""A run that is stepped from outside: the bits of `simulate`, commands, and misuse."""

import copy
import pickle
import threading
from dataclasses import fields, replace

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.navigation.laws.known import LAWS as DECLARED

# Every law of the package, and some that are not the default or not of the package.
LAWS = {name: law() for name, law in DECLARED.items()} | {
    "full": nav.VirtualForceField(stabilizing="full", side_hysteresis=3.0),
    "rapidly_exploring_random_tree": nav.RapidlyExploringRandomTree(draws=60),
    "safe": nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), yielding=nav.laws.Yielding()),
    "python": lambda seen: 3.0 * (seen.goal - seen.position) - 4.0 * seen.velocity,
}
SOME = [
    "virtual_force_field",
    "masoud",
    "optimal_reciprocal_collision_avoidance",
    "virtual_impedance",
    "safe",
    "python",
]

MEASURED = {
    "exact": None,
    "noise": nav.Measurement(of="both"),
    "late": nav.Measurement(of="both", latency=0.075),
}

CAMERA = nav.sensing.Vision(drop_probability=0.1)

BUILT = {
    "ideal": nav.AsBuilt(),
    "wheels": nav.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS),
    "cameras": nav.AsBuilt(robot_vision=CAMERA, obstacle_vision=CAMERA),
}

TWO_WHEELS = {
    "ideal": nav.AsBuilt(),
    "wheels": nav.AsBuilt(wheels=nav.robots.DIFFERENTIAL_WHEELS, robot_vision=CAMERA),
    "torque": nav.AsBuilt(tracking=nav.tracking.VirtualTorque()),
}


def two_wheels(name):
    return replace(scenarios.configuration(name), robot=nav.DifferentialDriveRobot())


def assert_same_bits(one, other):
    """Every field, with NaN where the other has it."""
    assert type(one) is type(other)
    for field in fields(one):
        first, second = getattr(one, field.name), getattr(other, field.name)
        if field.name in ("scenario", "law"):
            continue
        if isinstance(first, np.ndarray):
            assert first.shape == second.shape, field.name
            assert first.tobytes() == second.tobytes(), field.name
        elif field.name == "built":
            assert first == second
        else:
            assert np.array(first).tobytes() == np.array(second).tobytes(), field.name


def stepped(run):
    while not run.finished:
        run.step()
    return run.trajectory


@pytest.mark.parametrize("measured", MEASURED)
@pytest.mark.parametrize("law", LAWS)
def test_stepping_has_the_bits_of_simulate(law, measured):
    scene = replace(scenarios.configuration("c2"), measurement=MEASURED[measured], seed=5)
    run = nav.Run(scene, LAWS[law])
    assert_same_bits(stepped(run), nav.simulate(scene, LAWS[law]))


@pytest.mark.parametrize("name", ["c1", "c3", "c4", "n3"])
@pytest.mark.parametrize("seed", [0, 1, 2**64 - 1])
def test_every_configuration_and_seed(name, seed):
    scene = replace(scenarios.configuration(name), measurement=nav.Measurement(of="both", latency=0.02))
    run = nav.Run(scene, nav.VirtualForceField(), seed=seed, step=0.005, stop_on_contact=True)
    other = nav.simulate(replace(scene, seed=seed), nav.VirtualForceField(), step=0.005, stop_on_contact=True)
    assert_same_bits(stepped(run), other)
    assert run.scenario.seed == seed
    assert run.time == other.time[-1]


@pytest.mark.parametrize("built", BUILT)
@pytest.mark.parametrize("law", SOME)
def test_robots_as_built(built, law):
    scene = replace(scenarios.configuration("c2"), seed=3)
    run = nav.Run(scene, LAWS[law], BUILT[built])
    assert_same_bits(stepped(run), nav.simulate(scene, LAWS[law], built=BUILT[built]))


@pytest.mark.parametrize("built", TWO_WHEELS)
@pytest.mark.parametrize("law", SOME)
def test_two_wheels(built, law):
    scene = two_wheels("n2")
    run = nav.Run(scene, LAWS[law], TWO_WHEELS[built])
    assert_same_bits(stepped(run), nav.simulate(scene, LAWS[law], built=TWO_WHEELS[built]))


def test_two_wheels_as_simulate_has_them():
    scene = replace(two_wheels("n4"), measurement=nav.Measurement(of="both"))
    assert_same_bits(stepped(nav.Run(scene, nav.Masoud())), nav.simulate(scene, nav.Masoud()))


def test_observation_is_measured_once_a_period():
    scene = replace(scenarios.configuration("c2"), measurement=nav.Measurement(of="both"))
    run = nav.Run(scene, nav.VirtualForceField())
    first, again = run.observe(), run.observe()
    assert first.position.tobytes() == again.position.tobytes()
    assert np.abs(first.position - scene.start).max() > 1e-4  # noise
    assert first.time == 0.0
    after = run.step()
    assert after.time == pytest.approx(0.06)
    assert after.position.tobytes() == run.observe().position.tobytes()
    with pytest.raises(ValueError, match="read-only"):
        after.position[0] = 0.0


def test_observation_shows_goal_obstacles_and_robot():
    seen = nav.Run(scenarios.configuration("c3")).observe()
    scene = scenarios.configuration("c3")
    shapes = [isinstance(each, nav.Rectangle) for each in scene.obstacles]
    assert any(shapes)
    for index, rectangle in enumerate(shapes):
        assert np.isnan(seen.obstacle_radius[index]) == rectangle
        assert np.isnan(seen.obstacle_size[index]).all() != rectangle
        assert seen.active_radius[index] == scene.obstacles[index].active_radius
    assert seen.goal.tolist() == list(scene.goal)
    assert seen.heading == scene.heading
    assert seen.robot.mass == scene.robot.mass
    assert seen.control_period == scene.control_period


def test_a_law_in_steps_equals_the_commands_it_gives():
    scene = scenarios.configuration("c1")
    reference = nav.simulate(scene, nav.Masoud())
    run = nav.Run(scene)
    while not run.finished:
        row = int(np.searchsorted(reference.time, run.time - 1e-9))
        run.step(reference.force[row])
    assert run.trajectory.position.tobytes() == reference.position.tobytes()
    assert run.trajectory.law.name == "commands"


class Late:
    """Stands, and drives after somebody who has brushed it."""

    def velocity(self, seen):
        return (0.6, 0.0) if seen.time > 3.2 else (0.0, 0.0)


@pytest.mark.parametrize("late", [3.2, 3.3, 3.4])
def test_a_fault_within_a_contact_is_found_where_obstacles_were_nearer_before(late):
    walker = nav.MovingDisc(center=(-3.0 + 3.2 - late, 0.42), velocity=(1.0, 0.0), radius=0.3)
    scene = nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=[walker], time_limit=5.0, rest_time=60.0)
    run = nav.simulate(scene, Late())
    # They never overlap by 0.1 m, from which on nobody would be at fault.
    assert 0.4 < run.min_distance[0] < 0.45
    assert (run.contacts_standing, run.contact_at_fault.tolist()) == (1, [True])
    assert_same_bits(stepped(nav.Run(scene, Late())), run)
    assert nav.simulate_batch([scene], Late()).contacts_at_fault.tolist() == [1]


def test_a_velocity_is_reached_at_the_next_sample():
    run = nav.Run(scenarios.configuration("c1"))
    seen = run.step(velocity=(-0.03, 0.01))
    assert seen.velocity == pytest.approx([-0.03, 0.01], abs=1e-15)


def test_trajectory_so_far():
    whole = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    run = nav.Run(scenarios.configuration("c1"), nav.VirtualForceField())
    assert run.trajectory.time.tolist() == [0.0]
    for _ in range(10):
        run.step()
    part = run.trajectory
    assert (part.outcome, run.outcome, run.finished) == ("running", None, False)
    assert len(part.time) == 61
    assert part.position.tobytes() == whole.position[:61].tobytes()
    assert np.isnan(part.arrival_time)


def test_interleaved_runs_and_threads_do_not_disturb_each_other():
    scenes = [replace(scenarios.configuration("c2"), measurement=nav.Measurement(of="both"), seed=k) for k in range(4)]
    expected = [nav.simulate(scene, nav.VirtualForceField()) for scene in scenes]
    runs = [nav.Run(scene, nav.VirtualForceField()) for scene in scenes]
    while not all(run.finished for run in runs):
        for run in runs:
            if not run.finished:
                run.step()
    for run, other in zip(runs, expected, strict=True):
        assert_same_bits(run.trajectory, other)
    runs = [nav.Run(scene, nav.VirtualForceField()) for scene in scenes]
    threads = [threading.Thread(target=stepped, args=(run,)) for run in runs]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for run, other in zip(runs, expected, strict=True):
        assert_same_bits(run.trajectory, other)


def test_after_the_end_a_step_is_refused():
    run = nav.Run(scenarios.configuration("c1"), nav.VirtualForceField())
    stepped(run)
    end = run.time
    with pytest.raises(nav.SimulationError, match=r"has ended \(arrived at t = 6\.6"):
        run.step()
    with pytest.raises(nav.SimulationError, match="has ended"):
        run.step((1.0, 0.0))
    assert run.time == end
    assert run.observe().time >= end


@pytest.mark.parametrize(
    ("command", "velocity", "error", "words"),
    [
        ((np.nan, 0.0), None, nav.InvalidParameterError, "command must be two finite numbers"),
        (None, (0.0, np.inf), nav.InvalidParameterError, "velocity must be two finite numbers"),
        ((1.0, 2.0, 3.0), None, nav.ShapeError, r"command must have shape \(2,\)"),
        ("left", None, nav.InvalidParameterError, "command must be a pair"),
        ((1.0, 0.0), (1.0, 0.0), nav.InvalidParameterError, "velocity must be None where a force is given"),
        (None, None, nav.InvalidParameterError, "command must be a force in a run without a law"),
    ],
)
def test_bad_commands(command, velocity, error, words):
    run = nav.Run(scenarios.configuration("c1"))
    with pytest.raises(error, match=words):
        run.step(command, velocity=velocity)
    assert run.time == 0.0
    run.step((1.0, 0.0))  # a refused command does no harm


def test_a_force_that_overflows_ends_nothing_silently():
    run = nav.Run(scenarios.configuration("c1"))
    with pytest.raises(nav.SimulationError):
        run.step((1e300, 1e300))
    assert run.time == 0.0


def test_bad_arguments():
    scene = scenarios.configuration("c1")
    with pytest.raises(nav.InvalidParameterError, match="step"):
        nav.Run(scene, step=0.025)
    with pytest.raises(nav.InvalidParameterError, match="seed"):
        nav.Run(scene, seed=-1)
    with pytest.raises(nav.InvalidParameterError, match="scenario"):
        nav.Run("c1")
    with pytest.raises(nav.InvalidParameterError, match="law"):
        nav.Run(scene, 3)
    with pytest.raises(nav.InvalidParameterError, match="built"):
        nav.Run(scene, nav.Masoud(), 3)


def test_copies_are_refused_with_a_remedy():
    run = nav.Run(scenarios.configuration("c1"), nav.Masoud())
    for duplicate in (copy.copy, copy.deepcopy, pickle.dumps):
        with pytest.raises(nav.SimulationError, match="make another"):
            duplicate(run)


def test_a_law_cannot_step_its_own_run():
    run = None

    def recursive(_):
        run.step((0.0, 0.0))

    run = nav.Run(scenarios.configuration("c1"), recursive)
    with pytest.raises(nav.SimulationError, match="under way"):
        run.step()
    run.step((1.0, 0.0))  # it is not left locked


def test_contacts_end_a_run_when_asked():
    straight = nav.Run(scenarios.configuration("c1"), stop_on_contact=True)
    while not straight.finished:
        straight.step(velocity=(-1.0, 0.0))
    assert straight.outcome == "collided"
    assert np.isfinite(straight.trajectory.contact_time).any()
