"""Make the documentation site, a folder that any static server serves: `python tools/docs/make_site.py [FOLDER]`.

`docs/index.md` is its first page, and the order of its menu; each page of docs, CONTRIBUTING.md and CHANGELOG.md is in
it, the recipes and examples as they are and shown, and the public names of the library. With Pyodide's folder it holds
the page that designs in a browser too, in `design/`. It asks no other host for anything. The generator is the extra
`site`.
"""

from __future__ import annotations

import argparse
import html
import inspect
import io
import json
import os
import posixpath
import re
import shutil
import subprocess
import sys
import tempfile
from importlib.util import find_spec
from pathlib import Path
from typing import NamedTuple
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "site"
GENERATOR = "zensical"
MADE_BY = ".made-by-make-site"  # stands in a folder that this script made, and may make anew
DESIGN = "design"  # folder of the page that designs in a browser
SHOWN = ("recipes", "examples")  # folders whose files are all published
LANGUAGES = {".yaml": "yaml", ".py": "python", ".csv": "text"}  # of what is shown of these folders, by suffix
UNSOUGHT = ["---", "search:", "  exclude: true", "---"]  # head of a page that the search leaves out
OTHERS = {"CHANGELOG.md": "changelog.md", "CONTRIBUTING.md": "contributing.md", "README.md": "index.md"}

CODE = r"^ *```.*?^ *```[^\n]*$|``.+?``|`[^`]+`"
COMMENT = re.compile(rf"(?P<code>{CODE})|^[ \t]*<!--.*?-->[ \t]*\n|[ \t]*<!--.*?-->", re.DOTALL | re.MULTILINE)
LINK = re.compile(
    rf'(?P<code>{CODE})|\]\((?P<target>[^)\s]+)\)|\b(?P<name>href|src)="(?P<raw>[^"]*)"', re.DOTALL | re.MULTILINE
)


class Listed(NamedTuple):
    """A row of the first page: title and file of a page, from the folder docs, and what the page is for."""

    title: str
    page: str
    words: str


class Section(NamedTuple):
    """A heading of the first page, with the pages that it lists."""

    title: str
    pages: list[Listed]


def why_not() -> str:
    """Say why no site can be made; empty where one can."""
    if find_spec(GENERATOR) is None:
        return f"no generator of the site here: pip install -e '.[site]' brings {GENERATOR}"
    return ""


def sections(text: str) -> list[Section]:
    """Give the sections of the first page, in its order."""
    found = []
    for part in re.split(r"^## ", COMMENT.sub(lambda m: m["code"] or "", text), flags=re.MULTILINE)[1:]:
        rows = re.findall(r"^\| \[([^\]]+)\]\(([^)#\s]+\.md)\) \| (.*) \|$", part, re.MULTILINE)
        if rows:
            found.append(Section(part.partition("\n")[0], [Listed(*row) for row in rows]))
    return found


# pages that are written as the site is made, each behind one of docs in the menu
WRITTEN = {
    "recipe-verify.md": Listed("Commands", "commands.md", "every command with its options, exit status"),
    "library.md": Listed("Public names", "api.md", "functions, classes and errors by name"),
}


class Source:
    """The folder of which the generator makes the site: pages in Markdown, files beside them."""

    def __init__(self, folder: Path) -> None:
        """Take a folder, which `write` makes with its first page."""
        self.folder = folder
        self._shown = set[str]()

    def write(self, name: str, text: str) -> None:
        """Write a page."""
        path = self.folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")

    def page(self, place: str, name: str, more: str = "") -> None:
        """Take a page of the repository, by its place there, with a line more below its heading."""
        text = (ROOT / place).read_text(encoding="utf-8")
        text = COMMENT.sub(lambda m: m["code"] or "", text)
        text = LINK.sub(lambda m: self._linked(m, posixpath.dirname(place), name), text)
        text = re.sub(r"\[([\w-]+)\.md\]\(", r"[\1](", plain_lists(text))  # a reader of the site sees no files
        if more:
            head, _, rest = text.partition("\n# ") if text.startswith("---") else ("", "", text.removeprefix("# "))
            title, _, rest = rest.partition("\n")
            text = f"{head}\n# {title}\n\n{more}\n{rest}".lstrip("\n")
        self.write(name, text)

    def _linked(self, match: re.Match[str], folder: str, name: str) -> str:
        """A link with its target where the site has it."""
        if match["code"]:
            return match["code"]
        target = match["target"] or match["raw"]
        if re.match(r"[a-z]+:|#", target):
            return match[0]
        path, mark, anchor = target.partition("#")
        there = self.place_of(posixpath.normpath(posixpath.join(folder, path)))
        address = posixpath.relpath(there, posixpath.dirname(name) or ".")
        if match["raw"] is not None:  # raw HTML stays as it is written
            return f'{match["name"]}="{re.sub(r"[.]md$", ".html", address)}{mark}{anchor}"'
        return f"]({address}{mark}{anchor})"

    def place_of(self, place: str) -> str:
        """Where the site has a file or a folder of the repository; what is no page of docs is shown on one.

        Raises FileNotFoundError for what the repository does not hold.
        """
        if place in OTHERS:
            return OTHERS[place]
        if place.startswith("docs/"):
            return place.removeprefix("docs/")
        path = ROOT / place
        if path.is_dir():
            return f"{place}/index.md"
        if not path.is_file():
            raise FileNotFoundError(place)
        self.show(path)
        return f"{place}.md"

    def show(self, path: Path) -> None:
        """Publish a file as it is, and a page that shows it."""
        place = path.relative_to(ROOT).as_posix()
        if place in self._shown:
            return
        self._shown.add(place)
        text = path.read_text(encoding="utf-8")
        self.write(place, text)
        up = posixpath.relpath(".", posixpath.dirname(place))
        about = re.search(r"^about: *['\"]?(.*?)['\"]?$", text, re.MULTILINE) if path.suffix == ".yaml" else None
        picture = f"gallery/{path.stem}.svg" if path.suffix == ".yaml" else ""
        lines = [*UNSOUGHT, f"# {path.name}", ""]
        lines += [f"{about[1]}", ""] if about else []
        lines += [f'<p><a href="{path.name}" download>Save this file</a> ({place} of the repository)</p>', ""]
        if picture and (ROOT / "docs" / picture).is_file():
            lines += [f"![The cam of {path.name}]({up}/{picture})", ""]
        lines += [f"```{LANGUAGES.get(path.suffix, 'text')}", text.rstrip("\n"), "```", ""]
        self.write(f"{place}.md", "\n".join(lines))

    def folders(self) -> None:
        """Publish the folders that are shown whole, each with a page that lists its files."""
        for top in SHOWN:
            folders = [ROOT / top, *sorted(path for path in (ROOT / top).rglob("*") if path.is_dir())]
            for folder in (path for path in folders if path.name != "__pycache__"):
                files = [path for path in sorted(folder.iterdir()) if path.suffix in LANGUAGES]
                inner = [path for path in sorted(folder.iterdir()) if path in folders and path.name != "__pycache__"]
                for path in files:
                    self.show(path)
                place = folder.relative_to(ROOT).as_posix()
                lines = [*UNSOUGHT, f"# {place}", ""]
                lines += [f"- [{path.name}/]({path.name}/index.md)" for path in inner]
                lines += [f"- [{path.name}]({path.name}.md)" for path in files]
                self.write(f"{place}/index.md", "\n".join([*lines, ""]))


def plain_lists(text: str) -> str:
    """Give a page with lists and tables as the generator reads them.

    It wants an empty line before each, and what belongs to an item of a numbered list indented by four.
    """
    lines = list[str]()
    code = numbered = False
    given = text.split("\n")
    for i, line in enumerate(given):
        code ^= line.lstrip().startswith("```")
        numbered = bool(re.match(r"\d+\. ", line)) or (numbered and (not line or line.startswith("   ")))
        before = lines[-1] if lines else ""
        if not code:
            item = re.match(r"[-*] ", line) and before and not re.match(r"[-*] | {2,}", before)
            table = re.match(r"\|[ |:-]+\|$", "".join(given[i + 1 : i + 2])) and not before.lstrip().startswith("|")
            if before and (item or table):
                lines.append("")
        lines.append(f" {line}" if numbered and re.match(r" {3}\S", line) else line)
    return "\n".join(lines)


# --- what is written from the code ------------------------------------------------------------------------------------


def commands() -> str:
    """Give the page of all commands, from what they say of themselves."""
    lines = ["# Commands", "", "For those who look up an option: each command as `camgeo COMMAND --help` describes it."]
    whole = helped()
    for name in ["", *re.findall(r"^    ([a-z]+) ", whole, re.MULTILINE)]:
        lines += ["", f"## camgeo {name}".rstrip(), "", "```text", helped(name) if name else whole, "```"]
    return "\n".join([*lines, ""])


def helped(*words: str) -> str:
    """What a command says of itself, in lines of a page's width."""
    surroundings = {**os.environ, "COLUMNS": "88", "NO_COLOR": "1", "PYTHONPATH": str(ROOT)}
    command = [sys.executable, "-m", "camgeo", *words, "--help"]
    done = subprocess.run(command, capture_output=True, text=True, check=True, env=surroundings)
    return done.stdout.rstrip()


def api() -> str:
    """Give the page of the library's public names, from their docstrings."""
    import camgeo

    names = [name for name in camgeo.__all__ if not name.startswith("_")]
    values = {name: getattr(camgeo, name) for name in names}
    errors = [n for n, v in values.items() if isinstance(v, type) and issubclass(v, BaseException)]
    classes = [n for n, v in values.items() if isinstance(v, type) and n not in errors]
    functions = [n for n in names if n not in errors and n not in classes]
    lines = [
        "# Public names of the library",
        "",
        "For those who look up one name; [the library](library.md) tells how they go together.",
    ]
    for title, group in (("Functions", functions), ("Classes", classes), ("Errors", errors)):
        lines += ["", f"## {title}"]
        for name in group:
            lines += ["", f"### `camgeo.{name}`", *documented(name, values[name])]
            if name in classes:
                lines += members(values[name])
    return "\n".join([*lines, ""])


def documented(name: str, value: object) -> list[str]:
    """Lines on one name: how it is called, and its docstring."""
    lines = [] if isinstance(value, type) else ["", "```python", f"{name}{signature(value)}", "```"]
    for part in inspect.cleandoc(value.__doc__ or "").split("\n\n"):
        drawn = re.search(r"^ {2,}|\S {2,}\S", part, re.MULTILINE)  # columns stay as they are
        lines += ["", "```text", part, "```"] if drawn else ["", escaped(part)]
    return lines


def escaped(text: str) -> str:
    """A plain text as Markdown; what stands in backticks is code there too."""
    plain = re.compile(r"([\\*_\[\]|])")
    parts = re.split(r"(`[^`]+`)", text)
    return "".join(p if p.startswith("`") else plain.sub(r"\\\1", html.escape(p, quote=False)) for p in parts)


def signature(value: object) -> str:
    """How a function is called."""
    return str(inspect.signature(value)).replace("'", "").removeprefix("(self, ").replace("(self)", "()")


def members(of: type) -> list[str]:
    """A table of what a class has of its own: name, and the first sentence of its docstring."""
    rows = []
    for name, value in inspect.getmembers(of):
        inherited = any(
            name in vars(base) for base in of.__mro__ if base.__module__.split(".")[0] not in {"camgeo", "kin"}
        )
        if name.startswith("_") or inherited or not (inspect.isfunction(value) or isinstance(value, property)):
            continue
        called = f"{name}()" if inspect.isfunction(value) else name
        first = " ".join(inspect.cleandoc(value.__doc__ or "").split("\n\n")[0].split())
        rows.append(f"| `{called}` | {escaped(first)} |")
    return ["", "| has | what it is |", "| --- | --- |", *rows] if rows else []


# --- the site ---------------------------------------------------------------------------------------------------------


def settings(menu: list[Section]) -> str:
    """Give the generator's settings; a JSON text is a TOML value here."""
    nav = ["{ Start = 'index.md' }"]
    for section in menu:
        pages = ", ".join(f"{{ {json.dumps(title)} = {json.dumps(page)} }}" for title, page, _ in section.pages)
        nav.append(f"{{ {json.dumps(section.title)} = [{pages}] }}")
    lines = ["[project]", 'site_name = "camgeo"', 'site_description = "Cams that move exactly as intended"']
    lines += ["use_directory_urls = false", f"nav = [{', '.join(nav)}]", 'extra_css = ["site.css"]']
    lines += ["[project.theme]", "font = false"]  # those of the reader's system: none is asked for
    lines += [
        'features = ["navigation.tabs", "navigation.top", "navigation.footer", "search.highlight", "content.code.copy"]'
    ]
    lines += ["[project.extra]", "generator = false"]
    lines += ["[project.markdown_extensions.tables]", "[project.markdown_extensions.sane_lists]"]
    lines += ["[project.markdown_extensions.toc]", "permalink = true"]
    lines += ['slugify = { object = "pymdownx.slugs.slugify", kwds = { case = "lower" } }']  # as GitHub does
    lines += ["[project.markdown_extensions.pymdownx.superfences]"]
    lines += ["[project.markdown_extensions.pymdownx.highlight]"]
    return "\n".join([*lines, ""])


CSS = """\
.md-typeset img { background: #fff; }
.md-typeset table:not([class]) :is(td, th) { padding: 0.5em 0.8em; }
.md-typeset table:not([class]) td code { overflow-wrap: normal; word-break: normal; }
.md-typeset table:not([class]) td:nth-child(n + 3):last-child:not([align]) { min-width: 12rem; }
.md-typeset table:not([class]) td:nth-child(2):not(:last-child, [align]) { min-width: 7rem; }
@media (max-width: 40em) {
  .md-typeset tbody:has(td[align]) { display: grid; grid-template-columns: 1fr 1fr; }
  .md-typeset tbody:has(td[align]) tr { display: contents; }
}
"""  # a wide table scrolls in its place, and no word is cut; in the gallery two pictures stand in a row of a telephone


def build(target: Path, pyodide: Path | None = None) -> str:
    """Make the site anew in a folder, and give a line on it; `pyodide` is Pyodide's folder, for the design page."""
    if target.exists() and not (target / MADE_BY).is_file():
        sys.exit(f"{target} is there and is no folder that this script has made: name another")
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        menu = gather(folder / "docs", with_design=pyodide is not None)
        (folder / "zensical.toml").write_text(settings(menu), encoding="utf-8")
        command = [sys.executable, "-m", GENERATOR, "build", "--clean", "--config-file", str(folder / "zensical.toml")]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode:
            sys.exit(done.stdout + done.stderr)
        made = folder / "site"
        give_words(made / "search.json", menu)
        (made / "404.html").unlink()  # it holds addresses from the root of a server, where the site need not stand
        (made / "sitemap.xml").unlink()  # empty, as nobody knows the site's address
        if pyodide is not None:
            design(made / DESIGN, pyodide)
        (made / MADE_BY).write_text("python tools/docs/make_site.py\n", encoding="utf-8")
        shutil.rmtree(target, ignore_errors=True)
        shutil.copytree(made, target)
    size = sum(path.stat().st_size for path in target.rglob("*") if path.is_file())
    left = "" if pyodide else "; without the page that designs in a browser: no Pyodide (--pyodide FOLDER)"
    return f"{target}: {len(list(target.rglob('*.html')))} pages, {size / 1e6:.1f} MB{left}"


def gather(folder: Path, *, with_design: bool) -> list[Section]:
    """Write the sources of all pages into a folder, and give the menu."""
    source = Source(folder)
    index = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    opens = f'<p><a href="{DESIGN}/index.html">Open the page</a>: it designs and judges in this browser.</p>\n'
    more = {"tab.md": opens, "index.md": opens} if with_design else {}
    more["library.md"] = "[Public names](api.md) has each with its docstring.\n"
    for path in sorted((ROOT / "docs").iterdir()):
        if path.suffix == ".md":
            source.page(f"docs/{path.name}", path.name, more.get(path.name, ""))
        elif path.is_dir():
            shutil.copytree(path, folder / path.name)
    for place, name in OTHERS.items():
        if place != "README.md":
            source.page(place, name)
    source.folders()
    source.write("api.md", api())
    source.write("commands.md", commands())
    source.write("site.css", CSS)
    menu = []
    for title, pages in sections(index):
        listed = [row._replace(page=source.place_of(posixpath.normpath(f"docs/{row.page}"))) for row in pages]
        for i, row in enumerate(listed):
            if row.page in WRITTEN:
                listed.insert(i + 1, WRITTEN[row.page])
        menu.append(Section(title, listed))
    return menu


def give_words(index: Path, menu: list[Section]) -> None:
    """Let the search find each page by the words of its row on the first page, before what stands in any text.

    The first page and the changes are not sought: both name nearly everything.
    """
    words = {re.sub(r"md$", "html", row.page): row.words for section in menu for row in section.pages}
    left_out = {"index.html", OTHERS["CHANGELOG.md"].replace(".md", ".html")}
    data = json.loads(index.read_text(encoding="utf-8"))
    data["items"] = [item for item in data["items"] if item["location"].partition("#")[0] not in left_out]
    for item in data["items"]:
        if item["location"] in words:
            item["path"].append(words[item["location"]])
    index.write_text(json.dumps(data, ensure_ascii=False), encoding="utf-8")


def design(target: Path, pyodide: Path) -> None:
    """Make the page that designs in a browser."""
    sys.path.insert(0, str(ROOT / "web"))
    import build as page

    page.build(target, pyodide, page.fetch(pyodide))


def zipped(folder: Path) -> bytes:
    """Give a site as a zip: the same folder gives the same bytes."""
    target = io.BytesIO()
    with ZipFile(target, "w", ZIP_DEFLATED, compresslevel=9) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                entry = ZipInfo(f"site/{path.relative_to(folder).as_posix()}", date_time=(2000, 1, 1, 0, 0, 0))
                archive.writestr(entry, path.read_bytes(), ZIP_DEFLATED, 9)
    return target.getvalue()


def main() -> None:
    """Make the site."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=SITE, help="made anew (default: site)")
    given = os.environ.get("CAMGEO_PYODIDE")
    text = "Pyodide's folder, for the page that designs in a browser (default: CAMGEO_PYODIDE; without: left out)"
    parser.add_argument("--pyodide", type=Path, default=Path(given) if given else None, metavar="FOLDER", help=text)
    parser.add_argument("--zip", type=Path, metavar="FILE", help="write the site as a zip too")
    arguments = parser.parse_args()
    if why_not():
        sys.exit(why_not())
    print(build(arguments.folder, arguments.pyodide))
    if arguments.zip:
        arguments.zip.write_bytes(zipped(arguments.folder))
        print(arguments.zip)


if __name__ == "__main__":
    main()
