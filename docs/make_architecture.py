"""Draw the parts of the project and who knows whom, from the code itself.

``python docs/make_architecture.py`` writes docs/images/architecture.png. Boxes are crates and Python
packages, arrows point from a part to what it imports; an arrow is drawn only where no longer chain of
arrows says the same.
"""

from __future__ import annotations

import ast
import tomllib
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.patches import FancyArrowPatch, FancyBboxPatch

ROOT = Path(__file__).resolve().parents[1]
PACKAGE = ROOT / "python" / "hrsafety"
BINDING = "hrsafety_module"
Graph = dict[str, set[str]]


def crates() -> Graph:
    """Return the crates of the workspace with the crates that each is built on."""
    members = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["members"]
    names = {Path(member).name for member in members}
    manifests = {name: tomllib.loads((ROOT / "crates" / name / "Cargo.toml").read_text()) for name in names}
    return {name: set(manifest.get("dependencies", {})) & names for name, manifest in manifests.items()}


def packages() -> Graph:
    """Return the Python packages with the packages that each imports, types and lazy imports included."""
    names = {path.parent.name for path in PACKAGE.glob("*/__init__.py")}
    graph: Graph = {}
    for name in names:
        known = set().union(*(imported(path) for path in (PACKAGE / name).rglob("*.py")))
        graph[name] = (known & names) - {name}
        if "_hrsafety" in known:
            graph[name].add(BINDING)
    return graph


def imported(path: Path) -> set[str]:
    """Return the first names below ``hrsafety`` that a module imports."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom) and node.module:
            parts = node.module.split(".")
            if parts == ["hrsafety"]:
                found |= {alias.name for alias in node.names}
            elif parts[0] == "hrsafety":
                found.add(parts[1])
    return found


def levels(graph: Graph) -> dict[str, int]:
    """Return the height of every part, above all that it knows."""
    known: dict[str, int] = {}

    def height(name: str, above: tuple[str, ...] = ()) -> int:
        if name in above:
            raise SystemExit(f"import circle: {' -> '.join((*above, name))}")
        if name not in known:
            known[name] = 1 + max((height(other, (*above, name)) for other in sorted(graph[name])), default=-1)
        return known[name]

    for name in graph:
        height(name)
    # Each part stands as high as its users allow, so that arrows are short.
    users = {name: [other for other in graph if name in graph[other]] for name in graph}
    for name in sorted(graph, key=known.__getitem__, reverse=True):
        if users[name]:
            known[name] = min(known[other] for other in users[name]) - 1
    return known


def needed(graph: Graph) -> Graph:
    """Return the graph without the arrows that a longer chain says already."""

    def reach(name: str) -> set[str]:
        return graph[name].union(*(reach(other) for other in graph[name]))

    return {
        name: {other for other in others if not any(other in reach(third) for third in others - {other})}
        for name, others in graph.items()
    }


def placed(rows: list[list[str]], graph: Graph) -> dict[str, tuple[float, float]]:
    """Return where parts stand: in each row in the order of the middle of their users above."""
    places: dict[str, tuple[float, float]] = {}
    for level in range(len(rows) - 1, -1, -1):
        middle = {}
        for name in rows[level]:
            above = [places[other][0] for other in places if name in graph[other]]
            middle[name] = sum(above) / len(above) if above else 5.0
        row = sorted(rows[level], key=lambda name: (middle[name], name))
        places |= {name: (10 * (index + 0.5) / len(row), 1.5 * level) for index, name in enumerate(row)}
    return places


def draw(graph: Graph) -> plt.Figure:
    """Return the picture."""
    heights = levels(graph)
    rows = [[name for name in sorted(graph) if heights[name] == level] for level in range(max(heights.values()) + 1)]
    places = placed(rows, needed(graph))
    figure, axes = plt.subplots(figsize=(10, 1.15 * len(rows)), layout="constrained")
    for name, others in needed(graph).items():
        for other in others:
            (x, y), (to_x, to_y) = places[name], places[other]
            # A long arrow goes around the box in between, where one stands on its way.
            bend = 0.0 if heights[name] - heights[other] == 1 else 1.2 if abs(x - to_x) < 1.0 else 0.12
            arrow = FancyArrowPatch(
                (x, y - 0.3),
                (to_x, to_y + 0.3),
                arrowstyle="-|>",
                mutation_scale=10,
                color="0.55",
                linewidth=0.9,
                connectionstyle=f"arc3,rad={bend}",
            )
            axes.add_patch(arrow)
    rust = set(crates())
    for name, (x, y) in places.items():
        color = "#f3d9b1" if name in rust else "#cfe0f3"
        style = {"boxstyle": "round,pad=0.04", "facecolor": color, "edgecolor": "0.3"}
        axes.add_patch(FancyBboxPatch((x - 0.75, y - 0.28), 1.5, 0.56, **style))
        axes.text(x, y, name, ha="center", va="center", fontsize=10)
    axes.set(xlim=(-0.6, 10), ylim=(-0.6, 1.5 * len(rows) - 0.7))
    axes.set_axis_off()
    axes.text(0.05, 1.5 * len(rows) - 1.0, "Python packages", color="#23527c", fontsize=10)
    axes.text(0.05, -0.5, "Rust crates", color="#8a5a00", fontsize=10)
    return figure


if __name__ == "__main__":
    picture = ROOT / "docs" / "images" / "architecture.png"
    draw(crates() | packages()).savefig(picture, dpi=110)
    print(picture.relative_to(ROOT))
