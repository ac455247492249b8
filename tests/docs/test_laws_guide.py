"""The parameters that the guide to the laws lists are those that the laws have."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import pytest

from hrsafety import navigation as nav
from hrsafety.navigation.laws.known import LAWS as DECLARED

GUIDE = (Path(__file__).resolve().parents[2] / "docs" / "guides" / "laws.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| `(\w+)` \| `(\w+)` \| (?:\$(\S+)\$ )?\| (\S+) \| (.*?) ?\| (\w+) \| (.+?) \|$", re.MULTILINE)
ROWS = {(law, name): rest for law, name, *rest, _ in ROW.findall(GUIDE)}
LAWS = tuple(DECLARED.values())


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.__name__)
def test_guide_lists_the_defaults_of_the_law(law: type[nav.Law]) -> None:
    default = law()
    explained_elsewhere = law is nav.VirtualForceField  # all but its gains
    fields = [field.name for field in dataclasses.fields(default) if field.init]  # type: ignore[arg-type]  # every law is a dataclass
    for name in law.GAIN_NAMES if explained_elsewhere else fields:
        symbol, shown, unit, _ = ROWS[law.__name__, name]
        value = getattr(default, name)
        model = isinstance(value, nav.crowd.Pedestrian)
        assert shown == (f"{type(value).__name__}()" if model else str(value)), name
        assert unit == law.GAIN_UNITS.get(name, ""), name
        assert symbol.replace("\\", "") == law.GAIN_SYMBOLS.get(name, "") or name not in law.GAIN_NAMES, name


def test_guide_lists_nothing_that_is_not_there() -> None:
    known = {(law.__name__, field.name) for law in LAWS for field in dataclasses.fields(law)}  # type: ignore[arg-type]  # as above
    assert set(ROWS) <= known


def test_every_default_has_an_origin_that_the_guide_explains() -> None:
    origins = {origin for *_, origin in ROWS.values()}
    assert origins <= {"source", "authors", "search", "choice"}
