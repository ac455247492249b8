"""Wheels that are packed again hold the same files, in less room."""

import base64
import hashlib
import runpy
import subprocess
import sys
import zipfile
import zlib
from pathlib import Path

import pytest

SCRIPT = runpy.run_path(str(Path(__file__).parents[3] / "packaging/pack_wheel.py"))

FILES = {
    "tiny/__init__.py": b"VALUE = 3\n" * 400,
    "tiny/räum.txt": "größer\n".encode() * 90,
    "tiny/noise.bin": hashlib.sha512(b"noise").digest(),
    "tiny/py.typed": b"",
    "tiny-1.0.dist-info/METADATA": b"Metadata-Version: 2.1\nName: tiny\nVersion: 1.0\n",
    "tiny-1.0.dist-info/WHEEL": b"Wheel-Version: 1.0\nGenerator: test\nRoot-Is-Purelib: true\nTag: py3-none-any\n",
}


def deflate(content: bytes) -> bytes:
    packer = zlib.compressobj(9, zlib.DEFLATED, -zlib.MAX_WBITS)
    return packer.compress(content) + packer.flush()


def record() -> bytes:
    digest = {name: base64.urlsafe_b64encode(hashlib.sha256(own).digest()) for name, own in FILES.items()}
    lines = [f"{name},sha256={digest[name].rstrip(b'=').decode()},{len(own)}" for name, own in FILES.items()]
    return "\n".join([*lines, "tiny-1.0.dist-info/RECORD,,", ""]).encode()


@pytest.fixture
def wheel(tmp_path: Path) -> Path:
    """A wheel whose files are packed badly, one of them with the mode of a program."""
    place = tmp_path / "tiny-1.0-py3-none-any.whl"
    with zipfile.ZipFile(place, "w", zipfile.ZIP_STORED) as archive:
        for name, content in {**FILES, "tiny-1.0.dist-info/RECORD": record()}.items():
            file = zipfile.ZipInfo(name, date_time=(2024, 5, 17, 13, 47, 58))
            file.external_attr = (0o100755 if name.endswith("__init__.py") else 0o100644) << 16
            archive.writestr(file, content)
    return place


def listed(place: Path) -> list[tuple[object, ...]]:
    with zipfile.ZipFile(place) as archive:
        assert archive.testzip() is None
        return [
            (each.filename, each.date_time, each.external_attr, each.create_system, archive.read(each))
            for each in archive.infolist()
        ]


def test_a_packed_wheel_holds_the_same_files_in_less_room(wheel: Path) -> None:
    before, size = listed(wheel), wheel.stat().st_size
    assert SCRIPT["pack"](wheel, deflate) == (size, wheel.stat().st_size)
    assert wheel.stat().st_size < 0.5 * size
    assert listed(wheel) == before
    assert list(wheel.parent.iterdir()) == [wheel]


def test_the_same_wheel_gives_the_same_bytes_and_a_packed_one_stays(wheel: Path) -> None:
    again = wheel.with_name("again-1.0-py3-none-any.whl")
    again.write_bytes(wheel.read_bytes())
    SCRIPT["pack"](wheel, deflate)
    SCRIPT["pack"](again, deflate)
    assert again.read_bytes() == wheel.read_bytes()
    SCRIPT["pack"](again, deflate)
    assert again.read_bytes() == wheel.read_bytes()


def test_a_compressor_that_loses_bytes_leaves_the_wheel_alone(wheel: Path) -> None:
    before = wheel.read_bytes()
    with pytest.raises((RuntimeError, zipfile.BadZipFile)):
        SCRIPT["pack"](wheel, lambda content: deflate(content[:-1]))
    assert wheel.read_bytes() == before
    assert list(wheel.parent.iterdir()) == [wheel]


def test_a_packed_wheel_installs(wheel: Path, tmp_path: Path) -> None:
    SCRIPT["pack"](wheel, deflate)
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-index", "--no-deps", "--target"]
    subprocess.run([*pip, str(tmp_path / "at"), str(wheel)], check=True, timeout=120)
    assert (tmp_path / "at/tiny/__init__.py").read_bytes() == FILES["tiny/__init__.py"]
    assert (tmp_path / "at/tiny/räum.txt").read_bytes() == FILES["tiny/räum.txt"]
