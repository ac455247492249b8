"""Pictures of the ultrasonic skirt."""

from __future__ import annotations

import numpy as np

from hrsafety import plotting, reactive
from hrsafety.pages import Picture
from hrsafety.reproduce.figures import picture
from hrsafety.reproduce.reactive_skirt_study import LOW, LOW_SHARE, SkirtStudy

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
    caption = (
        "The published ring: nine sensors clockwise, their beams up to the triggering distance, wheels (black), and "
        "the motion directions."
    )
    return picture("skirt-ring", caption, figure)


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
    caption = "Tests with 5 % of the discs below the sensors: the first one of four directions, and the first contacts."
    return picture("skirt-runs", caption, plotting.reactive.skirt_runs(shown))


def _curve(study: SkirtStudy) -> Picture:
    figure = plotting.reactive.skirt_clearances({name: study.tests[name] for name in CURVES}, printed=PRINTED_SHARE)
    caption = 'Share of the tests that avoid all discs completely, over the limit below which a clearance is "close".'
    return picture("skirt-clearances", caption, figure)


def _counts() -> Picture:
    settings = [(RADIUS, speed) for speed in SPEEDS] + [(LARGE_RADIUS, SPEEDS[1])]
    studies = [
        reactive.smallest_skirt(CONTACT_SHARE, chassis_radius=radius, speed=speed, layouts=STUDY_LAYOUTS)
        for radius, speed in settings
    ]
    caption = (
        f"Contacts by the number of sensors with equal gaps, each fired in turn every 20 ms: the smallest number that "
        f"keeps them below {100 * CONTACT_SHARE:g} % (upper end of the 95 % interval), 1,000 tests for each mark."
    )
    return picture("skirt-sensor-counts", caption, plotting.reactive.skirt_sensor_counts(studies))
