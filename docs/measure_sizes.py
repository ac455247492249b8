"""Print how large the project is, by part and by capability, or write it into the page on architecture.

``python docs/measure_sizes.py`` prints, ``--write`` replaces what stands between the marks of docs/architecture.md.
Lines of code are those without blanks, comments, documentation and tests.
"""

from __future__ import annotations

import ast
import functools
import re
import subprocess
from collections import Counter
from pathlib import Path

from page_tables import DOCS, head, line, print_or_write

ROOT = DOCS.parent
RUST, PYTHON = "crates", "python/hrsafety"
TESTS = re.compile(r"^#\[cfg\(test\)\]\n(?:pub(?:\([a-z: ]+\))? )?mod \w+ \{.*", re.MULTILINE | re.DOTALL)
MANY = 20
"""Files of a folder from which on the page names it."""
LARGEST = 10

CAPABILITIES = {
    "lanes, checks, random numbers, threads, tables, errors, binding of these": (
        "numeric hrsafety_module vff_core hrsafety_py _arguments _atomic _display _keys _records _namespace "
        "_statistics errors plausibility tables"
    ),
    "robots, drives, footprints, scenarios, maps, guides, the loop and its lanes": (
        "navigation_world/robots navigation_world/world navigation_world navigation_runs/run navigation_runs "
        "navigation_laws/guide hrsafety_py/run hrsafety_py/robots hrsafety_py/scenes hrsafety_py/maps navigation"
    ),
    "virtual-force laws and compared planners": (
        "navigation_laws navigation_laws/field navigation_laws/planning navigation/laws hrsafety_py/laws"
    ),
    "search for gains": "box_search navigation_runs/search navigation/gains hrsafety_py/gains",
    "people that react, social metrics, environments for learners": (
        "navigation_runs/crowd navigation/crowd navigation/metrics gym hrsafety_py/crowd"
    ),
    "shield, yielding, foresight, searched persons": (
        "navigation_laws/shield navigation_laws/safe navigation_laws/yielding navigation_laws/foresight "
        "navigation_runs/run/pursuit hrsafety_py/safe navigation/pursuits navigation/controller "
        "navigation/safety_record"
    ),
    "filters of the field": "navigation_laws/filters",
    "laws that run on robots": (
        "navigation_laws/dwb navigation_laws/dynamic_window navigation_laws/pure_pursuit navigation_laws/path_integral "
        "navigation_laws/local_planning"
    ),
    "unknown buildings, people behind corners": (
        "unknown_places navigation_laws/arc_rollouts hrsafety_py/unknown navigation/scan_controller "
        "navigation/laws/arc_rollouts navigation/free_space"
    ),
    "sensors, cameras, wheels as built, tracking": (
        "navigation_world/sensing navigation_world/robots/wheels navigation_world/robots/differential "
        "navigation_runs/run/as_built navigation/sensing navigation/tracking"
    ),
    "published robots with sonars and microphones": (
        "reactive hrsafety_py/reactive navigation_runs/run/follower navigation_runs/run/skirt navigation_laws/escape "
        "navigation_laws/impedance"
    ),
    "impacts, injury criteria, foam, identification": "impact_core impact hrsafety_py/impact",
    "contacts, coverings, allowed speeds, separation": (
        "impact_core/allowed impact_core/collision impact_core/covering impact_core/contact impact_core/separation "
        "contact standards hrsafety_py/contact"
    ),
    "masses of arms from URDF and MJCF": "impact_core/arm arms",
    "robot programs": "impact_core/program program hrsafety_py/program",
    "measured records": "records impact_core/signal",
    "zones of a collision monitor": "zones",
    "files of others: people, logs, maps, plans, settings": "io datasets _yaml _tracks scenarios",
    "judged logs": "navigation/judging",
    "ROS 2": "ros",
    "players, MCAP, live page": "_replay live navigation/replays",
    "arena, benchmarks": "arena benchmarks",
    "sweeps": "sweep",
    "pictures": "plotting",
    "reports and the command line": "pages cli",
    "reproduction of the published tables": "reproduce",
}
"""Folders and files of a capability, by their beginnings; of several beginnings the longest one counts."""
BEGINNINGS = {beginning: name for name, each in CAPABILITIES.items() for beginning in each.split()}


@functools.cache
def sources() -> tuple[Path, ...]:
    """Return the source files, below the root of the project."""
    listed = subprocess.check_output(["git", "ls-files", RUST, PYTHON], cwd=ROOT, text=True)
    paths = map(Path, listed.split())
    return tuple(
        path for path in paths if path.suffix in (".py", ".pyi") or (path.suffix == ".rs" and "src" in path.parts)
    )


@functools.cache
def code_lines(path: Path) -> int:
    """Return the lines of code of a file."""
    text = (ROOT / path).read_text(encoding="utf-8")
    if path.suffix == ".rs":
        if path.stem == "tests" or path.parent.name == "tests":
            return 0
        rows = (row.strip() for row in TESTS.sub("", text).splitlines())
        return sum(1 for row in rows if row and not row.startswith("//"))
    documented: set[int] = set()
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef) and ast.get_docstring(node) is not None:
            documented |= set(range(node.body[0].lineno, (node.body[0].end_lineno or 0) + 1))
    rows = enumerate((row.strip() for row in text.splitlines()), 1)
    return sum(1 for number, row in rows if row and not row.startswith("#") and number not in documented)


def short(path: Path) -> str:
    """Return the path without ``crates``, ``src``, ``python/hrsafety`` and its ending."""
    parts = path.with_suffix("").parts
    return "/".join((parts[1], *parts[3:]) if parts[0] == RUST else parts[2:])


def capability(path: Path) -> str:
    """Return the capability of a file: that of the longest beginning of its path, or of the package itself."""
    parts = short(path).split("/")
    for count in range(len(parts), 0, -1):
        if (found := BEGINNINGS.get("/".join(parts[:count]))) is not None:
            return found
    return next(iter(CAPABILITIES))


def capabilities() -> str:
    """Return the table of lines of code by capability, in Rust and in Python."""
    counts: Counter[tuple[str, bool]] = Counter()
    for path in sources():
        counts[capability(path), path.suffix == ".rs"] += code_lines(path)
    rows = head("capability", "Rust", "Python", "both")
    totals = {name: (counts[name, True], counts[name, False]) for name in CAPABILITIES}
    for name, each in sorted(totals.items(), key=lambda item: -sum(item[1])):
        rows.append(line(name, *(f"{count:,}" for count in (*each, sum(each)))))
    whole = [sum(column) for column in zip(*totals.values(), strict=True)]
    rows.append(line("**all**", *(f"{count:,}" for count in (*whole, sum(whole)))))
    return "\n".join(rows) + "\n"


def parts() -> str:
    """Return the table of lines by crate and package, all of them and those of code."""
    every: Counter[str] = Counter()
    code: Counter[str] = Counter()
    for path in sources():
        name = short(path).split("/")[0]
        package = f"`hrsafety.{name}`" if len(path.parts) > 3 else "`hrsafety`"
        part = f"`crates/{name}`" if path.parts[0] == RUST else package
        every[part] += len((ROOT / path).read_text(encoding="utf-8").splitlines())
        code[part] += code_lines(path)
    rows = head("part", "lines", "of them code")
    rows += [line(part, f"{every[part]:,}", f"{count:,}") for part, count in code.most_common()]
    rows.append(line("**all**", f"{every.total():,}", f"{code.total():,}"))
    return "\n".join(rows) + "\n"


def largest() -> str:
    """Return the largest files and the folders with many of them."""
    sizes = {path: len((ROOT / path).read_text(encoding="utf-8").splitlines()) for path in sources()}
    rows = head("largest files", "lines", "of them code")
    for path in sorted(sizes, key=lambda path: -sizes[path])[:LARGEST]:
        rows.append(line(f"`{path}`", sizes[path], code_lines(path)))
    folders = Counter(path.parent for path in sources())
    rows += ["", *head("folders of 20 files and more", "files")]
    rows += [line(f"`{folder}`", count) for folder, count in folders.most_common() if count >= MANY]
    return "\n".join(rows) + "\n"


if __name__ == "__main__":
    print_or_write(
        DOCS / "architecture.md",
        {
            "capabilities": ("capabilities of measure_sizes.py", capabilities),
            "parts": ("parts of measure_sizes.py", parts),
            "largest": ("largest of measure_sizes.py", largest),
        },
    )
