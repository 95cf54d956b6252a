"""A spike of the intended motion, narrower than any step of a search, that a file does not have: it fails."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples

import camgeo
from kin.law.bounds import cubic_cells
from kin.law.formula.formula import Formula
from kin.law.from_formula import lift_from_formula
from kin.numeric.errors import UnsettledError

if TYPE_CHECKING:
    from pathlib import Path

TOLERANCE, HIGH = 0.002, 0.004
DISC = "kind: disc, base_radius: 30, "
CAMS = {
    "flat": DISC + "follower: {kind: flat}, motion: {formula: '4 - 4*cos(t)SPIKE'}",
    "tilted": DISC + "follower: {kind: flat, tilt: 10}, motion: {formula: '4 - 4*cos(t)SPIKE'}",
    "support": "kind: support, p: '25 + 3*cos(t)SPIKE'",
    "flat on an arm": DISC + "follower: {kind: flat, arm: {pivot: 80}}, motion: {formula: '5 - 5*cos(t)SPIKE'}",
    "roller": DISC + "follower: {kind: roller, radius: 8}, motion: {formula: '6 - 6*cos(t)SPIKE'}",
    "knife edge": DISC + "follower: {kind: knife-edge}, motion: {formula: '4 - 4*cos(t)SPIKE'}",
}


def recipe(folder: Path, cam: str, spike: str = "", export: str = f"{TOLERANCE}, files: [dxf]") -> Path:
    path = folder / f"{'spike' if spike else 'plain'}.yaml"
    text = f"cam: {{{cam.replace('SPIKE', spike)}}}\nexport: {{tolerance: {export}}}\n"
    path.write_text(text + "verify: {angles: 90}\n")
    return path


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "width"),
    [
        # of a roller the narrowest spike takes the search ten seconds
        pytest.param(name, width, marks=[pytest.mark.slow] if (name, width) == ("roller", 2e-5) else [])
        for name in CAMS
        for width in (2e-2, 2e-4, 2e-5)
    ],
)
def test_a_spike_that_the_file_lacks(tmp_path: Path, name: str, width: float) -> None:
    """Twice the tolerance high: eccentric circles have no error at all wherever else one looks."""
    if (name, width) == ("flat on an arm", 2e-5):
        pytest.skip("the face would swing faster than the cam turns")
    report = camgeo.export(recipe(tmp_path, CAMS[name]), tmp_path / "out")
    assert report.ok
    assert report.path is not None
    spiked = recipe(tmp_path, CAMS[name], f" + {HIGH}*exp((cos(t - 3.3) - 1)/{width}**2)")
    verdict = camgeo.verify(spiked, report.path / "plain.dxf")
    motion = next(check for check in verdict.checks if check.name == "motion")
    assert not motion.ok
    if name in {"flat", "support"}:
        # the narrowest is refused as rougher than rounding, before it is measured
        assert motion.value == (None if width < 1e-4 else pytest.approx(HIGH, rel=0.05))


@given(place=st.floats(0.5, 5.5), exponent=st.floats(-5.0, -1.0))
@settings(max_examples=examples(20), deadline=None)
def test_a_cubic_on_each_cell_is_near_the_law(place: float, exponent: float) -> None:
    """At random places, and at the spike's own, by Hermite's formula."""
    near, width = 1e-6, 10.0**exponent
    law = lift_from_formula(Formula(f"30 + cos(t) + 0.01*exp((cos(t - {place!r}) - 1)/{width!r}**2)")).law
    cells = cubic_cells(law, law.breaks, near)
    assert cells[0] == 0.0
    assert cells[-1] == 2.0 * np.pi
    rng = np.random.default_rng(1)
    t = np.concatenate([rng.uniform(0.0, 2.0 * np.pi, 500), place + width * np.linspace(-3.0, 3.0, 500)])
    k = np.clip(np.searchsorted(cells, t) - 1, 0, len(cells) - 2)
    h = cells[k + 1] - cells[k]
    s = (t - cells[k]) / h
    (f, df), (g, dg) = law.derivatives(cells[k], 1), law.derivatives(cells[k + 1], 1, -1)
    cubic = f * (1 + 2 * s) * (1 - s) ** 2 + g * s**2 * (3 - 2 * s) + h * (df * s * (1 - s) ** 2 - dg * s**2 * (1 - s))
    assert np.abs(cubic - law.derivatives(t, 0)[0]).max() <= near + 1e-12


def test_a_law_that_cannot_be_followed_says_so(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kin.law.bounds._MOST_CELLS", 100)
    law = lift_from_formula(Formula("30 + cos(7*t)")).law
    with pytest.raises(UnsettledError, match="too rough to be followed to 1e-12"):
        cubic_cells(law, law.breaks, 1e-12)


def test_what_the_proof_leaves_open_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A spike of 1e-7 rad is not met by a search that ends early; what the motion may do there is not left out."""
    monkeypatch.setattr("kin.follower.tracking.MOST_OPEN", 200_000)
    export = "2e-5, files: [{dxf: {as: polyline}}]"
    report = camgeo.export(recipe(tmp_path, CAMS["knife edge"], export=export), tmp_path / "out")
    assert report.ok
    assert report.path is not None
    spiked = recipe(tmp_path, CAMS["knife edge"], " + 8e-5*exp((cos(t - 3.30303) - 1)/1e-7**2)", export)
    verdict = camgeo.verify(spiked, report.path / "plain.dxf")
    motion = next(check for check in verdict.checks if check.name == "motion")
    measured = dict(verdict)["files"][0]["motion"]
    assert measured["max"] < motion.limit < measured["max"] + measured["remainder"]
    assert not motion.ok
    assert "true within" in motion.detail


@pytest.mark.slow
def test_rounding_is_not_left_open(tmp_path: Path) -> None:
    """At the finest tolerances what the proof leaves open is rounding, and a sound file passes."""
    for tolerance in ("1.0e-9", "1.0e-10", "2.0e-11"):
        report = camgeo.export(recipe(tmp_path, CAMS["roller"], export=f"{tolerance}, files: [dxf]"), tmp_path / "out")
        assert report.ok, tolerance
