"""Every picture of the documentation is made by the code beside it."""

from __future__ import annotations

import re
import struct
import subprocess
from pathlib import Path

import pytest

from make_images import BLOCK, DRAWN, GALLERY, SAVED, SHOWN, code_of, make, makers

DOCS = Path(__file__).resolve().parents[2] / "docs"
IMAGES = DOCS / "images"
COLUMNS = 88
RECORDING = "zara01.csv"


def size_of(picture: Path) -> tuple[int, int]:
    """Return width and height of a PNG or GIF file in pixels."""
    head = picture.read_bytes()[:24]
    if head[:8] == b"\x89PNG\r\n\x1a\n":
        width, height = struct.unpack(">II", head[16:24])
        return width, height
    assert head[:4] == b"GIF8"
    width, height = struct.unpack("<HH", head[6:10])
    return width, height


def test_every_picture_has_a_maker_and_a_place() -> None:
    there = {path.name for path in IMAGES.iterdir()}
    assert there == set(makers()) | set(DRAWN)
    for script in DRAWN.values():
        assert (DOCS / script).is_file()


def test_every_picture_that_is_shown_is_there() -> None:
    pages = [*DOCS.rglob("*.md"), DOCS.parent / "README.md"]
    shown = {(page, name) for page in pages for name in SHOWN.findall(page.read_text(encoding="utf-8"))}
    assert len(shown) > 30
    assert [name for _, name in shown if not (IMAGES / name).is_file()] == []


def test_every_entry_of_the_gallery_shows_what_its_code_saves() -> None:
    text = (DOCS / GALLERY).read_text(encoding="utf-8")
    parts = re.split(r"(?=!\[)", text)[1:]
    assert len(parts) > 25
    for part in parts:
        picture = SHOWN.match(part)
        assert picture is not None, part.splitlines()[0]
        code = "".join(BLOCK.findall(part))
        assert picture[1] in SAVED.findall(code)
    assert any(name.endswith(".gif") for name in SHOWN.findall(text))


def test_code_of_the_gallery_fits_into_its_column() -> None:
    code = "".join(BLOCK.findall((DOCS / GALLERY).read_text(encoding="utf-8")))
    assert [line for line in code.splitlines() if len(line) > COLUMNS] == []


@pytest.mark.parametrize(
    "page",
    [
        pytest.param(page, marks=[pytest.mark.evidence] if page == GALLERY else [])
        for page in sorted(set(makers().values()))
    ],
)
def test_page_makes_its_pictures(page: str, tmp_path: Path, request: pytest.FixtureRequest) -> None:
    recordings = []
    if RECORDING in code_of(DOCS / page):
        recordings.append(request.getfixturevalue("shared") / "data" / "pedestrians" / RECORDING)
    made = make(page, recordings, tmp_path)
    assert made
    for name in made:
        # Fonts differ between machines by some pixels, pictures of other content by more.
        for ours, kept in zip(size_of(tmp_path / name), size_of(IMAGES / name), strict=True):
            assert ours == pytest.approx(kept, rel=0.1), name


def test_page_whose_code_saves_nothing_is_noticed(tmp_path: Path) -> None:
    (tmp_path / "gallery.md").write_text('![A](images/a.png)\n\n```python\nname = "a.png"\n```\n', encoding="utf-8")
    assert makers(tmp_path) == {"a.png": "gallery.md"}
    with pytest.raises(FileNotFoundError, match=r"a\.png"):
        make("gallery.md", [], tmp_path, docs=tmp_path)
    (tmp_path / "gallery.md").write_text(
        '![A](images/a.png)\n\n```python\nraise ValueError("a.png")\n```\n', encoding="utf-8"
    )
    with pytest.raises(subprocess.CalledProcessError):
        make("gallery.md", [], tmp_path, docs=tmp_path)
