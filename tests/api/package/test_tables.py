"""Results as tables: columns, CSV through the csv module, Polars and pandas; what they refuse."""

from __future__ import annotations

import csv
import dataclasses
import math
import re
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas
import polars
import pytest

from hrsafety import InvalidParameterError, impact, reactive, scenarios
from hrsafety import navigation as nav
from hrsafety.cli import main
from hrsafety.errors import MissingExtraError
from hrsafety.tables import Table

CROSSING = scenarios.configuration("c3")
NOISY = replace(CROSSING, measurement=nav.Measurement())
LAW = nav.VirtualForceField()
LAWS = {"field": LAW, "Khatib": nav.Khatib()}
LINE = nav.tracking.LineReference(start=(0.0, 0.0), velocity=(0.5, 0.0))
FEW: dict[str, Any] = {"grid": (4, 4, 4, 4), "refinements": 1, "survivors": 10, "local_starts": 1}
LEADER = reactive.SoundLeader(start=(1.2, 0.0), end=(3.0, 0.0))
FOLLOWED = reactive.FollowerScene(
    leader=LEADER, obstacles=[reactive.Box(center=(1.5, 1.2), size=(0.5, 0.5))], duration=3.0
)
ROW = reactive.MicrophoneArray()
DELAYS = dict(zip(("delay_12", "delay_13"), ROW.delays(range=[1.0, 2.0, 3.0], bearing=0.5), strict=True))
DRIVE = impact.joints.DirectDrive(proportional=448.7, derivative=5.579)
PARTS = (impact.MANIPULATOR_1, impact.FOAM_1)

RESULTS: dict[str, Callable[[], Table]] = {
    "Trajectory": lambda: nav.simulate(CROSSING, LAW),
    "Trajectory of a robot as built": lambda: nav.simulate(
        NOISY, LAW, built=nav.robots.AsBuilt(wheels=nav.robots.HOLONOMIC_WHEELS)
    ),
    "Trajectory after a reference": lambda: nav.tracking.track(LINE, position=(0.0, 0.3), duration=3.0),
    "TrackingSummary": lambda: nav.tracking.track_batch(LINE, starts=[(0.0, 0.5, 0.0), (0.0, -0.2, 1.0)], duration=3.0),
    "WheelRun": lambda: nav.robots.follow_wheel(
        nav.robots.HOLONOMIC_WHEELS[0], nav.robots.WheelReference.sine(duration=1.0)
    ),
    "Comparison": lambda: nav.compare({"c1": scenarios.configuration("c1"), "c3": CROSSING}, LAWS),
    "RunTable": lambda: nav.simulate_many(NOISY, LAWS, paths=True),
    "RunTable of a batch": lambda: nav.simulate_batch([scenarios.configuration("c2"), CROSSING], LAW),
    "GainSearch": lambda: nav.optimize_gains([CROSSING], **FEW),
    "global GainSearch": lambda: nav.optimize_gains([CROSSING], method="cma_es", evaluations=200),
    "ParetoFront": lambda: nav.gains.pareto_front([CROSSING], grid=(4, 4, 4, 4), refinements=0),
    "GainSensitivity": lambda: nav.gain_sensitivity([CROSSING], changes=(-50, 50)),
    "FollowerExperiment": lambda: reactive.experiment("static", "active", layouts=2),
    "Fixes": lambda: reactive.locate_batch(ROW, **DELAYS),
    "FollowerRun": lambda: reactive.follow(FOLLOWED),
    "SkirtRun": reactive.skirt_run,
    "SkirtTest": lambda: reactive.skirt_test(layouts=1),
    "SmallestSkirt": lambda: reactive.smallest_skirt(0.2, counts=[6, 12], layouts=5),
    "ImpactResponse": lambda: impact.simulate(*PARTS, impact.Head.minimum(), closing_speed=0.8),
    "DirectDriveResponse": lambda: impact.joints.simulate_direct_drive(
        DRIVE, PARTS[1], impact.Head.apparatus(), closing_speed=1.25
    ),
    "ImpactMetricsBatch": lambda: impact.metrics_batch(
        manipulator=PARTS[0], foam=PARTS[1], head=impact.Head.minimum(), closing_speed=[0.4, 1.25]
    ),
}
# A number without a unit, a word, a flag or an index.
PLAIN = {"seed", "outcome", "law", "scenario", "stage", "evaluations", "best_value", "value", "violation", "action"}
PLAIN |= {"status", "collided", "follows", "contact_obstacle"}
PLAIN |= {
    "goal_phase",
    "entered_active",
    "contacts_moving",
    "contacts_toward",
    "contacts_away",
    "contacts_apart",
    "wall_contacts",
    "contacts_standing",
    "contacts_at_fault",
    "descent_share",
    "force_evaluations",
}
PLAIN |= {f"performance_{part}" for part in ("total", "arrival_time", "avoidance", "energy_saving")}
UNIT = re.compile(r"_(s|m|rad|N|A|V|J|N2|m_per_s|m_per_s2|rad_per_s|N_per_m|N_per_m2)$")
# Their columns are those of a sweep, whose units stand beside the names.
OF_SWEEPS = {"GainSensitivity", "SkirtTest", "SmallestSkirt", "ImpactMetricsBatch"}


@pytest.fixture(scope="module", params=RESULTS)
def named(request: pytest.FixtureRequest) -> tuple[str, Table]:
    return request.param, RESULTS[request.param]()


def same(read: str, value: Any) -> bool:
    """Return whether a cell of a file says what the array holds, to the last bit."""
    if isinstance(value, bool):
        return read == str(value).lower()
    if isinstance(value, float):
        return read == "" if math.isnan(value) else float(read) == value
    return read == str(value)


def test_columns_have_one_length_and_carry_their_units(named: tuple[str, Table]) -> None:
    name, result = named
    columns = result.columns()
    assert len({values.shape for values in columns.values()}) == 1
    assert next(iter(columns.values())).ndim == 1
    if name not in OF_SWEEPS:
        assert [column for column in columns if column not in PLAIN and not UNIT.search(column)] == []


def test_csv_is_read_back_bit_for_bit(named: tuple[str, Table], tmp_path: Path) -> None:
    columns = named[1].columns()
    path = named[1].to_csv(tmp_path / "table.csv")
    assert [entry.name for entry in tmp_path.iterdir()] == ["table.csv"]  # nothing left of an unfinished file
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    assert header == list(columns)
    for index, values in enumerate(columns.values()):
        assert len(rows) == len(values)
        assert all(same(row[index], value) for row, value in zip(rows, values.tolist(), strict=True))


def test_frames_hold_the_columns(named: tuple[str, Table]) -> None:
    columns = named[1].columns()
    frame, other = named[1].to_polars(), named[1].to_pandas()
    assert isinstance(frame, polars.DataFrame)
    assert isinstance(other, pandas.DataFrame)
    assert frame.columns == list(other.columns) == list(columns)
    for name, values in columns.items():
        np.testing.assert_array_equal(frame[name].to_numpy(), values)
        np.testing.assert_array_equal(other[name].to_numpy(), values)


def test_polars_reads_the_file_back(tmp_path: Path) -> None:
    run = nav.simulate(CROSSING, LAW)
    read = polars.read_csv(run.to_csv(tmp_path / "run.csv"), infer_schema_length=None)
    for name, values in run.columns().items():
        np.testing.assert_array_equal(read[name].cast(polars.Float64).fill_null(np.nan).to_numpy(), values)


def test_warnings_are_written_beside_the_rows(tmp_path: Path) -> None:
    doubted = nav.simulate_many(dataclasses.replace(CROSSING, heading=90.0), LAW)
    path = doubted.to_csv(tmp_path / "runs.csv")
    beside = tmp_path / "runs.csv.warnings.csv"
    with beside.open(encoding="utf-8", newline="") as file:
        rows = list(csv.DictReader(file))
    told = [dataclasses.asdict(each) for each in doubted.warnings]
    assert rows == [{**each, "safe_side": str(each["safe_side"]).lower()} for each in told]
    assert rows[0]["code"] == "implausible"
    assert doubted.to_pandas().attrs == {"warnings": told}
    nav.simulate_many(CROSSING, LAW).to_csv(tmp_path / "runs.txt")
    assert beside.exists(), "warnings of a file of another name"
    plain = nav.simulate_many(CROSSING, LAW)
    assert plain.to_csv(path) == path
    assert not beside.exists(), "warnings of an earlier result"
    assert plain.to_pandas().attrs == {}


def test_a_file_of_something_else_in_the_place_of_the_warnings_is_kept(tmp_path: Path) -> None:
    beside = tmp_path / "runs.csv.warnings.csv"
    beside.write_text("mine\n", encoding="utf-8")
    nav.simulate_many(CROSSING, LAW).to_csv(tmp_path / "runs.csv")
    with pytest.raises(InvalidParameterError, match=r"leave runs\.csv\.warnings\.csv to the warnings"):
        nav.simulate_many(dataclasses.replace(CROSSING, heading=90.0), LAW).to_csv(tmp_path / "runs.csv")
    assert beside.read_text(encoding="utf-8") == "mine\n"


def test_trajectory_has_the_columns_of_the_command_line(tmp_path: Path) -> None:
    file = tmp_path / "scene.toml"
    file.write_text((Path(__file__).parents[3] / "examples" / "my_first_crossing.toml").read_text(encoding="utf-8"))
    assert main(["simulate", str(file), "--out", str(tmp_path / "out")]) == 0
    described = scenarios.load(file)
    run = nav.simulate(described.scenario, described.law)
    own = run.to_csv(tmp_path / "own.csv").read_bytes()
    assert (tmp_path / "out" / "trajectory.csv").read_bytes() == own
    names = list(run.columns())
    assert names[:8] == ["t_s", "x_m", "y_m", "vx_m_per_s", "vy_m_per_s", "force_x_N", "force_y_N", "heading_rad"]
    assert {"current_0_A", "obstacle_0_x_m", "obstacle_0_y_m", "distance_0_m"} <= set(names)


def test_comparison_has_a_row_for_each_law_and_episode() -> None:
    result = nav.compare({"noisy": NOISY, "c1": scenarios.configuration("c1")}, LAWS, seeds=[3, 4])
    table = result.columns()
    assert table["law"].tolist() == ["field"] * 4 + ["Khatib"] * 4
    assert table["scenario"].tolist() == ["noisy", "noisy", "c1", "c1"] * 2
    assert table["seed"].tolist() == [3, 4] * 4
    np.testing.assert_array_equal(table["energy_J"].reshape(2, 4), result.energy)
    np.testing.assert_array_equal(table["min_distance_0_m"].reshape(2, 4), result.min_distance[:, :, 0])


def test_search_tells_how_it_went() -> None:
    search = nav.optimize_gains([CROSSING], **FEW)
    table = search.columns()
    assert table["stage"].tolist() == ["grid 1", "grid 2", "local 1"]
    assert table["evaluations"][-1] == search.evaluations
    assert table["best_value"][-1] == search.best_value
    assert table["attractive_gain_N_per_m"][-1] == search.local[0].best_gains[0]


@pytest.mark.parametrize("library", ["polars", "pandas"])
def test_missing_library_is_named(library: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, library, None)
    with pytest.raises(MissingExtraError, match=rf"(?i){library}: pip install {library}"):
        getattr(RESULTS["SkirtTest"](), f"to_{library}")()


@pytest.mark.parametrize(
    ("path", "words"), [(3, "path must be the path of a file"), (b"a.csv", "path must be"), ("", "path must be")]
)
def test_path_that_is_none_is_refused(path: Any, words: str) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        RESULTS["SkirtTest"]().to_csv(path)


def test_folder_that_is_missing_is_named(tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError, match=r"lie in a folder that exists, got .*run\.csv'; make .*missing"):
        RESULTS["SkirtTest"]().to_csv(tmp_path / "missing" / "run.csv")


def test_file_stays_as_it_was_when_writing_fails(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = tmp_path / "run.csv"
    path.write_text("old", encoding="utf-8")

    def full(*_: Any, **__: Any) -> Any:
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(csv, "writer", full)
    with pytest.raises(OSError, match="No space left"):
        RESULTS["SkirtTest"]().to_csv(path)
    assert path.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [path]
