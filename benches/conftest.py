"""Lets the benches import their peers and the second evaluation of the laws from ``tests/reference``."""

import sys
from pathlib import Path

BENCHES = Path(__file__).resolve().parent
for folder in (BENCHES, BENCHES.parent / "tests"):
    if str(folder) not in sys.path:
        sys.path.insert(0, str(folder))
