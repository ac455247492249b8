"""What happens to files: damaged ones, a full disk, two writers at once, bytes behind the end."""

from __future__ import annotations

import errno
import os
import pickle
import stat
import subprocess
import sys
import threading
import wave
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
import pytest

from hrsafety import InvalidParameterError, reactive, sweep
from hrsafety import navigation as nav
from hrsafety._atomic import create_file, only_writer, write_file
from hrsafety.cli import main
from hrsafety.errors import FolderInUseError, StorageError

SCENE = nav.Scenario(
    start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[nav.Disc(center=(2.45, 0.595), radius=0.1)], time_limit=6.0
)
TINY: dict[str, Any] = {"grid": (3, 1, 1, 1), "refinements": 0, "local_starts": 0, "threads": 1}
AXIS = sweep.Axis(name="x", low=0.0, high=1.0, points=40)


def squared(x: np.ndarray) -> dict[str, np.ndarray]:
    return {"y": x * x}


def swept(out: Path) -> sweep.SweepResult:
    study = sweep.FunctionStudy(function=squared, results=["y"])
    return sweep.run(sweep.Grid([AXIS]), study, out=out, chunk_rows=8)


@pytest.fixture(scope="module")
def checkpoint(tmp_path_factory: pytest.TempPathFactory) -> bytes:
    file = tmp_path_factory.mktemp("search") / "search.checkpoint"
    nav.optimize_gains([SCENE], checkpoint=file, **TINY)
    return file.read_bytes()


def full(_file: BinaryIO, *_: object) -> None:
    raise OSError(errno.ENOSPC, "No space left on device")


# ---- damage ---------------------------------------------------------------------------------


def test_damaged_checkpoints_are_refused_or_whole(checkpoint: bytes, tmp_path: Path) -> None:
    file = tmp_path / "search.checkpoint"
    draws = np.random.default_rng(4)
    cut = [checkpoint[:length] for length in range(0, len(checkpoint), max(len(checkpoint) // 100, 1))]
    flipped = []
    for _ in range(300):
        changed = bytearray(checkpoint)
        changed[int(draws.integers(len(changed)))] ^= 1 << int(draws.integers(8))
        flipped.append(bytes(changed))
    refused = 0
    for content in (*cut, *flipped):
        file.write_bytes(content)
        try:
            nav.optimize_gains([SCENE], checkpoint=file, **TINY)
        except InvalidParameterError as error:
            refused += error.argument == "checkpoint"
    assert refused >= len(cut)


def test_wav_with_a_chunk_longer_than_the_file_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "three.wav"
    with wave.open(str(path), "wb") as file:
        file.setnchannels(3)
        file.setsampwidth(2)
        file.setframerate(48000)
        file.writeframes(np.arange(-60, 60, dtype="<i2").tobytes())
    content = path.read_bytes()
    draws = np.random.default_rng(5)
    for place in range(4, 44):
        for value in (0, 1, 127, 255, int(draws.integers(256))):
            path.write_bytes(content[:place] + bytes([value]) + content[place + 1 :])
            try:
                reactive.read_recording(path)
            except InvalidParameterError:
                continue


@pytest.mark.parametrize("behind", [b"x", b"\0" * 30, b"PK\x05\x06" + b"\0" * 18])
def test_bytes_behind_a_chunk_are_noticed(behind: bytes, tmp_path: Path) -> None:
    whole = swept(tmp_path)["y"]
    file = tmp_path / "chunks" / "chunk-00000002.npz"
    file.write_bytes(file.read_bytes() + behind)
    with pytest.warns(sweep.SweepWarning, match=r"chunk-00000002\.npz is damaged"):
        again = swept(tmp_path)
    np.testing.assert_array_equal(again["y"], whole)


# ---- files of several processes ------------------------------------------------------------


@pytest.mark.parametrize("links", [True, False])
def test_file_that_is_there_stays(links: bool, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_links(*_: object) -> None:
        raise OSError(errno.EPERM, "Operation not permitted")

    if not links:
        monkeypatch.setattr(os, "link", no_links)
    for text in ("first", "second"):
        create_file(tmp_path / "a.json", text)
    assert (tmp_path / "a.json").read_text(encoding="utf-8") == "first"
    assert [path.name for path in tmp_path.iterdir()] == ["a.json"]


@pytest.mark.skipif(sys.platform == "win32", reason="files are not locked there")
def test_parts_of_a_lock_are_held_by_several_processes(tmp_path: Path) -> None:
    lock = tmp_path / ".lock"
    child = holder(lock, "(0, 5)")
    try:
        with only_writer(lock, FolderInUseError, (5, 5)):
            assert lock.exists()
        assert lock.exists()
        with (
            pytest.raises(FolderInUseError, match=r"another process is writing some of the chunks 4:6 into"),
            only_writer(lock, FolderInUseError, (4, 2)),
        ):
            pass
        with (
            pytest.raises(FolderInUseError, match="another process is writing into"),
            only_writer(lock, FolderInUseError),
        ):
            pass
    finally:
        child.kill()
        child.communicate()
    with only_writer(lock, FolderInUseError, (4, 2)):
        pass
    assert not lock.exists()


# ---- a full disk ----------------------------------------------------------------------------


def test_full_disk_names_the_chunk_what_is_kept_and_how_to_resume(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from hrsafety.sweep import chunk_files

    write = chunk_files.write_archive

    def fills_up(file: BinaryIO, columns: Any) -> None:
        if len(list((tmp_path / "chunks").glob("chunk-*.npz"))) >= 2:
            full(file)
        write(file, columns)

    with monkeypatch.context() as patched:
        patched.setattr(chunk_files, "write_archive", fills_up)
        with pytest.raises(StorageError, match=r"chunk-0000.*No space left.*2 finished chunks.*resumes") as caught:
            swept(tmp_path)
    assert str(pickle.loads(pickle.dumps(caught.value))) == str(caught.value)
    assert swept(tmp_path).complete


def test_full_disk_leaves_the_last_checkpoint(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from hrsafety.navigation.gains import checkpoint

    monkeypatch.setattr(checkpoint, "write_file", full)
    file = tmp_path / "search.checkpoint"
    with pytest.raises(StorageError, match=r"search\.checkpoint cannot be written \(No space left on device\)"):
        nav.optimize_gains([SCENE], checkpoint=file, **TINY)
    assert list(tmp_path.iterdir()) == []


# ---- two writers ----------------------------------------------------------------------------

STUDY = """
scenarios = ["c1"]
[search]
grid = [2, 2, 2, 2]
refinements = 0
local_starts = 0
"""

HOLD = """
import sys, time
from pathlib import Path
from hrsafety._atomic import only_writer
with only_writer(Path(sys.argv[1]), RuntimeError, eval(sys.argv[2])):
    print("held", flush=True)
    time.sleep(60)
"""


def holder(lock: Path, part: str = "None") -> subprocess.Popen[str]:
    child = subprocess.Popen([sys.executable, "-c", HOLD, str(lock), part], stdout=subprocess.PIPE, text=True)
    assert child.stdout is not None
    assert child.stdout.readline() == "held\n"
    return child


def test_optimize_refuses_a_folder_that_another_run_writes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    study, out = tmp_path / "study.toml", tmp_path / "gains"
    study.write_text(STUDY, encoding="utf-8")
    out.mkdir()
    child = holder(out / ".lock")
    try:
        assert main(["optimize", str(study), "--out", str(out)]) == 2
        assert "another process is writing into" in capsys.readouterr().err
    finally:
        child.kill()
        child.communicate()
    assert main(["optimize", str(study), "--out", str(out)]) == 0
    assert not (out / ".lock").exists()


def test_two_searches_do_not_share_a_checkpoint(tmp_path: Path) -> None:
    child = holder(tmp_path / ".search.checkpoint.lock")
    try:
        with pytest.raises(FolderInUseError, match="another process is writing"):
            nav.optimize_gains([SCENE], checkpoint=tmp_path / "search.checkpoint", **TINY)
    finally:
        child.kill()
        child.communicate()
    nav.optimize_gains([SCENE], checkpoint=tmp_path / "search.checkpoint", **TINY)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no such files")
def test_what_is_no_regular_file_is_written_to_and_stays(tmp_path: Path) -> None:
    pipe, found = tmp_path / "pipe", []
    os.mkfifo(pipe)
    reader = threading.Thread(target=lambda: found.append(pipe.read_bytes()))
    reader.start()
    write_file(pipe, "some text")
    reader.join(10.0)
    assert found == [b"some text"]
    assert stat.S_ISFIFO(pipe.stat().st_mode)
    assert list(tmp_path.iterdir()) == [pipe]


@pytest.mark.skipif(not Path("/dev/full").is_char_device(), reason="no such device")
def test_a_device_stays_a_device() -> None:
    with pytest.raises(OSError, match="/dev/full"):
        write_file(Path("/dev/full"), "x" * 100_000)
    write_file(Path("/dev/null"), "some text")
    assert all(Path(device).is_char_device() for device in ("/dev/full", "/dev/null"))


def test_a_link_stays_and_leads_to_what_was_written(tmp_path: Path) -> None:
    (tmp_path / "folder").mkdir()
    for target in (tmp_path / "folder" / "old", tmp_path / "folder" / "new"):
        link = tmp_path / f"to_{target.name}"
        link.symlink_to(target)
        if target.name == "old":
            target.write_text("before")
        write_file(link, "after")
        assert link.is_symlink()
        assert target.read_text() == "after"
