"""Animations show the run in its own time, whole or not at all."""

from __future__ import annotations

import stat
import sys

import numpy as np
import pytest

from api.plotted import DISC, LAW, PERSON, RECTANGLE, WALKING, crowd, made_up_run, scene
from hrsafety import navigation as nav
from hrsafety import plotting
from hrsafety.errors import HrsafetyError, InvalidParameterError

matplotlib = pytest.importorskip("matplotlib")
Image = pytest.importorskip("PIL.Image")


LARGEST_GIF = 3_000_000  # bytes, for a run of 15 s


@pytest.fixture(scope="module")
def run() -> nav.Trajectory:
    return nav.simulate(scene(PERSON, DISC, RECTANGLE), LAW)


def pictures_of(file) -> list[np.ndarray]:
    with Image.open(file) as picture:
        frames = []
        for index in range(picture.n_frames):
            picture.seek(index)
            frames.append(np.asarray(picture.convert("RGB")))
    return frames


def test_animation_shows_the_run_in_its_own_time(tmp_path, run):
    file = plotting.animate(run, tmp_path / "run.gif", frames_per_second=15)
    with Image.open(file) as picture:
        frames, durations = picture.n_frames, []
        for index in range(frames):
            picture.seek(index)
            durations.append(picture.info["duration"])
    assert frames > 5
    assert abs(sum(durations[:-1]) / 1000.0 - run.time[-1]) < 0.1  # one frame and the 10 ms of a GIF
    assert list(tmp_path.iterdir()) == [file]


def test_animation_of_a_long_run_in_a_crowd_stays_small(tmp_path):
    file = plotting.animate(made_up_run(*crowd(45), duration=15.0), tmp_path / "crowd.gif")
    assert file.stat().st_size < LARGEST_GIF
    assert len(pictures_of(file)) == 301


def test_who_is_absent_is_hidden_in_an_animation(tmp_path):
    slow = nav.Human(start=(1.0, 2.0), velocity=(0.06, 0.0), **WALKING)
    file = plotting.animate(made_up_run(slow), tmp_path / "run.gif", frames_per_second=2, regions=False)
    orange = np.array([0xD5, 0x5E, 0x00])
    shown = [bool((np.abs(frame - orange).sum(axis=2) < 30).any()) for frame in np.int64(pictures_of(file))]
    assert shown[:2] == [False, False]  # absent before 1 s
    assert all(shown[2:])


def test_speed_shortens_an_animation(tmp_path):
    lengths = []
    for speed in (1.0, 2.0):
        file = plotting.animate(made_up_run(), tmp_path / f"{speed}.gif", frames_per_second=10, speed=speed)
        lengths.append(len(pictures_of(file)))
    assert lengths == [56, 29]


@pytest.mark.parametrize(
    ("options", "named"),
    [
        ({"path": "run.avi"}, "path must end in .gif or .mp4"),
        ({"path": "nowhere/run.gif"}, "path must lie in a folder that exists"),
        ({"frames_per_second": 0}, "frames_per_second must be finite and positive"),
        ({"frames_per_second": np.nan}, "frames_per_second must be finite and positive"),
        ({"frames_per_second": 60}, "frames_per_second must be at most 50"),
        ({"speed": -1.0}, "speed must be finite and positive"),
        ({"speed": 1e-3}, "speed must be at least 0.0183 for at most 6000 frames"),
        ({"names": ["a", "b"]}, "names must be 1 strings"),
    ],
)
def test_animations_that_cannot_be_written_are_refused(tmp_path, options, named):
    path = tmp_path / options.pop("path", "run.gif")
    with pytest.raises(InvalidParameterError, match=named):
        plotting.animate(made_up_run(DISC), path, **options)
    assert not list(tmp_path.iterdir())


def test_an_animation_that_fails_leaves_an_older_file_alone(tmp_path, monkeypatch):
    file = tmp_path / "run.gif"
    file.write_bytes(b"older")
    made_up = made_up_run(DISC)

    def broken(*_arguments: object, **_options: object) -> None:
        raise OSError("disk full")

    monkeypatch.setattr(Image.Image, "save", broken)
    with pytest.raises(OSError, match="disk full"):
        plotting.animate(made_up, file, frames_per_second=2)
    assert file.read_bytes() == b"older"
    assert list(tmp_path.iterdir()) == [file]


def test_mp4_without_ffmpeg_says_so(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(plotting.MissingExtraError, match="ffmpeg"):
        plotting.animate(made_up_run(), tmp_path / "run.mp4")


def stand_in_for_ffmpeg(folder, code: str) -> None:
    program = folder / "ffmpeg"
    program.write_text(f"#!{sys.executable}\nimport sys\n{code}\n")
    program.chmod(program.stat().st_mode | stat.S_IXUSR)


def test_mp4_is_piped_to_ffmpeg_frame_by_frame(tmp_path, monkeypatch):
    programs = tmp_path / "bin"
    programs.mkdir()
    stand_in_for_ffmpeg(
        programs,
        "raw = sys.stdin.buffer.read()\n"
        "size = sys.argv[sys.argv.index('-s') + 1]\n"
        "open(sys.argv[-1], 'w').write(f'{size} {len(raw)}')",
    )
    monkeypatch.setenv("PATH", str(programs))
    file = plotting.animate(made_up_run(), tmp_path / "run.mp4", frames_per_second=10)
    size, total = file.read_text().split()
    width, height = (int(number) for number in size.split("x"))
    assert width % 2 == height % 2 == 0
    assert int(total) == 3 * width * height * (56 + 12)  # the run, and its last picture held


def test_failure_of_ffmpeg_is_told(tmp_path, monkeypatch):
    programs = tmp_path / "bin"
    programs.mkdir()
    stand_in_for_ffmpeg(programs, "sys.exit('no such codec')")
    monkeypatch.setenv("PATH", str(programs))
    with pytest.raises(HrsafetyError, match=r"ffmpeg could not write .*: no such codec"):
        plotting.animate(made_up_run(), tmp_path / "run.mp4", frames_per_second=10)
    assert not (tmp_path / "run.mp4").exists()
