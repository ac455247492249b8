"""``hrsafety play``: a world that runs while people and the goal are dragged, as a page of this machine."""

from __future__ import annotations

import argparse
from dataclasses import replace
from importlib import resources

from hrsafety import scenarios
from hrsafety.cli import output
from hrsafety.errors import InvalidParameterError
from hrsafety.live import serve

__all__ = ["play_world"]

MOST_PORT = 65_535
HALL = "people_in_a_hall.toml"


def play_world(options: argparse.Namespace) -> None:
    """Serve the page of a running world until its last tab is closed or Ctrl-C is pressed.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety play``.
    """
    if not 0 <= options.port <= MOST_PORT:
        raise InvalidParameterError("--port", f"be from 0 to {MOST_PORT}", options.port)
    if options.world is None:
        with resources.as_file(resources.files("hrsafety.cli").joinpath("data", HALL)) as file:
            world = scenarios.load_world(file)
    else:
        with output.located(options.world):
            world = scenarios.load_world(options.world)
    if options.seed is not None:
        world = replace(world, seed=options.seed)
    output.report_warnings(world.warnings, strict=False)
    serve(world, port=options.port, browser=options.browser, said=lambda address: print(address, flush=True))
