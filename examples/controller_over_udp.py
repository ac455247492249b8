"""A robot in a process of its own, driven over UDP at 50 Hz by a `Controller`, as a robot on a network would be.

The robot sends its pose, its velocity and whom it sees, and takes up the velocity that it is sent. Some packets are
lost on purpose: then it carries out the plan of the last command, which ends at rest.
"""

from __future__ import annotations

import json
import math
import multiprocessing
import socket
import time

from hrsafety import navigation as nav

PERIOD = 0.02
GOAL = (4.0, 0.0)
LIMIT = 30.0
LOST = 50
"""One packet in so many is not sent."""


def person_at(seconds: float) -> tuple[float, float, float, float]:
    """Return place and velocity of somebody who walks to and fro across the way."""
    phase = 0.5 * seconds
    return 2.0, 1.5 * math.sin(phase), 0.0, 0.75 * math.cos(phase)


def robot(port: int) -> None:
    """Drive as told over UDP, and print how it went."""
    wire = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    wire.settimeout(PERIOD)
    begin = time.perf_counter()
    place, velocity, plan, told = (0.0, 0.0), (0.0, 0.0), [(0.0, 0.0)], 0.0
    nearest, packets = math.inf, 0
    while math.dist(place, GOAL) > 0.12 and time.perf_counter() - begin < LIMIT:
        now = time.perf_counter() - begin
        # A plan begins a period after it was asked for; without a new one the velocity is the next one of the last.
        before, velocity = velocity, plan[min(max(round((now - told) / PERIOD) - 1, 0), len(plan) - 1)]
        place = tuple(x + 0.5 * (v + w) * PERIOD for x, v, w in zip(place, before, velocity, strict=True))
        x, y, vx, vy = person_at(now)
        nearest = min(nearest, math.dist(place, (x, y)) - 0.6)
        packets += 1
        if packets % LOST:
            seen = {"time": now, "position": place, "velocity": velocity, "people": {"walker": (x, y, vx, vy)}}
            wire.sendto(json.dumps(seen).encode(), ("127.0.0.1", port))
            try:
                answer = json.loads(wire.recvfrom(65_536)[0])
                plan, told = answer["plan"], now
            except TimeoutError:
                pass
        time.sleep(max(0.0, begin + packets * PERIOD - time.perf_counter()))
    arrived = math.dist(place, GOAL) <= 0.12
    print(f"arrived: {arrived}, {packets} periods, never touched: {nearest > 0.0}")
    wire.sendto(json.dumps({"arrived": arrived}).encode(), ("127.0.0.1", port))


def main() -> None:
    """Control the robot until it says that it is done."""
    wire = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    wire.bind(("127.0.0.1", 0))
    wire.settimeout(LIMIT)
    shield = nav.laws.Shield(person_speed=1.0, latency=2.0 * PERIOD)
    law = nav.laws.SafeNavigation(nav.VirtualForceField(), shield=shield, yielding=nav.laws.Yielding())
    controller = nav.controller.Controller(law, nav.HolonomicRobot(), GOAL, start=(0.0, 0.0), control_period=PERIOD)
    process = multiprocessing.get_context("spawn").Process(target=robot, args=(wire.getsockname()[1],))
    process.start()
    took = []
    while True:
        packet, sender = wire.recvfrom(65_536)
        seen = json.loads(packet)
        if "arrived" in seen:
            break
        begin = time.perf_counter()
        command = controller.update(seen["time"], seen["position"], seen["velocity"], people=seen["people"])
        took.append(time.perf_counter() - begin)
        plan = [command.velocity_after(PERIOD * step) for step in range(1, 40)]
        wire.sendto(json.dumps({"plan": plan}).encode(), sender)
    process.join()
    print(f"{len(took)} updates, the slowest took {1e3 * max(took):.2f} ms")
    if not seen["arrived"]:
        raise SystemExit("the robot did not arrive")


if __name__ == "__main__":
    main()
