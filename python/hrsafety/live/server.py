"""The page of a running world: a server that only this machine can ask, and only with a token."""

from __future__ import annotations

import json
import secrets
import threading
import time as clocks
import webbrowser
from collections.abc import Callable
from functools import cache
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from importlib import resources
from typing import Any, ClassVar
from urllib.parse import parse_qs, urlsplit

from hrsafety._replay.page import digest, player_page
from hrsafety.errors import HrsafetyError
from hrsafety.live.world import LiveWorld
from hrsafety.navigation.crowd.world import World

__all__ = ["serve"]

HOST = "127.0.0.1"
MOST_BYTES = 10_000
"""Of a wish."""
GRACE = 3.0
"""A world ends when no page has asked for it for so many seconds, in which one may be loaded again."""
PATIENCE = 120.0
"""Seconds until the first page must look."""
WRONG = "only the page that this program named may ask"


def serve(
    world: World,
    *,
    port: int = 0,
    browser: bool = True,
    said: Callable[[str], object] = print,
    grace: float = GRACE,
) -> None:
    """Run a world, and serve its page until the last tab is closed or Ctrl-C is pressed.

    Parameters
    ----------
    world : World
        With one robot.
    port : int
        Port on this machine; 0: one that is free.
    browser : bool
        Whether a browser is opened.
    said : callable
        Told the address of the page.
    grace : float
        Seconds without a page after which all ends.

    Raises
    ------
    InvalidParameterError
        If the world cannot be played with, see `LiveWorld`.
    OSError
        If the port is not free.
    """
    live = LiveWorld(world)
    server = _Server((HOST, port), _Handler)
    server.live, server.token = live, secrets.token_urlsafe(24)
    address = f"http://{HOST}:{server.server_port}/?token={server.token}"
    failed: list[BaseException] = []

    def run() -> None:
        try:
            live.run()
        except BaseException as error:  # told by the thread that waits
            failed.append(error)

    threads = [threading.Thread(target=run, daemon=True), threading.Thread(target=server.serve_forever, daemon=True)]
    for each in threads:
        each.start()
    said(address)
    if browser:
        webbrowser.open(address)
    try:
        while not live.finished and not server.left_alone(grace):
            clocks.sleep(0.1)
    finally:
        live.stop()
        server.shutdown()
        server.server_close()
        threads[0].join(5.0)
    if failed:
        raise failed[0]


class _Server(ThreadingHTTPServer):
    """Counts the pages that look."""

    daemon_threads = True
    live: LiveWorld
    token: str

    def __init__(self, *given: Any) -> None:
        super().__init__(*given)
        self._guard, self._looking, self._since = threading.Lock(), 0, clocks.monotonic()
        self._patience = PATIENCE

    def looks(self, change: int) -> None:
        """Count a page that begins or ends to look."""
        with self._guard:
            self._looking += change
            self._since, self._patience = clocks.monotonic(), 0.0

    def left_alone(self, grace: float) -> bool:
        """Return whether no page has looked for long."""
        with self._guard:
            return self._looking == 0 and clocks.monotonic() - self._since > max(grace, self._patience)

    def handle_error(self, *_: Any) -> None:
        """Say nothing of a page that was closed while it was answered."""


class _Handler(BaseHTTPRequestHandler):
    """Answers the page, its states and its wishes."""

    server: _Server
    protocol_version = "HTTP/1.1"
    server_version = "hrsafety"
    sys_version = ""
    timeout = 30
    _SAFE: ClassVar[dict[str, str]] = {
        "Cache-Control": "no-store",
        "X-Content-Type-Options": "nosniff",
        "X-Frame-Options": "DENY",
        "Referrer-Policy": "no-referrer",
        "Cross-Origin-Resource-Policy": "same-origin",
    }

    def log_message(self, *_: Any) -> None:
        """Keep the terminal for what matters."""

    def do_GET(self) -> None:  # named by the library
        """Answer with the page, its states as they come, or the player of what happened."""
        if not self._allowed():
            return
        path = urlsplit(self.path).path
        if path == "/":
            text, rules = _page(self.server.live)
            self._answer(HTTPStatus.OK, text, "text/html; charset=utf-8", {"Content-Security-Policy": rules})
        elif path == "/states":
            self._states()
        elif path == "/player.html":
            self._player()
        else:
            self._answer(HTTPStatus.NOT_FOUND, "there is no such page")

    def do_POST(self) -> None:  # named by the library
        """Take a wish."""
        if not self._allowed():
            return
        length = self.headers.get("Content-Length", "")
        if not length.isascii() or not length.isdigit() or int(length) > MOST_BYTES:
            self.close_connection = True
            self._answer(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"a wish has at most {MOST_BYTES} bytes")
            return
        body = self.rfile.read(int(length))
        try:
            wish = json.loads(body)
        except (ValueError, RecursionError):
            wish = None
        if urlsplit(self.path).path != "/wishes" or not isinstance(wish, dict):
            self._answer(HTTPStatus.BAD_REQUEST, "a wish is a JSON object for /wishes")
            return
        self.server.live.change(wish)
        self._answer(HTTPStatus.NO_CONTENT, "")

    def _allowed(self) -> bool:
        """Return whether the own page asks; another one of the same browser has another origin, or no token."""
        names = {f"{name}:{self.server.server_port}" for name in (HOST, "localhost")}
        origin = self.headers.get("Origin")
        token = parse_qs(urlsplit(self.path).query).get("token", [""])[0]
        known = self.headers.get_all("Host", []) in [[name] for name in names]
        own = origin is None or origin in {f"http://{name}" for name in names}
        if known and own and secrets.compare_digest(token.encode(), self.server.token.encode()):
            return True
        self.close_connection = True
        self._answer(HTTPStatus.FORBIDDEN, WRONG)
        return False

    def _answer(
        self, status: HTTPStatus, text: str, kind: str = "text/plain; charset=utf-8", more: dict[str, str] | None = None
    ) -> None:
        content = text.encode()
        self.send_response(status)
        for name, value in {**self._SAFE, **(more or {}), "Content-Type": kind}.items():
            self.send_header(name, value)
        self.send_header("Content-Length", str(len(content)))
        if self.close_connection:
            self.send_header("Connection", "close")
        self.end_headers()
        self.wfile.write(content)

    def _player(self) -> None:
        try:
            page = player_page(self.server.live.replay())
        except HrsafetyError as error:
            self._answer(HTTPStatus.CONFLICT, str(error))
            return
        kept = {"Content-Disposition": 'attachment; filename="player.html"'}
        self._answer(HTTPStatus.OK, page, "text/html; charset=utf-8", kept)

    def _states(self) -> None:
        """Send every state as it comes, the newest if the page is too slow, until one of both ends."""
        self.close_connection = True
        self.send_response(HTTPStatus.OK)
        for name, value in {**self._SAFE, "Content-Type": "text/event-stream", "Connection": "close"}.items():
            self.send_header(name, value)
        self.end_headers()
        live, last = self.server.live, -1
        self.server.looks(1)
        try:
            while True:
                with live.told:
                    live.told.wait_for(lambda: live.count != last or live.finished, 1.0)  # noqa: B023  # asked at once
                    state, count, finished = live.state, live.count, live.finished
                # A line that says nothing finds out whether the page is there.
                self.wfile.write(f"data: {state}\n\n".encode() if count != last and state else b":\n\n")
                if finished:
                    self.wfile.write(b"event: end\ndata: {}\n\n")
                self.wfile.flush()
                if finished:
                    return
                last = count
        except OSError:  # the tab was closed
            return
        finally:
            self.server.looks(-1)


@cache
def _part(name: str) -> str:
    return resources.files("hrsafety.live").joinpath(name).read_text(encoding="utf-8").strip()


def _page(live: LiveWorld) -> tuple[str, str]:
    """Return the page and the rules for what it may do."""
    style, script, body = (_part(name) for name in ("live.css", "live.js", "live.html"))
    rules = (
        f"default-src 'none'; script-src '{digest(script)}'; style-src '{digest(style)}'; connect-src 'self'; "
        "base-uri 'none'; form-action 'none'; frame-ancestors 'none'"
    )
    scene = json.dumps(live.scene(), separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")
    filled = {"style": style, "script": script, "scene": scene}
    return "".join(filled[part] if index % 2 else part for index, part in enumerate(body.split("@@"))), rules
