"""Margins of runs that somebody recorded: what a record says against itself keeps no limit."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from hrsafety import contact, standards
from hrsafety import navigation as nav
from hrsafety.plausibility import unsafe_doubts
from hrsafety.scenarios import configuration

LEG = standards.limits().contact("lower_leg", "transient")
BASE = contact.HolonomicBase(mass=4.4, inertia=0.1)
TIME = np.linspace(0.0, 4.0, 81)


def run(speed: float = 0.1, told: float | None = None, heading: object = 0.0, **more: Any) -> SimpleNamespace:
    still = np.zeros_like(TIME)
    made = {
        "time": TIME,
        "position": np.column_stack([speed * TIME, still]),
        "velocity": np.column_stack([still + (speed if told is None else told), still]),
        "heading": np.broadcast_to(np.asarray(heading, dtype=float), TIME.shape),
        "obstacle_position": np.broadcast_to([3.0, 0.0], (len(TIME), 1, 2)).copy(),
    }
    return SimpleNamespace(**made | more)


def judged(trajectory: object) -> contact.ContactMargins:
    return contact.contact_margins(
        trajectory, base=BASE, covering=None, regions=[LEG], robot_radius=0.2, person_radius=0.1, area=1e-3
    )


def codes(found: contact.ContactMargins) -> list[str]:
    return [each.code for each in unsafe_doubts(found.warnings)]


def test_an_ordinary_run_is_not_doubted() -> None:
    found = judged(run())
    assert (codes(found), set(found.verdict.ravel())) == ([], {"within_limits"})
    turning = np.arctan2(np.sin(3.0 * TIME), np.cos(3.0 * TIME))
    assert codes(judged(run(heading=turning))) == []
    noise = np.random.default_rng(0).normal(0.0, 0.025, (len(TIME), 2))
    assert codes(judged(run(position=run().position + noise))) == []
    for robot in (nav.HolonomicRobot(), nav.DifferentialDriveRobot()):
        scenario = replace(configuration("c1"), robot=robot)
        assert codes(judged(nav.simulate(scenario, nav.VirtualForceField()))) == []


@settings(max_examples=50, deadline=None)
@given(speed=st.floats(0.6, 2.0), share=st.floats(-1.0, 0.1))
@example(speed=1.0, share=0.0)  # stands in the person at one instant, where no direction leads to it
def test_velocities_that_positions_refute_keep_no_limit(speed: float, share: float) -> None:
    found = judged(run(speed, told=share * speed))
    assert set(codes(found)) == {"closing_speed_unknown"}
    assert "within_limits" not in found.verdict


def test_velocities_in_another_frame_are_told() -> None:
    sideways = np.column_stack([np.zeros_like(TIME), 0.5 * TIME])
    assert codes(judged(run(0.5, position=sideways))) == ["closing_speed_unknown"]


@pytest.mark.parametrize("heading", [90.0, np.linspace(0.0, 180.0, len(TIME))])
def test_headings_in_degrees_are_told(heading: object) -> None:
    found = judged(run(heading=heading))
    assert (codes(found), set(found.verdict.ravel())) == (["implausible"], {"not_checked"})


def test_nobody_is_absent_between_two_sights() -> None:
    places = run().obstacle_position
    places[:10] = places[30:50] = places[70:] = np.nan
    found = judged(run(obstacle_position=places))
    words = found.verdict.ravel()
    assert set(words[:10]) == set(words[70:]) == {"absent"}
    assert set(words[30:50]) == {"not_checked"}
    assert codes(found) == ["gap_in_track"]
    assert "20 of 81 rows" in found.warnings[-1].message
