"""No module imports itself through others: within the Python package, and within each crate."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator, Mapping
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parents[3]
PYTHON = REPOSITORY / "python"
CRATES = sorted(path for path in (REPOSITORY / "crates").iterdir() if (path / "src" / "lib.rs").is_file())
SOURCES = sorted((PYTHON / "hrsafety").rglob("*.py"))

Graph = Mapping[str, set[str]]


def circle(graph: Graph) -> list[str]:
    """Return the modules of one circle in the order of their imports, empty if there is none."""
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


def python_modules() -> dict[str, Path]:
    """Return the modules by name; packages are not modules here, for they only gather names."""
    names = {".".join(path.relative_to(PYTHON).with_suffix("").parts): path for path in SOURCES}
    return {name: path for name, path in names.items() if path.name != "__init__.py"}


def python_imports(path: Path) -> Iterator[str]:
    """Yield what a module imports anywhere, in functions and for type checks too."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom) and node.module:
            yield node.module
            yield from (f"{node.module}.{alias.name}" for alias in node.names)


def rust_modules(crate: Path) -> dict[str, Path]:
    found = {}
    for path in (crate / "src").rglob("*.rs"):
        parts = path.relative_to(crate / "src").with_suffix("").parts
        found["::".join(parts[:-1] if parts[-1] in {"mod", "lib"} else parts)] = path
    return found


def rust_graph(crate: Path) -> Graph:
    modules = rust_modules(crate)
    graph: dict[str, set[str]] = {}
    for name, path in modules.items():
        graph[name] = set()
        if path.name == "lib.rs":
            continue  # it names its modules, and may name what they hold
        for words in re.findall(r"\bcrate::([a-z_0-9]+(?:::[a-z_0-9]+)*)", path.read_text(encoding="utf-8")):
            parts = words.split("::")
            while parts and "::".join(parts) not in modules:
                parts.pop()
            if parts and "::".join(parts) != name:
                graph[name].add("::".join(parts))
    return graph


def test_the_search_finds_a_circle() -> None:
    assert circle({"a": {"b"}, "b": {"c"}, "c": set()}) == []
    assert set(circle({"a": {"b"}, "b": {"c"}, "c": {"a"}})) == {"a", "b", "c"}


def test_python_modules_have_no_circle() -> None:
    modules = python_modules()
    assert len(modules) > 100
    assert circle({name: (set(python_imports(path)) & set(modules)) - {name} for name, path in modules.items()}) == []


@pytest.mark.parametrize("crate", CRATES, ids=lambda crate: crate.name)
def test_modules_of_a_crate_have_no_circle(crate: Path) -> None:
    graph = rust_graph(crate)
    assert graph
    assert circle(graph) == []
