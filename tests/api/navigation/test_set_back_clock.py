"""A clock that is set back by less than what went by looks as if less time had gone by."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav

PERIOD = 0.1
FAR = {"a": (40.0, 0.0, 0.0, 0.0)}


class Told:
    """A law that wants what it was told last."""

    wanted = (0.6, 0.0)

    def velocity(self, _: nav.Situation) -> tuple[float, float]:
        return self.wanted


def controller(*, acceleration: float = 1.0, asks: Told | None = None, wheels: bool = False) -> nav.Controller:
    kind = nav.DifferentialDriveRobot if wheels else nav.HolonomicRobot
    robot = kind(max_acceleration=acceleration)
    law = nav.SafeNavigation(asks or Told(), shield=nav.Shield())
    return nav.Controller(law, robot, (90.0, 0.0), start=(0.0, 0.0), control_period=PERIOD)


def place_after(command: nav.Command, seconds: float) -> tuple[float, float]:
    parts = 400
    ways = [command.velocity_after((part + 0.5) * seconds / parts) for part in range(parts)]
    return sum(x for x, _ in ways) * seconds / parts, sum(y for _, y in ways) * seconds / parts


@pytest.mark.parametrize("wheels", [False, True])
@pytest.mark.parametrize(("gone_by", "told"), [(0.3, 0.1), (0.3, 0.05), (0.25, 0.15), (0.5, 0.12), (0.09, 0.001)])
def test_a_robot_farther_on_than_the_time_tells_executes_its_plan(gone_by: float, told: float, wheels: bool) -> None:
    driven = controller(wheels=wheels)
    first = driven.update(0.0, (0.0, 0.0), (0.6, 0.0), heading=0.0, people=FAR)
    assert first.velocity[0] == pytest.approx(0.6)
    place, velocity = place_after(first, gone_by), first.velocity_after(gone_by)
    again = driven.update(told, place, velocity, heading=0.0, people=FAR)
    assert (again.timing, again.status) == ("out_of_order", "braking")
    assert again.clock_set_back == pytest.approx(gone_by - told, abs=0.03)
    assert again.clock_set_back <= gone_by - told
    for later in (0.0, 0.05, 0.1, 0.3):
        left = math.hypot(*again.velocity_after(later))
        assert left <= 1.001 * math.hypot(*first.velocity_after(gone_by + later))


@pytest.mark.parametrize("gone_by", [0.2, 0.25, 0.28])
@pytest.mark.parametrize("ahead", [0.01, 0.02])
def test_a_clock_that_is_set_right_does_not_make_the_robot_brake_more_gently(gone_by: float, ahead: float) -> None:
    driven = controller(acceleration=3.0)
    first = driven.update(0.0, (0.0, 0.0), (0.6, 0.0), people=FAR)
    place, velocity = place_after(first, gone_by), first.velocity_after(gone_by)
    again = driven.update(gone_by + ahead, place, velocity, people={"b": (0.85, 0.0, 0.0, 0.0)})
    assert (again.status, again.refuted) == ("braking", ("robot_off_plan",))
    for later in (0.0, 0.02, 0.05, 0.1):
        assert again.velocity_after(later)[0] <= first.velocity_after(gone_by + later)[0] + 1e-6


@settings(max_examples=150, deadline=None)
@given(
    before=st.floats(0.0, 0.6),
    wanted=st.floats(0.05, 0.6),
    turned=st.floats(-3.1, 3.1),
    acceleration=st.floats(0.5, 10.0),
    gone_by=st.floats(0.01, 3.0),
    told=st.floats(1e-3, 1.0),
    wrong=st.floats(-0.01, 0.01),
    off=st.floats(-0.004, 0.004),
)
def test_no_clock_extends_a_plan_that_moves(
    before: float,
    wanted: float,
    turned: float,
    acceleration: float,
    gone_by: float,
    told: float,
    wrong: float,
    off: float,
) -> None:
    """What the robot is told to do next is verified anew with fresh ages, or no more than what was left of its plan."""
    asks = Told()
    asks.wanted = wanted * math.cos(turned), wanted * math.sin(turned)
    driven = controller(acceleration=acceleration, asks=asks)
    first = driven.update(5.0, (0.0, 0.0), (before, 0.0), people=FAR)
    now = told * gone_by
    place, velocity = place_after(first, gone_by), first.velocity_after(gone_by)
    assume(math.hypot(*velocity) > 1e-3)
    seen = (place[0] + off, place[1]), (velocity[0] * (1.0 + wrong), velocity[1] * (1.0 + wrong))
    again = driven.update(5.0 + now, *seen, people=FAR)
    if again.robot_off_plan is not None and again.timing != "out_of_order":
        # Slower than planned, but where it is planned to be: a robot can have slipped as well. It starts from there.
        assert again.robot_off_plan[0] == 0.0
        assert again.status in ("not_guaranteed", "braking")
        assert again.before == seen[1]
    elif again.timing == "out_of_order":
        left = max(math.hypot(*first.velocity_after(gone_by + 0.01 * k)) for k in range(20))
        assert math.hypot(*again.velocity_after(0.0)) <= 1.05 * left + 1e-9
    else:
        # As nearly in time as pose and velocity can tell.
        assert math.dist(place, place_after(first, now)) <= 0.0151
        assert math.dist(velocity, first.velocity_after(now)) <= 0.04 * math.hypot(*velocity) + 1e-9


def resting() -> nav.Controller:
    """Return the controller of a robot that stands, and somebody who could be near it after two seconds."""
    asks = Told()
    asks.wanted = (0.0, 0.0)
    driven = controller(acceleration=10.0, asks=asks)
    for k in range(3):
        driven.update(PERIOD * k, (0.0, 0.0), (0.0, 0.0), people={"a": (4.0, 0.0, 0.0, 0.0)})
    asks.wanted = (0.6, 0.0)
    return driven


@pytest.mark.parametrize("spacing", [0.05, 0.08, 0.16, 0.3])
def test_a_robot_that_rests_does_not_start_on_an_age_that_nothing_tells(spacing: float) -> None:
    driven = resting()
    command = driven.update(0.2 + spacing, (0.0, 0.0), (0.0, 0.0))
    assert command.oldest == math.inf
    assert command.velocity == (0.0, 0.0)
    seen = driven.update(0.3 + spacing, (0.0, 0.0), (0.0, 0.0), people={"a": (4.0, 0.0, 0.0, 0.0)})
    assert seen.oldest == 0.0
    assert seen.velocity[0] > 0.5


@pytest.mark.parametrize("spacing", [0.09, 0.1, 0.11, 0.149])
def test_ordinary_jitter_stops_no_robot(spacing: float) -> None:
    """One update may have been lost while the clock was set back: a period more."""
    command = resting().update(0.2 + spacing, (0.0, 0.0), (0.0, 0.0))
    assert command.oldest == pytest.approx(spacing)
    assert command.velocity[0] > 0.5
    aged = resting().update(0.3, (0.0, 0.0), (0.0, 0.0), people={"a": (1.23, 0.0, 0.0, 0.0, 0.2 - PERIOD)})
    lost = resting()
    lost.update(0.2 + 1e-9, (0.0, 0.0), (0.0, 0.0), people={"a": (1.23, 0.0, 0.0, 0.0)})
    assert lost.update(0.3, (0.0, 0.0), (0.0, 0.0)).velocity == pytest.approx(aged.velocity, abs=1e-6)


@pytest.mark.parametrize("share", [1.0, 0.5, 0.25])
def test_a_controller_that_is_updated_more_often_than_its_period_starts(share: float) -> None:
    """Two sensors in turn, each of which sees one person."""
    asks = Told()
    asks.wanted = (0.0, 0.0)
    driven = controller(acceleration=10.0, asks=asks)
    for k in range(9):
        person = {"ab"[k % 2]: (4.0, 2.0 - 4.0 * (k % 2), 0.0, 0.0)}
        command = driven.update(share * PERIOD * k, (0.0, 0.0), (0.0, 0.0), people=person)
        asks.wanted = (0.6, 0.0) if k == 7 else (0.0, 0.0)
    assert command.velocity[0] > 0.5


@pytest.mark.parametrize("back", [3.0, 3600.0])
def test_a_robot_goes_on_once_its_plan_has_ended_by_any_reading_of_the_clock(back: float) -> None:
    driven = controller()
    first = driven.update(5000.0, (0.0, 0.0), (0.6, 0.0), people=FAR)
    end = place_after(first, 2.0)
    answers = []
    for k in range(12):
        gone_by = PERIOD * (k + 1)
        place, velocity = place_after(first, gone_by), first.velocity_after(gone_by)
        answers.append(driven.update(5000.0 + gone_by - back, place, velocity))
    duration = first.plan[-1][0]
    held = [answer for answer in answers if answer.timing == "out_of_order"]
    assert len(held) * PERIOD == pytest.approx(duration, abs=1.01 * PERIOD)
    # Nobody knows how long it took, and so how long ago somebody was measured.
    assert answers[-1].timing == "regular"
    assert answers[-1].oldest == math.inf
    assert answers[-1].velocity == (0.0, 0.0)
    assert driven.update(5001.3 - back, end, (0.0, 0.0), people=FAR).velocity[0] > 0.05


def test_a_clock_that_stands_stops_the_robot_for_good() -> None:
    driven = controller()
    first = driven.update(1.0, (0.0, 0.0), (0.6, 0.0), people=FAR)
    end = place_after(first, 2.0)
    for _ in range(40):
        again = driven.update(1.0, end, (0.0, 0.0), people=FAR)
        assert (again.timing, again.velocity, again.clock_set_back) == ("out_of_order", (0.0, 0.0), None)


@pytest.mark.parametrize("tracking", [(0.0, 0.02), (0.1, 0.05)])
def test_a_robot_that_was_held_back_from_its_plan_goes_on_as_well(tracking: tuple[float, float]) -> None:
    law = nav.SafeNavigation(Told(), shield=nav.Shield(velocity_tracking=tracking))
    driven = nav.Controller(law, nav.HolonomicRobot(), (90.0, 0.0), start=(0.0, 0.0), control_period=PERIOD)
    driven.update(100.0, (0.0, 0.0), (0.2, 0.0), people={})
    # Somebody holds it where the plan began, where it could still be within the tracking error.
    answers = [driven.update(PERIOD * k, (0.0, 0.0), (0.0, 0.0), people={}) for k in range(20)]
    assert answers[0].timing == "out_of_order"
    assert answers[-1].timing == "regular"
    assert answers[-1].velocity[0] > 0.0
