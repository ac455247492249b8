from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from hrsafety import datasets, io
from hrsafety.datasets import Recording
from hrsafety.errors import HrsafetyError, InvalidParameterError, ShapeError

SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[3].parent / "shared"))
PEDESTRIANS = SHARED / "data" / "pedestrians"
ROUNDING = 1e-12
"""Room for the rounding of a few additions of numbers near 1."""

GOOD = """frame,t_s,ped_id,x_m,y_m
0,0.0,1,0.0,0.0
0,0.0,2,5.0,1.0
10,0.4,1,0.5,0.0
10,0.4,2,4.5,1.0
20,0.8,1,1.0,0.0
20,0.8,9,3.0,3.0
"""


def written(folder: Path, text: str | bytes) -> Path:
    path = folder / "people.csv"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def good(folder: Path) -> Recording:
    return io.load_people(written(folder, GOOD))


def test_loading_keeps_every_row_in_order(tmp_path: Path) -> None:
    recording = good(tmp_path)
    assert len(recording) == 6
    assert recording.people().tolist() == [1, 2, 9]
    assert recording.duration == 0.8
    assert recording.position[3].tolist() == [4.5, 1.0]


def test_columns_may_stand_in_any_order_behind_a_byte_order_mark(tmp_path: Path) -> None:
    lines = [line.split(",") for line in GOOD.split()]
    shuffled = "\r\n".join(",".join(line[k] for k in (3, 1, 4, 0, 2)) for line in lines) + "\r\n"
    recording = io.load_people(written(tmp_path, b"\xef\xbb\xbf" + shuffled.encode()))
    expected = good(tmp_path)
    np.testing.assert_array_equal(recording.position, expected.position)
    np.testing.assert_array_equal(recording.person, expected.person)


def test_track_returns_the_rows_of_one_person(tmp_path: Path) -> None:
    time, position = good(tmp_path).track(2)
    assert time.tolist() == [0.0, 0.4]
    assert position.tolist() == [[5.0, 1.0], [4.5, 1.0]]


def test_track_of_nobody_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError, match="person must be the id of a recorded person, got 3"):
        good(tmp_path).track(3)


def test_arrays_of_a_recording_cannot_be_written(tmp_path: Path) -> None:
    recording = good(tmp_path)
    with pytest.raises(ValueError, match="read-only"):
        recording.position[0, 0] = 1.0


def test_a_recording_does_not_share_memory_with_its_source() -> None:
    position = np.array([[0.0, 0.0], [1.0, 0.0]])
    recording = Recording(time_s=[0.0, 1.0], person=[1, 1], position=position)
    position[0, 0] = 7.0
    assert recording.position[0, 0] == 0.0


def test_people_present_at_one_instant_only_are_left_out_and_named(tmp_path: Path) -> None:
    recording = good(tmp_path)
    assert recording.present(0.0, duration=10.0).tolist() == [1, 2]
    assert recording.momentary(0.0, duration=10.0).tolist() == [9]
    assert len(recording.humans(0.0, duration=10.0)) == 2


def test_a_person_whose_last_row_begins_the_window_is_momentary(tmp_path: Path) -> None:
    recording = good(tmp_path)
    assert recording.present(0.4, duration=10.0).tolist() == [1]
    assert recording.momentary(0.4, duration=10.0).tolist() == [2, 9]


def test_window_without_anybody_is_empty(tmp_path: Path) -> None:
    recording = good(tmp_path)
    assert recording.humans(50.0, duration=1.0) == ()
    assert recording.momentary(50.0, duration=1.0).tolist() == []


def test_humans_start_their_clock_at_the_window() -> None:
    time = np.arange(6) * 0.5
    recording = Recording(time_s=time, person=[4] * 6, position=np.stack([time, 0 * time], axis=1))
    (person,) = recording.humans(0.75, duration=1.0)
    assert person.path is not None
    assert person.path[0] == (-0.25, 0.25, 0.75, 1.25)
    assert person.path[1][0] == (0.5, 0.0)


def test_humans_cover_the_whole_window() -> None:
    time = np.arange(100) * 0.4
    recording = Recording(time_s=time, person=[4] * 100, position=np.stack([time, 0 * time], axis=1))
    for start in (0.0, 0.4, 3.0, 11.9):
        (person,) = recording.humans(start, duration=5.0)
        assert person.path is not None
        assert person.path[0][0] <= 0.0
        assert person.path[0][-1] >= 5.0


def test_fields_of_humans_are_passed_on(tmp_path: Path) -> None:
    people = good(tmp_path).humans(0.0, duration=1.0, radius=0.3, active_radius=2.0, critical_radius=0.7)
    assert {(p.radius, p.active_radius, p.critical_radius) for p in people} == {(0.3, 2.0, 0.7)}


@pytest.mark.parametrize(
    ("start_time", "duration", "argument"),
    [
        (float("nan"), 1.0, "start_time"),
        (0.0, 0.0, "duration"),
        (0.0, -1.0, "duration"),
        (0.0, float("inf"), "duration"),
    ],
)
def test_a_bad_window_is_an_error(tmp_path: Path, start_time: float, duration: float, argument: str) -> None:
    with pytest.raises(InvalidParameterError) as caught:
        good(tmp_path).humans(start_time, duration=duration)
    assert caught.value.argument == argument


@pytest.mark.parametrize("angle", [0.0, 0.3, 1.5, 2.5, -2.0])
def test_main_flow_finds_the_direction_and_middle_of_a_stream(angle: float) -> None:
    direction = np.array([np.cos(angle), np.sin(angle)])
    across = np.array([-direction[1], direction[0]])
    offsets = (-1.0, 0.0, 1.0)
    time = np.tile(np.linspace(0.0, 10.0, 21), (3, 1)).T.ravel()
    person = np.tile([1, 2, 3], 21)
    position = np.array([3.0, 4.0]) + (time - 5.0)[:, None] * direction + np.tile(offsets, 21)[:, None] * across
    flow = Recording(time_s=time, person=person, position=position).main_flow()
    np.testing.assert_allclose(flow.direction, direction, atol=ROUNDING)
    np.testing.assert_allclose(flow.center, (3.0, 4.0), atol=10 * ROUNDING)
    assert flow.angle == pytest.approx(angle, abs=ROUNDING)
    assert flow.spread == pytest.approx(np.std(offsets), abs=ROUNDING)


def test_main_flow_points_where_more_of_the_way_is_walked() -> None:
    time = np.repeat([0.0, 5.0], 3)
    position = [[0, 0], [0, 1], [5, 2], [-5, 0], [-5, 1], [0, 2]]
    flow = Recording(time_s=time, person=[1, 2, 3] * 2, position=position).main_flow()
    assert flow.direction == (-1.0, 0.0)


def test_main_flow_ignores_how_many_people_only_stand() -> None:
    time = np.repeat([0.0, 5.0], 4)
    position = [[0, 0], [2, 9], [3, 9], [4, 9], [5, 0], [2, 9], [3, 9], [4, 9]]
    flow = Recording(time_s=time, person=[1, 2, 3, 4] * 2, position=position).main_flow()
    assert flow.center == (2.5, 0.0)


def test_main_flow_of_people_with_a_gap_between_their_ways_has_a_place() -> None:
    flow = Recording(
        time_s=[0.0, 0.0, 1.0, 1.0], person=[1, 2, 1, 2], position=[[0, 0], [5, 0], [1, 0], [6, 0]]
    ).main_flow()
    assert np.isfinite(flow.center).all()


@pytest.mark.parametrize(
    "recording",
    [
        Recording(time_s=[0.0], person=[1], position=[[0, 0]]),
        Recording(time_s=[0.0, 1.0], person=[1, 1], position=[[2, 3], [2, 3]]),
    ],
    ids=["one sample", "standing"],
)
def test_people_who_do_not_move_have_no_main_flow(recording: Recording) -> None:
    with pytest.raises(InvalidParameterError, match="hold people who move"):
        recording.main_flow()


def test_frames_may_be_left_out(tmp_path: Path) -> None:
    rows = [(0, 0.0, 7, 0.0, 1.0), (0, 0.0, 9, 3.0, 1.0), (10, 0.4, 7, 0.5, 1.0)]
    framed, plain = tmp_path / "framed.csv", tmp_path / "plain.csv"
    framed.write_text("\n".join(["frame,t_s,ped_id,x_m,y_m", *(",".join(map(str, row)) for row in rows)]))
    plain.write_text("\n".join(["y_m,t_s,x_m,ped_id", *(f"{y},{t},{x},{who}" for _, t, who, x, y in rows)]))
    one, other = (io.load_people(path) for path in (framed, plain))
    assert np.array_equal(one.time_s, other.time_s)
    assert np.array_equal(one.person, other.person)
    assert np.array_equal(one.position, other.position)


HEADER = "frame,t_s,ped_id,x_m,y_m\n"
BAD_FILES = {
    "empty": ("", "must hold at least one row"),
    "header only": (HEADER, "must hold at least one row"),
    "missing column": (
        "frame,t_s,ped_id,x_m\n0,0,1,0\n",
        "line 1 must have a column for y, got the columns frame, t_s, ped_id, x_m",
    ),
    "double column": ("frame,t_s,ped_id,x_m,x_m\n0,0,1,0,0\n", "have one column for x, got 'x_m' and 'x_m'"),
    "two units": ("t_s,ped_id,x_m,y_cm\n0,1,0,0\n", "have one unit of x and y, got m and cm"),
    "unknown unit": ("t_s,ped_id,x_ft,y_ft\n0,1,0,0\n", "have a column for x and y"),
    "word": (HEADER + "0,0,1,0,0\n10,0.4,1,abc,0\n", "line 3, column x_m must be a finite number, got 'abc'"),
    "inf": (HEADER + "0,0,1,0,-inf\n", "line 2, column y_m must be a finite number"),
    "huge": (HEADER + "0,0,1,0,1e999\n", "line 2, column y_m must be a finite number"),
    "underscore": (HEADER + "0,0,1,1_0,0\n", "line 2, column x_m must be a finite number"),
    "time that is none": (HEADER + "0,nan,1,0,0\n", "line 2 must have a time or frame in each row"),
    "no id": (HEADER + "0,0,,0,0\n", "line 2, column ped_id must name somebody"),
    "huge id": (HEADER + f"0,0,{'9' * 5000},0,0\n", "line 2, column ped_id must name somebody in 1 to 200 letters"),
    "short row": (HEADER + "0,0,1,0\n", "line 2 must have 5 cells, got 4"),
    "long row": (HEADER + "0,0,1,0,0,0\n", "line 2 must have 5 cells, got 6"),
    "decimal commas": (HEADER + "0,0,5,1,0,5,0,5\n", "have 5 cells, got 8; decimals need a point"),
    "two signs": ("t_s;id;x_m;y_m\n0,5;1;1,5;0\n1,0;1;1.7;0\n", "line 3, column x_m .*others have commas"),
    "two places": (HEADER + "0,0,1,0,0\n0,0,1,1,1\n", "line 3 must have one position of a person at one instant"),
    "no text": (HEADER.encode() + b"0,0,1,\0,0\n", "line 2 must be text, got a null character"),
    "binary": (bytes(range(256)), "must"),
    "open quote": (HEADER + '0,0,1,"0,0\n', "line 2 must close each quote"),
}


@pytest.mark.parametrize(("text", "message"), BAD_FILES.values(), ids=BAD_FILES.keys())
def test_a_bad_file_is_an_error_that_says_where(tmp_path: Path, text: str | bytes, message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        io.load_people(written(tmp_path, text))


def test_a_missing_file_is_an_error(tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError, match=r"path must name a readable file, got .*nobody\.csv"):
        io.load_people(tmp_path / "nobody.csv")


def test_a_folder_is_not_a_recording(tmp_path: Path) -> None:
    with pytest.raises(InvalidParameterError, match="path must name a readable file"):
        io.load_people(tmp_path)


@pytest.mark.parametrize(
    ("fields", "error"),
    [
        ({"time_s": []}, HrsafetyError),
        ({"time_s": [[0.0], [1.0]]}, ShapeError),
        ({"time_s": [0.0, np.nan]}, InvalidParameterError),
        ({"time_s": [1.0, 0.0]}, InvalidParameterError),
        ({"time_s": [0.0, 0.0]}, InvalidParameterError),
        ({"time_s": ["a", "b"]}, InvalidParameterError),
        ({"person": [1]}, ShapeError),
        ({"person": [1.0, 1.0]}, InvalidParameterError),
        ({"position": [[0, 0]]}, ShapeError),
        ({"position": [[0, 0, 0], [1, 0, 0]]}, ShapeError),
        ({"position": [[0, 0], [np.inf, 0]]}, InvalidParameterError),
        ({"position": [[0, 0], [1]]}, InvalidParameterError),
    ],
)
def test_bad_arrays_make_no_recording(fields: dict[str, object], error: type[HrsafetyError]) -> None:
    with pytest.raises(error):
        Recording(**{"time_s": [0.0, 1.0], "person": [1, 1], "position": [[0, 0], [1, 0]], **fields})


def test_load_track_reads_time_and_position(tmp_path: Path) -> None:
    time, position = io.load_track(written(tmp_path, "y_m,t_s,x_m\n1,0,2\n3,0.5,4\n"))
    assert time.tolist() == [0.0, 0.5]
    assert position.tolist() == [[2.0, 1.0], [4.0, 3.0]]


@pytest.mark.parametrize("second", ["0,1,1", "-1,1,1"])
def test_a_track_must_go_on_in_time(tmp_path: Path, second: str) -> None:
    with pytest.raises(InvalidParameterError, match=r"line 3, column t_s must be later than 0\.0"):
        io.load_track(written(tmp_path, f"t_s,x_m,y_m\n0,0,0\n{second}\n"))


@pytest.mark.parametrize(
    ("name", "rows", "people", "duration"), [("zara01", 5024, 148, 360.4), ("zara03", 3600, 180, 299.2)]
)
def test_the_recorded_scenes_are_read_whole(name: str, rows: int, people: int, duration: float) -> None:
    path = PEDESTRIANS / f"{name}.csv"
    if not path.is_file():
        pytest.skip(f"needs {path.name} of the pedestrian data (HRSAFETY_SHARED)")
    recording = io.load_people(path)
    assert len(recording) == rows
    assert len(recording.people()) == people
    assert recording.duration == pytest.approx(duration, abs=1e-9)
    assert sum(len(recording.track(int(person))[0]) for person in recording.people()) == rows


def test_who_is_away_for_long_under_one_id_is_told() -> None:
    time = [0.0, 0.4, 0.8, 1.2, 40.0, 40.4]
    walk = datasets.Recording(time_s=time, person=[7] * 6, position=[(0.5 * k, 0.0) for k in range(6)])
    assert [each.code for each in walk.warnings] == ["gap_in_track"]
    assert "person 7 is not seen for 38.8 s after 1.2 s" in str(walk.warnings[0])
    # Few rows of everybody are no gaps.
    few = datasets.Recording(time_s=[0.0, 0.4, 20.0], person=[7] * 3, position=[(0, 0), (1, 0), (2, 0)])
    assert [each.code for each in few.warnings] == ["implausible"]
    apart = datasets.Recording(time_s=time, person=[7, 7, 7, 7, 8, 8], position=[(0.5 * k, 0.0) for k in range(6)])
    assert apart.warnings == ()
