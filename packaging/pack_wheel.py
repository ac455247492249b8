"""Pack wheels again, smaller, with the same files in them: ``python packaging/pack_wheel.py dist/*.whl``.

Zopfli writes the same format as zlib and searches longer for it. Files, their times and places stay as they are, and so
does the record of their hashes; the same wheel gives the same bytes. Needs ``zopfli``.
"""

from __future__ import annotations

import io
import struct
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path

Deflate = Callable[[bytes], bytes]

LOCAL = struct.Struct("<4s5H3I2H")
CENTRAL = struct.Struct("<4s6H3I5H2I")
END = struct.Struct("<4s4H2IH")
VERSION = 20
UNIX = 3 << 8
NAME_IN_UTF8 = 0x800


def zopfli(content: bytes) -> bytes:
    """Deflate by Zopfli: as many blocks as pay, without the frame of zlib around them."""
    from zopfli.zlib import compress

    return compress(content, numiterations=15, blocksplittingmax=0)[2:-4]


def pack(wheel: Path, deflate: Deflate = zopfli) -> tuple[int, int]:
    """Pack a wheel again in its place; returns its size before and after, in bytes."""
    with zipfile.ZipFile(wheel) as source:
        files = [(each, source.read(each)) for each in source.infolist()]
    archive = packed(files, deflate)
    with zipfile.ZipFile(io.BytesIO(archive)) as written:
        contents = [(each.filename, written.read(each)) for each in written.infolist()]
    if contents != [(file.filename, content) for file, content in files]:
        raise RuntimeError(f"{wheel}: packed again, it would hold other files")
    before = wheel.stat().st_size
    if len(archive) < before:
        new = wheel.with_suffix(".packed")
        new.write_bytes(archive)
        new.replace(wheel)
    return before, wheel.stat().st_size


def packed(files: list[tuple[zipfile.ZipInfo, bytes]], deflate: Deflate) -> bytes:
    """Bytes of an archive with these files in their order."""
    archive, directory = bytearray(), bytearray()
    for file, content in files:
        name = file.filename.encode()
        flags = 0 if name.isascii() else NAME_IN_UTF8
        body, method = deflate(content), zipfile.ZIP_DEFLATED
        if len(body) >= len(content):
            body, method = content, zipfile.ZIP_STORED
        year, month, day, hour, minute, second = file.date_time
        time, date = hour << 11 | minute << 5 | second // 2, (year - 1980) << 9 | month << 5 | day
        shared = (VERSION, flags, method, time, date, file.CRC, len(body), len(content), len(name), 0)
        place = len(archive)
        archive += LOCAL.pack(b"PK\3\4", *shared) + name + body
        directory += CENTRAL.pack(b"PK\1\2", UNIX | VERSION, *shared, 0, 0, 0, file.external_attr, place) + name
    end = END.pack(b"PK\5\6", 0, 0, len(files), len(files), len(directory), len(archive), 0)
    return bytes(archive + directory + end)


def main() -> None:
    """Pack the wheels of the command line."""
    for name in sys.argv[1:]:
        before, after = pack(Path(name))
        print(f"{name}: {before / 1e6:.2f} MB before, {after / 1e6:.2f} MB packed")


if __name__ == "__main__":
    main()
