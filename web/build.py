"""Gather camgeo as a page for a browser in one folder: `python web/build.py [FOLDER]`.

Any static server serves that folder, as docs/tab.md says. Taken are Pyodide by npm, numpy's wheel of the same
distribution, held to the checksum of its list, and camgeo with what it imports from the Python that runs this script.
"""

from __future__ import annotations

import argparse
import base64
import hashlib
import io
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import urllib.request
import zlib
from importlib import metadata
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple
from zipfile import ZIP_DEFLATED, ZipFile, ZipInfo

from examples import EXAMPLES

if TYPE_CHECKING:
    from camgeo.api.shown import Shown
    from camgeo.recipe.recipe import Order

ROOT = Path(__file__).resolve().parents[1]
WEB = ROOT / "web"
VERSION = "0.27.7"  # of Pyodide; before 0.27.3 it ends Safari on iOS
DISTRIBUTION = f"https://cdn.jsdelivr.net/pyodide/v{VERSION}/full"
RUNTIME = ("pyodide.mjs", "pyodide.asm.js", "pyodide.asm.wasm", "pyodide-lock.json")
LIBRARY = "python_stdlib.zip"
OTHERS = ("yaml", "ezdxf", "fontTools", "pyparsing", "typing_extensions")  # what camgeo needs besides numpy
FIRST_PACKAGES = ("yaml", "camgeo", "kin")  # what designs need of it; the others come when a file is made or read
UNUSED: tuple[str, ...] = ("*.so", "*.pyd", "__pycache__", "*.pyx", "*.pxd", "*.c", "*.cpp", "*.pyi")
# parts of ezdxf and fontTools that draw, convert and compile fonts, a third of both: nothing here imports them
UNUSED += ("addons", "varLib", "feaLib", "otlLib", "voltLib", "ufoLib", "cffLib", "designspaceLib", "subset", "merge")
UNUSED += ("tests", "conftest.py", "pytest_plugin.py", "__main__.py", "f2py", "_pyinstaller", "include", "*.a", "*.h")
# modules of Python and of numpy that no design imports: they come with those others
RARE: tuple[str, ...] = ("multiprocessing", "unittest", "xmlrpc", "pydoc", "mailbox", "tarfile", "http", "email", "xml")
RARE += ("_pyio", "imaplib", "ftplib", "smtplib", "poplib", "nntplib", "cgi", "doctest", "pdb", "optparse", "plistlib")
RARE_OF_NUMPY = ("numpy.random", "numpy.polynomial", "numpy.fft", "numpy.testing", "numpy.ctypeslib", "numpy.matlib")
DESIGNED: tuple[str, ...] = (
    "disc-roller",
    "disc-arm",
    "disc-flat",
    "disc-shoe",
    "disc-lobe",
    "disc-groove",
    "disc-conjugate",
    "support",
)
DESIGNED += ("constant-breadth", "constant-diameter", "double-roller", "flat-pair", "four-bar", "slider-crank")
MINOR = (3, 12)  # of Pyodide's Python, whose compiled modules it reads
# in the order in which they run
SCRIPTS: tuple[str, ...] = ("state.js", "view.js", "form.js", "joints.js", "draw.js", "compare.js", "files.js")
SCRIPTS += ("hand.js", "gif.js", "film.js", "solid.js")
LAST = "start.js"  # runs behind those of capabilities
PAPER = r"[A-Z]+ \d{4}"  # at the start of what a recipe says of itself, where it is a figure of a paper
FIRST = "disc-roller"  # the starter that stands there while the page loads
SITE = WEB / "site"


def main() -> None:
    """Build the folder."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", nargs="?", type=Path, default=SITE, help="made anew (default: web/site)")
    text = "where Pyodide is, or is put (default: CAMGEO_PYODIDE or .ci-pyodide)"
    default = Path(os.environ.get("CAMGEO_PYODIDE", ROOT / ".ci-pyodide"))
    parser.add_argument("--pyodide", type=Path, default=default, metavar="FOLDER", help=text)
    parser.add_argument("--fetch", action="store_true", help="get Pyodide and numpy, and build nothing")
    arguments = parser.parse_args()
    wheel = fetch(arguments.pyodide)
    if arguments.fetch:
        print(f"Pyodide {VERSION} is in {arguments.pyodide}")
        return
    print(f"{build(arguments.folder, arguments.pyodide, wheel)}; serve it, such as by")
    print(f"python3 -m http.server --bind 127.0.0.1 --directory {arguments.folder}")


# --- Pyodide ----------------------------------------------------------------------------------------------------------


def fetch(folder: Path) -> Path:
    """Have Pyodide and numpy's wheel in a folder, where they are not there yet; the wheel is returned.

    A wheel that is there already counts if it has the checksum of Pyodide's list.
    """
    folder.mkdir(parents=True, exist_ok=True)
    modules = folder / "node_modules" / "pyodide"
    described = modules / "package.json"
    if not described.is_file() or json.loads(described.read_text("utf-8"))["version"] != VERSION:
        if shutil.which("npm") is None:
            sys.exit(
                f"Pyodide comes by npm, which is not here: install Node.js, or have pyodide@{VERSION} in {modules}"
            )
        if not (folder / "package.json").is_file():
            (folder / "package.json").write_text('{"private": true}\n', "utf-8")
        command = ["npm", "install", "--silent", "--no-audit", "--no-fund", f"pyodide@{VERSION}"]
        subprocess.run(command, cwd=folder, check=True)
    entry = json.loads((modules / "pyodide-lock.json").read_text("utf-8"))["packages"]["numpy"]
    wheel = folder / entry["file_name"]
    if not wheel.is_file():
        address = f"{DISTRIBUTION}/{entry['file_name']}"
        try:
            with urllib.request.urlopen(address, timeout=120) as answer:
                data = answer.read()
        except OSError as error:
            sys.exit(f"{address}: {error}; put that file into {folder}")
        demand_sum(address, data, entry["sha256"])
        wheel.write_bytes(data)
    demand_sum(str(wheel), wheel.read_bytes(), entry["sha256"])
    return wheel


def demand_sum(name: str, data: bytes, wanted: str) -> None:
    """End with a message where bytes have another SHA-256 than Pyodide's list."""
    if hashlib.sha256(data).hexdigest() != wanted:
        sys.exit(f"{name}: not the file of Pyodide's list, which has the SHA-256 {wanted}; delete it and try again")


# --- Python -----------------------------------------------------------------------------------------------------------


def gather(target: Path, names: tuple[str, ...] = OTHERS) -> None:
    """Copy packages from this Python into a folder, without their compiled parts."""
    target.mkdir(exist_ok=True)
    for name in names:
        spec = find_spec(name)
        if spec is None or spec.origin is None:
            sys.exit(f"the package {name} is missing in {sys.executable}: run this with the Python that has camgeo")
        source = Path(spec.origin)
        if source.name == "__init__.py":
            shutil.copytree(source.parent, target / name, ignore=shutil.ignore_patterns(*UNUSED))
        else:
            shutil.copy(source, target)


def python_of_pyodide() -> str | None:
    """A Python of the version of Pyodide's; None where there is none."""
    name = ".".join(map(str, MINOR))
    if sys.version_info[:2] == MINOR:
        return sys.executable
    known = Path(os.environ.get("PYENV_ROOT", Path.home() / ".pyenv")) / "versions"
    kept = sorted(known.glob(f"{name}.*/bin/python3"))
    candidates = [*filter(None, [shutil.which(f"python{name}")]), *map(str, kept)]
    ask = f"import sys; sys.exit(sys.version_info[:2] != {MINOR})"
    return next(
        (
            path
            for path in candidates
            if subprocess.run([path, "-c", ask], check=False, stderr=subprocess.DEVNULL).returncode == 0
        ),
        None,
    )


def imported() -> set[str]:
    """Names of the modules that designs of many kinds import, with all that the page asks before a file is made."""
    program = """
import json, sys
sys.path.insert(0, sys.argv[1])
import live
from camgeo.recipe.starter import starter
for name in sys.argv[2:]:
    for call in ("picture", "design", "more", "absent"):
        live.answer(call, json.dumps({"name": name, "text": starter(name)}))
print(*sys.modules)
"""
    command = [sys.executable, "-c", program, str(WEB), *DESIGNED, *of_kinds()]
    return set(subprocess.run(command, check=True, capture_output=True, text=True).stdout.split())


def of_kinds() -> list[str]:
    """Starters of kinds of cams with recipes of their own that the page shows."""
    from camgeo.api.root import root_by_key
    from camgeo.recipe.starter import STARTERS
    from camgeo.registry.root import kinds

    return [name for name, entry in STARTERS.items() if entry.root in kinds() and root_by_key(entry.root).shown]


def packed() -> tuple[bytes, bytes]:
    """Zips of camgeo: with what designs import, and with its other modules, which come when they are imported.

    The source of each `__init__` stays in the first, and what capabilities answer, as these are listed by their files.
    """
    needed = imported()
    with tempfile.TemporaryDirectory() as name:
        folder, late = Path(name) / "first", Path(name) / "late"
        gather(folder, FIRST_PACKAGES)
        names = [*(other for other in OTHERS if other not in FIRST_PACKAGES), *RARE, *RARE_OF_NUMPY]
        for path in sorted(path for package in ("camgeo", "kin") for path in (folder / package).rglob("*.py")):
            place = path.relative_to(folder)
            module = ".".join(place.with_suffix("").parts)
            if (
                path.name == "__init__.py"
                or module in needed
                or re.search(r"(?m)^(ANSWERS|ROOT)\b", path.read_text("utf-8"))
            ):
                continue
            (late / place).parent.mkdir(parents=True, exist_ok=True)
            shutil.move(path, late / place)
            names.append(module)
        for script in ("live.py", "segments.py", "paper.py", "later.py"):
            shutil.copy(WEB / script, folder)
        (folder / "later.txt").write_text("\n".join(names), "utf-8")
        return compiled(folder, kept="__init__.py", level=2), compiled(late, level=2)


def repacked(archive: Path, rare: tuple[str, ...], level: int = 0) -> tuple[bytes, bytes]:
    """An archive of Python's or of a package's modules, such as a wheel, as two zips of compiled ones.

    The second has the modules and packages of the names `rare`, such as `numpy.fft`.
    """
    with tempfile.TemporaryDirectory() as name:
        folder, late = Path(name) / "first", Path(name) / "late"
        with ZipFile(archive) as held:
            held.extractall(Path(name) / "all")
        shutil.copytree(Path(name) / "all", folder, ignore=shutil.ignore_patterns(*set(UNUSED) - {"*.so"}))
        for one in rare:
            path = folder / one.replace(".", "/")
            there = path if path.is_dir() else path.with_suffix(".py")
            (late / there.relative_to(folder)).parent.mkdir(parents=True, exist_ok=True)
            shutil.move(there, late / there.relative_to(folder))
        return compiled(folder, level=level), compiled(late)


def others() -> bytes:
    """A zip of the packages with which files are made and read."""
    with tempfile.TemporaryDirectory() as name:
        gather(Path(name), tuple(other for other in OTHERS if other not in FIRST_PACKAGES))
        return compiled(Path(name))


def joined(parts: list[bytes]) -> bytes:
    """A zip with the contents of several."""
    target = io.BytesIO()
    with ZipFile(target, "w", ZIP_DEFLATED, compresslevel=9) as archive:
        for part in parts:
            with ZipFile(io.BytesIO(part)) as held:
                for entry in held.namelist():
                    archive.writestr(entry_of(entry), held.read(entry), ZIP_DEFLATED)
    return target.getvalue()


def compiled(folder: Path, kept: str = "", level: int = 0) -> bytes:
    """A zip of a folder with its modules compiled, where there is the right Python; files of the name `kept` stay.

    A page that is opened would else compile every module that it imports. `level` is Python's of optimizing: 2 leaves
    docstrings and assertions out. The same input gives the same bytes.
    """
    python = python_of_pyodide()
    if python is not None:
        command = [python, "-m", "compileall", "-q", "-b", "-s", str(folder), "-o", str(level)]
        command += ["--invalidation-mode", "unchecked-hash"]
        subprocess.run([*command, str(folder)], check=True)
        for path in folder.rglob("*.py"):
            (path.with_suffix(".pyc") if path.name == kept else path).unlink()
    target = io.BytesIO()
    with ZipFile(target, "w", ZIP_DEFLATED, compresslevel=9) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                archive.writestr(entry_of(str(path.relative_to(folder))), path.read_bytes(), ZIP_DEFLATED)
    return target.getvalue()


def licences() -> str:
    """The licences of everything that the folder holds."""
    texts = [
        f"Pyodide {VERSION}: Mozilla Public License 2.0, https://pyodide.org",
        (ROOT / "LICENSE").read_text("utf-8"),
    ]
    for name in ("numpy", "PyYAML", "ezdxf", "fonttools", "pyparsing", "typing_extensions"):
        package = metadata.distribution(name)
        kept = [path for path in package.files or () if path.name.upper().startswith(("LICENSE", "LICENCE", "COPYING"))]
        words = "\n\n".join(path.read_text("utf-8") for path in kept) or package.metadata["License"]
        texts.append(f"{name} {package.version}\n\n{words}")
    return f"\n\n{'=' * 72}\n\n".join(texts)


def entry_of(name: str) -> ZipInfo:
    """An entry of a zip without a time of its own."""
    return ZipInfo(name, date_time=(2000, 1, 1, 0, 0, 0))


# --- what is shown ----------------------------------------------------------------------------------------------------


def starters() -> list[dict[str, object]]:
    """Starters and shipped recipes of cams: name, task, title, text, tables that it names, and the picture."""
    from camgeo.recipe.starter import STARTERS, starter
    from camgeo.registry.root import CAM

    entries: list[dict[str, object]] = []
    of_kind = of_kinds()
    for name, entry in STARTERS.items():
        if (entry.root == CAM and entry.kind) or name in of_kind:
            text = starter(name)
            words = {"title": entry.title, "task": entry.task or name, "also": entry.also}
            entries.append({"name": name, **words, "text": text, "tables": {}, "picture": drawing(text)})
    for path, recipe in shipped():
        text = path.read_text("utf-8")
        picture = (ROOT / "docs" / "gallery" / f"{path.stem}.svg").read_text("utf-8")
        words = {"title": recipe.about, "task": path.stem, "also": ""}
        one = {"name": path.stem, **words, "text": text, "tables": tables_of(text), "picture": picture}
        entries.append({**one, "shipped": True})
    return entries


def tables_of(text: str) -> dict[str, str]:
    """Tables that a shipped recipe names, by their names."""
    return {name: (ROOT / "recipes" / name).read_text("utf-8") for name in re.findall(r"[\w.-]+\.csv\b", text)}


def shipped() -> list[tuple[Path, Order]]:
    """Shipped recipes of cams that the page shows, each with its file; figures of papers come last."""
    from camgeo.api.root import root_of
    from camgeo.recipe.loading import load_order

    pictured = {path.stem for path in (ROOT / "docs" / "gallery").glob("*.svg")}
    paths = (path for path in sorted((ROOT / "recipes").glob("**/*.yaml")) if path.stem in pictured)
    found = [(path, recipe) for path in paths if root_of(recipe := load_order(path)).shown is not None]
    return sorted(found, key=lambda pair: re.match(PAPER, pair[1].about or "") is not None)


def drawing(text: str) -> str:
    """The cam of a recipe at the begin of its motion, as a picture by itself."""
    return shown_of(text).still()


def shown_of(text: str) -> Shown:
    """The cam of a recipe as the page shows it."""
    from camgeo.api.root import root_of
    from camgeo.recipe.loading import load_order_text

    recipe = load_order_text(text, str(ROOT / "recipes" / "recipe.yaml"))
    shown = root_of(recipe).shown
    if shown is None:
        raise AssertionError(recipe)
    return shown(recipe)


class Card(NamedTuple):
    """A design that opens in the page: its link, its picture's address, title and words."""

    link: str
    picture: str
    title: str
    words: str


def examples(pictures: Path) -> list[Card]:
    """The examples for a lecture, without those whose recipes are not shipped; their pictures are put into a folder."""
    from camgeo.measures.units import UNIT_NAMES
    from camgeo.schema.change import set_value
    from camgeo.schema.yaml_source import Source

    cards = []
    for example in EXAMPLES:
        path = ROOT / "recipes" / f"{example.recipe}.yaml"
        if not path.is_file():
            continue
        text = other = path.read_text("utf-8")
        for place, value in example.kept.items():
            other = set_value(Source.of(other, example.called), place, value)
        cams = [shown_of(one) for one in (text, other)]
        now, kept = (cam.figures[example.figure] for cam in cams)
        unit = UNIT_NAMES.get(now.unit, now.unit).replace("deg", "°").replace("^2", "²")
        apart = "" if unit == "°" else " "
        name = example.figure.replace("-", " ")
        both = [f"{value:.3g}{apart}{unit}" for value in (now.value, kept.value)]
        told = f"{example.see} {name.capitalize()}: {both[0]}, dashed {both[1]}."
        picture = f"{path.stem}-example.svg"
        (pictures / picture).write_text(cams[0].still(example.at), "utf-8")
        link = link_to(path.stem, text, (example.called, other), example.at)
        cards.append(Card(link, f"pictures/{picture}", example.title, told))
    return cards


def link_to(name: str, text: str, kept: tuple[str, str] | None = None, at: float | None = None) -> str:
    """Address, from its own folder, at which the page shows a recipe, beside a kept one, by name and text, at a place.

    `web/state.js` reads and writes such addresses.
    """
    held: list[object] = [name, text, tables_of(text)]
    if kept is not None or at is not None:
        held.append(None if kept is None else [*kept, tables_of(kept[1])])
    if at is not None:
        held.append(at)
    packer = zlib.compressobj(9, zlib.DEFLATED, -15)
    packed = packer.compress(json.dumps(held, ensure_ascii=False, separators=(",", ":")).encode()) + packer.flush()
    letters = base64.urlsafe_b64encode(packed).decode().rstrip("=")
    return f"index.html#r={zlib.crc32(letters.encode()):08x}{letters}"


def card(of: Card) -> str:
    """HTML of a card."""
    picture = f'<img alt="" loading="lazy" src="{of.picture}">'
    return f'<li><a href="{of.link}">{picture}<b>{escaped(of.title)}</b> {escaped(of.words)}</a></li>'


def kinds(*contents: str) -> list[str]:
    """Ends of the names of files with such contents, drawings or solids, that a browser can read."""
    from kin.read.formats import FORMATS, suffixes

    return [end.lstrip(".") for end, kind in suffixes().items() if FORMATS[kind].contents in contents]


def with_parts() -> list[str]:
    """Capabilities that have a part of the page in a file of their name, beside its script."""
    from camgeo.registry import registry

    return [name for name in registry.labels() if (WEB / f"{name}.html").is_file()]


def scripts_of(names: list[str]) -> list[str]:
    """Scripts of the page with the parts of these capabilities, in the order in which they run."""
    return [*SCRIPTS, *(f"{name}.js" for name in names), LAST]


def judged_page(text: str) -> str:
    """The whole page of a recipe as `camgeo report` makes it."""
    import camgeo
    from camgeo.schema.change import set_value
    from camgeo.schema.yaml_source import Source

    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / f"{FIRST}.yaml"
        path.write_text(set_value(Source.of(text, FIRST), "export.files", ["html"]), "utf-8")
        report = camgeo.export(path, Path(folder) / "out")
        if report.path is None:
            raise AssertionError(report)
        return (report.path / f"{FIRST}.html").read_text("utf-8")


def build(target: Path, pyodide: Path, wheel: Path) -> str:
    """Make the folder anew, and say how large it is."""
    import camgeo
    from camgeo.report.page import looks as looks_of_drawings
    from camgeo.report.page import page
    from camgeo.report.page.asset import asset

    if target.exists() and not (target / "worker.js").is_file():
        sys.exit(f"{target} is there and is no folder that this script has made: name another")
    shutil.rmtree(target, ignore_errors=True)
    (target / "pyodide").mkdir(parents=True)
    (target / "pictures").mkdir()
    for name in RUNTIME:
        shutil.copyfile(pyodide / "node_modules" / "pyodide" / name, target / "pyodide" / name)
    library, rare = repacked(pyodide / "node_modules" / "pyodide" / LIBRARY, RARE, 2)
    (target / "pyodide" / LIBRARY).write_bytes(library)
    numpy, rare_of_numpy = repacked(wheel, RARE_OF_NUMPY)
    code, late = packed()
    shown = starters()
    gallery = []
    for entry in shown:
        picture = f"pictures/{entry['name']}{'-shipped' if 'shipped' in entry else ''}.svg"
        (target / picture).write_text(str(entry.pop("picture")), "utf-8")
        if "shipped" in entry:
            name, about = str(entry["name"]), str(entry["title"])
            gallery.append(Card(link_to(name, str(entry["text"])), picture, name, about))
    first = next(entry for entry in shown if entry["name"] == FIRST and "shipped" not in entry)
    text = str(first["text"])
    of_kind = of_kinds()
    cams = [text, *(str(entry["text"]) for entry in shown if entry["name"] in of_kind)]
    looks = dict.fromkeys(shown_of(cam).looks() for cam in cams)
    scene = dict(camgeo.design(camgeo.load(text)).scene())
    scene["name"] = FIRST
    here = with_parts()
    rules = asset("drawing.css") + looks_of_drawings.rules() + asset("page.css") + "".join(own for own, _ in looks)
    style = rules + (WEB / "tab.css").read_text("utf-8")
    files = {
        "camgeo.zip": code,
        "numpy.zip": numpy,
        "later.zip": joined([others(), late, rare, rare_of_numpy]),
        "tab.css": style.encode(),
        "page.js": "".join([asset("page.js"), *(code for _, code in looks)]).encode(),
        "licences.txt": licences().encode(),
        "starters.json": json.dumps(shown, ensure_ascii=False).encode(),
        **{name: (WEB / name).read_bytes() for name in ("worker.js", *scripts_of(here))},
    }
    for name, data in files.items():
        (target / name).write_bytes(data)
    frame = asset("page.html")
    parts = {
        "policy": policy([judged_page(cam) for cam in cams]),
        "stage": between(frame, '<div class="left">', '<section class="checks"'),
        "parts": "".join((WEB / f"{name}.html").read_text("utf-8") for name in here),
        "scripts": "".join(f'<script src="{name}?{{{{stamp:{name}}}}}" defer></script>\n' for name in scripts_of(here)),
        "note": "",
        "drawing": str(scene["drawing"]),
        "recipe": escaped(text),
        "scene": page.script_json(scene),
        "version": camgeo.__version__,
        "kinds": " ".join(kinds("drawing", "solid")),
        "drawings": " ".join(kinds("drawing")),
        **{f"stamp:{name}": hashlib.sha256(data).hexdigest()[:10] for name, data in files.items()},
    }
    (target / "index.html").write_text(filled((WEB / "index.html").read_text("utf-8"), parts), "utf-8")
    parts |= {"examples": "\n".join(map(card, examples(target / "pictures")))}
    parts |= {"gallery": "\n".join(map(card, gallery))}
    (target / "examples.html").write_text(filled((WEB / "examples.html").read_text("utf-8"), parts), "utf-8")
    size = sum(path.stat().st_size for path in target.rglob("*") if path.is_file())
    return f"{target}: {size / 1e6:.1f} MB"


def policy(pages: list[str]) -> str:
    """What the page may load, for its content security policy: its own files, and style and script of judged pages.

    Such a page stands in a frame, which takes the policy over, and its style and script are the same for every recipe
    of its kind. `pages` has one of each kind.
    """
    allowed = dict[str, list[str]]()
    for name in ("script", "style"):
        found = [re.findall(rf"<{name}>(.*?)</{name}>", page, re.DOTALL) for page in pages]
        allowed[name] = list(dict.fromkeys(hashed(text) for (text,) in found))
    return "; ".join(
        [
            "default-src 'none'",
            f"script-src 'self' 'wasm-unsafe-eval' {' '.join(allowed['script'])}",
            f"style-src 'self' {' '.join(allowed['style'])}",
            "img-src 'self' data: blob:",
            "connect-src 'self'",
            "worker-src 'self'",
            "frame-src 'self'",
            "base-uri 'none'",
            "form-action 'none'",
        ]
    )


def hashed(text: str) -> str:
    """The source expression of an inline script or style."""
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


def between(text: str, start: str, end: str) -> str:
    """What stands in a text from one mark up to another."""
    before, mark, rest = text.partition(start)
    inside, behind, _ = rest.partition(end)
    if not mark or not behind:
        raise AssertionError((start, end, before[:80]))
    return mark + inside


def filled(text: str, parts: dict[str, str]) -> str:
    """A text with its {{parts}} in their places, those within parts too."""
    once = re.sub(r"\{\{(stage|parts|scripts)\}\}", lambda mark: parts[mark[1]], text)
    return re.sub(r"\{\{([\w.:-]+)\}\}", lambda mark: parts[mark[1]], once)


def escaped(text: str) -> str:
    """A text as it stands in HTML."""
    return text.replace("&", "&amp;").replace("<", "&lt;")


if __name__ == "__main__":
    main()
