"""Loads of measured signals: those of fine samples of the exact response, and plain pulses."""

from __future__ import annotations

import numpy as np
import pytest

from hrsafety import InvalidParameterError, ShapeError, impact

# Random and coarse signals are doubtful, which is tested beside the units; here only the numbers count.
pytestmark = pytest.mark.filterwarnings("ignore::hrsafety.plausibility.HrsafetyWarning")

GRAVITY = 9.80665
NUMBERS = [name for name in impact.ImpactMetrics._fields if name not in ("status", "beyond_linear_range")]
EXACT = 1e-12  # pulses with corners at samples


def recorded(response: impact.ImpactResponse, **options: float) -> impact.ImpactMetrics:
    return impact.recorded_metrics(
        response.time,
        response.head_acceleration / GRAVITY,
        contact_force=response.contact_force,
        compression=response.compression,
        manipulator_velocity=response.manipulator_velocity,
        **options,
    )


@pytest.mark.parametrize(
    ("manipulator", "foam", "head", "speed"),
    [
        (impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.apparatus(), 1.25),
        (impact.MANIPULATOR_2, impact.FOAM_2, impact.Head.maximum(), 0.25),
        (impact.MANIPULATOR_1, impact.FOAM_3, impact.Head.minimum(), 0.4),
    ],
)
def test_loads_of_samples_go_to_those_of_the_response_with_the_square_of_the_step(
    manipulator: impact.Manipulator, foam: impact.Foam, head: impact.Head, speed: float
) -> None:
    exact = impact.metrics(manipulator, foam, head, closing_speed=1.25, manipulator_speed=speed)
    errors = []
    for step in (1e-4, 1e-5):
        run = impact.simulate(
            manipulator, foam, head, closing_speed=1.25, manipulator_speed=speed, duration=0.1, step=step
        )
        found = recorded(run, linear_range=foam.linear_range)
        assert found.status == exact.status
        assert found.beyond_linear_range == exact.beyond_linear_range
        errors.append(max(abs(getattr(found, name) / getattr(exact, name) - 1.0) for name in NUMBERS))
    assert errors[0] < 1e-4  # a tenth of a millisecond beside milliseconds, squared
    assert errors[1] < 2e-2 * errors[0]


def test_triangle_has_the_loads_that_can_be_written_down() -> None:
    found = impact.recorded_metrics(
        [0.0, 0.005, 0.015],
        [0.0, 30.0, -30.0],
        contact_force=[0.0, 600.0, -600.0],
        compression=[0.0, 0.01, 0.0],
        manipulator_velocity=[1.0, 0.5, -0.5],
    )
    assert found.impact_duration == pytest.approx(0.010, rel=EXACT)
    assert found.peak_head_acceleration_g == pytest.approx(30.0, rel=EXACT)
    assert found.mean_head_acceleration_g == pytest.approx(15.0, rel=EXACT)
    assert found.hic15 == pytest.approx(impact.criteria.hic_of_pulse("triangle", 30.0, 0.010), rel=1e-9)  # free ends
    assert found.hic36 == pytest.approx(found.hic15, rel=EXACT)
    assert found.average_3ms_g == pytest.approx(30.0 * (1.0 - 0.15), rel=EXACT)
    assert found.clip_3ms_g == pytest.approx(30.0 * (1.0 - 0.3), rel=EXACT)
    assert found.peak_contact_force == pytest.approx(600.0, rel=EXACT)
    assert found.max_compression == pytest.approx(0.01, rel=EXACT)
    # 600 x N times (1 - x / 2) m/s rises to the corner, where it is 300 W.
    assert found.peak_power_manipulator == pytest.approx(300.0, rel=EXACT)
    assert found.peak_power_foam == pytest.approx(300.0 * 2.0, rel=EXACT)
    assert found.status == "released"


def test_start_leaves_out_what_is_before_the_contact() -> None:
    time = np.linspace(-0.02, 0.02, 4001)
    pulse = np.where(time >= 0.0, 40.0 * np.sin(np.pi * time / 0.01), 200.0 * np.sin(np.pi * time / 0.002))
    found = impact.recorded_metrics(time, pulse, start=0.0)
    assert found.peak_head_acceleration_g == pytest.approx(40.0, rel=1e-6)
    assert found.impact_duration == pytest.approx(0.01, rel=1e-6)
    assert impact.recorded_metrics(time, pulse).peak_head_acceleration_g > 199.0


def test_head_that_rests_first_is_not_the_end_of_the_impact() -> None:
    rested = [0.0, 0.01, 0.02, 0.03], [0.0, 0.0, 10.0, 0.0]
    # The period is the pulse, unless the first contact is told.
    assert impact.recorded_metrics(*rested).impact_duration == pytest.approx(0.02, rel=EXACT)
    assert impact.recorded_metrics(*rested, start=0.0).impact_duration == pytest.approx(0.03, rel=EXACT)


def test_record_without_zero_is_flagged_and_its_maxima_stand() -> None:
    found = impact.recorded_metrics([0.0, 0.01, 0.02], [1.0, 8.0, 5.0])
    assert found.status == "no_release"
    assert found.impact_duration == np.inf
    assert found.peak_head_acceleration_g == 8.0
    assert np.isnan([found.peak_contact_force, found.max_compression, found.peak_power_foam]).all()


def test_short_pulse_has_no_level_over_3_ms() -> None:
    found = impact.recorded_metrics([0.0, 0.001, 0.002], [0.0, 50.0, 0.0])
    assert np.isnan([found.average_3ms_g, found.clip_3ms_g]).all()
    assert found.hic15 > 0.0


def test_compression_beyond_the_linear_range_is_flagged() -> None:
    signals = {"time": [0.0, 0.01, 0.02], "acceleration_g": [0.0, 8.0, 0.0], "compression": [0.0, 0.03, 0.0]}
    found = impact.recorded_metrics(**signals, linear_range=0.02)
    assert found.status == "beyond_linear_range"
    assert found.beyond_linear_range
    assert impact.recorded_metrics(**signals).status == "released"


@pytest.mark.parametrize(
    ("change", "error", "argument"),
    [
        ({"time": [0.0, 0.0, 0.02]}, InvalidParameterError, "time"),
        ({"time": [0.0], "acceleration_g": [0.0]}, InvalidParameterError, "time"),
        ({"acceleration_g": [0.0, np.nan, 0.0]}, InvalidParameterError, "acceleration_g"),
        ({"contact_force": [0.0, np.inf, 0.0]}, InvalidParameterError, "contact_force"),
        ({"compression": [0.0, 1.0]}, ShapeError, "compression"),
        ({"start": 0.02}, InvalidParameterError, "start"),
        ({"start": np.nan}, InvalidParameterError, "start"),
        ({"linear_range": 0.0}, InvalidParameterError, "linear_range"),
    ],
)
def test_bad_record_is_refused_by_name(change: dict[str, object], error: type[Exception], argument: str) -> None:
    signals: dict[str, object] = {"time": [0.0, 0.01, 0.02], "acceleration_g": [0.0, 8.0, 0.0]}
    with pytest.raises(error) as caught:
        impact.recorded_metrics(**(signals | change))  # type: ignore[arg-type]  # bad on purpose
    assert caught.value.argument == argument  # type: ignore[attr-defined]  # both errors have one
