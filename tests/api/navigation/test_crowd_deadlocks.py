"""People who block each other where nothing is asymmetric, and how far models are from people in a laboratory."""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np
import pytest

from hrsafety import InvalidParameterError, scenarios
from hrsafety import navigation as nav

DOCS = Path(__file__).resolve().parents[3] / "docs"
SYMMETRIC = (
    nav.crowd.CollisionFreeSpeed(),
    nav.crowd.SocialForce2000(),
    nav.crowd.ReciprocalAvoidance(),
    nav.crowd.SocialForce1995(),
)


def arrived(model: nav.crowd.Pedestrian, aside: float) -> bool:
    people = [
        nav.Person(start=(-4 * side, aside * side), route=[(4 * side, aside * side)], model=model, desired_speed=1.3)
        for side in (1, -1)
    ]
    run = nav.simulate(nav.World(people=people, time_limit=30.0))
    there = bool(np.isfinite(run.person_arrival_time).all())
    # Who steps back and forth before the other does not stand.
    stands = not there and not isinstance(model, nav.crowd.CollisionFreeSpeed)
    assert nav.crowd.world_metrics(run).deadlocked_share == (1.0 if stands else 0.0)
    return there


@pytest.mark.parametrize("model", SYMMETRIC, ids=lambda model: type(model).__name__)
def test_who_meets_exactly_head_on_does_not_pass_unless_a_model_has_a_side(model: nav.crowd.Pedestrian) -> None:
    assert not arrived(model, 0.0)
    assert arrived(model, 1e-6)
    assert arrived(nav.crowd.Moussaid(), 0.0)


@pytest.mark.parametrize("seed", range(3))
def test_a_circle_is_disturbed_enough_for_people_who_avoid_each_other(seed: int) -> None:
    model = nav.crowd.ReciprocalAvoidance()
    free, blocked = (
        nav.simulate(scenarios.antipodal(20, model=model, seed=seed, **given)) for given in ({}, {"disturbance": 1e-3})
    )
    assert np.isfinite(free.person_arrival_time).all()
    assert np.isnan(blocked.person_arrival_time).any()
    with pytest.raises(InvalidParameterError, match="disturbance"):
        scenarios.antipodal(3, disturbance=-1.0)


def test_misses_of_the_laboratory_are_those_of_the_page() -> None:
    sys.path.insert(0, str(DOCS))
    try:
        import measure_crowds
        import page_tables
    finally:
        sys.path.remove(str(DOCS))
    page = (DOCS / "validation.md").read_text(encoding="utf-8")
    told = page_tables.written(page, "laboratory of measure_crowds.py").splitlines()
    rows = [[cell.strip() for cell in line.strip("|").split("|")] for line in told if line.startswith("| ")]
    models = (nav.crowd.CollisionFreeSpeed(time_gap=0.5), nav.crowd.CollisionFreeSpeed())
    chosen = (4, 10)
    density = np.array([measure_crowds.CORRIDOR[index][0] for index in chosen])
    for column, model in enumerate(models, start=2):
        walked = measure_crowds.walked(model, density)
        shown = [row[column] for row in rows if row[0] in {f"{each:.2f}" for each in density}]
        assert shown == [f"{speed:.2f}" for speed in walked]
    assert [row[1] for row in rows if row[0] == f"{density[0]:.2f}"] == [f"{measure_crowds.CORRIDOR[4][1]:.2f}"]
