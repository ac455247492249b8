"""Foam that is compressed beyond what it can: a status of its own, and never a kept limit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import InvalidParameterError, impact
from hrsafety.cli import main

ARM = impact.MANIPULATOR_2
HEAVY = impact.Head.maximum()
THIN = impact.Foam(stiffness=24300.0, damping=71.9, thickness=0.01)
PARTS = """closing_speed = 1.25
[manipulator]
mass = 49.4
damping = 111.0
stiffness = 14400.0
[damping]
points = 4
"""
foams = st.builds(
    impact.Foam,
    stiffness=st.floats(1.0, 2e5),
    damping=st.floats(0.0, 350.0),
    thickness=st.floats(0.002, 0.06),
)


def test_linear_range_is_at_most_the_thickness() -> None:
    with pytest.raises(InvalidParameterError, match=r"linear_range must be at most the thickness of 0.01 m.*leave"):
        impact.Foam(stiffness=24300.0, damping=71.9, thickness=0.01, linear_range=0.02)
    assert THIN.linear_range == pytest.approx(0.008)
    assert impact.Foam(stiffness=24300.0, damping=71.9).linear_range == 0.02
    assert impact.Foam.from_damping_ratio(
        stiffness=24300.0, damping_ratio=0.1, moving_mass=4.4, thickness=0.01
    ).linear_range == pytest.approx(0.008)


def test_thin_foam_is_bottomed_wherever_it_is_asked_about() -> None:
    found = impact.metrics(ARM, THIN, HEAVY, closing_speed=1.25)
    assert (found.status, found.bottomed, found.beyond_linear_range) == ("bottomed", True, True)
    batch = impact.metrics_batch(manipulator=ARM, foam=THIN, head=HEAVY, closing_speed=[0.2, 0.7, 1.25])
    assert batch.status.tolist() == ["released", "beyond_linear_range", "bottomed"]
    assert batch.bottomed.tolist() == [False, False, True]
    run = impact.simulate(ARM, THIN, HEAVY, closing_speed=1.25)
    assert run.metrics.status == run.compression_status == "bottomed"
    assert impact.gradients(ARM, THIN, HEAVY, closing_speed=1.25).metrics.status == "bottomed"
    limits = impact.FoamLimits(peak_head_acceleration_g=10.0, max_compression=None)
    design = impact.design_foam(ARM, limits, closing_speed=1.25)
    left = design.margin(THIN)
    assert left.status == "bottomed"
    assert left.least < 0.0
    assert not design.accepts(THIN)


@settings(derandomize=True, deadline=None, max_examples=60)
@given(foam=foams, speed=st.floats(0.05, 3.0), limited=st.booleans())
def test_kept_limit_means_compression_within_linear_range_within_thickness(
    foam: impact.Foam, speed: float, limited: bool
) -> None:
    limits = impact.FoamLimits(peak_head_acceleration_g=20.0, max_compression=0.05 if limited else None)
    design = impact.design_foam(ARM, limits, closing_speed=speed)
    left = design.margin(foam)
    assert design.accepts(foam) == (left.status == "kept")
    for head in (impact.Head.minimum(), HEAVY):
        found = impact.metrics(ARM, foam, head, closing_speed=speed)
        if left.status == "kept" or found.status == "released":
            assert found.max_compression <= foam.linear_range <= foam.thickness


def test_row_with_a_range_above_its_thickness_is_named() -> None:
    found = impact.metrics_batch(
        manipulator=ARM, foam=impact.FOAM_1, head=HEAVY, closing_speed=1.0, linear_range=[0.02, 0.03]
    )
    assert found.status.tolist() == ["released", "invalid_linear_range"]
    assert np.isnan(found.max_compression[1])
    thick = impact.metrics_batch(
        manipulator=ARM, foam=impact.FOAM_1, head=HEAVY, closing_speed=1.0, thickness=[0.0254, -1.0, 0.01]
    )
    assert thick.status.tolist()[0] == "released"
    assert thick.status.tolist()[1] == "invalid_thickness"
    assert thick.status.tolist()[2] == "bottomed"


@pytest.mark.parametrize("limit", [{}, {"max_compression": None}])
def test_advice_is_a_foam_that_keeps_every_limit_with_the_margin(limit: dict[str, None]) -> None:
    design = impact.design_foam(ARM, impact.FoamLimits(**limit), closing_speed=1.25)
    found = design.feasibility([0.0, 100.0, 200.0])
    assert found.stiffness > 1e3
    foam = impact.Foam(stiffness=found.stiffness, damping=found.damping)
    at_most = impact.design_foam(ARM, impact.FoamLimits(**limit), closing_speed=found.max_closing_speed * (1.0 - 1e-6))
    assert at_most.accepts(foam, margin=0.1)
    assert not at_most.accepts(foam, margin=0.11)
    assert design.feasibility([100.0], margin=0.3).max_closing_speed < found.max_closing_speed


def test_foam_that_never_gives_back_is_no_advice() -> None:
    """1 N/m with 345 N s/m keeps 10 g and 20 mm in the impact period, and is flat soon after it."""
    soft = impact.Foam(stiffness=1.0, damping=345.0)
    design = impact.design_foam(ARM, impact.FoamLimits(), closing_speed=1.25)
    assert design.margin(soft).max_compression > 0.0
    assert design.margin(soft).status == "bottomed"
    assert not design.accepts(soft)
    least, largest = design.stiffness_range([71.9, 345.0])
    assert 14e3 < least[0] < 24.3e3 < largest[0]
    assert np.isnan(least[1])


def test_command_never_calls_a_crushed_foam_fitting(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "thin.toml"
    text = PARTS + "[limits]\npeak_head_acceleration_g = 10.0\n"
    path.write_text(
        text + "[[foams]]\nname = 'thin'\nstiffness = 24300.0\ndamping = 71.9\nthickness = 0.01\n", encoding="utf-8"
    )
    assert main(["foam", str(path), "--out", str(tmp_path / "out")]) == 0
    printed = capsys.readouterr().out
    assert "does not fit: bottomed" in printed
    assert "0.00 kN/m" not in printed
    page = (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")
    assert "does not fit: bottomed" in page
    assert "0.00 kN/m" not in page
    rows = [line for line in page.split("<tr>") if "thin" in line]
    assert rows
    assert not any("good" in row for row in rows)


def test_command_shows_doubts_and_is_strict_when_asked(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "grams.toml"
    path.write_text(PARTS.replace("49.4", "49400.0"), encoding="utf-8")
    assert main(["foam", str(path), "--out", str(tmp_path / "out")]) == 0
    assert "manipulator.mass is 49400 kg" in capsys.readouterr().err
    assert "Is this what was meant?" in (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")
    assert main(["foam", str(path), "--out", str(tmp_path / "out"), "--strict"]) == 4


def test_margin_of_a_file_is_a_share(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "margin.toml"
    path.write_text("margin = 1.5\n" + PARTS, encoding="utf-8")
    assert main(["foam", str(path), "--out", str(tmp_path / "out")]) == 2
    assert "margin must be from 0 to below 1" in capsys.readouterr().err


def test_replaced_loads_keep_what_is_no_item_of_the_tuple() -> None:
    thin = impact.Foam(stiffness=24300.0, damping=71.9, thickness=0.01, linear_range=0.008)
    found = impact.metrics(ARM, thin, impact.Head.maximum(), closing_speed=12.5)
    assert found.bottomed
    other = found._replace(hic15=1.0)
    assert type(other) is impact.ImpactMetrics
    assert (other.hic15, other.bottomed, other.warnings) == (1.0, True, found.warnings)
    assert found._replace(warnings=("doubt",)).warnings == ("doubt",)
    with pytest.raises((TypeError, ValueError)):
        found._replace(hic=1.0)
