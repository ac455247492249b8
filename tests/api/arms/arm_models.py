"""Small URDFs that the tests of arms share."""

from __future__ import annotations

from pathlib import Path

import hrsafety

EXAMPLE = (Path(hrsafety.__file__).parent / "arms" / "data" / "example_arm.urdf").read_text(encoding="utf-8")

INERTIA = '<inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/>'
INERTIAL = f'<inertial><origin xyz="0.1 0 0"/><mass value="1.5"/>{INERTIA}</inertial>'


def link(name: str, inertial: str = INERTIAL) -> str:
    return f'<link name="{name}">{inertial}</link>'


def joint(name: str, parent: str, child: str, inner: str = '<axis xyz="0 0 1"/>', kind: str = "continuous") -> str:
    ends = f'<parent link="{parent}"/><child link="{child}"/>'
    return f'<joint name="{name}" type="{kind}">{ends}<origin xyz="0.3 0 0"/>{inner}</joint>'


def robot(*parts: str) -> str:
    return f'<robot name="small">{link("base", "")}{"".join(parts)}</robot>'


LINKS = (link("a"), link("b"))
TWO = robot(*LINKS, joint("one", "base", "a"), joint("two", "a", "b"))
"""Two turning joints about parallel axes."""
