"""A law on a robot that is told from outside what is seen."""

from __future__ import annotations

import itertools
import math
import pickle
from collections.abc import Callable

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError, ShapeError, SimulationError
from hrsafety.navigation.controller import Command, Controller, Sighting
from hrsafety.navigation.laws import SafeNavigation, Shield, Yielding
from hrsafety.navigation.maps import Guide, StaticMap

FIELD = nav.VirtualForceField()
ORCA = nav.OptimalReciprocalCollisionAvoidance()
WALLS = StaticMap.from_polylines([[(2.0, -2.0), (2.0, 0.5)]])
ROBOT = nav.HolonomicRobot()


def crowd(robot: nav.HolonomicRobot | nav.DifferentialDriveRobot = ROBOT) -> nav.Scenario:
    people = [
        nav.Human(start=(3.0, 0.4), velocity=(-0.8, 0.0), max_speed=1.6),
        nav.Human(start=(4.0, -2.0), velocity=(-0.3, 0.7), max_speed=1.6),
        nav.Human(start=(1.5, 2.5), velocity=(0.2, -0.9), max_speed=1.6),
    ]
    return nav.Scenario(robot=robot, start=(0.0, 0.0), goal=(5.0, 0.0), obstacles=people, time_limit=15.0, seed=3)


LAWS = [
    FIELD,
    ORCA,
    nav.VelocityObstacle(),
    SafeNavigation(FIELD, shield=Shield(), yielding=Yielding()),
    SafeNavigation(ORCA, map=WALLS, guide=Guide(), shield=Shield(person_speed=1.0), yielding=Yielding()),
]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.NAME)
@pytest.mark.parametrize("start", [(0.0, 0.0), None])
def test_told_the_same_it_commands_the_same_as_a_run(law: nav.Law, start: tuple[float, float] | None) -> None:
    scene = crowd()
    controller = Controller(law, ROBOT, scene.goal, start=start, people=3, seed=3)
    run, forces = nav.Run(scene, law), []
    while not run.finished:
        seen = run.observe()
        people = np.hstack([seen.obstacle_position, seen.obstacle_velocity])
        forces.append(controller.update(seen.time, seen.position, seen.velocity, people=people).force)
        run.step()
    told = run.trajectory
    every = round(scene.control_period / 0.01)
    assert len(forces) > 20
    assert np.array_equal(np.array(forces), told.force[:-1][::every][: len(forces)])


def test_a_lidar_tells_the_same_as_in_a_run() -> None:
    room = StaticMap.from_polylines([[(-1, -0.7), (5, -0.7)], [(-1, 0.7), (5, 0.7)]])
    lidar = nav.Lidar(map=room, beams=180)
    scene = nav.Scenario(start=(0.0, 0.2), goal=(4.0, 0.0))
    controller = Controller(FIELD, ROBOT, scene.goal, lidar=lidar, people=0)
    run, forces = nav.Run(scene, FIELD, nav.robots.AsBuilt(sensors=[lidar])), []
    while not run.finished:
        seen = run.observe()
        scan = lidar.scan(seen.position)
        forces.append(controller.update(seen.time, seen.position, seen.velocity, scan=scan).force)
        run.step()
    assert np.array_equal(np.array(forces), run.trajectory.force[:-1][::6][: len(forces)])


def test_two_wheels_are_told_speed_and_turn_rate() -> None:
    robot = nav.DifferentialDriveRobot()
    with pytest.raises(InvalidParameterError, match="shield"):
        Controller(FIELD, robot, (5.0, 0.0), start=(0.0, 0.0))
    law = SafeNavigation(FIELD, shield=Shield())
    controller = Controller(law, robot, (5.0, 3.0))
    with pytest.raises(InvalidParameterError, match="heading"):
        controller.update(0.0, (0.0, 0.0), (0.0, 0.0))
    run = nav.Run(crowd(robot), law)
    controller = Controller(law, robot, (5.0, 0.0), people=3, seed=3)
    told = []
    for _ in range(60):
        seen = run.observe()
        people = np.hstack([seen.obstacle_position, seen.obstacle_velocity])
        command = controller.update(seen.time, seen.position, seen.velocity, heading=seen.heading, people=people)
        told.append(command.force)
        assert command.speed is not None
        assert command.turn_rate is not None
        run.step()
    assert np.array_equal(np.array(told), run.trajectory.force[:-1][::6][:60])


class Ahead:
    """Wants to go ahead, whoever is there."""

    def velocity(self, _: nav.Situation) -> tuple[float, float]:
        return 0.6, 0.0


def shielded(**shield: float) -> Controller:
    law = SafeNavigation(Ahead(), shield=Shield(**shield))
    return Controller(law, ROBOT, (20.0, 0.0), start=(0.0, 0.0))


def still(controller: Controller, time: float, **told: object) -> Command:
    return controller.update(time, (0.0, 0.0), (0.0, 0.0), **told)  # type: ignore[arg-type]  # options by name


def test_who_is_not_measured_again_can_be_ever_nearer() -> None:
    controller = shielded()
    assert still(controller, 0.0, people={"a": (4.0, 0.0, 0.0, 0.0)}).status == "kept"
    # 3.4 m between the surfaces: at 1.6 m/s he can have come after 2.1 s.
    speeds = [math.hypot(*still(controller, 0.06 * k).velocity) for k in range(1, 45)]
    assert speeds[0] > 0.5
    assert speeds[-1] < 0.05
    assert all(later <= before + 1e-9 for before, later in itertools.pairwise(speeds))
    assert still(controller, 2.7).oldest == pytest.approx(2.7)
    assert controller.people == ("a",)
    assert still(controller, 2.76, gone=["a"]).status == "kept"
    assert controller.people == ()


def test_a_late_measurement_counts_with_its_age() -> None:
    person = (1.2, 0.0, 0.0, 0.0)
    now = still(shielded(latency=0.3), 1.0, people={"a": person})
    late = still(shielded(), 1.0, people={"a": (*person, 0.7)})
    fresh = still(shielded(), 1.0, people={"a": person})
    assert now.velocity == pytest.approx(late.velocity, abs=1e-12)
    assert late.velocity[0] < fresh.velocity[0]
    assert late.oldest == pytest.approx(0.3)


def test_who_is_lost_is_older_than_the_time_since_he_was_told_by_the_latency() -> None:
    person = (2.0, 0.0, 0.0, 0.0)
    one, two = shielded(latency=0.3), shielded(latency=0.3)
    still(one, 1.0, people={"a": person})
    still(two, 1.0, people={"a": (*person, 0.7)})
    # Told without an instant he may have been measured 0.3 s before, and is as old as the other from then on.
    for time in (1.06, 1.3, 1.6):
        untimed, timed = still(one, time), still(two, time)
        assert untimed.velocity == pytest.approx(timed.velocity, abs=1e-12)
        assert (untimed.oldest, timed.oldest) == (pytest.approx(time - 1.0), pytest.approx(time - 0.7))
    now = shielded(latency=0.3)
    still(now, 1.0, people={"a": (*person, 1.0)})
    assert still(now, 1.6).velocity[0] > untimed.velocity[0] + 0.05


def test_points_of_a_scan_grow_old() -> None:
    scan = np.full(36, np.inf)
    scan[17:20] = 1.5
    law = SafeNavigation(Ahead(), shield=Shield())
    lidar = nav.sensing.Lidar(beams=36, max_speed=1.6)
    controller = Controller(law, ROBOT, (20.0, 0.0), start=(0.0, 0.0), lidar=lidar)
    fresh = still(controller, 0.0, scan=scan).velocity[0]
    later = [still(controller, 0.06 * step).velocity[0] for step in range(1, 15)]
    assert fresh > 0.5
    assert later[-1] < 0.05
    assert all(after <= before + 1e-9 for before, after in itertools.pairwise(later))
    assert still(controller, 0.9, scan=scan).velocity[0] == fresh


def test_a_turn_that_was_lost_or_late_is_over() -> None:
    robot, law = nav.DifferentialDriveRobot(), SafeNavigation(FIELD, shield=Shield())

    def turning() -> Controller:
        controller = Controller(law, robot, (0.0, 5.0), start=(0.0, 0.0))
        for step in range(4):
            assert controller.update(0.06 * step, (0.0, 0.0), (0.0, 0.0), heading=0.0).turn_rate > 1.0
        return controller

    def again(controller: Controller, time: float) -> Command:
        return controller.update(time, (0.0, 0.0), (0.0, 0.0), heading=math.pi / 2.0 - 1e-3)

    fresh = again(Controller(law, robot, (0.0, 5.0), start=(0.0, 0.0)), 3.0)
    late = again(turning(), 3.0)
    assert (late.timing, late.turn_rate, late.speed) == ("late", fresh.turn_rate, fresh.speed)
    lost = turning()
    for step in range(5, 51):
        assert lost.update(0.06 * step - 0.06, None, None).timing == "lost"
    assert again(lost, 3.0).turn_rate == fresh.turn_rate
    assert again(turning(), 0.24).turn_rate > fresh.turn_rate + 0.5


def test_who_is_not_known_to_move_is_not_taken_to_stand() -> None:
    bounded = shielded(velocity_error=0.1, person_acceleration=1.0)
    with pytest.raises(InvalidParameterError, match="known to velocity_error"):
        still(bounded, 0.0, people={"a": Sighting(2.0, 0.0)})
    assert still(bounded, 0.0, people={"a": Sighting(9.0, 0.0, 0.0, 0.0)}).status == "kept"
    assert still(shielded(), 0.0, people={"a": Sighting(9.0, 0.0)}).status == "kept"


def test_an_older_measurement_of_somebody_counts_for_nothing() -> None:
    one, two = shielded(), shielded()
    for controller in (one, two):
        still(controller, 1.0, people={"a": (1.5, 0.0, 0.0, 0.0)})
    stale = still(one, 1.06, people={"a": Sighting(9.0, 9.0, time=0.5)})
    assert stale.force == still(two, 1.06).force
    newer = still(one, 1.12, people={"a": Sighting(9.0, 9.0, time=1.1)})
    assert newer.velocity == pytest.approx((0.6, 0.0))
    assert newer.oldest == pytest.approx(0.02)


def test_an_update_out_of_order_counts_for_nothing() -> None:
    one, two = shielded(), shielded()
    still(one, 1.0)
    still(two, 1.0)
    for time in (1.0, 0.4):
        again = one.update(time, (3.0, 3.0), (0.5, 0.0), people={"a": (1.0, 0.0, 0.0, 0.0)})
        assert (again.timing, again.status) == ("out_of_order", "braking")
    assert one.people == ()
    assert still(one, 1.06) == still(two, 1.06)


@pytest.mark.parametrize("clock", [lambda _: 1.0, lambda k: 0.06 * k - 7.0, lambda k: -k, lambda k: 1.0 - 1e-9 * k])
def test_a_clock_that_stands_or_is_set_back_lets_the_plan_run_to_its_end(clock: Callable[[int], float]) -> None:
    slow = nav.HolonomicRobot(max_acceleration=1.0)
    controller = Controller(SafeNavigation(Ahead(), shield=Shield()), slow, (20.0, 0.0), start=(0.0, 0.0))
    first = controller.update(1.0, (0.0, 0.0), (0.6, 0.0))
    assert first.velocity[0] == pytest.approx(0.6)
    for k in range(1, 14):
        again = controller.update(clock(k), (0.0, 0.0), (0.6, 0.0))
        assert again.timing == "out_of_order"
        assert again.velocity == pytest.approx(first.velocity_after(0.06 * (k + 1)), abs=1e-12)
        assert again.velocity_after(0.01) == pytest.approx(first.velocity_after(0.06 * k + 0.01), abs=1e-12)
    assert again.velocity == (0.0, 0.0)


@pytest.mark.parametrize("wrong", [1e-4, -1e-4, 0.01, -0.01])
def test_a_plan_is_kept_whatever_own_speed_is_told(wrong: float) -> None:
    slow = nav.HolonomicRobot(max_acceleration=1.0)

    def told(share: float) -> list[Command]:
        controller = Controller(
            SafeNavigation(Ahead(), shield=Shield()), slow, (20.0, 0.0), start=(0.0, 0.0), control_period=0.1
        )
        place, speed, found = 0.0, 0.0, list[Command]()
        for step in range(20):
            people = {} if step < 6 else {"a": (place + 0.61, 0.0, 0.0, 0.0)}
            found.append(controller.update(0.1 * step, (place, 0.0), (speed * share, 0.0), people=people))
            next_speed = found[-1].velocity_after(0.1)[0]
            place, speed = place + 0.05 * (speed + next_speed), next_speed
        return found

    for exact, off in zip(told(1.0), told(1.0 + wrong), strict=True):
        assert off.velocity == pytest.approx(exact.velocity, abs=1e-12)
        assert off.before == pytest.approx(exact.before, abs=1e-12)
        assert off.robot_off_plan is None


def test_a_robot_that_is_off_its_plan_is_told_how_far() -> None:
    controller = shielded()
    first = controller.update(0.0, (0.0, 0.0), (0.3, 0.0))
    assert first.robot_off_plan is None
    jumped = controller.update(0.06, (0.8, 0.0), first.velocity)
    assert jumped.robot_off_plan is not None
    assert jumped.robot_off_plan[0] == pytest.approx(0.8 - 0.03 * (0.3 + first.velocity[0]) - 0.01, abs=1e-9)
    slipped = controller.update(0.12, (0.8 + 0.06 * first.velocity[0], 0.0), (0.9 * jumped.velocity[0], 0.0))
    assert slipped.robot_off_plan is not None
    assert slipped.robot_off_plan[1] == pytest.approx(0.08 * jumped.velocity[0], abs=1e-9)
    assert slipped.before == pytest.approx((0.9 * jumped.velocity[0], 0.0))


def test_a_late_update_says_so() -> None:
    controller = shielded()
    assert [still(controller, time).timing for time in (0.0, 0.06, 0.149, 0.25)] == [
        "regular",
        "regular",
        "regular",
        "late",
    ]


def test_a_robot_that_does_not_know_its_place_brakes_as_its_plan_ends() -> None:
    slow = nav.HolonomicRobot(max_acceleration=1.0)
    controller = Controller(SafeNavigation(FIELD, shield=Shield()), slow, (20.0, 0.0), start=(0.0, 0.0))
    command = controller.update(0.0, (0.0, 0.0), (0.6, 0.0))
    for step in range(1, 14):
        planned = command.velocity_after(0.06 * (step + 1))
        lost = controller.update(0.06 * step, None, None)
        assert (lost.timing, lost.status) == ("lost", "braking")
        assert lost.velocity == pytest.approx(planned, abs=1e-12)
    assert lost.velocity == (0.0, 0.0)
    found = controller.update(0.84, (0.5, 0.0), (0.0, 0.0))
    assert found.timing == "regular"
    assert Controller(FIELD, ROBOT, (5.0, 0.0)).update(0.0, None, None).velocity == (0.0, 0.0)


def test_the_plan_of_a_command_starts_at_the_velocity_and_ends_at_rest() -> None:
    command = shielded().update(0.0, (0.0, 0.0), (0.3, 0.1))
    assert command.velocity_after(0.0) == (0.3, 0.1)
    assert command.velocity_after(command.period) == pytest.approx(command.velocity)
    assert command.velocity_after(5.0) == (0.0, 0.0)
    steps = np.array([command.velocity_after(t) for t in np.linspace(0.0, 1.0, 2001)])
    rates = np.hypot(*np.diff(steps, axis=0).T) / 0.0005
    assert rates.max() <= command.max_acceleration * (1.0 + 1e-6)


def test_a_scan_that_sees_the_place_empty_forgets_after_two_seconds() -> None:
    lidar = nav.Lidar(beams=360)
    law = SafeNavigation(FIELD, shield=Shield())

    def told(reading: float, until: float) -> tuple[object, ...]:
        controller = Controller(law, ROBOT, (20.0, 0.0), start=(0.0, 0.0), lidar=lidar)
        still(controller, 0.0, people={"a": (3.0, 0.0, 0.0, 0.0)})
        still(controller, until, scan=np.full(360, reading))
        return controller.people

    assert told(math.inf, 1.9) == ("a",)
    assert told(math.inf, 2.1) == ()
    # Something hides the place.
    assert told(2.0, 2.1) == ("a",)


def test_a_scan_forgets_nobody_beyond_its_largest_range() -> None:
    law = SafeNavigation(FIELD, shield=Shield())
    for reading in (math.inf, 2.9, 60.0):
        lidar = nav.Lidar(beams=360, range_max=2.9)
        controller = Controller(law, ROBOT, (20.0, 0.0), start=(0.0, 0.0), lidar=lidar)
        still(controller, 0.0, people={"a": (3.0, 0.0, 0.0, 0.0)})
        still(controller, 2.1, scan=np.full(360, reading))
        assert controller.people == ("a",), reading


def test_an_obstacle_that_moves_is_refused_as_nobody_would_tell_where_it_is() -> None:
    cart = nav.MovingRectangle(center=(2.0, 0.0), length=1.0, width=0.8, velocity=(0.0, -0.1))
    wall = nav.Rectangle(center=(2.0, 3.0), length=1.0, width=0.1)
    with pytest.raises(InvalidParameterError, match=r"obstacles\[1\] must stand for all time.*people="):
        Controller(FIELD, ROBOT, (20.0, 0.0), obstacles=[wall, cart])


def test_places_of_those_who_left_are_given_to_others() -> None:
    controller = Controller(FIELD, ROBOT, (20.0, 0.0), people=2)
    still(controller, 0.0, people={"a": (3.0, 0.0, 0.0, 0.0), "b": (4.0, 0.0, 0.0, 0.0)})
    with pytest.raises(InvalidParameterError, match="people=3"):
        still(controller, 0.1, people={"c": (5.0, 0.0, 0.0, 0.0)})
    still(controller, 0.2, gone=["a"])
    still(controller, 0.3, people={"c": (5.0, 0.0, 0.0, 0.0)})
    assert set(controller.people) == {"b", "c"}


def test_nobody_takes_the_place_of_somebody_told_of_in_the_same_update() -> None:
    crowd = {name: (3.0 + name, 0.0, 0.0, 0.0) for name in range(3)}
    full = Controller(FIELD, ROBOT, (20.0, 0.0), people=2)
    with pytest.raises(InvalidParameterError, match="people=3"):
        still(full, 0.0, people=crowd)
    with pytest.raises(InvalidParameterError, match="people=3"):
        still(full, 0.1, people=np.array(list(crowd.values())))
    roomy = Controller(FIELD, ROBOT, (20.0, 0.0), people=3)
    still(roomy, 0.0, people=crowd)
    assert set(roomy.people) == {0, 1, 2}


@pytest.mark.parametrize("reading", [0.0, 1e-300])
def test_what_touches_the_lidar_stops_the_robot(reading: float) -> None:
    lidar = nav.Lidar(beams=36)
    ahead = np.where(np.abs(lidar.bearings) < 0.3, reading, math.inf)
    for law in (FIELD, SafeNavigation(FIELD, shield=Shield())):
        controller = Controller(law, ROBOT, (20.0, 0.0), start=(0.0, 0.0), lidar=lidar)
        assert still(controller, 0.0, scan=np.full(36, math.inf)).velocity[0] > 0.1
        assert still(controller, 0.06, scan=ahead).velocity == pytest.approx((0.0, 0.0))


def test_who_is_faster_than_the_shield_reckons_with_is_named() -> None:
    people = {"walks": (6.0, 2.0, 0.0, 1.5), "runs": (6.0, 0.0, 0.0, -1.7)}
    assert still(shielded(), 0.0, people=people).faster == ("runs",)
    assert still(Controller(FIELD, ROBOT, (20.0, 0.0)), 0.0, people=people).faster == ()
    known = Shield(velocity_error=0.15, person_acceleration=1.0)
    tolerant = Controller(SafeNavigation(FIELD, shield=known), ROBOT, (20.0, 0.0))
    assert still(tolerant, 0.0, people=people).faster == ()
    of_scene = Controller(SafeNavigation(FIELD, shield=Shield(person_speed=None)), ROBOT, (20.0, 0.0), person_speed=1.0)
    assert still(of_scene, 0.0, people=people).faster == ("walks", "runs")


@pytest.mark.parametrize(("speed", "named"), [(2.4, True), (1.5, False)])
@pytest.mark.parametrize(("latency", "error"), [(0.0, 0.0), (0.1, 0.0354)])
def test_a_tracker_that_tells_no_velocity_hides_nobody_who_is_faster(
    speed: float, named: bool, latency: float, error: float
) -> None:
    controller = shielded(latency=latency, position_error=error)
    told = [still(controller, 0.06 * k, people={"a": (8.0 - 0.06 * k * speed, 0.0, 0.0, 0.0)}) for k in range(30)]
    assert (told[-1].faster == ("a",)) == named
    # The robot that stands is off the plan of the controller, which is refuted, too.
    assert ("faster" in told[-1].refuted) == named


def test_a_jump_of_somebody_is_named_until_it_is_past() -> None:
    controller = shielded()
    still(controller, 0.0, people={"a": (6.0, 0.0, 0.0, 0.0), "b": (6.0, 3.0, 0.0, 0.0)})
    jumped = still(controller, 0.06, people={"a": (5.2, 0.0, 0.0, 0.0), "b": (6.0, 3.05, 0.0, 0.0)})
    assert jumped.faster == ("a",)
    assert still(controller, 3.0, people={"a": (5.2, 0.0, 0.0, 0.0)}).faster == ()
    still(controller, 3.06, gone=["a"])
    assert still(controller, 3.12, people={"a": (9.0, 0.0, 0.0, 0.0)}).faster == ()


def test_who_accelerates_more_than_is_assumed_is_named() -> None:
    controller = shielded(velocity_error=0.05, person_acceleration=1.0)
    still(controller, 0.0, people={"a": (6.0, 0.0, 0.0, 0.0), "b": (6.0, 3.0, 0.0, 0.0)})
    told = {"a": (6.0, 0.0, 0.0, 0.2), "b": (6.0, 3.0, 0.0, 0.1)}
    assert still(controller, 0.06, people=told).accelerated == ("a",)


def test_a_decision_names_who_is_faster_than_assumed() -> None:
    people = {"people": [(3.0, 0.0), (4.0, 0.0)], "person_velocity": [(1.7, 0.0), (1.5, 0.0)]}
    decision = Shield().decide((0.1, 0.0), velocity=(0.0, 0.0), **people)
    assert (decision.faster, decision.status) == ((0,), "not_guaranteed")
    assert (
        Shield(velocity_error=0.2, person_acceleration=1.0).decide((0.1, 0.0), velocity=(0.0, 0.0), **people).faster
        == ()
    )


@pytest.mark.parametrize(
    ("told", "message"),
    [
        ({"people": {"a": 3.0}}, r"people\['a'\] must be a Sighting"),
        ({"people": {"a": {"x": 1.0, "y": 2.0, "vx": 0.0, "vy": 0.0}}}, r"people\['a'\] must be a Sighting"),
        ({"gone": "Ada"}, "gone must be names"),
        ({"gone": 5}, "gone must be names"),
        ({"gone": np.array(1.0)}, "gone must be names"),
        ({"gone": [["a"]]}, "gone must hold names"),
        ({"gone": ["a"], "people": {"a": (3.0, 0.0, 0.0, 0.0)}}, "nobody who is measured in the same update"),
        ({"people": {"a": (math.nan, 0.0, 0.0, 0.0)}}, "finite"),
        ({"people": {"a": (1.0, 0.0, 0.0, 0.0, 9.0)}}, "later than the update"),
        ({"scan": [1.0, 2.0]}, "lidar"),
        ({"heading": math.inf}, "finite"),
    ],
)
def test_bad_observations_are_named(told: dict[str, object], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        still(shielded(), 1.0, **told)


def test_bad_arguments_are_named() -> None:
    controller = shielded()
    with pytest.raises(ShapeError):
        still(controller, 1.0, people={"a": (1.0, 2.0)})
    with pytest.raises(InvalidParameterError, match="velocity"):
        controller.update(1.0, (0.0, 0.0), None)
    with pytest.raises(InvalidParameterError, match="time"):
        still(controller, math.nan)
    lidar = nav.Lidar(beams=4)
    scanning = Controller(FIELD, ROBOT, (5.0, 0.0), lidar=lidar)
    for scan, message in (([1.0] * 3, "each of 4 beams"), ([1.0, -1.0, 1.0, 1.0], r"scan\[1\]")):
        with pytest.raises(InvalidParameterError, match=message):
            still(scanning, 1.0, scan=scan)
    with pytest.raises(InvalidParameterError, match="map"):
        Controller(SafeNavigation(FIELD, map=WALLS), ROBOT, (5.0, 0.0), StaticMap.from_polylines([[(0, 1), (1, 1)]]))
    with pytest.raises(SimulationError, match="copied"):
        pickle.dumps(controller)
