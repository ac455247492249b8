"""What the guide to the search for gains prints is what its code prints."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

GUIDE = Path(__file__).resolve().parents[2] / "docs" / "guides" / "gains.md"
PART = re.compile(r"^```(python|text)\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# A reader does not wait longer than this, in s.
PATIENCE = 300.0
END = "end of a block"


@pytest.mark.evidence
def test_guide_shows_what_its_code_prints(tmp_path: Path) -> None:
    parts = PART.findall(GUIDE.read_text(encoding="utf-8"))
    shown = [text for kind, text in parts if kind == "text"]
    # A line of its own ends what a block prints.
    program = "".join(f"{text}\nprint('\\n{END}')\n" for kind, text in parts if kind == "python")
    (tmp_path / "guide.py").write_text(program, encoding="utf-8")
    done = subprocess.run(
        [sys.executable, "-W", "error", "guide.py"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=PATIENCE,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    printed = [text for text in done.stdout.split(f"\n{END}\n") if text]
    # The progress of the last search depends on how fast the machine is.
    assert [text for text in printed if not text.startswith("\ngrid")] == shown
