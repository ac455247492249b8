"""Ranks of entries with their uncertainty."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from hrsafety import arena
from hrsafety.errors import InvalidParameterError, ShapeError


def test_ranks_are_those_of_the_cases(shared: Path) -> None:
    case = json.loads((shared / "spec" / "arena_cases.json").read_text(encoding="utf-8"))["ranks"]
    found = arena.ranks(case["success"])
    for name in ("median", "low", "high"):
        assert getattr(found, name).tolist() == case[name]
    assert found.score == pytest.approx(case["score"], rel=5e-12)


def test_equal_entries_share_a_place() -> None:
    one = np.ones((1, 3, 5))
    found = arena.ranks(np.concatenate([one, one, 0.0 * one]))
    assert found.median.tolist() == [1.5, 1.5, 3.0]
    assert found.low.tolist() == found.high.tolist() == found.median.tolist()


def test_what_is_no_success_is_refused() -> None:
    with pytest.raises(ShapeError, match="success"):
        arena.ranks([[1, 0]])
    with pytest.raises(InvalidParameterError, match="success"):
        arena.ranks([[[0.5]]])
    with pytest.raises(InvalidParameterError, match="success"):
        arena.ranks([[[float("nan")]]])
    with pytest.raises(InvalidParameterError, match="replicates"):
        arena.ranks([[[1]]], replicates=0)
