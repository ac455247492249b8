"""Make the pictures of the documentation: run the code of the pages that show them, keep what it saves."""

from __future__ import annotations

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterable
from pathlib import Path

DOCS = Path(__file__).resolve().parent
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
SHOWN = re.compile(r"!\[[^\]]*\]\([\w./]*images/([\w.]+)\)")
SAVED = re.compile(r"\"([\w.]+\.(?:png|gif))\"")
GALLERY = "gallery.md"
# Drawn from the source code by a script of its own.
DRAWN = {
    "standard_scenes.png": "measure_scenes.py",
    "architecture.png": "make_architecture.py",
    "live.png": "make_views.py",
    "player.png": "make_views.py",
    "player_map.png": "make_views.py",
}


def code_of(page: Path) -> str:
    """Return the code of a page, block after block."""
    return "\n".join(BLOCK.findall(page.read_text(encoding="utf-8")))


def makers(docs: Path = DOCS) -> dict[str, str]:
    """Return the page that makes each picture: it shows and saves it; the gallery before all others."""
    pages = sorted(docs.rglob("*.md"), key=lambda page: (page.name != GALLERY, str(page)))
    found: dict[str, str] = {}
    for page in pages:
        saved = set(SAVED.findall(code_of(page)))
        for name in SHOWN.findall(page.read_text(encoding="utf-8")):
            if name in saved:
                found.setdefault(name, page.relative_to(docs).as_posix())
    return found


def make(page: str, recordings: Iterable[Path], images: Path, docs: Path = DOCS) -> list[str]:
    """Run the code of a page in a folder with the recordings, and keep the pictures that are its own.

    Parameters
    ----------
    page : str
        Its path below the documentation.
    recordings : iterable of Path
        Files that the code reads by their names.
    images : Path
        Where the pictures are kept.
    docs : Path
        The documentation.

    Returns
    -------
    list of str
        Names of the pictures.
    """
    own = [name for name, maker in makers(docs).items() if maker == page]
    with tempfile.TemporaryDirectory() as folder:
        for recording in recordings:
            shutil.copy(recording, folder)
        (Path(folder) / "page.py").write_text(code_of(docs / page), encoding="utf-8")
        environment = {**os.environ, "MPLBACKEND": "Agg"}
        subprocess.run([sys.executable, "-W", "error", "page.py"], cwd=folder, env=environment, check=True)
        for name in own:
            shutil.copy(Path(folder) / name, images)
    return own


def main() -> None:
    """Make the pictures of all pages, or of some."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("recording", type=Path, help="zara01.csv")
    parser.add_argument("pages", nargs="*", help="pages below docs, as gallery.md [all that have pictures]")
    options = parser.parse_args()
    for page in options.pages or sorted(set(makers().values())):
        for name in make(page, [options.recording], DOCS / "images"):
            print(f"docs/images/{name}", flush=True)


if __name__ == "__main__":
    main()
