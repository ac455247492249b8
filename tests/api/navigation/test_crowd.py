"""Worlds of people and robots that react to each other."""

from __future__ import annotations

import pickle
import threading
import time
from dataclasses import replace

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.datasets import Recording
from hrsafety.errors import InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.crowd.simulation import simulated

MODELS = (
    nav.crowd.SocialForce1995(),
    nav.crowd.SocialForce2000(),
    nav.crowd.Moussaid(),
    nav.crowd.CollisionFreeSpeed(),
    nav.crowd.ReciprocalAvoidance(),
)


def pair_of_people(model: nav.crowd.Pedestrian | None = None) -> tuple[nav.Person, ...]:
    of = nav.crowd.CollisionFreeSpeed() if model is None else model
    # Not on one line: forces along it would stop both for good.
    ends = (((0.0, 0.0), (6.0, 0.0)), ((6.0, 0.3), (0.0, 0.3)))
    return tuple(nav.Person(start=a, route=[b], model=of, desired_speed=1.2) for a, b in ends)


@pytest.mark.parametrize("model", MODELS, ids=lambda model: type(model).__name__)
def test_people_of_every_model_pass_each_other(model: nav.crowd.Pedestrian) -> None:
    run = nav.simulate(nav.World(people=pair_of_people(model), time_limit=20.0))
    assert run.diverged is None
    assert np.isfinite(run.person_arrival_time).all()
    assert run.obstacle_position.shape == (len(run.time), 2, 2)
    assert run.time[-1] < 20.0
    assert np.hypot(*(run.obstacle_position[:, 0] - run.obstacle_position[:, 1]).T).min() > 0.25


def test_a_world_without_anybody_ends_at_once_and_one_person_walks_alone() -> None:
    nobody = nav.simulate(nav.World())
    assert nobody.obstacle_position.shape == (1, 0, 2)
    assert nobody.robot_position.shape == (1, 0, 2)
    alone = nav.simulate(nav.World(people=pair_of_people()[:1]))
    assert alone.person_arrival_time[0] == pytest.approx(5.7 / 1.2, abs=0.06)


def test_a_robot_whose_goal_is_its_start_has_arrived() -> None:
    robot = nav.Robot(start=(1, 1), goal=(1, 1), law=nav.VirtualForceField())
    run = nav.simulate(nav.World(robots=[robot]))
    assert run.outcomes == ("arrived",)
    assert run.robot_arrival_time.tolist() == [0.0]


@pytest.mark.parametrize(
    "law",
    [
        nav.OptimalReciprocalCollisionAvoidance(),
        nav.VirtualForceField(),
        nav.VelocityObstacle(),
        nav.laws.SafeNavigation(nav.OptimalReciprocalCollisionAvoidance(), shield=nav.laws.Shield()),
        lambda situation: 4.0 * (situation.goal - situation.position) - 8.0 * situation.velocity,
    ],
    ids=["reciprocal", "field", "velocity obstacle", "shielded", "python"],
)
def test_robots_of_both_kinds_arrive_among_people_under_any_law(law: object) -> None:
    bodies = (nav.HolonomicRobot(), nav.DifferentialDriveRobot())
    person = nav.Person(start=(3.0, 5.0), route=[(3.0, -5.0)], desired_speed=1.2)
    for body in bodies:
        robot = nav.Robot(body, start=(0, 0), goal=(6, 0.2), law=law)  # type: ignore[arg-type]  # of two kinds
        run = nav.simulate(nav.World(people=[person], robots=[robot], time_limit=60.0))
        assert run.outcomes == ("arrived",), type(body)


def test_what_a_robot_sees_may_be_noisy_and_late() -> None:
    world = scenarios.circle_crossing(4, law=nav.OptimalReciprocalCollisionAvoidance())
    noisy = replace(world.robots[0], measurement=nav.Measurement(scale=0.1, of="both", latency=0.3))
    exact, blurred = (nav.simulate(replace(world, robots=[robot])) for robot in (world.robots[0], noisy))
    again = nav.simulate(replace(world, robots=[noisy]))
    rows = min(len(exact.time), len(blurred.time))
    assert not np.array_equal(exact.robot_position[:rows], blurred.robot_position[:rows])
    np.testing.assert_array_equal(again.robot_position, blurred.robot_position)


def test_who_is_beyond_the_sensing_range_changes_nothing() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance()
    person = nav.Person(start=(3, 0), desired_speed=0.0, awareness=0.0)
    near = nav.Robot(start=(0, 0), goal=(6, 0.1), law=law)
    blind = replace(near, sensing_range=0.1)
    deviation = [
        np.abs(nav.simulate(nav.World(people=[person], robots=[robot])).robot_position[..., 1]).max()
        for robot in (near, blind)
    ]
    assert deviation[0] > 0.3
    assert deviation[1] < 0.2


def test_threads_change_no_bit() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance()
    worlds = [scenarios.circle_crossing(case, law=law) for case in range(12)]
    worlds.append(scenarios.corridor(60, model=nav.crowd.Moussaid(), seed=3, time_limit=3.0))
    one = simulated(worlds, threads=1)
    for threads in (2, 7):
        for found, expected in zip(simulated(worlds, threads=threads), one, strict=True):
            np.testing.assert_array_equal(found.obstacle_position, expected.obstacle_position)
            np.testing.assert_array_equal(found.robot_position, expected.robot_position)


def test_a_robot_delays_people_who_leave_at_their_goal() -> None:
    doorway = nav.Robot(start=(3.0, 0.05), goal=(9.0, 0.0))
    walker = nav.Person(start=(0, 0), route=[(6, 0)], desired_speed=1.2, at_end="leave")
    # The way of the other leads past its last point: it arrives at the end of the way, not there.
    there_and_back = replace(walker, start=(0, 4), route=[(5, 4), (0, 4)])
    world = nav.World(people=[walker, there_and_back], robots=[doorway], time_limit=20.0)
    run = nav.simulate(world)
    alone = nav.simulate(replace(world, robots=()))
    assert np.isnan(run.obstacle_position[-1, 0]).all()
    np.testing.assert_array_less(np.hypot(*(run.person_arrival_position - [(6, 0), (0, 4)]).T), 0.3 + 1e-12)
    (episode,) = nav.crowd.episodes_of(run, alone)
    found = nav.metrics.evaluate(episode)
    assert found.person_delay == pytest.approx(np.mean(run.person_arrival_time - alone.person_arrival_time), abs=1e-12)
    assert found.person_delay > 0.1
    assert found.person_detour > 0.05
    assert found.people_blocked == 0
    table = nav.simulate_many([world], people_alone=True)
    assert table.person_delay[0] == found.person_delay
    total = nav.crowd.world_metrics(run).aggregated_time
    assert total == pytest.approx(run.person_arrival_time.sum(), abs=1e-9)


def test_people_from_sources_are_met_though_they_are_not_compared() -> None:
    source = nav.Source(low=(2, -0.5), high=(3, 0.5), rate=1.0, route=[(-2, 0)], awareness=0.0)
    robot = nav.Robot(start=(0, 0), goal=(9, 0))
    world = nav.World(sources=[source], robots=[robot], time_limit=8.0)
    least = [nav.simulate_many([world], people_alone=alone).min_clearance[0] for alone in (False, True)]
    assert least[0] == least[1] < 0.0


def test_progress_is_told_of_all_worlds() -> None:
    told: list[tuple[int, int]] = []
    worlds = [nav.World(people=pair_of_people(), seed=seed) for seed in range(5)]
    simulated(worlds, threads=2, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (5, 5)


def test_a_world_that_diverges_says_when_and_for_whom() -> None:
    model = nav.crowd.SocialForce2000(stiffness=1e308)
    people = [nav.Person(start=(x, 0), route=[(9, 0)], model=model) for x in (3.0, 0.0, 0.1)]
    run = nav.simulate(nav.World(people=people))
    assert run.diverged is not None
    assert run.diverged.kind == "person"
    assert run.diverged.index in {1, 2}
    assert run.time[-1] <= run.diverged.time
    assert np.isfinite(run.obstacle_position).all()


def test_seeds_draw_speeds_and_who_is_distracted() -> None:
    people = [nav.Person(start=(0, y), route=[(9, y)], distracted_share=0.4) for y in range(200)]
    run = nav.simulate(nav.World(people=people, time_limit=0.1, seed=5))
    assert ((run.desired_speed >= 0.5) & (run.desired_speed <= 2.2)).all()
    assert run.desired_speed.mean() == pytest.approx(1.34, abs=0.06)
    assert run.desired_speed.std() == pytest.approx(0.26, abs=0.05)
    assert 0.25 < (run.awareness == 0.0).mean() < 0.55
    other = nav.simulate(nav.World(people=people[:50], time_limit=0.1, seed=5))
    np.testing.assert_array_equal(other.desired_speed, run.desired_speed[:50])


def test_people_keep_together_in_groups() -> None:
    def spread(group: int | None) -> float:
        people = [
            nav.Person(start=(0, 1.2 * k), route=[(30, 0)], model=nav.crowd.Moussaid(), group=group, desired_speed=1.2)
            for k in range(3)
        ]
        run = nav.simulate(nav.World(people=people, time_limit=8.0))
        return float(run.obstacle_position[-1].std(axis=0).sum())

    assert spread(1) < spread(None)


def test_worlds_of_all_scenarios_run() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance()
    worlds = [
        scenarios.antipodal(6, law=law, robots=2),
        scenarios.corridor(20, seed=1, time_limit=5.0),
        scenarios.crossing(8, time_limit=5.0),
        scenarios.cross_torus(20, time_limit=5.0),
        scenarios.bottleneck(20, time_limit=30.0),
        scenarios.circle_crossing(0, law=law, visible=False),
    ]
    for run in simulated(worlds):
        assert run.diverged is None
        assert len(run.time) > 10
    assert np.isnan(nav.simulate(worlds[4]).obstacle_position[-1]).all(), "everybody has left the room"


def test_the_same_arguments_draw_the_same_world() -> None:
    assert scenarios.corridor(10, seed=4) == scenarios.corridor(10, seed=4)
    assert scenarios.corridor(10, seed=4) != scenarios.corridor(10, seed=5)
    world = scenarios.circle_crossing(11, law=nav.VirtualForceField())
    assert pickle.loads(pickle.dumps(world)) == world


def test_recorded_people_react_by_a_share() -> None:
    walk = Recording(time_s=[0, 0, 4, 4], person=[1, 2, 1, 2], position=[[0, 0], [5, 0.1], [5, 0], [0, 0.1]])
    runs = [nav.simulate(scenarios.with_recording(walk, share, time_limit=8.0)) for share in (0.0, 0.5, 1.0)]
    least = [np.nanmin(np.hypot(*(run.obstacle_position[:, 0] - run.obstacle_position[:, 1]).T)) for run in runs]
    assert least[0] < 0.15, "recorded people walk through each other"
    assert least[1] > 0.3
    assert least[2] > 0.3


def test_who_is_recorded_at_one_instant_only_does_not_react() -> None:
    places = [[0, 0], [0.5, 0], [5, 5], [1, 0]]
    walk = Recording(time_s=[0.0, 0.4, 0.4, 0.8], person=[1, 1, 3, 1], position=places)
    world = scenarios.with_recording(walk, 1.0, time_limit=2.0)
    assert [person.recording is None for person in world.people] == [True, False]
    nav.simulate(world)


def test_mistakes_are_named_with_their_place() -> None:
    def words(make: object) -> str:
        with pytest.raises(InvalidParameterError) as caught:
            make()  # type: ignore[operator]  # entries of the table are callables
        return str(caught.value)

    person = nav.Person(start=(0, 0), route=[(5, 0)])
    robot = nav.Robot(start=(0.1, 0), goal=(5, 0))
    world = nav.World
    assert "robots[0].start must not be in contact with people[0]" in words(
        lambda: world(people=[person], robots=[robot])
    )
    assert "robots[0].control_period must be a multiple" in words(
        lambda: world(robots=[replace(robot, control_period=0.06)])
    )
    assert words(lambda: world(people=[person, 3])).startswith("people[1] must be a Person")
    assert words(lambda: world(period=(-1.0, 0.0))).startswith("period[0] must")
    assert words(lambda: world(step=0.0)).startswith("step must")
    assert words(lambda: world(walls=[[(0, 0)]])).startswith("walls[0].points must be two points or more")
    assert words(lambda: replace(person, awareness=1.5)).startswith("awareness must be from 0 to 1")
    assert words(lambda: replace(person, radius=0.0)).startswith("radius must")
    assert words(lambda: replace(person, route=[], at_end="repeat")).startswith("route must hold a point")
    assert "did you mean" in words(lambda: replace(person, at_end="leaves"))
    assert words(lambda: replace(person, desired_speed=float("nan"))).startswith("desired_speed must")
    assert words(lambda: nav.crowd.SocialForce2000(mass=0.0)).startswith("mass must")
    assert words(lambda: nav.crowd.Moussaid(cutoff=-1.0)).startswith("cutoff must")
    assert words(lambda: replace(robot, sensing_range=0.0)).startswith("sensing_range must")
    assert words(lambda: world(people=[person], time_limit=1e9)).startswith("time_limit must")
    with pytest.raises(ShapeError):
        nav.crowd.decide(nav.crowd.Moussaid(), position=[(0, 0)], velocity=[(0, 0), (1, 1)], goal=[(0, 0)])
    assert words(
        lambda: nav.crowd.decide(nav.crowd.Moussaid(), position=[(0, np.nan)], velocity=[(0, 0)], goal=[(0, 0)])
    ).startswith("position[0] must be finite")

    def decided(**changes: object) -> str:
        given = {"position": np.zeros((2, 2)), "velocity": np.zeros((2, 2)), "goal": np.ones((2, 2))}
        return words(lambda: nav.crowd.decide(nav.crowd.Moussaid(), **(given | changes)))  # type: ignore[arg-type]  # options by name

    assert decided(radius=[0.2, -0.2]).startswith("radius[1] must be positive")
    assert decided(desired_speed=-1.0).startswith("desired_speed[0] must not be negative")
    assert decided(awareness=[0.0, 1.1]).startswith("awareness[1] must be from 0 to 1")
    assert decided(radius=np.nan).startswith("radius[0] must be finite")
    assert decided(desired_speed=np.inf).startswith("desired_speed[0] must be finite")
    assert decided(step=0.0).startswith("step must")
    assert decided(period=(float("inf"), 0.0)).startswith("period[0] must")
    assert words(lambda: world(period=(0.0, float("inf")))).startswith("period[1] must")


def test_the_interpreter_is_released() -> None:
    worlds = [scenarios.corridor(300, model=nav.crowd.Moussaid(), seed=seed, time_limit=3.0) for seed in range(2)]
    done = threading.Event()

    def run() -> None:
        simulated(worlds, threads=1)
        done.set()

    worker = threading.Thread(target=run)
    worker.start()
    longest, last = 0.0, time.perf_counter()
    while not done.wait(0.005):
        now = time.perf_counter()
        longest, last = max(longest, now - last), now
    worker.join()
    assert longest < 1.0


def test_what_would_not_fit_into_memory_is_refused_before_any_is_taken() -> None:
    person = nav.Person(start=(0.0, 0.0), route=[(1.0, 0.0)])
    long = nav.World(people=[person], time_limit=4.9e5)
    with pytest.raises(InvalidParameterError, match=r"worlds must hold at most .* agents times steps together"):
        simulated([long] * 11)
    law = nav.OptimalReciprocalCollisionAvoidance()
    ends = [((3.0 * k, 0.0), (3.0 * k, 9.0)) for k in range(3200)]
    robots = [nav.Robot(start=start, goal=goal, law=law) for start, goal in ends]
    with pytest.raises(InvalidParameterError, match="robots must see at most 10000000 people and robots together"):
        nav.simulate(nav.World(robots=robots))


@pytest.mark.parametrize("kind", ["Moussaid", "SocialForce1995", "SocialForce2000"])
def test_a_decision_that_is_not_finite_is_an_error(kind: str) -> None:
    model = getattr(nav.crowd, kind)()
    given = {"position": [(0.0, 0.0), (0.3, 0.0)], "goal": [(5, 0), (1, 4)]}
    with pytest.raises(SimulationError, match=r"the decision of row \d is not finite: .* are too large"):
        nav.crowd.decide(model, velocity=[(1e308, 1e308), (-1e308, 0.0)], **given)
    person, robot = nav.crowd.decide(model, velocity=np.zeros((2, 2)), robot=[False, True], **given)
    assert np.isfinite(person).all()
    assert np.isnan(robot).all()
