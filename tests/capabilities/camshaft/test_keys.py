"""Keys of a camshaft: heights that are one, an engine's centres, and what is refused by name."""

import re
from pathlib import Path

import numpy as np
import pytest
from support.camshafts import ENGINE, INTAKE, TWO, shaft

import camgeo
from camgeo.capabilities.camshaft.keys import ShaftHeights
from camgeo.cli.main import main
from camgeo.recipe.loading import load_order
from camgeo.recipe.starter import starter
from camgeo.schema.errors import RecipeErrors

RECIPES = Path(__file__).parents[3] / "recipes"


def test_every_sum_of_tenths_of_a_millimetre_meets_the_tenth_that_it_is() -> None:
    """Of all z to 30 and lengths to 20 mm, a sixth of the sums is not the float of the next body's z."""
    z, long = (tenths.ravel() for tenths in np.meshgrid(np.arange(1, 301), np.arange(1, 201)))
    sums, stated = z / 10 + long / 10, (z + long) / 10
    off = sums != stated
    assert 0.08 < np.mean(sums > stated) < off.mean() < 0.2
    level = ShaftHeights(np.unique(stated).tolist())
    assert list(map(level, sums[off].tolist())) == stated[off].tolist()


def test_a_height_that_is_stated_takes_the_sums_about_it() -> None:
    level = ShaftHeights([32.4, 6.2])
    assert level(20.1 + 12.3) == 32.4 != 20.1 + 12.3
    assert level(1.1 + 5.1) == 6.2 != 1.1 + 5.1
    assert level(6.2 + 1e-8) == 6.2 + 1e-8


THIN = {
    "a gap between lobes": (
        "at: 0, z: 1.1, length: 5.1\nat: 90, z: 6.2000001, length: 12",
        "camshaft.lobes[1].z: intake 1 and intake 2 are 1e-07 mm apart, which is too thin; let them ",
    ),
    "a gap before the end": (
        "at: 0, z: 1, length: 5\nat: 90, z: 20, length: 39.995",
        "camshaft.lobes[1].z: intake 2 and the shaft's upper end are 0.005 mm apart, which is too thin; let them ",
    ),
    "a gap at the lower end": (
        "at: 0, z: 0.001, length: 5\nat: 90, z: 20, length: 5",
        "camshaft.lobes[0].z: the shaft's lower end and intake 1 are 0.001 mm apart, which is too thin; let them ",
    ),
    "a lobe": (
        "at: 0, z: 1, length: 0.0000000001\nat: 90, z: 20, length: 5",
        "camshaft.lobes[0].length: intake 1 is too thin, 0 mm long; give a length of more than 0.01 mm, or ",
    ),
}


@pytest.mark.parametrize(("rows", "message"), THIN.values(), ids=THIN)
def test_what_is_thinner_than_the_tolerance_is_refused_by_name(tmp_path: Path, rows: str, message: str) -> None:
    lobes = "\n".join(f"recipe: intake.yaml, {row}" for row in rows.splitlines())
    body = "  shaft: {diameter: 24, to: 60}\n"
    with pytest.raises(camgeo.RecipeErrors, match=re.escape(message)):
        camgeo.check(shaft(tmp_path, lobes, body=body))


REFUSED = {
    "two in one place": (
        ("recipe: intake.yaml, at: 0, z: 30\nrecipe: intake.yaml, at: 9, z: 40", ""),
        "shaft.yaml:6:39: camshaft.lobes[1].z: intake 2 overlaps intake 1, which reaches from 30 to 44 mm; give",
    ),
    "no file": (
        ("recipe: nope.yaml, at: 0, z: 30", ""),
        "shaft.yaml:5:16: camshaft.lobes[0].recipe: the file does not exist, given 'nope.yaml'; give the path of ",
    ),
    "no recipe": (
        ("recipe: secrets.txt, at: 0, z: 30", ""),
        "shaft.yaml:5:16: camshaft.lobes[0].recipe: no recipe, given 'secrets.txt'; give the recipe of a cam\n",
    ),
    "a camshaft": (
        ("recipe: shaft.yaml, at: 0, z: 30", ""),
        "shaft.yaml:5:16: camshaft.lobes[0].recipe: a camshaft is no lobe, given 'shaft.yaml'; give the recipe",
    ),
    "a fault of a lobe's own": (
        ("recipe: slip.yaml, at: 0, z: 30", ""),
        "shaft.yaml:5:16: camshaft.lobes[0].recipe: SLIP:3:16: cam.base_radius: not above 0, given -18; give ",
    ),
    "no engine": (
        ("recipe: intake.yaml, cylinder: 1, valve: intake, z: 30", ""),
        "shaft.yaml:5:39: camshaft.lobes[0].cylinder: needs the engine's data; give camshaft.engine, or `at`",
    ),
    "a fifth cylinder": (
        ("recipe: intake.yaml, cylinder: 5, valve: intake, z: 30", ENGINE),
        "shaft.yaml:5:39: camshaft.lobes[0].cylinder: not in the firing order, given 5; give one of 1, 3, 4, 2",
    ),
    "no valve": (
        ("recipe: intake.yaml, cylinder: 1, z: 30", ENGINE),
        "shaft.yaml:5:7: camshaft.lobes[0].valve: missing, needed with cylinder; give intake or exhaust",
    ),
    "beyond the shaft": (
        ("recipe: intake.yaml, at: 0, z: 110", ""),
        "shaft.yaml:5:39: camshaft.lobes[0].z: it reaches from 110 to 124 mm, the shaft from 0 to 120 mm; ",
    ),
}


@pytest.mark.parametrize(("recipe", "message"), REFUSED.values(), ids=REFUSED)
def test_one_line_with_place_and_remedy(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], recipe: tuple[str, str], message: str
) -> None:
    path = shaft(tmp_path, *recipe)
    (tmp_path / "secrets.txt").write_text("root:x:0:0:root:/root:/bin/bash\n")
    (tmp_path / "slip.yaml").write_text(INTAKE.replace("18", "-18"))
    message = message.replace("SLIP", str(tmp_path / "slip.yaml"))
    assert main(["export", str(path), "--out", str(tmp_path / "out")]) == 2
    told = capsys.readouterr().err
    assert message in told
    assert told.count("\n") == 1
    assert not (tmp_path / "out" / "shaft").exists()


@pytest.mark.parametrize(
    "kind",
    [
        "dxf",
        "gcode",  # needs: milling
    ],
)
def test_a_drawing_is_that_of_a_lobe(tmp_path: Path, capsys: pytest.CaptureFixture[str], kind: str) -> None:
    path = shaft(tmp_path, TWO, files=f"[{kind}]")
    assert main(["check", str(path)]) == 2
    assert f"a camshaft takes no {kind}; leave it out, or give the recipe of a lobe" in capsys.readouterr().err


@pytest.mark.parametrize(("files", "where"), [("[{stl: {parts: all}}]", "files[0].stl."), ("[stl], parts: all", "")])
def test_a_solid_has_shaft_and_lobes_in_one_body(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], files: str, where: str
) -> None:
    path = shaft(tmp_path, TWO, files=files)
    assert main(["check", str(path)]) == 2
    told = capsys.readouterr().err
    assert f"export.{where}parts: each solid of a camshaft has shaft, journals and all lobes in one body; leave" in told
    path = shaft(tmp_path, TWO, files="[{stl: {part: all}}]")
    assert main(["check", str(path)]) == 2
    assert "export.files[0].stl.part: unknown key; " in capsys.readouterr().err


@pytest.mark.parametrize(
    ("recipe", "message"),
    [
        ("w-booth", "two contacts on one arm are no lobe's"),
        ("disc-ring", "a ring, a groove or a pair is no lobe"),  # needs: milling
    ],
)
def test_what_is_no_lobe(tmp_path: Path, recipe: str, message: str) -> None:
    path = shaft(tmp_path, f"recipe: {RECIPES / recipe}.yaml, at: 0, z: 30, length: 9")
    with pytest.raises(camgeo.RecipeErrors, match=message):
        camgeo.check(path)


@pytest.mark.parametrize("word", ["camshafxt", "cam_shaft", "Camshaft"])
def test_a_slip_in_the_word_camshaft_is_named(word: str, tmp_path: Path) -> None:
    path = tmp_path / "shaft.yaml"
    path.write_text(f"{word}: {{lobes: []}}\n", encoding="utf-8")
    with pytest.raises(RecipeErrors) as caught:
        load_order(path)
    assert f"shaft.yaml:1:1: {word}: unknown key; did you mean camshaft?" in str(caught.value)
    path.write_text("cma: {kind: disc}\n", encoding="utf-8")
    with pytest.raises(RecipeErrors, match=r"cma: unknown key; did you mean cam\?"):
        load_order(path)


@pytest.mark.parametrize("key", ["motion_error", "output_error"])
def test_what_a_lobe_is_permitted_stands_in_its_own_recipe(key: str, tmp_path: Path) -> None:
    path = shaft(tmp_path, TWO)
    path.write_text(path.read_text().replace("verify: {", f"verify: {{{key}: 0.1, "), encoding="utf-8")
    with pytest.raises(RecipeErrors, match=rf"verify\.{key}: unknown key; the keys here are angles"):
        load_order(path)
    assert key not in starter("camshaft")


def test_separation_and_advance_are_the_centres_that_they_make(tmp_path: Path) -> None:
    lobes = "recipe: intake.yaml, cylinder: 1, valve: intake, z: 25\n"
    lobes += "recipe: exhaust.yaml, cylinder: 1, valve: exhaust, z: 50"
    files = "[{csv: {as: events}}]"
    told = []
    for centres in ("separation: 110, advance: 4", "intake: 106, exhaust: 114"):
        path = shaft(tmp_path, lobes, f"  engine: {{order: [1], {centres}}}\n", files=files)
        told.append(dict(camgeo.export(path, tmp_path / "out"))["camshaft"])
    assert told[0] == told[1]
    assert told[0]["cylinders"][0]["separation"] == pytest.approx(110.0, abs=1e-9)


@pytest.mark.parametrize(
    ("engine", "message"),
    [
        ("order: [1]", "camshaft.engine: needs intake or separation; give exactly one of them"),
        ("order: [1], intake: 106, exhaust: 114, separation: 110", "separation: cannot be combined with intake"),
        ("order: [1], separation: 110, exhaust: 114", "exhaust: cannot be combined with separation; leave it out"),
        ("order: [1], intake: 106", "camshaft.engine.exhaust: missing, needed with intake"),
        ("order: [1], intake: 106, exhaust: 114, advance: 4", "advance: needs the lobes' separation; leave it out"),
    ],
)
def test_centres_are_given_one_way(engine: str, message: str, tmp_path: Path) -> None:
    path = shaft(tmp_path, "recipe: intake.yaml, cylinder: 1, valve: intake, z: 25", f"  engine: {{{engine}}}\n")
    with pytest.raises(RecipeErrors) as caught:
        load_order(path)
    assert message in str(caught.value)


def test_a_name_longer_than_any_file_has_a_place(tmp_path: Path) -> None:
    path = shaft(tmp_path, f"recipe: {'x' * 300}, at: 0, z: 30")
    with pytest.raises(camgeo.RecipeErrors, match=r"shaft\.yaml:5:16: camshaft\.lobes\[0\]\.recipe: cannot be read: "):
        camgeo.load(path)
