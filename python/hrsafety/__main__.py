"""The command line as ``python -m hrsafety``."""

from __future__ import annotations

import sys

from hrsafety.cli import main

__all__: list[str] = []

if __name__ == "__main__":
    sys.exit(main())
