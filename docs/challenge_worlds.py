"""Turn the worlds of the BARN challenge into the files that ``hrsafety benchmark`` reads.

``python docs/challenge_worlds.py CHECKOUT FOLDER``: CHECKOUT holds the public repository the-barn-challenge, FOLDER
gets barn_all.json with the 300 fields of cylinders and dynabarn.json with the 60 worlds of cylinders that move. Their
keyframes are published as compiled plugins only: they are read from the numbers that the instructions of each plugin
load, by ``objdump``, ``nm`` and ``readelf`` of GNU binutils. Nothing of the plugins is run.
"""

from __future__ import annotations

import itertools
import json
import math
import re
import struct
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np

BARN, DYNABARN = 300, 60
ENDS = {"": (-2.25, 3.0, 13.0), "_2022": (-2.0, 3.0, 13.0)}
"""Place across and both ends of the way, in m, by the years of the challenge."""
SPEED = 2.0
"""For the time that is best possible, in m/s."""
LONGEST = 0x40000
"""Most bytes of a function that sets keyframes."""

CONSTANT = re.compile(r"(movsd|mov)\s+0x\w+\(%rip\),%(xmm0|rax)\b.*# (\w+)")
KEPT = re.compile(r"(movsd|mov)\s+%(xmm0|rax),(-0x\w+)\(%rbp\)")
TAKEN = re.compile(r"movsd\s+(-0x\w+)\(%rbp\),%xmm0")
PLACE = re.compile(r"lea\s+(-0x\w+)\(%rbp\),(%r\w+)")


def field(checkout: Path, number: int) -> dict[str, Any]:
    """Return a field of cylinders with its reference path."""
    folder = checkout / "jackal_helper/worlds/BARN"
    text = (folder / f"world_{number}.world").read_text(errors="replace").split("<state")[0]
    cylinders = re.findall(r"<model name='unit_cylinder.*?<pose[^>]*>(\S+) (\S+)", text, re.S)
    cells = np.load(folder / "path_files" / f"path_{number}.npy")
    found: dict[str, Any] = {
        "id": number,
        "n": len(cylinders),
        "cyl_mm": [[round(float(axis) * 1000.0) for axis in place] for place in cylinders],
    }
    for year, (across, low, high) in ENDS.items():
        inner = [(0.15 * x - 4.575, 0.15 * y + 5.075) for x, y in cells.tolist()]
        way = [(across, low), *inner, (across, high)]
        length = sum(math.dist(*step) for step in itertools.pairwise(way))
        found |= {f"path_length{year}_m": length, f"optimal_time{year}_s": length / SPEED}
    return found


def output(*command: object) -> str:
    """Return what a program prints."""
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, check=True).stdout


def keyframes(plugin: Path) -> dict[str, Any]:
    """Return duration in s and keyframes (s, m, m) of a plugin, by following the numbers it loads."""
    start = next(int(line.split()[0], 16) for line in output("nm", plugin).splitlines() if "4LoadEN" in line)
    section = re.search(r"\.rodata\s+PROGBITS\s+(\w+)\s+(\w+)", output("readelf", "-SW", plugin))
    if section is None:
        sys.exit(f"{plugin} has no constants")
    address, offset = (int(part, 16) for part in section.groups())
    data = plugin.read_bytes()
    ends = (f"--start-address={start}", f"--stop-address={start + LONGEST}")
    registers: dict[str, float | None] = {}
    kept: dict[str, float | None] = {}
    places: dict[str, str] = {}
    frames: list[tuple[float | None, ...]] = []
    duration = time = None
    for line in output("objdump", "-d", "-C", "--no-show-raw-insn", *ends, plugin).splitlines():
        if "pxor" in line and "xmm0" in line:
            registers["xmm0"] = 0.0
        elif constant := CONSTANT.search(line):
            place = int(constant[3], 16) - address + offset
            inside = address - offset <= place + 8 <= len(data)
            registers[constant[2]] = struct.unpack_from("<d", data, place)[0] if inside else None
        elif move := KEPT.search(line):
            kept[move[3]] = registers.get(move[2])
        elif move := TAKEN.search(line):
            registers["xmm0"] = kept.get(move[1])
        elif move := PLACE.search(line):
            places[move[2]] = move[1]
        elif "PoseAnimation::PoseAnimation(" in line:
            duration = registers.get("xmm0")
        elif "CreateKeyFrame(" in line:
            time = registers.get("xmm0")
        elif "Vector3<double>::Vector3(double const" in line:
            frames.append((time, kept[places["%rsi"]], kept[places["%rdx"]]))
        elif "SetAnimation(" in line:
            break
    if duration is None or len(frames) < 2 or any(None in frame for frame in frames):
        sys.exit(f"{plugin} does not set its keyframes as the others do")
    return {"duration": duration, "keyframes": frames}


def main(checkout: Path, folder: Path) -> None:
    """Write both files."""
    folder.mkdir(parents=True, exist_ok=True)
    worlds = [field(checkout, number) for number in range(BARN)]
    (folder / "barn_all.json").write_text(json.dumps({"cylinder_radius_m": 0.075, "worlds": worlds}))
    movers: dict[str, list[str]] = {}
    for number in range(DYNABARN):
        text = (checkout / f"jackal_helper/worlds/DynaBARN/world_{number}.world").read_text(errors="replace")
        movers[str(number)] = re.findall(r"<plugin[^>]*filename='(\w*libobs_\d+)\.so'", text)
    names = sorted({name for each in movers.values() for name in each})
    trajectories = {name: keyframes(checkout / "jackal_helper/plugins" / f"{name}.so") for name in names}
    (folder / "dynabarn.json").write_text(json.dumps({"trajectories": trajectories, "worlds": movers}))


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:]))
