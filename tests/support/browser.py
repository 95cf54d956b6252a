"""A headless browser by its own debugging pipe: pages are opened, asked, clicked and looked at; nothing to install."""

from __future__ import annotations

import base64
import fcntl
import json
import os
import select
import shutil
import subprocess
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Self

if TYPE_CHECKING:
    from types import TracebackType

NAMES = ("chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome-headless-shell")
PATIENCE = 60.0  # seconds that an answer may take on a busy machine


def executable() -> str | None:
    """A Chromium of the system, or one that playwright has fetched; None where there is none."""
    given = os.environ.get("CAMGEO_BROWSER")
    if given:
        return given
    for name in NAMES:
        found = shutil.which(name)
        if found:
            return found
    fetched = Path.home() / ".cache" / "ms-playwright"
    return next((str(path) for path in sorted(fetched.glob("chromium*/chrome-*/*")) if path.stem in _FETCHED), None)


_FETCHED = {"chrome", "headless_shell", "chrome-headless-shell"}

REPLACED = ("navigated or closed", "context was destroyed", "Cannot find context", "Cannot find default execution")


# what observes sizes hears of them behind the next frame
SHOWN = "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))"
GONE_OVER = "Promise.allSettled(document.getAnimations().map((one) => one.finished)).then(() => true)"  # colours


class ReplacedError(AssertionError):
    """The page that was asked is being replaced by another."""


class Browser:
    """One page of one browser, as a context; `problems` are its console errors, exceptions and requests."""

    def __init__(self, profile: Path) -> None:
        self._profile = profile
        self._number = 0
        self._buffer = b""
        self.problems: list[str] = []
        self.requests: list[str] = []
        self._session: str | None = None

    def __enter__(self) -> Self:
        path = executable()
        assert path is not None
        to_read, self._write = os.pipe()
        self._read, to_write = os.pipe()
        ends = [fcntl.fcntl(fd, fcntl.F_DUPFD, 10) for fd in (to_read, to_write)]

        # the browser reads from 3 and writes to 4; a process that becomes it sets them, as this one may have threads
        become = "import os, sys; r, w, *c = sys.argv[1:]; os.dup2(int(r), 3); os.dup2(int(w), 4); os.execv(c[0], c)"
        options = ["--headless=new", "--no-sandbox", "--disable-gpu", "--remote-debugging-pipe", "--hide-scrollbars"]
        options += ["--disable-background-networking", "--no-first-run", "--disable-dev-shm-usage", "--mute-audio"]
        options += ["--disable-component-update", "--force-color-profile=srgb", f"--user-data-dir={self._profile}"]
        self._process = subprocess.Popen(
            [sys.executable, "-c", become, *map(str, ends), path, *options, "about:blank"],
            pass_fds=ends,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        for fd in (to_read, to_write, *ends):
            os.close(fd)
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        self._session = self.call("Target.attachToTarget", targetId=target, flatten=True)["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        return self

    @property
    def process(self) -> int:
        """Number of its first process."""
        return self._process.pid

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None) -> None:
        self._session = None
        try:
            self.call("Browser.close")
        except (OSError, AssertionError):
            self._process.kill()
        finally:
            os.close(self._write)
            os.close(self._read)
            try:
                self._process.wait(20)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Send a command and wait for its answer."""
        self._number += 1
        message: dict[str, Any] = {"id": self._number, "method": method, "params": parameters}
        if self._session is not None:
            message["sessionId"] = self._session
        os.write(self._write, json.dumps(message).encode() + b"\0")
        number = self._number
        while True:
            answer = self._next(PATIENCE)
            assert answer is not None, f"the browser does not answer {method}"
            if answer.get("id") == number:
                told = answer.get("error", {}).get("message", "")
                if any(part in told for part in REPLACED):
                    raise ReplacedError(f"{method}: {told}")
                assert "error" not in answer, f"{method}: {answer.get('error')}"
                result: dict[str, Any] = answer["result"]
                return result

    def _next(self, patience: float) -> dict[str, Any] | None:
        end = time.monotonic() + patience
        while b"\0" not in self._buffer:
            ready, _, _ = select.select([self._read], [], [], max(0.0, end - time.monotonic()))
            if not ready:
                return None
            data = os.read(self._read, 1 << 20)
            assert data, "the browser went away"
            self._buffer += data
        line, _, self._buffer = self._buffer.partition(b"\0")
        message: dict[str, Any] = json.loads(line)
        self._note(message)
        return message

    def _note(self, message: dict[str, Any]) -> None:
        method, parameters = message.get("method"), message.get("params", {})
        if method == "Runtime.exceptionThrown":
            self.problems.append(json.dumps(parameters["exceptionDetails"])[:800])
        elif method == "Runtime.consoleAPICalled" and parameters["type"] in {"error", "warning", "assert"}:
            self.problems.append(json.dumps(parameters["args"])[:800])
        elif (
            method == "Log.entryAdded"
            and parameters["entry"]["level"] in {"error", "warning"}
            and parameters["entry"]["source"] != "rendering"  # what a machine without a graphics card says of that
        ):
            self.problems.append(json.dumps(parameters["entry"])[:800])
        elif method == "Network.requestWillBeSent":
            self.requests.append(parameters["request"]["url"])

    def size(self, width: int, height: int, *, dark: bool = False, mobile: bool = False) -> None:
        """Set the size of the window and which colours are preferred, and wait until the page has taken both."""
        self.call("Emulation.setDeviceMetricsOverride", width=width, height=height, deviceScaleFactor=1, mobile=mobile)
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        self.call("Emulation.setEmulatedMedia", features=[scheme])
        self.ask(SHOWN)

    def leave(self, address: str) -> None:
        """Go to a page from none, so that nothing of the one before is taken for its own."""
        self.call("Page.navigate", url="about:blank")
        self.wait("location.href === 'about:blank'")
        self.call("Page.navigate", url=address)

    def open(self, address: str) -> None:
        """Open a page and wait until its script has run."""
        self.leave(address)
        self.wait("document.documentElement?.dataset.ready === 'true'")

    def wait(self, condition: str, patience: float = PATIENCE) -> None:
        """Wait until an expression is true."""
        end = time.monotonic() + patience
        while not self._holds(condition):
            assert time.monotonic() < end, f"never true: {condition}; {self.problems}"
            time.sleep(0.05)

    def _holds(self, condition: str) -> bool:
        """Whether an expression is true; not while a page is being replaced or lacks what the expression looks at."""
        try:
            answer = self.call("Runtime.evaluate", expression=condition, returnByValue=True)
        except ReplacedError:
            return False
        return "exceptionDetails" not in answer and bool(answer["result"].get("value"))

    def ask(self, expression: str) -> Any:
        """Value of an expression in the page."""
        answer = self.call("Runtime.evaluate", expression=expression, returnByValue=True, awaitPromise=True)
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def key(self, key: str, *, shift: bool = False) -> None:
        """Press and release a key."""
        more: dict[str, Any] = {"text": key} if len(key) == 1 else {}
        code = {" ": "Space"}.get(key, key)
        for kind in ("keyDown", "keyUp"):
            text = more if kind == "keyDown" else {}
            self.call("Input.dispatchKeyEvent", type=kind, key=key, code=code, modifiers=8 if shift else 0, **text)

    def drag(self, points: list[tuple[float, float]]) -> None:
        """Press the mouse at the first point, move through the others, release."""
        (x, y), *rest = points
        self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y)
        self.call("Input.dispatchMouseEvent", type="mousePressed", x=x, y=y, button="left", clickCount=1)
        for x, y in rest:
            self.call("Input.dispatchMouseEvent", type="mouseMoved", x=x, y=y, button="left", buttons=1)
        self.call("Input.dispatchMouseEvent", type="mouseReleased", x=x, y=y, button="left", clickCount=1)

    def touch(self, points: list[tuple[float, float]]) -> None:
        """Put a finger at the first point, move it through the others, lift it."""
        kinds = ["touchStart", *("touchMove" for _ in points[1:]), "touchEnd"]
        for kind, place in zip(kinds, [*points, None], strict=True):
            fingers = [] if place is None else [{"x": place[0], "y": place[1]}]
            self.call("Input.dispatchTouchEvent", type=kind, touchPoints=fingers)

    def screenshot(self, *, whole: bool = False) -> bytes:
        """The window, or the whole page, as PNG."""
        return base64.b64decode(self.call("Page.captureScreenshot", format="png", captureBeyondViewport=whole)["data"])

    def pdf(self) -> bytes:
        """The page as it prints."""
        return base64.b64decode(self.call("Page.printToPDF", printBackground=True, preferCSSPageSize=True)["data"])
