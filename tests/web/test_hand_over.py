"""What was made, handed over: each button gives what its name says. Holds: web.hand, web.film, web.gif, web.solid."""

from __future__ import annotations

import io
import re
from typing import TYPE_CHECKING
from zipfile import ZipFile

import numpy as np
import pytest
from PIL import Image, ImageSequence
from support import tab
from support.places import RECIPES

import camgeo
from camgeo.recipe.starter import starter

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = [pytest.mark.slow, pytest.mark.skipif(bool(tab.why_not()), reason=tab.why_not())]

DISC = starter("disc-roller").replace("[dxf, svg, stl, csv, html]", "[dxf]")


@pytest.fixture
def desk(other_page: tab.Tab, tmp_path: Path) -> tab.Tab:
    """The page with a cam whose files are made, which stands still; what it saves goes into a folder of the test."""
    page = other_page
    page.browser.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(tmp_path))
    page.turn_to(0)
    page.load("disc", DISC)
    page.judged("make")
    return page


def saved(page: tab.Tab, button: str, path: Path) -> bytes:
    """What a button saves under a name, which stands once among the files then."""
    data = page.saved(button, path)
    name = path.name
    assert (
        page.ask(f"[...document.querySelectorAll('#files a')].filter((one) => one.download === {name!r}).length") == 1
    )
    return data


def test_all_files_come_as_a_zip_with_the_recipe_and_its_tables(desk: tab.Tab, tmp_path: Path) -> None:
    text = (RECIPES / "disc-table.yaml").read_text("utf-8")
    table = (RECIPES / "disc-table.csv").read_text("utf-8")
    desk.load("mine", text, {"disc-table.csv": table, "other.csv": "0 1"})
    desk.judged("make")
    data = saved(desk, "zip", tmp_path / "mine.zip")
    with ZipFile(tmp_path / "mine.zip") as archive:
        names = {name.removeprefix("mine/") for name in archive.namelist()}
        archive.extractall(tmp_path)
    shown = desk.ask("[...document.querySelectorAll('#files a')].map((one) => one.download)")
    assert names == {*shown, "mine.yaml", "disc-table.csv"} - {"mine.zip"}
    assert camgeo.verify(tmp_path / "mine" / "mine.yaml", tmp_path / "mine" / "mine.dxf").ok
    (tmp_path / "mine.zip").unlink()
    assert saved(desk, "zip", tmp_path / "mine.zip") == data  # again: it does not hold itself
    assert desk.browser.problems == []


def test_of_a_file_that_was_judged_nothing_is_handed_over(desk: tab.Tab) -> None:
    assert desk.ask("byId('hand').hidden") is False
    held = desk.ask(
        "made.files.find(({ name }) => name.endsWith('.dxf')).bytes.reduce((a, b) => a + String.fromCharCode(b), '')"
    )
    desk.drop("cam.dxf", held.encode("latin-1"))
    desk.judged("verify")
    assert desk.ask("byId('hand').hidden") is True


def test_the_drawing_comes_as_a_pdf_unless_a_check_fails(desk: tab.Tab, tmp_path: Path) -> None:
    data = saved(desk, "pdf", tmp_path / "disc.pdf")
    assert data.startswith(b"%PDF-1.6")
    assert data.count(b"\nh\nS") == 2  # the contour and the bore
    desk.load("long", DISC.replace("base_radius: 36", "base_radius: 1800"))
    desk.judged("make")
    desk.worked("pdf")
    assert "sheets, and 60 are the most; take the DXF" in desk.text_of("hand-told")
    desk.load("failed", f"{DISC}limits: {{size: {{at_most: 20}}}}\n")
    desk.judged("make")
    assert desk.ask("[byId('zip').hidden, byId('pdf').hidden]") == [False, True]
    assert desk.browser.problems == []


def test_a_film_of_the_drawing_is_an_endless_gif_of_one_turn(desk: tab.Tab, tmp_path: Path) -> None:
    desk.turn_to(33)
    data = saved(desk, "gif", tmp_path / "disc.gif")
    assert desk.ask("[Number(document.documentElement.dataset.at), document.documentElement.dataset.playing]") == [
        33,
        "false",
    ]
    assert len(data) < 3e6
    film = Image.open(io.BytesIO(data))
    frames = [(one.info["duration"], one.convert("RGB")) for one in ImageSequence.Iterator(film)]
    assert (len(frames), film.info["loop"], max(film.size)) == (72, 0, 480)
    assert {duration for duration, _ in frames} == {50}
    pictures = [np.asarray(picture).astype(int) for _, picture in frames]
    # the cam's own colour covers its area at every angle
    metal = "getComputedStyle(document.querySelector('#drawing .cam .metal')).fill"
    colour = [int(part) for part in re.findall(r"\d+", desk.ask(metal))]
    shares = [(np.abs(picture - colour).sum(axis=2) < 3).mean() for picture in pictures]
    scale = 480 / desk.ask("byId('drawing').viewBox.baseVal.width") * desk.ask("shown.view[0]")
    points = camgeo.design(camgeo.load(DISC)).contour(3000)
    x, y = points.T
    area = 0.5 * float(np.abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))) - np.pi * 5.0**2
    assert shares[0] * pictures[0].shape[0] * 480 / scale**2 == pytest.approx(area, rel=0.05)
    assert max(shares) / min(shares) < 1.1
    steps = [
        np.abs(a - b).sum(axis=2).astype(bool).mean()
        for a, b in zip(pictures, [*pictures[1:], pictures[0]], strict=True)
    ]
    assert min(steps) > 0.002  # it moves all the time, and the last picture is as far from the first as any
    assert steps[-1] < 2 * max(steps[:-1])
    assert desk.browser.problems == []


def test_a_film_of_many_colours_is_packed_as_it_was(desk: tab.Tab) -> None:
    """Pictures of noise, which fill the table of codes again and again, by the encoder alone."""
    made = """(() => {
      let seed = 7;
      const random = () => (seed = (seed * 48271) % 2147483647);
      const pictures = Array.from({ length: 3 }, () => Uint8ClampedArray.from({ length: 4 * 150 * 90 }, (_, i) =>
        i % 4 === 3 ? 255 : 60 * (random() % 5)));
      const gif = new Gif(150, 90, paletteOf(pictures), 4);
      for (const picture of pictures) gif.add(picture);
      return [[...gif.bytes()], pictures.map((picture) => [...picture])];
    })()"""
    packed, pictures = desk.ask(made)
    film = Image.open(io.BytesIO(bytes(packed)))
    for i, picture in enumerate(pictures):
        film.seek(i)
        shown = np.asarray(film.convert("RGBA"))
        assert (shown == np.array(picture, dtype=np.uint8).reshape(90, 150, 4)).all()


def test_a_film_that_is_stopped_leaves_the_page_at_work(desk: tab.Tab) -> None:
    worker = desk.ask("(window.workerBefore = work.worker, 1)")
    assert worker == 1
    desk.ask("""new Promise((done) => {
      const watch = new MutationObserver(() => {
        if (!byId("busy").textContent.includes("picture 2 of 72")) return;
        watch.disconnect();
        byId("stop").click();
        byId("gif").click(); // which does not take the stop back
        done();
      });
      watch.observe(byId("busy"), { childList: true });
      byId("gif").click();
    })""")
    desk.wait("!underWay")
    assert desk.text_of("busy") == "stopped"
    assert desk.ask("work.worker === window.workerBefore && work.ready") is True  # Python stays
    assert desk.ask("[...document.querySelectorAll('#files a')].some((one) => one.download.endsWith('.gif'))") is False


def test_a_film_is_a_webm_where_the_browser_records(desk: tab.Tab, tmp_path: Path) -> None:
    assert desk.ask("byId('webm').hidden") is not desk.ask("Boolean(WEBM)")
    if desk.ask("byId('webm').hidden"):
        pytest.skip("this browser records no WebM")
    data = saved(desk, "webm", tmp_path / "disc.webm")
    assert data.startswith(b"\x1a\x45\xdf\xa3")
    assert b"webm" in data[:64]
    assert b"V_VP" in data[:600]
    assert len(data) > 20_000


INK = """(() => {
  drawSolid();
  const { gl } = solid;
  const [width, height] = [gl.drawingBufferWidth, gl.drawingBufferHeight];
  const pixels = new Uint8Array(4 * width * height);
  gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, pixels);
  let [x0, x1, y0, y1, sum, hash] = [width, -1, height, -1, 0, 0];
  for (let i = 0; i < width * height; i++) {
    if (!pixels[4 * i + 3]) continue;
    const [x, y] = [i % width, Math.floor(i / width)];
    [x0, x1, y0, y1, sum] = [Math.min(x0, x), Math.max(x1, x), Math.min(y0, y), Math.max(y1, y), sum + 1];
    hash = (31 * hash + pixels[4 * i]) % 1000003;
  }
  return [x1 - x0 + 1, y1 - y0 + 1, sum, hash, Math.min(width, height), solid.size];
})()"""


@pytest.mark.parametrize("width", [390, 1280])
def test_the_solid_is_shown_from_above_as_large_as_it_is_and_turned(desk: tab.Tab, width: int) -> None:
    desk.browser.size(width, 844)
    desk.worked("solid")
    assert desk.ask("byId('solid-figure').hidden") is False
    contour = camgeo.design(camgeo.load(DISC)).contour(5000)
    sides = [float(side) for side in np.ptp(contour, axis=0)]
    told = [float(part) for part in re.findall(r"[\d.]+", desk.text_of("solid-size").split(" mm")[0])]
    assert told == pytest.approx([*sides, 8.0], abs=0.02)
    desk.ask("Object.assign(solid, { spin: 0, tilt: 0, zoom: 1 })")
    wide, high, area, _, room, size = desk.ask(INK)
    scale = room / size
    assert [wide / scale, high / scale] == pytest.approx(sides, rel=0.02)
    x, y = contour.T
    metal = 0.5 * float(np.abs(x @ np.roll(y, -1) - y @ np.roll(x, -1))) - np.pi * 5.0**2
    assert area / scale**2 == pytest.approx(metal, rel=0.02)  # the bore is open
    desk.ask("solid.tilt = -Math.PI / 2")
    assert desk.ask(INK)[1] / scale == pytest.approx(8.0, rel=0.05)  # from the side its thickness
    before = desk.ask(INK)[3]
    desk.ask("byId('solid-view').focus()")
    at = desk.ask("document.documentElement.dataset.at")
    desk.browser.key("ArrowLeft")
    assert desk.ask(INK)[3] != before
    assert desk.ask("document.documentElement.dataset.at") == at  # the shaft stays
    spin = desk.ask("solid.spin")
    x0, y0 = desk.middle("byId('solid-view')")
    desk.browser.drag([(x0, y0), (x0 + 30, y0), (x0 + 60, y0 + 10)])
    assert desk.ask("solid.spin") > spin + 0.3
    assert desk.ask("document.documentElement.scrollWidth") <= width
    assert desk.browser.problems == []


def test_where_there_is_no_webgl_or_no_solid_the_page_says_so(desk: tab.Tab) -> None:
    desk.ask("byId('solid-view').getContext = () => null")
    desk.click("solid")
    assert "no WebGL" in desk.text_of("hand-told")
    desk.ask("delete byId('solid-view').getContext")
    desk.load("thin", re.sub(r"(?m)^.*thickness: 8.*\n", "", DISC))
    assert desk.text_of("faults") == ""
    desk.judged("make")
    desk.worked("solid")
    assert "a solid needs a thickness" in desk.text_of("hand-told")
    assert desk.ask("byId('solid-figure').hidden") is True
