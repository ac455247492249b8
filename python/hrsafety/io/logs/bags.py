"""Bags of ROS 1 and 2 as topics and raw messages in the order of their record times."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

from hrsafety.errors import FileError, MissingExtraError, Shown
from hrsafety.io.logs.definitions import DEFINITIONS

__all__ = ["Bag", "Topic", "kind_of_bag", "opened"]

_MARKS = {b"#ROSBAG V": "rosbag1", b"\x89MCAP0": "mcap", b"SQLite format 3\0": "sqlite3"}
_TITLES = {"rosbag1": "rosbag1", "mcap": "rosbag2-mcap", "sqlite3": "rosbag2-sqlite3"}


class Topic(NamedTuple):
    """A topic of a bag.

    Attributes
    ----------
    name, type : str
        As in the bag; types as ``package/msg/Name``.
    messages : int
        How many it holds.
    """

    name: str
    type: str
    messages: int


def kind_of_bag(head: bytes) -> str | None:
    """Return what kind of bag a file is by its first bytes, ``None`` if it is none."""
    return next((kind for mark, kind in _MARKS.items() if head.startswith(mark)), None)


class Bag:
    """An open bag.

    Attributes
    ----------
    format : str
        ``"rosbag1"``, ``"rosbag2-sqlite3"`` or ``"rosbag2-mcap"``.
    ros1 : bool
        Whether its messages are serialized as ROS 1 does.
    topics : list of Topic
        In the order of their names.
    """

    def __init__(self, readers: Sequence[Any], form: str, name: str) -> None:
        self._readers = readers
        self._name = name
        self._stores: dict[str, Any] = {}
        self.format = form
        self.ros1 = form == "rosbag1"
        counts: dict[tuple[str, str], int] = {}
        for each in self._connections():
            key = (each.topic, each.msgtype)
            counts[key] = counts.get(key, 0) + each.msgcount
        self.topics = [Topic(*key, count) for key, count in sorted(counts.items())]

    def of_type(self, *types: str) -> list[Topic]:
        """Return the topics of some types that hold messages."""
        return [topic for topic in self.topics if topic.type in types and topic.messages]

    def words(self) -> str:
        """Return all topics with their types in a line."""
        return ", ".join(f"{each.name} ({each.type}, {each.messages})" for each in self.topics) or "no topics"

    def messages(self, topics: Sequence[str]) -> Iterator[tuple[str, int, bytes]]:
        """Yield topic, record time in ns and bytes of the messages of some topics, sorted by record time."""
        wanted = set(topics)
        for reader in self._readers:
            chosen = [each for each in reader.connections if each.topic in wanted]
            if chosen:
                for connection, record, raw in reader.messages(chosen):
                    yield connection.topic, record, bytes(raw)

    def decoded(self, kind: str, raw: bytes) -> Any:
        """Return a message as an object with its fields, by the definition in the bag or the one that comes along."""
        if kind not in self._stores:
            self._stores[kind] = self._store_of(kind)
        store = self._stores[kind]
        try:
            return store.deserialize_ros1(raw, kind) if self.ros1 else store.deserialize_cdr(raw, kind)
        except Exception as error:  # the bytes do not have the fields of the definition: anything
            told = Shown(str(error) or type(error).__name__)
            place = f"{self._name}, type {kind}"
            raise FileError(place, "be messages of their definition", told, code="unreadable") from None

    def _connections(self) -> Iterator[Any]:
        for reader in self._readers:
            yield from reader.connections

    def _store_of(self, kind: str) -> Any:
        """Return the definitions of a type, those in the bag before those that come along."""
        from rosbags.typesys import Stores, get_types_from_idl, get_types_from_msg, get_typestore

        own = next((each.msgdef for each in self._connections() if each.msgtype == kind and each.msgdef.data), None)
        if own is not None:
            store = get_typestore(Stores.EMPTY)
            if own.format.name == "IDL":
                mark = "=" * 80 + "\n"
                for part in own.data.split(mark) if mark in own.data else [own.data]:
                    store.register(get_types_from_idl(part.partition("\n")[2] if part.startswith("IDL: ") else part))
            else:
                store.register(get_types_from_msg(own.data, kind))
            return store
        store = get_typestore(Stores.ROS1_NOETIC if self.ros1 else Stores.ROS2_HUMBLE)
        for name, text in DEFINITIONS.get(kind, {}).items():
            if name not in store.fielddefs:
                store.register(get_types_from_msg(text, name))
        if kind not in store.fielddefs:
            remedy = "convert it into a bag that holds the definitions (rosbags-convert, ros2 bag convert)"
            place, found = f"{self._name}, type {kind}", Shown("no definition")
            raise FileError(place, "be defined in the bag", found, remedy, code="no_definition")
        return store


@contextmanager
def opened(path: Path) -> Iterator[Bag]:
    """Open a bag: a file, or a folder of ROS 2 with or without its ``metadata.yaml``.

    Parameters
    ----------
    path : Path
        Which.

    Yields
    ------
    Bag
        Open until the block ends.

    Raises
    ------
    FileError
        If it cannot be read.
    MissingExtraError
        If rosbags is not installed.
    """
    if importlib.util.find_spec("rosbags") is None:
        raise MissingExtraError("bags need rosbags: pip install rosbags")
    try:
        readers, form = _readers(path)
        begun = []
        try:
            for reader in readers:
                reader.open()
                begun.append(reader)
            yield Bag(readers, form, path.name)
        finally:
            for reader in begun:
                reader.close()
    except (FileError, MissingExtraError):
        raise
    except (KeyboardInterrupt, GeneratorExit):
        raise
    except Exception as error:  # what readers of damaged files raise: anything
        told = " ".join(str(error).split())[:200] or type(error).__name__
        remedy = "a recording that was cut off: ros2 bag reindex, or rosbag reindex"
        raise FileError(path.name, "be a readable bag", Shown(told), remedy, code="unreadable") from None


def _readers(path: Path) -> tuple[list[Any], str]:
    from rosbags.rosbag1 import Reader as Reader1
    from rosbags.rosbag2 import Reader as Reader2

    if path.is_dir() and (path / "metadata.yaml").is_file():
        text = (path / "metadata.yaml").read_text("utf-8", errors="replace")
        return [Reader2(path)], _TITLES["mcap" if "mcap" in text.partition("storage_identifier")[2][:20] else "sqlite3"]
    files = sorted(each for each in path.iterdir() if each.is_file()) if path.is_dir() else [path]
    kinds = []
    for each in files:
        with each.open("rb") as file:
            kinds.append(kind_of_bag(file.read(16)))
    found = [(each, kind) for each, kind in zip(files, kinds, strict=True) if kind is not None]
    if not found or len({kind for _, kind in found}) > 1:
        names = ", ".join(each.name for each in files[:6]) or "nothing"
        raise FileError(path.name, "hold a bag (.bag, .db3, .mcap)", Shown(names), code="unknown_format")
    kind = found[0][1]
    if kind == "rosbag1":
        return [Reader1(each) for each, _ in found], _TITLES[kind]
    plugin = Reader2.STORAGE_PLUGINS[".mcap" if kind == "mcap" else ".db3"]
    return [_Storage(plugin(each)) for each, _ in found], _TITLES[kind]


class _Storage:
    """A storage file of ROS 2 by itself, whatever its name."""

    def __init__(self, storage: Any) -> None:
        self._storage = storage
        self.open, self.close, self.messages = storage.open, storage.close, storage.messages

    @property
    def connections(self) -> list[Any]:
        """Topics of the file."""
        found: list[Any] = self._storage.connections
        return found
