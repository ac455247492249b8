"""Write a player of each standard scene: ``python docs/scene_players.py FOLDER``; Sphinx writes them into the site."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

from hrsafety import arena, plotting, scenarios
from hrsafety import navigation as nav

RECIPROCAL = nav.OptimalReciprocalCollisionAvoidance(horizon=2.0, margin=0.05)


def write(folder: Path) -> None:
    """Write the players, seed 0, with a robot under guide, shield and yielding."""
    folder.mkdir(parents=True, exist_ok=True)
    for name in arena.CARDS:
        walls = scenarios.social(name, 0).walls
        law = nav.SafeNavigation(
            RECIPROCAL,
            map=nav.StaticMap.from_polylines(walls) if walls else None,
            guide=nav.Guide(),
            shield=nav.Shield(margin=0.02, wall_margin=0.02),
            yielding=nav.Yielding(),
        )
        run = nav.simulate(scenarios.social(name, 0, law=law))
        plotting.player(run, folder / f"{name}.html", title=name.replace("_", " ").capitalize())


def linked(_app: Any, page: str, _template: str, context: dict[str, Any], _tree: Any) -> None:
    """Let the names of scenes in the first cells of a table lead to their players."""
    if page != "guides/standard_scenes":
        return
    for name in arena.CARDS:
        cell = re.compile(rf"(<tr[^>]*>\s*<td[^>]*><p>)(<code[^>]*><span[^>]*>{name}</span></code>)")
        context["body"] = cell.sub(rf'\1<a href="../players/{name}.html">\2</a>', context["body"])


def finished(app: Any, error: Exception | None) -> None:
    """Write the players beside the pages."""
    if error is None and app.builder.format == "html":
        write(Path(app.outdir) / "players")


def setup(app: Any) -> dict[str, bool]:
    """Connect to Sphinx."""
    app.connect("html-page-context", linked)
    app.connect("build-finished", finished)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


if __name__ == "__main__":
    write(Path(sys.argv[1]))
