"""Doubts of sweeps: scenes made by a function, whichever row they are of, idle seeds, impossible rows."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import impact, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.plausibility import ResultWarning

NOT_LOOKED_AT = "rows_not_looked_at"
AWAY = 3.0


def crossing(row: dict[str, float]) -> nav.Scenario:
    """Return somebody on the way of the robot, who starts beside it for the place 0."""
    place = (0.61, 0.0) if row["place"] == 0.0 else (row["place"], AWAY)
    person = nav.Human(start=place, velocity=(0.0, 0.0))
    return nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=[person], time_limit=20.0)


def places(*values: float) -> sweep.Axis:
    """Return an axis of places."""
    return sweep.Axis(name="place", unit="m", values=values)


def codes(design: sweep.Design) -> set[str]:
    """Return the codes of the doubts of a sweep."""
    study = sweep.NavigationStudy(scenario=crossing, outputs=("outcome",))
    return {each.code for each in sweep.run(design, study, threads=1).warnings}


SCENE = crossing({"place": 0.0})
DOUBT = next(iter(each.code for each in SCENE.warnings))


def test_a_row_in_the_middle_is_looked_at() -> None:
    assert codes(sweep.Grid([places(-3.0, 0.0, 3.0)])) == {DOUBT}
    assert codes(sweep.Grid([places(-3.0, 2.0, 3.0)])) == set()


@settings(max_examples=10, deadline=None)
@given(st.integers(2, 64), st.data())
def test_every_row_of_few_is_looked_at(size: int, data: st.DataObject) -> None:
    doubtful = data.draw(st.integers(0, size - 1))
    values = np.linspace(1.0, 3.0, size)
    values[doubtful] = 0.0
    assert codes(sweep.Grid([places(*values)])) == {DOUBT}


def test_the_result_says_of_how_many_rows_nobody_looked() -> None:
    study = sweep.NavigationStudy(scenario=crossing, outputs=("outcome",))
    (found,) = sweep.run(sweep.Grid([places(*np.linspace(1.0, 3.0, 65))]), study, threads=1).warnings
    assert (found.code, found.subject, found.safe_side) == (NOT_LOOKED_AT, "scenario", False)
    assert "64 of 65 rows" in found.message


def test_gains_make_no_other_scenes() -> None:
    gains = sweep.Axis(name="detour_gain", values=np.linspace(10.0, 20.0, 65))
    assert codes(sweep.Grid([places(2.0, 3.0), gains])) == set()
    assert codes(sweep.Grid([gains, places(2.0, 0.0, 3.0)])) == {DOUBT}


@pytest.mark.parametrize("design", [sweep.Sobol, sweep.LatinHypercube])
def test_samples_are_looked_at_to_their_end(design: type[sweep.Sobol | sweep.LatinHypercube]) -> None:
    axis = sweep.Axis(name="place", unit="m", low=1.0, high=3.0)
    rows, total = design([axis], 128).spread(64)
    assert (len(rows["place"]), total) == (64, 128)
    assert rows["place"][[0, -1]].tolist() == design([axis], 128).rows()[[0, -1], 0].tolist()
    assert NOT_LOOKED_AT in codes(design([axis], 128))
    assert NOT_LOOKED_AT not in codes(design([axis], 64))


# ---- seeds ----------------------------------------------------------------------------------------------

SEEDS = sweep.Axis(name="seed", low=0, high=29, scale="integer")
GAIN = sweep.Axis(name="detour_gain", values=[10.0, 20.0])
C2 = scenarios.configuration("c2")
NOISY = replace(C2, measurement=nav.Measurement(scale=0.02))


def same_runs(axes: list[sweep.Axis], **fields: Any) -> list[ResultWarning]:
    """Return the doubts about seeds of a sweep."""
    result = sweep.run(sweep.Grid(axes), sweep.NavigationStudy(**fields))
    return [each for each in result.warnings if each.code == "same_runs"]


@pytest.mark.parametrize("axes", [[SEEDS], [SEEDS, GAIN], [GAIN, SEEDS]])
def test_seeds_that_change_nothing_are_told(axes: list[sweep.Axis]) -> None:
    (found,) = same_runs(axes, scenarios={"quiet": C2, "noisy": NOISY})
    assert (found.subject, found.safe_side) == ("seed", False)
    assert "the 30 rows over seed in quiet are the same run" in found.message
    assert "more" not in found.message.partition("differ")[2]


def test_seeds_that_draw_something_are_not_doubted() -> None:
    scale = sweep.Axis(name="measurement_scale", values=[0.0, 0.02])
    assert same_runs([SEEDS], scenarios=NOISY) == []
    assert same_runs([SEEDS, scale], scenarios=C2) == []
    assert same_runs([sweep.Axis(name="seed", values=[3.0]), GAIN], scenarios=C2) == []
    assert same_runs([SEEDS], scenario=lambda row: scenarios.random_crowd(3, seed=int(row["seed"]))) == []
    assert same_runs([SEEDS], scenarios=C2, law=nav.RapidlyExploringRandomTree(), outputs=("outcome",)) == []


# ---- rows that cannot be --------------------------------------------------------------------------------

PAD = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())


@settings(max_examples=20, deadline=None)
@given(
    st.sampled_from(["manipulator_mass", "foam_stiffness", "head_damping", "closing_speed"]),
    st.lists(st.floats(-50.0, -0.1), max_size=4, unique=True),
    st.lists(st.floats(0.5, 5.0), min_size=1, max_size=4, unique=True),
)
def test_impossible_numbers_are_counted_before_and_after(name: str, bad: list[float], good: list[float]) -> None:
    values = sweep.Axis(name=name, values=[*bad, *good])
    speeds = sweep.Axis(name="linear_range", values=[0.01, 0.012])
    study = PAD if name == "closing_speed" else replace(PAD, fixed={"closing_speed": 1.0})
    design = sweep.Grid([values, speeds])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        result, expected = sweep.run(design, study), sweep.estimate(design, study)
    for found in (result.warnings, expected.warnings):
        told = [each for each in found if each.code == "invalid_numbers"]
        assert len(told) == bool(bad)
        if bad:
            assert (told[0].subject, told[0].safe_side) == (name, False)
            assert f"{2 * len(bad)} of the {len(design)} rows" in told[0].message
            assert f"{name} is {bad[0]:g} " in told[0].message


def test_impossible_numbers_of_large_designs_are_found() -> None:
    axes = [
        sweep.Axis(name="manipulator_mass", low=-2.0, high=60.0),
        sweep.Axis(name="closing_speed", low=0.0, high=2.0),
    ]
    grid = sweep.Grid([replace(each, points=600) for each in axes])
    for design in (grid, sweep.LatinHypercube(axes, 100_000), sweep.Sobol(axes, 131_072)):
        (found,) = (each for each in PAD.judged(design) if each.code == "invalid_numbers")
        assert "rows that were looked at" in found.message
        assert "manipulator_mass is -" in found.message


def test_zero_speed_and_no_damping_are_right() -> None:
    axes = [sweep.Axis(name=name, low=0.0, high=1.0, points=5) for name in ("closing_speed", "foam_damping")]
    assert PAD.judged(sweep.Grid(axes)) == ()


def test_scenes_that_cannot_be_are_told_before_the_sweep_ends_there() -> None:
    study = sweep.NavigationStudy(scenarios=C2)
    (found,) = study.judged(sweep.Grid([sweep.Axis(name="robot_max_speed", values=[-2.0, 0.5])]))
    assert found.code == "invalid_numbers"
    assert "max_speed must be finite and positive, got -2.0" in found.message


@pytest.mark.parametrize(
    ("head", "words"), [(impact.Head.minimum(), ", which the status bottomed"), (impact.ConstrainedHead(), "")]
)
def test_rows_beyond_the_thickness_are_told_by_what_finds_them(head: Any, words: str) -> None:
    result = sweep.run(
        sweep.Grid([sweep.Axis(name="closing_speed", low=1.0, high=9.0, points=9)]), replace(PAD, head=head)
    )
    (found,) = (each for each in result.warnings if each.code == "bottomed")
    assert found.message.endswith(
        f"leave out rows whose max_compression is above the thickness{words} tells" if words else "thickness"
    )
    deep = result["max_compression"] > impact.FOAM_1.thickness
    assert deep.any()
    assert (result["status"][deep] == "bottomed").all() == bool(words)


WALKER = nav.Human(start=(0.6, 0.6), velocity=(1.0, 0.0))
HELD = replace(WALKER, critical_radius=1.5, active_radius=3.0)
MEETING = nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=[WALKER], time_limit=20.0)
SIZING: dict[str, tuple[float, float]] = {
    "measurement_scale": (0.001, 0.05),
    "measurement_latency": (0.0, 0.3),
    "control_period": (0.02, 0.1),
    "robot_max_speed": (0.3, 0.9),
    "robot_max_deceleration": (0.5, 2.0),
    "robot_radius": (0.2, 0.4),
}
OTHER: dict[str, tuple[float, float]] = {"time_limit": (10.0, 20.0), "seed": (0.0, 3.0), "detour_gain": (10.0, 40.0)}


def resized(name: str, values: tuple[float, float], *scenes: nav.Scenario) -> tuple[sweep.SweepResult, list[str]]:
    """Return a sweep over an axis, and what it says of regions."""
    result = sweep.run(sweep.Grid([sweep.Axis(name=name, values=values)]), sweep.NavigationStudy(scenarios=scenes))
    return result, [each.message for each in result.warnings if each.code == "regions_differ"]


@pytest.mark.parametrize("name", [*SIZING, *OTHER])
def test_axes_that_size_regions_are_named_and_the_radii_are_columns(name: str) -> None:
    away = replace(MEETING, obstacles=())
    result, doubts = resized(name, (SIZING | OTHER)[name], away, MEETING)
    radii = result.to_numpy(["critical_radius_0", "active_radius_0"])
    assert all(np.isnan(values[::2]).all() and np.isfinite(values[1::2]).all() for values in radii.values())
    if name in OTHER:
        assert not doubts
        assert all(len(set(values[1::2].tolist())) == 1 for values in radii.values())
        return
    (doubt,) = doubts
    assert f"sized for {name}, over {name} of scenarios['1'].obstacles[0] critical_radius " in doubt
    for values in radii.values():
        low, high = values[1::2]
        assert abs(low - high) > 1e-3
        assert f"{low:.4g} to {high:.4g} m" in doubt


def test_regions_that_are_given_are_kept_without_a_doubt() -> None:
    for name, values in SIZING.items():
        result, doubts = resized(name, values, replace(MEETING, obstacles=[HELD]))
        assert not doubts
        assert set(result["active_radius_0"].tolist()) == {3.0}


def test_radii_stand_beside_their_rows_whatever_varies_with_them() -> None:
    scales = sweep.Axis(name="measurement_scale", values=[0.05, 0.001])
    design = sweep.Grid([sweep.Axis(name="detour_gain", values=[10.0, 40.0]), scales])
    result = sweep.run(design, sweep.NavigationStudy(scenarios=[MEETING, replace(MEETING, obstacles=[HELD])]))
    own = [
        replace(MEETING, measurement=nav.Measurement(scale=scale)).obstacles[0].active_radius
        for scale in result["measurement_scale"][::2].tolist()
    ]
    assert result["active_radius_0"][::2].tolist() == own
    assert set(result["active_radius_0"][1::2].tolist()) == {3.0}
