"""A headless Firefox by WebDriver BiDi: pages are opened, asked and looked at; nothing to install but the browser."""

from __future__ import annotations

import base64
import json
import os
import re
import shutil
import socket
import struct
import subprocess
import time
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from pathlib import Path
    from types import TracebackType

PATIENCE = 60.0  # seconds that an answer may take on a busy machine
NAMES = ("firefox-esr", "firefox")


def why_not() -> str:
    """Say why there is none; empty where there is one."""
    return "" if executable() else "no Firefox here: install firefox-esr, or name one in CAMGEO_FIREFOX"


def executable() -> str | None:
    """A Firefox of the system; None where there is none."""
    return os.environ.get("CAMGEO_FIREFOX") or next(filter(None, map(shutil.which, NAMES)), None)


class Firefox:
    """One page of one Firefox, as a context."""

    def __init__(self, profile: Path, *, dark: bool = False) -> None:
        self._profile = profile
        self._number = 0
        self._dark = dark
        self._data = b""
        scheme = f'user_pref("layout.css.prefers-color-scheme.content-override", {0 if dark else 1});\n'
        quiet = 'user_pref("browser.shell.checkDefaultBrowser", false);\nuser_pref("app.update.enabled", false);\n'
        profile.mkdir(parents=True, exist_ok=True)
        (profile / "user.js").write_text(scheme + quiet, "utf-8")

    def __enter__(self) -> Self:
        path = executable()
        assert path is not None
        options = ["--headless", "--no-remote", "--profile", str(self._profile), "--remote-debugging-port", "0"]
        told = self._profile / "told"
        with told.open("wb") as stream:
            self._process = subprocess.Popen([path, *options, "about:blank"], stdout=stream, stderr=stream)
        end = time.monotonic() + PATIENCE
        while not (place := re.search(r"ws://([\d.]+):(\d+)", told.read_text("utf-8", "replace"))):
            assert time.monotonic() < end, told.read_text("utf-8", "replace")
            assert self._process.poll() is None, told.read_text("utf-8", "replace")
            time.sleep(0.1)
        host, port = place[1], int(place[2])
        self._socket = socket.create_connection((host, port), PATIENCE)
        key = base64.b64encode(os.urandom(16)).decode()
        lines = ["GET /session HTTP/1.1", f"Host: {host}:{port}", "Upgrade: websocket", "Connection: Upgrade"]
        lines += [f"Sec-WebSocket-Key: {key}", "Sec-WebSocket-Version: 13", "", ""]
        self._socket.sendall("\r\n".join(lines).encode())
        while b"\r\n\r\n" not in self._data:
            self._data += self._socket.recv(4096)
        head, _, self._data = self._data.partition(b"\r\n\r\n")
        assert b" 101 " in head, head
        self.call("session.new", capabilities={})
        (context,) = self.call("browsingContext.getTree")["contexts"]
        self._context = context["context"]
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        self._socket.close()
        self._process.terminate()
        try:
            self._process.wait(20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command and wait for its answer."""
        self._number += 1
        self._send(json.dumps({"id": self._number, "method": method, "params": parameters}).encode())
        while True:
            answer = json.loads(self._received())
            if answer.get("id") == self._number:
                assert answer["type"] == "success", f"{method}: {answer}"
                result: dict[str, Any] = answer["result"]
                return result

    def _send(self, data: bytes) -> None:
        """One frame of text, masked as a client's is."""
        size, mask = len(data), os.urandom(4)
        long = b"" if size < 126 else struct.pack(">H", size) if size < 1 << 16 else struct.pack(">Q", size)
        head = bytes([0x81, 0x80 | {0: size, 2: 126, 8: 127}[len(long)]]) + long + mask
        masks = (mask * (size // 4 + 1))[:size]
        coded = (int.from_bytes(data, "big") ^ int.from_bytes(masks, "big")).to_bytes(size, "big")
        self._socket.sendall(head + coded)

    def _received(self) -> bytes:
        """The next message, whose frames are put together; others than text are passed over."""
        message, last = b"", False
        while not last:
            first, second = self._take(2)
            size = second & 0x7F
            if size > 125:
                size = int.from_bytes(self._take(2 if size == 126 else 8), "big")
            part = self._take(size)
            if first & 0x0F in (0, 1):
                message, last = message + part, bool(first & 0x80)
        return message

    def _take(self, count: int) -> bytes:
        while len(self._data) < count:
            more = self._socket.recv(1 << 20)
            assert more, "the browser went away"
            self._data += more
        taken, self._data = self._data[:count], self._data[count:]
        return taken

    def size(self, width: int, height: int, *, dark: bool = False) -> None:
        """Set the size of the page; whether it is dark the profile says."""
        assert dark == self._dark
        self.call("browsingContext.setViewport", context=self._context, viewport={"width": width, "height": height})

    def open(self, address: str) -> None:
        """Open a page and wait until its script has run."""
        self.call("browsingContext.navigate", context=self._context, url="about:blank", wait="complete")
        self.call("browsingContext.navigate", context=self._context, url=address, wait="interactive")
        self.wait("document.documentElement?.dataset.ready === 'true'")

    def wait(self, condition: str, patience: float = PATIENCE) -> None:
        """Wait until an expression is true."""
        end = time.monotonic() + patience
        while True:
            answer = self._evaluated(f"Boolean({condition})")
            if answer["type"] == "success" and answer["result"]["value"]:
                return
            assert time.monotonic() < end, f"never true: {condition}"
            time.sleep(0.05)

    def ask(self, expression: str) -> Any:
        """Value of an expression in the page."""
        answer = self._evaluated(expression)
        assert answer["type"] == "success", answer
        return _plain(answer["result"])

    def _evaluated(self, expression: str) -> dict[str, Any]:
        return self.call("script.evaluate", expression=expression, target={"context": self._context}, awaitPromise=True)

    def screenshot(self) -> bytes:
        """The window as PNG."""
        return base64.b64decode(self.call("browsingContext.captureScreenshot", context=self._context)["data"])


def _plain(value: dict[str, Any]) -> Any:
    """A value of the page as JSON has it; of what JSON has not, such as an element, None."""
    held = value.get("value")
    match value["type"]:
        case "string" | "boolean":
            return held
        case "number":
            return float(held) if isinstance(held, str) else held
        case "array":
            return [_plain(item) for item in held or ()]
        case "object":
            return {name: _plain(item) for name, item in held or ()}
    return None
