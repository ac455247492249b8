"""Robots without a program: drawn motions, quantiles with intervals, and verdicts by them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from api.program.chains import chain, example
from hrsafety import program
from hrsafety.cli.file_kinds import starter
from hrsafety.errors import InvalidParameterError
from hrsafety.pages.report import json_text
from hrsafety.program.draws import quantiles_of

FREE = {"clamped": False, "reason": "nothing stands behind"}
LEVELS = (0.5, 0.95, 0.99)


def drawn(speed: float | None = 0.1, draws: int = 2000, **more: Any) -> program.DrawnProgram:
    """Return a robot without a program beside a chest."""
    motion = program.DrawnMotions(arm=example(), velocity=2.0, draws=draws)
    given: dict[str, Any] = {
        "points": [program.ContactPoint(name="gripper", link="tool", area=1e-4)],
        "segments": [program.Segment(regions=["chest"], **FREE)],
        "tcp_speed": speed,
    }
    return program.DrawnProgram(motion=motion, **(given | more))


@pytest.mark.parametrize("size", [400, 1000, 20_000])
def test_intervals_of_quantiles_are_those_of_the_binomial_distribution(size: int) -> None:
    stats = pytest.importorskip("scipy.stats")
    ranks = np.arange(1.0, size + 1.0)
    for found in quantiles_of(np.random.default_rng(size).permutation(ranks), LEVELS):
        below = stats.binom(size, found.level)
        # Widest ranks that still leave at most 2.5 % beyond each end.
        assert below.cdf(found.low - 1) <= 0.025 < below.cdf(found.low)
        assert below.sf(found.high - 1) <= 0.025 < below.sf(found.high - 2)
        assert found.value == np.ceil(found.level * size)


def test_too_few_draws_have_no_upper_end() -> None:
    (found,) = quantiles_of(np.arange(100.0), (0.99,))
    assert found.high == np.inf
    with pytest.raises(InvalidParameterError, match=r"draws must be at least 368 for a quantile of 0.99"):
        drawn(draws=200, accept_quantile=0.99)


def test_the_worst_draw_counts_and_is_doubted_until_a_quantile_is_accepted() -> None:
    slow = drawn()
    study = slow.report()
    assert study.verdict == "not_checked"
    assert [each.code for each in study.warnings] == ["motions_drawn"]
    assert study.rows[0].share <= 1.0
    assert drawn(accept_quantile=0.99).report().verdict == "within_limits"
    assert drawn(confirmed={"motions_drawn": "poses are fenced, J. Doe"}).report().verdict == "within_limits"


def test_a_quantile_is_held_by_its_upper_end_beside_the_worst() -> None:
    fast = drawn(0.5)
    level = 0.95
    study = drawn(0.37, accept_quantile=level).report()
    row, shares = study.rows[0], study.fields["rows"][0]["shares"]
    accepted = next(each for each in shares[3:] if each["level"] == level)
    assert accepted["value"] <= accepted["high"] <= row.share == study.fields["rows"][0]["share_worst"]
    assert (row.verdict == "exceeds") == (accepted["high"] > 1.0 + 1e-9)
    assert fast.report().verdict == "exceeds"
    # The same draws: what is capped at a lower speed uses no more of a limit.
    assert 0.37 / 0.5 - 1e-9 <= study.rows[0].share / fast.report().rows[0].share <= 1.0


def test_draws_are_as_fast_as_the_joints_and_the_tool_allow() -> None:
    motion = program.DrawnMotions(arm=example(), velocity=[2.0, 2.0, 2.5, 3.0, 3.0, 3.0], draws=500)
    joints, rates = motion.drawn()
    assert np.abs(rates / motion.rates_most).max(axis=1) == pytest.approx(1.0)
    low, high = example().limits.T
    assert ((joints >= low) & (joints <= high)).all()
    one = drawn(0.2).report()
    assert one.rows[0].speed <= 0.2 * (1.0 + 1e-9)
    assert json_text(one.fields) == json_text(drawn(0.2).report(threads=2).fields)


def test_masses_near_singular_poses_are_told() -> None:
    arm = chain(2, [0.4, 0.3], [2.0, 1.0])
    motion = program.DrawnMotions(arm=arm, draws=20_000)
    point = program.ContactPoint(name="tip", link="link2", point=(0.3, 0.0, 0.0), area=1e-4)
    free = program.Segment(regions=["chest"], **FREE)
    task = program.DrawnProgram(motion=motion, points=[point], segments=[free], direction="worst")
    (masses,) = task.report().masses
    # A planar arm: m2 + m1/sin^2 of its elbow along link 2, which is above ten medians in this share of the poses.
    angle = np.random.default_rng(1).uniform(-20.0, 20.0, 400_000)
    for one, exact in zip(masses.quantiles, np.quantile(1.0 + 2.0 / np.sin(angle) ** 2, LEVELS), strict=True):
        assert one.value <= exact * 1.1
    assert 0.0 < masses.near_singular < 0.25
    assert masses.worst > 10.0 * masses.quantiles[0].value


def test_a_file_without_a_path(tmp_path: Path) -> None:
    text = starter("program", "robot_program.toml")
    head, rest = text.split("[motion]")
    points = rest[rest.index("[[points]]") : rest.index("# What is within reach")]
    pads = rest[rest.index("[[coverings]]") : rest.index("# What pushes")]
    free = '[[segments]]\nregions = ["hand_finger"]\nclamped = false\nreason = "open"\n'
    motion = "[motion]\ndraws = 1000\naccept_quantile = 0.95\nvelocity = 2.0\ntcp_speed = 0.05\n"
    path = tmp_path / "any.toml"
    path.write_text(head + motion + points + free + pads, encoding="utf-8")
    task = program.load_program(path)
    assert isinstance(task, program.DrawnProgram)
    assert task.report().verdict in ("within_limits", "exceeds")
    for wrong, message in (
        ("acceleration = 3.0\n", "motion.acceleration must be left out beside draws"),
        ('log = "a.csv"\n', "motion.log must be left out beside draws"),
    ):
        path.write_text(head + motion + wrong + points + free + pads, encoding="utf-8")
        with pytest.raises(InvalidParameterError, match=message):
            program.load_program(path)
    path.write_text(text.replace("tcp_speed = 0.5 ", "accept_quantile = 0.99\n#"), encoding="utf-8")
    with pytest.raises(InvalidParameterError, match=r"motion.accept_quantile must come with draws"):
        program.load_program(path)
    path.write_text(head + motion + points + free.replace("reg", 'from = "a"\nreg') + pads, encoding="utf-8")
    with pytest.raises(InvalidParameterError, match=r"segments\[0\].from must be left out without a program"):
        program.load_program(path)


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"accept_quantile": 1.0}, "accept_quantile must be at least 0.9 and below 1"),
        ({"accept_quantile": 0.5}, "accept_quantile must be at least 0.9 and below 1"),
        ({"separation": {"reaction_time": 0.1}}, "separation must be left out without a program"),
        ({"segments": []}, "segments must be 1 to"),
    ],
)
def test_drawn_programs_that_are_refused(more: dict[str, Any], message: str) -> None:
    with pytest.raises(InvalidParameterError, match=message):
        drawn(**more)


def test_a_path_needs_segments_with_ends() -> None:
    motion = program.ArmMotion.from_waypoints(example(), {"turn": [0.0, 0.5, 1.0]}, acceleration=4.0)
    point = program.ContactPoint(name="gripper", link="tool", area=1e-4)
    with pytest.raises(InvalidParameterError, match=r"segments\[0\].from must be a time"):
        program.Program(motion=motion, points=[point], segments=[program.Segment(regions=["chest"], **FREE)])
