"""``hrsafety foam DESIGN.toml``: what it prints and writes, and how it answers a bad file."""

from __future__ import annotations

import contextlib
import csv
import io
import tomllib
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

from api.cli_answers import error_line, written
from api.read_pages import page_of
from hrsafety import impact
from hrsafety.cli import examples, main
from hrsafety.cli.foam.curves import Remembered
from hrsafety.cli.foam.file import load
from hrsafety.cli.parsers import parser

ROOT = Path(__file__).resolve().parents[3]
EXAMPLE = ROOT / "examples" / "foam_design.toml"
FAST = """closing_speed = 3.0
[manipulator]
mass = 49.4
damping = 111.0
stiffness = 14400.0
[damping]
from = 0.0
to = 200.0
points = 5
"""
# Printed with three decimals.
PRINTED = 0.0005


def verdicts(text: str) -> dict[str, str]:
    lines = [line for line in text.splitlines() if line.startswith("Foam ")]
    return {line[:6]: "does not fit" if "does not fit" in line else "fits" for line in lines}


class Answer(NamedTuple):
    """What the command wrote and printed."""

    folder: Path
    text: str


@pytest.fixture(scope="module")
def example(tmp_path_factory: pytest.TempPathFactory) -> Answer:
    """Answer the example once for all who look at it."""
    folder, said = tmp_path_factory.mktemp("example"), io.StringIO()
    with contextlib.redirect_stdout(said):
        assert main(["foam", str(EXAMPLE), "--out", str(folder)]) == 0
    return Answer(folder, said.getvalue())


def test_example_passes_foam_1_and_fails_foams_2_and_3(example: Answer) -> None:
    folder, text = example
    assert verdicts(text) == {"Foam 1": "fits", "Foam 2": "does not fit", "Foam 3": "does not fit"}
    for name in ("summary.html", "boundaries.csv", "boundaries.png"):
        assert f"wrote {folder / name}" in text
        assert (folder / name).stat().st_size > 1000


def test_example_fails_foam_2_for_its_compression_and_foam_3_for_its_acceleration(example: Answer) -> None:
    lines = {line[:6]: line.split() for line in example.text.splitlines() if line.startswith("Foam ")}
    assert lines["Foam 2"][-4:-1] == ["5.022", "24.048", "!"]
    assert lines["Foam 3"][-4:-1] == ["11.548", "!", "10.121"]


def test_page_is_whole_and_carries_the_picture(example: Answer) -> None:
    text = (example.folder / "summary.html").read_text(encoding="utf-8")
    assert page_of(text).images == 1
    assert "http" not in text
    assert "There are foams that fit" in text


def test_boundaries_are_those_of_the_library(example: Answer) -> None:
    described = load(str(EXAMPLE))
    design = impact.design_foam(described.manipulator, described.limits, closing_speed=described.closing_speed)
    upper, lower = design.upper(described.damping), design.lower(described.damping)
    with (example.folder / "boundaries.csv").open(newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == len(described.damping) == 139
    for index in (0, 29, 138):
        row = rows[index]
        assert float(row["upper_stiffness_N_per_m"]) == upper.stiffness[index]
        assert row["upper_status"] == upper.status[index]
        assert row["lower_stiffness_N_per_m"] == ("" if index == 138 else repr(float(lower.stiffness[index])))
        assert row["lower_status"] == lower.status[index]


def test_fits_up_to_is_the_speed_at_which_a_foam_sits_on_its_limit(example: Answer) -> None:
    lines = [line for line in example.text.splitlines() if line.startswith("Foam ")]
    described = load(str(EXAMPLE))
    for line in lines:
        name, speed = line[:6], float(line.split()[-1])
        foam = described.foams[name]
        for shift, expected in ((-2 * PRINTED, True), (2 * PRINTED, False)):
            design = impact.design_foam(described.manipulator, described.limits, closing_speed=speed + shift)
            assert design.accepts(foam) is expected, name


def test_where_nothing_fits_the_largest_closing_speed_is_told(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["foam", written(tmp_path / "fast.toml", FAST), "--out", str(tmp_path / "out")]) == 0
    text = capsys.readouterr().out
    assert "none fits with a damping of 0 to 200 N s/m" in text
    described = load(str(tmp_path / "fast.toml"))
    design = impact.design_foam(described.manipulator, described.limits, closing_speed=3.0)
    found = design.feasibility(described.damping)
    assert not found.feasible
    assert f"up to {found.max_closing_speed:.3f} m/s" in text
    assert f"slow down by   {3.0 - found.max_closing_speed:.3f} m/s" in text
    page = (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")
    assert "None fits with a damping of 0 to 200 N s/m at 3 m/s" in page
    assert f"{found.max_closing_speed:.3f} m/s" in page


def test_at_the_told_speed_something_fits_and_just_above_nothing(tmp_path: Path) -> None:
    described = load(written(tmp_path / "fast.toml", FAST))
    fastest = impact.design_foam(described.manipulator, described.limits, closing_speed=3.0).feasibility(
        described.damping
    )
    for factor, expected in ((0.999, True), (1.001, False)):
        slower = impact.design_foam(
            described.manipulator, described.limits, closing_speed=factor * fastest.max_closing_speed
        )
        assert slower.feasibility(described.damping).feasible is expected


def test_joint_and_lever_arm_describe_the_manipulator_as_well(tmp_path: Path) -> None:
    joint = FAST.replace("mass = 49.4", "inertia = 12.35").replace("damping = 111.0", "damping = 27.75")
    joint = joint.replace("stiffness = 14400.0", "stiffness = 3600.0\nlever_arm = 0.5")
    described = load(written(tmp_path / "joint.toml", joint))
    assert described.manipulator == impact.Manipulator(mass=49.4, damping=111.0, stiffness=14400.0)


def test_limits_that_are_not_named_are_no_limits(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = FAST + "[limits]\nmax_compression = 0.02\n[[foams]]\nname = 'hard'\nstiffness = 60600.0\ndamping = 113.6\n"
    path = written(tmp_path / "soft.toml", text.replace("closing_speed = 3.0", "closing_speed = 1.25"))
    assert load(path).limits.given() == {"max_compression": 0.02}
    assert main(["foam", path, "--out", str(tmp_path / "out")]) == 0
    (line,) = (line for line in capsys.readouterr().out.splitlines() if line.startswith("hard"))
    assert "does not fit" not in line
    with (tmp_path / "out" / "boundaries.csv").open(newline="", encoding="utf-8") as file:
        assert {row["upper_status"] for row in csv.DictReader(file)} == {"no limit"}


@pytest.mark.parametrize("limit", ["peak_contact_force = 300.0", "hic15 = 3.0", "hic36 = 4.0"])
def test_every_kind_of_limit_has_its_column(limit: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    name = {"peak_": "contact force", "hic15": "HIC15", "hic36": "HIC36"}[limit[:5]]
    text = FAST.replace("3.0", "1.25") + f"[limits]\n{limit}\nmax_compression = 0.02\n"
    text += "[[foams]]\nname = 'Foam 1'\nstiffness = 24300.0\ndamping = 71.9\n"
    assert main(["foam", written(tmp_path / "limit.toml", text), "--out", str(tmp_path / "out")]) == 0
    assert name in capsys.readouterr().out
    assert name in (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("change", "named"),
    [
        (("closing_speed = 3.0", "closing_speed = 0.0"), "closing_speed must be finite and positive"),
        (("closing_speed = 3.0", ""), "closing_speed must be given"),
        (("closing_speed = 3.0", "closing_speed = 'fast'"), "closing_speed must be a number"),
        (("mass = 49.4", "mass = -1.0"), "manipulator.mass must be finite and positive"),
        (("mass = 49.4", ""), "manipulator.mass must be given"),
        (("mass = 49.4", "weight = 49.4"), "manipulator.weight must be one of the keys"),
        (("to = 200.0", "to = 0.0"), "damping.to must be finite and above damping.from"),
        (("points = 5", "points = 1"), "damping.points must be from 2 to"),
        (("points = 5", "points = 2.5"), "damping.points must be an integer"),
        (("from = 0.0", "from = -1.0"), "damping.from must be finite and not negative"),
        (("[damping]", "[limits]\nhic15 = nan\n[damping]"), "limits.hic15 must be finite and positive"),
        (("[damping]", "[limits]\n[damping]"), "must hold at least one limit"),
        (("points = 5", "points = 5\n[[foams]]\nname = 'a'\ndamping = 1.0"), "foams[0].stiffness must be given"),
        (
            ("points = 5", "points = 5\n[[foams]]\nname = 'a'\ndamping = -1.0\nstiffness = 1.0"),
            "foams[0].damping must be finite and not negative",
        ),
        (("[manipulator]", "[manipulator"), "must be a TOML file"),
    ],
)
def test_bad_file_is_answered_with_the_key_and_the_rule(
    change: tuple[str, str], named: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert change[0] in FAST
    path = written(tmp_path / "bad.toml", FAST.replace(*change))
    assert main(["foam", path, "--out", str(tmp_path / "out")]) == 2
    line = error_line(capsys)
    assert named in line
    assert "bad.toml" in line
    assert not (tmp_path / "out").exists()


def test_names_of_foams_are_unique(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    foam = "[[foams]]\nname = 'a'\nstiffness = 1e4\ndamping = 50.0\n"
    path = written(tmp_path / "twice.toml", FAST + 2 * foam)
    assert main(["foam", path, "--out", str(tmp_path / "out")]) == 2
    assert "foams[1].name must be a name that no other foam has, got 'a'" in error_line(capsys)


def test_missing_file_and_file_in_place_of_the_folder_are_clear(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["foam", str(tmp_path / "none.toml"), "--out", str(tmp_path)]) == 2
    assert "path must name a readable file" in error_line(capsys)
    blocked = written(tmp_path / "blocked", "")
    assert main(["foam", str(EXAMPLE), "--out", blocked]) == 2
    assert "--out must be a folder or not exist" in error_line(capsys)


def test_help_has_an_example_and_the_example_is_complete(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["foam", "--help"]) == 0
    assert "  hrsafety foam " in capsys.readouterr().out
    words = next(line.split() for line in examples.FOAM.splitlines() if "hrsafety foam" in line)
    assert parser().parse_args(words[1:]).design == "examples/foam_design.toml"
    keys = tomllib.loads(EXAMPLE.read_text(encoding="utf-8"))
    assert set(keys) == {"title", "closing_speed", "manipulator", "limits", "damping", "foams"}


def test_guide_prints_the_loads_and_verdicts_of_the_example() -> None:
    described = load(str(EXAMPLE))
    design = impact.design_foam(described.manipulator, described.limits, closing_speed=described.closing_speed)
    guide = (ROOT / "docs" / "guides" / "foam.md").read_text(encoding="utf-8")
    for name, foam in described.foams.items():
        left = design.margin(foam)
        loads = (10.0 * (1.0 - left.peak_head_acceleration_g), 20.0 * (1.0 - left.max_compression))
        (row,) = (line for line in guide.splitlines() if line.startswith(f"| {name},"))
        _, words, acceleration, compression, verdict, _ = (cell.strip() for cell in row.split("|"))
        assert words == f"{name}, {foam.stiffness / 1000.0:g} kN/m, {foam.damping:g} N s/m"
        assert (acceleration, compression) == tuple(f"{load:.2f}" for load in loads)
        assert verdict.startswith("fits" if design.accepts(foam) else "does not fit")


def test_remembered_boundaries_are_those_of_the_design_and_computed_once() -> None:
    described = load(str(EXAMPLE))
    design = impact.design_foam(described.manipulator, described.limits, closing_speed=described.closing_speed)
    asked: list[float] = []

    def lower(damping: np.ndarray) -> impact.FoamBoundary:
        asked.extend(damping.tolist())
        return design.lower(damping)

    curve = Remembered(lower)
    for damping in ([0.0, 100.0, 340.0], [0.0, 50.0, 100.0], [340.0, 50.0, 340.0]):
        found, expected = curve(np.array(damping)), design.lower(damping)
        for name in ("damping", "stiffness", "status", "limited_by", "holds_below", "holds_above"):
            np.testing.assert_array_equal(getattr(found, name), getattr(expected, name))
        assert [each.tolist() for each in found.crossings] == [each.tolist() for each in expected.crossings]
        assert found.crossing_status == expected.crossing_status
    assert asked == [0.0, 100.0, 340.0, 50.0]
