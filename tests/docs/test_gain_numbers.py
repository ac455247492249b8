"""Tables of appendix C in the documents are those that the package computes."""

from __future__ import annotations

import runpy
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]


def test_tables_of_appendix_c_are_what_is_computed() -> None:
    script = runpy.run_path(str(REPOSITORY / "docs" / "measure_gains.py"))
    validation = (REPOSITORY / "docs" / "validation.md").read_text(encoding="utf-8")
    assert script["written"](validation) == script["page"]()
    assert script["page"]().count("| no |") >= 7
