"""Camshafts from a program: loaded, designed, their motion, checks and figures."""

import math
import pickle
from pathlib import Path

import numpy as np
import pytest
import yaml
from support.camshafts import ENGINE, TWO, shaft

import camgeo

RECIPES = Path(__file__).parents[3] / "recipes"


@pytest.mark.slow
def test_a_camshaft_is_loaded_and_designed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """From its file, its text or a mapping: whatever `check` takes. Lifts are those of case f20, at crank 200."""
    rows = [
        f"recipe: {valve}.yaml, cylinder: 4, valve: {valve}, z: {z}" for valve, z in (("intake", 30), ("exhaust", 60))
    ]
    path = shaft(tmp_path, "\n".join(rows), ENGINE, files="[csv]")
    monkeypatch.chdir(tmp_path)
    design = camgeo.design(path)
    assert isinstance(design, camgeo.CamshaftDesign)
    assert design.ok
    assert list(design.lobes) == ["cylinder 4 intake", "cylinder 4 exhaust"]
    assert design.motion(math.radians(100)) == pytest.approx([1.952853268, 0], abs=1e-8)
    assert design.motion([[0, 1], [2, 3]], derivative=1).shape == (2, 2, 2)
    assert design.angles["cylinder 4 intake"] == pytest.approx(math.radians(55))
    radius = design.lobes["cylinder 4 intake"].figures["radius-of-curvature"]
    assert design.figures["radius-of-curvature, cylinder 4 intake"] == radius
    assert repr(design) == "CamshaftDesign('shaft', 2 lobes)"
    for source in (path.read_text(encoding="utf-8"), yaml.safe_load(path.read_text(encoding="utf-8"))):
        recipe = camgeo.load(source)
        assert isinstance(recipe, camgeo.CamshaftRecipe)
        assert camgeo.check(recipe).ok
        assert np.array_equal(camgeo.design(recipe).motion(1.0), design.motion(1.0))
    with pytest.raises(camgeo.CallError, match="a derivative is one of order 0 to 6"):
        design.motion(0.0, derivative=7)
    again = pickle.loads(pickle.dumps(design))
    assert again.checks == design.checks


def test_a_report_of_a_camshaft_shows_itself_and_explains_its_checks(tmp_path: Path) -> None:
    path = shaft(tmp_path, TWO, body="  shaft: {diameter: 37, to: 120}\n")
    report = camgeo.check(path)
    (failed,) = (check for check in report.checks if not check.ok)
    told = report.explain(failed)
    assert told.startswith("shaft, intake: 18 mm, at least 18.5 mm allowed\n")
    assert told.endswith(f"recipe   {path}:4:16 camshaft.lobes[0].recipe")
    assert "shaft, intake" in report._repr_html_()
    assert "size, roller" in report.figures
    assert "<svg" in report.design._repr_svg_()
    mapping = {
        "camshaft": {
            "shaft": {"diameter": 20, "to": 10},
            "lobes": [{"recipe": str(tmp_path / "intake.yaml"), "at": 0, "z": 1}],
        }
    }
    with pytest.raises(camgeo.RecipeErrors, match=r"^recipe: camshaft\.lobes\[0\]\.z: it reaches from 1 to 15 mm"):
        camgeo.load(mapping)


HOLLOW = """\
cam:
  kind: disc
  base_radius: 36
  follower: {kind: roller, radius: 30}
  motion: [{rise: 20, over: 60, law: cycloidal}, {return: 20, over: 60, law: cycloidal}, {dwell: 240}]
part: {thickness: 10}
manufacture: {wheel: 400}
"""


def test_a_wheel_too_large_for_a_lobe_has_a_remedy(tmp_path: Path) -> None:
    """The remedy is twice the least radius of the lobe's hollows: that of the pitch curve, and the roller's."""
    u = np.linspace(0.0, 1.0, 200_001)
    over = math.radians(60)
    s = 20 * (u - np.sin(2 * math.pi * u) / (2 * math.pi))
    v = 20 / over * (1 - np.cos(2 * math.pi * u))
    a = 20 / over**2 * 2 * math.pi * np.sin(2 * math.pi * u)
    r = 36 + 30 + s
    bend = (r**2 + 2 * v**2 - r * a) / np.hypot(r, v) ** 3
    largest = 2 * (30 - 1 / bend.min())
    path = shaft(tmp_path, "recipe: hollow.yaml, at: 0, z: 30", body="  shaft: {diameter: 24, to: 60}\n")
    (tmp_path / "hollow.yaml").write_text(HOLLOW, encoding="utf-8")
    report = camgeo.check(path)
    (failed,) = (check for check in report.checks if not check.ok)
    (line,) = (line for line in report.explain(failed).splitlines() if "remedy" in line)
    number = float(line.split("wheel of ")[1].split()[0])
    assert 0.9995 * largest < number <= largest
    assert line.endswith(" mm or less, in hollow.yaml")
    (tmp_path / "hollow.yaml").write_text(HOLLOW.replace("400", repr(number)), encoding="utf-8")
    assert camgeo.check(path).ok
