"""``hrsafety arena``: run laws and filters through the standard scenes, and show how they stand."""

from __future__ import annotations

import argparse
import hashlib
import shlex
from collections.abc import Iterator
from pathlib import Path

import numpy as np

from hrsafety import __version__, arena
from hrsafety._statistics import Share
from hrsafety.cli import output, progress, terminal
from hrsafety.errors import InvalidParameterError
from hrsafety.pages.report import Report, ReportTable, Section

__all__ = ["HEAD", "cells_of", "run_arena"]

OPTIONS = {name: f"--{name}" for name in ("laws", "scenes", "seeds", "people", "sensing", "out", "threads")}
HEAD = (
    "success %",
    "by the robot %",
    "wall %",
    "by a person %",
    "late %",
    "lost %",
    "time ratio",
    "p",
    "rank",
    "front %",
)
MADE = ("entry", "command", "version and digest of the episodes")
NOTE = (
    "Shares in percent with 95 % Wilson intervals. A contact is by the robot where it moves toward whom it touches, "
    "at the first instant. The time is the arrival over the earliest one of a robot that knows the future, of "
    "successes. p: exact McNemar test of the successes against the best entry under the same conditions, after Holm. "
    "Rank: median with its 95 % interval, seeds drawn again; entries whose intervals overlap share a place. Front: "
    "share of drawn seeds in which no other entry has both fewer contacts by the robot and less time; what is lost "
    "counts as a contact there. Lost: the law raised an error or the world diverged."
)


def run_arena(options: argparse.Namespace) -> None:
    """Run entries through the scenes, print how they stand, and write a page.

    Parameters
    ----------
    options : argparse.Namespace
        Of ``hrsafety arena``.
    """
    output.check_targets(options)
    place = None if options.out is None else Path(options.out)
    try:
        with progress.live() as shown:
            board = arena.run(
                options.laws,
                scenes=options.scenes,
                seeds=options.seeds,
                people=options.people,
                sensing=options.sensing,
                out=None if place is None else place / "episodes",
                threads=options.threads,
                progress=None if shown is None else lambda done, total: shown("episodes", done, total, None),
            )
    except InvalidParameterError as error:
        name = OPTIONS.get(error.argument)
        raise error if name is None else error.renamed(name) from None
    standings = board.standings()
    conditions = list(dict.fromkeys((each.cell.people, each.cell.sensing) for each in standings))
    sections = [Section(_words(*each), _tables(board, standings, *each)) for each in conditions]
    report = Report(
        title="Arena",
        facts=[("scenes", str(len(board.scenes))), ("seeds", f"0 to {board.seeds - 1} of each")],
        sections=[*sections, Section("", [NOTE]), Section("Where which entry fails", [_by_scene(board, standings)])],
        warnings=board.warnings,
        warned="What is doubtful here",
        made="",
        sorts=True,
    )
    print(terminal.told(report))
    written = [] if place is None else output.write_report(report, place, (), (), "arena")
    output.say_written(written, report, options)
    output.report_warnings(board.warnings, options.strict)


_SENSED = {
    "exact": "measured exactly",
    "noise": "measured to +-25 mm",
    "noise_delay": "measured to +-25 mm, 0.1 s late",
}


def _words(people: str, sensing: str) -> str:
    """Return conditions in words."""
    return f"people {people.replace('_', ' ')}, {_SENSED[sensing]}"


def _tables(
    board: arena.Leaderboard, standings: list[arena.EntryStanding], people: str, sensing: str
) -> tuple[ReportTable, ReportTable]:
    """Return how entries stand under conditions, and what makes their episodes again, with a digest of them."""
    mine = [each for each in standings if (each.cell.people, each.cell.sensing) == (people, sensing)]
    titles = [(_words(people, sensing), *HEAD)]
    made = [(each.cell.entry, _command(board, each.cell), _digest(board, each.cell)) for each in mine]
    return (
        ReportTable(headers=titles, rows=[tuple(cells_of(each)) for each in mine], printed=True),
        ReportTable(headers=[MADE], rows=made, left=(0, 1, 2), summary="What makes the episodes of each row again"),
    )


def cells_of(row: arena.EntryStanding) -> Iterator[str]:
    """Yield the cells of a row of the standings: the entry, and what `HEAD` names."""
    yield row.cell.entry
    yield from map(_percent, (row.success, row.by_robot, row.wall, row.by_person, row.late, row.lost))
    ratio = row.time_ratio
    yield f"{ratio.value:.2f} ({ratio.low:.2f} to {ratio.high:.2f})" if ratio.runs else ""
    yield f"{row.p_value:.3g}"
    yield f"{row.rank:g} ({row.rank_low:g} to {row.rank_high:g})"
    yield f"{100.0 * row.front:.0f}"


def _percent(share: Share) -> str:
    return f"{100 * share.value:.1f} ({100 * share.low:.1f} to {100 * share.high:.1f})"


def _command(board: arena.Leaderboard, cell: arena.ArenaCell) -> str:
    """Return what makes the episodes of a row again."""
    scenes = [] if len(board.scenes) == len(arena.CARDS) else ["--scenes", *board.scenes]
    file = cell.entry.rpartition(":")[0]
    law = file if file.lower().endswith((".yaml", ".yml")) else cell.entry
    words = ["--laws", law, *scenes, "--seeds", str(board.seeds)]
    return shlex.join(["hrsafety", "arena", *words, "--people", cell.people, "--sensing", cell.sensing])


def _digest(board: arena.Leaderboard, cell: arena.ArenaCell) -> str:
    """Return version and digest of the episodes of a row."""
    found, content = board.episodes[cell], hashlib.sha256()
    content.update("\n".join(found["end"].ravel().tolist()).encode())
    content.update(np.ascontiguousarray(found["arrival_time"], dtype="<f8").tobytes())
    return f"hrsafety {__version__}, {content.hexdigest()[:12]}"


def _by_scene(board: arena.Leaderboard, standings: list[arena.EntryStanding]) -> ReportTable:
    """Return the shares of success in each scene."""
    scores = [board.scores(each.cell) for each in standings]
    cells = [f"{each.cell.entry}, {each.cell.people.replace('_', ' ')}, {each.cell.sensing}" for each in standings]
    rows = [(name, *(f"{100 * score[name].value:.0f}" for score in scores)) for name in board.scenes]
    return ReportTable(headers=[("scene, success %", *cells)], rows=rows)
