"""Several processes in one folder, chunks in Parquet files, lazy datasets, and estimates."""

from __future__ import annotations

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import polars
import pytest
import xarray

from hrsafety import InvalidParameterError, impact, scenarios, sweep
from hrsafety.cli import main
from hrsafety.errors import MissingExtraError
from hrsafety.sweep.chunk_ranges import checked_share

PATIENCE = 60.0
GRID = sweep.Grid(
    [
        sweep.Axis(name="foam_stiffness", low=5e3, high=60e3, points=40),
        sweep.Axis(name="foam_damping", low=0.0, high=150.0, points=25),
    ]
)
STUDY = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25})
ROWS = 50
CHUNKS = 20
STORES = ("npz", "parquet")

FILE = """
head = "minimum"
chunk_rows = 50
axes = [
    { name = "foam_stiffness", from = 5e3, to = 6e4, points = 40 },
    { name = "foam_damping", from = 0.0, to = 150.0, points = 25 },
]
[manipulator]
mass = 49.4
damping = 111.0
stiffness = 14400.0
[impact]
closing_speed = 1.25
"""

# A task of a job array: its share of the chunks of the file, slowed down to be met in the middle.
TASK = """
import sys, time
from hrsafety import impact, sweep
out, chunks, store, pause = sys.argv[1], sys.argv[2], sys.argv[3], float(sys.argv[4])
design = sweep.Grid([
    sweep.Axis(name="foam_stiffness", low=5e3, high=60e3, points=40),
    sweep.Axis(name="foam_damping", low=0.0, high=150.0, points=25),
])
study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25})
def told(done, total):
    print(done, total, flush=True)
    time.sleep(pause)
sweep.run(design, study, out=out, chunk_rows=50, chunks=chunks, store=store, progress=told)
"""


def task(out: Path, chunks: str, store: str = "npz", pause: float = 0.0) -> subprocess.Popen[str]:
    command = [sys.executable, "-c", TASK, str(out), chunks, store, str(pause)]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def files_of(out: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in sorted((out / "chunks").iterdir())}


def run(out: Path, **options: Any) -> sweep.SweepResult:
    return sweep.run(GRID, STUDY, out=out, **{"chunk_rows": ROWS, **options})


# ---- shares -----------------------------------------------------------------------------------------


@pytest.mark.parametrize("store", STORES)
def test_four_processes_write_the_bytes_of_one(store: str, tmp_path: Path) -> None:
    run(tmp_path / "one", store=store)
    tasks = [task(tmp_path / "four", f"{number}/4", store) for number in (1, 2, 3, 4)]
    for each in tasks:
        _, errors = each.communicate(timeout=PATIENCE)
        assert each.returncode == 0, errors
    assert files_of(tmp_path / "four") == files_of(tmp_path / "one")
    assert len(files_of(tmp_path / "four")) == CHUNKS
    assert not (tmp_path / "four" / ".lock").exists()
    seen: list[tuple[int, int]] = []
    whole = run(tmp_path / "four", progress=lambda done, total: seen.append((done, total)))
    assert seen == [(1000, 1000)]
    assert whole.complete


@pytest.mark.skipif(sys.platform == "win32", reason="signals and locks of files are those of Unix")
def test_killed_process_resumes_its_share_and_the_others_do_not_notice(tmp_path: Path) -> None:
    out = tmp_path / "out"
    first = task(out, "0:10", pause=0.05)
    assert first.stdout is not None
    while not first.stdout.readline().startswith("100 "):
        assert first.poll() is None
    os.kill(first.pid, signal.SIGKILL)
    first.communicate()
    second = task(out, "10:20", pause=0.1)
    assert second.stdout is not None
    second.stdout.readline()
    # What a process leaves behind that dies in the middle of a write.
    (out / "chunks" / ".chunk-00000005.npz.abc").write_bytes(b"half")
    (out / "chunks" / ".chunk-00000015.npz.abc").write_bytes(b"half")
    kept = {name for name in files_of(out) if name.startswith("chunk-0000000")}
    assert 2 <= len(kept) < 10
    again = task(out, "0:10")
    text, errors = again.communicate(timeout=PATIENCE)
    assert again.returncode == 0, errors
    assert text.splitlines()[0] == f"{ROWS * len(kept)} 500"
    assert (out / "chunks" / ".chunk-00000015.npz.abc").exists()
    assert not (out / "chunks" / ".chunk-00000005.npz.abc").exists()
    _, errors = second.communicate(timeout=PATIENCE)
    assert second.returncode == 0, errors
    assert run(out).complete
    assert files_of(out) == files_of(run(tmp_path / "one").folder or tmp_path)


@pytest.mark.skipif(sys.platform == "win32", reason="folders are not locked there")
def test_shares_that_overlap_and_whole_runs_are_refused(tmp_path: Path) -> None:
    out = tmp_path / "out"
    child = task(out, "4:12", pause=5.0)
    assert child.stdout is not None
    child.stdout.readline()
    try:
        for chunks in ("0:5", "11:20", "6:7", "2/4", "1/1"):
            with pytest.raises(sweep.SweepError, match=r"another process is writing some of the chunks \d+:\d+ into"):
                run(out, chunks=chunks)
        with pytest.raises(sweep.SweepError, match="another process is writing into"):
            run(out)
        before = run(out, chunks="0:4")
        assert {0, 1, 2, 3} <= set(before.finished)
        assert run(out, chunks=range(12, 20)).finished[-8:] == tuple(range(12, 20))
        assert (out / ".lock").exists()
    finally:
        child.kill()
        child.communicate()
    assert run(out).complete


def test_processes_that_begin_together_make_one_sweep(tmp_path: Path) -> None:
    for turn in range(3):
        out = tmp_path / str(turn)
        tasks = [task(out, f"{number}:{number + 1}") for number in range(4)]
        for each in tasks:
            _, errors = each.communicate(timeout=PATIENCE)
            assert each.returncode == 0, errors
        assert sweep.open(out).finished == (0, 1, 2, 3)
        assert sorted(path.name for path in out.iterdir()) == ["chunks", "sweep.json"]


@pytest.mark.parametrize("parts", [1, 3, 7, 20, 33])
def test_parts_are_all_chunks_once(parts: int) -> None:
    shares = [checked_share(f"{number}/{parts}") for number in range(1, parts + 1)]
    found = [index for share in shares if share is not None for index in share.of(CHUNKS)]
    assert found == list(range(CHUNKS))


def test_a_part_without_chunks_does_nothing(tmp_path: Path) -> None:
    run(tmp_path, chunks="0:1")
    before = files_of(tmp_path)
    assert run(tmp_path, chunks="1/500").finished == (0,)
    assert files_of(tmp_path) == before


def test_parts_cut_a_small_sweep_into_enough_chunks(tmp_path: Path) -> None:
    result = sweep.run(GRID, STUDY, out=tmp_path, chunks="2/4")
    assert result.chunk_count == 4
    assert result.finished == (1,)
    assert sweep.estimate(GRID, STUDY, chunks="2/4").chunk_count == 1


@pytest.mark.parametrize(
    ("chunks", "words"),
    [
        ("0:21", r"end at 20 at most, got '0:21'; the sweep has the chunks 0:20"),
        ("5:5", "end behind its start"),
        ("0/4", "count parts from 1"),
        ("5/4", "count parts from 1"),
        ("1/9999999", "count parts from 1"),
        ("half", 'be a range, "0:8" or "2/16"'),
        ("-1:4", 'be a range, "0:8" or "2/16"'),
        (3, 'be a range, "0:8" or "2/16"'),
        (range(0), "not empty"),
        (range(0, 8, 2), "steps of 1"),
        (range(-4, 2), "upward"),
    ],
)
def test_share_that_is_none_is_refused(chunks: Any, words: str, tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError, match=words):
        run(tmp_path, chunks=chunks)


def test_share_and_store_need_a_folder() -> None:
    for options in ({"chunks": "0:1"}, {"store": "parquet"}):
        with pytest.raises(InvalidParameterError, match="None without a folder"):
            sweep.run(GRID, STUDY, **options)  # type: ignore[arg-type]  # options of run


# ---- chunks in Parquet ------------------------------------------------------------------------------


def test_parquet_chunks_hold_the_bits_of_npz_in_less_space(tmp_path: Path) -> None:
    design = sweep.Grid([sweep.Axis(name=each.name, low=each.low, high=each.high, points=200) for each in GRID.axes])
    npz, parquet = (sweep.run(design, STUDY, out=tmp_path / store, store=store) for store in STORES)
    for column in npz.columns:
        np.testing.assert_array_equal(npz[column.name], parquet[column.name])
        assert npz[column.name].dtype == parquet[column.name].dtype
    sizes = [sum(map(len, files_of(tmp_path / store).values())) for store in STORES]
    assert sizes[0] > 1.4 * sizes[1]


def test_parquet_chunks_are_read_by_other_programs(tmp_path: Path) -> None:
    result = run(tmp_path, store="parquet")
    frame = polars.read_parquet(tmp_path / "chunks" / "*.parquet")
    assert frame.shape == (1000, len(result.columns))
    np.testing.assert_array_equal(frame["hic15"].to_numpy(), result["hic15"])
    assert frame["status"].cast(polars.String).to_list() == result["status"].tolist()
    import pyarrow.parquet as pq

    schema = pq.read_schema(tmp_path / "chunks" / "chunk-00000000.parquet")
    assert schema.field("peak_contact_force").metadata == {b"units": b"N"}


def test_every_damage_to_a_parquet_chunk_is_found(tmp_path: Path) -> None:
    whole = run(tmp_path, store="parquet").to_numpy()
    file = tmp_path / "chunks" / "chunk-00000007.parquet"
    content, draws = file.read_bytes(), np.random.default_rng(6)
    spoiled = [content[:-1], content[: len(content) // 2], b"", content + b"x", content + bytes(30)]
    for _ in range(150):
        changed = bytearray(content)
        changed[int(draws.integers(len(content)))] ^= 1 << int(draws.integers(8))
        spoiled.append(bytes(changed))
    refused = 0
    for each in spoiled:
        file.write_bytes(each)
        try:
            found = sweep.open(tmp_path).to_numpy()
        except sweep.SweepError:
            refused += 1
            continue
        for name, values in whole.items():
            np.testing.assert_array_equal(found[name], values)
    assert refused > 100
    file.write_bytes(content[:-1])
    with pytest.warns(sweep.SweepWarning, match=r"chunk-00000007\.parquet is damaged"):
        run(tmp_path)
    assert file.read_bytes() == content


def test_chunk_of_another_place_is_refused(tmp_path: Path) -> None:
    run(tmp_path, store="parquet")
    chunks = tmp_path / "chunks"
    (chunks / "chunk-00000003.parquet").write_bytes((chunks / "chunk-00000002.parquet").read_bytes())
    with pytest.raises(sweep.SweepError, match="belongs to another chunk"):
        sweep.open(tmp_path)["hic15"]


def test_folder_keeps_its_files(tmp_path: Path) -> None:
    run(tmp_path, store="parquet", chunks="0:3")
    assert run(tmp_path).complete
    assert {Path(name).suffix for name in files_of(tmp_path)} == {".parquet"}
    with pytest.raises(sweep.SweepError, match="holds chunks in parquet files, not npz; leave store out"):
        run(tmp_path, store="npz")
    with pytest.raises(InvalidParameterError, match="store must be one of"):
        run(tmp_path, store="parket")


def test_parquet_without_pyarrow_names_the_extra(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "pyarrow", None)
    with pytest.raises(MissingExtraError, match=r"pip install pyarrow"):
        run(tmp_path, store="parquet")
    assert not (tmp_path / "sweep.json").exists()
    assert run(tmp_path).complete


# ---- lazy datasets ----------------------------------------------------------------------------------


@pytest.mark.parametrize("store", STORES)
def test_lazy_dataset_is_the_eager_one_and_reads_what_it_needs(
    store: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    result = run(tmp_path, store=store)
    eager, lazy = result.to_xarray(), result.to_xarray(lazy=True)
    xarray.testing.assert_identical(lazy.compute(), eager)
    xarray.testing.assert_identical(lazy.isel(foam_damping=[3, 20]).compute(), eager.isel(foam_damping=[3, 20]))
    read, seen = type(result._store).read, []

    def counted(self: Any, index: int, names: tuple[str, ...]) -> Any:
        seen.append((index, names))
        return read(self, index, names)

    monkeypatch.setattr(type(result._store), "read", counted)
    lazy = result.to_xarray(["hic15", "status"], lazy=True)
    assert seen == []
    lazy["hic15"].isel(foam_stiffness=0).compute()
    assert set(seen) == {(0, ("hic15",))}


def test_lazy_dataset_of_a_sample_and_of_cases() -> None:
    study = sweep.NavigationStudy(scenarios={name: scenarios.configuration(name) for name in ("c1", "c2")})
    design = sweep.Sobol([sweep.Axis(name="detour_gain", low=10.0, high=50.0)], 16)
    result = sweep.run(design, study, chunk_rows=5)
    lazy = result.to_xarray(lazy=True)
    assert lazy["outcome"].chunks is not None
    xarray.testing.assert_identical(lazy.compute(), result.to_xarray())
    assert "arrived" in lazy["outcome"].values


def test_lazy_dataset_without_dask_names_the_extra(monkeypatch: pytest.MonkeyPatch) -> None:
    result = sweep.run(GRID, STUDY)
    monkeypatch.setitem(sys.modules, "dask.array", None)
    with pytest.raises(MissingExtraError, match=r"pip install .dask\[distributed\]"):
        result.to_xarray(lazy=True)
    with pytest.raises(InvalidParameterError, match="lazy must be True or False"):
        result.to_xarray(lazy=1)  # type: ignore[arg-type]  # on purpose


# ---- estimates --------------------------------------------------------------------------------------


@pytest.mark.parametrize("store", STORES)
def test_estimate_is_near_what_is_written(store: str, tmp_path: Path) -> None:
    found = sweep.estimate(GRID, STUDY, store=store, chunk_rows=ROWS)  # type: ignore[arg-type]  # a word of the list
    run(tmp_path, store=store)
    written = sum(map(len, files_of(tmp_path).values()))
    assert (found.rows, found.chunk_count, found.chunk_rows) == (1000, CHUNKS, ROWS)
    assert found.bytes == pytest.approx(written, rel=0.02 if store == "npz" else 0.1)
    assert str(found).startswith("1,000 rows in 20 chunks, about ")


def test_estimated_time_grows_with_the_rows_and_is_near_the_measured_one() -> None:
    def slow(speed: np.ndarray) -> dict[str, np.ndarray]:
        time.sleep(0.004 * len(speed))
        return {"y": speed}

    study = sweep.FunctionStudy(function=slow, results=["y"])
    design = sweep.Grid([sweep.Axis(name="speed", low=0.0, high=1.0, points=5000)])
    found = sweep.estimate(design, study)
    assert found.seconds == pytest.approx(20.0, rel=0.5)
    assert sweep.estimate(design, study, chunks="1/4").seconds == pytest.approx(5.0, rel=0.5)
    assert found.measured_rows < 1000
    # One chunk of 20 s; of 400 s a stop loses minutes, which is said.
    assert "a stop loses" not in str(found)
    longer = sweep.estimate(sweep.Grid([sweep.Axis(name="speed", low=0.0, high=1.0, points=100_000)]), study)
    assert longer.chunk_seconds == pytest.approx(longer.seconds / longer.chunk_count)
    assert re.search(r"a stop loses up to \S+ min, less with a smaller chunk_rows$", str(longer))


# ---- on the command line ----------------------------------------------------------------------------


@pytest.fixture
def study(tmp_path: Path) -> str:
    file = tmp_path / "study.toml"
    file.write_text(FILE, encoding="utf-8")
    return str(file)


def test_dry_run_shows_rows_size_and_time_and_writes_nothing(
    study: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before = sorted(tmp_path.iterdir())
    assert main(["sweep", study, "--out", str(tmp_path / "out"), "--dry-run", "--store", "parquet"]) == 0
    text = capsys.readouterr().out
    assert re.search(r"^rows     1,000 of \d+ columns besides the axes$", text, re.MULTILINE)
    assert re.search(r"^chunks   20 of at most 50 rows$", text, re.MULTILINE)
    assert re.search(r"^size     about \S+ kB in parquet files$", text, re.MULTILINE)
    assert re.search(r"^time     about \S+ s of computing in one process, from \d+ measured rows$", text, re.MULTILINE)
    assert sorted(tmp_path.iterdir()) == before


def test_dry_run_prints_the_doubts_of_the_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file, out = tmp_path / "study.toml", str(tmp_path / "out")
    told: list[list[str]] = []
    for speed, code in (("1250.0", 4), ("0.4", 0)):
        text = FILE.replace("closing_speed = 1.25", f"closing_speed = {speed}")
        file.write_text(text.replace("chunk_rows", "# chunk_rows"), encoding="utf-8")
        for options in (["--dry-run"], []):
            assert main(["sweep", str(file), "--out", out + speed, "--strict", *options]) == code
            told.append([line for line in capsys.readouterr().err.splitlines() if "warning: " in line])
    assert told[0] == told[1]
    assert "closing_speed is 1250 m/s" in told[0][0]
    assert told[2] == told[3] == []


def test_dry_run_says_that_there_is_no_room(
    study: str, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    for free, told in ((1_000, True), (10**9, False)):
        monkeypatch.setattr("hrsafety.cli.sweep.command.free_space", lambda _path, free=free: free)
        assert main(["sweep", study, "--out", str(tmp_path / "out"), "--dry-run"]) == 0
        assert ("the sweep would be refused" in capsys.readouterr().out) == told


def test_commands_with_shares_fill_a_folder_and_one_without_writes_the_page(
    study: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "out")
    assert main(["sweep", study, "--out", out, "--chunks", "2/2"]) == 0
    assert "chunks   2/2 finished; 10 of 20 chunks are in" in capsys.readouterr().out
    assert not (tmp_path / "out" / "summary.html").exists()
    assert main(["sweep", study, "--out", out, "--chunks", "0:9"]) == 0
    assert "19 of 20 chunks" in capsys.readouterr().out
    assert main(["sweep", study, "--out", out, "--chunks", "9:10"]) == 0
    assert "rows 1,000 in 20 chunks" in " ".join(capsys.readouterr().out.split())
    assert (tmp_path / "out" / "summary.html").exists()


@pytest.mark.skipif(sys.platform == "win32", reason="a shell script")
def test_job_array_of_four_tasks_fills_one_folder(study: str, tmp_path: Path) -> None:
    script = Path(__file__).resolve().parents[3] / "examples" / "sweep_array.sh"
    out, programs = tmp_path / "out", Path(sys.executable).parent
    common = {**os.environ, "PATH": f"{programs}:{os.environ['PATH']}", "STUDY": study, "OUT": str(out), "PARTS": "4"}
    tasks = [
        subprocess.Popen(
            ["sh", str(script)],
            env={**common, "SLURM_ARRAY_TASK_ID": str(number), "SLURM_CPUS_PER_TASK": "1"},
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        for number in (1, 2, 3, 4)
    ]
    for number, each in enumerate(tasks, start=1):
        text, _ = each.communicate(timeout=PATIENCE)
        assert each.returncode == 0, text
        assert f"{number}/4 finished" in text or "1,000 in 20 chunks" in text
    assert main(["sweep", study, "--out", str(tmp_path / "one"), "--store", "parquet"]) == 0
    assert files_of(out) == files_of(tmp_path / "one")
    assert main(["sweep", study, "--out", str(out)]) == 0
    assert (out / "summary.html").exists()


def test_outputs_replace_those_of_the_file(study: str, tmp_path: Path) -> None:
    assert main(["sweep", study, "--out", str(tmp_path / "out"), "--outputs", "hic15, status"]) == 0
    names = [column.name for column in sweep.open(tmp_path / "out").columns]
    assert names == ["foam_stiffness", "foam_damping", "hic15", "status"]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--outputs", "hic51"), r"--outputs must be one of .*did you mean \"hic15\""),
        (("--chunks", "0:99"), r"--chunks must end at 20 at most"),
        (("--chunks", "0:99", "--dry-run"), r"--chunks must end at 20 at most"),
        (("--chunks", "x"), r'--chunks must be a range, "0:8" or "2/16"'),
        (("--store", "zarr"), "invalid choice: 'zarr'"),
    ],
)
def test_wrong_options_name_the_option(
    options: tuple[str, ...], words: str, study: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    try:
        code = main(["sweep", study, "--out", str(tmp_path / "out"), *options])
    except SystemExit as stop:
        code = int(str(stop.code))
    assert code == 2
    assert re.search(words, capsys.readouterr().err)
