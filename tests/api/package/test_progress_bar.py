"""The bar that long calls draw."""

from __future__ import annotations

import io

import pytest

from hrsafety import InvalidParameterError, impact, sweep
from hrsafety.progress import ProgressBar


def test_bar_of_a_sweep_is_one_line_that_ends() -> None:
    drawn = io.StringIO()
    study = sweep.ImpactStudy(manipulator=impact.MANIPULATOR_1, foam=impact.FOAM_1, head=impact.Head.minimum())
    speeds = sweep.Grid([sweep.Axis(name="closing_speed", low=0.2, high=2.0, points=10)])
    sweep.run(speeds, study, chunk_rows=3, progress=ProgressBar("speeds", file=drawn))
    text = drawn.getvalue()
    assert text.count("\n") == 1
    assert text.endswith("\n")
    last = text.split("\r")[-1]
    assert last.startswith("speeds ######################## 100 % 10/10 in ")


def test_stages_of_a_search_are_told_with_the_best_value() -> None:
    drawn = io.StringIO()
    told = ProgressBar(file=drawn)
    for stage in ("global", "local"):
        for done in range(3):
            told(stage, done, 2, 0.25 * done)
    lines = [each.split("\r")[-1] for each in drawn.getvalue().split("\n")[:-1]]
    assert [line.split()[0] for line in lines] == ["global", "local"]
    assert all("best 0.5 " in line for line in lines)


@pytest.mark.parametrize("told", [(), (1,), (1, 2, 3), ("half", 2), (1, 2, 3, 4)])
def test_what_is_no_progress_is_refused(told: tuple[object, ...]) -> None:
    with pytest.raises(InvalidParameterError, match=r"be \(done, total\)"):
        ProgressBar()(*told)
