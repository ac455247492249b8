"""The result of a sweep and its other formats: the same numbers, with their units."""

from __future__ import annotations

import csv
import json
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import InvalidParameterError, __version__, errors, impact, scenarios, sweep
from reference import sweep_functions

AXES = [
    sweep.Axis(name="closing_speed", low=0.2, high=2.0, points=4),
    sweep.Axis(name="foam_damping", values=[0.0, 50.0, 100.0]),
]
IMPACT = sweep.ImpactStudy(
    manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"foam_stiffness": 24300.0}
)
SCENES = sweep.NavigationStudy(scenarios={name: scenarios.configuration(name) for name in ("c1", "c2", "c3")})


@pytest.fixture(scope="module")
def impacts(tmp_path_factory: pytest.TempPathFactory) -> sweep.SweepResult:
    return sweep.run(sweep.Grid(AXES), IMPACT, out=tmp_path_factory.mktemp("impacts"), chunk_rows=5)


@pytest.fixture(scope="module")
def runs(tmp_path_factory: pytest.TempPathFactory) -> sweep.SweepResult:
    design = sweep.Sobol([sweep.Axis(name="detour_gain", low=10.0, high=200.0)], 8)
    return sweep.run(design, SCENES, out=tmp_path_factory.mktemp("runs"), chunk_rows=3)


@pytest.fixture(params=["impacts", "runs"])
def result(request: pytest.FixtureRequest) -> sweep.SweepResult:
    found: sweep.SweepResult = request.getfixturevalue(request.param)
    return found


def without(monkeypatch: pytest.MonkeyPatch, module: str) -> None:
    for name in [name for name in sys.modules if name.split(".")[0] == module]:
        monkeypatch.setitem(sys.modules, name, None)  # type: ignore[arg-type]  # marks it as missing
    monkeypatch.setitem(sys.modules, module, None)  # type: ignore[arg-type]  # likewise


def test_chunks_are_the_columns_in_pieces(result: sweep.SweepResult) -> None:
    whole = result.to_numpy()
    pieces = list(result.chunks())
    assert len(pieces) == result.chunk_count == 3
    assert list(whole) == list(pieces[0]) == [column.name for column in result.columns]
    for name, values in whole.items():
        np.testing.assert_array_equal(np.concatenate([piece[name] for piece in pieces]), values)
        assert len(values) == len(result)


def test_opened_folder_is_the_result(result: sweep.SweepResult) -> None:
    assert result.folder is not None
    again = sweep.open(result.folder)
    assert again.complete
    assert again.columns == result.columns
    assert again.axes == result.axes
    assert again.provenance == result.provenance
    for name, values in again.to_numpy().items():
        np.testing.assert_array_equal(values, result[name])
    assert repr(again) == repr(result)


def test_result_in_memory_is_that_of_a_folder(impacts: sweep.SweepResult) -> None:
    found = sweep.run(sweep.Grid(AXES), IMPACT)
    assert found.folder is None
    for name, values in found.to_numpy().items():
        np.testing.assert_array_equal(values, impacts[name])


def test_units_and_provenance_are_there(impacts: sweep.SweepResult, runs: sweep.SweepResult) -> None:
    assert impacts.units["closing_speed"] == "m/s"
    assert impacts.units["peak_contact_force"] == "N"
    assert runs.units["detour_gain"] == "N/m^2"
    assert runs.units["energy"] == "J"
    assert runs.provenance["version"] == __version__
    assert runs.provenance["settings"]["design"]["seed"] == 0
    assert runs.provenance["settings"]["study"]["law"]["repulsive_gain"] == 20.0
    assert impacts.provenance["settings"]["study"]["fixed"] == {"foam_stiffness": 24300.0}
    json.dumps(runs.provenance, allow_nan=False)


def test_part_of_a_sweep_can_be_read(tmp_path: Path) -> None:
    study = sweep.FunctionStudy(function=sweep_functions.fails_beyond, results=["y"], parameters={"limit": 0.5})
    grid = sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=11)])
    with pytest.raises(sweep.SweepError, match="x beyond"):
        sweep.run(grid, study, out=tmp_path, chunk_rows=2)
    part = sweep.open(tmp_path)
    assert not part.complete
    assert len(part) == 6
    np.testing.assert_allclose(part["y"], 2.0 * np.linspace(0.0, 0.5, 6), rtol=1e-14)
    assert "3 of 6 chunks" in repr(part)
    assert [each.code for each in part.warnings] == ["incomplete"]
    # Files of it say so, too.
    assert part.provenance["chunks"] == {"finished": 3, "of": 6}
    pytest.importorskip("xarray", reason="needs the extra sweep")
    with pytest.raises(sweep.SweepError, match="not complete"):
        part.to_xarray()


def test_warnings_of_a_design_are_part_of_the_provenance() -> None:
    study = sweep.FunctionStudy(function=sweep_functions.fails_beyond, results=["y"], parameters={"limit": 2.0})
    found = sweep.run(sweep.Sobol([sweep.Axis(name="x", low=0.0, high=1.0)], 6), study)
    assert [each["code"] for each in found.provenance["warnings"]] == ["unbalanced"]


def test_npz_holds_columns_units_and_provenance(result: sweep.SweepResult, tmp_path: Path) -> None:
    path = result.to_npz(tmp_path / "table.npz")
    with np.load(path, allow_pickle=False) as table:
        description = json.loads(str(table["_hrsafety"]))
        assert set(table.files) == {*result.units, "_hrsafety"}
        for name, values in result.to_numpy().items():
            np.testing.assert_array_equal(table[name], values)
            assert table[name].dtype == values.dtype
    assert description == {"units": result.units, "provenance": result.provenance}


def test_polars_frame_has_the_columns(result: sweep.SweepResult) -> None:
    pl = pytest.importorskip("polars", reason="needs the extra sweep")
    frame = result.to_polars()
    assert frame.columns == [column.name for column in result.columns]
    for column in result.columns:
        np.testing.assert_array_equal(frame[column.name].to_numpy(), result[column.name])
        assert isinstance(frame.schema[column.name], pl.Enum) == (column.kind == "word")
    assert frame.null_count().sum_horizontal().item() == 0
    assert result.to_polars([result.columns[-1].name]).width == 1


def test_parquet_holds_columns_units_and_provenance(result: sweep.SweepResult, tmp_path: Path) -> None:
    pl = pytest.importorskip("polars", reason="needs the extra sweep")
    path = result.to_parquet(tmp_path / "table.parquet")
    assert pl.read_parquet(path).equals(result.to_polars())
    assert pl.scan_parquet(path).head(2).collect().equals(result.to_polars().head(2))
    description = json.loads(pl.read_parquet_metadata(path)["hrsafety"])
    assert description == {"units": result.units, "provenance": result.provenance}
    assert [entry.name for entry in tmp_path.iterdir()] == ["table.parquet"]


def test_parquet_is_read_by_another_library(result: sweep.SweepResult, tmp_path: Path) -> None:
    pytest.importorskip("polars", reason="needs the extra sweep")
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
    table = parquet.read_table(result.to_parquet(tmp_path / "table.parquet"))
    metadata = parquet.read_metadata(tmp_path / "table.parquet").metadata
    assert json.loads(metadata[b"hrsafety"])["units"] == result.units
    for name, values in result.to_numpy().items():
        np.testing.assert_array_equal(np.asarray(table[name].to_pylist()), values)


def test_csv_holds_the_numbers_with_units_in_the_header(result: sweep.SweepResult, tmp_path: Path) -> None:
    path = result.to_csv(tmp_path / "all.csv")
    with path.open(newline="", encoding="utf-8") as file:
        header, *rows = csv.reader(file)
    names = [column.name for column in result.columns]
    assert all(title.startswith(name) for title, name in zip(header, names, strict=True))
    for column in result.columns:
        values = [row[names.index(column.name)] for row in rows]
        if column.kind == "number":
            np.testing.assert_array_equal([float(each or "nan") for each in values], result[column.name])
        elif column.kind == "word":
            assert values == result[column.name].tolist()
    expected = {"closing_speed": "closing_speed_m_per_s", "peak_head_acceleration_g": "peak_head_acceleration_g"}
    assert {title for name, title in expected.items() if name in names} <= set(header)
    some = result.to_csv(tmp_path / "some.csv", names[:1]).read_text(encoding="utf-8").splitlines()
    assert (len(some), some[0]) == (len(result) + 1, header[0])


def test_csv_has_the_warnings_beside_it(tmp_path: Path) -> None:
    speeds = sweep.Grid([sweep.Axis(name="closing_speed", values=[-1.0, 1.0])])
    study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    path = sweep.run(speeds, study).to_csv(tmp_path / "a.csv")
    assert "invalid_numbers" in path.with_name("a.csv.warnings.csv").read_text(encoding="utf-8")


def test_pandas_frame_has_the_columns_and_units(result: sweep.SweepResult) -> None:
    pytest.importorskip("pandas")
    frame = result.to_pandas()
    assert list(frame.columns) == [column.name for column in result.columns]
    assert frame.attrs["units"] == result.units
    for name, values in result.to_numpy().items():
        np.testing.assert_array_equal(np.asarray(frame[name]), values)


def test_grid_becomes_an_array_of_as_many_dimensions(impacts: sweep.SweepResult) -> None:
    pytest.importorskip("xarray", reason="needs the extra sweep")
    data = impacts.to_xarray()
    assert dict(data.sizes) == {"closing_speed": 4, "foam_damping": 3}
    assert data["peak_contact_force"].attrs["units"] == "N"
    assert data["foam_damping"].attrs["units"] == "N s/m"
    expected = impact.metrics_batch(
        manipulator=impact.MANIPULATOR_1,
        head=impact.Head.minimum(),
        foam_stiffness=24300.0,
        closing_speed=float(data["closing_speed"][2]),
        foam_damping=100.0,
    )
    picked = data["peak_contact_force"].isel(closing_speed=2).sel(foam_damping=100.0)
    assert float(picked) == float(expected.peak_contact_force)
    assert json.loads(data.attrs["provenance"]) == impacts.provenance


def test_other_designs_and_cases_become_rows_and_a_dimension(runs: sweep.SweepResult) -> None:
    pytest.importorskip("xarray", reason="needs the extra sweep")
    data = runs.to_xarray(["energy", "outcome"])
    assert dict(data.sizes) == {"row": 8, "scenario": 3}
    assert data["scenario"].values.tolist() == ["c1", "c2", "c3"]
    np.testing.assert_array_equal(data["detour_gain"].values, runs["detour_gain"][::3])
    np.testing.assert_array_equal(data["energy"].sel(scenario="c2").values, runs["energy"][1::3])
    assert data["detour_gain"].attrs["units"] == "N/m^2"
    assert data["energy"].dims == ("row", "scenario")


@pytest.mark.parametrize("names", [["speed"], "energy", 3])
def test_unknown_column_is_refused(runs: sweep.SweepResult, tmp_path: Path, names: Any) -> None:
    for call in (runs.to_numpy, lambda n: list(runs.chunks(n)), lambda n: runs.to_npz(tmp_path / "a.npz", n)):
        with pytest.raises(InvalidParameterError, match="names must be"):
            call(names)
    assert not list(tmp_path.iterdir())


def test_axes_are_no_variables_of_a_dataset(runs: sweep.SweepResult) -> None:
    with pytest.raises(InvalidParameterError, match="names must be one of"):
        runs.to_xarray(["detour_gain"])
    with pytest.raises(InvalidParameterError, match="design must be a grid"):
        runs.shape()


@pytest.mark.parametrize("folder", [3, None, b"x"])
def test_bad_folder_is_refused(folder: Any) -> None:
    with pytest.raises(InvalidParameterError, match="folder must be"):
        sweep.open(folder)


@pytest.mark.parametrize(
    ("module", "call"),
    [
        ("polars", lambda result, _path: result.to_polars()),
        ("polars", lambda result, path: result.to_parquet(path)),
        ("pandas", lambda result, _path: result.to_pandas()),
        ("xarray", lambda result, _path: result.to_xarray()),
        ("scipy", lambda _result, _path: sweep.Sobol(AXES[:1], 4).rows()),
        ("distributed", lambda _result, _path: sweep.run(sweep.Grid(AXES), IMPACT, client=object())),
    ],
)
def test_missing_library_is_named(
    runs: sweep.SweepResult, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, module: str, call: Any
) -> None:
    without(monkeypatch, module)
    with pytest.raises(errors.MissingExtraError, match=r"pip install "):
        call(runs, tmp_path / "file")
