"""Right files of maps, floor plans, scenes and settings of robots, with their readers."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

from hrsafety import io
from hrsafety._yaml.documents import read_yaml

__all__ = ["places"]

YAML = """# notes stay
base: &base {radius: 0.3, name: 'a b', points: [1, -2.5e-1, .5]}
again: *base
nested:
  - x: 1   # first
    y: "two\\n lines"
  - - 3
    - ~
text: |
  one
   two
folded: >-
  one
  two
plain: several words
  in two lines
"""
SVG = """<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 200 100" width="20m" height="10m">
<g transform="rotate(10 5 5) scale(1.5,1)"><path d="M0 100 L120 100 c5 5 10-5 20 0 s3 4 5 6 a5 8 30 1 0 9 9 z"/></g>
<rect x="1" y="2" width="30" height="20" rx="3"/><circle cx="50" cy="50" r="5"/><polygon points="1,2 3,4 5,9"/>
<text>a</text></svg>"""
GEOJSON = """{"type": "FeatureCollection", "features": [{"type": "Feature", "geometry":
{"type": "Polygon", "coordinates": [[[0, 0], [6.5, 0], [6, 4], [0, 0]]]}}, {"type": "Feature", "geometry":
{"type": "MultiLineString", "coordinates": [[[1, 1], [2, 2, 0.5]]]}}]}"""
DXF = (
    "0 SECTION 2 HEADER 9 $INSUNITS 70 4 0 ENDSEC 0 SECTION 2 ENTITIES "
    "0 LINE 8 W 10 0 20 0 11 6000 21 0 0 LINE 8 W 10 6000 20 0 11 6000 21 4000 "
    "0 LWPOLYLINE 8 W 90 3 70 1 10 0 20 0 42 0.5 10 4000 20 0 10 4000 20 2500 "
    "0 ARC 8 W 10 0 20 0 40 900 50 10 51 200 0 CIRCLE 8 W 10 0 20 0 40 500 230 -1 "
    "0 POLYLINE 8 W 70 0 0 VERTEX 10 1 20 1 42 1 0 VERTEX 10 900 20 9 0 SEQEND 0 TEXT 1 a 0 ENDSEC 0 EOF "
)
GAZEBO = """<sdf version='1.6'><world name='default'><model name='ground_plane'><link name='l'><collision name='c'>
<geometry><plane/></geometry></collision></link></model><model name='c0'><pose frame=''>1 2 0 0 0 0.5</pose><link
name='l'><pose>0.1 0 0 0 0 0</pose><collision name='c'><geometry><cylinder><radius>0.075</radius></cylinder></geometry>
</collision></link></model></world></sdf>"""
HUNAV = """hunav_loader:
  ros__parameters:
    map: hall
    agents: [a, b]
    a: {id: 1, behavior: 1, group_id: -1, max_vel: 1.1, radius: 0.3, init_pose: {x: -1.0, y: 2.0, h: 0.5},
      goal_radius: 0.3, cyclic_goals: false, goals: [g], g: {x: 3.0, y: 2.0, h: 0.0}}
    b:
      id: 2
      behavior: 4
      group_id: 0
      max_vel: 1.3
      radius: 0.35
      init_pose: {x: 0.5, y: 1.0}
      goal_radius: 0.3
      cyclic_goals: true
      goals: []
"""
CROWDNAV = """[env]
time_limit = 25
time_step = 0.25
[sim]
test_sim = circle_crossing
square_width = 10
circle_radius = 4
human_num = 5
[humans]
visible = true
radius = 0.3
v_pref = 1
[robot]
visible = false
radius = 0.3
v_pref = 1
"""
NAV2 = """controller_server:
  ros__parameters:
    controller_plugins: ["FollowPath"]
    FollowPath: {plugin: "nav2_mppi_controller::MPPIController", vx_max: 0.5, vx_min: -0.35, wz_max: 1.9, ax_max: 3.0,
      ax_min: -3.0, az_max: 3.5, motion_model: "DiffDrive"}
velocity_smoother:
  ros__parameters:
    max_velocity: [0.5, 0.0, 2.0]
    max_decel: [-2.0, 0.0, -3.2]
local_costmap:
  local_costmap:
    ros__parameters:
      footprint: "[[0.5, 0.4], [0.5, -0.4], [-0.5, -0.4], [-0.5, 0.4]]"
      inflation_layer: {inflation_radius: 0.55, cost_scaling_factor: 3.0}
"""


def _robot(path: Path) -> Any:
    settings = io.read_nav2(path)
    return settings, settings.robot(max_acceleration=1.0)


def _world(path: Path) -> Any:
    scene = io.load_scene(path)
    world = scene.world() if isinstance(scene, io.HuNavScene) else scene.world(0)
    return scene, world


def _changed(path: Path) -> Any:
    """Return a file with a value changed, and changed back."""
    document = read_yaml(path)
    root = document.root
    key = next((key for key in root if root[key].is_map or root[key].is_list), None) if root.is_map else None
    if key is None:
        return root.plain
    changed = document.changed({(key,): [1.5, "a b", {"c": None}]})
    return changed.root[key].plain, changed.changed({(key,): root[key].plain}).root.plain


def places(folder: Path) -> dict[str, tuple[Path, Callable[[Path], Any]]]:
    """Write a right file of each kind into a folder and return their readers by name."""
    pairs = DXF.replace("$INSUNITS ", "$INSUNITS\n").split()
    kinds: dict[str, tuple[str, str, Callable[[Path], Any]]] = {
        "read_yaml": ("notes.yaml", YAML, lambda path: read_yaml(path).root.plain),
        "read_yaml, changed": ("changed.yaml", YAML, _changed),
        "load_map, DXF": ("plan.dxf", "\n".join(pairs) + "\n", io.load_map),
        "load_map, SVG": ("plan.svg", SVG, io.load_map),
        "load_map, GeoJSON": ("plan.geojson", GEOJSON, lambda path: io.load_map(path, unit="m")),
        "load_map, BARN": ("barn.world", GAZEBO, io.load_map),
        "load_scene, HuNavSim": ("agents.yaml", HUNAV, _world),
        "load_scene, CrowdNav": ("env.config", CROWDNAV, _world),
        "read_nav2": ("nav2.yaml", NAV2, _robot),
    }
    found: dict[str, tuple[Path, Callable[[Path], Any]]] = {}
    for name, (file, text, reader) in kinds.items():
        path = folder / file
        path.write_text(text, encoding="utf-8")
        found[name] = (path, reader)
    return found
