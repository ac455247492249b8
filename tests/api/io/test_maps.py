"""Maps and floor plans: samples, plans of other programs, what is refused."""

from __future__ import annotations

import io as streams
import json
import math
import time
from pathlib import Path
from typing import Any

import ezdxf
import numpy as np
import pytest
import svgelements

from hrsafety import navigation as nav
from hrsafety.errors import FileError, InvalidParameterError
from hrsafety.io.places.maps import load_map
from hrsafety.plausibility import unsafe_doubts

FORMATS = Path("data/formats")


def codes(found: Any) -> list[str]:
    return [each.code for each in found.warnings]


def written(folder: Path, name: str, content: str | bytes) -> Path:
    path = folder / name
    path.write_bytes(content if isinstance(content, bytes) else content.encode())
    return path


def points_of(found: nav.StaticMap) -> list[list[tuple[float, float]]]:
    return [list(wall.points) for wall in found.walls]


def test_samples_are_read_as_expected(shared: Path) -> None:
    expected = json.loads((shared / FORMATS / "expected.json").read_text(encoding="utf-8"))
    checked = 0
    for each in expected["maps_and_configurations"]:
        if not each["file"].startswith("map_") and not each["file"].endswith(".world"):
            continue
        checked += 1
        path = shared / FORMATS / each["file"]
        if "error" in each:
            with pytest.raises(InvalidParameterError) as caught:
                load_map(path, **each["call"])
            assert all(name in str(caught.value) for name in each.get("names", []))
            continue
        found = load_map(path, **each["call"])
        assert sorted(codes(found)) == sorted(each["warnings"]), each["file"]
        messages = " ".join(doubt.message for doubt in found.warnings)
        for kind, count in each.get("skipped", {}).items():
            assert f"{count} {kind}" in messages
        if "walls" in each:
            assert np.array_equal(
                np.concatenate([np.array(wall) for wall in points_of(found)]),
                np.concatenate([np.array(wall) for wall in each["walls"]]),
            )
            assert [len(wall) for wall in points_of(found)] == [len(wall) for wall in each["walls"]]
            place, clearance = each["clearance_at"]
            assert found.clearance(place) == pytest.approx(clearance, abs=1e-9)
        if "discs" in each:
            assert np.array_equal(np.array(found.discs), np.array(each["discs"]))
    assert checked >= 24


# ---- DXF -----------------------------------------------------------------------------------------


def saved(document: Any) -> str:
    stream = streams.StringIO()
    document.write(stream)
    return stream.getvalue()


def farthest(places: np.ndarray, found: nav.StaticMap) -> float:
    return float(np.max(found.clearance(places)))


def drawn(random: np.random.Generator, *, old: bool, number: int, scale: float) -> tuple[str, list[Any]]:
    """Return a plan that ezdxf wrote, and its entities."""
    document = ezdxf.new("R12" if old else "R2010")
    document.header["$INSUNITS"] = number
    space = document.modelspace()
    count = random.integers(2, 7)
    corners = np.column_stack([random.uniform(-20.0, 20.0, (count, 2)) / scale, random.uniform(-3.0, 3.0, count)])
    below = {"extrusion": (0.0, 0.0, -1.0)} if random.random() < 0.5 else {}
    draw = space.add_polyline2d if old else space.add_lwpolyline
    entities = [draw(corners.tolist(), format="xyb", close=bool(random.random() < 0.5), dxfattribs=below)]
    center, radius = tuple(random.uniform(-20.0, 20.0, 2) / scale), random.uniform(0.1, 15.0) / scale
    start = random.uniform(-400.0, 400.0)
    entities.append(space.add_arc(center, radius, start, start + random.uniform(1.0, 359.0), dxfattribs=below))
    entities.append(space.add_circle(center, radius, dxfattribs=below))
    entities.append(space.add_line((0.0, 0.0), (3.0 / scale, 1.0 / scale)))
    return saved(document), entities


@pytest.mark.parametrize("seed", range(24))
def test_dxf_of_another_program_is_the_same_plan(seed: int, tmp_path: Path) -> None:
    unit, number, scale = [("mm", 4, 1e-3), ("cm", 5, 1e-2), ("m", 6, 1.0), ("inch", 1, 0.0254), ("ft", 2, 0.3048)][
        seed % 5
    ]
    old = seed % 2 == 0  # it knows no units
    text, entities = drawn(np.random.default_rng(seed), old=old, number=number, scale=scale)
    path = written(tmp_path, "plan.dxf", text)
    if old:
        with pytest.raises(FileError, match=r"\$INSUNITS") as caught:
            load_map(path)
        assert caught.value.code == "unit_needed"
    found = load_map(path, **({"unit": unit} if old else {}))
    assert codes(found) == []
    for entity in entities:
        parts = entity.virtual_entities() if "POLYLINE" in entity.dxftype() else [entity]
        for part in parts:
            line = part.dxftype() == "LINE"
            places = [part.dxf.start, part.dxf.end] if line else list(part.flattening(1e-3 / scale))
            assert farthest(np.array([(x, y) for x, y, _ in places]) * scale, found) < 0.0052


def test_lines_that_go_on_are_one_wall_and_rings_repeat_their_first_point(tmp_path: Path) -> None:
    document = ezdxf.new()
    document.units = 6
    space = document.modelspace()
    for first, last in (((0, 0), (2, 0)), ((2, 0), (2, 2)), ((2, 2), (0, 0)), ((0, 0), (0, 5)), ((9, 9), (8, 8))):
        space.add_line(first, last)
        space.add_text("between")
    space.add_lwpolyline([(1, 1), (3, 1), (3, 3)], close=True)
    space.add_circle((5, 5), 1.0)
    space.add_line((4, 4), (4, 4))
    found = load_map(written(tmp_path, "plan.dxf", saved(document)))
    walls = points_of(found)
    assert walls[:4] == [
        [(0, 0), (2, 0), (2, 2), (0, 0)],
        [(0, 0), (0, 5)],
        [(9, 9), (8, 8)],
        [(1, 1), (3, 1), (3, 3), (1, 1)],
    ]
    assert walls[4][0] == walls[4][-1]
    (doubt,) = found.warnings
    assert "1 LINE without length, 5 TEXT" in doubt.message
    assert doubt.safe_side


def test_what_a_plan_holds_beside_walls_is_counted_and_doubted(tmp_path: Path) -> None:
    document = ezdxf.new()
    document.units = 6
    space = document.modelspace()
    space.add_line((0, 0), (5, 5), dxfattribs={"layer": "Walls"})
    space.add_ellipse((0, 0), (2, 0), 0.5)
    space.add_spline([(0, 0), (1, 1), (2, 0)])
    space.add_circle((0, 0), 1.0, dxfattribs={"extrusion": (1, 0, 0)})
    document.layout("Layout1").add_line((0, 0), (1, 1))
    block = document.blocks.new("DOOR")
    block.add_line((0, 0), (1, 0))
    space.add_blockref("DOOR", (1, 1))
    path = written(tmp_path, "plan.dxf", saved(document))
    (doubt,) = load_map(path).warnings
    for words in ("1 CIRCLE that is tilted", "1 ELLIPSE", "1 INSERT", "1 SPLINE", "1 LINE on paper"):
        assert words in doubt.message
    assert unsafe_doubts([doubt])
    assert load_map(path, layers=["WALLS"], outside="unknown").warnings == ()
    with pytest.raises(InvalidParameterError, match='did you mean "walls"'):
        load_map(path, layers=["wals"])


@pytest.mark.parametrize("old", [False, True])
def test_the_width_of_a_polyline_is_the_thickness_of_its_wall(tmp_path: Path, old: bool) -> None:
    document = ezdxf.new("R12" if old else "R2010")
    space = document.modelspace()
    draw = space.add_polyline2d if old else space.add_lwpolyline
    draw([(0, 0, 100, 240), (5000, 0, 0, 0)], format="xyse")
    space.add_line((0, 3000), (5000, 3000))
    path = written(tmp_path, "plan.dxf", saved(document))
    found = load_map(path, unit="mm", radius=0.05)
    assert [wall.radius for wall in found.walls] == pytest.approx([0.12, 0.05])
    assert found.clearance((2.5, 1.0)) == pytest.approx(0.88)


def test_blocks_are_read_where_they_are_placed(tmp_path: Path) -> None:
    document = ezdxf.new()
    document.units = 6
    space = document.modelspace()
    space.add_line((0, 0), (5, 5))
    inner = document.blocks.new("LEAF")
    inner.add_line((0, 0), (1, 0))
    door = document.blocks.new("DOOR")
    door.add_blockref("LEAF", (0, 0), dxfattribs={"xscale": 2.0, "yscale": 2.0})
    door.add_circle((0, 0), 0.5)
    space.add_blockref("DOOR", (10, 1), dxfattribs={"rotation": 90.0})
    space.add_blockref("LEAF", (0, 9), dxfattribs={"column_count": 3, "column_spacing": 2.0})
    path = written(tmp_path, "plan.dxf", saved(document))
    (doubt,) = load_map(path).warnings
    assert "2 INSERT; blocks=True" in doubt.message
    found = load_map(path, blocks=True)
    assert found.warnings == ()
    assert len(found.walls) == 6
    for place in ((10.0, 2.5), (10.5, 1.0), (0.5, 9.0), (2.5, 9.0), (4.5, 9.0), (1.0, 1.0)):
        assert found.clearance(place) == pytest.approx(0.0, abs=1e-9)
    space.add_blockref(
        "LEAF",
        (0, 9),
        dxfattribs={"column_count": 30_000, "row_count": 30_000, "column_spacing": 1.0, "row_spacing": 1.0},
    )
    with pytest.raises(FileError, match="100000 entities") as caught:
        load_map(written(tmp_path, "many.dxf", saved(document)), blocks=True)
    assert caught.value.code == "too_large"
    with pytest.raises(FileError, match="EOF"):
        load_map(written(tmp_path, "cut.dxf", saved(document)[:-8]), blocks=True)


def test_the_unit_that_is_said_counts_and_is_doubted_where_the_file_says_another(tmp_path: Path) -> None:
    document = ezdxf.new()
    document.units = 1
    document.modelspace().add_line((0, 0), (5, 0))
    path = written(tmp_path, "plan.dxf", saved(document))
    assert codes(load_map(path)) == ["implausible"]
    found = load_map(path, unit="m")
    assert codes(found) == ["unit_contradicts_file"]
    assert found.bounds == ((0.0, 0.0), (5.0, 0.0))
    with pytest.raises(InvalidParameterError, match="unit must be one of"):
        load_map(path, unit="miles")


# ---- SVG -----------------------------------------------------------------------------------------

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="{box}" width="{width}" height="{height}">'


def svg(body: str, box: str = "0 0 200 100", width: str = "20m", height: str = "10m") -> str:
    return HEAD.format(box=box, width=width, height=height) + body + "</svg>"


TRANSFORMS = [
    "",
    "translate(3, -4.5)",
    "translate(2)",
    "scale(2)",
    "scale(1 -0.5)",
    "rotate(30)",
    "rotate(30 10 20)",
    "skewX(20)",
    "skewY(-10)",
    "matrix(1,0.2,-0.3,0.9,4,5)",
    "translate(5,5) rotate(45),scale(.5)",
]
COUNTS = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}


def path_data(random: np.random.Generator) -> str:
    """Return commands as they come, but for those where the other reader does not do as SVG says."""
    parts, before = ["M 50 50"], "M"
    for _ in range(random.integers(1, 8)):
        kind = str(random.choice(list(COUNTS)))
        if before + kind in ("QS", "TS", "CT", "ST"):
            continue
        before = kind
        numbers = [f"{x:.3f}" for x in random.uniform(-30.0, 30.0, COUNTS[kind])]
        if kind == "A":
            numbers[:2] = [each.lstrip("-") for each in numbers[:2]]
            numbers[3:5] = [str(each) for each in random.integers(0, 2, 2)]
        parts.append((kind if random.random() < 0.5 else kind.lower()) + ",".join(numbers))
    return " ".join(parts) + " l 1 1"


@pytest.mark.parametrize("seed", range(60))
def test_paths_and_transforms_are_those_of_another_reader(seed: int, tmp_path: Path) -> None:
    random = np.random.default_rng(seed)
    data, (outer, inner) = path_data(random), random.choice(TRANSFORMS, 2)
    body = f'<g transform="{outer}"><path transform="{inner}" d="{data}"/></g><line x1="0" y1="0" x2="9" y2="9"/>'
    found = load_map(written(tmp_path, "plan.svg", svg(body)))
    matrix = svgelements.Matrix(str(inner)) * svgelements.Matrix(str(outer))
    for part in svgelements.Path(data):
        if isinstance(part, svgelements.Move):
            continue
        steps = 1 if isinstance(part, (svgelements.Line, svgelements.Close)) else 40
        places = [matrix.point_in_matrix_space(part.point(share)) for share in np.linspace(0.0, 1.0, steps + 1)]
        meters = np.array([(0.1 * each.x, 0.1 * (100.0 - each.y)) for each in places])
        assert farthest(meters, found) < 0.0052, data


def test_shapes_of_svg(tmp_path: Path) -> None:
    body = (
        '<title>no wall</title><defs><path d="M0 0L1 1"/></defs>'
        '<polyline points="0,100 50,100 50 50"/><polygon points="0 0 10 0 10 10"/>'
        '<rect x="20" y="20" width="10" height="5"/><circle cx="100" cy="50" r="10"/>'
        '<rect width="0" height="4"/><ellipse rx="2" ry="3"/><use href="#a"/><g display="none"><path d="M0 0L9 9"/></g>'
    )
    found = load_map(written(tmp_path, "plan.svg", svg(body)))
    walls = points_of(found)
    assert walls[0] == [(0.0, 0.0), (5.0, 0.0), (5.0, 5.0)]
    assert np.array(walls[1]) == pytest.approx(np.array([(0, 10), (1, 10), (1, 9), (0, 10)]))
    assert np.array(walls[2]) == pytest.approx(np.array([(2, 8), (3, 8), (3, 7.5), (2, 7.5), (2, 8)]))
    assert walls[3][0] == walls[3][-1]
    assert np.hypot(*(np.array(walls[3]) - (10.0, 5.0)).T) == pytest.approx(1.0)
    (doubt,) = found.warnings
    assert "1 ellipse, 1 g that is hidden, 1 rect without length, 1 use" in doubt.message
    assert unsafe_doubts([doubt])


def test_round_corners_of_a_rectangle_are_round(tmp_path: Path) -> None:
    body = '<rect x="0" y="0" width="100" height="100" rx="20"/>'
    found = load_map(written(tmp_path, "plan.svg", svg(body)))
    assert found.clearance((0.0, 10.0)) == pytest.approx(2.0 * (math.sqrt(2.0) - 1.0), abs=0.006)


@pytest.mark.parametrize(
    ("text", "call", "code", "words"),
    [
        (svg("<path d='M0 0L9 9'/>", width="100%"), {}, "scale_needed", "meters_per_unit"),
        (svg("<path d='M0 0L9 9'/>", width="800", height="400"), {}, "scale_needed", "meters_per_unit"),
        (svg("<path d='M0 0L9 9'/>", height="20m"), {}, "scale_needed", "proportion"),
        (svg("<path d='M0 0L9 9'/>", box="0 0 200"), {}, "unreadable", "viewBox"),
        (svg("<path d='M0 0 L9'/>"), {}, "unreadable", "path data"),
        (svg("<path d='L9 9'/>"), {}, "unreadable", "path data"),
        (svg("<path d='M0 0 X9 9'/>"), {}, "unreadable", "path data"),
        (svg("<g transform='turn(3)'><path d='M0 0L9 9'/></g>"), {}, "unreadable", "transform"),
        (svg("<path transform='rotate(1e999)' d='M0 0L9 9'/>"), {}, "unreadable", "transform"),
        (svg("<rect x='1e99' width='9' height='9'/>"), {}, "unreadable", "units of the drawing"),
        (svg("<line x1='5%' y1='3'/>"), {}, "unreadable", "units of the drawing"),
        (svg("<polygon points='1 2 3'/>"), {}, "unreadable", "pairs"),
        (svg("<text>a</text>"), {}, "no_walls", "1 text"),
        (svg("<circle r='1e12'/>"), {}, "too_large", "size"),
        (svg("<path d='M0 0L9 9'/>")[:-3], {}, "unreadable", "well-formed"),
        ('<!DOCTYPE svg [<!ENTITY a "b">]>' + svg("<path d='M0 0L9 9'/>"), {}, "unreadable", "entities"),
        (svg("<g>" * 300 + "</g>" * 300), {}, "unreadable", "deep"),
        (svg("<path d='M0 0L9 9'/>"), {"unit": "m"}, None, "unit must be left out"),
        (svg("<path d='M0 0L9 9'/>"), {"meters_per_unit": 0.0}, None, "meters_per_unit must be finite and positive"),
        (svg("<path d='M0 0L9 9'/>"), {"radius": -1.0}, None, "radius must be finite and not negative"),
    ],
)
def test_drawings_that_are_no_plan_are_refused(
    tmp_path: Path, text: str, call: dict[str, Any], code: str | None, words: str
) -> None:
    began = time.monotonic()
    with pytest.raises(InvalidParameterError, match=words) as caught:
        load_map(written(tmp_path, "plan.svg", text), **call)
    assert getattr(caught.value, "code", None) == code
    assert code is None or "plan.svg" in str(caught.value)
    assert time.monotonic() - began < 2.0


def test_the_scale_that_is_said_counts(tmp_path: Path) -> None:
    path = written(tmp_path, "plan.svg", svg("<path d='M0 100L100 100'/>", width="100%"))
    assert load_map(path, meters_per_unit=0.02).bounds == ((0.0, 0.0), (2.0, 0.0))
    paper = written(tmp_path, "paper.svg", svg("<path d='M0 100L100 100'/>", width="200mm", height="100mm"))
    (doubt,) = load_map(paper).warnings
    assert doubt.code == "implausible"
    assert "meters_per_unit" in doubt.message


# ---- GeoJSON -------------------------------------------------------------------------------------


def test_geometries_of_geojson(tmp_path: Path) -> None:
    ring = [[0, 0], [6, 0], [6, 4], [0, 0]]
    line = [[1, 1, 9.5], [2, 2, 9.5]]
    kinds = {"LineString": line, "MultiLineString": [line], "Polygon": [ring], "MultiPolygon": [[ring]]}
    parts = [{"type": kind, "coordinates": each} for kind, each in kinds.items()]
    features = [{"type": "Feature", "properties": None, "geometry": each} for each in (*parts, None)]
    point = {"type": "Feature", "geometry": {"type": "Point", "coordinates": [1, 1]}}
    features += [point, {"type": "Feature", "geometry": {"type": "GeometryCollection", "geometries": parts}}]
    path = written(tmp_path, "plan.json", json.dumps({"type": "FeatureCollection", "features": features}))
    found = load_map(path, unit="m", radius=0.1)
    expected = [[(1, 1), (2, 2)]] * 2 + [[(0, 0), (6, 0), (6, 4), (0, 0)]] * 2
    assert points_of(found) == expected * 2
    assert {wall.radius for wall in found.walls} == {0.1}
    assert "1 Feature without geometry, 1 Point" in found.warnings[0].message


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"type": "Polygon", "coordinates": [[[0, 0], [1, 0], [1, 1]]]}, r"coordinates\[0\] must be a ring"),
        ({"type": "LineString", "coordinates": [[0, 0], [1]]}, r"coordinates\[1\] must be a position"),
        ({"type": "LineString", "coordinates": [[0, 0], [1, "2"]]}, r"coordinates\[1\] must be finite numbers"),
        ({"type": "LineString", "coordinates": [[0, 0], [1, 10**400]]}, "finite numbers"),
        ({"type": "LineString", "coordinates": 3}, "must be a list"),
        ({"type": "Curve", "coordinates": []}, "type of GeoJSON"),
        ({"type": "Feature", "geometry": {"type": "Point", "coordinates": [0, 0]}}, "hold walls"),
    ],
)
def test_geojson_that_is_no_plan_is_refused(tmp_path: Path, given: Any, words: str) -> None:
    with pytest.raises(FileError, match=words):
        load_map(written(tmp_path, "plan.geojson", json.dumps(given)), unit="m")


def test_degrees_that_are_called_meters_are_doubted(tmp_path: Path) -> None:
    line = {"type": "LineString", "coordinates": [[8.41, 49.01], [8.4102, 49.0101]]}
    path = written(tmp_path, "plan.geojson", json.dumps(line))
    (doubt,) = load_map(path, unit="m").warnings
    assert doubt.code == "implausible"
    for unit in (None, "degrees", "mm"):
        with pytest.raises(FileError, match='unit="m"') as caught:
            load_map(path, unit=unit)
        assert caught.value.code == "unit_needed"


# ---- any file ------------------------------------------------------------------------------------


def test_arguments_of_another_format_are_refused(shared: Path) -> None:
    path = shared / FORMATS / "map_a.yaml"
    for call in ({"unit": "m"}, {"layers": ["a"]}, {"radius": 0.1}, {"meters_per_unit": 1.0}):
        with pytest.raises(InvalidParameterError, match="be left out for a map of the format map-server"):
            load_map(path, **call)
    with pytest.raises(InvalidParameterError, match="occupied_from must be left out"):
        load_map(shared / FORMATS / "map_plan.svg", occupied_from=50)
    with pytest.raises(FileError, match="give the YAML file beside it"):
        load_map(shared / FORMATS / "map_a.pgm")
    with pytest.raises(FileError, match="known format"):
        load_map(shared / FORMATS / "log_tum.txt")


def test_a_plan_that_is_cut_off_anywhere_is_an_error(shared: Path, tmp_path: Path) -> None:
    for name, call in (
        ("map_plan.dxf", {}),
        ("map_plan.svg", {}),
        ("map_plan.geojson", {"unit": "m"}),
        ("cfg_barn.world", {}),
        ("map_origin.yaml", {}),
    ):
        content = (shared / FORMATS / name).read_bytes()
        whole = content.rstrip()
        for cut in range(0, len(whole), 3):
            with pytest.raises(InvalidParameterError) as caught:
                load_map(written(tmp_path, name, content[:cut]), **call)
            assert str(caught.value)
