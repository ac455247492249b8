"""``hrsafety ros WORLD.toml``: people for a robot that is driven over ROS 2."""

from __future__ import annotations

import argparse
import math
import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import TYPE_CHECKING

from hrsafety import navigation as nav
from hrsafety import scenarios
from hrsafety.cli import output, terminal, verdict
from hrsafety.errors import InvalidParameterError
from hrsafety.io import read_nav2
from hrsafety.ros.bridge import Bridge, Settings
from hrsafety.ros.rcl import connected, stamps_by_default
from hrsafety.ros.record import BusRecord
from hrsafety.ros.score import report_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

__all__ = ["serve_world"]


def serve_world(options: argparse.Namespace) -> None:
    """Publish a world until it ends or Ctrl-C is pressed, and report.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety ros``.
    """
    verdict.failures_of(options.fail_on)  # a wrong word is told before the run
    output.check_targets(options)
    with output.located(options.world):
        world = scenarios.load_world(options.world)
    if options.seed is not None:
        world = replace(world, seed=options.seed)
    if options.params is not None:
        world = _with_body(world, options.params)
    settings = settings_of(options)
    if options.drive:
        from hrsafety.ros.drive import LawNode

        with _stoppable(), connected("hrsafety_drive") as bus:
            LawNode(
                world,
                bus,
                lockstep=settings.lockstep,
                commands=_sent(settings),
                topic=settings.topic,
                complete=options.complete,
            ).run()
        return
    with _stoppable(), connected("hrsafety") as bus:
        bridge = Bridge(world, bus, settings)
        try:
            bridge.run()
        except KeyboardInterrupt:
            if len(bridge.record.legs[0]) < 2:
                raise
            print("stopped by Ctrl-C: the run so far is scored\n")
    _report(bridge.record, settings, options)


@contextmanager
def _stoppable() -> Iterator[None]:
    """Let the signals of a launch file end a run as Ctrl-C does, also of one in the background of a script."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    kinds = (signal.SIGINT, signal.SIGTERM)
    before = [signal.signal(kind, signal.default_int_handler) for kind in kinds]
    try:
        yield
    finally:
        for kind, handler in zip(kinds, before, strict=True):
            signal.signal(kind, signal.SIG_DFL if handler is None else handler)


def _with_body(world: nav.World, path: str) -> nav.World:
    """Return the world with the robot that a parameter file of Nav2 describes."""
    found = read_nav2(path)
    with output.located(path):
        body = found.robot()
    robots = [replace(robot, body=body) for robot in world.robots]
    return replace(world, robots=robots, doubts=(*world.doubts, *found.body_warnings))


def _sent(settings: Settings) -> str:
    """Return what a controller sends: what ROS 2 has by default, but stamps in lock-step, which are answers."""
    if settings.commands != "auto":
        return settings.commands
    return "stamped" if settings.lockstep or stamps_by_default() else "twist"


def settings_of(options: argparse.Namespace) -> Settings:
    """Return how the bridge is to run; errors name the options."""
    try:
        return _settings(options)
    except InvalidParameterError as error:
        name = {"range_max": "range"}.get(error.argument, error.argument)
        raise error.renamed(f"--{name.replace('_', '-')}") from None


def _settings(options: argparse.Namespace) -> Settings:
    lidar = nav.Lidar(beams=options.beams, range_max=options.range, field_of_view=math.radians(options.field_of_view))
    return Settings(
        lockstep=options.lockstep,
        period=options.period,
        delay=options.delay,
        speed=options.speed,
        lidar=lidar,
        resolution=options.resolution,
        commands=options.commands,
        topic=options.topic,
        wait=options.wait,
        stay=options.stay,
    )


def _report(record: BusRecord, settings: Settings, options: argparse.Namespace) -> None:
    """Print and write the score of a run, and leave with the code that the options ask for."""
    report = report_of(record, settings, options.world)
    print(terminal.told(report))
    written = []
    if options.out is not None:
        plays = [output.player(leg.trajectory) for leg in record.legs]
        written = output.write_report(report, output.folder(options.out), _draw(record), [], plays=plays)
    output.say_written(written, report, options)
    contacts = record.contacts
    touched = (
        contacts.moving
        + contacts.standing
        + contacts.apart
        + sum(int(leg.metrics.wall_contacts) for leg in record.legs)
    )
    arrived = math.isfinite(record.legs[-1].trajectory.robot_arrival_time[0])
    happened = {
        "contact": bool(touched),
        "moving_contact": bool(contacts.moving),
        "timed_out": not arrived and not touched,
        "diverged": record.legs[-1].outcome == "diverged",
        "not_arrived": not arrived,
        "any": bool(touched) or not arrived,
    }
    counts = {word: int(happened.get(word, False)) for word in verdict.FAILURES}
    verdict.end(report.said, counts, report.warnings, options, 1)


def _draw(record: BusRecord) -> Iterator[tuple[str, Figure, str]]:
    from hrsafety import plotting

    for index, leg in enumerate(record.legs):
        name = "paths" if len(record.legs) == 1 else f"paths_{index}"
        yield name, plotting.crowds.crowd_paths(leg.trajectory), f"Paths of robot and people, leg {index}."
