"""Every block of code of README.md, CONTRIBUTING.md and docs: recipes are made, commands are known, Python runs.

A YAML block with a `cam` is a recipe, and every check of it holds; one without is a part of a recipe, which is put
beside a cam and read. Commands are parsed, wherever they stand, also within a line; the starters that pages name are
written. Python runs in a folder with the shipped recipes, page by page.
"""

import configparser
import re
import shlex
import shutil
import sys
import tomllib
from dataclasses import replace
from functools import cache
from itertools import takewhile
from pathlib import Path
from types import SimpleNamespace
from typing import NamedTuple, get_args

import pytest
from support.cases import few
from support.starters import OF_CAMS

import camgeo
from camgeo.api.root import root_of
from camgeo.checks.declared import CHECKS
from camgeo.checks.extension import CHECKING
from camgeo.cli.main import main
from camgeo.measures.remarks import RemarkName
from camgeo.recipe.loading import load_order, read
from camgeo.recipe.recipe import root_key
from camgeo.recipe.starter import STARTERS, starters_for
from camgeo.registry import registry
from camgeo.registry.root import kinds, reading, top_keys
from camgeo.report.page.content import DRAWN
from camgeo.schema.yaml_source import read_source

ROOT = Path(__file__).parents[2]
PLAN = ROOT / "docs" / "architecture.md"
PAGES = sorted([ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")])
RUN_ELSEWHERE = {"library.md"}  # its Python has tests of its own
CAM = "cam: {kind: support, p: 25 + 2*cos(3*t)}\npart: {thickness: 8, bore: 10}\n"
OTHERS = ("pip", "pytest", "python", "python3", "ruff", "mypy", "cd", "git", "head", "apt-get", "grep")


class Block(NamedTuple):
    """One fenced block."""

    page: str
    line: int
    language: str
    text: str


@cache
def blocks():
    found = []
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        found += [
            Block(page.name, text.count("\n", 0, match.start()) + 2, match[1], match[2])
            for match in re.finditer(r"^```([^\n]*)\n(.*?)^```", text, re.MULTILINE | re.DOTALL)
        ]
    return found


def of(language, *, whole=None):
    """Blocks of a language as parameters; of YAML either the whole recipes or the parts."""
    chosen = [b for b in blocks() if b.language == language]
    if whole is not None:
        chosen = [b for b in chosen if bool(re.search(r"^cam:", b.text, re.MULTILINE)) is whole]
    return [pytest.param(b.text, id=f"{b.page}:{b.line}") for b in chosen]


def test_every_block_is_of_a_kind_that_is_tested():
    assert {b.language for b in blocks()} <= {"yaml", "sh", "python", "text", "ini", "toml"}
    assert len(blocks()) >= 40
    assert all(text.count("\n```") % 2 == 0 for text in (page.read_text(encoding="utf-8") for page in PAGES))


def shown(text):
    """The recipe of a block, of whatever kind."""
    source = read_source(text.encode(), "shown.yaml")
    return reading(root_key(source)).read(source, Path("shown.yaml"))


@pytest.mark.thin(4)
@pytest.mark.parametrize("text", of("yaml", whole=True))
def test_a_recipe_is_read(text):
    shown(text)


@pytest.mark.thin(40)
@pytest.mark.parametrize("text", few(of("yaml", whole=True), 4))
def test_a_recipe_is_made_and_passes(text):
    recipe = shown(text)
    # a verdict at fewer angles is enough here
    recipe = replace(recipe, verify=replace(recipe.verify, angles=360))
    outcome = root_of(recipe).check(recipe, lambda _: None)
    assert outcome.ok, [check for check in outcome.report["checks"] if not check["ok"]]


OF_A_KIND = rf"^({'|'.join(('cam', *top_keys()))}):"


def test_a_part_of_a_recipe_is_read_beside_a_cam():
    for block in blocks():
        if block.language == "yaml" and not re.search(OF_A_KIND, block.text, re.MULTILINE):
            rest = CAM if "part:" not in block.text else CAM.splitlines()[0] + "\n"
            read((rest + block.text).encode(), f"{block.page}:{block.line}")


# needs: camshaft
def test_a_camshaft_is_read_beside_its_lobes(tmp_path):
    shown = [block for block in blocks() if block.language == "yaml" and block.text.startswith("camshaft:")]
    assert shown
    for block in shown:
        for name in re.findall(r"recipe: ([a-z-]+\.yaml)", block.text):
            source = "intake.yaml" if name in {"intake.yaml", "exhaust.yaml"} else "seal.yaml"
            shutil.copy(ROOT / "recipes" / "camshafts" / source, tmp_path / name)
        path = tmp_path / "shaft.yaml"
        path.write_text(block.text, encoding="utf-8")
        assert load_order(path).parts


# --- commands ---------------------------------------------------------------------------------------------------------


def commands(text):
    """Commands of lines of a shell: without comments and files for output, each of those joined by `&&` for itself."""
    for line in text.replace("\\\n", " ").splitlines():
        words = shlex.split(line, comments=True)
        while words:
            end = words.index("&&") if "&&" in words else len(words)
            yield list(takewhile(lambda word: word != ">", words[:end]))
            words = words[end + 1 :]


PLACES = {"RECIPE": "cam.yaml", "FILE": "cam.dxf", "KIND": "support", "N": "2", "DIR": "out"}


def parsed(words):
    """What argparse makes of a command, placeholders such as RECIPE... replaced; None for a command that is unknown."""
    from camgeo.cli.main import _parser

    plain = [word.rstrip(".]").lstrip("[") if word.rstrip(".]").lstrip("[").isupper() else word for word in words]
    call = [PLACES.get(word, word) for word in plain]
    return _parser(call).parse_args(call)


def spoken():
    """Commands of camgeo that stand in backticks, in shell blocks, and in tables of text."""
    for page in PAGES:
        text = page.read_text(encoding="utf-8")
        prose = re.sub(r"^```.*?^```", "", text, flags=re.MULTILINE | re.DOTALL)
        for quoted in re.findall(r"`(?:\.venv/bin/)?(camgeo [a-z][^`]*)`", prose):
            yield page.name, shlex.split(" ".join(quoted.split()))
    for block in blocks():
        if block.language == "sh":
            yield from ((block.page, words) for words in commands(block.text))
        elif block.language == "text":
            lines = re.findall(r"^camgeo [a-z].*?(?=  |$)", block.text, re.MULTILINE)
            yield from ((block.page, shlex.split(line)) for line in lines)


def complaint(words, capsys, *, prose=False):
    """What the parser says against a command; prose may speak of `camgeo export --json` without saying of what."""
    said = ""
    for rest in ([], ["RECIPE"], ["RECIPE", "FILE"]) if prose else ([],):
        try:
            parsed([*words, *rest])
        except SystemExit as left:
            said = said or (capsys.readouterr().err if left.code else "")
        else:
            return ""
    capsys.readouterr()
    return said


def test_every_command_of_camgeo_is_known(capsys):
    seen = set()
    said = {tuple(words): page for page, words in spoken()}  # once, however many pages say it
    for (first, *words), page in said.items():
        if Path(first).name != "camgeo":
            continue
        assert complaint(words, capsys, prose=True) == "", f"{page}: camgeo {shlex.join(words)}"
        if words[0] == "new" and len(words) > 1 and words[1].islower() and not words[1].startswith("-"):
            assert words[1] in STARTERS or starters_for(words[1]), f"{page}: camgeo {shlex.join(words)}"
        seen.add(words[0])
    capsys.readouterr()
    added = [command for label in registry.labels().values() for command in label.commands]
    assert seen >= {"export", "check", "verify", "report", "new", "laws", "schema", *added}


def test_an_unknown_command_is_found(capsys):
    for words in (["exprot"], ["exprot", "RECIPE"], ["export", "RECIPE", "--fast"], ["export", "RECIPE", "--jobs"]):
        assert "error" in complaint(words, capsys)
    assert complaint(["export", "RECIPE...", "--jobs", "N"], capsys) == ""


def test_other_commands_name_what_is_there():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    for block in (b for b in blocks() if b.language == "sh"):
        for words in commands(block.text):
            name = Path(words[0]).name
            assert name in {*OTHERS, "camgeo", "run"}, f"{block.page}:{block.line}: {words[0]}"
            for word in words[1:]:
                if word.endswith((".py", ".yaml")) and "/" in word:
                    assert (ROOT / word).is_file(), f"{block.page}:{block.line}: {word}"
                for extra in re.findall(r"^\.\[(.*)\]$", word):
                    assert set(extra.split(",")) <= set(extras), f"{block.page}:{block.line}: {word}"


def test_the_starters_that_pages_name_are_written(capsys):
    text = (ROOT / "docs" / "which-cam.md").read_text(encoding="utf-8")
    named = {
        name
        for cell in re.findall(r"^\|.*\| `camgeo new (.*?) \|(?: <!-- .* -->)?$", text, re.MULTILINE)
        for name in cell.split("`, `")
    }
    others = {name for name, each in STARTERS.items() if each.root in kinds()}
    assert {name.rstrip("`") for name in named} == {*OF_CAMS, *others}
    assert main(["new", "support"]) == 0
    read(capsys.readouterr().out.encode(), "starter.yaml")


def test_the_readme_prints_what_its_recipe_gives(tmp_path, capsys):
    recipe = next(b.text for b in blocks() if b.page == "README.md" and b.language == "yaml")
    (tmp_path / "lifter.yaml").write_text(recipe, encoding="utf-8")
    assert main(["check", str(tmp_path / "lifter.yaml")]) == 0
    (shown,) = [b.text for b in blocks() if b.page == "README.md" and b.text.startswith("lifter: ")]
    assert capsys.readouterr().out == shown


# --- Python, and settings ---------------------------------------------------------------------------------------------


def write_named(folder):
    """Write the blocks whose first line names a file, such as `# valve.yaml`, each to that file."""
    for block in blocks():
        named = re.match(r"# ([a-z-]+\.yaml)\b", block.text)
        if named:
            (folder / named[1]).write_text(block.text, encoding="utf-8")


@pytest.fixture(scope="module")
def workshop(tmp_path_factory):
    """The shipped recipes, those that pages name, and a cam that came back."""
    folder = tmp_path_factory.mktemp("workshop")
    shutil.copytree(ROOT / "recipes", folder / "recipes")
    assert main(["export", str(folder / "recipes" / "shu-wu.yaml"), "--out", str(folder / "out")]) == 0
    write_named(folder)
    (folder / "returned").mkdir()
    for kind in ("dxf", "stl"):
        shutil.copy(folder / "out" / "shu-wu" / f"shu-wu.{kind}", folder / "returned" / f"cam.{kind}")
    return folder


def scripts():
    return sorted({b.page for b in blocks() if b.language == "python"} - RUN_ELSEWHERE)


@pytest.mark.thin(4)
@pytest.mark.parametrize("page", few(scripts(), 3))
def test_python_runs(page, workshop, monkeypatch):
    monkeypatch.chdir(workshop)
    names = {}
    for block in blocks():
        if (block.page, block.language) == (page, "python"):
            exec(compile("\n" * (block.line - 1) + block.text, block.page, "exec"), names)
            if file := re.match(r"# (camgeo/\S+)\.py\n", block.text):  # a module that later blocks import
                module = SimpleNamespace(**names)
                monkeypatch.setitem(sys.modules, file[1].replace("/", "."), module)
    tests = [value for name, value in names.items() if name.startswith("test_")]
    for test in tests:
        test()
    assert names


def called():
    """Commands of camgeo of each page's shell blocks."""
    found = {}
    for block in (b for b in blocks() if b.language == "sh"):
        mine = [words[1:] for words in commands(block.text) if Path(words[0]).name == "camgeo"]
        found.setdefault(block.page, []).extend(mine)
    slow = {"sweep": (pytest.mark.slow,)}  # it draws, which takes seconds to begin with
    return [pytest.param(lines, id=page, marks=slow.get(lines[-1][0], ())) for page, lines in found.items() if lines]


@pytest.mark.thin(4)
@pytest.mark.parametrize("lines", few(called(), 3))
def test_commands_of_shell_blocks_run(lines, workshop, monkeypatch, capsys):
    monkeypatch.chdir(workshop)
    for words in lines:
        assert main(words) == 0, (words, capsys.readouterr().err)


# needs: camshaft
@pytest.mark.slow
def test_the_camshaft_of_its_page_is_made_of_the_lobe_beside_it(workshop, tmp_path):
    report = camgeo.export(workshop / "single.yaml", tmp_path)
    assert report.ok
    told = {"phase", "position", "shaft", "journal", "bore", "thickness", "volume"}
    assert {check.name for check in report.checks} >= told
    assert {path.suffix for path in report.path.iterdir()} == {".stl", ".3mf", ".svg", ".csv", ".html", ".json"}


def test_settings_are_read():
    for block in blocks():
        if block.language == "toml":
            assert tomllib.loads(block.text)
        elif block.language == "ini":
            settings = configparser.ConfigParser()
            settings.read_string(block.text)
            assert settings.sections()


# --- links ------------------------------------------------------------------------------------------------------------


def anchors(page):
    """Anchors of a page's headings, as GitHub makes them."""
    heads = re.findall(r"^#+ (.*)$", page.read_text(encoding="utf-8"), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", head.replace("`", "").lower()).replace(" ", "-") for head in heads}


def test_every_link_leads_somewhere():
    broken = []
    for page in PAGES:
        for target in re.findall(r"\]\(([^)\s]+)\)", page.read_text(encoding="utf-8")):
            if target.startswith(("http://", "https://")):
                continue
            path, _, anchor = target.partition("#")
            there = (page.parent / path).resolve() if path else page
            if not there.exists() or (anchor and anchor not in anchors(there)):
                broken.append(f"{page.name}: {target}")
    assert broken == []


def test_every_page_is_linked_from_the_first_one():
    text = (ROOT / "docs" / "index.md").read_text(encoding="utf-8")
    pages = {page.name for page in (ROOT / "docs").glob("*.md")} - {"index.md"}
    assert [page for page in sorted(pages) if f"]({page}) |" not in text] == []
    assert all(f"](../{page})" in text for page in ("CONTRIBUTING.md", "CHANGELOG.md"))
    assert "](docs/index.md)" in (ROOT / "README.md").read_text(encoding="utf-8")


def test_the_plan_of_the_house_names_what_is_there():
    """Each path and module of docs/architecture.md and CONTRIBUTING.md is there, and so is each package of the code."""
    for name in ("docs/architecture.md", "CONTRIBUTING.md"):
        text = (ROOT / name).read_text(encoding="utf-8")
        paths = re.findall(r"`((?:kin|camgeo|tests|benchmarks|docs|recipes)/[\w./-]*)`", text)
        assert paths
        assert [path for path in paths if not (ROOT / path).exists()] == []
        modules = re.findall(r"`((?:kin|camgeo)(?:\.[a-z_]+)+)`", text)
        assert [
            module
            for module in modules
            if not any((ROOT / (module.replace(".", "/") + end)).exists() for end in ("", ".py"))
        ] == []
    plan = PLAN.read_text(encoding="utf-8")
    packages = [path.name for top in ("kin", "camgeo") for path in (ROOT / top).iterdir() if [*path.glob("*.py")]]
    assert [name for name in packages if f"**{name}**" not in plan] == []


def test_the_drawing_of_the_layers_is_that_of_the_contracts():
    (drawing,) = re.findall(r"^```text\n(.*?)^```", PLAN.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL)
    rows = [row[:53].partition("   ")[0] for row in drawing.split("\n")]
    drawn = [set(re.findall(r"\w+", row)) for row in rows[2:] if row]
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    contracts = settings["tool"]["importlinter"]["contracts"]
    (layers,) = [contract["layers"] for contract in contracts if contract.get("containers") == ["camgeo"]]
    assert drawn == [set(re.findall(r"\w+", layer)) for layer in layers if layer != "__main__"]


def test_the_report_page_names_every_check():
    text = (ROOT / "docs" / "report.md").read_text(encoding="utf-8")
    assert [name for name in CHECKS.among(()) if f"`{name}`" not in text] == []


@pytest.mark.parametrize("name", CHECKING.answering())
def test_the_page_of_a_capability_names_its_checks(name):
    page = ROOT / "docs" / f"{name}.md"
    page = page if page.is_file() else page.with_name("report.md")
    text = page.read_text(encoding="utf-8")
    assert [one.name for one in CHECKING[name].checks if f"`{one.name}`" not in text] == []


def test_the_report_page_names_every_follower_and_every_remark():
    text = (ROOT / "docs" / "report.md").read_text(encoding="utf-8")
    (followers,) = re.findall(r"^\| `follower` \| (.*) \|$", text, re.MULTILINE)
    alone = {f"{drawn.guide.word} {drawn.touch.word}" for drawn in DRAWN if drawn.contacts == 1}
    others = {"yoke", "square frame", "double roller", "flat pair", "roller yoke"}
    assert set(re.findall(r"`([^`]*)`", followers)) == alone | others
    table = text.partition("| name | made where |")[2].partition("\n\n")[0]
    named = [name for cell in re.findall(r"^\| (`.*?) \|", table, re.MULTILINE) for name in cell.split(", ")]
    assert sorted(name.strip("`") for name in named) == sorted(get_args(RemarkName))


def test_the_glossary_has_each_term_once_in_order():
    rows = re.findall(r"^\| (.*?) \|", (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8"), re.MULTILINE)[2:]
    assert len(rows) >= 60
    assert rows == sorted(rows, key=str.lower)
    assert len(set(rows)) == len(rows)


def test_every_table_has_as_many_cells_in_each_row():
    uneven = []
    for page in PAGES:
        text = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
        for table in re.findall(r"(?:^\|.*\n)+", text, re.MULTILINE):
            counts = {len(re.findall(r"(?<!\\)\|", row)) for row in table.splitlines()}
            uneven += [f"{page.name}: {table.splitlines()[0]}"] if len(counts) > 1 else []
    assert uneven == []
