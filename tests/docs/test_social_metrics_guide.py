"""The guide to the social metrics lists them as the core declares them."""

from __future__ import annotations

from pathlib import Path

from hrsafety import navigation as nav

GUIDE = (Path(__file__).resolve().parents[2] / "docs" / "guides" / "social_metrics.md").read_text(encoding="utf-8")


def test_guide_lists_every_metric_in_order() -> None:
    declared = [*nav.metrics.METRICS.values(), *nav.metrics.WORLD_METRICS.values()]
    rows = [f"| `{each.name}` | {each.kind} | {each.unit} | {each.meaning} |" for each in declared]
    assert [line for line in GUIDE.splitlines() if line.startswith("| `")] == rows
