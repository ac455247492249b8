"""Virtual impedance, the law of the sound follower, drives a two-wheel robot through configuration c1.

It sees the quarter of a turn ahead that the sonar of the follower sees.
"""

from __future__ import annotations

from dataclasses import replace
from math import pi

from hrsafety import navigation as nav
from hrsafety import scenarios

scenario = replace(scenarios.configuration("c1"), robot=nav.DifferentialDriveRobot(), heading=pi)
for law in (nav.laws.VirtualImpedanceLaw(view=pi / 4), nav.VirtualForceField()):
    run = nav.simulate(scenario, law, built=nav.robots.AsBuilt())
    print(f"{type(law).__name__:20} {run.outcome}, least clearance {run.min_clearance.min():.2f} m")
