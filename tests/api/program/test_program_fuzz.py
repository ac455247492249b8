"""Files of programs, arms and records with other numbers in them: judged, or refused with an error of the package."""

from __future__ import annotations

import random
import warnings
from pathlib import Path

from fuzz.programs import misnumbered, programs
from fuzz.readers import damaged
from hrsafety import HrsafetyError

EACH = 8


def test_damaged_programs_arms_and_records_are_judged_or_refused(tmp_path: Path) -> None:
    warnings.simplefilter("ignore")
    answers: dict[str, set[str]] = {}
    for name, (path, judge) in programs(tmp_path).items():
        right = path.read_bytes()
        for number in range(EACH):
            draws = random.Random(f"{name} {number}")
            path.write_bytes((misnumbered if number % 2 else damaged)(right, draws))
            try:
                judge(path)
                answers.setdefault("result", set()).add(name)
            except HrsafetyError as error:
                answers.setdefault("error" if str(error) else "silent", set()).add(name)
        path.write_bytes(right)
    assert "silent" not in answers
    assert len(answers["error"]) > 5
    assert len(answers["result"]) > 3
