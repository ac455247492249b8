"""Equations of the documentation become MathML: no network, no script."""

from __future__ import annotations

import re
import runpy
from pathlib import Path

import pytest

pytest.importorskip("latex2mathml")
pytest.importorskip("sphinx")

DOCS = Path(__file__).resolve().parents[2] / "docs"


def test_every_equation_is_converted() -> None:
    mathml = runpy.run_path(str(DOCS / "mathml_equations.py"))["mathml"]
    count = 0
    for page in sorted(DOCS.rglob("*.md")):
        text = re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
        for block, inline in re.findall(r"\$\$(.+?)\$\$|\$([^$\n]+?)\$", text, flags=re.DOTALL):
            assert mathml(block or inline, display=bool(block)).startswith("<math")
            count += 1
    assert count > 1000
    with pytest.raises(ValueError, match="not converted"):
        mathml(r"\nosuchcommand{x}", display=False)


def test_no_page_loads_a_script_from_elsewhere() -> None:
    settings = (DOCS / "conf.py").read_text(encoding="utf-8")
    assert 'html_math_renderer = "mathml"' in settings
    assert "sphinx.ext.mathjax" not in settings
