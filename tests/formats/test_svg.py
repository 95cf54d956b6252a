"""SVG drawings: written and read back, by a second reader of their arcs, and kin's verdict on spoilt ones."""

import math
import re
import shutil
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from support.cases import examples
from support.outlines import bored
from support.parts import CAM, failures

from camgeo.cli.main import main
from camgeo.files.layer_outline import LayerOutline
from camgeo.fit.pieces import ArcSpline, Bound, BSpline, Polygon
from camgeo.formats.svg import write_svg
from camgeo.output.dispatch import make
from camgeo.output.job import Job
from camgeo.recipe.loading import read
from camgeo.synthesis.design import designed
from camgeo.synthesis.intent import intended
from kin.contour.contour import Contour
from kin.judge.intent import Limits
from kin.judge.verify import verify
from kin.read.errors import ReadError
from kin.read.files import read_drawing

EXACT = Bound(0.0, 0.0)
PART = "{bore: 12, keyway: {standard: din6885, at: 180}, bolts: {count: 3, circle: 31, hole: 3.2, start: 60}, %s}"
ENGRAVED = PART % "thickness: 8, mark: {length: 3, width: 0.8, depth: 0.4}"
HEAD = '<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="60mm" viewBox="-30 -30 60 60">'
DISC = '<circle r="20"/>'


def made(folder, *, part=ENGRAVED, form="arcs", tolerance=0.01, more="", cam=CAM):
    """Recipe, design and SVG of it, with the verdict's checks, all of which hold."""
    text = f"{cam}part: {part}\nexport: {{files: [{{svg: {{as: {form}, tolerance: {tolerance}}}}}]}}\n{more}"
    recipe = read(text.encode(), Path("part.yaml"))
    design = designed(recipe)
    (request,) = recipe.export.files
    path = folder / "part.svg"
    (result,), checks = make(Job.of(recipe, design), request, path)
    assert all(check.ok for check in checks), checks
    return recipe, design, path, {check.name: check for check in checks}, result


@pytest.fixture(scope="module")
def engraved(tmp_path_factory):
    return made(tmp_path_factory.mktemp("engraved"))


def written(folder, body, head=HEAD):
    path = folder / "cam.svg"
    path.write_text(f"{head}{body}</svg>", encoding="utf-8")
    return path


def outside(points, pivot=(3.0, 2.0)):
    """Distance of points outside the cam p = 25 + 2 cos 3t, negative inside: the greatest x.u - p, it is convex."""
    t = np.linspace(0, 2 * np.pi, 7200, endpoint=False)
    p = 25 + 2 * np.cos(3 * t) - pivot[0] * np.cos(t) - pivot[1] * np.sin(t)
    return (points @ np.stack([np.cos(t), np.sin(t)]) - p).max(axis=1)


def sampled(data, count=9):
    """Points along path data of M, L, A, C and Z as written by us, by the formulas of SVG 2, appendix B.2."""
    pen, found = None, []
    for letter, text in re.findall(r"([MLACZ])([^MLACZ]*)", data):
        v = np.array(text.split(), dtype=float)
        share = np.linspace(0, 1, count)[:, None]
        if letter == "L":
            found.append(pen + share * (v - pen))
        elif letter == "C":
            b = [pen, v[:2], v[2:4], v[4:]]
            found.append(sum(math.comb(3, k) * share**k * (1 - share) ** (3 - k) * b[k] for k in range(4)))
        elif letter == "A":
            (r, _, _, large, sweep), end = v[:5], v[5:]
            x, y = (pen - end) / 2
            side = 1.0 if large != sweep else -1.0
            root = side * math.sqrt(max(r * r * r * r - r * r * y * y - r * r * x * x, 0) / (r * r * (x * x + y * y)))
            cx, cy = root * y, -root * x
            centre = np.array([cx, cy]) + (pen + end) / 2
            first, last = math.atan2(y - cy, x - cx), math.atan2(-y - cy, -x - cx)
            turn = (last - first) % (2 * math.pi) - (0 if sweep else 2 * math.pi)
            angle = first + share * turn
            found.append(centre + r * np.hstack([np.cos(angle), np.sin(angle)]))
        pen = v[-2:] if len(v) else pen
    return np.concatenate(found)


# --- written and read back --------------------------------------------------------------------------------------------


@pytest.mark.thin(6)
@pytest.mark.parametrize("form", ["arcs", "polyline", "spline"])
@pytest.mark.parametrize("rotation", ["cw", "ccw"])
def test_every_form_is_the_cam_by_a_second_reader_too(tmp_path, form, rotation):
    _, _, path, checks, result = made(tmp_path, form=form, more=f"rotation: {rotation}\n")
    assert {"units", "closed", "bore", "holes", "mark", "contour", "motion"} <= checks.keys()
    assert checks["contour"].value == pytest.approx(result.bound.worst, rel=0.05)
    data = re.search(r'id="CUT".*?d="(.*?)"', path.read_text(), re.DOTALL)[1]
    points = sampled(data) * (1.0, -1.0 if rotation == "ccw" else 1.0)
    off = np.abs(outside(points)).max()
    assert 0.003 < off <= 0.01 + 1e-5  # the angles looked at miss some of it
    assert {"arcs": "A", "polyline": "L", "spline": "C"}[form] in data


@pytest.mark.slow
def test_drawing_is_at_true_size_and_says_so(engraved):
    _, design, path, _, _ = engraved
    text = path.read_text()
    wide, high, left, _, across, down = re.search(
        r'width="(.*?)mm" height="(.*?)mm" viewBox="(\S+) (\S+) (\S+) (\S+)"', text
    ).groups()
    assert (wide, high) == (across, down)
    x_min, y_min, x_max, y_max = -23.0 - 3, -27.0, 27.0 - 3, 27.0
    assert float(left) < x_min + 2.1
    assert float(left) + float(wide) > x_max
    assert float(high) < y_max - y_min + 3
    assert re.findall(r'<g id="(\w+)"', text) == ["CUT", "BORE", "HOLES", "ENGRAVE"]
    assert text.count("<circle") == 3
    assert "fill:none" in text
    assert "mark: 0.4 deep" in re.search("<desc>(.*)</desc>", text)[1]
    drawing = read_drawing(path, engraved=True)
    assert (drawing.units_mm, drawing.version, len(drawing.holes), len(drawing.engraved)) == (1.0, "SVG", 4, 1)
    assert not drawing.turned
    assert drawing.contour.area == pytest.approx(math.pi * (25**2 - 4 * 8 / 2), rel=1e-3)
    assert design.discs[0].body is not None


def test_inches_are_inches_and_the_same_bytes_come_each_time(tmp_path):
    cam = "units: inch\ncam: {kind: support, p: 1 + 0.08*cos(3*t)}\n"
    _, _, path, checks, _ = made(tmp_path, cam=cam, part="{bore: 0.5}", tolerance=0.0004)
    first = path.read_bytes()
    assert b'in" viewBox' in first
    # from -0.92 to 1.08 inch, 1 mm of margin on either side, outward to the next hundredth
    assert re.search(rb'viewBox="(\S+) \S+ (\S+) ', first).groups() == (b"-0.96", b"2.08")
    assert read_drawing(path).units_mm == 25.4
    assert checks["units"].value == 0.0
    made(tmp_path, cam=cam, part="{bore: 0.5}", tolerance=0.0004)
    assert path.read_bytes() == first


def test_title_and_description_are_escaped(tmp_path):
    square = Polygon(np.array([[1.0, 1], [-1, 1], [-1, -1], [1, -1]]), EXACT)
    write_svg(tmp_path / "a.svg", bored(square), name="<cam> & co", about="1 < 2\n\x07")
    text = (tmp_path / "a.svg").read_text()
    assert "<title>&lt;cam&gt; &amp; co</title>" in text
    assert "<desc>camgeo units: mm; 1 &lt; 2</desc>" in text
    assert read_drawing(tmp_path / "a.svg").contour.area == 4.0


def test_what_svg_does_not_have_is_refused(tmp_path):
    path = tmp_path / "a.svg"
    square = Polygon(np.array([[1.0, 1], [-1, 1], [-1, -1], [1, -1]]), EXACT)
    with pytest.raises(ValueError, match=r"1\.0 or 25\.4"):
        write_svg(path, bored(square), mm=10.0)
    with pytest.raises(ValueError, match="BORE: radius"):
        write_svg(path, [*bored(square), LayerOutline("BORE", square, ((0.0, 0.0), 0.0))])
    line = BSpline(1, np.array([[1.0, 1], [-1, 1], [-1, -1], [1, 1]]), np.array([0.0, 0, 1, 2, 3, 3]), 3, EXACT)
    with pytest.raises(ValueError, match="cubic"):
        write_svg(path, bored(line))
    assert not path.exists()


bulges = st.floats(-12, 1.5).map(lambda power: 10.0**power)


@settings(max_examples=examples(60), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(one=bulges, other=bulges, angle=st.floats(0, 6.3), far=st.floats(0, 100), mirrored=st.booleans())
def test_arcs_come_back_within_rounding(tmp_path, *, one, other, angle, far, mirrored):
    """Any two arcs over one chord, from next to nothing to all but a circle."""
    chord = np.array([[math.cos(angle), math.sin(angle)], [-math.cos(angle), -math.sin(angle)]])
    outline = ArcSpline(chord + far, np.array([one, other]), EXACT)
    outline = outline.mirrored() if mirrored else outline
    write_svg(tmp_path / "a.svg", bored(outline))
    back = read_drawing(tmp_path / "a.svg").contour
    meant = Contour.from_bulges(outline.points, outline.bulges)
    size = max(np.abs(outline.box()).max(), 1.0)
    assert meant.distance(back.sample(5)).max() <= 8e-15 * size
    assert back.distance(meant.sample(17)).max() <= 8e-15 * size
    sweeps = [float(a) for a in np.abs(back.sweep)]
    assert max(sweeps) <= math.pi / 2 + 1e-7


# --- spoilt drawings --------------------------------------------------------------------------------------------------


def spoilt(path, pattern, replacement):
    text = path.read_text()
    changed, number = re.subn(pattern, replacement, text, count=1, flags=re.DOTALL)
    assert number
    assert changed != text
    path.write_text(changed)
    return path


@pytest.mark.thin(2)
@pytest.mark.parametrize(
    ("pattern", "replacement", "found"),
    [
        (r'width="(\S+)mm" height="(\S+)mm"', r'width="\1in" height="\2in"', {"units", "contour", "bore", "holes"}),
        (r'width="(\S+)mm" height="(\S+)mm"', r'width="\1" height="\2"', {"units", "contour", "bore", "holes"}),
        (r'width="(\S+)mm" height="(\S+)mm"', "", {"units"}),
        (r'<circle cx="([-.0-9]+)"', lambda m: f'<circle cx="{float(m[1]) + 0.02}"', {"holes"}),
        (r'r="1.6"', 'r="1.58"', {"holes"}),
        (r"<circle [^>]*>", "", {"holes"}),
        (r'id="BORE"(.*?)</g>', r'id="REFERENCE"\1</g>', {"bore"}),
        (r'scale\(1 -1\)"', 'scale(1 1)"', {"contour", "motion"}),
        (r'scale\(1 -1\)"', 'matrix(1 0 0 -1 .02 0)"', {"contour", "motion", "bore", "holes"}),
        (r'scale\(1 -1\)"', 'scale(1.001 -1.001)"', {"contour", "motion"}),
    ],
)
def test_planted_faults_are_caught(engraved, tmp_path, pattern, replacement, found):
    recipe, design, sound, _, _ = engraved
    path = shutil.copy(sound, tmp_path / "part.svg")
    spoilt(path, pattern, replacement)
    if "BORE" in pattern:
        spoilt(path, 'inkscape:label="BORE"', "")
    assert found <= failures(path, recipe, design)


def test_what_stands_on_no_layer_is_cut_too(tmp_path):
    body = '<g id="CUT"><circle r="9"/></g><g id="X"><circle cx="4" r="1"/></g><style>.a {fill: none}</style>'
    (hole,) = read_drawing(written(tmp_path, body)).holes
    assert hole.area == pytest.approx(np.pi)


@pytest.mark.slow
def test_a_flipped_flag_is_caught_on_every_arc(tmp_path):
    recipe, design, path, _, _ = made(tmp_path, part="{bore: 12}")
    text = path.read_text()
    for arc in list(re.finditer(r"A\S+ \S+ 0 0 1", text))[::20]:
        path.write_text(text[: arc.end() - 1] + "0" + text[arc.end() :])
        assert "contour" in failures(path, recipe, design)


def test_an_open_path_is_told(tmp_path):
    recipe, design, path, _, _ = made(tmp_path, part="{bore: 12}", form="polyline")
    lines = path.read_text().splitlines()
    last = lines.index('Z"/>')
    path.write_text("\n".join([*lines[: last - 1], '"/>', *lines[last + 1 :]]))
    verdict = verify(path, intended(recipe, design), 36, Limits(0.01))
    assert [check.name for check in verdict.checks] == ["closed"]
    assert "open" in verdict.checks[0].detail


def test_the_wrong_sense_of_turning_is_caught(tmp_path):
    recipe, design, path, _, _ = made(tmp_path, more="rotation: ccw\n")
    assert {"contour", "motion"} <= failures(path, recipe, design, mirrored=False)
    assert failures(path, recipe, design) == set()


# --- drawings of any origin -------------------------------------------------------------------------------------------


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    "body",
    [
        '<path d="M20 0A20 20 0 0 1 -20 0A20 20 0 0 1 20 0Z"/>',
        '<path d="M20,0a20,20 0 1,1 -40,0a20 20 0 01 40 0z"/>',
        '<path d="m 20 0 A 2e1 20 0 0 1 0 20 20 20 0 0 1 -20 0 A 20 20 0 1 1 20 0"/>',
        '<g transform="translate(5 5)"><circle cx="-5" cy="-5" r="20"/></g>',
        '<g transform="matrix(0 2 -2 0 10 0)"><circle cy="5" r="10"/></g>',
        '<g id="CUT"><circle r="20"/></g><g id="TOOLPATH"><circle r="25"/></g><g id="REFERENCE"><line/></g>',
        '<g style="fill:none; display:none"><circle r="25"/></g><rect display="none"/><circle r="20"/>',
        '<circle r="20" display="none" style="display: inline"/>',
        '<circle r="25" visibility="hidden"/><rect style="visibility:collapse"/><circle r="20"/>',
        '<g visibility="hidden"><circle r="25"/><g><circle r="20" style="fill:none;visibility: Visible "/></g></g>',
        '<g style="visibility:hidden !important"><path d="M0 0H9"/></g><circle r="20" visibility="inherit"/>',
        '<defs><path d="nonsense"/></defs><!-- a comment --><circle r="20"/><text>words</text>',
        '<path d="M20 0C20 11.045694996615872 11.045694996615872 20 0 20" id="a"/><path d="M20 0A20 20 0 1 0 0 20"/>',
    ],
)
def test_a_disc_drawn_in_many_ways(tmp_path, body):
    drawing = read_drawing(written(tmp_path, body))
    assert drawing.units_mm == 1.0
    assert drawing.contour.area == pytest.approx(400 * math.pi, rel=2e-4)
    assert drawing.contour.distance(np.array([[14.142135623730951, 14.142135623730951]]))[0] < 6e-3


def test_y_runs_up_and_letters_mean_what_they_say(tmp_path):
    drawing = read_drawing(written(tmp_path, '<path d="M1 -2h2 1V-5l-1-1.5-.5.5H1z"/>'))
    box = drawing.contour.box
    assert tuple(box) == (1.0, 2.0, 4.0, 6.5)
    corners = {(1.0, 2.0), (3.0, 2.0), (4.0, 2.0), (4.0, 5.0), (3.0, 6.5), (2.5, 6.0), (1.0, 6.0)}
    assert {tuple(point) for point in drawing.contour.start.tolist()} == corners
    assert not drawing.turned


def test_two_outlines_in_one_path_are_contour_and_hole(tmp_path):
    path = written(tmp_path, '<path d="M20 20H-20V-20H20zM5 5H-5V-5H5z"/>')
    drawing = read_drawing(path)
    assert (drawing.contour.area, [hole.area for hole in drawing.holes]) == (1600.0, [100.0])


@pytest.mark.parametrize(
    ("size", "unit"),
    [
        ('width="6cm" height="6cm" viewBox="0 0 60 60"', 1.0),
        ('width="60in" height="60in" viewBox="0 0 60 60"', 25.4),
        ('width="72pt" viewBox="0 0 60 60"', 25.4 / 60),
        ('width="60" height="60"', 25.4 / 96),
        ('width="100%" height="100%" viewBox="0 0 60 60"', None),
        ('viewBox="0 0 60 60"', None),
        ("", None),
    ],
)
def test_units_of_the_page(tmp_path, size, unit):
    drawing = read_drawing(written(tmp_path, DISC, f'<svg xmlns="http://www.w3.org/2000/svg" {size}>'))
    assert drawing.units_mm == (None if unit is None else pytest.approx(unit, rel=1e-15))
    assert drawing.contour.area == pytest.approx(400 * math.pi * (unit or 1.0) ** 2)


BARE = '<svg xmlns="http://www.w3.org/2000/svg" '


@pytest.mark.parametrize(
    ("head", "body", "reason", "message"),
    [
        (HEAD, "", "empty", "nothing to cut; the file holds nothing at all"),
        (HEAD, '<g id="REFERENCE"><circle r="2"/></g>', "empty", "1 circle on REFERENCE"),
        (HEAD, '<rect width="3"/>', "unsupported", "rect #1 is none of path and circle"),
        (HEAD, '<g id="CUT"><circle r="2"/><use href="#a"/></g>', "unsupported", "use #2 on CUT is none of"),
        (HEAD, '<path d="M0 0Q1 1 2 0z"/>', "unsupported", "its path has Q; M, L, H, V, A, C and Z are read"),
        (HEAD, '<path d="M0 0A2 1 0 0 1 2 0z"/>', "unsupported", "an arc has the radii 2 and 1"),
        (HEAD, '<path d="M0 0A1 1 0 0 1 3 0z"/>', "range", "does not reach across its chord of 3"),
        (HEAD, '<path d="M0 0A1 1 0 2 1 1 0z"/>', "syntax", "where a number of A belongs"),
        (HEAD, '<path d="L0 0 1 1z"/>', "syntax", "does not begin with M"),
        (HEAD, '<path d="M0 0L1"/>', "syntax", "where a number of L belongs"),
        (HEAD, '<path d="M0 0 1 1z 3"/>', "syntax", "the number 3 where a letter belongs"),
        (HEAD, '<path d="M0 0 # 1"/>', "syntax", "'#'"),
        (HEAD, '<path d="M0 0L1e9 0 0 1z"/>', "range", "a value of 1e+09"),
        (HEAD, '<path d="M0 0C0 1 1e400 1 1 0z"/>', "range", "its path has 1e400, beyond all numbers"),
        (HEAD, '<circle r="-1"/>', "range", "its radius is -1"),
        (HEAD, '<circle r="10mm"/>', "syntax", "'10mm' is not a number of the drawing's own unit"),
        (HEAD, '<g transform="scale(1 2)"><circle r="2"/></g>', "unsupported", "makes ellipses of its circles"),
        (HEAD, '<g transform="skewX(30)"><circle r="2"/></g>', "unsupported", "makes ellipses of its circles"),
        (HEAD, '<g transform="skewX(90)"><path d="M0 0 L1 0 L0 1 Z"/></g>', "unsupported", "skewX(90) is not read"),
        (HEAD, '<g transform="turn(30)"><circle r="2"/></g>', "unsupported", "the transform turn(30) is not read"),
        (HEAD, '<g transform="scale(a)"><circle r="2"/></g>', "syntax", "a transform is 'scale(a)'"),
        (HEAD, f'<g transform="{"scale(2) " * 900}x"><circle r="2"/></g>', "syntax", f"is '{'scale(2) ' * 5}"[:40]),
        (HEAD, f'<circle r="{"9" * 9000}x"/>', "syntax", "'" + "9" * 37 + "...' is not a number"),
        (HEAD, f'<g transform="turn({"3 " * 9000})"><circle r="2"/></g>', "unsupported", "3 ... is not read"),
        (HEAD, f'<path d="M0 0 1 1z {"3" * 9000}"/>', "syntax", "3... where a letter belongs"),
        (HEAD, f'<path id="{"p" * 9000}" d="M0 0Q1 1 2 0z"/>', "unsupported", "pp...: its path has Q"),
        (HEAD, '<g style="transform:scale(2)"><circle r="2"/></g>', "unsupported", "transformed by its style"),
        (HEAD, "<g>" * 200 + DISC + "</g>" * 200, "unsupported", "groups within groups"),
        (HEAD, "<g>", "syntax", "not a sound SVG file: its XML breaks at line"),
        (BARE + 'transform="scale(2)">', DISC, "unsupported", "the page itself is transformed"),
        (BARE + 'width="6em">', DISC, "syntax", "the size of the page is '6em'"),
        (BARE + 'width="6mm" height="7mm" viewBox="0 0 6 6">', DISC, "unsupported", "along the height"),
        (BARE + 'width="6mm" viewBox="0 0 6">', DISC, "syntax", "the viewBox is '0 0 6'"),
        (BARE + 'width="1e300mm" viewBox="0 0 6 6">', DISC, "range", "a unit of"),
        (HEAD, '<g id="CUT"><circle r="2"/></g><use href="#CUT" x="9"/>', "unsupported", "use #2 is none of path"),
        (HEAD, f"<style>path {{ transform: scale(2) }}</style>{DISC}", "unsupported", "a style sheet sets transform"),
        ("<svg>", DISC, "syntax", "not an SVG file: its first element is svg"),
        ('<!DOCTYPE svg [<!ENTITY a "b">]>' + HEAD, DISC, "unsupported", "declares entities"),
    ],
)
def test_everything_else_is_refused_with_the_reason(tmp_path, head, body, reason, message):
    with pytest.raises(ReadError) as error:
        read_drawing(written(tmp_path, body, head))
    assert error.value.reason == reason
    assert len(error.value.message) < 300
    assert message in error.value.message


def test_an_empty_file_is_told(tmp_path):
    (tmp_path / "a.svg").write_bytes(b" ")
    with pytest.raises(ReadError, match="the file is empty"):
        read_drawing(tmp_path / "a.svg")


@settings(max_examples=examples(150), deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture])
@given(st.text("MmLlHhVvAaCcZzQ0123456789.-+e ,", max_size=60), st.text("(), 0123.-matrixscletn", max_size=20))
def test_noise_is_read_or_refused(tmp_path, data, transform):
    body = f'<path d="M0 0 9 0 9 9{data}" transform="scale(1){transform}"/>'
    try:
        drawing = read_drawing(written(tmp_path, body))
    except ReadError:
        return
    assert math.isfinite(drawing.contour.area)


# --- by the command ---------------------------------------------------------------------------------------------------


@pytest.mark.slow
def test_export_and_verify_by_the_command(tmp_path, capsys):
    recipe = tmp_path / "cam.yaml"
    recipe.write_text(
        f"{CAM}part: {{bore: 12}}\nexport: {{tolerance: 0.01, files: [svg, {{svg: {{as: spline}}}}, html]}}\n"
        "verify: {angles: 36}\n"
    )
    code = main(["export", str(recipe), "--out", str(tmp_path / "out")])
    told = capsys.readouterr()
    assert code == 0, told
    files = sorted((tmp_path / "out" / "cam").glob("*.svg"))
    assert [file.name for file in files] == ["cam-spline.svg", "cam.svg"]
    assert main(["verify", str(recipe), *map(str, files)]) == 0
    assert main(["verify", str(recipe), str(recipe)]) == 2
    assert "none of .dxf, .svg, .stl" in capsys.readouterr().err
