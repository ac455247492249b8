"""Sweeps that are stopped: by kill, by Ctrl-C, by damage to their files; and folders of others."""

from __future__ import annotations

import json
import math
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

from api.interrupting import LISTEN
from hrsafety import impact, sweep

ROWS = 1_000_000
CHUNKS = 50
FEW = 10_000
# Of the process of a sweep of that many rows, with Python, numpy and everything, in MB.
MOST_MEMORY = 300.0
# A million impacts take some seconds; a machine that is busy gets a minute.
PATIENCE = 60.0

# The child waits a little after each chunk when it is to be killed, so that the kill comes in the middle.
CHILD = """
import resource, sys, time
from pathlib import Path
from hrsafety import impact, sweep

def memory():
    # On Linux ru_maxrss starts with the memory of the process that started this one.
    status = Path("/proc/self/status")
    if status.exists():
        return float(status.read_text().split("VmHWM:")[1].split()[0]) / 1e3
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e3

out, pause, points = sys.argv[1], float(sys.argv[2]), int(sys.argv[3])
design = sweep.Grid([
    sweep.Axis(name="foam_stiffness", low=5e3, high=60e3, points=points),
    sweep.Axis(name="foam_damping", low=0.0, high=150.0, points=points),
])
study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, head=impact.Head.minimum(), fixed={"closing_speed": 1.25})
rows = points * points // 50
result = sweep.run(design, study, out=out, chunk_rows=rows, progress=lambda done, total: time.sleep(pause))
assert result.complete and len(result) == points * points
print(memory())
"""


def started(out: Path, pause: float = 0.0, rows: int = ROWS) -> subprocess.Popen[str]:
    command = [sys.executable, "-W", "error", "-c", LISTEN + CHILD, str(out), str(pause), str(math.isqrt(rows))]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finished(out: Path, rows: int = ROWS) -> float:
    """Run the sweep to its end and return its memory in MB."""
    child = started(out, rows=rows)
    text, errors = child.communicate(timeout=PATIENCE)
    assert child.returncode == 0, errors
    return float(text)


def chunk_files(out: Path) -> dict[str, tuple[int, int]]:
    """Return what changes if a file is written again: inode and time."""
    states = {path.name: path.stat() for path in (out / "chunks").glob("chunk-*.npz")}
    return {name: (state.st_ino, state.st_mtime_ns) for name, state in states.items()}


@pytest.fixture(scope="module")
def uninterrupted(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, float]:
    out = tmp_path_factory.mktemp("sweeps") / "uninterrupted"
    return out, finished(out)


def test_memory_of_a_million_rows_stays_small(uninterrupted: tuple[Path, float]) -> None:
    _, memory = uninterrupted
    assert 10.0 < memory < MOST_MEMORY


def test_kill_in_the_middle_of_a_million_rows_loses_and_repeats_nothing(
    uninterrupted: tuple[Path, float], tmp_path: Path
) -> None:
    whole, _ = uninterrupted
    out = tmp_path / "killed"
    for least in (5, 15):  # killed twice
        child = started(out, pause=0.02)
        deadline = time.monotonic() + PATIENCE
        while not (out / "chunks").is_dir() or len(chunk_files(out)) < least:
            assert child.poll() is None, child.communicate()
            assert time.monotonic() < deadline
            time.sleep(0.002)
        child.send_signal(signal.SIGKILL)
        child.communicate()
        assert child.returncode == -signal.SIGKILL
        kept = chunk_files(out)
        assert least <= len(kept) < CHUNKS
    memory = finished(out)
    assert memory < MOST_MEMORY
    after = chunk_files(out)
    assert len(after) == CHUNKS
    assert {name: after[name] for name in kept} == kept
    for name in after:
        assert (out / "chunks" / name).read_bytes() == (whole / "chunks" / name).read_bytes()
    assert sorted(path.name for path in (out / "chunks").iterdir()) == sorted(after)


# ---- small sweeps ---------------------------------------------------------------------------

GRID = sweep.Grid([sweep.Axis(name="closing_speed", low=0.2, high=2.0, points=100)])
STUDY = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())


def small(out: Path, **options: object) -> sweep.SweepResult:
    return sweep.run(GRID, STUDY, out=out, **{"chunk_rows": 10, **options})  # type: ignore[arg-type]  # options of run


def test_ctrl_c_keeps_the_finished_chunks_and_says_so(tmp_path: Path) -> None:
    def stop(done: int, _total: int) -> None:
        if done == 40:
            raise KeyboardInterrupt

    with pytest.raises(sweep.SweepInterrupted, match=r"stopped with 40 of 100 rows finished; they are in .*, the same"):
        small(tmp_path, progress=stop)
    kept = chunk_files(tmp_path)
    assert sweep.open(tmp_path).finished == (0, 1, 2, 3)
    seen: list[int] = []
    small(tmp_path, progress=lambda done, _total: seen.append(done))
    assert seen == [40, 50, 60, 70, 80, 90, 100]
    assert {name: chunk_files(tmp_path)[name] for name in kept} == kept
    with pytest.raises(KeyboardInterrupt, match="lost without a folder"):
        sweep.run(GRID, STUDY, chunk_rows=10, progress=stop)


def test_sigint_stops_a_child_with_one_clear_message(tmp_path: Path) -> None:
    child = started(tmp_path / "out", pause=0.05, rows=FEW)
    while not (tmp_path / "out" / "chunks").is_dir() or len(chunk_files(tmp_path / "out")) < 2:
        time.sleep(0.005)
    child.send_signal(signal.SIGINT)
    _, errors = child.communicate(timeout=PATIENCE)
    assert child.returncode != 0
    assert "SweepInterrupted: sweep stopped with" in errors.splitlines()[-1]


def test_finished_sweep_computes_nothing_again(tmp_path: Path) -> None:
    first = small(tmp_path)
    kept = chunk_files(tmp_path)
    again = small(tmp_path, chunk_rows=None)
    assert chunk_files(tmp_path) == kept
    assert again.provenance == first.provenance


@pytest.mark.parametrize("place", [0, 40, 200, 1000, -3000, -30, -1])
def test_damaged_chunk_is_found_and_computed_again(tmp_path: Path, place: int) -> None:
    small(tmp_path)
    file = tmp_path / "chunks" / "chunk-00000003.npz"
    whole = file.read_bytes()
    spoiled = bytearray(whole)
    spoiled[place] ^= 0xFF
    file.write_bytes(bytes(spoiled))
    try:
        columns = sweep.open(tmp_path).to_numpy()
    except sweep.SweepError as error:
        message = str(error)
    else:  # a byte that no reader looks at
        expected = sweep.run(GRID, STUDY, chunk_rows=10).to_numpy()
        for name, values in columns.items():
            np.testing.assert_array_equal(values, expected[name])
        return
    assert str(file) in message
    with pytest.warns(sweep.SweepWarning, match=r"chunk-00000003\.npz is damaged and is computed again"):
        small(tmp_path)
    assert file.read_bytes() == whole


def test_no_flipped_bit_changes_a_number(tmp_path: Path) -> None:
    whole = small(tmp_path).to_numpy()
    file = tmp_path / "chunks" / "chunk-00000000.npz"
    content = file.read_bytes()
    found = 0
    for place in range(0, len(content), 13):
        spoiled = bytearray(content)
        spoiled[place] ^= 1 << (place % 8)
        file.write_bytes(bytes(spoiled))
        try:
            columns = sweep.open(tmp_path).to_numpy()
        except sweep.SweepError:
            found += 1
            continue
        for name, values in columns.items():
            np.testing.assert_array_equal(values, whole[name])
    assert found > 0.6 * len(range(0, len(content), 13))


def test_truncated_and_exchanged_chunks_are_found(tmp_path: Path) -> None:
    small(tmp_path)
    expected = sweep.open(tmp_path).to_numpy()
    chunks = tmp_path / "chunks"
    (chunks / "chunk-00000001.npz").write_bytes((chunks / "chunk-00000001.npz").read_bytes()[:500])
    (chunks / "chunk-00000002.npz").write_bytes((chunks / "chunk-00000004.npz").read_bytes())
    (chunks / "chunk-00000005.npz").write_bytes(b"")
    (chunks / "chunk-00000006.npz").unlink()
    with pytest.raises(sweep.SweepError, match="is damaged"):
        sweep.open(tmp_path).to_numpy()
    with pytest.warns(sweep.SweepWarning, match="is damaged") as warned:
        again = small(tmp_path)
    assert len(warned) == 3
    for name, values in again.to_numpy().items():
        np.testing.assert_array_equal(values, expected[name])


def test_leftovers_of_a_killed_run_are_removed(tmp_path: Path) -> None:
    small(tmp_path)
    (tmp_path / "chunks" / ".chunk-00000003.npz.abcdef").write_bytes(b"half a chunk")
    small(tmp_path)
    assert len(list((tmp_path / "chunks").iterdir())) == 10


# ---- folders of others ----------------------------------------------------------------------


def test_folder_of_another_sweep_is_refused_naming_what_differs(tmp_path: Path) -> None:
    small(tmp_path)
    kept = chunk_files(tmp_path)
    other_grid = sweep.Grid([sweep.Axis(name="closing_speed", low=0.2, high=2.5, points=100)])
    other_study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_2, foam=impact.FOAM_1, head=impact.Head.minimum())
    with pytest.raises(sweep.SweepError, match=r"design\.axes\[0\]\.high is 2\.0 there and 2\.5 here"):
        sweep.run(other_grid, STUDY, out=tmp_path, chunk_rows=10)
    with pytest.raises(sweep.SweepError, match=r"study\.manipulator\.mass is .* there and .* here"):
        sweep.run(GRID, other_study, out=tmp_path, chunk_rows=10)
    with pytest.raises(sweep.SweepError, match=r"chunk_rows is 10 there and 20 here"):
        small(tmp_path, chunk_rows=20)
    with pytest.raises(sweep.SweepError, match="holds a sweep already"):
        small(tmp_path, resume=False)
    assert chunk_files(tmp_path) == kept


def test_other_version_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    small(tmp_path)
    monkeypatch.setattr("hrsafety.sweep.running.__version__", "99.0")
    with pytest.raises(sweep.SweepError, match=r'version is ".*" there and "99\.0" here'):
        small(tmp_path)


def test_seed_and_parameters_tell_sweeps_apart(tmp_path: Path) -> None:
    axes = [sweep.Axis(name="closing_speed", low=0.2, high=2.0)]
    sweep.run(sweep.Sobol(axes, 16, seed=1), STUDY, out=tmp_path)
    with pytest.raises(sweep.SweepError, match=r"design\.seed is 1 there and 2 here"):
        sweep.run(sweep.Sobol(axes, 16, seed=2), STUDY, out=tmp_path)
    with pytest.raises(sweep.SweepError, match=r"design\.kind is"):
        sweep.run(sweep.LatinHypercube(axes, 16, seed=1), STUDY, out=tmp_path)


def test_manifest_that_was_changed_or_lost_is_refused(tmp_path: Path) -> None:
    small(tmp_path)
    manifest = tmp_path / "sweep.json"
    text = manifest.read_text(encoding="utf-8")
    changed = json.loads(text)
    changed["settings"]["chunk_rows"] = 5
    for content, words in (
        (json.dumps(changed), "was changed"),
        ("{", "cannot be read"),
        ("[]", "is not the manifest"),
    ):
        manifest.write_text(content, encoding="utf-8")
        with pytest.raises(sweep.SweepError, match=words):
            sweep.open(tmp_path)
        with pytest.raises(sweep.SweepError, match=words):
            small(tmp_path)
    manifest.unlink()
    with pytest.raises(sweep.SweepError, match=r"holds no sweep: sweep\.json is missing"):
        sweep.open(tmp_path)
    with pytest.raises(sweep.SweepError, match=r"holds chunks but no sweep\.json"):
        small(tmp_path)
    manifest.write_text(text, encoding="utf-8")
    assert small(tmp_path).complete


def test_time_of_creation_is_not_compared(tmp_path: Path) -> None:
    small(tmp_path)
    manifest = tmp_path / "sweep.json"
    content = json.loads(manifest.read_text(encoding="utf-8"))
    content["created"] = "1999-12-31T23:59:59+00:00"
    manifest.write_text(json.dumps(content), encoding="utf-8")
    assert small(tmp_path).provenance["created"] == "1999-12-31T23:59:59+00:00"


def test_two_runs_of_a_process_do_not_write_into_one_folder(tmp_path: Path) -> None:
    with pytest.raises(sweep.SweepError, match="another run of this process is writing into"):
        small(tmp_path, progress=lambda _done, _total: small(tmp_path / "." / ""))
    assert small(tmp_path).complete


@pytest.mark.skipif(sys.platform == "win32", reason="folders are not locked there")
def test_two_processes_do_not_write_into_one_folder(tmp_path: Path) -> None:
    out = tmp_path / "out"
    child = started(out, pause=0.05, rows=FEW)
    while not (out / "chunks").is_dir() or not chunk_files(out):
        time.sleep(0.005)
    other = started(out, rows=FEW)
    _, errors = other.communicate(timeout=PATIENCE)
    assert "another process is writing into" in errors.splitlines()[-1]
    os.kill(child.pid, signal.SIGKILL)
    child.communicate()
    assert finished(out, rows=FEW) > 0.0
