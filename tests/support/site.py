"""The site of the docs: made once a session, its pages read as a browser reads them, its search asked."""

from __future__ import annotations

import json
import posixpath
import re
from html.parser import HTMLParser
from typing import TYPE_CHECKING, Any
from urllib.parse import unquote, urlsplit

from support.browser import SHOWN
from support.places import script

if TYPE_CHECKING:
    from pathlib import Path

    from support.browser import Browser

# Counts what its worker is asked and answers: "No results" stands there too until an answer comes.
COUNTED = """(() => {
  const Plain = Worker;
  Object.assign(window, { asked: [], answered: 0 });
  window.Worker = class extends Plain {
    constructor(...given) {
      super(...given);
      this.addEventListener("message", ({ data }) => (answered += data.type === 3));
    }
    postMessage(message) {
      if (message.type === 2) asked.push(JSON.stringify(message.data));
      super.postMessage(message);
    }
  };
})()"""
ASSETS = {"src", "srcset", "poster", "data", "action"}  # what a page loads by these names, and by `href` of a link


class Page(HTMLParser):
    """What a page links, loads and is linked by."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.links: list[str] = []
        self.assets: list[str] = []
        self.pictures: list[str] = []
        self.anchors: set[str] = set()
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        """Note what an element names."""
        for name, value in attrs:
            if name == "id" or (name == "name" and tag == "a"):
                self.anchors.add(value or "")
            elif name in {"href", "xlink:href"} and tag == "a":
                self.links.append(value or "")
            elif name in {"href", "xlink:href"} or name in ASSETS:
                self.assets.append(value or "")
        if tag == "img":
            self.pictures.append(dict(attrs).get("src") or "")


def make_site() -> Any:
    """The script that makes it."""
    return script("make_site", "tools/docs")


def faults(folder: Path) -> list[str]:
    """Every link, anchor and file of a site's pages that is not there, and whatever they load from elsewhere."""
    pages = {p.relative_to(folder).as_posix(): Page(p.read_text("utf-8")) for p in sorted(folder.rglob("*.html"))}
    found = []
    for name, page in pages.items():
        for target in [*page.links, *page.assets]:
            parts = urlsplit(target)
            if parts.scheme in {"data", "mailto"}:
                continue
            if parts.scheme or parts.netloc:
                found += [f"{name} loads {target}"] if target in page.assets else []
                continue
            there = (
                posixpath.normpath(posixpath.join(posixpath.dirname(name), unquote(parts.path))) if parts.path else name
            )
            there = posixpath.join(there, "index.html") if (folder / there).is_dir() else there
            if parts.path.startswith("/") or there.startswith("..") or not (folder / there).is_file():
                found.append(f"{name}: {target} is not there")
            elif parts.fragment.startswith("r=") and there.endswith("design/index.html"):
                continue  # a recipe for the page that designs, no anchor
            elif parts.fragment and there in pages and unquote(parts.fragment) not in pages[there].anchors:
                found.append(f"{name}: {target} has no such anchor")
    for path in sorted(folder.rglob("*.css")):
        loads = re.findall(r"""(?:url\(|@import)\s*["']?((?:https?:)?//[^"')\s]*)""", path.read_text("utf-8"))
        found += [f"{path.relative_to(folder)} loads {target}" for target in loads]
    return found


class Search:
    """The search of a site, as somebody at the keyboard has it."""

    def __init__(self, browser: Browser, address: str) -> None:
        self.browser = browser
        browser.size(1280, 900)
        counted = browser.call("Page.addScriptToEvaluateOnNewDocument", source=COUNTED)
        browser.leave(f"{address}index.html")
        browser.wait("!!document.querySelector('.md-search__button') && document.readyState === 'complete'")
        roots = "[...document.querySelectorAll('*')].map((one) => one.shadowRoot)"
        shadow = f"{roots}.find((root) => root?.querySelector('dialog'))"
        browser.wait(f"document.querySelector('.md-search__button').click(), !!({shadow})")
        browser.ask(f"window.sought = {shadow}, 0")
        browser.call("Page.removeScriptToEvaluateOnNewDocument", **counted)

    def results(self, query: str) -> list[str]:
        """Pages that it lists for some words, best first, each with its anchor."""
        put = "Object.getOwnPropertyDescriptor(HTMLInputElement.prototype, 'value').set.call(box, text)"
        fire = "box.dispatchEvent(new Event('input', {bubbles: true}))"
        links = "[...sought.querySelectorAll('[role=listbox] a')].map((one) => one.href)"
        self.browser.ask(f"((box, text) => {{{put}; {fire};}})(sought.querySelector('input'), {json.dumps(query)})")
        self.browser.wait(f"asked.at(-1)?.includes({json.dumps(json.dumps(query))}) && asked.length === answered")
        self.browser.ask(SHOWN)
        told, links = self.browser.ask(f"[sought.querySelector('[role=status]').textContent, {links}]")
        assert re.match(r"(No|\d+) result", told), (query, told)
        return [re.sub(r"\?h=[^#]*", "", urlsplit(link)._replace(scheme="", netloc="").geturl()) for link in links]
