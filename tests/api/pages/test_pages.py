"""Pages of the commands: whole, escaped, without network; what a command says where Jinja2 is missing."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path

import pytest

pytest.importorskip("jinja2")
pytest.importorskip("matplotlib")

from api.read_pages import page_of
from hrsafety import pages
from hrsafety.cli import main
from hrsafety.errors import HrsafetyError, MissingExtraError
from hrsafety.pages import pdf

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
CROSSING = EXAMPLES / "my_first_crossing.toml"
COMMANDS = {
    "foam": ["foam", str(EXAMPLES / "foam_design.toml")],
    "optimize": ["optimize", str(EXAMPLES / "gain_study.toml")],
    "sweep": ["sweep", str(EXAMPLES / "impact_sweep.toml")],
    "--out": ["simulate", str(CROSSING)],
    "reproduce": ["reproduce", "--only", "tables-6"],
}
# Comes from behind at 9 m/s, which no person walks.
WALKER = """start = [3.9, 0.6]
goal = [0.0, 0.6]
[[obstacles]]
type = "human"
start = [-8.0, 0.6]
velocity = [9.0, 0.0]
max_speed = 9.0
critical_radius = 0.8
active_radius = 2.1
"""


def read(path: Path) -> str:
    return re.sub(r"\s+", " ", " ".join(page_of(path).texts))


def test_every_page_inherits_the_one_base_and_there_is_one_style_sheet() -> None:
    folder = Path(pages.__file__).parent / "templates"
    texts = {path.relative_to(folder).as_posix(): path.read_text(encoding="utf-8") for path in folder.rglob("*.html")}
    whole = {name for name, text in texts.items() if '{% extends "base.html" %}' in text}
    assert whole == {"report.html", "cell.html", "program.html", "reproduce/page.html"}
    assert [name for name, text in texts.items() if "<style" in text or "<html" in text] == ["base.html"]
    assert sorted(path.name for path in folder.rglob("*.css")) == ["printed.css", "style.css"]  # the first for contact


def test_simulate_writes_a_page_with_outcome_obstacles_and_pictures(tmp_path: Path) -> None:
    assert main(["simulate", str(CROSSING), "--out", str(tmp_path)]) == 0
    text = read(tmp_path / "summary.html")
    assert "without a contact" in text
    assert "least distance (m)" in text
    html = (tmp_path / "summary.html").read_text(encoding="utf-8")
    assert html.count("data:image/png;base64,") == 4
    assert 'class="banner"' in html


def test_a_contact_and_warnings_stand_on_the_page_of_a_run_and_names_are_escaped(tmp_path: Path) -> None:
    scene = tmp_path / "<walker>.toml"
    scene.write_text(WALKER, encoding="utf-8")
    assert main(["simulate", str(scene), "--out", str(tmp_path / "out")]) == 0
    html = (tmp_path / "out" / "summary.html").read_text(encoding="utf-8")
    assert "Contact with obstacle 0 (Human)" in read(tmp_path / "out" / "summary.html")
    assert 'class="banner no"' in html
    assert "Is this what was meant?" in html
    assert "<walker>" not in html
    assert "&lt;walker&gt;" in html


@pytest.mark.parametrize("name", COMMANDS)
def test_missing_jinja_is_told_before_the_work_begins(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda each, *more: None if each == "jinja2" else found(each, *more)
    )
    assert main([*COMMANDS[name], "--out", str(tmp_path / "out")]) == 2
    message = f"{name} writes a page and needs Jinja2: pip install jinja2"
    assert message in capsys.readouterr().err
    assert not (tmp_path / "out").exists()
    with pytest.raises(MissingExtraError):
        pages.require_jinja(name)


def test_what_writes_no_page_works_without_jinja(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda *_: None)
    assert main(["simulate", str(CROSSING)]) == 0


def test_numbers_that_are_not_finite_are_dashes() -> None:
    values = (1.0, float("nan"), float("inf"), None, "words")
    assert [pages.shown(value) for value in values] == ["1.00", pages.DASH, pages.DASH, pages.DASH, "words"]


def test_a_browser_that_prints_nothing_is_told_with_the_remedy(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    broken = tmp_path / "broken-browser"
    broken.write_text("#!/bin/sh\necho no display >&2\n", encoding="utf-8")
    broken.chmod(0o755)
    monkeypatch.setattr(pdf, "BROWSERS", (str(broken),))
    found = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda each, *more: None if each == "weasyprint" else found(each, *more)
    )
    with pytest.raises(HrsafetyError, match=r"no display\); .*pip install weasyprint"):
        pdf.pdf_of("<!DOCTYPE html><title>x</title>")
