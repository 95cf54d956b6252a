"""High harmonics, cams from a micrometre to a kilometre, the shaft on the contour, tolerances down to rounding."""

import re
from functools import partial

import pytest
from accuracy import Row, made, names, off_file, off_motion, off_profile, recipe, refused, shown_as_measured
from extreme_oracle import fourier

from camgeo.synthesis.design import designed

FORMS = "{dxf: {as: arcs}}, {dxf: {as: polyline}}, stl"
SPLINE = "{dxf: {as: spline}}"


SLOW = (
    "arcs-within-3.42e-12",
    "cos-199t-0.999999",
    "breadth-0.001-inch",
    "breadth-1e+06-mm",
)


def cases():
    """What finds the rows of each case, by name, in the order of the page."""
    units = ((1e-3, "mm"), (1e6, "mm"), (1e-3, "inch"), (39370.0, "inch"))
    return {
        **{f"cos-{k}t-{share:g}": partial(harmonics, k, share) for k in (99, 199) for share in (0.5, 0.999999)},
        **{f"breadth-{size:g}-{unit}": partial(sizes, size, unit) for size, unit in units},
        **{f"shaft-at-{x!r}": partial(shaft, x) for x in (26.0, 26.0 * (1.0 - 1e-12), 26.0 + 1e-7)},
        "tolerances-refused": refusals,
        **{f"{form}-within-{tolerance:g}": partial(tightest, form, tolerance) for form, tolerance in HELD},
    }


def harmonics(k, share):
    a = 25.0 * share / (k * k - 1)
    asked = recipe(f"kind: support\nfourier: {{mean: 25, cos: {{{k}: {a!r}}}}}", files=FORMS, thickness=10)
    oracle = fourier(25, {k: a}, {})
    what = f"p = 25 + a cos {k}t, least radius {1 - share:.6g} of the mean"
    profile = max(off_profile(asked, oracle), off_motion(designed(asked).exact.law, oracle))
    yield Row(what, "profile, p to p'''", profile, 2e-16 * 7 * k, "the angle k t is rounded: k t eps, t up to 2 pi")
    files = made(asked)
    most = max(off_file(contour, oracle, 1e-3) for contour in files.contours.values())
    yield Row(what, "files within 0.001 mm", max(most, files.used()), 1.0, "share of the tolerance")


def sizes(breadth, unit):
    mm = 25.4 if unit == "inch" else 1.0
    size = 0.05 * breadth
    cam = f"kind: support\nhypocycloid: {{cusps: 3, size: {size!r}, breadth: {breadth!r}}}"
    oracle = fourier(breadth * mm / 2, {3: size * mm}, {})
    what = f"breadth {breadth:g} {unit}"
    for share, form in ((1e-6, FORMS), (1e-11, "dxf")):
        asked = recipe(cam, files=form, units=unit, thickness=breadth / 5, tolerance=share * breadth)
        files = made(asked)
        if share == 1e-6:
            profile = max(off_profile(asked, oracle), off_motion(designed(asked).exact.law, oracle))
            yield Row(
                what, "profile, p to p'''", profile, 2e-15, "everything scales; no length is compared with a constant"
            )
        most = max(off_file(contour, oracle, share * breadth * mm) for contour in files.contours.values())
        why = "share of the tolerance; the judge resolves 2e-14 of the extent"
        yield Row(what, f"files within {share:g} of the breadth", max(most, files.used()), 1.0, why)
    said = refused(cam, files="stl", units=unit, thickness=breadth / 5, tolerance=1e-9 * breadth)
    said = re.sub(r"[0-9.]+(e[-+]\d+)?", "#", said)
    yield Row(what, "an STL within 1e-9 of the breadth", said, "rounding to single precision", "24 binary digits")


def shaft(x):
    """The shaft on the contour, or as good as on it."""
    cam = f"kind: support\nfourier: {{mean: 25, cos: {{3: 1}}}}\nshaft: [{x!r}, 0]"
    asked = recipe(cam, files=f"{FORMS}, {SPLINE}", thickness=10)
    oracle = fourier(25, {3: 1}, {}, pivot=(x, 0.0))
    what = f"shaft {x - 26.0:.2g} mm outside the contour" if x != 26.0 else "shaft on the contour"
    profile = max(off_profile(asked, oracle), off_motion(designed(asked).exact.law, oracle))
    yield Row(
        what, "profile, p to p'''", profile, 2e-15, "as a share of the size; the place of the shaft is added last"
    )
    files = made(asked)
    most = max(off_file(contour, oracle, 1e-3) for contour in files.contours.values())
    yield Row(what, "files within 0.001 mm", max(most, files.used()), 1.0, "share of the tolerance")


CAM = "kind: constant-breadth\nbase_radius: 40\nmotion: [{rise: 20, over: 120, law: modified-sine}, {dwell: 60}]"
FLOOR = 3.42e-12  # mm: 256 roundings of 60
REFUSALS = (
    (1e-6, "stl", "rounding to single precision alone moves points by 2.7e-06 mm; at least 3.38e-06 mm"),
    (1e-12, "{dxf: {as: polyline}}", "straight edges within 1e-12 mm need about"),
    (1e-13, "{dxf: {as: polyline}}", "at least 8.53e-13 mm"),
    (1e-13, "{dxf: {as: arcs}}", "at least 3.42e-12 mm"),
    (3.4e-12, "{dxf: {as: arcs}}", "at least 3.42e-12 mm"),
    (1e-16, "{dxf: {as: spline}}", "at least 3.42e-12 mm"),
    (3.4e-12, "{dxf: {as: spline}}", "at least 3.42e-12 mm"),
    (1e-20, "stl", "at least 3.38e-06 mm"),
)


HELD = (("arcs", 1e-10), ("arcs", FLOOR), ("spline", 1e-3), ("spline", 1e-10), ("spline", FLOOR))


def refusals():
    for tolerance, form, words in REFUSALS:
        said = refused(CAM, files=form, thickness=10, tolerance=tolerance)
        what = f"{re.sub(r'[{}]|dxf: |as: ', '', form)} of a cam that reaches 60 mm"
        yield Row(what, f"{tolerance:g} mm", said, words, "refused with what can be held")


def tightest(form, tolerance):
    files = made(recipe(CAM, files=f"{{dxf: {{as: {form}}}}}", tolerance=tolerance))
    why = "share of the tolerance" if tolerance > FLOOR else "share of the tolerance; the least that is taken"
    yield Row(f"{form} of a cam that reaches 60 mm", f"{tolerance:g} mm", files.used(), 1.0, why)


@pytest.mark.slow
@pytest.mark.parametrize("name", names(cases(), SLOW))
def test_it_holds_and_the_page_shows_it(name):
    shown_as_measured(__name__, name)
