"""What refutes the assumptions of a shield, or is not known, stands in the status of commands."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError

PERIOD = 0.06


class Ahead:
    """Wants to go ahead, whoever is there."""

    def velocity(self, _: nav.Situation) -> tuple[float, float]:
        return 0.6, 0.0


class Driven:
    """A robot that executes its commands, and a controller that is told of it."""

    def __init__(self, *, wanted: object = None, people: int = 12, **options: Any) -> None:
        law = nav.SafeNavigation(wanted or Ahead(), shield=nav.Shield(**options.pop("shield", {})))
        self.controller = nav.Controller(
            law, nav.HolonomicRobot(), (90.0, 0.0), start=(0.0, 0.0), people=people, **options
        )
        self.time, self.place, self.velocity = 0.0, (0.0, 0.0), (0.0, 0.0)

    def told(self, seconds: float = PERIOD, **told: Any) -> nav.Command:
        """Tell what is seen, and execute the command for so long."""
        command = self.controller.update(self.time, self.place, self.velocity, **({"people": {}} | told))
        for part in range(60):
            vx, vy = command.velocity_after((part + 0.5) * seconds / 60.0)
            self.place = self.place[0] + vx * seconds / 60.0, self.place[1] + vy * seconds / 60.0
        self.velocity = command.velocity_after(seconds)
        self.time += seconds
        return command


class Rest:
    """Wants to stay."""

    def velocity(self, _: nav.Situation) -> tuple[float, float]:
        return 0.0, 0.0


def test_every_refuted_assumption_reaches_the_status() -> None:
    robot = Driven()
    assert robot.told(people={"a": (9.0, 0.0, 0.0, 1.5)}).status == "kept"
    runs = robot.told(people={"a": (9.0, 0.09, 0.0, 2.4)})
    assert (runs.faster, runs.refuted, runs.doubts, runs.status) == (("a",), ("faster",), ("faster",), "not_guaranteed")
    assert robot.told(people={"a": (9.0, 0.18, 0.0, 1.5)}).status == "kept"
    robot.place = robot.place[0], robot.place[1] + 0.8
    off = robot.told()
    assert (off.refuted, off.status) == (("robot_off_plan",), "not_guaranteed")
    turns = Driven(shield={"velocity_error": 0.05, "person_acceleration": 1.0})
    turns.told(people={"a": (9.0, 0.0, 0.0, 0.2)})
    turned = turns.told(people={"a": (9.0, 0.0, 0.0, -0.2)})
    assert (turned.accelerated, turned.status) == (("a",), "not_guaranteed")


@pytest.mark.parametrize("lag", [0.06, 0.17, 0.5])
def test_a_robot_that_does_late_what_it_is_told_is_off_its_plan(lag: float) -> None:
    robot, orders = Driven(), list[tuple[float, float]]()
    words = []
    for k in range(20):
        command = robot.controller.update(PERIOD * k, robot.place, robot.velocity, people={})
        words.append((command.robot_off_plan is not None, command.status))
        orders.append(command.velocity)
        late = k - round(lag / PERIOD)
        robot.velocity = orders[late] if late >= 0 else (0.0, 0.0)
        robot.place = robot.place[0] + PERIOD * robot.velocity[0], robot.place[1]
    assert words[0] == (False, "kept")
    assert words[1] == (True, "not_guaranteed")


def test_a_robot_that_brakes_keeps_that_word() -> None:
    robot = Driven()
    for _ in range(12):
        robot.told(people={"a": (9.0, 0.0, 0.0, 0.0)})
    command = robot.told(people={"a": (robot.place[0] + 0.61, 0.0, 0.0, 0.0)})
    assert "faster" in command.refuted
    assert command.status == "braking"


def test_an_update_that_counts_for_nothing_repeats_what_was_refuted_but_learns_no_names() -> None:
    robot = Driven()
    robot.told(people={"a": (9.0, 0.0, 0.0, 2.4)})
    again = robot.controller.update(-1.0, robot.place, robot.velocity, people={"b": (5.0, 0.0, 0.0, 0.0)})
    assert (again.faster, again.status, again.clock_set_back) == (("a",), "braking", 1.0)
    assert robot.controller.people == ("a",)


@pytest.mark.parametrize("speed", [0.5, 1.0, 1.5])
@pytest.mark.parametrize("known", [False, True])
def test_who_moves_otherwise_than_his_velocities_tell_is_named(speed: float, known: bool) -> None:
    assumed = {"velocity_error": 0.1, "person_acceleration": 0.5} if known else {}

    def told(velocity: tuple[float | None, float | None]) -> nav.Command:
        robot = Driven(shield={"position_error": 0.02, **assumed})
        for k in range(30):
            command = robot.told(people={"a": (12.0, speed * PERIOD * k, *velocity)})
        return command

    stands = told((0.0, 0.0))
    assert stands.velocity_off == ("a",)
    assert stands.faster == ()
    assert (stands.status, "velocity_off" in stands.refuted) == (("not_guaranteed", True) if known else ("kept", False))
    assert told((0.0, -speed)).velocity_off == ("a",)
    assert told((0.0, speed)).velocity_off == ()
    if not known:
        assert told((None, None)).velocity_off == ()


@settings(max_examples=60, deadline=None)
@given(
    seed=st.integers(0, 2**32 - 1),
    latency=st.floats(0.0, 0.2),
    error=st.floats(0.0, 0.05),
    velocity_error=st.floats(0.0, 0.2),
    acceleration=st.floats(0.1, 3.0),
)
def test_nobody_who_keeps_to_the_assumptions_refutes_them(
    seed: int, latency: float, error: float, velocity_error: float, acceleration: float
) -> None:
    draw = np.random.default_rng(seed)
    bounds = {"velocity_error": velocity_error, "person_acceleration": acceleration}
    robot = Driven(shield={"latency": latency, "position_error": error, **bounds})
    place, velocity = np.array([12.0, 0.0]), np.zeros(2)
    way, step = [(place, velocity)], 0.01

    def disc(radius: float) -> np.ndarray:
        angle = draw.uniform(0.0, 2.0 * math.pi)
        return radius * math.sqrt(draw.uniform()) * np.array([math.cos(angle), math.sin(angle)])

    for _ in range(40):
        for _ in range(round(PERIOD / step)):
            new = velocity + disc(acceleration * step)
            new *= min(1.0, 1.6 / max(1e-9, float(np.hypot(*new))))
            place, velocity = place + 0.5 * step * (velocity + new), new
            way.append((place, velocity))
        old = way[-1 - int(draw.integers(0, min(len(way), 1 + int(latency / step))))]
        seen = (*(old[0] + disc(error)), *(old[1] + disc(velocity_error)))
        command = robot.told(people={"a": seen})
        assert command.refuted == ()
        assert command.status != "not_guaranteed"


def test_somebody_lost_for_good_is_named_until_he_is_found_or_gone() -> None:
    robot = Driven(wanted=Rest(), age_limit=3.0)
    robot.told(people={"a": (9.0, 0.0, 0.0, 0.0), "b": (9.0, 3.0, 0.0, 0.0)})
    for k in range(60):
        command = robot.told(people={"b": (9.0, 3.0, 0.0, 0.0)})
        assert (command.lost, robot.controller.people) == (("a",), ("b",)) if k > 50 else ((), ("a", "b"))
    assert (command.status, command.doubts, command.refuted) == ("not_guaranteed", ("lost",), ())
    assert robot.told(gone=["a"]).lost == ()
    assert robot.told().status == "kept"


def test_the_robot_stands_until_the_age_limit_and_goes_on_with_a_doubt() -> None:
    robot = Driven(age_limit=5.0)
    robot.told(people={"a": (3.0, 0.0, 0.0, 0.0)})
    speeds = [math.hypot(*robot.told().velocity) for _ in range(100)]
    assert max(speeds[40:80]) == 0.0
    assert speeds[-1] == pytest.approx(0.6)
    assert robot.told().doubts == ("lost",)
    found = robot.told(people={"a": (robot.place[0] + 9.0, 0.0, 0.0, 0.0)})
    assert (found.lost, robot.controller.people) == ((), ("a",))
    for _ in range(5):
        found = robot.told(people={"a": (robot.place[0] + 9.0, 0.0, 0.0, 0.0)})
    assert found.status == "kept"
    for_ever = Driven(age_limit=None)
    for_ever.told(people={"a": (3.0, 0.0, 0.0, 0.0)})
    assert max([math.hypot(*for_ever.told().velocity) for _ in range(100)][40:]) == 0.0


@pytest.mark.parametrize("limit", [0.0, -1.0, math.nan, math.inf])
def test_an_age_limit_is_positive(limit: float) -> None:
    with pytest.raises(InvalidParameterError, match="age_limit"):
        Driven(age_limit=limit)


@pytest.mark.parametrize("count", [1, 3, 7])
def test_new_names_in_every_frame_are_told_and_leave_as_many_people_as_there_are(count: int) -> None:
    robot = Driven(wanted=Rest())
    for k in range(40):
        people = {f"{k}.{who}": (6.0 + 2.0 * who, 0.05 * k, 0.0, 0.8) for who in range(count)}
        command = robot.told(people=people)
        if k > 5:
            assert command.renamed == tuple(people)
            assert (command.status, command.doubts) == ("not_guaranteed", ("renamed",))
    # Who had the first names is there, too, as nobody knew then that names tell nothing.
    assert count <= len(robot.controller.people) <= 2 * count
    kept = {f"{k}.{who}": (6.0 + 2.0 * who, 0.05 * k, 0.0, 0.0) for who in range(count)}
    assert robot.told(people=kept).renamed == ()


def test_one_of_those_whose_names_change_stays_where_he_may_be() -> None:
    robot = Driven(wanted=Rest())
    for k in range(10):
        robot.told(people={f"{k}.{who}": (6.0 + 2.0 * who, 0.0, 0.0, 0.0) for who in range(3)})
    before = len(robot.controller.people)
    robot.told(people={f"x.{who}": (6.0 + 2.0 * who, 0.0, 0.0, 0.0) for who in range(2)})
    assert len(robot.controller.people) == before


def test_a_single_new_name_is_somebody_more() -> None:
    robot = Driven(wanted=Rest())
    robot.told(people={"a": (9.0, 0.0, 0.0, 0.0)})
    command = robot.told(people={"b": (9.0, 0.05, 0.0, 0.0)})
    assert (command.renamed, set(robot.controller.people)) == ((), {"a", "b"})
    assert robot.told(people={"b": (9.0, 0.1, 0.0, 0.0)}).status == "kept"


def test_where_there_is_no_room_who_is_new_is_taken_for_who_is_missing_nearby() -> None:
    robot = Driven(wanted=Rest(), people=2)
    robot.told(people={"a": (9.0, 0.0, 0.0, 0.0), "b": (9.0, 5.0, 0.0, 0.0)})
    command = robot.told(people={"c": (9.0, 0.05, 0.0, 0.0), "b": (9.0, 5.0, 0.0, 0.0)})
    assert (command.renamed, command.doubts) == (("c",), ("renamed",))
    with pytest.raises(InvalidParameterError, match="people=3"):
        robot.told(people={"d": (2.0, 9.0, 0.0, 0.0), "b": (9.0, 5.0, 0.0, 0.0)})
    assert set(robot.controller.people) == {"b", "c"}


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**32 - 1), share=st.floats(0.0, 1.0))
def test_people_are_never_fewer_than_were_measured_at_once_whatever_their_names(seed: int, share: float) -> None:
    """Nobody leaves, some are not measured, names change: all that were ever there at once are still reckoned with."""
    draw = np.random.default_rng(seed)
    robot = Driven(wanted=Rest(), people=8, age_limit=None)
    names = [f"first {who}" for who in range(4)]
    robot.told(people={name: (8.0 + 2.0 * who, 0.0, 0.0, 0.0) for who, name in enumerate(names)})
    for k in range(25):
        names = [f"{k} {who}" if draw.uniform() < share else name for who, name in enumerate(names)]
        seen = [who for who in range(4) if draw.uniform() < 0.7]
        command = robot.told(people={names[who]: (8.0 + 2.0 * who, 0.0, 0.0, 0.0) for who in seen})
        assert len(robot.controller.people) >= 4
        assert all(names[who] in robot.controller.people for who in seen)
        assert (command.status == "not_guaranteed") == bool(command.renamed)


LIDAR = nav.Lidar(beams=36, max_speed=1.6)


def scan(reading: float, beams: slice) -> np.ndarray:
    ranges = np.full(36, math.inf)
    ranges[beams] = reading
    return ranges


def test_beams_that_read_nothing_are_counted_and_reach_the_status() -> None:
    robot = Driven(lidar=LIDAR)
    assert robot.told(scan=scan(math.inf, slice(0, 0))).status == "kept"
    command = robot.told(scan=scan(math.nan, slice(3, 5)))
    assert (command.unknown_beams, command.doubts, command.status) == (2, ("unknown_beams",), "not_guaranteed")
    assert robot.told().unknown_beams == 2
    assert robot.told(scan=scan(math.inf, slice(0, 0))).status == "kept"


def test_what_was_seen_where_nothing_is_read_now_stays_and_grows_old() -> None:
    ahead = slice(17, 20)
    robots = {}
    for reading in (math.nan, math.inf):
        robot = Driven(lidar=LIDAR)
        robot.told(scan=scan(1.5, ahead))
        robots[reading] = [robot.told(scan=scan(reading, ahead)).velocity[0] for _ in range(15)]
    assert max(robots[math.nan][10:]) == 0.0
    assert robots[math.inf][-1] == pytest.approx(0.6)


def test_a_scan_in_millimeters_is_refused() -> None:
    # All of it would be beyond the largest range: free.
    lidar = nav.Lidar(beams=90, range_max=10.0)
    shielded = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield())
    controller = nav.Controller(shielded, nav.HolonomicRobot(), (5.0, 0.0), lidar=lidar)
    scans = nav.ScanController(
        nav.ArcRollouts(), nav.DifferentialDriveRobot(max_turn_acceleration=5.0), (5.0, 0.0), lidars=[lidar]
    )
    for far in (2500.0, 250.0):
        ranges = np.full(90, np.inf)
        ranges[7:9] = far, 1.01 * far
        with pytest.raises(InvalidParameterError, match=r"^scan must be in m.*mm or cm given for m"):
            controller.update(0.0, (0.0, 0.0), (0.0, 0.0), people={}, scan=ranges)
        with pytest.raises(InvalidParameterError, match=r"^scans\[0\].ranges must be in m"):
            scans.update(0.0, (0.0, 0.0), 0.0, [ranges])
        with pytest.raises(InvalidParameterError, match=r"^ranges must be in m"):
            lidar.points((0.0, 0.0), 0.0, ranges)
    # In cm a wall 3 m away is at 300 for a lidar that sees 30 m.
    far_sighted = nav.Lidar(beams=90, range_max=30.0)
    with pytest.raises(InvalidParameterError, match=r"^ranges must be in m.*mm or cm given for m"):
        far_sighted.points((0.0, 0.0), 0.0, np.append(np.linspace(10.0, 29.0, 40), np.linspace(70.0, 300.0, 50)))
    hall = np.append(np.linspace(10.0, 40.0, 60), np.full(30, 655.33))
    assert len(far_sighted.points((0.0, 0.0), 0.0, hall)) == 40
    ranges[:] = 655.33  # some drivers tell so that nothing was hit
    assert controller.update(0.0, (0.0, 0.0), (0.0, 0.0), people={}, scan=ranges).status == "kept"
    assert scans.update(0.0, (0.0, 0.0), 0.0, [ranges]).status == "kept"


def test_a_blind_scan_forgets_nobody() -> None:
    robot = Driven(wanted=Rest(), lidar=nav.Lidar(beams=360))
    robot.told(people={"a": (3.0, 0.0, 0.0, 0.0)})
    for _ in range(40):
        robot.told(scan=np.full(360, math.nan))
    assert robot.controller.people == ("a",)
    robot.told(scan=np.full(360, math.inf))
    assert robot.controller.people == ()


@settings(max_examples=60, deadline=None)
@given(
    ranges=st.lists(
        st.one_of(st.just(math.nan), st.just(math.inf), st.just(0.0), st.floats(0.05, 20.0)), min_size=36, max_size=36
    ),
    blind=st.lists(st.booleans(), min_size=36, max_size=36),
)
def test_a_beam_that_fails_never_makes_the_robot_faster(ranges: list[float], blind: list[bool]) -> None:
    first = np.array(ranges)
    second = np.where(blind, math.nan, first)
    speeds = []
    for later in (first, second):
        robot = Driven(lidar=LIDAR)
        robot.told(scan=first)
        robot.place, robot.velocity = (0.0, 0.0), (0.0, 0.0)
        speeds.append(math.hypot(*robot.told(scan=later).velocity))
    assert speeds[1] <= speeds[0] + 0.01


def test_people_for_whom_nobody_looked_are_not_away() -> None:
    blind, alone = Driven(), Driven(people=0)
    for _ in range(3):
        command = blind.told(people=None)
        assert (command.unmeasured, command.status, command.doubts) == (True, "not_guaranteed", ("unmeasured",))
        assert alone.told(people=None).status == "kept"
    assert blind.told(people={}).status == "kept"
    for step in range(20):
        # 1 s is 16 periods of 0.06 s and a part of one.
        assert blind.told(people=None).unmeasured == (step >= 16)
    assert blind.told(people={"a": (60.0, 0.0, 0.0, 0.0)}).status == "kept"
    for _ in range(20):
        blind.told(people=None)
    # Who left was looked for; whom nobody knows was not.
    assert not blind.told(people=None, gone=["a"]).unmeasured
    for _ in range(20):
        stale = blind.told(people=None, gone=["a"])
    assert stale.unmeasured


def test_scans_alone_are_no_look_and_unseen_people_need_none() -> None:
    lidar = nav.Lidar(beams=90, range_max=12.0)
    robot = Driven(lidar=lidar)
    assert robot.told(people=None).unmeasured
    empty = robot.told(people=None, scan=np.full(90, np.inf))
    assert (empty.unmeasured, empty.status) == (True, "not_guaranteed")
    assert robot.told(people={}, scan=np.full(90, np.inf)).status == "kept"
    law = nav.SafeNavigation(
        Ahead(), map=nav.StaticMap.from_polylines([[(0, 5), (90, 5)]]), shield=nav.Shield(unseen=nav.Unseen())
    )
    unseen = nav.Controller(law, nav.HolonomicRobot(), (90.0, 0.0), start=(0.0, 0.0), lidar=lidar)
    assert not unseen.update(0.0, (0.0, 0.0), (0.0, 0.0)).unmeasured


def test_a_filter_keeps_nobody_who_was_not_measured() -> None:
    law = nav.SafeNavigation(Ahead(), filter=nav.laws.Barrier())
    controller = nav.Controller(law, nav.HolonomicRobot(), (90.0, 0.0), start=(0.0, 0.0))
    assert controller.update(0.0, (0.0, 0.0), (0.6, 0.0)).status == "not_guaranteed"
    assert controller.update(0.06, (0.036, 0.0), (0.6, 0.0), people={}).status == "kept"
