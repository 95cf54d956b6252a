"""The live page in a real browser: what it shows agrees with camgeo here, and what goes wrong is told and survived."""

from __future__ import annotations

import gzip
import json
import math
import shutil
from typing import TYPE_CHECKING
from zipfile import ZipFile

import pytest
from support import tab
from support.browser import Browser
from support.meshfiles import text, triangles_in
from support.places import RECIPES, SHIPPED
from support.starters import OF_CAMS

import camgeo
from camgeo.recipe.starter import STARTERS, starter

if TYPE_CHECKING:
    from pathlib import Path

TEXTS = {name: starter(name) for name in OF_CAMS} | {path.name: path.read_text("utf-8") for path in SHIPPED}

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]


MOST = 12e6  # bytes, compressed, to the first verdict


def test_a_picture_stands_there_before_python_and_little_comes_for_the_verdict(
    address: str, site: Path, tmp_path: Path
) -> None:
    tab.ASKED.clear()
    with Browser(tmp_path) as browser:
        browser.size(390, 844, mobile=True)
        browser.open(address)
        assert browser.ask("document.body.dataset.loaded") is None
        assert browser.ask("document.querySelectorAll('#drawing .body').length") >= 4
        assert browser.ask("document.querySelectorAll('.plot').length") >= 5
        assert browser.ask("byId('loading').hidden") is False
        page = tab.Tab(browser, address)
        page.wait("document.body.dataset.loaded")
        page.settle()
        assert page.text_of("verdict") == "every check of the design holds"
    asked = [site / (name.lstrip("/") or "index.html") for name in tab.ASKED]
    assert site / "camgeo.zip" in asked
    assert site / "later.zip" not in asked
    assert sum(len(gzip.compress(path.read_bytes())) for path in set(asked)) < MOST


def test_it_loads_from_its_own_server_alone_and_without_complaint(page: tab.Tab) -> None:
    assert page.text_of("verdict") == "every check of the design holds"
    assert page.browser.problems == []
    assert {url for url in page.browser.requests if not url.startswith((page.address, "data:", "about:"))} == set()


def test_starters_have_pictures_and_begin_a_recipe(page: tab.Tab) -> None:
    page.ask("byId('begin').open = true")
    page.wait("document.querySelectorAll('#shipped li').length > 0")
    kinds = ("linear", "cylindrical", "indexing")  # recipes of their own
    others = [name for name, each in STARTERS.items() if each.root in kinds]
    others += [path.name for kind in kinds for path in (RECIPES / kind).glob("*.yaml")]
    assert page.ask("document.querySelectorAll('.starters li').length") == len(TEXTS) + len(others)
    missing = """(async () => {
      const pictures = [...document.querySelectorAll(".starters img")].map((one) => one.src);
      const answers = await Promise.all(pictures.map((address) => fetch(address)));
      return answers.filter((answer) => !answer.ok).map((answer) => answer.url).join(" ");
    })()"""
    assert page.ask(missing) == ""
    page.ask("byId('find').value = 'swings roller'; byId('find').dispatchEvent(new Event('input'))")
    shown = page.ask(
        "[...document.querySelectorAll('#starters li:not([hidden])')].map((one) => one.dataset.name).join(' ')"
    )
    assert shown == "disc-arm cylindrical-arm"
    page.ask("document.querySelector('#starters li:not([hidden]) button').click()")
    page.settle()
    assert page.text == TEXTS["disc-arm"]
    assert page.text_of("verdict") == "every check of the design holds"


CHECKS = """(async () => {{
  const answer = await work.ask("design", {{ name: {}, text: {} }}, {});
  if (!answer.scene) return JSON.stringify(answer.faults);
  const {{ checks, plots }} = answer.scene;
  return JSON.stringify([checks.map(({{ name, ok, value }}) => [name, ok, value]), plots.map((plot) => plot.title)]);
}})()"""


@pytest.mark.parametrize("name", TEXTS)
def test_starters_and_shipped_recipes_have_the_figures_that_they_have_here(page: tab.Tab, name: str) -> None:
    recipe = TEXTS[name]
    tables = {path.name: path.read_text("utf-8") for path in RECIPES.glob("*.csv") if path.name in recipe}
    files = ",".join(
        f"{json.dumps(key)}: new TextEncoder().encode({json.dumps(value)})" for key, value in tables.items()
    )
    checks, titles = json.loads(page.ask(CHECKS.format(json.dumps("x"), json.dumps(recipe), f"{{{files}}}")))
    path = RECIPES / name
    scene = camgeo.design(camgeo.load(path if path.exists() else recipe)).scene()
    here = scene["checks"]
    assert [check[:2] for check in checks] == [[check["name"], check["ok"]] for check in here]
    for (_, _, there), check in zip(checks, here, strict=True):
        value = check["value"]
        assert there == (value if value is None else pytest.approx(value, rel=1e-9, abs=1e-9))
    assert titles == [plot["title"] for plot in scene["plots"]]


def test_a_slider_moves_its_number_alone_and_what_belongs_to_it(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.slide("cam.base_radius", 41.5)
    assert page.text == TEXTS["disc-roller"].replace("base_radius: 36 ", "base_radius: 41.5 ")
    page.slide("cam.motion[0].over", 90)
    assert "over: 90," in page.text
    assert "{dwell: 70}" in page.text  # the turn stays whole
    page.slide("cam.motion[0].rise", 16)
    assert "{return: 16," in page.text  # and the follower comes back
    assert page.text_of("verdict") == "every check of the design holds"
    for _ in range(3):
        page.press("undo")
    assert page.text == TEXTS["disc-roller"]
    page.press("redo")
    assert "41.5" in page.text


def test_boxes_take_commas_units_and_words(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.enter("cam.base_radius", "1,5 in")
    assert "base_radius: 1.5 in " in page.text
    page.enter("cam.motion[0].law", "cycloidal")
    assert "{rise: 20, over: 110, law: cycloidal}" in page.text
    page.tick("export.files", "3mf")
    page.tick("export.files", "csv")
    assert "files: [dxf, svg, stl, html, 3mf]" in page.text
    assert page.text_of("verdict") == "every check of the design holds"
    page.load("support", TEXTS["support"])
    page.enter("cam.p", "26 + 2*cos(3*t)")
    assert "26 + 2*cos(3*t)" in page.text
    assert page.text_of("faults") == ""


def test_the_unit_changes_all_lengths(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.choose("unit", "inch")
    page.wait("recipe.text.includes('units: inch')")
    page.settle()
    assert "base_radius: 1.41732" in page.text
    assert page.ask("document.querySelector('[data-path=\"cam.base_radius\"] .unit').textContent") == "in"
    page.choose("unit", "mm")
    page.wait("recipe.text.includes('units: mm')")
    page.settle()
    assert "base_radius: 36" in page.text


def test_a_broken_recipe_has_its_faults_at_their_lines(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.write(page.text.replace("cycloidal", "cycloidl").replace("bore: 10", "bore: [10"))
    with pytest.raises(camgeo.RecipeErrors) as broken:
        camgeo.load(page.text)
    assert f"line {broken.value.errors[0].line}: YAML cannot be read" in page.text_of("faults")
    page.write(TEXTS["disc-roller"].replace("cycloidal", "cycloidl").replace("base_radius: 36", "base_radius: 36 ell"))
    numbers = [str(i + 1) for i, line in enumerate(page.text.split("\n")) if "cycloidl" in line or "36 ell" in line]
    assert page.text_of("verdict") == "2 faults in the recipe"
    assert "did you mean cycloidal" in page.text_of("faults")
    lines = page.ask("[...document.querySelectorAll('#lines .bad')].map((one) => one.textContent).join(' ')")
    assert lines.split() == numbers
    page.ask("document.querySelector('#faults button').click()")
    assert page.ask("document.activeElement.id") == "text"
    assert page.ask("recipe.text.slice(byId('text').selectionStart).startsWith('36 ell')")
    page.write("")
    assert "the recipe is empty" in page.text_of("faults")
    page.write(TEXTS["disc-roller"])
    assert page.text_of("verdict") == "every check of the design holds"


def test_a_cam_that_undercuts_says_where_and_what_would_do(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.slide("cam.follower.radius", 18)
    page.slide("cam.motion[0].over", 60)
    page.slide("cam.base_radius", 7)
    assert page.text_of("verdict") == "2 checks of 4 fail, 1 remark"
    assert "would be free of it" in page.text_of("failed")
    assert page.ask("document.querySelectorAll('#drawing .mark.failed').length") == 2
    assert page.ask("byId('why').hidden") is False
    page.ask("document.querySelector('#failed .go').click()")
    assert float(page.ask("document.documentElement.dataset.at")) == pytest.approx(51.08, abs=0.01)


def test_files_are_made_judged_and_downloaded(page: tab.Tab, tmp_path: Path) -> None:
    page.load("support", TEXTS["support"])
    page.browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    page.written()
    before = page.ask("history.length")
    page.judged("make")
    assert page.ask("history.length") == before  # the judged page is no entry
    assert page.text_of("outcome").startswith("support: ok")
    names = page.ask("[...document.querySelectorAll('#files a')].map((one) => one.download).join(' ')").split()
    assert names == [*(f"support.{end}" for end in ("csv", "dxf", "html", "stl", "svg")), "report.json"]
    page.saved("zip", tmp_path / "support.zip")
    with ZipFile(tmp_path / "support.zip") as archive:
        assert sorted(archive.namelist()) == sorted(f"support/{name}" for name in [*names, "support.yaml"])
        archive.extractall(tmp_path)
    assert camgeo.verify(tmp_path / "support/support.yaml", tmp_path / "support/support.dxf").ok
    assert json.loads((tmp_path / "support/report.json").read_text("utf-8"))["ok"]
    assert page.browser.problems == []


# needs: follow
def test_somebodys_file_is_judged_and_followed(page: tab.Tab, tmp_path: Path) -> None:
    report = camgeo.export(camgeo.load(TEXTS["disc-roller"]), tmp_path, only=["dxf"])
    page.load("disc-roller", TEXTS["disc-roller"])
    page.drop("somebody's cam.dxf", (report.path / "recipe.dxf").read_bytes())
    page.judged("verify")
    assert page.text_of("outcome").startswith("disc-roller: ok")
    page.enter("cam.base_radius", "36.2")
    page.judged("verify")
    assert "FAILED" in page.text_of("outcome")
    page.ask("byId('radius').value = '18'; byId('offset').value = '8,0'")  # the diameter, as people say it
    page.judged("follow")
    assert "lift 20 mm" in page.text_of("outcome")
    page.ask("document.querySelector('#next button.main').click()")
    page.wait("recipe.text.includes('reading: 0.01')")
    page.settle()
    assert page.text_of("verdict") == "every check of the design holds"


# needs: follow
SHOWN = "Object.keys(followerBoxes()).filter((id) => !byId(id).labels[0].hidden).join(' ')"


# needs: follow
def test_a_follower_has_the_boxes_that_it_needs(page: tab.Tab, tmp_path: Path) -> None:
    report = camgeo.export(camgeo.load(TEXTS["disc-flat"]), tmp_path, only=["dxf"])
    page.load("disc-flat", TEXTS["disc-flat"])
    page.drop("flat.dxf", (report.path / "recipe.dxf").read_bytes())
    assert page.text_of("chosen") == "flat.dxf"
    assert page.ask(SHOWN) == "radius size offset yoke track across"
    page.choose("led", "arm")
    assert page.ask(SHOWN) == "radius size pivot arm side track across"
    page.choose("led", "stem")
    page.choose("touch", "flat")
    assert page.ask(SHOWN) == "width offset yoke across"
    page.ask("byId('width').value = '20,5'; byId('offset').value = '0'")
    page.worked("follow")
    assert "width" in page.text_of("file-faults")  # which one is needed
    page.ask("byId('width').value = '34'")
    page.judged("follow")
    assert "a centred face is" in page.text_of("outcome")
    assert page.text_of("busy").endswith("see above")
    page.ask("byId('gap').value = '1'; byId('across').value = 'arc'")
    page.drop("flat.stl", b"no solid")
    assert page.text_of("chosen") == "flat.stl"
    assert page.ask(SHOWN) == "width offset yoke"
    assert page.ask("byId('gap').labels[0].hidden && !givenGap() && !follower().across")  # a solid has no ends


def test_files_that_a_browser_cannot_make_say_so_before_and_after(page: tab.Tab) -> None:
    page.load("support", TEXTS["support"])
    ticks = "[...document.querySelectorAll('.ticks label:has(small)')].map((one) => one.textContent).join(', ')"
    page.wait(f"{ticks} === 'step not in a browser, sheet not in a browser'")  # needs: sheet
    page.tick("export.files", "step")
    page.judged("make")
    assert "support.step cannot be made in a browser: a STEP file needs Open CASCADE" in page.text_of("outcome")
    assert "camgeo export support.yaml" in page.text_of("outcome")


# needs: follow
@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("cam.dxf", b"no drawing at all", "cam.dxf"),
        ("cam.stl", bytes(84), "cam.stl"),
    ],
)
def test_a_wrong_file_is_told(page: tab.Tab, name: str, data: bytes, words: str) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.drop(name, data)
    page.worked("follow")
    assert words in page.text_of("file-faults")
    assert page.text_of("verdict") == "every check of the design holds"  # it is no fault of the recipe
    page.slide("cam.base_radius", 40)
    assert page.text_of("verdict") == "every check of the design holds"


# needs: follow
def test_what_no_reader_knows_is_refused_when_it_is_dropped_and_a_table_is_offered_as_the_motion(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.drop("cam.pdf", b"%PDF-1.7")
    assert "cam.pdf is nothing that this page reads" in page.text_of("notice")
    assert "dxf, svg, stl" in page.text_of("notice")
    assert page.ask("byId('with-file').hidden")
    rows = "".join(f"{angle},{10 - 10 * math.cos(math.radians(angle)):.6f}\n" for angle in range(0, 361, 2))
    page.drop("lift.csv", f"angle,lift\n{rows}".encode())
    page.settle()
    assert page.ask("byId('notice').classList.contains('news')")  # no fault
    page.ask("document.querySelector('#notice button').click()")
    page.settle()
    assert "table: lift.csv" in page.text
    assert page.text_of("faults") == ""
    assert page.text_of("verdict").startswith("every check of the design holds")
    page.press("undo")
    assert page.text == TEXTS["disc-roller"]


def test_a_file_of_five_megabytes_is_judged(page: tab.Tab, tmp_path: Path) -> None:
    recipe = TEXTS["disc-roller"].replace("files: [dxf, svg, stl, csv, html]", "files: [{stl: {tolerance: 4e-6}}]")
    report = camgeo.export(camgeo.load(recipe), tmp_path)
    data = text(tmp_path / "large.stl", triangles_in(report.path / "recipe.stl")).read_bytes()
    assert len(data) > 5e6
    page.load("disc-roller", recipe)
    page.drop("large.stl", data)
    page.choose("units", "mm")
    page.judged("verify")
    assert page.text_of("outcome").startswith("disc-roller: ok")


def test_a_failure_of_its_own_is_told_and_the_next_recipe_is_drawn(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.ask("work.ask = async () => ({ faults: [{ line: 0, text: 'camgeo has failed' }], trace: 'x' })")
    page.load("other", TEXTS["disc-roller"] + "# other")
    assert "camgeo has failed" in page.text_of("faults")
    page.ask("delete work.ask")
    page.load("disc-roller", TEXTS["disc-roller"])
    assert page.text_of("verdict") == "every check of the design holds"
    assert page.browser.problems == []


def test_what_is_too_large_is_refused_before_it_is_read(page: tab.Tab) -> None:
    page.ask("takeFiles([{ name: 'huge.stl', size: 1e9 }])")
    assert "1000 MB" in page.text_of("notice")


def test_of_designs_that_wait_the_newest_is_made(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    before = page.ask("work.number")
    page.ask("""(() => {
      const slider = document.querySelector('[data-path="cam.base_radius"] [type=range]');
      for (let value = 37; value <= 56; value++) {
        slider.value = value;
        slider.dispatchEvent(new Event("input"));
      }
      slider.dispatchEvent(new Event("change"));
    })()""")
    page.settle()
    assert (
        page.ask("work.number") - before == 3
    )  # the first picture, which was under way; picture and checks of the last
    assert "base_radius: 56" in page.text
    page.press("undo")  # one movement is one step
    assert page.text == TEXTS["disc-roller"]


def test_letters_are_read_at_once_where_make_is_pressed_behind_them(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.ask("""(() => {
      byId("text").value = recipe.text.replace("base_radius: 36", "base_radius: 37");
      byId("text").dispatchEvent(new Event("input"));
      byId("make").click();
    })()""")
    page.settle()
    assert page.ask("recipe.fields.find(({ path }) => path === 'cam.base_radius').text") == "37"
    assert page.text_of("verdict") == "every check of the design holds"
    assert page.text_of("busy").startswith("done in ")
    assert page.text_of("since") == ""


def test_what_changes_while_files_are_judged_is_not_taken_for_what_was_judged(page: tab.Tab, tmp_path: Path) -> None:
    report = camgeo.export(camgeo.load(TEXTS["disc-roller"]), tmp_path, only=["dxf"])
    page.load("disc-roller", TEXTS["disc-roller"])
    page.drop("first.dxf", (report.path / "recipe.dxf").read_bytes())
    slide = """(() => {
      const slider = document.querySelector('[data-path="cam.base_radius"] [type=range]');
      slider.value = Number(slider.value) + 1;
      for (const kind of ["input", "change"]) slider.dispatchEvent(new Event(kind));
    })()"""
    other = "takeFiles([new File([somebodys.bytes], `next-${somebodys.name}`)])"
    presses = [("make", slide, "Made and judged"), ("verify", slide, "first.dxf by the recipe")]
    presses += [("verify", other, "first.dxf by the recipe")]
    presses += [("follow", other, "What next-first.dxf does")]  # needs: follow
    for name, meanwhile, head in presses:
        page.ask(f"byId({name!r}).click(), {meanwhile}")
        page.wait("!underWay")
        page.settle()
        assert page.text_of("judged-head") == head
        assert page.text_of("since") == ("The recipe has changed since." if meanwhile == slide else "")


def test_a_change_that_rests_does_not_stand_for_a_newer_one_that_was_answered_before_it(page: tab.Tab) -> None:
    """A slider that is held rests before its cam is checked; where it is let go meanwhile, the next cam does not."""
    page.ask("""(async () => {
      const pause = (ms) => new Promise((done) => setTimeout(done, ms));
      work.ask = async (call) => (call === "picture" ? {} : null);
      step = "slide";
      const older = changed();
      await pause(20);
      step = null;
      recipe.text += "\\n";
      await changed();
      await older;
      delete work.ask;
    })()""")
    page.settle()
    page.load("four-bar", TEXTS["four-bar"])


def test_no_verdict_stands_beside_another_number(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    verdicts = page.ask("""(async () => {
      const slider = document.querySelector('[data-path="cam.base_radius"] [type=range]');
      slider.value = 37;
      slider.dispatchEvent(new Event("input"));
      const told = [byId("verdict").textContent];
      const drawn = { attributeFilter: ["data-shown"] };
      await new Promise((done) => new MutationObserver(done).observe(document.body, drawn));
      told.push(byId("verdict").textContent, String(document.body.classList.contains("unjudged")));
      slider.dispatchEvent(new Event("change"));
      return told.join(" ");
    })()""")
    assert verdicts == "judging… judging… true"
    page.settle()
    assert page.text_of("verdict") == "every check of the design holds"
    assert not page.ask("document.body.classList.contains('unjudged')")


def test_a_file_that_the_server_lacks_is_told(site: Path, tmp_path: Path) -> None:
    copy = shutil.copytree(site, tmp_path / "site")
    (copy / "camgeo.zip").rename(copy / "camgeo")
    with tab.served(copy) as lacking, Browser(tmp_path / "profile") as browser:
        browser.open(lacking)
        browser.wait("byId('notice').textContent", tab.PATIENCE)
        told = browser.ask("byId('notice').textContent")
        (copy / "camgeo").rename(copy / "camgeo.zip")
        (copy / "later.zip").rename(copy / "later")
        page = tab.Tab(browser, lacking).open()
        page.worked("make")
        part = page.text_of("faults")
        (copy / "later").rename(copy / "later.zip")
        page.judged("make")
    assert "Python could not be loaded: camgeo.zip" in told
    assert "404" in told
    assert part.startswith("a part of this page could not be loaded: later.zip")


def test_stop_ends_the_worker_and_another_one_goes_on(page: tab.Tab) -> None:
    page.load("four-bar", TEXTS["four-bar"])
    page.ask("byId('make').click(); byId('stop').click()")  # at once: it may be done before a test presses the other
    page.wait("byId('busy').textContent === 'stopped'")
    page.settle()
    assert page.ask("byId('stop').disabled")
    # stopped before it has said which files a browser cannot make, it says so with the next answer
    page.ask("""new MutationObserver((_, watch) => {
      watch.disconnect();
      byId("make").click();
      byId("stop").click();
    }).observe(byId("form"), { childList: true })""")
    page.load("support", TEXTS["support"])
    page.wait("document.querySelectorAll('.ticks label:has(small)').length > 0")
    page.load("four-bar", TEXTS["four-bar"])
    page.slide("linkage.ground", 81)
    assert "81" in page.text_of("form") or "ground: 81" in page.text
    assert page.ask("document.body.dataset.answered") == str(page.ask("changeCount"))


def test_a_reload_and_a_link_keep_the_recipe_with_its_tables(page: tab.Tab) -> None:
    tables = {"disc-table.csv": (RECIPES / "disc-table.csv").read_text("utf-8")}
    page.load("disc-table", TEXTS["disc-table.yaml"], tables)
    assert page.text_of("faults") == ""
    page.wait("!due")  # the address follows a little later, by itself
    link = page.written()
    page.reload()
    page.settle()
    assert page.text == TEXTS["disc-table.yaml"]
    assert page.text_of("faults") == ""
    page.load("support", TEXTS["support"])
    assert page.written() != link
    page.load("disc-table", TEXTS["disc-table.yaml"])  # without its table, which is of another recipe
    assert "disc-table.csv" in page.text_of("faults")
    page.ask(f"location.hash = {link!r}")
    page.wait("'disc-table.csv' in recipe.tables")
    page.settle()
    assert page.text_of("faults") == ""


def test_two_tabs_know_nothing_of_each_other(page: tab.Tab) -> None:
    page.load("support", TEXTS["support"])
    with page.other(page.ask("packed(first)")) as there:
        page.wait(f"Number({there}?.body?.dataset.shown) > 0")
        page.slide("part.bore", 12)
        assert page.ask(f"{there}.getElementById('text').value.includes('kind: disc')")
        assert "bore: 12" in page.text


NAMELESS = """[...document.querySelectorAll("input, select, textarea, button, iframe")]
  .filter((one) => !one.hidden && !(one.labels?.length || one.ariaLabel || one.title || one.textContent.trim()))
  .map((one) => one.outerHTML).join(" ")"""


@pytest.mark.parametrize("width", [390, 768, 1000, 1280, 1920])
@pytest.mark.parametrize("dark", [False, True])
def test_nothing_overflows_and_everything_has_a_name(page: tab.Tab, width: int, *, dark: bool) -> None:
    page.browser.size(width, 800, dark=dark)
    page.load("disc-roller", TEXTS["disc-roller"])
    assert page.ask("document.documentElement.scrollWidth") <= width
    assert page.ask(NAMELESS) == ""


def test_the_keyboard_reaches_everything(page: tab.Tab) -> None:
    page.load("disc-roller", TEXTS["disc-roller"])
    page.ask("byId('undo').focus()")
    reached = set()
    name = ""
    while name != "undo":  # once round, whatever is on the page
        page.browser.key("Tab")
        name = page.ask("document.activeElement.id")
        reached.add(name)
        assert len(reached) < 300
        if name == "text":
            page.browser.key("Escape")
    assert {"open", "save", "link", "unit", "text", "make", "choose"} <= reached
    assert any(name.startswith("slide-") for name in reached)
    page.ask("byId('text').focus()")
    before = page.text
    page.browser.key(" ")
    page.settle()
    assert len(page.text) == len(before) + 1  # a blank is written, and does not play
