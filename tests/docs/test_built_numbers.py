"""What the guide to robots as built says follows from the tables beside it."""

from __future__ import annotations

import re
from pathlib import Path

GUIDE = (Path(__file__).resolve().parents[2] / "docs" / "guides" / "built.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| (c\d), (\S+ mm|mean 4 mm), (\w+) \| (.+) \|$", re.MULTILINE)
TABLE = re.compile(r"^\| (New\*?), stabilizing force (\w+) \|.*\n\|[-|]+\n((?:\|.*\n)+)", re.MULTILINE)
SIDES = ("afresh", "3.0", "3.05")


def successes() -> dict[tuple[str, str, str, str, str], dict[str, float]]:
    """Return the percentage of successes by gains, mode, configuration, error and body, then by side."""
    found = {}
    for gains, mode, rows in TABLE.findall(GUIDE):
        for name, error, body, cells in ROW.findall(rows):
            values = [float(cell.split()[0]) for cell in cells.split(" | ")]
            found[gains, mode, name, error, body] = dict(zip(SIDES, values, strict=True))
    return found


def test_all_conditions_are_in_the_tables() -> None:
    # c2 and c4 with three noisy bodies, c1 and c3 with the robot only; two errors, two gain sets, two modes.
    assert len(successes()) == (2 * 3 + 2) * 2 * 4


def test_recommended_side_loses_nothing_with_the_default_gains() -> None:
    rows = [row for key, row in successes().items() if key[0] == "New"]
    assert all(row["3.05"] >= row["afresh"] for row in rows)
    assert min(row["3.05"] for row in rows) >= 97.0


def test_text_quotes_the_table() -> None:
    rows = successes()
    coarse = [rows["New", "capped", "c2", "±25 mm", body] for body in ("person", "both")]
    fine = [rows["New", "capped", "c2", "mean 4 mm", body] for body in ("person", "both")]
    assert {round(row["afresh"]) for row in coarse} <= {31, 32}
    assert sorted(row["3.05"] for row in coarse) == [98.6, 99.5]
    assert "98.6 to 99.5 %" in GUIDE
    assert {round(row["afresh"]) for row in fine} == {89, 90}
    assert {row["3.05"] for row in fine} == {100.0}
    worst = min(
        rows["New", "capped", "c4", error, body]["3.0"]
        for error in ("±25 mm", "mean 4 mm")
        for body in ("both", "person")
    )
    assert 78.0 < worst < 80.0


def test_optimized_gains_pay_in_configuration_4() -> None:
    rows = [row for key, row in successes().items() if key[0] == "New*" and key[2] == "c4"]
    assert all(row["3.05"] <= row["afresh"] for row in rows)
