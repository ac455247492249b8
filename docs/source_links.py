"""Links from source code back to its documentation, for names that stand in several namespaces.

A name is documented in the place where it is read; the pages with source code link to the same page with the anchor
of another place. The anchors of a page begin with its own name.
"""

from __future__ import annotations

import re
from typing import Any

LINK = re.compile(r'(href="[\w./-]*/api/generated/([\w.]+)\.html#)([\w.]+)"')


def own_anchors(body: str) -> str:
    """Return a page whose links to documented names have the anchors of the pages that they lead to."""
    return LINK.sub(_own, body)


def _own(link: re.Match[str]) -> str:
    """Return a link with the anchor of its page, and what stands behind the last word of that: a method."""
    start, page, anchor = link.groups()
    _, found, rest = f".{anchor}.".partition(f".{page.rpartition('.')[2]}.")
    return f'{start}{page}{"." if rest else ""}{rest.rstrip(".")}"' if found else link[0]


def mend(_app: Any, pagename: str, _template: str, context: dict[str, Any], _tree: Any) -> None:
    """Mend the links of a page with source code."""
    if pagename.startswith("_modules/") and "body" in context:
        context["body"] = own_anchors(context["body"])


def setup(app: Any) -> dict[str, bool]:
    """Connect to Sphinx."""
    app.connect("html-page-context", mend)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
