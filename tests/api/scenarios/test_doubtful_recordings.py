"""What makes recorded people doubtful, and what takes the doubt away: frames, jumps, exchanged ids, gaps, noise."""

from __future__ import annotations

import math
import pickle
import time
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import io, scenarios
from hrsafety import navigation as nav
from hrsafety.cli import main
from hrsafety.datasets import Recording
from hrsafety.errors import InvalidParameterError
from hrsafety.plausibility import UnitWarning, unsafe_doubts


def crowd(
    *, step: float = 0.4, instants: int = 30, people: int = 4, speed: float = 1.2, seed: int = 0
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return times, ids and places of people who walk in slightly bent ways, row after row."""
    rng = np.random.default_rng(seed)
    time_s = step * np.arange(instants)
    heading = rng.uniform(-math.pi, math.pi, people) + rng.uniform(-0.05, 0.05, people) * time_s[:, None]
    velocity = speed * rng.uniform(0.8, 1.2, people)[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    places = np.cumsum(velocity * step, axis=0) + np.stack([4.0 * np.arange(people), np.zeros(people)], axis=-1)
    return time_s, np.arange(people), places


def recorded(time_s: np.ndarray, ids: np.ndarray, places: np.ndarray) -> Recording:
    rows = len(time_s)
    return Recording(
        time_s=np.repeat(time_s, len(ids)), person=np.tile(ids, rows), position=places.reshape(rows * len(ids), 2)
    )


def codes(recording: Recording) -> list[str]:
    return [each.code for each in recording.warnings]


# ---- frames and units ----------------------------------------------------------------------------


@settings(max_examples=60)
@given(
    fps=st.sampled_from([2.5, 10.0, 15.0, 16.0, 25.0, 29.97, 30.0, 50.0, 60.0, 100.0]),
    rows_per_s=st.floats(2.0, 25.0),
    speed=st.floats(0.9, 1.6),
    seed=st.integers(0, 1000),
)
def test_frames_read_as_seconds_are_doubted_and_fps_takes_the_doubt_away(
    fps: float, rows_per_s: float, speed: float, seed: int
) -> None:
    every = max(round(fps / rows_per_s), 1)
    step = every / fps
    time_s, ids, places = crowd(step=step, instants=max(40, int(20.0 / step)), speed=speed, seed=seed)
    frames = np.round(time_s * fps)
    doubted = recorded(frames, ids, places)
    assert codes(doubted) == ["implausible"]
    assert "fps=" in doubted.warnings[0].message
    assert not doubted.warnings[0].safe_side
    assert codes(recorded(frames / fps, ids, places)) == []


def table(folder: Path, header: str, time_s: np.ndarray, ids: np.ndarray, places: np.ndarray) -> Path:
    rows = [
        f"{t:.10g},{who},{x:.9f},{y:.9f}"
        for t, row in zip(time_s.tolist(), places.tolist(), strict=True)
        for who, (x, y) in zip(ids.tolist(), row, strict=True)
    ]
    path = folder / "people.csv"
    path.write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize("header", ["frame,ped_id,x_m,y_m", "t_s,ped_id,x_m,y_m"])
def test_a_file_of_frames_is_read_with_its_frames_per_second(tmp_path: Path, header: str) -> None:
    time_s, ids, places = crowd()
    path = table(tmp_path, header, np.round(25.0 * time_s), ids, places)
    found = io.load_people(path, fps=25.0)
    np.testing.assert_allclose(found.time_s, np.repeat(time_s, len(ids)), atol=1e-9)
    assert found.warnings == ()


def test_the_message_of_a_file_without_times_leads_to_right_seconds(tmp_path: Path) -> None:
    time_s, ids, places = crowd()
    path = table(tmp_path, "frame,ped_id,x_m,y_m", np.round(25.0 * time_s), ids, places)
    with pytest.raises(InvalidParameterError, match="come with fps=, the frames per second"):
        io.load_people(path)
    assert io.load_people(path, fps=25.0).duration == pytest.approx(time_s[-1])


def test_frames_that_contradict_the_times_of_a_file_are_refused(tmp_path: Path) -> None:
    time_s, ids, places = crowd()
    path = table(tmp_path, "t_s,ped_id,x_m,y_m", time_s, ids, places)
    with pytest.raises(InvalidParameterError, match=r"column t_s must hold frames where fps is given, got 0\.4"):
        io.load_people(path, fps=25.0)
    path.write_text("frame,t_s,ped_id,x_m,y_m\n0,0.0,1,0,0\n10,0.4,1,0.5,0\n", encoding="utf-8")
    assert io.load_people(path, fps=25.0).duration == 0.4
    with pytest.raises(InvalidParameterError, match="says 10 frames per second, got 25 in the file"):
        io.load_people(path, fps=10.0)
    for wrong in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InvalidParameterError, match="fps must be finite and positive"):
            io.load_people(path, fps=wrong)


def test_runs_among_people_by_frames_are_not_passed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    time_s, ids, places = crowd(instants=60)
    path = table(tmp_path, "t_s,ped_id,x_m,y_m", np.round(25.0 * time_s), ids, places)
    options = ["simulate", "--people", str(path), "--runs", "1"]
    assert main(options) == 0
    shown = capsys.readouterr()
    assert "passed" not in shown.out
    assert "NOT CHECKED" in shown.out
    assert "--fps" in shown.err
    assert main([*options, "--fail-on", "contact"]) == 5
    capsys.readouterr()
    main([*options, "--fps", "25"])
    assert "NOT CHECKED" not in capsys.readouterr().out


@pytest.mark.parametrize("factor", [100.0, 1000.0])
@pytest.mark.parametrize("seed", range(5))
def test_positions_in_other_units_are_doubted(factor: float, seed: int) -> None:
    time_s, ids, places = crowd(seed=seed)
    assert codes(recorded(time_s, ids, factor * places)) == ["implausible"]
    assert codes(recorded(time_s, ids, places)) == []


def test_recorded_scenes_have_no_doubts(shared: Path) -> None:
    for name in ("zara01", "zara03"):
        recording = io.load_people(shared / "data" / "pedestrians" / f"{name}.csv")
        assert recording.warnings == ()


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("frames_as_seconds", "implausible"),
        ("swap", "identity_switch"),
        ("teleport", "teleport"),
        ("gap", "gap_in_track"),
        ("noise_50hz", "noisy_positions"),
    ],
)
def test_samples_have_the_doubts_that_were_put_into_them(shared: Path, name: str, expected: str) -> None:
    recording = io.load_people(shared / "data" / "formats" / f"people_{name}.csv")
    assert codes(recording) == [expected]


# ---- jumps and exchanged ids ---------------------------------------------------------------------


@settings(max_examples=60)
@given(
    row=st.integers(3, 26),
    length=st.floats(4.0, 500.0),
    angle=st.floats(-3.0, 3.0),
    back=st.booleans(),
    seed=st.integers(0, 99),
)
def test_jumps_are_doubted_there_and_there_and_back(
    row: int, length: float, angle: float, back: bool, seed: int
) -> None:
    time_s, ids, places = crowd(seed=seed)
    places[row : row + 1 if back else None, 2] += length * np.array([math.cos(angle), math.sin(angle)])
    (doubt,) = recorded(time_s, ids, places).warnings
    assert doubt.code == "teleport"
    assert doubt.subject == f"speed of person 2 after {time_s[row - 1]:g} s"
    assert not doubt.safe_side


@settings(max_examples=60)
@given(row=st.integers(3, 26), apart=st.floats(2.0, 40.0), seed=st.integers(0, 99))
def test_exchanged_ids_are_doubted_and_are_no_jumps(row: int, apart: float, seed: int) -> None:
    time_s, ids, places = crowd(people=2, seed=seed)
    places[:, 1] = places[:, 0] + (0.0, apart)
    places[row:] = places[row:, ::-1].copy()
    (doubt,) = recorded(time_s, ids, places).warnings
    assert doubt.code == "identity_switch"
    assert doubt.message.startswith(f"person 0 and person 1 exchange places at {time_s[row]:g} s")


# ---- noise ---------------------------------------------------------------------------------------


@settings(max_examples=30)
@given(sigma=st.floats(0.005, 0.03), step=st.sampled_from([0.02, 1.0 / 30.0]), seed=st.integers(0, 99))
def test_noise_is_doubted_and_smoothing_brings_the_way_back(sigma: float, step: float, seed: int) -> None:
    time_s, ids, places = crowd(step=step, instants=250, people=2, seed=seed)
    clean = recorded(time_s, ids, places)
    noise = np.random.default_rng(seed).normal(0.0, sigma, places.shape)
    noisy = recorded(time_s, ids, places + noise)
    assert codes(clean) == []
    acceleration, ordinary = sigma * math.sqrt(6.0) / step**2, 1.2 * step
    if acceleration > 4.5 and sigma * math.sqrt(2.0) > 0.4 * ordinary:
        assert codes(noisy) == ["noisy_positions"]
        assert "smoothed(0.6)" in noisy.warnings[0].message

    def way(recording: Recording) -> float:
        return float(sum(np.hypot(*np.diff(recording.track(who)[1], axis=0).T).sum() for who in (0, 1)))

    assert way(noisy) > way(noisy.smoothed()) > 0.99 * way(clean)
    assert way(noisy.smoothed()) < 1.03 * way(clean)
    # What is smooth stays.
    assert way(clean.smoothed()) == pytest.approx(way(clean), rel=1e-3)


def test_smoothing_of_parabolas_changes_nothing_and_never_crosses_a_gap() -> None:
    time_s = np.concatenate([0.1 * np.arange(20), 10.0 + 0.1 * np.arange(20)])
    place = np.stack([0.3 * time_s**2, 1.0 - 0.1 * time_s], axis=1)
    place[20:] += 3.0
    walk = Recording(time_s=time_s, person=[7] * 40, position=place)
    np.testing.assert_allclose(walk.smoothed().position, place, atol=1e-9)
    with pytest.raises(InvalidParameterError, match="window must be finite and positive"):
        walk.smoothed(0.0)


# ---- size ----------------------------------------------------------------------------------------


def test_crossings_do_not_cost_people_times_rows() -> None:
    people, instants = 3000, 1000
    rng = np.random.default_rng(0)
    enters = np.round(rng.uniform(0.0, 3600.0, people), 1)
    passed = 0.1 * np.arange(instants)
    time_s, who = (enters[:, None] + passed).ravel(), np.repeat(np.arange(people), instants)
    along = rng.choice([-1.0, 1.0], people)[:, None] * (rng.uniform(0.8, 1.5, people)[:, None] * passed - 50.0)
    places = np.stack([along.ravel(), np.repeat(rng.uniform(-3.0, 3.0, people), instants)], axis=1)
    order = np.lexsort((who, time_s))
    recording = Recording(time_s=time_s[order], person=who[order], position=places[order])
    began = time.process_time()
    runs = scenarios.crossings(recording)
    # 1.6 s; 16 s when each instant of a stay was compared with each start, 114 s with a search for each person.
    assert time.process_time() - began < 6.0
    assert len(runs) == 24


def test_a_recording_is_pickled_by_its_rows() -> None:
    time_s, ids, places = crowd()
    recording = recorded(time_s, ids, places)
    before = len(pickle.dumps(recording))
    assert recording.warnings == ()
    again = pickle.loads(pickle.dumps(recording))
    assert len(pickle.dumps(recording)) == before
    np.testing.assert_array_equal(again.position, recording.position)


# ---- one recorded way ----------------------------------------------------------------------------


@settings(max_examples=25, deadline=None)
@given(fps=st.sampled_from([10.0, 15.0, 25.0, 30.0, 50.0]), every=st.integers(1, 10), speed=st.floats(0.9, 1.6))
def test_a_way_by_frames_is_doubted_in_scenes_and_fps_takes_the_doubt_away(
    fps: float, every: int, speed: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("scene")
    frames = every * np.arange(60)
    rows = "".join(f"{frame},{-3.0 + speed * frame / fps!r},1.5\n" for frame in frames.tolist())
    (folder / "walk.csv").write_text(f"t_s,x_m,y_m\n{rows}")
    (folder / "frames.csv").write_text(f"frame,x_m,y_m\n{rows}")
    head = 'start = [0.0, 0.0]\ngoal = [4.0, 0.0]\n[[obstacles]]\ntype = "human"\n'
    for name, more, doubted in (
        ("walk", "", True),
        ("walk", f"fps = {fps}\n", False),
        ("frames", f"fps = {fps}\n", False),
    ):
        scene = folder / "scene.toml"
        scene.write_text(f'{head}path = "{name}.csv"\n{more}')
        found = scenarios.load(scene)
        said = [each.message for each in found.scenario.warnings if each.code == "implausible"]
        assert any("look like frames" in message and "fps" in message for message in said) == doubted
        run = nav.simulate(found.scenario, found.law)
        assert any("look like frames" in each.message for each in unsafe_doubts(run.warnings)) == doubted
    with pytest.warns(UnitWarning, match="fps"):
        io.load_track(folder / "walk.csv")
    assert io.load_track(folder / "frames.csv", fps=fps)[0][-1] == frames[-1] / fps


def test_a_scene_with_a_way_by_frames_does_not_pass(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    rows = "".join(f"{10 * k},{3.0 - 0.5 * k},30.0\n" for k in range(40))
    (tmp_path / "walk.csv").write_text(f"t_s,x_m,y_m\n{rows}")
    text = 'start = [0.0, 0.0]\ngoal = [4.0, 0.0]\n[[obstacles]]\ntype = "human"\npath = "walk.csv"\n'
    (tmp_path / "scene.toml").write_text(text)
    assert main(["simulate", str(tmp_path / "scene.toml"), "--fail-on", "contact"]) == 5
    assert "NOT CHECKED" in capsys.readouterr().out
