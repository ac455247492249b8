"""Effective masses on one core: a million poses in one call, the same from numpy and from pinocchio.

Every bench records poses per second of processor time and the largest relative difference of the masses, taken in the
same run. Nothing here asserts a time; agreement is asserted.
"""

from __future__ import annotations

import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from hrsafety import arms

ARM = arms.Arm.example()
POSES = 1_000_000
PEER_POSES = 2_000
ALONG = np.array([0.6, -0.48, 0.64])
AGREE = 1e-9  # relative


def drawn(count: int) -> np.ndarray:
    return np.random.default_rng(18).uniform(-2.0, 2.0, (count, len(ARM.joint_names)))


def own(poses: np.ndarray, threads: int = 1) -> np.ndarray:
    return ARM.effective_mass(poses, link="tool", direction=ALONG, threads=threads).mass


def processor_time(work: Callable[[], Any]) -> tuple[float, Any]:
    started = time.process_time()
    result = work()
    return time.process_time() - started, result


def numpy_masses(poses: np.ndarray) -> np.ndarray:
    """Masses of the example by stacked matrices: all poses at once, a link after the other."""
    links, joints = _chain()
    count = len(poses)
    rotation, origin = np.broadcast_to(np.eye(3), (count, 3, 3)), np.zeros((count, 3))
    axes, places, bodies = [], [], []
    for index, (offset, axis) in enumerate(joints):
        origin = origin + rotation @ offset
        axes.append(rotation @ axis)
        places.append(origin)
        rotation = rotation @ _turned(axis, poses[:, index])
        mass, center, moments = links[index]
        spot = origin + rotation @ center
        inertia = np.einsum("nij,j,nkj->nik", rotation, moments, rotation)
        bodies.append((mass, spot, inertia))
    tip = origin + rotation @ np.array([0.0, 0.09, 0.0])
    masses = np.zeros((count, 6, 6))
    for index, (mass, spot, inertia) in enumerate(bodies):
        linear = np.stack([np.cross(axes[each], spot - places[each]) for each in range(index + 1)], axis=2)
        angular = np.stack(axes[: index + 1], axis=2)
        inner = mass * linear.transpose(0, 2, 1) @ linear + angular.transpose(0, 2, 1) @ inertia @ angular
        masses[:, : index + 1, : index + 1] += inner
    jacobian = np.stack([np.cross(axis, tip - place) for axis, place in zip(axes, places, strict=True)], axis=2)
    along = np.einsum("i,nij->nj", ALONG, jacobian)
    return 1.0 / np.einsum("nj,nj->n", along, np.linalg.solve(masses, along[..., np.newaxis])[..., 0])


def _turned(axis: np.ndarray, angle: np.ndarray) -> np.ndarray:
    cross = np.array([[0, -axis[2], axis[1]], [axis[2], 0, -axis[0]], [-axis[1], axis[0], 0]])
    sine, cosine = np.sin(angle)[:, np.newaxis, np.newaxis], np.cos(angle)[:, np.newaxis, np.newaxis]
    return np.eye(3) + sine * cross + (1.0 - cosine) * (cross @ cross)


def _chain() -> tuple[list[Any], list[Any]]:
    """Return masses, centers and moments of the links of the example, and origins and axes of its joints."""
    import xml.etree.ElementTree as Xml

    def numbers(text: str) -> np.ndarray:
        return np.array([float(each) for each in text.split()])

    root = Xml.fromstring(ARM.urdf)
    links = []
    for each in root.iter("inertial"):
        origin, mass, inertia = each.find("origin"), each.find("mass"), each.find("inertia")
        moments = np.array([float(inertia.attrib[name]) for name in ("ixx", "iyy", "izz")])
        links.append((float(mass.attrib["value"]), numbers(origin.attrib["xyz"]), moments))
    joints = [
        (numbers(each.find("origin").attrib["xyz"]), numbers(each.find("axis").attrib["xyz"]))
        for each in root.iter("joint")
        if each.attrib["type"] != "fixed"
    ]
    return links, joints


def pinocchio_masses(poses: np.ndarray) -> np.ndarray:
    pin = pytest.importorskip("pinocchio", reason="pin is not installed")
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arm.urdf"
        path.write_text(ARM.urdf, encoding="utf-8")
        model = pin.buildModelFromUrdf(str(path))
    data = model.createData()
    frame = model.getFrameId("tool")
    found = np.empty(len(poses))
    for index, pose in enumerate(poses):
        jacobian = pin.computeFrameJacobian(model, data, pose, frame, pin.LOCAL_WORLD_ALIGNED)[:3]
        upper = pin.crba(model, data, pose)
        along = ALONG @ jacobian
        masses = np.triu(upper) + np.triu(upper, 1).T
        found[index] = 1.0 / (along @ np.linalg.solve(masses, along))
    return found


def test_a_million_poses_in_one_call(benchmark: Any) -> None:
    poses = drawn(POSES)
    spent, found = processor_time(lambda: own(poses))
    benchmark.pedantic(own, args=(poses,), rounds=3)
    benchmark.extra_info["us_of_processor_per_pose"] = 1e6 * spent / POSES
    assert np.isfinite(found).all()


def test_all_cores(benchmark: Any) -> None:
    poses = drawn(POSES)
    assert np.array_equal(own(poses[:10_000], threads=2), own(poses[:10_000]))
    benchmark.pedantic(own, args=(poses, 2), rounds=3)


@pytest.mark.parametrize("peer", [numpy_masses, pinocchio_masses], ids=["numpy", "pinocchio"])
def test_peers_agree(benchmark: Any, peer: Callable[[np.ndarray], np.ndarray]) -> None:
    poses = drawn(PEER_POSES)
    spent, expected = processor_time(lambda: peer(poses))
    own_spent, found = processor_time(lambda: own(poses))
    difference = float(np.max(np.abs(found / expected - 1.0)))
    benchmark.extra_info |= {
        "us_of_processor_per_pose": 1e6 * own_spent / PEER_POSES,
        "us_of_processor_per_pose_of_peer": 1e6 * spent / PEER_POSES,
        "largest_relative_difference": difference,
    }
    assert difference < AGREE
    benchmark.pedantic(own, args=(poses,), rounds=3)
