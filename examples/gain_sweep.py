"""Sweep two gains over three configurations and print the best sets.

Run it with ``python examples/gain_sweep.py``.
"""

from __future__ import annotations

import numpy as np

from hrsafety import navigation as nav
from hrsafety import scenarios

NAMES = ("c1", "c2", "c3")
BEST = 5


def main() -> None:
    """Score 16 x 16 gain sets in one call; the score of a set is its mean H."""
    attractive, detour = np.meshgrid(np.linspace(1.0, 8.5, 16), np.linspace(10.0, 310.0, 16))
    table = nav.simulate_batch(
        [scenarios.configuration(name) for name in NAMES],
        nav.VirtualForceField(repulsive_gain=20.0, gain_ratio=0.68),
        {"attractive_gain": attractive.ravel(), "detour_gain": detour.ravel()},
    )
    # Scenarios run fastest, so each row of these arrays is one gain set.
    score = table.performance_total.reshape(-1, len(NAMES))
    gains = table.gains[:: len(NAMES)]
    mean = score.mean(axis=1)

    print(f"{len(table)} runs, {int((table.outcome == 'arrived').sum())} arrived without a contact")
    print("  K_1   K_3    K_5     b   mean    " + "    ".join(f"{name:>2}" for name in NAMES))
    print("  N/m   N/m  N/m^2     s      H    " + "    ".join(" H" for _ in NAMES))
    for row in np.argsort(-mean, kind="stable")[:BEST]:
        k1, k3, k5, b = gains[row]
        parts = " ".join(f"{value:5.3f}" for value in score[row])
        print(f"{k1:5.1f} {k3:5.1f} {k5:6.1f} {b:5.2f}  {mean[row]:5.3f}  {parts}")


if __name__ == "__main__":
    main()
