"""Watching a recipe: it is exported whenever it is saved, and a page on 127.0.0.1 reloads itself.

A recipe made of other recipes is exported when one of those is saved, too. The server has two addresses: the page and
a stream of events. A recipe with faults shows its errors on the terminal and over the page, and the watch goes on.
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
BEAT = 2.0  # seconds between messages to a page without news, by which a closed page is noticed
EMPTY = "<!DOCTYPE html><meta charset=utf-8><title>camgeo</title><link rel=icon href=data:,><body>" + RELOAD


@dataclass()
class PageState:
    """State of the page: its HTML, the errors of the recipe as last saved, and the number of changes of either.

    `changed` guards the state and wakes the streams of events; with `ended` they end.
    """

    page: str = EMPTY
    fault: str = ""
    version: int = 0
    changed: threading.Condition = field(default_factory=threading.Condition)
    ended: bool = False

    def show(self, page: str | None, fault: str) -> None:
        """Show a page and the fault over it, empty for none; with None the last page stays."""
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
    """Handler of one request: for the page, or for the stream of events."""

    def __init__(self, state: PageState, *arguments: object) -> None:
        self._shown = state
        super().__init__(*arguments)  # type: ignore[arg-type]  # socket, address and server, as the library has them

    def do_GET(self) -> None:
        """Answer with the page, the stream of events, or status 403 or 404."""
        if self.headers.get("Host", "").rpartition(":")[0] not in (HOST, "localhost"):
            # a site whose name is made to lead here would read the page as its own
            self._answer(403, "text/plain", b"ask for 127.0.0.1\n")
        elif self.path == "/":
            with self._shown.changed:
                page, version = self._shown.page, self._shown.version
            script = f'<script data-version="{version}">\n{asset("reload.js")}</script>'
            text = page.replace(LOCAL, "connect-src 'self'", 1).replace(RELOAD, script, 1)
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
        """Send the number of each new version and its fault, until the page is closed or the watch ends."""
        self.send_response(200)
        self.send_header("Content-Type", "text/event-stream")
        self.send_header("Cache-Control", "no-store")
        self.end_headers()
        state, sent_version = self._shown, -1
        try:
            while not state.ended:
                with state.changed:
                    news = state.version != sent_version
                    sent_version = state.version
                    event = {"version": state.version, "fault": state.fault}
                self.wfile.write(f"data: {json.dumps(event)}\n\n".encode() if news else b": still here\n\n")
                self.wfile.flush()
                with state.changed:
                    if not state.ended and state.version == sent_version:
                        state.changed.wait(BEAT)
        except ConnectionError:
            return  # the page was closed

    def log_message(self, format: str, *_: object) -> None:  # noqa: A002 - the library's own name
        """Write no line for a request."""


def watch(
    files: Sequence[Path],
    export_page: Callable[[], tuple[str | None, str]],
    report: Callable[[str], None],
    *,
    port: int = 0,
) -> None:
    """Export once and then whenever one of the files is saved, and serve the page, until interrupted.

    Port 0 is any free port. The list of files may change with each export. `export_page` returns the page, None where
    there is none, and the fault, empty for none; `report` is called with the address. Raises KeyboardInterrupt when it
    is interrupted, OSError where the port is taken.
    """
    state = PageState()
    server = ThreadingHTTPServer((HOST, port), partial(_Handler, state))
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.1}, daemon=True)
    thread.start()
    try:
        report(f"http://{HOST}:{server.server_address[1]}/")
        last: list[tuple[int, int, int] | None] = []
        while True:
            now = [_stamp(path) for path in files]
            if now != last:
                state.show(*export_page())
                last = now if len(now) == len(files) else [_stamp(path) for path in files]
            threading.Event().wait(LOOK)
    finally:
        state.end()
        server.shutdown()
        server.server_close()


def _stamp(path: Path) -> tuple[int, int, int] | None:
    """Time, size and node of a file, of which at least one changes at each saving; None where there is no such file."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_mtime_ns, status.st_size, status.st_ino
