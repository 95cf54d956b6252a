"""The page: one file without a network, its data against kin, its tables against the report, pictures and the watch.

Holds: camgeo.cli.watch, camgeo.report.page.asset, camgeo.report.page.content, camgeo.report.page.curves,
camgeo.report.page.looks, camgeo.report.page.outline, camgeo.report.page.png, camgeo.report.page.tables,
camgeo.report.page.linked.
"""

from __future__ import annotations

import argparse
import copy
import json
import math
import re
import subprocess
import sys
import threading
import urllib.error
import urllib.request
from html.parser import HTMLParser
from typing import TYPE_CHECKING
from urllib.parse import quote
from xml.etree import ElementTree as ET

import numpy as np
import pytest
from support.cases import few
from support.pages import RECIPES, SHAFT, SHOWN, Made, fetched, of, put, told, unpacked, wait

from camgeo.cli.main import main
from camgeo.cli.report import add_arguments
from camgeo.cli.watch import watch
from camgeo.curve.ring import Ring, disc
from camgeo.measures.file_result import FileResult
from camgeo.measures.forces import preload_section
from camgeo.recipe.export import FileRequest
from camgeo.recipe.loading import load, load_text
from camgeo.report.document import ROUNDING
from camgeo.report.page import curves, svg, tables
from camgeo.report.page.asset import asset
from camgeo.report.page.content import content
from camgeo.report.page.outline import MEASURED, contours_of
from camgeo.report.page.page import LOCAL, RELOAD, pack_numbers, page, scene, script_json
from camgeo.report.page.scene import STEPS
from camgeo.report.plot import Plot, Series
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.contour.contour import Contour
from kin.judge.intent import Limits
from kin.judge.verify import verify

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.recipe.recipe import Recipe
    from camgeo.report.page.content import Content

MOST = 1_000_000  # bytes of a page
VOID = {"meta", "link", "input", "br", "hr", "img"}


class Elements(HTMLParser):
    """Elements of a page in order, with a complaint about any that is not closed where it should be."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.found: list[tuple[str, dict[str, str | None]]] = []
        self.faults: list[str] = []
        self.texts: list[str] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.found.append((tag, dict(attrs)))

    def handle_endtag(self, tag: str) -> None:
        if not self.open or self.open.pop() != tag:
            self.faults.append(f"</{tag}> at {self.getpos()}")

    def handle_data(self, data: str) -> None:
        if data.strip():
            self.texts.append(data.strip())


def parsed(text: str) -> Elements:
    elements = Elements()
    elements.feed(text)
    elements.close()
    assert not elements.faults
    assert not elements.open
    return elements


@pytest.fixture(scope="module", params=few(SHOWN, 3))
def made(request: pytest.FixtureRequest) -> Made:
    return of(request.param)


# --- the file ---------------------------------------------------------------------------------------------------------


@pytest.mark.thin(3)
def test_the_page_is_one_sound_small_file_that_asks_for_nothing(made: Made) -> None:
    elements = parsed(made.text)
    assert len(made.text.encode("utf-8")) < MOST
    assert "{{" not in made.text
    assert "}}" not in made.text.partition("<script")[0].replace("}}", "}", made.text.count("@media"))
    named = {key: value for _, attributes in elements.found for key, value in attributes.items() if value}
    assert not [value for key, value in named.items() if key in {"src", "action", "srcset", "poster"}]
    files = {quote(file["path"]) for file in made.outcome.report["files"]}
    assert files
    assert {a["href"] for tag, a in elements.found if "href" in a} == {"data:,", *files}
    assert not re.search(r"https?:|//[a-z]|url\(|@import|fetch\(|XMLHttp|WebSocket|EventSource", made.text)
    (policy,) = (a["content"] for tag, a in elements.found if a.get("http-equiv") == "Content-Security-Policy")
    assert policy is not None
    assert policy.startswith("default-src 'none'")
    assert LOCAL in policy


@pytest.mark.thin(4)
def test_every_name_that_the_script_asks_for_is_there_and_every_control_has_a_label(made: Made) -> None:
    elements = parsed(made.text)
    ids = [a["id"] for _, a in elements.found if "id" in a]
    assert len(ids) == len(set(ids))
    asked = set(re.findall(r'find\("([a-z-]+)"\)', made.text))
    assert asked <= set(ids)
    inside = False
    for tag, attributes in elements.found:
        inside = tag == "label" or (inside and tag in {"input", "select", "span", "option"})
        if tag in {"input", "select"}:
            assert inside or attributes.get("aria-label")
    pointed = [a[key] for _, a in elements.found for key in ("aria-labelledby", "for") if a.get(key)]
    assert set(pointed) <= set(ids)
    assert dict(elements.found)["html"]["lang"] == "en"


def test_text_of_a_recipe_cannot_break_out(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(
        "about: '</script><script>alert(1)</script> & <b>'\ncam: {kind: support, p: 25 + cos(3*t)} # {{data}} </pre>\n",
        encoding="utf-8",
    )
    text = Made(path).text
    parsed(text)
    assert "alert(1)</script>" not in text
    assert "&lt;/script&gt;&lt;script&gt;alert(1)" in text
    assert "{{data}} &lt;/pre&gt;" in text


@pytest.mark.slow
def test_the_same_recipe_gives_the_same_page() -> None:
    assert of("w-ellipse").text == Made(RECIPES / "w-ellipse.yaml").text


# --- the tables -------------------------------------------------------------------------------------------------------


def test_checks_stand_with_their_values_failed_ones_first(tmp_path: Path) -> None:
    path = tmp_path / "undercut.yaml"
    path.write_text("cam: {kind: support, p: 25 + 4*cos(3*t)}\npart: {bore: 5}\n", encoding="utf-8")
    made = Made(path)
    assert not made.outcome.ok
    rows = re.findall(r'<tr class="(ok|failed)">.*?<th scope="row">([a-z-]+)', made.text, re.DOTALL)
    checks = made.outcome.report["checks"]
    assert sorted(name for _, name in rows) == sorted(check["name"] for check in checks)
    states = [state for state, _ in rows]
    assert states == sorted(states)
    assert states[0] == "failed"
    head = made.text.partition("</header>")[0]
    assert f"{states.count('failed')} checks of {len(states)} fail" in head
    assert "The cam is not made" in made.text
    parsed(made.text)


@pytest.mark.thin(3)
def test_figures_are_shown_short_and_told_exactly(made: Made) -> None:
    table = made.text.partition('id="checks-head"')[2].partition("</section>")[0]
    for check in made.outcome.report["checks"]:
        if check["value"] is not None:
            noise = check["ok"] and check["sense"] == "at_most" and 0.0 < abs(check["value"]) < ROUNDING
            noise = noise and abs(check["value"]) < 1e-3 * (check["limit"] or 1.0)
            assert ("below rounding" if noise else f"{check['value']:.6g}") in table
            if float(f"{check['value']:.6g}") != check["value"]:
                assert repr(check["value"]) in table
    for file in made.outcome.report["files"]:
        assert file["path"] in made.text


@pytest.mark.thin(3)
def test_of_many_checks_those_of_files_that_hold_are_folded_up(made: Made, monkeypatch: pytest.MonkeyPatch) -> None:
    report = copy.deepcopy(made.outcome.report)
    fails = next(check for check in report["checks"] if check.get("file"))
    fails["ok"] = False
    monkeypatch.setattr(tables, "MANY", 3)
    shown, *folded = tables.checks(report).split("<details")
    rows = r'<tr class="(ok|failed)">'
    assert re.findall(rows, shown).count("failed") == 1
    assert len(re.findall(rows, shown)) == 1 + sum(not check.get("file") for check in report["checks"])
    assert {state for part in folded for state in re.findall(rows, part)} == {"ok"}
    told = [int(re.findall(r"<summary>(\d+) check", part)[0]) for part in folded]
    assert told == [len(re.findall(rows, part)) for part in folded]
    assert sum(told) + len(re.findall(rows, shown)) == len(report["checks"])


# --- the numbers ------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("values", "kind"),
    [
        (np.sin(SHAFT) * 1e-3 + 5.0, "v"),
        (np.full(STEPS + 1, 1.0 / 3.0), "c"),
        (np.where(SHAFT < 1.0, np.nan, SHAFT), "n"),
        (np.zeros(STEPS + 1), "c"),
        (-1e6 * SHAFT, "v"),
        (7e21 * np.cos(SHAFT), "v"),
        (1e300 * SHAFT, "v"),
    ],
)
def test_packed_rows_come_back_within_a_hundred_thousandth(values: np.ndarray, kind: str) -> None:
    row = json.loads(json.dumps(pack_numbers(values)))
    assert kind in row
    back = unpacked(row, STEPS + 1)
    span = np.nanmax(values) - np.nanmin(values)
    assert np.array_equal(np.isnan(back), np.isnan(values))
    assert np.nanmax(np.abs(back - values)) <= max(0.51e-5 * span, 1e-12)


def test_a_yoke_moves_by_its_lift() -> None:
    made = of("shu-wu")
    lift = designed(made.recipe).exact.law.derivatives(SHAFT, 3)
    stroke = np.ptp(lift[0])
    x, y, angle = made.pose("yoke")
    assert np.abs(x - lift[0]).max() < 1e-4 * stroke
    assert not y.any()
    assert not angle.any()
    assert np.abs(made.plot("Lift") - (lift[0] - 40.0)).max() < 1e-4 * stroke
    assert np.abs(made.plot("Velocity") - lift[1]).max() < 1e-4 * np.ptp(lift[1])
    assert [rest[:2] for rest in made.data["rests"]] == [pytest.approx([120.0, 60.0]), pytest.approx([300.0, 60.0])]
    assert {rest[2] for rest in made.data["rests"]} == {"dwell of 60°"}


def test_contacts_lie_on_the_cam_and_on_the_face() -> None:
    made = of("shu-wu")
    turned = made.pose("cam")[2]
    x, y, _ = made.pose("contact on face 1")
    assert np.abs(x - made.pose("yoke")[0]).max() < 1e-3
    c, s = np.cos(-turned), np.sin(-turned)
    in_cam = np.column_stack([x * c - y * s, x * s + y * c])
    contour = Contour.from_bulges(*ring_of(made.content))
    assert contour.distance(in_cam).max() < 2.5e-3  # the file's tolerance, and the rounding of the drawing


def ring_of(found: Content) -> tuple[np.ndarray, np.ndarray]:
    ring = found.scene.bodies[0].shapes[0].rings[0]
    return ring.points, ring.bulges


@pytest.mark.slow
def test_a_linkage_stands_as_kin_says_over_the_shaft_angle() -> None:
    made = of("as-figure-9-2a")
    mechanism = designed(made.recipe).driven.mechanism
    at = mechanism.at(mechanism.relative(SHAFT), 1)
    x, y, direction = made.pose("rocker")
    assert np.abs(np.pi - direction - at.output[0]).max() < 1e-4 * np.ptp(at.output[0])
    assert (x[0], y[0]) == (80.0, 0.0)
    dx, dy, _ = made.pose("joint D")
    assert np.abs(np.hypot(dx - 80.0, dy) - 105.0).max() < 2e-3
    fx, fy, theta3 = made.pose("frame")
    assert np.abs(theta3 - at.frame[0]).max() < 1e-4
    # the coupler's bar ends in D, and the frame holds the cam: both faces of a pair are where the contacts are
    assert np.abs(fx + 95.0 * np.cos(theta3) - dx).max() < 2e-3
    assert np.abs(fy + 95.0 * np.sin(theta3) - dy).max() < 2e-3
    for face in (1, 2, 3, 4):
        cx, cy, _ = made.pose(f"contact on face {face}")
        normal = theta3 + face * math.pi / 2
        assert np.abs((cx - fx) * np.cos(normal) + (cy - fy) * np.sin(normal) - 25.0).max() < 2e-3
    # the shaft turns evenly, clockwise
    turned = made.pose("cam")[2]
    assert np.abs(turned - turned[0] + SHAFT).max() < 1e-4
    assert made.data["rests"][0][1] == pytest.approx(37.05, abs=0.01)


@pytest.mark.slow
@pytest.mark.thin(2)
@pytest.mark.parametrize("offset", [-40.0, 9.0])
def test_a_joint_off_the_mid_line_is_where_the_coupler_ends(tmp_path: Path, offset: float) -> None:
    """An offset beyond the frame's side hangs the bar on an arm that prolongs the side."""
    text = (RECIPES / "as-figure-9-2a.yaml").read_text(encoding="utf-8")
    path = tmp_path / "off.yaml"
    path.write_text(text.replace("rocker: 105", f"rocker: 105, joint_offset: {offset}"), encoding="utf-8")
    made = Made(path)
    dx, dy, _ = made.pose("joint D")
    fx, fy, theta3 = made.pose("frame")
    c, s = np.cos(theta3), np.sin(theta3)
    assert np.abs(fx + 95.0 * c - offset * s - dx).max() < 2e-3
    assert np.abs(fy + 95.0 * s + offset * c - dy).max() < 2e-3
    frame = next(body for body in made.content.scene.bodies if body.name == "frame")
    square, *bars = (np.concatenate([ring.points for ring in shape.rings]) for shape in frame.shapes)
    assert len(bars) == (2 if abs(offset) > 25.0 else 1)
    assert np.hypot(*(bars[0] - (95.0, offset)).T).min() < 3.0
    for bar, on in zip(bars, [*bars[1:], square], strict=True):
        assert bar.min(axis=0)[0] < on.max(axis=0)[0]
        assert (np.abs(bar[:, 1]).min() < np.abs(on[:, 1]).max()) or len(bars) == 1


@pytest.mark.slow
def test_ccw_is_the_mirror_image_and_the_motion_stays() -> None:
    made = of("six-bar")
    mechanism = designed(made.recipe).driven.mechanism
    at = mechanism.at(mechanism.relative(SHAFT), 0)
    _, _, angle = made.pose("output of dyad 1")
    assert np.abs(np.unwrap(-angle) - at.output[0]).max() < 1e-4 * np.ptp(at.output[0])
    assert np.abs(made.plot("Output") - np.degrees(at.output[0])).max() < 2e-3
    turned = made.pose("cam")[2]
    assert np.abs(turned - turned[0] - SHAFT).max() < 1e-4
    assert made.data["sense"] == 1
    px, py, _ = made.pose("joint")
    assert np.isfinite([px, py]).all()


def test_dyads_hang_together(tmp_path: Path) -> None:
    path = tmp_path / "dyads.yaml"
    path.write_text(
        "rotation: ccw\ncam:\n  kind: support\n  p: sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25\n  shaft: [18, 8.5]\n"
        "linkage:\n  kind: four-bar\n  ground: 80\n  coupler: 70\n  rocker: 105\n  dyads:\n"
        "    - {kind: rpr, on: output, point: [80, 10], ground: [100, -30], offset: 12}\n"
        "    - {kind: rrp, on: previous, point: [60, 0], link: 100, through: [150, -20], direction: 30}\n",
        encoding="utf-8",
    )
    made = Made(path)
    # in the mirror: the block is a fixed distance from the line through the pivot along the slot
    bx, by, along = made.pose("block")
    gx, gy, slot = made.pose("output of dyad 1")
    assert (gx[0], gy[0]) == (100.0, 30.0)
    assert np.abs(np.exp(1j * along) - np.exp(1j * slot)).max() < 1e-4
    assert (by - gy) * np.cos(slot) - (bx - gx) * np.sin(slot) == pytest.approx(-12.0, abs=2e-3)
    # the rod leads from the joint on the slotted rocker to the slide, which stays on its line
    rx, ry, towards = made.pose("rod of dyad 2")
    assert rx == pytest.approx(gx + 60.0 * np.cos(slot), abs=2e-3)
    assert ry == pytest.approx(gy + 60.0 * np.sin(slot), abs=2e-3)
    sx, sy, _ = made.pose("slide")
    assert sx == pytest.approx(rx + 100.0 * np.cos(towards), abs=5e-3)
    assert sy == pytest.approx(ry + 100.0 * np.sin(towards), abs=5e-3)
    c, s = math.cos(math.pi / 6), -math.sin(math.pi / 6)
    assert (sy - 20.0) * c - (sx - 150.0) * s == pytest.approx(0.0, abs=2e-3)
    assert made.plot("Output") == pytest.approx((sx - 150.0) * c + (sy - 20.0) * s, abs=5e-3)


def test_lengths_are_in_the_recipes_unit_and_angles_in_degrees() -> None:
    made = of("slider-crank")
    mechanism = designed(made.recipe).driven.mechanism
    told = made.outcome.report["linkage"]["force_angle"]
    assert told["min"] == pytest.approx(math.degrees(designed(made.recipe).driven.figures.force_least.value), rel=1e-12)
    output = mechanism.at(mechanism.relative(SHAFT), 0).output[0] / 25.4
    x, y, _ = made.pose("slide")
    assert np.abs(x - output).max() < 1e-4 * np.ptp(output)
    assert y == pytest.approx(0.25)
    assert {plot["unit"] for plot in made.data["plots"][:2]} == {"in", "in/rad"}


@pytest.mark.slow
def test_two_rollers_keep_their_distance_from_the_cam() -> None:
    made = of("w-law")
    cam = made.recipe.cam
    law = designed(made.recipe).exact.law
    x, y, angle = made.pose("arm")
    assert (x[0], y[0]) == (40.0, 0.0)
    psi = law.psi_of_shaft(SHAFT, 0)[0]
    assert np.abs(angle - psi).max() < 1e-4 * np.ptp(psi)  # mirrored: psi is clockwise positive
    turned = made.pose("cam")[2]
    contour = Contour.from_bulges(*ring_of(made.content))
    for side in (-1.0, 1.0):
        along = -(side * law.alpha - psi)
        centre = np.column_stack([40.0 + 40.0 * np.cos(along), 40.0 * np.sin(along)])
        c, s = np.cos(-turned), np.sin(-turned)
        in_cam = np.column_stack([centre[:, 0] * c - centre[:, 1] * s, centre[:, 0] * s + centre[:, 1] * c])
        assert np.abs(contour.distance(in_cam) - cam.touch.radius).max() < 2.5e-3
    (check,) = (c for c in made.outcome.report["checks"] if c["name"] == "pressure-angle")
    worst = max(made.plot("Pressure angle", i).max() for i in (0, 1))
    assert worst <= check["value"] + 1e-3
    assert worst > check["value"] - 0.2  # the check looks at breaks too


@pytest.mark.thin(3)
def test_errors_round_the_contour_are_those_that_the_judge_found(made: Made) -> None:
    reports = {file["path"]: file for file in made.outcome.report["files"]}
    drawn = [name for error in made.content.errors for name in error.name.split(", ")]
    assert sorted(drawn) == sorted(name for name in reports if not name.endswith(".csv"))
    for error in made.content.errors:
        report = reports[error.name.split(", ")[0]]
        assert error.tolerance == pytest.approx(report["tolerance"])
        measured = report["measured_error"]
        worst = max(np.nanmax(error.high), -np.nanmin(error.low))
        assert worst <= measured + MEASURED * made.recipe.export.tolerance / made.recipe.mm
        assert worst >= 0.5 * measured - 1e-9
        assert (error.low <= error.high).all()


def judged(recipe: Recipe, path: Path) -> FileResult:
    """The file as the judge reads it."""
    verdict = verify(path, intended(recipe, designed(recipe)), 36, Limits(1e-3))
    return FileResult.of(path, FileRequest(verdict.kind), 1e-3, verdict)


@pytest.mark.slow
def test_a_shifted_contour_shows_as_an_error_on_one_side(tmp_path: Path) -> None:
    import ezdxf

    recipe = load(RECIPES / "reuleaux.yaml")
    assert main(["export", str(RECIPES / "reuleaux.yaml"), "--out", str(tmp_path), "--only", "dxf"]) == 0
    path = tmp_path / "reuleaux" / "reuleaux.dxf"
    drawing = ezdxf.readfile(path)
    for entity in drawing.modelspace():
        entity.translate(0.01, 0.0, 0.0)
    drawing.saveas(path)
    (error,) = content(recipe, designed(recipe), [judged(recipe, path)]).errors
    assert error.high[0] == pytest.approx(0.01, abs=1e-4)
    assert error.low[STEPS // 2] == pytest.approx(-0.01, abs=1e-4)


@pytest.mark.slow
def test_holes_are_the_files_own_and_a_train_has_its_table(tmp_path: Path) -> None:
    path = tmp_path / "train.yaml"
    path.write_text(
        "cam: {kind: support, p: 25 + cos(3*t)}\npart: {bore: 12, bolts: {count: 4, hole: 3, circle: 30}}\n"
        "dynamics: {mass: 0.4, damping: 20, stiffness: 2.0e5, preload: 150, rpm: 300}\n",
        encoding="utf-8",
    )
    made = Made(path)
    metal = made.content.scene.bodies[0].shapes[0]
    assert len(metal.rings) == 6
    areas = sorted(abs(Contour.from_bulges(ring.points, ring.bulges).area) for ring in metal.rings[1:])
    assert areas == pytest.approx([math.pi * 1.5**2] * 4 + [math.pi * 36.0])
    (run, *_) = made.outcome.report["dynamics"]["runs"]
    table = made.text.partition('id="train-head"')[2].partition("</table>")[0]
    assert f"{run['steady']['peak_force']:.6g}" in table
    assert "train.dxf" in table


def test_an_unreadable_file_is_left_out(tmp_path: Path) -> None:
    recipe = load(RECIPES / "reuleaux.yaml")
    path = tmp_path / "reuleaux.stl"
    path.write_bytes(b"solid nothing\nendsolid nothing\n")
    file = judged(recipe, path)
    assert contours_of(recipe, file) is None
    found = content(recipe, designed(recipe), [file])
    assert found.errors == ()
    parsed(page(recipe, found, {**of("w-ellipse").outcome.report, "files": []}))


@pytest.mark.slow
def test_a_mechanism_that_binds_has_a_page_that_says_so(tmp_path: Path) -> None:
    path = tmp_path / "binds.yaml"
    path.write_text(
        "cam:\n  kind: support\n  p: sin(3*t) + 13/15*sin(3*t)*cos(2*t) + 25\n  shaft: [18, 8.5]\n"
        "linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 30}\nexport: {files: [csv, html]}\n",
        encoding="utf-8",
    )
    out = tmp_path / "out"
    assert main(["export", str(path), "--out", str(out)]) == 1
    text = (out / "binds.rejected" / "binds.html").read_text(encoding="utf-8")
    parsed(text)
    assert "does not make a full turn" in text
    assert re.search(r"It binds from .* to .* of the relative angle", text)


@pytest.mark.slow
def test_a_trimmed_contour_has_holes_where_it_is_cut(tmp_path: Path) -> None:
    path = tmp_path / "trimmed.yaml"
    path.write_text(
        "cam: {kind: support, p: 25 + 4*cos(3*t), undercut: trim}\nexport: {files: [dxf]}\n", encoding="utf-8"
    )
    made = Made(path)
    (error,) = made.content.errors
    assert np.isnan(error.low).any()
    assert np.isfinite(error.low).sum() > STEPS // 4
    parsed(made.text)


# --- rings and pictures -----------------------------------------------------------------------------------------------


def test_arcs_are_flattened_on_the_arc_and_written_as_arcs() -> None:
    ring = Ring(np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([math.tan(math.pi / 8.0), 0.0]))
    assert np.hypot(*ring.flattened()[:-1].T) == pytest.approx(1.0, abs=1e-12)
    assert ring.path(4) == "M1 0A1.0000 1.0000 0 0 1 0 1Z"
    assert ring.mirrored().path(2) == "M1 0A1.00 1.00 0 0 0 0 -1Z"
    large = Ring(np.array([[1.0, 0.0], [0.0, 1.0]]), np.array([-math.tan(3.0 * math.pi / 8.0), 0.0]))
    assert " 0 1 0 " in large.path(2)
    assert np.hypot(*(disc(2.0, 3.0, 0.5).flattened() - (2.0, 3.0)).T) == pytest.approx(0.5)


@pytest.mark.slow
def test_a_picture_is_an_svg_by_itself(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    arguments = ["report", str(RECIPES / "reuleaux.yaml"), "--out", str(tmp_path), "--picture", "svg", "--at", "-300"]
    assert main(arguments) == 0
    assert "page.html" in capsys.readouterr().out
    folder = tmp_path / "reuleaux"
    assert {path.name for path in folder.iterdir()} == {"page.html", "page.svg", "page.json"}
    report = json.loads((folder / "page.json").read_text(encoding="utf-8"))
    assert [file["path"] for file in report["files"]] == ["page.html", "page.svg"]
    root = ET.fromstring((folder / "page.svg").read_text(encoding="utf-8"))
    groups = [element for element in root.iter() if element.get("id", "").startswith("body-")]
    assert "rotate(-60.0000)" in groups[0].get("transform", "")
    assert "other" not in {element.get("class") for element in root.iter()}


@pytest.mark.slow
def test_a_picture_is_a_png(tmp_path: Path) -> None:
    from PIL import Image

    from camgeo.report.page.png import png

    path = tmp_path / "a.png"
    path.write_bytes(png(of("six-bar").content.scene, 100))
    with Image.open(path) as image:
        assert max(image.size) == pytest.approx(1280, abs=2)
        colours = {tuple(colour) for _, colour in image.convert("RGB").getcolors(1 << 24)}
    assert {(0xCD, 0xD7, 0xE2), (0xB2, 0x3A, 0x20)} <= colours  # metal and the links' edges


@pytest.mark.slow
def test_an_export_with_a_page_lists_it_and_leaves_the_other_page_alone(tmp_path: Path) -> None:
    path = tmp_path / "small.yaml"
    path.write_text("cam: {kind: support, p: 25 + cos(3*t)}\nexport: {files: [dxf, html]}\n", encoding="utf-8")
    out = tmp_path / "out"
    assert main(["report", str(path), "--out", str(out)]) == 0
    assert main(["export", str(path), "--out", str(out)]) == 0
    assert {p.name for p in (out / "small").iterdir()} == {
        *("small.dxf", "small.html", "report.json"),
        *("page.html", "page.json"),
    }
    report = json.loads((out / "small" / "report.json").read_text(encoding="utf-8"))
    entry = report["files"][-1]
    assert set(entry) == {"path", "kind", "bytes", "sha256"}
    assert entry["kind"] == "html"
    assert {"page", "write html"} <= {stage["name"] for stage in report["stages"]}
    own, other = ((out / "small" / name).read_text(encoding="utf-8") for name in ("small.html", "page.html"))
    assert own == other


@pytest.mark.parametrize("angle", ["nan", "x", "1e9"])
def test_a_wrong_angle_is_a_wrong_call(angle: str, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as ended:
        main(["report", "a.yaml", "--at", angle])
    assert ended.value.code == 2
    assert "a number of degrees" in capsys.readouterr().err


def test_an_angle_may_be_many_turns() -> None:
    parser = argparse.ArgumentParser(exit_on_error=False)
    add_arguments(parser)
    assert parser.parse_args(["a.yaml", "--at=-1e6"]).at == -1e6
    with pytest.raises(argparse.ArgumentError, match=r"a shaft angle is a number of degrees, not 1000000\.1"):
        parser.parse_args(["a.yaml", "--at", "1000000.1"])


def test_a_wrong_recipe_is_told(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "wrong.yaml"
    path.write_text("cam: {kind: support}\n", encoding="utf-8")
    assert main(["report", str(path), "--out", str(tmp_path / "out")]) == 2
    assert "wrong.yaml:1:" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_the_page_imports_nothing_heavy() -> None:
    code = (
        "import sys, camgeo.report.page.content, camgeo.report.page.page, camgeo.cli.watch;"
        "print({'matplotlib', 'scipy', 'shapely', 'ezdxf', 'PIL'} & set(sys.modules))"
    )
    assert subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout == "set()\n"


@pytest.mark.slow
def test_the_data_is_small_and_holds_no_infinity(made: Made) -> None:
    text = script_json(scene(made.recipe, made.content, made.outcome.report))
    assert len(text) < 300_000
    assert "Infinity" not in text
    assert "NaN" not in text
    parsed(svg.moving(made.content.scene))


# --- colours and axes -------------------------------------------------------------------------------------------------


def luminance(colour: str) -> float:
    """Relative luminance of #rrggbb or #rgb (WCAG 2.2)."""
    digits = colour[1:] if len(colour) == 7 else "".join(2 * digit for digit in colour[1:])
    shares = [int(digits[at : at + 2], 16) / 255.0 for at in (0, 2, 4)]
    linear = [share / 12.92 if share <= 0.04045 else ((share + 0.055) / 1.055) ** 2.4 for share in shares]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(one: str, other: str) -> float:
    low, high = sorted((luminance(one), luminance(other)))
    return (high + 0.05) / (low + 0.05)


def palettes() -> dict[str, dict[str, str]]:
    """Colours by name, on a screen in the light and in the dark, and on paper."""
    found: dict[str, dict[str, str]] = {"light": {}, "dark": {}, "print": {}}
    for name in ("drawing.css", "page.css"):
        for medium, block in re.findall(r"(@media [^{]*\{\s*)?:root \{(.*?)\}", asset(name), re.DOTALL):
            kind = "dark" if "dark" in medium else "print" if "print" in medium else "light"
            found[kind] |= dict(re.findall(r"--([a-z-]+): (#[0-9a-f]{3,6})", block))
    return {kind: {**found["light"], **colours} for kind, colours in found.items()}


def test_contrast_is_the_ratio_that_the_guidelines_define() -> None:
    assert contrast("#ffffff", "#000") == pytest.approx(21.0)
    assert contrast("#777777", "#ffffff") == pytest.approx(4.48, abs=0.01)


@pytest.mark.parametrize("kind", ["light", "dark", "print"])
def test_text_stands_out_from_its_ground(kind: str) -> None:
    colours = palettes()[kind]
    style = asset("page.css")
    texts = set(re.findall(r"[ {]color: var\(--([a-z]+)\)", style))
    texts |= set(re.findall(r"text[^{}]*\{[^{}]*fill: var\(--([a-z]+)\)", style))
    assert texts == {"ink", "quiet", "good", "bad", "one", "two", "accent"}
    grounds = [(text, ground) for text in texts for ground in ("page", "panel")]
    grounds += [("bad", "bad-ground"), ("ink", "bad-ground"), ("quiet", "bad-ground"), ("quiet", "rest")]
    low = {pair: round(contrast(*map(colours.__getitem__, pair)), 2) for pair in grounds}
    assert {pair: ratio for pair, ratio in low.items() if ratio < 4.5} == {}


TIMED = (
    "cam:\n  kind: disc\n  base_radius: 40\n  follower: {kind: roller, radius: 9}\n"
    "  motion: [{rise: 15, over: 110, law: modified-sine}, {dwell: 60},"
    " {return: 15, over: 100, law: cycloidal}, {dwell: 90}]\n"
)


def plots_of(more: str) -> dict[str, tuple[str, np.ndarray, str, tuple[tuple[float, str], ...]]]:
    recipe = load_text(TIMED + more, "cam.yaml")
    shown = content(recipe, designed(recipe), []).plots
    return {plot.title: (plot.unit, plot.series[0].values, plot.note, plot.limits) for plot in shown}


# needs: dynamics
def test_derivatives_are_by_second_where_the_speed_is_given() -> None:
    plain, timed = plots_of(""), plots_of("dynamics: {mass: 1, stiffness: 1.0e6, preload: 500, rate: 2000, rpm: 120}\n")
    assert plain["Lift"][0] == timed["Lift"][0] == "mm"
    rate = 120.0 * 2.0 * math.pi / 60.0
    for order, name in enumerate(("Velocity", "Acceleration", "Jerk"), start=1):
        power = ["", "²", "³"][order - 1]
        assert (plain[name][0], timed[name][0]) == (f"mm/rad{power}", f"mm/s{power}")
        assert (plain[name][2], timed[name][2]) == ("", "at 120 rpm")
        assert timed[name][1] == pytest.approx(plain[name][1] * rate**order, rel=1e-12)


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("limit", "lines"),
    [
        ("{at_most: 35}", {35.0, -35.0}),
        ("{at_most: 35, on_return: 45}", {35.0, -45.0}),
        ("{on_return: 45}", {-45.0}),
    ],
)
def test_limits_of_the_pressure_angle_are_lines_in_its_plot(limit: str, lines: set[float]) -> None:
    assert plots_of("")["Pressure angle"][3] == ()
    shown = plots_of(f"limits: {{pressure-angle: {limit}}}\n")["Pressure angle"][3]
    assert set(shown) == {(line, f"limit {abs(line):g}") for line in lines}


# needs: dynamics
def test_limits_of_forces_and_peaks_are_lines_too() -> None:
    shown = plots_of(
        "part: {thickness: 10}\n"
        "dynamics: {mass: 1, preload: 500, rate: 2000, rpm: 120, load: 30,"
        " material: {E: 206000, nu: 0.3, limit: 900}}\n"
        "limits: {contact-force-greatest: {at_most: 700}, contact-force-least: {at_least: 50}, shaft-torque: {at_most:"
        " 9}, contact-pressure: {at_most: 800}, peak-velocity-at-speed: {at_most: 200}, pitch-radius: {at_least: 20},"
        " radius-of-curvature: {at_least: 15}}\n"
    )
    lines = {title: [(line, name) for line, name in plot[3]] for title, plot in shown.items()}
    assert lines["Velocity"] == [(200.0, "limit 200"), (-200.0, "limit 200")]
    assert sorted(lines["Contact force"]) == [(50.0, "at least 50"), (700.0, "limit 700")]
    assert lines["Torque of the shaft"] == [(9.0, "limit 9"), (-9.0, "limit 9")]
    assert lines["Contact pressure"] == [(800.0, "limit 800"), (900.0, "material 900")]
    assert lines["Load"] == []
    assert shown["Load"][0] == "N"
    assert shown["Load"][1] == pytest.approx(30.0)
    # of a roller of 9 mm: the curvature of the pitch curve at which either radius is at its limit; its own is far off
    radii = {name: 1.0 / line for line, name in lines["Curvature of the pitch curve"]}
    assert radii == pytest.approx({"limit of pitch-radius": 20.0, "limit of radius-of-curvature": 24.0})


def test_the_edges_of_a_face_are_lines() -> None:
    recipe = load(RECIPES / "disc-flat.yaml")
    shown = {plot.title: plot for plot in content(recipe, designed(recipe), []).plots}
    assert [line for line, _ in shown["Contact on the face"].limits] == [17.0, -17.0]
    assert shown["Radius of curvature"].limits == ((0.0, ""), (10.0, "at least 10"))


def test_the_limits_of_a_preload_are_lines() -> None:
    """Of a yoke in N along its travel, which is each normal; of arms in N m, in pounds for a recipe in inches."""
    preload = "preload: {interference: 0.02 mm, stiffness: [4.5e+7, 4.5e+7]}"
    motion = "motion: [{rise: 8, over: 70, law: cycloidal}, {dwell: 40}, {return: 8, over: 70, law: cycloidal}]"
    bounds = "limits: {preload-force-least: {at_least: LEAST}, preload-force-greatest: {at_most: MOST}}\n"
    yoke = f"cam: {{kind: constant-breadth, base_radius: 40, {motion}, {preload}}}\n{bounds}"
    arms = (
        "units: inch\ncam: {kind: disc, base_radius: 34 mm, follower: {kind: roller, radius: 8 mm, arm: {length: 65 mm,"
        " pivot: 80 mm}}, conjugate: {radius: 9 mm, length: 60 mm, angle: 90},"
        f" {motion.removesuffix(']')}, {{dwell: 180}}], {preload}}}\n{bounds}"
    )
    shown = []
    for text, least, most in ((yoke, "400", "600"), (arms, "20 Nm", "200 lbf*in")):
        recipe = load_text(text.replace("LEAST", least).replace("MOST", most), "cam.yaml")
        plots = content(recipe, designed(recipe), []).plots
        shown.append({plot.title: plot for plot in plots if plot.title.startswith("Preload")})
    (alone,) = shown[0].values()
    assert [row.name for row in alone.series] == ["along the travel, flat face A and flat face B"]
    assert alone.series[0].values == pytest.approx(450.0)
    assert (alone.unit, alone.limits) == ("N", ((400.0, "at least 400"), (600.0, "limit 600")))
    moment, forces = shown[1]["Preload"], shown[1]["Preload of the contacts"]
    assert (moment.unit, forces.unit) == ("lbf in", "lbf")
    assert [value for value, _ in moment.limits] == pytest.approx([177.015, 200.0], abs=1e-3)
    assert forces.limits == ()
    section = preload_section(recipe, designed(recipe))
    assert section is not None
    ends = (section["force"]["min"] / 0.1129848, section["force"]["max"] / 0.1129848)
    assert (moment.series[0].values.min(), moment.series[0].values.max()) == pytest.approx(ends, rel=1e-3)
    assert [row.name for row in forces.series] == ["disc 1", "disc 2"]


def test_what_is_the_same_is_plotted_once() -> None:
    wave, more = np.sin(SHAFT), np.sin(SHAFT) + 1e-3
    plots = [
        Plot(title, "mm", (Series("a", values),), limits=limits)
        for title, values, limits in (
            ("Error of a.dxf", wave, ()),
            ("Error of a.svg", wave + 1e-9, ()),
            ("Error of a.stl", more, ()),
            ("Error of b.dxf", wave, ((1.0, ""),)),
        )
    ]
    titles = [plot.title for plot in curves.merge_alike(plots)]
    assert titles == ["Error of a.dxf and a.svg", "Error of a.stl", "Error of b.dxf"]
    assert curves.join_titles(["Radius, inner", "Radius, outer", "Radius, third"]) == "Radius, inner, outer and third"
    twice = Plot("Preload", "N", tuple(Series(name, np.full(9, 450.0)) for name in ("face A", "face B")))
    assert [row.name for row in curves.merge_alike([twice])[0].series] == ["face A and face B"]
    assert curves.short(130534.2) == "130500"
    assert curves.join_titles(["Output", "Output of the first loop"]) == "Output and Output of the first loop"


def test_files_that_draw_the_same_are_one_error(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    path.write_text(
        "cam: {kind: support, p: 25 + cos(3*t)}\nexport: {tolerance: 0.01, files: [dxf, svg, {dxf: {as: polyline}}]}\n",
        encoding="utf-8",
    )
    made = Made(path)
    assert [error.name for error in made.content.errors] == ["a.dxf, a.svg", "a-polyline.dxf"]
    assert [error["tolerance"] for error in made.data["errors"]] == [0.01, 0.01]


# --- the watch --------------------------------------------------------------------------------------------------------


def test_the_watch_serves_each_version_and_goes_on_after_a_fault(tmp_path: Path) -> None:
    path = tmp_path / "a.yaml"
    put(path, "1")
    address: list[str] = []
    stop = threading.Event()

    def exported() -> tuple[str | None, str]:
        if stop.is_set():
            raise KeyboardInterrupt
        text = path.read_text(encoding="utf-8")
        return (None, "half") if text == "?" else (f"<p>{text} {LOCAL}</p>{RELOAD}", "")

    def run() -> None:
        with pytest.raises(KeyboardInterrupt):
            watch([path], exported, address.append)

    thread = threading.Thread(target=run)
    thread.start()
    try:
        wait(lambda: bool(address))
        wait(lambda: "<p>1 connect-src 'self'</p>" in fetched(address[0]))
        assert "EventSource" in fetched(address[0])
        assert '<script data-version="1">' in fetched(address[0])
        with pytest.raises(urllib.error.HTTPError, match="403"):  # another site's name that leads here
            urllib.request.urlopen(
                urllib.request.Request(address[0], headers={"Host": "elsewhere.example:80"}), timeout=20
            )
        with urllib.request.urlopen(address[0] + "events", timeout=20) as stream:
            assert told(stream)["fault"] == ""
            put(path, "?")
            assert told(stream)["fault"] == "half"
            assert "<p>1 " in fetched(address[0])  # the last good page stays
            put(path, "22")
            assert told(stream) == {"version": 3, "fault": ""}
        assert "<p>22 " in fetched(address[0])
        with pytest.raises(urllib.error.HTTPError):
            fetched(address[0] + "etc/passwd")
    finally:
        stop.set()
        put(path, "333")
        thread.join(20)
    assert not thread.is_alive()
    with pytest.raises(urllib.error.URLError):
        fetched(address[0])


@pytest.mark.slow
def test_a_watch_by_the_command_ends_with_130_on_an_interrupt(tmp_path: Path) -> None:
    import signal

    path = tmp_path / "small.yaml"
    path.write_text("cam: {kind: support, p: 25 + cos(3*t)}\n", encoding="utf-8")
    command = [sys.executable, "-m", "camgeo", "export", str(path), "--watch", "--out", str(tmp_path / "out")]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    try:
        assert process.stdout is not None
        address = process.stdout.readline().split()[2]
        assert "small: ok" in process.stdout.readline()
        wait(lambda: "<h1>small</h1>" in fetched(address))
        put(path, "cam: {kind: support, p: 25 + cos(3*t\n")
        assert process.stderr is not None
        assert "small.yaml:" in process.stderr.readline()
        put(path, "cam: {kind: support, p: 26 + cos(3*t)}\n")
        assert "small: ok" in process.stdout.readline()
        wait(lambda: "26 + cos" in fetched(address))
        process.send_signal(signal.SIGINT)
        assert process.wait(30) == 130
    finally:
        process.kill()
        process.communicate()


# needs: camshaft
@pytest.mark.slow
def test_a_camshaft_is_watched_with_its_lobes(tmp_path: Path) -> None:
    lobe, path = tmp_path / "lobe.yaml", tmp_path / "shaft.yaml"
    text = (
        "cam: {kind: disc, base_radius: 30, follower: {kind: roller, radius: 8}, motion: {formula: 5*(1 - cos(t))}}\n"
    )
    lobe.write_text(text, encoding="utf-8")
    lobes = "[{recipe: lobe.yaml, at: 0, z: 10, length: 10}]"
    path.write_text(f"camshaft: {{shaft: {{diameter: 20, to: 30}}, lobes: {lobes}}}\n", encoding="utf-8")
    command = [sys.executable, "-m", "camgeo", "export", str(path), "--watch", "--only", "svg", "--tolerance", "0.01"]
    path.write_text(path.read_text(encoding="utf-8") + "export: {files: [svg, html]}\n", encoding="utf-8")
    process = subprocess.Popen(
        [*command, "--out", str(tmp_path / "out")], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    try:
        assert process.stdout is not None
        assert process.stderr is not None
        address = process.stdout.readline().split()[2]
        assert "shaft: ok" in process.stdout.readline()
        wait(lambda: "<h1>shaft</h1>" in fetched(address))
        assert "EventSource" in fetched(address)
        put(lobe, text.replace("30", "-30"))
        assert "shaft.yaml:1:" in (fault := process.stderr.readline())
        assert "lobe.yaml:1:32: cam.base_radius: not above 0, given -30" in fault
        put(lobe, text.replace("30", "31"))
        assert "shaft: ok" in process.stdout.readline()
    finally:
        process.kill()
        process.communicate()


@pytest.mark.parametrize("more", [["b.yaml"], ["--json"]])
def test_a_watch_takes_one_recipe(more: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["export", "a.yaml", *more, "--watch"]) == 2
    assert "--watch takes one recipe" in capsys.readouterr().err


def test_hub_and_timing_mark_are_drawn_on_the_cam(tmp_path: Path) -> None:
    part = "part: {thickness: 8, bore: 8, hub: {diameter: 16, height: 6}, mark: {as: engrave}}\n"
    cam = "cam: {kind: support, p: 25 + 2*cos(3*t)}\n"
    path = tmp_path / "a.yaml"
    path.write_text(f"{cam}{part}export: {{tolerance: 0.01, files: [dxf]}}\nverify: {{angles: 8}}\n")
    recipe = load(path)
    disk = content(recipe, designed(recipe), []).scene.bodies[0]
    roles = [shape.role for shape in disk.shapes]
    assert roles == ["metal", "hub", "timing mark"]  # no line shows the zero besides
    low, high = disk.shapes[2].rings[0].points.min(axis=0), disk.shapes[2].rings[0].points.max(axis=0)
    assert low[0] > 8.0
    assert high[0] < 27.0
    assert (low[1], high[1]) == pytest.approx((-0.25, 0.25))


@pytest.mark.parametrize(
    ("kind", "said"), [("four-bar", "a four-bar"), ("inverted-slider-crank", "an inverted slider-crank")]
)
def test_the_line_under_the_title_names_the_linkage_as_the_pages_do(kind: str, said: str) -> None:
    report = {
        "units": "inch",
        "follower": "square frame",
        "tolerance": 4e-5,
        "linkage": {"kind": kind},
    }
    turns = "the shaft turns counter-clockwise"
    assert tables.facts(report, turns) == f"square frame in {said} · {turns} · tolerance 4e-05 in"
