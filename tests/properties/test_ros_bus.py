"""Whatever comes over the bus: no error, the limits of the robot are kept, everything is counted."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from api.ros.fake_bus import STAMPED, TWIST, FakeBus, pose, stamped, told, twist
from api.ros.worlds import ROBOT, hall
from hrsafety import navigation as nav
from hrsafety.ros import Bridge, Publisher, Settings

ANY = st.floats(width=64)
SOME = st.one_of(st.floats(-2.0, 2.0), ANY)
TIME = st.one_of(st.floats(-1.0, 1.0), st.floats(-1e3, 1e10))
PLACE = st.one_of(st.floats(-3.0, 11.0), ANY)

EVENTS = st.one_of(
    st.tuples(st.just("now"), SOME, SOME, SOME),
    st.tuples(st.just("stamped"), TIME, SOME, SOME, SOME),
    st.tuples(st.just("plain"), SOME, SOME, SOME),
    st.tuples(st.just("place"), PLACE, PLACE, ANY, st.sampled_from(["map", "", "odom", "/map"])),
    st.tuples(st.just("goal"), PLACE, PLACE, ANY, st.sampled_from(["map", "base_link"])),
    st.tuples(st.just("publishers"), st.lists(st.sampled_from([TWIST, STAMPED, "std_msgs/msg/String"]), max_size=3)),
    st.tuples(st.just("nothing")),
    st.tuples(st.just("slow"), st.floats(0.0, 0.4)),
)


def said(bus: FakeBus, event: tuple[Any, ...]) -> int:
    """Say something on the bus, and return how many velocity commands were heard by that."""
    kind, *values = event
    if kind == "publishers":
        bus.known = {"cmd_vel": [Publisher(each) for each in values[0]]}
    elif kind == "place":
        x, y, w, frame = values
        bus.say("/initialpose", pose(x, y, w=w if math.isfinite(w) else 1.0, frame=frame, covariance=True))
    elif kind == "goal":
        x, y, w, frame = values
        bus.say("/goal_pose", pose(x, y, w=w, frame=frame))
    elif kind == "slow":
        bus._wall += values[0]
    elif kind in ("now", "stamped", "plain"):
        if kind == "plain":
            message, type = told(twist(*values)), TWIST
        else:
            time = bus.now + (0.0 if kind == "now" else values[0])
            message, type = stamped(max(time, 0.0), *values[-3:]), STAMPED
        heard = type in bus.heard["cmd_vel"]
        bus.say("cmd_vel", message, type)
        return int(heard)
    return 0


@settings(max_examples=60, deadline=None)
@given(st.lists(EVENTS, max_size=60), st.booleans(), st.sampled_from([0.0, 0.03, 0.3]))
def test_whatever_comes_is_counted_and_the_limits_are_kept(
    events: list[tuple[Any, ...]], lockstep: bool, delay: float
) -> None:
    bus, queue, heard = FakeBus(), list(events), [0]

    def answer(bus: FakeBus) -> None:
        if queue and bus.sent["/clock"]:
            heard[0] += said(bus, queue.pop(0))

    bus.answer = answer
    options = Settings(lockstep=lockstep, delay=delay, lidar=nav.Lidar(beams=8, range_max=5.0), resolution=0.5)
    bridge = Bridge(hall(time_limit=4.0), bus, options)
    record = bridge.run()
    counts = record.counts
    assert counts["commands"] + counts["command_not_finite"] + counts["command_out_of_order"] == heard[0]
    shown = [each["twist"]["twist"] for each in bus.sent["/odom"]]
    speed = np.array([each["linear"]["x"] for each in shown])
    rate = np.array([each["angular"]["z"] for each in shown])
    places = np.array([(p["x"], p["y"]) for p in (each["pose"]["pose"]["position"] for each in bus.sent["/odom"])])
    assert np.isfinite(places).all()
    assert (np.abs(speed) <= ROBOT.max_speed + 1e-9).all()
    assert (np.abs(rate) <= 1.5 + 1e-9).all()
    period = 0.05 if lockstep else 0.02
    carried = counts["initialpose"]
    assert (np.abs(np.diff(speed)) > ROBOT.max_acceleration * period + 1e-9).sum() <= carried
    # The odometry of a robot that is carried does not jump.
    assert np.abs(np.diff(places, axis=0)).max() < 0.1
    # Nobody drives it any more at the end: half a second after the last command, and the time to brake, it stands.
    if len(events) < 10 and lockstep:
        assert speed[-1] == rate[-1] == 0.0
    for leg in record.legs:
        assert len(leg) >= 2
        assert leg.outcome in {"arrived", "collided", "timed_out", "superseded"}
        assert math.isfinite(leg.metrics.path_length)
    wanted = sum(event[0] in ("place", "goal") for event in events)
    named = ("initialpose", "initialpose_refused", "goal_pose", "goal_pose_refused")
    assert sum(counts[name] for name in named) == wanted - sum(each[0] in ("place", "goal") for each in queue)
    first = {text.split(":")[0] for _, text in bus.logs}
    assert len(bus.logs) <= len(first) + wanted + 20
