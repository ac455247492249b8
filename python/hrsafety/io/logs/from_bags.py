"""A bag as a log: frames, poses, velocities, people, delays."""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from hrsafety._arguments import Array
from hrsafety.errors import FileError, Shown
from hrsafety.io.logs.bags import Bag
from hrsafety.io.logs.clocks import Clocks
from hrsafety.io.logs.decoding import Decoder, Transform
from hrsafety.io.logs.frames import Edge, Poses, Tree, unit_quaternions, yaw_of
from hrsafety.io.logs.grids import map_of
from hrsafety.io.logs.people_topics import Layout, PersonMessage, layout_of, sightings
from hrsafety.io.logs.robot_log import Scan
from hrsafety.navigation.maps.static_map import StaticMap
from hrsafety.plausibility import ResultWarning

__all__ = ["BagLog", "lost_doubt"]

Instants = npt.NDArray[np.int64]

_ODOMETRY, _TRANSFORMS = "nav_msgs/msg/Odometry", "tf2_msgs/msg/TFMessage"
_POSES = ("geometry_msgs/msg/PoseStamped", "geometry_msgs/msg/PoseWithCovarianceStamped")
_TWISTS = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
_SCAN, _CLOCK = "sensor_msgs/msg/LaserScan", "rosgraph_msgs/msg/Clock"
_STAMPED = (_SCAN, "nav_msgs/msg/Path")
_GRID = "nav_msgs/msg/OccupancyGrid"
_BASES = ("base_footprint", "base_link", "base")
_COMMANDS = ("cmd_vel", "cmd_vel_stamped", "cmd_vel_safe", "cmd_vel_smoothed", "cmd_vel_nav")


class BagLog:
    """Contents of a bag that a log is made of, all in ns and in the order in which they were recorded.

    Parameters
    ----------
    bag : Bag
        Open.
    robot : str or None
        Frame of the robot, or a topic of its poses.
    people : str or None
        Topic of the people, or its description.
    crowded : bool
        Whether people are looked for in the bag.
    offsets : mapping of str to float
        What is added to the stamps of topics, in s.
    scans : bool
        Whether laser scans are kept.
    name : str
        Of the file.
    """

    def __init__(
        self,
        bag: Bag,
        *,
        robot: str | None,
        people: str | None,
        crowded: bool,
        offsets: Mapping[str, float],
        scans: bool,
        name: str,
    ) -> None:
        self.bag, self.name, self.robot = bag, name, robot
        self.decoder = Decoder(ros1=bag.ros1)
        self.clocks = Clocks(offsets, {each.name for each in bag.topics}, name)
        self.transforms: dict[tuple[str, str, str], list[tuple[int, int, tuple[float, ...]]]] = {}
        self.twists: dict[str, list[tuple[int, int, tuple[float, float, float]]]] = {}
        self.odometry_frames: dict[str, tuple[str, str]] = {}
        self.seen: list[tuple[int, PersonMessage]] = []
        self.reports: list[tuple[int, int]] = []
        self.scans: list[Scan] = []
        self.keep_scans = scans
        self.warnings: tuple[ResultWarning, ...] = ()
        self._grid = b""
        self.people: tuple[Any, Layout] | None = layout_of(bag, people, name) if crowded else None
        self._read()

    # ---- reading --------------------------------------------------------------------------------

    def _read(self) -> None:
        kinds = {
            topic.name: topic.type
            for topic in self.bag.of_type(_ODOMETRY, _TRANSFORMS, *_POSES, *_TWISTS, *_STAMPED, _CLOCK)
        }
        # Costmaps are grids, too: a map is called one.
        kinds |= {each.name: _GRID for each in self.bag.of_type(_GRID) if each.name.split("/")[-1] == "map"}
        if self.people is not None:
            kinds[self.people[0].name] = "people"
        if not any(kind in (_ODOMETRY, _TRANSFORMS, *_POSES) for kind in kinds.values()):
            rule = "hold poses of a robot (Odometry, TFMessage, PoseStamped or PoseWithCovarianceStamped)"
            remedy = "record /tf, /tf_static and /odom"
            raise FileError(self.name, rule, Shown(self.bag.words()), remedy, code="nothing_usable")
        counts = dict.fromkeys(kinds, 0)
        for topic, record, raw in self.bag.messages(list(kinds)):
            counts[topic] += 1
            kind = kinds[topic]
            try:
                self._take(topic, kind, record, raw)
            except (struct.error, UnicodeDecodeError, IndexError, AttributeError, TypeError, ValueError) as error:
                if isinstance(error, FileError):
                    raise
                told = Shown(f"{error} at {record / 1e9:.3f} s")
                place = f"{self.name}, topic {topic}"
                raise FileError(place, f"be messages of type {kind}", told, code="unreadable") from None

        said = {each.name: each.messages for each in self.bag.topics}
        fewer = [f"{name} {count} of {said[name]}" for name, count in counts.items() if count < said[name]]
        if fewer:
            message = (
                f"the bag holds fewer messages than it says ({', '.join(fewer)}): it was cut off, or parts are missing"
            )
            self.warnings += (ResultWarning("missing_messages", "path", message),)

    def _take(self, topic: str, kind: str, record: int, raw: bytes) -> None:
        decoder = self.decoder
        if kind == _TRANSFORMS:
            for each in decoder.transforms(raw):
                self._keep(topic, record, each)
        elif kind == _ODOMETRY:
            pose, twist = decoder.odometry(raw)
            stamp = self._keep(topic, record, pose)
            self.odometry_frames[topic] = (pose.parent, pose.child)
            self.twists.setdefault(topic, []).append((record, stamp, twist))
        elif kind in _POSES:
            self._keep(topic, record, decoder.pose(raw))
        elif kind in _TWISTS:
            stamp, twist = decoder.twist(raw, stamped=kind == _TWISTS[1])
            self.twists.setdefault(topic, []).append((record, self.clocks.take(topic, record, stamp), twist))
        elif kind == _CLOCK:
            self.clocks.tick(record, decoder.clock(raw))
        elif kind == _GRID:
            self._grid = raw
        elif kind == "people":
            self._people(topic, record, raw)
        elif kind == _SCAN and self.keep_scans:
            stamp, frame, settings, distance = decoder.scan(raw)
            stamp = self.clocks.take(topic, record, stamp)
            far = np.array(distance, dtype=np.float64)
            angle = settings[0] + settings[2] * np.arange(len(far), dtype=np.float64)
            valid = np.isfinite(far) & (far >= settings[5]) & (far <= settings[6])
            self.scans.append(Scan(stamp, frame, angle, far, valid))
        else:
            self.clocks.take(topic, record, decoder.stamp(raw))

    def _keep(self, topic: str, record: int, each: Transform) -> int:
        static = topic.endswith("tf_static")
        stamp = each.stamp if static else self.clocks.take(topic, record, each.stamp, edge=each.child)
        self.transforms.setdefault((topic, each.parent, each.child), []).append((record, stamp, each.pose))
        return stamp

    def _people(self, topic: str, record: int, raw: bytes) -> None:
        assert self.people is not None
        kind, layout = self.people[0].type, self.people[1]
        message = self.bag.decoded(kind, raw)
        header = getattr(message, "header", None)
        stamp = 0 if header is None else header.stamp.sec * 10**9 + header.stamp.nanosec
        found = list(sightings(message, layout, f"{self.name}, topic {topic}"))
        stamp = self.clocks.take(topic, record, stamp or (found[0].stamp if found else 0))
        self.reports.append((record, stamp))
        offset = self.clocks.offset(topic)
        for each in found:
            own = each.stamp + offset if each.stamp else stamp
            self.seen.append((record, each._replace(stamp=own)))

    def map(self, frame: str) -> StaticMap | None:
        """Return the last map that was recorded in a frame, ``None`` without one."""
        if not self._grid:
            return None
        message = self.bag.decoded(_GRID, self._grid)
        return map_of(message, f"{self.name}, map") if message.header.frame_id.lstrip("/") == frame else None

    # ---- frames ---------------------------------------------------------------------------------

    def tree(self) -> tuple[Tree, str, str]:
        """Return the frames, that of the robot, and the child of the edge whose stamps are those of the poses."""
        wanted = self.robot or ""
        by_topic = wanted.startswith("/")
        kinds = {each.name: each.type for each in self.bag.topics}
        if by_topic and kinds.get(wanted) not in (_ODOMETRY, *_POSES):
            rule = "be a frame, or a topic of type Odometry, PoseStamped or PoseWithCovarianceStamped"
            raise FileError(
                self.name, f"have robot={wanted!r} which must {rule}", Shown(self.bag.words()), code="robot"
            )
        edges: dict[str, Edge] = {}
        for (topic, parent, child), rows in self.transforms.items():
            if kinds[topic] == _TRANSFORMS:
                self._add(edges, self._edge(topic, parent, child, rows))
        base = "" if by_topic else wanted
        names = {name for each in (*edges.values(),) for name in (each.parent, each.child)}
        for topic, (parent, child) in self.odometry_frames.items():
            if by_topic and topic != wanted:
                continue
            rows = self.transforms[topic, parent, child]
            other = edges.get(child)
            if other is not None and other.topic in self.odometry_frames and not by_topic:
                shown = Shown(f"{other.topic} and {topic}")
                remedy = f'name one of them: robot="{topic}"'
                raise FileError(self.name, f"hold one odometry of {child}", shown, remedy, code="several_pose_topics")
            if by_topic or other is None:
                edges[child] = self._edge(topic, parent, child or "base_link", rows)
            base = base or child
        for (topic, parent, _), rows in self.transforms.items():
            if kinds[topic] in _POSES and (topic == wanted or not (base or names)):
                base = base if base and not by_topic else "robot"
                edges[base] = self._edge(topic, parent, base, rows)
        moving = {child for child, edge in edges.items() if not edge.static}
        base = base or next((each for each in _BASES if each in names), "")
        if not base or base not in {name for each in edges.values() for name in (each.parent, each.child)}:
            tree = Tree(edges=edges)
            rule = f"hold a frame {base}" if base else "hold a frame of the robot, such as base_link"
            remedy = 'name it: robot="base_link"'
            raise FileError(self.name, rule, Shown(f"the frames {tree.words()}"), remedy, code="robot_frame_needed")
        tree = Tree(edges=edges)
        chain = [each for each in tree.up(base) if each in moving]
        if not chain:
            found = Shown(f"the frames {tree.words()}")
            raise FileError(
                self.name, f"hold poses of {base} over time", found, 'name it: robot="base_link"', code="robot"
            )
        odometric = {parent for parent, _ in self.odometry_frames.values()}
        own = next(
            (each for each in chain if edges[each].parent in odometric or "odom" in edges[each].parent.lower()),
            chain[0],
        )
        above = chain[chain.index(own) + 1 :]
        return Tree(edges=edges, held=frozenset(above)), base, own

    def _add(self, edges: dict[str, Edge], edge: Edge) -> None:
        other = edges.get(edge.child)
        if other is None or other.static:
            edges[edge.child] = edge
        elif not edge.static:
            shown = Shown(f"{other.parent} ({other.topic}) and {edge.parent} ({edge.topic})")
            raise FileError(f"{self.name}, frame {edge.child}", "have one parent", shown, code="frames")

    def _edge(self, topic: str, parent: str, child: str, rows: Sequence[tuple[int, int, tuple[float, ...]]]) -> Edge:
        static = topic.endswith("tf_static")
        kept = rows[-1:] if static else [row for row in rows if self.clocks.kept(topic, row[0], row[1])]
        if not kept:
            kept = rows[-1:]
        stamp = np.array([row[1] for row in kept], dtype=np.int64)
        seven = np.array([row[2] for row in kept], dtype=np.float64)
        place = f"topic {topic}, {parent} to {child}"
        quaternion = unit_quaternions(seven[:, 3:], self.name, (place for _ in kept))
        finite = np.asarray(np.isfinite(seven).all(axis=1))
        if not finite.all():
            self.clocks.lost[f"{parent} to {child}"] = int((~finite).sum())
        if not finite.any():
            raise FileError(f"{self.name}, {place}", "hold finite numbers", Shown("none"), code="unreadable_number")
        # Of equal stamps the last one counts, as for those who look it up.
        order = np.argsort(stamp, kind="stable")
        order = order[finite[order]]
        last = np.append(stamp[order][1:] != stamp[order][:-1], True)
        order = order[last]
        return Edge(
            parent=parent,
            child=child,
            topic=topic,
            stamp=stamp[order],
            translation=seven[order, :3],
            quaternion=quaternion[order],
            static=static,
        )

    def poses(self, tree: Tree, base: str, frame: str, instants: Instants) -> Poses:
        """Return poses of the robot, or an error with both trees if no chain leads to the frame."""
        found = tree.poses(base, frame, instants)
        if found is None:
            names = ", ".join(sorted({each.parent for each in tree.edges.values() if each.parent not in tree.edges}))
            remedy = f'give the frame that is wanted: frame="{tree.up(base)[-1]}" (roots: {names})'
            shown = Shown(f"the trees {tree.words()}")
            raise FileError(self.name, f"lead from {base} to {frame}", shown, remedy, code="no_chain")
        return found

    # ---- results --------------------------------------------------------------------------------

    def robot_poses(self, tree: Tree, base: str, own: str, frame: str) -> tuple[Instants, Array, Array]:
        """Return instants, positions (n, 2) and headings (n,) of the robot."""
        instants = tree.edges[own].stamp
        found = self.poses(tree, base, frame, instants)
        known = found.known
        if not known.any():
            shown = Shown(f"the trees {tree.words()}")
            raise FileError(self.name, f"lead from {base} to {frame} at some instant", shown, code="no_chain")
        return instants[known], found.translation[known, :2], yaw_of(found.rotation[known])

    def twist_at(self, instants: Instants) -> Array:
        """Return the last velocity stored at or before each instant, (n, 3); NaN without one."""
        rows = next(
            (
                [row for row in self.twists[topic] if self.clocks.kept(topic, row[0], row[1])]
                for topic in self.odometry_frames
                if not (self.robot or "").startswith("/") or topic == self.robot
            ),
            [],
        )
        empty = np.full((len(instants), 3), np.nan)
        if not rows:
            return empty
        stamp = np.array([row[1] for row in rows], dtype=np.int64)
        order = np.argsort(stamp, kind="stable")
        values = np.array([row[2] for row in rows], dtype=np.float64)[order]
        last = np.searchsorted(stamp[order], instants, "right") - 1
        return np.where((last >= 0)[:, None], values[np.maximum(last, 0)], empty)

    def commands(self) -> list[tuple[int, tuple[float, float, float]]]:
        """Return times in ns and velocities that were asked for, of the topic that is nearest to the drive."""
        found = {topic.name.strip("/"): topic.name for topic in self.bag.of_type(*_TWISTS)}
        name = next((found[each] for each in _COMMANDS if each in found), next(iter(found.values()), ""))
        rows = [row for row in self.twists.get(name, ()) if self.clocks.kept(name, row[0], row[1])]
        return sorted((stamp, twist) for _, stamp, twist in rows)

    def people_rows(self, tree: Tree, frame: str) -> tuple[list[str], Instants, Array, Array, int, int, list[int]]:
        """Return names, instants, positions and velocities in a frame, counts of rows lost and predicted, reports."""
        topic = "" if self.people is None else self.people[0].name
        rows = [each for record, each in self.seen if self.clocks.kept(topic, record, each.stamp)]
        reports = [stamp for record, stamp in self.reports if self.clocks.kept(topic, record, stamp)]
        names = [each.name for each in rows]
        instants = np.array([each.stamp for each in rows], dtype=np.int64)
        place = np.array([each.position for each in rows], dtype=np.float64).reshape(-1, 3)
        speed = np.array([each.velocity for each in rows], dtype=np.float64).reshape(-1, 3)
        for source in sorted({each.frame for each in rows}):
            if source in ("", frame):
                continue
            some = np.array([each.frame == source for each in rows])
            found = self.poses(tree, source, frame, instants[some])
            moved = np.einsum("nij,nj->ni", found.rotation, place[some]) + found.translation
            place[some] = np.where(found.known[:, None], moved, np.nan)
            turned = np.where(np.isfinite(speed[some]), speed[some], 0.0)
            turned = np.einsum("nij,nj->ni", found.rotation, turned)
            speed[some] = np.where(np.isfinite(speed[some]).all(axis=1)[:, None], turned, np.nan)
        predicted = np.array([each.predicted for each in rows], dtype=np.bool_)
        lost = ~np.isfinite(place[:, :2]).all(axis=1) & ~predicted
        keep = ~(lost | predicted)
        kept = [name for name, good in zip(names, keep.tolist(), strict=True) if good]
        return (
            kept,
            instants[keep],
            place[keep, :2],
            speed[keep, :2],
            int(lost.sum()),
            int(predicted.sum()),
            sorted(reports),
        )


def lost_doubt(lost: int, predicted: int, total: int) -> tuple[ResultWarning, ...]:
    """Return a warning of positions that are missing, or that a tracker made up."""
    if not lost + predicted:
        return ()
    parts = [f"{lost} of {total} positions of people are not finite or have no pose of the robot"] if lost else []
    parts += [f"{predicted} of {total} are predictions of people who were occluded"] if predicted else []
    message = f"{' and '.join(parts)}: these people are not seen then, and may be anywhere within reach"
    return (ResultWarning("missing_positions", "people", message),)
