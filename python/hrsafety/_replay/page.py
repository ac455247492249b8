"""The player: one HTML file with everything in it, which loads nothing and runs without a network."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import math
import os
import re
from collections.abc import Iterator, Sequence
from functools import cache
from importlib import resources
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety import __version__
from hrsafety._atomic import write_file
from hrsafety._replay.cells import cells_of
from hrsafety._replay.ground import ground_of
from hrsafety._replay.packing import Block, Scale, block, counted
from hrsafety._replay.record import VERDICTS, Decisions, Event, PlayedLidar, PlayedRobot, Replay

__all__ = ["LIMIT", "PlayerPage", "digest", "frame_rows", "least_since", "player_page", "verdicts_of"]

Array = npt.NDArray[np.float64]
Rows = npt.NDArray[np.intp]

LIMIT = 1_000_000
"""Letters of a page; of a run that would need more, instants farther apart are shown."""
LEAST_FRAMES = 50
FRAME_HEIGHT = 760
FINEST_STEP = 0.04
"""Least time between two frames in s; a player draws straight lines between them."""
TICK = 1e-3
MOST_TICKS = 65_535
MOST_PLAN = 24
"""Most places of a plan that are shown."""
MOST_RANGES = 60_000
"""Most ranges of scans that a page holds; of more beams some are shown."""
RANGES = 2e-3
MARGIN = 1.0
CLEARANCES = 1e-3
ANGLES = 1e-4
TEXT_ROWS = 40


class PlayerPage(str):
    """A page that plays a run: the HTML document, as text.

    Examples
    --------
    >>> from hrsafety import navigation as nav, plotting, scenarios
    >>> page = plotting.player(nav.simulate(scenarios.configuration("c1"), nav.VirtualForceField()))
    >>> page.save("run.html").name, page.startswith("<!DOCTYPE html>")
    ('run.html', True)
    """

    __slots__ = ()

    def save(self, path: str | os.PathLike[str]) -> Path:
        """Write the page.

        Parameters
        ----------
        path : str or path-like
            Where; its folder must exist.

        Returns
        -------
        pathlib.Path
            The file.
        """
        return write_file(Path(path), self)

    def framed(self, *, title: str = "player", height: int = FRAME_HEIGHT) -> str:
        """Return the page in a frame of another one, where it can run its own script and nothing else.

        Parameters
        ----------
        title : str
            What the frame is called.
        height : int
            In pixels.

        Returns
        -------
        str
            An ``iframe`` element.
        """
        look = f"width:100%;height:{height}px;border:1px solid #d0d7de;border-radius:6px"
        inside, name = html.escape(self), html.escape(title)
        return (
            f'<iframe sandbox="allow-scripts" title="{name}" loading="lazy" style="{look}" srcdoc="{inside}"></iframe>'
        )

    def _repr_html_(self) -> str:
        """Return the page as a notebook shows it."""
        return self.framed()


def player_page(replay: Replay, *, limit: int = LIMIT) -> PlayerPage:
    """Return the page that plays what happened.

    Parameters
    ----------
    replay : Replay
        What happened.
    limit : int
        Most letters of the page; of a run that would need more, instants farther apart are shown.

    Returns
    -------
    PlayerPage
        A complete HTML document; the same bytes for the same input.
    """
    span, places = float(replay.time[-1] - replay.time[0]), 0
    if replay.people is not None:
        places = int(np.isfinite(replay.people[..., 0]).sum())
    # A place takes a letter or two: what cannot fit is not packed first.
    step = max(FINEST_STEP, span / max(len(replay.time), 1) * places / limit)
    while True:
        rows = _rows(replay, step)
        page = _page(replay, rows)
        if len(page) <= limit or len(rows) <= LEAST_FRAMES:
            return PlayerPage(page)
        step = 2.0 * max(step, span / (len(rows) - 1))


def _rows(replay: Replay, step: float) -> Rows:
    """Return the instants that are shown: some time apart, with the first, the last and those of events."""
    time = np.asarray(replay.time, dtype=np.float64)
    wanted = np.arange(math.floor((time[-1] - time[0]) / step) + 1) * step + time[0] if len(time) > 1 else time[:1]
    if len(wanted) < len(time):
        chosen = np.searchsorted(time, wanted - 1e-9)
        ends = np.array([0, len(time) - 1])
        events = np.searchsorted(time, [each.time for each in replay.events])
        rows = np.unique(np.concatenate([chosen, ends, np.clip(events, 0, len(time) - 1)]))
    else:
        rows = np.arange(len(time))
    # Two frames at one tick would be one instant.
    _, first = np.unique(np.round((time[rows] - time[0]) / TICK), return_index=True)
    return rows[first].astype(np.intp)


def least_since(values: Array, rows: Rows) -> Array:
    """Return the least value since the frame before: what is between two frames is not lost, unknown stays unknown."""
    starts = np.concatenate([[0], rows[:-1] + 1])
    with np.errstate(invalid="ignore"):
        return np.minimum.reduceat(values[: rows[-1] + 1], starts)


def frame_rows(replay: Replay) -> Rows:
    """Return the instants that are shown where there is room for all that a player can tell apart."""
    return _rows(replay, FINEST_STEP)


def verdicts_of(made: Decisions | None, time: Array) -> tuple[npt.NDArray[np.int64], Array, Rows]:
    """Return verdict and margin at frames, the worst since the frame before, and the decision in force, -1 without."""
    if made is None or not len(made.time):
        nothing = np.full(len(time), -1, dtype=np.intp)
        return np.zeros(len(time), dtype=np.int64), np.full(len(time), np.nan), nothing
    at = np.searchsorted(made.time, time + 1e-9, side="right") - 1
    codes = np.array([VERDICTS.index(each) for each in made.verdict], dtype=np.int64)
    margins = np.asarray(made.margin, dtype=np.float64)
    since = np.minimum(np.concatenate([[0], at[:-1] + 1]), at)
    spans = [slice(low, high + 1) for low, high in zip(since.tolist(), at.tolist(), strict=True)]
    worst = np.array([int(codes[span].max()) if span.stop else 0 for span in spans])
    margin = np.array([margins[span].min() if span.stop else np.nan for span in spans])
    return worst, margin, at


class _Content:
    """Head and blocks of a page, filled part by part."""

    def __init__(self, replay: Replay, rows: Rows) -> None:
        self.replay, self.rows = replay, rows
        self.time = np.asarray(replay.time, dtype=np.float64)[rows]
        self.blocks: list[Block] = []
        self.known: list[tuple[str, str]] = []
        people = np.empty((len(replay.time), 0, 2)) if replay.people is None else np.asarray(replay.people)
        self.people = people[rows]
        robots = [np.asarray(each.position, dtype=np.float64)[rows] for each in replay.robots]
        self.robots = np.stack(robots, axis=1) if robots else np.empty((len(rows), 0, 2))
        decided = [each.decisions for each in replay.robots if each.decisions is not None]
        lines = [line for each in decided for line in (*each.plan, *each.path)]
        lines += [line for each in replay.robots if each.cells is not None for line in each.cells.way]
        # People are farther apart than the way of a robot is long, whose places are kept as finely as they can.
        self.scale, self.own_scale = Scale.of(self.people), Scale.of(self.robots, *lines)

    def head(self) -> dict[str, Any]:
        """Return everything that is no long list of numbers, and pack the rest."""
        replay = self.replay
        tick = TICK * max(1, math.ceil(np.diff(self.time, prepend=self.time[0]).max() / TICK / MOST_TICKS))
        ticks = np.round((self.time - self.time[0]) / tick).astype(np.int64)
        self.blocks += [
            block("time", np.diff(ticks, prepend=ticks[0]), kind="u16"),
            block("people", self.scale.whole(self.people)),
            block("robots", self.own_scale.whole(self.robots)),
        ]
        count = self.people.shape[1]
        kinds = list(replay.kinds) or ["person"] * count
        words = list(dict.fromkeys(kinds))
        radius = np.full(count, 0.25) if replay.radius is None else np.asarray(replay.radius, dtype=np.float64)
        ground, packed = ground_of(replay.maps)
        self.blocks += packed
        return {
            "title": replay.title,
            "start": float(self.time[0]),
            "tick": tick,
            "people": [self.scale.unit, *self.scale.middle],
            "own": [self.own_scale.unit, *self.own_scale.middle],
            "view": self._view(ground),
            "robots": [self._robot(index, each) for index, each in enumerate(replay.robots)],
            "radius": [round(float(each), 4) for each in radius],
            "names": list(replay.names) or [str(index) for index in range(count)],
            "kinds": words,
            "kind": [words.index(each) for each in kinds],
            "boxes": {str(index): list(size) for index, size in (replay.boxes or {}).items()},
            "ground": ground,
            "events": [self._event(each) for each in sorted(replay.events, key=lambda each: each.time)],
            "notJudged": [[float(each.begin), float(each.end), each.reason] for each in replay.not_judged],
            "verdicts": list(VERDICTS),
            "frames": len(self.rows),
            "instants": len(replay.time),
            "hashes": {"sha256": self._hash(), "hrsafety": __version__},
        }

    def _event(self, event: Event) -> list[Any]:
        """Return an event; a contact without a place is where the robot was."""
        place = event.place
        if place is None and event.kind in ("contact", "fault") and self.robots.shape[1] == 1:
            row = min(int(np.searchsorted(self.time, event.time - 1e-9)), len(self.time) - 1)
            place = tuple(self.robots[row, 0].tolist())
        known = place is not None and all(map(math.isfinite, place))
        return [round(float(event.time), 4), event.kind, event.words, [round(x, 4) for x in place] if known else None]  # type: ignore[union-attr]  # known

    def _robot(self, index: int, robot: PlayedRobot) -> dict[str, Any]:
        """Return one robot, its series packed."""
        if robot.heading is not None:
            turned = np.mod(np.asarray(robot.heading)[self.rows] + np.pi, 2.0 * np.pi) - np.pi
            self.blocks.append(block(f"heading{index}", counted(turned, ANGLES)))
        if robot.speed is not None:
            self.blocks.append(block(f"speed{index}", counted(np.asarray(robot.speed)[self.rows], CLEARANCES)))
        if robot.clearance is not None:
            least = least_since(np.asarray(robot.clearance, dtype=np.float64), self.rows)
            self.blocks.append(block(f"clearance{index}", counted(least, CLEARANCES)))
        if robot.decisions is not None and len(robot.decisions.time):
            self._decisions(index, robot.decisions)
        beams = [] if robot.scan is None else self._scans(index, robot.scan)
        return self._cells(index, robot) | {
            "name": robot.name,
            "radius": float(robot.radius),
            "footprint": [list(map(float, corner)) for corner in robot.footprint],
            "goal": None if robot.goal is None else [float(part) for part in robot.goal],
            "tolerance": float(robot.tolerance),
            "beams": beams,
            "decided": robot.decisions is not None and len(robot.decisions.time) > 0,
        }

    def _scans(self, index: int, scan: PlayedLidar) -> list[float]:
        """Pack the scans of a robot, of many beams some, and return the angles of those beams from its heading."""
        found = [np.asarray(scan.ranges(int(row)), dtype=np.float64) for row in self.rows]
        beams = len(found[0])
        shown = np.unique(np.linspace(0, beams - 1, min(beams, MOST_RANGES // len(found) + 1)).astype(int))
        ranges = np.stack(found)[:, shown]
        self.blocks.append(block(f"scan{index}", counted(np.where(ranges < scan.range_max, ranges, np.nan), RANGES)))
        angles = np.linspace(scan.start_angle, scan.end_angle, beams)[shown]
        return [round(float(each), 4) for each in angles]

    def _decisions(self, index: int, made: Decisions) -> None:
        """Pack verdict and margin of each frame, the worst since the frame before, and the plans in force."""
        worst, margin, at = verdicts_of(made, self.time)
        self.blocks.append(block(f"verdict{index}", worst, kind="u8"))
        self.blocks.append(block(f"margin{index}", counted(margin, CLEARANCES)))
        for name, lines in (("plan", made.plan), ("path", made.path), ("way", made.way), ("expected", made.expected)):
            if len(lines):
                self._lines(name, index, lines, at)
        if made.reach is not None and made.reach.shape[1]:
            reach = np.where((at >= 0)[:, None], made.reach[np.maximum(at, 0)], np.nan)
            self.blocks.append(block(f"reach{index}", counted(reach, 1e-2)))

    def _lines(self, name: str, index: int, lines: Sequence[Array], at: Rows) -> None:
        """Pack the line of a robot at each frame, none at -1."""
        drawn = np.asarray if name == "expected" else _thinned  # places, not a line
        shown = [drawn(np.asarray(lines[row])) if row >= 0 else np.empty((0, 2)) for row in at]
        self.blocks.append(block(f"{name}Length{index}", np.array([len(each) for each in shown]), kind="u8"))
        self.blocks.append(block(f"{name}{index}", self.own_scale.whole(np.concatenate(shown))))

    def _cells(self, index: int, robot: PlayedRobot) -> dict[str, Any]:
        """Pack the cells that a robot keeps with the way that it plans in them, and return their grid."""
        kept = robot.cells
        found = None if kept is None else cells_of(f"cells{index}", kept, self.time)
        if kept is None or found is None:
            return {}
        grid, packed = found
        self.blocks.append(packed)
        if len(kept.way):
            self._lines("path", index, kept.way, np.searchsorted(kept.time, self.time + 1e-9, side="right") - 1)
        what = "cells in which an unseen person may be" if kept.belief else "cells that are known from scans"
        side = grid["grid"][2]
        ratio = round(side / kept.side)
        told = f", the worst of {ratio} by {ratio} cells of the robot" if ratio > 1 else ""
        self.known.append((f"{what}, {robot.name}", f"{side:g} m{told}"))
        return {"cells": grid}

    def _view(self, ground: dict[str, Any]) -> list[float]:
        """Return the box that is in view at first: robots, goals, most people near them, and what stands there."""
        goals = [each.goal for each in self.replay.robots if each.goal is not None]
        must = np.concatenate([self.robots.reshape(-1, 2), np.array(goals, dtype=np.float64).reshape(-1, 2)])
        must = must[np.isfinite(must).all(axis=1)]
        places = self.people.reshape(-1, 2)
        places = places[np.isfinite(places).all(axis=1)]
        if len(places):
            must = _with_near(must, np.quantile(places, [0.02, 0.98], axis=0), 4.0)
        if ground["box"] is not None:
            must = _with_near(must, np.array(ground["box"]).reshape(2, 2), 3.0)
        if not len(must):
            must = np.zeros((1, 2))
        low, high = must.min(axis=0) - MARGIN, must.max(axis=0) + MARGIN
        return [round(float(each), 3) for each in (*low, *high)]

    def _hash(self) -> str:
        """Return the SHA-256 of all instants and places as they are, before anything is rounded."""
        made = hashlib.sha256()
        replay = self.replay
        every = [replay.time, *(each.position for each in replay.robots)]
        for values in every if replay.people is None else [*every, replay.people]:
            made.update(np.ascontiguousarray(values, dtype="<f8").tobytes())
        return made.hexdigest()


def _with_near(places: Array, corners: Array, near: float) -> Array:
    """Return places with the corners of a box, cut to some m around the places."""
    if len(places):
        corners = np.clip(corners, places.min(axis=0) - near, places.max(axis=0) + near)
    return np.concatenate([places, corners])


def _thinned(line: Array) -> Array:
    """Return at most so many places of a line, both ends among them."""
    if len(line) <= MOST_PLAN:
        return line
    kept: Array = line[np.unique(np.round(np.linspace(0, len(line) - 1, MOST_PLAN)).astype(int))]
    return kept


def _page(replay: Replay, rows: Rows) -> str:
    content = _Content(replay, rows)
    head = content.head()
    style, script, body = (_part(name) for name in ("player.css", "player.js", "player.html"))
    rules = f"default-src 'none'; script-src '{digest(script)}'; style-src '{digest(style)}'; base-uri 'none'"
    data = "".join(
        f'<script type="application/octet-stream" id="block-{each.name}" data-kind="{each.kind}" '
        f'data-rows="{each.shape[0]}" data-columns="{each.shape[1]}">{each.text}</script>\n'
        for each in content.blocks
    )
    filled = {
        "rules": rules,
        "style": style,
        "script": script,
        "title": html.escape(replay.title),
        "events": _table(("time (s)", "what"), _event_rows(replay), "event", "nothing is recorded as an event"),
        "states": _table(*_states(content)),
        "facts": _facts(content),
        "warnings": _warnings(replay),
        "head": _json(head),
        "blocks": data,
    }
    parts = body.split("@@")
    return "".join(filled[part] if index % 2 else part for index, part in enumerate(parts))


@cache
def _part(name: str) -> str:
    return resources.files("hrsafety._replay").joinpath(name).read_text(encoding="utf-8").strip()


def digest(text: str) -> str:
    """Return the hash by which a page allows its own script or style, and nothing else."""
    return f"sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode('ascii')}"


def _json(values: Any) -> str:
    """Return JSON that can stand in a page: no end of a script, no line end that scripts do not take."""
    text = json.dumps(values, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
    return text.replace("<", "\\u003c").replace("&", "\\u0026")


def _event_rows(replay: Replay) -> Iterator[tuple[str, str]]:
    for each in sorted(replay.events, key=lambda event: event.time):
        yield f"{each.time:.2f}", each.words
    for part in replay.not_judged:
        yield f"{part.begin:.2f} to {part.end:.2f}", f"not judged: {part.reason}"


def _states(content: _Content) -> tuple[Sequence[str], list[Sequence[str]], str, str]:
    """Return the run as a table of words, for who does not see the picture and where no script runs."""
    replay = content.replay
    chosen = np.unique(np.round(np.linspace(0, len(content.rows) - 1, TEXT_ROWS)).astype(int))
    names = [each.name for each in replay.robots]
    titles = ["time (s)", *(f"{name}: x, y (m)" for name in names), *(f"{name}: clearance (m)" for name in names)]
    lines: list[Sequence[str]] = []
    for row in chosen.tolist():
        places = [_words(content.robots[row, k], 2) for k in range(len(names))]
        gaps = [
            "" if each.clearance is None else _words(np.atleast_1d(each.clearance[content.rows[row]]), 2)
            for each in replay.robots
        ]
        here = int(np.isfinite(content.people[row]).all(axis=1).sum())
        lines.append([f"{content.time[row]:.2f}", *places, *gaps, str(here)])
    return [*titles, "people present"], lines, "state", "nothing"


def _words(values: Array, digits: int) -> str:
    return ", ".join(f"{each:.{digits}f}" if math.isfinite(each) else "-" for each in values.tolist())


def _table(titles: Sequence[str], rows: Any, kind: str, none: str) -> str:
    head = "".join(f'<th scope="col">{html.escape(title)}</th>' for title in titles)
    lines = [list(row) for row in rows]
    body = "".join("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in row) + "</tr>" for row in lines)
    if not lines:
        return f"<p>{html.escape(none.capitalize())}.</p>"
    return f'<table class="{kind}s"><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'


def _facts(content: _Content) -> str:
    replay = content.replay
    shown, every = len(content.rows), len(replay.time)
    kept = f"{shown} frames" if shown == every else f"{shown} frames of {every} instants"
    own = [
        ("shown", f"{kept}, positions to {max(content.scale.unit, 1e-3) * 500:.2g} mm"),
        ("SHA-256 of all instants and places", content._hash()),
        ("made by", f"hrsafety {__version__}"),
    ]
    cells = "".join(
        f"<dt>{html.escape(name)}</dt><dd>{html.escape(words)}</dd>"
        for name, words in (*replay.facts, *content.known, *own)
    )
    return f"<dl>{cells}</dl>"


def _warnings(replay: Replay) -> str:
    """Return the doubts, of those that differ by numbers only the first one and how many there are more."""
    kinds: dict[tuple[str, str], list[str]] = {}
    for each in dict.fromkeys(replay.warnings):
        kinds.setdefault((each.code, re.sub(r"\d+", "", each.subject)), []).append(each.message)
    if not kinds:
        return ""
    told = (f"{first} ({len(more)} more of this kind)" if more else first for first, *more in kinds.values())
    lines = "".join(f"<li>{html.escape(each)}</li>" for each in told)
    return f'<section class="doubts"><h2>Is this what was meant?</h2><ul>{lines}</ul></section>'
