"""Pictures of the ultrasonic skirt."""

from __future__ import annotations

import numpy as np

from hrsafety import plotting, reactive
from hrsafety.pages import Picture
from hrsafety.reproduce.figures import captioned
from hrsafety.reproduce.reactive.skirt_study import LOW, LOW_SHARE, SkirtStudy

__all__ = ["make"]

PRINTED_SHARE = 0.775
CONTACT_SHARE = 0.05
SPEEDS = (0.2, 0.3, 0.4)
RADIUS, LARGE_RADIUS = 0.33, 0.5
STUDY_LAYOUTS = 25
CURVES = ("ideal", LOW, "beam 10 deg", "0.5 m/s")


def make(study: SkirtStudy) -> list[Picture]:
    """Draw the ring, runs, the curve over the limit, and the number of sensors."""
    return [_ring(), _runs(study), _curve(study), _counts()]


def _ring() -> Picture:
    figure = plotting.reactive.skirt_ring(reactive.UltrasonicSkirt(), directions=reactive.skirt.MOTION_DIRECTIONS)
    return captioned("skirt-ring", figure)


def _runs(study: SkirtStudy) -> Picture:
    scene = reactive.SkirtScene(unseen_share=LOW_SHARE)
    shown = {f"escape to {name}": reactive.skirt_run(direction=name, scene=scene) for name in ("N", "W", "E", "NW")}
    low = study.tests[LOW]
    for words, unseen in (("with a low disc", True), ("in a blind place", False)):
        places = np.flatnonzero(low.collided & (low.nearest_seen != unseen))
        if len(places):
            row = places[0]
            run = reactive.skirt_run(
                direction=str(low.direction[row]), layout=int(low.layout[row]), repeat=int(low.repeat[row]), scene=scene
            )
            shown[f"contact {words}"] = run
    return captioned("skirt-runs", plotting.reactive.skirt_runs(shown))


def _curve(study: SkirtStudy) -> Picture:
    figure = plotting.reactive.skirt_clearances({name: study.tests[name] for name in CURVES}, printed=PRINTED_SHARE)
    return captioned("skirt-clearances", figure)


def _counts() -> Picture:
    settings = [(RADIUS, speed) for speed in SPEEDS] + [(LARGE_RADIUS, SPEEDS[1])]
    studies = [
        reactive.smallest_skirt(CONTACT_SHARE, chassis_radius=radius, speed=speed, layouts=STUDY_LAYOUTS)
        for radius, speed in settings
    ]
    return captioned("skirt-sensor-counts", plotting.reactive.skirt_sensor_counts(studies), share=100 * CONTACT_SHARE)
