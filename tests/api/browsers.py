"""Chromium without a window, driven through two pipes by its own protocol; no library is needed."""

from __future__ import annotations

import base64
import fcntl
import json
import os
import select
import shutil
import signal
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
WAIT = 30.0  # s, for anything that must happen


def program() -> str:
    """Return the browser, or skip the test where there is none."""
    found = next(filter(None, map(shutil.which, NAMES)), None)
    if found is None:
        pytest.skip(f"no browser: none of {', '.join(NAMES)} is installed")
    return found


class Tab:
    """A page in a browser."""

    def __init__(self, ask: int, answers: int) -> None:
        self._ask, self._answers, self._rest, self._last = ask, answers, b"", 0
        self._session: str | None = None
        self.errors: list[str] = []

    def send(self, method: str, **parameters: Any) -> Any:
        """Send a command and return its result."""
        self._last += 1
        message: dict[str, Any] = {"id": self._last, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        os.write(self._ask, json.dumps(message).encode() + b"\0")
        end = time.monotonic() + WAIT
        while time.monotonic() < end:
            found = self._read()
            if found.get("id") == self._last:
                assert "error" not in found, found
                return found["result"]
        raise TimeoutError(method)

    def _read(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            ready, _, _ = select.select([self._answers], [], [], WAIT)
            assert ready, "the browser does not answer"
            part = os.read(self._answers, 1 << 20)
            assert part, "the browser ended"
            self._rest += part
        first, _, self._rest = self._rest.partition(b"\0")
        found: dict[str, Any] = json.loads(first)
        told = found.get("params", {})
        if found.get("method") == "Runtime.exceptionThrown":
            self.errors.append(json.dumps(told["exceptionDetails"]))
        if found.get("method") == "Runtime.consoleAPICalled" and told["type"] in ("error", "warning"):
            self.errors.append(json.dumps(told["args"]))
        if found.get("method") == "Log.entryAdded" and told["entry"]["level"] == "error":
            self.errors.append(told["entry"]["text"])
        return found

    def attach(self) -> None:
        """Open an empty page."""
        target = self.send("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.send("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for part in ("Page", "Runtime", "Log"):
            self.send(f"{part}.enable")

    def size(self, width: int, height: int, *, touch: bool = False) -> None:
        """Make the window as large as a screen of so many pixels."""
        self.send("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=touch)
        if touch:
            self.send("Emulation.setTouchEmulationEnabled", enabled=True, maxTouchPoints=2)

    def reduced_motion(self) -> None:
        """Be a reader who wants no motion."""
        self.send("Emulation.setEmulatedMedia", features=[{"name": "prefers-reduced-motion", "value": "reduce"}])

    def open(self, address: str, *, state: str | None = "ready") -> None:
        """Load a page, and wait until its body is in a state."""
        self.send("Page.navigate", url=address)
        self.wait("document.readyState === 'complete'")
        if state is not None:
            self.wait(f"document.body && document.body.dataset.state === {state!r}")

    def value(self, expression: str) -> Any:
        """Return what an expression is in the page."""
        found = self.send("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in found, found
        return found["result"].get("value")

    def wait(self, expression: str, limit: float = WAIT) -> None:
        """Wait until an expression is true in the page."""
        end = time.monotonic() + limit
        while not self.value(expression):
            assert time.monotonic() < end, f"never: {expression}"
            time.sleep(0.02)

    def data(self, name: str) -> str:
        """Return a data attribute of the body."""
        return str(self.value(f"document.body.dataset[{name!r}]"))

    def press(self, key: str, *, shift: bool = False) -> None:
        """Press and release a key."""
        text = {"text": key} if len(key) == 1 else {}
        for kind in ("keyDown", "keyUp"):
            more = text if kind == "keyDown" else {}
            self.send("Input.dispatchKeyEvent", type=kind, key=key, modifiers=8 if shift else 0, **more)

    def drag(self, start: tuple[float, float], end: tuple[float, float], steps: int = 8) -> None:
        """Drag with the mouse."""
        places = [
            (start[0] + (end[0] - start[0]) * step / steps, start[1] + (end[1] - start[1]) * step / steps)
            for step in range(steps + 1)
        ]
        self._mouse("mousePressed", *places[0])
        for place in places[1:]:
            self._mouse("mouseMoved", *place)
        self._mouse("mouseReleased", *places[-1])

    def _mouse(self, kind: str, x: float, y: float) -> None:
        self.send("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)

    def picture(self, path: Path) -> None:
        """Save what is seen."""
        path.write_bytes(base64.b64decode(self.send("Page.captureScreenshot")["data"]))


@contextmanager
def tab(width: int = 1300, height: int = 900, *, touch: bool = False) -> Iterator[Tab]:
    """Open a page of a new browser, and end both afterwards."""
    found = program()
    to_browser, from_browser = os.pipe(), os.pipe()

    def pipes() -> None:
        ends = [fcntl.fcntl(each, fcntl.F_DUPFD, 10) for each in (to_browser[0], from_browser[1])]
        for number, each in zip((3, 4), ends, strict=True):
            os.dup2(each, number)

    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        options = ["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run", "--remote-debugging-pipe"]
        process = subprocess.Popen(
            [found, *options, f"--user-data-dir={profile}"],
            preexec_fn=pipes,
            close_fds=False,
            start_new_session=True,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        try:
            opened = Tab(to_browser[1], from_browser[0])
            opened.attach()
            opened.size(width, height, touch=touch)
            yield opened
        finally:
            # All of its processes end before the folder goes that they write into.
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()
            for each in (*to_browser, *from_browser):
                os.close(each)
            end = time.monotonic() + 5.0
            while time.monotonic() < end:
                try:
                    os.killpg(process.pid, 0)
                except ProcessLookupError:
                    break
                time.sleep(0.02)
