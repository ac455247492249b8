"""Layout of the summary page: pictures beside tables, folded tables, links that lead somewhere."""

from __future__ import annotations

import re

import pytest

pytest.importorskip("matplotlib")

from hrsafety.reproduce import figures, markup, page, placement, tables
from hrsafety.reproduce.figures import Picture

NAMES = [name for name, _, _ in figures._pictures()]


@pytest.fixture(scope="module")
def html() -> str:
    report = page.Report(command="", parts=("tables-6", "figures-6"), cells=tables.chapter_6())
    report.pictures = [Picture(name=name, caption=f"About {name}.", png=b"png") for name in NAMES]
    return page.html(report)


def test_every_picture_stands_below_the_table_of_its_configuration(html: str) -> None:
    starts = [html.index(f'id="table-6.{number}"') for number in range(2, 6)] + [len(html)]
    for name in NAMES:
        number = re.search(r"-c([1-4])\b", name)
        own = int(number[1]) if number else {"figure-6.9": 2, "figure-6.1": 3}[name[:10]]
        assert starts[own - 1] < html.index(f'<figure id="{name}"') < starts[own], name


def test_every_link_of_the_page_leads_somewhere(html: str) -> None:
    targets = set(re.findall(r'id="([^"]+)"', html))
    assert set(re.findall(r'href="#([^"]+)"', html)) <= targets


def test_page_says_why_a_right_value_differs(html: str) -> None:
    assert "A right evaluation differs from its source where" in html


def test_no_picture_is_lost_or_shown_twice() -> None:
    pictures = [Picture(name=name, caption="A.", png=b"") for name in [*NAMES, "unheard-of"]]
    placed = ["6.2", "6.3"]
    shown = [each for table in placed for each in placement.of_table(table, pictures)]
    rest = placement.unplaced(pictures, placed)
    assert sorted(each.name for each in [*shown, *rest]) == sorted(each.name for each in pictures)


def test_reasons_wrap_and_names_of_rows_too() -> None:
    style = page.html(page.Report(command="", parts=()))
    for selector in ("td.reason", 'th[scope="rowgroup"], td.text'):
        rule = style[style.index(f"{selector} {{") :].split("}")[0]
        assert "white-space: normal" in rule
    assert markup.scroll("") == '<div class="scroll"></div>'
