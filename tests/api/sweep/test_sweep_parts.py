"""Axes of late measurements and of parts around a law: each row is the run with these numbers, and doubted as it."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from hrsafety import InvalidParameterError, scenarios, sweep
from hrsafety import navigation as nav
from hrsafety.cli import main
from hrsafety.sweep.navigation_study import PART_UNITS

C2 = scenarios.configuration("c2")
SHIELDED = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), yielding=nav.Yielding())


def codes(axes: list[sweep.Axis], **options: object) -> list[str]:
    """Return the codes of the doubts of a grid in configuration c2, but for its small regions."""
    study = sweep.NavigationStudy(**({"scenarios": C2} | options))
    found = [each.code for each in sweep.run(sweep.Grid(axes), study).warnings]
    assert found == [each.code for each in sweep.estimate(sweep.Grid(axes), study).warnings]
    return [code for code in found if code != "region_below_safe"]


def expected(scene: nav.Scenario, law: nav.Law) -> tuple[float, float, float]:
    """Return numbers of a run that tell it from others."""
    run = nav.simulate_batch([scene], law)
    return float(run.end_time[0]), float(run.path_length[0]), float(run.min_clearance[0])


def test_late_measurements_and_shields_are_those_of_each_row() -> None:
    rows = sweep.LatinHypercube(
        [
            sweep.Axis(name="measurement_latency", low=0.0, high=0.3),
            sweep.Axis(name="shield_latency", low=0.0, high=0.3),
            sweep.Axis(name="shield_person_speed", low=0.8, high=1.6),
            sweep.Axis(name="yielding_clearance", low=0.05, high=0.4),
            sweep.Axis(name="detour_gain", low=10.0, high=60.0),
        ],
        6,
    )
    result = sweep.run(rows, sweep.NavigationStudy(scenarios=C2, law=SHIELDED), chunk_rows=4)
    assert result.units["measurement_latency"] == result.units["shield_latency"] == "s"
    assert result.units["shield_person_speed"] == "m/s"
    found = []
    for row, (late, latency, speed, clearance, gain) in enumerate(rows.rows().tolist()):
        law = nav.SafeNavigation(
            nav.VirtualForceField(detour_gain=gain),
            shield=nav.Shield(latency=latency, person_speed=speed),
            yielding=nav.Yielding(clearance=clearance),
        )
        # Late, and no noise that nobody asked for.
        scene = replace(C2, measurement=nav.Measurement(scale=0.0, latency=late))
        own = tuple(float(result[name][row]) for name in ("end_time", "path_length", "min_clearance"))
        assert own == expected(scene, law)
        found.append(own)
    assert len(set(found)) == 6


def test_scale_and_latency_of_a_row_are_one_measurement() -> None:
    axes = [
        sweep.Axis(name="measurement_latency", values=[0.1]),
        sweep.Axis(name="measurement_scale", values=[0.02]),
        sweep.Axis(name="seed", values=[3.0]),
    ]
    given = nav.Measurement(scale=0.01, distribution="gaussian", of="both")
    for start, made in (
        (None, nav.Measurement(scale=0.02, latency=0.1)),
        (given, replace(given, scale=0.02, latency=0.1)),
    ):
        scene = replace(C2, measurement=start)
        for order in (axes, axes[::-1]):
            result = sweep.run(sweep.Grid(order), sweep.NavigationStudy(scenarios=scene))
            assert (
                result["min_clearance"][0]
                == expected(replace(scene, measurement=made, seed=3), nav.VirtualForceField())[2]
            )
    late = sweep.run(sweep.Grid([axes[0]]), sweep.NavigationStudy(scenarios=replace(C2, measurement=given)))
    assert (
        late["end_time"][0]
        == expected(replace(C2, measurement=replace(given, latency=0.1)), nav.VirtualForceField())[0]
    )


def test_worlds_are_measured_late_and_their_shield_varies() -> None:
    people = [nav.Person(start=(2.0, -1.5), route=[(2.0, 3.0)])]
    robot = nav.Robot(start=(0.0, 0.0), goal=(4.0, 0.0))
    world = nav.World(people=people, robots=[robot])
    latencies, speeds = [0.0, 0.4], [0.6, 1.6]
    axes = [
        sweep.Axis(name="measurement_latency", values=latencies),
        sweep.Axis(name="shield_person_speed", values=speeds),
    ]
    result = sweep.run(sweep.Grid(axes), sweep.NavigationStudy(scenarios=world, law=SHIELDED))
    row, found = 0, set()
    for late in latencies:
        for speed in speeds:
            own = replace(robot, measurement=nav.Measurement(scale=0.0, latency=late))
            law = SHIELDED.replaced(shield=nav.Shield(person_speed=speed))
            table = nav.simulate_many([replace(world, robots=[own])], law)
            assert result["min_clearance"][row] == table.min_clearance[0]
            assert result["path_length"][row] == table.path_length[0]
            found.add(float(table.path_length[0]))
            row += 1
    assert len(found) > 1


# ---- what a shield assumes is compared with its own rows ---------------------------------------------------


def test_a_shield_that_assumes_less_in_any_corner_is_doubted() -> None:
    late = replace(C2, measurement=nav.Measurement(scale=0.0, latency=0.1))
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(latency=0.1))
    less, enough = (
        sweep.Axis(name="shield_latency", values=[0.1, 0.05]),
        sweep.Axis(name="shield_latency", values=[0.1, 0.2]),
    )
    assert codes([enough], scenarios=late, law=law) == []
    assert codes([less], scenarios=late, law=law) == ["shield_assumes_less"]
    assert codes([sweep.Axis(name="measurement_latency", values=[0.0, 0.1])], law=law) == []
    assert codes([sweep.Axis(name="measurement_latency", values=[0.0, 0.2])], law=law) == ["shield_assumes_less"]
    # The shield of the study is good, that of one row is not.
    speeds = sweep.Axis(name="shield_person_speed", values=[1.6, 0.2])
    assert codes([speeds], law=law) == ["shield_assumes_less"]
    assert codes([speeds], law=nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(person_speed=0.2))) == [
        "shield_assumes_less"
    ]


def test_every_number_of_a_part_is_an_axis() -> None:
    for part, units in PART_UNITS.items():
        kind = {"shield": nav.Shield, "yielding": nav.Yielding}[part]
        numbers = {
            name
            for name, default in (
                (each, getattr(kind(), each)) for each in kind.__dataclass_fields__ if each != "_native"
            )
            if default is None or isinstance(default, float)
        }
        assert set(units) == numbers - {"unseen"}
    both = [
        sweep.Axis(name="shield_velocity_error", values=[1.2]),
        sweep.Axis(name="shield_person_acceleration", values=[0.5]),
    ]
    result = sweep.run(sweep.Grid(both), sweep.NavigationStudy(scenarios=C2, law=SHIELDED))
    law = SHIELDED.replaced(shield=nav.Shield(velocity_error=1.2, person_acceleration=0.5))
    assert result["path_length"][0] == expected(C2, law)[1]


def test_rows_that_cannot_be_name_the_axis() -> None:
    for name, values, law in (
        ("shield_person_speed", [1.6, -1.0], SHIELDED),
        ("yielding_horizon", [1.0, 0.0], SHIELDED),
        ("measurement_latency", [0.0, 61.0], SHIELDED),
    ):
        design = sweep.Grid([sweep.Axis(name=name, values=values)])
        study = sweep.NavigationStudy(scenarios=C2, law=law)
        with pytest.raises(InvalidParameterError, match=f"^{name} must"):
            sweep.run(design, study)
        (doubt,) = [each for each in study.judged(design) if each.code == "invalid_numbers"]
        assert doubt.subject == name
    alone = sweep.Grid([sweep.Axis(name="shield_velocity_error", values=[0.3])])
    with pytest.raises(InvalidParameterError, match=r"^shield_person_acceleration must be given with velocity_error"):
        sweep.run(alone, sweep.NavigationStudy(scenarios=C2, law=SHIELDED))


@pytest.mark.parametrize("part", ["shield", "yielding"])
def test_a_part_that_is_not_there_has_no_axes(part: str) -> None:
    name = {"shield": "shield_latency", "yielding": "yielding_clearance"}[part]
    design = sweep.Grid([sweep.Axis(name=name, values=[0.1])])
    bare = nav.SafeNavigation(nav.VirtualForceField(), **{part: None})
    for law in (nav.VirtualForceField(), bare):
        with pytest.raises(InvalidParameterError, match=f"an axis of a law with {part} around it.*safe\\.{part}"):
            sweep.run(design, sweep.NavigationStudy(scenarios=C2, law=law))
    wrong = sweep.Grid([sweep.Axis(name="shield_latenzy", values=[0.1])])
    with pytest.raises(InvalidParameterError, match=r"did you mean .*shield_latency"):
        sweep.run(wrong, sweep.NavigationStudy(scenarios=C2, law=SHIELDED))


def test_a_file_sweeps_latency_and_shield(tmp_path: Path) -> None:
    study = tmp_path / "late.toml"
    study.write_text("""
scenarios = ["c2"]
axes = [
    { name = "measurement_latency", values = [0.0, 0.3] },
    { name = "shield_latency", values = [0.0, 0.3] },
]
[safe.shield]
""")
    assert main(["sweep", str(study), "--out", str(tmp_path / "out")]) == 0
    result = sweep.open(tmp_path / "out")
    assert "shield_assumes_less" in [each.code for each in result.warnings]
    for row, (late, latency) in enumerate(((0.0, 0.0), (0.0, 0.3), (0.3, 0.0), (0.3, 0.3))):
        scene = replace(C2, measurement=nav.Measurement(scale=0.0, latency=late))
        law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(latency=latency))
        np.testing.assert_array_equal(result["path_length"][row], expected(scene, law)[1])
