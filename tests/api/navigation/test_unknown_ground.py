"""What nobody has seen is not free: cells, grays of map savers, what lies outside; and files of many makers."""

from __future__ import annotations

import contextlib
import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import navigation as nav
from hrsafety.errors import InvalidParameterError
from hrsafety.navigation.maps.map_server import BETWEEN, FREE, OCCUPIED, UNKNOWN, cell_classes
from hrsafety.plausibility import unsafe_doubts

Image = pytest.importorskip("PIL.Image")

FORMATS = Path("data") / "formats"
LETTERS = {FREE: ".", UNKNOWN: "?", OCCUPIED: "#", BETWEEN: "+"}
# The wall with a door that nobody has looked through: white, black, and the gray of map savers.
WHITE, BLACK, GRAY = 254, 0, 205
HEAD = "resolution: 0.1\norigin: [-1.0, -0.5, 0.0]\nnegate: 0\noccupied_thresh: 0.65\n"


def served(folder: Path, values: Any, *, free: float = 0.25, head: str = HEAD, more: str = "") -> Path:
    """Write a map whose image is a PGM, and return its YAML file."""
    gray = np.asarray(values, dtype=np.uint8)
    rows, columns = gray.shape
    (folder / "map.pgm").write_bytes(b"P5\n%d %d\n255\n" % (columns, rows) + gray.tobytes())
    path = folder / "map.yaml"
    path.write_text(f"image: map.pgm\n{head}free_thresh: {free}\n{more}", encoding="utf-8")
    return path


def codes(found: Any) -> list[str]:
    return [each.code for each in found.warnings]


# ---- samples -------------------------------------------------------------------------------------


def samples(shared: Path) -> list[dict[str, Any]]:
    expected = json.loads((shared / FORMATS / "expected.json").read_text(encoding="utf-8"))
    return [each for each in expected["maps_and_configurations"] if each["file"].startswith("map_")]


def test_samples_are_read_as_they_were_drawn(shared: Path) -> None:
    checked = 0
    for each in samples(shared):
        path = shared / FORMATS / each["file"]
        if path.suffix != ".yaml":
            continue
        if "error" in each:
            with pytest.raises(InvalidParameterError) as caught:
                nav.StaticMap.from_map_server(path, **each["call"])
            assert all(name in str(caught.value) for name in each.get("names", [])), each["file"]
            continue
        there = nav.StaticMap.from_map_server(path, **each["call"])
        assert sorted(codes(there)) == sorted(each["warnings"]), each["file"]
        said = " ".join(doubt.message for doubt in there.warnings)
        assert all(name in said for name in each.get("names", [])), each["file"]
        if "rows_from_top" in each:
            drawn = ["".join(LETTERS[cell] for cell in row) for row in cell_classes(path)[::-1].tolist()]
            assert drawn == each["rows_from_top"], each["file"]
            (grid,) = there.grids
            assert grid.occupied.sum() == each["occupied"] + each["unknown"] + each["between"]
        checked += 1
    assert checked >= 12


# ---- gray 205 ------------------------------------------------------------------------------------


@settings(max_examples=50, deadline=None)
@given(seed=st.integers(0, 10_000), free=st.floats(0.2, 0.6), rows=st.integers(1, 12), columns=st.integers(1, 12))
def test_the_gray_of_map_savers_is_never_free_in_silence(
    seed: int, free: float, rows: int, columns: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    values = np.random.default_rng(seed).choice([WHITE, BLACK, GRAY], (rows, columns))
    path = served(tmp_path_factory.mktemp("map"), values, free=free)
    gray = int((values == GRAY).sum())
    careful = nav.StaticMap.from_map_server(path)
    assert careful.grids[0].occupied[::-1].tolist() == (values != WHITE).tolist()
    by_letter = nav.StaticMap.from_map_server(path, rule="nav2")
    assert by_letter.grids[0].occupied[::-1].tolist() == (values == BLACK).tolist()
    assert by_letter.grids[0].unseen[::-1].tolist() == (values == GRAY).tolist()
    for there in (careful, by_letter):
        assert codes(there) == (["unknown_gray"] if gray else [])
        assert len(unsafe_doubts(there.warnings)) == bool(gray)
        if gray:
            assert f"{gray} of {values.size} cells ({100.0 * gray / values.size:.3g} %)" in there.warnings[0].message


def test_below_the_gray_of_map_savers_there_is_nothing_to_doubt(tmp_path: Path) -> None:
    there = nav.StaticMap.from_map_server(served(tmp_path, [[WHITE, GRAY, BLACK]], free=0.196))
    assert there.warnings == ()
    assert there.grids[0].occupied.tolist() == [[False, True, True]]


def test_unknown_cells_taken_as_free_are_told_with_their_share(tmp_path: Path) -> None:
    path = served(tmp_path, [[WHITE, GRAY, GRAY, BLACK]], free=0.196)
    there = nav.StaticMap.from_map_server(path, unknown="free")
    (doubt,) = unsafe_doubts(there.warnings)
    assert doubt.code == "unknown_ground"
    assert "2 of 4 cells (50 %)" in doubt.message
    assert there.unseen([(-0.95, -0.45), (-0.85, -0.45), (-0.65, -0.45), (5.0, 5.0)]).tolist() == [
        False,
        True,
        False,
        True,
    ]


# ---- the guide -----------------------------------------------------------------------------------

# Two rooms whose wall reaches to the edges of the image: there is no known way from one to the other.
ROOMS = np.full((40, 60), WHITE)
ROOMS[:, 30] = BLACK
ENDS = {"start": (0.5, 1.5), "goal": (4.5, 1.5)}


def test_a_guide_does_not_plan_around_outside_of_the_image(tmp_path: Path) -> None:
    path = served(tmp_path, ROOMS)
    there = nav.StaticMap.from_map_server(path)
    with pytest.raises(InvalidParameterError, match="goal must be reachable from the start"):
        nav.Guide().plan(there, radius=0.2, **ENDS)
    around = nav.StaticMap.from_map_server(path, outside="free")
    assert nav.Guide().plan(around, radius=0.2, **ENDS).cost(ENDS["start"]) > 4.0
    boxed = nav.Guide(box=((-3, -3), (8, 6))).plan(there, radius=0.2, **ENDS)
    (doubt,) = unsafe_doubts(boxed.warnings)
    assert (doubt.code, doubt.message.startswith("the plan leads ")) == ("unknown_ground", True)


def test_ends_outside_of_the_image_are_refused(tmp_path: Path) -> None:
    there = nav.StaticMap.from_map_server(served(tmp_path, np.full((40, 60), WHITE)))
    for ends in ({"start": (-1.5, 0.0), "goal": (2.0, 1.0)}, {"start": (2.0, 1.0), "goal": (2.0, 3.6)}):
        with pytest.raises(InvalidParameterError, match="lie within the image of the map"):
            nav.Guide().plan(there, radius=0.2, **ends)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), yaw=st.floats(-3.1, 3.1), share=st.floats(0.0, 0.06))
def test_plans_stay_within_turned_images(seed: int, yaw: float, share: float) -> None:
    rng = np.random.default_rng(seed)
    cells = rng.random((20, 30)) < share
    there = nav.StaticMap.from_grid(cells, resolution=0.2, origin=(1.0, -2.0), yaw=yaw, outside="unknown")
    turn = np.array([[math.cos(yaw), -math.sin(yaw)], [math.sin(yaw), math.cos(yaw)]])
    start, goal = ((1.0, -2.0) + turn @ place for place in ((0.4, 0.4), (5.6, 3.6)))
    try:
        plan = nav.Guide(spacing=0.1).plan(there, radius=0.15, start=start, goal=goal)
    except InvalidParameterError:
        return
    local = (plan.path(start) - (1.0, -2.0)) @ turn
    assert (local > -1e-6).all()
    assert (local < (6.0 + 1e-6, 4.0 + 1e-6)).all()
    assert plan.warnings == ()


def test_runs_carry_the_doubts_of_their_map(tmp_path: Path) -> None:
    values = np.full((40, 60), WHITE)
    values[10:30, 25:35] = GRAY
    path = served(tmp_path, values)
    scene = nav.Scenario(**ENDS, time_limit=30.0)
    for options, expected in (({}, ["unknown_gray"]), ({"rule": "nav2"}, ["unknown_gray", "unknown_ground"])):
        law = nav.SafeNavigation(
            nav.VirtualForceField(), map=nav.StaticMap.from_map_server(path, **options), guide=nav.Guide()
        )
        run = nav.simulate(scene, law)
        assert run.outcome == "arrived"
        assert codes(run) == expected
        assert codes(nav.simulate_many([scene], law)) == ["unknown_gray"]
        assert len(unsafe_doubts(run.warnings)) == len(expected)


def test_maps_joined_keep_limits_and_doubts(tmp_path: Path) -> None:
    image = nav.StaticMap.from_map_server(served(tmp_path, [[WHITE, GRAY]]))
    both = image + nav.StaticMap.from_polylines([[(0, 0), (1, 0)]])
    assert codes(both) == ["unknown_gray"]
    assert both.unseen((10.0, 10.0))
    other = nav.StaticMap.from_grid(np.zeros((4, 4)) > 0, resolution=1.0, origin=(8.0, 8.0), outside="unknown")
    assert not (both + other).unseen((10.0, 10.0))


# ---- files of many makers ------------------------------------------------------------------------

CELLS = np.array([[WHITE, BLACK, GRAY], [BLACK, WHITE, WHITE]], dtype=np.uint8)


def pictures() -> dict[str, Any]:
    sixteen = (CELLS.astype(np.uint16) * 257).astype(np.uint16)
    palette = Image.fromarray(CELLS).convert("P")
    return {
        "L": Image.fromarray(CELLS),
        "I;16": Image.fromarray(sixteen),
        "RGB": Image.merge("RGB", [Image.fromarray(CELLS)] * 3),
        "LA": Image.merge("LA", [Image.fromarray(CELLS), Image.fromarray(np.full_like(CELLS, 255))]),
        "RGBA": Image.merge("RGBA", [Image.fromarray(CELLS)] * 3 + [Image.fromarray(np.full_like(CELLS, 255))]),
        "P": palette,
    }


@pytest.mark.parametrize("kind", sorted(pictures()))
def test_png_pictures_of_every_kind_are_the_same_map(tmp_path: Path, kind: str) -> None:
    path = served(tmp_path, CELLS, free=0.196)
    expected = nav.StaticMap.from_map_server(path)
    pictures()[kind].save(tmp_path / "map.png")
    path.write_text(path.read_text(encoding="utf-8").replace("map.pgm", "map.png"), encoding="utf-8")
    assert nav.StaticMap.from_map_server(path) == expected


def test_what_is_not_opaque_is_unknown(tmp_path: Path) -> None:
    alpha = np.array([[255, 255, 255], [255, 254, 0]], dtype=np.uint8)
    Image.merge("LA", [Image.fromarray(np.full_like(CELLS, WHITE)), Image.fromarray(alpha)]).save(tmp_path / "map.png")
    path = served(tmp_path, CELLS)
    path.write_text(path.read_text(encoding="utf-8").replace("map.pgm", "map.png"), encoding="utf-8")
    there = nav.StaticMap.from_map_server(path)
    assert there.grids[0].occupied[::-1].tolist() == (alpha < 255).tolist()
    free = nav.StaticMap.from_map_server(path, unknown="free")
    assert free.grids[0].unseen[::-1].tolist() == (alpha < 255).tolist()
    assert "2 of 6 cells (33.3 %)" in free.warnings[0].message


@settings(max_examples=40, deadline=None)
@given(cut=st.integers(0, 400), flip=st.integers(0, 400), value=st.integers(0, 255))
def test_a_spoiled_png_is_a_map_or_an_error(
    cut: int, flip: int, value: int, tmp_path_factory: pytest.TempPathFactory
) -> None:
    folder = tmp_path_factory.mktemp("png")
    Image.fromarray(CELLS).save(folder / "map.png")
    raw = bytearray((folder / "map.png").read_bytes())
    raw[flip % len(raw)] = value
    (folder / "map.png").write_bytes(bytes(raw[: max(len(raw) - cut % len(raw), 1)]))
    path = served(folder, CELLS)
    path.write_text(path.read_text(encoding="utf-8").replace("map.pgm", "map.png"), encoding="utf-8")
    with contextlib.suppress(InvalidParameterError):
        nav.StaticMap.from_map_server(path)


FLOW = (
    "{{image: {image}, resolution: 5.0e-2, origin: [0, 0, 0.0], negate: {negate}, occupied_thresh: 0.65, "
    "free_thresh: 0.196}}"
)


@pytest.mark.parametrize("negate", ["0", "false", "False", "no", "'0'"])
@pytest.mark.parametrize("image", ["map.pgm", '"map.pgm"', "'map.pgm'"])
@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
@pytest.mark.parametrize("end", ["\n", "\r\n"])
def test_yaml_of_every_style_is_the_same_map(tmp_path: Path, negate: str, image: str, encoding: str, end: str) -> None:
    path = served(tmp_path, CELLS)
    flow = FLOW.format(image=image, negate=negate) + " # flow style" + end
    block = flow.split(" #")[0][1:-1].replace(", ", "\n").replace("[0\n0\n0.0]", "[0, 0,\n  0.0]").replace("\n", end)
    found = []
    for text in (flow, f"%YAML 1.2{end}---{end}{block}{end}free_space: ignored # more{end}"):
        path.write_bytes(text.encode(encoding))
        found.append(nav.StaticMap.from_map_server(path))
    assert found[0] == found[1]
    assert found[0].grids[0].occupied[::-1].tolist() == (CELLS != WHITE).tolist()
    assert found[0].grids[0].resolution == 0.05


@pytest.mark.parametrize(
    ("head", "spare"),
    [
        *((b"P5\r\n3 2\r\n255\r\n", spare) for spare in (0, 1, 8)),
        *((b"P5\n# a\r\n3 2 # b\n255\n", spare) for spare in (0, 1, 8)),
        (b"P5 3 2 255\r", 0),
    ],
)
def test_heads_of_every_style_and_spare_bytes(tmp_path: Path, head: bytes, spare: int) -> None:
    path = served(tmp_path, CELLS, free=0.196)
    cells = CELLS.copy()
    cells[0, 0] = 10  # a line feed, which belongs to the picture
    (tmp_path / "map.pgm").write_bytes(head + cells.tobytes() + b"\n" * spare)
    there = nav.StaticMap.from_map_server(path)
    assert there.grids[0].occupied[::-1].tolist() == (cells != WHITE).tolist()
    assert ("trailing_bytes" in codes(there)) == (spare > 0)


@pytest.mark.parametrize("most", [1, 100, 255, 256, 1000, 65535])
@pytest.mark.parametrize("kind", ["P2", "P5"])
def test_gray_values_of_every_depth(tmp_path: Path, most: int, kind: str) -> None:
    path = served(tmp_path, CELLS, free=0.196)
    values = np.array([[most, 0, most], [0, most, most]])
    body = (
        " ".join(map(str, values.ravel())).encode()
        if kind == "P2"
        else values.astype(np.uint8 if most < 256 else ">u2").tobytes()
    )
    (tmp_path / "map.pgm").write_bytes(f"{kind}\n3 2\n{most}\n".encode() + body)
    assert nav.StaticMap.from_map_server(path).grids[0].occupied[::-1].tolist() == (values == 0).tolist()


def test_units_of_a_map_are_doubted(tmp_path: Path) -> None:
    for old, new, word in (("0.1", "50", "resolution"), ("-0.5, 0.0", "-0.5, 90", "degrees")):
        there = nav.StaticMap.from_map_server(served(tmp_path, CELLS, free=0.196, head=HEAD.replace(old, new)))
        assert codes(there) == ["implausible"]
        assert word in there.warnings[0].message


def test_an_image_elsewhere_is_read_when_its_path_is_trusted(tmp_path: Path) -> None:
    (tmp_path / "below").mkdir()
    path = served(tmp_path, CELLS, free=0.196)
    moved = tmp_path / "below" / "map.yaml"
    moved.write_text(path.read_text(encoding="utf-8").replace("map.pgm", "../map.pgm"), encoding="utf-8")
    with pytest.raises(InvalidParameterError, match="trust_path=True"):
        nav.StaticMap.from_map_server(moved)
    assert nav.StaticMap.from_map_server(moved, trust_path=True) == nav.StaticMap.from_map_server(path)


# ---- other grays and modes -----------------------------------------------------------------------


@pytest.mark.parametrize("negate", [False, True])
@pytest.mark.parametrize("most", [16, 100, 200, 254, 1000, 4095, 65535])
def test_the_gray_of_map_savers_is_known_at_every_depth(tmp_path: Path, most: int, negate: bool) -> None:
    head = HEAD.replace("negate: 0", f"negate: {int(negate)}")
    path = served(tmp_path, CELLS, free=0.3, head=head)
    levels = np.array([[255, 205, 0], [205, 205, 255]])
    values = np.round((255 - levels if negate else levels) * most / 255.0).astype(int)
    body = values.astype(np.uint8 if most < 256 else ">u2").tobytes()
    (tmp_path / "map.pgm").write_bytes(f"P5\n3 2\n{most}\n".encode() + body)
    there = nav.StaticMap.from_map_server(path)
    assert "unknown_gray" in codes(there)
    assert there.grids[0].occupied[::-1].tolist() == (levels < 255).tolist()


@settings(max_examples=40, deadline=None)
@given(gray=st.integers(90, 204), more=st.floats(0.001, 0.2))
def test_grays_that_a_threshold_frees_are_doubted(
    gray: int, more: float, tmp_path_factory: pytest.TempPathFactory
) -> None:
    values = np.full((20, 20), WHITE)
    values[0], values[5:9, 5:9] = BLACK, gray
    free = (255 - gray) / 255.0 + more
    path = served(tmp_path_factory.mktemp("map"), values, free=free, head=HEAD.replace("0.65", "0.95"))
    there = nav.StaticMap.from_map_server(path)
    assert codes(there) == ["unknown_gray"]
    assert "16 of 400 cells (4 %)" in unsafe_doubts(there.warnings)[0].message


@pytest.mark.parametrize(
    ("values", "more", "doubted"),
    [
        ([[0, 100, 255], [0, 0, 50]], "mode: raw\n", False),
        ([[0, 100, 255], [0, 0, 50]], "", True),
        ([[WHITE, WHITE, BLACK], [WHITE, GRAY, WHITE]], "mode: raw\n", True),
        ([[WHITE, WHITE, BLACK], [WHITE, GRAY, WHITE]], "", False),
        ([[255, 255, 0], [0, 255, 0]], "", False),
        ([[255, 0] * 1000 + [8, 19]], "", False),
        ([[255, 0] * 1000 + [8, 100]], "", True),
    ],
)
def test_gray_values_of_another_mode_are_doubted(tmp_path: Path, values: Any, more: str, doubted: bool) -> None:
    there = nav.StaticMap.from_map_server(served(tmp_path, values, free=0.196, more=more))
    assert ("other_mode" in {each.code for each in unsafe_doubts(there.warnings)}) == doubted


def test_an_origin_in_other_units_is_doubted_and_an_empty_name_is_none(tmp_path: Path) -> None:
    path = served(tmp_path, CELLS, free=0.196, head=HEAD.replace("-1.0, -0.5", "-50000, -25000"))
    assert codes(nav.StaticMap.from_map_server(path)) == ["implausible"]
    path.write_text(path.read_text(encoding="utf-8").replace("map.pgm", ""), encoding="utf-8")
    with pytest.raises(InvalidParameterError, match="image must stand in"):
        nav.StaticMap.from_map_server(path)


def test_json_is_yaml(tmp_path: Path) -> None:
    path = served(tmp_path, CELLS, free=0.196)
    entries = {
        "image": "map.pgm",
        "resolution": 0.1,
        "origin": [0, 0, 0],
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    }
    read = []
    for separators in ((", ", ": "), (",", ":")):
        path.write_text(json.dumps(entries | {"negate": 0}, separators=separators), encoding="utf-8")
        read.append(nav.StaticMap.from_map_server(path))
    assert read[0] == read[1]


def test_tables_tell_of_straight_ways_over_unknown_ground(tmp_path: Path) -> None:
    values = np.full((40, 60), WHITE)
    values[0] = BLACK
    image = nav.StaticMap.from_map_server(served(tmp_path, values, free=0.196))
    inside = nav.Scenario(start=(-0.5, 1.5), goal=(4.0, 1.5))
    outside = nav.Scenario(start=(-0.5, 1.5), goal=(8.0, 1.5))
    law = nav.SafeNavigation(nav.VirtualForceField(), map=image)
    assert codes(nav.simulate_many([inside], [law])) == []
    assert codes(nav.simulate_many([inside, outside], [law])) == ["unknown_ground"]
    assert codes(nav.simulate_batch([outside], law)) == ["unknown_ground"]


# ---- worlds and controllers ----------------------------------------------------------------------


def test_a_world_and_a_controller_doubt_the_map_of_a_law_as_a_scenario_does(tmp_path: Path) -> None:
    cells = np.full((30, 80), WHITE)
    cells[:, 30:40] = GRAY
    there = nav.StaticMap.from_map_server(served(tmp_path, cells, free=0.196), unknown="free")
    law = nav.SafeNavigation(nav.VirtualForceField(), map=there, shield=nav.Shield(margin=0.02, wall_margin=0.02))
    start, goal, real = (0.0, 1.0), (6.0, 1.0), nav.StaticMap.from_polylines([[(-1.0, -0.5), (7.0, -0.5)]])
    scene = nav.Scenario(start=start, goal=goal, walls=real)
    expected = [each for each in nav.simulate(scene, law).warnings if each.code == "unknown_ground"]
    for walls in ((), real):
        world = nav.World(robots=[nav.Robot(start=start, goal=goal)], walls=walls)
        for run in (nav.simulate(world, law), nav.simulate_many(world, law), nav.falsify(world, law, episodes=1)):
            assert codes(run).count("unknown_ground") == len(expected) == 2
    assert codes(nav.Controller(law, nav.HolonomicRobot(), goal)) == ["unknown_ground"]


@pytest.mark.parametrize("place", [nav.Scenario, nav.World])
def test_a_run_out_of_the_image_of_a_scene_is_over_unknown_ground(place: Any, tmp_path: Path) -> None:
    there = nav.StaticMap.from_map_server(served(tmp_path, np.full((30, 30), WHITE), free=0.196))
    found = []
    for goal in ((1.0, 1.0), (5.0, 1.0)):
        scene = nav.Scenario(start=(0.0, 1.0), goal=goal, walls=there)
        there_too = nav.World.of(scene) if place is nav.World else scene
        run = nav.simulate(there_too, nav.VirtualForceField())
        assert run.outcome == "arrived"
        attacked = nav.falsify(there_too, nav.VirtualForceField(), episodes=1)
        found.append(("unknown_ground" in codes(run), "unknown_ground" in codes(attacked)))
    assert found == [(False, False), (True, True)]
