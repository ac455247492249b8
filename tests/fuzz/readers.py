"""Readers of files with a right file of each kind, and damage to files."""

from __future__ import annotations

import dataclasses
import functools
import random
import shutil
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from api.fuzzing import right_files
from api.recorded_files import people_files, walk
from fuzz.logs import add_logs
from fuzz.places import places
from fuzz.programs import programs
from hrsafety import arms, contact, io, sweep
from hrsafety import navigation as nav
from hrsafety.benchmarks.results import Row, read_rows, row_text
from hrsafety.cli import file_kinds
from hrsafety.standards import load_limits

__all__ = ["damaged", "readers"]

ROOT = Path(__file__).resolve().parents[2]
_KINDS = ("contact_base.toml", "foam_design.toml", "gain_study.toml", "impact_sweep.toml", "my_first_crossing.toml")


def _squared(x: Any) -> dict[str, Any]:
    return {"y": x * x}


def readers(folder: Path) -> dict[str, tuple[Path, Callable[[Path], Any]]]:
    """Write a right file of each kind into a folder and return their readers by name."""
    found = {f"read {path.name}": (path, reader) for path, reader in right_files(folder).items()}
    for name in _KINDS:
        file = Path(shutil.copy(ROOT / "examples" / name, folder))
        found[f"check {name}"] = (file, lambda path: file_kinds.kind_of(str(path)).check(str(path)))
    urdf = folder / "arm.urdf"
    urdf.write_text(arms.Arm.example().urdf, encoding="utf-8")
    found["Arm.from_urdf"] = (urdf, arms.Arm.from_urdf)
    _maps(folder, found)
    _tables(folder, found)
    _sweeps(folder, found)
    add_logs(folder, found)
    for form, (path, call) in people_files(folder, walk(rows=8, people=2)).items():
        if form == "juelich-hdf5":  # read by a process of its own, which takes a second
            continue
        found[f"load_people, {form}"] = (path, functools.partial(_people, call=call))
    return found | places(folder) | programs(folder)


def _people(path: Path, call: dict[str, Any]) -> Any:
    return io.load_people(path, **call)


def _maps(folder: Path, found: dict[str, tuple[Path, Callable[[Path], Any]]]) -> None:
    """Add a map of a map server: its picture and its description."""
    picture, text = folder / "floor.pgm", folder / "floor.yaml"
    picture.write_bytes(b"P5\n8 6\n255\n" + bytes(range(0, 240, 5)))
    text.write_text(
        "image: floor.pgm\nresolution: 0.1\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n"
        "occupied_thresh: 0.65\nfree_thresh: 0.196\n",
        encoding="utf-8",
    )
    found["StaticMap.from_map_server"] = (text, nav.maps.StaticMap.from_map_server)
    found["StaticMap.from_map_server, picture"] = (picture, lambda _path: nav.maps.StaticMap.from_map_server(text))


def _tables(folder: Path, found: dict[str, tuple[Path, Callable[[Path], Any]]]) -> None:
    """Add tracks, materials, limits and rows of a benchmark."""
    track = folder / "track.csv"
    track.write_text("t_s,x_m,y_m\n0.0,0.0,0.0\n0.1,0.1,0.0\n0.2,0.2,0.0\n", encoding="utf-8")
    found["load_track"] = (track, io.load_track)
    for name, reader, source in (
        ("materials.toml", contact.load_materials, _MATERIALS),
        ("press.csv", lambda path: contact.load_compression_test(path, thickness=0.02, area=0.01), _PRESS),
        ("limits.toml", load_limits, _LIMITS),
        ("limits.csv", load_limits, _LIMIT_ROWS),
        ("rows.csv", read_rows, _rows()),
    ):
        file = folder / name
        file.write_text(source, encoding="utf-8")
        found[f"read {name}"] = (file, reader)


def _rows() -> str:
    row = Row(case=0, outcome="arrived", arrival_time=1.0, end_time=1.0, contacts=0, at_fault=0, apart=0, clearance=0.1)
    return row_text([row, dataclasses.replace(row, case=1)], head=True)


_MATERIALS = '[[materials]]\nname = "soft"\nlaw = "linear"\nE = 1e5\nsource = "own test"\n'
_PRESS = "displacement_mm,force_N\n0,0\n1,40\n2,60\n6,90\n12,200\n"
_LIMITS = (
    'id = "own"\ntitle = "Own"\nedition = "1"\n'
    '[[limits]]\nregion = "chest"\ncontact = "transient"\nforce_N = 100.0\nsource = "own tests"\n'
)
_LIMIT_ROWS = "region,contact,force_N,source\nchest,transient,100,own tests\n"


def _sweeps(folder: Path, found: dict[str, tuple[Path, Callable[[Path], Any]]]) -> None:
    """Add the folder of a sweep: its description and a chunk."""
    out = folder / "sweep"
    study = sweep.FunctionStudy(function=_squared, results=["y"])
    sweep.run(sweep.Grid([sweep.Axis(name="x", low=0.0, high=1.0, points=8)]), study, out=out, chunk_rows=4)

    def opened(_path: Path) -> dict[str, np.ndarray]:
        return sweep.open(out).to_numpy()

    found["sweep.open, description"] = (out / "sweep.json", opened)
    found["sweep.open, chunk"] = (out / "chunks" / "chunk-00000000.npz", opened)


def damaged(content: bytes, draws: random.Random) -> bytes:
    """Return content that is cut off, longer, or has some bytes changed, moved or repeated."""
    kind = draws.randrange(6)
    place = draws.randrange(max(len(content), 1))
    if kind == 0:
        return content[:place]
    if kind == 1:
        return content[:place] + draws.randbytes(draws.randint(1, 20)) + content[place:]
    if kind == 2:
        end = min(place + draws.randint(1, 40), len(content))
        return content[:place] + content[end:]
    if kind == 3:
        end = min(place + draws.randint(1, 40), len(content))
        return content[:end] + content[place:end] * draws.randint(1, 5) + content[end:]
    changed = bytearray(content)
    for _ in range(draws.randint(1, 4)):
        at = draws.randrange(len(changed))
        changed[at] = draws.randrange(256) if kind == 4 else changed[at] ^ (1 << draws.randrange(8))
    return bytes(changed)
