"""Runs of the follower on one thread beside the same loop compiled by numba.

Recorded beside the times: runs per second of processor time, taken in turn so that a busy machine
hurts both alike, and the collision rates of both with their 95 % intervals. Nothing here asserts a
time; the rates are.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from typing import Any

import pytest

import peer_follower_numba
from hrsafety import reactive
from hrsafety._statistics import Share, wilson

RUNS = 300
ROUNDS = 3
CASES = [(kind, law) for kind in peer_follower_numba.KINDS for law in ("conventional", "active")]


def per_second(work: Callable[[], object], runs: int) -> float:
    """Return runs per second of processor time."""
    started = time.process_time()
    work()
    return runs / (time.process_time() - started)


def apart(one: Share, other: Share) -> bool:
    """Return whether two intervals do not overlap."""
    return one.low > other.high or other.low > one.high


@pytest.mark.parametrize(("kind", "law"), CASES)
def test_runs_of_the_follower(benchmark: Any, kind: str, law: str) -> None:
    """Selection of the layouts included, as in the peer: two runs a layout."""

    def package() -> reactive.FollowerExperiment:
        return reactive.experiment(kind, law, layouts=RUNS, threads=1)  # type: ignore[arg-type]  # words of the call

    def peer() -> int:
        return peer_follower_numba.touches(kind, law, RUNS)

    own, theirs = package().collision_rate, wilson(peer(), RUNS)
    rates = [(per_second(package, 2 * RUNS), per_second(peer, 2 * RUNS)) for _ in range(ROUNDS)]
    benchmark.extra_info |= {
        "runs_per_cpu_second": max(rate for rate, _ in rates),
        "numba_runs_per_cpu_second": max(rate for _, rate in rates),
        "collision_rate": own.value,
        "numba_collision_rate": theirs.value,
    }
    benchmark.pedantic(package, rounds=ROUNDS)
    assert not apart(own, theirs)
