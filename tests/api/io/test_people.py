"""Files of recorded people in every known layout: what a right reader returns, asks for and doubts."""

from __future__ import annotations

import json
import warnings
from dataclasses import replace
from pathlib import Path
from time import perf_counter, process_time
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from api.recorded_files import WRITTEN, people_files, walk
from hrsafety import io, scenarios
from hrsafety import navigation as nav
from hrsafety.datasets import Recording
from hrsafety.errors import FileError, HrsafetyError
from hrsafety.io.people import hdf5
from hrsafety.plausibility import HrsafetyWarning

SHARED = Path(__file__).resolve().parents[3].parent / "shared"


def expectations() -> list[Any]:
    import os

    place = Path(os.environ.get("HRSAFETY_SHARED", SHARED)) / "data" / "formats" / "expected.json"
    if not place.is_file():
        return [pytest.param(place, {}, marks=pytest.mark.skip(reason="needs the files of formats (HRSAFETY_SHARED)"))]
    entries = json.loads(place.read_text())["people"]
    return [pytest.param(place.parent, each, id=f"{each['file']} {each['call']}") for each in entries]


def loaded(path: Path, **call: Any) -> Any:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", HrsafetyWarning)
        return io.load_people(path, **call)


def call_of(folder: Path, entry: dict[str, Any]) -> dict[str, Any]:
    return {key: folder / value if key == "homography" else value for key, value in entry["call"].items()}


COUNTS = ("unknown_rows", "lost_rows", "other_classes", "predictions_left_out", "repeated_rows", "unit", "markers")
FOUND = ("delimiter", "decimal", "absent")


@pytest.mark.parametrize(("folder", "entry"), expectations())
def test_a_sample_is_read_as_expected(folder: Path, entry: dict[str, Any]) -> None:
    path, call = folder / entry["file"], call_of(folder, entry)
    if "error" in entry:
        with pytest.raises(FileError) as caught:
            loaded(path, **call)
        assert caught.value.code == entry["error"]
        assert all(name in str(caught.value) for name in entry.get("names", [])), str(caught.value)
        return
    found = loaded(path, **call)
    assert sorted(each.code for each in found.warnings) == sorted(entry["warnings"])
    told = " ".join(each.message for each in found.warnings)
    assert all(name in told for name in entry.get("names", [])), told
    assert found.source.format == entry.get("format", found.source.format)
    assert len(found) == entry.get("rows", len(found))
    assert sorted(map(str, found.people().tolist())) == sorted(map(str, entry.get("people", found.people().tolist())))
    within = entry.get("time_tolerance", 1e-9)
    assert found.duration == pytest.approx(entry.get("duration", found.duration), abs=max(within, 1e-8))
    if "frame_rate" in entry:
        tolerance = entry.get("frame_rate_tolerance", 1e-9)
        assert found.frame_rate == (entry["frame_rate"] and pytest.approx(entry["frame_rate"], abs=tolerance))
    assert found.frame_rate_from == entry.get("frame_rate_from", found.frame_rate_from)
    assert found.sampling_period == pytest.approx(entry.get("sampling_period", found.sampling_period), abs=1e-6)
    assert found.sampling_period == pytest.approx(entry.get("sampling_period_near", found.sampling_period), rel=0.1)
    for who, when, x, y in entry.get("positions", []):
        time, position = found.track(who)
        row = int(np.argmin(np.abs(time - when)))
        assert time[row] == pytest.approx(when, abs=max(within, 1e-6))
        assert position[row].tolist() == pytest.approx([x, y], abs=1e-6)
    for who, when, vx, vy in entry.get("velocity", []):
        (row,) = np.flatnonzero((found.person == who) & (np.abs(found.time_s - when) < 1e-6))
        assert found.velocity[row].tolist() == pytest.approx([vx, vy], abs=1e-6)
    if "walls" in entry:
        assert [wall.tolist() for wall in found.walls] == entry["walls"]
    if "robot" in entry:
        way = np.column_stack([found.robot.time_s, found.robot.position, found.robot.heading])
        assert way[: len(entry["robot"])].tolist() == entry["robot"]
        assert list(found.details["goal"]) == entry["goal"]
    for name in (*COUNTS, *FOUND):
        if name in entry:
            assert found.details[name] == entry[name], name
    if "scenes" in entry:
        assert len(found.details["scenes"]) == entry["scenes"]
    for name in ("switches", "teleports", "gaps"):
        if name in entry:
            assert [list(each) for each in getattr(found, name)] == entry[name]


def test_exchanged_ids_are_exchanged_again_on_demand(shared: Path) -> None:
    found = loaded(shared / "data" / "formats" / "people_swap.csv", relabel=True)
    assert found.warnings == ()
    assert found.details["relabeled"] == [(1, 2, 4.0)]
    for _, time, position in found.tracks():
        assert (np.hypot(*np.diff(position, axis=0).T) / np.diff(time)).max() < 2.0


@pytest.mark.parametrize("name", ["zara01", "zara03"])
def test_published_recordings_of_the_usual_kind_are_not_doubted(shared: Path, name: str) -> None:
    found = io.load_people(shared / "data" / "pedestrians" / f"{name}.csv")
    assert found.warnings == ()
    assert found.frame_rate == 25.0


def test_noise_is_taken_out_of_the_way(shared: Path) -> None:
    found = loaded(shared / "data" / "formats" / "people_noise_50hz.csv")
    way = np.hypot(*np.diff(found.smoothed().track(1)[1], axis=0).T).sum()
    assert way == pytest.approx(3.278, rel=0.03)


def test_every_hint_leads_on(shared: Path) -> None:
    """Whoever does what the messages say gets the right seconds."""
    folder = shared / "data" / "formats"
    with pytest.raises(HrsafetyError, match=r"fps=.*step_s=0\.4"):
        loaded(folder / "people_trajnet.txt")
    assert loaded(folder / "people_trajnet.txt", step_s=0.4).sampling_period == pytest.approx(0.4)
    doubted = loaded(folder / "people_trajnet.txt", fps=1.0)
    assert "fps=" in next(each.message for each in doubted.warnings if each.code == "implausible")
    with pytest.raises(HrsafetyError, match="leave out fps"):
        loaded(folder / "people_eth_obsmat.txt", fps=10.0)
    assert loaded(folder / "people_eth_obsmat.txt", fps=15.0).warnings == ()
    assert loaded(folder / "people_frames_as_seconds.csv", fps=25.0).sampling_period == pytest.approx(0.4)


# ---- writers and other readers ------------------------------------------------------------------


RING = np.array([[-5.0, -5.0], [9.0, -5.0], [9.0, 12.0], [-5.0, 12.0]])
HOLE = np.array([[1.0, 1.5], [2.0, 1.5], [2.0, 2.5]])


@pytest.mark.parametrize("name", WRITTEN)
@given(seed=st.integers(0, 99), step=st.integers(1, 12), rate=st.sampled_from([8.0, 25.0, 29.97002997002997, 100.0]))
@settings(max_examples=12, deadline=None)
def test_what_is_written_is_read_again(
    name: str, seed: int, step: int, rate: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    recording = walk(step=step, rate=rate, seed=seed)
    path = io.write_people(recording, tmp_path_factory.mktemp("written") / name)
    again = loaded(path)
    np.testing.assert_allclose(again.time_s, recording.time_s, atol=1e-9)
    assert again.person.tolist() == recording.person.tolist()
    np.testing.assert_array_equal(again.position, recording.position)
    if name != "people.json":
        assert again.frame_rate == pytest.approx(rate, rel=1e-9)


def test_the_same_recording_through_every_format_gives_the_same_numbers(tmp_path: Path) -> None:
    recording = walk()
    found = {form: loaded(path, **call) for form, (path, call) in people_files(tmp_path, recording).items()}
    assert len(found) == 17
    expected = scores(recording)
    for form, each in found.items():
        assert each.source.format == form.partition(",")[0]
        np.testing.assert_allclose(each.time_s, recording.time_s, atol=2e-6, err_msg=form)
        # UCY numbers people, THOR names helmets.
        own = [str(who).removeprefix("Helmet_") for who in each.people().tolist()]
        expected_ids = list(map(str, range(4) if form == "ucy" else recording.people().tolist()))
        assert sorted(own, key=int) == expected_ids, form
        for who, name in zip(recording.people().tolist(), sorted(each.people().tolist(), key=_number), strict=True):
            for one, other in zip(each.track(name), recording.track(who), strict=True):
                np.testing.assert_allclose(one, other, atol=2e-6, err_msg=form)
        who = min(each.people().tolist(), key=_number)
        for name, value in scores(each, who).items():
            assert value == pytest.approx(expected[name], rel=1e-3, abs=1e-3, nan_ok=True), (form, name)


def _number(name: object) -> int:
    return int(str(name).removeprefix("Helmet_"))


def scores(recording: Recording, who: Any = 1) -> dict[str, float]:
    """Return the social metrics of the first person among the others."""
    episode = nav.metrics.Episode.from_recording(recording, who, step=0.1, robot_radius=0.3)
    found = nav.metrics.evaluate(episode)
    return {name: float(getattr(found, name)) for name in nav.metrics.METRICS}


def test_pedpy_reads_what_is_written(tmp_path: Path) -> None:
    import pedpy

    recording = replace(walk(), walls=(RING, HOLE))
    text = io.write_people(replace(recording, walls=()), tmp_path / "people.txt")
    database = io.write_people(recording, tmp_path / "people.sqlite")
    area = pedpy.load_walkable_area_from_jupedsim_sqlite(trajectory_file=database).polygon
    assert area.area == pytest.approx(14.0 * 17.0 - 0.5)
    for found in (
        pedpy.load_trajectory(trajectory_file=text),
        pedpy.load_trajectory_from_jupedsim_sqlite(trajectory_file=database),
    ):
        data = found.data.sort_values(["frame", "id"])
        assert found.frame_rate == 30.0
        assert data["id"].tolist() == recording.person.tolist()
        np.testing.assert_allclose(data["frame"].to_numpy() / 30.0, recording.time_s, atol=1e-9)
        np.testing.assert_allclose(data[["x", "y"]].to_numpy(), recording.position, atol=1e-12)
    again = loaded(database)
    assert [each.tolist() for each in again.walls] == [RING.tolist(), HOLE.tolist()]


def test_every_version_of_jupedsim_is_read_and_others_are_refused(tmp_path: Path) -> None:
    import sqlite3

    path = io.write_people(walk(), tmp_path / "people.sqlite")
    for version in (1, 3, 4):
        with sqlite3.connect(path) as connection:
            connection.execute("UPDATE metadata SET value = ? WHERE key = 'version'", (str(version),))
        connection.close()
        if version < 4:
            assert len(loaded(path)) == len(walk())
        else:
            with pytest.raises(FileError, match=r"metadata\.version must be of version 1, 2, 3, got 4"):
                loaded(path)


def test_jupedsim_itself_writes_what_is_read(tmp_path: Path) -> None:
    import jupedsim as jps

    path = tmp_path / "run.sqlite"
    writer = jps.SqliteTrajectoryWriter(output_file=path, every_nth_frame=10)
    model = jps.CollisionFreeSpeedModel()
    area = [(0.0, 0.0), (12.0, 0.0), (12.0, 4.0), (0.0, 4.0)]
    simulation = jps.Simulation(model=model, geometry=area, trajectory_writer=writer, dt=0.01)
    leave = simulation.add_exit_stage([(11.0, 1.0), (12.0, 1.0), (12.0, 3.0), (11.0, 3.0)])
    journey = simulation.add_journey(jps.JourneyDescription([leave]))
    for y in (1.0, 2.0, 3.0):
        agent = jps.CollisionFreeSpeedModelAgentParameters(position=(1.0, y), journey_id=journey, stage_id=leave)
        simulation.add_agent(agent)
    while simulation.agent_count() and simulation.iteration_count() < 3000:
        simulation.iterate()
    writer.close()
    found = loaded(path)
    assert found.frame_rate == pytest.approx(10.0)
    assert len(found.people()) == 3
    assert found.warnings == ()
    assert {tuple(each) for each in found.walls[0].tolist()} == set(area)


def test_what_a_format_cannot_hold_is_told(tmp_path: Path, shared: Path) -> None:
    found = loaded(shared / "data" / "formats" / "people_socnav.json")
    with pytest.warns(HrsafetyWarning, match="petrack holds no robot, no walls"):
        io.write_people(found, tmp_path / "people.txt")
    again = loaded(io.write_people(found, tmp_path / "again.json"))
    assert [each.tolist() for each in again.walls] == [each.tolist() for each in found.walls]
    np.testing.assert_array_equal(again.robot.position, found.robot.position)
    assert again.details["goal"] == found.details["goal"]
    words = loaded(shared / "data" / "formats" / "people_thor_Exp_1_run_1.tsv")
    with pytest.raises(HrsafetyError, match=r"got the id 'Helmet_1'; give renumber=True"):
        io.write_people(words, tmp_path / "words.txt")
    assert loaded(io.write_people(words, tmp_path / "words.txt", renumber=True)).people().tolist() == [1, 2]
    irregular = loaded(shared / "data" / "formats" / "people_atc-20121024.csv")
    with pytest.raises(HrsafetyError, match="have all rows on frames"):
        io.write_people(irregular, tmp_path / "irregular.txt", fps=30.0)


# ---- motion -------------------------------------------------------------------------------------


def test_noise_of_velocities_and_accelerations_is_what_is_stated() -> None:
    rng = np.random.default_rng(1)
    time = 0.02 * np.arange(20_000)
    place = np.stack([1.1 * time, 0.0 * time], axis=1) + rng.normal(0.0, 0.02, (len(time), 2))
    motion = Recording(time_s=time, person=[1] * len(time), position=place).motion(0.6)
    assert motion.velocity_from == "fit"
    assert motion.bandwidth == pytest.approx(1.07 / (31 * 0.02))
    assert motion.velocity_noise == pytest.approx(0.020, rel=0.05)
    assert motion.acceleration_noise == pytest.approx(0.25, rel=0.05)
    inner = slice(100, -100)
    assert motion.velocity[inner].std(axis=0) == pytest.approx([motion.velocity_noise] * 2, rel=0.1)
    assert motion.acceleration[inner].std(axis=0) == pytest.approx([motion.acceleration_noise] * 2, rel=0.1)


def test_stored_velocities_are_believed_where_they_fit() -> None:
    recording = walk()
    true = recording.motion().velocity
    assert replace(recording, velocity=1.1 * true).motion().velocity_from == "stored"
    assert replace(recording, velocity=1.5 * true).motion().velocity_from == "fit"
    slow = walk(step=10, rate=25.0).motion()
    assert slow.velocity_from == "differences"
    assert np.isfinite(slow.velocity).all()


# ---- words as ids, and noise, wherever recorded people go ---------------------------------------


def test_people_with_names_go_wherever_people_with_numbers_go() -> None:
    numbers = walk(people=5, rows=60)
    names = replace(numbers, person=np.array([f"Helmet_{each:02d}" for each in numbers.person.tolist()]))
    runs, named = (scenarios.crossings(each, runs=1, length=2.0) for each in (numbers, names))
    assert [each.start_time for each in runs] == [each.start_time for each in named]
    assert all(isinstance(who, str) for each in named for who in each.people)
    worlds = [scenarios.with_recording(each, 0.5, time_limit=5.0) for each in (numbers, names)]
    assert [len(each.people) for each in worlds] == [5, 5]
    scored = [
        nav.metrics.evaluate(nav.metrics.Episode.from_recording(each, who, step=0.1, robot_radius=0.3)).path_length
        for each, who in ((numbers, 1), (names, "Helmet_01"))
    ]
    assert scored[0] == scored[1]


def test_scores_of_noisy_people_are_those_of_smoothed_ones_and_say_so(shared: Path) -> None:
    found = loaded(shared / "data" / "formats" / "people_noise_50hz.csv")
    scored = nav.metrics.evaluate(
        nav.metrics.Episode.from_recording(found, 1, step=0.02, robot_radius=0.3, goal=(99.0, 0.0))
    )
    assert scored.path_length == pytest.approx(3.278, rel=0.03)
    assert "smoothed_positions" in {each.code for each in scored.warnings}


# ---- damage -------------------------------------------------------------------------------------

TOKENS = (
    "nan",
    "inf",
    "-1",
    "1e308",
    "1e-320",
    "?",
    "",
    "\x00",
    '"',
    ";",
    ",",
    "\t",
    "-",
    "{",
    "null",
    "1.2.3",
    "#",
    "0x10",
)


@settings(max_examples=400, deadline=None)
@given(data=st.data())
def test_a_damaged_file_is_read_or_refused_in_one_sentence(
    data: st.DataObject, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder, files = right_files(tmp_path_factory)
    # HDF5 is read by a process of its own, which takes a second.
    form = data.draw(st.sampled_from(sorted(files.keys() - {"juelich-hdf5"})))
    path, call = files[form]
    content = path.read_bytes()
    place = data.draw(st.integers(0, len(content)))
    token = data.draw(st.sampled_from(TOKENS)).encode()
    length = data.draw(st.sampled_from([0, 1, 5, len(content)]))
    damaged = folder / f"damaged_{path.name}"
    damaged.write_bytes(content[:place] + token + content[place + length :])
    began = perf_counter()
    found, said = None, ""
    try:
        found = loaded(damaged, **call)
    except HrsafetyError as error:
        said = str(error)
    assert (found is None) == (20 < len(said) < 1500)
    if found is not None:
        assert np.isfinite(found.position).all()
        assert np.isfinite(found.time_s).all()
        assert all(each.message for each in found.warnings)
    assert perf_counter() - began < 5.0


def test_hdf5_that_is_damaged_or_never_ends_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path, _ = people_files(tmp_path, walk(rows=8, people=2))["juelich-hdf5"]
    content = path.read_bytes()
    path.write_bytes(content[: int(0.9 * len(content))])
    with pytest.raises(FileError, match="must be HDF5 of the Juelich archive, got OSError"):
        loaded(path)
    path.write_bytes(content)
    assert len(loaded(path)) == 16
    # Some damage makes the library search without end, where nothing but another process can stop it.
    monkeypatch.setattr(hdf5, "PATIENCE", 1e-3)
    with pytest.raises(FileError, match=r"got a file that the library does not read within"):
        loaded(path)


RIGHT: dict[str, Any] = {}


def right_files(factory: pytest.TempPathFactory) -> tuple[Path, dict[str, tuple[Path, dict[str, Any]]]]:
    if not RIGHT:
        folder = factory.mktemp("right")
        RIGHT["files"] = (folder, people_files(folder, walk(rows=8, people=2)))
    found: tuple[Path, dict[str, tuple[Path, dict[str, Any]]]] = RIGHT["files"]
    return found


# ---- size ---------------------------------------------------------------------------------------


def test_a_million_rows_are_read_without_a_loop_over_rows(tmp_path: Path) -> None:
    people, instants = 1000, 1000
    rng = np.random.default_rng(0)
    path = tmp_path / "large.csv"
    with path.open("w") as file:
        file.write("frame,t_s,ped_id,x_m,y_m\n")
        for who in range(people):
            begin = float(rng.uniform(-9.0, 9.0))
            rows = (f"{k},{0.1 * k:.1f},{who},{begin + 0.12 * k:.4f},{who % 50}.5" for k in range(instants))
            file.write("\n".join(rows) + "\n")
    began = process_time()
    found = io.load_people(path)
    # Wide: no row is read by Python.
    assert process_time() - began < 15.0
    assert len(found) == people * instants


def test_three_people_who_exchange_ids_one_after_the_other_are_told_apart() -> None:
    time = 0.1 * np.arange(60)
    ways = [np.stack([1.2 * time, np.full(60, 3.0 * k)], axis=1) for k in range(3)]
    labels = np.tile([[1], [2], [3]], 60)
    labels[:, 20:] = labels[[1, 0, 2], 20:]  # ids of the first and the second
    labels[:, 40:] = [[3], [1], [2]]  # then those of the first, now 2, and the third
    rows = sorted((time[k], int(labels[who, k]), *ways[who][k].tolist(), who) for k in range(60) for who in range(3))
    table = np.array(rows)
    found = Recording(time_s=table[:, 0], person=table[:, 1].astype(int), position=table[:, 2:4])
    assert [each.code for each in found.warnings] == ["identity_switch"]
    assert [pair[:2] for pair in found.switches] == [(1, 2), (2, 3)]
    again = found.relabeled()
    assert again.warnings == ()
    for who in range(3):
        np.testing.assert_array_equal(again.track(who + 1)[1], ways[who])


# ---- columns that change what x, y and rows mean -------------------------------------------------


def crossing_rows(folder: Path, head: str, more: Any) -> Path:
    """Write a table of four people who cross, 0.1 s apart, with further cells by ``more(x, y)``."""
    rows = [head]
    for step in range(80):
        for person in range(4):
            x, y = -4.0 + 0.1 * step, 0.8 * person
            rows.append(f"{0.1 * step:.1f},{person},{x:.2f},{y:.2f},{more(x, y)}")
    path = folder / "people.csv"
    path.write_text("\n".join(rows) + "\n", encoding="utf-8")
    return path


@pytest.mark.parametrize(
    ("names", "cells"),
    [
        ("occluded", lambda lost: str(int(lost))),
        ("is_lost", lambda lost: str(lost)),
        ("visible,predicted", lambda lost: f"{not lost},0"),
        ("Interpolated", lambda lost: "yes" if lost else "no"),
    ],
)
def test_rows_that_a_table_marks_as_not_seen_are_not_seen(names: str, cells: Any, tmp_path: Path) -> None:
    near = 1.05  # 21 of 80 rows
    path = crossing_rows(tmp_path, f"t_s,ped_id,x_m,y_m,{names}", lambda x, _: cells(abs(x) < near))
    found = loaded(path)
    assert (np.abs(found.position[:, 0]) > near).all()
    assert (len(found), found.details["lost_rows"]) == (4 * 59, 4 * 21)
    assert "lost_rows" in [each.code for each in found.warnings]
    taken = loaded(path, columns={name: "-" for name in names.split(",")})
    assert len(taken) == 320
    assert "lost_rows" not in taken.details


@pytest.mark.parametrize(("name", "cell"), [("visible", "0.7"), ("lost", ""), ("occluded", "2")])
def test_a_mark_in_unknown_words_leaves_rows_as_they_are_and_says_so(name: str, cell: str, tmp_path: Path) -> None:
    path = crossing_rows(tmp_path, f"t_s,ped_id,x_m,y_m,{name}", lambda x, _: cell if x > 0.0 else "1")
    found = loaded(path)
    assert len(found) == 320
    (doubt,) = found.warnings
    assert (doubt.code, doubt.subject) == ("assumed", "position")
    assert f"{name} of people.csv holds more than true and false" in doubt.message
    assert loaded(path, columns={name: "-"}).warnings == ()


def test_a_height_taken_for_a_coordinate_is_doubted(tmp_path: Path) -> None:
    turned = crossing_rows(tmp_path, "t_s,ped_id,x_m,z_m,y_m", lambda x, y: f"{1.6 + 0.02 * y + 0.01 * abs(x):.3f}")
    (doubt,) = loaded(turned).warnings
    assert (doubt.code, doubt.safe_side) == ("implausible", False)
    assert 'columns={"y_m": "z_m", "z_m": "y_m"}' in doubt.message
    righted = loaded(turned, columns={"y_m": "z_m", "z_m": "y_m"})
    assert righted.warnings == ()
    assert np.ptp(righted.position[:, 1]) == pytest.approx(2.4)
    upright = crossing_rows(tmp_path, "t_s,ped_id,x_m,y_m,z_m", lambda _, y: f"{1.6 + 0.02 * y:.3f}")
    assert loaded(upright).warnings == ()


def test_corners_of_boxes_are_doubted(tmp_path: Path) -> None:
    boxes = crossing_rows(tmp_path, "t_s,ped_id,x_m,y_m,w,h", lambda *_: "0.5,1.7")
    assert [each.code for each in loaded(boxes).warnings] == ["assumed"]
    assert loaded(boxes, columns={"w": "-"}).warnings == ()
    middles = crossing_rows(tmp_path, "t_s,ped_id,x_center_m,y_center_m,w,h", lambda *_: "0.5,1.7")
    assert loaded(middles).warnings == ()
