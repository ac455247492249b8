"""Classes of robots by what their manipulators can do."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import Any

import pytest

from hrsafety import standards
from hrsafety.errors import InvalidParameterError

_SHARED = Path(os.environ.get("HRSAFETY_SHARED", Path(__file__).resolve().parents[4] / "shared"))
CASES: list[dict[str, Any]] = json.loads((_SHARED / "spec" / "program_cases.json").read_text(encoding="utf-8"))[
    "robot_class"
]


@pytest.mark.parametrize("case", CASES)
def test_classes(case: dict[str, Any]) -> None:
    found = standards.robot_class(**{name: case[name] for name in ("mass", "speed", "force", "limited_by")})
    assert (found.result, list(found.reasons)) == (case["result"], case["reasons"])
    assert [each.code for each in found.warnings] == ["single_source"]


def test_what_is_not_told_establishes_nothing() -> None:
    assert standards.robot_class().reasons == ("not given: mass, speed, force, limited_by",)
    # A robot that is slow by its settings alone is none of class I, whatever else is missing.
    assert standards.robot_class(mass=5.0, speed=0.2, force=20.0).result == "not_established"
    with pytest.raises(InvalidParameterError, match="mass"):
        standards.robot_class(mass=-1.0)
