"""Layout of the summary page: pictures beside tables, folded tables, links that lead somewhere."""

from __future__ import annotations

import re

import pytest

pytest.importorskip("matplotlib")

from hrsafety.pages import Picture
from hrsafety.reproduce import figures, names, page, tables
from hrsafety.reproduce.built import wheels_tables
from hrsafety.reproduce.cells import PrintedValue
from hrsafety.reproduce.parts import PARTS, Made
from hrsafety.reproduce.sections import section_of

NAMES = [name for name, _, _ in figures._pictures()]


@pytest.fixture(scope="module")
def html() -> str:
    pictures = [Picture(name=name, caption=f"About {name}.", png=b"png") for name in NAMES]
    made = {"tables-6": Made(cells=tables.chapter_6()), "figures-6": Made(pictures=pictures)}
    return page.html(page.ReproductionReport(command="", made=made))


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
    shown = [each for table in placed for each in names.beside(table, pictures)]
    rest = names.beside_none(placed, pictures)
    assert sorted(each.name for each in [*shown, *rest]) == sorted(each.name for each in pictures)


def test_pictures_of_a_study_stand_in_its_own_section_only() -> None:
    cells = tables.chapter_6()
    made = {
        "tables-6": Made(cells=cells),
        "figures-6": Made(pictures=[Picture(name="figure-6.8-paths-c2", caption="A.", png=b"")]),
        "stabilizing": Made(pictures=[Picture(name="outcomes-c2-noise", caption="A.", png=b"")]),
    }
    section = section_of(PARTS["tables-6"], made, cells)
    assert [each.name for view in section["tables"] for each in view.pictures] == ["figure-6.8-paths-c2"]


def test_tables_of_the_wheels_stand_robot_by_robot() -> None:
    cells = wheels_tables.cells()
    shown = [view.key for view in section_of(PARTS["wheels"], {"wheels": Made(cells=cells)}, cells)["tables"]]
    robots = (("D.1", "Section D.2", "D.2", "Section D.3"), ("E.1", "Section E.2", "E.2", "Section E.3"))
    assert shown == [table for robot in robots for table in robot]
    assert set(shown) == {cell.table for cell in cells}


def test_reasons_wrap_and_names_of_rows_too() -> None:
    style = page.html(page.ReproductionReport(command=""))
    for selector in ("td.reason", 'th[scope="rowgroup"], td.text'):
        rule = style[style.index(f"{selector} {{") :].split("}")[0]
        assert "white-space: normal" in rule


def test_text_is_escaped_and_names_of_columns_keep_their_indices() -> None:
    cell = PrintedValue.listed(
        table="6.1", row="<b>row</b>", column="K_1", printed="<i>1</i>", unit="N/m", reason="a < b & <script>"
    )
    html = page.html(page.ReproductionReport(command="<command>", made={"tables-6": Made(cells=[cell])}))
    for text in ("<b>row</b>", "<i>1</i>", "<script>", "<command>"):
        assert text not in html
        assert text.replace("<", "&lt;").replace(">", "&gt;") in html
    assert "K<sub>1</sub> (N/m)" in html
