"""What is given to commands, and how they refuse."""

from __future__ import annotations

from pathlib import Path

import pytest


def written(path: Path, text: str) -> str:
    """Write a file; return its path as it is given to a command."""
    path.write_text(text, encoding="utf-8")
    return str(path)


def error_line(capsys: pytest.CaptureFixture[str]) -> str:
    """Return the one line on stderr with which a command refuses."""
    captured = capsys.readouterr()
    assert captured.err.count("\n") == 1
    assert captured.err.startswith("hrsafety: error: ")
    return captured.err
