"""Charts of lines: what stands in them, what is left out, and that no library is loaded for them."""

from __future__ import annotations

import re
import subprocess
import sys
from xml.etree import ElementTree

import numpy as np
import pytest

from hrsafety.pages.chart import BOTTOM, LEFT, RIGHT, ChartLine, line_chart


def chart(*lines: ChartLine, ends: tuple[float, float] = (2.0, 1.0), **more: object) -> ElementTree.Element:
    """Return a chart as parsed XML."""
    text = line_chart("one", "speed & way", lines, labels=("way (m)", "speed < 1 (m/s)"), ends=ends, **more)  # type: ignore[arg-type]  # words
    return ElementTree.fromstring(text)


def paths(found: ElementTree.Element) -> list[list[tuple[str, float, float]]]:
    """Return the points of each line with the letter before them."""
    drawn = [each.get("d", "") for each in found.iter() if each.get("clip-path") == "url(#one-frame)"]
    return [[(a, float(x), float(y)) for a, x, y in re.findall(r"([ML])(-?[\d.]+) (-?[\d.]+)", d)] for d in drawn]


def test_a_line_goes_from_edge_to_edge_with_its_gap() -> None:
    x = np.array([0.0, 0.5, 1.0, 1.5, 2.0])
    (line,) = paths(chart(ChartLine("run", x, np.array([0.0, 1.0, np.inf, 0.2, 0.0]), "#000")))
    assert [letter for letter, _, _ in line] == ["M", "L", "M", "L"]
    assert line[0][1:] == (LEFT, BOTTOM)
    assert line[-1][1:] == (RIGHT, BOTTOM)


@pytest.mark.parametrize("seed", range(5))
def test_points_that_are_left_out_are_not_missed(seed: int) -> None:
    draw = np.random.default_rng(seed)
    x = np.linspace(0.0, 2.0, 2001)
    y = 0.5 + 0.4 * np.sin(draw.uniform(1.0, 9.0) * x) + (x > draw.uniform(0.2, 1.8)) * 0.1
    (line,) = paths(chart(ChartLine("run", x, y, "#000")))
    assert len(line) < 1000
    across, along = np.array([each[1:] for each in line]).T
    top = min(
        float(each.get("y", 0))
        for each in chart(ChartLine("run", x, y, "#000")).iter()
        if each.get("rx") is None and each.tag.endswith("rect")
    )
    expected = BOTTOM - (BOTTOM - top) * y
    off = np.abs(np.interp(LEFT + 0.5 * (RIGHT - LEFT) * x, across, along) - expected)
    assert np.median(off) < 0.1
    assert off.max() < 12.0  # beside a jump, which is as wide as a step of x


def test_names_and_ticks_are_text() -> None:
    line = ChartLine("a <b>", np.array([0.0, 2.0]), np.array([0.0, 1.0]), "#000")
    bands = {"pick & place": (0.0, 1.0), "no room": (1.0, 1.001), "turn": (1.2, 2.0)}
    found = chart(line, bands=bands)
    words = ["".join(each.itertext()) for each in found.iter() if each.tag.endswith("text")]
    assert {"a <b>", "pick & place", "turn", "way (m)", "speed < 1 (m/s)"} <= set(words)
    assert [each for each in words if re.fullmatch(r"[\d.]+", each)][:5] == ["0", "0.5", "1", "1.5", "2"]
    assert [each.get("aria-label") for each in found.iter() if each.get("aria-label")] == ["speed & way"]
    for end in (1e-3, 0.7, 0.99, 1.0, 3.3, 240.0, 9e4):
        ticks = [each for each in chart(line, ends=(end, 1.0)).iter() if each.get("text-anchor") == "middle"]
        assert 4 <= len(ticks) <= 11


def test_a_program_is_reported_without_a_library_for_pictures(tmp_path: object) -> None:
    code = (
        "import sys; from hrsafety.cli import main; "
        "main(['init', 'program']); main(['program', 'robot_program.toml', '--out', 'report']); "
        "sys.exit('matplotlib' in sys.modules)"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=str(tmp_path), capture_output=True, timeout=120)
    assert done.returncode == 0
