"""Upper bounds of counts: the one table, checked before memory is taken.

A count beyond its bound would not fit into memory, would take years, or is a slip of the keyboard.
The cores check the bounds of what they allocate again.
"""

from __future__ import annotations

__all__ = [
    "MOST_BODIES",
    "MOST_CELLS",
    "MOST_CONTACTS",
    "MOST_COUNT",
    "MOST_DRAWN",
    "MOST_DRAWS",
    "MOST_EVALUATIONS",
    "MOST_FRAMES",
    "MOST_INSTANTS",
    "MOST_INTERVAL",
    "MOST_LANES",
    "MOST_LAYOUTS",
    "MOST_LOCAL_STARTS",
    "MOST_MASSES",
    "MOST_OBSTACLES",
    "MOST_PATH_NUMBERS",
    "MOST_PIXELS",
    "MOST_POINTS",
    "MOST_POINTS_OF_AXIS",
    "MOST_POINT_STATES",
    "MOST_RAYS",
    "MOST_REFINEMENTS",
    "MOST_REPEATS",
    "MOST_RESAMPLES",
    "MOST_ROWS_AT_ONCE",
    "MOST_RUNS",
    "MOST_SAMPLES",
    "MOST_SEEDS",
    "MOST_SIGHTINGS",
    "MOST_SWINGS",
    "MOST_TABLE_ROWS",
    "MOST_TASKS",
    "MOST_THREADS",
    "MOST_WALL_POINTS",
]

# Any count at all: it has to fit into the integers of the cores.
MOST_COUNT = 2**63 - 1

# Threads of a pool, and vector lanes that may be asked for.
MOST_THREADS = 1024
MOST_LANES = 1024

# Obstacles that are drawn for a scenario: each takes about 60 microseconds and 1 kB.
MOST_OBSTACLES = 10_000
# Scenarios and obstacles made in one call: about 250 bytes each.
MOST_BODIES = 10**7
# Cells of an occupancy grid: 32 MB as bits.
MOST_CELLS = 2**28
# Points of the walls of a floor plan: 250 bytes each.
MOST_WALL_POINTS = 10**6
# Rays of a beam, beams of a scan.
MOST_RAYS = 100_000
# Points that a planner draws at one step.
MOST_DRAWS = 10**6
# Layouts of a study of the follower or the skirt.
MOST_LAYOUTS = 10**7
# Seeds of repeated runs, of noise in a search, of a calibration study.
MOST_SEEDS = 10**6
# Pairs of a robot under a law and a person in its sight, in all worlds together: 300 bytes each.
MOST_SIGHTINGS = 10**7
# Rows of a table of runs: about half a kilobyte each while it is made.
MOST_TABLE_ROWS = 10**7
# Motion steps from one row of a recorded run to the next.
MOST_INTERVAL = 10**7
# Numbers of the paths of a table of runs: 1.6 GB, about three times that while they are put side by side.
MOST_PATH_NUMBERS = 2 * 10**8
# Runs of all sources together: their delays fill 1.6 GB.
MOST_RUNS = 10**8
# Tests of one kind, timed runs, runs across a recording.
MOST_REPEATS = 10**5
# Instants of a picture, each a panel or a place.
MOST_INSTANTS = 24
# Pictures of an animation: a minute of drawing for every thousand.
MOST_FRAMES = 6000
# Points or lines of an overview; a page holds no more that could be told apart.
MOST_DRAWN = 10**6
# Samples of a record: 80 MB a column.
MOST_SAMPLES = 10**7
# Radians that a mass swings on its foam within a record: a drop test has a hundred.
MOST_SWINGS = 5 * 10**4
# Draws of a bootstrap.
MOST_RESAMPLES = 10**6
# Pixels along a side of a picture.
MOST_PIXELS = 10**6

# Points of a grid of gains: their values have to fit into memory.
MOST_POINTS = 10**8
# Rounds of ever finer grids: 60 halvings bring any increment below the spacing of floats.
MOST_REFINEMENTS = 60
# Local searches side by side, each a thread that mostly waits.
MOST_LOCAL_STARTS = 1024
# Gain sets of a global search.
MOST_EVALUATIONS = 10**9
# Values of a gain of which the surroundings are examined.
MOST_POINTS_OF_AXIS = 10**5

# Rows of a design that are made as one array.
MOST_ROWS_AT_ONCE = 10**8
# Chunks that are under way, and how often one is tried again.
MOST_TASKS = 10**5

# Effective masses of one call: 800 MB.
MOST_MASSES = 10**8
# Positions, mobilities and extremes of one call: 250 bytes each.
MOST_POINT_STATES = 10**7
# Collisions, allowed speeds or thicknesses of one call: a quarter of a kilobyte each while they are made.
MOST_CONTACTS = 10**7
