"""Which foams keep a head safe at every speed? A sampled sweep in two processes.

Run it with ``python examples/impact_sweep.py [FOLDER]``. Needs SciPy for the Sobol sequence.
"""

from __future__ import annotations

import multiprocessing
import sys
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from hrsafety import impact, sweep

LIMIT_G = 10.0
LIMIT_COMPRESSION = 0.02
SLICES = 6


def main(folder: str | None = None) -> None:
    """Sample stiffness, damping and closing speed, and count the foams that keep both limits."""
    design = sweep.Sobol(
        [
            sweep.Axis(name="foam_stiffness", low=2e3, high=1e5, scale="log"),
            sweep.Axis(name="foam_damping", low=0.0, high=300.0),
            sweep.Axis(name="closing_speed", low=0.2, high=2.0),
        ],
        2**14,
    )
    study = sweep.ImpactStudy(
        manipulator=impact.MANIPULATOR_1,
        head=impact.Head.minimum(),
        outputs=["peak_head_acceleration_g", "max_compression"],
    )
    with ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("spawn")) as pool:
        result = sweep.run(design, study, out=folder, executor=pool)

    print(result)
    edges = np.linspace(0.2, 2.0, SLICES + 1)
    tried, kept = np.zeros(SLICES, dtype=int), np.zeros(SLICES, dtype=int)
    # Chunk by chunk: this works the same for a sweep that does not fit the memory.
    for chunk in result.chunks():
        safe = (chunk["peak_head_acceleration_g"] <= LIMIT_G) & (chunk["max_compression"] <= LIMIT_COMPRESSION)
        tried += np.histogram(chunk["closing_speed"], edges)[0]
        kept += np.histogram(chunk["closing_speed"][safe], edges)[0]
    for low, high, share in zip(edges[:-1], edges[1:], kept / tried, strict=True):
        print(f"{low:.1f} to {high:.1f} m/s: {100.0 * share:5.1f} % of the foams fit")


if __name__ == "__main__":
    main(*sys.argv[1:2])
