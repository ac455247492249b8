"""Make the pictures of the documentation: run the code of the gallery, keep its PNG files."""

from __future__ import annotations

import os
import re
import shutil
import sys
import tempfile
from pathlib import Path

DOCS = Path(__file__).resolve().parent
BLOCK = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)


def main(recording: str) -> None:
    """Make all pictures; the gallery reads the recording by its name."""
    code = "\n".join(BLOCK.findall((DOCS / "gallery.md").read_text(encoding="utf-8")))
    with tempfile.TemporaryDirectory() as folder:
        shutil.copy(recording, folder)
        os.chdir(folder)
        exec(compile(code, "gallery.md", "exec"), {})
        for picture in sorted(Path(folder).glob("*.png")):
            shutil.copy(picture, DOCS / "images")
            print(f"docs/images/{picture.name}")
        os.chdir(DOCS)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python docs/make_images.py zara01.csv")
    os.environ.setdefault("MPLBACKEND", "Agg")
    main(sys.argv[1])
