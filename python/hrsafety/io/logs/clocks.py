"""Clocks of a bag: stamps and record times, delays, offsets, restarts, simulated time."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

import numpy as np

from hrsafety._arguments import finite
from hrsafety.errors import InvalidParameterError
from hrsafety.io.logs.robot_log import Delay
from hrsafety.plausibility import ResultWarning

__all__ = ["RESTART", "Clocks", "longest_part"]

RESTART = 10**9
"""A clock that goes back by more, in ns, was restarted."""
APART = 0.05
"""Sensors of one robot whose delays differ by more, in s, have different clocks."""
AHEAD = -1e-3
"""A median delay below it, in s, is that of a clock that goes ahead."""


class Clocks:
    """Stamps of all topics.

    Parameters
    ----------
    offsets : mapping of str to float
        What is added to the stamps of topics, in s.
    topics : set of str
        Those of the bag.
    name : str
        Of the file.
    """

    def __init__(self, offsets: Mapping[str, float], topics: Iterable[str], name: str) -> None:
        known = set(topics)
        for topic, value in offsets.items():
            if topic not in known:
                remedy = f"topics: {', '.join(sorted(known))}"
                raise InvalidParameterError("offset", "name topics of the bag", topic, remedy)
            finite(f"offset[{topic!r}]", value)
        self._offsets = {topic: round(1e9 * float(value)) for topic, value in offsets.items()}
        self.name = name
        self._pairs: dict[tuple[str, str], list[tuple[int, int]]] = {}
        self._unstamped: set[str] = set()
        self._stamped: set[str] = set()
        self._ticks: list[tuple[int, int]] = []
        self._window = (-(2**62), 2**62)
        self.lost: dict[str, int] = {}

    def offset(self, topic: str) -> int:
        """Return what is added to the stamps of a topic, in ns."""
        return self._offsets.get(topic, 0)

    def take(self, topic: str, record: int, stamp: int, *, edge: str = "") -> int:
        """Note a message and return its time in ns: the stamp, or the record time without one."""
        if stamp == 0:
            self._unstamped.add(topic)
            return record + self.offset(topic)
        stamp += self.offset(topic)
        self._stamped.add(topic)
        self._pairs.setdefault((topic, edge), []).append((record, stamp))
        return stamp

    def tick(self, record: int, now: int) -> None:
        """Note the simulated clock."""
        self._ticks.append((record, now))

    def kept(self, topic: str, record: int, stamp: int) -> bool:
        """Return whether a message belongs to the part that counts, and has a stamp if its topic has stamps."""
        bare = topic in self._unstamped and topic in self._stamped and stamp == record + self.offset(topic)
        return self._window[0] <= record <= self._window[1] and not bare

    def cut(self, edge: str) -> tuple[ResultWarning, ...]:
        """Keep the longest part between restarts of the stamps of an edge."""
        pairs = next((rows for (_, child), rows in self._pairs.items() if child == edge), [])
        if len(pairs) < 2:
            return ()
        records, stamps = (np.array(each, dtype=np.int64) for each in zip(*pairs, strict=True))
        first, last, parts = longest_part(stamps)
        if parts == 1:
            return ()
        begin = -(2**62) if first == 0 else int(records[first])
        end = 2**62 if last == len(records) - 1 else int(records[last + 1]) - 1
        self._window = (begin, end)
        return restarted(parts, (stamps[last] - stamps[first]) / 1e9)

    def factor(self) -> float | None:
        """Return simulated seconds in a second, ``None`` without a simulated clock."""
        ticks = [each for each in self._ticks if self.kept("", *each)]
        if len(ticks) < 2 or ticks[-1][0] <= ticks[0][0]:
            return None
        return (ticks[-1][1] - ticks[0][1]) / (ticks[-1][0] - ticks[0][0])

    def time_from(self) -> dict[str, str]:
        """Return by topic where times come from."""
        found = dict.fromkeys(self._unstamped, "record time")
        return found | dict.fromkeys(self._stamped, "header.stamp")

    def delays(self, edge: str) -> dict[str, Delay]:
        """Return the delays of topics; of transforms those of one edge, since others may be dated in advance."""
        found = {}
        for topic in dict.fromkeys(topic for topic, _ in self._pairs):
            children = {child for each, child in self._pairs if each == topic}
            child = edge if edge in children else next((each for each in children if each == ""), None)
            if child is None:
                continue
            pairs = [pair for pair in self._pairs[topic, child] if self.kept(topic, *pair)]
            if topic.endswith("tf_static") or not pairs:
                continue
            records, stamps = (np.array(each, dtype=np.int64) for each in zip(*pairs, strict=True))
            late = (self._simulated(records) - stamps) / 1e9
            found[topic] = Delay(float(np.median(late)), float(np.quantile(late, 0.95)), float(late.max()))
        return found

    def _simulated(self, records: np.ndarray) -> np.ndarray:
        """Return record times by the simulated clock, if there is one."""
        if self.factor() is None:
            return records
        ticks = np.array(self._ticks, dtype=np.int64)
        begin = ticks[0]
        moved = np.interp(records - begin[0], ticks[:, 0] - begin[0], (ticks[:, 1] - begin[1]).astype(np.float64))
        return np.asarray(begin[1] + np.rint(moved).astype(np.int64))

    def doubts(self, delays: Mapping[str, Delay], sensors: Iterable[str]) -> tuple[ResultWarning, ...]:
        """Return a warning if clocks of topics differ; ``sensors``: topics of one robot that measure at once."""
        told = [
            f"{topic} has stamps {-each.median:.3g} s after they were recorded"
            for topic, each in delays.items()
            if each.median < AHEAD
        ]
        known = {topic: delays[topic].median for topic in sensors if topic in delays}
        if known and max(known.values()) - min(known.values()) > APART:
            late, early = max(known, key=known.__getitem__), min(known, key=known.__getitem__)
            told.append(f"{late} and {early} are {known[late] - known[early]:.3g} s apart")
        if not told:
            return ()
        message = (
            f"clocks differ: {'; '.join(told)}; positions of people and robot are of different instants; correct it by "
            "offset={topic: seconds}, which are added to its stamps"
        )
        return (ResultWarning("clock_offset", "offset", message),)


def longest_part(stamps: np.ndarray) -> tuple[int, int, int]:
    """Return first and last row of the longest part without a step back by more than 1 s, and how many there are."""
    breaks = np.flatnonzero(np.diff(stamps) < -RESTART) + 1
    begins, ends = np.append(0, breaks), np.append(breaks, len(stamps)) - 1
    longest = int(np.argmax([np.ptp(stamps[begin : end + 1]) for begin, end in zip(begins, ends, strict=True)]))
    return int(begins[longest]), int(ends[longest]), len(begins)


def restarted(parts: int, duration: float) -> tuple[ResultWarning, ...]:
    """Return the warning that a clock was set back."""
    message = (
        f"the clock goes back by more than 1 s {parts - 1} times: the longest of {parts} parts is taken, "
        f"{duration:.4g} s; cut the log to judge the others"
    )
    return (ResultWarning("restarted", "time", message),)
