"""Doubts of sweeps whose scenes are made by a function: whichever row they are of, or that nobody looked."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety import sweep

NOT_LOOKED_AT = "rows_not_looked_at"
AWAY = 3.0


def crossing(row: dict[str, float]) -> nav.Scenario:
    """Return somebody on the way of the robot, who starts beside it for the place 0."""
    place = (0.61, 0.0) if row["place"] == 0.0 else (row["place"], AWAY)
    person = nav.Human(start=place, velocity=(0.0, 0.0))
    return nav.Scenario(start=(0.0, 0.0), goal=(6.0, 0.0), obstacles=[person], time_limit=20.0)


def places(*values: float) -> sweep.Axis:
    """Return an axis of places."""
    return sweep.Axis(name="place", unit="m", values=values)


def codes(design: sweep.Design) -> set[str]:
    """Return the codes of the doubts of a sweep."""
    study = sweep.NavigationStudy(scenario=crossing, outputs=("outcome",))
    return {each.code for each in sweep.run(design, study, threads=1).warnings}


SCENE = crossing({"place": 0.0})
DOUBT = next(iter(each.code for each in SCENE.warnings))


def test_a_row_in_the_middle_is_looked_at() -> None:
    assert codes(sweep.Grid([places(-3.0, 0.0, 3.0)])) == {DOUBT}
    assert codes(sweep.Grid([places(-3.0, 2.0, 3.0)])) == set()


@settings(max_examples=10, deadline=None)
@given(st.integers(2, 64), st.data())
def test_every_row_of_few_is_looked_at(size: int, data: st.DataObject) -> None:
    doubtful = data.draw(st.integers(0, size - 1))
    values = np.linspace(1.0, 3.0, size)
    values[doubtful] = 0.0
    assert codes(sweep.Grid([places(*values)])) == {DOUBT}


def test_the_result_says_of_how_many_rows_nobody_looked() -> None:
    study = sweep.NavigationStudy(scenario=crossing, outputs=("outcome",))
    (found,) = sweep.run(sweep.Grid([places(*np.linspace(1.0, 3.0, 65))]), study, threads=1).warnings
    assert (found.code, found.subject, found.safe_side) == (NOT_LOOKED_AT, "scenario", False)
    assert "64 of 65 rows" in found.message


def test_gains_make_no_other_scenes() -> None:
    gains = sweep.Axis(name="detour_gain", values=np.linspace(10.0, 20.0, 65))
    assert codes(sweep.Grid([places(2.0, 3.0), gains])) == set()
    assert codes(sweep.Grid([gains, places(2.0, 0.0, 3.0)])) == {DOUBT}


@pytest.mark.parametrize("design", [sweep.Sobol, sweep.LatinHypercube])
def test_samples_are_looked_at_to_their_end(design: type[sweep.Sobol | sweep.LatinHypercube]) -> None:
    axis = sweep.Axis(name="place", unit="m", low=1.0, high=3.0)
    rows, total = design([axis], 128).spread(64)
    assert (len(rows["place"]), total) == (64, 128)
    assert rows["place"][[0, -1]].tolist() == design([axis], 128).rows()[[0, -1], 0].tolist()
    assert NOT_LOOKED_AT in codes(design([axis], 128))
    assert NOT_LOOKED_AT not in codes(design([axis], 64))
