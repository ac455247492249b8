"""The follower touches what it passes between two of its steps, as every other robot does."""

from __future__ import annotations

import math

import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from hrsafety import reactive

BODY, SMALL = 0.25, 0.02


def stepped(step: float) -> reactive.Follower:
    """Return a follower that stands: its leader is at the standoff, and its bursts are exact."""
    return reactive.Follower(step=step, fix_noise=False, body_radius=BODY)


def passing(
    shape: reactive.Cylinder | reactive.Box, velocity: tuple[float, float], step: float
) -> reactive.FollowerRun:
    """Return the run in which something passes the standing robot."""
    scene = reactive.FollowerScene(
        leader=reactive.SoundLeader(start=(0.9, 0.0)),
        obstacles=[reactive.MovingObstacle(shape=shape, velocity=velocity)],
        duration=3.0,
    )
    return reactive.follow(scene, follower=stepped(step))


def test_a_small_disc_that_is_never_seen_in_the_body_has_touched_it() -> None:
    # At instants it is 1.5 m to the left and to the right.
    run = passing(reactive.Cylinder(center=(-0.1, 4.5), radius=SMALL), (0.0, -30.0), 0.1)
    assert run.contact_obstacle == 0
    assert run.time[-1] == pytest.approx(0.2)
    # Touched where it comes in: on the left, behind.
    assert run.contact_bearing == pytest.approx(math.acos(-0.1 / (BODY + SMALL)), abs=1e-6)


def test_a_box_that_passes_is_touched_with_its_face() -> None:
    run = passing(reactive.Box(center=(-4.5, 0.1), size=(0.1, 0.4)), (30.0, 0.0), 0.1)
    assert run.contact_obstacle == 0
    assert abs(run.contact_bearing or 0.0) == pytest.approx(math.pi, abs=1e-6)


@settings(max_examples=60, deadline=None)
@given(
    offset=st.floats(-0.6, -0.01),
    speed=st.floats(0.5, 40.0),
    start=st.floats(2.0, 6.0),
    step=st.floats(0.01, 0.2),
    side=st.sampled_from([-1.0, 1.0]),
)
def test_a_touch_depends_on_the_way_alone(offset: float, speed: float, start: float, step: float, side: float) -> None:
    """Behind the robot, where no sensor looks: it stands."""
    reach = BODY + SMALL
    assume(abs(-offset - reach) > 1e-3)
    assume(start + 1.0 < 2.5 * speed)
    disc = reactive.Cylinder(center=(offset, side * start), radius=SMALL)
    run = passing(disc, (0.0, -side * speed), step)
    assert (run.contact_obstacle == 0) == (-offset < reach)


def test_what_is_passed_without_a_touch_is_no_contact() -> None:
    run = passing(reactive.Cylinder(center=(-0.28, 4.5), radius=SMALL), (0.0, -30.0), 0.1)
    assert run.contact_obstacle is None
