"""The page about failures says what the validation page measured."""

from __future__ import annotations

import re
from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"
SHARE = re.compile(r"\d+\.\d \(\d+\.\d to \d+\.\d\)")


def test_every_share_of_the_page_is_measured() -> None:
    page = (DOCS / "guides" / "where_laws_fail.md").read_text(encoding="utf-8")
    measured = set(SHARE.findall((DOCS / "validation.md").read_text(encoding="utf-8")))
    shown = SHARE.findall(" ".join(page.split()))
    assert len(shown) > 30
    assert set(shown) <= measured
