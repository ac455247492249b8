"""Files that play what happened: HTML that needs no network, and MCAP for viewers of robot logs."""

from __future__ import annotations

import os
from dataclasses import replace
from pathlib import Path
from typing import Any

from hrsafety._calls import suggesting
from hrsafety._replay.mcap import write_mcap
from hrsafety._replay.page import PlayerPage, player_page
from hrsafety._replay.record import Replay
from hrsafety.errors import InvalidParameterError, Shown

__all__ = ["mcap", "player"]


@suggesting
def player(run: Any, path: str | os.PathLike[str] | None = None, *, title: str | None = None) -> PlayerPage:
    """Return a run as an HTML file that plays it: no network, no library, nothing beside it.

    Shown are robots with footprint, heading and way, people, what stands and unobserved floor, goals, the
    verdict of a shield with the area that it verified and where people can be by then, the guide's path, contacts, a
    clock, speeds and clearances, and what was not judged; of a `Run` also the map that a law makes of its scans, and
    where people can be whom a robot does not see. Everything can be reached by keyboard (``?`` lists the
    keys), and stands in tables, too. An address that ends in ``#t=12.4`` opens the file at that instant.

    Parameters
    ----------
    run : Trajectory, SafetyRecord, Run, Judgement, Recording or Replay
        What happened. A `SafetyRecord` has the decisions of a shield, which a run by itself does not keep. A `Run` is
        stepped to its end, and `Run.known_cells` and `Run.unseen_places` are recorded from now on.
    path : str, path-like or None
        Where to write the file, too.
    title : str or None
        Title of the page; what the run says of itself when ``None``.

    Returns
    -------
    PlayerPage
        The HTML document, a string: the same bytes for the same run. ``save(path)`` writes it; a notebook shows it.
        At most 1 MB: of a longer run instants farther apart are shown, between which clearances are the least and
        verdicts the worst.

    Raises
    ------
    InvalidParameterError
        If the run has no instants, is a `Run` that has ended, or is nothing that can be played.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> law = nav.SafeNavigation(nav.VirtualForceField(), shield=nav.Shield(person_speed=1.0))
    >>> record = nav.metrics.record_safety(scenarios.configuration("c2"), law)
    >>> plotting.player(record, "run.html")[:15]
    '<!DOCTYPE html>'
    """
    shown = _replay(run)
    page = player_page(shown if title is None else replace(shown, title=str(title)))
    if path is not None:
        page.save(path)
    return page


@suggesting
def mcap(run: Any, path: str | os.PathLike[str]) -> Path:
    """Write a run as an MCAP file, which viewers of robot logs play.

    With the standard schemas: ``/tf`` (FrameTransforms), ``/robot`` (PoseInFrame), ``/scene`` (SceneUpdate: footprint,
    people as entities by name, walls, the area that a plan sweeps, the guide's path), ``/map`` (Grid: 0 free, 100
    occupied, 255 not seen by anybody), ``/scan`` (LaserScan, of a robot with a lidar, without its noise), ``/state``
    (JSON: speed, clearance, margin, verdict, why nothing is judged) and ``/events`` (Log, doubts among them). Several
    robots are ``/robot_0``, ``/robot_1`` and so on. Instants are at least 0.04 s apart.

    Parameters
    ----------
    run : Trajectory, SafetyRecord, Run, Judgement, Recording or Replay
        What happened, as of `player`; cells of a `Run` are not written.
    path : str or path-like
        Where to write; its folder must exist.

    Returns
    -------
    pathlib.Path
        The file.

    Raises
    ------
    InvalidParameterError
        If the run has no instants, is a `Run` that has ended, or is nothing that can be played.
    MissingExtraError
        If foxglove-sdk is not installed.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> run = nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField())
    >>> plotting.mcap(run, "run.mcap").read_bytes()[1:5]
    b'MCAP'
    """
    return write_mcap(_replay(run), Path(path))


def _replay(run: Any) -> Replay:
    """Return what a player shows of a run."""
    made = getattr(run, "_replay", None)
    if made is None:
        rule = "be a run, a record of decisions, a judged log, a world that was simulated, or recorded people"
        raise InvalidParameterError("run", rule, Shown(type(run).__name__), "`nav.simulate` returns a run")
    shown: Replay = made()
    return shown
