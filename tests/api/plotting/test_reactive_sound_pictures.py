"""Pictures of sounds draw what they are given, and refuse what they cannot draw."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from hrsafety import plotting, reactive
from hrsafety.errors import InvalidParameterError, ShapeError

ROW = reactive.MicrophoneArray()
HEARD = reactive.record_burst(reactive.Burst(duration=0.05), ROW, range=2.0, bearing=0.5, noise=0.01)
PLACES = {"range": [1.0, 2.0], "bearing": [0.0, 0.6]}


def test_burst_has_one_panel_for_each_microphone() -> None:
    figure = plotting.reactive.sound_burst(
        HEARD, arrivals=[0.0061, 0.0055, 0.005], span=(0.004, 0.012), title="a burst"
    )
    assert len(figure.axes) == 3
    for index, axes in enumerate(figure.axes):
        line, arrival = axes.lines
        shown = (HEARD.time >= 0.004) & (HEARD.time <= 0.012)
        assert np.array_equal(line.get_xdata(), 1000.0 * HEARD.time[shown])
        assert np.array_equal(line.get_ydata(), HEARD.samples[index, shown])
        assert arrival.get_xdata()[0] == pytest.approx([6.1, 5.5, 5.0][index])
    assert figure.axes[-1].get_xlabel() == "time (ms)"


def test_likeness_is_drawn_as_share_of_its_peak() -> None:
    curves = {
        "similarity": reactive.sound.likeness(HEARD, ROW, method="mean_square"),
        "correlation": reactive.sound.likeness(HEARD, ROW),
    }
    figure = plotting.reactive.sound_likeness(curves, lags=(-65.0, -111.0), span=20)
    first, second = figure.axes
    for axes, lag in ((first, -65), (second, -111)):
        for line in axes.lines[:2]:
            assert max(line.get_ydata()) == 1.0
            assert line.get_xdata()[int(np.argmax(line.get_ydata()))] == lag
        assert axes.get_xlim() == (lag - 20, lag + 20)
        assert axes.get_xlabel() == "lag (samples)"


def test_fixes_stand_where_they_are_seen_from_the_robot() -> None:
    fixes = reactive.sound.jittered_fixes(ROW, **PLACES, runs=30)
    delay_12, delay_13 = ROW.delays(**PLACES)
    truth = [
        reactive.locate(ROW, delay_12=float(a), delay_13=float(b)) for a, b in zip(delay_12, delay_13, strict=True)
    ]
    (axes,) = plotting.reactive.sound_fixes(fixes, truth, labels=["near", "far"]).axes
    dots = [line for line in axes.lines if line.get_marker() == "."]
    assert [len(line.get_xdata()) for line in dots] == [30, 30]
    assert np.array_equal(dots[1].get_ydata(), fixes.position[1, :, 0])
    assert (np.asarray(dots[1].get_xdata()) < 0.0).all()  # left of the robot is left in the picture
    rings = [line for line in axes.lines if line.get_label() in {"near", "far"}]
    for ring, each in zip(rings, truth, strict=True):
        distance = np.hypot(ring.get_xdata(), ring.get_ydata())
        assert distance.max() - each.range == pytest.approx(2.0 * each.range_deviation, rel=0.02)


@pytest.mark.parametrize(
    ("call", "arguments", "error"),
    [
        (plotting.reactive.sound_burst, {"recording": None}, InvalidParameterError),
        (plotting.reactive.sound_burst, {"recording": HEARD, "arrivals": [1.0]}, InvalidParameterError),
        (plotting.reactive.sound_burst, {"recording": HEARD, "span": (1.0, 0.0)}, InvalidParameterError),
        (plotting.reactive.sound_likeness, {"curves": {}}, InvalidParameterError),
        (
            plotting.reactive.sound_fixes,
            {"fixes": reactive.sound.jittered_fixes(ROW, **PLACES), "truth": []},
            ShapeError,
        ),
    ],
)
def test_what_cannot_be_drawn_is_refused(call: Any, arguments: dict[str, Any], error: type[Exception]) -> None:
    with pytest.raises(error):
        call(**arguments)
