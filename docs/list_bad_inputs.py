"""Print the messages that bad inputs give, or write them into the page on bad inputs.

``python docs/list_bad_inputs.py`` prints, ``--write`` replaces what stands between the two marks of
docs/bad_inputs.md. The inputs are those of tests/bad_inputs.py.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(REPOSITORY / "tests"))

from bad_inputs import BAD_INPUTS, message  # noqa: E402  # from the folder of the line above
from page_tables import print_or_write  # noqa: E402  # sorted with it

PAGE = REPOSITORY / "docs" / "bad_inputs.md"
MARKS = "tables of list_bad_inputs.py"


def cell(text: str) -> str:
    """Return text as it stands in a table."""
    return text.replace("|", "\\|").replace("<", "&lt;").replace(">", "&gt;").replace("*", "\\*").replace("_", "\\_")


def row(name: str, call: str, said: str) -> str:
    """Return one bad input with the message that it gives."""
    typed = call.replace("|", "\\|")
    return f"| {name} | `{typed}` | {cell(said)} |"


def page() -> str:
    """Return all tables."""
    lines = [f"{sum(map(len, BAD_INPUTS.values()))} inputs.", ""]
    for part, inputs in BAD_INPUTS.items():
        lines += [f"## {part}", "", "| what | typed | message |", "|---|---|---|"]
        for name, call in inputs.items():
            with tempfile.TemporaryDirectory() as folder:
                lines.append(row(name, call, message(call, Path(folder).resolve())))
        lines.append("")
    return "\n" + "\n".join(lines)


if __name__ == "__main__":
    print_or_write(PAGE, {"tables": (MARKS, page)})
