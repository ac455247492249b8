"""Print all doubts with their side and the ends of a contact report, or write both into the page on verdicts.

``python docs/list_doubts.py --write`` replaces the tables between the marks of docs/verdicts.md.
"""

from __future__ import annotations

import ast
import functools
from collections import defaultdict
from pathlib import Path

import hrsafety
from hrsafety.cli.cell.page import LOOKS
from hrsafety.cli.exit_codes import MEANINGS
from hrsafety.cli.verdict import OF_VERDICTS
from hrsafety.standards.verdicts import VERDICT_WORDS
from page_tables import DOCS, line, print_or_write

PAGE = DOCS / "verdicts.md"
PARTS = ("doubts", "ends")
COLORS = {"bad": "red", "unsure": "yellow", "good": "green"}


def _code(node: ast.Call, constants: dict[str, object]) -> str | None:
    """Return the code that a call builds a warning with."""
    given = [*node.args[:1], *(each.value for each in node.keywords if each.arg == "code")]
    for each in given:
        found = each.value if isinstance(each, ast.Constant) else constants.get(getattr(each, "id", ""))
        if isinstance(found, str):
            return found
    return None


def _side(node: ast.Call) -> set[str]:
    """Return the sides on which the error of a warning may lie, by what it is built with."""
    told = [each.value for each in node.keywords if each.arg == "safe_side"] or node.args[3:4]
    if not told:
        return {"unsafe"}
    if isinstance(told[0], ast.Constant):
        return {"safe" if told[0].value else "unsafe"}
    return {"safe", "unsafe"}


@functools.cache
def sides() -> dict[str, frozenset[str]]:
    """Return the sides of every code of a warning, as the sources of the package build them."""
    found: defaultdict[str, set[str]] = defaultdict(set)
    for path in Path(hrsafety.__file__).parent.rglob("*.py"):
        source = ast.parse(path.read_text(encoding="utf-8"))
        constants: dict[str, object] = {}
        for node in source.body:
            if isinstance(node, ast.Assign) and isinstance(node.value, ast.Constant):
                constants |= {each.id: node.value.value for each in node.targets if isinstance(each, ast.Name)}
        for node in ast.walk(source):
            if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "ResultWarning":
                code = _code(node, constants)
                if code is not None:
                    found[code] |= _side(node)
    return {code: frozenset(found[code]) for code in sorted(found)}


def table(part: str) -> str:
    """Return one table as it stands on the page."""
    if part == "ends":
        lines = [line("verdict", "word on the page", "color", "exit code", "meaning"), "|---" * 5 + "|"]
        lines += [
            line(
                f"`{word}`",
                VERDICT_WORDS[word],
                COLORS[LOOKS[word]],
                code,
                MEANINGS[code].replace("--fail-on", "`--fail-on`"),
            )
            for word, (_, code) in OF_VERDICTS.items()
        ]
    else:
        lines = [line("side of the error", "codes"), "|---" * 2 + "|"]
        for words, side in (
            ("may be unsafe: takes part in verdicts", {"unsafe"}),
            ("unsafe or safe, by its number or place", {"safe", "unsafe"}),
            ("safe: leaves verdicts as they are", {"safe"}),
        ):
            codes = [f"`{code}`" for code, found in sides().items() if found == side]
            lines.append(line(words, ", ".join(codes) or "none"))
    return "\n" + "\n".join(lines) + "\n\n"


if __name__ == "__main__":
    print_or_write(PAGE, {part: (f"{part} of list_doubts.py", functools.partial(table, part)) for part in PARTS})
