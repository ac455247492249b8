"""Sphinx extension: equations become MathML while the pages are built.

Every browser draws MathML itself, so the pages need neither a network nor a script.
"""

from __future__ import annotations

import re
from typing import Any
from xml.etree import ElementTree

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.math import get_node_equation_number

LOGGER = logging.getLogger(__name__)

# What the converter does not know, in words that it knows.
_SYNONYMS = (
    (re.compile(r"\\(begin|end)\{aligned\}"), r"\\\1{align*}"),
    (re.compile(r"\\operatorname\{(\w+)\}"), r"\\mathrm{\1}"),
)


def mathml(latex: str, *, display: bool) -> str:
    """Return an equation as MathML; a command that is not known raises ValueError."""
    for pattern, known in _SYNONYMS:
        latex = pattern.sub(known, latex)
    content = convert(latex.strip(), display="block" if display else "inline")
    words = "".join(ElementTree.fromstring(content).itertext())  # raises on what is no XML, such as a bare &
    if "\\" in words or "&" in words:
        raise ValueError(f"not converted: {words}")
    return content


def _content(translator: Any, node: nodes.Element, *, display: bool) -> str:
    try:
        return mathml(node.astext(), display=display)
    except Exception as error:  # the converter has errors of many classes
        LOGGER.warning("equation %r: %s", node.astext(), error, location=node)
        return f"<code>{translator.encode(node.astext())}</code>"


def visit_inline(translator: Any, node: nodes.math) -> None:
    translator.body.append(f'<span class="math">{_content(translator, node, display=False)}</span>')
    raise nodes.SkipNode


def visit_block(translator: Any, node: nodes.math_block) -> None:
    translator.body.append(translator.starttag(node, "div", CLASS="math"))
    if node.get("number"):
        translator.body.append(f'<span class="eqno">({get_node_equation_number(translator, node)})</span>')
    translator.body.append(f"{_content(translator, node, display=True)}</div>\n")
    raise nodes.SkipNode


def setup(app: Sphinx) -> dict[str, bool]:
    app.add_html_math_renderer("mathml", (visit_inline, None), (visit_block, None))
    return {"parallel_read_safe": True, "parallel_write_safe": True}
