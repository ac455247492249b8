"""Send the robot across recorded people and count what happens.

Run it with ``python examples/recorded_people.py people.csv``; the file has the columns
frame, t_s, ped_id, x_m, y_m.
"""

from __future__ import annotations

import sys

from hrsafety import io, scenarios
from hrsafety import navigation as nav

RUNS = 20


def main(path: str) -> None:
    """Cross the main flow of a recording at many start times."""
    recording = io.load_people(path)
    flow = recording.main_flow()
    print(f"{len(recording.people())} people in {recording.duration:.0f} s")
    print(f"main flow through ({flow.center[0]:.1f}, {flow.center[1]:.1f}) m, {2 * flow.spread:.1f} m to either side")

    crossings = scenarios.crossings(recording, runs=RUNS)
    for mode in ("off", "capped"):
        law = nav.VirtualForceField(stabilizing=mode)
        table = nav.simulate_many([crossing.scenario for crossing in crossings], law)
        print(f"\nstabilizing force {mode}")
        print(f"  reached the goal                  {int((table.arrival_time > 0).sum()):3d} of {len(table)}")
        print(f"  without touching anybody          {int((table.outcome == 'arrived').sum()):3d}")
        print(f"  people in the active region       {int(table.entered_active.sum()):3d}")
        print(f"  toward whom the robot moved       {int(table.contacts_toward.sum()):3d}")
        print(f"  who touched it while it retreated {int(table.contacts_away.sum()):3d}")
        print(f"  walked into the standing robot    {int(table.contacts_standing.sum()):3d}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python recorded_people.py people.csv")
    main(sys.argv[1])
