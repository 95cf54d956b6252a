"""Watching a recipe: it is exported anew whenever it is saved, and a page on 127.0.0.1 reloads itself.

What is made of several recipes is exported anew when one of those is saved, too.
The server knows three addresses: the page, a stream of events, and nothing else. A recipe that is saved half-done shows
its errors on the terminal and over the page, and the watch goes on.
"""

from __future__ import annotations

import json
import threading
from functools import partial
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from typing import TYPE_CHECKING

from camgeo.report.page.asset import asset
from camgeo.report.page.page import LOCAL, RELOAD
from kin.numeric.records import dataclass, field

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

HOST = "127.0.0.1"
LOOK = 0.2  # seconds between looks at the file
BEAT = 2.0  # seconds between signs of life to a page, by which one that is gone is noticed
EMPTY = "<!DOCTYPE html><meta charset=utf-8><title>camgeo</title><link rel=icon href=data:,><body>" + RELOAD


@dataclass()
class Shown:
    """What the page shows: its text, the errors of the recipe as it is saved now, and how often either changed."""

    page: str = EMPTY
    fault: str = ""
    version: int = 0
    changed: threading.Condition = field(default_factory=threading.Condition)
    ended: bool = False

    def show(self, page: str | None, fault: str) -> None:
        """Show another page, or over the last one what is wrong."""
        with self.changed:
            self.page = self.page if page is None else page
            self.fault = fault
            self.version += 1
            self.changed.notify_all()

    def end(self) -> None:
        """Let every stream of events end."""
        with self.changed:
            self.ended = True
            self.changed.notify_all()


class _Handler(BaseHTTPRequestHandler):
    """One request: the page, or the events."""

    def __init__(self, shown: Shown, *arguments: object) -> None:
        self._shown = shown
        super().__init__(*arguments)  # type: ignore[arg-type]  # socket, address and server, as the library has them

    def do_GET(self) -> None:
        """Answer the page, the stream of events, or that there is nothing."""
        if self.headers.get("Host", "").rpartition(":")[0] not in (HOST, "localhost"):
            # a site whose name is made to lead here would read the page as its own
            self._answer(403, "text/plain", b"ask for 127.0.0.1\n")
        elif self.path == "/":
            script = f"<script>\n{asset('reload.js')}</script>"
            text = self._shown.page.replace(LOCAL, "connect-src 'self'", 1).replace(RELOAD, script, 1)
            self._answer(200, "text/html; charset=utf-8", text.encode("utf-8"))
        elif self.path == "/events":
            self._events()
        else:
            self._answer(404, "text/plain", b"nothing is here\n")

    def _answer(self, status: int, kind: str, data: bytes) -> None:
        self.send_response(status)
        self.send_header("Content-Type", kind)
        self.send_header("Content-Length", str(len(data)))
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        self.wfile.write(data)

    def _events(self) -> None:
        """Tell the page each version with its fault, until it goes away or the watch ends."""
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        shown, told = self._shown, -1
        try:
            while not shown.ended:
                with shown.changed:
                    news = shown.version != told
                    told = shown.version
                    event = {"version": shown.version, "fault": shown.fault}
                self.wfile.write(f"data: {json.dumps(event)}\n\n".encode() if news else b": still here\n\n")
                self.wfile.flush()
                with shown.changed:
                    if not shown.ended and shown.version == told:
                        shown.changed.wait(BEAT)
        except ConnectionError:
            return  # the page was closed

    def log_message(self, format: str, *_: object) -> None:  # noqa: A002 - the library's own name
        """Say nothing of each request."""


def watch(
    files: Sequence[Path],
    exported: Callable[[], tuple[str | None, str]],
    report: Callable[[str], None],
    *,
    port: int = 0,
) -> None:
    """Export once and then whenever one of the files is saved, and serve the page, until interrupted.

    Port 0 is any free one. Which files are looked at may change with each export.

    `exported` gives the page, None where there is none, and what is wrong, empty where nothing is; `report` hears of
    the address. Raises KeyboardInterrupt in the end, OSError where the port is taken.
    """
    shown = Shown()
    server = ThreadingHTTPServer((HOST, port), partial(_Handler, shown))
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.1}, daemon=True)
    thread.start()
    try:
        report(f"http://{HOST}:{server.server_address[1]}/")
        last: list[tuple[int, int, int] | None] = []
        while True:
            now = [_stamp(path) for path in files]
            if now != last:
                shown.show(*exported())
                last = now if len(now) == len(files) else [_stamp(path) for path in files]
            threading.Event().wait(LOOK)
    finally:
        shown.end()
        server.shutdown()
        server.server_close()


def _stamp(path: Path) -> tuple[int, int, int] | None:
    """Return what changes when a file is saved, also where an editor puts another in its place; None without one."""
    try:
        found = path.stat()
    except OSError:
        return None
    return found.st_mtime_ns, found.st_size, found.st_ino
