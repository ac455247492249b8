"""Bad inputs by name: calls and command lines that the package refuses, and how one of them is run.

Each entry is what a reader would type. `tests/docs/test_bad_inputs.py` holds the message of each to
the page docs/bad_inputs.md, which ``python docs/list_bad_inputs.py --write`` makes from this list.
"""

from __future__ import annotations

import contextlib
import os
import re
from collections.abc import Iterator, Mapping
from io import StringIO
from pathlib import Path

import numpy as np

from hrsafety import (
    HrsafetyError,
    arms,
    datasets,
    gym,
    impact,
    io,
    navigation,
    plotting,
    reactive,
    reproduce,
    scenarios,
    sweep,
)
from hrsafety.cli import main

PROGRAM = (
    '[robot]\nurdf = "example"\n[motion]\nacceleration = 4.0\n[[moves]]\nkind = "joint"\n'
    "to = { turn = 0.0, shoulder = 0.4, elbow = 1.4, wrist_1 = 0.0, wrist_2 = 0.0, wrist_3 = 0.0 }\n"
    '[[moves]]\nname = "turn"\nkind = "joint"\nto = { turn = 1.0 }\n[[points]]\nname = "gripper"\nlink = "tool"\n'
    '[[segments]]\nfrom = "turn"\nto = "turn"\nregions = ["chest"]\n'
)
"""A robot program that is right."""
DEGREES_LOG = "time,turn,shoulder,elbow,wrist_1,wrist_2,wrist_3\n" + "".join(
    f"{0.1 * k:.1f},{3.0 * k},20,80,0,0,0\n" for k in range(9)
)
FILES = {
    "far.toml": PROGRAM.replace('kind = "joint"\nto = { turn = 1.0 }', 'kind = "linear"\nto = [3.0, 0.0, 0.5]'),
    "slow_joint.toml": PROGRAM.replace("acceleration = 4.0\n", ""),
    "no_regions.toml": PROGRAM.replace('regions = ["chest"]\n', ""),
    "no_reason.toml": PROGRAM.replace("regions", "clamped = false\nregions"),
    "moves.toml": PROGRAM.replace('to = "turn"', 'to = "trun"'),
    "joints.toml": PROGRAM.replace("to = { turn = 1.0 }", "to = { trun = 1.0 }"),
    "log.toml": PROGRAM.replace("[motion]", '[motion]\nlog = "joints.csv"').split("[[moves]]")[0]
    + '[[points]]\nname = "gripper"\nlink = "tool"\n[[segments]]\nfrom = 0.0\nto = 0.5\nregions = ["chest"]\n',
    "joints.csv": DEGREES_LOG,
    "scene.toml": "start = [3.9, 0.6]\ngoal = [0.0, 0.6]\n",
    "misspelt.toml": "start = [3.9, 0.6]\ngoal = [0.0, 0.6]\ntime_limt = 30.0\n",
    "negative.toml": 'start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n[[obstacles]]\ntype = "disc"\ncenter = [2.0, 1.0]\n'
    "radius = -0.1\n",
    "text.toml": 'start = [4.0, 0.0]\ngoal = [0.0, 0.0]\ntime_limit = "60"\n',
    "kind.toml": 'start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n[[obstacles]]\ntype = "dics"\ncenter = [2.0, 1.0]\n'
    "radius = 0.1\n",
    "law.toml": 'start = [4.0, 0.0]\ngoal = [0.0, 0.0]\n[law]\ntype = "velocity_obstacel"\n',
    "hall.toml": 'start = [0.0, 0.0]\ngoal = [4.0, 0.0]\n[[people]]\nstart = [3.0, 0.5]\nmodel = "social_force"\n',
    "broken.toml": "start = [3.9, 0.6\n",
    "design.toml": "closing_speed = 1.25\n[manipulator]\nmass = 49.4\ndamping = 111.0\n",
    "study.toml": 'scenarios = ["c9"]\n',
    "budget.toml": 'scenarios = ["c1"]\n[search]\nmethod = "cmaes"\n',
    "axes.toml": 'head = "minimum"\n[design]\nkind = "grid"\n',
    "axis.toml": 'head = "minimum"\n[design]\nkind = "grid"\n[[axes]]\nname = "foam_stifness"\nfrom = 1.0\nto = 2.0\n'
    "points = 3\n[manipulator]\nmass = 49.4\ndamping = 111.0\nstiffness = 14400.0\n[impact]\nclosing_speed = 1.25\n",
    "thousands.csv": "t_s;id;x_m;y_m\n0;1;1.234,5;2,0\n",
    "columns.csv": "frame,number,x_m,y_m\n0,1,0.0,1.0\n",
    "trajnet.txt": "0 4 -4.0 0.61\n10 4 -3.57 0.64\n10 17 4.5 1.7\n20 4 -3.14 0.65\n20 17 4.0 1.65\n",
    "grid.txt": "0 0 0.0 0.0\n0 1 0.0 1.0\n1 0 1.0 0.0\n1 1 1.0 1.0\n",
    "places.csv": "time,id,lat,lon\n0,1,50.1,8.6\n1,1,50.1,8.6\n",
    "centimeters.csv": "t,id,x,y\n0.0,1,0,100\n0.4,1,50,100\n0.8,1,100,100\n",
    "pixels.txt": '0 122 287 138 307 100 0 0 0 "Pedestrian"\n0 131 286 147 306 110 0 0 1 "Pedestrian"\n',
    "camera.txt": "# framerate: 16 fps\n# id frame x/cm y/cm\n1 40 -400.0 61.0\n1 41 -393.3 61.5\n",
    "zero.txt": "0.0 0 0 0 0 0 0 0\n0.1 0 0 0 0 0 0 1\n",
    "poses.csv": "t_s,x_m,z_m\n0,0,0\n",
    "robot.csv": "t_s,x_m,y_m,yaw_rad\n0,0,0,0\n0.1,0.1,0,0\n0.2,0.2,0,0\n",
    "late.csv": "t_s,ped_id,x_m,y_m\n9.0,1,0.0,1.0\n9.4,1,0.5,1.0\n",
    "cut.bag": "#ROSBAG V2.0\n",
    "words.csv": "frame,t_s,ped_id,x_m,y_m\n0,0.0,1,zero,1.0\n",
    "order.csv": "t_s,x_m,y_m\n0.4,0.0,1.0\n0.0,0.0,1.0\n",
    "twice.csv": "frame,t_s,ped_id,x_m,y_m\n0,0.0,1,0.0,1.0\n0,0.0,1,0.5,1.0\n",
    "header.csv": "frame,t_s,ped_id,x_m,y_m\n",
    "short.csv": "t_s,x_m,y_m\n0.0,1.0\n",
    "noise.wav": "RIFF of nothing",
    "chunk.wav": "RIFF\x14\x00\x00\x00WAVELIST\x7f\x7f\x00\x00" + 40 * "\x00",
    "search.checkpoint": "damaged",
    "timed_out.toml": "start = [3.9, 0.6]\ngoal = [0.0, 0.6]\ntime_limit = 1.0\n",
    "outside.yaml": "image: ../map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\n",
    "blank.yaml": "resolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\n",
    "cut.yaml": "image: cut.pgm\nresolution: 0.05\norigin: [0, 0, 0]\noccupied_thresh: 0.65\nfree_thresh: 0.2\n",
    "cut.pgm": "P5\n3 2\n255\nabcde",
    "twice.yaml": "image: map.pgm\nresolution: 0.05\nresolution: 0.5\n",
    "degrees.geojson": '{"type": "LineString", "coordinates": [[8.41, 49.01], [8.42, 49.02]]}',
    "pixels.svg": "<svg viewBox='0 0 200 100' width='800' height='400'><path d='M0 0L9 9'/></svg>",
    "torn.dxf": "0\nSECTION\n2\nENTITIES\n0\nLINE\n8\nWALLS\n",
    "unitless.dxf": "0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n",
    "nav2.yaml": "local_costmap:\n  ros__parameters:\n    footprint: '[[0.3, 0.2], [0.3, x], [-0.3, 0.2]]'\n",
    "agents.yaml": "hunav_loader:\n  ros__parameters:\n    agents: [a]\n    a: {id: 1, behavior: 9, max_vel: 1.0}\n",
    "degrees.toml": "start = [3.9, 0.6]\ngoal = [0.0, 0.6]\nheading = 90.0\n",
}
"""Files that lie beside the caller."""

SCENE = navigation.Scenario(
    start=(3.9, 0.6), goal=(0.0, 0.6), obstacles=[navigation.Disc(center=(2.45, 1.2), radius=0.1)]
)
LAW = navigation.VirtualForceField()
FOAM, ARM, HEAD = impact.FOAM_1, impact.MANIPULATOR_1, impact.Head.minimum()
LIMITS = impact.FoamLimits()
ARRAY = reactive.MicrophoneArray()
TRAP = navigation.StaticMap.from_polylines([[(1.0, 1.5), (3.0, 1.5), (3.0, -1.5), (1.0, -1.5)]])
AXIS = sweep.Axis(name="foam_stiffness", low=1e4, high=4e4, points=3)
STUDY = sweep.ImpactStudy(manipulator=ARM, foam=FOAM, head=HEAD, fixed={"closing_speed": 1.0})
PEOPLE = datasets.Recording(
    time_s=[0.0, 0.0, 0.4, 0.4], person=[1, 2, 1, 2], position=[[0.0, 0.0], [5.0, 1.0], [0.5, 0.0], [5.5, 1.0]]
)
MET = navigation.simulate(scenarios.circle_crossing(0))
NAMES = {
    "np": np,
    "gym": gym,
    "met": MET,
    "nav": navigation,
    "impact": impact,
    "io": io,
    "reactive": reactive,
    "arms": arms,
    "sweep": sweep,
    "scenarios": scenarios,
    "datasets": datasets,
    "plotting": plotting,
    "reproduce": reproduce,
    "scene": SCENE,
    "law": LAW,
    "foam": FOAM,
    "arm": ARM,
    "head": HEAD,
    "limits": LIMITS,
    "microphones": ARRAY,
    "trap": TRAP,
    "gate": navigation.StaticMap.from_polylines([[(1.0, -1.5), (1.0, 1.5)]]),
    "axis": AXIS,
    "study": STUDY,
    "people": PEOPLE,
}
"""What stands for what in a call."""

BAD_INPUTS: Mapping[str, Mapping[str, str]] = {
    "Scenes": {
        "disc without size": "nav.Disc(center=(2.0, 0.6), radius=0.0)",
        "negative radius": "nav.Disc(center=(2.0, 0.6), radius=-0.1)",
        "radius as text": 'nav.Disc(center=(2.0, 0.6), radius="0.1")',
        "three coordinates": "nav.Disc(center=(2.0, 0.6, 0.0), radius=0.1)",
        "regions exchanged": "nav.Disc(center=(2.0, 0.6), radius=0.1, active_radius=0.4, critical_radius=0.8)",
        "rectangle that moves": "nav.Rectangle(center=(2.0, 0.0), length=1.4, width=0.6, max_speed=0.5)",
        "rectangle without width": "nav.Rectangle(center=(2.0, 0.0), length=1.4, width=0.0)",
        "velocity not a number": 'nav.Human(start=(0.0, 0.0), velocity=(float("nan"), 0.0))',
        "stop behind the person": "nav.Human(start=(0.0, 0.0), velocity=(1.0, 0.0), stop=(-2.0, 0.0))",
        "recording without samples": "nav.Human.from_path([], np.empty((0, 2)))",
        "recording of unequal length": "nav.Human.from_path([0.0, 0.4], [[0.0, 0.0]])",
        "recording that goes back in time": "nav.Human.from_path([0.4, 0.0], [[0.0, 0.0], [0.5, 0.0]])",
        "person without segments": "nav.Human.from_segments((0.0, 0.0), [])",
        "segment of two parts": "nav.Human.from_segments((0.0, 0.0), [(1.0, (1.0, 0.0))])",
        "segment of no duration": "nav.Human.from_segments((0.0, 0.0), [(0.0, (1.0, 0.0), (0.0, 0.0))])",
        "start at the goal": "nav.Scenario(start=(0.0, 0.0), goal=(0.1, 0.0))",
        "start inside an obstacle": "nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=["
        "nav.Disc(center=(2.0, 2.0), radius=0.1), nav.Disc(center=(4.0, 0.2), radius=0.1)])",
        "goal in an active region": "nav.simulate(nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=["
        "nav.Disc(center=(0.3, 0.0), radius=0.1)]), nav.VirtualForceField())",
        "obstacle that is none": "nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=[(2.0, 0.0, 0.1)])",
        "one obstacle, no list": "nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), "
        "obstacles=nav.Disc(center=(2.0, 0.0), radius=0.1))",
        "time limit of nothing": "nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), time_limit=0.0)",
        "seed with a fraction": "nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), seed=1.5)",
        "seed of 65 bits": "nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), seed=2**64)",
        "negative noise": "nav.Measurement(scale=-0.025)",
        "noise of unknown kind": 'nav.Measurement(distribution="normal")',
        "noise that comes early": "nav.Measurement(latency=-0.1)",
        "noise that comes never": 'nav.Measurement(latency=float("inf"))',
        "regions for a negative delay": "nav.region_radii(nav.HolonomicRobot(), nav.Human(start=(0, 0), "
        "velocity=(1, 0)), latency=-0.1)",
        "regions for a negative error": "nav.region_radii(nav.HolonomicRobot(), nav.Human(start=(0, 0), "
        "velocity=(1, 0)), position_error=-0.025)",
        "side of a round obstacle": "nav.region_radii(nav.HolonomicRobot(), nav.Disc(center=(2, 0), radius=0.1), "
        "faced_side=1.0)",
        "unknown configuration": 'scenarios.configuration("c9")',
        "crowd of less than nobody": "scenarios.random_crowd(-1, seed=0)",
        "crowd of half a person": "scenarios.random_crowd(2.5, seed=0)",
        "more runs than a recording has": "scenarios.crossings(people, runs=500)",
        "more runs than memory holds": "scenarios.crossings(people, runs=2**53, selection='even')",
        "critical region below the contact": "nav.Scenario(start=(4.0, 0.0), goal=(0.0, 0.0), obstacles=["
        "nav.Disc(center=(2.0, 0.0), radius=0.3, active_radius=0.8, critical_radius=0.4)])",
        "critical clearance below zero": "nav.Disc(center=(2.0, 0.0), radius=0.3, critical_clearance=-0.1)",
        "radius and clearance at once": "nav.Disc(center=(2.0, 0.0), radius=0.3, active_radius=0.9, "
        "critical_radius=0.6, critical_clearance=0.1)",
        "crowd of a million thousands": "scenarios.random_crowd(2**31, seed=0)",
        "traffic without end": "scenarios.random_traffic(10**400, seed=0)",
        "a crowd for every seed": "scenarios.random_crowd_batch(10**6, people=100)",
        "row of arrays that is no scenario": "nav.Scenarios.from_arrays(start=[[0, 0], [4, 0]], goal=(4, 0))",
        "people by fractions": "people.humans([1.0, 2.0], duration=1.0)",
        "masked positions": "nav.Human.from_path([0.0, 0.4], np.ma.masked_greater([[0.0, 0.0], [9.0, 0.0]], 5.0))",
    },
    "Worlds of people": {
        "person who starts nowhere": 'nav.Person(start=(float("nan"), 0))',
        "point of a route that is nowhere": 'nav.Person(start=(0, 0), route=[(1, 0), (float("inf"), 0)])',
        "person without a body": "nav.Person(start=(0, 0), route=[(5, 0)], radius=0)",
        "person who walks backward": "nav.Person(start=(0, 0), route=[(5, 0)], desired_speed=-1.0)",
        "person who is more than aware": "nav.Person(start=(0, 0), route=[(5, 0)], awareness=1.2)",
        "more than everybody distracted": "nav.Person(start=(0, 0), route=[(5, 0)], distracted_share=1.5)",
        "no way to repeat": 'nav.Person(start=(0, 0), at_end="repeat")',
        "end of a way, misspelt": 'nav.Person(start=(0, 0), route=[(5, 0)], at_end="leaves")',
        "recorded person with more instants than places": "nav.Person(start=(0, 0), recording=([0.0, 1.0], [(0, 0)]))",
        "people without mass": "nav.crowd.SocialForce2000(mass=0)",
        "people who turn at once": "nav.crowd.Moussaid(relaxation_time=0)",
        "range of a force below zero": "nav.crowd.SocialForce1995(range=-0.3)",
        "people who see nobody": "nav.crowd.CollisionFreeSpeed(cutoff=0)",
        "time gap that never ends": 'nav.crowd.CollisionFreeSpeed(time_gap=float("inf"))',
        "source that takes people back": "nav.Source(low=(0, 0), high=(1, 1), rate=-1, route=[(5, 0)])",
        "source with exchanged corners": "nav.Source(low=(1, 1), high=(0, 0), rate=1, route=[(5, 0)])",
        "world that stands still": "nav.World(step=0)",
        "world that never ends": 'nav.World(time_limit=float("inf"))',
        "world that repeats itself backward": "nav.World(period=(-10, 0))",
        "wall of one point": "nav.World(walls=[[(0, 0)]])",
        "robot that starts on a person": "nav.World(people=[nav.Person(start=(0.1, 0))], "
        "robots=[nav.Robot(start=(0, 0), goal=(5, 0))])",
        "robot that starts in a wall": "nav.World(walls=[[(0.1, -1), (0.1, 1)]], "
        "robots=[nav.Robot(start=(0, 0), goal=(5, 0))])",
        "robots that start on each other": "nav.World(robots=[nav.Robot(start=(0, 0), goal=(5, 0))] * 2)",
        "robot that decides between steps": "nav.World(robots=[nav.Robot(start=(0, 0), goal=(5, 0), "
        "control_period=0.07)])",
        "robot that sees nobody": "nav.Robot(start=(0, 0), goal=(5, 0), sensing_range=0)",
        "awareness of an instant": "nav.crowd.decide(nav.crowd.Moussaid(), position=[(0, 0)], velocity=[(0, 0)], "
        "goal=[(1, 0)], awareness=2)",
        "radius of an instant": "nav.crowd.decide(nav.crowd.Moussaid(), position=[(0, 0)], velocity=[(0, 0)], "
        "goal=[(1, 0)], radius=-0.2)",
        "robot and people of unequal length": "nav.metrics.Episode(position=[(0, 0), (1, 0)], people=[[(2, 0)]], "
        "step=0.1, goal=(5, 0), robot_radius=0.3)",
        "scenario among worlds": "nav.simulate_many([nav.World(), 3], nav.VirtualForceField())",
        "world without a robot for a law": "nav.simulate_many(nav.World(), nav.VirtualForceField())",
        "step of a world from outside": "nav.simulate_many(scenarios.circle_crossing(0), "
        "nav.VirtualForceField(), step=0.02)",
        "more than everybody reacts": "scenarios.with_recording(people, 1.5)",
        "more robots than there are": "scenarios.antipodal(3, robots=4)",
        "parameter of people, misspelt": 'nav.crowd.fit_people(nav.crowd.Moussaid(), people, ["strenth"])',
        "density at which nobody walks": "nav.crowd.weidmann_speed(6.0)",
    },
    "Static maps": {
        "polygon that crosses itself": "nav.StaticMap.from_polygons([[(0, 0), (1, 1), (1, 0), (0, 1)]])",
        "first corner repeated": "nav.StaticMap.from_polygons([[(0, 0), (1, 0), (1, 1), (0, 0)]])",
        "polygon of two corners": "nav.StaticMap.from_polygons([[(0, 0), (1, 1)]])",
        "wall of no length": "nav.StaticMap.from_polylines([[(1, 1), (1, 1)]])",
        "occupancy as a share": "nav.StaticMap.from_grid([[0.0, 0.5]], resolution=0.1)",
        "grid of one axis": "nav.StaticMap.from_grid([0, 1], resolution=0.1)",
        "cells without size": "nav.StaticMap.from_grid([[0, 1]], resolution=0.0)",
        "image outside of its folder": 'nav.StaticMap.from_map_server("outside.yaml")',
        "map without image": 'nav.StaticMap.from_map_server("blank.yaml")',
        "image that was cut off": 'nav.StaticMap.from_map_server("cut.yaml")',
        "share of boundary points above one": "trap.boundary_points((0, 0), reach=1.0, kappa=1.5)",
        "goal beside a wall": "nav.maps.Guide().plan(trap, radius=0.2, start=(0, 0), goal=(3.1, 0))",
        "goal without a way": "nav.maps.Guide().plan(trap + gate, radius=0.2, start=(2, 0), goal=(5, 0))",
        "nodes beyond memory": "nav.maps.Guide(spacing=1e-7).plan(trap, radius=0.2, start=(0, 0), goal=(5, 0))",
        "lidar that looks around twice": "nav.sensing.Lidar(field_of_view=7.0)",
    },
    "Robots and laws": {
        "negative mass": "nav.HolonomicRobot(mass=-1.0)",
        "speed given as True": "nav.HolonomicRobot(max_speed=True)",
        "two wheel inertias of three": "nav.HolonomicRobot(wheel_inertia=(0.007, 0.007))",
        "negative gain": "nav.VirtualForceField(repulsive_gain=-20.0)",
        "unknown stabilizing force": 'nav.VirtualForceField(stabilizing="cap")',
        "cap without capped force": 'nav.VirtualForceField(stabilizing="off", stabilizing_force_cap=10.0)',
        "form of Khatib's force": 'nav.Khatib(form="print")',
        "selection of a velocity": 'nav.VelocityObstacle(selection="fastest_one")',
        "probability above 1": "nav.RapidlyExploringRandomTree(goal_probability=1.5)",
        "tree without draws": "nav.RapidlyExploringRandomTree(draws=0)",
        "cells of no size": "nav.FieldDStar(resolution=0.0)",
        "law by its name": 'nav.simulate(scene, "virtual_force_field")',
        "camera of 0 frames per second": "nav.sensing.Vision(period=0.0)",
        "camera that is early": "nav.sensing.Vision(delay=-0.03)",
        "frames lost with certainty": "nav.sensing.Vision(drop_probability=1.0)",
    },
    "Runs": {
        "arguments exchanged": "nav.simulate(law, scene)",
        "step that does not divide the period": "nav.simulate(scene, law, step=0.025)",
        "step of nothing": "nav.simulate(scene, law, step=0.0)",
        "step of nanoseconds": "nav.simulate(scene, law, step=1e-9, hold=False)",
        "unknown integrator": 'nav.simulate(scene, law, integrator="euler")',
        "yes for True": 'nav.simulate(scene, law, stop_on_contact="yes")',
        "weights that sum to 1.5": "nav.evaluate(scene, law, (0.5, 0.5, 0.5))",
        "one scenario, no list": "nav.simulate_batch(scene, law)",
        "no scenario": "nav.simulate_batch([], law)",
        "three gains of four": "nav.simulate_batch([scene], law, [[3.0, 20.0, 17.0]])",
        "gain by half its name": 'nav.simulate_batch([scene], law, {"attractive": [3.0]})',
        "100,000 threads": "nav.simulate_batch([scene], law, threads=100_000)",
        "three lanes": "nav.simulate_batch([scene], law, lanes=3)",
        "comparison without laws": "nav.compare(scene, {})",
        "unknown law in a comparison": 'nav.compare(scene, {"field": law}).standing("Field")',
        "gains of two kinds of laws": "nav.simulate_many(scene, [law, nav.Masoud()], gains=[[3.0, 20.0, 17.0, 0.25]])",
        "no seeds": "nav.simulate_many(scene, law, seeds=0)",
        "position of one number": "nav.laws.command(law, scene, position=(3.0,), velocity=(0.0, 0.0))",
        "unknown search method": 'nav.optimize_gains([scene], law, method="cmaes")',
        "bounds exchanged": 'nav.optimize_gains([scene], law, bounds={"attractive_gain": (50.0, 0.0)})',
        "unknown objective": 'nav.optimize_gains([scene], law, objective="time")',
        "grid of three numbers for four gains": "nav.optimize_gains([scene], law, grid=(4, 4, 4))",
        "search seed of 65 bits": "nav.optimize_gains([scene], law, grid=(1, 1, 1, 1), seed=2**64)",
        "constraint without bound": 'nav.gains.GainConstraint(metric="min_clearance")',
        "camera of 1e308 frames per second": "nav.sensing.observe(nav.sensing.Vision(period=1e-308), [0.0, 1.0], "
        "[[0.0, 0.0], [1.0, 0.0]])",
        "camera of 1e12 frames per second": "nav.sensing.observe(nav.sensing.Vision(period=1e-12), [0.0, 1.0], "
        "[[0.0, 0.0], [1.0, 0.0]])",
        "seeds without end": "nav.simulate_many(scene, law, seeds=2**53)",
        "refinements without end": "nav.optimize_gains([scene], law, refinements=2**31)",
    },
    "Arms": {
        "SDF for a URDF": "arms.Arm.from_urdf('<sdf version=\"1.9\"/>')",
        "MJCF for the text of a URDF": "arms.Arm('<mujoco/>')",
        "inertia that no body has": "arms.Arm(arms.Arm.example().urdf.replace('ixx=\"0.42\"', 'ixx=\"0.9\"'))",
        "units in a URDF": "arms.Arm.from_urdf(arms.Arm.example().urdf.replace('<mass ', '<mass unit=\"g\" '))",
        "type plate of 0 kg": "arms.Arm.example(type_plate_mass=0.0)",
    },
    "Impacts": {
        "foam of negative stiffness": "impact.Foam(stiffness=-24300.0, damping=71.9)",
        "foam with negative damping": "impact.Foam(stiffness=24300.0, damping=-1.0)",
        "head of no mass": "impact.Head(mass=0.0, damping=100.0, stiffness=1e5)",
        "closing speed not a number": 'impact.metrics(arm, foam, head, closing_speed=float("nan"))',
        "arguments of an impact exchanged": "impact.metrics(foam, arm, head, closing_speed=1.0)",
        "time and signal of unequal length": "impact.hic([0.0, 0.001, 0.002], [0.0, 50.0])",
        "time that stands still": "impact.hic([0.0, 0.0, 0.001], [0.0, 50.0, 0.0])",
        "one sample": "impact.hic([0.0], [50.0])",
        "window of nothing": "impact.hic([0.0, 0.001], [0.0, 50.0], window=0.0)",
        "acceleration with a gap": 'impact.hic([0.0, 0.001, 0.002], [0.0, float("nan"), 0.0])',
        "unknown channel class": "impact.criteria.channel_corner(500)",
        "channel class as text": "impact.criteria.channel_filter([0.0, 0.001], [0.0, 1.0], 'CFC60')",
        "limits of nothing": "impact.FoamLimits(peak_head_acceleration_g=None, max_compression=None)",
        "negative limit": "impact.FoamLimits(peak_head_acceleration_g=-10.0)",
        "design against a plain number": "impact.design_foam(arm, 10.0, closing_speed=1.0)",
        "batch of unequal columns": "impact.metrics_batch(manipulator=arm, head=head, foam_stiffness=[1e4, 2e4], "
        "foam_damping=[1.0, 2.0, 3.0], closing_speed=1.0)",
        "batch without a foam": "impact.metrics_batch(manipulator=arm, head=head, closing_speed=1.0)",
        "drop from below": "impact.identification.drop_trajectory([0.0, 0.1], height=-0.1, mass=1.0, stiffness=1e4, "
        "damping_ratio=0.1)",
        "static test of unequal length": "impact.identification.fit_static([1.0, 2.0], [0.001, 0.002, 0.003])",
        "unknown method": 'impact.simulate(arm, foam, head, closing_speed=1.0, method="rk45")',
        "foam thinner than its linear range": "impact.Foam(stiffness=24300.0, damping=71.9, thickness=0.01, "
        "linear_range=0.02)",
        "milliseconds for seconds": "impact.hic(np.arange(0.0, 100.0, 1.0), np.full(100, 50.0))",
        "milliseconds in a recording": "impact.recorded_metrics(np.arange(0.0, 100.0, 1.0), "
        "np.sin(np.linspace(0.0, np.pi, 100)))",
        "closing speed of 1e308 m/s": "impact.simulate(arm, foam, head, closing_speed=1e308)",
        "foam as stiff as no solid": "impact.identification.drop_trajectory("
        "[0.0, 0.4], height=0.05, mass=1.54, stiffness=1e20, damping_ratio=0.1)",
        "forces of 1e200 N": "impact.identification.fit_static([1e200, 2e200, 3e200], [0.001, 0.002, 0.003])",
        "signal for a channel class": "impact.criteria.channel_filter(np.arange(9) / 1e4, np.ones(9), np.ones(3))",
        "masked acceleration": "impact.hic([0.0, 0.001, 0.002], np.ma.masked_greater([0.0, 50.0, 1e6], 1e3))",
    },
    "Avoidance from sensors": {
        "sonar without rays": "reactive.Sonar(rays=0)",
        "sensor that begins beyond its end": "reactive.Sonar(least_range=4.0)",
        "unknown firing": 'reactive.Sonar(firing="sequential")',
        "microphones at one place": "reactive.MicrophoneArray(spacing=0.0)",
        "delay as text": 'reactive.locate(microphones, delay_12="1e-4", delay_13=0.0)',
        "unknown law of impedance": 'reactive.experiment("static", "passive", layouts=1)',
        "unknown layout": 'reactive.experiment("dynamic", layouts=1)',
        "no layouts": 'reactive.experiment("static", layouts=0)',
        "ring of two sensors": "reactive.UltrasonicSkirt(sensors=2)",
        "direction by a word": 'reactive.skirt_run(direction="north")',
        "box without size": "reactive.Box(center=(1.0, 0.0), size=(0.0, 0.4))",
        "wall of one number": "reactive.Wall(start=1.0, end=(1.0, 0.0))",
        "burst seed of 65 bits": "reactive.Burst(seed=2**64)",
        "sound that is none": 'reactive.read_recording("noise.wav")',
        "file that is not there": 'reactive.read_recording("nowhere.wav")',
        "2**53 rays": "reactive.Sonar(rays=2**53)",
        "2**63 rays": "reactive.Sonar(rays=2**63)",
        "a thousand million rays": "reactive.Sonar(rays=10**9)",
        "temperature not a number": 'reactive.sonar.speed_of_sound(float("nan"))',
        "below absolute zero": "reactive.sonar.speed_of_sound(-400.0)",
        "layouts without end": 'reactive.experiment("static", layouts=2**31)',
        "deviation of 1e200 s": "reactive.sound.jittered_fixes(microphones, range=1.0, bearing=0.0, runs=2, "
        "arrival_deviation=1e200)",
        "WAV with a wrong chunk size": 'reactive.read_recording("chunk.wav")',
    },
    "Sweeps": {
        "axis without numbers": 'sweep.Axis(name="foam_stiffness")',
        "axis from high to low": 'sweep.Axis(name="foam_stiffness", low=4e4, high=1e4, points=3)',
        "logarithmic axis from zero": 'sweep.Axis(name="foam_stiffness", low=0.0, high=1e4, points=3, scale="log")',
        "grid without axes": "sweep.Grid([])",
        "axis twice": "sweep.Grid([axis, axis])",
        "hypercube of no rows": "sweep.LatinHypercube([axis], 0)",
        "unknown axis of a study": 'sweep.run(sweep.Grid([sweep.Axis(name="foam_stifness", low=1.0, high=2.0, '
        "points=2)]), study)",
        "chunks of no rows": "sweep.run(sweep.Grid([axis]), study, chunk_rows=0)",
        "damaged checkpoint": 'nav.optimize_gains([scene], law, grid=(2, 2, 2, 2), checkpoint="search.checkpoint")',
        "folder without a sweep": 'sweep.open("nowhere")',
        "part of more than there are": 'sweep.run(sweep.Grid([axis]), study, out="out", chunks="5/4")',
        "chunks behind the end": 'sweep.run(sweep.Grid([axis]), study, out="out", chunks="0:9")',
        "chunks of no known kind of file": 'sweep.run(sweep.Grid([axis]), study, out="out", store="parket")',
        "unknown part": 'reproduce.run("out", only="everything")',
        "hypercube seed of 65 bits": "sweep.LatinHypercube([axis], 4, seed=2**64)",
    },
    "Files and pictures": {
        "key that stands twice": 'io.load_map("twice.yaml")',
        "degrees for meters": 'io.load_map("degrees.geojson")',
        "drawing without a scale": 'io.load_map("pixels.svg")',
        "plan that was cut off": 'io.load_map("torn.dxf", unit="m")',
        "plan without its unit": 'io.load_map("unitless.dxf")',
        "unit of a map of the map server": 'io.load_map("outside.yaml", unit="m")',
        "corner of a footprint": 'io.read_nav2("nav2.yaml")',
        "agent without a start": 'io.load_scene("agents.yaml")',
        "number with a separator of thousands": 'io.load_people("thousands.csv")',
        "column by an unknown name": 'io.load_people("columns.csv")',
        "people by frames without a rate": 'io.load_people("trajnet.txt")',
        "columns that may be exchanged": 'io.load_people("grid.txt", fps=2.5)',
        "latitude and longitude": 'io.load_people("places.csv")',
        "centimeters without their unit": 'io.load_people("centimeters.csv")',
        "pixels without a scale": 'io.load_people("pixels.txt")',
        "rate that contradicts the file": 'io.load_people("camera.txt", fps=30.0)',
        "unit that contradicts the file": 'io.load_people("camera.txt", unit="m")',
        "format that nobody knows": 'io.load_people("camera.txt", format="petrac")',
        "people in no known format": 'io.load_people("broken.toml")',
        "word in a table": 'io.load_people("words.csv")',
        "way that goes back in time": 'io.load_track("order.csv")',
        "person twice at one instant": 'io.load_people("twice.csv")',
        "table without rows": 'io.load_people("header.csv")',
        "row of two fields": 'io.load_track("short.csv")',
        "table that is not there": 'io.load_people("nowhere.csv")',
        "scenario with an unknown key": 'scenarios.load("misspelt.toml")',
        "scenario with a bad number": 'scenarios.load("negative.toml")',
        "scenario with a number as text": 'scenarios.load("text.toml")',
        "scenario with an unknown obstacle": 'scenarios.load("kind.toml")',
        "scenario with an unknown law": 'scenarios.load("law.toml")',
        "scenario that is not TOML": 'scenarios.load("broken.toml")',
        "picture of no run": "plotting.paths([])",
        "picture of a scenario": "plotting.paths([scene])",
        "frames for a year": 'plotting.animate(nav.simulate(scene, law), "run.gif", speed=1e-6)',
        "frames without a rate": 'plotting.animate(nav.simulate(scene, law), "run.gif", frames_per_second=None)',
        "sequence of too many instants": "plotting.time_sequence(nav.simulate(scene, law), instants=2**31)",
        "overview of too many points": "plotting.sweep_scatter(sweep.run(sweep.Grid([axis]), study), "
        "'peak_head_acceleration', most=10**9)",
    },
    "Logs of robots": {
        "quaternion of zeros": 'io.load_log("zero.txt")',
        "poses without y": 'io.load_log("poses.csv")',
        "bag that was cut off": 'io.load_log("cut.bag")',
        "frame of the robot in a table": 'io.load_log("robot.csv", robot="base_link")',
        "offset of a topic in a table": 'io.load_log("robot.csv", offset={"/people": 0.1})',
        "people at another time": 'io.load_log("robot.csv", people="late.csv")',
        "robot whose radius nobody knows": 'nav.metrics.judge(io.load_log("robot.csv"))',
        "path in place of a log": 'nav.metrics.judge("robot.csv", robot_radius=0.3)',
        "threshold below zero": "nav.metrics.PermitRules(lead_time=-3.0)",
        "log without a radius": "hrsafety judge robot.csv",
        "unknown word of a judgement": "hrsafety judge robot.csv --radius 0.3 --fail-on crash",
    },
    "Learners and crowds": {
        "environment without a robot": "gym.CrowdEnv(nav.World())",
        "no environments": "gym.CrowdVectorEnv(gym.circle_crossing(), num_envs=0)",
        "action misspelt": 'gym.CrowdEnv(gym.circle_crossing(), action="velocty")',
        "action of three numbers": "gym.CrowdEnv(gym.circle_crossing()).step([0.0, 0.0, 0.0])",
        "action that is not finite": "gym.CrowdEnv(gym.circle_crossing()).step([np.nan, 0.0])",
        "many robots, all with a law": "gym.parallel_env(scenarios.antipodal(4, robots=2, law=law))",
        "nobody told what to do": "gym.parallel_env(scenarios.antipodal(4, robots=2)).step({'robot_0': [0.0, 0.0]})",
        "instant after the end": "plotting.crowds.crowd_paths(met, at=1000.0)",
        "colors by an unknown word": "plotting.crowds.crowd_paths(met, color_by='grop')",
        "direction without a length": "plotting.crowds.space_time(met, along=(0.0, 0.0))",
        "world for the Lyapunov function of a run": "plotting.lyapunov(met)",
    },
    "Command line": {
        "no command": "hrsafety",
        "command misspelt": "hrsafety simulat scene.toml",
        "nothing to simulate": "hrsafety simulate",
        "scenario file that is not there": "hrsafety simulate nowhere.toml",
        "three gains on the command line": "hrsafety simulate scene.toml --gains 3 20 17",
        "gain that is a word": "hrsafety simulate scene.toml --gains 3 20 17 x",
        "law that there is not": "hrsafety simulate scene.toml --law astar",
        "stabilizing force of another law": "hrsafety simulate scene.toml --law masoud --stabilizing off",
        "step that does not divide": "hrsafety simulate scene.toml --step 0.025",
        "folder that is a file": "hrsafety simulate scene.toml --out scene.toml",
        "animation of unknown kind": "hrsafety simulate scene.toml --animate run.txt",
        "runs without people": "hrsafety simulate scene.toml --runs 3",
        "people with a separator of thousands": "hrsafety simulate --people thousands.csv",
        "foam design without stiffness": "hrsafety foam design.toml",
        "study of an unknown configuration": "hrsafety optimize study.toml",
        "study with an unknown method": "hrsafety optimize budget.toml",
        "line out of reach": "hrsafety program far.toml",
        "program without acceleration": "hrsafety program slow_joint.toml",
        "segment without regions": "hrsafety program no_regions.toml",
        "segment without reason": "hrsafety program no_reason.toml",
        "segment of an unknown move": "hrsafety program moves.toml",
        "move of an unknown joint": "hrsafety program joints.toml",
        "joint log in degrees": "hrsafety program log.toml",
        "sweep without axes": "hrsafety sweep axes.toml",
        "sweep over an unknown axis": "hrsafety sweep axis.toml",
        "unknown part of reproduce": "hrsafety reproduce --only everything",
        "timed-out run": "hrsafety simulate timed_out.toml --fail-on timed_out",
        "word for what fails": "hrsafety simulate scene.toml --fail-on crash",
        "model of people that there is not": "hrsafety ros hall.toml",
        "control period in milliseconds": "hrsafety ros scene.toml --lockstep --period 50",
        "implausible value with --strict": "hrsafety simulate degrees.toml --strict",
    },
}
"""What is typed, by part and name; a line that begins with ``hrsafety`` is one of the command line."""


class AcceptedError(AssertionError):
    """An input of the list that is refused no more."""


def message(call: str, folder: Path) -> str:
    """Return what the package answers to a bad input in a folder that holds `FILES`."""
    with _inside(folder):
        shown = _command(call) if call.split()[0] == "hrsafety" else _raised(call)
    return " ".join(re.sub(r"0x[0-9a-f]{6,}", "0x...", _without(folder, shown)).split())


def _without(folder: Path, shown: str) -> str:
    """Return a message in which the folder of the files is that of a reader."""
    return shown.replace(f"{folder}{os.sep}", "").replace(str(folder), "/data/project")


def _raised(call: str) -> str:
    try:
        eval(call, dict(NAMES))
    except HrsafetyError as error:
        return f"{type(error).__name__}: {error}"
    raise AcceptedError(call)


def _command(call: str) -> str:
    said = StringIO()
    with contextlib.redirect_stderr(said), contextlib.redirect_stdout(StringIO()):
        code = main(call.split()[1:])
    if code == 0:
        raise AcceptedError(call)
    return f"exit code {code}: {said.getvalue().strip()}"


@contextlib.contextmanager
def _inside(folder: Path) -> Iterator[None]:
    for name, text in FILES.items():
        (folder / name).write_text(text, encoding="utf-8")
    with contextlib.chdir(folder):
        yield
