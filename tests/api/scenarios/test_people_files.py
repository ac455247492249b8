"""Files of recorded people in every known layout: what a right reader returns, asks for and doubts."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import io
from hrsafety.errors import FileError, HrsafetyError
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
