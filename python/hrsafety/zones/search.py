"""Search of the worst attack by covariance matrix adaptation (CMA-ES), from the worst that chance found."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from hrsafety._arguments import Array

__all__ = ["adapted", "mirrored"]

SPREAD = 0.12
"""Standard deviation of the first generation."""


def mirrored(genes: Array) -> Array:
    """Return numbers folded into 0 to 1 at both ends."""
    folded = np.mod(genes, 2.0)
    return np.where(folded > 1.0, 2.0 - folded, folded)


def adapted(
    severity: Callable[[Array], Array],
    starts: Array,
    *,
    generations: int,
    population: int,
    generator: np.random.Generator,
) -> tuple[Array, Array]:
    """Return attacks that several evolutions tried from their starts, and the severity of each.

    Every evolution is a (mu/mu_w, lambda) CMA-ES with cumulative step-size adaptation and rank-one and rank-mu updates
    (Hansen, The CMA evolution strategy: a tutorial, 2016, with its default constants). All are evaluated together.

    Parameters
    ----------
    severity : callable
        Returns (n,) severities of (n, d) attacks; more is worse.
    starts : ndarray (k, d)
        Where the evolutions start.
    generations, population : int
        Of each evolution.
    generator : numpy.random.Generator
        Of the draws.

    Returns
    -------
    tuple of ndarray (n, d) and ndarray (n,)
        Attacks with numbers from 0 to 1, and their severities.
    """
    count, size = starts.shape
    parents = population // 2
    weights = np.log(parents + 0.5) - np.log(np.arange(1, parents + 1))
    weights /= weights.sum()
    effective = 1.0 / (weights**2).sum()
    step_rate = (effective + 2.0) / (size + effective + 5.0)
    damping = 1.0 + 2.0 * max(0.0, math.sqrt((effective - 1.0) / (size + 1.0)) - 1.0) + step_rate
    path_rate = (4.0 + effective / size) / (size + 4.0 + 2.0 * effective / size)
    one = 2.0 / ((size + 1.3) ** 2 + effective)
    many = min(1.0 - one, 2.0 * (effective - 2.0 + 1.0 / effective) / ((size + 2.0) ** 2 + effective))
    expected = math.sqrt(size) * (1.0 - 1.0 / (4.0 * size) + 1.0 / (21.0 * size * size))
    mean, spread = starts.copy(), np.full(count, SPREAD)
    covariance = np.repeat(np.eye(size)[np.newaxis], count, axis=0)
    path, step_path = np.zeros((count, size)), np.zeros((count, size))
    tried, found = [], []
    for generation in range(generations):
        values, axes = np.linalg.eigh(covariance)
        scale = np.sqrt(np.maximum(values, 1e-20))
        draws = generator.standard_normal((count, population, size))
        moves = np.einsum("kij,kpj->kpi", axes * scale[:, np.newaxis], draws)
        genes = mean[:, np.newaxis] + spread[:, np.newaxis, np.newaxis] * moves
        tried.append(mirrored(genes).reshape(-1, size))
        found.append(severity(tried[-1]))
        order = np.argsort(-found[-1].reshape(count, population), axis=1, kind="stable")[:, :parents]
        best = np.take_along_axis(moves, order[..., np.newaxis], axis=1)
        move = np.einsum("p,kpi->ki", weights, best)
        mean = mean + spread[:, np.newaxis] * move
        whitened = np.einsum("kij,kj->ki", axes, np.einsum("kji,kj->ki", axes, move) / scale)
        step_path = (1.0 - step_rate) * step_path + math.sqrt(step_rate * (2.0 - step_rate) * effective) * whitened
        length = np.linalg.norm(step_path, axis=1)
        limit = (1.4 + 2.0 / (size + 1.0)) * expected * math.sqrt(1.0 - (1.0 - step_rate) ** (2 * (generation + 1)))
        steady = (length < limit)[:, np.newaxis]
        path = (1.0 - path_rate) * path + steady * math.sqrt(path_rate * (2.0 - path_rate) * effective) * move
        rank_one = path[:, :, np.newaxis] * path[:, np.newaxis]
        rank_mu = np.einsum("p,kpi,kpj->kij", weights, best, best)
        covariance = (1.0 - one - many) * covariance + one * rank_one + many * rank_mu
        spread = np.minimum(spread * np.exp(step_rate / damping * (length / expected - 1.0)), 1.0)
    return np.concatenate(tried), np.concatenate(found)
