"""The force field drives a robot that knows obstacles by the echoes of an ultrasonic ring alone."""

from __future__ import annotations

from hrsafety import navigation as nav
from hrsafety import scenarios

scenario = scenarios.configuration("c1")
sonar = nav.sensing.Ultrasonic.ring(16, 0.15, beam_width=0.4, max_speed=0.3)
run = nav.simulate(scenario, nav.VirtualForceField(side_hysteresis=3.05), built=nav.robots.AsBuilt(sensors=[sonar]))
print(f"{run.outcome} after {run.arrival_time:.2f} s, obstacles known by {', '.join(run.sensing.obstacles)}")
print(f"least clearance {run.min_clearance.min():.2f} m")
for warning in run.warnings:
    print(warning)
