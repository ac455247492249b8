"""Examples that the help of each command ends with."""

from __future__ import annotations

__all__ = [
    "ARENA",
    "ARM",
    "BENCHMARK",
    "CONTACT",
    "FOAM",
    "INFO",
    "INIT",
    "JUDGE",
    "OPTIMIZE",
    "PLAY",
    "PROGRAM",
    "RECORD",
    "REPRODUCE",
    "ROS",
    "SIMULATE",
    "SWEEP",
    "VALIDATE",
    "ZONES",
]

RECORD = """examples:
  hrsafety record drop_1.csv drop_2.csv drop_3.csv --kind head --hic15 275 --filter 1000 --out drops
  hrsafety record hand_1.csv hand_2.csv hand_3.csv --kind force --transient 280 --quasi-static 140 --device device.toml

Files are tables as devices write them, or channels, folders and archives of ISO-MME. Loads are those of the whole
record. Several files are repetitions: with three or more, and their expanded uncertainty within the limit, it is kept.
"""

REPRODUCE = """example:
  hrsafety reproduce --out reproduction
  hrsafety reproduce --only tables-6 --only figures-6
"""

SIMULATE = """examples:
  hrsafety simulate my_first_crossing.toml --out crossing --animate crossing/run.gif
  hrsafety simulate my_first_crossing.toml --gains 4.3 20.3 240.7 0.68 --stabilizing off
  hrsafety simulate my_first_crossing.toml --law velocity-obstacle
  hrsafety simulate --people zara01.csv --runs 24 --out zara01 --animate zara01/run.gif

People come from a file in any layout that "hrsafety people info" reads. The robot crosses the main flow of people,
who walk as recorded; start times are those with most traffic on its way.
"""

PEOPLE = """examples:
  hrsafety people info obsmat.txt
  hrsafety people info students003.txt --step-s 0.4
  hrsafety people convert annotations.txt people.csv --scale 0.0384 --classes pedestrian,biker

The format is recognized by the contents: ETH, UCY, TrajNet, TrajNet++, Stanford Drone, inD, PeTrack, JuPedSim, Juelich
HDF5, ATC, THOR, THOR-Magni, CITR, SocNavData, tables with a header, bare columns of numbers. What a file does not say
is asked for.
"""

FOAM = """example:
  hrsafety foam examples/foam_design.toml --out puma

The file names a manipulator, a closing speed, limits, a range of foam damping and foams. The
folder receives summary.html with the picture of the boundaries, boundaries.csv and
boundaries.png.
"""

OPTIMIZE = """examples:
  hrsafety optimize examples/gain_study.toml --out gains
  hrsafety optimize examples/gain_study.toml --out gains --resume

The file names scenarios, bounds, the grid and its refinements, an objective, constraints and
whatever else differs from the published procedure. Ctrl-C keeps what is done in the folder;
--resume continues from there and ends with the same result. The folder receives summary.html
with the pictures, results.json with every value, and the pictures.
"""

SWEEP = """examples:
  hrsafety sweep examples/impact_sweep.toml --out foams
  hrsafety sweep examples/gain_sweep.toml --out gains --workers 4 --table gains/result.parquet
  hrsafety sweep examples/gain_sweep.toml --dry-run
  hrsafety sweep examples/gain_sweep.toml --out gains --chunks 3/16

The file names axes with their ranges, a design (grid, Latin hypercube or Sobol sequence) and what
is computed: impacts, or runs in given scenarios. Chunks are written as they finish; the same
command resumes after a stop, whatever stopped it. The folder receives summary.html with the
pictures, sweep.json and the folder chunks, which hrsafety.sweep.open reads.
"""

BENCHMARK = """examples:
  hrsafety benchmark s5 --laws field field+shield+yielding orca+shield --person-speed 1.0
  hrsafety benchmark crowd --cases 1000 --out crowd
  hrsafety benchmark recordings --data recordings --out recordings

Episodes are kept in the folder as they come; the same command resumes there. Shares stand with their
95 % Wilson intervals. A contact is at fault where the robot moves toward whom it touches.
"""

ARENA = """examples:
  hrsafety arena --laws orca+shield+yielding straight+barrier --seeds 20 --out arena
  hrsafety arena --scenes narrow_doorway blind_corner --people not_reacting --sensing exact noise_delay

Finished tasks are kept in the folder; the same or a larger command resumes there. The page can be sorted, and
every row has the command that makes its episodes again.
"""

ROS = """examples:
  hrsafety ros world.toml --wait --out run
  hrsafety ros world.toml --lockstep --out run
  hrsafety ros world.toml --lockstep --drive --complete

It publishes /clock, /tf, /odom, /scan, /map, /people and /hrsafety/verdict, and moves the robot by cmd_vel. Ctrl-C
ends the run and scores it. rclpy comes with ROS 2: source its setup file first.
"""

PLAY = """examples:
  hrsafety play
  hrsafety play world.toml --no-browser

Only this machine can ask the page, and only with the token in its address. It ends with its last tab, or by Ctrl-C.
"""

JUDGE = """examples:
  hrsafety judge rosbag2_2026_03_31 --radius 0.3 --map map.yaml --out judged
  hrsafety judge odometry.csv --people tracks.csv --radius 0.3 --fail-on contact,violated_rule
  hrsafety judge run.bag --frame odom --people "/humans:agents[] id=id position=pose.position" --radius 0.3

Nobody who was not seen counts as safe: what is not judged stands in a table with its times and reasons. A bag
needs rosbags: pip install rosbags.
"""

INIT = """examples:
  hrsafety init scenario
  hrsafety init contact my_cell.toml

Every key of the file is explained in it. Nothing is overwritten.
"""

VALIDATE = """examples:
  hrsafety validate my_first_crossing.toml gain_study.toml
  hrsafety validate robot.urdf --strict

Each file is read as its command reads it, and nothing is run but, of a sweep over seeds, a few rows to see that they
differ. The exit code is 2 if a file is invalid.
"""

ZONES = """examples:
  hrsafety zones --footprint 0.22 --max-speed 0.5 --max-turn-rate 1.0 --deceleration 2.5 --reaction 0.15 \\
      --error 0.02 --beam-step-deg 0.5 --command-fall 2.5 --turn-command-fall 3.2 --out cm.yaml
  hrsafety zones check cm.yaml --footprint 0.22 --max-speed 0.5 --max-turn-rate 1.0 --deceleration 2.5 \\
      --reaction 0.15 --error 0.02 --beam-step-deg 0.5 --out verdict --fail-on broken,not_covered

The first writes polygons for a collision monitor of Nav2 that stop the robot before it touches a person, and prints
their fields. The second attacks those of a file: broken means that the robot touched somebody while it moved toward the
person. A check takes what it is not told from the default robot of Nav2, and says so.
"""

INFO = """example:
  hrsafety info
"""

ARM = """examples:
  hrsafety arm robot.urdf --link tool0 --joint elbow=1.2 --joint wrist=-0.4
  hrsafety arm robot.urdf --link tool0 --payload 2.0 --poses poses.csv --out masses

The table has the mass of a point along the world axes, its least and worst direction, and the mass
of ISO/TS 15066 beside them. Without --joint and --poses the arm stands in the middle of its limits
and in drawn poses. The folder receives masses.csv, mass_ellipse.png, the mass ellipse in the pose
with the worst mass, and summary.html with both.
"""

CONTACT = """examples:
  hrsafety contact --init cell.toml
  hrsafety contact examples/contact_arm.toml --out report --date 2026-03-31 --pdf

The file names a robot (an arm from URDF, a mobile base or a mass), coverings, the regions of the body
that may be touched and the planned speeds. The folder receives report.html, a page that prints on A4,
and report.json with every number of it; the same file gives the same bytes. The date is printed only
if it is given here or by SOURCE_DATE_EPOCH.
"""

PROGRAM = """examples:
  hrsafety init program
  hrsafety program robot_program.toml --out program

The file names a robot (URDF), its motion (a joint log or moves), the points of it that may touch a person, and the
regions of the body within reach of each segment. The folder receives report.html, a page that prints on A4,
report.json, the log of the joints within the limits of contacts, the measurement plan and a table of all waypoints;
the same file gives the same bytes.
"""
