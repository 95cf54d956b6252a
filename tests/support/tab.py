"""The live page: built once a session, served as a plain static server does, and opened in a browser."""

from __future__ import annotations

import base64
import functools
import http.server
import json
import re
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from support import pyodide
from support.browser import executable
from support.pages import wait
from support.places import script

if TYPE_CHECKING:
    from collections.abc import Iterator

    from support.browser import Browser
    from support.firefox import Firefox

PATIENCE = 240.0  # seconds that Python's start may take on a busy machine
RESTED = """new Promise((done) => {
  const place = () => `${scrollY} ${document.documentElement.scrollHeight}`;
  let last = place(), frames = 0;
  const look = () => {
    frames = place() === last ? frames + 1 : 0;
    last = place();
    if (frames < 20) requestAnimationFrame(look); else done(true);
  };
  look();
})"""
AS_OPENED = """(() => {
  if (underWay) halting();
  document.getElementById("other")?.remove();
  const own = [[work, "ask"], [document, "hidden"], [history, "pushState"], [navigator.clipboard, "writeText"]];
  for (const [one, name] of own) delete one[name];
  recipe.beside = null;
  [keeps, step, grip, chosen] = [true, null, null, 0];
  if (tab.dataset.answered !== String(changeCount)) changed(); // a change that nothing answers
  for (const id of ["begin", "add"]) byId(id).open = false;
  byId("with-file").hidden = true;
  for (const form of document.forms) if (form.id !== "form") form.reset();
  for (const id of ["units", "gap", "find"]) byId(id).value = "";
  byId("told").textContent = "";
  tab.dispatchEvent(new Event("chosen")); // boxes go by what stands in them
  document.activeElement.blur();
  scrollTo({ top: 0, behavior: "instant" });
})()"""


def why_not() -> str:
    """Say why the page cannot be opened; empty where it can."""
    if executable() is None:
        return "no browser here: install chromium, or name one in CAMGEO_BROWSER"
    return pyodide.why_not()


def built(folder: Path) -> Path:
    """The page in a new folder."""
    build = script("build")
    build.build(folder, pyodide.folder(), build.fetch(pyodide.folder()))
    return folder


ASKED: list[str] = []  # names of the files that browsers have asked servers for


class Plain(http.server.SimpleHTTPRequestHandler):
    """A static server that says nothing, and notes what it is asked for."""

    def do_GET(self) -> None:
        """Send a file, and note it."""
        ASKED.append(self.path.partition("?")[0])
        super().do_GET()

    def log_message(self, *_: object) -> None:
        """Say nothing."""


class _Strict(Plain):
    """One that sends the page's own policy with every file, the worker's among them."""

    def end_headers(self) -> None:
        index = (Path(self.directory) / "index.html").read_text("utf-8")
        (policy,) = re.findall(r'http-equiv="Content-Security-Policy" content="([^"]*)"', index)
        self.send_header("Content-Security-Policy", policy)
        super().end_headers()


@contextmanager
def served(folder: Path, how: type[Plain] = _Strict) -> Iterator[str]:
    """Serve a folder meanwhile, and give its address."""
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), functools.partial(how, directory=str(folder)))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        yield f"http://127.0.0.1:{server.server_port}/"
    finally:
        server.shutdown()
        server.server_close()


class Tab:
    """The page in a browser, as somebody at the keyboard has it."""

    def __init__(self, browser: Browser | Firefox, address: str) -> None:
        self.browser, self.address = browser, address

    def open(self, fragment: str = "") -> Tab:
        """Open it and wait for the first design."""
        self.browser.open(f"{self.address}{fragment}")
        self.wait("document.body.dataset.loaded")
        self.settle()
        return self

    def as_opened(self) -> Tab:
        """The page as it is found, whatever a test before has left: its window, its boxes, and functions of its own."""
        self.browser.size(1280, 800)
        self.browser.call("Emulation.setTouchEmulationEnabled", enabled=False)
        self.ask(AS_OPENED)
        self.wait("!underWay")
        self.settle()
        return self

    def turn_to(self, at: float) -> None:
        """Turn the mechanism to a place, at which it stands still."""
        self.ask(f"byId('slider').value = {at}; byId('slider').dispatchEvent(new Event('input'))")

    def wait(self, condition: str) -> None:
        """Wait until an expression is true."""
        self.browser.wait(condition, PATIENCE)

    def settle(self) -> None:
        """Wait until every change of the recipe is answered, and the worker rests."""
        self.wait("document.body.dataset.answered === String(changeCount) && !work.current")

    def written(self) -> str:
        """Write the recipe to the address at once, not a little later, and give what stands behind its #."""
        self.ask("writeAddress()")
        address: str = self.ask("writing.then(() => location.hash)")
        return address

    def reload(self) -> None:
        """Load it anew, and wait until Python is there."""
        self.ask("window.former = true")
        self.browser.call("Page.reload")
        self.wait("!window.former && document.body?.dataset.loaded")

    def rest(self) -> None:
        """Wait until nothing scrolls the page or changes its height any more."""
        self.ask(RESTED)

    def ask(self, expression: str) -> Any:
        """Value of an expression in the page."""
        return self.browser.ask(expression)

    def text_of(self, name: str) -> str:
        """Text of an element."""
        text: str = self.ask(f"byId({name!r}).textContent")
        return text

    def click(self, name: str) -> None:
        """Press a button by its id."""
        self.ask(f"byId({name!r}).click()")

    def press(self, name: str) -> None:
        """Press a button that changes the recipe, and wait for what comes of it."""
        self.click(name)
        self.settle()

    def worked(self, name: str) -> None:
        """Press a button of what takes its time, and wait until that has ended."""
        assert self.ask(f"byId({name!r}).click(), underWay")
        self.wait("!underWay")

    def judged(self, name: str) -> None:
        """Press a button that makes or judges files, and wait for the judged page."""
        before = self.ask("Number(document.body.dataset.judged || 0)")
        self.worked(name)
        faults = self.text_of("faults" if name == "make" else "file-faults")
        assert self.ask("Number(document.body.dataset.judged || 0)") == before + 1, faults

    def saved(self, name: str, path: Path) -> bytes:
        """What a button saves under a name, which no file has yet."""
        assert not path.exists()
        self.worked(name)
        assert self.text_of("busy").startswith("done in "), self.text_of("hand-told")
        wait(path.is_file)
        return path.read_bytes()

    def copied(self) -> str:
        """Copy the link, and give it."""
        link: str = self.ask(
            "new Promise((done) => {navigator.clipboard.writeText = async (text) => done(text); byId('link').click();})"
        )
        return link

    def middle(self, element: str) -> tuple[float, float]:
        """Middle of an element in the window, after it has come into view and nothing scrolls any more."""
        self.ask(f"{element}.scrollIntoView({{ block: 'center', behavior: 'instant' }})")
        self.rest()
        box = f"{element}.getBoundingClientRect()"
        x, y = self.ask(f"(({{ x, y, width, height }}) => [x + width / 2, y + height / 2])({box})")
        return x, y

    @contextmanager
    def other(self, fragment: str = "") -> Iterator[str]:
        """Open the page in a frame meanwhile, as another tab, and give its document."""
        self.ask(f"""(() => {{
          const other = document.createElement("iframe");
          Object.assign(other, {{ id: "other", src: {json.dumps(f"index.html{fragment}")} }});
          document.body.append(other);
        }})()""")
        yield "byId('other').contentDocument"
        self.ask("byId('other').remove()")

    @property
    def text(self) -> str:
        """The recipe."""
        text: str = self.ask("byId('text').value")
        return text

    def load(self, name: str, text: str, tables: dict[str, str] | None = None) -> None:
        """Begin with a recipe, as a starter does."""
        self.ask(f"beginRecipe({json.dumps({'name': name, 'text': text, 'tables': tables or {}})})")
        self.settle()

    def choose(self, name: str, value: str) -> None:
        """Choose a value of a list by its id."""
        self.ask(f"byId({name!r}).value = {value!r}; byId({name!r}).dispatchEvent(new Event('change'))")

    def tick(self, path: str, word: str) -> None:
        """Tick or untick a word of a list."""
        self.ask(f"document.querySelector({_row(path)!r}).querySelector('[value=\"{word}\"]').click()")
        self.settle()

    def write(self, text: str) -> None:
        """Put a text in the place of the recipe's, as if it were typed, and wait for what comes of it."""
        self._put("byId('text')", text, "input")

    def enter(self, path: str, text: str) -> None:
        """Put a text into the box of a field, and wait for what comes of it."""
        self._put(f"document.querySelector({_row(path)!r}).querySelector('.box, .wide')", text, "change")

    def slide(self, path: str, value: float) -> None:
        """Move a slider, and wait for the picture."""
        self._put(
            f"document.querySelector({_row(path)!r}).querySelector('[type=range]')", f"{value:.9g}", "input", "change"
        )

    def _put(self, element: str, text: str, *events: str) -> None:
        fire = "".join(f"element.dispatchEvent(new Event({name!r}, {{bubbles: true}}));" for name in events)
        self.ask(f"(() => {{const element = {element}; element.value = {json.dumps(text)}; {fire}}})()")
        self.settle()

    def drop(self, name: str, data: bytes) -> None:
        """Give the page a file, as dropping it does."""
        packed = base64.b64encode(data).decode()
        self.ask(
            f"takeFiles([new File([Uint8Array.from(atob({packed!r}), (c) => c.charCodeAt(0))], {json.dumps(name)})])"
        )


def _row(path: str) -> str:
    return f'[data-path="{path}"]'
