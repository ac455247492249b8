"""Files of measuring devices: layouts, units, errors with their place, times on their grid."""

from __future__ import annotations

import json
import os
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from hrsafety import errors, records

_SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[4] / "shared"))
CASES: dict[str, Any] = json.loads((_SHARED / "spec" / "program_cases.json").read_text(encoding="utf-8"))
TABLES = [case for case in CASES["files"] if "columns" in case]
CHANNEL = next(case for case in CASES["files"] if "code" in case)


def written(folder: Path, text: str, name: str = "record.csv", encoding: str = "utf-8") -> Path:
    place = folder / name
    place.write_bytes(text.encode(encoding))
    return place


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16", "cp1252"])
@pytest.mark.parametrize("case", TABLES, ids=lambda case: case["name"])
def test_layouts(case: dict[str, Any], encoding: str, tmp_path: Path) -> None:
    found = records.load(written(tmp_path, case["text"].lstrip("\ufeff"), encoding=encoding))
    assert list(found.columns) == list(case["columns"])
    for name, values in case["columns"].items():
        assert found.columns[name].tolist() == pytest.approx(values, rel=1e-9, abs=1e-15)
    assert list(found.units.values()) == case["units"]
    assert (found.decimal, found.delimiter, len(found.header)) == (
        case["decimal"],
        case["delimiter"],
        case["header_lines"],
    )


@pytest.mark.parametrize("case", CASES["bad_files"])
def test_errors(case: dict[str, Any], tmp_path: Path) -> None:
    with pytest.raises(errors.FileError) as refused:
        records.load(written(tmp_path, case["text"]))
    assert refused.value.code == case["status"]
    assert "record.csv" in str(refused.value)


def test_a_channel_from_a_file_a_folder_and_an_archive(tmp_path: Path) -> None:
    folder = tmp_path / "test"
    folder.mkdir()
    place = written(folder, CHANNEL["text"], "test.001")
    other = CHANNEL["text"].replace("Head X", "Head Y").replace("ACXP", "ACYP")
    written(folder, other, "test.002")
    written(folder, "Title :run 7\n", "test.mme")
    with zipfile.ZipFile(tmp_path / "test.zip", "w") as archive:
        for each in sorted(folder.iterdir()):
            archive.write(each, each.name)
    for source, names in (
        (place, ["Head X"]),
        (folder, ["Head X", "Head Y"]),
        (tmp_path / "test.zip", ["Head X", "Head Y"]),
    ):
        found = records.load(source)
        assert list(found.columns) == ["time", *names]
        assert found.codes["Head X"] == CHANNEL["code"]
        assert found.time.tolist() == pytest.approx(CHANNEL["time"], abs=1e-15)
        expected = [np.nan if value is None else value for value in CHANNEL["values"]]
        assert found.columns["Head X"].tolist() == pytest.approx(expected, nan_ok=True)


def test_what_a_channel_does_not_say_is_asked_for(tmp_path: Path) -> None:
    for old, new, code in (
        ("Sampling interval           :0.0001\r\n", "", "no_time"),
        ("Time of first sample        :-0.0005\r\n", "", "no_time"),
        ("Unit                        :g", "Unit                        :furlong", "unknown_unit"),
        ("15E", "x", "unreadable_number"),
        ("Comments                    :a: b", "Reference channel :explicit", "no_time"),
    ):
        text = CHANNEL["text"].replace("1.5E+01", "15E+00").replace(old, new)
        with pytest.raises(errors.FileError) as refused:
            records.load(written(tmp_path, text, "a.001"))
        assert refused.value.code == code, new


@pytest.mark.parametrize(
    ("titles", "names", "units"),
    [
        ("Zeit in ms;Kraft in N", ["Zeit", "Kraft"], ["ms", "N"]),
        ("t / ms;F/N", ["t", "F"], ["ms", "N"]),
        ("Zeit [ms];p / N/mm²", ["Zeit", "p"], ["ms", "N/mm²"]),
        ("Zeit [ms];a in m/s²", ["Zeit", "a"], ["ms", "m/s²"]),
        # A quotient of units, or a name with a slash, is no name with a unit behind it.
        ("Zeit [ms];v m/s", ["Zeit", "v m/s"], ["ms", None]),
        ("Zeit [ms];Kraft/Weg", ["Zeit", "Kraft/Weg"], ["ms", None]),
    ],
)
def test_units_behind_a_slash_or_in(titles: str, names: list[str], units: list[str | None], tmp_path: Path) -> None:
    rows = "\n".join(f"{each},0;{each % 7},25" for each in range(20))
    found = records.load(written(tmp_path, f"{titles}\n{rows}"))
    assert list(found.columns) == names
    assert list(found.units.values()) == units
    assert found.time[1] == pytest.approx(1e-3)


def test_times_are_taken_as_meant(tmp_path: Path) -> None:
    # 24 kHz in whole microseconds is an even grid.
    time = np.arange(2400) / 24e3
    rows = "\n".join(f"{each * 1e6:.0f},{value:.3f}" for each, value in zip(time, np.sin(time * 50.0), strict=True))
    found = records.load(written(tmp_path, "t [us],F [N]\n" + rows))
    assert np.ptp(np.diff(found.time)) < 1e-12
    lines = rows.split("\n")
    for change, code, place in (
        (lines[:100] + lines[110:], "gap", "line 102"),
        (lines[:100] + lines[100:101] + lines[100:], "not_increasing", "line 103"),
    ):
        with pytest.raises(errors.FileError) as refused:
            records.load(written(tmp_path, "t [us],F [N]\n" + "\n".join(change)))
        assert refused.value.code == code
        assert place in str(refused.value)


def test_loads_of_a_file(tmp_path: Path) -> None:
    time = np.arange(0.0, 0.06, 5e-5)
    pulse = np.where((time >= 0.02) & (time <= 0.03), 60.0 * np.sin(np.pi * (time - 0.02) / 0.01), 0.0)
    rows = "\n".join(
        f"{1e3 * each:.2f}\t{value:.6f}".replace(".", ",") for each, value in zip(time, pulse, strict=True)
    )
    found = records.load(written(tmp_path, "Device\tA 7\n\nTime\tHead X\nms\tg\n" + rows))
    assert found.acceleration().hic15 == pytest.approx(115.62, rel=1e-4)
    with pytest.raises(errors.FileError, match="unit of force"):
        found.force()
    bare = records.load(written(tmp_path, "time_s;head\n" + rows.replace("\t", ";")))
    with pytest.raises(errors.FileError) as refused:
        bare.acceleration()
    assert refused.value.code == "unit_needed"


def test_thousands_and_missing_times_are_refused(tmp_path: Path) -> None:
    with pytest.raises(errors.FileError) as refused:
        records.load(written(tmp_path, "t;F\n0,1;1.234,5\n0,2;1.300,0\n0,3;1.400,0\n"))
    assert refused.value.code == "thousands_separator"
    found = records.load(written(tmp_path, "0 0\n0.001 2.5\n0.002 5\n"))
    with pytest.raises(errors.FileError) as refused:
        found.force("column_2", unit="N")
    assert refused.value.code == "no_time"
    named = records.load(tmp_path / "record.csv", time="column_1")
    assert named.force("column_2", unit="N").peak == 5.0


@given(data=st.data())
def test_spoiled_files_are_results_or_errors_with_a_place(
    data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    text = data.draw(st.sampled_from([case["text"] for case in CASES["files"]])).encode()
    cut = data.draw(st.integers(0, len(text)))
    noise = data.draw(st.binary(max_size=6))
    place = tmp_path_factory.mktemp("spoiled") / "record.csv"
    place.write_bytes(text[:cut] + noise + text[data.draw(st.integers(cut, len(text))) :])
    lengths: set[int] = set()
    try:
        lengths = {len(column) for column in records.load(place).columns.values()}
        told = place.name
    except errors.FileError as error:
        told = str(error)
    assert len(lengths) <= 1
    assert place.name in told
