"""Drawings whose pieces do not quite meet: what is open fails, the rest is judged, a gap that is asked for counts."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.heavy import ezdxf

import camgeo
from camgeo import testing
from camgeo.cli.main import main

if TYPE_CHECKING:
    from pathlib import Path

CAM = """\
cam: {kind: support, p: 25 + cos(3*t)}
part: {bore: 10}
export: {tolerance: 0.01, files: [{dxf: {tolerance: 0.002}}]}
"""
# decimals of coordinates and angles, and a gap that is wider than what they leave
DECIMALS = {6: 1.5e-6, 5: 2e-5, 4: 2e-4, 3: 2e-3}


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    """The recipe, and its drawing as loose lines and arcs."""
    folder = tmp_path_factory.mktemp("gaps")
    recipe = folder / "cam.yaml"
    recipe.write_text(CAM)
    report = camgeo.export(recipe, folder / "out")
    assert report.path is not None
    document = ezdxf.readfile(report.path / "cam.dxf")
    for outline in list(document.modelspace().query("LWPOLYLINE[layer=='CUT']")):
        outline.explode()
    path = folder / "loose.dxf"
    document.saveas(path)
    return recipe, path


def rounded(path: Path, target: Path, decimals: int) -> Path:
    """The same pieces in fewer decimals."""
    document = ezdxf.readfile(path)
    for one in document.modelspace().query("ARC LINE"):
        for name in ("start", "end", "center", "radius", "start_angle", "end_angle"):
            if one.dxf.hasattr(name) and one.dxf.layer == "CUT":
                value = one.dxf.get(name)
                one.dxf.set(name, value.round(decimals) if hasattr(value, "x") else round(value, decimals))
    document.saveas(target)
    return target


def parted(path: Path, target: Path, apart: float) -> Path:
    """Each piece moved along x by up to a third of `apart`, as programs do that compute each end by itself."""
    document = ezdxf.readfile(path)
    rng = np.random.default_rng(3)
    for one in document.modelspace().query("ARC LINE"):
        if one.dxf.layer == "CUT":
            one.translate(rng.uniform(-1.0, 1.0) * apart / 3.0, rng.uniform(-1.0, 1.0) * apart / 3.0, 0.0)
    document.saveas(target)
    return target


def verified(recipe: Path, path: Path, **options: float) -> tuple[dict[str, camgeo.Check], set[str]]:
    report = camgeo.verify(recipe, path, **options)
    return {check.name: check for check in report.checks}, {check.name for check in report.checks if not check.ok}


@pytest.mark.slow
@pytest.mark.parametrize(("decimals", "gap"), DECIMALS.items())
def test_few_decimals_are_joined_and_counted_and_a_gap_takes_them(
    made: tuple[Path, Path], tmp_path: Path, decimals: int, gap: float
) -> None:
    recipe, path = made
    spoilt = rounded(path, tmp_path / "returned.dxf", decimals)
    checks, failed = verified(recipe, spoilt)
    assert not failed
    counted = checks["closed"].detail.partition("ends up to ")[2].partition(" mm")[0]
    assert 0.0 < float(counted or 1e-6) < gap
    joined, failed = verified(recipe, spoilt, gap=gap)
    assert not failed
    assert "0 pieces are no longer" in joined["closed"].detail
    wider, failed = verified(recipe, spoilt, gap=gap + 1e-3)
    assert not failed
    for name in ("contour", "motion"):
        assert wider[name].value - joined[name].value == pytest.approx(1e-3, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize("apart", [2e-5, 1e-4, 4.4e-3])
def test_pieces_that_are_apart_by_as_much_as_programs_leave(
    made: tuple[Path, Path], tmp_path: Path, apart: float
) -> None:
    recipe, path = made
    spoilt = parted(path, tmp_path / "returned.dxf", apart)
    checks, failed = verified(recipe, spoilt)
    assert failed == {"closed"}
    assert not verified(recipe, spoilt, gap=apart)[1]
    remedy = checks["closed"].detail.partition("--gap ")[2].partition("mm ")[0]
    assert not verified(recipe, spoilt, gap=float(remedy))[1]
    assert verified(recipe, spoilt, gap=0.01 * apart)[1] == {"closed"}


@pytest.mark.slow
def test_assertions_take_a_gap(made: tuple[Path, Path], tmp_path: Path) -> None:
    """What they return has it added, as the checks of `verify` have."""
    recipe, path = made
    spoilt = parted(path, tmp_path / "returned.dxf", 1e-3)
    for figure in (
        lambda gap: testing.assert_motion(recipe, spoilt, gap=gap).max,
        lambda gap: testing.assert_contour(recipe, spoilt, gap=gap),
    ):
        assert figure(2e-3) - figure(1e-3) == pytest.approx(1e-3, rel=1e-6)
        with pytest.raises(AssertionError, match=r"at most 0\.0"):
            figure(0.02)


def test_a_gap_above_the_tolerance_gets_its_figure_and_fails(made: tuple[Path, Path], tmp_path: Path) -> None:
    """So far as no gap is asked for it cannot be judged, and the check names the one that would do."""
    recipe, path = made
    spoilt = parted(path, tmp_path / "returned.dxf", 0.05)
    checks, failed = verified(recipe, spoilt)
    assert failed == {"closed"}
    gap = float(checks["closed"].detail.partition("--gap ")[2].partition("mm ")[0])
    checks, failed = verified(recipe, spoilt, gap=gap)
    assert failed >= {"contour", "motion"}
    assert "closed" not in failed
    assert checks["contour"].value >= gap


def test_an_open_bore_does_not_keep_the_contour_from_being_judged(made: tuple[Path, Path], tmp_path: Path) -> None:
    recipe, path = made
    document = ezdxf.readfile(path)
    (bore,) = document.modelspace().query("CIRCLE[layer=='BORE']")
    document.modelspace().delete_entity(bore)
    document.modelspace().add_arc((0, 0), 5.0, 0.0, 350.0, dxfattribs={"layer": "BORE"})
    document.saveas(tmp_path / "returned.dxf")
    checks, failed = verified(recipe, tmp_path / "returned.dxf")
    assert failed == {"closed", "bore"}
    assert checks["closed"].detail.endswith("; the rest is judged")
    assert {"contour", "motion"} < set(checks)


@pytest.mark.parametrize(
    ("name", "words", "message"),
    [
        ("returned.dxf", ["--gap", "0.02", "--tolerance", "0.03"], ""),
        ("cam.stl", ["--gap", "0.001"], "a gap is one between ends in a drawing: leave it out"),
        ("returned.dxf", ["--gap", "0"], "a length above 0 and up to 2000000 is expected, not 0"),
        ("returned.dxf", ["--gap", "nan"], "a length above 0 and up to 2000000 is expected, not nan"),
    ],
)
def test_gaps_that_make_no_sense(
    made: tuple[Path, Path], capsys: pytest.CaptureFixture[str], name: str, words: list[str], message: str
) -> None:
    recipe, path = made
    given = path.with_name(name)
    given.write_bytes(path.read_bytes())
    try:
        status = main(["verify", str(recipe), str(given), *words])
    except SystemExit as end:
        status = int(end.code or 0)
    assert status == (2 if message else 0)
    assert message in capsys.readouterr().err


def test_the_gap_stands_in_the_report(
    made: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    recipe, path = made
    spoilt = rounded(path, tmp_path / "returned.dxf", 4)
    assert main(["verify", str(recipe), str(spoilt), "--gap", "2e-4", "--json"]) == 0
    (closed,) = [one for one in json.loads(capsys.readouterr().out)["checks"] if one["name"] == "closed"]
    assert closed["detail"] == "ends up to 0.0002 mm apart are joined, which is counted; 0 pieces are no longer"
