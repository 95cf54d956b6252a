"""Exact rational splines: against mpmath, through the file by two readers, and what is no trigonometric polynomial."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import mpmath
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from support.cases import examples, few
from support.places import RECIPES

from camgeo.curve.curve import Curve
from camgeo.curve.support import SupportShape
from camgeo.fit import exact
from camgeo.fit.bound import Bound, FormError
from camgeo.fit.exact import fit_exact, spline_of
from camgeo.fit.nodes import ToleranceError
from camgeo.fit.rational import RationalSpline
from camgeo.fit.trigonometric import Polynomial, polynomial_of
from camgeo.output.dispatch import make
from camgeo.output.job import Job
from camgeo.output.pipeline import export
from camgeo.recipe.export import FileRequest
from camgeo.recipe.loading import load, read
from camgeo.schema.errors import RecipeErrors
from camgeo.synthesis.design import designed
from kin.law.formula.formula import Formula
from kin.law.from_formula import lift_from_formula
from kin.law.support_function import lift_from_fourier, lift_hypocycloid
from kin.read.drawing.dxf import read_dxf

POLYNOMIALS = ["as-figure-1", "as-figure-2a", "as-figure-2b", "as-figure-2d", "fourier", "hypocycloid", "rabinowitz"]


def waves_at(mean: float, waves: list[tuple[int, float, float]], t: mpmath.mpf) -> tuple[mpmath.mpf, mpmath.mpf]:
    """Point of the contour with normal t, in mpmath's precision."""
    p = mpmath.mpf(mean) + sum(
        mpmath.mpf(a) * mpmath.cos(k * t) + mpmath.mpf(b) * mpmath.sin(k * t) for k, a, b in waves
    )
    q = sum(k * (mpmath.mpf(b) * mpmath.cos(k * t) - mpmath.mpf(a) * mpmath.sin(k * t)) for k, a, b in waves)
    return p * mpmath.cos(t) - q * mpmath.sin(t), p * mpmath.sin(t) + q * mpmath.cos(t)


def worst_of(spline: RationalSpline, mean: float, waves: list[tuple[int, float, float]], steps: int = 8) -> float:
    """Greatest distance of the stored numbers' curve, evaluated in 50 digits, from the contour at the same normal."""
    d, worst = spline.degree, mpmath.mpf(0)
    with mpmath.workdps(50):
        for span in range(spline.count):
            rows = slice(span * d, (span + 1) * d + 1)
            points, weights = spline.control[rows].tolist(), spline.weights[rows].tolist()
            for u in [mpmath.mpf(i) / steps for i in range(steps + 1)]:
                basis = [mpmath.binomial(d, i) * u**i * (1 - u) ** (d - i) * w for i, w in enumerate(weights)]
                x, y = (sum(b * p[axis] for b, p in zip(basis, points, strict=True)) / sum(basis) for axis in (0, 1))
                line = (1 - u) * mpmath.expj(-mpmath.pi / 8) + u * mpmath.expj(mpmath.pi / 8)
                t = mpmath.pi / 4 * (2 * span + 1) + 2 * mpmath.arg(line)
                cx, cy = waves_at(mean, waves, t)
                worst = max(worst, mpmath.hypot(x - cx, y - cy))
    return float(worst)


@pytest.mark.parametrize(
    ("mean", "waves", "degree"),
    [
        (10.0, [], 2),
        (10.0, [(1, 3.0, -4.0)], 2),
        (25.0, [(2, 1.0, 0.5)], 6),
        (9.0, [(3, 1.0, 0.0)], 8),
        (25.0, [(1, -16.0, 7.5), (3, 1.5, 0.0), (5, 0.0, 0.3)], 12),
        (1e6, [(3, 1e4, 1e3), (7, 3e3, 1e2)], 16),
        (1e-3, [(4, 1e-5, 3e-6)], 10),
        (30.0, [(11, 0.1, 0.2), (1, 5.0, 5.0)], 24),
    ],
)
def test_the_numbers_stored_are_the_contour_to_rounding(
    mean: float, waves: list[tuple[int, float, float]], degree: int
) -> None:
    spline = spline_of(Polynomial.of_waves(mean, waves))
    assert (spline.degree, spline.count) == (degree, 4)
    worst = worst_of(spline, mean, waves)
    assert worst <= spline.bound.worst
    size = mean + sum(math.hypot(a, b) * (k + 1) for k, a, b in waves)
    assert worst <= 8 * 2.0**-53 * size  # eight roundings of the largest number there is, and no more
    assert spline.weights.min() > 0.1
    assert spline.weights.max() == 1.0


@settings(max_examples=examples(20), deadline=None)
@given(
    st.floats(0.1, 1e3),
    st.dictionaries(st.integers(1, 11), st.tuples(st.floats(-1, 1), st.floats(-1, 1)), max_size=4),
)
def test_any_trigonometric_polynomial(mean: float, given_: dict[int, tuple[float, float]]) -> None:
    waves = [(k, a * mean, b * mean) for k, (a, b) in given_.items()]
    spline = spline_of(Polynomial.of_waves(mean, waves).trimmed())
    assert worst_of(spline, mean, waves, steps=3) <= spline.bound.worst


def test_the_box_is_that_of_the_curve() -> None:
    spline = spline_of(Polynomial.of_waves(25.0, [(3, 2.0, 0.0), (2, 0.5, 1.0)]))
    d = spline.degree
    u = np.linspace(0, 1, 2001)[:, None]
    basis = (
        np.array([math.comb(d, i) for i in range(d + 1)]) * u ** np.arange(d + 1) * (1 - u) ** (d - np.arange(d + 1))
    )
    found = np.einsum("ui,nij->nuj", basis, spline.homogeneous)
    points = (found[..., :2] / found[..., 2:]).reshape(-1, 2)
    x_min, y_min, x_max, y_max = spline.box()
    assert [x_min, y_min] == pytest.approx(points.min(axis=0), abs=1e-5)
    assert [x_max, y_max] == pytest.approx(points.max(axis=0), abs=1e-5)
    assert np.all(points >= np.array([x_min, y_min]) - 1e-13)
    assert np.all(points <= np.array([x_max, y_max]) + 1e-13)
    # a chain whose extremes are inside its spans
    leaning = RationalSpline(
        2, np.array([[0.0, 0.0], [1.0, 2.0], [2.0, 0.0], [1.0, -2.0], [0.0, 0.0]]), np.ones(5), spline.bound
    )
    assert leaning.box() == pytest.approx((0.0, -1.0, 2.0, 1.0), abs=1e-14)
    assert leaning.mirrored().box() == pytest.approx((0.0, -1.0, 2.0, 1.0), abs=1e-14)
    assert leaning.scaled(2.0).box() == pytest.approx((0.0, -2.0, 4.0, 2.0), abs=1e-14)


@pytest.mark.parametrize(
    ("control", "weights", "message"),
    [
        (np.zeros((4, 2)), np.ones(4), "make no spans"),
        (np.zeros((5, 2)), np.ones(4), "shape"),
        (np.zeros((5, 2)), np.array([1.0, 0.0, 1.0, 1.0, 1.0]), "positive"),
        (np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 1e-9]]), np.ones(5), "close"),
    ],
)
def test_what_is_no_closed_rational_spline(control: np.ndarray, weights: np.ndarray, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        RationalSpline(2, control, weights, Bound(0.0, 0.0))


@pytest.mark.thin(3)
@pytest.mark.parametrize("name", few(POLYNOMIALS, 3))
def test_shipped_recipes_through_the_file(name: str, tmp_path: Path) -> None:
    recipe = load(RECIPES / f"{name}.yaml")
    request = FileRequest("dxf", "exact", "R2000", 1e-11)
    recipe = replace(recipe, export=replace(recipe.export, files=(request,)), verify=replace(recipe.verify, angles=360))
    design = designed(recipe)
    path = tmp_path / "cam.dxf"
    (file,), checks = make(Job.of(recipe, design), request, path)
    assert [check.name for check in checks if not check.ok] == []
    assert file.pieces == 4
    assert file.bound.worst < 2e-12
    assert file.measured_error < 2e-12
    assert file.motion.max < 2e-12


def second_opinion(path: Path) -> tuple[int, np.ndarray]:
    """Degree of the SPLINE in a file, and points of it by ezdxf's own evaluation, the one in plain Python.

    The compiled one takes degree 10 at most.
    """
    import ezdxf
    from ezdxf.math import Vec3
    from ezdxf.math._bspline import Basis, Evaluator

    (entity,) = ezdxf.readfile(path).modelspace().query("SPLINE[layer=='CUT']")
    control, degree = [Vec3(p) for p in entity.control_points], entity.dxf.degree
    assert entity.closed
    assert len(entity.weights) == len(control)
    assert set(entity.weights) != {1.0}
    basis = Basis(list(entity.knots), degree + 1, len(control), list(entity.weights))
    points = list(Evaluator(basis, control).points(np.linspace(0, 4, 401)))
    if degree <= 10:
        compiled = entity.construction_tool()
        assert compiled.is_rational
        assert (
            max((a - b).magnitude for a, b in zip(compiled.points(np.linspace(0, 4, 401)), points, strict=True)) < 1e-12
        )
    return degree, np.array([tuple(p) for p in points])[:, :2]


@pytest.mark.thin(2)
@pytest.mark.parametrize("rotation", few(["cw", "ccw"], 3))
@pytest.mark.parametrize(
    ("text", "order"),
    [
        ("25 + 2*cos(3*t)", 3),
        ("4*cos(3*t/2)**2 + 23", 3),
        ("25 + 0.1*sin(t)*cos(2*t)**2/3 - 0.02*sin(0.5*t)**8", 5),
        ("40 + cos(t + 1)**11/100", 11),
    ],
)
def test_a_second_reader_finds_the_contour_on_the_spline(text: str, order: int, rotation: str, tmp_path: Path) -> None:
    source = f"""
    name: cam
    rotation: {rotation}
    cam: {{kind: support, p: "{text}", shaft: [3, -2]}}
    export: {{tolerance: 1.0e-11, files: [{{dxf: {{as: exact}}}}]}}
    verify: {{angles: 360}}
    """
    recipe = read(source.encode(), Path("cam.yaml"))
    outcome = export(recipe, tmp_path)
    assert outcome.ok
    degree, points = second_opinion(tmp_path / "cam" / "cam.dxf")
    assert degree == 2 * (order + 1)
    assert read_dxf(tmp_path / "cam" / "cam.dxf").pieces == 4
    lift = lift_from_formula(Formula(text), (3.0, -2.0))
    points = points * [1.0, -1.0 if rotation == "ccw" else 1.0]
    # each point lies on the contour: the greatest u.x - p over normals u is 0, and it is where the derivative vanishes
    theta = np.linspace(0, 2 * np.pi, 721)
    p = lift.derivatives(theta, 1)[0]
    reach = points @ np.array([np.cos(theta), np.sin(theta)]) - p
    t = theta[reach.argmax(axis=1)]
    for _ in range(6):
        p = lift.derivatives(t, 2)
        off = points[:, 0] * np.cos(t) + points[:, 1] * np.sin(t) - p[0]
        slope = points[:, 1] * np.cos(t) - points[:, 0] * np.sin(t) - p[1]
        t = t + slope / (p[0] + p[2])
    assert np.abs(off).max() < 2e-13


def test_units_scale_the_spline(tmp_path: Path) -> None:
    source = (
        b"units: inch\ncam: {kind: support, p: 1 + cos(3*t)/12}\nexport: {tolerance: 1e-9, files: [{dxf: {as: exact}}]}"
    )
    assert export(read(source, tmp_path / "inches.yaml"), tmp_path).ok
    assert second_opinion(tmp_path / "inches" / "inches.dxf")[0] == 8


def polynomial(text: str) -> Polynomial:
    return polynomial_of(Curve.whole(SupportShape(lift_from_formula(Formula(text)))))


@pytest.mark.parametrize(
    "text",
    [
        "25 + 2*cos(3*t)",
        "25 + cos(t)**5/7 - sin(2*t - pi/3)**3/9",
        "30 + (1 + cos(t)*sin(2*t))**3/e",
        "20 - -cos(2*(t + 0.1)/4*2)/sqrt(2)",
        "20 + cos(t*3/2 + 1/3)**4",
        "20 + sin(0.1)*cos(0*t) + 3",
    ],
)
def test_coefficients_of_formulas_against_mpmath(text: str) -> None:
    found = polynomial(text)
    names = {name: getattr(mpmath, name) for name in ("cos", "sin", "sqrt", "pi", "e")}
    with mpmath.workdps(40):
        n = 64
        # formulas of this file: nothing but what stands above
        values = [eval(text, {"__builtins__": {}, **names, "t": 2 * mpmath.pi * j / n}) for j in range(n)]
        for k in range(n // 2):
            c = sum(v * mpmath.expj(-2 * mpmath.pi * j * k / n) for j, v in enumerate(values)) / n
            ours = complex(found.coefficients[k]) if k <= found.order else 0.0
            # a decimal in this check is the double, in the formula the number that is written
            room = float(found.error[k]) + 1e-16 if k <= found.order else found.rest + 1e-16
            assert abs(c - ours) <= room
            assert room < 1e-13


def test_harmonics_that_cancel_are_left_out() -> None:
    assert polynomial("25 + cos(3*t)**2 + sin(3*t)**2 + 0.3*cos(t/2)*cos(t/2)").order == 1
    found = polynomial("25 + cos(2*t) + 0.1*cos(7*t) - (0.3 - 0.2)*cos(7*t)")
    assert found.order == 2
    assert 0.0 < found.rest < 1e-14


@pytest.mark.parametrize(
    ("cam", "reason"),
    [
        ("p: 25 + 2*sin(pi*cos(t))*cos(pi*sin(t))", r"sin of something other than a multiple of t \(character"),
        ("p: sqrt(600 + cos(3*t))", "sqrt is not an operation"),
        ("p: 25 + exp(cos(3*t))/10", "exp is not an operation"),
        ("p: 25 + 1/(3 + cos(2*t))", "division by something other than a number"),
        ("p: (25 + cos(2*t))**0.5", "power is not an operation"),
        ("p: 25 + abs(sin(3*t))**3/100", "pieced together from 6 stretches"),
        ("p: 60 + cos(12*t)/10", r"harmonics up to 12, so .* degree 26; CAD systems take degree 25 at most"),
        ("reuleaux: {sides: 3, breadth: 50, rounding: 5}", "pieced together from 6 stretches"),
    ],
)
def test_what_is_no_trigonometric_polynomial_is_refused_with_the_reason(cam: str, reason: str, tmp_path: Path) -> None:
    source = f"name: cam\ncam:\n  kind: support\n  {cam}\nexport:\n  files: [{{dxf: {{as: exact}}}}]\n"
    with pytest.raises(RecipeErrors, match=reason) as caught:
        export(read(source.encode(), Path("cam.yaml")), tmp_path)
    (error,) = caught.value.errors
    assert error.path == "export.files[0].dxf.as"
    assert error.line == 6


@pytest.mark.thin(2)
@pytest.mark.parametrize("name", ["shu-wu", "w-ellipse", "w-figure-9"])
def test_other_cams_are_refused(name: str, tmp_path: Path) -> None:
    recipe = load(RECIPES / f"{name}.yaml")
    recipe = replace(recipe, export=replace(recipe.export, files=(FileRequest("dxf", "exact", "R2010"),)))
    with pytest.raises(RecipeErrors, match=r"pieced together|not given by a support function"):
        export(recipe, tmp_path)


def test_r12_has_no_exact_splines() -> None:
    source = b"cam: {kind: support, p: 25 + cos(3*t)}\nexport: {files: [{dxf: {as: exact, version: R12}}]}"
    with pytest.raises(RecipeErrors, match="R12 has no splines"):
        read(source, Path("cam.yaml"))


def test_a_tolerance_below_rounding_is_refused_with_the_figure() -> None:
    curve = Curve.whole(SupportShape(lift_hypocycloid(3, 2.0, 50.0)))
    with pytest.raises(ToleranceError, match="below the rounding") as caught:
        fit_exact(curve, 1e-15)
    assert 1e-15 < caught.value.reached < 1e-12
    assert fit_exact(curve, caught.value.reached).bound.worst == caught.value.reached


@pytest.mark.slow
def test_a_high_power_of_a_sum_is_not_multiplied_out(monkeypatch: pytest.MonkeyPatch) -> None:
    text = "25 + (cos(t) + cos(2*t) + cos(9*t)/3)**99/1e60"
    with pytest.raises(FormError, match=r"a product of sums of \d+ and \d+ harmonics \(character"):
        polynomial(text)
    # the longest product of a power of one wave is within the limit many times over
    monkeypatch.setattr("camgeo.fit.trigonometric.MOST_PRODUCTS", 30_000)
    assert polynomial("25 + cos(t)**198/1e6").order <= 198


def test_a_trimmed_contour_has_corners_and_is_refused() -> None:
    source = b"cam: {kind: support, p: 16 - 2.2*cos(3*t), undercut: trim}"
    contour = designed(read(source, Path("cam.yaml"))).only_surface.contour
    assert contour is not None
    assert not contour.closed
    with pytest.raises(FormError, match="corners"):
        fit_exact(contour, 1e-6)


def test_a_wrong_weight_or_point_would_show(monkeypatch: pytest.MonkeyPatch) -> None:
    curve = Curve.whole(SupportShape(lift_from_fourier(25.0, {3: 2.0}, {})))
    right = exact._basis
    monkeypatch.setattr(
        exact, "_basis", lambda n, m: right(n, m) * (1.0 + 1e-12 * (np.arange(2 * n + 1) == 3) * (m > 0))
    )
    spline = fit_exact(curve, 1e-9)
    assert worst_of(spline, 25.0, [(3, 2.0, 0.0)]) > spline.bound.worst


def test_a_harmonic_below_rounding_is_left_out_and_counted() -> None:
    plain, whole = polynomial("25 + 2*cos(3*t)"), polynomial("25 + 2*cos(3*t) + 1e-18*cos(200*t)")
    assert whole.order == plain.order == 3
    assert whole.rest >= 200 * 1e-18
    assert spline_of(whole).bound.worst >= spline_of(plain).bound.worst + 200 * 1e-18
    # one that is not below it stays, and so do many that are not all together
    assert polynomial("25 + 2*cos(3*t) + 1e-15*cos(200*t)").order == 200
    many = " + ".join(f"1e-16*cos({k}*t)" for k in range(10, 60))
    assert polynomial(f"25 + {many}").order > 10


@pytest.mark.thin(4)
@pytest.mark.parametrize(
    ("small", "told"),
    [
        (
            "1e-18*cos(13*t) + 1e-18*sin(14*t)",
            [("harmonics 13, 14 of p", "they move the contour by less than rounding")],
        ),
        ("1e-18*cos(13*t)", [("harmonic 13 of p", "it moves the contour by less than rounding")]),
        ("cos(t)**2 + sin(t)**2", []),  # harmonics that cancel were never there
        ("0.01*cos(5*t)", []),
    ],
)
def test_the_report_tells_which_harmonics_a_file_goes_without(
    tmp_path: Path, small: str, told: list[tuple[str, str]]
) -> None:
    text = f"cam: {{kind: support, p: 25 + cos(3*t) + {small}}}\nexport: {{files: [dxf, {{dxf: {{as: exact}}}}]}}\n"
    report = export(read(text.encode(), tmp_path / "cam.yaml"), tmp_path / "out").report
    found = [(one["what"], one["why"]) for one in report["skipped"] if "harmonic" in one["what"]]
    assert [what for what, _ in found] == [what for what, _ in told]
    for (_, why), (_, start) in zip(found, told, strict=True):
        assert why.startswith(f"cam-exact.dxf: {start}, ")


def test_a_frequency_that_is_off_by_rounding_drifts_over_the_turn() -> None:
    """A tenth times 90 may not be 9 in binary: the file has 9, and the bound what the difference makes in a turn."""
    exact_, off = polynomial("25 + cos(9*t)/40"), polynomial("25 + cos((0.1*t)*90)/40")
    assert off.order == exact_.order == 9
    assert off.error[9] > exact_.error[9] + 0.0125 * 2 * math.pi * 9 * 2.0**-54
