"""The checker of links finds what is broken, and nothing else."""

from __future__ import annotations

from pathlib import Path

import pytest

from check_links import broken, main
from source_links import own_anchors

INDEX = """<html><head><link href="style.css"></head><body id="top">
<a href="guide/first.html#start">right</a> <a href="guide/">folder</a> <a href="#top">here</a>
<a href="https://example.org/a?b=1#c">outside</a> <a href="mailto:a@example.org">mail</a> <img src="a%20b.png">
{}
</body></html>
"""


def site(folder: Path, more: str = "") -> Path:
    (folder / "guide").mkdir(exist_ok=True)
    (folder / "index.html").write_text(INDEX.format(more), encoding="utf-8")
    first = '<html><body><h1 id="start">x</h1><a href="../index.html#top">up</a></body></html>'
    for name in ("first.html", "index.html"):
        (folder / "guide" / name).write_text(first, encoding="utf-8")
    for name in ("style.css", "a b.png"):
        (folder / name).write_bytes(b"")
    return folder


def test_right_links_pass(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(site(tmp_path)) == 0
    assert "3 pages, 0 broken links" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("link", "words"),
    [
        ('<a href="guide/second.html">x</a>', "index.html: guide/second.html: no such file"),
        ('<a href="guide/first.html#end">x</a>', "index.html: guide/first.html#end: no such anchor"),
        ('<a href="#end">x</a>', "index.html: #end: no such anchor"),
        ('<img src="c.png">', "index.html: c.png: no such file"),
        ('<a href="../../secret.html">x</a>', "index.html: ../../secret.html: outside the site"),
        ('<a href="http://">x</a>', "index.html: http://: no address"),
        ('<a href="https://exam ple.org">x</a>', "index.html: https://exam ple.org: no address"),
        ('<a href="https://[1">x</a>', "Invalid IPv6 URL"),
        ('<a href="htps://example.org">x</a>', "unknown scheme htps"),
    ],
)
def test_each_broken_link_is_found_once(link: str, words: str, tmp_path: Path) -> None:
    found = list(broken(site(tmp_path, link * 2)))
    assert len(found) == 1
    assert words in found[0]


def test_site_without_pages_is_no_success(tmp_path: Path) -> None:
    assert main(tmp_path) == 1


@pytest.mark.parametrize(
    ("link", "mended"),
    [
        ("a.metrics.Standing.html#a.Standing", "a.metrics.Standing.html#a.metrics.Standing"),
        ("a.metrics.Table.html#a.Table.columns", "a.metrics.Table.html#a.metrics.Table.columns"),
        ("a.metrics.Standing.html#a.metrics.Standing", "a.metrics.Standing.html#a.metrics.Standing"),
        ("a.metrics.Standing.html#a.Other", "a.metrics.Standing.html#a.Other"),
    ],
)
def test_links_from_source_code_have_the_anchors_of_their_pages(link: str, mended: str) -> None:
    page = '<a class="viewcode-back" href="../../api/generated/{}">[docs]</a>'
    assert own_anchors(page.format(link)) == page.format(mended)
