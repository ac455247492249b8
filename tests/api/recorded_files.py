"""The same recorded people in a file of each layout, with what a reader has to be told."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import h5py
import numpy as np

from hrsafety import io
from hrsafety.datasets import Recording

__all__ = ["WRITTEN", "people_files", "walk"]

WRITTEN = ("people.csv", "people.txt", "people.sqlite", "people.ndjson", "people.json")
"""Files that the package writes itself."""
RATE = 30.0


def walk(*, step: int = 3, rate: float = RATE, people: int = 4, rows: int = 40, seed: int = 0) -> Recording:
    """Return people who walk on curves and are there at different times."""
    rng = np.random.default_rng(seed)
    time, who, place = [], [], []
    for person in range(people):
        frames = step * (np.arange(rows) + int(rng.integers(0, 20)))
        seconds = frames / rate
        time.append(seconds)
        who += [3 * person + 1] * rows
        turn = rng.uniform(0.2, 1.0)
        place.append(np.stack([1.2 * seconds, 2.0 * person + np.sin(turn * seconds)], axis=1))
    times, ids, places = np.concatenate(time), np.array(who), np.round(np.concatenate(place), 6)
    order = np.lexsort((ids, times))
    return Recording(time_s=times[order] - times.min(), person=ids[order], position=places[order], frame_rate=rate)


def people_files(folder: Path, recording: Recording) -> dict[str, tuple[Path, dict[str, Any]]]:
    """Write the recording, 30 frames a second, into a file of each layout; return the files and arguments by format."""
    found: dict[str, tuple[Path, dict[str, Any]]] = {}
    for name in WRITTEN:
        path = io.write_people(recording, folder / name)
        found[io.load_people(path).source.format] = (path, {})
    frames = np.rint(recording.time_s * RATE).astype(int).tolist()
    rows = list(zip(frames, recording.person.tolist(), *recording.position.T.tolist(), strict=True))
    moving = [(*row, *speed) for row, speed in zip(rows, recording.motion().velocity.tolist(), strict=True)]
    stamps = [1.35e9 + round(frame / RATE, 6) for frame in frames]
    polar = [(1e3 * np.hypot(vx, vy), np.arctan2(vy, vx)) for *_, vx, vy in moving]
    texts: dict[str, tuple[str, str, dict[str, Any]]] = {
        "eth": (
            "obsmat.txt",
            "".join(f"{f} {p} {x!r} 0 {y!r} {vx!r} 0 {vy!r}\n" for f, p, x, y, vx, vy in moving),
            {"fps": RATE},
        ),
        "trajnet": ("trajnet.txt", "".join(f"{f} {p} {x!r} {y!r}\n" for f, p, x, y in rows), {"step_s": 0.1}),
        "id frame x y z": (
            "hermes.txt",
            "".join(f"{p} {f} {100 * x:.4f} {100 * y:.4f} 170\n" for f, p, x, y in rows),
            {"fps": RATE, "unit": "cm"},
        ),
        "jupedsim-text": (
            "jupedsim.txt",
            "#framerate: 30.00\n#ID\tFR\tX\tY\tZ\n" + "".join(f"{p}\t{f}\t{x!r}\t{y!r}\t0\n" for f, p, x, y in rows),
            {},
        ),
        "table, decimal commas": (
            "zeit.csv",
            "Bild;Person;X [cm];Y [cm]\n"
            + "".join(f"{f};{p};{100 * x:.4f};{100 * y:.4f}\n".replace(".", ",") for f, p, x, y in rows),
            {"fps": RATE},
        ),
        "citr": (
            "ped.csv",
            "id,frame,label,x_est,y_est,vx_est,vy_est\n"
            + "".join(f"{p},{f},ped,{x!r},{y!r},{vx!r},{vy!r}\n" for f, p, x, y, vx, vy in moving),
            {"fps": RATE},
        ),
        "sdd": (
            "annotations.txt",
            "".join(_box(*row) for row in rows),
            {"scale": 0.01},
        ),
        "atc": (
            "atc.csv",
            "".join(
                f"{t:.6f},{p},{1e3 * x:.3f},{1e3 * y:.3f},1650,{v:.3f},{a:.6f},0\n"
                for t, (_, p, x, y), (v, a) in zip(stamps, rows, polar, strict=True)
            ),
            {},
        ),
        "ucy": ("people.vsp", _splines(rows), {"scale": 0.01, "fps": RATE}),
        "thor-magni": ("magni.csv", _magni(recording, frames), {}),
    }
    for form, (name, text, call) in texts.items():
        (folder / name).write_text(text, encoding="utf-8")
        found[form] = (folder / name, call)
    found["ind"] = (_ind(folder, moving), {})
    found["juelich-hdf5"] = (_hdf5(folder, rows), {})
    return found


def _box(frame: int, who: int, x: float, y: float) -> str:
    left, top, right, bottom = 100 * x - 5, -100 * y - 9, 100 * x + 5, -100 * y + 9
    return f'{who} {left:.4f} {top:.4f} {right:.4f} {bottom:.4f} {frame} 0 0 0 "Pedestrian"\n'


def _splines(rows: list[Any]) -> str:
    people = sorted({p for _, p, _, _ in rows})
    text = [f"{len(people)} - the number of splines"]
    for who in people:
        own = [row for row in rows if row[1] == who]
        text.append(f"{len(own)} - Num of control points")
        text += [f"{100 * x:.4f} {100 * y:.4f} {f} 0.0 - (2D point, m_id)" for f, _, x, y in own]
    return "\n".join(text) + "\n"


def _magni(recording: Recording, frames: list[int]) -> str:
    people = recording.people().tolist()
    names = [f"Helmet_{who} Centroid_{axis}" for who in people for axis in "XYZ"]
    lines = ["FILE_ID,made up", f"N_FRAMES_QTM,{len(frames)}", "MODALITIES_UNITS_SPECIFIED,mm"]
    lines.append(",".join(["Frame", "Time", *names]))
    places: dict[int, dict[int, Any]] = {}
    for frame, who, place in zip(frames, recording.person.tolist(), recording.position.tolist(), strict=True):
        places.setdefault(frame, {})[who] = place
    for frame in sorted(places):
        cells = [
            f"{1e3 * places[frame][who][0]:.3f},{1e3 * places[frame][who][1]:.3f},1700"
            if who in places[frame]
            else ",,"
            for who in people
        ]
        lines.append(",".join([str(frame), f"{frame / RATE:.6f}", *cells]))
    return "\n".join(lines) + "\n"


def _ind(folder: Path, moving: list[Any]) -> Path:
    place = folder / "07_tracks.csv"
    head = "recordingId,trackId,frame,xCenter,yCenter,heading,xVelocity,yVelocity\n"
    text = "".join(f"7,{p},{f},{x!r},{y!r},0,{vx!r},{vy!r}\n" for f, p, x, y, vx, vy in moving)
    place.write_text(head + text, encoding="utf-8")
    ids = sorted({row[1] for row in moving})
    meta = "recordingId,trackId,initialFrame,class\n" + "".join(f"7,{who},0,pedestrian\n" for who in ids)
    (folder / "07_tracksMeta.csv").write_text(meta, encoding="utf-8")
    (folder / "07_recordingMeta.csv").write_text("recordingId,frameRate\n7,30.0\n", encoding="utf-8")
    return place


def _hdf5(folder: Path, rows: list[Any]) -> Path:
    place = folder / "people.h5"
    with h5py.File(place, "w") as file:
        kind = [("id", int), ("frame", int), ("x", float), ("y", float)]
        data = file.create_dataset("trajectory", data=np.array([(p, f, x, y) for f, p, x, y in rows], dtype=kind))
        data.attrs["fps"] = RATE
        file.attrs["wkt_geometry"] = "POLYGON ((-9 -9, 30 -9, 30 30, -9 30, -9 -9))"
    return place
