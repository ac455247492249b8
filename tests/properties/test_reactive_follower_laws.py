"""Laws against mpmath, rays and collision vectors against other ways to compute them."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from hrsafety import reactive

mpmath = pytest.importorskip("mpmath")

# Rounding of an exponential of a few units times some 10 N.
ROUNDING = 1e-13
# A polygon of so many corners lies at most 9e-7 m inside a disc of 3 m; seen at an angle that is more,
# but then a turn by TURN changes the distance by more than this too, from APART on.
CORNERS, POLYGON, TURN, APART = 4096, 2e-6, 1e-4, 0.02
# A ray that grazes a disc of 3 m from 9 m meets it so much earlier after a turn by TURN.
GRAZING = 0.1

numbers = st.floats(-3.0, 3.0)
positive = st.floats(0.05, 3.0)


def spring_and_damper(law: reactive.VirtualImpedance, distance: float, speed: float) -> tuple[Any, Any]:
    """Return both parts in 40 digits, written from the equations."""
    with mpmath.workdps(40):
        k0, d0, rho, mu = (
            mpmath.mpf(value) for value in (law.stiffness, law.damping, law.safe_distance, law.speed_limit)
        )
        c, v = mpmath.mpf(distance), mpmath.mpf(speed)
        if law.form == "conventional":
            return (k0 * (rho - c), d0 * v) if c < rho else (mpmath.mpf(0), mpmath.mpf(0))
        k_ref = mpmath.mpf(law.reference_stiffness or math.e * law.stiffness)
        d_ref = mpmath.mpf(law.reference_damping or law.damping / math.e)
        alpha, beta = rho / (2 * mpmath.log(k_ref / k0)), mu / (2 * mpmath.log(d0 / d_ref))
        damper = d_ref * mpmath.exp(v / beta) * (mu - v) if v <= mu or not law.clamp else mpmath.mpf(0)
        return k_ref * mpmath.exp(-c / alpha) * c, damper


@given(
    form=st.sampled_from(["conventional", "active"]),
    gains=st.tuples(st.floats(5.0, 100.0), st.floats(1.0, 30.0)),
    references=st.tuples(st.floats(1.1, 5.0), st.floats(1.1, 5.0)),
    limits=st.tuples(st.floats(0.2, 2.0), st.floats(0.2, 2.0)),
    distance=st.floats(0.0, 3.0),
    speed=st.floats(0.0, 1.5),
    clamp=st.booleans(),
)
@settings(max_examples=200)
def test_laws_are_their_equations(
    form: Any,
    gains: tuple[float, float],
    references: tuple[float, float],
    limits: tuple[float, float],
    distance: float,
    speed: float,
    clamp: bool,
) -> None:
    law = reactive.VirtualImpedance(
        form=form,
        stiffness=gains[0],
        damping=gains[1],
        reference_stiffness=gains[0] * references[0],
        reference_damping=gains[1] / references[1],
        safe_distance=limits[0],
        speed_limit=limits[1],
        clamp=clamp,
    )
    spring, damper = spring_and_damper(law, distance, speed)
    scale = 1.0 + 20.0 * max(abs(float(spring)), abs(float(damper)))
    assert abs(float(law.spring_force(distance)) - float(spring)) <= ROUNDING * scale
    assert abs(float(law.damping_force(distance, speed)) - float(damper)) <= ROUNDING * scale * (1.0 + 20.0 * speed)


@given(st.floats(0.05, 2.0), st.floats(1.05, 6.0))
def test_spring_peaks_at_its_scale(safe_distance: float, reference: float) -> None:
    law = reactive.VirtualImpedance(safe_distance=safe_distance, reference_stiffness=40.0 * reference)
    alpha = law.distance_scale
    peak = 40.0 * reference * alpha / math.e
    grid = np.linspace(0.0, 6.0 * alpha, 1001)
    assert law.spring_force(grid).max() <= peak * (1.0 + 1e-12)
    assert float(law.spring_force(alpha)) == pytest.approx(peak, rel=1e-12)
    half = 0.5 * safe_distance
    assert float(law.spring_force(half)) == pytest.approx(40.0 * half, rel=1e-12)


def corners(shape: Any) -> np.ndarray:
    """Return the corners of a shape, a disc as a polygon."""
    if isinstance(shape, reactive.Cylinder):
        turn = np.linspace(0.0, 2.0 * np.pi, CORNERS, endpoint=False)
        return np.asarray(shape.center) + shape.radius * np.column_stack([np.cos(turn), np.sin(turn)])
    if isinstance(shape, reactive.Wall):
        return np.array([shape.start, shape.end])
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    c, s = math.cos(shape.angle), math.sin(shape.angle)
    turned: np.ndarray = np.asarray(shape.center) + (0.5 * signs * shape.size) @ np.array([[c, s], [-s, c]])
    return turned


def first_crossing(shapes: list[Any], origin: np.ndarray, angle: float) -> float:
    """Return the distance to the nearest edge along a ray, edge by edge by solving 2 x 2 systems."""
    direction = np.array([math.cos(angle), math.sin(angle)])
    best = math.inf
    for shape in shapes:
        points = corners(shape)
        edges = np.roll(points, -1, axis=0) - points
        to = points - origin
        cross = direction[0] * edges[:, 1] - direction[1] * edges[:, 0]
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):  # an edge along the ray
            along = (to[:, 0] * edges[:, 1] - to[:, 1] * edges[:, 0]) / cross
            share = (to[:, 0] * direction[1] - to[:, 1] * direction[0]) / cross
        hit = (along >= 0.0) & (share >= 0.0) & (share <= 1.0)
        best = min(best, float(along[hit].min(initial=math.inf)))
    return best


def inside(shape: Any, point: np.ndarray, margin: float) -> bool:
    if isinstance(shape, reactive.Wall):
        along = np.subtract(shape.end, shape.start)
        share = np.clip((point - shape.start) @ along / (along @ along), 0.0, 1.0)
        return bool(np.linalg.norm(point - shape.start - share * along) < margin)
    if isinstance(shape, reactive.Cylinder):
        return bool(np.linalg.norm(point - shape.center) < shape.radius + margin)
    c, s = math.cos(shape.angle), math.sin(shape.angle)
    own = np.array([[c, s], [-s, c]]) @ (point - shape.center)
    return bool(np.all(np.abs(own) < 0.5 * np.asarray(shape.size) + margin))


boxes = st.builds(
    lambda x, y, w, h, angle: reactive.Box(center=(x, y), size=(w, h), angle=angle),
    numbers,
    numbers,
    positive,
    positive,
    numbers,
)
discs = st.builds(lambda x, y, r: reactive.Cylinder(center=(x, y), radius=r), numbers, numbers, positive)
walls = st.builds(
    lambda a, b, c, d: reactive.Wall(start=(a, b), end=(c, d)), numbers, numbers, numbers, numbers
).filter(lambda wall: math.dist(wall.start, wall.end) > 0.05)


@given(st.lists(st.one_of(boxes, discs, walls), min_size=1, max_size=3), numbers, numbers, st.floats(-4.0, 4.0))
@settings(max_examples=150, deadline=None)
def test_rays_meet_the_nearest_edge(shapes: list[Any], x: float, y: float, angle: float) -> None:
    origin = np.array([x, y])
    found = float(reactive.sonar.cast_rays(shapes, [(x, y)], [angle])[0])
    if any(inside(shape, origin, APART) for shape in shapes):
        if any(inside(shape, origin, -APART) for shape in shapes):
            assert found == 0.0
        return
    # Where a ray grazes, neighbors decide differently: both must be near one of them.
    near = [first_crossing(shapes, origin, angle + turn) for turn in (-TURN, 0.0, TURN)]
    if math.isinf(found):
        assert any(math.isinf(each) for each in near)
    elif all(math.isfinite(each) for each in near) and max(near) - min(near) < 1e-2:
        assert abs(found - near[1]) < max(near) - min(near) + POLYGON
    else:
        assert min(near) - GRAZING <= found


@given(st.lists(st.one_of(boxes, discs, walls), min_size=1, max_size=3), st.floats(-3.0, 3.0), st.integers(1, 30))
@settings(max_examples=100, deadline=None)
def test_a_reading_is_the_nearest_of_its_rays(shapes: list[Any], heading: float, rays: int) -> None:
    sonar = reactive.Sonar(rays=rays, least_range=0.0, range_noise=0.0)
    found = sonar.readings(shapes, (0.0, 0.0, heading))
    half = 0.5 * sonar.beam_width
    offsets = np.linspace(-half, half, rays) if rays > 1 else np.zeros(1)
    c, s = math.cos(heading), math.sin(heading)
    for place, axis, reading in zip(sonar.mounts.position, sonar.mounts.axis, found, strict=True):
        at = (c * place[0] - s * place[1], s * place[0] + c * place[1])
        along = reactive.sonar.cast_rays(shapes, np.tile(at, (rays, 1)), heading + axis + offsets)
        expected = float(along.min())
        if expected > sonar.most_range:
            expected = math.inf
        # A ray that grazes may fall to either side by rounding of its direction.
        assert (
            reading == pytest.approx(expected, abs=1e-9)
            or abs(expected - sonar.most_range) < 1e-9
            or grazes(shapes, at, heading + axis + offsets)
        )


def grazes(shapes: list[Any], at: tuple[float, float], angles: np.ndarray) -> bool:
    """Return whether a turn by 1e-9 rad changes what a ray meets by much."""
    places = np.tile(at, (len(angles), 1))
    hits = [reactive.sonar.cast_rays(shapes, places, angles + turn) for turn in (-1e-9, 1e-9)]
    with np.errstate(invalid="ignore"):
        return bool(np.any(~(np.abs(hits[0] - hits[1]) < 1e-6) & (np.isfinite(hits[0]) | np.isfinite(hits[1]))))


@given(st.tuples(numbers, numbers), st.tuples(numbers, numbers))
def test_collision_vector_is_the_least_squares_foot(one: tuple[float, float], other: tuple[float, float]) -> None:
    first, second = np.array(one), np.array(other)
    along = second - first
    if np.linalg.norm(along) < 1e-2:
        return
    share = np.linalg.lstsq(along[:, np.newaxis], -first, rcond=None)[0][0]
    np.testing.assert_allclose(
        reactive.follower.collision_vector(one, other, clamp=False), first + share * along, atol=1e-9
    )
    clamped = first + min(max(share, 0.0), 1.0) * along
    np.testing.assert_allclose(reactive.follower.collision_vector(one, other), clamped, atol=1e-9)


def test_deviations_are_scipys_on_the_grid() -> None:
    interpolate = pytest.importorskip("scipy.interpolate")
    ranges, bearings = np.array([1.0, 2.0, 3.0, 4.0]), np.radians([0.0, 30.0, 60.0])
    table = np.array([[0.02, 0.03, 0.07], [0.05, 0.08, 0.13], [0.09, 0.12, 0.37], [0.48, 0.20, 0.43]])
    own = interpolate.RegularGridInterpolator((ranges, bearings), table)
    generator = np.random.default_rng(1)
    points = np.column_stack([generator.uniform(1.0, 4.0, 300), generator.uniform(0.0, bearings[-1], 300)])
    np.testing.assert_allclose(reactive.follower.fix_deviations(*points.T).range, own(points), atol=1e-12)
    np.testing.assert_array_equal(
        reactive.follower.fix_deviations(points[:, 0], -points[:, 1]).bearing,
        reactive.follower.fix_deviations(points[:, 0], points[:, 1]).bearing,
    )
