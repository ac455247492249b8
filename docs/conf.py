"""Settings of the documentation site."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

from sphinx.ext.autosummary import autosummary_toc
from sphinx.util.nodes import make_refnode

import hrsafety

sys.path.insert(0, str(Path(__file__).parent))  # for mathml_equations, scene_players, source_links

project = "hrsafety"
author = copyright = "hrsafety developers"
version = release = hrsafety.__version__

extensions = [
    "mathml_equations",
    "myst_parser",
    "numpydoc",
    "scene_players",
    "source_links",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.viewcode",
]

source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["_build"]

# `name` in a docstring is a link where it can be one.
default_role = "py:obj"
add_module_names = False

myst_enable_extensions = ["amsmath", "colon_fence", "dollarmath"]
myst_heading_anchors = 3

templates_path = ["_templates"]
autosummary_generate = True
autosummary_ignore_module_all = False
autodoc_member_order = "bysource"
autodoc_typehints = "none"  # the docstrings say it, with units
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False

html_math_renderer = "mathml"  # drawn by the browser, without a network
html_static_path = ["_static"]
html_css_files = ["equations.css", "boxes.css"]
html_theme = "furo"
html_title = "hrsafety"
html_show_sphinx = False
html_copy_source = False


PLACES: dict[str, list[str]] = {}  # full names of everything documented, by the last word


def collect_places(_app: Any, environment: Any) -> None:
    """Note where every documented name stands."""
    for name in environment.get_domain("py").objects:
        PLACES.setdefault(name.rpartition(".")[2], []).append(name)


def find_in_namespaces(app: Any, environment: Any, node: Any, shown: Any) -> Any:
    """Link a name that stands in another namespace: of the same package first, then of any."""
    target = node.get("reftarget", "")
    if node.get("refdomain") != "py" or not target:
        return None
    package = ".".join((node.get("py:module") or "").split(".")[:2])
    ends = [name for name in PLACES.get(target.rpartition(".")[2], []) if name.endswith(f".{target}")]
    for prefix in (package, "hrsafety"):
        found = [name for name in ends if name.startswith(f"{prefix}.")]
        if len(found) == 1:
            place = environment.get_domain("py").objects[found[0]]
            return make_refnode(app.builder, node["refdoc"], place.docname, place.node_id, shown, found[0])
    return None


GENERATED = "api/generated/"
"""Pages of single names."""


def leave_out_of_sidebar(app: Any, tree: Any) -> None:
    """Keep pages of single names, which are many, out of the sidebar of every page."""
    for node in list(tree.findall(autosummary_toc)):
        node.parent.remove(node)
    if app.env.docname.startswith(GENERATED):
        app.env.metadata[app.env.docname]["orphan"] = True


def link_package(app: Any, page: str, _template: str, context: dict[str, Any], _tree: Any) -> None:
    """Let the page of a single name lead to that of its package."""
    if not page.startswith(GENERATED):
        return
    package = page.removeprefix(GENERATED).split(".")[1]
    place = f"api/{package}"
    if place not in app.env.found_docs:
        place = "api/index"
    title = app.env.titles[place].astext()
    context["body"] = f'<p><a href="{context["pathto"](place)}">{title}</a></p>\n{context["body"]}'


def setup(app: Any) -> None:
    """Connect what finds links."""
    app.connect("doctree-read", leave_out_of_sidebar, priority=400)
    app.connect("html-page-context", link_package)
    app.connect("env-check-consistency", collect_places)
    app.connect("missing-reference", find_in_namespaces)
