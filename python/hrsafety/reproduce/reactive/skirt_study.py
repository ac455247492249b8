"""The avoidance test under the conditions that the page compares."""

from __future__ import annotations

import math

import numpy as np

from hrsafety import reactive
from hrsafety._records import dataclass

__all__ = ["CLOSELY", "CLOSELY_FITTED", "CONDITIONS", "LOW_SHARE", "SkirtStudy", "limit_for", "run_study"]

CLOSELY, CLOSELY_FITTED = 0.10, 0.20  # m; the source gives no limit
LOW_SHARE = 0.05
LAYOUTS = 100

IDEAL, LOW = "ideal", "5 % of the discs below the sensors"
CONDITIONS = {
    IDEAL: "nine sensors, every disc seen, 0.3 m/s",
    LOW: f"{100 * LOW_SHARE:g} % of the discs below the sensors",
    "best direction": "the other policy between the rows of Table 1",
    "printed triggering": "triggering distances of (7) to (9) as printed",
    "beam 10 deg": "beam of 10 deg to either side instead of 20 deg",
    "small discs": "radius 0.03 to 0.15 m instead of 0.05 to 0.25 m",
    "0.5 m/s": "speed 0.5 m/s",
    "0.8 m/s": "speed 0.8 m/s",
    "Table 1 alone": "only the ten patterns of Table 1",
}


@dataclass(frozen=True, slots=True)
class SkirtStudy:
    """Tests by condition.

    Attributes
    ----------
    tests : dict of str to SkirtTest
        With the keys of `CONDITIONS`; all with the same seed.
    """

    tests: dict[str, reactive.SkirtTest]


def run_study(layouts: int = LAYOUTS) -> SkirtStudy:
    """Run the test under every condition."""
    skirt, scene, motion = reactive.UltrasonicSkirt, reactive.SkirtScene, reactive.SkirtMotion
    changes: dict[str, dict[str, object]] = {
        IDEAL: {},
        LOW: {"scene": scene(unseen_share=LOW_SHARE)},
        "best direction": {"skirt": skirt(policy="best_direction")},
        "printed triggering": {"skirt": skirt(triggering="printed")},
        "beam 10 deg": {"skirt": skirt(beam_width=math.radians(20.0))},
        "small discs": {"scene": scene(disc_radius=(0.03, 0.15))},
        "0.5 m/s": {"motion": motion(speed=0.5)},
        "0.8 m/s": {"motion": motion(speed=0.8)},
        "Table 1 alone": {"skirt": skirt(policy="table_only")},
    }
    return SkirtStudy(
        {
            name: reactive.skirt_test(layouts=layouts, **changes[name])  # type: ignore[arg-type]  # by its keyword
            for name in CONDITIONS
        }
    )


def limit_for(test: reactive.SkirtTest, share: float) -> float:
    """Return the limit of "closely" at which a share of the tests avoids completely."""
    return float(np.quantile(test.min_clearance, 1.0 - share))
