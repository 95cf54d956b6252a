"""Remarks: made where they are due and not elsewhere, shown everywhere, and failing nothing."""

from __future__ import annotations

import json
import re
from typing import TYPE_CHECKING, Any

import pytest

from camgeo.cli.main import main
from camgeo.measures.remarks import remarks_of
from camgeo.output.pipeline import check
from camgeo.recipe.loading import load_text
from camgeo.report.page import tables
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from pathlib import Path

    from camgeo.measures.rule_remark import RuleRemark

FLAT = "cam: {kind: support, p: 30 + 3*cos(2*t)}\n"
ROLLER = "cam: {kind: double-roller, ratio: 4/3, arm: 60, roller_radius: 8, delta: {cos: {1: 625}}}\n"
PAIR = "cam: {kind: flat-pair, ratio: 2, arm: 30, delta: {cos: {1: 252}}}\n"
LINKED = """\
cam: {kind: support, p: 25 + sin(3*t) + 13/15*sin(3*t)*cos(2*t), shaft: [18, 8.5]}
linkage: {kind: four-bar, ground: 80, coupler: 70, rocker: 105}
"""
PRELOADED = """\
cam:
  kind: constant-diameter
  base_radius: 33
  roller_radius: 8
  motion: [{rise: 14, over: 180, law: modified-sine}]
  preload: {interference: 0.02, stiffness: [5.0e+7, 4.0e+7]}
dynamics: {mass: 1.5, rpm: %d}
"""
WANTED = (
    "cam: {kind: flat-pair, ratio: 2, arm: 60, delta: {harmonics: %d, law: [{rise: 0.5, over: 45, law: harmonic}, "
    "{return: 0.5, over: 45, law: harmonic}]}}\n"
)
INCH = "units: inch\ncam: {kind: support, p: 1.5 + 0.1*cos(2*t)}\n"
KEYED = "part: {bore: %s, keyway: %s}\n"


SIZED_PAIR = """\
units: inch
cam:
  kind: disc
  sizing: {pressure-angle: {at_most: 30}}
  follower: {kind: roller, radius: 0.35}
  conjugate: {radius: %s, distance: 5, gap: 0.1}
  motion:
    - {rise: 1, over: 100, law: polynomial-4567}
    - {dwell: 40}
    - {return: 1, over: 140, law: polynomial-4567}
    - {dwell: 80}
"""


def remarks(text: str) -> list[RuleRemark]:
    recipe = load_text(text, "cam.yaml")
    return list(remarks_of(recipe, designed(recipe)))


def names(text: str) -> list[str]:
    return [remark.name for remark in remarks(text)]


def test_a_large_second_roller_of_a_sized_pair_is_told_the_radius_that_keeps_the_rule() -> None:
    (remark,) = (remark for remark in remarks(SIZED_PAIR % 1.1) if remark.name == "large-roller")
    keeping = re.search(r"which a conjugate\.radius below (\S+) in keeps$", remark.sentence)
    assert keeping
    assert "large-roller" in names(SIZED_PAIR % (float(keeping[1]) + 0.001))
    assert "large-roller" not in names(SIZED_PAIR % keeping[1])


@pytest.mark.parametrize("text", [FLAT, PAIR, LINKED, INCH, ROLLER.replace("625", "300")])
def test_a_sound_recipe_has_none(text: str) -> None:
    assert names(text) == []


@pytest.mark.thin(3)
@pytest.mark.parametrize(
    ("text", "found"),
    [
        (ROLLER, ["pressure-angle"]),
        (ROLLER + "limits: {pressure-angle: {at_most: 80}}\n", []),
        (ROLLER + "limits: {pressure-angle: {at_least: 1}}\n", ["pressure-angle"]),
        ("cam: {kind: support, p: 30, shaft: [40, 0]}\n", ["shaft-outside"]),
        ("cam: {kind: support, p: 30, shaft: [29, 0]}\n", []),
        ("cam: {kind: support, p: 30, shaft: [40, 0]}\npart: {bolts: {count: 3, circle: 10, hole: 2}}\n", []),
        ("cam: {kind: support, p: '30'}\n", ["no-motion"]),
        (FLAT + "export: {tolerance: 0.61}\n", ["coarse-tolerance"]),
        (FLAT + "export: {tolerance: 0.59}\n", []),
        (FLAT + "export: {tolerance: 3, files: [csv]}\n", []),
        (FLAT + "export: {files: [dxf, {svg: {tolerance: 0.61}}]}\n", ["coarse-tolerance"]),
        (FLAT + "verify: {motion_error: 0.61}\n", ["loose-motion-error"]),
        (ROLLER + "verify: {motion_error: 1.99}\nlimits: {pressure-angle: {at_most: 80}}\n", []),
        (ROLLER + "verify: {motion_error: 2.01}\nlimits: {pressure-angle: {at_most: 80}}\n", ["loose-motion-error"]),
        # needs: dynamics
        (PRELOADED % 2480, []),
        # needs: dynamics
        (PRELOADED % 2490, ["lost-contact"]),
        (WANTED % 1, ["wanted-law"]),
        (WANTED % 1 + "limits: {law-error: {at_most: 3}}\n", []),
        (WANTED % 3, []),
        (LINKED + "verify: {output_error: 5}\n", ["loose-output-error"]),
        (LINKED + "dwell: {band: 5}\n", ["wide-dwell-band"]),
        (FLAT + "part: {thickness: 65}\n", []),
        (FLAT + "part: {thickness: 67}\n", ["thick"]),
        (FLAT + "part: {thickness: 0.3}\n", ["thin"]),
        (INCH + KEYED % ("0.75", "din6885"), ["metric-keyway"]),
        (INCH + KEYED % ("0.75", "{width: 0.1875, depth: 0.09}"), []),
        (INCH + KEYED % (repr(20 / 25.4), "din6885"), []),
        (FLAT + KEYED % ("19.05", "din6885"), ["metric-keyway"]),
        (FLAT + KEYED % ("20", "din6885"), []),
        (FLAT + KEYED % ("19.1", "din6885"), []),
    ],
)
def test_where_a_remark_is_made(text: str, found: list[str]) -> None:
    assert names(text) == found


def test_what_a_remark_tells() -> None:
    (pressure,) = remarks(ROLLER)
    assert (pressure.rule, pressure.unit) == (45.0, "deg")
    assert pressure.value == pytest.approx(62.5453, abs=1e-4)
    assert pressure.at_deg == pytest.approx(134.30, abs=0.01)
    assert pressure.sentence == "the pressure angle reaches 62.55 deg; up to 45 is the rule for oscillating followers"
    (outside,) = remarks("cam: {kind: support, p: 30, shaft: [40, 0]}\n")
    assert outside.sentence == "the shaft lies outside the contour by 10 mm"
    corner = "reuleaux: {sides: 3, breadth: 50}, shaft: [28.8675134594813, 0]"
    (on,) = (x for x in remarks(f"cam: {{kind: support, {corner}}}\n") if x.name == "shaft-outside")
    assert on.sentence == "the shaft lies on the contour"  # but for 3e-14 mm
    (keyway,) = remarks(INCH + KEYED % ("0.75", "din6885"))
    assert keyway.sentence.startswith("a bore of 0.75 in takes a metric keyway of DIN 6885, 6 mm wide")
    (coarse,) = remarks("cam: {kind: support, p: 30 + cos(t)}\nexport: {tolerance: 3}\n")
    assert coarse.sentence == "the tolerance, 3 mm, is 1.5 times the stroke of 2 mm"


LONG_DWELL = """\
cam:
  kind: support
  fourier: {mean: 25, cos: {3: 2.938, 5: -0.0487, 7: -0.0206, 9: -0.0628}}
  shaft: [14.833, 0]
linkage: {kind: four-bar, ground: 79.28, coupler: 61.85, rocker: 60}
dwell: {band: 0.1, over: shaft}
part: {thickness: 8, bore: 10}
"""


@pytest.mark.slow
def test_a_files_dwell_that_is_shorter_than_the_intended_one_is_remarked() -> None:
    # a ripple just fills the band: arcs within 0.01 mm let it out, arcs within 0.005 do not
    for tolerance, made in (("0.01", True), ("0.005", False)):
        report = check(load_text(LONG_DWELL + f"export: {{tolerance: {tolerance}, files: [dxf]}}\n", "a.yaml")).report
        assert report["ok"]
        assert [remark["name"] for remark in report["remarks"]] == ["dwell-shorter"] * made
        if made:
            (remark,) = report["remarks"]
            (file,) = (dwell for dwell in report["linkage"]["dwells"] if dwell["from"] == "a.dxf")
            assert remark["value"] == file["length_deg"] < remark["rule"]
            assert remark["sentence"].startswith("a.dxf: the output dwells for 82.489 deg of the 93.223 intended")


def test_remarks_are_shown_everywhere_and_fail_nothing(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "roller.yaml"
    path.write_text(ROLLER + "part: {thickness: 200}\nverify: {angles: 120}\nexport: {files: [dxf, html]}\n")
    assert main(["export", str(path), "--out", str(tmp_path / "out"), "-v"]) == 0
    out = capsys.readouterr().out
    *rest, line = out.splitlines()
    assert line.startswith("roller: ok")
    assert "; remark: the pressure angle reaches 62.55 deg; up to 45 is the rule for oscillating followers" in line
    assert "; remark: part.thickness, 200 mm, is " in line
    (row,) = [text for text in rest if text.startswith("pressure-angle") and " remark " in text]
    assert row.split() == ["pressure-angle", "remark", "62.5453", "<=", "45", "deg", "134.30", "deg"]
    report: dict[str, Any] = json.loads((tmp_path / "out" / "roller" / "report.json").read_text())
    assert report["ok"]
    assert [one["name"] for one in report["remarks"]] == ["pressure-angle", "thick"]
    assert set(report["remarks"][0]) == {"name", "value", "rule", "unit", "at_deg", "sentence"}
    page = (tmp_path / "out" / "roller" / "roller.html").read_text(encoding="utf-8")
    assert page.count('<tr class="remark">') == 2
    assert "up to 45 is the rule for oscillating followers" in page
    assert main(["check", str(path), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)[0]["remarks"] == report["remarks"]


def test_on_the_page_remarks_stand_between_what_fails_and_what_holds() -> None:
    def check(name: str, *, ok: bool) -> dict[str, Any]:
        rest = {"value": 1.0, "limit": 2.0, "unit": "mm", "sense": "at_most", "at_deg": None}
        return {"name": name, "ok": ok, **rest}

    remark = {"name": "thin", "value": 0.1, "rule": 0.3, "unit": "mm", "at_deg": None, "sentence": "a <foil>"}
    text = tables.checks({"checks": [check("a", ok=True), check("b", ok=False)], "remarks": [remark]})
    assert [text.index(f'scope="row">{name}') for name in ("b", "thin", "a")] == sorted(
        text.index(f'scope="row">{name}') for name in ("a", "b", "thin")
    )
    assert "a &lt;foil&gt;" in text
    assert "≥" in text


def test_lengths_are_in_the_recipe_s_unit(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = tmp_path / "bar.yaml"
    path.write_text(INCH + "part: {thickness: 8}\nverify: {angles: 120}\n")
    assert main(["check", str(path), "--json"]) == 0
    (one,) = json.loads(capsys.readouterr().out)[0]["remarks"]
    assert (one["name"], one["value"], one["unit"]) == ("thick", 8.0, "in")
    assert one["rule"] == pytest.approx(3.2, rel=1e-3)
    assert one["sentence"].startswith("part.thickness, 8 in, is 5 times")
