"""Time is stepped in one place, and the lane kernel is its fast path."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

CRATES = Path(__file__).resolve().parents[3] / "crates"
PARTS_OF_THE_CORE = ("navigation_world", "navigation_laws", "navigation_runs")
ROBOTS, RUN, CROWD = "navigation_world/src/robots/", "navigation_runs/src/run/", "navigation_runs/src/crowd/"
LOOP = f"{RUN}episode.rs"
# The fast path of ideal point masses, side by side with a scene and gains each, or by themselves.
KERNELS = {f"{RUN}lanes/kernel.rs"}
# No episode: a reference that is given over time is tracked, or a wheel turns on a bench; nothing is sensed, no law
# decides and nothing ends them.
WITHOUT_EPISODE = {f"{ROBOTS}differential/track.rs", f"{ROBOTS}wheels/open_loop.rs"}
# Periods of the wheels' own controllers within a motion step.
WITHIN_A_STEP = {f"{ROBOTS}drives/driven.rs"}
# Steps of worlds, each by the loop, between two commands of a learner.
BETWEEN_COMMANDS = {f"{CROWD}environments/block.rs"}
# A loop over steps or instants: counted, or as long as something runs.
TIME_LOOP = re.compile(
    r"\bfor (?:step|time|instant|sample|period)s? in \S*\.\."
    r"|\bfor \w+ in [^{]*\.\.[^{]*\b(?:steps|periods)(?:_per_\w+)?\b"
    r"|\bstep \+= 1\b|\bwhile !?[\w.]*(?:time|step|finished|ended)\b"
)
PARTS = re.compile(r"\bimpl\b[^{;]*\bParts for (\w+)")


def code(path: Path) -> str:
    """Return the source without comments and tests."""
    text = re.sub(r"(?s)\n#\[cfg\(test\)\]\nmod \w+ \{.*", "", path.read_text(encoding="utf-8"))
    return re.sub(r"//[^\n]*", "", text)


SOURCES = {
    path.relative_to(CRATES).as_posix(): code(path)
    for part in PARTS_OF_THE_CORE
    for path in sorted((CRATES / part / "src").rglob("*.rs"))
    if path.name != "tests.rs"
}


def test_the_search_finds_a_time_loop() -> None:
    loops = ("for step in 0..steps {", "for index in 0..=self.steps {", "self.step += 1;", "while !self.finished() {")
    for text in (*loops, "while time < duration {"):
        assert TIME_LOOP.search(text)
    for text in (
        "for gap in gaps {",
        "for (step, frame) in frames.iter_mut().enumerate() {",
        "while index < time.len() {",
    ):
        assert not TIME_LOOP.search(text)


def test_time_is_stepped_in_one_place() -> None:
    # A crowd is an episode of the loop; its metrics look back on what is over.
    stepped = {name: text for name, text in SOURCES.items() if name.startswith((RUN, ROBOTS, CROWD))}
    found = {name for name, text in stepped.items() if TIME_LOOP.search(text) and f"{CROWD}metrics" not in name}
    assert found == {LOOP} | KERNELS | WITHOUT_EPISODE | WITHIN_A_STEP | BETWEEN_COMMANDS


def test_only_the_loop_moves_and_senses() -> None:
    for method in ("travel", "look_around", "time_over"):
        callers = {name for name, text in SOURCES.items() if re.search(rf"\.{method}\(", text)}
        assert callers == {LOOP}, method


def test_every_robot_is_stepped_by_the_loop() -> None:
    kinds = {kind for text in SOURCES.values() for kind in PARTS.findall(text)}
    assert {"Navigation", "FollowerParts", "SkirtParts", "PursuitParts", "CrowdParts"} <= kinds


@pytest.mark.parametrize("name", sorted(name for name, text in SOURCES.items() if re.search(r"\.step\(\)", text)))
def test_drives_step_within_a_motion_step_only(name: str) -> None:
    text = SOURCES[name]
    if name.startswith(RUN):
        assert PARTS.search(text)
        assert len(re.findall(r"\.step\(\)", text)) == 1
