"""Take the pictures of the player and of the live page with a browser: ``python docs/make_views.py``."""

from __future__ import annotations

import math
import sys
import tempfile
import threading
from pathlib import Path

DOCS = Path(__file__).resolve().parent
sys.path.insert(0, str(DOCS.parent / "tests"))

from api.browsers import tab  # noqa: E402  # the folder of tests is known from the line above on
from hrsafety import navigation as nav  # noqa: E402
from hrsafety import plotting, scenarios  # noqa: E402
from hrsafety.live import serve  # noqa: E402

WIDTH, PLAYER, LIVE = 1200, 800, 830
HALL = DOCS.parent / "python/hrsafety/cli/data/people_in_a_hall.toml"


def player(target: Path) -> None:
    """Take a picture of the player of a run with a shield."""
    robot = nav.HolonomicRobot(max_speed=1.0, max_acceleration=1.5)
    scene = scenarios.random_traffic(14, seed=2, robot=robot)
    law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(), yielding=nav.Yielding())
    with tempfile.TemporaryDirectory() as folder, tab(WIDTH, PLAYER) as browser:
        page = Path(folder) / "run.html"
        plotting.player(nav.metrics.record_safety(scene, law), page, title="A robot crosses among fourteen people")
        browser.open(f"{page.as_uri()}#t=6.5")
        browser.picture(target)


def player_map(target: Path) -> None:
    """Take a picture of the player of a robot that makes a map of its scans."""
    lines = [[(0, -2), (8, -2), (8, 2), (0, 2), (0, -2)], [(3, -2), (3, 0.6)], [(5.5, 2), (5.5, -0.6)]]
    walls = nav.StaticMap.from_polylines(lines, radius=0.03)
    lidar = nav.Lidar(map=walls, beams=720, field_of_view=1.5 * math.pi, range_noise=0.01)
    place = nav.Scenario(robot=nav.DifferentialDriveRobot(), start=(1.0, 0.0), goal=(7.0, 0.0), walls=walls)
    run = nav.Run(place, nav.ArcRollouts(), nav.robots.AsBuilt(sensors=[lidar]))
    with tempfile.TemporaryDirectory() as folder, tab(WIDTH, PLAYER) as browser:
        page = Path(folder) / "run.html"
        plotting.player(run, page, title="A robot in an unknown building")
        browser.open(f"{page.as_uri()}#t=2.5")
        browser.picture(target)


def live(target: Path) -> None:
    """Take a picture of a running world."""
    said: list[str] = []
    told = threading.Event()

    def say(address: str) -> None:
        said.append(address)
        told.set()

    given = {"browser": False, "said": say, "grace": 0.5}
    thread = threading.Thread(target=serve, args=(scenarios.load_world(HALL),), kwargs=given)
    thread.start()
    told.wait()
    with tab(WIDTH, LIVE) as browser:
        browser.open(said[0])
        browser.wait("+document.body.dataset.time > 4")
        browser.picture(target)
    thread.join()


if __name__ == "__main__":
    player(DOCS / "images" / "player.png")
    player_map(DOCS / "images" / "player_map.png")
    live(DOCS / "images" / "live.png")
