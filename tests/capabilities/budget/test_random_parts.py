"""Made parts by contact: influences against their differences, finite errors, what chance leaves of a budget.

Holds: camgeo.capabilities.budget.exact_metal, camgeo.capabilities.budget.file_metal.
"""

from __future__ import annotations

import math
import re
import tracemalloc
from functools import cache
from typing import TYPE_CHECKING

import numpy as np
import pytest
from support.budgets import dimensions_of
from support.made_cases import CASES
from support.places import ROOT

import camgeo
from camgeo.capabilities.budget import random_parts
from camgeo.capabilities.budget.dimensions import DIMENSIONS
from camgeo.capabilities.budget.influence import influence
from camgeo.capabilities.budget.keys import Budget
from camgeo.capabilities.budget.library import budget as split
from camgeo.capabilities.budget.random_parts import Moments, errors_by_contact, sample_angles, simulate
from camgeo.capabilities.budget.read_contours import read_contours
from camgeo.cli.main import main
from camgeo.common.errors import CallError
from camgeo.recipe.loading import load_text
from camgeo.synthesis.design import designed

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

GUIDE = 120.0
STEPS = np.array([-2.0, -1.0, 1.0, 2.0])  # five-point difference
SHARES = np.array([1.0, -8.0, 8.0, -1.0]) / 12.0
SHAFT = np.radians([7.0, 41.0, 98.0, 133.0, 188.0, 226.0, 277.0, 333.0])
FAMILIES = [
    "disc-roller",
    "disc-ring",  # needs: milling
    "disc-flat",
    "disc-arm",
    "disc-arm-flat",
    "conjugate-stem",
    "conjugate-arm",
    "conjugate-flat",
    "groove-stem",  # needs: milling
    "groove-arm",
    "print-double-roller",  # needs: mechanism
    "w-ellipse",
    "print-constant-diameter",  # needs: mechanism
    "shu-wu",
    "valve-lobe",  # needs: dynamics
    "as-figure-8",
    "as-figure-12",
    "slider-crank",
]

READ = [
    "disc-roller",
    "disc-ring",  # needs: milling
    "disc-flat",
    "disc-arm",
    "disc-arm-flat",
    "groove-stem",  # needs: milling
    "disc-knife-edge",
    "knife-arm",
    "conjugate-stem",
    "conjugate-flat",
]
OWN = {
    "knife-arm": """\
cam:
  kind: disc
  base_radius: 34
  follower: {kind: knife-edge, arm: {length: 65, pivot: 80, side: trailing}}
  motion: [{rise: 20, over: 130, law: cycloidal}, {dwell: 50}, {return: 20, over: 130, law: cycloidal}, {dwell: 50}]
export: {tolerance: 0.01, files: [dxf]}
""",
    "trimmed-roller": """\
cam:
  kind: disc
  base_radius: 10
  undercut: trim
  follower: {kind: roller, radius: 25}
  motion: [{rise: 25, over: 40, law: cycloidal}, {return: 25, over: 40, law: cycloidal}, {dwell: 280}]
export: {tolerance: 0.0001, files: [dxf]}
""",
    "trimmed-frame": """\
cam: {kind: support, p: 25 + 3.4*cos(3*t), shaft: [10, 4], undercut: trim}
linkage: {kind: slider-crank, coupler: 75, offset: 0}
export: {tolerance: 0.0001, files: [dxf]}
""",
    "preload-frame": """\
cam: {kind: support, p: 25 + 2*cos(3*t), shaft: [10, 4], preload: {interference: 0.02}}
linkage: {kind: slider-crank, coupler: 75, offset: 0}
export: {tolerance: 0.001, files: [dxf]}
""",
}


class Stepped:
    """Sizes that are off by nothing but one, by some steps of it: a part for each."""

    def __init__(self, name: str, step: float, component: complex = 1.0) -> None:
        self.name, self.steps, self.component = name, step * STEPS[:, None], component

    def size(self, name: str) -> np.ndarray:
        return self.steps if name == self.name else 0.0 * self.steps

    def radius(self, name: str) -> np.ndarray:
        return self.component * (self.steps if name == self.name else 0.0 * self.steps)


@cache
def of_recipe(name: str):
    path = ROOT / "recipes" / f"{name}.yaml"
    return load_text(OWN.get(name) or path.read_text(encoding="utf-8"), path)


@cache
def design_of(name: str):
    return designed(of_recipe(name))


@pytest.mark.thin(6)
@pytest.mark.parametrize("name", FAMILIES)
def test_influences_are_differences_of_contact_with_the_metal_fixed(name: str) -> None:
    recipe = of_recipe(name)
    design = design_of(name)
    words = dimensions_of(recipe)
    stated = Budget(1.0, tuple((word, 1.0) for word in words), guide=GUIDE)
    rows = influence(recipe, design, stated, SHAFT)
    errors_of = errors_by_contact(recipe, design, stated, SHAFT)
    for word in words:
        components = (1.0, 1j) if DIMENSIONS[word].radius else (1.0,)
        for k, component in enumerate(components):
            step = 2e-4 if DIMENSIONS[word].angle else 5e-3
            errors = errors_of(Stepped(word, step, component))
            measured = np.einsum("p,cpn->cn", SHARES, errors) / step
            # sizes that each contact has of its own are all off together
            ours = np.sum([one.rows[:, k] for one in rows.contributions if one.name == word], axis=0)
            assert np.abs(measured - ours).max() < 2e-6 * max(1.0, np.abs(ours).max()), (word, component)


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", ["yoke-preload", "preload-frame"])
def test_errors_of_a_preloaded_follower_are_those_beside_its_overlap(name: str, tmp_path: Path) -> None:
    recipe, design = of_recipe(name), design_of(name)
    stated = Budget(1.0, (("profile", 0.01),))
    assert np.abs(errors_by_contact(recipe, design, stated, SHAFT)(Stepped("", 0.0))).max() < 1e-9
    camgeo.export(recipe, tmp_path, only=["dxf"])
    contours = read_contours(recipe, design, [tmp_path / name / f"{name}.dxf"])
    errors = errors_by_contact(recipe, design, stated, SHAFT, contours)(Stepped("", 0.0))
    assert np.abs(errors).max() < 1.1 * recipe.export.tolerance


def test_finite_errors() -> None:
    """Roller + 0.05, offset + 0.2, both: worked cases by contact at 50, 215 and 300 degrees."""
    recipe = load_text(CASES["roller on a stem"].cam, "a.yaml")
    design, shaft = designed(recipe), np.radians([50.0, 215.0, 300.0])
    errors_of = errors_by_contact(recipe, design, Budget(1.0, (("profile", 1.0),)), shaft)

    class Sizes(Stepped):
        def size(self, name: str) -> np.ndarray:
            off = {"follower.radius": [0.05, 0.0, 0.05], "follower.offset": [0.0, 0.2, 0.2]}
            return np.array(off.get(name, [0.0, 0.0, 0.0]))[:, None]

        def radius(self, _name: str) -> np.ndarray:
            return np.zeros((3, 1), dtype=complex)

    (errors,) = errors_of(Sizes("", 0.0))
    worked = [
        [0.0515869991, 0.0568231843, 0.0512807811],
        [0.0503940331, -0.1085390488, -0.0460642544],
        [0.1019296928, -0.0515990204, 0.0052703601],
    ]
    assert np.abs(errors - worked).max() < 1e-9


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", FAMILIES)
def test_deviations_are_those_foreseen(name: str) -> None:
    recipe, design = of_recipe(name), design_of(name)
    sizes = tuple((word, 1e-3) for word in dimensions_of(recipe))
    parts = simulate(recipe, design, Budget(1.0, sizes, guide=GUIDE, runs=1000, seed=3), sample_angles([0.3]))
    assert all(one.agrees for one in parts.spreads)
    assert parts.within == 1.0
    for one in parts.spreads:
        assert one.error < 0.05 * one.deviation


def test_deviations_from_where_the_machine_is_set() -> None:
    recipe = of_recipe("disc-roller")
    sizes = (("profile", 0.01), ("angle", 1e-3), ("bore", 0.01))
    stated = Budget(0.05, sizes, zero=math.radians(300.0), runs=2000)
    parts = simulate(recipe, designed(recipe), stated, sample_angles([0.9]))
    assert all(one.agrees for one in parts.spreads)
    assert 0.0 < parts.within < 1.0


@pytest.mark.slow
def test_the_same_seed_gives_the_same_parts_and_another_one_others() -> None:
    text = (ROOT / "recipes" / "disc-roller.yaml").read_text(encoding="utf-8")
    text += "budget: {permitted: 0.03, tolerances: {profile: 0.01, angle: 0.05}, runs: 500, seed: %d}\n"
    first, again, other = (split(load_text(text % seed, "a.yaml"))["parts"] for seed in (1, 1, 2))
    assert first == again
    assert first["worst"]["sd"] != other["worst"]["sd"]
    assert first["agrees"]


def test_moments_of_blocks_are_those_of_all_parts_together() -> None:
    """Errors of 3e-3 about 10: sums of their own powers would leave no digit of the fourth moment."""
    errors = 10.0 + 1e-3 * np.random.default_rng(5).exponential(3.0, (2, 5000, 4))
    moments = Moments()
    for begin, end in ((0, 7), (7, 2000), (2000, 5000)):
        moments.add(errors[:, begin:end])
    off = errors - errors.mean(axis=1, keepdims=True)
    for ours, direct in zip(
        moments.central(), (errors.mean(axis=1), (off**2).mean(axis=1), (off**4).mean(axis=1)), strict=True
    ):
        assert ours == pytest.approx(direct, rel=1e-10)
    assert (moments.greatest == errors.max(axis=1)).all()
    assert moments.count == 5000


@pytest.mark.slow
def test_memory_is_that_of_a_block_whatever_the_number_of_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(random_parts, "AT_ONCE", 50)
    recipe, design, shaft = of_recipe("disc-flat"), design_of("disc-flat"), sample_angles([])
    most = []
    for runs in (500, 5000):
        tracemalloc.start()
        simulate(recipe, design, Budget(1.0, (("profile", 0.01),), runs=runs), shaft)
        most.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    assert most[1] < 1.1 * most[0]


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Callable[[str], list[Path]]:
    """Drawings of a cam, coarse: their errors are far above what a simulation may sink between points."""
    folder = tmp_path_factory.mktemp("made")

    @cache
    def of(name: str) -> list[Path]:
        text = of_recipe(name).text.replace("tolerance: 0.001", "tolerance: 0.01")
        camgeo.export(load_text(text, f"{name}.yaml"), folder, only=["dxf"])
        return sorted((folder / name).glob("*.dxf"))

    return of


@pytest.mark.slow
@pytest.mark.parametrize("name", READ)
def test_parts_of_a_file_begin_with_its_own_errors(name: str, made: Callable[[str], list[Path]]) -> None:
    """Nothing off, the error by contact is the one that the judge finds of the file."""
    recipe, design = of_recipe(name), design_of(name)
    contours = read_contours(recipe, design, made(name))
    errors_of = errors_by_contact(recipe, design, Budget(1.0, (("profile", 0.01),)), SHAFT, contours)
    for errors, contact in zip(errors_of(Stepped("", 0.0))[:, 0], design.follower.contacts, strict=True):
        judged = design.exact.gauges[contact.surface].judge(contours[contact.surface], SHAFT).motion
        rms = np.sqrt((errors**2).mean())
        assert abs((math.degrees(rms) if judged.unit == "deg" else rms) - judged.rms) < 2e-6


@pytest.mark.thin(4)
@pytest.mark.parametrize("name", ["disc-knife-edge", "knife-arm", "conjugate-flat"])
def test_on_a_file_sizes_do_what_they_do_on_the_exact_contour(name: str, tmp_path: Path) -> None:
    recipe, design = of_recipe(name), design_of(name)
    camgeo.export(load_text(re.sub(r"tolerance: [0-9.]+", "tolerance: 0.0001", recipe.text), f"{name}.yaml"), tmp_path)
    contours = read_contours(recipe, design, sorted((tmp_path / name).glob("*.dxf")))
    for word in ("profile", "shaft", "angle"):
        stated = Budget(1.0, ((word, 0.02),))
        exact = errors_by_contact(recipe, design, stated, SHAFT)(Stepped(word, 0.01))
        read = errors_by_contact(recipe, design, stated, SHAFT, contours)(Stepped(word, 0.01))
        reach = 65.0 if name == "knife-arm" else 1.0  # of its arm, whose errors are angles
        assert reach * np.abs(exact).max() > 0.01
        assert reach * np.abs(exact - read).max() < 1.1e-4, word


@pytest.mark.slow
def test_the_command_simulates_a_file(
    made: Callable[[str], list[Path]], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "c.yaml"
    text = (
        of_recipe("disc-roller").text
        + "budget: {permitted: 0.05, tolerances: {profile: 0.01, bore: 0.01}, runs: 500}\n"
    )
    path.write_text(text, encoding="utf-8")
    (drawing,) = made("disc-roller")
    assert main(["budget", str(path), str(drawing)]) == 0
    out = capsys.readouterr().out
    assert "of 500 parts by contact on disc-roller.dxf" in out
    assert "which agrees with" in out
    assert main(["budget", str(path), str(path)]) == 2
    assert "c.yaml" in capsys.readouterr().err
    assert main(["budget", str(path), str(tmp_path / "none.dxf")]) == 2
    assert "none.dxf" in capsys.readouterr().err


@pytest.mark.costly("budgets of a file, which is read and judged")
def test_what_no_file_can_show_is_said(made: Callable[[str], list[Path]], tmp_path: Path) -> None:
    pair, design = of_recipe("conjugate-stem"), design_of("conjugate-stem")
    discs = made("conjugate-stem")
    with pytest.raises(CallError, match="give a file of each disc"):
        read_contours(pair, design, discs[:1])
    with pytest.raises(CallError, match="give one file, or one of each disc"):
        read_contours(pair, design, [*discs, *discs])
    for name in ("a.dxf", "a.foo"):  # each is named once
        (tmp_path / name).write_text("no drawing", encoding="utf-8")
        with pytest.raises(CallError) as refused:
            read_contours(of_recipe("disc-roller"), design_of("disc-roller"), [tmp_path / name])
        assert str(refused.value).count(name) == 1
    recipe = of_recipe("disc-kerf")
    camgeo.export(recipe, tmp_path, only=["dxf"])
    (drawing,) = (tmp_path / "disc-kerf").glob("*kerf.dxf")
    with pytest.raises(CallError, match="its contour is not the cam's"):
        read_contours(recipe, design_of("disc-kerf"), [drawing])


@pytest.mark.slow
@pytest.mark.parametrize("name", ["disc-trim", "trimmed-roller", "trimmed-frame"])
def test_parts_of_a_trimmed_contour_begin_with_the_motion_that_is_lost(name: str, tmp_path: Path) -> None:
    recipe, design = of_recipe(name), design_of(name)
    stated, shaft = Budget(1.0, (("profile", 0.01),)), np.radians(np.arange(0.5, 360.0, 3.0))
    lost = errors_by_contact(recipe, design, stated, shaft)(Stepped("", 0.0))
    assert np.abs(lost).max() > 1e-3
    camgeo.export(recipe, tmp_path, only=["dxf"])
    contours = read_contours(recipe, design, [tmp_path / name / f"{name}.dxf"])
    read = errors_by_contact(recipe, design, stated, shaft, contours)(Stepped("", 0.0))
    assert np.abs(lost - read).max() < 1.1 * recipe.export.tolerance


def test_a_contour_that_is_not_made_is_not_simulated() -> None:
    text = of_recipe("disc-trim").text.replace("  undercut: trim\n", "")
    text += "budget: {permitted: 0.05, tolerances: {profile: 0.01}}\n"
    assert split(load_text(text, "a.yaml"))["parts"] == {
        "runs": 0,
        "why": "parts are not simulated, as no contour is made",
    }
