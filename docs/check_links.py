"""Check the links of the built site: pages, files and anchors that it points at are there.

``python docs/check_links.py target/docs``; addresses outside are only looked at, not asked.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from html.parser import HTMLParser
from pathlib import Path
from urllib.parse import unquote, urldefrag, urlsplit

OUTSIDE = ("http", "https")
LINKING = {"a": "href", "link": "href", "img": "src", "script": "src", "source": "src", "iframe": "src"}


class Page(HTMLParser):
    """Links of a page and the places in it that links can name."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.anchors: list[str] = []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Keep what a tag links to and what it is called."""
        given = dict(attrs)
        target = given.get(LINKING.get(tag, ""))
        if target is not None:
            self.links.append(target)
        self.anchors += [name for key in ("id", "name") if (name := given.get(key)) and (key == "id" or tag == "a")]


def broken(site: Path) -> Iterator[str]:
    """Yield a line for each link of a site that leads nowhere.

    Parameters
    ----------
    site : Path
        Folder of the built pages.

    Yields
    ------
    str
        Page, link and what is wrong with it.
    """
    pages = {path: Page(path.read_text(encoding="utf-8")) for path in sorted(site.rglob("*.html"))}
    anchors = {path.resolve(): set(page.anchors) for path, page in pages.items()}
    for path, page in pages.items():
        for link in dict.fromkeys(page.links):
            wrong = _wrong(site, path, link, anchors)
            if wrong:
                yield f"{path.relative_to(site)}: {link}: {wrong}"


def _wrong(site: Path, page: Path, link: str, anchors: dict[Path, set[str]]) -> str:
    """Return what is wrong with a link; nothing if it leads somewhere."""
    try:
        parts = urlsplit(link)
        port = parts.port
    except ValueError as error:
        return str(error)
    if parts.scheme in OUTSIDE or (not parts.scheme and parts.netloc):
        whole = parts.hostname and "." in parts.hostname and not set(link) & set(' "<>\\^`{|}') and port != 0
        return "" if whole else "no address"
    if parts.scheme in ("mailto", "data", "javascript"):
        return "" if parts.path else "empty"
    if parts.scheme:
        return f"unknown scheme {parts.scheme}"
    address, anchor = urldefrag(link)
    local = unquote(urlsplit(address).path)
    target = (page.parent / local).resolve() if local else page.resolve()
    if local.endswith("/") or target.is_dir():
        target = target / "index.html"
    if not target.is_relative_to(site.resolve()):
        return "outside the site"
    if not target.is_file():
        return "no such file"
    known = anchors.get(target)
    if anchor and known is not None and unquote(anchor) not in known:
        return "no such anchor"
    return ""


def main(site: Path) -> int:
    """Print broken links and how many pages were read; 1 if a link is broken or there is no page."""
    if not any(site.rglob("*.html")):
        print(f"{site} holds no pages: build them first with make docs")
        return 1
    found = list(broken(site))
    print("\n".join([*found, f"{len(list(site.rglob('*.html')))} pages, {len(found)} broken links"]))
    return int(bool(found))


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python docs/check_links.py target/docs")
    sys.exit(main(Path(sys.argv[1])))
