"""Symmetry of the compared laws: what moves, turns and mirrors with the scene."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from hrsafety import navigation as nav

Pair = tuple[float, float]

FORCES: dict[str, nav.Law] = {
    "masoud": nav.Masoud(),
    "ge_cui": nav.GeCui(),
    "khatib": nav.Khatib(),
    "khatib_printed": nav.Khatib(form="printed"),
    "borenstein_koren": nav.BorensteinKoren(),
    "borenstein_koren_printed": nav.BorensteinKoren(attracted_inside=False),
}
MIRRORED = tuple(name for name in FORCES if name != "masoud")
FORCE = 1e-8
"""Relative: coordinates of a few meters round to 1e-15 m, and surfaces 0.05 m apart to 1e-13 of
their distance; Ge and Cui divide by its square."""
APART = 0.05
"""m: between robot and obstacles, and between robot and the edge of a region."""


class Scene(NamedTuple):
    """A state of a robot between a walking person, a disc and a rectangle."""

    position: Pair
    velocity: Pair
    person: Pair
    walk: Pair
    disc: Pair
    goal: Pair


places = st.tuples(st.floats(-1.5, 1.5), st.floats(-1.5, 1.5))
velocities = st.tuples(st.floats(-0.45, 0.45), st.floats(-0.45, 0.45))
scenes = st.builds(
    Scene,
    position=places,
    velocity=velocities,
    person=places,
    walk=velocities,
    disc=places,
    goal=st.tuples(st.floats(-9.0, -6.0), st.floats(-3.0, 3.0)),
)
angles = st.floats(-math.pi, math.pi)
shifts = st.tuples(st.floats(-5.0, 5.0), st.floats(-5.0, 5.0))

BOX: Pair = (2.0, -2.0)
BOX_HEADING = 0.4
START: Pair = (12.0, 9.0)


class Motion(NamedTuple):
    """A motion of the plane, with or without a reflection."""

    turn: Callable[[Pair], Pair]
    shift: Pair
    heading: Callable[[float], float]

    def place(self, point: Pair) -> Pair:
        x, y = self.turn(point)
        return (x + self.shift[0], y + self.shift[1])


STAY = Motion(lambda point: point, (0.0, 0.0), lambda heading: heading)
MIRROR = Motion(lambda point: (point[0], -point[1]), (0.0, 0.0), lambda heading: -heading)


def rotated(angle: float, shift: Pair) -> Motion:
    cosine, sine = math.cos(angle), math.sin(angle)
    return Motion(
        lambda point: (cosine * point[0] - sine * point[1], sine * point[0] + cosine * point[1]),
        shift,
        lambda heading: heading + angle,
    )


def scenario(scene: Scene, motion: Motion) -> nav.Scenario:
    return nav.Scenario(
        start=motion.place(START),
        goal=motion.place(scene.goal),
        obstacles=(
            nav.Human(
                start=motion.place(scene.person),
                velocity=motion.turn(scene.walk),
                critical_radius=0.8,
                active_radius=2.1,
            ),
            nav.Disc(center=motion.place(scene.disc), radius=0.1, critical_radius=0.3665, active_radius=0.8),
            nav.Rectangle(
                center=motion.place(BOX),
                length=1.4,
                width=0.6,
                heading=motion.heading(BOX_HEADING),
                critical_radius=0.2665,
                active_radius=0.7,
            ),
        ),
    )


def commanded(law: nav.Law, scene: Scene, motion: Motion) -> np.ndarray:
    state: dict[str, Any] = {"position": motion.place(scene.position), "velocity": motion.turn(scene.velocity)}
    return nav.laws.command(law, scenario(scene, motion), **state)


def regions(scene: Scene) -> list[float]:
    """Return how deep the robot is in each active region, in m; states at an edge are left out."""
    reached = []
    for center, touching, active in ((scene.person, 0.6, 2.1), (scene.disc, 0.3, 0.8)):
        distance = math.dist(scene.position, center)
        assume(distance > touching + APART and abs(distance - active) > 1e-6)
        reached.append(active - distance)
    distance = math.hypot(*_from_box(scene.position))
    assume(distance > 0.2 + APART and abs(distance - 0.7) > 1e-6)
    reached.append(0.7 - distance)
    return reached


def regular(scene: Scene) -> bool:
    """Return whether no stopping distance of Ge and Cui comes near a distance, where they divide by zero."""
    limit = nav.HolonomicRobot().max_acceleration
    for center, walk in ((scene.person, scene.walk), (scene.disc, (0.0, 0.0)), (BOX, (0.0, 0.0))):
        speed = math.dist(scene.velocity, walk)
        if math.dist(scene.position, center) < speed**2 / (2.0 * limit) + 0.1:
            return False
    return True


@pytest.mark.parametrize("name", FORCES)
@given(scene=scenes, angle=angles, shift=shifts)
def test_force_moves_and_turns_with_the_scene(name: str, scene: Scene, angle: float, shift: Pair) -> None:
    regions(scene)
    assume(regular(scene))
    motion = rotated(angle, shift)
    expected = motion.turn(tuple(commanded(FORCES[name], scene, STAY).tolist()))
    scale = max(1.0, math.hypot(*expected))
    assert commanded(FORCES[name], scene, motion) == pytest.approx(expected, abs=FORCE * scale)


@pytest.mark.parametrize("name", MIRRORED)
@given(scene=scenes)
def test_force_without_a_side_of_its_own_mirrors_with_the_scene(name: str, scene: Scene) -> None:
    regions(scene)
    assume(regular(scene))
    expected = MIRROR.turn(tuple(commanded(FORCES[name], scene, STAY).tolist()))
    scale = max(1.0, math.hypot(*expected))
    assert commanded(FORCES[name], scene, MIRROR) == pytest.approx(expected, abs=FORCE * scale)


@given(scene=scenes)
def test_circulation_of_masoud_is_counter_clockwise_in_the_mirror_too(scene: Scene) -> None:
    depths = regions(scene)
    law = nav.Masoud()
    mirrored = np.array(MIRROR.turn(tuple(commanded(law, scene, MIRROR).tolist())))
    apart = commanded(law, scene, STAY) - mirrored
    # Each circulation K_5 d t is there twice: once each way round.
    circulation = np.zeros(2)
    offsets = [np.subtract(scene.position, center) for center in (scene.person, scene.disc)]
    offsets.append(_from_box(scene.position))
    for offset, depth in zip(offsets, depths, strict=True):
        if depth > 0.0:
            circulation += law.detour_gain * np.array([-offset[1], offset[0]])
    assert apart == pytest.approx(2.0 * circulation, abs=1e-9)


def _from_box(place: Pair) -> np.ndarray:
    """Return the offset of a place from the nearest point of the rectangle."""
    along = np.array([math.cos(BOX_HEADING), math.sin(BOX_HEADING)])
    axes = np.array([along, [-along[1], along[0]]])
    inner = axes @ np.subtract(place, BOX)
    return np.asarray((inner - np.clip(inner, [-0.7, -0.3], [0.7, 0.3])) @ axes)


@given(scene=scenes)
def test_pull_and_push_of_masoud_alone_mirror_with_the_scene(scene: Scene) -> None:
    regions(scene)
    law = nav.Masoud(detour_gain=0.0)
    expected = MIRROR.turn(tuple(commanded(law, scene, STAY).tolist()))
    assert commanded(law, scene, MIRROR) == pytest.approx(expected, abs=1e-9)


@pytest.mark.parametrize("name", FORCES)
@given(scene=scenes, factor=st.floats(0.1, 10.0))
def test_force_is_proportional_to_the_gains(name: str, scene: Scene, factor: float) -> None:
    law = FORCES[name]
    gains = {gain: factor * getattr(law, gain) for gain in law.GAIN_NAMES if gain != "gain_ratio"}
    scaled = law.replaced(**gains)
    expected = factor * commanded(law, scene, STAY)
    assert commanded(scaled, scene, STAY) == pytest.approx(expected, rel=1e-9, abs=1e-9)
