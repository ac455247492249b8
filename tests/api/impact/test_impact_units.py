"""Numbers in another unit: warnings that results carry, and errors where a criterion would be silently wrong."""

from __future__ import annotations

import numpy as np
import pytest

from api.interrupting import check_work_is_interrupted, needs_signals
from hrsafety import InvalidParameterError, impact

ARM, FOAM, HEAD = impact.MANIPULATOR_1, impact.FOAM_1, impact.Head.minimum()
GRAVITY = 9.80665


def subjects(found: object) -> list[str]:
    return [each.subject for each in found.warnings]  # type: ignore[attr-defined]  # every result has them


def test_milliseconds_are_refused_by_the_criteria() -> None:
    time = np.arange(0.0, 40.0, 0.1)
    pulse = 60.0 * np.sin(np.pi * time / 40.0) + 1.0
    for criterion in (impact.hic, impact.recorded_metrics):
        with pytest.raises(InvalidParameterError, match=r"time must have steps of at most .* divide milliseconds"):
            criterion(time, pulse)
        criterion(time / 1000.0, pulse)
    # What is defined by straight lines between samples stays defined, with a doubt.
    for found in (
        impact.hic(time, pulse, interpolate=True),
        impact.criteria.clip_3ms(time, pulse),
        impact.criteria.average_3ms(time, pulse),
    ):
        assert "time" in subjects(found)


def test_plausible_impacts_have_no_warnings() -> None:
    run = impact.simulate(ARM, FOAM, HEAD, closing_speed=1.25, step=1e-4)
    level = run.head_acceleration / GRAVITY
    found = impact.recorded_metrics(run.time, level, contact_force=run.contact_force, compression=run.compression)
    assert run.warnings == found.warnings == impact.hic(run.time, level).warnings == ()
    time = np.linspace(0.0, 0.005, 501)
    assert impact.hic(time, 100.0 * np.sin(np.pi * time / 0.005)).warnings == ()


def test_meters_per_second_squared_taken_for_g_are_doubted() -> None:
    run = impact.simulate(ARM, FOAM, HEAD, closing_speed=1.25, step=1e-4)
    assert impact.hic(run.time, run.head_acceleration).warnings
    found = impact.recorded_metrics(run.time, run.head_acceleration, contact_force=run.contact_force)
    assert "mass of the head by contact_force and acceleration_g" in subjects(found)


def test_wrong_units_of_parameters_are_named_in_every_result() -> None:
    heavy = impact.Manipulator(mass=49400.0, damping=111.0, stiffness=14400.0)
    soft = impact.Foam(stiffness=24.3, damping=71.9)
    expected = ["manipulator.mass", "foam.stiffness", "closing_speed"]
    for found in (
        impact.metrics(heavy, soft, HEAD, closing_speed=800.0),
        impact.simulate(heavy, soft, HEAD, closing_speed=800.0),
        impact.gradients(heavy, soft, HEAD, closing_speed=800.0),
    ):
        assert subjects(found) == expected
    assert "49400 kg" in repr(impact.metrics(heavy, soft, HEAD, closing_speed=800.0))
    batch = impact.metrics_batch(manipulator=ARM, foam=FOAM, head=HEAD, closing_speed=[1.0, 800.0])
    assert subjects(batch) == ["closing_speed"]
    limits = impact.FoamLimits(peak_head_acceleration_g=98.1)
    assert subjects(impact.design_foam(ARM, limits, closing_speed=1.0)) == ["limits.peak_head_acceleration_g"]


def test_millimeters_in_foam_tests_are_doubted() -> None:
    fit = impact.identification.fit_static([0.0, 24.0, 49.0, 72.0], [0.0, 1.0, 2.0, 3.0])
    assert subjects(fit) == ["static_compression", "fitted stiffness"]
    assert impact.identification.fit_static([0.0, 24.0, 49.0, 72.0], [0.0, 0.001, 0.002, 0.003]).warnings == ()


@pytest.mark.parametrize("ratio", [1.05, 1.2, 1e2, 1e4, 1e8])
@pytest.mark.parametrize("contact", ["unilateral", "attached"])
def test_overdamped_drop_creeps_to_its_rest(ratio: float, contact: str) -> None:
    time = np.linspace(0.0, 1.0, 50)
    path = impact.identification.drop_trajectory(
        time, height=0.05, mass=1.54, stiffness=24250.0, damping_ratio=ratio, contact=contact
    )
    assert np.isfinite(path).all()
    rest = -1.54 * GRAVITY / 24250.0
    # In contact at the slow root: the offset from the rest shrinks by the same factor from sample to sample.
    rate = (
        np.sqrt(24250.0 / 1.54) * (ratio - np.sqrt(ratio**2 - 1.0))
        if ratio < 1e3
        else np.sqrt(24250.0 / 1.54) / ratio / 2
    )
    late = path[-10:] - rest
    assert late[1:] == pytest.approx(late[:-1] * np.exp(-rate * time[1]), rel=1e-6, abs=1e-15)


def test_numbers_that_overflow_are_refused() -> None:
    with pytest.raises(InvalidParameterError, match="closing_speed"):
        impact.simulate(ARM, FOAM, HEAD, closing_speed=1e308)
    with pytest.raises(InvalidParameterError, match="closing_speed"):
        impact.metrics(ARM, FOAM, HEAD, closing_speed=1e308)
    for force, compression in (([0.0, 1e200, 2e200], [0.0, 0.001, 0.002]), ([0.0, 1.0, 2.0], [0.0, 1e200, 2e200])):
        with pytest.raises(InvalidParameterError, match="squares"):
            impact.identification.fit_static(force, compression)


@pytest.mark.filterwarnings("ignore:.*less than 6 steps:hrsafety.plausibility.HrsafetyWarning")
def test_masked_values_are_refused_by_name() -> None:
    time = np.ma.masked_array([0.0, 0.001, 0.002], mask=[False, True, False])
    with pytest.raises(InvalidParameterError, match=r"time must have no masked values, got 1 masked of 3"):
        impact.hic(time, [1.0, 2.0, 1.0])
    whole = np.ma.masked_array([0.0, 0.001, 0.002], mask=False)
    assert impact.hic(whole, [1.0, 2.0, 1.0]) == impact.hic([0.0, 0.001, 0.002], [1.0, 2.0, 1.0])
    with pytest.raises(InvalidParameterError, match="closing_speed"):
        impact.metrics(ARM, FOAM, HEAD, closing_speed=np.ma.masked)


@needs_signals
@pytest.mark.parametrize(
    ("preparation", "work"),
    [
        (
            "import numpy as np\nfrom hrsafety.impact import identification\n"
            "instants = np.linspace(0.0, 20.0, 2_000_000)",
            "while True: identification.drop_trajectory("
            "instants, height=0.05, mass=1.54, stiffness=1e6, damping_ratio=0.1)",
        ),
        (
            "import numpy as np\nfrom hrsafety import impact\n"
            "instants = np.arange(4e5) * 1e-7\nnoise = np.random.default_rng(1).normal(size=len(instants))",
            "while True: impact.hic(instants, noise)",
        ),
    ],
)
def test_long_work_answers_ctrl_c(preparation: str, work: str, capsys: pytest.CaptureFixture[str]) -> None:
    check_work_is_interrupted(preparation, work, capsys)
