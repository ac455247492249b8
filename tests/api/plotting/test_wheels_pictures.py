"""Pictures of wheels show what the results hold."""

from __future__ import annotations

import numpy as np
import pytest

from hrsafety import navigation as nav
from hrsafety import plotting

pytest.importorskip("matplotlib")
WHEEL = nav.robots.DIFFERENTIAL_WHEELS[1]


def test_tracking_draws_speed_error_and_current_of_each_run() -> None:
    runs = [
        nav.robots.follow_wheel(wheel, nav.robots.WheelReference.sine(duration=2.0))
        for wheel in nav.robots.DIFFERENTIAL_WHEELS
    ]
    speed, error, current = plotting.robots.wheel_tracking(runs, labels=["right", "left"], title="wheels").axes
    assert [line.get_label() for line in speed.lines] == ["wanted", "right", "left"]
    np.testing.assert_array_equal(speed.lines[0].get_ydata(), runs[0].wanted_speed)
    np.testing.assert_allclose(error.lines[1].get_ydata(), 1e3 * runs[1].angle_error)
    np.testing.assert_array_equal(current.lines[0].get_ydata(), runs[0].current)
    assert [axes.get_ylabel() for axes in (speed, error, current)] == [
        "speed (rad/s)",
        "angle error (mrad)",
        "current (A)",
    ]


def test_identification_draws_tests_line_and_what_did_not_move() -> None:
    tests = nav.robots.open_loop_tests(WHEEL)
    fit = nav.robots.identify_wheel(tests)
    angle, left, line = plotting.robots.wheel_identification(tests, fit).axes
    assert len(angle.lines) == 24  # a line and circles for each of 12 tests
    assert len(left.lines) == 12
    ends = line.lines[0].get_xydata()
    np.testing.assert_allclose(ends[0], [fit.static_friction, 0.0], atol=1e-9)
    crosses = [each for each in line.lines if each.get_marker() == "x"]
    assert [float(each.get_xdata()[0]) for each in crosses] == [0.25, 0.25]


def test_pictures_refuse_what_does_not_belong_together() -> None:
    run = nav.robots.follow_wheel(WHEEL, nav.robots.WheelReference.sine(duration=1.0))
    tests = nav.robots.open_loop_tests(WHEEL)
    fit = nav.robots.identify_wheel(tests)
    for call in (
        lambda: plotting.robots.wheel_tracking([]),
        lambda: plotting.robots.wheel_tracking([run], labels=["a", "b"]),
        lambda: plotting.robots.wheel_identification(tests[1:], fit),
    ):
        with pytest.raises(nav.InvalidParameterError):
            call()
