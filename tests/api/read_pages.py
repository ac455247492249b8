"""Pages that commands write, read strictly."""

from __future__ import annotations

from collections import Counter
from html.parser import HTMLParser
from pathlib import Path

VOID_TAGS = {"meta", "img", "br", "hr", "input"}
# What a page would have to load from elsewhere.
LOADED = {"script", "link", "iframe", "object"}


class Page(HTMLParser):
    """Checks that every tag is closed in order and that nothing is loaded; gathers what is on the page."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.images = 0
        self.ids: Counter[str] = Counter()
        self.links: list[str] = []
        self.texts: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        # A player stands whole in the page, in a frame that may load nothing.
        framed = tag == "iframe" and dict(attrs).get("sandbox") == "allow-scripts" and "src" not in dict(attrs)
        assert framed or tag not in LOADED
        for name, value in attrs:
            assert name != "src" or (value or "").startswith("data:image/png;base64,")
            if name == "id":
                self.ids[value or ""] += 1
            if name == "href":
                self.links.append(value or "")
        self.images += tag == "img"
        if tag not in VOID_TAGS:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.texts.append(data)


def page_of(source: Path | str) -> Page:
    """Return what is on a page, given as text or by its file, after the check that it is whole."""
    page = Page()
    page.feed(source if isinstance(source, str) else source.read_text(encoding="utf-8"))
    page.close()
    assert page.open == []
    return page
