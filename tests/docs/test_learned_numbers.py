"""What the guide says of the learned law is what was measured."""

from __future__ import annotations

import re
from pathlib import Path

from page_tables import written

DOCS = Path(__file__).resolve().parents[2] / "docs"
NAMES = {
    "reciprocal avoidance": "reciprocal",
    "the same, shield": "reciprocal, shield",
    "learned": "learned",
    "learned, shield": "learned, shield",
}


def cells(text: str) -> list[list[str]]:
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line[:1] == "|"]


def plain(share: str) -> str:
    return share.replace(" %", "")


def test_the_guide_repeats_the_measured_table() -> None:
    measured = cells(written((DOCS / "validation.md").read_text(encoding="utf-8"), "table of measure_learned.py"))
    found = {row[1]: (row[2], row[4], row[5], row[3]) for row in measured if row[0] == "unseen, as the benchmark"}
    guide = (DOCS / "guides" / "gymnasium.md").read_text(encoding="utf-8")
    section = guide.split("## Train a policy and run it as a law")[1].split("\n## ")[0]
    said = {row[0]: tuple(plain(share) for share in row[1:5]) for row in cells(section) if row[0] in NAMES}
    assert said == {name: found[key] for name, key in NAMES.items()}


def test_no_shielded_robot_was_at_fault_and_the_learned_law_succeeds_more_often() -> None:
    measured = cells(written((DOCS / "validation.md").read_text(encoding="utf-8"), "table of measure_learned.py"))[2:]
    assert len(measured) == 20
    assert all(row[4].startswith("0.0 ") for row in measured if "shield" in row[1])
    low = {(row[0], row[1]): float(re.findall(r"[\d.]+", row[2])[1]) for row in measured}
    high = {(row[0], row[1]): float(re.findall(r"[\d.]+", row[2])[2]) for row in measured}
    for people in ("unseen, as the benchmark", "unseen, motion steps of 0.05 s", "seen", "unseen, 10 people"):
        assert low[people, "learned"] > high[people, "reciprocal"]
