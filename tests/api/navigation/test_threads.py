"""Threads of batches: one is the calling thread, and more of them change no bit."""

from __future__ import annotations

import time

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios

EPISODES = [scenarios.random_traffic(3, seed=seed) for seed in range(40)]


def test_one_thread_is_the_calling_one() -> None:
    law = nav.VirtualForceField()
    nav.simulate_batch(EPISODES, law, threads=1)
    of_process, of_thread = time.process_time(), time.thread_time()
    for _ in range(50):  # long beside what other threads of the process do meanwhile
        nav.simulate_batch(EPISODES, law, threads=1)
    of_process, of_thread = time.process_time() - of_process, time.thread_time() - of_thread
    # A pool or a helper thread would do all of the work: nearly nothing would be left here.
    assert of_thread > 0.8 * of_process


def test_any_number_of_threads_gives_the_same_bits() -> None:
    law = nav.OptimalReciprocalCollisionAvoidance()
    one = nav.simulate_batch(EPISODES, law, threads=1)
    for threads in (2, 3, 8, None):
        other = nav.simulate_batch(EPISODES, law, threads=threads)
        assert np.array_equal(one.min_distance, other.min_distance)
        assert np.array_equal(one.energy, other.energy)
