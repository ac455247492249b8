"""A floor plan with people who react: laws compared, tuned and attacked in the same worlds.

A two-wheel robot with a lidar and a camera that sees people late crosses a room with a doorway.
"""

from __future__ import annotations

from hrsafety import navigation as nav
from hrsafety import plotting

plan = nav.StaticMap.from_polylines([[(0, 0), (8, 0), (8, 4), (0, 4), (0, 0)], [(4, 0), (4, 1.2)], [(4, 2.8), (4, 4)]])
ways = [((7, 1.6), (1, 1.6)), ((7, 2.4), (1, 2.4)), ((1, 3.2), (1, 0.8))]
people = [nav.Person(start=a, route=[b], desired_speed=0.9, model=nav.crowd.SocialForce1995()) for a, b in ways]
eyes = nav.robots.AsBuilt(obstacle_vision=nav.sensing.Vision())
robot = nav.Robot(nav.DifferentialDriveRobot(), start=(1, 2), goal=(7, 2), sensors=[nav.Lidar()], built=eyes)
worlds = [nav.World(robots=[robot], people=people, walls=plan, time_limit=40.0, seed=seed) for seed in range(2)]

bare = {"field": nav.VirtualForceField(), "Khatib": nav.Khatib(), "Masoud": nav.Masoud()}
shield = nav.Shield(person_speed=1.2, margin=0.02, wall_margin=0.02)
laws = bare | {f"{name}, shield": nav.SafeNavigation(law, map=plan, shield=shield) for name, law in bare.items()}
found = nav.compare(worlds, laws)
for standing in found.standings():
    print(f"{standing.law:16} arrived {standing.success}, at fault {standing.at_fault}")
search = nav.optimize_gains(worlds, bare["field"], method="cma_es", evaluations=60, require_arrival=False)
print(f"tuned field: H = {search.best_value:.3f}, gains {search.nearest.gains}")
attacked = nav.falsify(worlds[0], laws["field, shield"], episodes=20)
print(f"someone who pursues the robot: margin {attacked.margin.min():.3f} m")
plotting.crowds.crowd_paths(nav.simulate(worlds[0], laws["field, shield"])).savefig("one_world.png", dpi=80)
